//! Contacts with a state of their own: elastic sliders and LuGre bristles.

use std::f64::consts::{PI, TAU};

use quell_dynamics::mean_friction::mean_friction;
use quell_dynamics::motion::{
    ContactPhase, MOTION_TOLERANCE, Motion, MotionEnd, MotionRecorder, MotionStart,
};
use quell_dynamics::simulation::EventKind;
use quell_model::profile::{KnotShape, Knots, Profile};
use quell_model::system::{MassMatrix, Mechanical};
use quell_model::{Belt, Direction, Dither, LawKind, System, Waveform};
use quell_numerics::matrix::Matrix;

fn dithered(direction: Direction, amplitude: f64, frequency_ratio: f64, phase: f64) -> Dither {
    Dither {
        direction,
        waveform: Waveform::Sine,
        amplitude,
        frequency_ratio,
        phase,
        envelope: None,
    }
}

fn slider(
    (zeta, velocity): (f64, f64),
    law: LawKind,
    values: &[f64],
    stiffness: Option<f64>,
    dithers: Vec<Dither>,
) -> System {
    let law = law.build(values).expect("a law");
    let belt = Belt::new(zeta, 1.0, velocity, law, dithers).expect("a belt");
    belt.with_tangential_stiffness(stiffness).expect("a stiffness").system()
}

/// A run from rest, or from a state of the structure.
fn run(system: &System, structure: [f64; 2], until: f64) -> (MotionEnd, MotionRecorder) {
    let motion = Motion::new(system).expect("a motion");
    let start = MotionStart { time: 0.0, state: motion.relaxed(&structure) };
    let mut events = MotionRecorder::default();
    let end = motion.run(&start, until, MOTION_TOLERANCE, &mut events).expect("an end");
    (end, events)
}

/// (time, release or stick, slip sign)
type Expected = (f64, EventKind, i8);

fn assert_events(found: &MotionRecorder, expected: &[Expected]) {
    for (event, (time, kind, sign)) in found.events.iter().zip(expected) {
        assert!((event.time - time).abs() < 1e-8, "{event:?} at {time}");
        assert_eq!((event.kind, event.slip_sign), (*kind, *sign), "{event:?}");
    }
    assert!(found.events.len() >= expected.len(), "{} events", found.events.len());
}

#[test]
fn an_elastic_slider_moves_as_two_other_integrators_find() {
    let system = slider((0.01, 0.1), LawKind::Coulomb, &[0.3, 0.3, 0.0], Some(20.0), Vec::new());
    let (end, events) = run(&system, [0.0, 0.0], 30.0);
    assert_eq!(events.events.len(), 5);
    let (stick, release) = (EventKind::Stick, EventKind::Release);
    assert_events(
        &events,
        &[(0.164379259, release, 1), (0.419744375, stick, 0), (1.570625838, release, 1)],
    );
    assert!((end.state[0] - 0.356216271167392).abs() < 1e-10);
    assert!((end.state[1] - 0.009874938342066226).abs() < 1e-10);
    assert_eq!(end.contacts[0].friction, 0.3);
}

#[test]
fn an_elastic_slider_under_a_load_that_varies() {
    let normal = vec![dithered(Direction::Normal, 0.5, 6.0, 0.0)];
    let system = slider((0.01, 0.05), LawKind::Coulomb, &[0.3, 0.3, 0.0], Some(10.0), normal);
    let (end, events) = run(&system, [0.0, 0.0], 25.0);
    assert_eq!(events.events.len(), 41);
    assert!((end.state[0] - 0.29850655174653146).abs() < 1e-10);
    assert!((end.contacts[0].friction - 0.19276853555562531).abs() < 1e-10);
}

#[test]
fn bristles_move_as_two_other_integrators_find() {
    let tangential = vec![dithered(Direction::Tangential, 0.8, 8.0, 0.0)];
    let values = [0.3, 0.4, 0.05, 100.0, 2.0, 0.02];
    let system = slider((0.01, 0.03), LawKind::Lugre, &values, None, tangential);
    let (end, events) = run(&system, [0.0, 0.0], 15.0);
    assert_eq!(events.events.len(), 38);
    let reversal = EventKind::Reversal;
    assert_events(&events, &[(0.081741124, reversal, -1), (0.53405992, reversal, 1)]);
    assert!((end.state[0] - 0.0450045996455362).abs() < 1e-10);
    assert!((end.state[2] - 0.003011400319427485).abs() < 1e-10);
    assert_eq!(end.contacts[0].phase, ContactPhase::Slip(1));
}

