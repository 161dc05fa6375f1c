//! Attractors against known ones: locking ratios, coexistence, and thresholds at which responses lose stability.

use quell_dynamics::attractor::{
    Attractor, AttractorKind, AttractorSettings, BasinLabel, Patience, Ratio, SettleOutcome,
    Settled, gather, measure, settle, settle_many,
};
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::simulation::Start;
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
use quell_zoo::belt::{self, decreasing_under, stribeck_under};

fn reached(belt: &Belt, displacement: f64, velocity: f64) -> (Settled, Option<Attractor>) {
    let settings = AttractorSettings::new(belt).expect("a strobe");
    let start = Start { time: 0.0, displacement, velocity };
    let settled = settle(&settings, start, Patience::SWEEP).expect("no stall");
    let attractor = measure(&settings, &settled).expect("no stall");
    (settled, attractor)
}

/// The slow frequency of figure 2.3(a) is 10·5/68, that of figure 3.9(b) 10/13.
#[test]
fn responses_below_the_threshold_lock_at_known_fractions() {
    for (waveform, turns, periods, frequency) in
        [(Waveform::Sine, 5, 68, 0.735_29), (Waveform::Square, 1, 13, 0.769_23)]
    {
        let belt = stribeck_under(waveform, 0.3);
        let (settled, attractor) = reached(&belt, 0.0, 0.0);
        let attractor = attractor.expect("settled");
        assert_eq!(settled.outcome, SettleOutcome::Elsewhere);
        let rotation = attractor.rotation.expect("a slow phase");
        assert_eq!(rotation.ratio, Some(Ratio { turns, periods }), "{attractor:?}");
        let period = std::f64::consts::TAU / 10.0;
        let found = attractor.frequency(period).expect("a slow phase");
        assert!((found - frequency).abs() < 1e-5, "{found}");
        let AttractorKind::Periodic { periods: closed, radius } = attractor.kind else {
            panic!("{:?}", attractor.kind)
        };
        assert_eq!(closed, periods);
        assert_eq!(attractor.section.len(), periods as usize);
        // Sticking removes one dimension; on a locked response the other contracts.
        assert!(radius < 1.0 && attractor.stick_fraction > 0.01, "{attractor:?}");
    }
}

/// v₀ = 1, decreasing law: the base response and a large stick-slip cycle coexist below D = 4.32239; between there and 9.90021
/// the base response is unstable, which so near the threshold only growth rates can decide.
#[test]
fn the_base_response_and_squeal_coexist_below_the_local_threshold() {
    for (amplitude, stable, quenched_from_afar) in [
        (0.0, true, false),
        (2.5, true, false),
        (4.3, true, false),
        (4.34, false, false),
        (9.89, false, false),
        (9.91, true, true),
    ] {
        let belt = decreasing_under(Waveform::Sine, amplitude);
        let settings = AttractorSettings::new(&belt).expect("a strobe");
        let base = settings.base.clone().expect("an orbit");
        assert_eq!(base.verdict == OrbitVerdict::Stable, stable, "{amplitude}");
        // From the orbit itself: a run leaves it if it is unstable.
        let (settled, _) = reached(&belt, base.displacement, base.velocity);
        assert_eq!(settled.outcome == SettleOutcome::Base, stable, "{amplitude}");
        let (settled, attractor) = reached(&belt, 1.5, 0.0);
        assert_eq!(
            settled.outcome == SettleOutcome::Base,
            quenched_from_afar,
            "{amplitude} {settled:?}"
        );
        let size = attractor.expect("settled").size();
        if !quenched_from_afar && amplitude < 9.0 {
            assert!(size > 1.2, "{amplitude}: {size}");
        }
    }
}

