//! Loads over an area, and loads on pads and calipers: limits and convergence.

use quell_disc::boundaries::{NoBoundary, boundaries};
use quell_disc::dithered;
use quell_disc::partition::{NoPartition, crossings};
use quell_disc::resonance::{WaveError, Waves};
use quell_disc::undithered::{eigenvalues, growth};
use quell_model::disc::{Carrier, DiscDither, Load, Mode, Patch};
use quell_model::{Disc, System};
use quell_numerics::floquet::Effort;

const DITHER: DiscDither = DiscDither::Normal { amplitude: 0.7, frequency_ratio: 2.7 };

fn modes() -> Vec<Mode> {
    let shapes = [(0, 1.771_548, 0.658_8), (1, 1.807_665, 0.933_1), (2, 2.0, 0.934_7)];
    let mode =
        |(diameters, ratio, shape_at_load)| Mode { diameters, ratio, shape_at_load, damping: 1e-4 };
    shapes.map(mode).to_vec()
}

fn load() -> Load {
    Load::new(0.1, 0.08, 0.12, 0.05).at_angle(0.3)
}

fn disc_of(load: Load, dither: DiscDither) -> Disc {
    Disc::new(modes(), vec![load], dither, 0.3).expect("valid")
}

fn rate(load: Load) -> f64 {
    growth(&disc_of(load, DiscDither::None)).expect("finite").rate
}

fn dithered_rate(load: Load) -> f64 {
    dithered::growth(&disc_of(load, DITHER), Effort::default()).expect("finite").rate
}

#[test]
fn a_patch_of_no_extent_is_a_point() {
    let point = disc_of(load(), DITHER).system();
    let patch = disc_of(load().over(Patch::sector(0.0, 8)), DITHER).system();
    let parts = |system: &System| {
        let structure = system.structure.mechanical().expect("mechanical").clone();
        (structure.mass().matrix(), structure.damping().clone(), structure.stiffness().clone())
    };
    assert_eq!(parts(&point), parts(&patch));
    assert_eq!(point.inputs, patch.inputs);
    let mut contacts = patch.contacts.clone();
    contacts[0].name.clone_from(&point.contacts[0].name);
    assert_eq!(point.contacts, contacts);
    // The difference falls with the square of the extent.
    let plain = rate(load());
    let difference = |extent: f64| rate(load().over(Patch::sector(extent, 8))) - plain;
    let (wide, narrow) = (difference(0.02), difference(0.01));
    assert!(wide.abs() > 1e-9 && (wide / narrow - 4.0).abs() < 0.02, "{wide} {narrow}");
}

#[test]
fn a_patch_converges_with_its_points() {
    for of in [rate as fn(Load) -> f64, dithered_rate] {
        let at = |points| of(load().over(Patch::sector(1.2, points)));
        let exact = at(40);
        let errors = [1, 2, 3, 4].map(|points| (at(points) - exact).abs());
        assert!(errors.windows(2).all(|pair| pair[1] < 0.2 * pair[0]), "{errors:?}");
        let enough = Patch::enough_points(1.2, 2);
        assert!((at(enough) - exact).abs() < 1e-12, "{enough}: {}", at(enough) - exact);
    }
}

/// Over the whole circle a patch has no preferred angle: the modes are not coupled, each has the mean ⟨cos²⟩ = ½.
#[test]
fn a_patch_all_around_is_a_ring() {
    let ring = Load::new(0.0, 0.0, 0.12, 0.0)
        .over(Patch::sector(std::f64::consts::TAU, Patch::enough_points(6.3, 2)));
    let disc = Disc::new(modes(), vec![ring], DiscDither::None, 0.0).expect("valid");
    let found = eigenvalues(&disc).expect("finite");
    for mode in modes() {
        let mean = if mode.diameters == 0 { 1.0 } else { 0.5 };
        let square =
            mode.ratio * mode.ratio + mean * 0.12 * mode.shape_at_load * mode.shape_at_load;
        let frequency = (square - (mode.damping * mode.ratio).powi(2)).sqrt();
        assert!(found.iter().any(|value| (value.im - frequency).abs() < 1e-12), "{mode:?}");
    }
}

