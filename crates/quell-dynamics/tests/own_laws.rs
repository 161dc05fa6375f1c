//! User-defined laws, as a formula or from samples, against the equivalent built-in laws.

use quell_dynamics::orbit::base_response;
use quell_dynamics::simulation::{
    Event, EventKind, EventRecorder, InstructionSet, SimulationRun, Start, simulate,
    simulate_many_with,
};
use quell_linear::averaging::{
    Averaging, CriticalVelocity, FastMotion, FastWave, closed_band, criterion, effective,
    effective_by_quadrature, everywhere_stable_amplitude, undithered_critical_velocity,
};
use quell_model::{Belt, Direction, Dither, Expression, Friction, LawKind, Samples, Waveform};
use quell_zoo as zoo;
use quell_zoo::BeltExt;
use quell_zoo::belt::DAMPING_RATIO;
use quell_zoo::dither::{at_phase, tangential};
use quell_zoo::law::{self, measured};

use crate::belt_orbits::{monodromy, orbit_near};

const TOLERANCE: f64 = 1e-13;

/// (2.7) and (2.8) built in and as formulas.
fn pairs() -> Vec<(Friction, Friction)> {
    let pair = |kind| (law::dissertation(kind), law::dissertation_as_formula(kind));
    [LawKind::Stribeck, LawKind::Decreasing].map(pair).to_vec()
}

fn dither(direction: Direction, waveform: Waveform, amplitude: f64) -> Dither {
    at_phase(zoo::dither::dither(direction, waveform, amplitude, 7.3), 0.4)
}

fn belt(law: &Friction, velocity: f64, dithers: Vec<Dither>) -> Belt {
    zoo::belt::belt(DAMPING_RATIO, velocity, law, dithers)
}

fn events(belt: &Belt, until: f64) -> Vec<Event> {
    let mut watch = EventRecorder::default();
    simulate(belt, Start::REST, until, TOLERANCE, &mut watch).expect("no stall");
    watch.events
}

/// Under dither squeal is chaotic over long times: the comparison ends before errors have grown.
#[test]
fn a_formula_gives_the_events_of_the_equivalent_law() {
    for (built_in, custom) in pairs() {
        for dithers in [
            vec![],
            vec![dither(Direction::Tangential, Waveform::Sine, 0.3)],
            vec![dither(Direction::Tangential, Waveform::Square, 0.2)],
            vec![
                dither(Direction::Normal, Waveform::Triangle, 0.4),
                dither(Direction::Tangential, Waveform::Sine, 2.0),
            ],
        ] {
            let (known, found) = (
                events(&belt(&built_in, 0.05, dithers.clone()), 25.0),
                events(&belt(&custom, 0.05, dithers), 25.0),
            );
            assert!(known.len() >= 4 && known.len() == found.len(), "{custom:?}: {}", known.len());
            for (known, found) in known.iter().zip(&found) {
                assert_eq!((known.kind, known.slip_sign), (found.kind, found.slip_sign));
                assert!((known.time - found.time).abs() < 1e-10, "{known:?} {found:?}");
                assert!((known.displacement - found.displacement).abs() < 1e-10);
            }
        }
    }
}

