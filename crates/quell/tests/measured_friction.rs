//! `friction --measured`: friction of steady responses next to averaged friction, and the warnings about the latter.

use quell::Study;
use quell::outcome::Outcome;
use quell::study::{BeltStudy, Change};
use quell::verbs::verbs;
use quell_model::digits::digits;
use serde_json::Value as Json;

const NORMAL: &str = include_str!("../../../studies/figure-4.5.toml");

fn study(changes: &[&str]) -> BeltStudy {
    let changes: Vec<Change> =
        changes.iter().map(|text| Change::parse(text, "--set").expect("a change")).collect();
    BeltStudy::parse(NORMAL, &changes).expect("a study")
}

fn warnings(json: &Json) -> Vec<&str> {
    json["warnings"].as_array().expect("a list").iter().filter_map(Json::as_str).collect()
}

/// The friction of a belt's contact at slip velocities, as JSON with the warnings of the answer.
fn friction(study: &BeltStudy, at: &[f64], measured: bool) -> Json {
    let answer = verbs(&Study::from(study)).friction(Some(at), measured);
    answer.expect("friction").json()
}

#[test]
fn measured_friction_is_reported_next_to_the_average() {
    let study = study(&["dither.amplitude=0.9"]);
    let at = [-0.15, -0.02, 0.0, 0.02, 0.15];
    let answer = verbs(&Study::from(&study)).friction(Some(&at[..]), true).expect("friction");
    let whole = answer.json();
    let json = &whole["contacts"][0];
    let measured = json["measured_coefficient"].as_array().expect("a list");
    assert!(measured[2].is_null());
    let why = whole["why"]["contacts[0].measured_coefficient[2]"].as_str().expect("a reason");
    assert_eq!(why, "at zero slip velocity the surface does not move");
    let value = |index: usize| measured[index].as_f64().expect("a number");
    assert!((value(0) + value(4)).abs() < 1e-9 && (value(1) + value(3)).abs() < 1e-9);
    // Beyond the fast velocity averaging holds, to terms of the order α_N²; below it, it is far too low.
    let averaged = |index: usize| json["effective_coefficient"][index].as_f64().expect("a number");
    assert!((value(4) / averaged(4) - 1.0).abs() < 0.01);
    assert!(value(3) > 3.0 * averaged(3), "{} {}", value(3), averaged(3));
    assert_eq!(json["measured_verdict"][3], "stable");
    assert!(json["measured_stick_fraction"][3].as_f64() > Some(0.2));
    assert_eq!(json["measured_stick_fraction"][4], 0.0);
    let csv = |answer: &dyn Outcome| answer.datasets()[0].1.csv();
    let csv_measured = csv(answer.as_ref());
    assert!(
        csv_measured.contains("measured_coefficient")
            && csv_measured.contains("measured_stick_fraction"),
        "{csv_measured}"
    );
    let averaged = verbs(&Study::from(&study)).friction(Some(&at[..]), false).expect("friction");
    let csv = csv(averaged.as_ref());
    assert!(!csv.contains("measured_"), "{csv}");
}

#[test]
fn averaging_under_normal_dither_warns_below_its_fast_velocity() {
    let strong = study(&["dither.amplitude=0.9"]);
    // μ_s D/R = 0.4 · 0.9/5.
    let said = friction(&strong, &[0.02], false);
    assert!(warnings(&said)[0].starts_with("below |v_r| = 0.072, the fast velocity"), "{said}");
    for at in [0.073, -0.2, 0.0] {
        let quiet = friction(&strong, &[at], false);
        assert!(warnings(&quiet).is_empty(), "{quiet}");
    }
    let said = friction(&strong, &[0.02, 0.05, 0.1, 0.15], true);
    let first = |name: &str| said["contacts"][0][name][0].as_f64().expect("a number");
    let ratio = first("measured_coefficient") / first("effective_coefficient");
    let text = warnings(&said)[0];
    assert!(text.starts_with("at |v_r| = 0.02 the measured friction is "), "{text}");
    assert!(text.contains(&format!("{} times", digits(ratio, 3))), "{ratio} {text}");
    assert!(text.contains("above |v_r| = 0.05 agree within 10 %"), "{text}");
    // Below its fast velocity a contact sticks under tangential dither too, and the average is as far off.
    let tangential = study(&["dither.direction=tangential", "dither.amplitude=0.3"]);
    let averaged = friction(&tangential, &[0.02], false);
    assert!(warnings(&averaged).is_empty(), "{averaged}");
    let measured = friction(&tangential, &[0.02], true);
    let text = warnings(&measured)[0];
    assert!(text.starts_with("at |v_r| = 0.02 the measured friction is 3.94 times"), "{text}");
    // No other point was measured that could agree.
    assert!(!text.contains("agree"), "{text}");
}
