//! Least dithers of belts against an independent program, and limits in closed form.

use quell_design::actuator::{Actuator, ActuatorLimit, PiezoStack};
use quell_design::least_dither::{
    DesignObjective, DesignProblem, DesignStart, Designed, LimitedQuantity, NoDesign,
    OperatingPoint, Plant, SystemAtPoint, SystemPlant, covered, design,
};
use quell_design::tasks::InTurn;
use quell_model::{Belt, Direction, Dither, Friction, InvalidValues, LawKind, Waveform};
use quell_numerics::interval::RealInterval;

fn law(kind: LawKind) -> Friction {
    kind.build(&[0.4, 0.2857, 0.2]).expect("a law")
}

/// A belt at an operating point, its velocity, with an amplitude and, if they are chosen, a frequency ratio.
fn belt(kind: LawKind, damping_ratio: f64, waveform: Waveform) -> Box<SystemAtPoint<'static>> {
    let dither = Dither {
        direction: Direction::Tangential,
        waveform,
        amplitude: 1.0,
        frequency_ratio: 10.0,
        phase: 0.0,
        envelope: None,
    };
    let belt = Belt::new(damping_ratio, 1.0, 0.1, law(kind), vec![dither]).expect("a belt");
    let at = move |at: OperatingPoint<'_>, amplitude: f64| {
        let belt = belt.with_amplitude(0, amplitude)?.with_belt_velocity(at.point[0])?;
        at.others.iter().try_fold(belt, |belt, ratio| belt.with_frequency_ratio(0, *ratio))
    };
    Box::new(move |point: OperatingPoint<'_>, amplitude: f64| {
        let belt: Result<Belt, InvalidValues> = at(point, amplitude);
        Ok(belt?.system())
    })
}

fn plant<'a>(at: &'a SystemAtPoint<'a>) -> SystemPlant<'a> {
    SystemPlant { at, input: 0, observe: &[1.0], start: DesignStart::Local }
}

fn problem<'a>(
    plant: &'a SystemPlant<'a>,
    over: &'a [RealInterval],
    limits: &'a [(LimitedQuantity, f64)],
) -> DesignProblem<'a> {
    DesignProblem {
        plant,
        objective: DesignObjective::Amplitude,
        amplitude: RealInterval::new(0.01, 20.0),
        others: &[],
        over,
        limits,
        actuator: None,
        start: DesignStart::Local,
        tasks: &InTurn,
    }
}

/// Exact least amplitude, that of averaging and the operating point that decides, of an independent program
/// (`reference/design/least_dither.json`).
#[test]
fn least_amplitudes_over_speeds() {
    let text = include_str!("../../../reference/design/least_dither.json");
    let reference: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let mut judged = 0;
    for case in reference["cases"].as_array().expect("cases") {
        let number = |key: &str| case[key].as_f64().expect("a number");
        let kind = match case["law"].as_str() {
            Some("stribeck") => LawKind::Stribeck,
            _ => LawKind::Decreasing,
        };
        let waveform = match case["waveform"].as_str() {
            Some("sine") => Waveform::Sine,
            Some("triangle") => Waveform::Triangle,
            _ => Waveform::Square,
        };
        let over = [RealInterval::new(number("from"), number("to"))];
        let belt = belt(kind, number("damping_ratio"), waveform);
        let plant = plant(&belt);
        let found = design(problem(&plant, &over, &[])).answer.expect("feasible");
        let critical = &found.critical;
        // Grazings and multipliers of the oracle are exact to 1e-9; a tip is where two thresholds meet.
        assert!(
            (critical.amplitude / number("amplitude") - 1.0).abs() < 1e-6,
            "{case} {critical:?}"
        );
        assert!(
            (found.averaged.amplitude / number("averaged") - 1.0).abs() < 1e-8,
            "{case} {found:?}"
        );
        let worst = critical.worst.as_ref().expect("a point")[0];
        assert!((worst - number("worst")).abs() < 1e-5, "{case} {worst}");
        assert!(found.verified.len() > 30 && found.verified.iter().all(|at| at.multiplier < 1.0));
        judged += 1;
    }
    assert!(judged >= 6);
}

