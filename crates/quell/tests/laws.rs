//! `coulomb` and `stribeck-exponential`, friction in newtons, formulas that are verified, and slip beyond the range of a law.
//!
//! Numbers: `reference/laws.json` (source and tolerance in `reference/README.md`); published cases with their source.

use quell::map;
use quell::run::orbit::Wanted;
use quell::run::response::ResponseRequest;
use quell::run::simulate::{MotionRequest, Simulation};
use quell::run::{basins, bifurcation, simulate, thresholds, varied};
use quell::running::Running;
use quell::status::Status;
use quell::study::{BeltStudy, Change};
use quell::sweep::{MapQuantity, Plan};
use quell::verbs::verbs;
use quell_linear::averaging::{AveragedLaw, Averaging, Effective, FastMotion};
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

fn reference() -> Json {
    serde_json::from_str(include_str!("../../../reference/laws.json")).expect("JSON")
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

fn set(study: &str, changes: &[&str]) -> BeltStudy {
    let changes: Vec<Change> =
        changes.iter().map(|text| Change::parse(text, "--set").expect("a change")).collect();
    BeltStudy::parse(study, &changes).expect("a study")
}

/// The friction of a belt's contact at slip velocities.
fn friction(study: &BeltStudy, at: Option<&[f64]>) -> Json {
    verbs(&quell::Study::from(study)).friction(at, false).expect("friction").json()
}

fn warnings(json: &Json) -> String {
    let list = json["warnings"].as_array().expect("a list");
    list.iter().map(|text| text.as_str().expect("text")).collect::<Vec<_>>().join("\n")
}

#[test]
fn averages_are_those_of_the_definition() {
    let reference = reference();
    let rows = reference["averages"].as_array().expect("rows");
    assert_eq!(rows.len(), 18);
    for row in rows {
        let study = study(row["study"].as_str().expect("text"));
        // The reference is of the limit R → ∞.
        let at = numbers(&row["slip_velocity"]);
        let averaged = |v: f64| {
            let law =
                AveragedLaw::of_one_mass(study.belt(), v, Averaging::Limit).expect("a motion");
            law.at(v).expect("an average")
        };
        let limit: Vec<Effective> = at.iter().map(|v| averaged(*v)).collect();
        let found = &friction(&study, Some(&at))["contacts"][0];
        let values = numbers(&found["limit_effective_coefficient"]);
        let slopes = numbers(&found["limit_effective_slope"]);
        for (place, value) in numbers(&row["coefficient"]).into_iter().enumerate() {
            let error = (values[place] / value - 1.0).abs();
            assert!(error < 1e-10, "{row}: {} differs by {error:e}", values[place]);
        }
        // The stored slopes are rounded to 13 digits after the point; below δ = 1 the slope at rest is unbounded, and the
        // reported error of the average is larger.
        for (place, slope) in numbers(&row["slope"]).into_iter().enumerate() {
            let error = (slopes[place] - slope).abs();
            let reported = limit[place].slope_error;
            assert!(reported < 1e-4, "{row}: {reported:e}");
            assert!(error < 1e-9 + reported, "{row}: slope {} differs by {error:e}", slopes[place]);
        }
    }
}

/// Under a sine, Coulomb friction averages to μ_d (2/π) asin(v/α) for any static level.
#[test]
fn coulomb_under_a_sine_is_an_arcsine() {
    let reference = reference();
    let study = study(reference["averages"][0]["study"].as_str().expect("text"));
    let alpha = 0.08;
    let at: Vec<f64> = (1..40).map(|k| 0.002 * f64::from(k)).collect();
    let found = &friction(&study, Some(&at))["contacts"][0];
    // At R = 10 the fast velocity is larger by 1/(1 − 1/R²).
    let finite = alpha / 0.99;
    for (place, v) in at.iter().enumerate() {
        let exact = |alpha: f64| 0.3 * (2.0 / std::f64::consts::PI) * (v / alpha).asin();
        let own = number(&found["effective_coefficient"][place]);
        let limit = number(&found["limit_effective_coefficient"][place]);
        for (value, exact) in [(own, exact(finite)), (limit, exact(alpha))] {
            assert!((value / exact - 1.0).abs() < 1e-12, "{v}: {value}, {exact}");
        }
    }
}

#[test]
fn events_and_states_agree_with_independent_integrators() {
    let reference = reference();
    let cases = reference["trajectories"].as_array().expect("cases");
    assert_eq!(cases.len(), 4);
    for case in cases {
        let study = study(case["study"].as_str().expect("text"));
        let run = simulated(&study, number(&case["until"]));
        let events = &run.history.events;
        let expected = case["events"].as_array().expect("events");
        assert_eq!(run.end.events, case["n_events"].as_u64().expect("a count"), "{case}");
        for (event, expected) in events.iter().zip(expected) {
            let kind = expected["kind"].as_str().expect("a kind");
            assert_eq!(event.kind.name(), kind, "{case}");
            assert!((event.time - number(&expected["time"])).abs() < 1e-9, "{event:?}: {expected}");
            let moved = (event.state[0] - number(&expected["displacement"])).abs();
            assert!(moved < 1e-9, "{event:?}: {expected}");
        }
        let end = &case["final"];
        assert!((run.end.state[0] - number(&end["displacement"])).abs() < 1e-9, "{case}");
        assert!((run.end.state[1] - number(&end["velocity"])).abs() < 1e-9, "{case}");
    }
}

/// Siconos, example FrictionOscillator: a free oscillator with Coulomb friction rests at 15 − √205.
#[test]
fn a_free_oscillator_comes_to_rest_where_it_must() {
    let study = study(
        "schema = 1\n[belt]\ndamping_ratio = 0.0\nnormal_load = 1.0\nbelt_velocity = 0.0\n[belt.initial]\n\
         displacement = 12.0\nvelocity = 6.0\n[friction]\nlaw = \"coulomb\"\ncoefficient = 1.0\n",
    );
    let run = simulated(&study, 60.0);
    assert!(run.end.contacts[0].phase == quell_dynamics::motion::ContactPhase::Stick);
    assert!((run.end.state[0] - (15.0 - 205f64.sqrt())).abs() < 1e-11, "{:?}", run.end);
}

/// Veraszto and Stepan 2017, in newtons: 6 N at rest, a fall by 4 N over 0.1 m/s, 0.2 N·s/m.
const DRIVE: &str = "schema = 1\n[belt]\nmass_kg = 0.538\nstiffness_n_per_m = 6957.0\ndamping_n_s_per_m = 5.746\n\
     belt_velocity_m_per_s = 0.1\n[friction]\nlaw = \"stribeck-exponential\"\nfriction_force_n = 2.0\n\
     static_friction_force_n = 6.0\nreference_velocity_m_per_s = 0.1\nexponent = 1.0\nviscous_n_s_per_m = 0.2\n";

/// Friction forces are independent of the normal force; the same study in coefficients gives the same numbers.
#[test]
fn friction_in_newtons_is_independent_of_the_normal_force() {
    let own = study(DRIVE);
    let pressed = DRIVE.replace("[friction]", "normal_force_n = 30.0\n[friction]");
    let pressed = study(&pressed);
    let same = DRIVE
        .replace("[friction]", "normal_force_n = 6.0\n[friction]")
        .replace("static_friction_force_n = 6.0", "static_coefficient = 1.0")
        .replace("friction_force_n = 2.0", &format!("coefficient = {:?}", 2.0 / 6.0))
        .replace("viscous_n_s_per_m = 0.2", &format!("viscous_s_per_m = {:?}", 0.2 / 6.0));
    let same = study(&same);
    let force = |study: &BeltStudy, v: f64| {
        let newtons = study.scales().expect("SI").per_unit(quell_model::units::Quantity::Force);
        let belt = study.belt();
        let unit = study.scales().expect("SI").angular_frequency();
        newtons * belt.normal_load() * belt.friction().coefficient(v / unit)
    };
    for v in [0.0_f64, 0.03, 0.1, 2.0] {
        let exact = 2.0 + 4.0 * (-v / 0.1).exp() + 0.2 * v;
        for study in [&own, &pressed, &same] {
            assert!((force(study, v) / exact - 1.0).abs() < 1e-13, "{v}: {}", force(study, v));
        }
    }
    let rests: Vec<f64> =
        [&own, &pressed, &same].iter().map(|study| simulated(study, 200.0).end.state[0]).collect();
    for rest in &rests {
        assert!((rest / rests[0] - 1.0).abs() < 1e-7, "{rests:?}");
    }
    // Map points and --set change the forces.
    let softer = set(DRIVE, &["friction.friction_force_n=5.0"]);
    assert!((force(&softer, 1e3) - 205.0).abs() < 1e-9);
    let point = own.with("friction.friction_force_n", 5.0).expect("a study");
    assert_eq!(softer.belt(), point.belt());
}

/// Steady sliding is stable from v = v_s ln(ΔF/(v_s(c + c_v))) on, for any friction level: 0.190616072953803 m/s.
#[test]
fn the_drive_of_veraszto_and_stepan_has_its_hopf_point() {
    let study = study(DRIVE);
    let bands = stability(&study)["unstable_surface_velocities"].clone();
    let upper = bands[0]["upper"].as_f64().expect("an end");
    assert!((upper / 0.190616072953803 - 1.0).abs() < 1e-9, "{upper}");
}

#[test]
fn friction_in_newtons_is_never_guessed() {
    for (from, to, parts) in [
        (
            "friction_force_n = 2.0",
            "friction_force_n = 2.0\ncoefficient = 0.3",
            &["friction.coefficient", "not both"][..],
        ),
        ("friction_force_n = 2.0\n", "", &["friction.coefficient_n", "in N"]),
        (
            "mass_kg = 0.538\nstiffness_n_per_m = 6957.0\ndamping_n_s_per_m = 5.746\nbelt_velocity_m_per_s",
            "damping_ratio = 0.1\nbelt_velocity",
            &["dimensionless"],
        ),
        ("viscous_n_s_per_m = 0.2", "viscous_s_per_m = 0.2", &["viscous_s_per_m", "not both"]),
        ("stribeck-exponential", "stribeck", &["friction_force_n", "for law = \"stribeck\""]),
        ("friction_force_n = 2.0", "friction_force_n = -2.0", &["≥ 0, in N"]),
    ] {
        let text = DRIVE.replacen(from, to, 1);
        assert_ne!(text, DRIVE, "{from}");
        let said = refused(&text);
        for part in parts {
            assert!(said.contains(part), "{to}: {said}");
        }
    }
    let dither = "[dither]\ndirection = \"normal\"\nwaveform = \"sine\"\namplitude_n = 1.0\nfrequency_hz = 500.0\n";
    let said = refused(&format!("{DRIVE}{dither}"));
    assert!(said.contains("belt.normal_load"), "{said}");
    let coulomb = DRIVE
        .replace("stribeck-exponential", "coulomb")
        .replace("reference_velocity_m_per_s = 0.1\nexponent = 1.0\n", "");
    assert!(BeltStudy::parse(&coulomb, &[]).is_ok(), "{}", refused(&coulomb));
    let said =
        refused(&coulomb.replace("static_friction_force_n = 6.0", "static_friction_force_n = 1.0"));
    assert!(said.contains("at least friction.friction_force_n = 2"), "{said}");
}

/// Without an integer exponent a run is rejected with the reason; averages are available.
#[test]
fn laws_not_analytic_at_rest_are_only_averaged() {
    let text = DRIVE.replace("exponent = 1.0", "exponent = 0.5");
    let study = study(&text);
    let Err(wrong) = verbs(&(&study).into()).simulate(&MotionRequest::to(10.0)) else {
        panic!("no branch");
    };
    assert!(format!("{wrong:?}").contains("exponent = 1, 2, 3 or 4"), "{wrong:?}");
    assert!(stability(&study)["criterion"].is_f64());
}

/// The run of a belt from its start.
fn simulated(study: &BeltStudy, until: f64) -> Simulation {
    let system = quell::Study::from(study).system();
    simulate::run(&system, &MotionRequest::to(until)).unwrap_or_else(|why| panic!("{why}"))
}

/// Its answer; the time is in the units of the study.
fn run_to(study: &BeltStudy, until: f64) -> Json {
    verbs(&study.into()).simulate(&MotionRequest::to(until)).expect("a run").json()
}

fn response(study: &BeltStudy) -> Json {
    let found = verbs(&study.into()).response(&ResponseRequest::default());
    found.expect("a response").json()
}

fn stability(study: &BeltStudy) -> Json {
    verbs(&study.into()).stability().expect("an answer").json()
}

fn orbit(study: &BeltStudy) -> Json {
    let found = verbs(&study.into()).orbit(&Wanted::default());
    found.expect("an answer").json()
}

const CUBIC: &str = "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\n\
     law = \"stribeck\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity = 0.2\n[dither]\n\
     direction = \"tangential\"\nwaveform = \"sine\"\namplitude = 0.5\nfrequency_ratio = 10.0\n[solver]\nsettle = 100.0\n\
     record_periods = 8\n";

/// v₀ = 10 km/h with v_m = 0.2 m/s: the case that used to be reported as "stable" under 619 279 N without a warning.
#[test]
fn a_cubic_far_out_warns_in_the_study_s_units() {
    let si = "schema = 1\n[belt]\nmass_kg = 1.0\nstiffness_n_per_m = 1e6\ndamping_n_s_per_m = 10.0\n\
         normal_force_n = 4000.0\nbelt_velocity_m_per_s = 2.7777777777777777\n[friction]\nlaw = \"stribeck\"\n\
         static_coefficient = 0.4\nminimum_coefficient = 0.2857\nreference_velocity_m_per_s = 0.2\n";
    let far = study(si);
    for json in [
        stability(&far),
        friction(&far, Some(&[far.belt().belt_velocity()])),
        verbs(&quell::Study::from(&far)).check().expect("valid").json(),
        run_to(&far, 20.0 / 1e3),
        response(&set(si, &["solver.settle_s=0.1", "solver.record_periods=4"])),
        orbit(&far),
    ] {
        let said = warnings(&json);
        assert!(
            said.contains("outside the range of the stribeck law, 0 m/s to 0.3464 m/s"),
            "{said}"
        );
    }
    let near = set(si, &["belt.belt_velocity_m_per_s=0.1"]);
    assert_eq!(warnings(&friction(&near, Some(&[near.belt().belt_velocity()]))), "");
}

/// Every verb, inside and outside the range; without --at, `friction` ends where slip including dither reaches the limit.
#[test]
fn every_verb_warns_where_slip_leaves_the_range() {
    let inside = study(CUBIC);
    let outside = set(CUBIC, &["dither.amplitude=3.0"]);
    let quiet = |json: &Json| assert_eq!(warnings(json), "", "{json}");
    let warns = |json: &Json| {
        let said = warnings(json);
        assert!(said.contains("range of the stribeck law") && said.contains("0.3464 "), "{said}");
    };
    let at = [0.1];
    quiet(&friction(&inside, Some(&at)));
    warns(&friction(&outside, Some(&at)));
    // Outside, the belt's own slip including the dither leaves the range for any grid.
    for study in [&inside, &outside] {
        let grid = numbers(&friction(study, None)["contacts"][0]["slip_velocity"]);
        let end = grid.last().copied().expect("points");
        // With dither, the average at a slip velocity reaches that velocity plus the fast velocity.
        let belt = study.belt();
        let motion = FastMotion::of(belt, belt.belt_velocity(), Averaging::FiniteR);
        let met = end + motion.and_then(|motion| motion.largest_slip()).expect("a fast motion");
        assert!((met - 0.2 * 3f64.sqrt()).abs() < 1e-15, "{end}");
    }
    quiet(&friction(&inside, None));
    warns(&friction(&outside, None));
    quiet(&stability(&inside));
    warns(&stability(&outside));
    quiet(&run_to(&inside, 40.0));
    warns(&run_to(&outside, 40.0));
    quiet(&response(&inside));
    warns(&response(&outside));
    quiet(&orbit(&inside));
    warns(&orbit(&outside));
    let question = |to| thresholds::ThresholdsRequest {
        parameter: "dither.amplitude".to_owned(),
        window: RealInterval::new(1.2, to),
        ..thresholds::ThresholdsRequest::default()
    };
    let asked = |to| verbs(&(&inside).into()).thresholds(&question(to)).expect("thresholds").json();
    quiet(&asked(1.6));
    warns(&asked(3.0));
    let stop = std::sync::atomic::AtomicBool::new(false);
    let running = Running { threads: Some(1), progress: &(), stop: &stop };
    let range =
        varied::Range { parameter: "dither.amplitude".to_owned(), from: 1.8, to: 3.0, points: 2 };
    let question = bifurcation::SweepRequest { range, up: true, down: false };
    let found = verbs(&(&inside).into()).bifurcation(&question, running).expect("a sweep");
    warns(&found.json());
    let question = basins::BasinsRequest {
        layout: Some(basins::StartLayout::Grid { columns: 2, rows: 2 }),
        ..basins::BasinsRequest::default()
    };
    warns(&verbs(&(&outside).into()).basins(&question, running).expect("basins").json());
    // A map point has its value, and a status that reports the range.
    let axes = "[[sweep]]\nparameter = \"dither.amplitude\"\nvalues = [0.5, 3.0]\n";
    let swept = study(&format!("{CUBIC}{axes}"));
    for name in ["residual-vibration", "mean-friction", "verdict", "limit-criterion"] {
        let quantity = MapQuantity::named(name, "--quantity").expect("a quantity");
        let plan = Plan::new(&swept, &[quantity]).expect("axes");
        let found = map::run(plan, None, running).expect("a map");
        let entry = found.plan().sheet().entries()[0];
        let states = [0, 1].map(|point| found.status(&entry, point));
        assert_eq!(states, [Status::Known, Status::BeyondRange], "{name}");
        assert!(found.number(&entry, 1).is_some(), "{name}");
        let said = warnings(&found.json());
        assert!(said.contains("1 of 2 points") && said.contains("range"), "{said}");
    }
}

/// A formula is verified for each study, and rejected with its key if that fails.
#[test]
fn formulas_are_proven_for_every_study() {
    let text = |formula: &str, more: &str| {
        format!(
            "schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1.0\nbelt_velocity = 0.1\n[friction]\n\
             law = \"expression\"\ncoefficient = \"{formula}\"\n{more}"
        )
    };
    for (formula, part) in [
        ("0/0", "not finite"),
        ("0.3-1.0*exp(-((abs(v)-0.2)/0.0001)^2)", "it is -0."),
        ("0.3+1e-7/(abs(v)-0.2)", "at v = 0.1999"),
    ] {
        let said = refused(&text(formula, ""));
        assert!(said.contains("friction.coefficient") && said.contains(part), "{said}");
    }
    let falling = text("0.4 - 0.1*abs(v)", "");
    let belt = study(&falling);
    assert_eq!(belt.belt().friction().range().map(|range| range.upper), Some(1.0));
    let faster = belt.with("belt.belt_velocity", 0.5).expect_err("negative from v = 4 on");
    assert!(
        faster.iter().any(|complaint| complaint.to_string().contains("at v = 4.")),
        "{faster:?}"
    );
    let meant = set(&falling, &["belt.belt_velocity=0.5", "friction.maximum_velocity=3.0"]);
    assert_eq!(meant.belt().friction().range().map(|range| range.upper), Some(3.0));
    assert_eq!(warnings(&run_to(&meant, 30.0)), "");
    let narrow = set(&falling, &["friction.maximum_velocity=0.12"]);
    let said = warnings(&run_to(&narrow, 30.0));
    assert!(
        said.contains("range of the expression law, 0 to 0.12 (the maximum velocity"),
        "{said}"
    );
    // In SI the key includes its unit.
    let si = "schema = 1\n[belt]\nmass_kg = 1.0\nstiffness_n_per_m = 1e4\ndamping_n_s_per_m = 1.0\n\
        normal_force_n = 10.0\nbelt_velocity_m_per_s = 0.5\n[friction]\nlaw = \"expression\"\n\
        coefficient = \"0.4 - 0.1*abs(v)\"\nmaximum_velocity_m_per_s = 3.0\n";
    let si = study(si);
    let warned = warnings(&friction(&si, Some(&[4.0])));
    assert!(warned.contains("0 m/s to 3 m/s"), "{warned}");
}
