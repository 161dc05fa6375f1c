//! Averages under noise: closed forms against quadrature, the Gaussian limit of many lines, and the verdicts that follow.

use std::f64::consts::{PI, SQRT_2, TAU};

use quell_linear::averaging::{
    Averaging, AveragingError, CrossingKind, DitheredSystem, FastMotion, criterion,
    critical_amplitudes, effective, effective_under_noise_by_quadrature, unstable_bands,
};
use quell_linear::harmonic::response;
use quell_model::profile::Profile;
use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
use quell_model::waveform::Noise;
use quell_model::{Belt, Direction, Dither, Friction, LawKind, System, Waveform};
use quell_numerics::matrix::Matrix;
use quell_numerics::quadrature::{QuadratureOptions, integrate};
use quell_numerics::special::erf;

fn law(kind: LawKind, values: &[f64]) -> Friction {
    kind.build(values).expect("valid")
}

/// Laws with closed forms.
fn closed() -> Vec<Friction> {
    vec![
        law(LawKind::Stribeck, &[0.4, 0.2857, 0.2]),
        law(LawKind::Decreasing, &[0.4, 0.2857, 0.2]),
        law(LawKind::Coulomb, &[0.3, 0.4, 0.15]),
        law(LawKind::StribeckExponential, &[0.3, 0.45, 0.1, 1.0, 0.05]),
        law(LawKind::StribeckExponential, &[0.3, 0.45, 0.1, 2.0, 0.05]),
    ]
}

fn noise(lines: u32, seed: u64) -> Noise {
    Noise::new([8.0, 12.0], lines, seed).expect("valid")
}

fn dither(direction: Direction, amplitude: f64, lines: u32) -> Dither {
    Dither {
        direction,
        waveform: Waveform::Noise(noise(lines, 1).into()),
        amplitude,
        frequency_ratio: 10.0,
        phase: 0.0,
        envelope: None,
    }
}

fn belt(law: Friction, velocity: f64, dithers: Vec<Dither>) -> Belt {
    Belt::new(0.005, 1.0, velocity, law, dithers).expect("valid")
}

fn gaussian(deviation: f64) -> FastMotion {
    FastMotion::default().with_noise(deviation)
}

#[test]
fn closed_forms_are_the_quadrature() {
    for law in closed() {
        for deviation in [1e-3, 0.02, 0.1, 0.35, 2.0] {
            for v in [0.0, 1e-4, 0.03, 0.1, 0.4, 1.7, -0.1] {
                let closed = effective(&law, &gaussian(deviation), v).expect("a mean");
                let other =
                    effective_under_noise_by_quadrature(&law, deviation, v).expect("a mean");
                let size = closed.coefficient.abs().max(0.1);
                let difference = (closed.coefficient - other.coefficient).abs();
                assert!(difference < 1e-11 * size, "{law:?} {deviation} {v}: {difference}");
                let size = closed.slope.abs().max(0.1 + 0.4 / deviation);
                let difference = (closed.slope - other.slope).abs();
                assert!(difference < 1e-10 * size, "slope, {law:?} {deviation} {v}: {difference}");
            }
        }
    }
}

/// With the motion frozen the slope is the derivative of the mean.
#[test]
fn the_slope_is_the_derivative() {
    let lugre_like = law(LawKind::StribeckExponential, &[0.3, 0.45, 0.1, 0.7, 0.0]);
    for law in closed().into_iter().chain([lugre_like]) {
        let mean = |v: f64| effective(&law, &gaussian(0.1), v).expect("a mean");
        for v in [0.05, 0.2, 0.6] {
            let h = 1e-4;
            let difference = (mean(v + h).coefficient - mean(v - h).coefficient) / (2.0 * h);
            // The error of a central difference, h² μ̄‴/6, with μ̄‴ up to μ_s/σ³ times a few.
            assert!((difference - mean(v).slope).abs() < 1e-4, "{law:?} {v}");
        }
    }
}

