//! Slip that goes on through v_r = 0: one branch of the law, continued analytically to slip of the other sign.
//!
//! No motion of the belt, but the smooth continuation of one. An orbit in pure slip that depends on a parameter
//! exists on both sides of the touch of v_r = 0 in this sense, so that the touch is a simple root of its least slip
//! velocity. In slip of the branch's own sign it is the motion, by the same series as the engine's.

use quell_model::Belt;
use quell_model::friction::{LawVisitor, SlidingLaw};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};

use super::super::clock::Clock;
use super::super::engine::{forcings, longest_step, step_tolerance};
use super::super::observer::{Observer, Segment};
use super::super::pace::Pace;
use super::super::slip::{DitherSeries, Load, SlipEquation, SlipSeries, SlipStart, StepLimits};
use super::super::{FinalState, ORDER, Stalled, Start};
use super::rows::Row;

/// Slip on the branch of `sign` from `start` to τ = `until`, whatever the sign of v_r.
///
/// # Errors
/// [`Stalled`] if a state leaves the finite numbers or no step advances time.
pub(crate) fn slide(
    belt: &Belt,
    sign: f64,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Result<FinalState, Stalled> {
    if let Some(why) = belt.friction().unsimulated() {
        return Err(Stalled { time: start.time, why });
    }
    belt.friction().visit(Sliding { belt, sign, start, until, tolerance, observer })
}

struct Sliding<'a> {
    belt: &'a Belt,
    sign: f64,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &'a mut dyn Observer,
}

impl LawVisitor for Sliding<'_> {
    type Output = Result<FinalState, Stalled>;

    fn visit<L: SlidingLaw>(self, law: &L) -> Self::Output {
        with_fused_multiply_add(SlidingBy { run: self, law })
    }
}

struct SlidingBy<'a, 'l, L> {
    run: Sliding<'a>,
    law: &'l L,
}

impl<L: SlidingLaw> Work for SlidingBy<'_, '_, L> {
    type Output = Result<FinalState, Stalled>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { run, law } = self;
        let Sliding { belt, sign, start, until, tolerance, observer } = run;
        let unit = law.velocity_scale();
        let mut clock = Clock::at(start.time);
        let (mut tangential, mut normal) = forcings(belt, unit, clock);
        let longest = longest_step(&tangential, &normal);
        let mut constants = L::constants::<f64>(std::slice::from_ref(law));
        let belt_velocity = belt.belt_velocity() / unit;
        let equation = SlipEquation { damping: 2.0 * belt.damping_ratio(), belt_velocity };
        let mut displacement = start.displacement / unit;
        let mut slip = (belt.belt_velocity() - start.velocity) / unit;
        let mut series = SlipSeries { displacement: [0.0; ORDER + 1], slip: [0.0; ORDER + 1] };
        let mut table = [Row::ZERO; ORDER + 1];
        let fastest = tangential.highest_rate().max(normal.highest_rate());
        let mut pace = Pace::new(start.time, until, fastest);
        let tolerance = step_tolerance(tolerance, (&tangential, &normal), displacement, slip);
        let mut steps = 0;
        while clock.until(until) > 0.0 {
            let stop = tangential.next_break().min(normal.next_break()).min(until);
            for (row, entry) in table.iter_mut().zip(tangential.series(clock)) {
                row.0[0] = entry;
            }
            let dither = DitherSeries { table: &table, turn: [1.0; 4], line: [0.0; 2] };
            let load_series;
            let load = if normal.is_constant() {
                Load::Steady(normal.mean())
            } else {
                load_series = normal.series(clock);
                Load::Series(&load_series)
            };
            let from = SlipStart { sign, displacement, slip, first_slope: 1.0 };
            let limits = StepLimits { tolerance, longest, room: clock.until(stop) };
            let length =
                equation.series::<L>(&mut constants, from, &dither, load, limits, &mut series);
            (displacement, slip) = series.end(length);
            observer.segment(&Segment {
                clock,
                duration: length,
                slip_sign: if sign > 0.0 { 1 } else { -1 },
                unit,
                belt_velocity: belt.belt_velocity(),
                displacement: &series.displacement,
                slip: &series.slip,
            });
            steps += 1;
            let before = clock;
            clock = clock.after(length);
            if length >= limits.room || clock.time() == stop {
                clock = Clock::at(stop);
                tangential.pass_breaks(clock);
                normal.pass_breaks(clock);
            }
            let stalled = |why| Stalled { time: clock.time(), why };
            if !(displacement.is_finite() && slip.is_finite()) {
                return Err(stalled("the state left the finite numbers"));
            }
            if clock == before {
                return Err(stalled("no step advanced time"));
            }
            if pace.is_due(steps) {
                pace.look(steps, clock.time()).map_err(stalled)?;
            }
        }
        Ok(FinalState {
            time: clock.time(),
            displacement: unit * displacement,
            velocity: belt.belt_velocity() - unit * slip,
            sticking: false,
            slip_sign: if sign > 0.0 { 1 } else { -1 },
            events: 0,
            steps,
            near_tangential_releases: 0,
        })
    }
}
