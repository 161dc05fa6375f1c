//! `probability`: against quadrature of an independent program, between judges, of every kind of study, and refusals.

use std::sync::atomic::AtomicBool;

use quell::outcome::named;
use quell::run::probability::{ProbabilityRequest, ProbabilityStart};
use quell::running::Running;
use quell::verbs::verbs;
use quell::{Failure, Study};
use serde_json::Value as Json;

const BELT: &str = "[belt]\ndamping_ratio = 0.05\nnormal_load = 1.0\nbelt_velocity = 0.3\n[friction]\nlaw = \"decreasing\"\n\
                    static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n";
const DAMPING: &str = "[uncertainty]\n\"belt.damping_ratio\" = { lognormal = [0.05, 0.5] }\n";

fn asked(text: &str, request: ProbabilityRequest) -> Result<Json, Failure> {
    let study = Study::parse(text, &[]).map_err(Failure::Wrong)?;
    let stop = AtomicBool::new(false);
    let running = Running { threads: None, stop: &stop, progress: &() };
    let found = verbs(&study).probability(request, running)?;
    Ok(named(found.as_ref(), found.facts()))
}

fn found(text: &str, samples: usize, start: ProbabilityStart) -> Json {
    let request = ProbabilityRequest { samples: Some(samples), seed: 1, start };
    asked(text, request).unwrap_or_else(|why| panic!("{why}: {text}"))
}

fn averaged(text: &str, samples: usize) -> Json {
    found(text, samples, ProbabilityStart::Averaged)
}

