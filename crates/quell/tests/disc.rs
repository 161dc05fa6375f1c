//! Disc studies: valid and invalid input, modes saved and read back, maps of discs.

use std::fs;
use std::path::Path;

use quell::map::run as map;
use quell::outcome::{Answered, Outcome};
use quell::run::disc::{modes, resonances, stability};
use quell::running::Running;
use quell::study::DiscStudy;
use quell::sweep::{Grid, MapQuantity, Plan};
use quell::{Change, Complaints};
use quell_numerics::floquet::Effort;
use serde_json::Value as Json;

const PLATE: &str = "schema = 1\n[disc]\ninner_radius_ratio = 0.5\n[disc.load]\nradius_ratio = 0.75\n\
    mass = 0.1\ndamping = 0.1\nstiffness = 0.1\nfriction = 0.05\nspeed = 0.3\n";
const DITHER: &str = "[dither]\ndirection = \"normal\"\namplitude = 0.8\nfrequency_ratio = 2.7\n";

fn parse(text: &str) -> Result<DiscStudy, Complaints> {
    DiscStudy::parse_in(text, &[], Path::new(""))
}

fn good(text: &str) -> DiscStudy {
    parse(text).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn computed(study: &DiscStudy, quantity: &str) -> quell::map::FinishedMap {
    let quantity = MapQuantity::named(quantity, "--quantity").expect("a quantity");
    let plan = Plan::new(study, &[quantity]).expect("axes");
    let stop = std::sync::atomic::AtomicBool::new(false);
    map(plan, None, Running { threads: Some(1), stop: &stop, progress: &() }).expect("computed")
}

#[test]
fn complaints_name_the_key() {
    let with = |from: &str, to: &str| PLATE.replace(from, to);
    for (text, key, line, allowed) in [
        (with("= 0.5\n", "= 1.0\n"), "disc.inner_radius_ratio", Some(3), "0.95"),
        (with("ratio = 0.75", "ratio = 0.4"), "disc.load.radius_ratio", Some(5), "clamp"),
        (with("ratio = 0.75", "ratio = 1.2"), "disc.load.radius_ratio", Some(5), "1]"),
        (with("damping = 0.1", "damping = -0.1"), "disc.load.damping", Some(7), "≥ 0"),
        (with("damping = 0.1", "dampng = 0.1"), "disc.load.dampng", Some(7), "mass"),
        (
            format!("{PLATE}{}", DITHER.replace("0.8", "1.5")),
            "dither.amplitude",
            Some(13),
            "at most 1",
        ),
        (format!("{PLATE}{DITHER}phase = 1\n"), "dither.phase", Some(15), "direction"),
        (
            with("[disc.load]", "mode = []\n[disc.load]"),
            "disc.inner_radius_ratio",
            Some(3),
            "already",
        ),
        (
            with("[disc.load]", "radial_modes = 0\n[disc.load]"),
            "disc.radial_modes",
            Some(4),
            "1, 40",
        ),
        (
            with("[disc.load]", "without = [\"dampr\"]\n[disc.load]"),
            "disc.without[0]",
            Some(4),
            "damper",
        ),
        (
            with("[disc.load]", "modes_file = \"nowhere.csv\"\n[disc.load]")
                .replace("inner_radius_ratio = 0.5\n", ""),
            "disc.modes_file",
            Some(3),
            "cannot be read",
        ),
        ("schema = 1\n[disc]\nmode = []\n".to_owned(), "disc.mode", Some(3), "at least one"),
        (format!("{PLATE}[belt]\nnormal_load = 1\n"), "belt", Some(11), "exclude each other"),
    ] {
        let complaints = parse(&text).expect_err(&text);
        let found = complaints.iter().find(|complaint| complaint.key == key);
        let found = found.unwrap_or_else(|| panic!("{key}: {complaints:#?}"));
        assert_eq!(found.origin.line(), line, "{found}");
        assert!(found.allowed.contains(allowed), "{found}");
    }
    let complaints = parse(&with("damping = 0.1", "dampng = 0.1")).expect_err("a slip");
    assert_eq!(complaints[0].suggestion.as_deref(), Some("disc.load.damping"));
}

/// Complaints about the material, the reference, axes and dither of a disc.
#[test]
fn complaints_about_a_plate_name_the_key() {
    let disc = |keys: &str| PLATE.replace("= 0.5\n", &format!("= 0.5\n{keys}"));
    let metal = "youngs_modulus_pa = 1.1e11\ndensity_kg_per_m3 = 7200\n";
    let axis = "[[sweep]]\nparameter = \"disc.load.speed\"\nfrom = 0.1\nto = 1\npoints = 3\n";
    for (text, key, line, allowed) in [
        (disc(metal), "disc.thickness_m", Some(2), "hertz and rpm require"),
        (disc(metal), "disc.outer_radius_m", Some(2), "hertz and rpm require"),
        (
            disc(&format!("{metal}thickness_m = 0.5\nouter_radius_m = 0.1\n")),
            "disc.thickness_m",
            Some(6),
            "below disc.outer_radius_m = 0.1",
        ),
        (
            disc("reference_frequency = \"highest\"\n"),
            "disc.reference_frequency",
            Some(4),
            "\"critical\", or",
        ),
        (disc("reference_frequency = 0\n"), "disc.reference_frequency", Some(4), "> 0"),
        (
            disc("nodal_diameters = 0\n"),
            "disc.nodal_diameters",
            Some(4),
            "at least 1, unless disc.reference_frequency",
        ),
        (
            format!(
                "{PLATE}{}",
                DITHER.replace("\"normal\"", "\"normal\"\nwaveform = \"sawtooth\"")
            ),
            "dither.waveform",
            Some(13),
            "triangle",
        ),
        (format!("{PLATE}{axis}{axis}"), "sweep[1].parameter", Some(16), "sweep[0] already varies"),
        (format!("sweep = 3\n{PLATE}"), "sweep", Some(1), "tables [[sweep]]"),
    ] {
        let complaints = parse(&text).err().unwrap_or_else(|| panic!("{key} is accepted"));
        let found = complaints.iter().find(|complaint| complaint.key == key);
        let found = found.unwrap_or_else(|| panic!("{key}: {complaints:#?}"));
        assert_eq!(found.origin.line(), line, "{found}");
        assert!(found.allowed.contains(allowed), "{found}");
    }
    let thin = "thickness_m = 0.002\nouter_radius_m = 0.1\nreference_frequency = 20.5\n";
    let study = good(&disc(&format!("{metal}{thin}")));
    // k² of the reference, in hertz: f = k²/(2πa²)·√(D/ρh), D = Eh³/(12(1 − ν²)).
    let rigidity = 1.1e11 * 0.002_f64.powi(3) / (12.0 * (1.0 - 0.3 * 0.3));
    let hertz = 20.5 / (std::f64::consts::TAU * 0.01) * (rigidity / (7200.0 * 0.002)).sqrt();
    let found = study.reference_hz().expect("a material");
    assert!((found / hertz - 1.0).abs() < 1e-12, "{found} {hertz}");
}

#[test]
fn a_load_at_the_clamp_is_warned_of() {
    assert!(good(PLATE).warnings().is_empty());
    let study = good(&PLATE.replace("ratio = 0.75", "ratio = 0.5"));
    assert!(study.warnings()[0].contains("couples to no mode"), "{:?}", study.warnings());
    assert!(study.disc().modes().iter().all(|mode| mode.shape_at_load == 0.0));
}

#[test]
fn modes_go_through_a_file() {
    let text = format!(
        "{}{DITHER}",
        PLATE.replace(
            "= 0.5\n",
            "= 0.5\nnodal_diameters = 5\nradial_modes = 2\nmodal_damping = 1e-4\n"
        )
    );
    let study = good(&text);
    let found = modes::run(&study);
    assert_eq!(found.rows.len(), 12);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("modes-file");
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("modes.csv"), found.dataset(&study).csv()).expect("written");
    let through = text.replace(
        "inner_radius_ratio = 0.5\nnodal_diameters = 5\nradial_modes = 2\nmodal_damping = 1e-4\n",
        "modes_file = \"modes.csv\"\n",
    );
    let read =
        DiscStudy::parse_in(&through, &[], &folder).unwrap_or_else(|errors| panic!("{errors:#?}"));
    assert_eq!(read.disc().modes(), study.disc().modes());
    let (one, other) =
        (stability::run(&study).expect("finite"), stability::run(&read).expect("finite"));
    assert!((one.growth.rate - other.growth.rate).abs() <= 1e-12);
    // Changing one digit of a mode gives another study.
    assert_ne!(read.settings(), study.settings());
}

