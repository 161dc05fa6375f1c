//! A load over time on a contact that presses along a row of the structure: it is balanced at every moment.

use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, MotionEnd, MotionRecorder, MotionStart};
use quell_model::profile::{KnotShape, Knots, Profile};
use quell_model::system::{Contact, MassMatrix, Mechanical};
use quell_model::{LawKind, System};
use quell_numerics::matrix::Matrix;

/// A pad with a tangential and a normal coordinate on a surface, with compliance and loss in the contact.
fn pad(normal_load: f64, load: Option<Knots>) -> System {
    let diagonal =
        |values: [f64; 2]| Matrix::from_fn(2, 2, |i, j| if i == j { values[i] } else { 0.0 });
    let names = vec!["x".to_owned(), "y".to_owned()];
    let (damping, stiffness) = (diagonal([0.02, 0.3]), diagonal([1.0, 4.0]));
    let structure = Mechanical::new(names, MassMatrix::identity(2), damping, stiffness).into();
    let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("a law");
    let contact = Contact {
        name: "pad".to_owned(),
        tangent: Some(vec![1.0, 0.0]),
        force: None,
        normal: Some(vec![0.3, 1.0]),
        slope: None,
        normal_load,
        varying_load: load.map(Profile::over),
        normal_stiffness: 2.5,
        normal_damping: 0.1,
        surface_velocity: Profile::constant(0.1),
        friction: law,
        tangential_stiffness: None,
    };
    System { structure, contacts: vec![contact], inputs: Vec::new() }
}

fn run(system: &System, state: &[f64], (from, until): (f64, f64)) -> (MotionEnd, usize) {
    let motion = Motion::new(system).expect("a motion");
    let start = MotionStart { time: from, state: motion.relaxed(state) };
    let mut events = MotionRecorder::default();
    let end = motion.run(&start, until, MOTION_TOLERANCE, &mut events).expect("an end");
    (end, events.events.len())
}

/// After its last knot a load over time is the constant load of its last value: the run goes on as that of the study at the moment.
#[test]
fn after_the_last_knot_a_run_is_that_of_the_constant_load() {
    for (shape, last) in [(KnotShape::Linear, 1.8), (KnotShape::Smooth, 0.4)] {
        let load = Knots::new(vec![2.0, 9.0], vec![1.0, last], shape).expect("knots");
        let varying = pad(1.0, Some(load));
        let (whole, _) = run(&varying, &[0.3, 0.1, 0.0, 0.0], (0.0, 60.0));
        let (middle, _) = run(&varying, &[0.3, 0.1, 0.0, 0.0], (0.0, 9.0));
        let (rest, events) = run(&pad(last, None), &middle.state, (9.0, 60.0));
        assert!(events > 2, "{events} events");
        for (found, expected) in whole.state.iter().zip(&rest.state) {
            assert!((found - expected).abs() < 1e-11, "{found} {expected}");
        }
    }
}

/// Without friction's share a load over time does not move a structure at rest: its normal coordinate stays where it is balanced.
#[test]
fn a_load_over_time_moves_nothing_along_the_normal() {
    let load = Knots::new(vec![0.0, 5.0], vec![1.0, 2.0], KnotShape::Linear).expect("knots");
    let mut system = pad(1.0, Some(load));
    system.contacts[0].tangent = None;
    let (end, _) = run(&system, &[0.0; 4], (0.0, 20.0));
    for entry in &end.state {
        assert!(entry.abs() < 1e-14, "{entry}");
    }
}
