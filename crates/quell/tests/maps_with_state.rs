//! Maps, comparisons of waveforms and designs of contacts with a state of their own: the answers are those of the single verbs, and
//! averages, which do not know the state, say so.

use std::sync::atomic::AtomicBool;

use quell::Study;
use quell::run::found_attractor::AttractorRequest;
use quell::run::orbit::Wanted;
use quell::run::protocol::Protocol;
use quell::run::response::ResponseRequest;
use quell::run::thresholds::ThresholdsRequest;
use quell::running::Running;
use quell::sweep::{MapQuantity, Plan, QUANTITIES};
use quell::verbs::verbs;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{text}\n{errors}"))
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn warnings(found: &Json) -> String {
    found["warnings"].to_string()
}

fn map(text: &str, quantities: &[&str]) -> Json {
    let asked: Vec<_> = quantities
        .iter()
        .map(|name| MapQuantity::named(name, "--quantity").expect("a quantity"))
        .collect();
    let plan = Plan::new(study(text), &asked).expect("a plan");
    let never = AtomicBool::new(false);
    let running = Running { threads: Some(1), stop: &never, progress: &() };
    quell::map::run(plan, None, running).expect("a map").json()
}

/// The laws with a state, as the keys of a contact and its table of friction: an elastic slider and bristles.
const LAWS: [(&str, &str); 2] = [
    (
        "tangential_stiffness = 30.0\n",
        "law = \"stribeck-exponential\"\ncoefficient = 0.25\nstatic_coefficient = 0.4\nreference_velocity = 0.2\n",
    ),
    (
        "",
        "law = \"lugre\"\ncoefficient = 0.25\nstatic_coefficient = 0.4\nreference_velocity = 0.2\nbristle_stiffness = 60.0\n\
         bristle_damping = 0.1\n",
    ),
];

/// Amplitudes of the dither on the axis of the maps.
const AMPLITUDES: [f64; 2] = [0.6, 2.4];

fn axis(path: &str) -> String {
    format!("[[sweep]]\nparameter = \"{path}\"\nvalues = {AMPLITUDES:?}\n")
}

fn belt((contact, law): (&str, &str), amplitude: f64) -> String {
    format!(
        "schema = 1\n[belt]\ndamping_ratio = 0.01\nnormal_load = 1.0\nbelt_velocity = 0.1\n{contact}[friction]\n{law}\
         [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = {amplitude}\nfrequency_ratio = 10.0\n\
         [solver]\nsettle = 150\nrecord_periods = 12\n"
    )
}

fn system((contact, law): (&str, &str), amplitude: f64) -> String {
    format!(
        "schema = 1\n[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [[0.02]]\nstiffness = [[1.0]]\n\
         [[contact]]\nname = \"pad\"\ntangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n{contact}\
         [contact.friction]\n{law}[[dither]]\nat = {{ x = 1.0 }}\nwaveform = \"sine\"\namplitude = {amplitude}\nfrequency = 10.0\n"
    )
}

/// Compares a variable of a map at a point with the fact of a single verb, to the last bit.
fn assert_same(map: &Json, variable: &str, point: usize, fact: &Json) {
    let value = &map[variable][point];
    let status = &map[format!("{variable}_status").as_str()][point];
    if fact.is_null() || fact == "unknown" || fact == "undecided" {
        let unknown = status != "known" && status != "without_state";
        assert!(unknown, "{variable}[{point}]: {value} {status}, but the verb has {fact}");
    } else {
        assert_eq!(value, fact, "{variable}[{point}]: {status}");
    }
}

