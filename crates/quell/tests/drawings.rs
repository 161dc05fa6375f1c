//! Each verb draws what it answers: compares the numbers of its picture with those of its JSON.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use quell::picture::orbit::orbit as draw_orbit;
use quell::picture::{basins as draw_basins, curves as draw_curves, disc};
use quell::plot::Figure;
use quell::run::basins::{self, StartLayout};
use quell::run::disc::{campbell, modes, resonances, stability};
use quell::run::orbit::{self, Wanted};
use quell::run::protocol::Protocol;
use quell::run::thresholds::{self, curves};
use quell::run::varied::Range;
use quell::running::Running;
use quell::verbs::{system_of, verbs};
use quell::{BeltStudy, Change, DiscStudy, Study, picture};
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn path(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies").join(name)
}

fn belt(name: &str, changes: &[&str]) -> BeltStudy {
    let changes: Vec<Change> =
        changes.iter().map(|text| Change::parse(text, "--set").expect("a change")).collect();
    BeltStudy::read(&path(name), &changes).expect("a study")
}

/// Layers of a kind in a panel.
fn layers<'a>(figure: &'a Json, panel: usize, kind: &str) -> Vec<&'a Json> {
    let all = figure["panels"][panel]["layers"].as_array().expect("layers");
    all.iter().filter(|layer| layer["kind"] == kind).collect()
}

/// Points (x, y) of a layer, including all pieces of a line.
fn places(layer: &Json) -> Vec<(f64, f64)> {
    let pieces = match layer["kind"].as_str() {
        Some("line") => layer["pieces"].as_array().expect("pieces").clone(),
        _ => vec![layer["points"].clone()],
    };
    let column = |piece: &Json, which: usize| -> Vec<f64> {
        piece[which].as_array().expect("a column").iter().filter_map(Json::as_f64).collect()
    };
    pieces.iter().flat_map(|piece| column(piece, 0).into_iter().zip(column(piece, 1))).collect()
}

fn numbers(list: &Json, name: &str) -> Vec<f64> {
    let list = list.as_array().expect("a list");
    list.iter().map(|object| object[name].as_f64().expect("a number")).collect()
}

fn numbers_of(list: &Json) -> Vec<f64> {
    list.as_array().expect("a list").iter().filter_map(Json::as_f64).collect()
}

#[test]
fn thresholds_are_marked_where_they_are() {
    let study = belt("can-dither-make-it-worse.toml", &[]);
    let question = thresholds::ThresholdsRequest {
        parameter: "dither.amplitude".into(),
        window: RealInterval::new(4.0, 10.5),
        protocols: vec![Protocol::Sliding],
        ..thresholds::ThresholdsRequest::default()
    };
    let study = system_of(&(&study).into(), "thresholds").expect("a system");
    let done = thresholds::run(&study, &question).expect("an answer");
    let (answer, figure) = (done.json(&study), picture::thresholds(&study, &done).described());
    let marked: Vec<f64> = layers(&figure, 0, "points")
        .iter()
        .flat_map(|layer| places(layer))
        .map(|(x, _)| x)
        .collect();
    let mut found = numbers(&answer["local"], "value");
    assert!(found.len() >= 2);
    found.sort_by(f64::total_cmp);
    let mut sorted = marked.clone();
    sorted.sort_by(f64::total_cmp);
    assert_eq!(sorted, found);
    // The modulus passes 1 there.
    let modulus = places(layers(&figure, 0, "line")[0]);
    let around = |value: f64| {
        let (low, high) = (value - 0.3, value + 0.3);
        let near = modulus.iter().filter(|(x, _)| (low..high).contains(x)).map(|(_, y)| *y);
        near.clone().fold(f64::MAX, f64::min) < 1.0 && near.fold(0.0, f64::max) > 1.0
    };
    assert!(found.iter().all(|value| around(*value)), "{found:?}");
    let switches = numbers(&answer["from_sliding"], "value");
    let rules: Vec<f64> = layers(&figure, 0, "rule")
        .iter()
        .filter(|rule| rule["vertical"] == true)
        .filter_map(|rule| rule["value"].as_f64())
        .collect();
    assert_eq!(rules, switches);
}

