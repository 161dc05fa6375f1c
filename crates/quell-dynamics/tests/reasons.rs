//! Every reason for a missing answer is stated in words, with its numbers.
//!
//! Each reason comes from the engine itself, from a belt that provokes it. Built by hand are only those that no belt is known
//! to provoke within a second.

use quell_dynamics::attractor::{AttractorSettings, NoEnd, Patience, Unsettled, settle};
use quell_dynamics::orbit::{
    BranchEnding, CycleMapError, NoImage, NoOrbit, NoSqueal, Open, OpenLine, Orbit, ThresholdPlane,
    base_response, branch_thresholds, cycles, free_end, squealing_state, threshold_curves,
};
use quell_dynamics::simulation::{Start, simulate, within};
use quell_linear::averaging::{Averaging, AveragingError, NoBand, closed_band, criterion};
use quell_model::{Belt, Waveform};
use quell_numerics::interval::RealInterval;
use quell_numerics::quadrature::{QuadratureError, QuadratureOptions, integrate};
use quell_zoo::belt::{
    self, decreasing_under, over_amplitude_and_velocity, over_amplitudes, stribeck_under,
    undithered_belt,
};
use quell_zoo::dither::{normal, sine};
use quell_zoo::{BeltExt, law};

use crate::belt_orbits::orbit_near;

#[track_caller]
fn assert_states(reason: &dyn std::error::Error, parts: &[&str]) {
    let text = reason.to_string();
    for part in parts {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!text.contains("NaN") && !text.ends_with('.'), "{text}");
}

fn at(displacement: f64, velocity: f64) -> Start {
    Start { time: 0.0, displacement, velocity }
}

fn no_orbit(found: Result<Orbit, NoOrbit>) -> NoOrbit {
    found.expect_err("no orbit")
}

fn no_base_response(belt: &Belt) -> NoOrbit {
    no_orbit(base_response(&belt.system(), 8))
}

/// At the natural frequency the base response folds at D = 0.0016.
fn folding(amplitude: f64) -> Belt {
    belt::decreasing().with_dither(sine(amplitude, 1.0))
}

/// Free oscillations of every size: constant friction and no damping.
fn continuum() -> Belt {
    undithered_belt(0.0, 0.9767, law::coulomb(0.3, 0.3))
}

/// A base response that begins steeply where the mass begins to stick, at D = 2.99321, because μ(0⁺) < μ_s: it is known a ten-thousandth
/// further on, and lost between.
fn lost() -> Belt {
    let dithers = vec![sine(2.9933, 10.0), normal(Waveform::Square, 0.4, 5.0)];
    undithered_belt(0.25, 0.3, law::jumping_formula()).with_dithers(dithers)
}

#[test]
fn dithers_without_a_common_period() {
    let none = no_base_response(&belt::stribeck());
    assert_eq!(none, NoOrbit::NoDither);
    assert_states(&none, &["without dither"]);
    let dithers = vec![sine(0.1, 10.0), sine(0.1, 10.0 * 2f64.sqrt())];
    let why = no_base_response(&belt::stribeck().with_dithers(dithers));
    assert_eq!(why, NoOrbit::NoImage(NoImage::NoPeriod));
    assert_states(&why, &["no common period"]);
}

#[test]
fn shooting_that_does_not_close() {
    let belt = stribeck_under(Waveform::Sine, 0.25);
    let why = no_orbit(orbit_near(&belt, at(-2.0, 0.0), 3));
    let NoOrbit::NotConverged { steps, residual } = why else { panic!("{why:?}") };
    assert_states(&why, &[&steps.to_string(), &format!("{residual:.1e}")]);
    let why = no_orbit(orbit_near(&belt, at(-1.0, 0.5), 1));
    let NoOrbit::Degenerate { residual, .. } = why else { panic!("{why:?}") };
    assert_states(&why, &[&format!("{residual:.1e}"), "a multiplier is 1"]);
}

