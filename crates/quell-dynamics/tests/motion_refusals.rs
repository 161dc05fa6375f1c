//! Systems and runs that are refused, with time, contact and reason.

use quell_dynamics::motion::{
    ContactPhase, Immobile, MOTION_TOLERANCE, Motion, MotionStart, MotionStopped, StopReason,
};
use quell_model::friction::{Coulomb, Friction};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical, StateSpace};
use quell_model::{System, Waveform};
use quell_numerics::matrix::Matrix;

fn contact(name: &str, tangent: Option<Vec<f64>>) -> Contact {
    Contact {
        name: name.to_owned(),
        tangent,
        force: None,
        normal: None,
        slope: None,
        normal_load: 1.0,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(0.1),
        friction: Friction::Coulomb(Coulomb::constant(0.3)),
        varying_load: None,
    }
}

fn first_order(force: [[f64; 2]; 2]) -> System {
    let matrix = Matrix::from_fn(2, 2, |i, j| if i == j { -1.0 } else { 0.0 });
    let names = vec!["a".to_owned(), "b".to_owned()];
    let contacts = [("left", 0), ("right", 1)].map(|(name, at)| {
        let tangent = (0..2).map(|i| f64::from(u8::from(i == at))).collect();
        Contact { force: Some(force[at].to_vec()), ..contact(name, Some(tangent)) }
    });
    let structure = StateSpace::new(names, matrix).into();
    System { structure, contacts: contacts.to_vec(), inputs: Vec::new() }
}

fn mass(contacts: Vec<Contact>, inputs: Vec<Input>) -> System {
    let one = |value: f64| Matrix::from_fn(1, 1, |_, _| value);
    let names = vec!["x".to_owned()];
    let structure = Mechanical::new(names, MassMatrix::identity(1), one(0.02), one(1.0)).into();
    System { structure, contacts, inputs }
}

#[test]
fn decisions_that_are_not_unique_are_refused_before_a_run() {
    // G = [[1, 2], [2, 1]] has a negative determinant.
    let why = Motion::new(&first_order([[1.0, 2.0], [2.0, 1.0]])).err();
    let names = vec!["left".to_owned(), "right".to_owned()];
    assert_eq!(why, Some(Immobile::NotUnique { contacts: names }));
    assert!(Motion::new(&first_order([[1.0, 0.5], [-3.0, 1.0]])).is_ok());
    let why = Motion::new(&first_order([[-1.0, 0.0], [0.0, 1.0]])).err();
    assert_eq!(why, Some(Immobile::Unopposed { contact: "left".to_owned() }));
}

#[test]
fn a_contact_without_direction_is_refused() {
    let still = Contact { surface_velocity: Profile::constant(0.0), ..contact("still", None) };
    let system = mass(vec![still], Vec::new());
    let why = Motion::new(&system).err().map(|why| why.to_string());
    assert!(why.is_some_and(|why| why.contains("still") && why.contains("no direction")));
}

#[test]
fn a_prescribed_load_that_vanishes_ends_the_run_there() {
    let wave = Wave {
        waveform: Waveform::Sine,
        amplitude: 1.5,
        frequency: 2.0,
        phase: 0.0,
        envelope: None,
    };
    let input = Input {
        target: InputTarget::NormalLoad { contact: 0, reaction: false },
        profile: Profile::default().with(wave),
    };
    let system = mass(vec![contact("pad", Some(vec![1.0]))], vec![input]);
    let motion = Motion::new(&system).expect("movable");
    let start = MotionStart { time: 0.0, state: vec![0.3, 0.0] };
    let stopped = motion.run(&start, 10.0, MOTION_TOLERANCE, &mut ());
    let MotionStopped { time, state, reason } = stopped.expect_err("the load vanishes");
    // 1 + 1.5 sin 2t = 0 for the first time.
    let vanishes = 0.5 * (std::f64::consts::PI + (1.0_f64 / 1.5).asin());
    assert!((time - vanishes).abs() < 1e-12, "{time} {vanishes}");
    assert_eq!(reason, StopReason::LoadVanishes { contact: "pad".to_owned() });
    assert!(state.len() == 2 && state.iter().all(|value| value.is_finite()));
}

