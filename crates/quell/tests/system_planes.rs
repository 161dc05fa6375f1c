//! Verbs of systems over a parameter and in planes, against the same belt, and against planted answers.

use std::sync::atomic::AtomicBool;

use quell::Study;
use quell::outcome::named;
use quell::run::basins::{BasinsRequest, StartLayout, default_plane};
use quell::run::bifurcation::SweepRequest;
use quell::run::found_attractor::AttractorRequest;
use quell::run::orbit::Wanted;
use quell::run::protocol::Protocol;
use quell::run::thresholds::ThresholdsRequest;
use quell::run::thresholds::curves::CurvesRequest;
use quell::run::varied::Range;
use quell::running::Running;
use quell::verbs::{system_of, verbs};
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

const LAW: &str =
    "static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n";

/// A belt with ζ = 0.005 and F = 1.
fn belt(law: &str, velocity: f64, dither: &str) -> Study {
    study(&format!(
        "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = {velocity}\n\
         [friction]\nlaw = \"{law}\"\n{LAW}{}",
        dither
            .replace("DIRECTION", "direction = \"tangential\"")
            .replace("FREQUENCY", "frequency_ratio")
    ))
}

/// The same belt as a system.
fn system(law: &str, velocity: f64, dither: &str) -> Study {
    study(&format!(
        "schema = 1\n[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.01]\nstiffness = [1.0]\n\
         [[contact]]\nname = \"belt\"\ntangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = {velocity}\n\
         [friction]\nlaw = \"{law}\"\n{LAW}{}",
        dither.replace("DIRECTION", "at = { x = 1.0 }").replace("FREQUENCY", "frequency")
    ))
}

fn dither(amplitude: f64) -> String {
    format!(
        "[[dither]]\nDIRECTION\nwaveform = \"sine\"\namplitude = {amplitude}\nFREQUENCY = 10.0\n"
    )
}

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

fn list(value: &Json) -> &[Json] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn numbers(value: &Json) -> Vec<f64> {
    list(value).iter().filter_map(Json::as_f64).collect()
}

fn running(stop: &AtomicBool) -> Running<'_> {
    Running { threads: Some(2), stop, progress: &() }
}

fn curves(study: &Study, window: RealInterval, along: &str, between: RealInterval) -> Json {
    let along = along.to_owned();
    let parameter = "dither.amplitude".to_owned();
    let request = CurvesRequest { parameter, window, along, between };
    let found = verbs(study).threshold_curves(&request).unwrap_or_else(|why| panic!("{why:?}"));
    let json = named(found.as_ref(), found.json());
    println!("{}", json["sentence"]);
    json
}

/// Value of a curve at a value of the second parameter, by cubic interpolation between its points.
fn at(curve: &Json, along: f64) -> Option<f64> {
    let (x, y) = (numbers(&curve["along"]), numbers(&curve["value"]));
    let place = (1..x.len()).find(|k| (x[k - 1] - along) * (x[*k] - along) <= 0.0)?;
    let first = place.saturating_sub(2).min(x.len().checked_sub(4)?);
    let nodes = first..first + 4;
    let weight = |i: usize| {
        nodes.clone().filter(|j| *j != i).map(|j| (along - x[j]) / (x[i] - x[j])).product::<f64>()
    };
    Some(nodes.clone().map(|i| y[i] * weight(i)).sum())
}

/// A belt and the same belt as a system have the same curves.
#[test]
fn a_belt_as_a_system_has_the_same_curves() {
    let (window, between) = (RealInterval::new(0.5, 14.0), RealInterval::new(0.85, 1.2));
    let own = curves(&belt("decreasing", 1.0, &dither(1.0)), window, "belt.belt_velocity", between);
    let other = curves(
        &system("decreasing", 1.0, &dither(1.0)),
        window,
        "contact.belt.belt_velocity",
        between,
    );
    assert_eq!(list(&own["curves"]).len(), list(&other["curves"]).len());
    for kind in ["neimark-sacker", "grazing"] {
        let of = |all: &Json| {
            list(&all["curves"]).iter().find(|curve| curve["kind"] == kind).cloned().expect(kind)
        };
        let (one, two) = (of(&own), of(&other));
        let mut ends = [&one, &two].map(|curve| list(&curve["ends"]).to_vec());
        for ends in &mut ends {
            ends.sort_by_key(Json::to_string);
        }
        assert_eq!(ends[0], ends[1]);
        for velocity in [0.88, 0.95, 1.0, 1.07, 1.15] {
            let (a, b) =
                (at(&one, velocity).expect("a value"), at(&two, velocity).expect("a value"));
            assert!((a - b).abs() < 2e-6 * a, "{kind} at {velocity}: {a} {b}");
        }
    }
    // The thresholds at v = 1 are those of the reference.
    let sacker = list(&other["curves"]).iter().find(|curve| curve["kind"] == "neimark-sacker");
    assert!((at(sacker.expect("a curve"), 1.0).expect("a value") - 4.322_392_624).abs() < 1e-5);
    assert!(list(&other["averaged"]).len() == 2, "{}", other["averaged"]);
}

