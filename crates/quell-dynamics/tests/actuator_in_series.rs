//! Power and stroke of normal dither through the spring of a contact, against the linear response of one mass in closed form.

use std::f64::consts::TAU;

use num_complex::Complex64;
use quell_dynamics::motion::{InputMeter, MOTION_TOLERANCE, Motion, MotionStart};
use quell_linear::series_actuator::NoSeriesActuator;
use quell_model::friction::{Coulomb, Friction};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{System, Waveform};
use quell_numerics::matrix::Matrix;

const STIFFNESS: f64 = 5.0;
const AMPLITUDE: f64 = 0.2;
const FREQUENCY: f64 = 3.0;
/// Spring and damper of the mass in the normal direction.
const OWN: (f64, f64) = (2.0, 0.3);

/// A mass that slides in x and moves in y against the surface.
fn brake(waveform: Waveform, normal_damping: f64, reaction: bool) -> System {
    let diagonal =
        |values: [f64; 2]| Matrix::from_fn(2, 2, |i, j| if i == j { values[i] } else { 0.0 });
    let structure = Mechanical::new(
        vec!["x".to_owned(), "y".to_owned()],
        MassMatrix::identity(2),
        diagonal([0.1, OWN.1]),
        diagonal([1.0, OWN.0]),
    );
    let contact = Contact {
        name: "pad".to_owned(),
        tangent: Some(vec![1.0, 0.0]),
        force: None,
        normal: Some(vec![0.0, 1.0]),
        slope: None,
        normal_load: 1.0,
        varying_load: None,
        normal_stiffness: STIFFNESS,
        normal_damping,
        surface_velocity: Profile::constant(2.0),
        friction: Friction::Coulomb(Coulomb::constant(0.3)),
        tangential_stiffness: None,
    };
    let wave =
        Wave { waveform, amplitude: AMPLITUDE, frequency: FREQUENCY, phase: 0.7, envelope: None };
    let target = InputTarget::NormalLoad { contact: 0, reaction };
    let input = Input { target, profile: Profile::constant(0.0).with(wave) };
    System { structure: structure.into(), contacts: vec![contact], inputs: vec![input] }
}

/// The costs over 50 periods after the motion has settled.
fn costs(system: &System) -> quell_dynamics::motion::InputCost {
    let motion = Motion::new(system).expect("a motion");
    let period = TAU / FREQUENCY;
    let start = MotionStart { time: 0.0, state: vec![0.0; 4] };
    let settled = motion.run(&start, 150.0 * period, MOTION_TOLERANCE, &mut ()).expect("a run");
    let start = MotionStart { time: settled.time, state: settled.state };
    let mut meter = InputMeter::new(system);
    motion.run(&start, 200.0 * period, MOTION_TOLERANCE, &mut meter).expect("a run");
    meter.costs().expect("a duration").swap_remove(0).expect("a cost")
}

#[test]
fn a_sine_in_closed_form() {
    for damping in [0.0, 0.4] {
        let found = costs(&brake(Waveform::Sine, damping, true));
        let i_omega = Complex64::new(0.0, FREQUENCY);
        let spring = i_omega * damping + STIFFNESS;
        let dynamic = spring - FREQUENCY * FREQUENCY + OWN.0 + i_omega * OWN.1;
        let load = Complex64::new(AMPLITUDE, 0.0);
        let moved = -load / dynamic;
        let elongation = load / spring;
        let whole = load + spring * moved;
        let power = |force: Complex64, displacement: Complex64| {
            0.5 * (force * (i_omega * displacement).conj()).re
        };
        let series = found.in_series.expect("a load").expect("a spring");
        let exact = power(whole, elongation);
        assert!((series.power - exact).abs() < 1e-9 * exact.abs(), "{series:?} {exact}");
        assert!((series.stroke - 2.0 * elongation.norm()).abs() < 1e-12, "{series:?}");
        let exact = power(-load, moved);
        assert!((found.power - exact).abs() < 1e-9 * exact.abs(), "{found:?} {exact}");
        // What the actuator delivers is lost in the dampers of the mass and of the contact.
        let lost = 0.5
            * FREQUENCY
            * FREQUENCY
            * (OWN.1 * moved.norm_sqr() + damping * (moved + elongation).norm_sqr());
        assert!((series.power / lost - 1.0).abs() < 1e-9, "{series:?} {lost}");
    }
}

#[test]
fn what_a_spring_cannot_follow_is_refused() {
    let found = costs(&brake(Waveform::Square, 0.0, true));
    assert_eq!(found.in_series, Some(Err(NoSeriesActuator::Jumps)));
    assert!(costs(&brake(Waveform::Square, 0.4, true)).in_series.expect("a load").is_ok());
}