/// Constant friction under a Gaussian velocity is the error function; without noise the law itself remains.
#[test]
fn limits_of_the_mean() {
    let coulomb = law(LawKind::Coulomb, &[0.3, 0.4, 0.0]);
    for (v, deviation) in [(0.1, 0.1), (0.02, 0.3), (0.5, 0.1)] {
        let found = effective(&coulomb, &gaussian(deviation), v).expect("a mean");
        assert!((found.coefficient - 0.3 * erf(v / (deviation * SQRT_2))).abs() < 1e-15);
    }
    for law in closed() {
        let found = effective(&law, &gaussian(1e-7), 0.3).expect("a mean");
        assert!((found.coefficient - law.coefficient(0.3)).abs() < 1e-12, "{law:?}");
        assert!((found.slope - law.slope(0.3)).abs() < 1e-11, "{law:?}");
        // ⟨μ′⟩ at v = 0 contains the jump, twice the level at rest times the density.
        let at_rest = effective(&law, &gaussian(1e-3), 0.0).expect("a mean");
        let jump = 2.0 * law.coefficient(0.0) / (1e-3 * TAU.sqrt());
        assert_eq!(at_rest.coefficient, 0.0);
        assert!((at_rest.slope / jump - 1.0).abs() < 0.01, "{law:?}");
    }
}

/// Mean of sgn(v − w) over the phases of lines of these amplitudes: (2/π) ∫ sin(kv)/k ∏ J₀(aᵢk) dk.
fn sign_over_lines(amplitudes: &[f64], v: f64) -> f64 {
    let product = |k: f64| amplitudes.iter().map(|a| libm::j0(a * k)).product::<f64>();
    let integrand = |k: f64| libm::sin(k * v) / k * product(k);
    let deviation = (0.5 * amplitudes.iter().map(|a| a * a).sum::<f64>()).sqrt();
    // The characteristic function of many lines has decayed to 10⁻¹⁶ there.
    let end = 9.0 / deviation;
    let options = QuadratureOptions { relative: 1e-12, absolute: 1e-13, ..Default::default() };
    let cuts: Vec<f64> = (1..40).map(|k| end * f64::from(k) / 40.0).collect();
    2.0 / PI * integrate(integrand, 0.0, end, &cuts, &options).expect("an integral").value
}

/// The mean over the phases of n lines approaches the Gaussian mean like 1/n, with the first term of the Edgeworth series: the
/// excess kurtosis −3/(2n) changes it by less than 0.07/n.
#[test]
fn many_lines_are_gaussian() {
    let coulomb = law(LawKind::Coulomb, &[1.0, 1.0, 0.0]);
    let largest = |lines: u32| -> f64 {
        let noise = noise(lines, 1);
        let share = noise.line_amplitude();
        let amplitudes: Vec<f64> = noise.lines().iter().map(|line| share / line.ratio).collect();
        let deviation = noise.mean_square(|ratio| 1.0 / ratio).sqrt();
        let errors = (1..=30).map(|k| {
            let v = 0.1 * f64::from(k) * deviation;
            let mean = effective(&coulomb, &gaussian(deviation), v).expect("a mean").coefficient;
            (sign_over_lines(&amplitudes, v) - mean).abs()
        });
        errors.fold(0.0, f64::max)
    };
    let errors = [16, 32, 64].map(largest);
    for (error, lines) in errors.iter().zip([16.0, 32.0, 64.0]) {
        assert!(*error < 0.085 / lines && *error > 0.05 / lines, "{lines}: {error}");
    }
    assert!((errors[0] / errors[1] - 2.0).abs() < 0.2 && (errors[1] / errors[2] - 2.0).abs() < 0.2);
}

#[test]
fn the_variance_is_the_sum_over_the_lines() {
    let coulomb = || law(LawKind::Coulomb, &[0.3, 0.4, 0.0]);
    let noisy = belt(coulomb(), 0.1, vec![dither(Direction::Tangential, 1.5, 32)]);
    let lines = noisy.dithers()[0].by_harmonics();
    let sum = |gain: fn(f64) -> f64| {
        let square = |line: &Dither| {
            let velocity = gain(line.frequency_ratio) * line.amplitude / line.frequency_ratio;
            0.5 * velocity * velocity
        };
        lines.iter().map(square).sum::<f64>().sqrt()
    };
    let limit = FastMotion::of(&noisy, 0.1, Averaging::Limit).expect("a motion");
    assert!((limit.noise() / sum(|_| 1.0) - 1.0).abs() < 1e-14);
    let finite = FastMotion::of(&noisy, 0.1, Averaging::FiniteR).expect("a motion");
    assert!((finite.noise() / sum(|r| r * r / (r * r - 1.0)) - 1.0).abs() < 1e-14);
    // Normal noise moves the mass through friction, to first order.
    let normal = belt(coulomb(), 0.1, vec![dither(Direction::Normal, 0.1, 32)]);
    let of = |options| FastMotion::of(&normal, 0.1, options);
    let driven = of(Averaging::Limit).expect("a motion").noise();
    assert!((driven / (0.3 * 0.1 / 1.5 * sum(|_| 1.0)) - 1.0).abs() < 1e-14);
    let finite = of(Averaging::FiniteR).expect("a motion").noise();
    let exact = 0.3 * 0.1 / 1.5 * sum(|r| r * r / (r * r - 1.0));
    assert!((finite / exact - 1.0).abs() < 1e-14);
}

