//! Quantiles and tests of residuals.

use quell_numerics::order::ascending;

/// Residuals up to this part of the largest coefficient are rounding.
pub(super) const ROUNDING: f64 = 1e-12;

/// The t with P(|T| ≤ t) = `probability` for Student's distribution with ν ≥ 1 degrees of freedom.
///
/// Bisection of the finite series of the distribution (Abramowitz and Stegun 1964, eqs. 26.7.3 and 26.7.4), to rounding.
/// `probability` is in (0, 1).
pub fn student_quantile(probability: f64, degrees: usize) -> f64 {
    let (mut lower, mut upper) = (0.0_f64, 1.0_f64);
    while central(upper, degrees) < probability && upper < f64::MAX / 4.0 {
        upper *= 2.0;
    }
    loop {
        let middle = 0.5 * (lower + upper);
        if middle <= lower || middle >= upper {
            return middle;
        }
        if central(middle, degrees) < probability {
            lower = middle;
        } else {
            upper = middle;
        }
    }
}

/// P(|T| ≤ t).
fn central(t: f64, degrees: usize) -> f64 {
    let angle = libm::atan(t / (degrees as f64).sqrt());
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let square = cosine * cosine;
    let odd = degrees % 2 == 1;
    // Terms cosᵏ with k = 0, 2, … ≤ ν − 2 (even), k = 1, 3, … ≤ ν − 2 (odd).
    let mut term = if odd { cosine } else { 1.0 };
    let mut power = usize::from(odd);
    let mut sum = 0.0;
    while power + 2 <= degrees {
        sum += term;
        power += 2;
        term *= square * (power - 1) as f64 / power as f64;
        if term < f64::EPSILON * f64::EPSILON {
            break;
        }
    }
    if odd { std::f64::consts::FRAC_2_PI * (angle + sine * sum) } else { sine * sum }
}

/// The median of absolute values times 1.4826, which estimates the standard deviation of a normal distribution for any minority
/// of outliers.
pub(super) fn robust_deviation(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    ascending(&mut sizes);
    let middle = sizes.len() / 2;
    let median = match sizes.len() {
        0 => 0.0,
        count if count % 2 == 1 => sizes[middle],
        _ => 0.5 * (sizes[middle - 1] + sizes[middle]),
    };
    1.4826 * median
}

/// Number of runs of equal sign, its expectation and the deviation from it in standard deviations, for signs in random order (Wald
/// and Wolfowitz 1940); `None` for fewer than ten values or a single sign.
pub fn runs(values: &[f64]) -> Option<(usize, f64, f64)> {
    let count = values.len() as f64;
    let positive = values.iter().filter(|value| **value > 0.0).count() as f64;
    let negative = count - positive;
    if values.len() < 10 || positive == 0.0 || negative == 0.0 {
        return None;
    }
    let changes = values.windows(2).filter(|pair| (pair[0] > 0.0) != (pair[1] > 0.0)).count();
    let expected = 2.0 * positive * negative / count + 1.0;
    let variance = (expected - 1.0) * (expected - 2.0) / (count - 1.0);
    let score = ((changes + 1) as f64 - expected) / variance.sqrt();
    score.is_finite().then_some((changes + 1, expected, score))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        // Abramowitz and Stegun, table 26.10, to their three decimals; one degree: tan(0.475 π), two: closed form.
        for (degrees, value) in [(3, 3.182), (4, 2.776), (10, 2.228), (30, 2.042), (120, 1.980)] {
            assert!((student_quantile(0.95, degrees) - value).abs() < 5e-4, "{degrees}");
        }
        let one = libm::tan(0.475 * std::f64::consts::PI);
        assert!((student_quantile(0.95, 1) / one - 1.0).abs() < 1e-12);
        // ν = 2: P = t/√(t² + 2).
        let two = 0.95 * (2.0_f64 / (1.0 - 0.95 * 0.95)).sqrt();
        assert!((student_quantile(0.95, 2) / two - 1.0).abs() < 1e-12);
        // Many degrees: the normal distribution, whose quantile is 1.959964; the excess is (z³ + z)/(4ν).
        let excess = student_quantile(0.95, 100_001) - 1.959_963_984_540_054;
        assert!((excess * 400_004.0 / 9.489_11 - 1.0).abs() < 1e-2, "{excess}");
    }

    #[test]
    fn runs_of_alternating_and_of_sorted_signs() {
        let alternating: Vec<f64> = (0..20).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let sorted: Vec<f64> = (0..20).map(|k| f64::from(k) - 9.5).collect();
        let (found, expected, score) = runs(&alternating).expect("both signs");
        assert_eq!((found, expected), (20, 11.0));
        assert!(score > 3.0);
        let (found, _, score) = runs(&sorted).expect("both signs");
        assert_eq!(found, 2);
        assert!(score < -3.0);
        assert!(runs(&[1.0; 20]).is_none());
    }

    #[test]
    fn one_outlier_does_not_change_the_robust_deviation() {
        assert_eq!(robust_deviation(&[1.0, -1.0, 1.0, -1.0, 50.0]), 1.4826);
        assert_eq!(robust_deviation(&[1.0, -3.0]), 2.0 * 1.4826);
    }
}
