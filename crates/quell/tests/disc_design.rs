//! `design` of a disc: its answer as JSON, speeds and frequencies in SI, other waveforms, and refusals.

use quell::Study;
use quell::verbs::verbs;
use serde_json::Value as Json;

use crate::designs::{complaint, facts};

/// A friction just above that of a backward wave, which normal dither of this frequency quenches.
const DISC: &str = "[disc]\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n\
                    modal_damping = 1e-3\n[disc.load]\nradius_ratio = 0.75\nmass = 0.1\ndamping = 0.1\nstiffness = 0.1\n\
                    friction = 0.15\nspeed = 0.4\n";

const NORMAL: &str = "[dither]\ndirection = \"normal\"\namplitude = 1.0\nfrequency_ratio = 2.7\n";

const DESIGN: &str = "[design]\nminimise = \"amplitude\"\nvary = [\"dither.amplitude\"]\nfrom = [0.0]\nto = [1.0]\n\
                      [design.over]\n\"disc.load.speed\" = [0.695, 0.705]\n";

fn number(value: &Json) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

#[test]
fn the_answer_has_the_least_amplitude_and_its_verification() {
    let found = facts(&format!("{DISC}{NORMAL}{DESIGN}"));
    assert_eq!((&found["feasible"], &found["waveform"]), (&true.into(), &"sine".into()));
    let least = number(&found["critical"]["dither.amplitude"]);
    assert!(least > 0.0 && least < 1.0, "{found}");
    let verified = number(&found["parameters"]["dither.amplitude"]);
    assert!((verified / least - 1.001).abs() < 1e-12);
    assert!((0.695..=0.705).contains(&number(&found["worst"]["disc.load.speed"])));
    assert!(number(&found["verified"]["growth_rate"]) < 0.0, "{found}");
    assert!(number(&found["verified"]["multiplier"]) < 1.0);
    assert_eq!(found["friction_loss"], 0.0);
    // The stability of the study there.
    let at =
        format!("{DISC}{}", NORMAL.replace("amplitude = 1.0", &format!("amplitude = {verified}")));
    let at = at.replace("speed = 0.4", &format!("speed = {}", found["worst"]["disc.load.speed"]));
    let study = Study::parse(&at, &[]).expect("valid");
    let stability = verbs(&study).stability().expect("finite").facts();
    assert_eq!(stability["verdict"], "stable", "{stability}");
}

#[test]
fn speeds_may_be_given_in_si() {
    let si = DISC.replace(
        "poisson_ratio = 0.3\n",
        "poisson_ratio = 0.3\nyoungs_modulus_pa = 110e9\ndensity_kg_per_m3 = 7200\nthickness_m = 0.01\nouter_radius_m = 0.15\n",
    );
    let plain = facts(&format!("{DISC}{NORMAL}{DESIGN}"));
    let study = Study::parse(&format!("{si}{NORMAL}"), &[]).expect("valid");
    let modes = verbs(&study).modes().expect("modes").facts();
    let hertz = number(&modes["reference"]) / std::f64::consts::TAU;
    let rpm = |speed: f64| 60.0 * hertz * speed;
    let range = format!("\"disc.load.speed_rpm\" = [{}, {}]", rpm(0.695), rpm(0.705));
    let asked = DESIGN.replace("\"disc.load.speed\" = [0.695, 0.705]", &range);
    let load = si.replace("speed = 0.4", &format!("speed_rpm = {}", rpm(0.4)));
    let found = facts(&format!("{load}{NORMAL}{asked}"));
    let same = |path: &str| {
        let ratio =
            number(&found[path]["dither.amplitude"]) / number(&plain[path]["dither.amplitude"]);
        assert!((ratio - 1.0).abs() < 1e-6, "{path}: {ratio}");
    };
    same("critical");
    same("parameters");
    let worst = number(&found["worst"]["disc.load.speed_rpm"]);
    assert!((worst / rpm(number(&plain["worst"]["disc.load.speed"])) - 1.0).abs() < 1e-6);
}

#[test]
fn what_a_disc_does_not_have_is_refused() {
    let whole = format!("{DISC}{NORMAL}{DESIGN}");
    for (from, to, key) in [
        ("minimise = \"amplitude\"", "minimise = \"stroke\"", "design.minimise"),
        ("[design.over]", "[design.limits]\npower = 1.0\n[design.over]", "design.limits.power"),
        ("minimise", "start = \"rest\"\nminimise", "design.start"),
        ("vary = [\"dither.amplitude\"]", "vary = [\"disc.load.friction\"]", "design.vary"),
        ("to = [1.0]", "to = [1.5]", "design.vary"),
        ("\"disc.load.speed\"", "\"belt.belt_velocity\"", "design.over"),
        (NORMAL, "", "dither"),
        ("[disc.load]", "without = [\"dither\"]\n[disc.load]", "disc.without"),
    ] {
        let said = complaint(&whole.replacen(from, to, 1));
        assert!(said.contains(key), "{to}: {said}");
    }
    assert!(complaint(&format!("{DISC}{NORMAL}")).contains("design"));
}