#[test]
fn a_stroke_limit_binds_the_frequency() {
    let belt = belt(LawKind::Stribeck, 0.005, Waveform::Sine);
    let plant = plant(&belt);
    let limits = [(LimitedQuantity::Stroke, 0.04)];
    let others = [RealInterval::new(2.0, 20.0)];
    let over = [RealInterval::new(0.05, 0.2)];
    let whole = DesignProblem { others: &others, ..problem(&plant, &over, &limits) };
    let found = design(whole).answer.expect("feasible");
    // An independent program; averaged values in closed form: A = v R(1 − 1/R²) at the tip, 2A/(R² − 1) = 0.04.
    assert!((found.averaged.others[0] / 8.117203095830686 - 1.0).abs() < 1e-5, "{found:?}");
    assert!((found.averaged.amplitude / 1.2977797219792655 - 1.0).abs() < 1e-5);
    assert!((found.critical.others[0] / 8.127289235523428 - 1.0).abs() < 1e-5, "{found:?}");
    assert!((found.critical.amplitude / 1.3010566063571558 - 1.0).abs() < 1e-5);
    assert!((found.critical.use_of_limits() - 1.0).abs() < 1e-6);
}

/// By averaging the least amplitude at the tip is A = v R |1 − 1/R²|, with stroke 2A/(R² − 1). A stack of blocked force F_b, free stroke
/// Δu and no mass, biased by half its voltage, gives A = F_b/2 times the share |K|/|K + k_a|: the range of its force, A(1 + k_a/K) with
/// K = 1 − R² + 2iζR, is F_b/2 on both sides.
#[test]
fn a_voltage_binds_the_frequency() {
    let belt = belt(LawKind::Stribeck, 0.005, Waveform::Sine);
    let plant = plant(&belt);
    let stack = PiezoStack {
        blocked_force: 3.0,
        stiffness: 20.0,
        mass: 0.0,
        capacitance: None,
        maximum_voltage: Some(120.0),
        maximum_current: None,
    };
    let actuator = Actuator::Piezo(stack.clone());
    let limit = LimitedQuantity::Actuator(ActuatorLimit::MaximumVoltage);
    let limits = [(limit, 1.0)];
    let others = [RealInterval::new(6.0, 20.0)];
    let over = [RealInterval::new(0.05, 0.2)];
    let whole = DesignProblem {
        others: &others,
        actuator: Some(&actuator),
        ..problem(&plant, &over, &limits)
    };
    let found = design(whole).answer.expect("feasible");
    let used = |frequency: f64, amplitude: f64| {
        let (re, im) = (1.0 - frequency * frequency, 2.0 * 0.005 * frequency);
        amplitude * libm::hypot(re + 20.0, im) / libm::hypot(re, im) / 1.5
    };
    let averaged = &found.averaged;
    let share = averaged.used[0].1.as_ref().expect("known");
    assert!((share / used(averaged.others[0], averaged.amplitude) - 1.0).abs() < 1e-10);
    let (demand, point) = found.drive.as_ref().expect("known");
    let exact = used(found.critical.others[0], found.verified_amplitude);
    assert!((demand.tightest().expect("known").1 / exact - 1.0).abs() < 1e-10, "{point:?}");
    let volts = demand.voltage.as_ref().expect("known").peak_to_peak;
    assert!((volts / (120.0 * exact) - 1.0).abs() < 1e-10);
    // A tenth of the stack gives no dither that is quiet everywhere.
    let weak = Actuator::Piezo(PiezoStack { blocked_force: 0.3, ..stack });
    let whole = DesignProblem { actuator: Some(&weak), ..whole };
    let none = design(whole).answer.expect_err("too weak");
    assert!(
        matches!(none.why, NoDesign::Limit { quantity, used, .. } if quantity == limit && used > 1.0),
        "{:?}",
        none.why
    );
}