#[test]
fn a_patch_over_the_radius_shares_the_load_by_area() {
    let shapes = |_| Some(vec![0.6588, 0.9331, 0.9347]);
    let patch = Patch::sector(0.0, 1).over_radii(0.75, 0.2, 6, shapes).expect("shapes");
    let sum: f64 = patch.radii.iter().map(|at| at.weight).sum();
    assert!((sum - 1.0).abs() < 1e-14);
    // The moment arm cancels the area, so that the whole follower force has the weight of the width alone.
    let levers: f64 = patch.radii.iter().map(|at| at.weight * at.lever).sum();
    assert!((levers - 1.0).abs() < 1e-14);
    assert!((rate(load().over(patch)) - rate(load())).abs() < 1e-12);
}

#[test]
fn a_rigid_pad_is_the_ground() {
    let plain = [rate(load()), dithered_rate(load())];
    let pad = |stiffness| Carrier { mass: 0.02, damping: 0.0, stiffness };
    let mut before = [f64::INFINITY; 2];
    for stiffness in [1e3, 1e4, 1e5] {
        let on = load().on_pad(pad(stiffness));
        let both = load().on_pad(pad(stiffness)).on_caliper(pad(2.0 * stiffness));
        for (of, plain) in [rate as fn(Load) -> f64, dithered_rate].into_iter().zip(plain) {
            // The plate's own waves come near those of the load at rest; a stiff undamped pad may grow no faster than they do.
            let difference = (of(on.clone()) - plain).abs();
            assert!(difference < 0.1 / stiffness, "{stiffness}: {difference}");
            assert!((of(both.clone()) - plain).abs() < 0.2 / stiffness);
        }
        let now = [(rate(on.clone()) - plain[0]).abs(), (dithered_rate(on) - plain[1]).abs()];
        assert!(now[0] < before[0] && now[1] < before[1]);
        before = now;
    }
}

/// A pad on a disc that does not couple to it is an oscillator of its own on the springs of contact and pad.
#[test]
fn a_pad_and_a_caliper_oscillate() {
    let (pad, caliper) = (
        Carrier { mass: 0.2, damping: 0.0, stiffness: 0.9 },
        Carrier { mass: 0.5, damping: 0.0, stiffness: 1.4 },
    );
    let mode = Mode { diameters: 0, ratio: 3.0, shape_at_load: 0.0, damping: 0.0 };
    let load = Load::new(0.1, 0.0, 0.3, 0.0).on_pad(pad).on_caliper(caliper);
    let disc = Disc::new(vec![mode], vec![load], DiscDither::None, 0.4).expect("valid");
    assert_eq!(disc.coordinates(), 3);
    assert_eq!(disc.system().structure.names(), ["A0", "pad 0", "caliper 0"]);
    let found = eigenvalues(&disc).expect("finite");
    // det [k + k_p − m_p w, −k_p; −k_p, k_p + k_c − m_c w] = 0.
    let (a, b): (f64, f64) = (0.2 * 0.5, -(0.2 * 2.3 + 0.5 * 1.2));
    let root = (b * b - 4.0 * a * (1.2 * 2.3 - 0.81)).sqrt();
    for square in [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)] {
        assert!(found.iter().any(|value| (value.im - square.sqrt()).abs() < 1e-12), "{found:?}");
    }
}

