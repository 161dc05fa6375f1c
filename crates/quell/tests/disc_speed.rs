//! The speed of a disc over time: runs against Runge–Kutta steps of the equations, moments, and refusals.

use std::path::Path;

use quell::run::disc::motion;
use quell::run::disc::resonances::ResonancesRequest;
use quell::run::simulate::MotionRequest;
use quell::study::{DiscStudy, Study};
use quell::verbs::verbs;
use quell_dynamics::motion::MotionStart;
use serde_json::Value as Json;

const MODES: &str = "schema = 1\n[disc]\n\
    [[disc.mode]]\ndiameters = 0\nratio = 1.6\nshape_at_load = 0.8\ndamping = 0.02\n\
    [[disc.mode]]\ndiameters = 2\nratio = 2.0\nshape_at_load = 0.9\ndamping = 0.01\n\
    [[disc.mode]]\ndiameters = 3\nratio = 3.1\nshape_at_load = -0.7\ndamping = 0.015\n";

const LOAD: &str = "[disc.load]\nmass = 0.3\ndamping = 0.05\nstiffness = 0.4\nfriction = 0.2\n";

const DITHER: &str = "[dither]\ndirection = \"normal\"\namplitude = 0.6\nfrequency_ratio = 2.7\n";

/// Diameters, β, φ and ξ of the modes.
const GIVEN: [(f64, f64, f64, f64); 3] =
    [(0.0, 1.6, 0.8, 0.02), (2.0, 2.0, 0.9, 0.01), (3.0, 3.1, -0.7, 0.015)];

