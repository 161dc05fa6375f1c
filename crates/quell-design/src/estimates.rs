//! Estimates of a nonlinear fit: standard errors, covariance, and the directions that the data do not determine.
//!
//! The covariance is s²(JᵀJ)⁻¹ with s² = RSS/(n − p). The columns of J are scaled to length 1 first, so that the eigenvalues of JᵀJ do
//! not depend on units: 1 each if the parameters are independent. An eigenvector of an eigenvalue near 0 is a combination of parameters
//! that hardly changes the values.
//!
//! A standard error is that of a model which describes the data. Where the model leaves more than half of their variance, no parameter has
//! one.

use quell_numerics::damped_least_squares::DampedMinimum;
use quell_numerics::gram::{Eigenpair, gram_eigenpairs};
use quell_numerics::order::descending_by;

use crate::{ExactFit, NoStandardError};

/// Ratio of the least to the largest eigenvalue below which the inverse has no digit left.
const SINGULAR: f64 = 1e-14;

/// Ratio below which a combination is nearly undetermined: its error is a thousand times that of the best one.
const NEARLY_SINGULAR: f64 = 1e-6;

/// Share of a parameter in an eigenvector of length 1 below which it is not named.
const NAMED: f64 = 0.1;

/// Share in an undetermined combination above which a parameter has no standard error: rounding of the eigenvectors is far below.
const INVOLVED: f64 = 1e-4;

/// Share of the variance of the data below which a model does not explain them.
const EXPLAINS: f64 = 0.5;

/// A combination of parameters that the data hardly determine.
#[derive(Clone, Debug, PartialEq)]
pub struct WeakCombination {
    /// Eigenvalue over the largest one.
    pub ratio: f64,
    /// Places of parameters with their shares, the largest first. A share is of the parameter over the change that its column has.
    pub shares: Vec<(usize, f64)>,
}

/// Estimates of all parameters of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimates {
    /// Values of all parameters.
    pub values: Vec<f64>,
    /// The standard errors, or the reason why one is missing.
    pub errors: Vec<Result<f64, NoStandardError>>,
    /// Places of the parameters with standard errors, in the order of the covariance.
    pub order: Vec<usize>,
    /// The covariance, row by row.
    pub covariance: Vec<Vec<f64>>,
    /// Condition of the scaled JᵀJ; `None` if it is singular or there is no parameter.
    pub condition: Option<f64>,
    /// Combinations that the data hardly determine.
    pub weak: Vec<WeakCombination>,
    /// Number of data.
    pub count: usize,
    /// Number of estimated parameters, those on bounds included.
    pub free: usize,
    /// Sum of squares of the residuals.
    pub rss: f64,
    /// Share of the variance of the data that the model explains, 1 − RSS/Σ(y − ȳ)²: negative where a horizontal line fits better;
    /// `None` of data that do not vary.
    pub explained: Option<f64>,
}

/// Which parameters are estimated, and which are fixed.
#[derive(Clone, Debug, PartialEq)]
pub enum Freedom {
    /// Estimated.
    Free,
    /// The value is given.
    Fixed,
}

