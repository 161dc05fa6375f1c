//! The least dither of a disc over a range of speeds: against dense searches by exact exponents, in limits, and where none exists.

use quell_design::least_dither::{
    DesignObjective, DesignProblem, DesignStart, Designed, DiscPlant, NoDesign, OperatingPoint,
    Plant, covered, design,
};
use quell_design::tasks::InTurn;
use quell_disc::dithered;
use quell_disc::plate::{ModeSet, Plate as DiscPlate, Reference};
use quell_model::disc::{DiscDither, Load};
use quell_model::{Disc, Waveform};
use quell_numerics::floquet::Effort;
use quell_numerics::interval::RealInterval;

fn disc(friction: f64, dither: DiscDither, waveform: &Waveform) -> Disc {
    let plate = DiscPlate::new(0.5, 0.3).expect("valid");
    let set = ModeSet::new(&plate, 1, 2, Reference::Critical).expect("found");
    let modes = set.at_radius(0.75, 1e-3).expect("on the plate");
    let load = Load::new(0.1, 0.1, 0.1, friction);
    let disc = Disc::new(modes, vec![load], dither, 0.4).expect("valid");
    disc.shaped(waveform.clone()).expect("valid")
}

fn growth(disc: &Disc) -> f64 {
    dithered::growth(disc, Effort::default()).expect("finite").rate
}

/// The disc of a speed, an amplitude and, among the other variables, a frequency ratio.
fn at(disc: &Disc, speed: f64, amplitude: f64, ratio: Option<f64>) -> Disc {
    let mut next = disc.at_speed(speed).expect("in bounds");
    if let Some(ratio) = ratio {
        next = next.with_frequency_ratio(ratio).expect("in bounds");
    }
    next.with_amplitude(amplitude).expect("in bounds")
}

fn designed(
    disc: &Disc,
    speeds: RealInterval,
    amplitudes: RealInterval,
    ratios: &[RealInterval],
) -> Designed {
    let place = |point: OperatingPoint<'_>, amplitude: f64| {
        Ok(at(disc, point.point[0], amplitude, point.others.first().copied()))
    };
    let plant = DiscPlant { at: &place, speed: Some(0) };
    design(problem(&plant, &[speeds], amplitudes, ratios))
}

fn problem<'a>(
    plant: &'a DiscPlant<'_>,
    speeds: &'a [RealInterval; 1],
    amplitude: RealInterval,
    ratios: &'a [RealInterval],
) -> DesignProblem<'a> {
    DesignProblem {
        plant,
        objective: DesignObjective::Amplitude,
        amplitude,
        others: ratios,
        over: speeds,
        limits: &[],
        actuator: None,
        start: DesignStart::Local,
        tasks: &InTurn,
    }
}

/// The largest growth rate over many speeds.
fn loudest(
    disc: &Disc,
    RealInterval { lower: from, upper: to }: RealInterval,
    amplitude: f64,
    ratio: Option<f64>,
) -> f64 {
    let steps = 800;
    (0..=steps)
        .map(|k| from + (to - from) * f64::from(k) / f64::from(steps))
        .map(|speed| growth(&at(disc, speed, amplitude, ratio)))
        .fold(f64::MIN, f64::max)
}

/// A friction just above the threshold of a backward wave. Normal dither at a frequency at which this wave meets a forward one makes
/// them share their damping.
#[test]
fn normal_dither_quenches_a_wave_where_it_shares_damping() {
    for waveform in [Waveform::Sine, Waveform::Square] {
        let normal = DiscDither::Normal { amplitude: 1.0, frequency_ratio: 2.7 };
        let disc = disc(0.15, normal, &waveform);
        let speeds = RealInterval::new(0.695, 0.705);
        assert!(loudest(&disc, speeds, 0.0, None) > 0.0, "it squeals without dither");
        let found = designed(&disc, speeds, RealInterval::new(0.0, 1.0), &[]);
        let answer = found.answer.expect("a least dither");
        let least = answer.critical.amplitude;
        assert!(least > 0.0 && least < 1.0, "{least}");
        let loud = loudest(&disc, speeds, least * 0.99, None);
        assert!(loud > 0.0, "{waveform:?} {least} {loud}");
        let quiet = loudest(&disc, speeds, answer.verified_amplitude, None);
        assert!(quiet <= 1e-10, "{waveform:?} {least} {quiet}");
        let worst = answer.critical.worst.expect("a speed");
        let marginal = growth(&at(&disc, worst[0], least, None));
        assert!(marginal.abs() < 1e-9, "{marginal}");
        assert!(
            answer.verified.iter().all(|point| point.growth_rate.is_some_and(|rate| rate < 1e-10))
        );
    }
}