fn read(text: &str) -> DiscStudy {
    DiscStudy::parse_in(text, &[], Path::new("")).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

fn study(text: &str) -> Study {
    Study::parse(text, &[]).unwrap_or_else(|wrong| panic!("{text}\n{wrong:?}"))
}

fn refused(text: &str) -> String {
    let wrong = Study::parse(text, &[]).expect_err(text);
    wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

fn ran(text: &str, state: &[f64], until: f64) -> (Vec<f64>, Json) {
    let from = Some(MotionStart { time: 0.0, state: state.to_vec() });
    let request = MotionRequest { until: Some(until), from, ..MotionRequest::default() };
    let disc = read(text);
    let done = motion::run(&disc, &request).expect("a motion");
    (done.motion.end.state.clone(), done.json(&disc))
}

/// Rates of (A₀, A₁, B₁, A₂, B₂, and their rates) by (5.18), (5.22) with Euler's term, a load m, c, k at φ = 0 whose friction
/// follows its load 1 + kw + cw′, and normal dither. The mass of the load gives (1 + m Σφ²) w″ = Σφa.
fn rates(time: f64, y: &[f64], (speed, rate): (f64, f64)) -> Vec<f64> {
    let (mass, damper, spring, friction) = (0.3, 0.05, 0.4, 0.2);
    let factor = 1.0 + 0.6 * (2.7 * time).cos();
    // Places of A of each mode; B follows.
    let places = [0usize, 1, 3];
    let (mut w, mut w_rate, mut slope) = (0.0, 0.0, 0.0);
    for ((q, _, shape, _), at) in GIVEN.iter().zip(places) {
        w += shape * y[at];
        w_rate += shape * y[5 + at];
        if *q > 0.0 {
            slope += q * shape * y[at + 1];
        }
    }
    let load = 1.0 + spring * w + damper * w_rate;
    let force = -(damper * w_rate + spring * w - friction * factor * load * slope);
    let mut out = vec![0.0; 10];
    out[..5].copy_from_slice(&y[5..]);
    let (mut sum, mut squares) = (0.0, 0.0);
    for ((q, ratio, shape, damping), at) in GIVEN.iter().zip(places) {
        let loss = 2.0 * damping * ratio;
        let stiffness = ratio * ratio - q * q * speed * speed;
        let (a, a_rate) = (y[at], y[5 + at]);
        let (b, b_rate) = if *q > 0.0 { (y[at + 1], y[6 + at]) } else { (0.0, 0.0) };
        let first = 2.0 * q * speed * b_rate + q * rate * b
            - stiffness * a
            - loss * (a_rate - q * speed * b)
            + shape * force;
        if *q > 0.0 {
            out[6 + at] = -2.0 * q * speed * a_rate
                - q * rate * a
                - stiffness * b
                - loss * (b_rate + q * speed * a);
        }
        out[5 + at] = first;
        sum += shape * first;
        squares += shape * shape;
    }
    let acceleration = sum / (1.0 + mass * squares);
    for ((_, _, shape, _), at) in GIVEN.iter().zip(places) {
        out[5 + at] -= shape * mass * acceleration;
    }
    out
}

/// Steps of the fourth order, none over a knot; `speed` gives Ω and Ω′ within the piece of a middle.
fn by_runge_kutta(
    state: &[f64],
    until: f64,
    knots: &[f64],
    speed: impl Fn(f64, f64) -> (f64, f64),
) -> Vec<f64> {
    let mut cuts = vec![0.0];
    cuts.extend(knots.iter().filter(|knot| **knot > 0.0 && **knot < until));
    cuts.push(until);
    let mut state = state.to_vec();
    for ends in cuts.windows(2) {
        let middle = 0.5 * (ends[0] + ends[1]);
        let count = ((ends[1] - ends[0]) / 1e-3).ceil();
        let step = (ends[1] - ends[0]) / count;
        let at = |time: f64, y: &[f64]| rates(time, y, speed(time, middle));
        for time in
            (0..).map(|k| ends[0] + step * f64::from(k)).take_while(|at| *at < ends[1] - 0.5 * step)
        {
            let moved = |slope: &[f64], by: f64| -> Vec<f64> {
                state.iter().zip(slope).map(|(y, slope)| y + by * slope).collect()
            };
            let one = at(time, &state);
            let two = at(time + 0.5 * step, &moved(&one, 0.5 * step));
            let three = at(time + 0.5 * step, &moved(&two, 0.5 * step));
            let four = at(time + step, &moved(&three, step));
            state = (0..10)
                .map(|i| state[i] + step / 6.0 * (one[i] + 2.0 * (two[i] + three[i]) + four[i]))
                .collect();
        }
    }
    state
}

fn start() -> Vec<f64> {
    (0..10).map(|i| 0.02 * (1.0 + f64::from(i) / 7.0)).collect()
}

fn agree(drive: &str, knots: &[f64], speed: impl Fn(f64, f64) -> (f64, f64)) -> Json {
    let (found, json) = ran(&format!("{MODES}{LOAD}{drive}{DITHER}"), &start(), 11.0);
    let wanted = by_runge_kutta(&start(), 11.0, knots, speed);
    let largest = wanted.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    for (found, wanted) in found.iter().zip(&wanted) {
        // The error of the steps: (ωh)⁴/120 · ωt ≈ 10⁻¹¹ for the fastest mode, ω = 3.1 + 3Ω.
        assert!((found - wanted).abs() < 1e-9 * largest, "{drive}: {found} {wanted}");
    }
    json
}

#[test]
fn runs_at_a_speed_over_time_are_those_of_runge_kutta() {
    let line = |time: f64, middle: f64| {
        let slope = 0.7 / 6.3;
        match middle {
            at if at < 1.0 => (0.2, 0.0),
            at if at < 7.3 => (0.2 + slope * (time - 1.0), slope),
            _ => (0.9, 0.0),
        }
    };
    let json = agree("[disc.drive]\ntime = [1.0, 7.3]\nspeed = [0.2, 0.9]\n", &[1.0, 7.3], line);
    assert!(json["manoeuvre"].is_object(), "{json}");
    assert!(json["why"]["growth_observed"].as_str().is_some_and(|why| why.contains("speed")));
    let smooth = |time: f64, middle: f64| {
        let s = (time - 1.0) / 6.3;
        match middle {
            at if at < 1.0 => (0.2, 0.0),
            at if at < 7.3 => {
                (0.2 + 0.7 * s * s * (3.0 - 2.0 * s), 0.7 * 6.0 * s * (1.0 - s) / 6.3)
            }
            _ => (0.9, 0.0),
        }
    };
    let table = "[disc.drive]\ntime = [1.0, 7.3]\nspeed = [0.2, 0.9]\nshape = \"smooth\"\n";
    agree(table, &[1.0, 7.3], smooth);
}

#[test]
fn an_oscillating_speed_is_about_that_of_the_loads() {
    let drive =
        "[disc.drive]\noscillation = { amplitude = 0.3, frequency_ratio = 0.8, phase = 0.4 }\n";
    let load = LOAD.replace("[disc.load]\n", "[disc.load]\nspeed = 0.5\n");
    let (found, _) = ran(&format!("{MODES}{load}{drive}{DITHER}"), &start(), 11.0);
    let wanted = by_runge_kutta(&start(), 11.0, &[], |time, _| {
        let phase = 0.8 * time + 0.4;
        (0.5 + 0.3 * phase.sin(), 0.24 * phase.cos())
    });
    let largest = wanted.iter().fold(0.0, |most: f64, y| most.max(y.abs()));
    for (found, wanted) in found.iter().zip(&wanted) {
        assert!((found - wanted).abs() < 1e-9 * largest, "{found} {wanted}");
    }
}

#[test]
fn constant_knots_are_the_constant_speed() {
    let load = LOAD.replace("[disc.load]\n", "[disc.load]\nspeed = 0.5\n");
    let (plain, json) = ran(&format!("{MODES}{load}{DITHER}"), &start(), 20.0);
    assert!(json.get("manoeuvre").is_none_or(Json::is_null));
    let drive = "[disc.drive]\ntime = [0.0, 4.0]\nspeed = [0.5, 0.5]\n";
    let (table, _) = ran(&format!("{MODES}{LOAD}{drive}{DITHER}"), &start(), 20.0);
    for (plain, table) in plain.iter().zip(&table) {
        assert!((plain - table).abs() < 1e-12, "{plain} {table}");
    }
}

#[test]
fn a_law_slips_at_the_speed_of_the_moment() {
    let pad = "[disc.load]\nmass = 0.1\nstiffness = 0.4\nnormal_load = 0.5\n\
        [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.5\nminimum_coefficient = 0.3\nreference_velocity = 2.0\n";
    let drive = "[disc.drive]\ntime = [0.0, 10.0]\nspeed = [0.9, 0.3]\n";
    let disc = read(&format!("{MODES}{pad}{drive}"));
    for (until, speed) in [(2.0, 0.78), (10.0, 0.3), (12.0, 0.3)] {
        let request = MotionRequest { until: Some(until), ..MotionRequest::default() };
        let done = motion::run(&disc, &request).expect("a motion");
        let contact = done.motion.end.contacts[0];
        assert!((contact.slip_velocity - speed).abs() < 1e-13, "{contact:?}");
        let law = disc.disc().law().expect("a law");
        let friction = law.coefficient(speed) * contact.normal_load;
        assert!((contact.friction - friction).abs() < 1e-12, "{contact:?}");
    }
}

#[test]
fn a_moment_is_a_steady_study() {
    let drive = "[disc.drive]\ntime = [0.0, 10.0]\nspeed = [0.2, 0.6]\n";
    let whole = study(&format!("{MODES}{LOAD}{drive}"));
    assert_eq!(whole.varies_by(), Some("disc.drive"));
    assert!(whole.number("disc.load.speed").is_none());
    let refusing = verbs(&whole);
    for reply in
        [refusing.stability(), refusing.modes(), refusing.resonances(ResonancesRequest::default())]
    {
        let Err(why) = reply else { panic!("an answer about a steady disc") };
        let why = why.to_string();
        assert!(why.contains("disc.drive") && why.contains("--at-time"), "{why}");
    }
    let check = verbs(&whole).check().expect("valid").json();
    assert_eq!(check["disc"]["least_speed"].as_f64(), Some(0.2));
    assert_eq!(check["disc"]["largest_speed"].as_f64(), Some(0.6));
    assert!(check["disc"]["speed"].is_null() && check["why"]["disc.speed"].is_string());
    let at = whole.at_time(5.0).expect("a moment");
    assert_eq!(at.varies_by(), None);
    let constant = study(&format!("{MODES}{}", LOAD.replace("mass", "speed = 0.4\nmass")));
    let growth = |study: &Study| {
        let json = verbs(study).stability().expect("finite").json();
        json["growth_rate"].as_f64().expect("a number")
    };
    assert!((growth(&at) - growth(&constant)).abs() < 1e-12);
    // An oscillation is about the speed of the load, in SI too.
    let steel = "inner_radius_ratio = 0.5\nyoungs_modulus_pa = 210e9\ndensity_kg_per_m3 = 7850\nthickness_m = 0.01\nouter_radius_m = 0.14\n";
    let si = "[disc.load]\nradius_ratio = 0.75\nfriction = 0.1\nspeed_rpm = 600\n\
        [disc.drive]\noscillation = { amplitude_hz = 2.0, frequency_hz = 5.0, phase = 1.0 }\n";
    let whole = study(&format!("schema = 1\n[disc]\n{steel}{si}"));
    let hertz = whole.disc().expect("a disc").reference_hz().expect("a material");
    let speed = |study: &Study| study.disc().expect("a disc").disc().speed();
    let wanted = (10.0 + 2.0 * 1f64.sin()) / hertz;
    assert!((speed(&whole) - 10.0 / hertz).abs() < 1e-14);
    let at = whole.at_time(0.0).expect("a moment");
    assert!((speed(&at) - wanted).abs() < 1e-14 && at.disc().expect("a disc").is_si());
}

#[test]
fn speeds_may_reach_zero_and_reverse_without_friction() {
    let stop = "[disc.drive]\ntime = [0.0, 10.0]\nspeed = [0.4, 0.0]\nshape = \"smooth\"\n";
    let turn = "[disc.drive]\ntime = [0.0, 10.0]\nspeed = [0.4, -0.4]\n";
    let free = LOAD.replace("friction = 0.2\n", "");
    for text in [format!("{MODES}{LOAD}{stop}"), format!("{MODES}{free}{turn}")] {
        let (end, _) = ran(&text, &start(), 15.0);
        assert!(end.iter().all(|number| number.is_finite()));
    }
    let said = refused(&format!("{MODES}{LOAD}{turn}"));
    assert!(said.contains("disc.drive") && said.contains("does not follow the speed"), "{said}");
    let law = "[disc.load]\nnormal_load = 0.5\n\
        [friction]\nlaw = \"stribeck\"\nstatic_coefficient = 0.5\nminimum_coefficient = 0.3\nreference_velocity = 2.0\n";
    let said = refused(&format!("{MODES}{law}{stop}"));
    assert!(said.contains("disc.drive") && said.contains("requires sliding"), "{said}");
}

#[test]
fn wrong_tables_are_named() {
    for (load, tables, words) in [
        (LOAD, "[disc.drive]\ntime = [0.0, 1.0, 1.0]\nspeed = [0.1, 0.2, 0.3]\n", "cannot jump"),
        (LOAD, "[disc.drive]\ntime = [0.0]\nspeed = [2000.0]\n", "disc.drive"),
        (LOAD, "[disc.drive]\ntime = [0.0]\nspeed = [0.3, 0.4]\n", "disc.drive.speed"),
        (
            LOAD,
            "[disc.drive]\ntime_s = [0.0]\nspeed = [0.3]\n",
            "the size and material of the plate",
        ),
        (LOAD, "[disc.drive]\ntime = [0.0]\nvelocity = [0.3]\n", "disc.drive.velocity"),
        (LOAD, "[disc.load.drive]\ntime = [0.0]\nspeed = [0.3]\n", "all loads rotate together"),
        ("", "[disc.drive]\ntime = [0.0]\nspeed = [0.3]\n", "without loads has no speed"),
        (
            "[disc.load]\nspeed = 0.3\n",
            "[disc.drive]\ntime = [0.0]\nspeed = [0.3]\n",
            "disc.drive gives it over time",
        ),
    ] {
        let said = refused(&format!("{MODES}{load}{tables}"));
        assert!(said.contains(words), "{tables}: {said}");
    }
}
