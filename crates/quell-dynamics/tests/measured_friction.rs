//! Effective friction measured on trajectories, against its exact value.

use std::f64::consts::TAU;

use quell_dynamics::orbit::base_response;
use quell_dynamics::response::{
    NoSteadyFriction, SteadyFriction, measured_effective_friction, steady_effective_friction,
};
use quell_dynamics::simulation::{Sampler, Start, simulate};
use quell_linear::averaging::{Averaging, FastMotion, effective};
use quell_model::waveform::{Burst, Hold, SampledWave};
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
use quell_zoo as zoo;
use quell_zoo::dither::{normal, tangential};

fn belt(belt_velocity: f64, damping_ratio: f64, amplitude: f64) -> Belt {
    let dithers = vec![normal(Waveform::Sine, amplitude, 5.0)];
    zoo::belt::belt(damping_ratio, belt_velocity, zoo::law::decreasing(), dithers)
}

fn at(displacement: f64) -> Start {
    Start { time: 0.0, displacement, velocity: 0.0 }
}

/// Without dither the mean over a window is the mean of the law over the slip in it: a point of the law as long as
/// the velocity is nearly constant.
#[test]
fn without_dither_the_points_lie_on_the_law() {
    let belt = belt(1.5, 0.05, 0.0);
    let start = at(belt.steady_sliding() + 1e-4);
    let means = measured_effective_friction(&belt, 5.0, &[start], 40.0, 4, 1e-12).expect("runs");
    assert_eq!(means.len(), 124, "40 τ hold 127 quarter periods, hence 124 windows of four");
    for (index, mean) in means.iter().enumerate() {
        // The slow velocity changes by the difference of the windows half a period before and after.
        let ends =
            index.checked_sub(2).and_then(|before| Some((means[before], *means.get(index + 2)?)));
        let drift = ends.map(|(before, after)| after.slip_velocity - before.slip_velocity);
        assert_eq!(mean.drift, drift);
        let law = belt.friction().coefficient(mean.slip_velocity);
        assert!((mean.coefficient - law).abs() < 1e-9, "{mean:?} against {law}");
    }
}

/// The balance of momentum over one window: x′ + 2ζx and ∫x change by the friction impulse. With constant load
/// (D = 0) the impulse is the mean coefficient times F.
#[test]
fn the_impulse_closes_the_balance_of_momentum() {
    let belt = belt(0.3, 0.01, 0.0);
    let start = at(0.45);
    let window = TAU / 5.0;
    let means =
        measured_effective_friction(&belt, 5.0, &[start], window * 1.01, 2, 1e-13).expect("runs");
    let mut sampler = Sampler::new(0.0, window / 4000.0, 4001);
    simulate(&belt, start, window * 1.01, 1e-13, &mut sampler).expect("runs");
    let samples = &sampler.samples;
    // Simpson's rule for ∫x.
    let integral: f64 = samples
        .iter()
        .enumerate()
        .map(|(k, sample)| {
            let weight = if k == 0 || k == 4000 {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            };
            weight * sample.displacement
        })
        .sum::<f64>()
        * window
        / 4000.0
        / 3.0;
    let change = samples[4000].velocity - samples[0].velocity
        + 0.02 * (samples[4000].displacement - samples[0].displacement);
    let expected = (change + integral) / window;
    assert_eq!(means.len(), 1);
    assert!((means[0].coefficient - expected).abs() < 1e-11, "{} {expected}", means[0].coefficient);
}

/// Every window is reported, with the fraction of it that sticks, and no mean exceeds μ_s.
#[test]
fn windows_report_their_stick() {
    let belt = belt(0.05, 0.005, 0.3);
    let means = measured_effective_friction(&belt, 5.0, &[at(0.45)], 60.0, 8, 1e-12).expect("runs");
    assert_eq!(means.len(), 374, "60 τ hold 381 eighths of a period, hence 374 windows of eight");
    let stuck = |low: f64, high: f64| {
        means.iter().filter(|mean| low < mean.stick_fraction && mean.stick_fraction < high).count()
    };
    assert!(
        stuck(-1.0, 1e-300) > 20 && stuck(0.0, 1.0) > 5,
        "windows that slip, and that stick for a part"
    );
    assert!(means.iter().all(|mean| (0.0..=1.0 + 1e-12).contains(&mean.stick_fraction)));
    assert!(means.iter().all(|mean| mean.coefficient.abs() <= 0.4));
}

fn steady(belt: &Belt, v: f64) -> SteadyFriction {
    steady_effective_friction(belt, v, 1e-12).expect("a steady response")
}

