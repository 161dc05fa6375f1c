//! A smooth approximant of measured friction: a sum of decaying exponentials,
//!
//! ```text
//! μ(u) = c + Σ aᵢ e^(−u/sᵢ),   s₁ < … < sₙ in equal ratios,   n ≤ 4
//! ```
//!
//! Scheme: for given decay lengths the coefficients are linear least squares; the first and the last decay
//! length are found by a grid and a compass search on the sum of squares (variable projection, Golub and
//! Pereyra 1973). The n = 1…4 with the smallest error at left-out samples is chosen, with fewer terms if
//! more reduce the error by less than a tenth. If the fit would start above a given static level, it is pinned to that level.
//!
//! Why exponentials and not Chebyshev polynomials or a rational function: they are bounded by construction,
//! fit both falls and rises, have no poles, and need one recurrence per term. Beyond the largest sampled
//! speed the trend decays towards the constant c over another interval of that length (no decay length is longer);
//! no decay length is shorter than the smallest sampled speed. Measured: (2.8) is recovered to 10⁻¹³; a Gaussian
//! with a viscous part to 1 % of its fall; the cubic (2.7) up to 1.5 v_m to 1.2·10⁻³. The latter would be 1.5·10⁻² with decay
//! lengths up to half the range, and 2.5·10⁻⁴ with lengths up to twice the range, but then it rises to μ = 11 beyond.

use std::fmt::Write as _;

use quell_numerics::interval::RealInterval;
use quell_numerics::least_squares::least_squares;

/// Maximum number of terms; more terms are slower and fit noise.
pub const MOST_TERMS: usize = 4;

/// Minimum number of distinct speeds.
pub const FEWEST: usize = 5;

/// Shortest decay length in units of the largest speed, if samples are that close to rest.
const SHORTEST: f64 = 1.0 / 500.0;

/// Longest decay length in units of the largest speed.
const LONGEST: f64 = 1.0;

/// Least ratio of neighbouring decay lengths: closer ones can hardly be distinguished from samples, and their terms cancel.
const LEAST_RATIO: f64 = 1.5;

/// Number of grid points along each decay length.
const GRID: usize = 20;

/// Halvings of the compass search.
const HALVINGS: u32 = 36;

/// A further term must reduce the error to less than this fraction.
const WORTH_A_TERM: f64 = 0.9;

/// An error at left-out samples, relative to the coefficients, below which no more terms are added.
const EXACT: f64 = 1e-9;

/// The approximant with its error over the samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// c, the coefficient far beyond the samples.
    pub limit: f64,
    /// aᵢ and sᵢ, the shortest decay first.
    pub terms: Vec<(f64, f64)>,
    /// Largest |sample − fit|.
    pub largest_error: f64,
    /// Root mean square of sample − fit.
    pub rms_error: f64,
    /// The same at samples that were left out, one at a time.
    pub left_out_error: f64,
    /// Whether μ(0⁺) was fixed at the static level.
    pub pinned: bool,
    /// Number of samples.
    pub samples: usize,
    /// Smallest and largest slip speed of the samples.
    pub range: RealInterval,
}

impl Fit {
    /// μ(0⁺).
    pub fn start(&self) -> f64 {
        self.limit + self.terms.iter().map(|(amplitude, _)| amplitude).sum::<f64>()
    }

    /// The fit as a formula in v.
    pub fn formula(&self) -> String {
        let mut text = format!("{:?}", self.limit);
        for (amplitude, length) in &self.terms {
            let sign = if *amplitude < 0.0 { '-' } else { '+' };
            // UNWRAP: writing to a String does not fail.
            write!(text, " {sign} {:?}*exp(-abs(v)/{length:?})", amplitude.abs()).unwrap();
        }
        text
    }
}

/// Fits samples (speed ≥ 0, coefficient), checked already, with `terms` terms or the best number.
/// `None` if the samples do not determine a fit.
pub(super) fn fit(
    samples: &[(f64, f64)],
    static_coefficient: Option<f64>,
    terms: Option<usize>,
) -> Option<Fit> {
    let counts = terms.map_or(1..=MOST_TERMS, |count| count..=count);
    let size = samples.iter().map(|(_, value)| value.abs()).sum::<f64>() / samples.len() as f64;
    let mut best: Option<Fit> = None;
    for count in counts {
        let free = Problem { samples, count, pin: None }.solved();
        let above =
            |fit: &Fit| static_coefficient.filter(|level| fit.start() > level * (1.0 + 1e-12));
        let found = match free.as_ref().map(above) {
            Some(Some(level)) => Problem { samples, count, pin: Some(level) }.solved(),
            _ => free,
        };
        let Some(found) = found else { continue };
        let better = best.as_ref().is_none_or(|best| {
            found.left_out_error < WORTH_A_TERM * best.left_out_error
                && best.left_out_error > EXACT * size
        });
        if better {
            best = Some(found);
        }
    }
    best
}

