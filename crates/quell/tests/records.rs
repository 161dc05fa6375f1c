//! Records: fits of decays and of studies with planted numbers, comparisons, and what cannot be compared.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use quell::outcome::{ComparedStudy, Outcome};
use quell::record::RecordRequest;
use quell::run::compare::{self, CompareRequest};
use quell::run::decay::{self, DecayRequest};
use quell::run::record_fit::{self, RecordFit, RecordFitRequest};
use quell::{Failure, Study};
use quell_numerics::random::SplitMix;
use serde_json::Value as Json;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn studies() -> PathBuf {
    root().join("studies")
}

fn measured_belt() -> Study {
    Study::read(&studies().join("measured-belt.toml"), &[]).expect("valid")
}

/// A file in a folder of its own for this process.
fn file(name: &str, header: &str, times: &[f64], values: &[f64]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("quell-records-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut text = format!("{header}\n");
    for (time, value) in times.iter().zip(values) {
        let _ = writeln!(text, "{time:?},{value:?}");
    }
    let path = folder.join(name);
    std::fs::write(&path, text).expect("written");
    path
}

fn stored() -> Json {
    let text = std::fs::read_to_string(root().join("reference/records.json")).expect("a file");
    serde_json::from_str(&text).expect("JSON")
}

fn numbers(json: &Json) -> Vec<f64> {
    json.as_array().expect("a list").iter().map(|one| one.as_f64().expect("a number")).collect()
}

fn fit(study: &Study, path: &Path, free: &[&str], fix: &[&str]) -> Result<RecordFit, Failure> {
    let listed = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    let request = RecordFitRequest {
        record: RecordRequest::default(),
        free: listed(free),
        fix: listed(fix),
        settle: None,
    };
    record_fit::run(study, path, &request, &AtomicBool::new(false))
}

fn compared(study: &Study, measured: &Path, after: Option<&Path>) -> Result<Json, Failure> {
    let request = CompareRequest {
        measured: measured.to_owned(),
        after: after.map(Path::to_owned),
        record: RecordRequest::default(),
        settle: None,
    };
    let done = compare::run(study, &request)?;
    Ok(ComparedStudy { study: study.clone(), done }.json())
}

/// The decay without noise that another program computed: every parameter to the digits of the data.
#[test]
fn the_stored_decay_is_recovered() {
    let planted = &stored()["decay"];
    let (times, values) = (numbers(&planted["times"]), numbers(&planted["values"]));
    // Every 25th sample is 20 a second, too few for 12.5 Hz: the test is of the motion, not of the search.
    let number = |name: &str| planted[name].as_f64().expect("a number");
    let vibration = quell_design::decay::FreeVibration {
        angular_frequency: std::f64::consts::TAU * number("natural_frequency_hz"),
        damping_ratio: number("damping_ratio"),
        friction: number("friction"),
        displacement: number("displacement"),
        velocity: number("velocity"),
        offset: 0.0,
    };
    let quantity = quell_model::RecordedQuantity::Displacement;
    let found = quell_design::decay::readings(&vibration, quantity, &times, true).values;
    for (own, stored) in found.iter().zip(&values) {
        assert!((own - stored).abs() < 1e-14, "{own} {stored}");
    }
}

/// The synthetic record of the studies: the law and every parameter within three standard errors of what was planted.
#[test]
fn the_synthetic_decay_gives_its_planted_numbers() {
    let request = DecayRequest::new(RecordRequest::default(), &[], &[]).expect("valid");
    let done = decay::run(&studies().join("synthetic-decay.csv"), &request).expect("a decay");
    assert_eq!(done.best().law.name(), "viscous-coulomb");
    let named = done.named(done.best());
    let planted = [12.5, 0.004, 40e-6, 2e-3, 0.03, 1e-5];
    for (place, truth) in planted.into_iter().enumerate() {
        let error = named.error(place).expect("determined");
        let z = (named.value(place) - truth) / error;
        assert!(z.abs() < 3.0, "{}: {z}", named.parameters[place].name);
    }
    let json = done.json();
    assert_eq!(json["parameters"]["natural_frequency"]["value"], named.value(0));
    assert_eq!(json["units"]["natural_frequency"], "Hz");
    let uncertainty = json["tables"]["uncertainty"].as_str().expect("a table");
    assert!(uncertainty.contains("belt.natural_frequency_hz"), "{uncertainty}");
}

/// The exact motion of Quell is that of the program that made the record; then the fit recovers numbers that differ from the study's.
#[test]
fn a_squealing_record_gives_its_planted_numbers() {
    let stored = &stored()["squeal"];
    let (times, values) = (numbers(&stored["times"]), numbers(&stored["velocities"]));
    let path = file("squeal.csv", "time_s,velocity_m_per_s", &times, &values);
    let free = ["belt.damping_ratio", "friction.static_coefficient", "record.shift"];
    let fixed = ["dither.amplitude_n=0", "friction.reference_velocity_m_per_s=0.06"];
    let done = fit(&measured_belt(), &path, &free, &fixed).expect("a fit");
    assert!(done.converged && done.from_highest);
    // Order 4 with 2000 steps a period has an error of 10⁻⁹ of the velocity.
    for (place, truth) in [(0, 0.006), (1, 0.42)] {
        let value = done.named.value(place);
        assert!((value / truth - 1.0).abs() < 1e-5, "{place}: {value}");
    }
    let largest = done.residuals().iter().fold(0.0_f64, |m, r| m.max(r.abs()));
    assert!(largest < 1e-7, "{largest}");
}

/// With noise: within four standard errors, from a study that is off by 5 and 7 %. The two coefficients are nearly one combination.
#[test]
fn a_noisy_record_gives_its_planted_numbers_within_their_errors() {
    let path = studies().join("synthetic-squeal.csv");
    let free =
        ["friction.static_coefficient", "friction.reference_velocity_m_per_s", "record.shift"];
    let fixed = ["dither.amplitude_n=0", "belt.damping_ratio=0.006"];
    let done = fit(&measured_belt(), &path, &free, &fixed).expect("a fit");
    assert!(done.converged && !done.named.estimates.weak.is_empty());
    for (place, truth) in [(0, 0.42), (1, 0.06)] {
        let error = done.named.error(place).expect("determined");
        let z = (done.named.value(place) - truth) / error;
        assert!(z.abs() < 4.0, "{}: {z} of {error}", done.named.parameters[place].name);
    }
    assert!((done.named.estimates.residual() / 3e-4 - 1.0).abs() < 0.1);
    // What the answer offers is a valid study.
    let (numbers, uncertainty) = done.fragments();
    assert!(numbers.contains("[friction]\nstatic_coefficient = "), "{numbers}");
    assert!(uncertainty.contains("friction.reference_velocity_m_per_s"), "{uncertainty}");
    let text = format!("{}\n{uncertainty}", measured_belt().text());
    Study::parse(&text, &[]).expect("the table of the uncertainty is valid");
}

/// A transient of a system with two masses, displacement of one: stiffness, damping and start, without a shift.
#[test]
fn a_system_is_fitted_from_its_start() {
    let text = r#"
        [system]
        coordinates = ["a", "b"]
        mass = [1.0, 0.5]
        stiffness = [[3.0, -1.0], [-1.0, 1.0]]
        damping = [0.02, 0.01]
        observe = { b = 1.0 }
        [system.initial]
        displacements = { a = 0.3, b = -0.2 }
        [[contact]]
        name = "foot"
        tangent = { a = 1.0 }
        normal_load = 0.05
        belt_velocity = 0.1
        [contact.friction]
        law = "coulomb"
        coefficient = 0.5
        static_coefficient = 0.7
    "#;
    let study = Study::parse(text, &[]).expect("valid");
    let motion = quell::verbs::verbs(&study).recorded_motion("test").expect("a motion");
    let times: Vec<f64> = (0..300).map(|k| 0.15 * f64::from(k)).collect();
    let quantity = quell_model::RecordedQuantity::Displacement;
    let (exact, _) = motion.readings(quantity, &times).expect("readings");
    let mut random = SplitMix::new(4);
    let noisy: Vec<f64> = exact.iter().map(|y| y + 0.002 * random.normal()).collect();
    let path = file("system.csv", "time,displacement", &times, &noisy);
    let free = ["system.mass[1]=0.45", "contact.foot.friction.coefficient=0.4", "record.offset"];
    let done = fit(&study, &path, &free, &[]).expect("a fit");
    assert!(!done.from_highest);
    for (place, truth) in [(0, 0.5), (1, 0.5), (2, 0.0)] {
        let error = done.named.error(place).expect("determined");
        assert!(((done.named.value(place) - truth) / error).abs() < 4.0, "{place}");
    }
}

/// Two numbers that a record knows only as a product: the load and the coefficients. The combination is named, and neither has an error that
/// pretends otherwise.
#[test]
fn what_a_record_cannot_tell_is_named() {
    let stored = &stored()["squeal"];
    let (times, values) = (numbers(&stored["times"]), numbers(&stored["velocities"]));
    let path = file("product.csv", "time_s,velocity_m_per_s", &times, &values);
    let study = Study::read(&studies().join("measured-belt.toml"), &[]).expect("valid");
    let free = [
        "belt.normal_force_n",
        "friction.static_coefficient",
        "friction.minimum_coefficient",
        "record.shift",
    ];
    let fixed = [
        "dither.amplitude_n=0",
        "friction.reference_velocity_m_per_s=0.06",
        "belt.damping_ratio=0.006",
    ];
    let done = fit(&study, &path, &free, &fixed).expect("a fit");
    let weak = &done.named.estimates.weak;
    assert!(!weak.is_empty(), "{:?}", done.named.estimates);
    let places: Vec<usize> = weak[0].shares.iter().map(|(place, _)| *place).collect();
    assert!(places.contains(&0) && (places.contains(&1) || places.contains(&2)), "{weak:?}");
    assert!(done.warnings().iter().any(|text| text.contains("combination")));
}

#[test]
fn a_fit_without_numbers_or_with_unknown_ones_is_refused() {
    let path = studies().join("synthetic-squeal.csv");
    let said =
        |free: &[&str]| fit(&measured_belt(), &path, free, &[]).expect_err("refused").to_string();
    assert!(said(&[]).contains("--free"));
    assert!(said(&["belt.dampingratio"]).contains("damping_ratio"));
    assert!(said(&["belt.damping_ratio=x"]).contains("NAME=START"));
    assert!(said(&["record.shift", "record.shift"]).contains("once"));
    let dimensionless = Study::read(&studies().join("stribeck-belt.toml"), &[]).expect("valid");
    let why = fit(&dimensionless, &path, &["belt.damping_ratio"], &[]).expect_err("no seconds");
    assert!(why.to_string().contains("no seconds"), "{why}");
}

/// A record computed from the study itself: every line and the level agree to the noise of the window, and the reduction is the predicted one.
#[test]
fn a_record_of_the_study_itself_has_no_difference() {
    let study = measured_belt();
    let motion = quell::verbs::verbs(&study).recorded_motion("test").expect("a motion");
    let quiet = quell::run::recorded_motion::ObservedMotion {
        system: motion.system.undithered(),
        ..motion.clone()
    };
    let count = 8000;
    let times: Vec<f64> = (0..count).map(|k| 0.00025 * f64::from(k)).collect();
    let rate = motion.scales.second.expect("in SI");
    let settled = 200.0 * motion.period.expect("it oscillates");
    let at: Vec<f64> = times.iter().map(|t| t.mul_add(rate, settled)).collect();
    let quantity = quell_model::RecordedQuantity::Velocity;
    let path = |name: &str, motion: &quell::run::recorded_motion::ObservedMotion| {
        let (values, _) = motion.readings(quantity, &at).expect("readings");
        let values: Vec<f64> = values.iter().map(|v| v * rate).collect();
        file(name, "time_s,velocity_m_per_s", &times, &values)
    };
    let (before, after) = (path("before.csv", &quiet), path("after.csv", &motion));
    let found = compared(&study, &before, Some(&after)).expect("a comparison");
    for record in [&found["before"], &found["after"]] {
        let difference = record["difference"].as_f64().expect("a level");
        assert!(difference.abs() < 1e-6, "{difference}");
        for line in record["lines"].as_array().expect("lines") {
            let difference = line["difference"].as_f64().expect("a pair");
            assert!(difference.abs() < 1e-4, "{line}");
        }
    }
    let reduction = &found["slow_reduction"];
    assert!(reduction["difference"].as_f64().expect("a number").abs() < 1e-4, "{reduction}");
    assert!(reduction["predicted"].as_f64().expect("a number") > 20.0, "{reduction}");
    // A gain of two is 6.02 dB in every line.
    let request = CompareRequest {
        measured: before,
        after: None,
        record: RecordRequest { gain: 2.0, ..RecordRequest::default() },
        settle: None,
    };
    let quiet = study.with("dither.amplitude_n", 0.0).expect("valid");
    let done = compare::run(&quiet, &request).expect("a comparison");
    assert!(
        (compare::decibels(done.before.rms[0] / done.before.rms[1]) - 6.020_599_9).abs() < 1e-5
    );
}

/// The synthetic records: squeal at 40 Hz is seen in both, and the dither quiets what is measured by what the study predicts within 3 dB.
#[test]
fn synthetic_records_are_compared_before_and_after() {
    let study = measured_belt();
    let before = studies().join("synthetic-squeal.csv");
    let after = studies().join("synthetic-quenched.csv");
    let found = compared(&study, &before, Some(&after)).expect("a comparison");
    let strongest = |record: &Json| {
        let lines = record["lines"].as_array().expect("lines").clone();
        let level = |line: &Json| line["measured"].as_f64().unwrap_or(f64::NEG_INFINITY);
        lines.into_iter().max_by(|a, b| level(a).total_cmp(&level(b))).expect("a line")
    };
    let line = strongest(&found["before"]);
    assert!((line["frequency"].as_f64().expect("a frequency") - 40.0).abs() < 3.0, "{line}");
    let dither = strongest(&found["after"]);
    assert!((dither["frequency"].as_f64().expect("a frequency") - 500.0).abs() < 1.0, "{dither}");
    assert!(dither["difference"].as_f64().expect("a pair").abs() < 1.0, "{dither}");
}

#[test]
fn what_cannot_be_compared_is_stated() {
    let study = measured_belt();
    let text = std::fs::read_to_string(studies().join("synthetic-quenched.csv")).expect("a file");
    let rows: Vec<(f64, f64)> = text
        .lines()
        .filter_map(|line| {
            let (time, value) = line.split_once(',')?;
            Some((time.parse().ok()?, value.parse().ok()?))
        })
        .collect();
    let (times, values): (Vec<f64>, Vec<f64>) = rows.iter().step_by(8).copied().unzip();
    let coarse = file("coarse.csv", "time_s,velocity_m_per_s", &times, &values);
    let found = compared(&study, &coarse, None).expect("a comparison");
    let stated = found["before"]["not_comparable"].to_string();
    assert!(stated.contains("half of its sampling rate"), "{stated}");
    let (times, values): (Vec<f64>, Vec<f64>) = rows.iter().take(40).copied().unzip();
    let short = file("short.csv", "time_s,velocity_m_per_s", &times, &values);
    let found = compared(&study, &short, None).expect("a comparison");
    assert!(found["before"]["not_comparable"].to_string().contains("periods"), "{found}");
    let (mut times, values): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
    times.iter_mut().skip(500).for_each(|time| *time += 0.1);
    let gap = file("gap.csv", "time_s,velocity_m_per_s", &times, &values);
    let why = compared(&study, &gap, None).expect_err("a gap").to_string();
    assert!(why.contains("gap") && why.contains("line 501"), "{why}");
    let quiet = study.with("dither.amplitude_n", 0.0).expect("valid");
    let both = compared(&quiet, &coarse, Some(&coarse)).expect_err("no dither").to_string();
    assert!(both.contains("--after"), "{both}");
}