#[test]
fn base_responses_that_end_or_are_lost() {
    let why = no_base_response(&folding(2e-3));
    assert!(matches!(why, NoOrbit::Ends { .. }) && why.is_absence(), "{why:?}");
    assert_states(&why, &["78.6", "of the dither", "ends at"]);
    let why = no_base_response(&lost());
    assert!(matches!(why, NoOrbit::Lost { .. }) && !why.is_absence(), "{why:?}");
    assert_states(&why, &["99.99", "of the dither", "could not be followed"]);
}

#[test]
fn runs_that_end_on_no_orbit() {
    let why = free_end(&continuum(), Start::REST).expect_err("a continuum");
    assert_eq!(why, CycleMapError::NoLimit);
    assert_states(&why, &["neither to a known limit cycle"]);
}

#[test]
fn runs_that_have_not_settled() {
    let unsettled = |belt: &Belt, start: Start, patience: Patience| {
        let settings = AttractorSettings::new(belt).expect("commensurate");
        let settled = settle(&settings, start, patience).expect("no stall");
        settled.why().expect("not settled")
    };
    let belt = decreasing_under(Waveform::Sine, 4.3);
    let moving = unsettled(&belt, at(1.5, 0.0), Patience { periods: 20, ..Patience::SWEEP });
    assert_eq!(moving, Unsettled::Moving);
    assert_states(&NoEnd::Unsettled(moving), &["still moved"]);
    // On the unstable cycle between sliding and squeal.
    let belt = belt::decreasing();
    let between = cycles(&belt).expect("no stall")[1].state.clone();
    let between = Start::of_state(&between);
    let dwelling = unsettled(&belt, between, Patience::SWEEP);
    assert_eq!(dwelling, Unsettled::Dwelling);
    assert_states(&NoEnd::Unsettled(dwelling), &["unstable curve"]);
}

#[test]
fn runs_that_stall() {
    let belt = decreasing_under(Waveform::Sine, 2.0);
    let stalled = within(0, || simulate(&belt, Start::REST, 1.0, 1e-12, &mut ()));
    let stalled = stalled.expect_err("no steps are left");
    assert_states(&stalled, &[stalled.why, "used up"]);
    let why = no_orbit(within(0, || orbit_near(&belt, Start::REST, 1)));
    assert!(matches!(why, NoOrbit::NoImage(NoImage::Stopped(_))), "{why:?}");
    assert_states(&why, &[stalled.why]);
}

#[test]
fn squealing_starts_that_do_not_exist() {
    let at_speed = |belt_velocity: f64| {
        let belt = belt::stribeck().at_speed(belt_velocity);
        squealing_state(&belt.system()).expect_err("nothing squeals").to_string()
    };
    for (velocity, why) in [(0.0, "no stable limit cycle"), (0.3, "no stable limit cycle")] {
        assert!(at_speed(velocity).contains(why), "{velocity}: {}", at_speed(velocity));
    }
    let stalled = within(0, || squealing_state(&belt::stribeck().system()));
    assert!(matches!(stalled, Err(NoSqueal::NotFound(_))), "{stalled:?}");
}

#[test]
fn thresholds() {
    let belt = folding(1e-4);
    let over = over_amplitudes(&belt);
    let from = |from: f64| branch_thresholds(&over, from, 3e-3, 20, None).expect_err("nothing");
    let why = from(-1.5);
    assert!(matches!(why, NoOrbit::NoImage(NoImage::Invalid(_))), "{why:?}");
    assert_states(&why, &["-1.5"]);
    let why = from(2e-3);
    assert!(matches!(why, NoOrbit::Ends { .. }), "{why:?}");
    assert_states(&why, &["78.6", "ends at"]);
    let why = branch_thresholds(&over, -3.0, 1.0, 5, Some((&[0.0, 0.0], 1)));
    assert_states(&why.expect_err("a negative amplitude"), &["-3"]);
    let found = branch_thresholds(&over_amplitudes(&lost()), 2.5, 2.9933, 8, None);
    let ending = found.expect("a first response").ending;
    let BranchEnding::Lost { at } = ending else { panic!("{ending:?}") };
    assert!((at - 2.99321).abs() < 1e-4, "{at}");
}

