//! Answers where the outcome of starts is unknown.

use quell_dynamics::attractor::{BasinsOfAttraction as Gathered, Unsettled};

use super::*;

const STUDY: &str = "schema = 1\n[belt]\ndamping_ratio = 0.1\nnormal_load = 1\nbelt_velocity = 1\n\
    [friction]\nlaw = \"decreasing\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.3\nreference_velocity = 0.2\n";

/// If no outcome is known, nothing is stated about whether starts reach the base response.
#[test]
fn unknown_ends_reach_nothing() {
    let labels = vec![BasinLabel::Unsettled(Unsettled::Moving); 3];
    let gathered = Gathered { basins: Vec::new(), labels };
    let share = Share::of(StartLayout::Sample { count: 3, seed: 1 }, &[true; 3]);
    let mut portrait = Portrait {
        value: None,
        period: 1.0,
        scales: None,
        in_band: false,
        local: Ok(OrbitVerdict::Stable),
        gathered,
        shares: Vec::new(),
        quiet: None,
        unknown: share,
    };
    assert_eq!(
        portrait.sentence(),
        "The outcome of 3 starts is unknown. The base response is stable."
    );
    let at = |value: f64| Portrait { value: Some(value), ..portrait.clone() };
    let range = Range { parameter: "belt.belt_velocity".into(), from: 1.0, to: 2.0, points: 2 };
    let study = BeltStudy::parse(STUDY, &[]).expect("valid");
    let varied = Varied::new(&study, "--over", &range).expect("valid");
    let starts = Starts::new(study.belt(), None, None, StartLayout::Sample { count: 3, seed: 1 });
    let found = Basins {
        starts: starts.expect("valid"),
        varied: Some(varied),
        portraits: vec![at(1.0), at(2.0)],
        slip: SlipMet::default(),
    };
    let sentence = found.sentence(&study);
    assert!(sentence.ends_with(", the outcome of every start is unknown."), "{sentence}");
    let json = found.json(&study);
    for name in ["quiet_fraction", "quiet_fraction_low", "quiet_fraction_high"] {
        assert!(json["portraits"][0][name].is_null(), "{json}");
        assert!(json["why"][format!("portraits[0].{name}")].is_string(), "{json}");
    }
    assert!(!found.dataset(&study).csv().contains("NaN"));
    portrait.local = Err("it was not found".to_owned());
    assert_eq!(portrait.sentence(), "The outcome of 3 starts is unknown. It was not found.");
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
