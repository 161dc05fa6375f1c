//! The state of the lanes of one batch, and the slip step that all of them take at once.

use quell_model::friction::LawSeries;
use quell_numerics::dispatch::InstructionSet;
use quell_numerics::lane::{Lane, MOST_LANES, horner};

use super::super::clock::{Clock, after, until};
use super::super::engine::Engine;
use super::super::forcing::{ForcingShape, ForcingShapes};
use super::super::lane_row::LaneRow;
use super::super::slip::{SlipEquation, SlipSeries, SlipStart, StepLimits, StepLoad};
use super::super::slip_step::{LaneColumn, Next, SlipDue, SlipTaken, StepRoot};
use super::super::state::RunResult;
use super::super::taylor::ORDER;
use super::forcing_rows::ForcingRows;
use super::run_slot::RunSlot;

/// The state of all lanes, and the step they have just taken.
///
/// Clock, displacement and slip of a lane are the working copy of those in the engine's state: a lane
/// takes slip steps without events on them alone, and [`LaneState::service`] brings the engine up to date.
///
/// It is the same type in lanes of any width, and what only moves numbers is compiled once for all of them and for every law.
pub(super) struct LaneState {
    /// Number of lanes.
    lanes: usize,
    // Constants of a run.
    damping: LaneRow,
    belt_velocity: LaneRow,
    tolerance: LaneRow,
    longest: LaneRow,
    tangential: ForcingRows,
    normal: ForcingRows,
    /// 1 where slip steps without an event need no service, −1 where each step does.
    unwatched: LaneRow,
    /// Whether slip goes on through v_r = 0, so that no root of it ends a step.
    keeps_branch: [bool; MOST_LANES],
    // Constant between two services.
    sign: LaneRow,
    stop: LaneRow,
    /// Multiplicity of the zero of v_r at the start of the coming step.
    zeros: LaneRow,
    first_slope: LaneRow,
    // Start of the next step.
    displacement: LaneRow,
    slip: LaneRow,
    time: LaneRow,
    low: LaneRow,
    // The step just taken.
    time_before: LaneRow,
    low_before: LaneRow,
    pub(super) length: LaneRow,
    pub(super) zeros_before: LaneRow,
    /// Positive where v_r provably has no root.
    no_root: LaneRow,
    /// Whether the first root of v_r was found, coded as in `Crossings`, and its time.
    pub(super) found: LaneRow,
    pub(super) duration: LaneRow,
    /// Positive where the step needs no service.
    clear: LaneRow,
    /// Coefficient by coefficient, [`Lane::LANES`] side by side.
    displacement_series: [f64; (ORDER + 1) * MOST_LANES],
    pub(super) slip_series: [f64; (ORDER + 1) * MOST_LANES],
}

impl LaneState {
    pub(super) fn new(lanes: usize, (tangential, normal): ForcingShapes) -> Self {
        Self {
            lanes,
            damping: LaneRow::ZERO,
            belt_velocity: LaneRow::ZERO,
            tolerance: LaneRow::ZERO,
            longest: LaneRow::ZERO,
            tangential: ForcingRows::new(tangential),
            normal: ForcingRows::new(normal),
            unwatched: LaneRow::ZERO,
            keeps_branch: [false; MOST_LANES],
            sign: LaneRow::ZERO,
            stop: LaneRow::ZERO,
            zeros: LaneRow::ZERO,
            first_slope: LaneRow::ZERO,
            displacement: LaneRow::ZERO,
            slip: LaneRow::ZERO,
            time: LaneRow::ZERO,
            low: LaneRow::ZERO,
            time_before: LaneRow::ZERO,
            low_before: LaneRow::ZERO,
            length: LaneRow::ZERO,
            zeros_before: LaneRow::ZERO,
            no_root: LaneRow::ZERO,
            found: LaneRow::ZERO,
            duration: LaneRow::ZERO,
            clear: LaneRow::ZERO,
            displacement_series: [0.0; (ORDER + 1) * MOST_LANES],
            slip_series: [0.0; (ORDER + 1) * MOST_LANES],
        }
    }

