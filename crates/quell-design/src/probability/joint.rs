//! The joint distribution of several parameters.
//!
//! Correlated parameters are functions of correlated standard normal numbers (a Gaussian copula). Of normal parameters, and of the
//! logarithms of lognormal ones, the correlation is that of the parameters.

use quell_numerics::random::SplitMix;

use super::Distribution;

/// Pivot of a correlation matrix below which its row is a combination of earlier ones; also the rounding that a symmetric matrix
/// may have.
const ROUNDING: f64 = 1e-10;

/// Why a matrix is not a correlation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoCorrelation {
    /// It does not have a row and a column for every parameter.
    Size,
    /// Two entries across the diagonal differ, or an entry of the diagonal is not 1.
    NotSymmetric,
    /// No parameters can have it: a combination of them would have a negative variance.
    NotPositive,
}

impl std::fmt::Display for NoCorrelation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Size => "it needs a row and a column for every parameter",
            Self::NotSymmetric => "it must be symmetric, with ones in the diagonal of a correlation",
            Self::NotPositive => {
                "a combination of the parameters would have a negative variance: its eigenvalues must not be negative"
            }
        })
    }
}

impl std::error::Error for NoCorrelation {}

/// Parameters with their joint distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct JointDistribution {
    distributions: Vec<Distribution>,
    /// Rows of the lower triangular factor of the correlation.
    factor: Vec<Vec<f64>>,
    groups: Vec<Vec<usize>>,
}

impl JointDistribution {
    /// Parameters with a correlation of their standard normal numbers.
    ///
    /// # Errors
    /// [`NoCorrelation`].
    pub fn new(
        distributions: Vec<Distribution>,
        correlation: &[Vec<f64>],
    ) -> Result<Self, NoCorrelation> {
        let size = distributions.len();
        if correlation.len() != size || correlation.iter().any(|row| row.len() != size) {
            return Err(NoCorrelation::Size);
        }
        let factor = factor(correlation)?;
        Ok(Self { distributions, factor, groups: groups(correlation) })
    }

    /// The distributions of the parameters.
    pub fn distributions(&self) -> &[Distribution] {
        &self.distributions
    }

    /// Parameters that are correlated, by number: each parameter is in one group, alone if it is independent.
    pub fn groups(&self) -> &[Vec<usize>] {
        &self.groups
    }

    /// The parameters of independent standard normal numbers.
    pub fn values(&self, normals: &[f64]) -> Vec<f64> {
        let correlated = |row: &Vec<f64>| row.iter().zip(normals).map(|(a, z)| a * z).sum::<f64>();
        self.distributions
            .iter()
            .zip(&self.factor)
            .map(|(one, row)| one.at(correlated(row)))
            .collect()
    }

    /// Point `number` of the sample of a seed. A point depends on its number and the seed alone.
    pub fn sample(&self, seed: u64, number: u64) -> SampledPoints {
        // The first number of one generator is the seed of another, so that neighbouring points share nothing.
        let mut of_point = SplitMix::new(SplitMix::new(seed).bits().wrapping_add(number));
        let mut random = SplitMix::new(of_point.bits());
        let mut draw =
            || -> Vec<f64> { self.distributions.iter().map(|_| random.normal()).collect() };
        let (first, second) = (draw(), draw());
        let mixed = |group: &Vec<usize>| {
            let mut normals = first.clone();
            for member in group {
                normals[*member] = second[*member];
            }
            self.values(&normals)
        };
        SampledPoints {
            mixed: self.groups.iter().map(mixed).collect(),
            first: self.values(&first),
            second: self.values(&second),
        }
    }
}

/// Two independent points of a joint distribution, and the first with one group of parameters of the second.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledPoints {
    /// A point.
    pub first: Vec<f64>,
    /// An independent one.
    pub second: Vec<f64>,
    /// For each group of correlated parameters the first point with that group of the second.
    pub mixed: Vec<Vec<f64>>,
}

