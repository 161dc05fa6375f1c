//! Formulas: any text gives a law or a complaint and never a panic; invalid laws are rejected with the reason.

use proptest::prelude::*;
use quell_model::{
    Belt, Direction, Dither, Expression, Friction, LawKind, LawParameters, Samples, SlidingLaw,
    Waveform,
};

fn constants() -> Vec<(String, f64)> {
    vec![("a".to_owned(), 0.3), ("b".to_owned(), 0.2)]
}

/// The complaints about a formula.
fn refused(text: &str) -> String {
    let law = Expression::new(text, &constants(), None, 1.0);
    let wrong = law.and_then(|law| law.proven_up_to(1e3 * law.velocity_scale())).expect_err(text);
    wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

#[test]
fn invalid_laws_are_rejected_with_the_reason() {
    for (text, part) in [
        ("0.3 + ", "at character 7"),
        ("min(v)", "kinks"),
        ("0.4 - 0.1*abs(v)", "≥ 0"),
        ("0.3/(abs(v) - b)^2", "finite"),
        ("0.3/abs(v)", "0⁺"),
        ("0.3 + sqrt(abs(v))", "0⁺"),
        ("abs(v)^1.5", "0⁺"),
        ("0.3 + 0.1*v^2 + 0.01*v", "same in both directions"),
        ("0.3 + 0.1*sign(v)", "same in both directions"),
        ("0.3 + abs(v - a)", "multiple of v"),
        ("0.3 + log(v^2 - 1)", "0⁺"),
        ("exp(abs(v))", "finite"),
        ("c*v", "constants are a, b"),
    ] {
        let complaint = refused(text);
        assert!(complaint.contains(part), "{text}: {complaint}");
        assert!(complaint.starts_with("friction.coefficient"), "{text}: {complaint}");
    }
    let wrong = |level, constants: &[(String, f64)]| {
        let found = Expression::new("a + b*exp(-abs(v))", constants, level, 1.0);
        found.expect_err("wrong").iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    };
    assert!(wrong(Some(0.4), &constants()).contains("at least μ(0⁺) = 0.5"));
    assert!(wrong(Some(-0.4), &constants()).contains("friction.static_coefficient"));
    let mut named = constants();
    named[1].1 = f64::NAN;
    assert!(wrong(None, &named).contains("friction.constants.b"));
    named[1] = ("exp".to_owned(), 1.0);
    assert!(wrong(None, &named).contains("has no other meaning"));
}

/// The formula proven up to a speed, or the complaints about it.
fn proven(text: &str, up_to: f64) -> Result<Expression, String> {
    let law =
        Expression::new(text, &constants(), None, 1.0).and_then(|law| law.proven_up_to(up_to));
    law.map_err(|wrong| wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
}

/// Violations too narrow for any sampling are found, with the slip at which they occur; valid formulas that come close to one are
/// proven.
#[test]
fn formulas_are_proven_over_their_range() {
    for (text, up_to, parts) in [
        ("0.3-1.0*exp(-((abs(v)-0.2)/0.0001)^2)", 2.0, &["at v = 0.19995", "it is -0.4878"][..]),
        ("0.3-1.0*exp(-((abs(v)-0.2)/1e-9)^2)", 2.0, &["at v = 0.", "it is -0."]),
        ("0.3+1e-7/(abs(v)-0.2)", 2.0, &["at v = 0.1999"]),
        ("0.3+1e-7/(abs(v)-0.2)^2", 2.0, &["at v = 0."]),
        ("0/0", 2.0, &["not finite"]),
        ("0.4 + 0*(1/(a - a))", 2.0, &["not finite"]),
        ("0.3 + 0.1*sqrt((abs(v) - b)^2 + 0*v)", 2.0, &["at v = 0."]),
        ("0.4 - 0.1*abs(v)", 4.1, &["up to the maximum velocity 4.1", "at v = 4.0", "it is -0.0"]),
        ("exp(abs(v))", 400.0, &["not finite"]),
        ("0.3 + (2 - abs(v))^0.5", 3.0, &["not finite"]),
    ] {
        let complaint = proven(text, up_to).expect_err(text);
        for part in parts {
            assert!(complaint.contains(part), "{text}: {complaint}");
        }
    }
    // At any belt speed: a bounded formula is proven up to the largest number.
    let bounded = proven("0.3 + 0.1*exp(-abs(v)/0.2)", f64::INFINITY).expect("bounded");
    assert_eq!(bounded.range().map(|range| range.upper), Some(f64::MAX));
    let unbounded = proven("0.4 + 0.1*abs(v)", f64::INFINITY).expect_err("unbounded");
    assert!(unbounded.contains("not finite"), "{unbounded}");
    for (text, up_to) in [
        ("0.4 - 0.1*abs(v)", 3.9),
        ("exp(abs(v))", 100.0),
        ("0.3+1e-7/(abs(v)-0.2)", 0.1999),
        ("0.31-0.3*exp(-((abs(v)-0.2)/1e-4)^2)", 2.0),
        // It is zero at 2π, up to rounding.
        ("0.5*(1 + cos(v/2))", 9.0),
        ("0.4 - 0.17145*(abs(v)/b - (abs(v)/b)^3/3)", 50.0),
        ("tanh(abs(v)/1e-3)*(0.25 + 0.15/(1 + abs(v)/0.1)) + 0.01*abs(v)", 1e3),
        ("0.2857 + 0.1143*sech(v/0.3)^2 + 0.001*v^2", 1e5),
        ("0.3 + 0.05*sin(200*abs(v))", 20.0),
    ] {
        let law = proven(text, up_to).expect(text);
        assert_eq!(law.range().map(|range| range.upper), Some(up_to), "{text}");
    }
}

/// The range is given by the study, or a multiple of the slip that belt and dither reach; another belt needs another proof.
#[test]
fn a_formula_is_proven_for_its_belt() {
    let law = |maximum| {
        let law = Expression::new("0.4 - 0.1*abs(v)", &[], None, 1.0).expect("a formula");
        Friction::Expression(law.with_maximum_velocity(maximum).expect("a speed"))
    };
    let belt = |velocity, amplitude, maximum| {
        let (waveform, direction) = (Waveform::Square, Direction::Tangential);
        let dither = Dither {
            direction,
            waveform,
            amplitude,
            frequency_ratio: 10.0,
            phase: 0.0,
            envelope: None,
        };
        Belt::new(0.01, 1.0, velocity, law(maximum), vec![dither])
    };
    let undithered = belt(0.1, 0.0, None).expect("proven up to 1");
    assert_eq!(undithered.friction().range().map(|range| range.upper), Some(1.0));
    // α max|G| = 0.2 · π/2 more.
    let reached = undithered.with_amplitude(0, 1.0).expect("proven up to 2.57");
    let upper = reached.friction().range().expect("a range").upper;
    assert!((upper - (1.0 + 0.5 * std::f64::consts::PI)).abs() < 1e-12, "{upper}");
    let wrong = undithered.with_belt_velocity(0.41).expect_err("up to 4.1 it is negative");
    assert!(
        wrong[0].key == "friction.coefficient" && wrong[0].allowed.contains("4.1"),
        "{wrong:?}"
    );
    let given = belt(0.41, 0.0, Some(3.0)).expect("meant up to 3");
    let law = given.friction();
    assert_eq!(law.get("friction.maximum_velocity"), Some(3.0));
    let wrong = law.with("friction.maximum_velocity", 5.0).and_then(|law| given.with_friction(law));
    let wrong = wrong.expect_err("negative from 4 on");
    assert!(wrong[0].key == "friction.coefficient" && wrong[0].allowed.contains('5'), "{wrong:?}");
}

/// The cubic holds up to √3 v_m, where it returns to its static level; beyond, it grows without bound.
#[test]
fn the_cubic_holds_up_to_its_return() {
    for v_m in [0.2, 6e-6] {
        let law = LawKind::Stribeck.build(&[0.4, 0.2857, v_m]).expect("valid");
        let range = law.range().expect("a range");
        assert!((range.upper / v_m - 3f64.sqrt()).abs() < 1e-15 && range.lower == 0.0);
        assert!((law.coefficient(range.upper) - 0.4).abs() < 1e-15);
        assert!(law.coefficient(10.0 * range.upper) > 50.0);
    }
    let constant = LawKind::Stribeck.build(&[0.4, 0.4, 0.2]).expect("valid");
    assert_eq!(constant.range(), None);
    assert_eq!(LawKind::Decreasing.build(&[0.4, 0.3, 0.2]).expect("valid").range(), None);
}

#[test]
fn the_static_level_is_given_or_follows_from_the_formula() {
    let follows = Expression::new("a + b*exp(-abs(v))", &constants(), None, 1.0).expect("valid");
    assert_eq!((follows.static_coefficient(), follows.starts_at_static_level()), (0.5, true));
    let moved = follows.with("friction.constants.a", 0.4).expect("valid");
    assert_eq!(moved.static_coefficient(), 0.6000000000000001);
    let given = Expression::new("a + b*exp(-abs(v))", &constants(), Some(0.7), 1.0).expect("valid");
    assert_eq!((given.static_coefficient(), given.starts_at_static_level()), (0.7, false));
    assert_eq!(given.coefficient(0.0), 0.5);
    // A level that differs from μ(0⁺) by the rounding of decimals alone is μ(0⁺).
    let sum = Expression::new("0.1 + 0.2*exp(-abs(v))", &[], Some(0.3), 1.0).expect("valid");
    assert!(sum.starts_at_static_level());
}

#[test]
fn samples_that_determine_no_law_are_rejected_with_the_reason() {
    let line = |k: u32| (0.1 * f64::from(k), 0.4 - 0.01 * f64::from(k));
    let good: Vec<(f64, f64)> = (0..12).map(line).collect();
    let complaints = |samples: &[(f64, f64)], level, terms| {
        let wrong = Samples::new(samples, level, terms, 1.0).expect_err("wrong");
        wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
    };
    assert!(complaints(&good[..4], None, None).contains("5 distinct speeds"));
    assert!(complaints(&good, None, Some(9)).contains("from 1 to 4"));
    let mut bad = good.clone();
    bad[3].0 = -0.3;
    bad[5].1 = f64::NAN;
    let both = complaints(&bad, None, None);
    assert!(both.contains("slip_velocity[3]") && both.contains("one direction"), "{both}");
    assert!(both.contains("coefficient[5]"), "{both}");
    // A static level below the samples pins the fit.
    let pinned = Samples::new(&good, Some(0.39), None, 1.0).expect("a fit");
    assert!(pinned.fit().pinned && pinned.starts_at_static_level(), "{:?}", pinned.fit());
    assert!((pinned.coefficient(0.0) - 0.39).abs() < 1e-12);
}

/// The fit does not follow noise: its error, at its own samples and at left-out ones, is that of the noise.
#[test]
fn noise_is_smoothed_and_its_size_reported() {
    let mut state = 1_u64;
    let mut noise = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((state >> 40) as f64 / f64::from(1 << 24) - 0.5) * 0.01 * 12f64.sqrt()
    };
    let truth = |u: f64| 0.26 + 0.12 * (-u / 0.08).exp();
    let samples: Vec<(f64, f64)> =
        (0..200).map(|k| f64::from(k) * 0.004).map(|u| (u, truth(u) + noise())).collect();
    let law = Samples::new(&samples, Some(0.45), None, 1.0).expect("a fit");
    let fit = law.fit();
    assert!((0.008..0.012).contains(&fit.rms_error), "{fit:?}");
    assert!((0.008..0.012).contains(&fit.left_out_error), "{fit:?}");
    for (u, _) in &samples {
        assert!((law.coefficient(*u) - truth(*u)).abs() < 0.006, "{u}: {fit:?}");
    }
    // Far beyond the samples it is bounded.
    assert!((law.coefficient(100.0) - fit.limit).abs() < 1e-12 && (0.2..0.3).contains(&fit.limit));
}

#[test]
fn a_unit_of_velocity_is_finite_and_positive() {
    for unit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let wrong = Expression::new("0.4", &[], None, unit).expect_err("no unit");
        assert_eq!(wrong[0].key, "velocity_unit");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_text_gives_a_law_or_a_complaint(text in ".{0,60}") {
        match Expression::new(&text, &constants(), None, 1.0) {
            Ok(law) => {
                prop_assert!(law.coefficient(0.0) >= -1e-12 && law.slope(0.0).is_finite());
                prop_assert_eq!(law.text(), text.as_str());
            }
            Err(wrong) => {
                prop_assert!(!wrong.is_empty());
                prop_assert!(wrong.iter().all(|complaint| complaint.key.starts_with("friction.")));
            }
        }
    }

    #[test]
    fn any_arrangement_of_words_gives_a_law_or_a_complaint(
        words in prop::collection::vec(
            prop::sample::select(vec![
                "v", "a", "b", "abs(", "exp(", "log(", "sqrt(", "tanh(", "sech(", "sin(", "atan(", "sign(",
                "(", ")", ")", ")", "+", "-", "*", "/", "^", "2", "0.3", "1e-9", "1e300", " ", "pi", "max(",
            ]),
            0..24,
        )
    ) {
        let text = words.concat();
        let law = Expression::new(&text, &constants(), None, 1.0);
        if let Ok(law) = law.and_then(|law| law.proven_up_to(31.0 * law.velocity_scale())) {
            for speed in [0.0, 1e-9, 0.1, 1.0, 30.0] {
                let speed = speed * law.velocity_scale();
                prop_assert!(law.coefficient(speed) >= -1e-12 && law.slope(speed).is_finite());
            }
        }
    }
}
