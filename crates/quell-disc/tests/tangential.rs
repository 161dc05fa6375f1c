//! Tangential dither at a finite speed ratio, and square follower forces.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use quell_disc::partition::{NoPartition, crossings};
use quell_disc::tangential::TangentialDither;
use quell_disc::{dithered, undithered};
use quell_linear::floquet::{FollowerDither, NotFollowerDither};
use quell_linear::linearised::Linearised;
use quell_model::disc::{DiscDither, Load, Mode, Patch};
use quell_model::system::InputTarget;
use quell_model::{Disc, Waveform};
use quell_numerics::floquet::{ConstantFlow, Effort, Floquet};
use quell_numerics::quadrature::{QuadratureOptions, integrate};

fn shaken(slip_ratio: f64) -> TangentialDither {
    TangentialDither { slip_ratio, speed: -0.3, frequency_ratio: 20.0 }
}

fn average(of: &dyn Fn(f64) -> f64, breaks: &[f64]) -> f64 {
    let found = integrate(
        of,
        0.0,
        TAU,
        breaks,
        &QuadratureOptions { absolute: 1e-13, ..QuadratureOptions::default() },
    );
    found.expect("piecewise smooth").value / TAU
}

#[test]
fn mean_and_harmonics_are_those_of_the_sign_of_the_slip() {
    for slip_ratio in [0.4, 1.0, 1.2, 3.0, 50.0] {
        let dither = shaken(slip_ratio);
        let sign = |phase: f64| (1.0 + slip_ratio * phase.cos()).signum();
        let turn = (-1.0 / slip_ratio).max(-1.0).acos();
        let breaks = [turn, TAU - turn];
        assert!((average(&sign, &breaks) - dither.mean()).abs() < 1e-12, "{slip_ratio}");
        for n in 1..5 {
            let cosine = |phase: f64| 2.0 * sign(phase) * (f64::from(n) * phase).cos();
            let found = average(&cosine, &breaks);
            assert!((found - dither.harmonic(n)).abs() < 1e-12, "{slip_ratio} {n}");
        }
    }
}

#[test]
fn limits_of_the_speed_ratio() {
    // (5.27), (5.28): a high ratio leaves a square wave of zero mean, whose fundamental is 4/π.
    let fast = shaken(1e9);
    assert!(fast.mean() < 1e-9 && (fast.harmonic(1) - 4.0 / PI).abs() < 1e-12);
    assert!(fast.harmonic(2).abs() < 1e-8 && (fast.harmonic(3) + 4.0 / (3.0 * PI)).abs() < 1e-8);
    // A low ratio leaves friction as it is, and the force is the inertia m φ₀R² alone.
    let slow = shaken(0.5);
    assert_eq!([slow.mean(), slow.harmonic(1)], [1.0, 0.0]);
    assert!((slow.force(0.1, 0.05) - 0.1 * slow.angle() * 400.0).abs() < 1e-15);
    for mean in [1.0, 0.5, 0.01] {
        let ratio = TangentialDither::slip_ratio_for(mean);
        assert!((shaken(ratio).mean() - mean).abs() < 1e-9, "{mean}");
    }
}

#[test]
fn the_force_is_the_peak_over_a_cycle() {
    for (slip_ratio, mass, friction) in
        [(0.7, 0.1, 0.05), (1.1, 0.1, 0.05), (2.0, 0.001, -0.3), (5.0, 0.1, 0.4), (1.5, 0.0, 0.2)]
    {
        let dither = shaken(slip_ratio);
        let steps = 2_000_000;
        let force = |k: i32| {
            let phase = TAU * (f64::from(k) + 0.5) / f64::from(steps);
            let acceleration = -slip_ratio * 0.3 * 20.0 * phase.sin();
            let sign = (1.0 + slip_ratio * phase.cos()).signum();
            (mass * acceleration + friction * (sign - dither.mean())).abs()
        };
        let peak = (0..steps).map(force).fold(0.0, f64::max);
        assert!((peak - dither.force(mass, friction)).abs() < 1e-5, "{slip_ratio}: {peak}");
    }
}

const SQUARE: DiscDither = DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 2.7 };

fn disc(loads: Vec<Load>, dither: DiscDither) -> Disc {
    let shapes = [(0, 1.771_548, 0.658_8), (1, 1.807_665, 0.933_1), (2, 2.0, 0.934_7)];
    let mode =
        |(diameters, ratio, shape_at_load)| Mode { diameters, ratio, shape_at_load, damping: 1e-4 };
    Disc::new(shapes.map(mode).to_vec(), loads, dither, 0.3).expect("valid")
}

