//! Small changes of motions whose contacts have states of their own: against differences, closed forms and the rigid contact.

use quell_dynamics::motion::{
    ContactPhase, MOTION_TOLERANCE, Motion, MotionEnd, MotionStart, MotionVariation,
};
use quell_dynamics::orbit::{base_response, near, settled, sliding_state};
use quell_dynamics::simulation::EventKind;
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{Belt, Direction, Dither, LawKind, System, Waveform};
use quell_numerics::continuation::multipliers;
use quell_numerics::matrix::Matrix;
use quell_numerics::polar::modulus;

const COULOMB: [f64; 3] = [0.3, 0.3, 0.0];
const FALLING: [f64; 5] = [0.25, 0.4, 0.1, 2.0, 0.05];
/// Above its static level at every slip.
const RISING: [f64; 5] = [0.3, 0.3, 0.1, 2.0, 0.5];
const BRISTLES: [f64; 6] = [0.3, 0.4, 0.05, 100.0, 2.0, 0.02];

fn dither(direction: Direction, amplitude: f64, frequency_ratio: f64) -> Dither {
    Dither {
        direction,
        waveform: Waveform::Sine,
        amplitude,
        frequency_ratio,
        phase: 0.3,
        envelope: None,
    }
}

fn belt(
    velocity: f64,
    (law, values): (LawKind, &[f64]),
    stiffness: Option<f64>,
    dithers: Vec<Dither>,
) -> System {
    let law = law.build(values).expect("a law");
    let belt = Belt::new(0.02, 1.0, velocity, law, dithers).expect("a belt");
    belt.with_tangential_stiffness(stiffness).expect("a stiffness").system()
}

/// A mass on a compliant contact that a force lifts off, with a slope that turns its friction.
fn bouncing((law, values): (LawKind, &[f64]), stiffness: Option<f64>) -> System {
    let structure = Mechanical::new(
        vec!["x".to_owned(), "y".to_owned()],
        MassMatrix::identity(2),
        Matrix::from_fn(2, 2, |i, j| if i == j { 0.1 } else { 0.0 }),
        Matrix::from_fn(2, 2, |i, j| [[1.0, 0.2], [0.2, 0.5]][i][j]),
    );
    let contact = Contact {
        name: "pad".to_owned(),
        tangent: Some(vec![1.0, 0.0]),
        force: None,
        normal: Some(vec![0.0, 1.0]),
        slope: Some(vec![0.1, 0.0]),
        normal_load: 1.0,
        normal_stiffness: 4.0,
        tangential_stiffness: stiffness,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(0.3),
        friction: law.build(values).expect("a law"),
        varying_load: None,
    };
    let wave = Wave {
        waveform: Waveform::Sine,
        amplitude: 1.5,
        frequency: 2.0,
        phase: 0.0,
        envelope: None,
    };
    let target = InputTarget::Force(vec![0.1, 1.0]);
    let input = Input { target, profile: Profile::constant(0.0).with(wave) };
    System { structure: structure.into(), contacts: vec![contact], inputs: vec![input] }
}

/// The derivative of the state after a time by the state, and what the contact does at both ends.
fn variation(system: &System, start: &MotionStart, until: f64) -> (Matrix, Vec<EventKind>) {
    let motion = Motion::new(system).expect("a motion");
    let mut variation = MotionVariation::new(&motion).expect("equations");
    motion.run(start, until, MOTION_TOLERANCE, &mut variation).expect("an end");
    assert!(!variation.has_failed && !variation.is_one_sided, "{:?}", system.contacts);
    (variation.matrix(), variation.events.iter().map(|event| event.kind).collect())
}

/// The same by differences of fourth order; the number of a slider that slides at the start is no variable of its own.
fn differences(system: &System, start: &MotionStart, until: f64, slides: bool) -> Matrix {
    let motion = Motion::new(system).expect("a motion");
    let (size, own) = (motion.size(), motion.structure_size());
    let image = |place: usize, change: f64| {
        let mut state = start.state.clone();
        state[place] += change;
        if slides {
            // Beyond its bound it slides from the start, at the level of the changed slip and load.
            state[own] = 1e3_f64.copysign(state[own]);
        }
        let start = MotionStart { time: start.time, state };
        motion.run(&start, until, MOTION_TOLERANCE, &mut ()).expect("an end").state
    };
    let mut matrix = Matrix::zeros(size, size);
    for place in 0..size {
        if slides && place >= own {
            continue;
        }
        let h = 1e-5 * start.state[place].abs().max(0.01);
        let (a, b) = (image(place, h), image(place, -h));
        let (c, d) = (image(place, 2.0 * h), image(place, -2.0 * h));
        for i in 0..size {
            matrix[(i, place)] = (8.0 * (a[i] - b[i]) - (c[i] - d[i])) / (12.0 * h);
        }
    }
    matrix
}