#[test]
fn curves_of_thresholds_are_drawn_point_by_point() {
    let study = belt("can-dither-make-it-worse.toml", &[]);
    let question = curves::CurvesRequest {
        parameter: "dither.amplitude".into(),
        window: RealInterval::new(0.1, 16.0),
        along: "belt.belt_velocity".into(),
        between: RealInterval::new(0.85, 1.5),
    };
    let study = system_of(&(&study).into(), "thresholds").expect("a system");
    let done = curves::run(&study, &question).expect("an answer");
    let (answer, figure) = (done.json(&study), draw_curves(&study, &done).described());
    let drawn = layers(&figure, 0, "line");
    for kind in ["neimark-sacker", "grazing"] {
        let label = match kind {
            "grazing" => "exact: grazing",
            _ => "exact: Neimark–Sacker",
        };
        let line =
            drawn.iter().find(|line| line["label"] == label).unwrap_or_else(|| panic!("{kind}"));
        let expected: Vec<(f64, f64)> = answer["curves"]
            .as_array()
            .expect("curves")
            .iter()
            .filter(|curve| curve["kind"] == kind)
            .flat_map(|curve| {
                let column = |name: &str| -> Vec<f64> {
                    let values = curve[name].as_array().expect("a column");
                    values.iter().filter_map(Json::as_f64).collect()
                };
                column("along").into_iter().zip(column("value"))
            })
            .collect();
        assert!(expected.len() > 50 && places(line) == expected, "{kind}");
    }
    assert!(drawn.iter().any(|line| line["label"] == "averaged, R → ∞"));
    // The curves fill the frame, which is as small as they are and within the window that was searched.
    for (axis, column, window) in [("y", 1, (0.1, 16.0)), ("x", 0, (0.85, 1.5))] {
        let of = |(along, value): (f64, f64)| if column == 0 { along } else { value };
        let all: Vec<f64> = drawn.iter().flat_map(|line| places(line)).map(of).collect();
        let inside = all.iter().copied().filter(|value| *value >= window.0 && *value <= window.1);
        let (low, high) =
            (inside.clone().fold(f64::MAX, f64::min), inside.fold(f64::MIN, f64::max));
        let limits = numbers_of(&figure["panels"][0][axis]["stretch"]);
        assert!(limits[0] >= window.0 - 1e-9 && limits[1] <= window.1 + 1e-9, "{axis}: {limits:?}");
        assert!(
            high - low > 0.85 * (limits[1] - limits[0]),
            "{axis}: {limits:?} around {low} to {high}"
        );
    }
    assert_eq!(answer["warnings"].as_array().map(Vec::len), Some(0), "{}", answer["warnings"]);
}

#[test]
fn an_orbit_closes_and_its_multipliers_are_drawn() {
    for (name, closed) in
        [("can-dither-make-it-worse.toml", 1e-9), ("can-it-squeal-although-stable.toml", 1e-9)]
    {
        let study = belt(name, &[]);
        let system = system_of(&study.into(), "orbit").expect("a system");
        let found = orbit::run(&system, &Wanted::default()).expect("an orbit");
        let figure = draw_orbit(&system, &found).expect("a picture").described();
        let curve = places(layers(&figure, 0, "line")[0]);
        let (first, last) = (curve[0], curve[curve.len() - 1]);
        assert!((first.0 - last.0).hypot(first.1 - last.1) < closed, "{first:?} {last:?}");
        let multipliers = places(layers(&figure, 1, "points")[0]);
        let found = found.found.expect("an orbit").orbit.multipliers;
        assert_eq!(multipliers, found.iter().map(|z| (z.re, z.im)).collect::<Vec<_>>());
    }
    let quiet = belt("does-it-squeal.toml", &["belt.belt_velocity=9"]);
    let quiet = system_of(&quiet.into(), "orbit").expect("a system");
    let found = orbit::run(&quiet, &Wanted::default()).expect("sliding");
    let refused = draw_orbit(&quiet, &found).expect_err("no orbit").to_string();
    assert!(refused.contains("No limit cycle was found"), "{refused}");
}

fn portraits(study: &BeltStudy, layout: StartLayout, over: Option<Range>) -> (Json, Figure) {
    let never = AtomicBool::new(false);
    let running = Running { threads: Some(2), stop: &never, progress: &() };
    let question = basins::BasinsRequest { axes: None, layout: Some(layout), over };
    let study = system_of(&study.into(), "basins").expect("a system");
    let done = basins::run(&study, &question, running).expect("basins");
    (done.json(&study), draw_basins(&study, &done).expect("a picture"))
}

#[test]
fn basins_show_every_start_and_every_share() {
    let study = belt("will-every-start-fall-quiet.toml", &[]);
    let layout = StartLayout::Sample { count: 24, seed: 3 };
    let (answer, figure) = portraits(&study, layout, None);
    let attractors = answer["attractors"].as_array().expect("attractors").len();
    let figure = figure.described();
    let starts: usize =
        layers(&figure, 0, "points").iter().take(attractors).map(|layer| places(layer).len()).sum();
    let unknown = answer["unknown"]["starts"].as_u64().expect("a count");
    assert_eq!(starts as u64 + unknown, 24);
    let over = Range { parameter: "dither.amplitude".into(), from: 5.0, to: 10.5, points: 3 };
    let (answer, figure) = portraits(&study, StartLayout::Sample { count: 8, seed: 3 }, Some(over));
    let figure = figure.described();
    let line = places(layers(&figure, 0, "line")[0]);
    let shares = numbers(&answer["portraits"], "quiet_fraction");
    assert_eq!(line.iter().map(|(_, share)| *share).collect::<Vec<_>>(), shares);
}