/// From x = 1.5 the undithered cycle of the decreasing law has a peak-to-peak of 2.09; that of the Stribeck law at v₀ = 0.05
/// has a frequency of 0.654435.
#[test]
fn cycles_without_dither_have_their_size_and_frequency() {
    let (settled, attractor) = reached(&belt::decreasing(), 1.5, 0.0);
    assert_eq!(settled.outcome, SettleOutcome::Elsewhere);
    let size = attractor.expect("settled").size();
    assert!((size - 2.09).abs() < 0.005, "{size}");
    let (_, attractor) = reached(&belt::stribeck(), 0.0, 0.0);
    let attractor = attractor.expect("settled");
    assert!((attractor.size() - 2.0 * 0.146_395).abs() < 1e-5, "{}", attractor.size());
    let found = attractor.frequency(0.1 * std::f64::consts::TAU).expect("a slow phase");
    assert!((found - 0.654_435).abs() < 1e-5, "{found}");
    // Steady sliding above the critical velocity.
    let (settled, attractor) = reached(&belt::decreasing(), 0.3, 0.0);
    assert_eq!(settled.outcome, SettleOutcome::Base);
    assert_eq!(attractor.expect("settled").size(), 0.0);
}

/// Figure 4.11 with a sine, D_N = 0.69: a curve on which the motion nearly repeats itself after five periods is filled so slowly
/// that runs on it differ in centre and size. It is one attractor.
#[test]
fn a_curve_near_a_resonance_is_one_attractor() {
    let dither = Dither {
        direction: Direction::Normal,
        waveform: Waveform::Sine,
        amplitude: 0.69,
        frequency_ratio: 5.0,
        phase: 0.0,
        envelope: None,
    };
    let law = LawKind::Decreasing.build(&[0.4, 0.2857, 0.2]).expect("a law");
    let belt = Belt::new(0.2, 1.0, 0.075, law, vec![dither]).expect("a belt");
    let settings = AttractorSettings::new(&belt).expect("a strobe");
    let starts: Vec<Start> = (0..49)
        .map(|k| Start {
            time: 0.0,
            displacement: 0.34 + 0.05 / 6.0 * f64::from(k % 7),
            velocity: -0.08 + 0.01 * f64::from(k / 7),
        })
        .collect();
    let found = gather(&settings, &settle_many(&settings, &starts, Patience::BASIN));
    let found = found.expect("no stall");
    assert_eq!((found.basins.len(), found.unknown()), (2, 0));
    let counts: Vec<usize> = found.basins.iter().map(|basin| basin.starts).collect();
    assert_eq!(counts.iter().sum::<usize>(), starts.len());
    let labelled =
        |place| found.labels.iter().filter(|label| **label == BasinLabel::Attractor(place)).count();
    assert_eq!(counts, [labelled(0), labelled(1)]);
    assert!(found.basins[0].attractor.quiet && counts[0] < counts[1]);
}

/// Along a line of starts at D = 2.5 the basin of the base response is one interval, and the bits of a run do not depend on the
/// other runs of a batch.
#[test]
fn a_line_of_starts_has_two_attractors() {
    let belt = decreasing_under(Waveform::Sine, 2.5);
    let settings = AttractorSettings::new(&belt).expect("a strobe");
    let starts: Vec<Start> = (0..40)
        .map(|k| Start { time: 0.0, displacement: -1.4 + 0.09 * f64::from(k), velocity: 0.0 })
        .collect();
    let all = settle_many(&settings, &starts, Patience::BASIN);
    let alone: Vec<_> = starts
        .chunks(7)
        .flat_map(|starts| settle_many(&settings, starts, Patience::BASIN))
        .collect();
    assert_eq!(all, alone);
    let found = gather(&settings, &all).expect("no stall");
    assert_eq!((found.basins.len(), found.unknown()), (2, 0), "{found:?}");
    assert!(found.basins[0].attractor.quiet && !found.basins[1].attractor.quiet);
    let quenched: Vec<bool> =
        found.labels.iter().map(|label| *label == BasinLabel::Attractor(0)).collect();
    let changes = quenched.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!(changes, 2, "{quenched:?}");
    assert_eq!(quenched.iter().filter(|quenched| **quenched).count(), found.basins[0].starts);
    // A single long run from some of the starts agrees.
    for (start, quenched) in starts.iter().zip(&quenched).step_by(9) {
        let settled = settle(&settings, *start, Patience::SWEEP).expect("no stall");
        assert_eq!(settled.outcome == SettleOutcome::Base, *quenched, "{start:?}");
    }
}
