//! Derivatives of least amplitudes against differences of exact thresholds, located at neighbouring values of each number.

use quell_design::least_dither::{LeastAmplitude, LeastAmplitudeSensitivity};
use quell_dynamics::orbit::{OrbitVerdict, ThresholdKind, branch_thresholds};
use quell_model::profile::{Profile, Wave};
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::{Belt, Direction, Dither, LawKind, RefusedNumbers, System, Waveform};
use quell_numerics::interval::RealInterval;
use quell_numerics::matrix::Matrix;

/// A belt with ζ, F, v₀, the three coefficients of the law, and R as its numbers.
fn belt(amplitude: f64, numbers: &[f64]) -> Result<System, RefusedNumbers> {
    let law = LawKind::Stribeck.build(&numbers[3..6])?;
    let dither = Dither {
        direction: Direction::Tangential,
        waveform: Waveform::Sine,
        amplitude,
        frequency_ratio: numbers[6],
        phase: 0.0,
        envelope: None,
    };
    let belt = Belt::new(numbers[0], numbers[1], numbers[2], law, vec![dither]);
    Ok(belt?.system())
}

/// Two masses, friction at the second and dither on both, with numbers in the order of the uses below.
fn two_masses(amplitude: f64, numbers: &[f64]) -> Result<System, RefusedNumbers> {
    let [joint, damping, load, speed, frequency, share, ..] = numbers else {
        return Err(RefusedNumbers::by_study("numbers are missing"));
    };
    let stiffness = Matrix::from_fn(2, 2, |i, j| {
        if i == j { 1.0 + joint * f64::from(u8::from(i == 0)) } else { -joint }
    });
    let damping = Matrix::from_fn(2, 2, |i, j| if i == j { *damping } else { 0.0 });
    let contact = Contact {
        name: "pad".to_owned(),
        tangent: Some(vec![0.0, 1.0]),
        force: None,
        normal: None,
        slope: None,
        normal_load: *load,
        normal_stiffness: 0.0,
        tangential_stiffness: None,
        normal_damping: 0.0,
        surface_velocity: Profile::constant(*speed),
        friction: LawKind::Decreasing.build(&numbers[6..9])?,
        varying_load: None,
    };
    let wave = Wave {
        waveform: Waveform::Sine,
        amplitude,
        frequency: *frequency,
        phase: 0.0,
        envelope: None,
    };
    let input = Input {
        target: InputTarget::Force(vec![*share, 1.0]),
        profile: Profile::default().with(wave),
    };
    let names = vec!["x".to_owned(), "y".to_owned()];
    Ok(System {
        structure: Mechanical::new(names, MassMatrix::identity(2), damping, stiffness).into(),
        contacts: vec![contact],
        inputs: vec![input],
    })
}

/// The same with the dither on the mass that has no contact: its motion is much larger than that of the contact, and differences of
/// the equations need steps that are small against the latter.
fn driven_far_from_the_contact(amplitude: f64, numbers: &[f64]) -> Result<System, RefusedNumbers> {
    let mut system = two_masses(amplitude, numbers)?;
    system.inputs[0].target = InputTarget::Force(vec![numbers[5], 0.0]);
    Ok(system)
}

type SystemOf = fn(f64, &[f64]) -> Result<System, RefusedNumbers>;

/// The amplitude at which the base response becomes stable near another one.
fn threshold(of: SystemOf, near: f64, numbers: &[f64]) -> (f64, ThresholdKind) {
    let at = |values: &[f64]| of(values[0], numbers);
    let found = branch_thresholds(&at, 0.97 * near, 1.03 * near, 16, None).expect("a response");
    let quiet = found.thresholds.iter().filter(|found| found.becomes == Some(OrbitVerdict::Stable));
    let nearest = quiet.min_by(|a, b| (a.value - near).abs().total_cmp(&(b.value - near).abs()));
    nearest.map(|found| (found.value, found.kind)).expect("a threshold")
}

/// Compares every derivative with central differences of thresholds, extrapolated twice from a step that is a share of the number:
/// thresholds are located to about 10⁻¹¹, which small steps would show.
fn compared(of: SystemOf, near: f64, numbers: &[f64], (kind, share): (ThresholdKind, f64)) {
    let (amplitude, found) = threshold(of, near, numbers);
    assert_eq!(found, kind);
    let at = |amplitude: f64, _: &[f64], numbers: &[f64]| of(amplitude, numbers);
    let least = LeastAmplitude { at: &at, amplitude, point: &[], over: &[], numbers };
    let LeastAmplitudeSensitivity { kind, meets, derivatives } =
        least.sensitivity().expect("regular");
    assert_eq!((kind, meets), (found, None));
    for (place, derivative) in derivatives.iter().enumerate() {
        let derivative = *derivative.as_ref().expect("known");
        let moved = |step: f64| {
            let mut moved = numbers.to_vec();
            moved[place] += step;
            threshold(of, amplitude, &moved).0
        };
        let slope = |step: f64| (moved(step) - moved(-step)) / (2.0 * step);
        let step = share * numbers[place];
        let wanted = (64.0 * slope(0.25 * step) - 20.0 * slope(0.5 * step) + slope(step)) / 45.0;
        // Relative to the elasticity that counts, 10⁻³, where the number hardly matters.
        let size = wanted.abs().max(1e-3 * amplitude / numbers[place].abs());
        assert!(
            (derivative - wanted).abs() < 1e-6 * size,
            "number {place}: {derivative} and {wanted}"
        );
    }
}

