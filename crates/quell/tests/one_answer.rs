//! Verbs that could contradict each other about one study, found by readers from outside.

use std::sync::atomic::AtomicBool;

use quell::Study;
use quell::run::probability::ProbabilityRequest;
use quell::run::response::ResponseRequest;
use quell::run::system::tracked::TrackRequest;
use quell::run::thresholds::ThresholdsRequest;
use quell::running::Running;
use quell::sweep::{MapQuantity, Plan};
use quell::verbs::verbs;
use quell_design::quench::quench;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

/// A slider that begins to adhere at 308.01 N, next to which no step of a continuation follows its response. Plain Runge–Kutta runs of a
/// reader vibrate slowly at 330 N and not from 340 N on.
const SLIDER: &str = r#"
[belt]
mass_kg = 0.5
natural_frequency_hz = 100.0
damping_ratio = 0.005
normal_force_n = 200.0
belt_velocity_m_per_s = 0.1
tangential_stiffness_n_per_m = 5e6
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity_m_per_s = 0.3
[dither]
direction = "tangential"
waveform = "sine"
amplitude_n = 400.0
frequency_hz = 1000.0
[design]
minimise = "amplitude"
vary = ["dither.amplitude_n"]
from = [10.0]
to = [2000.0]
"#;

#[test]
fn designs_waveforms_and_thresholds_of_a_slider_agree() {
    let study = study(SLIDER);
    let verbs = verbs(&study);
    let thresholds = |from: f64, to: f64| {
        let parameter = "dither.amplitude_n".to_owned();
        let request = ThresholdsRequest {
            parameter,
            window: RealInterval::new(from, to),
            ..ThresholdsRequest::default()
        };
        verbs.thresholds(&request).expect("thresholds").facts()
    };
    let values: Vec<f64> = [(10.0, 2000.0), (306.0, 340.0), (320.0, 350.0)]
        .map(|(from, to)| number(&thresholds(from, to)["local"][0]["value"]))
        .to_vec();
    for value in &values {
        assert!((value / 333.7607 - 1.0).abs() < 1e-6, "{values:?}");
    }
    let near = thresholds(306.0, 310.0);
    assert_eq!(near["covered"], true, "{near}");
    let design = verbs.design().expect("a design").facts();
    let least = number(&design["critical"]["dither.amplitude_n"]);
    assert!((least / values[0] - 1.0).abs() < 1e-6, "{least}");
    let rows = verbs.waveforms().expect("waveforms").facts();
    let sine = number(&rows["waveforms"][0]["exact_amplitude"]);
    assert!((sine / values[0] - 1.0).abs() < 1e-6, "{sine}");
    // The quantity of maps.
    let belt = study.belt().expect("a belt");
    let scales = belt.scales().expect("in SI");
    let quench = quench(&belt.belt().system(), 0).expect("a branch");
    let least = quench.least().expect("a quench").amplitude * scales.per_unit(Quantity::Force);
    assert!((least / values[0] - 1.0).abs() < 1e-6, "{least}");
}

const BELT: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
                    static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
                    direction = \"tangential\"\nwaveform = \"sine\"\namplitude = 1.0\nfrequency_ratio = 10.0\n";

/// A burst 5 : 3 at R = 10 repeats at 1.25 ω₀: in step with it the mass vibrates slowly.
#[test]
fn a_waveform_in_the_band_of_the_vibration_has_no_exact_amplitude() {
    let found = verbs(&study(BELT)).waveforms().expect("waveforms").facts();
    let rows = found["waveforms"].as_array().expect("rows");
    let row = |label: &str| rows.iter().find(|row| row["label"] == label).expect("a row");
    let slow = row("burst 5 : 3");
    assert!(slow["exact_amplitude"].is_null(), "{slow}");
    let why = found["why"].as_object().expect("reasons");
    let reasons = why.iter().filter(|(path, why)| {
        path.ends_with(".exact_amplitude") && why.to_string().contains("1.9 times")
    });
    assert_eq!(reasons.count(), 4, "{why:?}");
    assert!(number(&row("burst 1 : 3")["exact_amplitude"]) > 1.0);
    let sentence = found["sentence"].as_str().expect("a sentence");
    assert!(sentence.contains("a square has the least"), "{sentence}");
    let burst = BELT.replace("\"sine\"", "\"burst\"\ncarrier = \"sine\"\non = 5\noff = 3");
    let response =
        verbs(&study(&burst)).response(&ResponseRequest::default()).expect("a response").facts();
    assert_ne!(response["effect"], "quenches", "{response}");
}

