//! Periodic responses against identities, differences and known thresholds.

use quell_dynamics::attractor::{
    NoOutcome, NoStart, RunOutcome, RunSwitches, StartOfRun, VariedRun, values_tried,
};
use quell_dynamics::orbit::{Orbit, OrbitVerdict, Threshold, ThresholdKind, base_response};
use quell_dynamics::simulation::{EventKind, Start, simulate};
use quell_model::{Belt, Dither, LawKind, RefusedNumbers, System, Waveform};
use quell_numerics::interval::RealInterval;
use quell_zoo::BeltExt;
use quell_zoo::belt::{chapter_4, decreasing_under, dissertation, over_amplitudes};
use quell_zoo::dither::{normal, tangential};
use serde_json::Value;

use crate::belt_orbits::{monodromy, orbit_reached};
use crate::local_thresholds;

const REFERENCE: &str = include_str!("../../../reference/quench_thresholds.json");

/// Five-point differences of the period map.
fn differences(belt: &Belt, orbit: &Orbit, h: f64) -> [[f64; 2]; 2] {
    let end = |dx: f64, dv: f64| {
        let start =
            Start { time: 0.0, displacement: orbit.state[0] + dx, velocity: orbit.state[1] + dv };
        let end = simulate(belt, start, orbit.period, 1e-14, &mut ()).expect("no stall");
        [end.displacement, end.velocity]
    };
    let column = |column: usize| {
        let at = |s: f64| if column == 0 { end(s * h, 0.0) } else { end(0.0, s * h) };
        let (far, near, back, behind) = (at(2.0), at(1.0), at(-1.0), at(-2.0));
        [0, 1].map(|row| (8.0 * (near[row] - back[row]) - (far[row] - behind[row])) / (12.0 * h))
    };
    let (first, second) = (column(0), column(1));
    [[first[0], second[0]], [first[1], second[1]]]
}

/// Reversals: square dither beyond the upper threshold; determinant by differences, 0.8031914534517.
#[test]
fn saltation_at_reversals() {
    let belt = decreasing_under(Waveform::Square, 6.4);
    let orbit = base_response(&belt.system(), 16).expect("an orbit");
    assert_eq!(orbit.events.len(), 2, "{:?}", orbit.events);
    let [[a, b], [c, d]] = monodromy(&orbit);
    assert!((a * d - b * c - 0.803_191_453_458_5).abs() < 1e-9, "{}", a * d - b * c);
    assert_eq!(orbit.verdict(), OrbitVerdict::Stable);
}

/// With a stick among reversals, over ten periods of the dither, one multiplier is 0 and the derivative agrees with
/// differences, as it does where the mass only reverses. The steps of the differences do not change the order of events.
#[test]
fn multipliers_through_stick_and_reversal() {
    let squeal = Start { time: 0.0, displacement: -0.750_838_2, velocity: 0.0 };
    let squealing =
        orbit_reached(&decreasing_under(Waveform::Sine, 2.5), squeal).expect("an orbit");
    assert!(
        squealing.signature.count(EventKind::Stick) > 0
            && squealing.signature.count(EventKind::Reversal) > 0
    );
    let least = squealing.multipliers[1];
    assert!(least.norm() < 1e-9, "{least}");
    let reversing =
        base_response(&decreasing_under(Waveform::Sine, 12.0).system(), 16).expect("an orbit");
    assert_eq!((reversing.signature.count(EventKind::Stick), reversing.events.len()), (0, 2));
    for (d, orbit) in [(2.5, squealing), (12.0, reversing)] {
        let other = differences(&decreasing_under(Waveform::Sine, d), &orbit, 1e-5);
        for (own, other) in monodromy(&orbit).iter().flatten().zip(other.iter().flatten()) {
            assert!((own - other).abs() < 1e-8, "{d}: {own} {other}");
        }
    }
}

fn check(found: &[Threshold], expected: &[(f64, ThresholdKind, OrbitVerdict)]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (threshold, (value, kind, becomes)) in found.iter().zip(expected) {
        let off = (threshold.value / value - 1.0).abs();
        assert!(off < 1e-8, "{} {value}: {off:.1e}", threshold.value);
        assert_eq!((threshold.kind, threshold.becomes), (*kind, Some(*becomes)), "{value}");
        assert!(threshold.error < 1e-7 * value, "{threshold:?}");
    }
}

#[test]
fn thresholds_of_tangential_dither() {
    for (waveform, lower, upper) in [
        (Waveform::Sine, 4.322_392_624, 9.900_214_849),
        (Waveform::Square, 3.295_664_190, 6.313_857_946),
    ] {
        let found = local_thresholds(
            &over_amplitudes(&decreasing_under(waveform, 1.0)),
            RealInterval::new(0.5, 10.5),
            40,
        );
        let expected = [
            (lower, ThresholdKind::NeimarkSacker, OrbitVerdict::Unstable),
            (upper, ThresholdKind::Grazing, OrbitVerdict::Stable),
        ];
        check(&found, &expected);
    }
}