struct Problem<'s> {
    samples: &'s [(f64, f64)],
    count: usize,
    /// The fixed value of μ(0⁺), if any.
    pin: Option<f64>,
}

impl Problem<'_> {
    /// Decay lengths from the logarithms of the first and the last.
    fn lengths(&self, [first, last]: [f64; 2]) -> Vec<f64> {
        (0..self.count)
            .map(|term| {
                let share =
                    if self.count > 1 { term as f64 / (self.count - 1) as f64 } else { 0.0 };
                libm::exp(first + share * (last - first))
            })
            .collect()
    }

    /// The fit with given decay lengths.
    fn with_lengths(&self, ends: [f64; 2]) -> Option<Fit> {
        let lengths = self.lengths(ends);
        let decay = |length: f64| {
            let shift = if self.pin.is_some() { 1.0 } else { 0.0 };
            self.samples.iter().map(move |(u, _)| libm::exp(-u / length) - shift).collect()
        };
        let mut columns: Vec<Vec<f64>> = lengths.iter().map(|&length| decay(length)).collect();
        if self.pin.is_none() {
            columns.push(vec![1.0; self.samples.len()]);
        }
        let base = self.pin.unwrap_or(0.0);
        let data: Vec<f64> = self.samples.iter().map(|(_, value)| value - base).collect();
        let found = least_squares(&columns, &data)?;
        let amplitudes = &found.solution[..self.count];
        let limit = match self.pin {
            Some(level) => level - amplitudes.iter().sum::<f64>(),
            None => found.solution[self.count],
        };
        let count = self.samples.len() as f64;
        let rms = |squares: f64| (squares / count).sqrt();
        let left_out = found.residuals.iter().zip(&found.leverages).map(|(residual, leverage)| {
            let alone = residual / (1.0 - leverage).max(1e-6);
            alone * alone
        });
        let (low, high) = range(self.samples);
        Some(Fit {
            limit,
            terms: amplitudes.iter().copied().zip(lengths).collect(),
            largest_error: found.residuals.iter().fold(0.0, |m, r| r.abs().max(m)),
            rms_error: rms(found.residuals.iter().map(|r| r * r).sum()),
            left_out_error: rms(left_out.sum()),
            pinned: self.pin.is_some(),
            samples: self.samples.len(),
            range: RealInterval::new(low, high),
        })
    }

    fn solved(&self) -> Option<Fit> {
        // The decay lengths count as one or two unknowns.
        let numbers = self.count + self.count.min(2) + usize::from(self.pin.is_none());
        if numbers > self.samples.len() {
            return None;
        }
        let (low, high) = range(self.samples);
        let shortest = libm::log((SHORTEST * high).max(low).min(0.25 * high));
        let longest = libm::log(LONGEST * high);
        let apart = (self.count - 1) as f64 * libm::log(LEAST_RATIO);
        let allowed =
            |[first, last]: [f64; 2]| first >= shortest && last <= longest && last - first >= apart;
        let error = |ends: [f64; 2]| {
            let found = if allowed(ends) { self.with_lengths(ends) } else { None };
            found.map_or(f64::INFINITY, |fit| fit.rms_error)
        };
        let place = |k: usize| shortest + (longest - shortest) * k as f64 / (GRID - 1) as f64;
        let mut best = (f64::INFINITY, [shortest, longest]);
        for i in 0..GRID {
            let others = if self.count == 1 { i..=i } else { i + 1..=GRID - 1 };
            for j in others {
                let ends = [place(i), place(j)];
                let found = error(ends);
                if found < best.0 {
                    best = (found, ends);
                }
            }
        }
        let mut step = (longest - shortest) / (GRID - 1) as f64;
        let moves: &[[f64; 2]] = if self.count == 1 {
            &[[1.0, 1.0], [-1.0, -1.0]]
        } else {
            &[[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], [1.0, 1.0], [-1.0, -1.0]]
        };
        for _ in 0..HALVINGS {
            // A few moves of each length; the valley may be long.
            for _ in 0..4 {
                let around = moves.iter().map(|way| {
                    let ends = [best.1[0] + step * way[0], best.1[1] + step * way[1]];
                    (error(ends), ends)
                });
                let next =
                    around.fold(best, |best, next| if next.0 < best.0 { next } else { best });
                if next.0 >= best.0 {
                    break;
                }
                best = next;
            }
            step *= 0.5;
        }
        self.with_lengths(best.1).filter(|_| best.0.is_finite())
    }
}

fn range(samples: &[(f64, f64)]) -> (f64, f64) {
    samples.iter().fold((f64::INFINITY, 0.0), |(low, high), (u, _)| (low.min(*u), u.max(high)))
}