fn settled_for(system: &System, until: f64) -> MotionEnd {
    let motion = Motion::new(system).expect("a motion");
    let start =
        MotionStart { time: 0.0, state: motion.relaxed(&vec![0.0; motion.structure_size()]) };
    motion.run(&start, until, MOTION_TOLERANCE, &mut ()).expect("an end")
}

/// Sliders and bristles, driven along and across the surface, from several moments of their motions. Events of every kind but landings occur.
#[test]
fn changes_are_those_of_differences() {
    let (along, across) = (Direction::Tangential, Direction::Normal);
    let of_belt = |velocity, law, stiffness, dithers| belt(velocity, law, stiffness, dithers);
    let cases = [
        of_belt(0.05, (LawKind::Coulomb, &COULOMB), Some(30.0), vec![dither(along, 0.8, 5.0)]),
        of_belt(
            0.1,
            (LawKind::StribeckExponential, &FALLING),
            Some(20.0),
            vec![dither(along, 0.8, 3.0)],
        ),
        of_belt(0.05, (LawKind::Coulomb, &COULOMB), Some(10.0), vec![dither(across, 0.5, 6.0)]),
        of_belt(
            0.1,
            (LawKind::StribeckExponential, &FALLING),
            Some(20.0),
            vec![dither(across, 0.4, 3.0)],
        ),
        of_belt(0.03, (LawKind::Lugre, &BRISTLES), None, vec![dither(along, 0.8, 8.0)]),
        of_belt(
            0.1,
            (LawKind::Lugre, &BRISTLES),
            None,
            vec![dither(across, 0.5, 3.0), dither(along, 0.5, 4.5)],
        ),
        of_belt(
            0.1,
            (LawKind::StribeckExponential, &RISING),
            Some(20.0),
            vec![dither(across, 0.4, 3.0), dither(along, 0.8, 4.5)],
        ),
        bouncing((LawKind::StribeckExponential, &RISING), Some(20.0)),
        bouncing((LawKind::Lugre, &BRISTLES), None),
        bouncing((LawKind::StribeckExponential, &FALLING), Some(20.0)),
    ];
    let mut met = Vec::new();
    for (number, system) in cases.iter().enumerate() {
        for from in [1.0, 4.3, 7.9, 11.1] {
            let end = settled_for(system, from);
            if end.contacts[0].phase == ContactPhase::Open {
                continue;
            }
            let is_slider = system.contacts[0].tangential_stiffness.is_some();
            let slides = is_slider && end.contacts[0].phase != ContactPhase::Stick;
            let (start, until) = (end.restart(), from + 2.5);
            let (found, events) = variation(system, &start, until);
            met.extend(events);
            let expected = differences(system, &start, until, slides);
            let size = expected.as_slice().iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            for (a, b) in found.as_slice().iter().zip(expected.as_slice()) {
                let off = (a - b).abs();
                assert!(
                    off < 1e-6 * size,
                    "{number} from {from}: {a} {b}\n{found:?}\n{expected:?}"
                );
            }
        }
    }
    for kind in [EventKind::Release, EventKind::Stick, EventKind::Reversal, EventKind::Separation] {
        assert!(met.contains(&kind), "{kind:?} did not occur");
    }
}

/// exp(A t) by scaling and squaring of its series.
fn exponential(matrix: &Matrix, time: f64) -> Matrix {
    let n = matrix.rows();
    let share = Matrix::from_fn(n, n, |i, j| matrix[(i, j)] * time / 4096.0);
    let product = |a: &Matrix, b: &Matrix| {
        Matrix::from_fn(n, n, |i, j| (0..n).map(|k| a[(i, k)] * b[(k, j)]).sum())
    };
    let (mut sum, mut term) = (Matrix::identity(n), Matrix::identity(n));
    for k in 1..12 {
        let next = product(&term, &share);
        term = Matrix::from_fn(n, n, |i, j| next[(i, j)] / f64::from(k));
        sum = Matrix::from_fn(n, n, |i, j| sum[(i, j)] + term[(i, j)]);
    }
    (0..12).fold(sum, |power, _| product(&power, &power))
}

