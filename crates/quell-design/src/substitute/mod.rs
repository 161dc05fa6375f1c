//! Friction models of other programs fitted to a curve of friction, with their largest errors.
//!
//! A program that knows no dither can still simulate slow motion under dither, if its friction is the averaged one. A table over
//! the slip speed takes any curve; smooth models with three numbers take only some, and the error says which.
//!
//! | file | model |
//! |---|---|
//! | `slip_rate_table` | straight lines between few points (Abaqus `*FRICTION`) |
//! | `exponential_decay` | `μ_k + (μ_s − μ_k)e^{−dv}` (Abaqus `*FRICTION, EXPONENTIAL DECAY`) |
//! | `translational_friction` | Stribeck, Coulomb and viscous parts (Simscape Translational Friction) |

mod exponential_decay;
mod slip_rate_table;
mod translational_friction;

use quell_numerics::least_squares::least_squares;
use quell_numerics::roots::{Closeness, minimise};

pub use exponential_decay::ExponentialDecay;
pub use slip_rate_table::SlipRateTable;
pub use translational_friction::TranslationalFriction;

/// Friction coefficients over the slip speed.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedCurve {
    /// Slip speeds, ascending, the first 0; its coefficient is the limit from above.
    pub speeds: Vec<f64>,
    /// Friction coefficients μ.
    pub coefficients: Vec<f64>,
}

/// Points per decade of the search for the parameter that is not linear.
const PER_DECADE: i32 = 20;

impl SpeedCurve {
    /// The largest speed.
    fn fastest(&self) -> f64 {
        self.speeds.last().copied().unwrap_or_default()
    }

    /// The least positive speed.
    fn slowest(&self) -> f64 {
        self.speeds.get(1).copied().unwrap_or_default()
    }

    /// The largest difference from a model at points for which `counts`.
    fn largest_error(&self, model: impl Fn(f64) -> f64, counts: impl Fn(f64) -> bool) -> f64 {
        let points =
            self.speeds.iter().zip(&self.coefficients).filter(|(speed, _)| counts(**speed));
        points.map(|(speed, coefficient)| (model(*speed) - coefficient).abs()).fold(0.0, f64::max)
    }

    /// The speeds for which `counts`, and the weighted coefficients there.
    ///
    /// A point stands for half the distance to each of its neighbours, so that a cluster of points weighs no more than the
    /// interval that it covers.
    fn weighted(&self, counts: impl Fn(f64) -> bool) -> WeightedCurve {
        let last = self.speeds.len() - 1;
        let (mut speeds, mut roots, mut data) = (Vec::new(), Vec::new(), Vec::new());
        for (i, &speed) in self.speeds.iter().enumerate().filter(|(_, speed)| counts(**speed)) {
            let width = self.speeds[(i + 1).min(last)] - self.speeds[i.saturating_sub(1)];
            let root = width.sqrt();
            speeds.push(speed);
            roots.push(root);
            data.push(root * self.coefficients[i]);
        }
        WeightedCurve { speeds, roots, data }
    }
}

/// A weighted problem of least squares.
struct WeightedCurve {
    speeds: Vec<f64>,
    /// Square roots of the weights.
    roots: Vec<f64>,
    data: Vec<f64>,
}

impl WeightedCurve {
    /// The factors ≥ 0 of functions of the speed that fit best, and the sum of squares that remains.
    ///
    /// With so few functions each subset is tried: the best solution is that of the functions with factors above 0, among which
    /// it is an ordinary problem.
    fn factors<const N: usize>(&self, functions: [&dyn Fn(f64) -> f64; N]) -> ([f64; N], f64) {
        let columns: Vec<Vec<f64>> = functions
            .iter()
            .map(|function| {
                self.speeds.iter().zip(&self.roots).map(|(v, root)| root * function(*v)).collect()
            })
            .collect();
        let mut best = ([0.0; N], self.data.iter().map(|b| b * b).sum::<f64>());
        for subset in 1..1usize << N {
            let used: Vec<usize> = (0..N).filter(|j| subset >> j & 1 == 1).collect();
            let chosen: Vec<Vec<f64>> = used.iter().map(|j| columns[*j].clone()).collect();
            let Some(found) = least_squares(&chosen, &self.data) else { continue };
            let rest: f64 = found.residuals.iter().map(|r| r * r).sum();
            if found.solution.iter().all(|factor| *factor >= 0.0) && rest < best.1 {
                let mut factors = [0.0; N];
                for (j, factor) in used.into_iter().zip(found.solution) {
                    factors[j] = factor;
                }
                best = (factors, rest);
            }
        }
        best
    }
}

