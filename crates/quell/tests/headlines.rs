//! First sentences against the tables and the JSON that follow them.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::sync::atomic::AtomicBool;

use quell::Study;
use quell::outcome::{Outcome, named};
use quell::record::RecordRequest;
use quell::run::decay::{self, DecayRequest};
use quell::run::record_fit::{self, RecordFitRequest};
use quell::run::response::ResponseRequest;
use quell::run::thresholds::ThresholdsRequest;
use quell::study::Change;
use quell::verbs::verbs;
use quell_numerics::interval::RealInterval;
use quell_numerics::random::SplitMix;
use serde_json::Value as Json;

/// The answer of `design`.
fn facts(text: &str) -> Json {
    let study = Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    let found = verbs(&study).design().unwrap_or_else(|why| panic!("{why}"));
    named(found.as_ref(), found.facts())
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} should be a number"))
}

fn words(value: &Json) -> &str {
    value.as_str().unwrap_or_else(|| panic!("{value} should be words"))
}

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|wrong| panic!("{wrong}\n{text}"))
}

fn belt(direction: &str, frequency_ratio: f64, law: &str) -> String {
    format!(
        "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n[friction]\n{law}\n[dither]\n\
         direction = \"{direction}\"\nwaveform = \"sine\"\namplitude = 0.4\nfrequency_ratio = {frequency_ratio:?}\n"
    )
}

const STRIBECK: &str = "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2";

/// The rows of a comparison, the least exact amplitude, and that the sentence and the marks are about it.
fn ranked_exactly(facts: &Json) -> (usize, f64) {
    let rows = facts["waveforms"].as_array().expect("rows");
    assert_eq!(facts["ranked_by"], "exact");
    for column in ["amplitude", "root_mean_square", "power", "stroke", "velocity"] {
        let key = format!("exact_{column}");
        let known = rows.iter().enumerate().filter_map(|(row, of)| Some((row, of[&key].as_f64()?)));
        let least = known.min_by(|a, b| a.1.total_cmp(&b.1));
        match least {
            Some((row, _)) => assert_eq!(facts["best"][column], rows[row]["label"], "{facts}"),
            None => assert!(facts["best"][column].is_null(), "{facts}"),
        }
    }
    let known = rows.iter().enumerate();
    let known = known.filter_map(|(row, of)| Some((row, of["exact_amplitude"].as_f64()?)));
    let (row, least) = known.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a row");
    let sentence = words(&facts["sentence"]);
    assert!(sentence.contains(words(&rows[row]["label"])), "{sentence}");
    for other in rows.iter().filter(|other| other["exact_amplitude"].is_null()) {
        let label = format!("a {}", words(&other["label"]));
        assert!(!sentence.contains(&format!("{label} ")), "{label}: {sentence}");
    }
    (row, least)
}

/// Averaging has the least amplitude with the shortest burst; at R = 20 and 12 it needs more than others, or repeats in the band.
#[test]
fn waveforms_are_ranked_by_exact_amplitudes() {
    for ratio in [20.0, 12.0] {
        let facts = verbs(&study(&belt("tangential", ratio, STRIBECK)))
            .waveforms()
            .expect("a comparison")
            .facts();
        let rows = facts["waveforms"].as_array().expect("rows");
        let (row, least) = ranked_exactly(&facts);
        let averaged = rows.iter().map(|row| number(&row["amplitude"]));
        let of_averaging = averaged.fold(f64::INFINITY, f64::min);
        assert!(least > of_averaging, "averaging praises another one: {facts}");
        // Costs are those at the exact amplitude: the power with its square.
        let ratio = least / number(&rows[row]["amplitude"]);
        let power = number(&rows[row]["exact_power"]) / number(&rows[row]["power"]);
        assert!((power / (ratio * ratio) - 1.0).abs() < 1e-12);
    }
    // As a system.
    let text = "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.02]\nstiffness = [1.0]\n[[contact]]\nname = \"belt\"\n\
                tangent = { x = 1.0 }\nnormal_load = 1.0\nbelt_velocity = 0.1\n[contact.friction]\nlaw = \"stribeck\"\n\
                static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[[dither]]\nat = { x = 1.0 }\n\
                waveform = \"sine\"\namplitude = 1.5\nfrequency = 12.0\n";
    ranked_exactly(&verbs(&study(text)).waveforms().expect("a comparison").facts());
}