/// The exact amplitudes of a system are its thresholds, also where averaging ranks none.
#[test]
fn the_exact_amplitude_of_a_system_is_its_threshold() {
    let text = "[system]\ncoordinates = [\"motor\", \"carriage\"]\nmass = [1.0, 1.0]\n\
                damping = [[0.02, -0.01], [-0.01, 0.02]]\nstiffness = [[2.0, -1.0], [-1.0, 1.0]]\n[[contact]]\n\
                name = \"guide\"\ntangent = { carriage = 1.0 }\nnormal_load = 1.0\nbelt_velocity = 0.05\n\
                [contact.friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\n\
                reference_velocity = 0.2\n[[dither]]\nat = { carriage = 1.0 }\nwaveform = \"sine\"\namplitude = 0.5\n\
                frequency = 10.0\n";
    let study = study(text);
    let found = verbs(&study).waveforms().expect("waveforms").facts();
    let exact = number(&found["waveforms"][0]["exact_amplitude"]);
    let request = ThresholdsRequest {
        parameter: "dither.amplitude".to_owned(),
        window: RealInterval::new(0.9 * exact, 1.1 * exact),
        ..ThresholdsRequest::default()
    };
    let thresholds = verbs(&study).thresholds(&request).expect("thresholds").facts();
    let value = number(&thresholds["local"][0]["value"]);
    assert!((value / exact - 1.0).abs() < 1e-6, "{value} {exact}");
    let sentence = found["sentence"].as_str().expect("a sentence");
    assert!(!sentence.contains("no waveform quenches"), "{sentence}");
}

/// On a very slow belt the cycle without dither is longer than the record, which says so.
#[test]
fn a_cycle_longer_than_the_record_is_warned_of() {
    let slow = BELT.replace("belt_velocity = 0.1", "belt_velocity = 1e-4");
    let coulomb = "law = \"coulomb\"\ncoefficient = 0.2\nstatic_coefficient = 0.4\n[solver]\nsettle = 9000.0\nrecord_periods = 100\n";
    let law = "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n";
    let text = slow.replace(law, coulomb);
    let found = verbs(&study(&text)).response(&ResponseRequest::default());
    let found = found.expect("a response").facts();
    let warnings = found["warnings"].to_string();
    assert!(warnings.contains("the vibration without dither repeats after 3972"), "{warnings}");
}

/// A belt between the amplitude from which it is quiet (exact: D = 0.496562) and that of the limit of high frequency (0.4999).
const NEAR: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n[friction]\nlaw = \"stribeck\"\n\
                    static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
                    direction = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.498\nfrequency_ratio = 10.0\n";

/// The same in SI: a brake whose dither is a little more than enough.
const BRAKE: &str = "[belt]\nmass_kg = 0.5\nnatural_frequency_hz = 5600.0\ndamping_ratio = 0.005\nnormal_force_n = \"4 kN\"\n\
                     belt_velocity_m_per_s = 0.1\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\n\
                     minimum_coefficient = 0.2857\nreference_velocity_m_per_s = 0.2\n[dither]\ndirection = \"tangential\"\n\
                     waveform = \"sine\"\namplitude_n = 5800\nfrequency_hz = 20000\n";

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