/// k_t → ∞ is the rigid contact. An adhering slider oscillates about the force that would hold a rigid contact, at √(k_t/m): its velocity
/// differs by 1/√k_t, a tenth for a hundred times the stiffness.
#[test]
fn a_stiff_slider_is_a_rigid_contact() {
    let ends = [None, Some(1e3), Some(1e5), Some(1e7)].map(|stiffness| {
        let dither = vec![dithered(Direction::Tangential, 0.8, 3.0, 0.3)];
        let law = [0.3, 0.4, 0.0];
        let system = slider((0.01, 0.08), LawKind::Coulomb, &law, stiffness, dither);
        run(&system, [0.0, 0.0], 6.0).0.state
    });
    let off =
        |place: usize| (ends[place][0] - ends[0][0]).abs() + (ends[place][1] - ends[0][1]).abs();
    assert!(off(1) > 1e-6, "{}", off(1));
    assert!(off(2) < 0.15 * off(1) && off(3) < 0.15 * off(2), "{} {} {}", off(1), off(2), off(3));
    assert!(off(3) < 1e-3, "{}", off(3));
}

/// A run that is continued from its own state, in slip and in adhesion, ends as the run without a break.
#[test]
fn a_run_continues_from_the_state_of_its_contacts() {
    let cases = [
        (LawKind::Coulomb, vec![0.3, 0.3, 0.0], Some(20.0)),
        (LawKind::StribeckExponential, vec![0.25, 0.4, 0.1, 2.0, 0.05], Some(20.0)),
        (LawKind::StribeckExponential, vec![0.3, 0.3, 0.1, 2.0, 0.5], Some(20.0)),
        (LawKind::Lugre, vec![0.3, 0.4, 0.05, 100.0, 2.0, 0.02], None),
    ];
    for (law, values, stiffness) in cases {
        let dither = vec![dithered(Direction::Tangential, 0.8, 4.0, 0.3)];
        let system = slider((0.01, 0.08), law, &values, stiffness, dither);
        let motion = Motion::new(&system).expect("a motion");
        let whole = run(&system, [0.0, 0.0], 8.0).0;
        let mut phases = Vec::new();
        for stop in 1..16 {
            let half = run(&system, [0.0, 0.0], 0.5 * f64::from(stop)).0;
            phases.push(half.contacts[0].phase);
            let end = motion.run(&half.restart(), 8.0, MOTION_TOLERANCE, &mut ()).expect("an end");
            for (found, expected) in end.state.iter().zip(&whole.state) {
                assert!((found - expected).abs() < 1e-9, "{law:?} {stop}: {found} {expected}");
            }
        }
        let sticks = phases.contains(&ContactPhase::Stick);
        assert_eq!(sticks, law != LawKind::Lugre, "{law:?}: {phases:?}");
        assert!(phases.iter().any(|phase| matches!(phase, ContactPhase::Slip(_))));
    }
}

/// A run that is cut where the load jumps, up or down, goes on as the run without a break: T does not jump up, and a slider that slides
/// goes on to slide under a smaller load, also if its static level there is above T.
#[test]
fn a_run_continues_from_a_jump_of_its_load() {
    for law in [[0.3, 0.3, 0.0], [0.3, 0.4, 0.0]] {
        for amplitude in [0.1, 0.4] {
            let normal = Dither {
                waveform: Waveform::Square,
                ..dithered(Direction::Normal, amplitude, 5.0, 0.0)
            };
            let system = slider((0.02, 0.1), LawKind::Coulomb, &law, Some(15.0), vec![normal]);
            let motion = Motion::new(&system).expect("a motion");
            let whole = run(&system, [0.1, -0.2], 9.0).0;
            for jump in 1..14 {
                let cut = run(&system, [0.1, -0.2], f64::from(jump) * PI / 5.0).0;
                let end = motion.run(&cut.restart(), 9.0, MOTION_TOLERANCE, &mut ());
                let end = end.expect("an end");
                for (found, expected) in end.state.iter().zip(&whole.state) {
                    let off = (found - expected).abs();
                    assert!(off < 1e-9, "{law:?} {amplitude} {jump}: {found} {expected}");
                }
            }
        }
    }
}