/// Exact amplitudes of normal dither close to the load, where averaging in the limit R → ∞ would open the contact, are the thresholds.
#[test]
fn exact_amplitudes_close_to_the_load_are_thresholds() {
    let mut found = 0;
    for velocity in [0.13, 0.17, 0.175, 0.18] {
        let law = "law = \"decreasing\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.5";
        let text = belt("normal", 2.2, law)
            .replace("belt_velocity = 0.05", &format!("belt_velocity = {velocity}"));
        let study = study(&text);
        let facts = verbs(&study).waveforms().expect("a comparison").facts();
        let sine = &facts["waveforms"][0];
        let request = ThresholdsRequest {
            parameter: "dither.amplitude".to_owned(),
            window: RealInterval::new(0.02, 0.999),
            ..ThresholdsRequest::default()
        };
        let thresholds = verbs(&study).thresholds(&request).expect("thresholds").facts();
        let local = thresholds["local"].as_array().expect("a list");
        let stable = local.iter().filter(|row| row["becomes"] == "stable");
        let least = stable.map(|row| number(&row["value"])).fold(f64::INFINITY, f64::min);
        match sine["exact_amplitude"].as_f64() {
            Some(exact) => {
                assert!((exact / least - 1.0).abs() < 1e-6, "{velocity}: {exact} {least}");
            }
            None => assert!(least.is_infinite(), "{velocity}: {least} {facts}"),
        }
        found += u32::from(least.is_finite() && least > 0.85);
    }
    assert!(found > 0, "no case is close to the load");
}

/// A pad of 0.1 kg on 370 N/µm whose stack can drive it near its resonance at 9.68 kHz alone.
fn pad((from, to): (f64, f64), current: f64) -> String {
    format!(
        "[belt]\nmass_kg = 0.1\nstiffness_n_per_m = 370e6\ndamping_ratio = 0.005\nnormal_force_n = 1500.0\n\
         belt_velocity_m_per_s = 0.2\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.3996\nminimum_coefficient = 0.2855\n\
         reference_velocity_m_per_s = 0.5064\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude_n = 200.0\n\
         frequency_hz = 16000.0\n[actuator]\nkind = \"piezo\"\nblocked_force_n = 7000.0\ncapacitance_f = 2.1e-6\n\
         maximum_voltage = 150.0\nmaximum_current = {current:?}\n[design]\nminimise = \"amplitude\"\n\
         vary = [\"dither.amplitude_n\", \"dither.frequency_hz\"]\nfrom = [10.0, {from:?}]\nto = [3500.0, {to:?}]\n[design.over]\n\
         \"belt.belt_velocity_m_per_s\" = [0.05, 0.2]\n"
    )
}

/// The natural frequency of the pad.
fn natural() -> f64 {
    (370e6_f64 / 0.1).sqrt() / TAU
}

/// Near the resonance a small dither is followed in step, and a tone replaces the squeal: it is not called quiet.
#[test]
fn a_dither_in_the_band_of_the_vibration_is_not_called_quiet() {
    let facts = facts(&pad((13000.0, 40000.0), 5.0));
    assert_eq!((&facts["feasible"], &facts["quiet"]), (&true.into(), &false.into()));
    let first = words(&facts["sentence"]).split(". ").next().expect("a sentence");
    assert!(!first.contains("quiet"), "{first}");
    let (residual, level) = (number(&facts["residual_vibration"]), number(&facts["level_db"]));
    assert!(residual > 0.5, "{facts}");
    assert!((level - 20.0 * residual.log10()).abs() < 1e-9);
    let percent = 100.0 * residual;
    let percent =
        if percent < 100.0 { format!("{percent:.2} %") } else { format!("{percent:.0} %") };
    assert!(first.contains(&format!("residual vibration of {percent}")), "{first}");
    assert!(
        first.contains(&format!("({level:.1} dB)"))
            && facts["notes"].to_string().contains("a tone at 13"),
        "{first}"
    );
    assert!((number(&facts["tone_frequency"]) / (13000.0 * TAU) - 1.0).abs() < 0.01, "{facts}");
    // The response to that dither, from its own verb.
    let point = number(&facts["worst"]["belt.belt_velocity_m_per_s"]);
    let amplitude = number(&facts["parameters"]["dither.amplitude_n"]);
    let at = |path: &str, value: f64| {
        Change::parse(&format!("{path}={value:?}"), "--set").expect("a change")
    };
    let sets = [
        at("belt.belt_velocity_m_per_s", point),
        at("dither.amplitude_n", amplitude),
        at("dither.frequency_hz", 13000.0),
    ];
    let study = Study::parse(&pad((13000.0, 40000.0), 5.0), &sets).expect("valid");
    let response = verbs(&study).response(&ResponseRequest::default()).expect("a response").facts();
    assert!(residual >= number(&response["residual_vibration"]) * 0.999, "{facts} {response}");
}