/// Two relays that drive each other: G = [[1, −a], [a, 1]] is a P-matrix, so that every decision is unique. With w = 0 slip velocities
/// spiral into (0, 0): from (s, 0) they reach (0, −s(a − 1)/(a + 1)) after s/(1 + a), in units of the friction force, and so on.
/// Events accumulate at the sum of that geometric series. (The example is Filippov's.)
fn relays(a: f64) -> System {
    let mut system = first_order([[1.0, a], [-a, 1.0]]);
    // Surfaces at rest make the origin the end of the spiral; the relaxation of the states, at the rate 1, is slow in comparison.
    for contact in &mut system.contacts {
        contact.surface_velocity = Profile::constant(0.0);
    }
    system
}

/// Time at which the events of [`relays`] accumulate from slip velocities (s, 0), without the relaxation.
fn accumulates_at(a: f64, s: f64) -> f64 {
    let (force, shrinks) = (0.3, (a - 1.0) / (a + 1.0));
    s / (force * (1.0 + a)) / (1.0 - shrinks)
}

#[test]
fn events_that_accumulate_end_a_run_with_time_contact_and_state() {
    let (a, s) = (60.0, 1e-3);
    let system = relays(a);
    let motion = Motion::new(&system).expect("a P-matrix");
    let start = MotionStart { time: 0.0, state: vec![-s, 0.0] };
    let stopped = motion.run(&start, 1.0, MOTION_TOLERANCE, &mut ()).expect_err("accumulates");
    println!("{stopped}");
    let wanted = accumulates_at(a, s);
    assert!((stopped.time - wanted).abs() < 1e-3 * wanted, "{} {wanted}", stopped.time);
    assert!(stopped.state.iter().all(|value| value.abs() < 1e-3 * s), "{:?}", stopped.state);
    assert!(
        matches!(&stopped.reason, StopReason::Zeno { contact } if contact == "left" || contact == "right")
    );
    let words = stopped.to_string();
    assert!(words.contains("infinitely many in a finite time") && words.contains("contact"));
}

#[test]
fn fast_accumulation_is_one_moment_and_the_run_goes_on_in_stick() {
    let (a, s) = (2.0, 1e-3);
    let system = relays(a);
    let motion = Motion::new(&system).expect("a P-matrix");
    let start = MotionStart { time: 0.0, state: vec![-s, 0.0] };
    let end = motion.run(&start, 1.0, MOTION_TOLERANCE, &mut ()).expect("goes on");
    assert!(end.contacts.iter().all(|contact| contact.phase == ContactPhase::Stick), "{end:?}");
    assert!(end.events > 8 && end.state.iter().all(|value| value.abs() < 1e-12), "{end:?}");
    let before = 0.99 * accumulates_at(a, s);
    let slips = motion.run(&start, before, MOTION_TOLERANCE, &mut ()).expect("slips");
    assert!(slips.contacts.iter().any(|contact| contact.phase != ContactPhase::Stick));
}

/// The limits on the steps of belts are those of systems: damping makes a step short, but no period.
#[test]
fn runs_that_would_not_end_are_stopped() {
    let push = Input {
        target: InputTarget::Force(vec![1.0]),
        profile: Profile::constant(0.0).with(Wave {
            waveform: Waveform::Sine,
            amplitude: 1.5,
            frequency: 0.9,
            phase: 0.0,
            envelope: None,
        }),
    };
    let one = |value: f64| Matrix::from_fn(1, 1, |_, _| value);
    for (damping, until, why) in
        [(3e7, 100.0, "hundred thousand steps"), (0.02, 1e12, "as much work")]
    {
        let mut system = mass(vec![contact("rub", Some(vec![1.0]))], vec![push.clone()]);
        let names = vec!["x".to_owned()];
        system.structure =
            Mechanical::new(names, MassMatrix::identity(1), one(damping), one(1.0)).into();
        let motion = Motion::new(&system).expect("a motion");
        let start = MotionStart { time: 0.0, state: vec![0.0, 0.0] };
        let stopped = motion.run(&start, until, MOTION_TOLERANCE, &mut ()).expect_err("stopped");
        assert!(stopped.to_string().contains(why), "{stopped}");
    }
}