#[test]
fn points_of_systems_are_the_answers_of_the_verbs() {
    let quantities = [
        "growth",
        "verdict",
        "growth-undithered",
        "critical-amplitude",
        "orbit-verdict",
        "orbit-radius",
        "ends-on",
        "peak-to-peak",
        "stick-fraction",
        "effect",
        "residual-vibration",
        "amplitude",
        "undithered-amplitude",
    ];
    for law in LAWS {
        let found = map(&(system(law, 1.0) + &axis("dither.amplitude")), &quantities);
        for (point, amplitude) in AMPLITUDES.into_iter().enumerate() {
            let one = verbs(&study(&system(law, amplitude)));
            let stability = one.stability().expect("averages").json();
            assert_same(&found, "growth", point, &stability["growth_rate"]);
            assert_same(&found, "verdict", point, &stability["verdict"]);
            let dithered = system(law, amplitude);
            let still = verbs(&study(dithered.split("[[dither]]").next().expect("a part")));
            let still = still.stability().expect("small motions").json();
            assert_same(&found, "growth_undithered", point, &still["growth_rate"]);
            assert_eq!(found["growth_undithered_status"][point], "known");
            // The bristles always move with the dither, and the displacement of the dither is that of about one breakaway.
            assert_eq!(found["growth_status"][point], "without_state", "{found}");
            match one.orbit(&Wanted::Base { periods: 1 }) {
                // Where the base response does not exist, the verb has the motion that a run from rest reaches.
                Ok(orbit) if orbit.json()["no_base_response"].is_null() => {
                    assert_same(&found, "orbit_verdict", point, &orbit.json()["verdict"]);
                    assert_same(&found, "orbit_radius", point, &orbit.json()["radius"]);
                }
                _ => assert_eq!(found["orbit_radius_status"][point], "no_base_response"),
            }
            let end = one.attractor(&AttractorRequest::default()).expect("an end").json();
            let end = &end["attractor"];
            assert_same(&found, "ends_on", point, &end["kind"]);
            assert_same(&found, "peak_to_peak", point, &end["peak_to_peak"]);
            if law.0.is_empty() {
                assert_eq!(found["stick_fraction_status"][point], "never_sticks");
            } else {
                assert_same(&found, "stick_fraction", point, &end["contacts"][0]["stick_fraction"]);
            }
            let response = one.response(&ResponseRequest::default()).expect("a response").json();
            for fact in ["effect", "residual_vibration", "amplitude", "undithered_amplitude"] {
                assert_same(&found, fact, point, &response[fact]);
            }
        }
        assert!(warnings(&found).contains("without_state"), "{}", warnings(&found));
        // The effects differ, so that the points are no copies of each other.
        assert_ne!(found["amplitude"][0], found["amplitude"][1]);
    }
}

#[test]
fn points_of_belts_are_the_answers_of_the_verbs() {
    let of_response = [
        "effect",
        "residual-vibration",
        "amplitude",
        "undithered_amplitude",
        "stick_fraction",
        "mean_friction",
        "dither_power",
        "dither_stroke",
        "minimum_normal_load",
    ];
    let averaged = [
        "verdict",
        "criterion",
        "growth",
        "critical-amplitude",
        "limit-verdict",
        "limit-criterion",
        "limit-growth",
        "limit-critical-amplitude",
    ];
    let names: Vec<String> = of_response.iter().map(|name| name.replace('_', "-")).collect();
    let quantities: Vec<&str> = names.iter().map(String::as_str).chain(averaged).collect();
    for law in LAWS {
        let found = map(&(belt(law, 1.0) + &axis("dither.amplitude")), &quantities);
        for (point, amplitude) in AMPLITUDES.into_iter().enumerate() {
            let one = verbs(&study(&belt(law, amplitude)));
            let response = one.response(&ResponseRequest::default()).expect("a response").json();
            for fact in ["effect", "residual_vibration", "amplitude", "undithered_amplitude"] {
                assert_same(&found, fact, point, &response[fact]);
            }
            let (contact, dither) = (&response["contacts"][0], &response["dithers"][0]);
            let end = one.attractor(&AttractorRequest::default()).expect("an end").json();
            for (variable, fact) in [
                ("stick_fraction", &end["attractor"]["contacts"][0]["stick_fraction"]),
                ("mean_friction", &contact["mean_friction"]),
                ("minimum_normal_load", &contact["least_normal"]),
                ("dither_power", &dither["power"]),
                ("dither_stroke", &dither["stroke"]),
            ] {
                // Bristles never stick, of which a map has a status.
                if found[format!("{variable}_status").as_str()][point] != "never_sticks" {
                    assert_same(&found, variable, point, fact);
                }
            }
            let stability = one.stability().expect("averages").json();
            let limit = &stability["limit"];
            for (variable, fact) in [
                ("verdict", &stability["verdict"]),
                ("criterion", &stability["criterion"]),
                ("growth", &stability["growth_rate"]),
                ("critical_amplitude", &stability["critical_amplitudes"][0]["amplitude"]),
                ("limit_verdict", &limit["verdict"]),
                ("limit_criterion", &limit["criterion"]),
                ("limit_growth", &limit["growth_rate"]),
                ("limit_critical_amplitude", &limit["critical_amplitudes"][0]["amplitude_ratio"]),
            ] {
                assert_same(&found, variable, point, fact);
                let status = &found[format!("{variable}_status").as_str()][point];
                assert_eq!(status, "without_state", "{variable}: {found}");
            }
        }
        assert_eq!(found["stick_fraction_status"][0] == "never_sticks", law.0.is_empty());
        assert!(warnings(&found).contains("without_state"), "{}", warnings(&found));
    }
}

