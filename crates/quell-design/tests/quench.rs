//! Exact quench amplitudes of belts and systems against an independent program, the continuation over other ranges, and limits.

use quell_design::least_dither::amplitude_branch;
use quell_design::quench::{NoQuench, NotQuenched, quench};
use quell_dynamics::orbit::ThresholdKind;
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
use quell_numerics::interval::RealInterval;

fn belt(kind: LawKind, damping: f64, velocity: f64, waveform: Waveform, ratio: f64) -> Belt {
    let dither = Dither {
        direction: Direction::Tangential,
        waveform,
        amplitude: 123.0,
        frequency_ratio: ratio,
        phase: 0.4,
        envelope: None,
    };
    let law = kind.build(&[0.4, 0.2857, 0.2]).expect("a law");
    Belt::new(damping, 1.0, velocity, law, vec![dither]).expect("a belt")
}

/// Amplitudes from which the period-1 response is stable, by an independent program (`reference/quench_thresholds.json`).
#[test]
fn quench_amplitudes_of_an_independent_program() {
    let text = include_str!("../../../reference/quench_thresholds.json");
    let reference: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let mut judged = 0;
    for case in reference["cases"].as_array().expect("cases") {
        let number = |key: &str| case[key].as_f64().expect("a number");
        let kind = LawKind::from_name(case["law"].as_str().expect("a law")).expect("a law");
        let waveform = match case["waveform"].as_str() {
            Some("sine") => Waveform::Sine,
            Some("triangle") => Waveform::Triangle,
            _ => Waveform::Square,
        };
        let belt = belt(kind, 0.005, number("belt_velocity"), waveform, number("frequency_ratio"));
        let found = quench(&belt.system(), 0).expect("a base response");
        let Some(expected) = case["D_period1_stable_from"].as_f64() else { continue };
        let least = found.least().unwrap_or_else(|why| panic!("{case} {why:?} {found:?}"));
        // The numbers of the reference have nine digits.
        assert!((least.amplitude / expected - 1.0).abs() < 1e-7, "{case} {found:?}");
        judged += 1;
    }
    assert!(judged > 10, "{judged}");
}

/// Known thresholds of the decreasing law at v₀ = 1: sliding is stable, a weak dither destabilises it, a strong one quenches
/// again. The numbers are those of `reference/scripts/atlas.py` for these belts.
#[test]
fn quiet_amplitudes_of_two_intervals() {
    for (waveform, lost, last) in [
        (Waveform::Sine, 4.322_392_620_543, 9.900_214_849_173),
        (Waveform::Square, 3.295_664_191_249, 6.313_857_945_790),
    ] {
        let belt = belt(LawKind::Decreasing, 0.005, 1.0, waveform, 10.0);
        let found = quench(&belt.system(), 0).expect("a base response");
        assert_eq!(found.least(), Err(NotQuenched::QuietWithout));
        assert!((found.lost().expect("lost") - lost).abs() < 1e-10, "{found:?}");
        assert!((found.last().expect("quiet again") - last).abs() < 1e-10, "{found:?}");
        let kinds: Vec<_> = found.branch.changes.iter().map(|change| change.kind).collect();
        assert_eq!(kinds, [ThresholdKind::NeimarkSacker, ThresholdKind::Grazing]);
    }
}

/// Below the corner a Neimark–Sacker bifurcation ends the loud range, and averaging is near.
#[test]
fn a_neimark_sacker_bifurcation_can_quench() {
    let belt = belt(LawKind::Stribeck, 0.05, 0.17, Waveform::Sine, 20.0);
    let found = quench(&belt.system(), 0).expect("a base response");
    let least = found.least().expect("a quench amplitude");
    assert_eq!(least.kind, ThresholdKind::NeimarkSacker);
    assert_eq!((found.lost(), found.last()), (None, Some(least.amplitude)));
    let averaged = found.averaged().expect("averaging").expect("an amplitude");
    assert!((averaged / least.amplitude - 1.0).abs() < 5e-3, "{averaged} {least:?}");
}

/// The limit of the search decides nothing: the continuation up to other amplitudes finds the same.
#[test]
fn other_ranges_and_the_amplitude_of_the_study_change_nothing() {
    let belt = belt(LawKind::Decreasing, 0.02, 0.3, Waveform::Triangle, 7.0);
    let found = quench(&belt.system(), 0).expect("a base response");
    let least = found.least().expect("a quench amplitude").amplitude;
    let weak = quench(&belt.system().with_amplitude(0, 0.1), 0).expect("a response");
    assert_eq!(weak.branch, found.branch);
    for (to, steps) in [(1.3 * least, 5), (3.0 * least, 60)] {
        let system = belt.system();
        let at = |amplitude: f64| Ok(system.with_amplitude(0, amplitude));
        let other = amplitude_branch(&at, RealInterval::new(0.0, to), steps).expect("a branch");
        let first = other.changes[0];
        assert!((first.amplitude / least - 1.0).abs() < 1e-9, "{first:?} {least}");
    }
}

/// What has no quench amplitude has a reason.
#[test]
fn reasons() {
    let sliding = belt(LawKind::Stribeck, 0.005, 0.3, Waveform::Sine, 10.0);
    let found = quench(&sliding.system(), 0).expect("a base response");
    assert_eq!(found.least(), Err(NotQuenched::QuietWithout));
    assert_eq!((found.lost(), found.last()), (None, Some(0.0)));
    assert_eq!(found.averaged().expect("averaging"), Err(NotQuenched::QuietWithout));
    let without = quench(&sliding.undithered().system(), 0);
    assert!(matches!(without, Err(NoQuench::NoDither)), "{without:?}");
    let at_rest = sliding.with_belt_velocity(0.0).expect("a belt");
    let found = quench(&at_rest.system(), 0);
    assert!(matches!(found, Err(NoQuench::NoSteadySliding)), "{found:?}");
}