    /// Writes the constants of a run.
    pub(super) fn admit(&mut self, lane: usize, engine: &Engine<'_>) {
        self.damping.0[lane] = engine.damping;
        self.belt_velocity.0[lane] = engine.stiction.belt_velocity;
        self.tolerance.0[lane] = engine.tolerance;
        self.longest.0[lane] = engine.longest_step;
        // The series of several dithers is rewritten for each step.
        let several = [&self.tangential, &self.normal]
            .iter()
            .any(|forcing| forcing.shape == ForcingShape::Several);
        self.unwatched.0[lane] = if engine.watched || several { -1.0 } else { 1.0 };
        self.keeps_branch[lane] = engine.keeps_branch;
        self.tangential.admit(lane, &engine.tangential);
        self.normal.admit(lane, &engine.normal);
    }

    /// Empties a lane: it slips indefinitely without load and never needs service.
    pub(super) fn evict(&mut self, lane: usize) {
        for (row, number) in [
            (&mut self.damping, 0.0),
            (&mut self.belt_velocity, 1.0),
            (&mut self.tolerance, 1.0),
            (&mut self.longest, 1.0),
            (&mut self.unwatched, 1.0),
            (&mut self.sign, 1.0),
            (&mut self.stop, f64::MAX),
            (&mut self.displacement, 0.0),
            (&mut self.slip, 1.0),
            (&mut self.time, 0.0),
            (&mut self.low, 0.0),
        ] {
            row.0[lane] = number;
        }
        self.tangential.evict(lane);
        self.normal.evict(lane);
    }

    /// Writes the start of the next step.
    #[inline(always)]
    pub(super) fn load(&mut self, lane: usize, engine: &Engine<'_>, due: SlipDue) {
        self.sign.0[lane] = due.sign;
        self.stop.0[lane] = due.stop;
        self.zeros.0[lane] = due.zeros as f64;
        self.first_slope.0[lane] = if due.zeros == 2 { 0.0 } else { 1.0 };
        self.displacement.0[lane] = engine.state.displacement;
        self.slip.0[lane] = engine.state.slip;
        self.time.0[lane] = engine.state.clock.time();
        self.low.0[lane] = engine.state.clock.low();
        self.tangential.load(lane, engine.state.clock, &engine.tangential);
        self.normal.load(lane, engine.state.clock, &engine.normal);
    }

