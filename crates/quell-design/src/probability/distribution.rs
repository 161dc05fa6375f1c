//! The distribution of one parameter.

use std::f64::consts::FRAC_1_SQRT_2;

use quell_numerics::interval::RealInterval;

/// A distribution of one parameter, in the unit of the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// A normal distribution.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation, positive.
        deviation: f64,
    },
    /// A distribution whose logarithm is normal.
    Lognormal {
        /// Median, positive.
        median: f64,
        /// Standard deviation of the natural logarithm, positive.
        sigma: f64,
    },
    /// Equal density between two values.
    Uniform {
        /// Smallest value.
        from: f64,
        /// Largest value, above the smallest.
        to: f64,
    },
}

impl Distribution {
    /// The value whose probability of not being exceeded is Φ(`normal`), with the standard normal distribution Φ: a standard normal
    /// number becomes one of this distribution.
    pub fn at(self, normal: f64) -> f64 {
        match self {
            Self::Normal { mean, deviation } => deviation.mul_add(normal, mean),
            Self::Lognormal { median, sigma } => median * libm::exp(sigma * normal),
            Self::Uniform { from, to } => (to - from).mul_add(cumulative(normal), from).min(to),
        }
    }

    /// The values beyond which it has no probability; `None` where it has no such ends.
    pub fn ends(self) -> Option<RealInterval> {
        match self {
            Self::Uniform { from, to } => Some(RealInterval::new(from, to)),
            Self::Normal { .. } | Self::Lognormal { .. } => None,
        }
    }
}

/// Φ, the standard normal distribution.
fn cumulative(normal: f64) -> f64 {
    0.5 * libm::erfc(-normal * FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles() {
        let z = 1.644_853_626_951_472_7;
        assert!((cumulative(z) - 0.95).abs() < 1e-15);
        assert_eq!(Distribution::Normal { mean: 2.0, deviation: 0.5 }.at(0.0), 2.0);
        let lognormal = Distribution::Lognormal { median: 0.05, sigma: 0.5 };
        assert!((lognormal.at(z) - 0.05 * libm::exp(0.5 * z)).abs() < 1e-15);
        let uniform = Distribution::Uniform { from: 0.5, to: 1.5 };
        assert!((uniform.at(z) - 1.45).abs() < 1e-14);
        assert_eq!((uniform.at(-40.0), uniform.at(40.0)), (0.5, 1.5));
    }
}
