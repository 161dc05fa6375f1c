//! Answers where the outcome of starts is unknown.

use quell_dynamics::orbit::NoOrbit;

use super::*;
use crate::study::{Study, SystemStudy};

const STUDY: &str = "schema = 1\n[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.2]\nstiffness = [1.0]\n\
    [[contact]]\nname = \"belt\"\ntangent = { x = 1.0 }\nnormal_load = 1.0\nbelt_velocity = 1.0\n\
    [friction]\nlaw = \"decreasing\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.3\nreference_velocity = 0.2\n";

fn study() -> SystemStudy {
    Study::parse(STUDY, &[]).expect("valid").system()
}

/// If no outcome is known, nothing is stated about whether starts reach the base response.
#[test]
fn unknown_ends_reach_nothing() {
    let layout = StartLayout::Sample { count: 3, seed: 1 };
    let reasons = vec![("it moves".to_owned(), 3)];
    let portrait = Portrait {
        value: None,
        is_dithered: true,
        in_band: false,
        local: Ok("stable"),
        basins: Vec::new(),
        ends: vec![None; 3],
        quiet: None,
        unknown: Share::of(layout, &[true; 3]),
        reasons,
        largest_slip: vec![0.0],
    };
    let at = |value: Option<f64>| Portrait { value, ..portrait.clone() };
    let range =
        Range { parameter: "contact.belt.belt_velocity".into(), from: 1.0, to: 2.0, points: 2 };
    let found = |over: Option<Range>, portraits: Vec<Portrait>| Basins {
        names: ["x", "velocity.x"].map(str::to_owned),
        places: [0, 1],
        windows: [RealInterval::new(0.0, 1.0); 2],
        layout,
        starts: layout.places([RealInterval::new(0.0, 1.0); 2]),
        start: "from rest".to_owned(),
        over,
        portraits,
    };
    let study = study();
    assert_eq!(
        found(None, vec![at(None)]).sentence(&study),
        "The outcome of 3 starts is unknown. The base response is stable."
    );
    let unknown = Portrait { local: Err(NoOrbit::NoDither.into()), ..portrait.clone() };
    assert_eq!(
        found(None, vec![unknown]).sentence(&study),
        "The outcome of 3 starts is unknown. Without dither the response has no prescribed period."
    );
    let found = found(Some(range), vec![at(Some(1.0)), at(Some(2.0))]);
    let sentence = found.sentence(&study);
    assert!(sentence.ends_with(", the outcome of every start is unknown."), "{sentence}");
    let json = found.json(&study);
    for name in ["quiet_fraction", "quiet_fraction_low", "quiet_fraction_high"] {
        assert!(json["portraits"][0][name].is_null(), "{json}");
        assert!(json["why"][format!("portraits[0].{name}")].is_string(), "{json}");
    }
    assert!(!found.dataset(&study).csv().contains("NaN"));
}

/// Starts of unknown outcome count only towards the upper bound.
#[test]
fn unknown_ends_widen_the_share() {
    let layout = StartLayout::Sample { count: 4, seed: 1 };
    let surely = [true, false, false, false];
    let without = Share::of(layout, &surely);
    let with = Share::between(layout, &surely, &[false, true, true, false]);
    assert_eq!((with.starts, with.fraction, with.low), (1, without.fraction, without.low));
    assert_eq!(with.high, Share::of(layout, &[true, true, true, false]).high);
}