/// A dither that serves a part of the box and repeats in the band of the vibration says what it leaves there, and the end of that part is a
/// point that was found loud.
#[test]
fn a_slow_dither_for_a_part_of_the_box_says_what_it_leaves() {
    let facts = facts(&pad((13000.0, 40000.0), 2.0));
    assert_eq!((&facts["feasible"], &facts["quiet"]), (&false.into(), &false.into()), "{facts}");
    let sentence = words(&facts["sentence"]);
    assert!(
        sentence.contains("the motion stays in step") && !sentence.contains("suffices"),
        "{sentence}"
    );
    let residual = number(&facts["residual_vibration"]);
    assert!(residual > 0.5 && sentence.contains("a residual vibration of"), "{facts}");
    assert_eq!(
        (&facts["examined"]["below"], &facts["examined"]["above"]),
        (&"loud".into(), &"loud".into())
    );
    let warned = facts["warnings"].as_array().expect("a list").iter();
    assert!(warned.map(words).any(|warning| warning.contains("vibrates slowly")), "{facts}");
}

/// Of dithers that are allowed, one above the band of the vibration is chosen.
#[test]
fn a_dither_above_the_band_is_preferred() {
    let facts = facts(&pad((13000.0, 40000.0), 40.0));
    assert_eq!((&facts["feasible"], &facts["quiet"]), (&true.into(), &true.into()), "{facts}");
    assert!(number(&facts["parameters"]["dither.frequency_hz"]) > 1.9 * natural(), "{facts}");
    assert_eq!(number(&facts["residual_vibration"]), 0.0);
    assert!(words(&facts["sentence"]).starts_with("The least dither that is quiet"), "{facts}");
}

/// A pad that carries the actuator on a small mass, whose natural frequency is far above that of the vibration.
fn pad_with_stack(blocked_force: f64) -> String {
    format!(
        "[system]\ncoordinates = [\"pad\", \"stack\"]\nmass = [1.0, 0.01]\ndamping = [[0.002, -0.001], [-0.001, 0.001]]\n\
         stiffness = [[1.25, -0.25], [-0.25, 0.25]]\n[[contact]]\nname = \"belt\"\ntangent = {{ pad = 1.0 }}\nnormal_load = 1.0\n\
         belt_velocity = 0.1\n[contact.friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\n\
         reference_velocity = 0.2\n[[dither]]\nat = {{ stack = 1.0 }}\nwaveform = \"sine\"\namplitude = 0.1\nfrequency = 8.0\n\
         [actuator]\nkind = \"piezo\"\nblocked_force = {blocked_force}\nstiffness = 0.25\ncapacitance = 1e-6\n\
         maximum_voltage = 100.0\n"
    )
}

/// The largest margin is that of the best row, at the ends of the range, at changes of the limit and at resonances too.
#[test]
fn the_largest_margin_is_the_largest_of_its_rows() {
    let belts = [((9800.0, 40000.0), 5.0), ((9000.0, 30000.0), 15.0)].map(|(range, current)| {
        (pad(range, current), RealInterval::new(TAU * range.0, TAU * range.1))
    });
    let systems = [0.05, 0.1].map(|force| (pad_with_stack(force), RealInterval::new(3.0, 12.0)));
    let mut narrow = 0;
    for (text, range) in belts.into_iter().chain(systems) {
        let found = verbs(&study(&text)).actuator(Some(range)).expect("an actuator");
        let facts = found.facts();
        // Without a number where an undamped resonance makes it unbounded.
        let best = facts["best"]["margin"].as_f64().unwrap_or(f64::INFINITY);
        let bands = facts["sufficient"].as_array().expect("a list");
        let margins = bands.iter().map(|band| &band["best"]["margin"]);
        let resonances = facts["resonances"].as_array().expect("a list");
        let margins = margins.chain(resonances.iter().map(|resonance| &resonance["margin"]));
        for margin in margins.filter_map(Json::as_f64) {
            assert!(best >= margin, "{margin} exceeds {best}: {facts}");
        }
        for band in bands {
            let is_narrow = number(&band["to"]) / number(&band["from"]) < 1.02;
            assert_eq!(band["narrow"], is_narrow, "{facts}");
            narrow += usize::from(is_narrow);
            let sentence = words(&facts["sentence"]);
            assert_eq!(
                sentence.contains("narrow window"),
                bands.iter().any(|band| band["narrow"] == true),
                "{sentence}"
            );
        }
    }
    assert!(narrow >= 1, "no window is narrow");
}

