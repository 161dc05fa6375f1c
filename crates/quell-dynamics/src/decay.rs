//! Whether a run approaches its limit at the rate that is known from multipliers or eigenvalues: the test that every judge of where
//! a run ends uses.

/// Relative difference within which a measured decay rate agrees with a known one. The judges ask for agreement several times in
/// succession, so that nonlinear decay no longer matters. With a larger value a run that converges elsewhere could pass; a
/// smaller value only takes longer.
const RATE_TOLERANCE: f64 = 0.05;

/// Whether a measured rate of decay agrees with the expected one; a rate that is not a number does not.
pub(crate) fn decays_at(measured: f64, expected: f64) -> bool {
    (measured - expected).abs() <= RATE_TOLERANCE * expected.abs()
}

#[cfg(test)]
mod tests {
    use super::decays_at;

    #[test]
    fn rates_agree_within_a_twentieth() {
        assert!(decays_at(-1.04, -1.0) && decays_at(-0.96, -1.0));
        assert!(!decays_at(-1.06, -1.0) && !decays_at(1.0, -1.0));
        assert!(!decays_at(f64::NAN, -1.0) && !decays_at(f64::NEG_INFINITY, -1.0));
    }
}
