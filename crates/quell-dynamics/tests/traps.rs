//! The pitfalls of stick-slip integration, one test each; every test fails without the remedy.

use std::f64::consts::{PI, TAU};

use quell_dynamics::response::{ResponseCase, Solver, compare_many};
use quell_dynamics::simulation::{
    DEFAULT_TOLERANCE, Event, EventKind, EventRecorder, FinalState, Observer, Sampler, Start,
    VelocitySection, simulate,
};
use quell_model::{Belt, Waveform};
use quell_zoo::BeltExt;
use quell_zoo::belt::{self, decreasing_under, stribeck_under};
use quell_zoo::dither::{at_phase, tangential};

use crate::response_of;

fn start(displacement: f64, velocity: f64) -> Start {
    Start { time: 0.0, displacement, velocity }
}

fn run(belt: &Belt, from: Start, until: f64) -> (FinalState, Vec<Event>) {
    let mut record = EventRecorder::default();
    let end = simulate(belt, from, until, DEFAULT_TOLERANCE, &mut record).expect("no stall");
    (end, record.events)
}

/// Pitfall 1: just after a release v_r has a double zero, after a reversal or a jump a simple one. If it
/// were not divided out, the slip would end where it began.
#[test]
fn a_release_is_not_taken_for_the_next_stick() {
    let smooth = stribeck_under(Waveform::Sine, 0.3);
    let jumping = stribeck_under(Waveform::Square, 0.3);
    let reversing = decreasing_under(Waveform::Sine, 12.0);
    for (belt, from) in
        [(smooth, Start::REST), (jumping, Start::REST), (reversing, start(0.2, 0.0))]
    {
        let (_, events) = run(&belt, from, 100.0);
        assert!(events.len() > 100);
        for pair in events.windows(2) {
            if pair[0].slip_sign != 0 {
                let slip = pair[1].time - pair[0].time;
                assert!(slip > 1e-6, "{slip:e} after {:?}", pair[0]);
            }
        }
    }
}

/// Pitfall 2: a grazing of the static threshold, or a crossing by less than rounding, must neither loop
/// nor move the mass.
#[test]
fn grazing_the_threshold_does_not_loop() {
    for waveform in [Waveform::Sine, Waveform::Triangle] {
        for offset in [0.0, 1e-17, 5e-17, 1e-16, -1e-16, 1e-15, 1e-14, 1e-12, 1e-10, 1e-8] {
            // f_s = x₀ − D g grazes μ_s = 0.4 once per period.
            let belt = belt::stribeck()
                .at_speed(0.0)
                .with_dither(at_phase(tangential(waveform.clone(), 0.15, 10.0), 0.3));
            let (end, events) = run(&belt, start(0.25 + offset, 0.0), 100.0);
            let grazings = 100.0 * 10.0 / TAU;
            assert!(
                (events.len() as f64) < 4.0 * grazings,
                "{waveform:?}, offset {offset:e}: {} events",
                events.len()
            );
            assert!((end.displacement - 0.25).abs() < 1e-6, "offset {offset:e}");
        }
    }
}

/// Pitfalls 3 and 5: a jump of the dither ends a stick exactly at the time of the jump, as one release.
#[test]
fn a_jump_releases_the_mass_at_the_jump() {
    let belt = stribeck_under(Waveform::Square, 0.2);
    // Sticking with f_s = 0.3505 − 0.2; at τ = π/R it jumps to about 0.57 > 0.4.
    let (_, events) = run(&belt, start(0.35, 0.05), 0.5);
    let jump = PI / 10.0;
    assert_eq!(events[0].kind, EventKind::Release);
    assert_eq!(events[0].time, jump);
    assert_eq!(events[0].slip_sign, 1);
    assert_eq!(events.iter().filter(|event| event.time == jump).count(), 1);
    assert!((events[0].displacement - (0.35 + 0.05 * jump)).abs() < 1e-15);
}