impl Estimates {
    /// From a minimum over data.
    pub fn of(found: &DampedMinimum, data: &[f64], freedom: &[Freedom]) -> Self {
        let count = found.values.len();
        let free = freedom.iter().filter(|one| **one == Freedom::Free).count();
        let norms: Vec<f64> = found
            .columns
            .iter()
            .map(|column| column.iter().map(|entry| entry * entry).sum::<f64>().sqrt())
            .collect();
        let errors: Vec<Result<f64, NoStandardError>> = (0..found.at.len())
            .map(|place| match (&freedom[place], found.on_bound[place], norms[place]) {
                (Freedom::Fixed, ..) => Err(NoStandardError::Fixed),
                (_, true, _) => Err(NoStandardError::OnBound),
                (_, _, norm) if !(norm > 0.0 && norm.is_finite()) => Err(NoStandardError::NoEffect),
                _ => Ok(0.0),
            })
            .collect();
        let visible: Vec<usize> =
            (0..errors.len()).filter(|place| errors[*place].is_ok()).collect();
        let scaled = |place: &usize| {
            found.columns[*place].iter().map(|entry| entry / norms[*place]).collect()
        };
        let columns: Vec<Vec<f64>> = visible.iter().map(scaled).collect();
        let pairs = gram_eigenpairs(&columns).unwrap_or_default();
        let mut estimates = Self {
            values: found.at.clone(),
            errors,
            order: Vec::new(),
            covariance: Vec::new(),
            condition: None,
            weak: Vec::new(),
            count,
            free,
            rss: found.rss,
            explained: explained(data, found.rss),
        };
        estimates.resolve(&pairs, &visible, &norms);
        if !estimates.explain() {
            estimates.order.clear();
            estimates.covariance.clear();
            for error in estimates.errors.iter_mut().filter(|error| error.is_ok()) {
                *error = Err(NoStandardError::NotExplained);
            }
        }
        estimates
    }

    /// Whether the model explains the data: at least half of their variance, if they vary.
    pub fn explain(&self) -> bool {
        self.explained.is_none_or(|share| share >= EXPLAINS)
    }

    /// Covariance and weak combinations from the eigenpairs of the scaled information.
    fn resolve(&mut self, pairs: &[Eigenpair], visible: &[usize], norms: &[f64]) {
        let Some(largest) = pairs.last().map(|pair| pair.value).filter(|value| *value > 0.0) else {
            return;
        };
        let (lost, kept): (Vec<&Eigenpair>, Vec<&Eigenpair>) =
            pairs.iter().partition(|pair| pair.value < SINGULAR * largest);
        for pair in pairs.iter().filter(|pair| pair.value < NEARLY_SINGULAR * largest) {
            let mut shares: Vec<(usize, f64)> =
                visible.iter().copied().zip(pair.vector.iter().copied()).collect();
            shares.retain(|(_, share)| share.abs() > NAMED);
            descending_by(&mut shares, |a| a.1.abs());
            self.weak.push(WeakCombination { ratio: (pair.value / largest).max(0.0), shares });
        }
        self.condition = lost.is_empty().then(|| largest / pairs[0].value);
        let known = |row: usize| lost.iter().all(|pair| pair.vector[row].abs() < INVOLVED);
        let rows: Vec<usize> = (0..visible.len()).filter(|row| known(*row)).collect();
        let scale = self.rss / self.count.saturating_sub(self.free).max(1) as f64;
        let entry = |i: usize, j: usize| {
            let inverse: f64 =
                kept.iter().map(|pair| pair.vector[i] * pair.vector[j] / pair.value).sum();
            scale * inverse / (norms[visible[i]] * norms[visible[j]])
        };
        self.covariance =
            rows.iter().map(|&i| rows.iter().map(|&j| entry(i, j)).collect()).collect();
        self.order = rows.iter().map(|row| visible[*row]).collect();
        for (row, place) in visible.iter().enumerate() {
            self.errors[*place] = if known(row) {
                Ok(entry(row, row).max(0.0).sqrt())
            } else {
                Err(NoStandardError::OnlyTogether)
            };
        }
    }

    /// The residual standard deviation √(RSS/(n − p)).
    pub fn residual(&self) -> f64 {
        (self.rss / self.count.saturating_sub(self.free).max(1) as f64).sqrt()
    }

    /// Correlation of two parameters by their rows in the covariance.
    pub fn correlation(&self, i: usize, j: usize) -> f64 {
        self.covariance[i][j] / (self.covariance[i][i] * self.covariance[j][j]).sqrt()
    }

    /// Akaike's information criterion n ln(RSS/n) + n(1 + ln 2π) + 2(p + 1).
    ///
    /// # Errors
    /// The curve passes through every datum, so that the criterion has no lower bound.
    pub fn aic(&self) -> Result<f64, ExactFit> {
        if self.rss <= 0.0 {
            return Err(ExactFit::Samples);
        }
        let count = self.count as f64;
        let likelihood =
            count * libm::log(self.rss / count) + count * (1.0 + libm::log(std::f64::consts::TAU));
        Ok(likelihood + 2.0 * (self.free + 1) as f64)
    }
}

