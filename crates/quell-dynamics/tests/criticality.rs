//! Whether bifurcations are supercritical: the exact coefficient of steady sliding against that of its flow, and against the
//! vibrations next to thresholds.

use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, MotionStart};
use quell_dynamics::orbit::{
    OrbitFamily, Threshold, ThresholdKind, branch_thresholds, free_cycle, near, sliding_state,
};
use quell_linear::criticality::of_steady_sliding;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{Friction, LawKind, System, Waveform};
use quell_numerics::continuation::PeriodMap;
use quell_numerics::continuation::criticality::{Criticality, first_lyapunov};
use quell_numerics::continuation::threshold::BifurcationKind;
use quell_numerics::eigen::Decomposition;
use quell_numerics::matrix::Matrix;
use quell_numerics::normal_form::CriticalPair;
use quell_numerics::polar::modulus;

fn structure(mass: [f64; 2], damping: [[f64; 2]; 2], stiffness: [[f64; 2]; 2]) -> Mechanical {
    let names = vec!["x".to_owned(), "y".to_owned()];
    let mass = MassMatrix::dense(Matrix::from_fn(2, 2, |i, j| if i == j { mass[i] } else { 0.0 }));
    let matrix = |rows: [[f64; 2]; 2]| Matrix::from_fn(2, 2, |i, j| rows[i][j]);
    Mechanical::new(names, mass, matrix(damping), matrix(stiffness))
}

fn contact(friction: Friction, speed: f64) -> Contact {
    Contact {
        name: "pad".to_owned(),
        tangent: Some(vec![1.0, 0.0]),
        force: None,
        normal: None,
        slope: None,
        normal_load: 1.0,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(speed),
        friction,
        varying_load: None,
    }
}

/// A pad that is pressed and tilted by its own motion: every term of the second and third derivatives is at work.
fn pad(friction: Friction, damping: f64, speed: f64) -> System {
    let rows = [[damping, 0.02], [-0.03, 0.05]];
    let contact = Contact {
        normal: Some(vec![0.3, 1.0]),
        slope: Some(vec![0.4, -0.7]),
        normal_stiffness: 0.8,
        tangential_stiffness: None,
        normal_damping: 0.05,
        ..contact(friction, speed)
    };
    let structure = structure([1.0, 1.7], rows, [[2.0, 0.3], [0.1, 1.1]]);
    System { structure: structure.into(), contacts: vec![contact], inputs: Vec::new() }
}

fn growth(system: &System) -> (f64, f64) {
    let linear = Linearised::new(system).expect("slides");
    let growth = spectrum::growth(&linear, &linear.friction()).expect("finite");
    (growth.rate, growth.frequency)
}