/// Small motions of bristles about steady sliding: ẍ + 2ζẋ + x = δT with δż = (γ g′/g) δγ − (σ₀ γ/g) δz.
#[test]
fn bristles_in_steady_sliding_have_the_linear_map() {
    let velocity = 0.08;
    let system = belt(velocity, (LawKind::Lugre, &BRISTLES), None, Vec::new());
    let [dynamic, level, speed, stiffness, damping, viscous] = BRISTLES;
    let excess = (level - dynamic) * (-(velocity / speed) * (velocity / speed)).exp();
    let (g, slope) = (dynamic + excess, -2.0 * velocity / (speed * speed) * excess);
    let (by_slip, by_deflection) = (velocity * slope / g, stiffness * velocity / g);
    let by_velocity = damping * by_slip + viscous;
    let linear = [
        [0.0, 1.0, 0.0],
        [-1.0, -0.04 - by_velocity, stiffness - damping * by_deflection],
        [0.0, -by_slip, -by_deflection],
    ];
    let linear = Matrix::from_fn(3, 3, |i, j| linear[i][j]);
    let state = sliding_state(&system).expect("sliding");
    let start = MotionStart { time: 0.0, state };
    let (found, events) = variation(&system, &start, 3.0);
    assert!(events.is_empty());
    let expected = exponential(&linear, 3.0);
    for (a, b) in found.as_slice().iter().zip(expected.as_slice()) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    let (found, expected) =
        (multipliers(&found).expect("some"), multipliers(&expected).expect("some"));
    for (a, b) in found.iter().zip(&expected) {
        assert!(modulus(*a - *b) < 1e-9, "{a} {b}");
    }
}

/// The orbit of a stiff slider has two multipliers of the rigid contact, and one of its own that is zero or small.
#[test]
fn a_stiff_slider_has_the_multipliers_of_a_rigid_contact() {
    let orbit = |stiffness| {
        let dithers = vec![dither(Direction::Tangential, 0.8, 3.0)];
        let system = belt(0.08, (LawKind::Coulomb, &COULOMB), stiffness, dithers);
        settled(&system, &vec![0.0; system.state_size()]).expect("an orbit").orbit
    };
    let rigid = orbit(None);
    assert!(rigid.events.iter().any(|event| event.kind == EventKind::Reversal));
    let off = |stiffness: f64| {
        let found = orbit(Some(stiffness));
        let largest = modulus(found.multipliers[0]) - modulus(rigid.multipliers[0]);
        largest.abs().max(modulus(found.multipliers[2]))
    };
    let (soft, stiff) = (off(1e3), off(1e5));
    assert!(soft < 0.1 && stiff < 0.3 * soft + 1e-9, "{soft} {stiff}");
}

/// Slip throughout: a slider is on the surface T = μN, and moves as a rigid contact.
#[test]
fn a_slider_that_slides_throughout_has_the_multipliers_of_a_rigid_contact_and_zero() {
    let dithers = || vec![dither(Direction::Tangential, 0.4, 5.0)];
    let law = (LawKind::StribeckExponential, &FALLING[..]);
    let rigid = base_response(&belt(0.3, law, None, dithers()), 8).expect("an orbit");
    let slider = base_response(&belt(0.3, law, Some(50.0), dithers()), 8).expect("an orbit");
    assert!(rigid.signature.is_pure_slip() && slider.signature.is_pure_slip());
    assert_eq!(slider.multipliers.len(), 3);
    for (a, b) in slider.multipliers.iter().zip(&rigid.multipliers) {
        assert!(modulus(*a - *b) < 1e-10, "{a} {b}");
    }
    assert!(modulus(slider.multipliers[2]) < 1e-12);
    let near = near(&belt(0.3, law, Some(50.0), dithers()), &slider.state, 1);
    let near = near.expect("an orbit");
    assert!(near.state.iter().zip(&slider.state).all(|(a, b)| (a - b).abs() < 1e-9));
}
