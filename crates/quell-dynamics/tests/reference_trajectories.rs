//! Event times, kinds and states against `reference/trajectories.json` (two independent
//! integrators, good to all digits printed): within 1e-9, with the same kinds in the same order and
//! neither missing nor spurious events.

use quell_dynamics::simulation::{DEFAULT_TOLERANCE, EventKind, EventRecorder, Start, simulate};
use quell_model::{Belt, Direction, LawKind, Waveform};
use quell_zoo::dither::dither;
use serde_json::Value;

const TOLERANCE: f64 = 1e-9;

fn number(value: &Value) -> f64 {
    value.as_f64().or_else(|| value.as_str()?.parse().ok()).expect("a number or a number in quotes")
}

fn belt(case: &Value) -> Belt {
    let p = |key: &str| number(&case["params"][key]);
    let text = |key: &str| case[key].as_str().expect("text");
    let law = LawKind::from_name(text("law")).expect("a known law");
    let law = law.build(&[p("mu_s"), p("mu_m"), p("v_m")]).expect("valid law");
    let waveform = |key: &str| Waveform::from_name(text(key)).expect("a known waveform");
    let dithers = vec![
        dither(Direction::Tangential, waveform("wave_T"), p("D_T"), p("R_T")),
        dither(Direction::Normal, waveform("wave_N"), p("D_N"), p("R_N")),
    ];
    Belt::new(p("zeta"), p("F"), p("v0"), law, dithers).expect("valid belt")
}

#[test]
fn events_and_states_agree_with_independent_integrators() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../reference/trajectories.json");
    let text = std::fs::read_to_string(path).expect("reference/trajectories.json");
    let reference: Value = serde_json::from_str(&text).expect("JSON");
    let cases = reference["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 11);
    for case in cases {
        let name = case["name"].as_str().expect("name");
        let start = Start {
            time: 0.0,
            displacement: number(&case["x0"]),
            velocity: number(&case["xdot0"]),
        };
        let mut record = EventRecorder::default();
        let end = simulate(&belt(case), start, 50.0, DEFAULT_TOLERANCE, &mut record)
            .unwrap_or_else(|stalled| panic!("{name}: {stalled}"));
        let events = &record.events;
        let mut worst: f64 = 0.0;
        for (index, expected) in case["first_events"].as_array().expect("events").iter().enumerate()
        {
            let event = events[index];
            let kind = match expected["type"].as_str().expect("type") {
                "stick_start" => EventKind::Stick,
                "stick_end" => EventKind::Release,
                _ => EventKind::Reversal,
            };
            assert_eq!(event.kind, kind, "{name}, event {index} at {}", event.time);
            let sign = number(&expected["sign_vr_after"]);
            assert_eq!(f64::from(event.slip_sign), sign, "{name}, event {index}");
            worst = worst.max((event.time - number(&expected["t"])).abs());
            worst = worst.max((event.displacement - number(&expected["x"])).abs());
        }
        worst = worst.max((end.displacement - number(&case["state_at_50"]["x"])).abs());
        worst = worst.max((end.velocity - number(&case["state_at_50"]["xdot"])).abs());
        assert_eq!(end.sticking, case["sticking_at_50"].as_bool().expect("bool"), "{name}");
        assert_eq!(events.len() as u64, case["n_events_to_50"].as_u64().expect("count"), "{name}");
        println!("{name}: largest difference {worst:.1e}");
        assert!(worst < TOLERANCE, "{name}: largest difference {worst:e}");
    }
}