/// The grazing that decides the design of the first belt, at v₀ = 0.15: an independent program has the amplitude 1.4863197137.
#[test]
fn of_a_grazing_of_a_belt() {
    let numbers = [0.005, 1.0, 0.15, 0.4, 0.2857, 0.2, 10.0];
    let (amplitude, _) = threshold(belt, 1.486, &numbers);
    assert!((amplitude / 1.4863197137178406 - 1.0).abs() < 1e-8, "{amplitude}");
    compared(belt, amplitude, &numbers, (ThresholdKind::Grazing, 1e-3));
}

/// A pair of multipliers crosses the unit circle as the dither raises the mean slope of the friction.
#[test]
fn of_a_neimark_sacker_bifurcation_of_a_belt() {
    let numbers = [0.005, 1.0, 0.18, 0.4, 0.2857, 0.2, 10.0];
    let near = first_quiet(belt, 0.01, &numbers);
    compared(belt, near, &numbers, (ThresholdKind::NeimarkSacker, 1e-3));
}

/// The first of some amplitudes at which the base response is stable.
fn first_quiet(of: SystemOf, step: f64, numbers: &[f64]) -> f64 {
    let quiet = |amplitude: &f64| {
        let system = of(*amplitude, numbers).expect("a system");
        let orbit = quell_dynamics::orbit::base_response(&system, 8);
        orbit.is_ok_and(|orbit| orbit.verdict() == OrbitVerdict::Stable)
    };
    (1..200).map(|k| step * f64::from(k)).find(quiet).expect("a quiet amplitude")
}

#[test]
fn of_a_grazing_of_two_masses() {
    let numbers = [0.6, 0.01, 1.0, 0.15, 7.3, 0.4, 0.4, 0.2857, 0.2];
    let near = first_quiet(two_masses, 0.05, &numbers);
    let (_, kind) = threshold(two_masses, near, &numbers);
    compared(two_masses, near, &numbers, (kind, 1e-3));
}

#[test]
fn of_a_dither_far_from_the_contact() {
    let numbers = [1.0, 0.02, 1.0, 0.15, 10.0, 1.0, 0.4, 0.2857, 0.2];
    let near = first_quiet(driven_far_from_the_contact, 5.0, &numbers);
    let (_, kind) = threshold(driven_far_from_the_contact, near, &numbers);
    compared(driven_far_from_the_contact, near, &numbers, (kind, 5e-3));
}

/// At a tip two thresholds meet inside the box: the amplitude follows the tip, which an independent program has at v₀ = 0.16234527 and
/// D = 1.60851599, and does not depend on the speed of the study.
#[test]
fn of_a_tip_inside_a_box() {
    let numbers = [0.005, 1.0, 0.4, 0.2857, 0.2, 10.0];
    let at = |amplitude: f64, point: &[f64], numbers: &[f64]| {
        belt(amplitude, &[&numbers[..2], point, &numbers[2..]].concat())
    };
    let (point, over) = ([0.16234527494519785], [RealInterval::new(0.05, 0.2)]);
    let least = LeastAmplitude {
        at: &at,
        amplitude: 1.6085159880796942,
        point: &point,
        over: &over,
        numbers: &numbers,
    };
    let found = least.sensitivity().expect("regular");
    assert_eq!(found.kind, ThresholdKind::Grazing);
    assert!(found.meets.is_some(), "{found:?}");
    // Averaging at high frequency: the tip is at D = v R (1 − 1/R²) with v from the reference velocity, to which it is proportional, so
    // that the elasticities to R and v_m are (1 + 1/R²)/(1 − 1/R²) and about 1.
    let elasticity = |place: usize| {
        found.derivatives[place].as_ref().expect("known") * numbers[place] / least.amplitude
    };
    assert!((elasticity(5) - 1.01 / 0.99).abs() < 0.03, "{}", elasticity(5));
    assert!((elasticity(4) - 1.0).abs() < 0.03, "{}", elasticity(4));
}
