//! Published cases: the values of a paper or another program, exact values, and the results of Quell.
//!
//! Numbers and sources are in `reference/published.json`; the page on correctness shows the same table.

use quell::run::orbit::{FoundMotion, Wanted, run as orbit_of};
use quell::run::simulate::{self, MotionRequest, Simulation};
use quell::run::thresholds::{ThresholdsRequest, run as thresholds};
use quell::verbs::system_of;
use quell::{BeltStudy, Study};
use quell_dynamics::motion::{ContactPhase, RecordedEvent};
use quell_dynamics::orbit::{OrbitVerdict, ThresholdKind, limit_cycles};
use quell_dynamics::simulation::EventKind;
use quell_numerics::interval::RealInterval;
use serde_json::Value;

/// The independent integrator agrees with closed forms to 2e-12; periods and positions are of order 10.
const CLOSE: f64 = 1e-10;

fn case(name: &str) -> Value {
    let text = include_str!("../../../reference/published.json");
    let cases: Value = serde_json::from_str(text).expect("JSON");
    assert!(cases[name]["source"].is_string(), "{name}");
    cases[name].clone()
}

/// A stored number.
fn number(case: &Value, kind: &str, name: &str) -> f64 {
    case[kind][name].as_f64().unwrap_or_else(|| panic!("{kind} {name}: {case}"))
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} against {expected}");
}

fn study(text: &str) -> BeltStudy {
    BeltStudy::parse(text, &[]).unwrap_or_else(|why| panic!("{why:?}"))
}

/// A mass with friction of coefficient `law` under unit load, without damping unless it is given.
fn belt(damping: f64, velocity: f64, law: &str, rest: &str) -> BeltStudy {
    study(&format!(
        "[belt]\ndamping_ratio = {damping:?}\nnormal_load = 1.0\nbelt_velocity = {velocity:?}\n{rest}"
    )
    .replace("LAW", &format!("[friction]\nlaw = \"expression\"\ncoefficient = \"{law}\"\n")))
}

/// A driven oscillator with Coulomb friction 1: the support is at rest and the dither is the drive.
fn driven(damping: f64, stiction: f64, amplitude: f64, ratio: f64) -> BeltStudy {
    let rest = format!(
        "LAWstatic_coefficient = {stiction:?}\n[dither]\ndirection = \"tangential\"\nwaveform = \"sine\"\n\
         amplitude = {amplitude:?}\nfrequency_ratio = {ratio:?}\n"
    );
    belt(damping, 0.0, "1.0", &rest)
}

/// The run of a belt from its start.
fn simulated(study: &BeltStudy, until: f64) -> Simulation {
    let system = Study::from(study).system();
    simulate::run(&system, &MotionRequest::to(until)).unwrap_or_else(|why| panic!("{why}"))
}

fn orbit(study: &BeltStudy) -> FoundMotion {
    let system = system_of(&study.into(), "orbit").expect("a system");
    orbit_of(&system, &Wanted::default()).expect("an answer").found.expect("an orbit")
}

fn stick_fraction(found: &FoundMotion) -> f64 {
    found.samples.means()[0].stick_fraction
}

/// Events of one period of a kind.
fn events(found: &FoundMotion, kind: EventKind) -> Vec<&RecordedEvent> {
    found.orbit.events.iter().filter(|event| event.kind == kind).collect()
}

