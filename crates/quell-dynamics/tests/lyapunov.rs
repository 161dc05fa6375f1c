//! Lyapunov exponents against traces, multipliers and the growth of small differences between runs.

use quell_dynamics::motion::{
    LyapunovExponent, LyapunovVerdict, MOTION_TOLERANCE, Motion, MotionStart,
};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{Friction, LawKind, System, Waveform};
use quell_numerics::matrix::Matrix;

fn contact(row: [f64; 2], friction: Friction, speed: f64, load: f64) -> Contact {
    Contact {
        name: "block".to_owned(),
        tangent: Some(row.to_vec()),
        force: None,
        normal: None,
        slope: None,
        normal_load: load,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(speed),
        friction,
        varying_load: None,
    }
}

/// Two blocks on a belt, coupled by a spring and each held by one; the second is pressed more than the first.
fn blocks(friction: &Friction, speed: f64, damping: f64, inputs: Vec<Input>) -> System {
    let stiffness = [[2.2, -1.2], [-1.2, 2.2]];
    let structure = Mechanical::new(
        vec!["x".to_owned(), "y".to_owned()],
        MassMatrix::identity(2),
        Matrix::from_fn(2, 2, |i, j| if i == j { damping } else { 0.0 }),
        Matrix::from_fn(2, 2, |i, j| stiffness[i][j]),
    );
    let contacts = vec![
        contact([1.0, 0.0], friction.clone(), speed, 1.0),
        contact([0.0, 1.0], friction.clone(), speed, 1.3),
    ];
    System { structure: structure.into(), contacts, inputs }
}

fn rates(exponents: &[LyapunovExponent]) -> Vec<f64> {
    exponents.iter().map(LyapunovExponent::rate).collect()
}

/// In slip with constant friction the equations are linear: the sum of the exponents is the trace of their matrix.
#[test]
fn the_sum_of_exponents_in_pure_slip_is_the_trace() {
    let law = LawKind::Coulomb.build(&[0.3, 0.3, 0.05]).expect("valid");
    let wave = Wave {
        waveform: Waveform::Sine,
        amplitude: 0.2,
        frequency: 3.0,
        phase: 0.0,
        envelope: None,
    };
    let target = InputTarget::Force(vec![1.0, 0.0]);
    let input = Input { target, profile: Profile::constant(0.0).with(wave) };
    let damping = 0.04;
    let system = blocks(&law, 5.0, damping, vec![input]);
    let motion = Motion::new(&system).expect("moves");
    let start = MotionStart { time: 0.0, state: vec![0.1, 0.2, 0.0, 0.0] };
    let found = motion.lyapunov_exponents(&start, (50.0, 400.0), 4).expect("exponents");
    let sum: f64 = rates(&found.exponents).iter().sum();
    // Friction damps each block by σ_v N besides its own damper.
    let trace = -(2.0 * damping + 0.05 * (1.0 + 1.3));
    assert!((sum - trace).abs() < 1e-10, "{sum} {trace}");
    assert_eq!(found.verdict(false), LyapunovVerdict::Regular);
    assert_eq!(found.kaplan_yorke_dimension(false), Some(0.0));
    for means in &found.means {
        assert_eq!(means.len(), found.means[0].len());
    }
}

/// Mean rate at which the distance between two runs grows, which is set back to a small one every `interval`.
fn growth_of_a_difference(
    motion: &Motion<'_>,
    start: &MotionStart,
    interval: f64,
    count: u32,
) -> f64 {
    const DISTANCE: f64 = 1e-7;
    let mut one = start.clone();
    let mut direction: Vec<f64> = vec![0.5, -0.5, 0.5, 0.5];
    let mut sum = 0.0;
    for index in 1..=count {
        let until = start.time + f64::from(index) * interval;
        let state =
            one.state.iter().zip(&direction).map(|(x, d)| DISTANCE.mul_add(*d, *x)).collect();
        let other = MotionStart { time: one.time, state };
        let run = |from: &MotionStart| {
            motion.run(from, until, MOTION_TOLERANCE, &mut ()).expect("a run").restart()
        };
        let (first, second) = (run(&one), run(&other));
        let change: Vec<f64> = second.state.iter().zip(&first.state).map(|(b, a)| b - a).collect();
        let length = change.iter().map(|d| d * d).sum::<f64>().sqrt();
        sum += (length / DISTANCE).ln();
        direction = change.iter().map(|d| d / length).collect();
        one = first;
    }
    sum / (f64::from(count) * interval)
}

/// Two blocks that stick and slip on a belt while a force shakes the first: chaotic. The exponent from the variational equation
/// is that from two runs.
#[test]
fn a_chaotic_motion_has_one_exponent_by_two_methods() {
    let law = LawKind::Decreasing.build(&[0.5, 0.2, 0.15]).expect("valid");
    let (amplitude, frequency) = (0.3, 1.7);
    let wave = Wave { waveform: Waveform::Sine, amplitude, frequency, phase: 0.0, envelope: None };
    let target = InputTarget::Force(vec![1.0, 0.0]);
    let input = Input { target, profile: Profile::constant(0.0).with(wave) };
    let system = blocks(&law, 0.05, 0.02, vec![input]);
    let motion = Motion::new(&system).expect("moves");
    let start = MotionStart { time: 0.0, state: vec![0.3, 0.2, 0.0, 0.0] };
    let period = std::f64::consts::TAU / frequency;
    let times = (100.0 * period, 3000.0 * period);
    let found = motion.lyapunov_exponents(&start, times, 4).expect("exponents");
    assert_eq!(found.verdict(false), LyapunovVerdict::Irregular, "{found:?}");
    let LyapunovExponent::Rate { value, error } = found.exponents[0] else { panic!("{found:?}") };
    let other = growth_of_a_difference(&motion, &start, period, 3000);
    // Both are means over different parts of one attractor.
    assert!((other - value).abs() < 5.0 * error, "{other} {value} {error}");
    assert!(value > 20.0 * error, "{value} {error}");
    assert!(found.exponents.contains(&LyapunovExponent::Erased), "the blocks stick");
    assert!(found.kaplan_yorke_dimension(false).is_some_and(|dimension| dimension > 1.0));
}
