//! Extreme but valid studies: every verb ends in time, with an answer or a reason, and does not panic.
//!
//! A generator sets one to three parameters to their smallest or largest values and runs one verb. The test runs a few such
//! cases with a fixed seed, and cases that once did not terminate; `QUELL_EXTREMES=2000` runs 2000 random cases.

use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::place::Place;

const BELT: &str = "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.05\n\
    [friction]\nlaw = \"LAW\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n\
    [dither]\ndirection = \"DIRECTION\"\nwaveform = \"WAVEFORM\"\namplitude = 0.4\nfrequency_ratio = 10\n\
    [solver]\nsettle = 50\nrecord_periods = 4\n";

const SI: &str = "schema = 1\n[belt]\nmass_kg = 1\nstiffness_n_per_m = 1e4\ndamping_ratio = 0.005\n\
    normal_force_n = 10\nbelt_velocity_m_per_s = 0.05\n\
    [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\n\
    reference_velocity_m_per_s = 0.2\n\
    [dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude_n = 4\nfrequency_hz = 200\n\
    [solver]\nsettle_s = 1\nrecord_periods = 4\n";

const DISC: &str = "schema = 1\n[disc]\ninner_radius_ratio = 0.5\npoisson_ratio = 0.3\nradial_modes = 1\nnodal_diameters = 2\n\
    [disc.load]\nradius_ratio = 0.75\nmass = 0.1\ndamping = 0.1\nstiffness = 0.1\nfriction = 0.05\nspeed = 0.3\n\
    [dither]\namplitude = 0.3\nfrequency_ratio = 5\n";

type Values = &'static [(&'static str, &'static [f64])];

const TINY: f64 = 5e-324;
const HUGE: f64 = 1.7e308;

const OF_BELT: Values = &[
    ("belt.damping_ratio", &[0.0, TINY, 1e-15, 1e6, 1e15, 1e100, HUGE]),
    ("belt.normal_load", &[TINY, 1e-300, 1e-100, 1e-15, 1e15, 1e100, HUGE]),
    ("belt.belt_velocity", &[0.0, TINY, 1e-300, 1e-100, 1e-15, 1e15, 1e100, HUGE]),
    ("friction.static_coefficient", &[0.2857, 1e15, HUGE]),
    ("friction.minimum_coefficient", &[0.0, TINY, 0.4]),
    ("friction.reference_velocity", &[TINY, 1e-300, 1e-100, 1e-15, 1e15, 1e100, HUGE]),
    ("dither.amplitude", &[0.0, TINY, 1e-100, 1e-15, 1e15, 1e100, HUGE]),
    ("dither.frequency_ratio", &[TINY, 1e-300, 1e-100, 1e-15, 1e-6, 1e5]),
    ("dither.phase", &[-1e6, 1e6]),
    ("belt.initial.displacement", &[-HUGE, -1e100, 1e-300, 1e-15, 1e15]),
    ("belt.initial.velocity", &[-HUGE, 1e-300, 1e15, 1e100]),
    ("solver.tolerance", &[1e-15, 1e-3]),
];

const OF_SI: Values = &[
    ("belt.mass_kg", &[TINY, 1e-300, 1e-15, 1e15, 1e300]),
    ("belt.stiffness_n_per_m", &[TINY, 1e-300, 1e-15, 1e15, 1e300]),
    ("belt.normal_force_n", &[TINY, 1e-100, 1e15, 1e300]),
    ("belt.belt_velocity_m_per_s", &[TINY, 1e-100, 1e15, 1e300]),
    ("friction.reference_velocity_m_per_s", &[TINY, 1e-100, 1e15, 1e300]),
    ("dither.amplitude_n", &[TINY, 1e-100, 1e15, 1e300]),
    ("dither.frequency_hz", &[TINY, 1e-100, 1e-15, 1e6, 1e300]),
];

const OF_DISC: Values = &[
    ("disc.inner_radius_ratio", &[0.001, 0.05, 0.99, 0.999]),
    ("disc.poisson_ratio", &[0.0, 0.5]),
    ("disc.nodal_diameters", &[0.0, 1.0, 6.0]),
    ("disc.load.radius_ratio", &[0.5, 1.0]),
    ("disc.load.mass", &[0.0, TINY, 1e-100, 1e15, HUGE]),
    ("disc.load.damping", &[0.0, TINY, 1e15, HUGE]),
    ("disc.load.stiffness", &[0.0, TINY, 1e15, HUGE]),
    ("disc.load.friction", &[0.0, TINY, 1e15, HUGE]),
    ("disc.load.speed", &[0.0, TINY, 1e-15, 1e15, HUGE]),
    ("disc.damping_ratio", &[0.0, TINY, 1e-15, 1e15, HUGE]),
    ("dither.amplitude", &[0.0, TINY, 1e-15, 1e15, HUGE]),
    ("dither.frequency_ratio", &[TINY, 1e-300, 1e-15, 1e-6, 1e5]),
];

/// Verbs of a belt.
const BELT_VERBS: &[&str] = &[
    "check",
    "friction",
    "stability",
    "simulate --until 10",
    "response",
    "orbit",
    "orbit --from-rest",
    "thresholds --parameter dither.amplitude --from 0.1 --to 1",
    "thresholds --parameter dither.amplitude --from 0.1 --to 1 --from-rest",
    "bifurcation --parameter dither.amplitude --from 0.1 --to 1 --points 2 --up",
    "basins --grid 2x2",
];