#[test]
fn driven_oscillator_in_slip_and_with_stick() {
    let slip = case("driven_slip");
    let found = orbit(&driven(0.05, 1.1, 1.5, 0.9));
    close(found.orbit.period, number(&slip, "printed", "period"), 1e-12);
    for (index, multiplier) in found.orbit.multipliers.iter().enumerate() {
        let printed = slip["printed"]["multipliers"][index].as_f64().expect("a number");
        close(multiplier.re, printed, 6e-11);
        close(multiplier.im, 0.0, 1e-12);
    }
    assert_eq!((events(&found, EventKind::Reversal).len(), stick_fraction(&found)), (2, 0.0));

    let stick = case("driven_stick");
    let found = orbit(&driven(0.05, 1.1, 1.5, 0.6));
    let half = 0.5 * found.orbit.period;
    let stuck = half * stick_fraction(&found);
    for (value, name) in [(stuck, "stick"), (half - stuck, "slip")] {
        close(value, number(&stick, "exact", name), CLOSE);
        close(value, number(&stick, "printed", name), 1e-12);
    }
    close(found.orbit.multipliers[0].re, number(&stick, "printed", "multiplier"), 6e-11);
    let sticks = events(&found, EventKind::Stick);
    assert_eq!(sticks.len(), 2);
    for stick_event in sticks {
        close(stick_event.state[0].abs(), number(&stick, "printed", "place"), 1e-12);
    }
}

/// A smoothed switch cuts the peak of friction: the printed periods are too short, by 0.3 and by 6 %.
#[test]
fn stick_slip_of_a_block_on_a_belt() {
    let leine = case("leine1998");
    let found = orbit(&belt(0.0, 0.2, "1/(1 + 3*abs(v))", "LAW"));
    let exact = number(&leine, "exact", "period");
    close(found.orbit.period, exact, CLOSE);
    close(stick_fraction(&found), number(&leine, "exact", "stick_fraction"), CLOSE);
    assert_eq!(found.orbit.verdict(), OrbitVerdict::Stable);
    for (name, least, most) in [("period", 0.003, 0.004), ("period_smoothed", 0.05, 0.07)] {
        let short = 1.0 - number(&leine, "printed", name) / exact;
        assert!((least..most).contains(&short), "{name}: {short}");
    }
    let block = case("carlson1989");
    let found = orbit(&belt(0.0, 0.01, "1/(1 + 5*abs(v))", "LAW"));
    close(found.orbit.period, number(&block, "exact", "period"), 10.0 * CLOSE);
    close(stick_fraction(&found), number(&block, "exact", "stick_fraction"), CLOSE);
}

/// x stops at 15 − √205; a step of 0.01 misses it by 1.3·10⁻⁴.
#[test]
fn free_oscillator_with_coulomb_friction_stops() {
    let decay = case("coulomb_decay");
    let study = belt(0.0, 0.0, "1.0", "[belt.initial]\ndisplacement = 12.0\nvelocity = 6.0\nLAW");
    let done = simulated(&study, 100.0);
    assert!(done.end.contacts[0].phase == ContactPhase::Stick);
    close(done.end.state[0], 15.0 - 205.0f64.sqrt(), 1e-12);
    close(done.end.state[0], number(&decay, "exact", "stops_at"), 1e-12);
    let off = (done.end.state[0] - number(&decay, "printed", "stops_at")).abs();
    assert!((1.3e-4..1.4e-4).contains(&off), "{off}");
}

#[test]
fn amplitude_without_stops_is_den_hartogs() {
    for row in case("denhartog1931")["cases"].as_array().expect("a list") {
        let [ratio, amplitude, exact] = ["frequency_ratio", "amplitude", "exact"]
            .map(|name| row[name].as_f64().expect("a number"));
        // √(V²a² − U²x_f²), x_f = 1.
        let response = 1.0 / (1.0 - ratio * ratio);
        let angle = std::f64::consts::PI / ratio;
        let damping = angle.sin() / (ratio * (1.0 + angle.cos()));
        let formula = ((response * amplitude).powi(2) - damping * damping).sqrt();
        close(formula, exact, 1e-13);
        let found = orbit(&driven(0.0, 1.0, amplitude, ratio));
        let reversals = events(&found, EventKind::Reversal);
        assert_eq!((reversals.len(), found.orbit.events.len()), (2, 2), "{row}");
        for reversal in reversals {
            close(reversal.state[0].abs(), exact, 1e-11);
        }
    }
}