#[test]
fn listed_modes_in_hertz_are_measured_in_the_lowest_critical_speed() {
    let text = "schema = 1\n[disc]\n[[disc.mode]]\ndiameters = 2\nfrequency_hz = 1000\nshape_at_load = 0.9\n\
        [[disc.mode]]\ndiameters = 3\nfrequency_hz = 1800\nshape_at_load = 0.9\ndamping = 0.01\n";
    let study = good(text);
    assert_eq!(study.reference_hz(), Some(500.0));
    let ratios: Vec<f64> = study.disc().modes().iter().map(|mode| mode.ratio).collect();
    assert_eq!(ratios, [2.0, 3.6]);
    assert_eq!(study.disc().modes()[1].damping, 0.01);
    let mixed = text.replace("frequency_hz = 1800", "ratio = 3.6");
    assert!(parse(&mixed).expect_err("mixed")[0].allowed.contains("all"));
}

#[test]
fn two_half_pads_give_both_families_of_one() {
    let halves = PLATE.replace("[disc.load]\nradius_ratio = 0.75\nmass = 0.1\ndamping = 0.1\nstiffness = 0.1\nfriction = 0.05\nspeed = 0.3\n",
        "[[disc.load]]\nradius_ratio = 0.75\nmass = 0.05\ndamping = 0.05\nstiffness = 0.05\nfriction = 0.025\nspeed = 0.3\n\
         [[disc.load]]\nangle_deg = 180\nradius_ratio = 0.75\nmass = 0.05\ndamping = 0.05\nstiffness = 0.05\nfriction = 0.025\n");
    let study = good(&halves);
    assert_eq!((study.disc().loads().len(), study.disc().speed()), (2, 0.3));
    let complaints = parse(&format!("{halves}speed = 0.4\n")).expect_err("two speeds");
    assert!(complaints[0].allowed.contains("rotate together"), "{complaints:?}");
    let refused = resonances::run(&study, resonances::ResonancesRequest::default());
    assert!(
        refused.expect_err("two loads").json()["errors"][0]["allowed"]
            .as_str()
            .expect("text")
            .contains("one load")
    );
}

