//! What a sample says about a probability and about quantiles.

use quell_numerics::interval::RealInterval;

/// The 97.5 % quantile of the standard normal distribution: two-sided intervals of 95 %.
const NORMAL_QUANTILE: f64 = 1.959_963_984_540_054;

/// The 95 % interval of a probability of which `count` of `total` cases are known (Wilson 1927), inside [0, 1]; all of [0, 1] without
/// a case.
pub fn binomial_interval(count: usize, total: usize) -> RealInterval {
    if total == 0 {
        return RealInterval::new(0.0, 1.0);
    }
    let (total, share) = (total as f64, count as f64 / total as f64);
    let square = NORMAL_QUANTILE * NORMAL_QUANTILE;
    let middle = (share + 0.5 * square / total) / (1.0 + square / total);
    let half = NORMAL_QUANTILE / (1.0 + square / total)
        * ((share * (1.0 - share) + 0.25 * square / total) / total).sqrt();
    let low = if count == 0 { 0.0 } else { (middle - half).max(0.0) };
    let high = if share >= 1.0 { 1.0 } else { (middle + half).min(1.0) };
    RealInterval::new(low, high)
}

/// A quantile of ascending values, linear between them; `None` of no values.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place among values")]
pub fn quantile(ascending: &[f64], probability: f64) -> Option<f64> {
    let last = ascending.len().checked_sub(1)?;
    let place = probability.clamp(0.0, 1.0) * last as f64;
    let below = (place.floor() as usize).min(last);
    let above = (below + 1).min(last);
    let (low, high) = (ascending[below], ascending[above]);
    Some((high - low).mul_add(place - below as f64, low))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ends of the interval solve (p̂ − p)² = z² p (1 − p)/n, by which it is defined.
    #[test]
    fn ends_of_the_interval_are_a_normal_quantile_away() {
        for (count, total) in [(3, 10), (686, 1000), (1, 50), (99_000, 100_000)] {
            let RealInterval { lower: low, upper: high } = binomial_interval(count, total);
            let share = count as f64 / total as f64;
            for end in [low, high] {
                let away = (share - end).powi(2) * total as f64 / (end * (1.0 - end));
                assert!((away.sqrt() - NORMAL_QUANTILE).abs() < 1e-9, "{count} {total} {end}");
            }
        }
        assert_eq!(binomial_interval(0, 100).lower, 0.0);
        assert_eq!(binomial_interval(100, 100).upper, 1.0);
        assert_eq!(binomial_interval(0, 0), RealInterval::new(0.0, 1.0));
    }

    #[test]
    fn quantiles_between_values() {
        let values = [1.0, 2.0, 4.0, 8.0];
        assert_eq!(quantile(&values, 0.5), Some(3.0));
        assert_eq!((quantile(&values, 0.0), quantile(&values, 1.0)), (Some(1.0), Some(8.0)));
        assert_eq!(quantile(&[], 0.5), None);
    }
}