/// The lower triangular factor L of L Lᵀ (Cholesky), also of singular matrices.
fn factor(matrix: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, NoCorrelation> {
    let size = matrix.len();
    let mut lower = vec![vec![0.0; size]; size];
    for row in 0..size {
        for column in 0..=row {
            let entry = matrix[row][column];
            let skew = (entry - matrix[column][row]).abs();
            if !entry.is_finite()
                || skew > ROUNDING
                || (row == column && (entry - 1.0).abs() > ROUNDING)
            {
                return Err(NoCorrelation::NotSymmetric);
            }
            let known: f64 = (0..column).map(|k| lower[row][k] * lower[column][k]).sum();
            let rest = entry - known;
            lower[row][column] = if row == column {
                if rest < -ROUNDING {
                    return Err(NoCorrelation::NotPositive);
                }
                rest.max(0.0).sqrt()
            } else if lower[column][column] * lower[column][column] > ROUNDING {
                rest / lower[column][column]
            } else if rest.abs() > ROUNDING.sqrt() {
                return Err(NoCorrelation::NotPositive);
            } else {
                0.0
            };
        }
    }
    Ok(lower)
}

/// The connected parts of a correlation.
fn groups(correlation: &[Vec<f64>]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (number, row) in correlation.iter().enumerate() {
        let joined = |group: &Vec<usize>| group.iter().any(|member| row[*member] != 0.0);
        let (joined, apart): (Vec<_>, Vec<_>) = groups.into_iter().partition(joined);
        groups = apart;
        let mut group = joined.concat();
        group.push(number);
        group.sort_unstable();
        groups.push(group);
    }
    groups.sort();
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn normal() -> Distribution {
        Distribution::Normal { mean: 0.0, deviation: 1.0 }
    }

    #[test]
    fn samples_have_the_correlation() {
        let matrix = vec![vec![1.0, -0.8, 0.0], vec![-0.8, 1.0, 0.0], vec![0.0, 0.0, 1.0]];
        let joint = JointDistribution::new(vec![normal(); 3], &matrix).expect("a correlation");
        assert_eq!(joint.groups(), [vec![0, 1], vec![2]]);
        let count = 50_000_u32;
        let mut product = [0.0; 2];
        for number in 0..count {
            let points = joint.sample(7, u64::from(number));
            let [a, b, c] = points.first[..] else { unreachable!() };
            product[0] += a * b / f64::from(count);
            product[1] += a * c / f64::from(count);
            assert_eq!(points.mixed[0], [points.second[0], points.second[1], c]);
            assert_eq!(points.mixed[1], [a, b, points.second[2]]);
        }
        assert!((product[0] + 0.8).abs() < 0.03 && product[1].abs() < 0.03, "{product:?}");
    }

    #[test]
    fn refused() {
        let of = |rows: &[[f64; 2]]| {
            let matrix: Vec<Vec<f64>> = rows.iter().map(|row| row.to_vec()).collect();
            JointDistribution::new(vec![normal(); 2], &matrix).map(|_| ())
        };
        assert_eq!(of(&[[1.0, 0.5], [0.5, 1.0]]), Ok(()));
        // Two parameters that are one.
        assert_eq!(of(&[[1.0, 1.0], [1.0, 1.0]]), Ok(()));
        assert_eq!(of(&[[1.0, 1.2], [1.2, 1.0]]), Err(NoCorrelation::NotPositive));
        assert_eq!(of(&[[1.0, 0.5], [0.4, 1.0]]), Err(NoCorrelation::NotSymmetric));
        assert_eq!(of(&[[2.0, 0.5], [0.5, 1.0]]), Err(NoCorrelation::NotSymmetric));
        assert_eq!(of(&[[1.0, f64::NAN], [f64::NAN, 1.0]]), Err(NoCorrelation::NotSymmetric));
        assert_eq!(of(&[[1.0, 0.5]]), Err(NoCorrelation::Size));
    }
}