/// Every quantity of a belt is one of the same mass as a system, with the same numbers.
#[test]
fn a_belt_and_its_system_have_the_same_map() {
    let law = LAWS[0].1;
    let bare = (belt(("", law), 1.0), system(("", law), 1.0));
    // The record of a belt without `[solver]` is that of its system.
    let belt = bare.0.replace("[solver]\nsettle = 150\nrecord_periods = 12\n", "");
    let all: Vec<&str> = QUANTITIES.iter().copied().flatten().map(|one| one.name).collect();
    let [one, other] = [belt, bare.1].map(|text| map(&(text + &axis("dither.amplitude")), &all));
    assert_eq!(one["counts"], other["counts"]);
    // An axis is in the unit of its key.
    let object = one.as_object().expect("an object");
    for (name, value) in object.iter().filter(|(name, _)| *name != "axes") {
        let point = |found: &Json, at: usize| found[name][at].as_f64();
        for at in 0..AMPLITUDES.len() {
            match point(&one, at).zip(point(&other, at)) {
                Some((a, b)) => assert!((a - b).abs() <= 1e-9 * b.abs(), "{name}: {a} {b}"),
                None => assert_eq!(value, &other[name], "{name}"),
            }
        }
    }
}

/// A quantity whose needs a study does not meet is refused with those that it has.
#[test]
fn quantities_are_for_studies_that_meet_their_needs() {
    let two = system(LAWS[0], 1.0)
        .replace("coordinates = [\"x\"]", "coordinates = [\"x\", \"y\"]")
        .replace("mass = [1.0]", "mass = [1.0, 2.0]")
        .replace("[[0.02]]", "[[0.02, 0.0], [0.0, 0.02]]")
        .replace("[[1.0]]", "[[2.0, -1.0], [-1.0, 2.0]]");
    let refused = |text: &str, name: &str| {
        let quantity = MapQuantity::named(name, "--quantity").expect("a quantity");
        let axis = axis("dither.amplitude");
        Plan::new(study(&(text.to_owned() + &axis)), &[quantity]).expect_err("refused").allowed
    };
    let why = refused(&two, "limit-verdict");
    assert!(why.starts_with("for a study of one mass"), "{why}");
    assert!(why.contains("quench-amplitude") && !why.contains("limit-growth"), "{why}");
    let found = map(&(two + &axis("dither.amplitude")), &["mean-friction", "verdict"]);
    assert!(found["mean_friction"][0].is_number(), "{found}");
}

/// Without a dither that acts, averages are the small motions themselves, base responses do not exist, and effects are unknown.
#[test]
fn a_dither_of_amplitude_zero_is_none() {
    let text = belt(LAWS[1], 1.0) + "[[sweep]]\nparameter = \"dither.amplitude\"\nvalues = [0.0]\n";
    let found = map(&text, &["growth", "growth-undithered", "orbit-verdict", "effect"]);
    assert_eq!(found["growth"], found["growth_undithered"]);
    assert_eq!(found["growth_status"][0], "known");
    for name in ["orbit_verdict_status", "effect_status"] {
        assert_eq!(found[name][0], "no_dither", "{found}");
    }
}