/// The unprefixed keys of every verb are those of its sentence, by finite-R averaging; the limit has names of its own.
#[test]
fn verdicts_by_averaging_are_those_of_the_sentence() {
    for (text, amplitude, slip) in
        [(NEAR, "dither.amplitude", 0.05), (BRAKE, "dither.amplitude_n", 0.1)]
    {
        let own =
            number(&verbs(&study(text)).check().expect("valid").facts()["dithers"][0]["amplitude"]);
        let stability = verbs(&study(text)).stability().expect("averages").facts();
        assert_eq!(stability["verdict"], "stable", "{stability}");
        assert_eq!(stability["limit"]["verdict"], "unstable", "{stability}");
        assert!(number(&stability["growth_rate"]) < 0.0);
        let sentence = stability["sentence"].as_str().expect("a sentence");
        assert!(
            sentence.contains("is stable") && !sentence.contains("unstable from"),
            "{sentence}"
        );
        let axis = format!("{text}[[sweep]]\nparameter = \"{amplitude}\"\nvalues = [{own:?}]\n");
        let quantities = [
            "verdict",
            "growth",
            "critical-amplitude",
            "limit-verdict",
            "limit-critical-amplitude",
        ];
        let found = map(&axis, &quantities);
        assert_eq!(found["verdict"][0], "stable", "{found}");
        assert_eq!(found["limit_verdict"][0], "unstable", "{found}");
        let [critical, limit] =
            [&stability, &stability["limit"]].map(|of| &of["critical_amplitudes"][0]);
        assert_eq!(found["critical_amplitude"][0], critical["amplitude"]);
        assert_eq!(found["limit_critical_amplitude"][0], limit["amplitude_ratio"]);
        // Mean friction has the slope that decides: that of the limit has the other sign of 2ζ + Fμ̄′.
        let friction = verbs(&study(text)).friction(Some(&[slip]), false).expect("means").facts();
        let slope = |name: &str| number(&friction["contacts"][0][name][0]);
        assert!(slope("effective_slope") > slope("limit_effective_slope"), "{friction}");
        let uncertain = format!(
            "{text}[uncertainty]\n\"{amplitude}\" = {{ uniform = [{own:?}, {:?}] }}\n",
            own * (1.0 + 1e-9)
        );
        let request = ProbabilityRequest { samples: Some(20), ..ProbabilityRequest::default() };
        let never = AtomicBool::new(false);
        let running = Running { threads: Some(1), stop: &never, progress: &() };
        let found = verbs(&study(&uncertain)).probability(request, running).expect("a probability");
        let found = found.facts();
        assert_eq!((&found["quiet"], &found["limit"]["quiet"]), (&20.into(), &0.into()), "{found}");
    }
}

/// Where the belt is exactly as fast as the fast motion the criterion jumps to infinity: a map has no number there, only a reason. The
/// rounding of the quotient of amplitude and frequency makes no number of 10⁸ of it.
#[test]
fn a_map_has_no_criterion_where_it_is_infinite() {
    // Of a sine the fast velocity is D/R in the limit, at any rounding of D = 0.05·R.
    for (velocity, ratio) in [(0.05, 10.0), (0.1, 3.0), (0.3, 7.0), (0.7, 11.0), (0.07, 13.0)] {
        let text = NEAR
            .replace("frequency_ratio = 10.0", &format!("frequency_ratio = {ratio:?}"))
            .replace("belt_velocity = 0.05", &format!("belt_velocity = {velocity:?}"));
        let exact: f64 = velocity * ratio;
        let values = [exact.next_down(), exact, exact.next_up(), 1.001 * exact, 0.999 * exact];
        let axis = format!("[[sweep]]\nparameter = \"dither.amplitude\"\nvalues = {values:?}\n");
        let found = map(&format!("{text}{axis}"), &["limit-criterion", "limit-growth"]);
        for point in 0..3 {
            for name in ["limit_criterion", "limit_growth"] {
                assert!(found[name][point].is_null(), "{ratio}: {found}");
                assert_eq!(found[format!("{name}_status").as_str()][point], "at_corner");
            }
        }
        assert!(number(&found["limit_criterion"][3]) > 0.0);
        assert!(found["limit_criterion"][4].is_number());
    }
}