/// Averaging does not hold of a dither that repeats in the band of the vibration, and the headline says so; at the natural frequency,
/// where an undamped average needs nothing, the margin has no number.
#[test]
fn averages_in_the_band_of_the_vibration_are_named() {
    let range = RealInterval::new(TAU * 7000.0, TAU * 12000.0);
    let found = verbs(&study(&pad((7000.0, 12000.0), 15.0))).actuator(Some(range));
    let facts = found.expect("an actuator").facts();
    assert!(words(&facts["sentence"]).contains("which does not hold below"), "{facts}");
    for row in facts["sufficient"].as_array().expect("a list") {
        assert!(row["best"]["margin"].as_f64().is_none_or(|margin| margin < 1e9), "{facts}");
    }
}

/// A record of noise, which no motion explains, has estimates without standard errors.
#[test]
fn a_fit_that_explains_little_has_no_standard_errors() {
    let mut random = SplitMix::new(7);
    let mut text = "time_s,displacement_m\n".to_owned();
    for k in 0..400 {
        let _ = writeln!(text, "{:?},{:?}", 0.01 * f64::from(k), 1e-4 * (random.share() - 0.5));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("noise.csv");
    std::fs::write(&path, text).expect("a file");
    let study = study(
        "[belt]\nmass_kg = 0.03\nstiffness_n_per_m = 1000.0\ndamping_ratio = 0.01\nnormal_force_n = 0.3\n\
         belt_velocity_m_per_s = 0.001\n[friction]\nlaw = \"coulomb\"\ncoefficient = 0.33\nstatic_coefficient = 0.45\n",
    );
    let request = RecordFitRequest {
        record: RecordRequest::default(),
        free: vec!["friction.coefficient".to_owned(), "record.offset".to_owned()],
        fix: Vec::new(),
        settle: None,
    };
    let done = record_fit::run(&study, &path, &request, &AtomicBool::new(false)).expect("a fit");
    let facts = done.json();
    let share = number(&facts["explained"]);
    assert!(share < 0.5, "{facts}");
    for name in ["friction.coefficient", "record.offset"] {
        assert!(facts["parameters"][name]["standard_error"].is_null(), "{facts}");
    }
    let sentence = words(&facts["sentence"]);
    assert!(
        sentence.contains("does not explain the record") && !sentence.contains('±'),
        "{sentence}"
    );
    assert_eq!(facts["tables"]["uncertainty"], "");
    // A decay too.
    let request = DecayRequest::new(RecordRequest::default(), &["viscous".to_owned()], &[]);
    let found = decay::run(&path, &request.expect("valid"));
    if let Ok(found) = found {
        let facts = found.json();
        let is_explained = number(&facts["explained"]) >= 0.5;
        assert_eq!(
            words(&facts["sentence"]).contains("does not explain"),
            !is_explained,
            "{facts}"
        );
    }
}

/// A mass on a belt of constant friction, shaken at 0.9 of its natural frequency: it is quiet without the dither alone.
#[test]
fn a_forced_vibration_is_not_quiet() {
    let text = "[system]\ncoordinates = [\"q\"]\nmass = [1.0]\ndamping = [[0.02]]\nstiffness = [[1.0]]\n[[contact]]\nname = \"rub\"\n\
                tangent = { q = 1.0 }\nnormal_load = 0.3\nbelt_velocity = 0.05\n[contact.friction]\nlaw = \"coulomb\"\ncoefficient = 1.0\n\
                [[dither]]\nat = { q = 1.0 }\nwaveform = \"sine\"\namplitude = 1.5\nfrequency = 0.9\n";
    let facts =
        verbs(&study(text)).response(&ResponseRequest::default()).expect("a response").facts();
    assert_eq!(facts["effect"], "causes", "{facts}");
    let (amplitude, half) = (number(&facts["amplitude"]), number(&facts["half_peak_to_peak"]));
    assert!(amplitude > 0.9 * half && half > 7.0, "{facts}");
    // At ten times the natural frequency it is followed in step, above the band.
    let fast = text.replace("frequency = 0.9", "frequency = 10.0");
    let facts =
        verbs(&study(&fast)).response(&ResponseRequest::default()).expect("a response").facts();
    assert_eq!(facts["effect"], "quiet", "{facts}");
}