#[test]
fn curves_of_thresholds() {
    let line = |belt: &Belt, window, between| -> OpenLine {
        let at = over_amplitude_and_velocity(belt);
        let plane = ThresholdPlane { at: &at, window, between, points: 5 };
        threshold_curves(&plane, 2).expect("one line is followed").open[0].clone()
    };
    let why = line(
        &decreasing_under(Waveform::Sine, 1.0),
        RealInterval::new(0.1, 3.0),
        RealInterval::new(-1.0, 1.0),
    );
    assert_states(&why, &["at -0.5", "belt_velocity"]);
    let why = line(&folding(1e-4), RealInterval::new(2e-3, 3e-3), RealInterval::new(0.9, 1.1));
    let Open::Begin(NoOrbit::Ends { .. }) = why.why else { panic!("{why}") };
    assert_states(&why, &["at 0.95", "ends at 52.9"]);
    // No plane is known in which these are met at once.
    let line = |why: Open| OpenLine { along: 2.5, why };
    assert_states(&line(Open::Lost { at: 0.375 }), &["at 2.5", "lost beyond 0.375"]);
    assert_states(&line(Open::NotFollowed { value: 0.375 }), &["at 2.5", "threshold at 0.375"]);
}

#[test]
fn averages() {
    let options = Averaging::Limit;
    let constant = law::coulomb(0.3, 0.3);
    let why = closed_band(&constant, 0.1, 1.0, &Waveform::Sine, 0.1).expect_err("no band");
    assert_eq!(why, NoBand::Stable);
    assert_states(&why, &["stable"]);
    let still = belt::stribeck().at_speed(0.0);
    let still = still.with_law_number("friction.static_coefficient", 0.375);
    let why = criterion(&still, options).expect_err("at rest");
    assert_eq!(why, AveragingError::SetValued { static_coefficient: 0.375 });
    assert_states(&why, &["0.375"]);
    let dithers = [1.0, 2f64.sqrt(), 3f64.sqrt(), 5f64.sqrt(), 7f64.sqrt()];
    let dithers = dithers.map(|factor| sine(0.1, 10.0 * factor)).to_vec();
    let why = criterion(&belt::stribeck().with_dithers(dithers), options).expect_err("too many");
    assert_eq!(why, AveragingError::TooManyGroups { groups: 5, largest: 3 });
    assert_states(&why, &["5", "3"]);
    let slow = belt::stribeck().with_dither(sine(0.1, 0.75));
    let oscillator = Averaging::FiniteR;
    let why = criterion(&slow, oscillator).expect_err("below resonance");
    assert_eq!(why, AveragingError::NotFast { frequency_ratio: 0.75 });
    assert_states(&why, &["0.75"]);
    assert_states(&NoBand::Failed(why), &["0.75"]);
}

#[test]
fn quadratures() {
    let options = QuadratureOptions::default();
    let integral = |of: fn(f64) -> f64, to: f64| integrate(of, 0.0, to, &[], &options);
    let why = integral(|x| x, f64::INFINITY).expect_err("no end");
    assert_eq!(why, QuadratureError::NotFinite { limit: f64::INFINITY });
    assert_states(&why, &["inf", "not finite"]);
    let why = integral(|x| (x - 0.375).ln(), 1.0).expect_err("negative below 0.375");
    let QuadratureError::IntegrandNotFinite { at } = why else { panic!("{why:?}") };
    assert!((0.0..0.375).contains(&at), "{at}");
    assert_states(&why, &[&at.to_string()]);
    // Cancellation: ∫|f| is 10¹⁴ times ∫f.
    let why = integral(|x| 1e14 * (x - 0.5) + 1.0, 1.0).expect_err("no digits");
    let QuadratureError::Rounding { best } = why else { panic!("{why:?}") };
    assert_states(&why, &[&format!("{:e}", best.error), &format!("{:e}", best.value)]);
    let why = integral(|x| (1e7 * x).sin() + 2.0, 1.0).expect_err("too many waves");
    let QuadratureError::Evaluations { best } = why else { panic!("{why:?}") };
    let numbers = [best.evaluations.to_string(), format!("{:e}", best.error)];
    assert_states(&why, &numbers.each_ref().map(String::as_str));
    assert_states(&AveragingError::Quadrature(why), &numbers.each_ref().map(String::as_str));
}
