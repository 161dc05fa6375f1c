//! A plate in a frame that rotates at a speed over time is the same plate.
//!
//! Without load its standing wave x(t) cos q(θ − θ₀), x″ + 2ξβx′ + β²x = 0, keeps its place in the plate. In a frame with
//! φ = θ − Θ(t), Θ = ∫Ω dt, it is A = x cos q(Θ − θ₀), B = −x sin q(Θ − θ₀) exactly, for every Ω(t). All terms in Ω, Ω² and Ω′ take part.

use quell_dynamics::motion::{MOTION_TOLERANCE, Motion, MotionStart};
use quell_model::disc::{DiscDither, Mode};
use quell_model::profile::{KnotShape, Knots, Profile, Wave};
use quell_model::{Disc, Waveform};

const PLACE: f64 = 0.4;

fn mode(diameters: usize, ratio: f64, damping: f64) -> Mode {
    Mode { diameters, ratio, shape_at_load: 1.0, damping }
}

fn knots(shape: KnotShape) -> Knots {
    Knots::new(vec![0.3, 2.0, 4.7, 9.1], vec![0.4, 1.7, -0.8, 0.0], shape).expect("valid")
}

/// ∫Ω dt from 0: Simpson's rule is exact for a cubic, the oscillation has its integral.
fn turned(drive: &Profile, time: f64) -> f64 {
    let course = drive.without_waves();
    let mut cuts: Vec<f64> = drive.knots().map_or(Vec::new(), |knots| knots.times().to_vec());
    cuts.retain(|cut| *cut > 0.0 && *cut < time);
    cuts.insert(0, 0.0);
    cuts.push(time);
    let value = |at: f64| course.value(at);
    let pieces = cuts.windows(2).map(|ends| {
        let (from, to) = (ends[0], ends[1]);
        (to - from) / 6.0 * (value(from) + 4.0 * value(0.5 * (from + to)) + value(to))
    });
    let waves = drive.waves().iter().map(|wave| {
        wave.amplitude / wave.frequency
            * (wave.phase.cos() - (wave.frequency * time + wave.phase).cos())
    });
    pieces.sum::<f64>() + waves.sum::<f64>()
}

/// The state of the plate in the frame: A and B of every mode, then their rates.
fn exact(modes: &[Mode], drive: &Profile, time: f64) -> Vec<f64> {
    let (angle, speed) = (turned(drive, time), drive.value(time));
    let (mut displacements, mut rates) = (Vec::new(), Vec::new());
    for mode in modes {
        let decay = mode.damping * mode.ratio;
        let frequency = mode.ratio * (1.0 - mode.damping * mode.damping).sqrt();
        let (sine, cosine) = (frequency * time).sin_cos();
        let size = (-decay * time).exp();
        let (x, rate) = (size * cosine, -size * (decay * cosine + frequency * sine));
        if mode.diameters == 0 {
            displacements.push(x);
            rates.push(rate);
            continue;
        }
        let q = mode.diameters as f64;
        let (sine, cosine) = (q * (angle - PLACE)).sin_cos();
        displacements.extend([x * cosine, -x * sine]);
        rates.extend([rate * cosine - x * q * speed * sine, -rate * sine - x * q * speed * cosine]);
    }
    displacements.extend(rates);
    displacements
}

fn run(modes: &[Mode], drive: Option<&Profile>, start: &MotionStart, until: f64) -> Vec<f64> {
    let disc = Disc::new(modes.to_vec(), Vec::new(), DiscDither::None, 0.4).expect("valid");
    let disc = match drive {
        Some(drive) => disc.driven(drive.clone()).expect("valid"),
        None => disc,
    };
    let system = disc.system();
    let motion = Motion::new(&system).expect("a motion");
    motion.run(start, until, MOTION_TOLERANCE, &mut ()).expect("a run").state
}

