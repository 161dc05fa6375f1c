//! The state of the lanes of one bench, and the slip step that all of them take at once.

use quell_model::friction::SlidingLaw;
use quell_numerics::dispatch::InstructionSet;
use quell_numerics::lane::{Lane, MOST_LANES, horner};

use super::super::ORDER;
use super::super::clock::{Clock, after, until};
use super::super::engine::Engine;
use super::super::forcing::Shape;
use super::super::slip::{Load, SlipEquation, SlipSeries, SlipStart, StepLimits};
use super::super::slip_step::{Column, Next, Root, SlipDue, SlipTaken};
use super::bench::Seat;
use super::rows::{ForcingRows, Row};
use super::{Outcome, Shapes};

/// The state of all lanes, and the step they have just taken.
pub(super) struct Board<V> {
    // Constants of a run.
    damping: Row,
    belt_velocity: Row,
    tolerance: Row,
    longest: Row,
    tangential: ForcingRows,
    normal: ForcingRows,
    /// 1 where slip steps without event need nobody's look, −1 where each one does.
    unwatched: Row,
    // Of a stretch between two looks.
    sign: Row,
    stop: Row,
    /// Multiplicity of the zero of v_r at the start of the coming step.
    zeros: Row,
    first_slope: Row,
    // Of a step.
    displacement: Row,
    slip: Row,
    time: Row,
    low: Row,
    // Of the step just taken.
    time_before: Row,
    low_before: Row,
    pub(super) length: Row,
    pub(super) zeros_before: Row,
    /// Positive where it is proven that v_r has no root.
    no_root: Row,
    /// What is known of the first root of v_r, as in `Crossings`, and where it is.
    pub(super) found: Row,
    pub(super) duration: Row,
    clear: Row,
    /// Coefficient by coefficient, [`Lane::LANES`] side by side.
    displacement_series: [f64; (ORDER + 1) * MOST_LANES],
    pub(super) slip_series: [f64; (ORDER + 1) * MOST_LANES],
    series: SlipSeries<V>,
}

impl<V: Lane> Board<V> {
    #[inline(always)]
    pub(super) fn new((tangential, normal): Shapes) -> Self {
        Self {
            damping: Row::ZERO,
            belt_velocity: Row::ZERO,
            tolerance: Row::ZERO,
            longest: Row::ZERO,
            tangential: ForcingRows::new(tangential),
            normal: ForcingRows::new(normal),
            unwatched: Row::ZERO,
            sign: Row::ZERO,
            stop: Row::ZERO,
            zeros: Row::ZERO,
            first_slope: Row::ZERO,
            displacement: Row::ZERO,
            slip: Row::ZERO,
            time: Row::ZERO,
            low: Row::ZERO,
            time_before: Row::ZERO,
            low_before: Row::ZERO,
            length: Row::ZERO,
            zeros_before: Row::ZERO,
            no_root: Row::ZERO,
            found: Row::ZERO,
            duration: Row::ZERO,
            clear: Row::ZERO,
            displacement_series: [0.0; (ORDER + 1) * MOST_LANES],
            slip_series: [0.0; (ORDER + 1) * MOST_LANES],
            series: SlipSeries {
                displacement: [V::splat(0.0); ORDER + 1],
                slip: [V::splat(0.0); ORDER + 1],
            },
        }
    }

    /// Writes what stays the same along a run.
    pub(super) fn seat(&mut self, lane: usize, engine: &Engine<'_>) {
        self.damping.0[lane] = engine.damping;
        self.belt_velocity.0[lane] = engine.bond.belt_velocity;
        self.tolerance.0[lane] = engine.tolerance;
        self.longest.0[lane] = engine.longest_step;
        // A series of several dithers is written anew for each step.
        let several = [&self.tangential, &self.normal].iter().any(|it| it.shape == Shape::Several);
        self.unwatched.0[lane] = if engine.watched || several { -1.0 } else { 1.0 };
        self.tangential.seat(lane, &engine.tangential);
        self.normal.seat(lane, &engine.normal);
    }

