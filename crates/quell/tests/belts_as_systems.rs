//! Belts against the same belts written as systems, and systems against their exact responses: friction, describing functions, noise
//! and ramps.

use quell::Study;
use quell::run::found_attractor::AttractorRequest;
use quell::run::noise_response;
use quell::run::response::ResponseRequest;
use quell::study::{BeltStudy, SystemStudy};
use quell::verbs::verbs;
use serde_json::Value as Json;

const LAW: &str = "law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n";

/// Numbers of a belt, the same in both forms.
#[derive(Clone, Copy)]
struct Numbers {
    damping: f64,
    load: f64,
    velocity: f64,
}

const LIGHT: Numbers = Numbers { damping: 0.005, load: 0.1, velocity: 0.12 };

fn belt(numbers: Numbers, dither: &str, rest: &str) -> BeltStudy {
    let Numbers { damping, load, velocity } = numbers;
    let text = format!(
        "[belt]\ndamping_ratio = {damping:?}\nnormal_load = {load:?}\nbelt_velocity = {velocity:?}\n[friction]\n{LAW}[dither]\n\
         direction = \"tangential\"\n{dither}\n{rest}"
    );
    BeltStudy::parse(&text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

fn system(numbers: Numbers, dither: &str) -> SystemStudy {
    let Numbers { damping, load, velocity } = numbers;
    let dither = dither.replace("frequency_ratio", "frequency");
    let text = format!(
        "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [{:?}]\nstiffness = [1.0]\n[[contact]]\nname = \"pad\"\n\
         tangent = {{ x = 1.0 }}\nnormal_load = {load:?}\nbelt_velocity = {velocity:?}\n[contact.friction]\n{LAW}[[dither]]\n\
         at = {{ x = 1.0 }}\n{dither}\n",
        2.0 * damping
    );
    SystemStudy::parse(&text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

fn answer(study: &SystemStudy, ask: impl Fn(&quell::verbs::Verbs) -> quell::verbs::Reply) -> Json {
    ask(&verbs(&Study::from(study))).unwrap_or_else(|why| panic!("{why}")).json()
}

fn number(json: &Json) -> f64 {
    json.as_f64().unwrap_or_else(|| panic!("{json}"))
}

fn close(one: f64, other: f64, tolerance: f64, what: &str) {
    assert!((one - other).abs() <= tolerance * other.abs(), "{what}: {one} against {other}");
}

/// The mean friction of the contact of a system is that of finite-R averaging of the belt. The system has the damping of the
/// structure in its fast motion, which changes the velocity by 2(ζ/R)² = 10⁻⁷.
#[test]
fn friction_of_the_contact() {
    for dither in [
        "waveform = \"sine\"\namplitude = 2.0\nfrequency_ratio = 20.0",
        "waveform = \"triangle\"\namplitude = 3.0\nfrequency_ratio = 20.0",
    ] {
        let at = vec![-0.05, 0.03, 0.08, 0.15, 0.3];
        let found = answer(&system(LIGHT, dither), |verbs| verbs.friction(Some(&at), false));
        let contact = &found["contacts"][0];
        let study = belt(LIGHT, dither, "");
        let motion = quell_linear::averaging::AveragedLaw::of_one_mass(
            study.belt(),
            0.12,
            quell_linear::averaging::Averaging::FiniteR,
        );
        let law = motion.expect("a law");
        for (index, v) in at.iter().enumerate() {
            let exact = law.at(*v).expect("a mean");
            let of = |name: &str| number(&contact[name][index]);
            close(of("effective_coefficient"), exact.coefficient, 1e-6, "mean");
            close(of("effective_slope"), exact.slope, 1e-5, "slope");
            close(
                of("coefficient"),
                study.belt().friction().coefficient(v.abs()) * v.signum(),
                1e-15,
                "law",
            );
        }
    }
    let measured = verbs(&Study::from(&system(
        LIGHT,
        "waveform = \"sine\"\namplitude = 2.0\nfrequency = 20.0",
    )))
    .friction(Some(&[0.15]), true);
    // The steady responses of the mass: beyond the fast velocity its averages hold.
    let measured = measured.expect("one mass").json();
    let of = |name: &str| number(&measured["contacts"][0][name][0]);
    close(of("measured_coefficient"), of("effective_coefficient"), 1e-2, "measured");
}

/// The slow vibration of the system is that of finite-R averaging of the belt up to the damping in the fast motion, and the exact
/// response of the system has its amplitude within what the first harmonic neglects: 1/R = 5 % and the load 0.1.
#[test]
fn the_slow_vibration_of_a_belt() {
    let dither = "waveform = \"sine\"\namplitude = 2.0\nfrequency_ratio = 20.0";
    let study = system(LIGHT, dither);
    let found = answer(&study, |verbs| verbs.describing(0.3));
    let of_belt =
        verbs(&Study::from(&belt(LIGHT, dither, ""))).describing(0.3).expect("a function").json();
    let velocity = number(&found["limit_cycle_velocity"]);
    for path in ["/limit_cycle_velocity", "/contacts/0/small_gain", "/limit/limit_cycle_velocity"] {
        let [one, other] = [&found, &of_belt].map(|answer| answer.pointer(path).expect(path));
        close(number(one), number(other), 1e-12, path);
    }
    // x″ + x = 0 at the cycle, up to the change of the frequency by damping, which vanishes there.
    close(number(&found["limit_cycle_frequency"]), 1.0, 1e-9, "frequency");
    close(number(&found["limit_cycle_amplitude"]), velocity, 1e-9, "amplitude");
    let times =
        ResponseRequest { settle: Some(1500.0), record: Some(400.0), ..ResponseRequest::default() };
    let exact = answer(&study, |verbs| verbs.response(&times));
    close(velocity, number(&exact["amplitude"]), 0.05, "response");
}

/// Two masses in a row, friction at the first: the prediction has the frequency and the amplitude of the exact response.
#[test]
fn the_slow_vibration_of_two_masses() {
    let text = format!(
        "[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1.0, 2.0]\ndamping = [[0.02, -0.01], [-0.01, 0.06]]\n\
         stiffness = [[1.0, -1.0], [-1.0, 5.0]]\nobserve = {{ x = 1.0 }}\n[[contact]]\nname = \"pad\"\ntangent = {{ x = 1.0 }}\n\
         normal_load = 0.1\nbelt_velocity = 0.12\n[contact.friction]\n{LAW}[[dither]]\nat = {{ x = 1.0 }}\nwaveform = \"sine\"\n\
         amplitude = 2.0\nfrequency = 20.0\n"
    );
    let study = SystemStudy::parse(&text, &[]).expect("valid");
    let found = answer(&study, |verbs| verbs.describing(0.3));
    assert_eq!(found["balanced_contact"], "pad", "{found}");
    let times =
        ResponseRequest { settle: Some(1500.0), record: Some(600.0), ..ResponseRequest::default() };
    let exact = answer(&study, |verbs| verbs.response(&times));
    close(number(&found["limit_cycle_amplitude"]), number(&exact["amplitude"]), 0.05, "amplitude");
    let size = |line: &Json| number(&line["amplitude"]);
    let peaks = exact["peaks"].as_array().expect("peaks").iter();
    let line = peaks.max_by(|a, b| size(a).total_cmp(&size(b))).expect("a line");
    close(number(&found["limit_cycle_frequency"]), number(&line["frequency"]), 0.01, "frequency");
    // Friction at the second mass too: an amplitude of its own there.
    let two = text.replace(
        "[[dither]]",
        &format!(
            "[[contact]]\nname = \"disc\"\ntangent = {{ y = 1.0 }}\nnormal_load = 0.1\nbelt_velocity = 0.12\n[contact.friction]\n{LAW}[[dither]]"
        ),
    );
    let two = SystemStudy::parse(&two, &[]).expect("valid");
    let found = answer(&two, |verbs| verbs.describing(0.3));
    assert!(found["limit_cycle_velocity"].is_null());
    assert!(found["why"]["limit_cycles"].as_str().expect("why").contains("2 contacts"), "{found}");
    assert_eq!(found["contacts"].as_array().map(Vec::len), Some(2));
}

/// Runs under noise: the same E in both engines, where both run for the same times.
#[test]
fn the_share_of_seeds() {
    let numbers = Numbers { damping: 0.005, load: 1.0, velocity: 0.1 };
    let solver = "[solver]\nsettle = 300\nrecord_periods = 30\n";
    let record = 30.0 * std::f64::consts::TAU;
    let times = ResponseRequest {
        settle: Some(300.0),
        record: Some(record),
        seeds: Some(3),
        ..ResponseRequest::default()
    };
    for (amplitude, quiet) in [(3.0, 1.0), (0.05, 0.0)] {
        let dither = format!("waveform = \"noise\"\nband = [8.0, 12.0]\namplitude = {amplitude:?}");
        let one = noise_response::run(
            &Study::from(&belt(numbers, &dither, solver)).system(),
            ResponseRequest { seeds: Some(3), ..ResponseRequest::default() },
        )
        .expect("runs");
        let study = system(numbers, &dither);
        let other = noise_response::run(&study, times).expect("runs");
        for found in [&one, &other] {
            assert_eq!(found.quiet().expect("a share").fraction, quiet);
            // The averaged growth rate has the sign of the simulated share.
            assert_eq!(*found.averaged.as_ref().expect("a rate") > 0.0, quiet == 0.0);
        }
        let rates = [&one, &other].map(|found| *found.averaged.as_ref().expect("a rate"));
        close(rates[0], rates[1], 1e-3, "averaged growth rate");
        let costs = [&one, &other].map(|found| found.costs[0].clone().expect("a cost"));
        close(costs[0].power, costs[1].power, 1e-12, "power");
        let of = |found: &noise_response::NoiseResponse| found.residual_vibrations().expect("E");
        // Records of different sampling and bands: of a quiet run a few percent of E, which stick–slip repeats.
        for (one, other) in of(&one).iter().zip(of(&other)) {
            close(*one, other, 0.05, "E");
        }
        assert_eq!(one.runs[2].seed, other.runs[2].seed);
    }
    let periodic = system(LIGHT, "waveform = \"sine\"\namplitude = 2.0\nfrequency = 20.0");
    assert!(noise_response::run(&periodic, times).is_err());
    // Every run ends quiet or not; there is no orbit.
    let study = system(numbers, "waveform = \"noise\"\nband = [8.0, 12.0]\namplitude = 3.0");
    assert!(verbs(&Study::from(&study)).attractor(&AttractorRequest::default()).is_err());
}

/// The finite-R response to every line is in the average of a belt too: critical amplitudes of belt and system agree.
#[test]
fn critical_noise() {
    let numbers = Numbers { damping: 0.005, load: 1.0, velocity: 0.1 };
    let dither = "waveform = \"noise\"\nband = [8.0, 12.0]\namplitude = 1.0";
    let of_belt =
        verbs(&Study::from(&belt(numbers, dither, ""))).stability().expect("averages").json();
    let of_system = answer(&system(numbers, dither), quell::verbs::Verbs::stability);
    let amplitude = |json: &Json| number(&json["critical_amplitudes"][0]["amplitude"]);
    close(amplitude(&of_belt), amplitude(&of_system), 1e-15, "critical amplitude");
    let limit = amplitude(&of_belt["limit"]);
    assert!((limit / amplitude(&of_system) - 1.0).abs() > 1e-3, "the limit differs");
    // From this amplitude on every belt velocity is stable: the worst is just stable there.
    let ratio = number(&of_belt["everywhere_stable_amplitude"]);
    let at = |factor: f64| {
        let dither =
            dither.replace("amplitude = 1.0", &format!("amplitude = {:?}", factor * ratio));
        let json =
            verbs(&Study::from(&belt(numbers, &dither, ""))).stability().expect("averages").json();
        json["unstable_surface_velocities"].as_array().expect("bands").len()
    };
    assert_eq!((at(0.98) > 0, at(1.02)), (true, 0));
}

/// A drive that slows down and speeds up again: switches and thresholds of both engines, and the thresholds of the verb `thresholds`.
#[test]
fn a_ramp() {
    let drive = "time = [0.0, 400.0, 800.0]\nvelocity = [0.3, 0.05, 0.3]\n";
    let dither = "waveform = \"sine\"\namplitude = 1.0\nfrequency_ratio = 10.0";
    let belt = format!(
        "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\n[belt.initial]\nstate = \"sliding\"\n[belt.drive]\n{drive}[friction]\n{LAW}[dither]\n\
         direction = \"tangential\"\n{dither}\n"
    );
    let system = format!(
        "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.01]\nstiffness = [1.0]\n[system.initial]\nstate = \"sliding\"\n\
         [[contact]]\nname = \"pad\"\ntangent = {{ x = 1.0 }}\nnormal_load = 1.0\n[contact.drive]\n{drive}[contact.friction]\n{LAW}\
         [[dither]]\nat = {{ x = 1.0 }}\n{}\n",
        dither.replace("frequency_ratio", "frequency")
    );
    let ramp = |text: &str| {
        let study = Study::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"));
        verbs(&study).ramp().unwrap_or_else(|why| panic!("{why}")).json()
    };
    let (one, other) = (ramp(&belt), ramp(&system));
    assert_eq!(other["parameter"], "contact.pad.belt_velocity");
    let list = |json: &Json, name: &str| json[name].as_array().expect("a list").clone();
    let thresholds = list(&other, "thresholds");
    assert_eq!(thresholds.len(), list(&one, "thresholds").len(), "{one} {other}");
    assert!(!thresholds.is_empty());
    for (one, other) in list(&one, "thresholds").iter().zip(&thresholds) {
        close(number(&one["value"]), number(&other["value"]), 1e-6, "threshold");
        assert_eq!((&one["kind"], &one["becomes"]), (&other["kind"], &other["becomes"]));
    }
    // The same motion in both engines: a switch is found to within half a natural period.
    let switches = list(&other, "switches");
    assert_eq!(switches.len(), list(&one, "switches").len(), "{one} {other}");
    for (one, other) in list(&one, "switches").iter().zip(&switches) {
        assert!((number(&one["time"]) - number(&other["time"])).abs() < 3.2, "{one} {other}");
        assert_eq!(one["becomes"], other["becomes"]);
    }
    // Vibration ends beyond the exact threshold on the way up, by less than a tenth in this slow ramp.
    let last = switches.last().expect("a switch");
    assert_eq!(last["becomes"], "quiet");
    let (value, threshold) = (number(&last["value"]), number(&last["threshold"]));
    assert!(value > threshold && value < 1.2 * threshold, "{last}");
    // Every threshold is passed in the sense of its switch. The drive is symmetric about 400, where it turns.
    for found in switches.iter().filter(|found| !found["threshold"].is_null()) {
        let (passed, value) = (number(&found["threshold_time"]), number(&found["threshold"]));
        let at_that_time = 0.05 + 0.25 * (passed - 400.0).abs() / 400.0;
        close(at_that_time, value, 1e-9, "passed");
        let known = thresholds.iter().find(|known| number(&known["value"]) == value);
        let becomes = known.expect("a threshold")["becomes"] == "stable";
        let rises = passed > 400.0;
        assert_eq!(becomes == rises, found["becomes"] == "quiet", "{found}");
    }
    // Vibration begins after the lower threshold is passed on the way up, late.
    let first = &switches[0];
    assert_eq!(first["becomes"], "vibrating");
    assert!(number(&first["threshold"]) < number(&first["value"]), "{first}");
    assert!(number(&first["threshold_time"]) < number(&first["time"]), "{first}");
}

/// A load and an amplitude of a system as ramps; without dither the thresholds are those of steady sliding.
#[test]
fn ramps_of_loads_and_amplitudes() {
    let base = |contact: &str, dither: &str| {
        format!(
            "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.03]\nstiffness = [1.0]\n\
             [[contact]]\nname = \"pad\"\ntangent = {{ x = 1.0 }}\nbelt_velocity = 0.1\n{contact}[contact.friction]\n{LAW}{dither}"
        )
    };
    let ramp = |text: &str| {
        let study = Study::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"));
        verbs(&study).ramp().map(|done| done.json())
    };
    let load = base("[contact.load]\ntime = [0.0, 600.0]\nload = [0.01, 0.2]\n", "");
    let found = ramp(&load).unwrap_or_else(|why| panic!("{why}"));
    assert_eq!(found["parameter"], "contact.pad.normal_load");
    // 0.03 + F μ′(0.1) = 0, μ′(0.1) = −0.642938.
    let slope = -1.5 * (0.4 - 0.2857) / 0.2 * (1.0 - 0.25);
    close(number(&found["thresholds"][0]["value"]), -0.03 / slope, 1e-6, "threshold");
    assert_eq!(found["thresholds"][0]["kind"], "hopf");
    let switch = &found["switches"].as_array().expect("switches")[0];
    assert_eq!(switch["becomes"], "vibrating");
    assert!(number(&switch["value"]) > -0.03 / slope, "{switch}");
    let envelope = "[[dither]]\nat = { x = 1.0 }\nwaveform = \"sine\"\namplitude = 2.0\nfrequency = 10.0\n[dither.envelope]\n\
        time = [0.0, 600.0]\nshare = [0.0, 1.0]\n";
    let found = ramp(&base("normal_load = 0.3\n", envelope)).unwrap_or_else(|why| panic!("{why}"));
    assert_eq!(found["parameter"], "dither.amplitude");
    assert_eq!(number(&found["largest"]), 2.0);
    assert!(found["thresholds"].as_array().is_some_and(|all| !all.is_empty()), "{found}");
    // Two things that vary are no ramp, and neither is a steady study.
    let both = base("[contact.load]\ntime = [0.0, 600.0]\nload = [0.01, 0.2]\n", envelope);
    assert!(ramp(&both).is_err());
    assert!(ramp(&base("normal_load = 0.3\n", "")).is_err());
}
