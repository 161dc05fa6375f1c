//! Nonlinear least squares by damped Gauss–Newton steps, within bounds.
//!
//! min Σ(yᵢ − fᵢ(p))² from a start: each step solves min ‖r − J δ‖² + λ‖N δ‖² with N the lengths of the columns of J, so that it
//! does not depend on units (Levenberg 1944, Marquardt 1963). A parameter on a bound towards which the sum decreases is held. The
//! minimum is local: the caller chooses the starts.

use crate::least_squares::least_squares;

/// A function of parameters that is compared with data.
pub trait FittedFunction {
    /// Its values, one for each number of the data; `None` where it has none.
    fn values(&mut self, at: &[f64]) -> Option<Vec<f64>>;

    /// Its derivatives by each parameter, given its values.
    fn columns(&mut self, at: &[f64], values: &[f64]) -> Option<Vec<Vec<f64>>>;

    /// Whether the search shall end as it is.
    fn is_stopped(&self) -> bool {
        false
    }
}

/// Options of [`fitted`].
#[derive(Clone, Debug, PartialEq)]
pub struct DampedSearch {
    /// Least value of each parameter.
    pub lower: Vec<f64>,
    /// Largest value of each parameter.
    pub upper: Vec<f64>,
    /// Most steps.
    pub steps: usize,
}

/// A local minimum.
#[derive(Clone, Debug, PartialEq)]
pub struct DampedMinimum {
    /// The parameters.
    pub at: Vec<f64>,
    /// The values of the function.
    pub values: Vec<f64>,
    /// Its derivatives by each parameter.
    pub columns: Vec<Vec<f64>>,
    /// Sum of squares of the residuals.
    pub rss: f64,
    /// Which parameters are held by a bound.
    pub on_bound: Vec<bool>,
    /// Whether the steps have become negligible.
    pub converged: bool,
}

/// A step changes the values by less than this share of the standard deviation of the residuals: far below any standard error.
const NEGLIGIBLE: f64 = 1e-7;

/// Change of the values, relative to their own length, that is rounding.
const ROUNDING: f64 = 1e-13;

/// Damping at the start, and the factors by which it shrinks and grows.
const DAMPING: (f64, f64, f64) = (1e-3, 0.2, 8.0);

/// Damping at which no step reduces the sum further.
const LARGEST_DAMPING: f64 = 1e10;

/// Searches a local minimum; `None` if the function has no values at the start.
pub fn fitted(
    function: &mut impl FittedFunction,
    data: &[f64],
    start: &[f64],
    search: &DampedSearch,
) -> Option<DampedMinimum> {
    let bounded = |at: Vec<f64>| -> Vec<f64> {
        let limits = search.lower.iter().zip(&search.upper);
        at.iter().zip(limits).map(|(value, (low, high))| value.max(*low).min(*high)).collect()
    };
    let at = bounded(start.to_vec());
    let values = function.values(&at)?;
    let rss = sum_of_squares(data, &values).filter(|rss| rss.is_finite())?;
    let columns = function.columns(&at, &values)?;
    let on_bound = vec![false; at.len()];
    let mut found = DampedMinimum { at, values, columns, rss, on_bound, converged: false };
    let mut damping = DAMPING.0;
    for _ in 0..search.steps {
        if function.is_stopped() {
            return Some(found);
        }
        let residuals: Vec<f64> = data.iter().zip(&found.values).map(|(y, f)| y - f).collect();
        found.on_bound = held(&found, &residuals, search);
        let Some((step, change)) = damped_step(&found, &residuals, damping) else {
            found.converged = found.on_bound.iter().all(|held| *held);
            return Some(found);
        };
        let freedom = data.len().saturating_sub(found.at.len()).max(1) as f64;
        let size = found.values.iter().map(|value| value * value).sum::<f64>().sqrt();
        let is_small = change <= NEGLIGIBLE * (found.rss / freedom).sqrt() + ROUNDING * size;
        let next = bounded(found.at.iter().zip(&step).map(|(value, step)| value + step).collect());
        let reached = function.values(&next).and_then(|values| {
            let rss = sum_of_squares(data, &values)?;
            (rss <= found.rss).then_some((values, rss))
        });
        match reached {
            Some((values, rss)) => {
                let columns = function.columns(&next, &values)?;
                let on_bound = found.on_bound;
                found =
                    DampedMinimum { at: next, values, columns, rss, on_bound, converged: false };
                damping *= DAMPING.1;
            }
            None if is_small || damping > LARGEST_DAMPING => {
                found.converged = is_small;
                return Some(found);
            }
            None => damping *= DAMPING.2,
        }
        if is_small {
            found.converged = true;
            break;
        }
    }
    let residuals: Vec<f64> = data.iter().zip(&found.values).map(|(y, f)| y - f).collect();
    found.on_bound = held(&found, &residuals, search);
    Some(found)
}

