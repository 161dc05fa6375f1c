//! Values and slopes of the sliding branch.

use quell_model::{Friction, LawKind};

use crate::law_samples::{SCALED_SPEEDS, all_samples};

/// μ(0⁺) ≤ μ_s, up to the rounding of one sum: otherwise stick could never begin.
#[test]
fn the_branch_starts_at_or_below_the_static_level() {
    for law in all_samples() {
        let (start, level) = (law.coefficient(0.0), law.static_coefficient());
        let rounding = f64::EPSILON * level;
        assert!(start <= level + rounding, "{law:?}: {start} > {level}");
        let reported = law.starts_at_static_level();
        assert_eq!(reported, (start - level).abs() <= rounding, "{law:?}: μ(0⁺) = {start}");
    }
}

/// The difference quotient of fourth order on five points, `first`…`first` + 4 steps.
fn five_points(law: &Friction, speed: f64, step: f64, central: bool) -> f64 {
    let (weights, first) = if central {
        ([1.0, -8.0, 0.0, 8.0, -1.0], -2.0)
    } else {
        ([-25.0, 48.0, -36.0, 16.0, -3.0], 0.0)
    };
    let mut sum = 0.0;
    for (index, weight) in weights.into_iter().enumerate() {
        sum += weight * law.coefficient(speed + (first + index as f64) * step);
    }
    sum / (12.0 * step)
}

/// Truncation h⁴|μ⁗′|/30 (forward h⁴|μ⁗′|/5) with h = 2⁻¹⁰ is below 2·10⁻¹³, rounding of
/// the quotient about ε/h = 2·10⁻¹³, both in units of μ_s/v_m.
#[test]
fn slopes_agree_with_differences_of_values() {
    for law in all_samples() {
        let scale = law.velocity_scale();
        let step = scale / 1024.0;
        // Sums are known to the rounding of their terms.
        let terms: f64 = match &law {
            Friction::Samples(law) => law.fit().terms.iter().map(|(size, _)| size.abs()).sum(),
            _ => 0.0,
        };
        let mut size = law.static_coefficient().max(terms) / scale;
        for &scaled in SCALED_SPEEDS {
            let speed = scaled * scale;
            // Central where the five points stay on the branch, forward next to v_r = 0.
            let central = speed > 2.0 * step;
            let differences = five_points(&law, speed, step, central);
            let slope = law.slope(speed);
            size = size.max(law.coefficient(speed).abs() / scale);
            let error = (slope - differences).abs();
            assert!(
                error <= 4e-12 * size,
                "{law:?} at {scaled} v_m: slope {slope}, differences {differences}"
            );
        }
    }
}

#[test]
fn extreme_slip_gives_finite_numbers() {
    for law in all_samples() {
        for speed in [0.0, f64::MIN_POSITIVE, 1e-300, 1e-20, 1e6] {
            let (value, slope) = (law.coefficient(speed), law.slope(speed));
            assert!(value.is_finite() && slope.is_finite(), "{law:?} at {speed}: {value}, {slope}");
        }
        // The branch starts without a jump.
        let change = (law.coefficient(1e-300) - law.coefficient(0.0)).abs();
        assert!(change <= 1e-280, "{law:?}: {change}");
        let change = (law.slope(1e-300) - law.slope(0.0)).abs() * law.velocity_scale();
        assert!(change <= 1e-280, "{law:?}: {change}");
    }
}

/// Friction dissipates energy at every slip speed: μ ≥ 0, up to rounding.
#[test]
fn coefficients_are_never_negative() {
    for law in all_samples() {
        let spread = (0..4000).map(|i| 10f64.powf(f64::from(i) * 0.004 - 8.0));
        // About where an exponential leaves the normal numbers.
        let edge = (0..200).map(|i| 650.0 + f64::from(i));
        for scaled in spread.chain(edge) {
            let value = law.coefficient(scaled * law.velocity_scale());
            let rounding = 4.0 * f64::EPSILON * law.static_coefficient();
            assert!(value >= -rounding, "{law:?} at {scaled} v_m: {value}");
        }
    }
}

/// Stored numbers: (2.7) and (2.8) with the values of the dissertation.
#[test]
fn laws_of_the_dissertation_have_its_values() {
    let (level, minimum, velocity) = (0.4, 0.2857, 0.2);
    let halfway = 0.5 * (level + minimum);
    for (kind, points) in [
        // w − w³/3 is 0 at 0 and √3, 2/3 at 1, 11/24 at 1/2, −2/3 at 2.
        (
            LawKind::Stribeck,
            [
                (0.0, level),
                (0.5, level - 11.0 / 16.0 * (level - minimum)),
                (1.0, minimum),
                (3f64.sqrt(), level),
                (2.0, 2.0 * level - minimum),
            ],
        ),
        (
            LawKind::Decreasing,
            [
                (0.0, level),
                (2f64.ln(), halfway),
                (4f64.ln(), 0.5 * (halfway + minimum)),
                (40.0, minimum),
                (5e6, minimum),
            ],
        ),
    ] {
        let law = kind.build(&[level, minimum, velocity]).expect("valid");
        for (scaled, value) in points {
            let found = law.coefficient(scaled * velocity);
            assert!((found - value).abs() < 4e-16, "{kind:?} at {scaled} v_m: {found}, {value}");
        }
    }
}