    /// An empty lane slips on without load for ever, so that nobody needs to look at it.
    pub(super) fn leave(&mut self, lane: usize) {
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
        self.tangential.leave(lane);
        self.normal.leave(lane);
    }

    /// Writes what a step starts from.
    #[inline(always)]
    pub(super) fn announce(&mut self, lane: usize, engine: &Engine<'_>, due: SlipDue) {
        self.sign.0[lane] = due.sign;
        self.stop.0[lane] = due.stop;
        self.zeros.0[lane] = due.zeros as f64;
        self.first_slope.0[lane] = if due.zeros == 2 { 0.0 } else { 1.0 };
        self.displacement.0[lane] = engine.displacement;
        self.slip.0[lane] = engine.slip;
        self.time.0[lane] = engine.clock.time();
        self.low.0[lane] = engine.clock.low();
        self.tangential.announce(lane, engine, &engine.tangential);
        self.normal.announce(lane, engine, &engine.normal);
    }

    /// One slip step in every lane; whether all of them are clear.
    #[inline(always)]
    pub(super) fn step<L: SlidingLaw>(&mut self, law: &mut L::Constants<V>) -> bool {
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
        let load = if self.normal.shape == Shape::Constant {
            Load::Steady(self.normal.mean.load())
        } else {
            let normal = self.normal.series::<V>(time, low);
            load_series = [V::splat(0.0); ORDER + 1];
            for (k, coefficient) in load_series.iter_mut().enumerate() {
                *coefficient = normal.coefficient(k);
            }
            Load::Series(&load_series)
        };
        let series = &mut self.series;
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
        // Each of these is positive where the engine has nothing to do after the step; the proof
        // last, because it is not a number where any coefficient is none.
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
        let all_clear = self.clear.0[..V::LANES].iter().all(|&it| it > 0.0);
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

    /// Ends the steps with a root there.
    #[inline(always)]
    pub(super) fn go_back_to_roots(&mut self) {
        let at_root = horner(&self.series.displacement, self.duration.load());
        let found: V = self.found.load();
        self.displacement.store(found.where_positive(at_root, self.displacement.load()));
    }

    /// Whether the step of a lane needs nobody's look.
    #[inline(always)]
    pub(super) fn is_clear(&self, lane: usize) -> bool {
        self.clear.0[lane] > 0.0
    }

    /// The moment a lane has come to.
    pub(super) fn time(&self, lane: usize) -> f64 {
        self.time.0[lane]
    }

    /// Whether a step may have a root.
    #[inline(always)]
    pub(super) fn is_unproven(&self, lane: usize) -> bool {
        let proven = self.no_root.0[lane] > 0.0;
        !proven
    }

    /// Lets the engine of a lane take the step and go on to its next one; how it ends if it is over.
    #[inline(always)]
    pub(super) fn look_after(
        &mut self,
        set: InstructionSet,
        lane: usize,
        seat: &mut Seat<'_>,
        turn: u64,
    ) -> Option<Outcome> {
        let Seat { engine, due, known, .. } = seat;
        let unseen = turn - *known - 1;
        let clock = Clock::of(self.time_before.0[lane], self.low_before.0[lane]);
        let column = |rows| Column { rows, lanes: V::LANES, lane };
        let (displacement, slip) = (column(&self.displacement_series), column(&self.slip_series));
        engine.catch_up(
            unseen,
            clock,
            (displacement.coefficient(0), slip.coefficient(0)),
            due.sign,
        );
        let found = self.found.0[lane];
        let taken = SlipTaken {
            length: self.length.0[lane],
            root: match found {
                0.0 => Root::Unsure,
                it if it > 0.0 => Root::At(self.duration.0[lane]),
                _ => Root::None,
            },
            end: (self.displacement.0[lane], self.slip.0[lane]),
            displacement,
            slip,
        };
        let zeros = if unseen > 0 { 0 } else { due.zeros };
        match engine.take(set, SlipDue { zeros, ..*due }, &taken) {
            Next::Slip(next) => {
                self.announce(lane, engine, next);
                *due = next;
                *known = turn;
                None
            }
            Next::Over(outcome) => Some(outcome),
        }
    }
}
