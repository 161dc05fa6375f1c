//! Loads under a friction law: the follower force is its limit, and a falling law destabilises a thick disc.

use quell_disc::boundaries::{NoBoundary, boundaries};
use quell_disc::instability::{InstabilityKind, origins};
use quell_disc::{dithered, undithered};
use quell_linear::floquet::NotFollowerDither;
use quell_model::disc::{Contributions, DiscDither, Load, Mode, Patch};
use quell_model::{Disc, LawKind};
use quell_numerics::floquet::Effort;

const DITHER: DiscDither = DiscDither::Normal { amplitude: 0.7, frequency_ratio: 2.7 };

fn disc(loads: Vec<Load>, dither: DiscDither, speed: f64) -> Disc {
    let shapes = [(0, 1.771_548, 0.658_8), (1, 1.807_665, 0.933_1), (2, 2.0, 0.934_7)];
    let mode =
        |(diameters, ratio, shape_at_load)| Mode { diameters, ratio, shape_at_load, damping: 1e-4 };
    Disc::new(shapes.map(mode).to_vec(), loads, dither, speed).expect("valid")
}

fn force(friction: f64) -> Load {
    Load::new(0.1, 0.08, 0.12, friction).at_angle(0.3)
}

fn pressed(normal_load: f64, half_thickness: f64) -> Load {
    Load { normal_load: Some(normal_load), half_thickness, ..force(0.0) }
}

fn under(kind: LawKind, numbers: &[f64], disc: Disc) -> Disc {
    disc.under_law(kind.build(numbers).expect("a law")).expect("valid")
}

fn coulomb(coefficient: f64, disc: Disc) -> Disc {
    under(LawKind::Coulomb, &[coefficient, coefficient, 0.0], disc)
}

/// A constant coefficient without thickness is the follower force, in every bit, forwards and backwards.
#[test]
fn a_constant_law_on_a_thin_disc_is_the_follower_force() {
    for speed in [0.3, -0.3] {
        for patch in [None, Some(Patch::sector(0.4, 3))] {
            let with = |load: Load| Load { patch: patch.clone(), ..load };
            let own = (0.25f64 * 0.8).copysign(speed);
            let plain = disc(vec![with(force(own))], DITHER, speed);
            let law = coulomb(0.25, disc(vec![with(pressed(0.8, 0.0))], DITHER, speed));
            let still = |disc: &Disc| undithered::growth(disc).expect("finite");
            let shaken = |disc: &Disc| dithered::growth(disc, Effort::default()).expect("finite");
            let (a, b) = (still(&plain), still(&law));
            let (c, d) = (shaken(&plain), shaken(&law));
            if patch.is_none() {
                assert_eq!((a, c), (b, d));
            }
            assert!((a.rate - b.rate).abs() < 1e-13 && (c.rate - d.rate).abs() < 1e-12);
        }
    }
}

#[test]
fn a_falling_law_destabilises_a_thick_disc() {
    // The sign of μ′ decides, in proportion to η².
    let rate = |numbers: &[f64], half_thickness: f64| {
        let disc = disc(vec![pressed(0.1, half_thickness)], DiscDither::None, 0.3);
        undithered::growth(&under(LawKind::Coulomb, numbers, disc)).expect("finite").rate
    };
    // 0.25 + 0.5 v is 0.4 at v = 0.3.
    let rising = |half| rate(&[0.25, 0.25, 0.5], half);
    let constant = |half| rate(&[0.4, 0.4, 0.0], half);
    let difference = |half: f64| constant(half) - rising(half);
    assert!((rising(0.0) - constant(0.0)).abs() < 1e-15);
    assert!(difference(0.05) > 1e-6, "{}", difference(0.05));
    let ratio = difference(0.05) / difference(0.025);
    assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    let falling = |half| {
        let disc = disc(vec![pressed(0.1, half)], DiscDither::None, 0.3);
        let law = under(LawKind::Stribeck, &[0.4, 0.2, 1.0], disc);
        undithered::growth(&law).expect("finite").rate
    };
    assert!(falling(0.05) > falling(0.0));
}

/// The tangent row is −(h/2r) times the slope row, and points at other radii slide faster or slower.
#[test]
fn rows_and_speeds_follow_the_radius() {
    let shapes = |_: f64| Some(vec![0.6588, 0.9331, 0.9347]);
    let patch = Patch::sector(0.0, 1).over_radii(0.75, 0.2, 2, shapes).expect("shapes");
    let loads = vec![Load { radius_ratio: Some(0.75), ..pressed(0.1, 0.04).over(patch) }];
    let system = coulomb(0.3, disc(loads, DiscDither::None, 0.5)).system();
    let mut force = 0.0;
    for (contact, x) in system.contacts.iter().zip([-1.0, 1.0]) {
        let radius = 1.0 + x / (3f64.sqrt() * 7.5);
        assert!((contact.surface_velocity.mean() - 0.5 * radius).abs() < 1e-14);
        let (tangent, slope) = (contact.tangent.as_ref(), contact.slope.as_ref());
        let (tangent, slope) = (tangent.expect("thick"), slope.expect("a slope"));
        for (t, s) in tangent.iter().zip(slope) {
            // t = −(h/2r) ∂_φ and s = (r₀/r) ∂_φ, with h/2r₀ = 0.04.
            assert!((t + 0.04 * s).abs() < 1e-15);
        }
        force += contact.normal_load;
    }
    assert!((force - 0.1).abs() < 1e-15);
}

#[test]
fn friction_is_the_cause_under_a_law_too() {
    let law = coulomb(0.5, disc(vec![pressed(1.0, 0.0)], DiscDither::None, 0.3));
    let motions = undithered::growing_with(&law, Contributions::ALL).expect("finite");
    let found = origins(&law, Contributions::ALL, &motions).expect("finite");
    assert!(!found.is_empty());
    let plain = disc(vec![force(0.5)], DiscDither::None, 0.3);
    assert_eq!(found, origins(&plain, Contributions::ALL, &motions).expect("finite"));
    assert!(found.iter().all(|shares| shares.kind() == Some(InstabilityKind::Friction)));
}

#[test]
fn what_does_not_fit_is_refused() {
    let law = LawKind::Coulomb.build(&[0.3, 0.3, 0.0]).expect("a law");
    let keys = |disc: Disc| {
        let complaints = disc.under_law(law.clone()).expect_err("refused");
        complaints.iter().map(|wrong| wrong.key.clone()).collect::<Vec<_>>()
    };
    let none = DiscDither::None;
    let both = Load { friction: 0.2, ..pressed(1.0, 0.0) };
    assert_eq!(keys(disc(vec![force(0.0)], none, 0.3)), ["disc.load.normal_load"]);
    assert_eq!(keys(disc(vec![both], none, 0.3)), ["disc.load.friction"]);
    assert_eq!(keys(disc(vec![pressed(1.0, 0.0)], none, 0.0)), ["disc.load.speed"]);
    let right = coulomb(0.3, disc(vec![pressed(1.0, 0.01)], DITHER, 0.3));
    assert!(right.at_speed(0.0).is_err());
    let heavier = right.with_each_load(|load| Load { normal_load: Some(2.0), ..load.clone() });
    assert_eq!(heavier.map(|disc| disc.law().is_some()), Ok(true));
    assert_eq!(boundaries(&right), Err(NoBoundary::NotPlain));
    let tangent = NotFollowerDither::Tangent { contact: 0 };
    assert_eq!(dithered::growth(&right, Effort::default()), Err(tangent));
}