/// With a constant load the balance of momentum over a period, ⟨x⟩ = F⟨f/N⟩, holds through stick and reversals.
#[test]
fn the_mean_displacement_balances_the_measured_friction() {
    let dithers = vec![tangential(Waveform::Sine, 0.3, 5.0)];
    let belt = zoo::belt::belt(0.005, 0.02, zoo::law::decreasing(), dithers);
    let orbit = base_response(&belt.system(), 8).expect("an orbit");
    let found = steady(&belt, 0.02);
    assert!(0.01 < found.stick_fraction && found.stick_fraction < 0.99, "{found:?}");
    let count = 20_000u16;
    let step = orbit.period / f64::from(count);
    let mut sampler = Sampler::new(0.0, step, usize::from(count));
    simulate(&belt, Start::of_state(&orbit.state), orbit.period, 1e-12, &mut sampler)
        .expect("runs");
    let mean =
        sampler.samples.iter().map(|sample| sample.displacement).sum::<f64>() / f64::from(count);
    assert!((mean - found.coefficient).abs() < 1e-7, "{mean} {found:?}");
}

/// Friction is odd in the slip velocity, with the dither in either direction.
#[test]
fn a_negative_slip_velocity_is_the_mirror_image() {
    for dither in [tangential(Waveform::Triangle, 0.3, 5.0), normal(Waveform::Sine, 0.6, 5.0)] {
        let belt = zoo::belt::belt(0.005, 0.02, zoo::law::stribeck(), vec![dither]);
        for v in [0.03, 0.15] {
            let [right, left] = [v, -v].map(|v| steady(&belt, v));
            assert!((right.coefficient + left.coefficient).abs() < 1e-9, "{right:?} {left:?}");
            assert!((right.stick_fraction - left.stick_fraction).abs() < 1e-8);
        }
    }
}

/// Limits: the law itself without dither; the closed average at high frequency; and no answer at rest.
#[test]
fn limits_of_the_steady_friction() {
    let undithered = belt(0.1, 0.005, 0.0).undithered();
    let law = undithered.friction().coefficient(0.07);
    assert_eq!(steady(&undithered, 0.07).coefficient, law);
    assert_eq!(steady(&undithered, -0.07).coefficient, -law);
    assert!(steady_effective_friction(&undithered, 0.0, 1e-12).is_err());
    assert!(steady_effective_friction(&undithered, f64::NAN, 1e-12).is_err());
    // α = 0.1 and v = 0.25: slip throughout. The oscillator's response differs from αG by 1/R².
    let errors = [10.0, 20.0, 40.0].map(|ratio| {
        let dithers = vec![tangential(Waveform::Sine, 0.1 * ratio, ratio)];
        let belt = zoo::belt::belt(0.005, 0.02, zoo::law::decreasing(), dithers);
        let motion = FastMotion::of(&belt, 0.25, Averaging::Limit).expect("a motion");
        let averaged = effective(belt.friction(), &motion, 0.25).expect("an average");
        (steady(&belt, 0.25).coefficient - averaged.coefficient).abs()
    });
    assert!(
        errors[0] < 1e-3 && errors[1] < 0.3 * errors[0] && errors[2] < 0.3 * errors[1],
        "{errors:?}"
    );
}

/// Without symmetry of the waveform friction at −v is not minus that at v: both are those of averaging, from
/// which they differ by the fast velocity that friction itself causes, of order F/R.
#[test]
fn friction_of_a_waveform_without_symmetry_depends_on_the_direction() {
    let values = vec![1.5, -0.4, -0.2, -0.6, -0.3];
    let samples = SampledWave::new(values, Hold::Linear).expect("samples");
    let dither = |waveform: Waveform| Dither {
        direction: Direction::Tangential,
        waveform,
        amplitude: 300.0,
        frequency_ratio: 3000.0,
        phase: 0.3,
        envelope: None,
    };
    let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("a law");
    let of =
        |waveform| Belt::new(0.05, 1.0, 0.1, law.clone(), vec![dither(waveform)]).expect("a belt");
    let belt = of(Waveform::Samples(samples.into()));
    let measured =
        |v: f64| steady_effective_friction(&belt, v, 1e-12).expect("a response").coefficient;
    let averaged = |v: f64| {
        let motion = FastMotion::of(&belt, v, Averaging::Limit).expect("a motion");
        effective(belt.friction(), &motion, v).expect("an average").coefficient
    };
    let (forwards, backwards) = (averaged(0.03), averaged(-0.03));
    assert!((forwards + backwards).abs() > 0.015, "{forwards} {backwards}");
    for v in [0.03, -0.03, 0.2, -0.2] {
        assert!((measured(v) - averaged(v)).abs() < 4e-3, "{v}: {} {}", measured(v), averaged(v));
    }
    let burst = of(Burst::new(Waveform::Sine, 2, 1).expect("a burst").into_waveform());
    assert_eq!(steady_effective_friction(&burst, -0.2, 1e-12), Err(NoSteadyFriction::NoMirror));
}