const DISC_VERBS: &[&str] =
    &["check", "modes", "stability", "resonances", "resonances --clear 0.2:0.9 --frequency 2:6"];

/// Cases that once did not terminate, each with a different cause or verb.
const ONCE_ENDLESS: &[(&str, &[&str])] = &[
    // A loop that advances by a factor does not advance from the smallest number.
    ("stability", &["belt.belt_velocity=5e-324"]),
    ("stability", &["friction.reference_velocity=5e-324"]),
    // The tolerance is relative to F, and F is negligible compared with the other forces.
    ("simulate --until 10", &["belt.normal_load=1e-300"]),
    ("response", &["belt.normal_load=1e-15"]),
    ("orbit --from-rest", &["belt.normal_load=5e-324"]),
    ("simulate --until 10", &["dither.amplitude=1e15"]),
    ("response", &["belt.initial.displacement=1e15"]),
    // An equation so stiff that a period takes more steps than the time limit permits.
    ("simulate --until 10", &["belt.damping_ratio=1e15"]),
    ("response", &["belt.damping_ratio=1e15"]),
    ("orbit", &["belt.normal_load=1e15"]),
    (
        "thresholds --parameter dither.amplitude --from 0.1 --to 1",
        &["friction.static_coefficient=1e15"],
    ),
    ("basins --grid 2x2", &["friction.static_coefficient=1e15"]),
    // A period of the dither is 10¹⁵ periods of the oscillator.
    ("orbit", &["dither.frequency_ratio=1e-15"]),
    (
        "bifurcation --parameter dither.amplitude --from 0.1 --to 1 --points 2",
        &["dither.frequency_ratio=1e-100"],
    ),
    ("basins --grid 2x2", &["dither.frequency_ratio=1e-300"]),
    ("simulate --until 1e9", &["dither.frequency_ratio=1e5"]),
];

/// Random numbers of a linear congruential generator.
struct Dice(u64);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).expect("31 bits") % count
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }
}

/// Runs a verb and returns its exit status, or `None` if it does not end in time. Panics if the verb panics.
fn end(place: &Place, study: &str, verb: &str, changes: &[String]) -> Option<i32> {
    let mut words = verb.split(' ');
    let mut arguments: Vec<&str> = words.next().into_iter().chain([study]).chain(words).collect();
    for change in changes {
        arguments.extend(["--set", change]);
    }
    let mut command = place.command(&arguments);
    let child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
    let mut child = child.expect("quell runs");
    let begun = Instant::now();
    while child.try_wait().expect("it is ours").is_none() {
        if begun.elapsed() > Duration::from_mins(2) {
            child.kill().expect("it is ours");
            child.wait().expect("it ends");
            return None;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let done = child.wait_with_output().expect("it ended");
    let printed = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(!printed.contains("panicked"), "{study} {verb} {changes:?}: {printed}");
    let status = done.status.code().unwrap_or(-1);
    assert!([0, 1, 2].contains(&status), "{study} {verb} {changes:?}: {status} {printed}");
    assert!(status == 0 || !printed.is_empty(), "{study} {verb} {changes:?}: no reason");
    Some(status)
}

fn place(name: &str) -> Place {
    let plain = BELT
        .replace("LAW", "stribeck")
        .replace("DIRECTION", "tangential")
        .replace("WAVEFORM", "sine");
    Place::with(name, &[("belt.toml", &plain), ("si.toml", SI), ("disc.toml", DISC)])
}

#[test]
fn cases_that_once_did_not_terminate_end() {
    let place = place("extremes/known");
    for (verb, changes) in ONCE_ENDLESS {
        let changes: Vec<String> = changes.iter().map(|&change| change.to_owned()).collect();
        assert!(end(&place, "belt.toml", verb, &changes).is_some(), "{verb} {changes:?}: no end");
    }
}

#[test]
fn random_extreme_cases_end() {
    let place = place("extremes/random");
    let count = std::env::var("QUELL_EXTREMES").ok().and_then(|count| count.parse().ok());
    let mut dice = Dice(14);
    let mut endless = Vec::new();
    for _ in 0..count.unwrap_or(60) {
        let (study, values, verbs) = match dice.below(10) {
            0..6 => {
                let text = BELT
                    .replace("LAW", dice.one(&["stribeck", "decreasing"]))
                    .replace("DIRECTION", dice.one(&["tangential", "normal"]))
                    .replace("WAVEFORM", dice.one(&["sine", "triangle", "square"]));
                place.write("random.toml", text);
                ("random.toml", OF_BELT, BELT_VERBS)
            }
            6 | 7 => ("si.toml", OF_SI, BELT_VERBS),
            _ => ("disc.toml", OF_DISC, DISC_VERBS),
        };
        let verb = dice.one(verbs);
        let changes: Vec<String> = (0..=dice.below(3))
            .map(|_| {
                let (path, values) = dice.one(values);
                format!("{path}={:?}", dice.one(values))
            })
            .collect();
        if end(&place, study, verb, &changes).is_none() {
            endless.push(format!("{study} {verb} {changes:?}"));
        }
    }
    assert!(endless.is_empty(), "no end: {endless:#?}");
}
