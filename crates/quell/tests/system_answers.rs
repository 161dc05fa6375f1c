//! What answers about systems say where a verdict does not hold as stated, where numbers overflow, and where input is unlikely.

use std::sync::atomic::AtomicBool;

use quell::Study;
use quell::outcome::Outcome;
use quell::run::system::tracked::TrackRequest;
use quell::running::Running;
use quell::sweep::{MapQuantity, Plan};
use quell::verbs::verbs;
use quell_linear::averaging::AveragingError;
use quell_linear::linearised::NoSteadySliding;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}"))
}

fn tracked(text: &str, parameter: &str, window: RealInterval) -> Json {
    let request = TrackRequest { parameter: parameter.to_owned(), window, along: None };
    verbs(&study(text)).tracked_stability(&request).expect("an answer").json()
}

fn warnings(found: &Json) -> String {
    found["warnings"].to_string()
}

fn sentence(found: &Json) -> &str {
    found["sentence"].as_str().expect("a sentence")
}

/// One pad on two springs, and dither in the direction of its normal.
fn pad(mass: &str, damping: &str, dither: f64, frequency: f64) -> String {
    format!(
        "[system]\ncoordinates = [\"x\", \"y\"]\nmass = {mass}\ndamping = {damping}\nstiffness = [[1, 0], [0, 1]]\n\
         [[contact]]\nname = \"pad\"\ntangent = {{ x = 1 }}\nnormal = {{ y = 1 }}\nnormal_load = 1\nnormal_stiffness = 1\n\
         belt_velocity = 1\n[contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n\
         [[dither]]\nat = {{ y = 1 }}\nwaveform = \"sine\"\namplitude = {dither}\nfrequency = {frequency}\n"
    )
}

const LIGHT: &str = "[0.1, 0.1]";

/// A fast load of 10·30/(30² − 2) is above the load of 1.
#[test]
fn a_verdict_about_an_opened_contact_is_conditional() {
    let open = pad("[1, 1]", LIGHT, 1000.0, 20.0);
    let found = verbs(&study(&open)).stability().expect("an answer").json();
    assert_eq!(found["verdict"], "stable");
    assert!(sentence(&found).contains("would be stable if contact pad stayed closed"), "{found}");
    assert!(warnings(&found).contains("contact pad opens"), "{found}");

    let closed = pad("[1, 1]", LIGHT, 1.0, 20.0);
    let found = verbs(&study(&closed)).stability().expect("an answer").json();
    assert!(sentence(&found).contains("steady sliding is stable: "), "{found}");

    let found = tracked(&closed, "dither.amplitude", RealInterval::new(1.0, 1000.0));
    assert!(sentence(&found).contains("holds only where contact pad stays closed"), "{found}");
    assert!(
        warnings(&found).contains("contact pad opens for the dither amplitude from "),
        "{found}"
    );
    let found = tracked(&closed, "dither.amplitude", RealInterval::new(1.0, 2.0));
    assert_eq!(warnings(&found), "[]");
}

fn map(text: &str, quantity: &str) -> Json {
    let study = study(text);
    let asked = MapQuantity::named(quantity, "--quantity").expect("a quantity");
    let plan = Plan::new(&study, &[asked]).expect("a plan");
    let never = AtomicBool::new(false);
    let running = Running { threads: Some(1), stop: &never, progress: &() };
    quell::map::run(plan, None, running).expect("a map").json()
}

#[test]
fn maps_mark_opened_contacts_and_ranges_of_laws() {
    let axis = "[[sweep]]\nparameter = \"dither.amplitude\"\nvalues = [1, 1000]\n";
    let found = map(&(pad("[1, 1]", LIGHT, 1.0, 20.0) + axis), "verdict");
    assert_eq!(found["verdict_status"], serde_json::json!(["known", "opens"]));
    assert_eq!(found["verdict"][1], "stable");
    assert!(warnings(&found).contains("1 of 2 points"), "{found}");

    let law = "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.3\nreference_velocity = 1\n";
    let text =
        pad("[1, 1]", LIGHT, 1.0, 20.0).replace("law = \"coulomb\"\ncoefficient = 0.3\n", law);
    let axis = "[[sweep]]\nparameter = \"contact.pad.belt_velocity\"\nvalues = [1, 5]\n";
    let found = map(&(text.clone() + axis), "growth-undithered");
    let wanted = serde_json::json!(["known", "beyond_range"]);
    assert_eq!(found["growth_undithered_status"], wanted, "{found}");
    let found = tracked(&text, "contact.pad.belt_velocity", RealInterval::new(1.0, 5.0));
    assert!(warnings(&found).contains("leaves the range of its friction law, 1.732 "), "{found}");
}