/// Σ(y − f)²; `None` if the lengths differ or a value is not a number.
fn sum_of_squares(data: &[f64], values: &[f64]) -> Option<f64> {
    if data.len() != values.len() {
        return None;
    }
    let sum: f64 = data.iter().zip(values).map(|(y, f)| (y - f) * (y - f)).sum();
    (!sum.is_nan()).then_some(sum)
}

/// The parameters on a bound beyond which the sum decreases.
fn held(found: &DampedMinimum, residuals: &[f64], search: &DampedSearch) -> Vec<bool> {
    let holds = |place: usize| {
        let slope: f64 = found.columns[place].iter().zip(residuals).map(|(c, r)| c * r).sum();
        let value = found.at[place];
        (value >= search.upper[place] && slope >= 0.0)
            || (value <= search.lower[place] && slope <= 0.0)
    };
    (0..found.at.len()).map(holds).collect()
}

/// The damped step of the parameters that are not held, and ‖J δ‖; `None` if there is no such parameter.
fn damped_step(found: &DampedMinimum, residuals: &[f64], damping: f64) -> Option<(Vec<f64>, f64)> {
    let rows = residuals.len();
    let norm = |column: &[f64]| column.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    let free: Vec<(usize, f64)> = (0..found.at.len())
        .filter(|place| !found.on_bound[*place])
        .map(|place| (place, norm(&found.columns[place])))
        .filter(|(_, size)| *size > 0.0 && size.is_finite())
        .collect();
    if free.is_empty() {
        return None;
    }
    // Columns of length 1, so that the damping is the same for all.
    let columns: Vec<Vec<f64>> = free
        .iter()
        .enumerate()
        .map(|(index, (place, size))| {
            let mut column: Vec<f64> =
                found.columns[*place].iter().map(|entry| entry / size).collect();
            column.resize(rows + free.len(), 0.0);
            column[rows + index] = damping.sqrt();
            column
        })
        .collect();
    let mut target = residuals.to_vec();
    target.resize(rows + free.len(), 0.0);
    let solved = least_squares(&columns, &target)?;
    let mut step = vec![0.0; found.at.len()];
    for ((place, size), own) in free.iter().zip(&solved.solution) {
        step[*place] = own / size;
    }
    let change: f64 = (0..rows)
        .map(|row| columns.iter().zip(&solved.solution).map(|(c, own)| c[row] * own).sum::<f64>())
        .map(|change| change * change)
        .sum();
    Some((step, change.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// a e^{−b t}.
    struct Exponential(Vec<f64>);

    impl FittedFunction for Exponential {
        fn values(&mut self, at: &[f64]) -> Option<Vec<f64>> {
            Some(self.0.iter().map(|t| at[0] * libm::exp(-at[1] * t)).collect())
        }

        fn columns(&mut self, at: &[f64], _: &[f64]) -> Option<Vec<Vec<f64>>> {
            let decay = |t: &f64| libm::exp(-at[1] * t);
            let first = self.0.iter().map(decay).collect();
            Some(vec![first, self.0.iter().map(|t| -at[0] * t * decay(t)).collect()])
        }
    }

    fn problem() -> (Exponential, Vec<f64>) {
        let times: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k)).collect();
        let data = times.iter().map(|t| 3.0 * libm::exp(-0.7 * t)).collect();
        (Exponential(times), data)
    }

    #[test]
    fn an_exact_curve_is_found_to_rounding() {
        let (mut function, data) = problem();
        let search = DampedSearch { lower: vec![0.0; 2], upper: vec![100.0; 2], steps: 100 };
        let found = fitted(&mut function, &data, &[1.0, 3.0], &search).expect("values");
        assert!(found.converged && found.rss < 1e-24, "{found:?}");
        assert!((found.at[0] - 3.0).abs() < 1e-11 && (found.at[1] - 0.7).abs() < 1e-11);
        assert_eq!(found.on_bound, [false, false]);
    }

    #[test]
    fn a_bound_holds_its_parameter_and_the_other_one_is_least_there() {
        let (mut function, data) = problem();
        let search = DampedSearch { lower: vec![0.0, 1.0], upper: vec![100.0; 2], steps: 100 };
        let found = fitted(&mut function, &data, &[1.0, 3.0], &search).expect("values");
        assert_eq!(found.at[1], 1.0);
        assert_eq!(found.on_bound, [false, true]);
        // The best factor of a fixed exponential is a quotient of sums.
        let decay: Vec<f64> = function.0.iter().map(|t| libm::exp(-t)).collect();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let best = product(&data, &decay) / product(&decay, &decay);
        assert!((found.at[0] / best - 1.0).abs() < 1e-7);
    }
}
