//! The kind of an instability follows its cause.

use quell_disc::instability::{GrowthShares, InstabilityKind, origins};
use quell_disc::undithered::growing_with;
use quell_model::Disc;
use quell_model::disc::{Contributions, DiscDither, Load, Mode};

fn disc(load: Load, speed: f64) -> Disc {
    let shapes = [(0, 1.771_548, 0.658_8), (1, 1.807_665, 0.933_1), (2, 2.0, 0.934_7)];
    let mode =
        |(diameters, ratio, shape_at_load)| Mode { diameters, ratio, shape_at_load, damping: 1e-4 };
    let modes = shapes.map(mode).to_vec();
    Disc::new(modes, vec![load], DiscDither::None, speed).expect("valid")
}

fn unstable(disc: &Disc) -> Vec<(f64, GrowthShares)> {
    let motions = growing_with(disc, Contributions::ALL).expect("finite");
    let origins = origins(disc, Contributions::ALL, &motions).expect("finite");
    motions.iter().map(|motion| motion.rate).zip(origins).collect()
}

fn kinds(load: &Load, speeds: impl Iterator<Item = f64>) -> Vec<InstabilityKind> {
    let found = speeds.flat_map(|speed| unstable(&disc(load.clone(), speed)));
    found.map(|(_, origin)| origin.kind().expect("a cause")).collect()
}

fn speeds(from: f64, to: f64) -> impl Iterator<Item = f64> {
    (0..60).map(move |k| from + (to - from) * f64::from(k) / 59.0)
}

/// One part alone is the cause of every instability, whichever side of the worst strength it is on.
#[test]
fn one_part_alone_is_the_cause() {
    for (load, kind) in [
        (Load::new(0.3, 0.0, 0.0, 0.0), InstabilityKind::Terminal),
        (Load::new(0.0, 0.05, 0.0, 0.0), InstabilityKind::Damping),
        (Load::new(0.0, 0.0, 0.3, 0.0), InstabilityKind::Stiffness),
        (Load::new(0.0, 0.0, 0.0, 0.05), InstabilityKind::Friction),
    ] {
        let found = kinds(&load, speeds(0.2, 2.5));
        assert!(!found.is_empty(), "{kind:?}");
        assert!(found.iter().all(|found| *found == kind), "{kind:?} {found:?}");
    }
}

/// The share of a part alone is the growth and what the plate's damping takes from it.
#[test]
fn the_share_of_one_part_is_the_whole_growth() {
    let found = unstable(&disc(Load::new(0.0, 0.0, 0.3, 0.0), 1.02));
    let (rate, origin) = found[0];
    let [mass, damper, spring, friction] = origin.shares;
    assert_eq!([mass, damper, friction], [0.0; 3]);
    assert!(spring > rate && spring < rate + 2.1e-4, "{spring} {rate}");
}

/// Iwan and Stahl: just above the critical speed the spring is the cause, further beyond it the mass.
#[test]
fn stiffness_comes_before_terminal() {
    let load = Load::new(0.3, 0.0, 0.3, 0.0);
    let below = kinds(&load, speeds(1.001, 1.03));
    assert!(
        !below.is_empty() && below.iter().all(|kind| *kind == InstabilityKind::Stiffness),
        "{below:?}"
    );
    let beyond = kinds(&load, speeds(1.8, 3.0));
    assert!(beyond.contains(&InstabilityKind::Terminal), "{beyond:?}");
}

/// Below the critical speed only friction can be the cause: without it the loads are conservative or dissipative.
#[test]
fn below_the_critical_speed_friction_is_the_cause() {
    let load = Load::new(0.1, 0.1, 0.1, 0.3);
    let found = kinds(&load, speeds(0.05, 0.95));
    assert!(!found.is_empty());
    assert!(found.iter().all(|kind| *kind == InstabilityKind::Friction), "{found:?}");
    assert_eq!(InstabilityKind::Friction.name(), "friction");
    assert_eq!(GrowthShares { shares: [-1.0, 0.0, -2.0, 0.0], rate: 0.1 }.kind(), None);
}
