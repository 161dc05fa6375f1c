//! Every reason for not having an answer says it in words, with its numbers.

use quell_dynamics::orbit::curve::{Open, OpenLine};
use quell_dynamics::orbit::threshold::NoThresholds;
use quell_dynamics::orbit::{NoOrbit, Unsettled};
use quell_dynamics::simulation::{Stalled, Start};
use quell_dynamics::start::NoSquealingStart;
use quell_linear::averaging::{AveragingError, NoBand};
use quell_numerics::quadrature::{Integral, QuadratureError};

fn told(reason: &dyn std::error::Error, parts: &[&str]) {
    let text = reason.to_string();
    for part in parts {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!text.contains("NaN") && !text.ends_with('.'), "{text}");
}

#[test]
fn orbits() {
    let at = Start { time: 0.0, displacement: 0.25, velocity: -0.5 };
    told(&NoOrbit::NoDither, &["without dither"]);
    told(&NoOrbit::Incommensurate, &["no common period"]);
    let (steps, residual) = (17, 3.5e-4);
    let place = ["17", "0.25", "-0.5", "3.5e-4"];
    told(&NoOrbit::NotConverged { steps, residual, at }, &place);
    told(
        &NoOrbit::Degenerate { steps, residual, at },
        &[&place[..], &["a multiplier is 1"]].concat(),
    );
    told(&NoOrbit::Another { distance: 0.125, at }, &["0.25", "-0.5", "1.2e-1", "another one"]);
    told(&NoOrbit::Ends { share: 0.75 }, &["0.75 of the dither", "none beyond"]);
    told(&NoOrbit::LostOnTheWay { share: 0.75 }, &["0.75 of the dither", "could not be followed"]);
    told(&NoOrbit::NoPeriod { most: 200 }, &["200 periods"]);
    told(&NoOrbit::AtRest, &["comes to rest"]);
    told(&NoOrbit::Unsettled(Unsettled::Moving), &["has not settled", "still moved"]);
    told(&NoOrbit::NoLimit, &["neither to a known limit cycle"]);
    told(&NoOrbit::Invalid { value: -3.0 }, &["-3"]);
    let stalled = Stalled { time: 12.5, why: "it stood still" };
    told(&NoOrbit::Stalled(stalled), &[stalled.why]);
    told(&NoSquealingStart::Stalled(stalled), &[stalled.why]);
    told(&NoSquealingStart::BeltAtRest, &["v₀ = 0"]);
    told(&NoSquealingStart::SettlesToSliding, &["no limit cycle"]);
}

#[test]
fn thresholds_and_curves() {
    told(&NoThresholds::Invalid { value: -1.5 }, &["-1.5"]);
    told(&NoThresholds::Start(NoOrbit::NoDither), &["without dither"]);
    told(&NoThresholds::Lost { at: 0.375 }, &["lost beyond 0.375"]);
    let line = |why: Open| OpenLine { along: 2.5, why };
    told(&line(Open::Invalid), &["at 2.5", "cannot take this value"]);
    told(&line(Open::Begin(NoThresholds::Lost { at: 0.375 })), &["at 2.5", "0.375"]);
    told(&line(Open::Lost { at: 0.375 }), &["at 2.5", "lost beyond 0.375"]);
    told(&line(Open::NotFollowed { value: 0.375 }), &["at 2.5", "threshold at 0.375"]);
}

#[test]
fn averages() {
    told(&NoBand::Stable, &["stable"]);
    told(&AveragingError::SetValued { static_coefficient: 0.375 }, &["0.375"]);
    told(&AveragingError::TooManyGroups { groups: 5, largest: 3 }, &["5", "3"]);
    let slow = AveragingError::NotFast { frequency_ratio: 0.75 };
    told(&slow, &["0.75"]);
    told(&NoBand::Failed(slow), &["0.75"]);
    let best = Integral { value: 0.5, error: 1e-9, evaluations: 77 };
    told(&QuadratureError::NotFinite { limit: f64::INFINITY }, &["inf", "not finite"]);
    told(&QuadratureError::IntegrandNotFinite { at: 0.375 }, &["0.375"]);
    told(&QuadratureError::Rounding { best }, &["1e-9", "5e-1"]);
    told(
        &AveragingError::Quadrature(QuadratureError::Evaluations { best }),
        &["77", "1e-9", "5e-1"],
    );
}