fn refused(text: &str) -> String {
    match asked(text, ProbabilityRequest { samples: Some(10), ..ProbabilityRequest::default() }) {
        Err(why) => why.to_string(),
        Ok(_) => panic!("accepted: {text}"),
    }
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

/// Quadrature by a program that shares nothing with Quell. Every estimate is within three of its standard errors.
#[test]
fn probabilities_quantiles_and_indices_are_those_of_quadrature() {
    let text = include_str!("../../../reference/design/probability.json");
    let reference: Json = serde_json::from_str(text).expect("JSON");
    let samples = 40_000;
    for case in reference["cases"].as_array().expect("cases") {
        let name = case["name"].as_str().expect("a name");
        let found = averaged(case["study"].as_str().expect("a study"), samples);
        for (key, pointer) in
            [("probability", "/probability"), ("limit_probability", "/limit/probability")]
        {
            let Some(exact) = case[key].as_f64() else { continue };
            let error = 3.0 * (exact * (1.0 - exact) / samples as f64).sqrt();
            let value = found.pointer(pointer).map_or(f64::NAN, number);
            assert!((value - exact).abs() < error, "{name}: {key} {value} {exact}");
        }
        let (low, high) = (number(&found["low"]), number(&found["high"]));
        assert!(low < number(&found["probability"]) && number(&found["probability"]) < high);
        for (share, exact) in case["growth_quantiles"].as_object().into_iter().flatten() {
            // The growth rates within three standard errors of the share have this width.
            let (value, exact) = (number(&found["quantiles"]["growth"][share]), number(exact));
            assert!((value - exact).abs() < 1.5e-3, "{name}: {share} {value} {exact}");
        }
        for (path, exact) in case["indices"].as_object().expect("indices") {
            for index in ["first", "total"] {
                let value = number(&found["indices"][path][index]);
                let error = number(&found["indices"][path][format!("{index}_error")]);
                let exact = number(&exact[index]);
                assert!(
                    (value - exact).abs() <= 3.0 * error,
                    "{name}: {path} {index} {value} {exact}"
                );
                assert!(error < 0.01);
            }
        }
    }
}

/// The samples of a seed are the same on any number of threads, and another seed has others.
#[test]
fn a_seed_decides_the_samples() {
    let study = Study::parse(&format!("{BELT}{DAMPING}"), &[]).expect("a study");
    let stop = AtomicBool::new(false);
    let of = |threads: usize, seed: u64| {
        let request =
            ProbabilityRequest { samples: Some(500), seed, ..ProbabilityRequest::default() };
        let running = Running { threads: Some(threads), stop: &stop, progress: &() };
        verbs(&study).probability(request, running).expect("an answer").facts()
    };
    assert_eq!(of(1, 3), of(2, 3));
    assert_ne!(of(1, 3)["quantiles"], of(1, 4)["quantiles"]);
}

/// Without dither steady sliding loses its stability exactly where its small motions grow, so that both judges count the same
/// samples; a belt as a system has the same ones.
#[test]
fn judges_and_kinds_agree_without_dither() {
    let text = format!("{BELT}{DAMPING}");
    let belt = averaged(&text, 500);
    let local = found(&text, 500, ProbabilityStart::Local);
    assert_eq!(belt["vibrating"], local["vibrating"]);
    let system = "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [\"2*zeta\"]\nstiffness = [1.0]\n[parameters]\nzeta = 0.05\n\
                  [[contact]]\nname = \"pad\"\ntangent = { x = 1.0 }\nnormal_load = 1.0\nbelt_velocity = 0.3\n[contact.friction]\n\
                  law = \"decreasing\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
                  [uncertainty]\n\"parameters.zeta\" = { lognormal = [0.05, 0.5] }\n";
    let system = averaged(system, 500);
    assert_eq!(belt["vibrating"], system["vibrating"]);
    for share in ["0.05", "0.5", "0.95"] {
        let rates = [&belt, &system].map(|found| number(&found["quantiles"]["growth"][share]));
        assert!((rates[0] - rates[1]).abs() < 1e-12, "{rates:?}");
    }
}

/// Where the dither quenches every motion, no run vibrates; without it a negative slope makes every run vibrate.
#[test]
fn runs_end_as_they_must() {
    let uncertain = "[uncertainty]\n\"belt.belt_velocity\" = { uniform = [0.1, 0.11] }\n";
    let dither = |amplitude: f64| {
        format!(
            "[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = {amplitude}\nfrequency_ratio = 10.0\n"
        )
    };
    let belt = BELT.replace("damping_ratio = 0.05", "damping_ratio = 0.01");
    for start in [ProbabilityStart::Rest, ProbabilityStart::Squeal, ProbabilityStart::Local] {
        let loud = found(&format!("{belt}{}{uncertain}", dither(0.05)), 6, start);
        let quiet = found(&format!("{belt}{}{uncertain}", dither(4.0)), 6, start);
        assert_eq!(
            (number(&loud["probability"]), number(&quiet["probability"])),
            (1.0, 0.0),
            "{start:?}"
        );
    }
}

/// The correlation of two numbers whose effects cancel makes the growth rate nearly certain; their indices are those of the pair.
#[test]
fn correlation_counts() {
    let text = |rest: &str| {
        format!(
            "{BELT}[uncertainty]\n\"friction.static_coefficient\" = {{ normal = [0.4, 0.01] }}\n\
             \"friction.minimum_coefficient\" = {{ normal = [0.2857, 0.01] }}\n{rest}"
        )
    };
    let correlation = "[uncertainty.correlation]\nof = [\"friction.minimum_coefficient\", \"friction.static_coefficient\"]\n\
                       matrix = [[1.0, 0.99], [0.99, 1.0]]\n";
    let covariance = format!(
        "{BELT}[uncertainty.covariance]\nof = [\"friction.static_coefficient\", \"friction.minimum_coefficient\"]\n\
         mean = [0.4, 0.2857]\nmatrix = [[1e-4, 0.99e-4], [0.99e-4, 1e-4]]\n"
    );
    let width = |found: &Json| {
        number(&found["quantiles"]["growth"]["0.95"])
            - number(&found["quantiles"]["growth"]["0.05"])
    };
    let apart = averaged(&text(""), 4000);
    let together = averaged(&text(correlation), 4000);
    // The growth rate depends on the difference: its variance is 2 (1 − ρ) times that of one number.
    let ratio = width(&together) / width(&apart);
    assert!((ratio - 0.1).abs() < 0.01, "{ratio}");
    let of_covariance = width(&averaged(&covariance, 4000));
    assert!((width(&together) / of_covariance - 1.0).abs() < 1e-9, "{of_covariance}");
    let path = "friction.static_coefficient";
    assert!(apart["indices"][path]["first"].is_number());
    assert!(together["indices"][path]["first"].is_null());
    assert_eq!(together["groups"][0]["of"].as_array().map(Vec::len), Some(2));
    assert_eq!(number(&together["groups"][0]["total"]), 1.0);
}

/// Every kind of study, and noise by averaging alone.
#[test]
fn discs_and_noise() {
    let disc = "[disc]\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\nmodal_damping = 1e-4\n\
                [disc.load]\nradius_ratio = 0.75\nmass = 0.1\ndamping = 0.1\nstiffness = 0.1\nfriction = 0.25\nspeed = 0.4\n\
                [uncertainty]\n\"disc.load.friction\" = { lognormal = [0.25, 0.5] }\n";
    let found = averaged(disc, 50);
    assert!(found["probability"].is_number() && found["quantiles"]["growth"]["0.5"].is_number());
    let noise = format!(
        "{BELT}[dither]\ndirection = \"tangential\"\nwaveform = \"noise\"\namplitude = 1.0\nband = [8.0, 12.0]\nlines = 16\nseed = 1\n{DAMPING}"
    );
    assert!(averaged(&noise, 50)["probability"].is_number());
    let request = ProbabilityRequest { samples: Some(5), seed: 1, start: ProbabilityStart::Rest };
    assert!(asked(&noise, request).is_err_and(|why| why.to_string().contains("noise")));
}

#[test]
fn complaints_name_the_place() {
    let of = |uncertainty: &str| refused(&format!("{BELT}{uncertainty}"));
    let one = |entry: &str| of(&format!("[uncertainty]\n{entry}\n"));
    assert!(of("").contains("uncertainty"));
    assert!(of("[uncertainty]\n").contains("at least one distribution"));
    for (entry, expected) in [
        ("\"belt.dampin\" = { normal = [0.05, 0.01] }", "belt.damping_ratio"),
        ("\"belt.damping_ratio\" = { lognorm = [0.05, 0.5] }", "lognormal"),
        ("\"belt.damping_ratio\" = { lognormal = [0.05] }", "1 numbers"),
        ("\"belt.damping_ratio\" = { lognormal = [-0.05, 0.5] }", "lognormal[0]"),
        ("\"belt.damping_ratio\" = { lognormal = [0.05, 0.0] }", "lognormal[1]"),
        ("\"belt.damping_ratio\" = { uniform = [0.05, 0.05] }", "above the smallest"),
        ("\"belt.damping_ratio\" = 0.05", "one distribution"),
        // Reaches negative values.
        (
            "\"belt.normal_load\" = { normal = [1.0, 0.5] }",
            "positive values alone (lognormal = [median, sigma])",
        ),
        ("\"belt.normal_load\" = { uniform = [-1.0, 0.5] }", "belt.normal_load = -1"),
        ("\"friction.law\" = { normal = [1.0, 0.1] }", "path of a number"),
    ] {
        let said = one(entry);
        assert!(said.contains(expected), "{entry}: {said}");
    }
    let matrix = |matrix: &str| {
        of(&format!(
            "[uncertainty.covariance]\nof = [\"friction.static_coefficient\", \"friction.minimum_coefficient\"]\nmean = [0.4, 0.2857]\n\
             matrix = {matrix}\n"
        ))
    };
    assert!(matrix("[[1e-4, 2e-4], [2e-4, 1e-4]]").contains("negative variance"));
    assert!(matrix("[[1e-4, 2e-5], [1e-5, 1e-4]]").contains("symmetric"));
    assert!(matrix("[[1e-4, 0.0]]").contains("square"));
    assert!(matrix("[[0.0, 0.0], [0.0, 1e-4]]").contains("positive variances"));
    // A path without quotes.
    let unquoted = averaged(
        &format!("{BELT}[uncertainty]\nbelt.damping_ratio = {{ lognormal = [0.05, 0.5] }}\n"),
        50,
    );
    assert_eq!(unquoted["quantiles"], averaged(&format!("{BELT}{DAMPING}"), 50)["quantiles"]);
}

/// Values with units, and the deviation of a logarithm, which has none.
#[test]
fn distributions_have_the_units_of_their_keys() {
    let belt = "[belt]\nmass_kg = 2.0\nstiffness_n_per_m = 200.0\ndamping_ratio = 0.05\nnormal_force_n = 200.0\n\
                belt_velocity_m_per_s = 3.0\n[friction]\nlaw = \"decreasing\"\nstatic_coefficient = 0.4\n\
                minimum_coefficient = 0.2857\nreference_velocity_m_per_s = 2.0\n[uncertainty]\n";
    let of = |entries: &str| averaged(&format!("{belt}{entries}"), 100);
    let plain = of(
        "\"belt.belt_velocity_m_per_s\" = { lognormal = [3.0, 0.1] }\n\"belt.normal_force_n\" = { uniform = [100.0, 200.0] }\n",
    );
    let units = of(
        "\"belt.belt_velocity_m_per_s\" = { lognormal = [\"3000 mm/s\", 0.1] }\n\"belt.normal_force_n\" = { uniform = [\"0.1kN\", \"200 N\"] }\n",
    );
    assert_eq!(plain["quantiles"], units["quantiles"]);
    assert!(plain["notes"][0].as_str().is_some_and(|said| said.contains(" 1/s ")), "{plain}");
    let wrong = refused(&format!(
        "{belt}\"belt.belt_velocity_m_per_s\" = {{ lognormal = [3.0, \"0.1 m/s\"] }}\n"
    ));
    assert!(wrong.contains("lognormal[1]"), "{wrong}");
}

const STRIBECK: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
                        static_coefficient = 0.4\nminimum_coefficient = 0.25\nreference_velocity = 0.5\n\
                        [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 1.2\nfrequency_ratio = 10.0\n";

/// The least quiet amplitude grows with the speed, so that its quantile over speeds is that of the speed of the same share.
#[test]
fn quantiles_of_thresholds_are_thresholds_at_quantiles() {
    let uncertain = "[uncertainty]\n\"belt.belt_velocity\" = { uniform = [0.05, 0.15] }\n";
    for (start, samples) in [(ProbabilityStart::Averaged, 4000), (ProbabilityStart::Local, 100)] {
        let found = found(&format!("{STRIBECK}{uncertain}"), samples, start);
        let values = [0, 1, 2].map(|place| number(&found["thresholds"][place]["amplitude"]));
        let shares = values.map(|amplitude| share_quenched(amplitude, start));
        for (share, exact) in shares.into_iter().zip([0.05, 0.5, 0.95]) {
            let error = 4.0 * (exact * (1.0_f64 - exact) / samples as f64).sqrt();
            assert!((share - exact).abs() < error, "{start:?}: {values:?} {shares:?}");
        }
    }
    let without = STRIBECK.split("[dither]").next().expect("a belt");
    let found = averaged(&format!("{without}{uncertain}"), 50);
    assert!(found["thresholds"][1]["amplitude"].is_null());
    let of_runs = format!("{STRIBECK}{uncertain}");
    let found = self::found(&of_runs, 3, ProbabilityStart::Rest);
    assert!(found["thresholds"][1]["amplitude"].is_null());
}

/// The share of the speeds that an amplitude quenches: up to the threshold in speed, by bisection of the verdict.
fn share_quenched(amplitude: f64, start: ProbabilityStart) -> f64 {
    let (mut low, mut high) = (0.05_f64, 0.15_f64);
    let dithered = STRIBECK.replace("amplitude = 1.2", &format!("amplitude = {amplitude}"));
    let vibrates = |speed: f64| {
        let text = dithered.replace("belt_velocity = 0.1", &format!("belt_velocity = {speed}"));
        let certain = format!(
            "{text}[uncertainty]\n\"belt.damping_ratio\" = {{ uniform = [0.005, 0.0050000001] }}\n"
        );
        let found = found(&certain, 1, start);
        found["vibrating"] == 1
    };
    for _ in 0..14 {
        let middle = f64::midpoint(low, high);
        if vibrates(middle) { high = middle } else { low = middle }
    }
    (low - 0.05) / 0.1
}

/// Rates and forces are those of every sample in SI: the units of the equations depend on its mass and stiffness.
#[test]
fn uncertain_scales_change_rates_and_forces() {
    let text = |mass: f64, uncertain: &str| {
        format!(
            "[belt]\nmass_kg = {mass}\nstiffness_n_per_m = 100.0\ndamping_ratio = 0.005\nnormal_force_n = 100.0\n\
             belt_velocity_m_per_s = 1.0\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.25\n\
             reference_velocity_m_per_s = 5.0\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude_n = 120.0\n\
             frequency_hz = 20.0\n[uncertainty]\n{uncertain}\n"
        )
    };
    let mass =
        |mass: f64| format!("\"belt.mass_kg\" = {{ uniform = [{mass}, {}] }}", mass * 1.000_001);
    let elsewhere = averaged(&text(1.0, &mass(0.5)), 50);
    let own = averaged(&text(0.5, &mass(0.5)), 50);
    for pointer in ["/quantiles/growth/0.5", "/thresholds/1/amplitude"] {
        let [a, b] = [&elsewhere, &own].map(|found| found.pointer(pointer).map_or(0.0, number));
        assert!((a / b - 1.0).abs() < 1e-9, "{pointer}: {a} {b}");
    }
}

/// Averaging of a dither that is not fast is warned of, below the resonance too, where `stability` has a verdict with a warning.
#[test]
fn averaging_of_slow_dither_is_warned_of() {
    let uncertain = "[uncertainty]\n\"belt.belt_velocity\" = { uniform = [0.05, 0.15] }\n";
    let of = |ratio: &str| {
        let text =
            STRIBECK.replace("frequency_ratio = 10.0", &format!("frequency_ratio = {ratio}"));
        averaged(&format!("{text}{uncertain}"), 60)
    };
    let warned = |found: &Json, words: &str| {
        let warnings = found["warnings"].as_array().expect("warnings");
        warnings.iter().any(|warning| warning.as_str().is_some_and(|said| said.contains(words)))
    };
    let slow = of("0.5");
    assert!(warned(&slow, "R is below 5 in 60 of 60 samples"), "{slow}");
    assert_eq!(slow["probability"], 0.0, "{slow}");
    assert!(slow["limit"]["probability"].is_number(), "{slow}");
    // Fast enough for both, and not for the limit of high frequency.
    let near = averaged(
        &format!("{}{uncertain}", STRIBECK.replace("amplitude = 1.2", "amplitude = 0.985")),
        400,
    );
    assert!(warned(&near, "another verdict"), "{near}");
    assert!(!warned(&of("10.0"), "below 5"));
}