/// Under a load with jumps and kinks, against a second method: fixed steps in which the spring is stretched
/// first and its force then cut to its bound. Its error is of the first order in the step.
#[test]
fn loads_with_jumps_and_kinks_agree_with_fixed_steps() {
    for waveform in [Waveform::Square, Waveform::Triangle, Waveform::Sine] {
        let normal = Dither { waveform, ..dithered(Direction::Normal, 0.6, 5.0, 0.4) };
        let tangential = dithered(Direction::Tangential, 0.5, 3.0, 0.0);
        let dithers = vec![normal.clone(), tangential.clone()];
        let system = slider((0.02, 0.1), LawKind::Coulomb, &[0.3, 0.3, 0.0], Some(15.0), dithers);
        let (end, events) = run(&system, [0.1, -0.2], 10.0);
        assert!(events.events.len() > 10, "{}", events.events.len());
        let step = 1e-6;
        let (mut x, mut v, mut force) = (0.1_f64, -0.2_f64, 0.0_f64);
        for k in 0..10_000_000_u32 {
            let time = (f64::from(k) + 0.5) * step;
            let dither = |dither: &Dither| {
                let phase = dither.frequency_ratio.mul_add(time, dither.phase);
                dither.amplitude * dither.waveform.value(phase)
            };
            let bound = 0.3 * (1.0 + dither(&normal));
            force = (force + 15.0 * (0.1 - v) * step).clamp(-bound, bound);
            v += step * (force + dither(&tangential) - x - 0.04 * v);
            x += step * v;
        }
        let off = (end.state[0] - x).abs() + (end.state[1] - v).abs();
        assert!(off < 1e-5, "{normal:?}: {off:e}");
        assert!((end.contacts[0].friction - force).abs() < 1e-4, "{normal:?}");
    }
}

/// A law that rises with γ above its static level bounds adhesion too: the force of a spring does not jump up to it. Against the same
/// fixed steps, whose bound is then the level at γ.
#[test]
fn a_law_that_rises_above_its_static_level_agrees_with_fixed_steps() {
    for waveform in [Waveform::Square, Waveform::Triangle, Waveform::Sine] {
        let normal = Dither { waveform, ..dithered(Direction::Normal, 0.6, 5.0, 0.4) };
        let tangential = dithered(Direction::Tangential, 0.5, 3.0, 0.0);
        let dithers = vec![normal.clone(), tangential.clone()];
        let law = [0.3, 0.3, 0.1, 2.0, 0.5];
        let kind = LawKind::StribeckExponential;
        let system = slider((0.02, 0.1), kind, &law, Some(15.0), dithers);
        let (end, events) = run(&system, [0.1, -0.2], 10.0);
        assert!(events.events.len() > 10, "{}", events.events.len());
        let step = 1e-6;
        let (mut x, mut v, mut force) = (0.1_f64, -0.2_f64, 0.0_f64);
        for k in 0..10_000_000_u32 {
            let time = (f64::from(k) + 0.5) * step;
            let dither = |dither: &Dither| {
                let phase = dither.frequency_ratio.mul_add(time, dither.phase);
                dither.amplitude * dither.waveform.value(phase)
            };
            let slip = 0.1 - v;
            let bound = (0.3 + 0.5 * slip.abs()) * (1.0 + dither(&normal));
            force = (force + 15.0 * slip * step).clamp(-bound, bound);
            v += step * (force + dither(&tangential) - x - 0.04 * v);
            x += step * v;
        }
        let off = (end.state[0] - x).abs() + (end.state[1] - v).abs();
        assert!(off < 1e-5, "{normal:?}: {off:e}");
        assert!((end.contacts[0].friction - force).abs() < 1e-4, "{normal:?}");
    }
}

/// The level of this law rises at zero slip and falls from γ = 0.0033 on: a slider that begins to slip there under a varying load.
#[test]
fn a_slider_passes_the_rise_of_its_law_at_small_slip() {
    let law = LawKind::StribeckExponential.build(&[0.25, 0.4, 0.1, 2.0, 0.05]).expect("a law");
    let belt = Belt::new(0.01, 1.0, 0.1, law, Vec::new()).expect("a belt");
    let belt = belt.with_tangential_stiffness(Some(23.0)).expect("a stiffness");
    let mut system = belt.system();
    let load = Knots::new(vec![0.0, 9.0, 21.0], vec![1.0, 1.4, 0.8], KnotShape::Linear);
    system.contacts[0].varying_load = Some(Profile::over(load.expect("knots")));
    let (end, events) = run(&system, [0.1, -0.2], 60.0);
    assert!(end.time == 60.0 && events.events.len() > 5, "{}", events.events.len());
}

