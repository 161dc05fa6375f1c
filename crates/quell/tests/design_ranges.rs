//! The range that one dither serves where none serves the whole box, and the amplitude at which a least dither is verified.
//!
//! Points that must not be in a range: an independent program found there an orbit of pure slip with a multiplier of 1.20 to 1.21 under the
//! amplitude that a design had named. The end of a range under a largest force: a bisection of the exact threshold by that program.

use quell::Study;
use quell::verbs::verbs;
use serde_json::Value as Json;

/// The answer of `design`.
fn facts(text: &str) -> Json {
    let study = Study::parse(text, &[]).unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    verbs(&study).design().unwrap_or_else(|why| panic!("{why}")).facts()
}

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} should be a number"))
}

/// A mass on a belt with an absorber, dithered at the contact at ω = 10. At the stiffness 100 m of the absorber the contact does not move.
fn absorber(mass: f64, stiffness: f64, to: f64) -> String {
    let damping = 2e-4 * (stiffness * mass).sqrt();
    format!(
        "[system]\ncoordinates = [\"c\", \"a\"]\nmass = [1.0, {mass:?}]\n\
         damping = [[{}, {}], [{}, {damping:?}]]\nstiffness = [[\"1 + kk\", \"-kk\"], [\"-kk\", \"kk\"]]\nobserve = {{ c = 1.0 }}\n\
         [parameters]\nkk = {stiffness:?}\n[[contact]]\nname = \"g\"\ntangent = {{ c = 1.0 }}\nnormal_load = 1.0\nbelt_velocity = 0.1\n\
         [contact.friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
         [[dither]]\nat = {{ c = 1.0 }}\nwaveform = \"sine\"\namplitude = 1.0\nfrequency = 10.0\n[design]\nminimise = \"amplitude\"\n\
         vary = [\"dither.amplitude\"]\nfrom = [0.1]\nto = [{to:?}]\n[design.over]\n\"parameters.kk\" = [{:?}, {:?}]\n",
        0.02 + damping,
        -damping,
        -damping,
        0.5 * stiffness,
        1.5 * stiffness
    )
}

/// An antiresonance of the structure is loud over a hundredth to a thousandth of the box.
#[test]
fn a_range_has_no_narrow_loud_interval_in_it() {
    for (mass, stiffness, to, loud) in [(0.02, 2.0274, 12.0, 2.0), (0.0005, 0.050_685, 1.5, 0.05)] {
        let found = facts(&absorber(mass, stiffness, to));
        let Some(ends) = found["covered"]["parameters.kk"].as_array() else {
            // The whole box is served, or no dither was found to serve a part of it.
            assert!(!found["why"]["covered"].is_null(), "{mass}: {found}");
            continue;
        };
        let (low, high) = (number(&ends[0]), number(&ends[1]));
        assert!(!(low..=high).contains(&loud), "{mass}: {low} to {high}");
        assert!(high > low && number(&found["examined"]["points"]) > 30.0, "{found}");
        // What is next to an end inside the box was judged.
        let (from, till) = (0.5 * stiffness, 1.5 * stiffness);
        for (side, end, of_box) in [("below", low, from), ("above", high, till)] {
            let beyond = &found["examined"][side];
            assert_eq!(beyond == "not examined", end == of_box, "{mass} {side}: {found}");
        }
    }
}

/// A belt in SI under a stack of 2 kN, whose dither has at most 1 kN.
fn stack(from: f64, to: f64) -> String {
    format!(
        "[belt]\nmass_kg = 0.5\nnatural_frequency_hz = 5600.0\ndamping_ratio = 0.005\nnormal_force_n = 4000.0\n\
         belt_velocity_m_per_s = 0.1\n[friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\n\
         reference_velocity_m_per_s = 0.2\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude_n = 900.0\n\
         frequency_hz = 20000.0\n[actuator]\nkind = \"piezo\"\nblocked_force_n = 2000.0\n[design]\nminimise = \"amplitude\"\n\
         vary = [\"dither.amplitude_n\"]\nfrom = [10.0]\nto = [20000.0]\n[design.over]\n\
         \"belt.belt_velocity_m_per_s\" = [{from:?}, {to:?}]\n"
    )
}

/// With the largest force that the actuator can give, belts up to 0.017243 m/s are quiet in any box.
#[test]
fn the_end_of_a_range_does_not_depend_on_the_box() {
    for (from, to) in [(0.01, 0.19), (0.01, 0.05), (0.004, 0.12)] {
        let found = facts(&stack(from, to));
        assert_eq!(found["feasible"], false);
        let ends = &found["covered"]["belt.belt_velocity_m_per_s"];
        assert_eq!(number(&ends[0]), from, "{found}");
        assert!((number(&ends[1]) / 0.017_243 - 1.0).abs() < 1e-4, "{from} to {to}: {ends}");
        let amplitude = number(&found["parameters"]["dither.amplitude_n"]);
        assert!((amplitude / 1000.0 - 1.0).abs() < 1e-6 && amplitude <= 1000.001, "{amplitude}");
        assert_eq!(found["examined"]["below"], "not examined");
        assert_ne!(found["examined"]["above"], "not examined");
        let sentence = found["sentence"].as_str().expect("a sentence");
        assert!(sentence.contains("below 0.0"), "{sentence}");
    }
}

/// A limit on the loss of friction that the choice of the frequency uses wholly is kept, not exceeded by the rounding of the search.
#[test]
fn a_limit_that_is_used_wholly_is_kept() {
    let text = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
                static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\ndirection = \"tangential\"\n\
                waveform = \"sine\"\namplitude = 0.5\nfrequency_ratio = 10.0\n[design]\nminimise = \"amplitude\"\n\
                vary = [\"dither.amplitude\", \"dither.frequency_ratio\"]\nfrom = [0.01, 2.0]\nto = [20.0, 20.0]\n[design.over]\n\
                \"belt.belt_velocity\" = [0.05, 0.06]\n[design.limits]\nfriction_loss = 0.1\n";
    let found = facts(text);
    let sentence = found["sentence"].as_str().expect("a sentence");
    assert!(!sentence.contains(" 1 times its limit"), "{sentence}");
    if found["feasible"] == true {
        assert!(number(&found["friction_loss"]) <= 0.1 * (1.0 + 2e-6), "{found}");
    } else {
        assert!(!found["covered"].is_null(), "{found}");
    }
}

const BELT: &str = "[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\nlaw = \"stribeck\"\n\
                    static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
                    direction = \"tangential\"\nwaveform = \"sine\"\namplitude = 1.0\nfrequency_ratio = 10.0\n\
                    [design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\"]\nfrom = [0.01]\n";

/// The margin ends where the range of amplitudes ends: the dither is verified there.
#[test]
fn no_dither_is_beyond_its_range() {
    let with = |to: f64| facts(&format!("{BELT}to = [{to:?}]\n"));
    let free = with(20.0);
    let least = number(&free["critical"]["dither.amplitude"]);
    assert_eq!(number(&free["margin"]), 1e-3);
    let to = least * 1.0004;
    let tight = with(to);
    assert_eq!(tight["feasible"], true, "{tight}");
    assert_eq!(number(&tight["parameters"]["dither.amplitude"]), to);
    assert!((number(&tight["margin"]) - 4e-4).abs() < 1e-9);
    let below = with(least * 0.999);
    assert_eq!(below["feasible"], false, "{below}");
    // A limit on the amplitude is the end of its range.
    let limited = facts(&format!("{BELT}to = [20.0]\n[design.limits]\namplitude = {to:?}\n"));
    assert_eq!(number(&limited["parameters"]["dither.amplitude"]), to, "{limited}");
}