#[test]
fn a_bounded_amplitude_covers_a_part_of_the_box() {
    let belt = belt(LawKind::Stribeck, 0.005, Waveform::Sine);
    let plant = plant(&belt);
    let over = [RealInterval::new(0.02, 0.2)];
    let whole =
        DesignProblem { amplitude: RealInterval::new(0.01, 1.0), ..problem(&plant, &over, &[]) };
    let Designed { answer, .. } = design(whole);
    let infeasible = answer.expect_err("the amplitude is bounded");
    assert!(matches!(infeasible.why, NoDesign::NeverQuiet { .. }), "{infeasible:?}");
    let covered = covered(whole, &infeasible).expect("a part");
    assert_eq!((covered.ends.lower, covered.amplitude), (0.02, 1.0));
    assert!((covered.ends.upper / 0.10081636800765753 - 1.0).abs() < 1e-6, "{covered:?}");
}

#[test]
fn a_loss_of_friction_is_judged_on_exact_responses() {
    let belt = belt(LawKind::Stribeck, 0.005, Waveform::Sine);
    let plant = plant(&belt);
    let over = [RealInterval::new(0.145, 0.15)];
    let limits = [(LimitedQuantity::FrictionLoss, 0.25)];
    let found = design(problem(&plant, &over, &limits)).answer.expect("feasible");
    assert!((found.critical.amplitude / 1.4863197137178406 - 1.0).abs() < 1e-6);
    let (loss, _) = found.friction_loss.expect("a loss");
    let used = found.critical.used[0].1.clone().expect("a loss") * 0.25;
    assert!(
        (used - loss.max(0.0)).abs() < 1e-9,
        "the limit is judged on exact responses: {loss} {used}"
    );
    let corner = OperatingPoint { point: &[0.145], others: &[] };
    let averaged = Plant::averaged_loss(&plant, corner, found.critical.amplitude).expect("a loss");
    assert!(loss < averaged, "near the graze averaging loses too much: {loss} {averaged}");
    let over = [RealInterval::new(0.05, 0.15)];
    let limits = [(LimitedQuantity::FrictionLoss, 0.1)];
    let none = design(problem(&plant, &over, &limits)).answer.expect_err("too much is lost");
    assert!(matches!(
        none.why,
        NoDesign::Limit { quantity: LimitedQuantity::FrictionLoss, used, .. } if used > 8.0
    ));
}

/// Near the graze the averaged loss of friction is wrong even in sign: v₀ = 0.145, α = 1.0375 v₀, and D = α(R² − 1)/R; an independent
/// program gives two digits of the exact losses.
#[test]
fn averaged_and_exact_losses_meet_at_high_frequency() {
    let belt = belt(LawKind::Stribeck, 0.005, Waveform::Sine);
    let plant = plant(&belt);
    let at = |ratio: f64| {
        let (point, others) = ([0.145], [ratio]);
        let amplitude = 1.0375 * 0.145 * (ratio * ratio - 1.0) / ratio;
        let place = OperatingPoint { point: &point, others: &others };
        let [averaged, exact] =
            [Plant::averaged_loss(&plant, place, amplitude), plant.exact_loss(place, amplitude)];
        (averaged.expect("averaged"), exact.expect("exact"))
    };
    for (ratio, exact) in [(10.0, -0.052), (40.0, 0.089), (160.0, 0.111)] {
        let (averaged, found) = at(ratio);
        assert!((averaged - 0.113).abs() < 5e-4, "{averaged}");
        assert!((found - exact).abs() < 1e-3, "R = {ratio}: {found}");
    }
}

#[test]
fn nothing_is_needed_where_sliding_is_stable() {
    let belt = belt(LawKind::Stribeck, 0.005, Waveform::Sine);
    let plant = plant(&belt);
    // Without dither sliding is stable from 0.2 √(1 − 0.01/0.857) = 0.1988 on.
    let over = [RealInterval::new(0.2, 0.25)];
    let found = design(problem(&plant, &over, &[])).answer.expect("feasible");
    assert_eq!((found.critical.amplitude, found.critical.worst), (0.01, None));
}
