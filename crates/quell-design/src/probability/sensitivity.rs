//! Sobol indices: the share of the variance of a result that each parameter causes.
//!
//! The estimators are those of Jansen ("Analysis of variance designs for model output", 1999) with the variance from the same pairs
//! of points, so that a single parameter has both indices equal to 1 exactly.

/// Number of parts of a sample from which standard errors are estimated.
const PARTS: usize = 20;

/// Relative difference of results that rounding can cause.
const ROUNDING: f64 = 1e-11;

/// An estimate with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SobolEstimate {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// Sobol indices of one parameter or of one group of correlated parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SobolIndices {
    /// Share of the variance that the parameter causes alone.
    pub first: SobolEstimate,
    /// Share of the variance that it causes alone and together with others.
    pub total: SobolEstimate,
}

/// Sobol indices from the results at (first point, second point, first point with this parameter of the second); `None` where the
/// result does not vary, or with fewer points than twice the parts from which standard errors are estimated.
pub fn sobol_indices(results: &[(f64, f64, f64)]) -> Option<SobolIndices> {
    if results.len() < 2 * PARTS {
        return None;
    }
    let of = |results: &[(f64, f64, f64)]| -> Option<[f64; 2]> {
        let mut sums = [0.0; 3];
        for (first, second, mixed) in results {
            sums[0] += (first - second).powi(2);
            sums[1] += (second - mixed).powi(2);
            sums[2] += (first - mixed).powi(2);
        }
        let [all, others, own] = sums;
        (all > 0.0).then(|| [1.0 - others / all, own / all])
    };
    let whole = of(results)?;
    let varies = |(first, second, _): &(f64, f64, f64)| {
        (first - second).abs() > ROUNDING * first.abs().max(second.abs())
    };
    if !results.iter().any(varies) {
        return None;
    }
    let length = results.len() / PARTS;
    let parts: Vec<[f64; 2]> = results.chunks_exact(length).filter_map(of).collect();
    let estimate = |which: usize| {
        let squares = parts.iter().map(|part| (part[which] - whole[which]).powi(2));
        let count = parts.len() as f64;
        let error = (squares.sum::<f64>() / (count * (count - 1.0).max(1.0))).sqrt();
        SobolEstimate { value: whole[which], error }
    };
    Some(SobolIndices { first: estimate(0), total: estimate(1) })
}

#[cfg(test)]
mod tests {
    use super::super::{Distribution, JointDistribution};
    use super::*;

    fn indices(result: impl Fn(&[f64]) -> f64, parameters: usize) -> Vec<SobolIndices> {
        let uniform = Distribution::Uniform { from: -1.0, to: 1.0 };
        let row = |i: usize| (0..parameters).map(|j| f64::from(u8::from(i == j))).collect();
        let unit: Vec<Vec<f64>> = (0..parameters).map(row).collect();
        let joint = JointDistribution::new(vec![uniform; parameters], &unit).expect("independent");
        let points: Vec<_> = (0..20_000).map(|number| joint.sample(3, number)).collect();
        let of = |group: usize| {
            let triple = |at: &super::super::SampledPoints| {
                (result(&at.first), result(&at.second), result(&at.mixed[group]))
            };
            sobol_indices(&points.iter().map(triple).collect::<Vec<_>>()).expect("it varies")
        };
        (0..parameters).map(of).collect()
    }

    /// x + 2y: shares 1/5 and 4/5; xy: no first-order index, total indices 1.
    #[test]
    fn known_indices() {
        let near = |estimate: SobolEstimate, exact: f64| {
            assert!((estimate.value - exact).abs() < 4.0 * estimate.error, "{estimate:?} {exact}");
            assert!(estimate.error < 0.02);
        };
        let sum = indices(|x| x[0] + 2.0 * x[1], 2);
        for (found, exact) in sum.iter().zip([0.2, 0.8]) {
            near(found.first, exact);
            near(found.total, exact);
        }
        for found in indices(|x| x[0] * x[1], 2) {
            near(found.first, 0.0);
            near(found.total, 1.0);
        }
    }

    #[test]
    fn one_parameter_causes_all() {
        let [found] = indices(|x| libm::exp(x[0]), 1)[..] else { unreachable!() };
        assert_eq!((found.first.value, found.total.value), (1.0, 1.0));
        assert_eq!((found.first.error, found.total.error), (0.0, 0.0));
        assert_eq!(sobol_indices(&[(1.0, 1.0, 1.0); 100]), None);
        assert_eq!(sobol_indices(&[(1.0, 1.0 + 1e-15, 1.0); 100]), None);
        assert_eq!(sobol_indices(&[(1.0, 2.0, 3.0); 10]), None);
    }
}
