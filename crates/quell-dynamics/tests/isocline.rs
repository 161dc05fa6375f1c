//! The amplitude at which E = 5 %, against `reference/quench_thresholds.json`.

use quell_dynamics::response::{Solver, amplitude_at_residual_vibration};
use quell_dynamics::simulation::Start;
use quell_model::{LawKind, Waveform};
use quell_zoo::BeltExt;
use quell_zoo::belt::dissertation;
use quell_zoo::dither::tangential;
use serde_json::Value;

const REFERENCE: &str = include_str!("../../../reference/quench_thresholds.json");

#[test]
fn residual_vibration_falls_through_five_per_cent_at_the_reference_amplitude() {
    let reference: Value = serde_json::from_str(REFERENCE).expect("reference file");
    let cases = reference["cases"].as_array().expect("cases");
    let number = |case: &Value, key: &str| case[key].as_f64().expect("a number");
    let solver = Solver { tolerance: 1e-10, ..Solver::default() };
    let mut checked = 0;
    let mut worst: f64 = 0.0;
    for case in cases {
        let Some(&[Value::Number(ref expected)]) = case["D_E5"].as_array().map(Vec::as_slice)
        else {
            panic!("one crossing in each case");
        };
        let expected = expected.as_f64().expect("a number");
        let named = |key: &str| case[key].as_str().expect("a name");
        let law = LawKind::from_name(named("law")).expect("a law");
        let waveform = Waveform::from_name(named("waveform"));
        let average = number(case, "D_average");
        let dither =
            tangential(waveform.expect("a waveform"), average, number(case, "frequency_ratio"));
        let belt = dissertation(law).at_speed(number(case, "belt_velocity")).with_dither(dither);
        let range = 0.7 * average..=1.15 * average;
        let found = amplitude_at_residual_vibration(&belt, Start::REST, &solver, 0.05, range, 1e-3);
        let found = found.unwrap_or_else(|| panic!("no crossing: {case}"));
        let deviation = (found / expected - 1.0).abs();
        worst = worst.max(deviation);
        assert!(deviation < 0.01, "D = {found}, reference {expected}: {case}");
        checked += 1;
    }
    assert!(checked >= 29, "{checked} cases");
    println!("{checked} cases, largest deviation {worst:.2e}");
}