/// Noise and a sine: the mean over the phase of the sine of the Gaussian mean.
#[test]
fn noise_and_a_sine() {
    let sine = Dither {
        waveform: Waveform::Sine,
        frequency_ratio: 17.3,
        amplitude: 1.0,
        ..dither(Direction::Tangential, 1.0, 1)
    };
    let with_noise = dither(Direction::Tangential, 0.8, 64);
    for law in closed() {
        let belt = belt(law.clone(), 0.1, vec![sine.clone(), with_noise.clone()]);
        let motion = FastMotion::of(&belt, 0.1, Averaging::Limit).expect("a motion");
        let found = effective(&law, &motion, 0.1).expect("a mean");
        // A smooth periodic integrand: the sum over equal phases converges faster than any power.
        let steps = 256;
        let each = (0..steps).map(|k| {
            let s = 1.0 / 17.3 * libm::sin(TAU * f64::from(k) / f64::from(steps));
            effective_under_noise_by_quadrature(&law, motion.noise(), 0.1 - s).expect("a mean")
        });
        let (mut value, mut slope) = (0.0, 0.0);
        for one in each {
            value += one.coefficient / f64::from(steps);
            slope += one.slope / f64::from(steps);
        }
        assert!((found.coefficient - value).abs() < 1e-10, "{law:?}");
        assert!((found.slope - slope).abs() < 1e-8, "{law:?}: {} {slope}", found.slope);
    }
}

/// The Stribeck law under noise: the criterion in closed form has the roots that the search finds, and no jump.
#[test]
fn critical_amplitudes_are_roots() {
    let stribeck = law(LawKind::Stribeck, &[0.4, 0.2857, 0.2]);
    for velocity in [0.05, 0.1, 0.15] {
        let noisy = belt(stribeck.clone(), velocity, vec![dither(Direction::Tangential, 1.0, 64)]);
        let critical = critical_amplitudes(&noisy, Averaging::Limit).expect("amplitudes");
        assert!(!critical.is_empty(), "v₀ = {velocity}");
        let unit = FastMotion::of(&noisy, velocity, Averaging::Limit).expect("a motion");
        let (fall, cubic) = (1.5 * 0.1143 / 0.2, 1.5 * 0.1143 / (3.0 * 0.008));
        let value = |amplitude: f64| {
            let deviation = amplitude * unit.noise();
            let x = velocity / deviation;
            let density = (-0.5 * x * x).exp() / (deviation * TAU.sqrt());
            0.01 + 0.8 * density - fall
                + 3.0 * cubic * (velocity * velocity + deviation * deviation)
        };
        for found in &critical {
            assert_eq!(found.crossing, CrossingKind::Root);
            assert!(value(found.amplitude).abs() < 1e-9, "{found:?}");
        }
        // Every change of sign of the closed form on a fine grid is found.
        let grid: Vec<f64> = (1..4000).map(|k| value(2e-3 * f64::from(k))).collect();
        let inside = critical.iter().filter(|found| found.amplitude < 7.998).count();
        let changes = grid.windows(2).filter(|pair| (pair[0] < 0.0) != (pair[1] < 0.0)).count();
        assert_eq!(changes, inside, "v₀ = {velocity}");
    }
}

#[test]
fn bands_agree_with_the_criterion() {
    let stribeck = law(LawKind::Stribeck, &[0.4, 0.2857, 0.2]);
    let at = |velocity: f64| {
        belt(stribeck.clone(), velocity, vec![dither(Direction::Tangential, 0.6, 64)])
    };
    let bands = unstable_bands(&at(0.1), Averaging::Limit).expect("bands");
    assert_eq!(bands.len(), 1);
    let value = |v: f64| criterion(&at(v), Averaging::Limit).expect("a value").value;
    let upper = bands[0].upper.expect("an end");
    for edge in [bands[0].lower, upper] {
        assert!(value(edge).abs() < 1e-8, "{edge}");
    }
    assert!(value(0.5 * (bands[0].lower + upper)) < 0.0);
}