/// The fast real root of an overdamped motion is as fast as the dither, though it does not oscillate.
#[test]
fn fast_motions_without_oscillation_are_warned_of() {
    let found = verbs(&study(&pad("[1, 1]", "[20, 0.1]", 0.1, 20.0))).stability();
    let found = found.expect("an answer").json();
    assert!(
        warnings(&found).contains("a motion without oscillation has the rate |λ| = 19.9"),
        "{found}"
    );
}

#[test]
fn an_undamped_resonance_is_unbounded() {
    let found =
        verbs(&study(&pad("[1, 1]", "[0, 0]", 0.1, 20.0))).reach(Some(RealInterval::new(0.5, 5.0)));
    let found = found.expect("an answer");
    let json = found.json();
    let extremes = &json["responses"][0]["extremes"];
    let peaks = extremes.as_array().expect("a list").iter().enumerate();
    let (index, peak) = peaks.clone().find(|(_, at)| at["kind"] == "peak").expect("a peak");
    assert!(peak["slip_per_amplitude"].is_null(), "{json}");
    let path = format!("responses[0].extremes[{index}].slip_per_amplitude");
    assert_eq!(json["why"][path.as_str()], "unbounded (undamped resonance)", "{json}");
    assert!(found.text().contains("unbounded (undamped resonance)"));
    // A little damping bounds it.
    let found = verbs(&study(&pad("[1, 1]", "[1e-9, 1e-9]", 0.1, 20.0)))
        .reach(Some(RealInterval::new(0.5, 5.0)));
    let json = found.expect("an answer").json();
    let extremes = json["responses"][0]["extremes"].as_array().expect("a list");
    assert!(extremes.iter().all(|at| at["slip_per_amplitude"].is_number()), "{json}");
}

#[test]
fn messages_have_short_numbers() {
    let why = AveragingError::Resonance { frequency: 2f64.sqrt() * 1e300 }.to_string();
    assert_eq!(why, "the dither of angular frequency 1.41421e300 excites an undamped resonance");
    let why = NoSteadySliding::Open { contact: "pad".to_owned(), normal_load: -1e-300 / 3.0 };
    assert!(why.to_string().ends_with("its normal load would be -3.33333e-301"), "{why}");
}

/// A value that the study does not allow is reported by its own key.
#[test]
fn ranges_without_an_answer_name_the_real_key() {
    let text = pad("[1, 1]", LIGHT, 0.1, 20.0);
    let found = tracked(&text, "contact.pad.normal_stiffness", RealInterval::new(-1.0, 1.0));
    let why = found["unknown"][0]["why"].as_str().expect("a reason");
    assert!(why.starts_with("contact.normal_stiffness = -1: must be"), "{why}");
}

/// The surface reverses inside the window, whether or not a value of the grid is there: table, sentence and JSON say so, and the
/// verdicts on both sides are those of windows that end before it.
#[test]
fn a_surface_that_comes_to_rest_is_a_point() {
    let dithered = pad("[1, 1]", LIGHT, 1.0, 20.0);
    let text = dithered.split("[[dither]]").next().expect("the study without dither");
    let law = "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.3\nreference_velocity = 1\n";
    let text = text.replace("law = \"coulomb\"\ncoefficient = 0.3\n", law);
    let path = "contact.pad.belt_velocity";
    for window in
        [RealInterval::new(-0.9, 1.1), RealInterval::new(-1.0, 1.0), RealInterval::new(-0.731, 1.2)]
    {
        let request = TrackRequest { parameter: path.to_owned(), window, along: None };
        let found = verbs(&study(&text)).tracked_stability(&request).expect("an answer");
        let json = found.json();
        let rest = &json["rests"][0];
        assert_eq!(rest["contact"], "pad", "{json}");
        assert!(rest["value"].as_f64().expect("a number").abs() < 1e-9, "{json}");
        assert_eq!(json["rests"].as_array().expect("a list").len(), 1);
        assert_eq!(json["unknown"].as_array().expect("a list").len(), 1, "{json}");
        let notes = found.notes().join(" ");
        assert!(notes.contains("contact pad comes to rest"), "{notes}");
        assert!(found.text().contains("rest         contact pad"), "{}", found.text());
        let values = |json: &Json| -> Vec<f64> {
            let found = json["thresholds"].as_array().expect("a list").iter();
            found.map(|found| found["value"].as_f64().expect("a number")).collect()
        };
        let sides = [RealInterval::new(window.lower, -1e-3), RealInterval::new(1e-3, window.upper)];
        let apart: Vec<f64> =
            sides.iter().flat_map(|side| values(&tracked(&text, path, *side))).collect();
        let whole = values(&json);
        assert!(!whole.is_empty() && whole.len() == apart.len(), "{whole:?} {apart:?}");
        for (a, b) in whole.iter().zip(&apart) {
            assert!((a - b).abs() < 1e-9, "{whole:?} {apart:?}");
        }
    }
    assert_eq!(tracked(&text, path, RealInterval::new(0.1, 1.0))["rests"], serde_json::json!([]));
}