/// Quadrature against closed forms, and every threshold of averaging.
#[test]
fn a_formula_has_the_averages_and_thresholds_of_the_equivalent_law() {
    for (built_in, custom) in pairs() {
        for waveform in [Waveform::Sine, Waveform::Triangle, Waveform::Square] {
            for v in [0.02, 0.11, 0.3, -0.11] {
                let dithers = vec![dither(Direction::Tangential, waveform.clone(), 0.8)];
                let (known, found) =
                    (belt(&built_in, 0.05, dithers.clone()), belt(&custom, 0.05, dithers));
                let mean = |belt: &Belt| {
                    let motion = FastMotion::of(belt, v, Averaging::Limit).expect("fast");
                    effective(belt.friction(), &motion, v).expect("a mean")
                };
                let (known, found) = (mean(&known), mean(&found));
                assert!((known.coefficient - found.coefficient).abs() < 1e-12, "{waveform:?} {v}");
                assert!((known.slope - found.slope).abs() < 1e-10 * (1.0 + known.slope.abs()));
            }
            let upper = |law: &Friction| {
                closed_band(law, 0.005, 1.0, &waveform, 0.1).ok().and_then(|band| band.upper)
            };
            let (known, found) = (upper(&built_in), upper(&custom));
            let close = known.zip(found).is_some_and(|(known, found)| (known - found).abs() < 1e-9);
            assert!(close, "{waveform:?}: {known:?} {found:?}");
        }
        let edge = |law: &Friction| match undithered_critical_velocity(law, 0.005, 1.0) {
            Ok(CriticalVelocity::Above(v)) => v,
            other => panic!("{other:?}"),
        };
        assert!((edge(&built_in) - edge(&custom)).abs() < 1e-10);
        let normal = vec![dither(Direction::Normal, Waveform::Sine, 0.5)];
        let value = |law: &Friction| {
            criterion(&belt(law, 0.12, normal.clone()), Averaging::Limit).expect("a mean").value
        };
        assert!((value(&built_in) - value(&custom)).abs() < 1e-10);
    }
    let (built_in, custom) = &pairs()[0];
    for direction in [Direction::Tangential, Direction::Normal] {
        let wave = FastWave::Integral(Waveform::Triangle);
        let all =
            |law: &Friction| everywhere_stable_amplitude(law, 0.005, 1.0, wave.clone(), direction);
        let digits = |law: &Friction| format!("{:.6?}", all(law).expect("an amplitude"));
        let (known, found) = (digits(built_in), digits(custom));
        // The amplitudes to six digits; their error bounds differ by the method.
        let amplitude = |text: &str| text.split("error").next().map(str::to_owned);
        assert_eq!(amplitude(&known), amplitude(&found));
    }
}

/// An exponential is recovered exactly, a cubic within the error that the fit reports.
#[test]
fn samples_of_a_law_give_that_law_within_the_error_of_the_fit() {
    let built_in: Vec<Friction> = pairs().into_iter().map(|(built_in, _)| built_in).collect();
    for (law, last, most, close) in
        [(&built_in[1], 1.0, 1e-9, 1e-6), (&built_in[0], 0.3, 2e-3, 0.1)]
    {
        let custom = Samples::new(&measured(law, last, 61), None, None, 1.0).expect("a fit");
        let error = custom.fit().largest_error;
        assert!(error < most, "{:?}", custom.fit());
        assert_eq!(custom.fit().samples, 61);
        let custom = Friction::Samples(custom);
        for k in 0..200 {
            let u = last * f64::from(k) / 200.0;
            let off = (custom.coefficient(u) - law.coefficient(u)).abs();
            assert!(off <= 3.0 * error + 1e-15, "{law:?} at {u}: {off:.1e}, stated {error:.1e}");
        }
        let (known, found) =
            (events(&belt(law, 0.05, vec![]), 20.0), events(&belt(&custom, 0.05, vec![]), 20.0));
        assert_eq!(known.len(), found.len());
        for (known, found) in known.iter().zip(&found) {
            assert!((known.time - found.time).abs() < close, "{known:?} {found:?}");
        }
        let wave = FastWave::Integral(Waveform::Sine);
        let mean = |law: &Friction| {
            effective_by_quadrature(law, &wave, 0.1, 0.05).expect("a mean").coefficient
        };
        assert!((mean(law) - mean(&custom)).abs() <= 3.0 * error + 1e-12);
    }
}

