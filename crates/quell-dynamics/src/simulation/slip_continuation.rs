//! Continuation on the sliding branch: slip through v_r = 0 on one branch of the law, continued analytically to slip of the
//! other sign.
//!
//! This is not a motion of the belt but the smooth continuation of one. In this sense an orbit in pure slip that depends on a
//! parameter exists on both sides of the grazing of v_r = 0, so that the grazing is a simple root of its least slip
//! velocity. In slip of the branch's own sign it is the actual motion, computed with the engine's series.

use quell_model::Belt;
use quell_model::friction::{LawSeries, LawVisitor};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};

use super::clock::Clock;
use super::engine::{longest_step, step_tolerance};
use super::forcing::Forcing;
use super::lane_row::LaneRow;
use super::observer::{Observer, Segment};
use super::slip::{DitherSeries, SlipEquation, SlipSeries, SlipStart, StepLimits, StepLoad};
use super::state::{FinalState, RunResult, Stalled, Start};
use super::step_budget::StepBudget;
use super::taylor::ORDER;

/// Integrates slip on the branch of `sign` from `start` to τ = `until`, regardless of the sign of v_r.
///
/// # Errors
/// [`Stalled`] if a state leaves the finite numbers or no step advances time.
pub(crate) fn continue_slip(
    belt: &Belt,
    sign: f64,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &mut dyn Observer,
) -> Result<FinalState, Stalled> {
    if let Some(why) = belt.unsimulated() {
        return Err(Stalled::before(&start, why));
    }
    with_fused_multiply_add(SlipContinuation { belt, sign, start, until, tolerance, observer })
}

struct SlipContinuation<'a> {
    belt: &'a Belt,
    sign: f64,
    start: Start,
    until: f64,
    tolerance: f64,
    observer: &'a mut dyn Observer,
}

impl Work for SlipContinuation<'_> {
    type Output = RunResult;

    #[inline(always)]
    fn run(self) -> RunResult {
        let Self { belt, sign, start, until, tolerance, observer } = self;
        let law = belt.friction();
        let unit = law.velocity_scale();
        let mut clock = Clock::at(start.time);
        let (mut tangential, mut normal) = Forcing::of_belt(belt, unit, clock);
        let longest = longest_step(&tangential, &normal);
        let belt_velocity = belt.belt_velocity() / unit;
        let equation = SlipEquation { damping: 2.0 * belt.damping_ratio(), belt_velocity };
        let mut displacement = start.displacement / unit;
        let mut slip = (belt.belt_velocity() - start.velocity) / unit;
        let mut series = SlipSeries { displacement: [0.0; ORDER + 1], slip: [0.0; ORDER + 1] };
        let mut table = [LaneRow::ZERO; ORDER + 1];
        let fastest = tangential.highest_rate().max(normal.highest_rate());
        StepBudget::begin().map_err(|why| Stalled::before(&start, why))?;
        let mut budget = StepBudget::new(start.time, until, fastest);
        let tolerance = step_tolerance(tolerance, (&tangential, &normal), displacement, slip);
        let mut steps = 0;
        while clock.until(until) > 0.0 {
            let stop = tangential.next_break().min(normal.next_break()).min(until);
            for (row, entry) in table.iter_mut().zip(tangential.series(clock)) {
                row.0[0] = entry;
            }
            let dither = DitherSeries { table: &table, phasor: [1.0; 4], line: [0.0; 2] };
            let load_series;
            let load = if normal.is_constant() {
                StepLoad::Steady(normal.mean())
            } else {
                load_series = normal.series(clock);
                StepLoad::Series(&load_series)
            };
            let from = SlipStart { sign, displacement, slip, first_slope: 1.0 };
            let limits = StepLimits { tolerance, longest, room: clock.until(stop) };
            let series = &mut series;
            let dither = &dither;
            let length = law.visit(SlipStep { equation, from, dither, load, limits, series });
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
            let stalled = |why| {
                let velocity = belt.belt_velocity() - unit * slip;
                let displacement = unit * displacement;
                Stalled { time: clock.time(), displacement, velocity, why }
            };
            if !(displacement.is_finite() && slip.is_finite()) {
                return Err(stalled("the state left the finite numbers"));
            }
            if clock == before {
                return Err(stalled("no step advanced time"));
            }
            if budget.is_due(steps) {
                budget.check(steps, clock.time()).map_err(stalled)?;
            }
        }
        // The steps are counted, but a run that has ended is not stopped for them.
        let _ = budget.spend(steps);
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

/// A step of slip, by a function of each law.
struct SlipStep<'a> {
    equation: SlipEquation<f64>,
    from: SlipStart<f64>,
    dither: &'a DitherSeries<'a, f64>,
    load: StepLoad<'a, f64>,
    limits: StepLimits<f64>,
    series: &'a mut SlipSeries<f64>,
}

impl LawVisitor for SlipStep<'_> {
    /// The length of the step.
    type Output = f64;

    fn visit<L: LawSeries>(self, law: &L) -> f64 {
        with_fused_multiply_add(SlipStepOf { step: self, law })
    }
}

struct SlipStepOf<'a, 'l, L> {
    step: SlipStep<'a>,
    law: &'l L,
}

impl<L: LawSeries> Work for SlipStepOf<'_, '_, L> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let SlipStep { equation, from, dither, load, limits, series } = self.step;
        let mut constants = L::constants::<f64>(std::slice::from_ref(self.law));
        equation.series::<L>(&mut constants, from, dither, load, limits, series)
    }
}
