//! Comparison with 40-digit arithmetic, with mode counts by a fine scan, and with limits.

use super::*;

fn number(value: &serde_json::Value) -> f64 {
    value.as_str().expect("a printed number").parse().expect("a number")
}

/// Frequency parameters within 1e-12 relative (required: 1e-10), shapes within 1e-11 of φ(a), for every stored mode.
#[test]
fn stored_modes() {
    let text = include_str!("../../../../reference/disc_modes.json");
    let table: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let (mut worst, mut worst_shape, mut worst_norm, mut count) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
    for (ratio, entries) in table["plates"].as_object().expect("plates") {
        let ratio: f64 = ratio.parse().expect("a ratio");
        let plate = Plate::new(ratio, 0.3).expect("valid");
        let modes = plate.modes(4, 5).expect("found");
        for entry in entries.as_array().expect("modes") {
            let n = entry["n"].as_u64().expect("n");
            let radial = entry["m"].as_u64().expect("m") + 1;
            let wanted =
                |mode: &&PlateMode| u64::from(mode.diameters) == n && mode.radial as u64 == radial;
            let mode = modes.iter().find(wanted).expect("the mode");
            worst = worst.max((mode.frequency_parameter / number(&entry["k2"]) - 1.0).abs());
            let edge = mode.shape.value(1.0).expect("on the plate");
            let area = core::f64::consts::PI * (1.0 - ratio * ratio);
            let exact_edge = number(&entry["Rhat_at_a"]) * area.sqrt();
            worst_norm = worst_norm.max((edge / exact_edge - 1.0).abs());
            let radii = entry["r_over_a"].as_array().expect("radii");
            let shapes = entry["R_over_Ra"].as_array().expect("shapes");
            for (radius, shape) in radii.iter().zip(shapes) {
                let value = mode.shape.value(number(radius)).expect("on the plate") / edge;
                worst_shape = worst_shape.max((value - number(shape)).abs());
            }
            count += 1;
        }
    }
    assert_eq!(count, 72);
    println!("k²: {worst:e}, shape: {worst_shape:e}, norm: {worst_norm:e}");
    assert!(worst < 1e-12, "frequency parameter: {worst:e}");
    assert!(worst_shape < 1e-11, "shape: {worst_shape:e}");
    assert!(worst_norm < 1e-11, "norm: {worst_norm:e}");
}

/// A scan of the exact determinant, with 60 steps per smallest distance of roots, finds the same modes at the same wave numbers.
#[test]
fn no_root_is_missed_or_duplicated() {
    for (ratio, poisson) in
        [(0.01, 0.3), (0.05, 0.0), (0.2, 0.499), (0.5, 0.3), (0.7, 0.3), (0.95, 0.1)]
    {
        let plate = Plate::new(ratio, poisson).expect("valid");
        let modes = plate.modes(10, 20).expect("found");
        assert_eq!(modes.len(), 210);
        for n in [0, 1, 2, 3, 7, 13, 20] {
            let found: Vec<f64> = modes
                .iter()
                .filter(|mode| mode.diameters == n)
                .map(|mode| mode.frequency_parameter.sqrt())
                .collect();
            assert!(
                found.windows(2).all(|pair| pair[1] > pair[0] * (1.0 + 1e-3)),
                "b/a {ratio}, n {n}"
            );
            let step = core::f64::consts::PI / (1.0 - ratio) / 60.0;
            let end = found[9] * (1.0 + 1e-9);
            let (mut k, mut changes) = (0.3_f64.max(0.3 * f64::from(n)), Vec::new());
            let sign =
                |k: f64| eliminate(n, ratio, poisson, k).expect("in range").determinant > 0.0;
            let mut last = sign(k);
            while k < end {
                k = (k + step).min(end);
                let now = sign(k);
                if now != last {
                    changes.push(k);
                }
                last = now;
            }
            assert_eq!(changes.len(), 10, "b/a {ratio}, n {n}: {changes:?} {found:?}");
            for (scanned, k) in changes.iter().zip(&found) {
                assert!(
                    *k <= scanned + 1e-9 && *k >= scanned - step,
                    "b/a {ratio}, n {n}: {k} {scanned}"
                );
            }
        }
    }
}

