//! Waveforms by harmonics, by samples and by bursts.
//!
//! Numbers: `reference/waveforms.json` (source and tolerance in `reference/README.md`).

use quell::Study;
use quell::kind::verbs;
use quell::run::orbit::Wanted;
use quell::run::{friction, simulate};
use quell::study::BeltStudy;
use quell_linear::averaging::{
    AveragingOptions, Becomes, CrossingKind, FastResponse, critical_amplitudes,
};
use serde_json::Value as Json;

fn reference() -> Json {
    serde_json::from_str(include_str!("../../../reference/waveforms.json")).expect("JSON")
}

fn number(value: &Json) -> f64 {
    value.as_f64().or_else(|| value.as_str()?.parse().ok()).expect("a number")
}

fn numbers(value: &Json) -> Vec<f64> {
    value.as_array().expect("numbers").iter().map(number).collect()
}

fn study(text: &str) -> BeltStudy {
    BeltStudy::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

fn refused(text: &str) -> String {
    let wrong = BeltStudy::parse(text, &[]).expect_err(text);
    wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

#[test]
fn events_and_states_agree_with_independent_integrators() {
    let reference = reference();
    let cases = reference["trajectories"].as_array().expect("cases");
    assert_eq!(cases.len(), 9);
    for case in cases {
        let study = study(case["study"].as_str().expect("text"));
        let options = simulate::Options { events: true, ..simulate::Options::default() };
        let run = simulate::run(&study, number(&case["until"]), options).expect("a run");
        let events = run.events.expect("events");
        assert_eq!(run.end.events, case["n_events"].as_u64().expect("a count"), "{}", case["name"]);
        for (event, expected) in events.iter().zip(case["events"].as_array().expect("events")) {
            let kind = expected["kind"].as_str().expect("a kind");
            assert_eq!(event.kind.name(), kind, "{} {event:?}", case["name"]);
            assert!((event.time - number(&expected["time"])).abs() < 1e-9, "{event:?}: {expected}");
            let moved = (event.displacement - number(&expected["displacement"])).abs();
            assert!(moved < 1e-9, "{event:?}: {expected}");
        }
        let end = &case["final"];
        let name = &case["name"];
        assert!((run.end.displacement - number(&end["displacement"])).abs() < 1e-9, "{name}");
        assert!((run.end.velocity - number(&end["velocity"])).abs() < 1e-9, "{name}");
    }
}

#[test]
fn averages_are_those_of_the_definition() {
    for row in reference()["averaged"].as_array().expect("rows") {
        let study = study(row["study"].as_str().expect("text"));
        let ratio = number(&row["frequency_ratio"]);
        let waveform = study.belt().dithers()[0].waveform.clone();
        let (least, largest) = waveform.integral_range();
        let shape = &row["waveform"];
        assert!((largest - number(&shape["G_max"])).abs() < 1e-12, "{row}: {largest}");
        assert!((least - number(&shape["G_min"])).abs() < 1e-12, "{row}: {least}");
        let mean_square = waveform.mean_square_integral();
        assert!((mean_square / number(&shape["G_mean_square"]) - 1.0).abs() < 1e-12, "{row}");
        for case in row["effective"].as_array().expect("cases") {
            let alpha = number(&case["amplitude_ratio"]);
            let study = study.with("dither.amplitude", alpha * ratio).expect("an amplitude");
            let found = friction::run(&study, &numbers(&case["slip_velocity"]));
            let values = found.effective_coefficients().into_iter().zip(found.effective_slopes());
            let expected = numbers(&case["coefficient"]).into_iter().zip(numbers(&case["slope"]));
            for ((value, slope), (exact, exact_slope)) in values.zip(expected) {
                assert!((value - exact).abs() < 1e-10 * exact.abs(), "{row}: {value} {exact}");
                assert!((slope - exact_slope).abs() < 1e-9, "{row}: {slope} {exact_slope}");
            }
        }
        let stability = &row["stability"];
        let belt = study.belt();
        assert_eq!(belt.belt_velocity(), number(&stability["belt_velocity"]));
        let found = critical_amplitudes(belt, AveragingOptions::default()).expect("an average");
        let end = number(&stability["scanned_to"]);
        let found: Vec<_> =
            found.iter().filter(|critical| critical.amplitude_ratio < end).collect();
        let expected = stability["critical_amplitudes"].as_array().expect("amplitudes");
        assert_eq!(found.len(), expected.len(), "{row}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            let exact = number(&expected["amplitude_ratio"]);
            assert!((found.amplitude_ratio / exact - 1.0).abs() < 1e-9, "{row}: {found:?}");
            let jumps = expected["kind"] == "jump";
            assert_eq!(found.crossing == CrossingKind::Jump, jumps, "{row}");
            assert_eq!(found.becomes == Becomes::Stable, expected["becomes"] == "stable", "{row}");
        }
    }
}

#[test]
fn a_burst_without_pause_is_its_carrier() {
    for case in reference()["no_pause"].as_array().expect("cases") {
        let [burst, carrier] =
            ["burst", "carrier"].map(|name| study(case[name].as_str().expect("text")));
        assert_eq!(burst.belt(), carrier.belt());
    }
}

/// A sum of one harmonic is a sine of another amplitude and frequency, under both kinds of averaging.
#[test]
fn one_harmonic_is_a_sine() {
    let critical = |keys: &str, ratio: &str, response| {
        let text = with("tangential", keys).replace("frequency_ratio = 10.0", ratio);
        let options = AveragingOptions { response, ..AveragingOptions::default() };
        critical_amplitudes(study(&text).belt(), options).expect("an average")
    };
    for response in [FastResponse::Limit, FastResponse::Oscillator] {
        let half = "waveform = \"fourier\"\nharmonics = [{ order = 2, sine = 0.3, cosine = 0.4 }]";
        let found = critical(half, "frequency_ratio = 10.0", response);
        let sine = critical("waveform = \"sine\"", "frequency_ratio = 20.0", response);
        assert_eq!(found.len(), sine.len());
        for (found, sine) in found.iter().zip(&sine) {
            assert!(
                (found.amplitude / (2.0 * sine.amplitude) - 1.0).abs() < 1e-12,
                "{found:?} {sine:?}"
            );
            assert_eq!(found.crossing, sine.crossing);
        }
    }
}

const BELT: &str = "[belt]\ndamping_ratio = 0.01\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
     static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\namplitude = 0.5\n\
     frequency_ratio = 10.0\n";

fn with(direction: &str, keys: &str) -> String {
    format!("{BELT}direction = \"{direction}\"\n{keys}\n")
}

/// 1000 samples of a sine that are held: nearly the sine.
#[test]
fn held_samples_of_a_sine_are_nearly_a_sine() {
    let values: Vec<String> = (0..1000)
        .map(|k| format!("{:?}", (std::f64::consts::TAU * (f64::from(k) + 0.5) / 1000.0).sin()))
        .collect();
    let keys = format!("waveform = \"samples\"\nhold = \"zero\"\nvalues = [{}]", values.join(", "));
    let [held, sine] = [keys.as_str(), "waveform = \"sine\""].map(|keys| {
        critical_amplitudes(study(&with("tangential", keys)).belt(), AveragingOptions::default())
            .expect("an average")
    });
    assert_eq!(held.len(), sine.len());
    for (held, sine) in held.iter().zip(&sine) {
        assert!((held.amplitude_ratio / sine.amplitude_ratio - 1.0).abs() < 1e-5, "{held:?}");
    }
}

#[test]
fn wrong_waveforms_are_refused_with_the_place() {
    for (keys, complaints) in [
        ("waveform = \"sin\"", "did you mean"),
        ("waveform = \"sine\"\non = 3", "dither.on"),
        ("waveform = \"fourier\"", "dither.harmonics"),
        ("waveform = \"fourier\"\nharmonics = []", "1 to 1000 harmonics"),
        ("waveform = \"fourier\"\nharmonics = [{ sine = 1.0 }]", "dither.harmonics[0]"),
        (
            "waveform = \"fourier\"\nharmonics = [{ order = 0, sine = 1.0 }]",
            "dither.harmonics[0].order",
        ),
        ("waveform = \"fourier\"\nharmonics = [{ order = 2, sine = 0.0 }]", "not all zero"),
        (
            "waveform = \"fourier\"\nharmonics = [{ order = 2, sinus = 1.0 }]",
            "dither.harmonics[0].sinus",
        ),
        ("waveform = \"samples\"\nvalues = [1.0]", "2 to 1000000 samples"),
        ("waveform = \"samples\"\nvalues = [1.0, 1.0]", "samples that differ"),
        ("waveform = \"samples\"\nvalues = [1.0, nan]", "sample 1"),
        ("waveform = \"samples\"\nvalues = [1.0, 2.0]\nhold = \"cubic\"", "dither.hold"),
        ("waveform = \"burst\"\ncarrier = \"sine\"\non = 0\noff = 2", "dither.on"),
        ("waveform = \"burst\"\ncarrier = \"sine\"\non = 2.5\noff = 2", "whole number"),
        ("waveform = \"burst\"\ncarrier = \"burst\"\non = 2\noff = 2", "dither.carrier"),
        ("waveform = \"burst\"\non = 2\noff = 2", "dither.carrier"),
    ] {
        let said = refused(&with("tangential", keys));
        assert!(said.contains(complaints), "{keys}: {said}");
    }
    // The load of a waveform with a deep minimum must stay positive.
    let deep = "waveform = \"samples\"\nvalues = [3.0, 0.0, 0.0, 0.0]\nhold = \"zero\"";
    let upside_down = "waveform = \"samples\"\nvalues = [-3.0, 0.0, 0.0, 0.0]\nhold = \"zero\"";
    study(&with("normal", deep));
    assert!(refused(&with("normal", upside_down)).contains("dither.amplitude"));
}

/// The same dither on the same mass, as a belt and as a system: the same periodic motion, by two engines.
#[test]
fn a_belt_and_a_system_have_the_same_periodic_motion() {
    for keys in [
        "waveform = \"burst\"\ncarrier = \"sine\"\non = 3\noff = 2",
        "waveform = \"burst\"\ncarrier = \"triangle\"\non = 2\noff = 1",
        "waveform = \"samples\"\nvalues = [0.3, 1.0, -0.4, -1.2, 0.5]",
        "waveform = \"samples\"\nhold = \"zero\"\nvalues = [0.3, 1.0, -0.4, -1.2, 0.5]",
        "waveform = \"fourier\"\nharmonics = [{ order = 1, sine = 1.0 }, { order = 4, cosine = 0.3 }]",
    ] {
        let system = format!(
            "[system]\ncoordinates = [\"x\"]\nmass = [1.0]\ndamping = [0.02]\nstiffness = [1.0]\n[[contact]]\nname = \"belt\"\n\
             tangent = {{ x = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n[contact.friction]\nlaw = \"stribeck\"\n\
             static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[[dither]]\nat = {{ x = 1.0 }}\n\
             {keys}\namplitude = 1.5\nfrequency = 10.0\n"
        );
        let belt = with("tangential", keys).replace("amplitude = 0.5", "amplitude = 1.5");
        let facts = [belt, system].map(|text| {
            let study =
                Study::parse(&text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"));
            verbs(&study).orbit(Wanted::default()).expect("an orbit").facts()
        });
        let [belt, system] = &facts;
        assert!(
            (number(&belt["period"]) / number(&system["period"]) - 1.0).abs() < 1e-14,
            "{keys}"
        );
        let leading = numbers(&belt["multipliers"][0]);
        let radius = leading[0].hypot(leading[1]);
        assert!((radius - number(&system["radius"])).abs() < 1e-8, "{facts:?}");
        let state = numbers(&system["state"]);
        assert!((number(&belt["displacement"]) - state[0]).abs() < 1e-9, "{keys}: {facts:?}");
        assert!((number(&belt["velocity"]) - state[1]).abs() < 1e-9, "{keys}");
        assert_eq!(belt["verdict"], system["verdict"], "{keys}");
    }
}