/// A system of one mass without damping has the averages of the undamped belt at finite R, which has its response.
#[test]
fn a_system_of_one_mass_is_the_belt() {
    let stribeck = law(LawKind::Stribeck, &[0.4, 0.2857, 0.2]);
    let noise = dither(Direction::Tangential, 1.5, 32);
    let belt = Belt::new(0.0, 1.0, 0.1, stribeck, vec![noise]).expect("valid");
    let system = belt.system();
    let prepared = DitheredSystem::new(&system).expect("a response");
    let average = prepared.average().expect("an average");
    let exact = criterion(&belt, Averaging::FiniteR).expect("a value");
    let contact = &average.contacts[0];
    assert!((contact.effective_coefficient / exact.effective.coefficient - 1.0).abs() < 1e-12);
    assert!((contact.slope_by_velocity / exact.effective.slope - 1.0).abs() < 1e-11);
    let growth = average.growth().expect("a growth rate").rate;
    assert!((growth + 0.5 * exact.value).abs() < 1e-10, "{growth} {}", exact.value);
    let critical = critical_amplitudes(&belt, Averaging::FiniteR).expect("roots");
    let found = prepared.critical_amplitudes(0).expect("roots");
    assert_eq!(found.len(), critical.len());
    for (one, other) in found.iter().zip(&critical) {
        assert!((one.amplitude / other.amplitude - 1.0).abs() < 1e-8, "{one:?} {other:?}");
        assert_eq!(one.crossing, CrossingKind::Root);
    }
}

/// A dither on the load that the structure bears: slip and load are correlated. The mean friction is that of the same lines over
/// their phases, ⟨μ(γ + a)(N + Ñ)⟩, here of a law that is linear in the slip velocity, for which the mean is exact.
#[test]
fn correlated_slip_and_load() {
    let viscous = law(LawKind::Coulomb, &[0.0, 0.0, 0.5]);
    let structure = Mechanical::new(
        vec!["x".to_owned(), "z".to_owned()],
        MassMatrix::identity(2),
        Matrix::from_fn(2, 2, |i, j| if i == j { 0.1 } else { 0.02 }),
        Matrix::from_fn(2, 2, |i, j| if i == j { 2.0 } else { -0.3 }),
    );
    let contact = Contact {
        name: "c".to_owned(),
        tangent: Some(vec![1.0, 0.0]),
        force: None,
        normal: Some(vec![0.0, 1.0]),
        slope: None,
        normal_load: 1.0,
        varying_load: None,
        normal_stiffness: 5.0,
        normal_damping: 0.1,
        surface_velocity: Profile::constant(0.3),
        friction: viscous,
        tangential_stiffness: None,
    };
    let noise = dither(Direction::Tangential, 0.8, 16);
    let input = Input {
        target: InputTarget::Force(vec![1.0, 0.7]),
        profile: Profile::default().with(noise.wave()),
    };
    let system =
        System { structure: structure.into(), contacts: vec![contact], inputs: vec![input] };
    let prepared = DitheredSystem::new(&system).expect("a response");
    let average = prepared.average().expect("an average");
    // ⟨0.5(γ + a)Ñ⟩ = 0.5⟨aÑ⟩, summed over the lines.
    let mut covariance = 0.0;
    for line in noise.by_harmonics() {
        let target = &system.inputs[0].target;
        let at = line.frequency_ratio;
        let found = response(&system, prepared.sliding(), target, at).expect("a response");
        let one = &found.contacts[0];
        covariance += 0.5 * line.amplitude * line.amplitude * (one.slip * one.load.conj()).re;
    }
    let ratchet = average.contacts[0].ratchet_force;
    assert!(covariance.abs() > 1e-6);
    assert!((ratchet / (0.5 * covariance) - 1.0).abs() < 1e-11, "{ratchet} {covariance}");
}

#[test]
fn slow_noise_has_no_oscillator_response() {
    let slow = Dither { frequency_ratio: 1.1, ..dither(Direction::Tangential, 0.1, 8) };
    let slow = belt(law(LawKind::Coulomb, &[0.3, 0.4, 0.0]), 0.1, vec![slow]);
    let found = FastMotion::of(&slow, 0.1, Averaging::FiniteR);
    assert!(
        matches!(found, Err(AveragingError::NotFast { frequency_ratio }) if frequency_ratio < 1.0)
    );
}
