//! Power and stroke of normal dither through the spring of a contact, against the linear response of one mass in closed form.

use std::f64::consts::TAU;

use num_complex::Complex64;
use quell_dynamics::motion::{InputMeter, MOTION_TOLERANCE, Motion, MotionStart, NoPower};
use quell_linear::driven_point::{DrivenPoint, NoDrivenPoint, PointOutput};
use quell_linear::linearised::Linearised;
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
    meter.costs().expect("a duration").swap_remove(0)
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
        let fed = found.fed.expect("a motion");
        assert!((fed.power - exact).abs() < 1e-9 * exact.abs(), "{fed:?} {exact}");
        // What the actuator delivers is lost in the dampers of the mass and of the contact.
        let lost = 0.5
            * FREQUENCY
            * FREQUENCY
            * (OWN.1 * moved.norm_sqr() + damping * (moved + elongation).norm_sqr());
        assert!((series.power / lost - 1.0).abs() < 1e-9, "{series:?} {lost}");
    }
}

/// What an actuator must give for the same dither: displacement, velocity, acceleration of its mass and the force on it.
#[test]
fn the_driven_point_in_closed_form() {
    for (damping, reaction) in [(0.0, true), (0.4, true), (0.0, false), (0.4, false)] {
        let system = brake(Waveform::Sine, damping, reaction);
        let sliding = Linearised::new(&system).expect("sliding");
        let target = &system.inputs[0].target;
        let point = DrivenPoint::of_input(&system, &sliding, target, &Waveform::Sine, FREQUENCY);
        let point = point.expect("a spring");
        let i_omega = Complex64::new(0.0, FREQUENCY);
        let spring = i_omega * damping + STIFFNESS;
        let dynamic = spring - FREQUENCY * FREQUENCY + OWN.0 + i_omega * OWN.1;
        // Guides bear the modulation: the mass stays where it is.
        let moved = if reaction { -1.0 / dynamic } else { Complex64::ZERO };
        let elongation = 1.0 / spring;
        let acceleration = i_omega * i_omega * (elongation + moved);
        let exact = [1.0 + spring * moved, elongation, i_omega * elongation, acceleration];
        let one = |force, displacement, velocity, acceleration| PointOutput {
            force,
            displacement,
            velocity,
            acceleration,
        };
        let wanted = [
            one(1.0, 0.0, 0.0, 0.0),
            one(0.0, 1.0, 0.0, 0.0),
            one(0.0, 0.0, 1.0, 0.0),
            one(0.0, 0.0, 0.0, 1.0),
        ];
        for (place, (found, exact)) in point.outputs(&wanted).iter().zip(exact).enumerate() {
            let [least, largest] = found.range();
            let size = exact.norm();
            assert!(
                (largest - size).abs() < 1e-10 * size && (least + size).abs() < 1e-10 * size,
                "{place}: {found:?}"
            );
        }
        assert!(point.is_in_series() && !point.velocity_jumps());
        assert!((point.change_by(15.0, 1.0) - 0.25).abs() < 1e-15);
    }
    let system = brake(Waveform::Triangle, 0.0, true);
    let sliding = Linearised::new(&system).expect("sliding");
    let of = |waveform| {
        DrivenPoint::of_input(&system, &sliding, &system.inputs[0].target, waveform, FREQUENCY)
    };
    assert!(of(&Waveform::Triangle).expect("continuous").velocity_jumps());
    let jumps = NoDrivenPoint::InSeries(NoSeriesActuator::Jumps);
    assert_eq!(of(&Waveform::Square).map(|_| ()), Err(jumps));
}

/// Guides bear the modulation: it does no work on the structure, and the actuator has a stroke.
#[test]
fn a_guided_modulation_has_an_actuator_too() {
    let found = costs(&brake(Waveform::Sine, 0.0, false));
    assert_eq!(found.fed, Err(NoPower::Guided));
    let series = found.in_series.expect("a load").expect("a spring");
    assert!((series.stroke - 2.0 * AMPLITUDE / STIFFNESS).abs() < 1e-12, "{series:?}");
}

#[test]
fn what_a_spring_cannot_follow_is_refused() {
    let found = costs(&brake(Waveform::Square, 0.0, true));
    assert_eq!(found.in_series, Some(Err(NoSeriesActuator::Jumps)));
    assert!(costs(&brake(Waveform::Square, 0.4, true)).in_series.expect("a load").is_ok());
}