/// In SI, with viscous friction in the law: the formula of the Hopf point is exact, the normal form places the end of
/// bistability 15 % too high.
#[test]
fn bistability_of_the_block_of_veraszto_and_stepan() {
    let case = case("veraszto2017");
    let study = study(
        "[belt]\nmass_kg = 0.538\nstiffness_n_per_m = 6957.0\ndamping_n_s_per_m = 5.746\nnormal_force_n = 1.0\n\
         belt_velocity_m_per_s = 0.22\n[friction]\nlaw = \"expression\"\n\
         coefficient = \"C + (C_0 - C)*exp(-c_v*abs(v)) + b_s*abs(v)\"\n\
         [friction.constants]\nC = 2.0\nC_0 = 6.0\nc_v = 10.0\nb_s = 0.2\n",
    );
    let key = "belt.belt_velocity_m_per_s";
    let question = ThresholdsRequest {
        parameter: key.to_owned(),
        window: RealInterval::new(0.15, 0.25),
        ..ThresholdsRequest::default()
    };
    let system = system_of(&(&study).into(), "thresholds").expect("a system");
    let found = thresholds(&system, &question).expect("followed").local.expect("steady sliding");
    let hopf = &found.thresholds[0];
    assert_eq!((found.thresholds.len(), hopf.kind), (1, ThresholdKind::Hopf));
    close(hopf.value, number(&case, "printed", "hopf"), 1e-9);

    // Cycles at this velocity: the squeal and the smaller unstable cycle, or none.
    let count = |velocity: f64| {
        let belt = study.with(key, velocity).expect("valid");
        limit_cycles(Study::from(&belt).system().system()).expect("one mass").len()
    };
    let exact = number(&case, "exact", "end_of_bistability");
    assert_eq!((count(exact - 1e-6), count(exact + 1e-6)), (2, 0));
    let high = number(&case, "printed", "end_of_bistability") / exact - 1.0;
    assert!((0.15..0.16).contains(&high), "{high}");
}

/// The stick–slip example of PathSim 0.27.1: m = 20 kg, k = 70 N/m, d = 10 N·s/m, friction coefficient 1, belt 2 sin(2πt/50) m/s. In
/// the frame of the belt the support is at rest, and the belt's motion is a force: two sines and a constant, which shifts the origin. The
/// block sticks until k x_b + d v_b + m a_b = μmg, in closed form.
#[test]
fn a_belt_of_oscillating_speed_is_a_support_at_rest_under_two_sines() {
    let (mass, stiffness, damper, weight) = (20.0, 70.0, 10.0, 20.0 * 9.81);
    let (speed, omega) = (2.0, std::f64::consts::TAU / 50.0);
    let own = f64::sqrt(stiffness / mass);
    let zeta = damper / (2.0 * mass * own);
    let (cosine, sine) = (
        (stiffness * speed / omega - mass * speed * omega) / stiffness,
        damper * speed / stiffness,
    );
    let dither = |amplitude: f64, phase: f64| {
        format!(
            "[[dither]]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = {amplitude:?}\nfrequency_ratio = {:?}\n\
             phase = {phase:?}\n",
            omega / own
        )
    };
    let text = format!(
        "[belt]\ndamping_ratio = {zeta:?}\nnormal_load = {:?}\nbelt_velocity = 0.0\n[belt.initial]\ndisplacement = {:?}\n\
         velocity = 0.0\n[friction]\nlaw = \"expression\"\ncoefficient = \"1.0\"\n{}{}",
        weight / stiffness,
        speed / omega,
        dither(cosine, std::f64::consts::FRAC_PI_2),
        dither(sine, std::f64::consts::PI),
    );
    let study = study(&text);
    let found = simulated(&study, 20.0).history.events;
    let release = found.iter().find(|event| event.kind == EventKind::Release).expect("it slips");
    // The closed form, by bisection.
    let excess = |t: f64| {
        let angle = omega * t;
        stiffness * speed / omega * (1.0 - angle.cos())
            + damper * speed * angle.sin()
            + mass * speed * omega * angle.cos()
            - weight
    };
    let (mut low, mut high) = (0.0, 10.0);
    while high - low > 1e-13 {
        let middle = 0.5 * (low + high);
        *(if excess(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    close(release.time / own, low, 1e-9);
    close(low, 4.600699324, 1e-9);
}