/// Pitfall 4: two roots of v_r inside one step. The orbit grazes v_r = 0 at some D; just above, v_r dips
/// below zero for much less than a step, which the signs at the ends of the step do not show.
#[test]
fn a_dip_inside_a_step_is_found() {
    let events_and_low = |amplitude: f64| {
        let belt = decreasing_under(Waveform::Sine, amplitude);
        let fast = amplitude * 10.0 / 99.0;
        let mut watch = (EventRecorder::default(), Sampler::new(0.0, 1e-5, 60_000));
        simulate(&belt, start(0.2857, -fast), 0.6, DEFAULT_TOLERANCE, &mut watch)
            .expect("no stall");
        let low = watch.1.samples.iter().map(|sample| 1.0 - sample.velocity);
        (watch.0.events.len(), low.fold(f64::INFINITY, f64::min))
    };
    let (mut sliding, mut crossing) = (9.0, 11.0);
    assert!(events_and_low(sliding).0 == 0 && events_and_low(crossing).0 > 0);
    while crossing - sliding > 1e-12 {
        let middle = 0.5 * (sliding + crossing);
        if events_and_low(middle).0 == 0 {
            sliding = middle;
        } else {
            crossing = middle;
        }
    }
    // Below, v_r stays positive and approaches zero as closely as the sampling can resolve; finding a dip
    // by its ends alone would need 10⁻⁴ more amplitude.
    let (events, low) = events_and_low(sliding);
    assert_eq!(events, 0);
    assert!(low > 0.0 && low < 1e-8, "{low:e}");
    assert!(events_and_low(sliding + 1e-9).0 > 0);
}

/// Pitfall 5: at v_r = 0 on a jump the value after the jump decides, by f_s alone.
#[test]
fn a_start_on_a_jump_takes_the_value_after_it() {
    for (phase, sign) in [(0.0, -1), (PI, 1)] {
        let dither = at_phase(tangential(Waveform::Square, 0.5, 10.0), phase);
        let belt = belt::stribeck().with_dither(dither);
        let (end, events) = run(&belt, start(0.0, 0.05), 1e-3);
        assert!(events.is_empty());
        assert_eq!(end.slip_sign, sign, "phase {phase}");
    }
    let weak = stribeck_under(Waveform::Square, 0.3);
    assert!(run(&weak, start(0.0, 0.05), 1e-3).0.sticking);
}

/// Pitfall 6: observers are passive.
#[test]
fn observers_change_no_bit() {
    fn watched(belt: &Belt, observer: &mut impl Observer) -> FinalState {
        simulate(belt, Start::REST, 300.0, DEFAULT_TOLERANCE, observer).expect("no stall")
    }
    let dithers = vec![
        tangential(Waveform::Sine, 0.3, 10.0),
        at_phase(tangential(Waveform::Triangle, 0.1, 3.7), 1.0),
    ];
    let belt = belt::stribeck().with_dithers(dithers);
    let bits = |observer: &mut dyn FnMut() -> FinalState| {
        let end = observer();
        [end.time, end.displacement, end.velocity].map(f64::to_bits)
    };
    let alone = bits(&mut || watched(&belt, &mut ()));
    let mut sampler = Sampler::new(0.0, 0.001, 300_000);
    let mut strobe = Sampler::new(0.0, 0.2 * PI, 478);
    let mut section = VelocitySection::upward(0.0);
    assert_eq!(alone, bits(&mut || watched(&belt, &mut sampler)));
    assert_eq!(alone, bits(&mut || watched(&belt, &mut strobe)));
    assert_eq!(alone, bits(&mut || watched(&belt, &mut section)));
    assert_eq!(sampler.samples.len(), 300_000);
    assert_eq!(strobe.samples.len(), 478);
    // The section is at x′ = 0, rising, and agrees with the dense samples.
    assert!(section.crossings.len() > 30);
    for crossing in &section.crossings {
        assert!(crossing.velocity.abs() < 1e-13);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let index = (crossing.time / 0.001) as usize;
        assert!(sampler.samples[index].velocity <= 1e-12);
        assert!(sampler.samples[index + 1].velocity >= -1e-12);
    }
}

/// Pitfall 7: a slow transient is not reported as a steady response: by the record of a map it has not settled, and `respond` measures
/// the motion on which it ends.
#[test]
fn an_unfinished_decay_is_reported() {
    let belt = decreasing_under(Waveform::Sine, 2.84);
    let short = Solver { settle: 200.0, ..Solver::default() };
    let case = ResponseCase { belt: belt.clone(), start: Start::REST };
    let found = compare_many(&[case], &short);
    assert!(!found[0].expect("no stall").settled());
    let quenched = response_of(&belt, Start::REST, &short);
    assert!(quenched.dithered.lines.whole < 1e-6, "{}", quenched.dithered.lines.whole);
}