/// The argument between two positive ends at which a function is least: a grid over the logarithm, refined about its best
/// point.
fn least_over(mut function: impl FnMut(f64) -> f64, from: f64, to: f64) -> f64 {
    let (from, to) = (libm::log10(from), libm::log10(to));
    #[expect(clippy::cast_possible_truncation, reason = "a few hundred points")]
    let steps = ((to - from) * f64::from(PER_DECADE)).ceil().max(2.0) as i32;
    let place = |k: i32| from + (to - from) * f64::from(k) / f64::from(steps);
    let mut at = |place: f64| function(libm::exp10(place));
    let mut best = (0, f64::INFINITY);
    for k in 0..=steps {
        let value = at(place(k));
        if value < best.1 {
            best = (k, value);
        }
    }
    let ends = (place((best.0 - 1).max(0)), place((best.0 + 1).min(steps)));
    let found = minimise(&mut at, ends.0, ends.1, Closeness { relative: 1e-9, absolute: 1e-9 });
    libm::exp10(match found {
        Ok(found) if found.value < best.1 => found.location,
        _ => place(best.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(law: impl Fn(f64) -> f64) -> SpeedCurve {
        let speeds: Vec<f64> = (0..=200).map(|k| f64::from(k) * 0.005).collect();
        let coefficients = speeds.iter().map(|v| law(*v)).collect();
        SpeedCurve { speeds, coefficients }
    }

    /// Curves made by a model give back its numbers.
    #[test]
    fn planted_numbers_are_found() {
        let decay = |v: f64| 0.2 + 0.3 * (-7.0 * v).exp();
        let found = ExponentialDecay::fitted(&curve(decay));
        assert!((found.static_coefficient - 0.5).abs() < 1e-6, "{found:?}");
        assert!((found.kinetic_coefficient - 0.2).abs() < 1e-6, "{found:?}");
        assert!((found.decay - 7.0).abs() < 1e-4 && found.largest_error < 1e-6, "{found:?}");

        let planted = TranslationalFriction {
            breakaway: 0.45,
            coulomb: 0.3,
            viscous: 0.05,
            breakaway_velocity: 0.13,
            largest_error: 0.0,
            slowest: 0.0,
        };
        let found = TranslationalFriction::fitted(&curve(|v| planted.coefficient(v)));
        for (found, wanted) in [
            (found.breakaway, 0.45),
            (found.coulomb, 0.3),
            (found.viscous, 0.05),
            (found.breakaway_velocity, 0.13),
        ] {
            assert!((found / wanted - 1.0).abs() < 1e-4, "{found} {wanted}");
        }
        assert!(found.largest_error < 1e-6, "{found:?}");
    }

    /// Parameters that the programs refuse are never fitted: none is below 0, and breakaway is at least Coulomb friction.
    #[test]
    fn a_rising_curve_has_no_negative_numbers() {
        let rising = curve(|v| (v / 0.4).min(1.0));
        let decay = ExponentialDecay::fitted(&rising);
        assert!(decay.static_coefficient >= decay.kinetic_coefficient, "{decay:?}");
        // The best constant is in error by at least half the range of the curve.
        assert!(decay.kinetic_coefficient >= 0.0 && decay.largest_error > 0.5, "{decay:?}");
        let smooth = TranslationalFriction::fitted(&rising);
        assert!(smooth.breakaway >= smooth.coulomb && smooth.viscous >= 0.0, "{smooth:?}");
        assert!(smooth.largest_error < 0.2, "{smooth:?}");
    }

    #[test]
    fn a_table_has_few_points_within_its_tolerance() {
        let law =
            |v: f64| if v < 0.5 { (v / 0.5).asin() * std::f64::consts::FRAC_2_PI } else { 1.0 };
        let known = curve(law);
        let table = SlipRateTable::of(&known, 1e-3);
        assert!(table.largest_error <= 1e-3 && table.points.len() < 40, "{}", table.points.len());
        assert_eq!(table.points[0], (0.0, 0.0));
        assert_eq!(table.points.last().map(|point| point.0), Some(1.0));
        for (speed, coefficient) in known.speeds.iter().zip(&known.coefficients) {
            assert!((table.coefficient(*speed) - coefficient).abs() <= table.largest_error);
        }
        // Straight lines need only their ends, and the value beyond them stays.
        let line = SlipRateTable::of(&curve(|v| 0.1 + v), 1e-3);
        assert_eq!(line.points.len(), 2);
        assert_eq!((line.coefficient(0.5), line.coefficient(3.0)), (0.6, 1.1));
    }
}