    /// Takes one slip step in every lane. Returns whether no lane needs service.
    #[inline(always)]
    pub(super) fn step<V: Lane, L: LawSeries>(
        &mut self,
        law: &mut L::Constants<V>,
        series: &mut SlipSeries<V>,
    ) -> bool {
        let equation =
            SlipEquation { damping: self.damping.load(), belt_velocity: self.belt_velocity.load() };
        let start = SlipStart {
            sign: self.sign.load(),
            displacement: self.displacement.load(),
            slip: self.slip.load(),
            first_slope: self.first_slope.load(),
        };
        let (time, low): (V, V) = (self.time.load(), self.low.load());
        let dither = self.tangential.series::<V>(time, low);
        let mut load_series;
        let load = if self.normal.shape == ForcingShape::Constant {
            StepLoad::Steady(self.normal.mean.load())
        } else {
            let normal = self.normal.series::<V>(time, low);
            load_series = [V::splat(0.0); ORDER + 1];
            for (k, coefficient) in load_series.iter_mut().enumerate() {
                *coefficient = normal.coefficient(k);
            }
            StepLoad::Series(&load_series)
        };
        let stop: V = self.stop.load();
        let room = until(time, low, stop);
        let limits =
            StepLimits { tolerance: self.tolerance.load(), longest: self.longest.load(), room };
        let length = equation.series::<L>(law, start, &dither, load, limits, series);
        let (displacement, slip) = series.end(length);
        let (later, later_low) = after(time, low, length);
        let zeros: V = self.zeros.load();
        let no_root = series.margin(zeros, length);
        let leaves = series.leaves(start.sign, zeros);
        // Each of these is positive where the engine has nothing to do after the step. The proof
        // comes last, because it is NaN where any coefficient is not a number.
        let short_of_stop = (room - length).min((stop - later).abs());
        let advances = (later - time).abs() + (later_low - low).abs();
        let clear =
            self.unwatched.load::<V>().min(leaves).min(short_of_stop).min(advances).min(no_root);
        self.clear.store(clear);
        self.time_before.store(time);
        self.low_before.store(low);
        self.time.store(later);
        self.low.store(later_low);
        self.displacement.store(displacement);
        self.slip.store(slip);
        self.zeros.store(V::splat(0.0));
        self.first_slope.store(V::splat(1.0));
        let all_clear = self.clear.0[..V::LANES].iter().all(|&margin| margin > 0.0);
        if !all_clear {
            self.no_root.store(no_root);
            self.found.store(V::splat(-1.0));
            self.length.store(length);
            self.zeros_before.store(zeros);
            for k in 0..=ORDER {
                series.displacement[k].store(&mut self.displacement_series[k * V::LANES..]);
                series.slip[k].store(&mut self.slip_series[k * V::LANES..]);
            }
        }
        all_clear
    }

    /// Ends the steps with a root at the root.
    #[inline(always)]
    pub(super) fn cut_at_roots<V: Lane>(&mut self, series: &SlipSeries<V>) {
        let at_root = horner(&series.displacement, self.duration.load());
        let found: V = self.found.load();
        self.displacement.store(found.where_positive(at_root, self.displacement.load()));
    }

    /// Whether the step of a lane needs service by its engine.
    #[inline(always)]
    pub(super) fn needs_service(&self, lane: usize) -> bool {
        let clear = self.clear.0[lane] > 0.0;
        !clear
    }

    /// The current time of a lane.
    pub(super) fn time(&self, lane: usize) -> f64 {
        self.time.0[lane]
    }

    /// Whether a step may end at a root.
    #[inline(always)]
    pub(super) fn is_unproven(&self, lane: usize) -> bool {
        let proven = self.no_root.0[lane] > 0.0;
        !(proven || self.keeps_branch[lane])
    }

    /// Lets the engine of a lane accept the step and continue to its next one. Returns the result of a run that is over.
    #[inline(never)]
    pub(super) fn service(
        &mut self,
        set: InstructionSet,
        lane: usize,
        slot: &mut RunSlot<'_>,
        round: u64,
    ) -> Option<RunResult> {
        let RunSlot { engine, due, synced, .. } = slot;
        let pending = round - *synced - 1;
        let clock = Clock::of(self.time_before.0[lane], self.low_before.0[lane]);
        let column = |rows| LaneColumn { rows, lanes: self.lanes, lane };
        let (displacement, slip) = (column(&self.displacement_series), column(&self.slip_series));
        engine.state.catch_up(
            pending,
            clock,
            (displacement.coefficient(0), slip.coefficient(0)),
            due.sign,
        );
        let found = self.found.0[lane];
        let taken = SlipTaken {
            length: self.length.0[lane],
            root: match found {
                0.0 => StepRoot::Unknown,
                code if code > 0.0 => StepRoot::At(self.duration.0[lane]),
                _ => StepRoot::None,
            },
            end: (self.displacement.0[lane], self.slip.0[lane]),
            displacement,
            slip,
        };
        let zeros = if pending > 0 { 0 } else { due.zeros };
        match engine.accept(set, SlipDue { zeros, ..*due }, &taken) {
            Next::Slip(next) => {
                self.load(lane, engine, next);
                *due = next;
                *synced = round;
                None
            }
            Next::Over(result) => Some(result),
        }
    }
}