/// Tangential dither is quiet at the smallest amplitude; its frequency must be clear of every tongue.
#[test]
fn a_clear_frequency_is_chosen_for_tangential_dither() {
    let tangential = DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 2.7 };
    let disc = disc(0.25, tangential, &Waveform::Sine);
    let speeds = RealInterval::new(0.25, 0.9);
    assert!(loudest(&disc, speeds, 1.0, Some(2.7)) > 0.0, "tongues at R = 2.7");
    let found =
        designed(&disc, speeds, RealInterval::new(1.0, 1.0), &[RealInterval::new(2.0, 6.0)]);
    let answer = found.answer.expect("a clear frequency");
    let ratio = answer.critical.others[0];
    assert!(loudest(&disc, speeds, 1.0, Some(ratio)) < 0.0, "{ratio}");
    assert_eq!(answer.critical.amplitude, 1.0);
    assert_eq!(answer.friction_loss.expect("known").0, 1.0);
}

/// A tongue far narrower than any step of the grid over the speeds makes a dither loud, and is found.
#[test]
fn a_narrow_tongue_is_not_missed() {
    let plate = DiscPlate::new(0.5, 0.3).expect("valid");
    let set = ModeSet::new(&plate, 1, 2, Reference::Critical).expect("found");
    let modes = set.at_radius(0.75, 1e-5).expect("on the plate");
    let load = Load::new(2e-3, 1e-4, 2e-3, 1.2e-3);
    let tangential = DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 2.7 };
    let disc = Disc::new(modes, vec![load], tangential, 0.4).expect("valid");
    let speeds = RealInterval::new(0.3, 0.6);
    let place =
        |point: OperatingPoint<'_>, amplitude: f64| Ok(at(&disc, point.point[0], amplitude, None));
    let plant = DiscPlant { at: &place, speed: Some(0) };
    let loud = plant.loud_points(&[speeds], &[], 1.0).expect("known");
    assert!(!loud.is_empty());
    for point in &loud {
        assert!(growth(&at(&disc, point[0], 1.0, None)) > 0.0);
        // A grid of 33 points has none in it.
        let step = speeds.width() / 32.0;
        let nearest = ((point[0] - speeds.lower) / step).round().mul_add(step, speeds.lower);
        assert!(growth(&at(&disc, nearest, 1.0, None)) < 0.0);
    }
    let found = designed(&disc, speeds, RealInterval::new(1.0, 1.0), &[]);
    let none = found.answer.expect_err("the tongue is loud");
    assert!(matches!(none.why, NoDesign::NeverQuiet { .. }), "{:?}", none.why);
    let part = covered(problem(&plant, &[speeds], RealInterval::new(1.0, 1.0), &[]), &none)
        .expect("a part");
    let RealInterval { lower: from, upper: to } = part.ends;
    assert!(loudest(&disc, RealInterval::new(from, to), 1.0, None) <= 1e-10 && to - from > 0.05);
}

/// Where nothing squeals the smallest amplitude is the answer, and where a whole range squeals no dither is.
#[test]
fn limits() {
    let normal = DiscDither::Normal { amplitude: 0.0, frequency_ratio: 2.7 };
    let quiet = designed(
        &disc(0.01, normal, &Waveform::Sine),
        RealInterval::new(0.5, 0.6),
        RealInterval::new(0.0, 1.0),
        &[],
    );
    let answer = quiet.answer.expect("no dither at all");
    assert_eq!((answer.critical.amplitude, &answer.critical.worst), (0.0, &None));
    let loud = designed(
        &disc(2.0, normal, &Waveform::Sine),
        RealInterval::new(0.3, 0.4),
        RealInterval::new(0.0, 1.0),
        &[],
    );
    assert!(loud.answer.is_err());
}