#[test]
fn numbers_of_pads_have_bounds() {
    let pad = Carrier { mass: 0.2, damping: 0.01, stiffness: 0.9 };
    let disc = disc_of(load().on_pad(pad), DiscDither::None);
    let on = |pad: Carrier| disc.with_each_load(|load| load.clone().on_pad(pad));
    let stiffer = on(Carrier { stiffness: 2.0, ..pad }).expect("in bounds");
    assert_eq!(stiffer.loads()[0].pad.map(|pad| pad.stiffness), Some(2.0));
    assert!(on(Carrier { mass: 0.0, ..pad }).is_err());
    let loose = Disc::new(modes(), vec![load().on_caliper(pad)], DiscDither::None, 0.0);
    let complaints = loose.expect_err("no pad");
    assert_eq!(
        complaints.iter().next().map(|wrong| wrong.key.as_str()),
        Some("disc.load.pad_mass")
    );
}

#[test]
fn closed_forms_are_refused() {
    let pad = Carrier { mass: 0.2, damping: 0.0, stiffness: 0.9 };
    for load in [load().on_pad(pad), load().over(Patch::sector(0.1, 8))] {
        assert_eq!(boundaries(&disc_of(load.clone(), DiscDither::None)), Err(NoBoundary::NotPlain));
        assert_eq!(crossings(&disc_of(load.clone(), DITHER)), Err(NoPartition::NotPlain));
        assert_eq!(Waves::new(&disc_of(load, DITHER)), Err(WaveError::NotPlain));
    }
}

#[test]
fn every_load_and_every_body_counts() {
    let pad = Carrier { mass: 0.2, damping: 0.01, stiffness: 0.9 };
    let loads = vec![
        load(),
        load().at_angle(2.0).over(Patch::sector(0.4, 3)),
        load().at_angle(4.0).over(Patch::sector(0.4, 3)).on_pad(pad),
    ];
    let disc = Disc::new(modes(), loads, DITHER, 0.3).expect("valid");
    let system = disc.system();
    assert_eq!(system.contacts.len(), 7);
    assert_eq!(system.structure.size(), 6);
    assert!(growth(&disc).is_ok());
    assert!(dithered::growth(&disc, Effort::default()).is_ok());
}

/// At the critical speed the forward wave of the free disc stands still under the loads, centrifugal stress included.
#[test]
fn centrifugal_stress_raises_frequencies_and_critical_speeds() {
    let undamped: Vec<Mode> =
        modes().into_iter().map(|mode| Mode { damping: 0.0, ..mode }).collect();
    let free = Disc::new(undamped, Vec::new(), DiscDither::None, 0.4).expect("valid");
    let disc = free.clone().stiffened(vec![0.5, 1.5, 3.0]).expect("valid");
    let found = eigenvalues(&disc).expect("finite");
    for (index, mode) in disc.modes().iter().enumerate() {
        let own = (mode.ratio * mode.ratio + disc.centrifugal(index) * 0.16).sqrt();
        assert!((disc.ratio_at_speed(index) - own).abs() < 1e-15);
        let q = mode.diameters as f64;
        for wave in [own - 0.4 * q, own + 0.4 * q] {
            assert!(found.iter().any(|value| (value.im - wave.abs()).abs() < 1e-12), "{mode:?}");
        }
    }
    // κ ≥ q² holds the wave ahead of the loads at any speed.
    assert_eq!([0, 1].map(|mode| disc.critical_speed(mode)), [None, None]);
    let critical = disc.critical_speed(2).expect("κ < q²");
    let there = eigenvalues(&disc.at_speed(critical).expect("in bounds")).expect("finite");
    let slowest = there.iter().map(|value| value.norm_sqr().sqrt()).fold(1.0, f64::min);
    assert!(critical > 1.0 && slowest < 1e-7, "{critical} {slowest}");
    assert_eq!(free.critical_speed(2), Some(1.0));
    // No stiffening leaves the same bits, and every rebuilt disc keeps its own.
    assert_eq!(free.clone().stiffened(vec![0.0; 3]).expect("valid"), free);
    assert!(disc.at_speed(0.1).expect("in bounds").is_stiffened());
    assert!(free.stiffened(vec![-1.0, 0.0, 0.0]).is_err());
}
