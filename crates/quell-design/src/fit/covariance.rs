//! Covariance of the estimates, s²(JᵀJ)⁻¹, and which parameters have none.
//!
//! J has one column per parameter inside its bounds, divided by σ. Its columns are scaled to length 1 first, so that JᵀJ has a
//! condition that does not depend on units.

use quell_model::parameter::Parameter;
use quell_numerics::matrix::Matrix;
use quell_numerics::symmetric::{SymmetricMatrix, pencil_eigenvalues};

use super::model::{Estimate, FitModel, Influence};
use super::projection::{FitSamples, Position};
use super::search::{FitMinimum, interior, linear_columns};
use super::statistics::ROUNDING;
use crate::NoStandardError;

/// Condition of the scaled JᵀJ above which its inverse has no digit left.
const SINGULAR: f64 = 1e14;

/// A parameter with a standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimated {
    /// Place among the parameters of the law.
    pub(super) place: usize,
    /// Place of the level that has the same value.
    pub(super) tied: Option<usize>,
}

/// The covariance of estimates.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// The parameters in the order of the rows.
    pub order: Vec<Parameter>,
    /// The matrix, row by row.
    pub matrix: Vec<Vec<f64>>,
    /// Condition of the information matrix JᵀJ with columns of J scaled to length 1: 1 if the parameters are independent; `None`
    /// without parameters, and if the matrix is singular.
    pub condition: Option<f64>,
    pub(super) estimated: Vec<Estimated>,
}

impl Covariance {
    /// Correlation of two of the parameters, by row.
    pub fn correlation(&self, i: usize, j: usize) -> f64 {
        self.matrix[i][j] / (self.matrix[i][i] * self.matrix[j][j]).sqrt()
    }
}

/// The standard error of each parameter of a law, or why it has none.
pub(super) type StandardErrors = Vec<Result<f64, NoStandardError>>;

/// The covariance at a minimum, and the standard errors of the parameters of the law.
pub(super) fn covariance(
    model: &FitModel,
    samples: &FitSamples,
    found: &FitMinimum,
    scale: f64,
) -> (Covariance, StandardErrors) {
    let gradient = model.gradient(&found.values, &samples.speeds);
    let current = &found.projected;
    let mut columns = linear_columns(model, samples, current, &gradient);
    let tied = |place: usize| {
        let (upper, lower) = model.levels().filter(|(upper, _)| *upper == place)?;
        (upper == place && current.position(lower) == Some(Position::Tied)).then_some(lower)
    };
    let mut estimated: Vec<Estimated> =
        interior(current).map(|place| Estimated { place, tied: tied(place) }).collect();
    let size = norm(&samples.weighted(&samples.coefficients));
    for place in model.free() {
        let searched = matches!(model.influence(place), Influence::Velocity | Influence::Exponent);
        if searched && !found.at_limit.contains(&place) {
            let column = samples.weighted(&gradient[place]);
            // Where both levels have the same value but for rounding, no friction depends on the velocity between them.
            if norm(&column) * found.values[place].abs() > ROUNDING * size {
                columns.push(column);
                estimated.push(Estimated { place, tied: None });
            }
        }
    }
    let norms: Vec<f64> = columns.iter().map(|column| norm(column)).collect();
    let visible: Vec<usize> =
        (0..columns.len()).filter(|k| norms[*k].is_finite() && norms[*k] > 0.0).collect();
    let product = |i: usize, j: usize| {
        let both = columns[i].iter().zip(&columns[j]);
        both.map(|(a, b)| a * b).sum::<f64>() / (norms[i] * norms[j])
    };
    let information =
        Matrix::from_fn(visible.len(), visible.len(), |i, j| product(visible[i], visible[j]));
    let condition = condition(&information).filter(|condition| *condition < SINGULAR);
    let inverse = condition.and_then(|_| information.solve(&Matrix::identity(visible.len())));
    let Some(inverse) = inverse else {
        let none = Covariance {
            order: Vec::new(),
            matrix: Vec::new(),
            condition: None,
            estimated: Vec::new(),
        };
        return (none, standard_errors(model, found, &|_| None));
    };
    // Rows in the order of the law.
    let mut rows: Vec<usize> = (0..visible.len()).collect();
    rows.sort_by_key(|row| estimated[visible[*row]].place);
    let entry = |i: usize, j: usize| {
        let mean = 0.5 * (inverse[(i, j)] + inverse[(j, i)]);
        scale * mean / (norms[visible[i]] * norms[visible[j]])
    };
    let matrix: Vec<Vec<f64>> =
        rows.iter().map(|&i| rows.iter().map(|&j| entry(i, j)).collect()).collect();
    let estimated: Vec<Estimated> = rows.iter().map(|row| estimated[visible[*row]]).collect();
    let error = |place: usize| {
        let row = estimated.iter().position(|own| own.place == place)?;
        Some(matrix[row][row].sqrt())
    };
    let standard_errors = standard_errors(model, found, &error);
    let parameters = model.kind().parameters();
    let order = estimated.iter().map(|own| parameters[own.place]).collect();
    (Covariance { order, matrix, condition, estimated }, standard_errors)
}

fn norm(column: &[f64]) -> f64 {
    column.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
}

/// Ratio of the extreme eigenvalues of a symmetric matrix; `None` if it is not positive definite or empty.
fn condition(matrix: &Matrix) -> Option<f64> {
    let size = matrix.rows();
    let (mut own, mut identity) = (SymmetricMatrix::zeros(size), SymmetricMatrix::zeros(size));
    for i in 0..size {
        identity.add(i, i, 1.0);
        for j in 0..=i {
            own.add(i, j, matrix[(i, j)]);
        }
    }
    let values = pencil_eigenvalues(&own, &identity)?;
    let (least, largest) = (*values.first()?, *values.last()?);
    (least > 0.0).then(|| largest / least)
}

/// The standard error of each parameter of the law.
fn standard_errors(
    model: &FitModel,
    found: &FitMinimum,
    error: &dyn Fn(usize) -> Option<f64>,
) -> StandardErrors {
    let parameters = model.kind().parameters();
    let named = |place: usize| parameters[place].key();
    let of = |place: usize| {
        if model.estimates()[place] != Estimate::Free {
            return Err(NoStandardError::Fixed);
        }
        let other = model
            .levels()
            .map(|(upper, lower)| named(if place == lower { upper } else { lower }))
            .unwrap_or_default();
        match found.projected.position(place) {
            Some(Position::Zero) => return Err(NoStandardError::OnZero),
            Some(Position::AtLevel(_) | Position::Tied) => {
                return Err(NoStandardError::OnBoundBy(other));
            }
            _ => {}
        }
        if found.at_limit.contains(&place) {
            return Err(NoStandardError::AtLimit);
        }
        error(place).ok_or(NoStandardError::NoChange)
    };
    (0..parameters.len()).map(of).collect()
}