/// Over the whole domain, Ritz values are above the exact ones by less than the bound.
#[test]
fn ritz_values_are_upper_bounds() {
    let mut worst = 0.0_f64;
    for ratio in [0.01, 0.03, 0.13, 0.26, 0.49, 0.51, 0.8, 0.95] {
        for poisson in [0.0, 0.33, 0.4999] {
            let plate = Plate::new(ratio, poisson).expect("valid");
            let modes = plate.modes(10, 20).expect("found");
            let space = TrialSpace::new(ratio, poisson, 11, 20);
            for n in [0, 1, 5, 20] {
                let ritz = space.wave_numbers(n, 10).expect("factored");
                for (mode, k) in modes.iter().filter(|mode| mode.diameters == n).zip(ritz) {
                    let excess = k / mode.frequency_parameter.sqrt() - 1.0;
                    // Rounding of the Ritz problem: 1/k⁴ is accurate to 1e-15 of its largest value.
                    assert!(
                        excess > -1e-9,
                        "b/a {ratio}, n {n}, radial {}: {excess:e}",
                        mode.radial
                    );
                    worst = worst.max(excess);
                }
            }
        }
    }
    println!("largest excess {worst:e}");
    assert!(worst < 0.01 * ACCURACY, "{worst:e}");
}

/// Thin ring: the lowest axisymmetric mode is that of a clamped–free beam, k(1 − b) = 1.8751 (with ν = 0 and b/a → 1).
#[test]
fn thin_ring_is_a_cantilever() {
    let beam = [1.875104068711961, 4.694091132974174, 7.854757438237612];
    for (ratio, bound) in [(0.9, 0.06), (0.95, 0.03)] {
        let modes = Plate::new(ratio, 0.0).expect("valid").modes(3, 0).expect("found");
        for (mode, exact) in modes.iter().zip(beam) {
            let k = mode.frequency_parameter.sqrt() * (1.0 - ratio);
            assert!((k / exact - 1.0).abs() < bound, "{k} {exact}");
        }
    }
}

/// The closed-form norm agrees with a quadrature of the shape, the slope is its derivative, and R(a) > 0.
#[test]
fn normalised_shapes() {
    let rule = quell_numerics::gauss_legendre::GaussLegendre::new(80);
    for (ratio, radial, diameters) in [(0.01, 3, 6), (0.1, 4, 8), (0.5, 10, 20), (0.95, 3, 20)] {
        for mode in Plate::new(ratio, 0.3).expect("valid").modes(radial, diameters).expect("found")
        {
            let half = 0.5 * (1.0 - ratio);
            let square: f64 = rule
                .nodes
                .iter()
                .zip(&rule.weights)
                .map(|(x, w)| {
                    let r = ratio + half * (1.0 + x);
                    let value = mode.shape.value(r).expect("on the plate");
                    half * w * r * value * value
                })
                .sum();
            let mean = square / (1.0 - ratio * ratio) * if mode.diameters == 0 { 2.0 } else { 1.0 };
            assert!((mean - 1.0).abs() < 1e-10, "b/a {ratio}, {mode:?}: {mean}");
            assert!(mode.shape.value(1.0).expect("edge") > 0.0);
            assert_eq!(mode.shape.value(ratio), Some(0.0));
            assert_eq!(mode.shape.value(1.0001), None);
            let (r, h) = (ratio + 1.3 * half, 1e-3 * half / (mode.radial as f64));
            let at = |r: f64| mode.shape.value(r).expect("on the plate");
            let difference =
                (8.0 * (at(r + h) - at(r - h)) - (at(r + 2.0 * h) - at(r - 2.0 * h))) / (12.0 * h);
            let [_, slope] = mode.shape.value_and_slope(r).expect("on the plate");
            assert!((difference - slope).abs() < 1e-7 * (1.0 + slope.abs()) / half, "{mode:?}");
            let near = mode.shape.value(ratio + 1e-9 * half).expect("on the plate");
            assert!(near.abs() < 1e-10, "clamp: {near:e} {mode:?}");
        }
    }
}