#[test]
fn a_plate_in_a_frame_of_any_speed_is_the_same_plate() {
    let wave = Wave {
        waveform: Waveform::Sine,
        amplitude: 0.7,
        frequency: 1.3,
        phase: 0.2,
        envelope: None,
    };
    let few = vec![mode(2, 2.0, 0.03)];
    let many = vec![mode(0, 1.4, 0.02), mode(1, 1.1, 0.0), mode(2, 2.0, 0.01), mode(3, 3.3, 0.05)];
    for modes in [&few, &many] {
        for drive in [
            Profile::over(knots(KnotShape::Linear)),
            Profile::over(knots(KnotShape::Smooth)),
            Profile::constant(-0.3).with(wave.clone()),
            Profile::over(knots(KnotShape::Smooth)).with(wave.clone()),
        ] {
            let start = MotionStart { time: 0.0, state: exact(modes, &drive, 0.0) };
            let end = run(modes, Some(&drive), &start, 12.0);
            for (found, wanted) in end.iter().zip(exact(modes, &drive, 12.0)) {
                // Truncation of 10⁻¹³ per step and rounding over some hundred steps.
                assert!((found - wanted).abs() < 1e-11, "{drive:?}: {found} {wanted}");
            }
        }
    }
}

#[test]
fn a_constant_profile_is_the_constant_speed() {
    let modes = vec![mode(0, 1.4, 0.02), mode(1, 1.1, 0.0), mode(3, 3.3, 0.05)];
    let constant = Knots::new(vec![1.0, 5.0], vec![0.4, 0.4], KnotShape::Linear).expect("valid");
    let start = || MotionStart { time: 0.0, state: exact(&modes, &Profile::constant(0.4), 0.0) };
    let plain = run(&modes, None, &start(), 20.0);
    for drive in [Profile::constant(0.4), Profile::over(constant)] {
        for (found, wanted) in run(&modes, Some(&drive), &start(), 20.0).iter().zip(&plain) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
    }
}

/// A knot is an event: a run that stops there and goes on has the same end.
#[test]
fn breaks_of_the_speed_are_exact() {
    let modes = vec![mode(2, 2.0, 0.0)];
    let drive = Profile::over(knots(KnotShape::Linear));
    let start = MotionStart { time: 0.0, state: exact(&modes, &drive, 0.0) };
    let whole = run(&modes, Some(&drive), &start, 7.0);
    let mut now = start;
    for until in [2.0, 4.7, 7.0] {
        let state = run(&modes, Some(&drive), &now, until);
        now = MotionStart { time: until, state };
    }
    for (found, wanted) in now.state.iter().zip(&whole) {
        assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
    }
}

#[test]
fn the_steady_system_of_a_moment_is_that_of_its_speed() {
    let disc = |drive: Option<Profile>, speed: f64| {
        let modes = vec![mode(0, 1.4, 0.02), mode(2, 2.0, 0.03)];
        let disc = Disc::new(modes, Vec::new(), DiscDither::None, speed).expect("valid");
        drive.map_or(disc.clone(), |drive| disc.driven(drive).expect("valid"))
    };
    let drive = Profile::over(knots(KnotShape::Smooth));
    let varying = disc(Some(drive.clone()), 0.0);
    assert!(!varying.is_steady() && !varying.system().is_steady());
    for time in [0.0, 1.1, 3.3, 20.0] {
        let wanted = disc(None, drive.value(time));
        assert_eq!(varying.steady_at(time), wanted);
        let (found, wanted) = (varying.system().steady_at(time), wanted.system());
        assert!(found.is_steady());
        let parts = |system: &quell_model::System| {
            let structure = system.structure.mechanical().expect("masses").clone();
            [structure.damping().clone(), structure.stiffness().clone()]
        };
        for (found, wanted) in parts(&found).iter().zip(parts(&wanted)) {
            for (found, wanted) in found.as_slice().iter().zip(wanted.as_slice()) {
                assert!((found - wanted).abs() < 1e-14, "{found} {wanted}");
            }
        }
    }
}