#[test]
fn tables_of_the_dissertation() {
    let study =
        good(&format!("{PLATE}{}", DITHER.replace("normal", "tangential").replace("0.8", "1")));
    let found =
        resonances::run(&study, resonances::ResonancesRequest::default()).expect("one load");
    let places = |list: &[quell_disc::resonance::Resonance]| -> Vec<String> {
        list.iter()
            .filter(|meeting| meeting.speed > 1e-9)
            .map(|meeting| format!("{:.3}", meeting.speed))
            .collect()
    };
    assert_eq!(places(&found.undithered), ["0.036", "0.064", "0.114", "0.192", "1.000"]);
    assert_eq!(
        places(&found.dithered),
        ["0.325", "0.369", "0.458", "0.536", "0.675", "0.836", "0.879", "0.964"]
    );
    let json = found.json(&study);
    for name in ["speed", "waves", "pair_can_be_unstable", "threshold", "edges", "peak_growth"] {
        assert!(json["dithered"][0].get(name).is_some(), "{name}");
    }
}

#[test]
fn a_map_has_the_numbers_of_its_points_and_points_beside_resonances() {
    let axes = "[[sweep]]\nparameter = \"disc.load.speed\"\nfrom = 0.02\nto = 1\npoints = 12\nspacing = \"log\"\n\
        [[sweep]]\nparameter = \"disc.load.friction\"\nfrom = 0\nto = 0.3\npoints = 4\n";
    for dither in ["", DITHER] {
        let study = good(&format!("{PLATE}{dither}{axes}"));
        let grid = Grid::of(&study).expect("axes");
        let speeds = &grid.axes()[0].values;
        // Within 10⁻⁵ below and above the third meeting of waves.
        let place = resonances::run(&study, resonances::ResonancesRequest::default())
            .expect("one load")
            .undithered[2]
            .speed;
        for side in [-1e-5, 1e-5] {
            assert!(speeds.iter().any(|speed| (speed - place - side).abs() < 1e-12), "{speeds:?}");
        }
        assert!(speeds.is_sorted() && speeds.len() > 12);
        let done = computed(&study, "growth");
        let entry = &done.plan().sheet().entries()[0];
        for point in (0..grid.len()).step_by(7) {
            let alone = grid.study_at(point).expect("valid").disc().expect("a disc");
            let one = stability::run(&alone).expect("finite").growth;
            let number = done.number(entry, point).expect("known");
            assert_eq!(number.to_bits(), one.rate.to_bits(), "{dither} {point}");
        }
    }
}

