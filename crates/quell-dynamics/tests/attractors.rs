//! Attractors against known ones: locking ratios, coexistence, thresholds between which responses are lost.

use quell_dynamics::attractor::{
    Attractor, Kind, Label, Outcome, Patience, Ratio, Scene, Settled, gather, measure, settle,
    settle_many,
};
use quell_dynamics::orbit::Verdict;
use quell_dynamics::simulation::Start;
use quell_model::{Belt, Waveform};
use quell_zoo::belt::{self, decreasing_under, stribeck_under};

fn reached(belt: &Belt, displacement: f64, velocity: f64) -> (Settled, Option<Attractor>) {
    let scene = Scene::new(belt).expect("a strobe");
    let start = Start { time: 0.0, displacement, velocity };
    let settled = settle(&scene, start, Patience::SWEEP).expect("no stall");
    let attractor = measure(&scene, &settled).expect("no stall");
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
        assert_eq!(settled.outcome, Outcome::Elsewhere);
        let rotation = attractor.rotation.expect("it turns");
        assert_eq!(rotation.ratio, Some(Ratio { turns, periods }), "{attractor:?}");
        let period = std::f64::consts::TAU / 10.0;
        let found = attractor.frequency(period).expect("it turns");
        assert!((found - frequency).abs() < 1e-5, "{found}");
        let Kind::Periodic { periods: closed, radius } = attractor.kind else {
            panic!("{:?}", attractor.kind)
        };
        assert_eq!(closed, periods);
        assert_eq!(attractor.section.len(), periods as usize);
        // A stick takes one dimension, locking makes the rest contract.
        assert!(radius < 1.0 && attractor.stick_fraction > 0.01, "{attractor:?}");
    }
}

/// v₀ = 1, decreasing law: the quiet response and a large stick-slip cycle live side by side below D = 4.32239; between there
/// and 9.90021 the quiet one is unstable, and so near the threshold it takes growth rates to say so.
#[test]
fn rest_and_squeal_coexist_below_the_local_threshold() {
    for (amplitude, quiet_from_orbit, from_afar) in [
        (0.0, true, false),
        (2.5, true, false),
        (4.3, true, false),
        (4.34, false, false),
        (9.89, false, false),
        (9.91, true, true),
    ] {
        let belt = decreasing_under(Waveform::Sine, amplitude);
        let scene = Scene::new(&belt).expect("a strobe");
        let quiet = scene.quiet.clone().expect("an orbit");
        assert_eq!(quiet.verdict == Verdict::Stable, quiet_from_orbit, "{amplitude}");
        // On the orbit itself: an unstable one is left.
        let (settled, _) = reached(&belt, quiet.displacement, quiet.velocity);
        assert_eq!(settled.outcome == Outcome::Quiet, quiet_from_orbit, "{amplitude}");
        let (settled, attractor) = reached(&belt, 1.5, 0.0);
        assert_eq!(settled.outcome == Outcome::Quiet, from_afar, "{amplitude} {settled:?}");
        let size = attractor.expect("settled").size();
        if !from_afar && amplitude < 9.0 {
            assert!(size > 1.2, "{amplitude}: {size}");
        }
    }
}

/// From x = 1.5 the undithered cycle has a peak-to-peak of 2.09, and the Stribeck law's of v₀ = 0.05 a frequency of 0.654435.
#[test]
fn cycles_without_dither_have_their_size_and_frequency() {
    let (settled, attractor) = reached(&belt::decreasing(), 1.5, 0.0);
    assert_eq!(settled.outcome, Outcome::Elsewhere);
    let size = attractor.expect("settled").size();
    assert!((size - 2.09).abs() < 0.005, "{size}");
    let (_, attractor) = reached(&belt::stribeck(), 0.0, 0.0);
    let attractor = attractor.expect("settled");
    assert!((attractor.size() - 2.0 * 0.146_395).abs() < 1e-5, "{}", attractor.size());
    let found = attractor.frequency(0.1 * std::f64::consts::TAU).expect("it turns");
    assert!((found - 0.654_435).abs() < 1e-5, "{found}");
    // Steady sliding above the critical velocity.
    let (settled, attractor) = reached(&belt::decreasing(), 0.3, 0.0);
    assert_eq!(settled.outcome, Outcome::Quiet);
    assert_eq!(attractor.expect("settled").size(), 0.0);
}

/// Along a line of starts at D = 2.5 the basin of the quiet response is one stretch, and what is computed in one company
/// has the same bits in another.
#[test]
fn a_line_of_starts_has_two_attractors() {
    let belt = decreasing_under(Waveform::Sine, 2.5);
    let scene = Scene::new(&belt).expect("a strobe");
    let starts: Vec<Start> = (0..40)
        .map(|k| Start { time: 0.0, displacement: -1.4 + 0.09 * f64::from(k), velocity: 0.0 })
        .collect();
    let all = settle_many(&scene, &starts, Patience::BASIN);
    let alone: Vec<_> =
        starts.chunks(7).flat_map(|starts| settle_many(&scene, starts, Patience::BASIN)).collect();
    assert_eq!(all, alone);
    let found = gather(&scene, &all).expect("no stall");
    assert_eq!((found.basins.len(), found.unknown()), (2, 0), "{found:?}");
    assert!(found.basins[0].attractor.quiet && !found.basins[1].attractor.quiet);
    let quiet: Vec<bool> = found.labels.iter().map(|label| *label == Label::Attractor(0)).collect();
    let changes = quiet.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!(changes, 2, "{quiet:?}");
    assert_eq!(quiet.iter().filter(|it| **it).count(), found.basins[0].starts);
    // Both ends of the stretch by one run alone, slowly.
    for (start, quiet) in starts.iter().zip(&quiet).step_by(9) {
        let settled = settle(&scene, *start, Patience::SWEEP).expect("no stall");
        assert_eq!(settled.outcome == Outcome::Quiet, *quiet, "{start:?}");
    }
}