/// Two uncoupled oscillators on belts of their own, under one dither.
fn uncoupled() -> Study {
    study(&format!(
        "schema = 1\n[system]\ncoordinates = [\"a\", \"b\"]\nmass = [1.0, 1.0]\ndamping = [0.01, 0.01]\nstiffness = [1.0, 1.0]\n\
         [[contact]]\nname = \"first\"\ntangent = {{ a = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 1.0\n\
         [[contact]]\nname = \"second\"\ntangent = {{ b = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 1.0\n\
         [friction]\nlaw = \"decreasing\"\n{LAW}\
         [[dither]]\nat = {{ a = 1.0, b = 1.0 }}\nwaveform = \"sine\"\namplitude = 1.0\nfrequency = 10.0\n"
    ))
}

/// Two uncoupled oscillators on belts of their own: the response is stable as long as both are, so that the curve of the second
/// one ends where that of the first one crosses it, at equal velocities.
#[test]
fn a_curve_ends_where_another_threshold_crosses_it() {
    let two = uncoupled();
    let found = curves(
        &two,
        RealInterval::new(1.0, 6.0),
        "contact.first.belt_velocity",
        RealInterval::new(0.85, 1.2),
    );
    assert_eq!(list(&found["curves"]).len(), 2);
    let crossed = "another threshold crosses it, and comes first beyond";
    assert_eq!(found["notes"].to_string().matches(crossed).count(), 2);
    for curve in list(&found["curves"]) {
        let (along, value) = (numbers(&curve["along"]), numbers(&curve["value"]));
        let ends: Vec<&str> = list(&curve["ends"]).iter().filter_map(Json::as_str).collect();
        let place = if ends[0] == "crossing" { 0 } else { along.len() - 1 };
        assert!(ends.contains(&"crossing") && ends.contains(&"window"), "{ends:?}");
        assert!((along[place] - 1.0).abs() < 0.01, "{}", along[place]);
        assert!((value[place] - 4.322_392_624).abs() < 0.1, "{}", value[place]);
        // Beyond the crossing the response depends on the other oscillator alone.
        let is_second = along.iter().all(|at| *at > 1.0 - 1e-3);
        let constant = value.iter().all(|at| (at - 4.322_392_624).abs() < 1e-6);
        assert_eq!(is_second, constant, "{curve}");
    }
}

/// Equal multipliers of equal parts cross the unit circle together, where every test function keeps its sign.
#[test]
fn thresholds_of_equal_parts_are_found() {
    let two = uncoupled();
    let request = ThresholdsRequest {
        parameter: "dither.amplitude".to_owned(),
        window: RealInterval::new(1.0, 6.0),
        ..Default::default()
    };
    let found = verbs(&two).thresholds(&request).unwrap_or_else(|why| panic!("{why:?}")).json();
    println!("{}", found["sentence"]);
    let thresholds = list(&found["local"]);
    let values: Vec<f64> = thresholds.iter().filter_map(|at| at["value"].as_f64()).collect();
    assert_eq!(values.len(), 1, "{found}");
    assert!((values[0] - 4.322_392_624).abs() < 1e-7, "{}", values[0]);
    assert_eq!(thresholds[0]["kind"], "neimark-sacker");
    assert_eq!([&thresholds[0]["was"], &thresholds[0]["becomes"]], ["stable", "unstable"]);
}

