//! Floquet exponents of x′ = A₀x + U Φ(t) Vᵀ x, Φ periodic, with an error bound.
//!
//! Strang splitting with the exact constant flow ([`ConstantFlow`]) and exact kicks, with N and 2N steps per period. The error
//! of the growth rate ρ = ln|μ|/T of N steps is a series in even powers of h, starting with h⁴ if the kicks are nilpotent
//! (VᵀU = 0) and with h² otherwise; the tests measure both orders. Hence
//!
//! ```text
//! ρ = (16ρ₂ₙ − ρₙ)/15   or   (4ρ₂ₙ − ρₙ)/3,      error ≤ |ρ₂ₙ − ρₙ| + 10⁻¹³ + rounding
//! ```
//!
//! and N is doubled until the sign of ρ is certain or the bound is small enough. The eigenvalues of one map are reused for
//! the others (`shared`). If multipliers are defective or the maps differ too much, the full eigenvalue problem is solved for
//! each map. The splitting has no numerical damping: a marginal exponent stays marginal, whereas an integrator such as ode45
//! reports −10⁻⁵ and hides any slower growth.

mod flow;
mod kick;
mod monodromy;
mod pieces;
mod processing;
mod shared;
mod steps;
mod varying;

pub use flow::ConstantFlow;
pub use pieces::{ConstantPiece, of_pieces};
pub use steps::Phase;
pub use varying::{Sinusoid, Strength, VaryingFlow, VaryingPiece};

use num_complex::Complex64;

use crate::eigen::{Decomposition, EigenError, eigenvalues};
use crate::matrix::Matrix;
use crate::order::descending_by;
use crate::polar::modulus;
use processing::Generator;
use shared::TrackedMultiplier;
use steps::Steps;

/// Smallest error bound.
const FLOOR: f64 = 1e-13;

/// Maximum number of multipliers that are tracked individually; for more candidates a full solve is cheaper.
const MOST_TRACKED: usize = 6;

/// Stopping criteria.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Steps are doubled while the sign of the growth rate is uncertain and the bound is above this.
    pub enough: f64,
    /// Steps are doubled while the bound is above this, whether or not the sign is certain. The extrapolated rate is
    /// about a hundred times more accurate than its bound, so that 10⁻⁷ gives rates to 10⁻⁹.
    pub at_least: f64,
    /// Maximum number of steps per period.
    pub finest: usize,
}

impl Default for Effort {
    /// Bound 10⁻¹¹ if the sign is uncertain, 10⁻⁷ if it is certain, at most 8192 steps.
    fn default() -> Self {
        Self { enough: 1e-11, at_least: 1e-7, finest: 8192 }
    }
}

/// The largest growth rate of a periodic system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// Growth rate: largest real part of an exponent.
    pub growth_rate: f64,
    /// Bound on its error.
    pub error: f64,
    /// Its frequency |Im ρ| in radians per unit of time, from 0 to π/T: exponents are defined up to multiples of i·2π/T.
    pub frequency: f64,
    /// Steps per period of the finest map used.
    pub steps: usize,
}

/// A constant flow and the tables of its first two levels for one period, applicable to any Φ of that period.
#[derive(Clone, Debug)]
pub struct Floquet {
    flow: ConstantFlow,
    period: f64,
    levels: [Steps; 2],
}

impl Floquet {
    /// Prepares the flow for kicks of period T. The number of steps of the first level is the least power of two, at least
    /// 32, with |λ|h ≤ 1.
    pub fn new(flow: ConstantFlow, period: f64) -> Self {
        let mut count = 32;
        while flow.fastest * period > count as f64 && count < 4096 {
            count *= 2;
        }
        Self::with_steps(flow, period, count)
    }

    /// As [`Floquet::new`] with a given number of steps at the first level, rounded up to a power of two.
    pub fn with_steps(flow: ConstantFlow, period: f64, count: usize) -> Self {
        let count = count.next_power_of_two();
        let levels = [count, 2 * count].map(|count| Steps::new(&flow, period, count));
        Self { flow, period, levels }
    }

    /// The period T.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Steps per period of the first level.
    pub fn first_steps(&self) -> usize {
        self.levels[0].phases.len()
    }

    /// Multipliers of one period with `count` steps (rounded up to a power of two), without extrapolation.
    ///
    /// # Errors
    /// [`EigenError`] if the map is not finite.
    pub fn multipliers(
        &self,
        phi: &dyn Fn(Phase, &mut Matrix),
        count: usize,
    ) -> Result<Vec<Complex64>, EigenError> {
        let steps = Steps::new(&self.flow, self.period, count.next_power_of_two());
        eigenvalues(&monodromy::monodromy(&self.flow, &steps, phi))
    }

