//! Contacts with a state of their own: elastic sliders (`tangential_stiffness`) and the law `lugre`.
//!
//! Numbers: `reference/laws-with-state.json` (source and tolerance in `reference/README.md`).

use quell::run::found_attractor::AttractorRequest;
use quell::run::orbit::{Wanted, run as orbit_run};
use quell::run::protocol::Protocol;
use quell::run::response::ResponseRequest;
use quell::run::simulate::{MotionRequest, run as run_system};
use quell::run::stability::run as system_stability;
use quell::run::system::exact::run as system_exact;
use quell::run::thresholds::ThresholdsRequest;
use quell::study::{BeltStudy, Study, SystemStudy};
use quell::verbs::verbs;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn reference() -> Json {
    serde_json::from_str(include_str!("../../../reference/laws-with-state.json")).expect("JSON")
}

fn number(value: &Json) -> f64 {
    value.as_f64().or_else(|| value.as_str()?.parse().ok()).expect("a number")
}

fn text(value: &Json) -> &str {
    value.as_str().expect("text")
}

fn rows<'a>(reference: &'a Json, key: &str) -> &'a [Json] {
    reference[key].as_array().expect("rows")
}

fn belt(text: &str) -> BeltStudy {
    BeltStudy::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

fn system(text: &str) -> SystemStudy {
    SystemStudy::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

fn warnings(json: &Json) -> String {
    let list = json["warnings"].as_array().expect("a list");
    list.iter().map(text).collect::<Vec<_>>().join("\n")
}

/// The friction of a belt's contact at a slip velocity.
fn friction(study: &BeltStudy, at: f64) -> Json {
    verbs(&Study::from(study)).friction(Some(&[at]), false).expect("friction").json()
}

fn mean_of(friction: &Json) -> f64 {
    number(&friction["contacts"][0]["effective_coefficient"][0])
}

/// The mean of T/N₀ in the periodic state, under the prescribed slip and load.
#[test]
fn means_are_those_of_the_periodic_state() {
    let reference = reference();
    for (key, count) in [("popov", 6), ("elastic_slider", 5), ("lugre", 6)] {
        let rows = rows(&reference, key);
        assert_eq!(rows.len(), count);
        for row in rows {
            let study = belt(text(&row["study"]));
            let at = number(&row["slip_velocity"]);
            let found = friction(&study, at);
            let mean = mean_of(&found);
            let error = (mean - number(&row["coefficient"])).abs();
            assert!(error < 1e-7, "{key}: {mean} differs by {error:e} from {row}");
            // The mean is odd in the slip velocity.
            let other = mean_of(&friction(&study, -at));
            assert!((mean + other).abs() < 1e-9, "{key}: {mean} and {other}");
        }
    }
}

/// 1 + (a/δ₀)Ψ(v̄), with Ψ of Popov et al. (2017), and the rigid average from v̄ = 1 on.
#[test]
fn a_load_that_oscillates_lowers_friction_by_popovs_function() {
    let reference = reference();
    for row in rows(&reference, "popov") {
        let study = belt(text(&row["study"]));
        let at = number(&row["slip_velocity"]);
        let found = friction(&study, at);
        let mean = mean_of(&found);
        let exact = 0.4 * (1.0 + 0.5 * number(&row["Psi"]));
        assert!((mean - exact).abs() < 1e-7, "{mean} {exact}");
        let warned = warnings(&found).contains("Popov");
        assert_eq!(warned, number(&row["v_bar"]) < 1.0, "{row}");
    }
}

/// The mean force of bristles under v = V + a cos θ at V/a = 0.1 with μ_c = μ_s = 1, for Π = σ₀a/(F_c ω). For Π → ∞ it is that of the
/// rigid law, (2/π) asin(V/a); for Π → 0 the bristles keep their deflection, V/⟨|v|⟩.
#[test]
fn bristles_between_their_limits() {
    let reference = reference();
    let of = |pi: f64| {
        let study = text(&rows(&reference, "lugre")[2]["study"]);
        let study = study.replace("bristle_damping = 0.5", "bristle_damping = 0.0");
        let study = belt(&study.replace(
            "bristle_stiffness = 100.0",
            &format!("bristle_stiffness = {:?}", 100.0 * pi),
        ));
        mean_of(&friction(&study, 0.01))
    };
    // The errors of the limits are of the order of 1/Π² and Π²; the others are half a unit of the last digit that is known.
    for (pi, mean, error) in [
        (300.0, 0.063_768_6, 2e-4),
        (10.0, 0.066_115_0, 5e-8),
        (1.0, 0.122_328, 5e-7),
        (0.01, 0.156_297, 1e-5),
    ] {
        let found = of(pi);
        assert!((found - mean).abs() < error, "Π = {pi}: {found} {mean}");
    }
}

#[test]
fn belts_move_as_independent_integrators_find() {
    let reference = reference();
    let cases = rows(&reference, "trajectories").iter().filter(|case| case["system"] == false);
    let mut count = 0;
    for case in cases {
        count += 1;
        let study = belt(text(&case["study"]));
        let request = MotionRequest::to(number(&case["until"]));
        let json = verbs(&Study::from(&study)).simulate(&request).expect("a run").json();
        let at = |event: &Json, place: usize| number(&event["state"][place]);
        compare(case, &json, |event| (at(event, 0), at(event, 1)));
        let end = &json["final"];
        assert!(off(&case["final"]["displacement"], &end["displacement"]) < 1e-9);
        assert!(off(&case["final"]["velocity"], &end["velocity"]) < 1e-9);
    }
    assert_eq!(count, 6);
}

#[test]
fn systems_move_as_independent_integrators_find() {
    let reference = reference();
    let cases = rows(&reference, "trajectories").iter().filter(|case| case["system"] == true);
    for case in cases {
        let study = system(text(&case["study"]));
        let until = Some(number(&case["until"]));
        let request = MotionRequest { until, events: true, ..MotionRequest::default() };
        let run = run_system(&study, &request).expect("a run");
        let json = run.json(&study);
        let at = |state: &Json, place: usize| number(&state["state"][place]);
        compare(case, &json, |event| (at(event, 0), at(event, 1)));
        let end = &json["final"];
        assert!((number(&case["final"]["displacement"]) - at(end, 0)).abs() < 1e-8);
        assert!((number(&case["final"]["velocity"]) - at(end, 1)).abs() < 1e-8);
    }
}

fn off(a: &Json, b: &Json) -> f64 {
    (number(a) - number(b)).abs()
}

/// The events, and friction or deflection at the end. Stiff bristles amplify the rounding of the reference to 1e-8.
fn compare(case: &Json, json: &Json, state: impl Fn(&Json) -> (f64, f64)) {
    let name = text(&case["name"]);
    let tolerance = if name.contains("Canudas") { 1e-8 } else { 1e-9 };
    let events = json["events"].as_array().expect("events");
    assert_eq!(events.len() as u64, case["n_events"].as_u64().expect("a count"), "{name}");
    for (event, expected) in events.iter().zip(rows(case, "events")) {
        assert_eq!(event["kind"], expected["kind"], "{name}: {event}");
        assert_eq!(event["slip_sign"], expected["slip_sign"], "{name}: {event}");
        let (displacement, velocity) = state(event);
        let errors = [
            off(&event["time"], &expected["time"]),
            (displacement - number(&expected["displacement"])).abs(),
            (velocity - number(&expected["velocity"])).abs(),
        ];
        let largest = errors.into_iter().fold(0.0, f64::max);
        assert!(largest < tolerance, "{name}: {largest:e} at {event}");
    }
    let (end, expected) = (&json["final"], &case["final"]);
    for key in ["friction", "bristle"] {
        if let Some(value) = expected.get(key) {
            assert!(off(&end[key], value) < tolerance, "{name}: {key} {} {value}", end[key]);
        }
    }
}

/// Canudas de Wit et al. (1995), figure 4: the box sticks and slips. The period is the time between two reversals of the same kind.
#[test]
fn a_box_pulled_by_a_spring_has_the_published_stick_slip_period() {
    let reference = reference();
    let case = &reference["stick_slip"][0];
    let study = system(text(&case["study"]));
    let until = Some(number(&case["until"]));
    let request = MotionRequest { until, events: true, ..MotionRequest::default() };
    let run = run_system(&study, &request).expect("a run");
    let json = run.json(&study);
    let events = json["events"].as_array().expect("events");
    let backwards = events.iter().filter(|event| event["slip_sign"] == -1);
    let times: Vec<f64> = backwards.map(|event| number(&event["time"])).collect();
    let period = number(&case["period"]);
    let after = |first: &f64| times.iter().any(|time| (time - first - period).abs() < 1e-6);
    assert!(times.iter().any(after), "{times:?} and the period {period}");
    assert!(warnings(&json).contains("not passive"), "{}", warnings(&json));
    // The largest spring force, 2x.
    let end = verbs(&Study::from(&study)).attractor(&AttractorRequest::default());
    let highest = number(&end.expect("an end").json()["attractor"]["highest"]);
    assert!((2.0 * highest - 1.507_987_833_6).abs() < 1e-8, "{highest}");
}

#[test]
fn averaged_verbs_warn_where_the_rigid_law_does_not_hold() {
    let reference = reference();
    for (row, expected) in
        rows(&reference, "elastic_slider").iter().zip([true, true, true, true, false])
    {
        let study = belt(text(&row["study"]));
        let asked = verbs(&(&study).into());
        for answer in [asked.stability(), asked.describing(0.1)] {
            let found = warnings(&answer.expect("an answer").json());
            assert_eq!(found.contains("breakaway displacement"), expected, "{row}: {found}");
        }
    }
    let study = belt(text(&rows(&reference, "lugre")[2]["study"]));
    let found = warnings(&verbs(&(&study).into()).stability().expect("an answer").json());
    // The displacement at R = 10 is larger by R²/(R² − 1) than in the limit, where Π is 1.
    assert!(found.contains("Π = σ₀a/(F_c ω) = 1.01 "), "{found}");
}

#[test]
fn verbs_that_do_not_know_the_state_refuse_it_by_name() {
    let reference = reference();
    let study = belt(text(&rows(&reference, "elastic_slider")[0]["study"]));
    let refused = verbs(&study.into()).actuator(None).err().expect("no averages");
    let refused = refused.json().to_string();
    assert!(refused.contains("belt.tangential_stiffness"), "{refused}");
    let both = text(&rows(&reference, "lugre")[0]["study"])
        .replace("belt_velocity", "tangential_stiffness = 2.0\nbelt_velocity");
    let wrong = BeltStudy::parse(&both, &[]).expect_err("two states");
    assert!(wrong.iter().any(|wrong| wrong.key == "belt.tangential_stiffness"), "{wrong:?}");
}

const SLIDER: &str = r#"
schema = 1
[system]
coordinates = ["x"]
mass = [1.0]
damping = [[0.02]]
stiffness = [[1.0]]
[[contact]]
name = "pad"
tangent = { x = 1.0 }
normal_load = 1.0
belt_velocity = 0.05
tangential_stiffness = 30.0
[contact.friction]
law = "coulomb"
coefficient = 0.3
[[dither]]
at = { x = 1.0 }
waveform = "sine"
amplitude = 0.8
frequency = 10.0
"#;

/// The orbit of a slider that adheres and slides: the run ends on it, and returns to it at the rate of its multipliers.
#[test]
fn a_dithered_slider_has_a_periodic_motion_with_multipliers() {
    let study = system(SLIDER);
    let wanted = Wanted::After(Protocol::Study);
    let found = orbit_run(&study, &wanted).expect("an orbit");
    let json = found.json(&study);
    assert_eq!(json["verdict"], "stable", "{json}");
    assert_eq!(json["state"].as_array().expect("a state").len(), 3);
    assert_eq!(json["multipliers"].as_array().expect("multipliers").len(), 3);
    assert!(number(&json["residual"]) < 1e-9, "{json}");
    let until = Some(400.0 * number(&json["period"]));
    let request = MotionRequest { until, ..MotionRequest::default() };
    let end = run_system(&study, &request).expect("a run").end;
    for (place, value) in json["state"].as_array().expect("a state").iter().enumerate() {
        assert!(
            (number(value) - end.state[place]).abs() < 1e-7,
            "{place}: {value} {}",
            end.state[place]
        );
    }
}

#[test]
fn systems_name_the_numbers_of_their_contacts() {
    let study = system(SLIDER);
    let request = MotionRequest { until: Some(1.0), ..MotionRequest::default() };
    let json = run_system(&study, &request).expect("a run").json(&study);
    assert_eq!(json["state_names"][2], "friction.pad");
    assert_eq!(json["final"]["state"][2], json["final"]["contacts"][0]["friction"]);
    let bristles = SLIDER
        .replace("tangential_stiffness = 30.0\n", "")
        .replace(
            "law = \"coulomb\"",
            "law = \"lugre\"\nbristle_stiffness = 100\nstatic_coefficient = 0.3\nreference_velocity = 0.1",
        );
    let study = system(&bristles);
    let json = run_system(&study, &request).expect("a run").json(&study);
    assert_eq!(json["state_names"][2], "bristle.pad");
    assert_eq!(json["final"]["state"][2], json["final"]["bristle"]);
    // Small motions of bristles are those of their steady curve, with a warning.
    let stable = system_stability(&study).expect("an answer").json(&study);
    assert!(warnings(&stable).contains("bristles"), "{stable}");
    assert!(system_exact(&study).is_err());
}

/// [`SLIDER`] as a belt.
const SLIDER_ON_A_BELT: &str = r#"
schema = 1
[belt]
damping_ratio = 0.01
normal_load = 1.0
belt_velocity = 0.05
tangential_stiffness = 30.0
[friction]
law = "coulomb"
coefficient = 0.3
[dither]
direction = "tangential"
waveform = "sine"
amplitude = 0.8
frequency_ratio = 10.0
"#;

/// A belt whose contact has a state is answered as its system, with its own paths.
#[test]
fn belts_with_a_state_are_answered_as_their_systems() {
    let (of_belt, of_system) =
        (verbs(&Study::from(&belt(SLIDER_ON_A_BELT))), verbs(&system(SLIDER).into()));
    let pairs = [
        (
            of_belt.orbit(&Wanted::After(Protocol::Rest)).expect("an orbit").json(),
            of_system.orbit(&Wanted::After(Protocol::Rest)).expect("an orbit").json(),
        ),
        (
            of_belt.attractor(&AttractorRequest::default()).expect("an end").json(),
            of_system.attractor(&AttractorRequest::default()).expect("an end").json(),
        ),
    ];
    for (a, b) in &pairs {
        for key in ["period", "state", "multipliers", "verdict", "kind"] {
            assert_eq!(a.get(key), b.get(key), "{key}");
        }
    }
    let near = Wanted::Near { state: vec![(0, 0.28), (1, 0.0)], periods: 1 };
    assert_eq!(of_belt.orbit(&near).expect("an orbit").json()["verdict"], "stable");
    let request = ThresholdsRequest {
        parameter: "dither.amplitude".to_owned(),
        window: RealInterval::new(0.3, 0.8),
        protocols: vec![Protocol::Rest],
        ..ThresholdsRequest::default()
    };
    let a = of_belt.thresholds(&request).expect("thresholds").json();
    let b = ThresholdsRequest {
        parameter: "dither[0].amplitude".to_owned(),
        window: RealInterval::new(0.3, 0.8),
        near: None,
        protocols: vec![Protocol::Rest],
        ramp: 0.0,
    };
    let b = of_system.thresholds(&b).expect("thresholds").json();
    assert_eq!(a["local"], b["local"], "{a}");
}

/// Units of a belt of 2 kg on 200 N/m, ω₀ = 10 rad/s, and the same numbers in both forms.
const IN_SI: &str = "mass_kg = 2.0\nstiffness_n_per_m = 200.0\ndamping_ratio = 0.02\nnormal_force_n = 200.0\nbelt_velocity_m_per_s = 1.0\n";
const SCALED: &str = "damping_ratio = 0.02\nnormal_load = 1.0\nbelt_velocity = 0.1\n";

/// A belt in SI and the same belt in the numbers of the equations: an elastic slider under Stribeck's law, one under a formula, bristles.
fn in_both_forms() -> [[BeltStudy; 2]; 3] {
    let whole = |belt: &str, contact: &str, friction: &str, dither: &str| {
        self::belt(&format!(
            "[belt]\n{belt}{contact}[friction]\n{friction}[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\n{dither}"
        ))
    };
    let levels = "static_coefficient = 0.4\n";
    let si = |contact: &str, friction: &str| {
        whole(IN_SI, contact, friction, "amplitude_n = 100.0\nfrequency_hz = 15.915494309189533\n")
    };
    let scaled = |contact: &str, friction: &str| {
        whole(SCALED, contact, friction, "amplitude = 0.5\nfrequency_ratio = 10.0\n")
    };
    let stribeck = format!("law = \"stribeck\"\n{levels}minimum_coefficient = 0.25\n");
    let lugre = format!("law = \"lugre\"\n{levels}coefficient = 0.25\n");
    let formula = |scale: f64| {
        format!("law = \"expression\"\ncoefficient = \"0.25 + 0.15*exp(-abs(v)/{scale:?})\"\n")
    };
    [
        [
            si(
                "tangential_stiffness_n_per_m = 6000.0\n",
                &format!("{stribeck}reference_velocity_m_per_s = 1.5\n"),
            ),
            scaled(
                "tangential_stiffness = 30.0\n",
                &format!("{stribeck}reference_velocity = 0.15\n"),
            ),
        ],
        [
            si("tangential_stiffness_n_per_m = 6000.0\n", &formula(1.5)),
            scaled("tangential_stiffness = 30.0\n", &formula(0.15)),
        ],
        [
            si(
                "",
                &format!(
                    "{lugre}reference_velocity_m_per_s = 1.0\nbristle_stiffness_per_m = 1000.0\nbristle_damping_s_per_m = 0.01\nviscous_s_per_m = 0.01\n"
                ),
            ),
            scaled(
                "",
                &format!(
                    "{lugre}reference_velocity = 0.1\nbristle_stiffness = 1000.0\nbristle_damping = 0.1\nviscous = 0.1\n"
                ),
            ),
        ],
    ]
}

/// The verbs about motions that repeat answer a belt in SI in metres, seconds and newtons, and as they do in the numbers of the
/// equations.
#[test]
fn belts_with_a_state_are_answered_in_si() {
    let close = |si: &Json, scaled: &Json, unit: f64| {
        let (found, expected) = (number(si), unit * number(scaled));
        assert!((found - expected).abs() <= 1e-7 * expected.abs().max(1e-3), "{found} {expected}");
    };
    for [si, scaled] in in_both_forms() {
        let [si, scaled] = [&si, &scaled].map(|study| verbs(&Study::from(study)));
        let of = |ask: &dyn Fn(&quell::verbs::Verbs) -> quell::verbs::Reply| {
            [&si, &scaled].map(|verbs| ask(verbs).unwrap_or_else(|why| panic!("{why}")).json())
        };
        let [a, b] = of(&|verbs| verbs.orbit(&Wanted::default()));
        assert_eq!(a["verdict"], b["verdict"]);
        assert_eq!(a["units"]["period"], "s");
        close(&a["period"], &b["period"], 0.1);
        close(&a["radius"], &b["radius"], 1.0);
        for (place, unit) in [1.0, 10.0].into_iter().enumerate() {
            close(&a["state"][place], &b["state"][place], unit);
        }
        let [a, b] = of(&|verbs| verbs.attractor(&AttractorRequest::default()));
        assert_eq!(a["kind"], b["kind"]);
    }
    for [si, scaled] in in_both_forms() {
        let ask = |study: &BeltStudy, parameter: &str, unit: f64| {
            let request = ThresholdsRequest {
                parameter: parameter.to_owned(),
                window: RealInterval::new(0.3 * unit, 1.6 * unit),
                protocols: Vec::new(),
                ..ThresholdsRequest::default()
            };
            verbs(&Study::from(study)).thresholds(&request).expect("thresholds").json()
        };
        let a = ask(&si, "dither.amplitude_n", 200.0);
        let b = ask(&scaled, "dither.amplitude", 1.0);
        let lists = [&a, &b].map(|json| json["local"].as_array().expect("a list").clone());
        assert!(lists[0].len() == lists[1].len() && a["ending"] == b["ending"], "{a} {b}");
        for (one, other) in lists[0].iter().zip(&lists[1]) {
            close(&one["value"], &other["value"], 200.0);
            assert_eq!(one["kind"], other["kind"]);
        }
        assert_eq!(a["parameter"], "dither.amplitude_n");
    }
}

/// A slider under a falling law, whose base response first adheres at D = 0.991 and becomes stable at D = 1.016: long steps of the
/// continuation contain both.
const FALLING_SLIDER: &str = r#"
schema = 1
[belt]
damping_ratio = 0.01
normal_load = 1.0
belt_velocity = 0.1
tangential_stiffness = 100.0
[friction]
law = "stribeck-exponential"
coefficient = 0.25
static_coefficient = 0.4
reference_velocity = 0.2
[dither]
direction = "tangential"
waveform = "sine"
amplitude = 1.0
frequency_ratio = 10.0
"#;

/// A threshold that follows a border within one step is found, in every window. At D = 1 the multipliers are those of central
/// differences of plain Runge–Kutta runs with the events of the law, 0.88325 ± 0.63560 i.
#[test]
fn thresholds_just_beyond_a_border_do_not_depend_on_the_window() {
    let verbs = verbs(&Study::from(&belt(FALLING_SLIDER)));
    let orbit = verbs.orbit(&Wanted::default()).expect("an orbit").json();
    let multiplier = &orbit["multipliers"][0];
    for (part, expected) in [(0, 0.88325), (1, 0.63560)] {
        assert!((number(&multiplier[part]).abs() - expected).abs() < 1e-5, "{orbit}");
    }
    let mut found: Vec<f64> = Vec::new();
    for (from, to) in [(0.2, 4.0), (0.5, 4.0), (0.2, 2.0), (0.01, 20.0), (0.9, 1.1)] {
        let request = ThresholdsRequest {
            parameter: "dither.amplitude".to_owned(),
            window: RealInterval::new(from, to),
            protocols: Vec::new(),
            ..ThresholdsRequest::default()
        };
        let json = verbs.thresholds(&request).expect("thresholds").json();
        assert_eq!(json["local"][0]["kind"], "neimark-sacker", "{from} to {to}: {json}");
        found.push(number(&json["local"][0]["value"]));
    }
    assert!(found.iter().all(|value| (value / found[0] - 1.0).abs() < 1e-9), "{found:?}");
}

/// The response of a belt with an elastic slider is the orbit of the same motion as a system.
#[test]
fn the_response_of_a_belt_with_a_slider_is_that_of_its_motion() {
    let study = verbs(&(&belt(SLIDER_ON_A_BELT)).into());
    let found = study.response(&ResponseRequest::default()).expect("a response").json();
    let orbit = verbs(&system(SLIDER).into());
    let orbit = orbit.orbit(&Wanted::After(Protocol::Rest)).expect("an orbit").json();
    assert_eq!(found["settled"], true, "{found}");
    let [sticks, stuck] =
        [&orbit, &found].map(|answer| number(&answer["contacts"][0]["stick_fraction"]));
    assert!((stuck - sticks).abs() < 1e-6, "{found} {orbit}");
    let half = number(&found["half_peak_to_peak"]);
    let [low, high] = ["lowest", "highest"].map(|key| number(&orbit[key]));
    assert!((2.0 * half / (high - low) - 1.0).abs() < 1e-6, "{half} {low} {high}");
}

/// Small motions about steady sliding of bristles: the run decays or grows at the rate of the eigenvalue, which differs from that of the
/// steady law.
#[test]
fn bristles_move_in_small_motions() {
    let text = |damping: f64, stiffness: f64| {
        format!(
            "schema = 1\n[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [[{damping}]]\nstiffness = [[1.0]]\n\
             [[contact]]\nname = \"pad\"\ntangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n\
             [contact.friction]\nlaw = \"lugre\"\nbristle_stiffness = {stiffness}\nbristle_damping = 0.3\nviscous = 0.05\n\
             coefficient = 0.3\nstatic_coefficient = 0.4\nreference_velocity = 0.15\n"
        )
    };
    let rate = |study: &SystemStudy| {
        let json = system_stability(study).expect("a verdict").json(study);
        (number(&json["growth_rate"]), warnings(&json))
    };
    let (growth, words) = rate(&system(&text(0.8, 20.0)));
    assert!(!words.contains("follow the slip at once"), "{words}");
    let (stiff, ..) = rate(&system(&text(0.8, 2e6)));
    // Stiff bristles follow at once: 2Re λ = −(c + T_γ), T_γ the slope of steady friction.
    let g = |v: f64| 0.3 + 0.1 * (-(v / 0.15_f64).powi(2)).exp() + 0.05 * v;
    let slope = (g(0.1 + 1e-6) - g(0.1 - 1e-6)) / 2e-6;
    assert!((stiff + 0.5 * (0.8 + slope)).abs() < 1e-4, "{stiff} {slope}");
    assert!((growth - stiff).abs() > 1e-3, "{growth} {stiff}");
    // The whole equations: the deviation from steady sliding shrinks at that rate in the periods of the small motion.
    let study = system(&text(0.8, 20.0));
    let linear = Linearised::new(study.system()).expect("slides");
    let value = spectrum(&linear, &linear.friction()).expect("a spectrum").motions[0].eigenvalue;
    assert_eq!(value.re, growth);
    let deviation = |time: f64| {
        let request = MotionRequest { until: Some(time), ..MotionRequest::default() };
        run_system(&study, &request).expect("a run").end.state[0] - g(0.1)
    };
    let (begin, periods) = (12.0 / growth.abs(), 2.0);
    let length = periods * std::f64::consts::TAU / value.im.abs();
    let measured = (deviation(begin + length) / deviation(begin)).ln() / length;
    assert!((measured - growth).abs() < 1e-3 * growth.abs(), "{measured} {growth}");
}

/// Where no base response exists, the motion on which a run ends is known to be none.
#[test]
fn a_motion_without_a_base_response_is_not_the_base_response() {
    let study = belt(
        "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n[friction]\nlaw = \"lugre\"\n\
         static_coefficient = 0.4\ncoefficient = 0.2857\nreference_velocity = 0.1\nbristle_stiffness = 500.0\n\
         bristle_damping = 1.0\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.7\n\
         frequency_ratio = 10.0\n",
    );
    let verbs = verbs(&Study::from(&study));
    let orbit = verbs.orbit(&Wanted::Base { periods: 1 }).expect("a motion").json();
    assert!(text(&orbit["no_base_response"]).contains("the base response ends at"), "{orbit}");
    let found = verbs.attractor(&AttractorRequest::default()).expect("an end").json();
    assert_eq!(found["attractor"]["base_response"], false, "{found}");
}