#[test]
fn a_speed_axis_has_points_at_the_tongues_in_every_unit() {
    let steel = "youngs_modulus_pa = 210e9\ndensity_kg_per_m3 = 7850\nthickness_m = 0.01\nouter_radius_m = 0.14\n";
    let plate = PLATE.replace("[disc.load]", &format!("{steel}[disc.load]"));
    let speeds = |path: &str, per_speed: f64| {
        let (from, to) = (0.02 * per_speed, per_speed);
        let axis = format!(
            "[[sweep]]\nparameter = \"{path}\"\nfrom = {from:?}\nto = {to:?}\npoints = 12\n"
        );
        let study = good(&format!("{plate}{DITHER}{axis}"));
        let values = Grid::of(&study).expect("an axis").axes()[0].values.clone();
        values.into_iter().map(|value| value / per_speed).collect::<Vec<f64>>()
    };
    let hertz = good(&plate).reference_hz().expect("a material");
    let own = speeds("disc.load.speed", 1.0);
    assert!(own.len() > 20, "{own:?}");
    for (path, per_speed) in [("disc.load.speed_hz", hertz), ("disc.load.speed_rpm", 60.0 * hertz)]
    {
        let other = speeds(path, per_speed);
        assert_eq!(other.len(), own.len(), "{path}");
        assert!(own.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-12), "{path}: {other:?}");
    }
}

#[test]
fn numbers_set_one_by_one_are_those_of_the_file() {
    let study = good(&format!("{PLATE}{DITHER}"));
    let at = |path, value| {
        study.setup_at(&study.model().numbers(&[(path, value)]).expect("a number of the study"))
    };
    for (path, value) in [
        ("disc.load.speed", 0.7),
        ("disc.load.friction", 0.2),
        ("dither.amplitude", 0.3),
        ("disc.nodal_diameters", 3.0),
        ("disc.modal_damping", 1e-3),
    ] {
        let change = Change::parse(&format!("{path}={value:?}"), "--set").expect("a change");
        let read = DiscStudy::parse_in(study.text(), &[change], Path::new("")).expect("valid");
        assert_eq!(at(path, value).expect(path).disc(), read.disc(), "{path}");
    }
    assert!(at("dither.amplitude", 1.5).is_err());
}

#[test]
fn the_answer_of_each_run_is_one_object_with_its_names() {
    let study = good(&format!("{PLATE}{DITHER}"));
    let modes: Json = modes::run(&study).json(&study);
    for name in ["radial", "diameters", "frequency_parameter", "ratio", "shape_at_load"] {
        assert!(modes["modes"][0][name].is_number(), "{name}");
    }
    assert_eq!(modes["critical_mode"]["diameters"], 2);
    let stability = stability::run(&study).expect("finite").json(&study);
    for name in ["verdict", "growth_rate", "growth_rate_error", "frequency"] {
        assert!(!stability[name].is_null(), "{name}");
    }
    let without = PLATE.replace("[disc.load]", "without = [\"follower-force\"]\n[disc.load]");
    let quiet = stability::run(&good(&without)).expect("finite");
    assert!(quiet.changes.is_err() && quiet.growth.rate <= 0.0);
}

/// First-order theory reports R from 3.05 to 6 as clear; by the exact exponents motions grow from 4.4 on.
#[test]
fn a_clear_frequency_is_verified_by_the_exact_equations() {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/which-dither-frequency.toml");
    let text = fs::read_to_string(&path).expect("a study");
    let study = good(&text);
    let question = resonances::ResonancesRequest {
        clear: Some((0.25..=0.9, 2.0..=6.0)),
        ..Default::default()
    };
    let found = resonances::run(&study, question).expect("an answer");
    let clear = found.clear.as_ref().expect("asked");
    let (ratio, _) = clear.suggestion.as_ref().expect("a frequency");
    let verified = clear.verified.expect("exponents");
    assert!(verified.is_clear() && verified.growth.rate < 0.0, "{verified:?}");
    assert!((3.1..4.4).contains(ratio) && *ratio == verified.frequency_ratio, "{ratio}");
    let clear = found.json(&study)["clear"].clone();
    assert_eq!(clear["verified_growth_rate"].as_f64(), Some(verified.growth.rate));
    assert_eq!(clear["verified"]["verdict"], "stable");
    assert_eq!(clear["verified"]["speed"].as_f64(), Some(verified.speed));
    let growth = |ratio: f64, speed: f64| {
        let disc = study.disc().with_frequency_ratio(ratio).expect("valid");
        let disc = disc.at_speed(speed).expect("valid");
        quell_disc::dithered::growth(&disc, Effort::default()).expect("finite").rate
    };
    let largest = |ratio: f64| {
        (0..=1300).map(|k| growth(ratio, 0.25 + 5e-4 * f64::from(k))).fold(f64::MIN, f64::max)
    };
    assert!(largest(*ratio) <= verified.growth.rate + 1e-9, "{}", largest(*ratio));
    assert!(largest(4.523_287) > 1e-3);
    // A single frequency is also an interval, and the answer reports growth there.
    let asked = |ratio: f64| {
        let clear = Some((0.25..=0.9, ratio..=ratio));
        let question = resonances::ResonancesRequest { clear, ..Default::default() };
        resonances::run(&study, question).expect("an answer").json(&study)["clear"].clone()
    };
    for (ratio, verdict) in [(*ratio, "stable"), (4.523_287, "unstable")] {
        let answer = asked(ratio);
        assert_eq!(answer["suggestion"].as_f64(), Some(ratio));
        assert_eq!(answer["verified"]["verdict"], verdict, "{answer}");
        let rate = answer["verified"]["growth_rate"].as_f64();
        assert_eq!(rate.map(|rate| rate > 0.0), Some(verdict == "unstable"));
    }
}

