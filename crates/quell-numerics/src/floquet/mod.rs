//! Floquet exponents of x′ = A₀x + U Φ(t) Vᵀ x, Φ periodic, with an error bound.
//!
//! Strang splitting with the exact constant flow ([`ConstantFlow`]) and exact kicks, N and 2N steps a period. The growth
//! rate ρ = ln|μ|/T of N steps has an error in even powers of h, h⁴ where kicks are nilpotent (VᵀU = 0), h² otherwise; both
//! orders are measured in the tests. So
//!
//! ```text
//! ρ = (16ρ₂ₙ − ρₙ)/15   or   (4ρ₂ₙ − ρₙ)/3,      error ≤ |ρ₂ₙ − ρₙ| + 10⁻¹³ + rounding
//! ```
//!
//! and N is doubled until the sign of ρ is sure or the bound is small enough. The eigenvalues of one map serve all others
//! (`shared`). Where multipliers are defective or the maps differ too much, all maps are solved in full.
//! The splitting has no damping of its own: a marginal exponent stays marginal, where an integrator of the ode45 kind reports
//! −10⁻⁵ and hides what grows more slowly.

mod flow;
mod kick;
mod monodromy;
mod processing;
mod shared;
mod steps;

pub use flow::ConstantFlow;
pub use steps::Phase;

use num_complex::Complex64;

use crate::eigen::{Decomposition, EigenError, eigenvalues, modulus};
use crate::matrix::Matrix;
use processing::Generator;
use shared::TrackedMultiplier;
use steps::Steps;

/// Least of all error bounds.
const FLOOR: f64 = 1e-13;

/// Branches that are followed one by one; with more in question a full solve is cheaper.
const BRANCHES: usize = 6;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Steps are doubled while the sign of the growth rate is open and the bound is above this.
    pub enough: f64,
    /// Steps are doubled while the bound is above this, whether the sign is open or not. The extrapolated rate is
    /// some hundred times better than its bound, so that 10⁻⁷ keeps rates to 10⁻⁹.
    pub at_least: f64,
    /// Largest number of steps a period.
    pub finest: usize,
}

impl Default for Effort {
    /// Bound 10⁻¹¹ where the sign is open, 10⁻⁷ where it is sure, at most 8192 steps.
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
    /// Its frequency |Im ρ| in radians per unit of time, from 0 to π/T: exponents are known up to multiples of i·2π/T.
    pub frequency: f64,
    /// Steps a period of the finest map used.
    pub steps: usize,
}

/// A constant flow and the tables of its first two levels for one period: ready for any Φ of that period.
#[derive(Clone, Debug)]
pub struct Floquet {
    flow: ConstantFlow,
    period: f64,
    levels: [Steps; 2],
}

impl Floquet {
    /// Prepares the flow for kicks of a period T. The first level has the least power of two of steps, at least
    /// 32, with |λ|h ≤ 1.
    pub fn new(flow: ConstantFlow, period: f64) -> Self {
        let mut count = 32;
        while flow.fastest * period > count as f64 && count < 4096 {
            count *= 2;
        }
        Self::with_steps(flow, period, count)
    }

    /// The same with a given number of steps at the first level, rounded up to a power of two.
    pub fn with_steps(flow: ConstantFlow, period: f64, count: usize) -> Self {
        let count = count.next_power_of_two();
        let levels = [count, 2 * count].map(|count| Steps::new(&flow, period, count));
        Self { flow, period, levels }
    }

    /// Steps a period of the first level.
    pub fn first_steps(&self) -> usize {
        self.levels[0].phases.len()
    }

    /// Multipliers of one period by `count` steps (rounded up to a power of two), without extrapolation.
    ///
    /// # Errors
    /// [`EigenError`] where the map is not finite.
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
    /// [`EigenError`] where a map is not finite.
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
        let branches = candidates(&decomposition, &coarse, &fine);
        let mut known: Option<Vec<Complex64>> = None;
        loop {
            let followed = branches.as_ref().and_then(|branches| {
                let old = match known.take() {
                    Some(known) => Some(known),
                    None => follow_all(branches, &decomposition, &coarse),
                }?;
                let new = follow_all(branches, &decomposition, &fine)?;
                Some((old, new))
            });
            let (found, difference) = if let (Some((old, new)), Some(branches)) =
                (followed, &branches)
            {
                let conditions: Vec<f64> = branches.iter().map(|branch| branch.condition).collect();
                let found = self.extrapolate(&old, &new, &conditions, &decomposition, count);
                known = Some(new);
                found
            } else {
                self.in_full(&coarse, &fine, count)?
            };
            let sure = found.growth_rate.abs() > found.error;
            let decided = sure && found.error <= effort.at_least;
            // What is left is rounding: more steps would not help.
            let rounded = difference <= FLOOR;
            if decided || rounded || found.error <= effort.enough || 2 * count > effort.finest {
                return Ok(found);
            }
            count *= 2;
            coarse = fine;
            fine = map(&Steps::new(&self.flow, self.period, count));
        }
    }

    /// Every exponent that grows by more than its error, one of each conjugate pair, the fastest first.
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
        found.sort_by(|a, b| b.growth_rate.total_cmp(&a.growth_rate));
        Ok(found)
    }

    /// Weight of the difference between two levels in the extrapolation.
    fn weight(&self) -> f64 {
        if self.flow.nilpotent { 1.0 / 15.0 } else { 1.0 / 3.0 }
    }

    /// The leading exponent of two levels, and the largest difference between the levels of a branch.
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
        // A branch that is a little lower with a larger error may be the true leader.
        best.error = best.error.max(highest - best.growth_rate);
        (best, largest_difference)
    }

    /// Both maps solved in full, multipliers paired by nearness.
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

/// The finer map, and for each of its multipliers the nearest of the coarser one, each taken once.
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

/// Conditions of the multipliers beyond a fraction of the largest, 1 for the others. Defective multipliers move by the
/// root of a rounding error, which their difference shows; the condition is capped where that holds.
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

/// Branches that may hold the largest multiplier of the true map; `None` where vectors do not serve.
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
    if chosen.len() > BRANCHES {
        return None;
    }
    chosen.into_iter().map(|i| TrackedMultiplier::new(decomposition, i)).collect()
}

/// Every branch in another map.
fn follow_all(
    branches: &[TrackedMultiplier],
    decomposition: &Decomposition,
    map: &Matrix,
) -> Option<Vec<Complex64>> {
    branches.iter().map(|branch| branch.follow(decomposition, map)).collect()
}