    /// Largest growth rate with its error bound. `phi` writes the r × r matrix Φ at a phase of the period.
    ///
    /// # Errors
    /// [`EigenError`] if a map is not finite.
    pub fn growth(
        &self,
        phi: &dyn Fn(Phase, &mut Matrix),
        effort: Effort,
    ) -> Result<Exponent, EigenError> {
        let generator = Generator::new(&self.flow, self.period, phi);
        let map = |steps: &Steps| {
            let map = monodromy::monodromy(&self.flow, steps, phi);
            generator.process(map, steps.step)
        };
        let mut coarse = map(&self.levels[0]);
        let mut fine = map(&self.levels[1]);
        let mut count = 2 * self.first_steps();
        let decomposition = Decomposition::of_balanced(&fine)?;
        let tracked = candidates(&decomposition, &coarse, &fine);
        let mut known: Option<Vec<Complex64>> = None;
        loop {
            let pairs = tracked.as_ref().and_then(|tracked| {
                let old = match known.take() {
                    Some(known) => Some(known),
                    None => track_all(tracked, &decomposition, &coarse),
                }?;
                let new = track_all(tracked, &decomposition, &fine)?;
                Some((old, new))
            });
            let (found, difference) = if let (Some((old, new)), Some(tracked)) = (pairs, &tracked) {
                let conditions: Vec<f64> =
                    tracked.iter().map(|multiplier| multiplier.condition).collect();
                let found = self.extrapolate(&old, &new, &conditions, &decomposition, count);
                known = Some(new);
                found
            } else {
                self.in_full(&coarse, &fine, count)?
            };
            let sure = found.growth_rate.abs() > found.error;
            let decided = sure && found.error <= effort.at_least;
            // The remaining difference is rounding: more steps would not help.
            let rounded = difference <= FLOOR;
            if decided || rounded || found.error <= effort.enough || 2 * count > effort.finest {
                return Ok(found);
            }
            count *= 2;
            coarse = fine;
            fine = map(&Steps::new(&self.flow, self.period, count));
        }
    }

    /// All exponents whose growth rate exceeds its error, one of each conjugate pair, the fastest first.
    ///
    /// # Errors
    /// As [`Floquet::growth`].
    pub fn growing(
        &self,
        phi: &dyn Fn(Phase, &mut Matrix),
        effort: Effort,
    ) -> Result<Vec<Exponent>, EigenError> {
        let leading = self.growth(phi, effort)?;
        if leading.growth_rate <= leading.error {
            return Ok(Vec::new());
        }
        let generator = Generator::new(&self.flow, self.period, phi);
        let map = |count: usize| {
            let steps = Steps::new(&self.flow, self.period, count);
            generator.process(monodromy::monodromy(&self.flow, &steps, phi), steps.step)
        };
        let (coarse, fine) = (map(leading.steps / 2), map(leading.steps));
        let (decomposition, old) = paired(&coarse, &fine)?;
        let conditions = conditions(&decomposition, 0.0);
        let values = decomposition.values();
        let one = |i: usize| {
            let (old, new, condition) = (&old[i..=i], &values[i..=i], &conditions[i..=i]);
            self.extrapolate(old, new, condition, &decomposition, leading.steps).0
        };
        let mut found: Vec<Exponent> = (0..old.len())
            .filter(|&i| values[i].im >= 0.0 && modulus(values[i]) > 1.0)
            .map(one)
            .filter(|exponent| exponent.growth_rate > exponent.error)
            .collect();
        descending_by(&mut found, |a| a.growth_rate);
        Ok(found)
    }

    /// All exponents, one of each conjugate pair, the fastest first. Steps are doubled while a bound is above `effort.at_least`.
    ///
    /// # Errors
    /// As [`Floquet::growth`].
    pub fn exponents(
        &self,
        phi: &dyn Fn(Phase, &mut Matrix),
        effort: Effort,
    ) -> Result<Vec<Exponent>, EigenError> {
        let generator = Generator::new(&self.flow, self.period, phi);
        let map = |steps: &Steps| {
            let map = monodromy::monodromy(&self.flow, steps, phi);
            generator.process(map, steps.step)
        };
        let (mut coarse, mut fine) = (map(&self.levels[0]), map(&self.levels[1]));
        let mut count = 2 * self.first_steps();
        loop {
            let (decomposition, old) = paired(&coarse, &fine)?;
            let conditions = conditions(&decomposition, 0.0);
            let values = decomposition.values();
            let one = |i: usize| {
                let (old, new, condition) = (&old[i..=i], &values[i..=i], &conditions[i..=i]);
                self.extrapolate(old, new, condition, &decomposition, count)
            };
            let all = (0..old.len()).filter(|&i| values[i].im >= 0.0).map(one);
            let (mut found, differences): (Vec<Exponent>, Vec<f64>) = all.unzip();
            let largest = differences.into_iter().fold(0.0, f64::max);
            if largest <= effort.at_least || 2 * count > effort.finest {
                descending_by(&mut found, |a| a.growth_rate);
                return Ok(found);
            }
            count *= 2;
            coarse = fine;
            fine = map(&Steps::new(&self.flow, self.period, count));
        }
    }

