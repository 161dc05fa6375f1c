//! Extremes of a Taylor polynomial on a step: all roots of its derivative are isolated, so that none is missed.

use quell_numerics::lane::horner;
use quell_numerics::polynomial::{derivative, first_crossing_after, value};

use crate::simulation::{ORDER, shift};

/// Calls `visit` with every time in (0, `duration`] at which the slope of a polynomial changes its sign, in order.
#[inline(always)]
pub(crate) fn turning_points(series: &[f64; ORDER + 1], duration: f64, mut visit: impl FnMut(f64)) {
    let mut slope = derivative(series);
    let (mut since, mut rest) = (0.0, duration);
    // The slope has fewer roots than this; the shifts separate several of them.
    for _ in 0..ORDER {
        let zeros = slope.iter().take_while(|coefficient| **coefficient == 0.0).count();
        if zeros > ORDER || rest <= 0.0 {
            break;
        }
        let Some(root) = first_crossing_after(&slope, zeros, rest) else { break };
        if root <= 0.0 {
            break;
        }
        since += root;
        rest -= root;
        visit(since);
        let rising = value(&derivative(&slope), root);
        shift(&mut slope, root);
        slope[0] = f64::MIN_POSITIVE.copysign(rising);
    }
}

/// Least value of a polynomial on [0, `duration`], and where: at an end or where its slope changes its sign.
pub(super) fn least(series: &[f64; ORDER + 1], duration: f64) -> (f64, f64) {
    let mut lowest = (series[0], 0.0);
    let mut consider = |since: f64| {
        let height = horner(series, since);
        if height < lowest.0 {
            lowest = (height, since);
        }
    };
    consider(duration);
    turning_points(series, duration, consider);
    lowest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_value_is_that_of_a_dense_scan() {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut random = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for _ in 0..2000 {
            let mut scale = 1.0;
            let series: [f64; ORDER + 1] = std::array::from_fn(|_| {
                scale *= 1.4;
                random() * scale
            });
            let (found, since) = least(&series, 1.0);
            let scan = (0..=2000).map(|i| horner(&series, f64::from(i) / 2000.0));
            let scan = scan.fold(f64::INFINITY, f64::min);
            assert!(found <= scan + 1e-12, "{found} {scan}");
            assert!((horner(&series, since) - found).abs() < 1e-12);
        }
    }
    /// Two extremes 10⁻⁴ of the step apart, both inside, which samples of the slope would have to meet.
    #[test]
    fn close_pairs_of_extremes_are_found() {
        let (a, b) = (0.4321, 0.4322);
        // x′ = (t − a)(t − b).
        let mut series = [0.0; ORDER + 1];
        series[..4].copy_from_slice(&[1.0, a * b, -0.5 * (a + b), 1.0 / 3.0]);
        let mut found = Vec::new();
        turning_points(&series, 1.0, |since| found.push(since));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[0] - a).abs() < 1e-10 && (found[1] - b).abs() < 1e-10, "{found:?}");
    }
}