/// Every kind of motion has its word, and every status is one that its variable declares.
#[test]
fn words_and_statuses_are_declared() {
    let stribeck = "[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n";
    let text = format!(
        "schema = 1\n[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.01]\nstiffness = [1.0]\n[[contact]]\nname = \"belt\"\n\
         tangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n{}[[dither]]\nat = {{ x = 1.0 }}\nwaveform = \"sine\"\n\
         amplitude = 0.9\nfrequency = 10.0\n[[sweep]]\nparameter = \"contact.belt.belt_velocity\"\nvalues = [-0.1, 0.1]\n",
        stribeck.replace("[friction]", "[contact.friction]")
    );
    let asked: Vec<_> = ["ends-on", "criterion", "limit-verdict"]
        .map(|name| MapQuantity::named(name, "--quantity").expect("a quantity"))
        .into();
    let plan = Plan::new(study(&text), &asked).expect("a plan");
    let declared = |name: &str| {
        let field = plan.sheet().fields().iter().find(|field| field.name == name);
        format!("{:?}", field.expect("a field").content)
    };
    let found = map(&text, &["ends-on", "criterion", "limit-verdict"]);
    assert_eq!(found["ends_on"][1], "quasi-periodic", "{found}");
    assert_eq!(found["criterion_status"][0], "not_one_mass", "{found}");
    assert!(declared("criterion_status").contains("not_one_mass"));
    assert!(declared("ends_on").contains("quasi-periodic"));
}

/// The criterion is that of `stability` where averaging in the limit does not apply, and a record that `response` refuses is refused.
#[test]
fn points_are_refused_where_the_verb_refuses() {
    let bare = belt(("", LAWS[0].1), 1.0);
    let over = |values: &str| {
        format!("{bare}[[sweep]]\nparameter = \"dither.frequency_ratio\"\nvalues = {values}\n")
    };
    let found = map(&over("[0.5]"), &["criterion"]);
    let slow = verbs(&study(&bare.replace("frequency_ratio = 10.0", "frequency_ratio = 0.5")));
    assert_eq!(found["criterion"][0], slow.stability().expect("averages").json()["criterion"]);
    let found = map(&over("[100000.0]"), &["effect", "mean-friction"]);
    for name in ["effect_status", "mean_friction_status"] {
        assert_eq!(found[name][0], "record_length", "{found}");
    }
}

/// A stiff slider adheres for so short a part of the dither that the average of the rigid law holds, and no point is marked.
#[test]
fn stiff_sliders_are_not_marked() {
    let stiff = ("tangential_stiffness = 3e4\n", LAWS[0].1);
    let found = map(&(belt(stiff, 1.0) + &axis("dither.amplitude")), &["growth"]);
    assert_eq!(found["growth_status"], serde_json::json!(["known", "known"]), "{found}");
    let found = map(&(system(stiff, 1.0) + &axis("dither.amplitude")), &["growth"]);
    assert_eq!(found["growth_status"], serde_json::json!(["known", "known"]), "{found}");
}

fn row<'a>(found: &'a Json, label: &str) -> &'a Json {
    let rows = found["waveforms"].as_array().expect("rows");
    rows.iter().find(|row| row["label"] == label).unwrap_or_else(|| panic!("no {label}: {found}"))
}

/// The averaged amplitudes are those of the rigid law; the exact ones are thresholds of the contact with its state, as a belt and as the
/// same mass as a system.
#[test]
fn waveforms_know_the_state_in_their_exact_amplitudes() {
    let (contact, law) = ("tangential_stiffness = 100.0\n", LAWS[0].1);
    let of = |contact: &str| {
        verbs(&study(&belt((contact, law), 1.0))).waveforms().expect("waveforms").json()
    };
    let (rigid, found) = (of(""), of(contact));
    let (own, bare) = (row(&found, "sine"), row(&rigid, "sine"));
    assert_eq!(own["amplitude"], bare["amplitude"]);
    assert_ne!(own["exact_amplitude"], bare["exact_amplitude"]);
    assert!(warnings(&found).contains("without the state of its contact"), "{found}");
    assert!(!warnings(&rigid).contains("without the state"), "{rigid}");
    assert_near_a_threshold((contact, law), number(&own["exact_amplitude"]));
}

