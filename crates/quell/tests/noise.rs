//! Noise: what a study says about it, its runs, its averages, and the share of seeds that quench.

use quell::Study;
use quell::run::noise_response::{self, NoiseResponse};
use quell::run::response::ResponseRequest;
use quell::run::simulate::{self, MotionRequest};
use quell::study::{BeltStudy, SystemStudy};
use quell::verbs::verbs;
use quell_linear::averaging::{Averaging, FastMotion, critical_amplitudes};
use quell_model::Waveform;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

const BELT: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
    static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n";

fn with_noise(amplitude: f64, keys: &str) -> String {
    format!(
        "{BELT}[dither]\ndirection = \"tangential\"\nwaveform = \"noise\"\namplitude = {amplitude:?}\n{keys}\n\
         [solver]\nsettle = 300\nrecord_periods = 30\n"
    )
}

const BAND: &str = "band = [8.0, 12.0]";

fn study(text: &str) -> BeltStudy {
    BeltStudy::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

/// Keys and texts of all complaints about a study.
fn refused(text: &str) -> String {
    let wrong = Study::parse(text, &[]).map(|_| ()).expect_err(text);
    wrong.iter().map(|one| format!("{}: {}", one.key, one.allowed)).collect::<Vec<_>>().join("\n")
}

#[test]
fn keys_of_noise() {
    let given = study(&with_noise(1.5, "band = [8.0, 12.0]\nlines = 64\nseed = 1"));
    let defaults = study(&with_noise(1.5, BAND));
    assert_eq!(given.belt(), defaults.belt());
    let dither = &given.belt().dithers()[0];
    assert!((dither.frequency_ratio - 10.0).abs() < 1e-15);
    let noise = dither.waveform.noise().expect("noise");
    assert_eq!((noise.lines().len(), noise.seed()), (64, 1));
    // In SI: ω₀ = 5 rad/s, k = 100 N/m.
    let si = BELT
        .replace(
            "damping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1",
            "damping_ratio = 0.005\nmass_kg = 4\n\
            stiffness_n_per_m = 100\nnormal_force_n = 100\nbelt_velocity_m_per_s = 0.5",
        )
        .replace("reference_velocity = 0.2", "reference_velocity_m_per_s = 1.0");
    let hertz = 5.0 / std::f64::consts::TAU;
    let si = study(&format!(
        "{si}[dither]\ndirection = \"tangential\"\nwaveform = \"noise\"\namplitude_n_rms = {:?}\nband_hz = [{:?}, {:?}]\n",
        150.0 / 2f64.sqrt(),
        8.0 * hertz,
        12.0 * hertz
    ));
    let found = &si.belt().dithers()[0];
    assert!((found.amplitude - 1.5).abs() < 1e-14, "{}", found.amplitude);
    let band = found.waveform.noise().expect("noise").band(found.frequency_ratio);
    assert!((band[0] - 8.0).abs() < 1e-13 && (band[1] - 12.0).abs() < 1e-13, "{band:?}");
}

#[test]
fn wrong_keys_are_named() {
    for (keys, key, allowed) in [
        ("band = [12.0, 8.0]", "dither.band", "the second above the first"),
        ("band = [8.0, 8.0]", "dither.band", "the second above the first"),
        ("band = [0.0, 8.0]", "dither.band[0]", "> 0"),
        ("band = [-1.0, 8.0]", "dither.band[0]", "> 0"),
        ("band = 8.0", "dither.band", "array of two"),
        ("lines = 4", "dither.band", "lowest and the highest"),
        ("band = [8.0, 12.0]\nlines = 0", "dither.lines", "from 1 to 1000"),
        ("band = [8.0, 12.0]\nlines = 1001", "dither.lines", "every line is a sine"),
        ("band = [8.0, 12.0]\nlines = 1.5", "dither.lines", "whole number"),
        ("band = [8.0, 12.0]\nseed = 0.5", "dither.seed", "whole number"),
        ("band = [8.0, 12.0]\nseed = -1", "dither.seed", "whole number"),
        ("band = [8.0, 12.0]\nfrequency_ratio = 10", "dither.frequency_ratio", "left out"),
        ("band = [8.0, 12.0]\nphase = 1", "dither.phase", "random phases"),
        ("band = [8.0, 12.0]\nband_hz = [8.0, 12.0]", "dither.band_hz", "not both"),
        ("band_hz = [8.0, 12.0]", "dither.band_hz", "dimensionless"),
    ] {
        let text = refused(&with_noise(1.0, keys));
        assert!(text.contains(&format!("{key}: ")) && text.contains(allowed), "{keys}\n{text}");
    }
    let sine = with_noise(1.0, "band = [8.0, 12.0]\nseed = 3\nfrequency_ratio = 10");
    let text = refused(&sine.replace("\"noise\"", "\"sine\""));
    assert!(text.contains("dither.band: left out: only the waveform \"noise\""), "{text}");
    assert!(text.contains("dither.seed: left out"), "{text}");
    let disc = "[disc]\nradius_ratio = 0.5\npoisson_ratio = 0.3\n[dither]\ndirection = \"normal\"\nwaveform = \"noise\"\n";
    assert!(refused(disc).contains("dither.waveform: periodic"));
    // The load must not vanish when all lines are in phase: √64 D ≤ F.
    let normal = |amplitude: f64| with_noise(amplitude, BAND).replace("tangential", "normal");
    assert!(refused(&normal(0.2)).contains("dither.amplitude: at most the normal load"));
    study(&normal(0.12));
}

/// A system with the numbers of the belt above.
fn system(keys: &str) -> String {
    format!(
        "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.01]\nstiffness = [1.0]\n[[contact]]\nname = \"belt\"\n\
         tangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n[contact.friction]\nlaw = \"stribeck\"\n\
         static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[[dither]]\nat = {{ x = 1.0 }}\n\
         waveform = \"noise\"\namplitude = 0.4\n{keys}\n"
    )
}

/// The end of a run, time of its last event first.
fn end(study: &BeltStudy, until: f64) -> [f64; 2] {
    let system = Study::from(study).system();
    let run = simulate::run(&system, &MotionRequest::to(until)).expect("a run");
    [run.end.state[0], run.end.state[1]]
}

/// Noise is the sum of its lines: the same run as with a dither for each, in both engines.
#[test]
fn noise_is_its_lines() {
    let noisy = study(&with_noise(0.4, "band = [8.0, 12.0]\nlines = 3\nseed = 7"));
    let lines = noisy.belt().dithers()[0].by_harmonics();
    assert_eq!(lines.len(), 3);
    let total: f64 = lines.iter().map(|line| 0.5 * line.amplitude * line.amplitude).sum();
    assert!((total.sqrt() - 0.4 / 2f64.sqrt()).abs() < 1e-15);
    let listed: Vec<String> = lines
        .iter()
        .map(|line| {
            assert_eq!(line.waveform, Waveform::Sine);
            format!(
                "[[dither]]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = {:?}\nfrequency_ratio = {:?}\nphase = {:?}\n",
                line.amplitude, line.frequency_ratio, line.phase
            )
        })
        .collect();
    let sines = study(&format!("{BELT}{}", listed.concat()));
    let as_system =
        SystemStudy::parse(&system("band = [8.0, 12.0]\nlines = 3\nseed = 7"), &[]).expect("valid");
    for until in [5.0, 40.0] {
        let (one, other) = (end(&noisy, until), end(&sines, until));
        assert_eq!(one, other, "τ = {until}");
        let request = MotionRequest::to(until);
        let done = verbs(&Study::from(&as_system)).simulate(&request).expect("a run").json();
        let state = &done["final"];
        let x = state["state"][0].as_f64().or_else(|| state["displacements"][0].as_f64());
        let x = x.unwrap_or_else(|| panic!("{state}"));
        assert!((x - one[0]).abs() < 1e-9, "{x} {one:?}");
    }
}

#[test]
fn one_line_is_a_sine() {
    let noisy = study(&with_noise(0.7, "band = [8.0, 12.0]\nlines = 1\nseed = 11"));
    let line = noisy.belt().dithers()[0].by_harmonics().remove(0);
    assert_eq!(line.amplitude, 0.7);
    let sine = study(&format!(
        "{BELT}[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.7\nfrequency_ratio = {:?}\nphase = {:?}\n",
        line.frequency_ratio, line.phase
    ));
    let (one, other) = (end(&noisy, 60.0), end(&sine, 60.0));
    assert!(
        (one[0] - other[0]).abs() < 1e-9 && (one[1] - other[1]).abs() < 1e-9,
        "{one:?} {other:?}"
    );
}

/// The same seed gives the same bits, another seed another run.
#[test]
fn a_seed_decides_the_run() {
    let of = |seed: u32| end(&study(&with_noise(0.7, &format!("{BAND}\nseed = {seed}"))), 50.0);
    assert_eq!(of(5), of(5));
    assert_ne!(of(5), of(6));
}

#[test]
fn averages_have_answers() {
    let noisy = study(&with_noise(3.0, BAND));
    let curve = verbs(&Study::from(&noisy)).friction(Some(&[0.05, 0.1, 0.0]), false);
    let curve = curve.expect("friction").json();
    let motion = FastMotion::of(noisy.belt(), 0.1, Averaging::Limit).expect("a motion");
    assert!((motion.noise() / (0.3 / 2f64.sqrt()) - 1.0).abs() < 0.05);
    let means = curve["contacts"][0]["effective_coefficient"].as_array().expect("means");
    assert!(means.len() == 3 && means.iter().all(Json::is_number), "{curve}");
    let answer = verbs(&Study::from(&noisy)).stability().expect("a verdict").json();
    assert_eq!(answer["verdict"], "stable");
    assert_eq!(answer["limit"]["verdict"], "stable");
    let warns = |answer: &Json| {
        let warnings = answer["warnings"].as_array().expect("a list").iter();
        warnings.filter_map(Json::as_str).any(|text| text.contains("lines, fewer than 8"))
    };
    assert!(!warns(&answer));
    let critical = critical_amplitudes(noisy.belt(), Averaging::FiniteR).expect("roots");
    let found = answer["critical_amplitudes"].as_array().expect("roots");
    assert_eq!(found.len(), critical.len());
    assert!(found.iter().all(|one| one["kind"] == "root"));
    // Just above a critical amplitude that makes sliding stable it is stable, just below it is not.
    let root = critical.iter().find(|one| one.becomes == quell_linear::averaging::Becomes::Stable);
    let root = root.expect("noise stabilises").amplitude;
    for (factor, verdict) in [(0.99, "unstable"), (1.01, "stable")] {
        let near = study(&with_noise(factor * root, BAND));
        let answer = verbs(&Study::from(&near)).stability().expect("a verdict").json();
        assert_eq!(answer["verdict"], verdict, "{factor}");
    }
    let few = study(&with_noise(3.0, "band = [8.0, 12.0]\nlines = 4"));
    let answer = verbs(&Study::from(&few)).stability().expect("a verdict").json();
    assert!(warns(&answer), "{answer}");
}

fn response(text: &str, seeds: usize) -> NoiseResponse {
    let system = Study::from(&study(text)).system();
    let request = ResponseRequest { seeds: Some(seeds), ..ResponseRequest::default() };
    noise_response::run(&system, request).expect("runs")
}

/// Strong noise quenches from every seed, weak noise from none; a run is that of the study with its seed.
#[test]
fn the_share_of_seeds_that_quench() {
    let strong = response(&with_noise(3.0, BAND), 6);
    let share = strong.quiet().expect("a share");
    assert_eq!((share.starts, share.fraction, share.high), (6, 1.0, 1.0));
    // Wilson: n/(n + z²).
    assert!((share.low - 6.0 / (6.0 + 1.959_963_984_540_054_f64.powi(2))).abs() < 1e-12);
    let weak = response(&with_noise(0.05, BAND), 3);
    assert_eq!(weak.quiet().expect("a share").starts, 0);
    let third = response(&with_noise(3.0, &format!("{BAND}\nseed = 3")), 1);
    let [all, one] = [&strong, &third].map(|found| found.residual_vibrations().expect("E"));
    assert_eq!(all[2].to_bits(), one[0].to_bits());
    // The cost is the sum over the lines.
    let cost = strong.costs[0].clone().expect("a cost");
    assert!((cost.force - 3.0 / 2f64.sqrt()).abs() < 1e-12);
    assert!(cost.power > 0.0 && cost.velocity > 9.0 * cost.displacement);
}

#[test]
fn answers_name_the_band() {
    let noisy = Study::from(&study(&with_noise(3.0, BAND)));
    let check = verbs(&noisy).check().expect("valid");
    let json = check.json();
    let of = &json["dithers"][0]["noise"];
    assert_eq!((of["lines"].as_u64(), of["seed"].as_u64()), (Some(64), Some(1)));
    assert!((of["band"][1].as_f64().expect("a number") - 12.0).abs() < 1e-13);
    assert!(check.text().contains("64 lines, seed 1"), "{}", check.text());
    let keys: Vec<String> =
        verbs(&noisy).sources().unique().iter().map(|source| source.key.to_owned()).collect();
    for key in ["gelb1968", "steele2014", "wilson1927"] {
        assert!(keys.iter().any(|known| known == key), "{key}");
    }
    let system = Study::from(&SystemStudy::parse(&system(BAND), &[]).expect("valid"));
    assert!(
        verbs(&system)
            .check()
            .expect("valid")
            .text()
            .contains("angular frequency 8 to 12 (64 lines, seed 1)")
    );
}

/// With an envelope a run of noise is one over time; averages of a moment have its amplitude.
#[test]
fn noise_with_an_envelope() {
    let text = with_noise(3.0, BAND)
        .replace("[solver]", "[dither.envelope]\ntime = [0, 20]\nshare = [0, 1]\n[solver]");
    let study = Study::from(&study(&text));
    assert_eq!(study.varies_by(), Some("dither.envelope"));
    verbs(&study).simulate(&MotionRequest::to(30.0)).expect("a run");
    let window = ResponseRequest {
        window: Some(RealInterval::new(20.0, 40.0)),
        ..ResponseRequest::default()
    };
    verbs(&study).response(&window).expect("a window");
    let half = study.at_time(10.0).expect("a moment");
    assert_eq!(half.belt().expect("a belt").belt().dithers()[0].amplitude, 1.5);
    assert_eq!(half.noise().as_deref(), Some("dither.waveform"));
}