#[test]
fn a_disc_is_drawn_with_its_own_place() {
    let text = fs::read_to_string(path("which-dither-frequency.toml")).expect("a study");
    let study = DiscStudy::parse_in(&text, &[], Path::new("")).expect("a disc");
    let answer = stability::run(&study).expect("finite");
    let speeds = campbell::run(&study, 1.0).expect("finite");
    let figure = disc::stability(&study, &answer, &speeds).described();
    let at = (study.disc().speed(), answer.growth.rate);
    let own = layers(&figure, 1, "points");
    assert!(own.iter().any(|layer| places(layer) == [at]), "{at:?}");
    // Under dither a separate line passes through the same point.
    let line = places(layers(&figure, 1, "line")[0]);
    let around = line.windows(2).find(|pair| (pair[0].0..=pair[1].0).contains(&at.0));
    let around = around.expect("speeds around it");
    let (low, high) = (around[0].1.min(around[1].1), around[0].1.max(around[1].1));
    assert!((low - 1e-3..=high + 1e-3).contains(&at.1), "{around:?} {at:?}");

    let found =
        resonances::run(&study, resonances::ResonancesRequest::default()).expect("one load");
    let figure = disc::resonances(&study, &found).described();
    let rules = layers(&figure, 0, "rule");
    let own = rules.iter().find(|rule| rule["label"] == "this study").expect("its friction");
    assert_eq!(own["value"], 0.25);
    let dotted: Vec<f64> = rules
        .iter()
        .filter(|rule| rule["vertical"] == true)
        .filter_map(|rule| rule["value"].as_f64())
        .collect();
    let stable = found
        .undithered
        .iter()
        .chain(&found.dithered)
        .filter(|meeting| !meeting.pair_can_be_unstable());
    assert_eq!(dotted, stable.map(|meeting| meeting.speed).collect::<Vec<_>>());

    let listed = DiscStudy::parse_in(
        "schema = 1\n[disc]\n[[disc.mode]]\ndiameters = 1\nratio = 1\nshape_at_load = 1\n\
         [[disc.mode]]\ndiameters = 2\nratio = 1.5\nshape_at_load = 1.2\n",
        &[],
        Path::new(""),
    )
    .expect("modes");
    let figure = disc::modes(&listed, &modes::run(&listed)).expect("a picture").described();
    let rows = modes::run(&listed).rows;
    let rows: Vec<(f64, f64)> = rows.iter().map(|row| (row.diameters as f64, row.ratio)).collect();
    assert_eq!(places(layers(&figure, 0, "points")[0]), rows);
    assert_eq!(rows.len(), 2);
}

/// A picture of changed numbers is not the figure of the dissertation, and says what is changed.
#[test]
fn a_changed_study_does_not_keep_its_title() {
    let text = "schema = 1\ntitle = \"Figure 2.4: effective friction, Stribeck law\"\n[belt]\ndamping_ratio = 0.005\n\
        normal_load = 1\nbelt_velocity = 0.05\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\n\
        minimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\n\
        amplitude = 1\nfrequency_ratio = 10\n";
    let title = |changes: &[&str]| {
        let changes: Vec<Change> =
            changes.iter().map(|text| Change::parse(text, "--set").expect("a change")).collect();
        let study = Study::parse(text, &changes).expect("valid");
        let done = verbs(&study).friction(None, false).expect("an answer");
        done.figure().expect("a picture").expect("drawn").title
    };
    assert_eq!(title(&[]), "Figure 2.4: effective friction, Stribeck law");
    assert_eq!(
        title(&["friction.reference_velocity=0.3"]),
        "Effective friction, Stribeck law; changed: friction.reference_velocity = 0.3"
    );
    // Accuracy changes no study, and a title that is set stays as it is.
    assert_eq!(title(&["solver.tolerance=1e-9"]), "Figure 2.4: effective friction, Stribeck law");
    assert_eq!(title(&["belt.belt_velocity=0.1", "title=Mine"]), "Mine");
    let many = title(&[
        "belt.belt_velocity=0.1",
        "belt.damping_ratio=0.01",
        "dither.amplitude=2",
        "dither.phase=1",
    ]);
    assert!(many.ends_with("dither.amplitude = 2, 1 more"), "{many}");
}