/// An amplitude is a threshold of the same mass as a system, with the state of its contact.
fn assert_near_a_threshold(law: (&str, &str), amplitude: f64) {
    let request = ThresholdsRequest {
        parameter: "dither.amplitude".to_owned(),
        window: RealInterval::new(0.9 * amplitude, 1.1 * amplitude),
        near: None,
        protocols: Vec::<Protocol>::new(),
        ramp: 0.0,
    };
    let one = verbs(&study(&system(law, 1.0)));
    let thresholds = one.thresholds(&request).expect("thresholds").json();
    let list = thresholds["local"].as_array();
    let list = list.unwrap_or_else(|| panic!("{thresholds}"));
    let off = |one: &Json| (number(&one["value"]) / amplitude - 1.0).abs();
    let near = list.iter().map(off).fold(f64::INFINITY, f64::min);
    assert!(near < 1e-8, "{amplitude}: {thresholds}");
}

const DESIGN: &str = "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\"]\nfrom = [0.01]\nto = [20.0]\nwaveforms = [\"sine\"]\n";

/// The least dither of a belt with a slider is the threshold of its base response, verified with the state.
#[test]
fn designs_know_the_state() {
    let law = ("tangential_stiffness = 100.0\n", LAWS[0].1);
    let text = belt(law, 1.0) + DESIGN;
    let found = verbs(&study(&text)).design().expect("a design").json();
    assert_eq!(found["feasible"], true, "{found}");
    assert!(number(&found["verified"]["multiplier"]) < 1.0, "{found}");
    assert!(warnings(&found).contains("without the state of its contact"), "{found}");
    let critical = number(&found["critical"]["dither.amplitude"]);
    assert_near_a_threshold(law, critical);
    let near = format!("from = [{}]\nto = [{}]", 0.95 * critical, 1.1 * critical);
    let from_rest = text
        .replace("from = [0.01]\nto = [20.0]", &near)
        .replace("minimise", "start = \"rest\"\nminimise");
    let found = verbs(&study(&from_rest)).design().expect("a design").json();
    let least = number(&found["critical"]["dither.amplitude"]);
    assert!(least >= critical * (1.0 - 1e-6), "{least} below {critical}: {found}");
}

/// Without dither the verdict on bristles is that of small motions with their own state, not of the criterion of the steady law.
#[test]
fn stability_of_a_belt_has_the_small_motions_of_bristles() {
    let without = |text: String| {
        let end = text.find("[[dither]]").or_else(|| text.find("[dither]")).expect("a dither");
        text[..end].to_owned()
    };
    let ask = |text| verbs(&study(&without(text))).stability().expect("small motions").json();
    let [found, exact] = [ask(belt(LAWS[1], 1.0)), ask(system(LAWS[1], 1.0))];
    assert_eq!(found["growth_rate"], exact["growth_rate"]);
    assert_eq!(found["eigenvalues"].as_array().map(Vec::len), Some(3), "{found}");
    assert!(found.get("criterion").is_none(), "{found}");
}

/// `check` warns of friction that is not passive, and reports the mean that is taken out of samples.
#[test]
fn check_reports_passivity_and_the_mean_of_samples() {
    let samples = "waveform = \"samples\"\nvalues = [1, 2, 3]\n";
    let active =
        LAWS[1].1.replace("bristle_damping = 0.1", "bristle_damping = 20.0\nviscous = 0.01");
    for text in [belt(("", &active), 1.0), system(("", &active), 1.0)] {
        let text = text.replace("waveform = \"sine\"\n", samples);
        let found = verbs(&study(&text)).check().expect("valid").json();
        assert!(warnings(&found).contains("not passive"), "{found}");
        assert!(warnings(&found).contains("have the mean 2, which is taken out"), "{found}");
    }
    let plain = verbs(&study(&belt(LAWS[0], 1.0))).check().expect("valid").json();
    assert_eq!(warnings(&plain), "[]");
}