/// The value in a window at which the growth rate is zero.
fn root(at: impl Fn(f64) -> f64, (mut low, mut high): (f64, f64)) -> f64 {
    let sign = at(low) > 0.0;
    assert_ne!(sign, at(high) > 0.0, "no sign change: {} {}", at(low), at(high));
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if (at(middle) > 0.0) == sign { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn stribeck() -> Friction {
    LawKind::Stribeck.build(&[0.5, 0.3, 0.4]).expect("valid")
}

fn falling() -> Friction {
    LawKind::Decreasing.build(&[0.5, 0.3, 0.1]).expect("valid")
}

/// The flow over a time T has the coefficient T ω l₁ with the same critical vector.
#[test]
fn the_exact_coefficient_is_that_of_the_flow() {
    for (law, speed) in [(stribeck(), 0.2), (falling(), 0.15), (falling(), -0.15)] {
        let damping = root(|damping| growth(&pad(law.clone(), damping, speed)).0, (-0.5, 3.0));
        let system = pad(law.clone(), damping, speed);
        let exact = of_steady_sliding(&system).expect("a Hopf bifurcation");
        let motion = Motion::new(&system).expect("moves");
        let at = |_: &[f64]| Ok(system.clone());
        let family = OrbitFamily { at: &at, periods: 1, size: 4, scale: speed.abs() };
        let state = sliding_state(&system).expect("slides");
        let kind = BifurcationKind::NeimarkSacker;
        let flow = first_lyapunov(&family, &state, &[], kind, 2).expect("smooth");
        let factor = motion.time_scale() * growth(&system).1;
        let off = (flow.value / factor - exact.value).abs();
        let bound = flow.error / factor + exact.error;
        assert!(off <= bound, "{law:?} {speed}: {exact:?} {flow:?} {factor}");
        assert!(bound < 1e-5 * exact.value.abs(), "{exact:?} {flow:?}");
    }
}

/// A change of the unit of length multiplies l₁ by its inverse square; units of time and mass leave it as it is.
#[test]
fn the_coefficient_scales_as_one_over_length_squared() {
    let (length, time, mass) = (1e-3, 7.0, 250.0);
    let law = |length: f64| LawKind::Stribeck.build(&[0.5, 0.3, 0.4 * length]).expect("valid");
    let speed = 0.2;
    let damping = root(|damping| growth(&pad(law(1.0), damping, speed)).0, (-0.5, 3.0));
    let system = pad(law(1.0), damping, speed);
    let mut other = pad(law(length / time), damping, speed * length / time);
    let quell_model::system::Structure::Mechanical(mechanical) = &system.structure else {
        panic!("a mechanical structure")
    };
    let scaled =
        |matrix: &Matrix, factor: f64| Matrix::from_fn(2, 2, |i, j| factor * matrix[(i, j)]);
    let names = vec!["x".to_owned(), "y".to_owned()];
    let changed = Mechanical::new(
        names,
        MassMatrix::dense(scaled(&mechanical.mass().matrix(), mass)),
        scaled(mechanical.damping(), mass / time),
        scaled(mechanical.stiffness(), mass / time / time),
    );
    other.structure = changed.into();
    let contact = &mut other.contacts[0];
    contact.normal_load *= mass * length / time / time;
    contact.normal_stiffness *= mass / time / time;
    contact.normal_damping *= mass / time;
    contact.slope = contact.slope.take().map(|row| row.iter().map(|s| s / length).collect());
    let (own, other) = (of_steady_sliding(&system), of_steady_sliding(&other));
    let (own, other) = (own.expect("critical"), other.expect("critical"));
    let off = (other.value * length * length / own.value - 1.0).abs();
    assert!(off < 1e-11, "{own:?} {other:?}");
}

/// Just beyond a supercritical threshold the cycle has the amplitude 2r with r² = −Re λ/(ω l₁).
#[test]
fn a_small_cycle_has_the_amplitude_of_the_coefficient() {
    let block = |damping: f64| {
        let mut system = pad(stribeck(), damping, 0.2);
        system.contacts[0] = contact(stribeck(), 0.2);
        system
    };
    let critical = root(|damping| growth(&block(damping)).0, (-0.5, 3.0));
    let found = of_steady_sliding(&block(critical)).expect("a Hopf bifurcation");
    assert_eq!(found.criticality(), Some(Criticality::Supercritical));
    for share in [0.02, 0.005] {
        let system = block(critical * (1.0 - share));
        let (rate, frequency) = growth(&system);
        let radius = (-rate / (frequency * found.value)).sqrt();
        let linear = Linearised::new(&system).expect("slides");
        let matrix = linear.state_matrix_with(&linear.friction());
        let decomposition = Decomposition::new(&matrix).expect("finite");
        let index = (0..4).max_by(|&a, &b| {
            let value = |k: usize| decomposition.values()[k];
            value(a).re.total_cmp(&value(b).re).then(value(a).im.total_cmp(&value(b).im))
        });
        let pair = decomposition.pair(index.expect("four eigenvalues"));
        let pair = CriticalPair::new(&pair, 2).expect("simple");
        let steady = sliding_state(&system).expect("slides");
        let start: Vec<f64> =
            steady.iter().zip(&pair.right).map(|(x, q)| x + 2.0 * radius * q.re).collect();
        let cycle = free_cycle(&system, &start).expect("a cycle");
        assert!(cycle.events.is_empty(), "a cycle in pure slip");
        let deviation = cycle.state.iter().zip(&steady).map(|(x, s)| x - s);
        let part: num_complex::Complex64 = deviation.zip(&pair.left).map(|(x, p)| p * x).sum();
        let ratio = modulus(part) / radius;
        // The next order of the amplitude is as large as the distance from the threshold.
        assert!((ratio - 1.0).abs() < 3.0 * share.sqrt(), "{share}: {ratio}");
    }
}

/// Two masses; the first rubs on a belt, the dither acts on the second.
fn two_masses(friction: Friction, speed: f64, damping: f64, amplitude: f64) -> System {
    let structure =
        structure([1.0, 0.6], [[damping, -0.01], [-0.01, 0.05]], [[1.8, -0.8], [-0.8, 1.3]]);
    let wave =
        Wave { waveform: Waveform::Sine, amplitude, frequency: 3.7, phase: 0.0, envelope: None };
    let input = Input {
        target: InputTarget::Force(vec![0.0, 1.0]),
        profile: Profile::constant(0.0).with(wave),
    };
    System {
        structure: structure.into(),
        contacts: vec![contact(friction, speed)],
        inputs: vec![input],
    }
}

/// The Neimark–Sacker threshold of the damping.
fn torus(friction: &Friction, speed: f64) -> Threshold {
    let at = |values: &[f64]| Ok(two_masses(friction.clone(), speed, values[0], 0.1));
    let found = branch_thresholds(&at, 1.2, 0.1, 40, None).expect("a base response");
    let mut thresholds = found.thresholds.into_iter();
    thresholds.find(|found| found.kind == ThresholdKind::NeimarkSacker).expect("a threshold")
}

/// Modulus of the critical part of a run after some periods, from a start with that part.
fn carried(system: &System, orbit: &[f64], radius: f64, periods: u32) -> f64 {
    let at = |_: &[f64]| Ok(system.clone());
    let family = OrbitFamily { at: &at, periods: 1, size: 4, scale: 0.2 };
    let image = family.image(orbit, &[], None).expect("an image");
    let decomposition = Decomposition::new(&image.derivative).expect("finite");
    let index = (0..4).filter(|&k| decomposition.values()[k].im > 0.0).max_by(|&a, &b| {
        let size = |k: usize| modulus(decomposition.values()[k]);
        size(a).total_cmp(&size(b))
    });
    let pair = decomposition.pair(index.expect("a pair"));
    let pair = CriticalPair::new(&pair, 2).expect("simple");
    let state = orbit.iter().zip(&pair.right).map(|(x, q)| x + 2.0 * radius * q.re).collect();
    let motion = Motion::new(system).expect("moves");
    let until = f64::from(periods) * std::f64::consts::TAU / 3.7;
    let start = MotionStart { time: 0.0, state };
    let end = motion.run(&start, until, MOTION_TOLERANCE, &mut ()).expect("a run");
    let deviation = end.state.iter().zip(orbit).map(|(x, s)| x - s);
    modulus(deviation.zip(&pair.left).map(|(x, p)| p * x).sum())
}

/// (the orbit at a value, |λ| − 1).
fn orbit_at(system: &System, guess: &[f64]) -> (Vec<f64>, f64) {
    let orbit = near(system, guess, 1).expect("an orbit");
    let radius = orbit.radius();
    (orbit.state, radius - 1.0)
}

#[test]
fn a_supercritical_neimark_sacker_has_a_small_stable_torus_beyond() {
    let threshold = torus(&stribeck(), 0.2);
    let found = threshold.first_lyapunov.expect("smooth");
    assert_eq!(found.criticality(), Some(Criticality::Supercritical), "{threshold:?}");
    assert!(found.error < 1e-4 * found.value.abs(), "{found:?}");
    let beyond = two_masses(stribeck(), 0.2, 0.99 * threshold.value, 0.1);
    let (orbit, growth) = orbit_at(&beyond, &threshold.state);
    assert!(growth > 0.0, "unstable for less damping");
    let radius = (-growth / found.value).sqrt();
    let periods = (6.0 / growth).ceil();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand")]
    let periods = periods as u32;
    for first in [0.4 * radius, 1.7 * radius] {
        let last = carried(&beyond, &orbit, first, periods);
        assert!((last / radius - 1.0).abs() < 0.2, "{first} {last} {radius}");
    }
    let before = two_masses(stribeck(), 0.2, 1.01 * threshold.value, 0.1);
    let (orbit, growth) = orbit_at(&before, &threshold.state);
    assert!(growth < 0.0, "stable for more damping");
    let last = carried(&before, &orbit, radius, periods);
    assert!(last < 0.05 * radius, "{last} {radius}");
}

#[test]
fn a_subcritical_neimark_sacker_has_an_unstable_torus_before() {
    let threshold = torus(&falling(), 0.2);
    let found = threshold.first_lyapunov.expect("smooth");
    assert_eq!(found.criticality(), Some(Criticality::Subcritical), "{threshold:?}");
    assert!(found.error < 1e-4 * found.value.abs(), "{found:?}");
    let before = two_masses(falling(), 0.2, 1.005 * threshold.value, 0.1);
    let (orbit, growth) = orbit_at(&before, &threshold.state);
    assert!(growth < 0.0, "stable for more damping");
    let radius = (-growth / found.value).sqrt();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand")]
    let periods = (3.0 / -growth).ceil() as u32;
    let inside = carried(&before, &orbit, 0.6 * radius, periods);
    assert!(inside < 0.3 * radius, "{inside} {radius}");
    let outside = carried(&before, &orbit, 1.4 * radius, periods);
    assert!(outside > 2.0 * radius, "{outside} {radius}");
}