/// An option that a kind of study lacks is not refused by a list that has the verb.
#[test]
fn a_refused_option_is_not_listed() {
    let request = TrackRequest {
        parameter: "belt.belt_velocity".to_owned(),
        window: RealInterval::new(0.1, 0.2),
        along: None,
    };
    let disc = "schema = 1\n[disc]\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n\
                [disc.load]\nradius_ratio = 0.75\nmass = 0.04\ndamping = 0.0\nstiffness = 0.04\nfriction = 0.4\nspeed = 0.5\n";
    let refused = verbs(&study(disc)).tracked_stability(&request).map(|_| ()).expect_err("a disc");
    let said = refused.to_string();
    assert!(said.starts_with("disc: stability --parameter is not available"), "{said}");
    assert!(said.contains("stability without --parameter"), "{said}");
}

/// A start that does not disturb steady sliding leaves the belt there without dither, also where it is unstable: no dither is the cause of a
/// vibration that `stability` expects without it.
#[test]
fn unstable_sliding_is_not_called_quiet() {
    // The numbers of steady sliding are exact here: rounding does not disturb it either.
    let text = "[belt]\nmass_kg = 0.4\nstiffness_n_per_m = 6.3e7\ndamping_ratio = 0.008\nnormal_force_n = 2500.0\n\
                belt_velocity_m_per_s = 0.15\ninitial.state = \"sliding\"\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.45\n\
                minimum_coefficient = 0.3\nreference_velocity_m_per_s = 0.6\n[dither]\ndirection = \"tangential\"\n\
                waveform = \"sine\"\namplitude_n = 4600.0\nfrequency_hz = 13000.0\n";
    let response =
        verbs(&study(text)).response(&ResponseRequest::default()).expect("a response").facts();
    assert_eq!(response["effect"], "unknown", "{response}");
    let sentence = response["sentence"].as_str().expect("a sentence");
    assert!(sentence.contains("stays in steady sliding, which is unstable"), "{sentence}");
    assert!(!sentence.contains("quiet"), "{sentence}");
}

/// A dither that moves nothing causes no vibration.
#[test]
fn a_system_that_does_not_move_is_quiet() {
    let text = "[system]\ncoordinates = [\"y\"]\nmass = [1.0]\nstiffness = [5.0]\n[[contact]]\nname = \"floor\"\ntangent = { y = 1.0 }\n\
                normal_load = 9.8\nbelt_velocity = 0.0\n[contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.4\n[[dither]]\n\
                at = { y = 1.0 }\nwaveform = \"sine\"\namplitude = 3.5\nfrequency = 2.5\n";
    let response =
        verbs(&study(text)).response(&ResponseRequest::default()).expect("a response").facts();
    assert_eq!(response["effect"], "quiet", "{response}");
}

/// The units of numbers that have one name in several objects.
#[test]
fn every_number_has_its_own_unit() {
    let text = format!(
        "{}[actuator]\nkind = \"piezo\"\nblocked_force_n = 7000.0\ncapacitance_f = 2e-6\nmaximum_voltage = 150.0\n",
        SLIDER
            .split("[design]")
            .next()
            .expect("a study")
            .replace("tangential_stiffness_n_per_m = 5e6\n", "")
    );
    let facts = verbs(&study(&text)).actuator(None).expect("an actuator").facts();
    assert_eq!(facts["units"]["voltage.peak"], "V", "{}", facts["units"]);
    assert_eq!(facts["units"]["current.peak"], "A", "{}", facts["units"]);
    assert_eq!(facts["units"]["peak"], "N", "{}", facts["units"]);
}