/// Pseudo-random numbers in [0, 1), from a linear congruence.
fn uniform(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

/// Random sliders, of falling and rising laws, under dither along and across, end their runs with T within its bound.
#[test]
fn random_sliders_run_to_their_ends() {
    let mut seed = 19;
    let waveforms = [Waveform::Sine, Waveform::Triangle, Waveform::Square];
    for case in 0..400_usize {
        let mut next = |low: f64, high: f64| low + (high - low) * uniform(&mut seed);
        let values = [next(0.1, 0.4), next(0.1, 0.5), next(0.02, 0.4), 2.0, next(0.0, 1.0)];
        let values = [values[0].min(values[1]), values[1], values[2], values[3], values[4]];
        let mut dither = |direction, amplitude| Dither {
            waveform: waveforms[(case + usize::from(direction == Direction::Normal)) % 3].clone(),
            ..dithered(direction, amplitude, next(1.3, 9.0), next(0.0, 6.0))
        };
        let dithers = vec![dither(Direction::Tangential, 0.7), dither(Direction::Normal, 0.6)];
        let stiffness = 10_f64.powf(next(0.0, 3.0));
        let belt = (next(0.0, 0.1), next(0.01, 0.4));
        let kind = LawKind::StribeckExponential;
        let system = slider(belt, kind, &values, Some(stiffness), dithers);
        let motion = Motion::new(&system).expect("a motion");
        let state = motion.relaxed(&[next(-0.5, 0.5), next(-0.5, 0.5)]);
        let start = MotionStart { time: 0.0, state };
        let end = motion.run(&start, 30.0, MOTION_TOLERANCE, &mut ());
        let end = end.unwrap_or_else(|why| panic!("{case}: {why:?} {system:?}"));
        let contact = &end.contacts[0];
        let level = system.contacts[0].friction.coefficient(contact.slip_velocity.abs());
        let bound = level.max(values[1]) * contact.normal_load;
        assert!(contact.friction.abs() <= bound * (1.0 + 1e-9), "{case}: {end:?}");
    }
}

/// Bristles far stiffer than the dither is fast: the mean friction under v = V + a cos θ at V/a = 0.1 is 2 asin(0.1)/π for a rigid contact,
/// and differs from it by a part that falls as one over their stiffness.
#[test]
fn stiff_bristles_have_the_mean_friction_of_a_rigid_contact() {
    let rigid = 2.0 / PI * 0.1_f64.asin();
    let off = [1e3, 1e4, 1e5].map(|stiffness| {
        let law = LawKind::Lugre.build(&[1.0, 1.0, 0.05, stiffness, 0.0, 0.0]).expect("a law");
        let dither = dithered(Direction::Tangential, 10.0, 10.0, 0.0);
        let belt = Belt::new(0.01, 1.0, 0.1, law, vec![dither]).expect("a belt");
        mean_friction(&belt, 0.1).expect("a mean").coefficient - rigid
    });
    assert!((off[0] - 2.16e-4).abs() < 1e-6, "{off:?}");
    assert!(
        (off[0] / off[1] - 10.0).abs() < 0.1 && (off[1] / off[2] - 10.0).abs() < 0.1,
        "{off:?}"
    );
}

/// At a slip of 100 the bristles are 10⁷ times as fast as the dither. They are at their level g sgn γ but for its changes: the mean is that
/// of g + σ₂γ, and the part by which they lag behind it is a 10⁻⁷ of it.
#[test]
fn the_mean_of_stiff_bristles_in_fast_slip_ends() {
    for (stiffness, velocity) in [(1e3, 100.0), (1e5, 100.0), (1e7, 1.0), (1e9, 1e4)] {
        let law = LawKind::Lugre.build(&[0.3, 0.4, 0.05, stiffness, 2.0, 0.02]).expect("a law");
        let dither = dithered(Direction::Tangential, 5.0, 10.0, 0.3);
        let belt = Belt::new(0.01, 1.0, 0.1, law, vec![dither]).expect("a belt");
        let found = mean_friction(&belt, velocity).expect("a mean");
        let expected = 0.3 + 0.02 * velocity;
        let off = (found.coefficient - expected).abs();
        assert!(off < 1e-9 * expected, "{stiffness} {velocity}: {off:e}");
        assert!((found.slope - 0.02).abs() < 1e-8, "{}", found.slope);
    }
}

/// An open contact has no state: bristles and sliders land with zero, regardless of what they carried when they opened.
#[test]
fn contacts_land_without_deflection() {
    for (law, values, stiffness) in [
        (LawKind::Lugre, vec![0.3, 0.4, 0.05, 100.0, 2.0, 0.02], None),
        (LawKind::Coulomb, vec![0.3, 0.3, 0.0], Some(20.0)),
    ] {
        let mut system = slider((0.01, 0.1), law, &values, stiffness, Vec::new());
        let rows = Matrix::identity(2);
        let names = vec!["x".to_owned(), "y".to_owned()];
        let mass = MassMatrix::dense(rows.clone());
        system.structure = Mechanical::new(names, mass, Matrix::zeros(2, 2), rows).into();
        let contact = &mut system.contacts[0];
        contact.tangent = Some(vec![1.0, 0.0]);
        contact.normal = Some(vec![0.0, 1.0]);
        contact.normal_stiffness = 2.0;
        let motion = Motion::new(&system).expect("a motion");
        let state = motion.relaxed(&[0.0, 1.5, 0.0, 0.0]);
        let mut events = MotionRecorder::default();
        let start = MotionStart { time: 0.0, state };
        motion.run(&start, 30.0, MOTION_TOLERANCE, &mut events).expect("an end");
        let carried = |kind| {
            let of_kind = events.events.iter().filter(move |event| event.kind == kind);
            of_kind.map(|event| event.state[4]).collect::<Vec<f64>>()
        };
        let landings = carried(EventKind::Landing);
        assert!(landings.len() > 3 && landings.iter().all(|own| *own == 0.0), "{landings:?}");
    }
}

/// A soft slider that slips slowly is released once in several periods of the dither: its mean is that of all of them, as plain steps of
/// the same law find it.
#[test]
fn a_slider_repeats_itself_after_several_periods() {
    let (amplitude, rate) = (0.5, 5.0);
    let values = [0.2, 0.5, 0.05, 2.0, 0.0];
    for (stiffness, slip) in [(2.0, 0.06), (2.0, 0.01), (5.0, 0.03)] {
        let law = LawKind::StribeckExponential.build(&values).expect("a law");
        let dither = vec![dithered(Direction::Tangential, amplitude, rate, 0.0)];
        let belt = Belt::new(0.01, 1.0, 0.1, law.clone(), dither).expect("a belt");
        let belt = belt.with_tangential_stiffness(Some(stiffness)).expect("a stiffness");
        let found = mean_friction(&belt, slip).expect("a mean").coefficient;

        let step = TAU / rate / 4000.0;
        let (mut force, mut slides, mut sum) = (0.5_f64, false, 0.0);
        let (skipped, counted) = (200 * 4000, 3000 * 4000);
        for count in 0..skipped + counted {
            let gamma = slip - amplitude / rate * (rate * step * f64::from(count)).cos();
            let level = law.coefficient(gamma.abs()).copysign(force);
            if slides {
                let own = gamma - (level - force) / (step * stiffness);
                // A release is a jump of T at a slip that goes on.
                slides = own * force > 0.0 || (level - force).abs() > 0.01;
                force = level;
            } else {
                force += stiffness * gamma * step;
                slides = force.abs() >= law.static_coefficient();
            }
            if count >= skipped {
                sum += force;
            }
        }
        let mean = sum / f64::from(counted);
        assert!((found - mean).abs() < 3e-3, "k_t = {stiffness}, V = {slip}: {found} {mean}");
    }
}

/// A slider that adheres above its static level, because sliding at its speed would take more, and one that slides against the direction
/// of its slip, go on so after a cut at any time: T decides, and T is part of the state.
#[test]
fn a_run_continues_from_every_branch_of_a_slider() {
    let mut seed = 12_345_u64;
    let mut share = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    for case in 0..60 {
        let level = 0.2 + 0.2 * share();
        let rise = if share() > 0.4 { 0.15 * share() } else { 0.0 };
        let values = [level, level + rise, 0.05 + 0.3 * share(), 2.0, 0.8 * share()];
        let tangential =
            dithered(Direction::Tangential, 1.5 * share(), 1.0 + 6.0 * share(), share());
        let normal = dithered(Direction::Normal, 0.8 * share(), 1.0 + 6.0 * share(), share());
        let system = slider(
            (0.05 * share(), 0.02 + 0.3 * share()),
            LawKind::StribeckExponential,
            &values,
            Some(2.0 + 60.0 * share()),
            vec![tangential, normal],
        );
        let motion = Motion::new(&system).expect("a motion");
        let from = [share() - 0.5, share() - 0.5];
        let whole = run(&system, from, 8.0).0;
        for _ in 0..20 {
            let cut = run(&system, from, 8.0 * share()).0;
            let end = motion.run(&cut.restart(), 8.0, MOTION_TOLERANCE, &mut ()).expect("an end");
            for (found, expected) in end.state.iter().zip(&whole.state) {
                let contacts = &cut.contacts;
                assert!((found - expected).abs() < 1e-11, "{case}, {}: {contacts:?}", cut.time);
            }
        }
    }
}