fn load() -> Load {
    Load::new(0.1, 0.05, 0.1, 0.3)
}

fn square(loads: Vec<Load>, dither: DiscDither) -> Disc {
    disc(loads, dither).shaped(Waveform::Square).expect("a square wave")
}

/// Jumps at quarters of the period fall between steps, so that the splitting of smooth dither also converges, with its steps.
#[test]
fn a_square_wave_agrees_with_many_steps() {
    for loads in [
        vec![load()],
        vec![load(), load().at_angle(2.0).dithered_at(FRAC_PI_2)],
        vec![load().over(Patch::sector(0.5, 4))],
    ] {
        let disc = square(loads, SQUARE);
        let found = dithered::growth(&disc, Effort::default()).expect("finite");
        let system = disc.system();
        let linear = Linearised::new(&system).expect("flat");
        let (u, v) = linear.follower_columns();
        let none = vec![0.0; system.contacts.len()];
        let flow = ConstantFlow::new(&linear.state_matrix(&none), &u, &v).expect("finite");
        let period = TAU / 2.7;
        let engine = Floquet::new(flow, period);
        let rate = |count: usize| {
            let phi = |phase: quell_numerics::floquet::Phase,
                       to: &mut quell_numerics::matrix::Matrix| {
                for (c, input) in system.inputs.iter().enumerate() {
                    let factor = input.profile.value(phase.cycles * period);
                    to[(c, c)] = linear.contacts()[c].steady.friction * factor;
                }
            };
            let multipliers = engine.multipliers(&phi, count).expect("finite");
            let largest =
                multipliers.iter().map(num_complex::Complex64::norm_sqr).fold(0.0, f64::max);
            0.5 * largest.ln() / period
        };
        let (coarse, fine) = (rate(512), rate(1024));
        assert!((fine - found.rate).abs() < 1e-6, "{fine} {found:?}");
        assert!((fine - found.rate).abs() < 0.5 * (coarse - found.rate).abs() + 1e-12);
    }
}

#[test]
fn a_square_wave_of_no_amplitude_is_no_dither() {
    let silent = DiscDither::Normal { amplitude: 0.0, frequency_ratio: 2.7 };
    let found = dithered::growth(&square(vec![load()], silent), Effort::default()).expect("finite");
    let still = undithered::growth(&disc(vec![load()], DiscDither::None)).expect("finite");
    assert!((found.rate - still.rate).abs() < found.error + 1e-12, "{found:?} {still:?}");
    let listed =
        dithered::prepared(&square(vec![load()], silent)).expect("finite").expect("dithered");
    let growing = listed.growing(Effort::default()).expect("finite");
    let expected = undithered::growing_with(
        &disc(vec![load()], DiscDither::None),
        quell_model::disc::Contributions::ALL,
    );
    assert_eq!(growing.len(), expected.expect("finite").len());
}

#[test]
fn a_waveform_takes_the_place_of_the_cosine() {
    let plain = disc(vec![load()], SQUARE);
    assert_eq!(plain.clone().shaped(Waveform::Sine).expect("the default"), plain);
    let square = square(vec![load()], SQUARE);
    assert_eq!(crossings(&square), Err(NoPartition::Waveform));
    assert_eq!(square.at_speed(0.2).expect("in bounds").waveform(), &Waveform::Square);
}

/// Inputs that the exponents do not describe are errors: nothing is computed as if there were no dither.
#[test]
fn unknown_inputs_are_errors() {
    let disc = disc(vec![load()], SQUARE);
    let mut system = disc.system();
    let linear = Linearised::new(&system).expect("flat");
    assert!(FollowerDither::new(&system, &linear, 2.7).is_ok());
    assert_eq!(FollowerDither::new(&system, &linear, 2.8).err(), Some(NotFollowerDither::Input));
    system.inputs[0].target = InputTarget::Force(vec![0.0; 5]);
    assert_eq!(FollowerDither::new(&system, &linear, 2.7).err(), Some(NotFollowerDither::Input));
    system.inputs.clear();
    let missing = NotFollowerDither::Undithered { contact: 0 };
    assert_eq!(FollowerDither::new(&system, &linear, 2.7).err(), Some(missing));
}