/// 1 − RSS/Σ(y − ȳ)².
fn explained(data: &[f64], rss: f64) -> Option<f64> {
    let mean = data.iter().sum::<f64>() / data.len() as f64;
    let total: f64 = data.iter().map(|value| (value - mean) * (value - mean)).sum();
    (total > 0.0).then(|| 1.0 - rss / total)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn minimum(columns: Vec<Vec<f64>>) -> DampedMinimum {
        let count = columns[0].len();
        DampedMinimum {
            at: vec![1.0; columns.len()],
            values: vec![0.0; count],
            on_bound: vec![false; columns.len()],
            columns,
            rss: (count - 2) as f64,
            converged: true,
        }
    }

    #[test]
    fn errors_of_a_line_are_the_textbook_ones() {
        // y = a + b x on x = 0 … 8 with s = 1: σ_b² = 1/Σ(x − x̄)² = 1/60, σ_a² = 1/9 + x̄²/60.
        let x: Vec<f64> = (0..9).map(f64::from).collect();
        // Of the variance of the data, 60 · 9, the residuals of 7 leave little.
        let data: Vec<f64> = x.iter().map(|x| 3.0 * x).collect();
        let line = minimum(vec![vec![1.0; 9], x]);
        let found = Estimates::of(&line, &data, &[Freedom::Free, Freedom::Free]);
        assert!((found.explained.expect("they vary") - (1.0 - 7.0 / 540.0)).abs() < 1e-14);
        let error = |place: usize| found.errors[place].expect("determined");
        assert!((error(1) - (1.0_f64 / 60.0).sqrt()).abs() < 1e-14);
        assert!((error(0) - (1.0 / 9.0 + 16.0 / 60.0_f64).sqrt()).abs() < 1e-13);
        assert!((found.covariance[0][1] + 4.0 / 60.0).abs() < 1e-14);
        assert!(found.weak.is_empty());
    }

    #[test]
    fn parameters_known_only_together_are_named_and_others_keep_their_errors() {
        let x: Vec<f64> = (0..9).map(f64::from).collect();
        let twice = x.iter().map(|x| 2.0 * x).collect();
        let columns = vec![vec![1.0; 9], x, twice];
        let data: Vec<f64> = (0..9).map(f64::from).collect();
        let found = Estimates::of(&minimum(columns), &data, &[const { Freedom::Free }; 3]);
        assert!(found.errors[0].is_ok() && found.errors[1].is_err() && found.errors[2].is_err());
        let places: Vec<usize> = found.weak[0].shares.iter().map(|(place, _)| *place).collect();
        assert!(places.len() == 2 && places.contains(&1) && places.contains(&2));
        assert_eq!(found.order, [0]);
        assert_eq!(found.condition, None);
    }

    #[test]
    fn a_model_that_a_horizontal_line_beats_has_no_standard_errors() {
        let x: Vec<f64> = (0..9).map(f64::from).collect();
        let line = minimum(vec![vec![1.0; 9], x]);
        let flat: Vec<f64> = (0..9).map(|k| f64::from(k % 2)).collect();
        let found = Estimates::of(&line, &flat, &[Freedom::Free, Freedom::Free]);
        // Σ(y − ȳ)² is 20/9, and the residuals are 7.
        assert!((found.explained.expect("they vary") - (1.0 - 63.0 / 20.0)).abs() < 1e-14);
        assert!(!found.explain() && found.order.is_empty() && found.covariance.is_empty());
        assert_eq!(found.errors, [Err(NoStandardError::NotExplained); 2]);
        assert_eq!(
            Estimates::of(&line, &[1.0; 9], &[Freedom::Free, Freedom::Free]).explained,
            None
        );
    }
}