/// b/a = 0.5: the reference frequency changes by a factor of 1.18822 between N_θ = 2 and 5; a fixed one does not change.
#[test]
fn reference_frequency() {
    let plate = Plate::new(0.5, 0.3).expect("valid");
    let two = ModeSet::new(&plate, 1, 2, Reference::Critical).expect("found");
    let five = ModeSet::new(&plate, 2, 5, Reference::Critical).expect("found");
    assert!((two.reference() / five.reference() - 1.18822).abs() < 5e-6);
    assert_eq!(two.critical_mode().expect("one").diameters, 2);
    assert_eq!(five.critical_mode().expect("one").diameters, 3);
    let ratios: Vec<f64> = two.modes().iter().map(|mode| two.ratio(mode)).collect();
    for (ratio, printed) in ratios.iter().zip([1.771548, 1.807665, 2.0]) {
        assert!((ratio - printed).abs() < 5e-7, "{ratio} {printed}");
    }
    let fixed = ModeSet::new(&plate, 1, 2, Reference::FrequencyParameter(5.0)).expect("found");
    assert_eq!(fixed.reference(), 5.0);
    assert_eq!(ModeSet::new(&plate, 1, 0, Reference::Critical), Err(ModeSetError::NoCriticalSpeed));
    let bad = ModeSet::new(&plate, 1, 0, Reference::FrequencyParameter(-1.0));
    assert_eq!(bad, Err(ModeSetError::Reference { value: -1.0 }));
}

/// Steel, a = 0.15 m, h = 0.01 m: frequencies in hertz against a direct evaluation of the formula.
#[test]
fn hertz_and_revolutions() {
    let plate = Plate::new(0.5, 0.3).expect("valid");
    let material = PlateMaterial::new(210e9, 7800.0, 0.01, 0.15).expect("valid");
    let by_hand =
        (210e9_f64 * 1e-4 / (12.0 * 0.91 * 7800.0)).sqrt() / (0.0225 * core::f64::consts::TAU);
    assert!((material.hertz(&plate, 1.0) / by_hand - 1.0).abs() < 1e-14);
    assert_eq!(material.critical_speed_rpm(&plate, 1.0, 0), None);
    let rpm = material.critical_speed_rpm(&plate, 3.0, 2).expect("turns");
    assert!((rpm / (90.0 * by_hand) - 1.0).abs() < 1e-14);
    let mass = core::f64::consts::PI * 0.0225 * 0.75 * 78.0;
    assert!((material.plate_mass(&plate) / mass - 1.0).abs() < 1e-14);
    assert_eq!(
        PlateMaterial::new(210e9, 7800.0, 0.2, 0.15).expect_err("too thick").quantity,
        "thickness"
    );
}

#[test]
fn invalid_values_are_rejected() {
    assert_eq!(Plate::new(1.0, 0.3), Err(PlateError::InnerRadiusRatio { value: 1.0 }));
    assert_eq!(Plate::new(0.5, 0.5), Err(PlateError::PoissonRatio { value: 0.5 }));
    assert!(Plate::new(f64::NAN, 0.3).is_err() && Plate::new(0.5, f64::NAN).is_err());
    let plate = Plate::new(0.5, 0.3).expect("valid");
    assert_eq!(plate.modes(0, 2), Err(PlateError::RadialModes { radial: 0 }));
    assert_eq!(plate.modes(1, 41), Err(PlateError::TooManyDiameters { diameters: 41 }));
}