#[test]
fn unlikely_input_is_warned_of() {
    let check = |text: &str| warnings(&verbs(&study(text)).check().expect("valid").json());
    let text = pad("[1, 1]", LIGHT, 0.1, 20.0);
    assert_eq!(check(&text), "[]");
    let used =
        text.replace("coefficient = 0.3", "coefficient = \"mu\"") + "[parameters]\nmu = 0.3\n";
    assert_eq!(check(&used), "[]");
    let unused = used.replace("[parameters]\n", "[parameters]\nnu = \"2*mu\"\n");
    assert!(check(&unused).contains("no formula uses parameters.nu: it has no effect"));
    let half = text.replace("stiffness = [[1, 0], [0, 1]]", "stiffness = [[1, 0.5], [0, 1]]");
    assert!(
        check(&half).contains("system.stiffness[0][1] is 0.5, but system.stiffness[1][0] is 0:")
    );
    assert!(!check(&half).contains("damping"));
    let gyroscopic = text.replace("damping = [0.1, 0.1]", "damping = [[0, 1], [-1, 0]]");
    assert_eq!(check(&gyroscopic), "[]");
}

#[test]
fn tables_and_maps_of_systems_name_their_units() {
    let text = pad("[1, 1]", LIGHT, 0.1, 20.0);
    let text_of = |found: &dyn Outcome| found.text();
    let modes = verbs(&study(&text)).modes().expect("modes");
    assert!(text_of(modes.as_ref()).contains("natural angular frequency "));
    let stability = verbs(&study(&text)).stability().expect("an answer");
    assert!(text_of(stability.as_ref()).contains("  angular frequency "));
    let axis = "[[sweep]]\nparameter = \"dither.amplitude\"\nvalues = [1, 2]\n";
    let si = text.replace("[system]\n", "[system]\nunits = \"SI\"\n");
    for (text, rate, force) in [(&text, "1 (per unit of time)", "1"), (&si, "1/s", "N")] {
        let found = map(&(text.clone() + axis), "growth");
        assert_eq!(found["units"]["growth"], rate);
        let found = map(&(text.clone() + axis), "critical-amplitude");
        assert_eq!(found["units"]["critical_amplitude"], force);
    }
}

/// Every null has a reason, below the name of its array.
#[test]
fn numbers_that_overflow_are_null_with_a_reason() {
    let text = pad("[1e-300, 1]", LIGHT, 0.1, 20.0);
    let study = study(&text);
    let verbs = verbs(&study);
    for found in [verbs.stability(), verbs.modes()] {
        let Ok(found) = found else { continue };
        let json = found.json();
        let mut nulls = Vec::new();
        paths(&json, "", &mut nulls);
        assert!(!nulls.is_empty(), "{json}");
        for path in nulls {
            let known = json["why"].as_object().is_some_and(|why| why.contains_key(&path));
            assert!(known, "{path} of {json}");
        }
    }
}

fn paths(value: &Json, path: &str, nulls: &mut Vec<String>) {
    let join =
        |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        Json::Null => nulls.push(path.to_owned()),
        Json::Object(object) => {
            for (name, value) in object {
                paths(value, &join(name), nulls);
            }
        }
        Json::Array(items) if items.iter().any(Json::is_object) => {
            for (index, item) in items.iter().enumerate() {
                paths(item, &format!("{path}[{index}]"), nulls);
            }
        }
        Json::Array(items) => {
            let before = nulls.len();
            for item in items {
                paths(item, path, nulls);
            }
            nulls.truncate(before + usize::from(nulls.len() > before));
        }
        _ => {}
    }
}