#[test]
fn thresholds_of_normal_dither() {
    for (waveform, lower, upper, closeness) in [
        (Waveform::Square, 0.553_840_4, 0.614_698_468, 2e-7),
        (Waveform::Sine, 0.710_299_1, 0.965_369_470, 2e-7),
    ] {
        let belt = chapter_4().with_dither(normal(waveform.clone(), 0.1, 5.0));
        let found = local_thresholds(&over_amplitudes(&belt), RealInterval::new(0.1, 0.99), 60);
        assert_eq!(found.len(), 2, "{found:?}");
        for (threshold, value) in found.iter().zip([lower, upper]) {
            let off = (threshold.value / value - 1.0).abs();
            assert!(off < closeness, "{waveform:?}: {} {value} {off:.1e}", threshold.value);
        }
        assert_eq!(found[0].becomes, Some(OrbitVerdict::Unstable));
        assert_eq!(found[1].becomes, Some(OrbitVerdict::Stable));
    }
}

#[test]
fn quench_thresholds_of_the_reference() {
    let reference: Value = serde_json::from_str(REFERENCE).expect("reference file");
    let mut worst: f64 = 0.0;
    let mut checked = 0;
    for case in reference["cases"].as_array().expect("cases") {
        let number = |key: &str| case[key].as_f64().expect("a number");
        let law = LawKind::from_name(case["law"].as_str().expect("a law")).expect("a law");
        let name = case["waveform"].as_str().expect("a waveform");
        let waveform = Waveform::from_name(name).expect("a waveform");
        let (average, expected) = (number("D_average"), number("D_period1_stable_from"));
        let dither = tangential(waveform, average, number("frequency_ratio"));
        let belt = dissertation(law).at_speed(number("belt_velocity")).with_dither(dither);
        let (from, to) = (0.8 * average, 1.1 * average);
        let found = local_thresholds(&over_amplitudes(&belt), RealInterval::new(from, to), 12);
        let last = found.last().unwrap_or_else(|| panic!("no threshold: {case}"));
        assert_eq!(last.kind, ThresholdKind::Grazing);
        let off = (last.value / expected - 1.0).abs();
        worst = worst.max(off);
        assert!(off < 2e-6, "{} {expected} {off:.1e}: {case}", last.value);
        checked += 1;
    }
    assert!(checked >= 29, "{checked}");
    println!("{checked} thresholds, worst {worst:.1e}");
}

/// From rest the threshold depends on the phase of the dither at its start, and is far below the local one.
#[test]
fn thresholds_from_rest() {
    let quarter = std::f64::consts::FRAC_PI_2;
    for (phase, expected) in [(0.0, 2.868), (1.0, 3.791), (2.0, 2.870), (3.0, 3.431)] {
        let belt = decreasing_under(Waveform::Sine, 1.0);
        let shifted = |dither: &Dither| Dither { phase: phase * quarter, ..dither.clone() };
        let belt = belt.with_dithers(belt.dithers().iter().map(shifted).collect());
        let range = RealInterval::new(expected - 0.11, expected + 0.09);
        let at = |values: &[f64]| Ok(belt.with_amplitude(0, values[0]).expect("valid").system());
        let found = switches(&at, &|_, _| Ok(vec![0.0, 0.0]), range, 2);
        assert_eq!(found.first.is_quiet(), Some(true), "{found:?}");
        let [change] = &found.changes[..] else { panic!("{found:?}") };
        assert_eq!(change.becomes, RunOutcome::Vibrating);
        assert!((change.value - expected).abs() < 5e-3, "{phase}: {}", change.value);
    }
}

/// The corrector may move the last point of a continuation run beyond its window: the run ends at the window all the same. At
/// these amplitudes it once did not, and the response counted as lost.
#[test]
fn a_continuation_run_ends_at_the_end_of_its_window() {
    for amplitude in [9.95, 9.975, 10.0, 10.1, 10.35, 11.6] {
        let belt =
            decreasing_under(Waveform::Sine, 1.0).with_amplitude(0, amplitude).expect("valid");
        let orbit =
            base_response(&belt.system(), 8).unwrap_or_else(|why| panic!("{amplitude}: {why}"));
        assert_eq!(orbit.verdict(), OrbitVerdict::Stable, "{amplitude}");
        assert!(orbit.residual < 1e-9, "{amplitude}: {}", orbit.residual);
    }
}

/// Where a start cannot be computed the end is unknown.
#[test]
fn a_start_that_cannot_be_computed_is_not_quenched() {
    let no_start = || NoStart::OfStudy("no start".to_owned());
    let belt = decreasing_under(Waveform::Sine, 1.0);
    let at = |values: &[f64]| Ok(belt.with_amplitude(0, values[0]).expect("valid").system());
    let found = switches(&at, &|_, _| Err(no_start()), RealInterval::new(2.0, 3.0), 1);
    assert_eq!((found.first.is_quiet(), found.changes.len()), (None, 0));
    assert_eq!(found.unknown, [2.0, 3.0].map(|value| (value, NoOutcome::NoStart(no_start()))));
}

/// The changes of runs over a parameter, tried at equal steps.
pub(crate) fn switches(
    at: &(dyn Fn(&[f64]) -> Result<System, RefusedNumbers> + Sync),
    start: &StartOfRun<'_>,
    window: RealInterval,
    steps: u32,
) -> RunSwitches {
    let run = VariedRun { start, ramp: 0.0, at, most_steps: u64::MAX };
    let outcomes: Vec<_> =
        values_tried(window, steps).map(|value| (value, run.outcome(value))).collect();
    RunSwitches::of(&outcomes, |pairs| pairs.iter().map(|[a, b]| run.change(*a, *b)).collect())
}