/// Without dither the sweep of a belt as a system jumps between the same values as that of the belt, and both have limit cycles of
/// the same size.
#[test]
fn sweeps_without_dither_are_those_of_the_belt() {
    let stop = AtomicBool::new(false);
    let sweep = |study: &Study, parameter: &str| {
        let parameter = parameter.to_owned();
        let range = Range { parameter, from: 0.05, to: 0.3, points: 6 };
        let request = SweepRequest { range, up: true, down: true };
        let found = verbs(study).bifurcation(&request, running(&stop));
        found.unwrap_or_else(|why| panic!("{why:?}")).json()
    };
    let own = sweep(&belt("stribeck", 0.05, ""), "belt.belt_velocity");
    let other = sweep(&system("stribeck", 0.05, ""), "contact.belt.belt_velocity");
    println!("{}\n{}", own["sentence"], other["sentence"]);
    assert_eq!(own["jumps"], other["jumps"]);
    assert_eq!(list(&own["jumps"]).len(), 2);
    assert_eq!(own["hysteresis"], other["hysteresis"]);
    // A dither of amplitude 0 changes nothing.
    let silent = sweep(&system("stribeck", 0.05, &dither(0.0)), "contact.belt.belt_velocity");
    assert_eq!(silent["up"], other["up"]);
    assert_eq!(silent["down"], other["down"]);
    for direction in ["up", "down"] {
        for (one, two) in list(&own[direction]).iter().zip(list(&other[direction])) {
            assert_eq!(one["quiet"], two["quiet"], "{one} {two}");
            assert_eq!(one["local_verdict"], two["local_verdict"]);
            let [a, b] = [one, two].map(|point| point["peak_to_peak"].as_f64().expect("a size"));
            assert!((a - b).abs() < 2e-5 * a + 1e-9, "{a} {b}");
        }
    }
}

/// Shares of random starts, at one value and over a parameter, are those of the belt: the same seed gives the same starts.
#[test]
fn shares_of_random_starts_are_those_of_the_belt() {
    let stop = AtomicBool::new(false);
    let layout = StartLayout::Sample { count: 24, seed: 7 };
    let basins = |study: &Study, over: Option<&str>| {
        let over = over.map(|parameter| Range {
            parameter: parameter.to_owned(),
            from: 0.15,
            to: 0.25,
            points: 3,
        });
        let system = system_of(study, "basins").expect("a system");
        let axes = default_plane(
            &system,
            [Some(RealInterval::new(-0.3, 0.9)), Some(RealInterval::new(-0.3, 0.3))],
        );
        let axes = Some(axes.expect("a plane"));
        let request = BasinsRequest { axes, layout: Some(layout), over };
        let found = verbs(study).basins(&request, running(&stop));
        let found = found.unwrap_or_else(|why| panic!("{why:?}")).json();
        println!("{}", found["sentence"]);
        found
    };
    let (one, two) = (belt("stribeck", 0.05, ""), system("stribeck", 0.05, ""));
    let own = basins(&one, Some("belt.belt_velocity"));
    let other = basins(&two, Some("contact.belt.belt_velocity"));
    assert_eq!(own["layout"], other["layout"]);
    assert_eq!(own["error_meaning"], other["error_meaning"]);
    let pairs = list(&own["portraits"]).iter().zip(list(&other["portraits"]));
    assert_eq!(pairs.len(), 3);
    for (a, b) in pairs {
        for key in ["quiet_fraction", "quiet_fraction_low", "quiet_fraction_high", "local_verdict"]
        {
            assert_eq!(a[key], b[key], "{key}");
        }
        assert_eq!(list(&a["attractors"]).len(), list(&b["attractors"]).len());
    }
    // Under dither the outcome of every start is that of the belt.
    let own = basins(&belt("decreasing", 1.0, &dither(12.0)), None);
    let other = basins(&system("decreasing", 1.0, &dither(12.0)), None);
    assert_eq!(own["quiet_fraction"], other["quiet_fraction"]);
    assert_eq!(own["ends"], other["ends"]);
}

/// Without dither a run from steady sliding changes at the Hopf bifurcation, one from squeal where the limit cycles end, and where nothing
/// squeals it starts from steady sliding; as a belt and as a system.
#[test]
fn runs_without_dither_change_where_the_squeal_ends() {
    let found = |study: &Study, parameter: &str| {
        let request = ThresholdsRequest {
            parameter: parameter.to_owned(),
            window: RealInterval::new(0.01, 3.0),
            protocols: vec![Protocol::Sliding, Protocol::Squeal],
            ..ThresholdsRequest::default()
        };
        verbs(study).thresholds(&request).unwrap_or_else(|why| panic!("{why:?}")).json()
    };
    let own = found(&belt("decreasing", 1.0, &dither(0.0)), "belt.belt_velocity");
    let other = found(&system("decreasing", 1.0, &dither(0.0)), "contact.belt.belt_velocity");
    for name in ["local", "from_sliding", "from_squeal"] {
        let [a, b] = [&own, &other].map(|found| list(&found[name]));
        assert_eq!(a.len(), b.len(), "{name}");
        for (a, b) in a.iter().zip(b) {
            let [a, b] = [a, b].map(|at| at["value"].as_f64().expect("a number"));
            assert!((a - b).abs() <= 1e-12 * a, "{name}: {a} {b}");
        }
    }
    let [hopf] = list(&own["from_sliding"]) else { panic!("{own}") };
    assert_eq!((&hopf["kind"], &hopf["becomes"]), (&"hopf".into(), &"quenched".into()));
    let [run, local] = [hopf, &own["local"][0]].map(|at| at["value"].as_f64().expect("a number"));
    assert!((run - local).abs() <= 1e-10, "{run} {local}");
    let [end] = list(&own["from_squeal"]) else { panic!("{own}") };
    let end = end["value"].as_f64().expect("a number");
    let squeals = |velocity: f64| {
        let wanted = Wanted::After(Protocol::Squeal);
        verbs(&belt("decreasing", velocity, &dither(0.0))).orbit(&wanted).is_ok()
    };
    assert!(squeals(end - 1e-3) && !squeals(end + 1e-3), "{end}");
    let warnings = own["warnings"].to_string();
    assert!(warnings.contains("no squeal was found"), "{warnings}");
}