/// Figure 5.9 at f = 1.7·10⁻⁴: near the fourth speed of table 5.2 three waves grow together. No pair of waves does at first order, which
/// the answer says, and the exact growth is on the same page; a dither frequency is not called clear there.
#[test]
fn a_tongue_of_three_waves_is_found_exactly() {
    let text = fs::read_to_string(
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/figure-5.9.toml"),
    )
    .expect("a study");
    let change = Change::parse("disc.load.friction=0.7215", "--set").expect("a change");
    let study = DiscStudy::parse_in(&text, &[change], Path::new("")).expect("valid");
    let found =
        resonances::run(&study, resonances::ResonancesRequest::default()).expect("one load");
    let json = found.json(&study);
    let fourth = &json["dithered"][3];
    assert!((fourth["speed"].as_f64().expect("a speed") - 0.5358).abs() < 1e-4);
    assert_eq!(fourth["pair_can_be_unstable"], false);
    assert!(fourth["why"]["threshold"].as_str().expect("why").contains("at this order"));
    let growing = json["growing"].as_array().expect("a list");
    let inside = |item: &&Json| {
        let end = |name: &str| item[name].as_f64().expect("a speed");
        (end("from")..end("to")).contains(&0.553)
    };
    let three = growing.iter().find(inside).expect("the fourth");
    let peak = ["peak_speed", "peak_growth"].map(|name| three[name].as_f64().expect("a number"));
    assert_eq!(three["explained_by"], "none");
    assert!(three["why"]["pair"].as_str().expect("why").contains("three waves or more"));
    assert!(growing.iter().filter(|item| item["explained_by"] != "none").count() >= 3, "{json}");
    // Between the intervals nothing grows, and within them something does.
    let growth = |speed: f64| {
        let disc = study.disc().at_speed(speed).expect("valid");
        quell_disc::dithered::growth(&disc, Effort::default()).expect("finite")
    };
    assert!((growth(0.553).rate / 3.676e-4 - 1.0).abs() < 1e-3, "{:?}", growth(0.553));
    assert!((growth(peak[0]).rate / peak[1] - 1.0).abs() < 1e-6 && peak[1] > 3.676e-4, "{three}");
    for k in 1..400 {
        let speed = f64::from(k) / 400.0;
        let end = |item: &Json, name: &str| item[name].as_f64().expect("a speed");
        let within =
            growing.iter().any(|item| end(item, "from") < speed && speed < end(item, "to"));
        let found = growth(speed);
        assert!(within == (found.rate > found.error), "Ω = {speed}: {found:?}");
    }
    let outcome = Answered::new(&study, found);
    let words = outcome.text();
    assert!(
        words.contains("no tongue at first order") && !words.contains("cannot be unstable"),
        "{words}"
    );
    assert!(
        words.contains("three waves or more grow together; the nearest meeting is at 0.5357"),
        "{words}"
    );
    // At first order R = 2.7 is clear of these speeds; exactly it is not, and no frequency is said to be that was found to grow.
    let question = resonances::ResonancesRequest {
        clear: Some((0.545..=0.56, 2.69..=2.71)),
        ..Default::default()
    };
    let found = resonances::run(&study, question).expect("an answer");
    let json = found.json(&study)["clear"].clone();
    assert!(!json["clear"].as_array().expect("intervals").is_empty(), "{json}");
    assert_eq!(json["verified"]["verdict"], "unstable", "{json}");
    assert!(
        json["tested"].as_array().expect("tested").iter().all(|item| item["verdict"] == "unstable"),
        "{json}"
    );
    let words = Answered::new(&study, found).text();
    assert!(words.contains("at first order") && words.contains("exactly, 0 of"), "{words}");
}