/// Runs with different constants have the same bits side by side as alone.
#[test]
fn lanes_have_the_same_bits_as_a_run_alone() {
    let mut belts = Vec::new();
    for k in 0..11_u32 {
        let x = f64::from(k);
        let constants = [("a".to_owned(), 0.1 + 0.01 * x), ("b".to_owned(), 0.2 + 0.02 * x)];
        let text = "0.25 + a*exp(-(v/b)^2) + 0.02*tanh(abs(v))/(1 + abs(v))";
        let level = if k % 2 == 0 { Some(0.6) } else { None };
        let custom = Expression::new(text, &constants, level, 1.0).expect(text);
        let dithers = vec![dither(Direction::Tangential, Waveform::Sine, 0.1 + 0.2 * x)];
        belts.push(belt(&Friction::Expression(custom), 0.05 + 0.01 * x, dithers));
        let (law, _) = &pairs()[k as usize % 2];
        let custom =
            Samples::new(&measured(law, 0.4, 30), Some(0.45), Some(2), 1.0).expect("a fit");
        belts.push(belt(&Friction::Samples(custom), 0.05 + 0.01 * x, vec![]));
    }
    let trace = |belt: &Belt| {
        let mut watch = EventRecorder::default();
        (simulate(belt, Start::REST, 40.0, 1e-11, &mut watch).expect("no stall"), watch.events)
    };
    let alone: Vec<_> = belts.iter().map(trace).collect();
    assert!(alone.iter().map(|(_, events)| events.len()).sum::<usize>() > 100);
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let mut watches = vec![EventRecorder::default(); belts.len()];
        let runs = belts.iter().zip(&mut watches);
        let runs = runs.map(|(belt, observer)| SimulationRun {
            belt,
            start: Start::REST,
            until: 40.0,
            observer,
        });
        let ends = simulate_many_with(set, runs.collect(), 1e-11);
        for ((end, watch), alone) in ends.into_iter().zip(watches).zip(&alone) {
            assert_eq!((end.expect("no stall"), watch.events), *alone, "{}", set.name());
        }
    }
}

/// μ_s > μ(0⁺): friction drops at the release, and a delay of the release delays the slip by the same time.
#[test]
fn multipliers_are_correct_across_a_release_with_a_jump() {
    let law = law::jumping_formula();
    assert!(!law.starts_at_static_level());
    let mut judged = 0;
    for (waveform, amplitude) in
        [(Waveform::Sine, 0.7), (Waveform::Triangle, 0.8), (Waveform::Square, 0.5)]
    {
        let wave = at_phase(tangential(waveform.clone(), amplitude, 1.7), 0.2);
        let belt = zoo::belt::belt(0.25, 0.3, &law, vec![wave]);
        let period = std::f64::consts::TAU / 1.7;
        let settled =
            simulate(&belt, Start::REST, 40.0 * period, 1e-14, &mut ()).expect("no stall");
        let guess = Start { time: 0.0, ..settled.restart() };
        let Ok(orbit) = orbit_near(&belt, guess, 1).or_else(|_| base_response(&belt.system(), 20))
        else {
            continue;
        };
        if !orbit.events.iter().any(|event| event.kind == EventKind::Release) {
            continue;
        }
        let end = |dx: f64, dv: f64| {
            let start = Start {
                time: 0.0,
                displacement: orbit.state[0] + dx,
                velocity: orbit.state[1] + dv,
            };
            let end = simulate(&belt, start, orbit.period, 1e-14, &mut ()).expect("no stall");
            [end.displacement, end.velocity]
        };
        // A start in stick has one direction only.
        let h = 1e-4;
        let (ahead, behind) = (end(h, 0.0), end(-h, 0.0));
        for row in 0..2 {
            let other = (ahead[row] - behind[row]) / (2.0 * h);
            let derivative = monodromy(&orbit)[row][0];
            assert!(
                (derivative - other).abs() < 1e-6 * (1.0 + derivative.abs()),
                "{waveform:?}: {derivative} {other}"
            );
        }
        judged += 1;
    }
    assert!(judged >= 2, "{judged} orbits with a release");
}

#[test]
fn constants_of_a_formula_are_parameters_of_the_belt() {
    let (_, custom) = &pairs()[1];
    let belt = belt(custom, 0.05, vec![]);
    assert_eq!(belt.friction().get("friction.constants.v_m"), Some(0.2));
    let changed = belt.with_law_number("friction.constants.v_m", 0.3);
    let known = law::build(LawKind::Decreasing, &[0.4, 0.2857, 0.3]);
    assert!((changed.friction().coefficient(0.17) - known.coefficient(0.17)).abs() < 1e-15);
    let refused = |path: &str, value: f64| {
        let law = belt.friction().with(path, value);
        let complaints = law.and_then(|law| belt.with_friction(law)).expect_err(path);
        assert_eq!(complaints[0].key, "friction.coefficient", "{complaints:?}");
        complaints[0].allowed.clone()
    };
    let division = refused("friction.constants.v_m", 0.0);
    assert!(division.contains("0⁺"), "{division}");
    let negative = refused("friction.constants.mu_m", -1.0);
    assert!(negative.contains("≥ 0"), "{negative}");
    assert_eq!(belt.friction().get("friction.constants.v"), None);
}