/// Next to the unstable limit cycle, which a run from rest passes slowly, `attractor` and `thresholds` know where the run ends; the change
/// of the exact cycle map lies at 0.8590745.
#[test]
fn verbs_agree_next_to_an_unstable_limit_cycle() {
    let study = belt("decreasing", 1.0, &dither(0.0));
    let parameter = "belt.belt_velocity".to_owned();
    let request = ThresholdsRequest {
        parameter: parameter.clone(),
        window: RealInterval::new(0.85, 0.87),
        protocols: vec![Protocol::Rest],
        ..ThresholdsRequest::default()
    };
    let found = verbs(&study).thresholds(&request).expect("thresholds").json();
    let [change] = list(&found["from_rest"]) else { panic!("{found}") };
    let [value, error] = ["value", "error"].map(|key| change[key].as_f64().expect("a number"));
    assert!((value - 0.859_074_5).abs() <= error + 1e-6, "{found}");
    for (velocity, quiet) in [(value - 2.0 * error, false), (value + 2.0 * error, true)] {
        let at = belt("decreasing", velocity, &dither(0.0));
        let end = verbs(&at).attractor(&AttractorRequest::default()).expect("an end").json();
        assert_eq!(end["attractor"]["quiet"], quiet, "{velocity}: {end}");
    }
}

/// Curves warn of slip beyond the range of the law, as thresholds do.
#[test]
fn curves_warn_of_slip_beyond_the_law() {
    let text = "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n\
        [friction]\nlaw = \"samples\"\nslip_velocity = [0.0, 0.02, 0.04, 0.06, LAST]\n\
        coefficient = [0.4, 0.38, 0.365, 0.355, 0.35]\n\
        [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.4\nfrequency_ratio = 10.0\n";
    let warned = |last: &str| {
        let study = study(&text.replace("LAST", last));
        let found = curves(
            &study,
            RealInterval::new(0.4, 0.6),
            "belt.belt_velocity",
            RealInterval::new(0.049, 0.051),
        );
        assert!(!list(&found["curves"]).is_empty(), "{found}");
        found["warnings"].to_string().contains("range of the samples law")
    };
    // At the thresholds the slip reaches twice the velocity of the surface.
    assert!(warned("0.08") && !warned("0.2"));
}

/// Runs whose dither is ramped up stop being quenched at the same amplitude as those of the belt.
#[test]
fn ramped_runs_change_where_those_of_the_belt_do() {
    let thresholds = |study: &Study| {
        let request = ThresholdsRequest {
            parameter: "dither.amplitude".to_owned(),
            window: RealInterval::new(0.42, 0.56),
            protocols: vec![Protocol::Squeal],
            ramp: 100.0,
            ..ThresholdsRequest::default()
        };
        let found = verbs(study).thresholds(&request).unwrap_or_else(|why| panic!("{why:?}"));
        let found = found.json();
        println!("{}", found["sentence"]);
        assert_eq!(found["ramp"], 100.0);
        list(&found["from_squeal"]).iter().filter_map(|at| at["value"].as_f64()).collect::<Vec<_>>()
    };
    let own = thresholds(&belt("stribeck", 0.05, &dither(0.4)));
    let other = thresholds(&system("stribeck", 0.05, &dither(0.4)));
    assert!(!own.is_empty() && own.len() == other.len(), "{own:?} {other:?}");
    for (a, b) in own.iter().zip(&other) {
        assert!((a - b).abs() < 2e-5 * a, "{a} {b}");
    }
}