    /// Weight of the difference between two levels in the extrapolation.
    fn weight(&self) -> f64 {
        if self.flow.nilpotent { 1.0 / 15.0 } else { 1.0 / 3.0 }
    }

    /// The leading exponent of two levels, and the largest difference of a growth rate between the levels.
    fn extrapolate(
        &self,
        old: &[Complex64],
        new: &[Complex64],
        conditions: &[f64],
        decomposition: &Decomposition,
        steps: usize,
    ) -> (Exponent, f64) {
        let rate = |z: Complex64| libm::log(modulus(z)) / self.period;
        let mut best: Option<Exponent> = None;
        let mut highest = f64::NEG_INFINITY;
        let mut largest_difference = 0.0f64;
        for ((&old, &new), &condition) in old.iter().zip(new).zip(conditions) {
            let (coarse, fine) = (rate(old), rate(new));
            let difference = fine - coarse;
            let growth_rate = difference.mul_add(self.weight(), fine);
            let rounding = decomposition.backward_error() * condition
                / (modulus(new) * self.period)
                + self.flow.rounding;
            let error = difference.abs() + FLOOR + rounding;
            highest = highest.max(growth_rate + error);
            largest_difference = largest_difference.max(difference.abs());
            let leads = best.is_none_or(|best| growth_rate > best.growth_rate);
            if leads {
                let frequency = libm::atan2(new.im.abs(), new.re) / self.period;
                best = Some(Exponent { growth_rate, error, frequency, steps });
            }
        }
        let mut best = best.unwrap_or(Exponent {
            growth_rate: f64::NEG_INFINITY,
            error: f64::INFINITY,
            frequency: 0.0,
            steps,
        });
        // A slightly smaller exponent with a larger error may be the true leading one.
        best.error = best.error.max(highest - best.growth_rate);
        (best, largest_difference)
    }

    /// Solves the full eigenvalue problem for both maps; each multiplier is paired with the nearest one.
    fn in_full(
        &self,
        coarse: &Matrix,
        fine: &Matrix,
        steps: usize,
    ) -> Result<(Exponent, f64), EigenError> {
        let (decomposition, old) = paired(coarse, fine)?;
        let conditions = conditions(&decomposition, 0.9);
        Ok(self.extrapolate(&old, decomposition.values(), &conditions, &decomposition, steps))
    }
}

/// The decomposition of the finer map, and for each of its multipliers the nearest one of the coarser map, each used once.
fn paired(coarse: &Matrix, fine: &Matrix) -> Result<(Decomposition, Vec<Complex64>), EigenError> {
    let decomposition = Decomposition::of_balanced(fine)?;
    let mut left = eigenvalues(coarse)?;
    let mut old = Vec::with_capacity(left.len());
    for &value in decomposition.values() {
        let nearest = (0..left.len())
            .min_by(|&i, &j| modulus(left[i] - value).total_cmp(&modulus(left[j] - value)));
        if let Some(at) = nearest {
            old.push(left.swap_remove(at));
        }
    }
    Ok((decomposition, old))
}

/// Condition numbers of the multipliers larger than a fraction of the largest, 1 for the others. Defective multipliers change
/// by the square root of a rounding error, which their difference shows; the condition number is capped in that case.
fn conditions(decomposition: &Decomposition, beyond: f64) -> Vec<f64> {
    let cap = 1.0 / decomposition.backward_error().max(f64::MIN_POSITIVE).sqrt();
    let values = decomposition.values();
    let largest = values.iter().fold(0.0, |most: f64, z| most.max(modulus(*z)));
    (0..values.len())
        .map(|i| {
            let near = modulus(values[i]) > beyond * largest;
            if near { decomposition.pair(i).condition.min(cap) } else { 1.0 }
        })
        .collect()
}

/// Multipliers that may be the largest one of the true map; `None` if there are too many or their vectors are unusable.
fn candidates(
    decomposition: &Decomposition,
    coarse: &Matrix,
    fine: &Matrix,
) -> Option<Vec<TrackedMultiplier>> {
    let mut difference = coarse.clone();
    difference.add_scaled(-1.0, fine);
    let values = decomposition.values();
    let largest = values.iter().fold(0.0, |largest: f64, z| largest.max(modulus(*z)));
    let margin = 4.0 * difference.frobenius_norm() + decomposition.backward_error();
    let chosen: Vec<usize> = (0..values.len())
        .filter(|&i| values[i].im >= 0.0 && modulus(values[i]) >= largest - margin)
        .collect();
    if chosen.len() > MOST_TRACKED {
        return None;
    }
    chosen.into_iter().map(|i| TrackedMultiplier::new(decomposition, i)).collect()
}

/// All tracked multipliers in another map.
fn track_all(
    tracked: &[TrackedMultiplier],
    decomposition: &Decomposition,
    map: &Matrix,
) -> Option<Vec<Complex64>> {
    tracked.iter().map(|multiplier| multiplier.in_map(decomposition, map)).collect()
}
