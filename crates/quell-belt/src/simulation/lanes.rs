//! Slip steps of many runs side by side.
//!
//! Each lane holds one run with its own time, step, phase, events and law constants; what
//! happens at v_r = 0 and in stick is the run's own affair ([`super::engine`]). A lane whose
//! run is over takes the next run of the queue. A lane computes nothing but correctly rounded
//! operations on its own numbers, so that a run has the same bits alone, in any lane and
//! beside any neighbours; one run alone is the case of one lane.
//!
//! Lanes of one loop share the law and the shape of the forcing; runs are grouped by these.

use quell_model::Direction;
use quell_model::friction::{LawVisitor, SlidingLaw};
use quell_numerics::dispatch::{InstructionSet, LaneWork, with_lanes};
use quell_numerics::elementary::sin_cos_of_phase;
use quell_numerics::lane::{Lane, MOST_LANES, horner};
use quell_numerics::polynomial::side_by_side::first_crossings;

use super::clock::{Clock, after, until};
use super::engine::{Column, Engine, Next, Root, SlipDue, SlipTaken};
use super::forcing::{Forcing, Line, Shape};
use super::slip::{DitherSeries, Load, SlipEquation, SlipSeries, SlipStart, StepLimits};
use super::{FinalState, ORDER, Run, Stalled};

/// How a run ends.
type Outcome = Result<FinalState, Stalled>;

/// Runs in the lanes of `set`, outcomes in the order of the runs.
pub(super) fn side_by_side(
    set: InstructionSet,
    runs: Vec<Run<'_>>,
    tolerance: f64,
) -> Vec<Outcome> {
    let mut outcomes = vec![Err(Stalled::NEVER_STARTED); runs.len()];
    let mut rest: Vec<(usize, Run<'_>)> = runs.into_iter().enumerate().collect();
    while let Some((_, first)) = rest.first() {
        let (law, shapes) = (*first.belt.friction(), shapes_of(first));
        let alike =
            |run: &Run<'_>| run.belt.friction().kind() == law.kind() && shapes_of(run) == shapes;
        let (group, others) = rest.into_iter().partition(|(_, run)| alike(run));
        rest = others;
        law.visit(Group { set, runs: group, shapes, tolerance, outcomes: &mut outcomes });
    }
    outcomes
}

/// Shapes of the tangential and of the normal forcing.
type Shapes = (Shape, Shape);

fn shapes_of(run: &Run<'_>) -> Shapes {
    let shape = |direction| Shape::of(run.belt.dithers(), direction);
    (shape(Direction::Tangential), shape(Direction::Normal))
}

/// Runs that share a law and shapes.
struct Group<'q, 'a> {
    set: InstructionSet,
    runs: Vec<(usize, Run<'a>)>,
    shapes: Shapes,
    tolerance: f64,
    outcomes: &'q mut [Outcome],
}

impl LawVisitor for Group<'_, '_> {
    type Output = ();

    fn visit<L: SlidingLaw>(self, _: &L) {
        with_lanes(self.set, GroupOf::<L> { group: self, law: std::marker::PhantomData });
    }
}

/// [`Group`] with its law.
struct GroupOf<'q, 'a, L> {
    group: Group<'q, 'a>,
    law: std::marker::PhantomData<L>,
}

impl<L: SlidingLaw> LaneWork for GroupOf<'_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lane>(self) {
        let Group { set, runs, shapes, tolerance, outcomes } = self.group;
        // Every run is of this law: the group was made so.
        let runs = runs
            .into_iter()
            .filter_map(|(number, run)| Some((number, L::of(run.belt.friction())?, run)))
            .map(|(number, law, run)| (number, run, law))
            .collect::<Vec<_>>();
        let runs = runs.into_iter();
        drive::<V, L>(runs, set, shapes, tolerance, |number, outcome| outcomes[number] = outcome);
    }
}

/// A run in its lane.
struct Seat<'a> {
    number: usize,
    engine: Engine<'a>,
    due: SlipDue,
    /// Turn of the loop in which `engine` last knew where the run is.
    known: u64,
}

/// Most benches of a loop: enough that the roots of one round fill the lanes of the search.
const MOST_BENCHES: usize = 4;

/// The loop: takes one slip step in all lanes of all benches, searches the roots of v_r where one
/// may be, then looks after the runs that need it. A lane in which nothing but slip happens is not
/// looked at: its state lives on the board.
#[inline(always)]
fn drive<'a, V: Lane, L: SlidingLaw>(
    mut queue: impl ExactSizeIterator<Item = (usize, Run<'a>, L)>,
    set: InstructionSet,
    shapes: Shapes,
    tolerance: f64,
    mut over: impl FnMut(usize, Outcome),
) {
    let count = queue.len().div_ceil(V::LANES).clamp(1, MOST_BENCHES);
    let mut benches: Vec<Bench<'a, V, L>> = (0..count).map(|_| Bench::new(set, shapes)).collect();
    let mut search = RootSearch::<V>::new();
    loop {
        let mut seated = 0;
        for bench in &mut benches {
            bench.fill(&mut queue, tolerance, &mut over);
            seated += bench.seated;
            if bench.seated > 0 {
                bench.step();
            }
        }
        if seated == 0 {
            return;
        }
        search.run(&mut benches);
        for bench in &mut benches {
            bench.look_after(&mut over);
        }
    }
}

/// As many runs as there are lanes.
struct Bench<'a, V: Lane, L: SlidingLaw> {
    set: InstructionSet,
    board: Board<V>,
    seats: [Option<Seat<'a>>; MOST_LANES],
    laws: Vec<L>,
    constants: Option<L::Constants<V>>,
    /// Number of lanes with a run.
    seated: usize,
    /// Number of lanes that ask for one: every lane at first, then each whose run is over.
    waiting: usize,
    turn: u64,
    /// Whether no run needs a look after the last step.
    all_clear: bool,
}

impl<'a, V: Lane, L: SlidingLaw> Bench<'a, V, L> {
    #[inline(always)]
    fn new(set: InstructionSet, shapes: Shapes) -> Self {
        Self {
            set,
            board: Board::new(shapes),
            seats: std::array::from_fn(|_| None),
            laws: Vec::with_capacity(V::LANES),
            constants: None,
            seated: 0,
            waiting: V::LANES,
            turn: 0,
            all_clear: true,
        }
    }

    /// Gives the empty lanes the next runs of the queue.
    #[inline(always)]
    fn fill(
        &mut self,
        queue: &mut impl Iterator<Item = (usize, Run<'a>, L)>,
        tolerance: f64,
        over: &mut impl FnMut(usize, Outcome),
    ) {
        if self.waiting == 0 {
            return;
        }
        for (lane, seat) in self.seats.iter_mut().enumerate().take(V::LANES) {
            while seat.is_none() {
                let Some((number, run, law)) = queue.next() else { break };
                let mut engine = Engine::new(run, &law, tolerance);
                match engine.next(self.set) {
                    Next::Over(outcome) => over(number, outcome),
                    Next::Slip(due) => {
                        if self.laws.is_empty() {
                            self.laws.resize(V::LANES, law);
                        }
                        self.laws[lane] = law;
                        self.board.seat(lane, &engine);
                        self.board.announce(lane, &engine, due);
                        *seat = Some(Seat { number, engine, due, known: self.turn });
                        self.seated += 1;
                    }
                }
            }
            if seat.is_none() {
                self.board.leave(lane);
            }
        }
        self.waiting = 0;
        if !self.laws.is_empty() {
            self.constants = Some(L::constants::<V>(&self.laws));
        }
    }

    #[inline(always)]
    fn step(&mut self) {
        self.turn += 1;
        if let Some(constants) = &self.constants {
            self.all_clear = self.board.step::<L>(constants);
        }
    }

    /// Lets the engines of the lanes that are not clear go on to their next slip step.
    #[inline(always)]
    fn look_after(&mut self, over: &mut impl FnMut(usize, Outcome)) {
        if self.all_clear {
            return;
        }
        self.all_clear = true;
        for (lane, place) in self.seats.iter_mut().enumerate().take(V::LANES) {
            if self.board.is_clear(lane) {
                continue;
            }
            let Some(seat) = place else { continue };
            if let Some(outcome) = self.board.look_after(self.set, lane, seat, self.turn) {
                over(seat.number, outcome);
                *place = None;
                self.seated -= 1;
                self.waiting += 1;
            }
        }
    }
}

/// The search for roots of v_r on the steps that may have one, from all benches side by side.
struct RootSearch<V> {
    /// Bench and lane of each candidate.
    candidates: Vec<(usize, usize)>,
    displacement: [f64; (ORDER + 1) * MOST_LANES],
    slip: [f64; (ORDER + 1) * MOST_LANES],
    zeros: Row,
    length: Row,
    wanted: Row,
    lanes: std::marker::PhantomData<V>,
}

impl<V: Lane> RootSearch<V> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            candidates: Vec::with_capacity(MOST_BENCHES * MOST_LANES),
            displacement: [0.0; (ORDER + 1) * MOST_LANES],
            slip: [0.0; (ORDER + 1) * MOST_LANES],
            zeros: Row::ZERO,
            length: Row::ZERO,
            wanted: Row::ZERO,
            lanes: std::marker::PhantomData,
        }
    }

    #[inline(always)]
    fn run<L: SlidingLaw>(&mut self, benches: &mut [Bench<'_, V, L>]) {
        self.candidates.clear();
        for (number, bench) in benches.iter().enumerate() {
            if bench.all_clear {
                continue;
            }
            let lanes = (0..V::LANES).filter(|&lane| bench.board.is_unproven(lane));
            self.candidates.extend(lanes.map(|lane| (number, lane)));
        }
        for first in (0..self.candidates.len()).step_by(V::LANES) {
            let last = self.candidates.len().min(first + V::LANES);
            self.wanted = Row::ZERO;
            for (slot, &(bench, lane)) in self.candidates[first..last].iter().enumerate() {
                let board = &benches[bench].board;
                for k in 0..=ORDER {
                    self.slip[k * V::LANES + slot] = board.slip_series[k * V::LANES + lane];
                    self.displacement[k * V::LANES + slot] =
                        board.displacement_series[k * V::LANES + lane];
                }
                self.zeros.0[slot] = board.zeros_before.0[lane];
                self.length.0[slot] = board.length.0[lane];
                self.wanted.0[slot] = 1.0;
            }
            let (found, duration, displacement) = self.roots();
            for (slot, &(bench, lane)) in self.candidates[first..last].iter().enumerate() {
                let board = &mut benches[bench].board;
                board.found.0[lane] = found.0[slot];
                board.duration.0[lane] = duration.0[slot];
                board.displacement.0[lane] = displacement.0[slot];
            }
        }
    }

    /// What [`first_crossings`] says, the step up to the root, and y there.
    #[inline(always)]
    fn roots(&self) -> (Row, Row, Row) {
        let mut slip = [V::splat(0.0); ORDER + 1];
        let mut displacement = slip;
        for k in 0..=ORDER {
            slip[k] = V::load(&self.slip[k * V::LANES..]);
            displacement[k] = V::load(&self.displacement[k * V::LANES..]);
        }
        let length: V = self.length.load();
        let crossings = first_crossings(&slip, self.zeros.load(), length, self.wanted.load());
        let duration = crossings.found.where_positive(crossings.time, length);
        let mut rows = (Row::ZERO, Row::ZERO, Row::ZERO);
        rows.0.store(crossings.found);
        rows.1.store(duration);
        rows.2.store(horner(&displacement, duration));
        rows
    }
}

/// Numbers of all lanes side by side.
#[derive(Debug)]
#[repr(align(64))]
pub(super) struct Row([f64; MOST_LANES]);

impl Row {
    const ZERO: Self = Self([0.0; MOST_LANES]);

    #[inline(always)]
    pub(super) fn load<V: Lane>(&self) -> V {
        V::load(&self.0)
    }

    #[inline(always)]
    fn store<V: Lane>(&mut self, value: V) {
        value.store(&mut self.0);
    }
}

/// The state of all lanes, and the step they have just taken.
struct Board<V> {
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
    length: Row,
    zeros_before: Row,
    /// Positive where it is proven that v_r has no root.
    no_root: Row,
    /// What is known of the first root of v_r, as in `Crossings`, and the step up to it.
    found: Row,
    duration: Row,
    clear: Row,
    /// Coefficient by coefficient, [`Lane::LANES`] side by side.
    displacement_series: [f64; (ORDER + 1) * MOST_LANES],
    slip_series: [f64; (ORDER + 1) * MOST_LANES],
    series: SlipSeries<V>,
}

impl<V: Lane> Board<V> {
    #[inline(always)]
    fn new((tangential, normal): Shapes) -> Self {
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
    fn seat(&mut self, lane: usize, engine: &Engine<'_>) {
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
    fn leave(&mut self, lane: usize) {
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
    fn announce(&mut self, lane: usize, engine: &Engine<'_>, due: SlipDue) {
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
    fn step<L: SlidingLaw>(&mut self, law: &L::Constants<V>) -> bool {
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
        equation.series::<L>(law, start, &dither, load, series);
        let stop: V = self.stop.load();
        let room = until(time, low, stop);
        let limits =
            StepLimits { tolerance: self.tolerance.load(), longest: self.longest.load(), room };
        let length = series.step(limits, L::longest_change(ORDER));
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

    /// Whether the step of a lane needs nobody's look.
    #[inline(always)]
    fn is_clear(&self, lane: usize) -> bool {
        self.clear.0[lane] > 0.0
    }

    /// Whether a step may have a root.
    #[inline(always)]
    fn is_unproven(&self, lane: usize) -> bool {
        let proven = self.no_root.0[lane] > 0.0;
        !proven
    }

    /// Lets the engine of a lane take the step and go on to its next one; how it ends if it is over.
    #[inline(always)]
    fn look_after(
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

/// The forcing of one direction in all lanes.
struct ForcingRows {
    shape: Shape,
    mean: Row,
    rate: Row,
    phase: Row,
    /// D Rᵏ/k! of a harmonic forcing; the coefficients themselves where there are several.
    table: [Row; ORDER + 1],
    line: Line<Row>,
}

impl ForcingRows {
    fn new(shape: Shape) -> Self {
        Self {
            shape,
            mean: Row::ZERO,
            rate: Row::ZERO,
            phase: Row::ZERO,
            table: [Row::ZERO; ORDER + 1],
            line: Line { began: Row::ZERO, value: Row::ZERO, slope: Row::ZERO },
        }
    }

    fn seat(&mut self, lane: usize, forcing: &Forcing) {
        self.mean.0[lane] = forcing.mean();
        let (rate, phase, table) = forcing.wave();
        self.rate.0[lane] = rate;
        self.phase.0[lane] = phase;
        for (row, entry) in self.table.iter_mut().zip(table) {
            row.0[lane] = if self.shape == Shape::Harmonic { entry } else { 0.0 };
        }
    }

    fn leave(&mut self, lane: usize) {
        for row in
            [&mut self.mean, &mut self.rate, &mut self.phase].into_iter().chain(&mut self.table)
        {
            row.0[lane] = 0.0;
        }
        self.set_line(lane, Line::default());
    }

    #[inline(always)]
    fn set_line(&mut self, lane: usize, line: Line) {
        self.line.began.0[lane] = line.began;
        self.line.value.0[lane] = line.value;
        self.line.slope.0[lane] = line.slope;
    }

    #[inline(always)]
    fn announce(&mut self, lane: usize, engine: &Engine<'_>, forcing: &Forcing) {
        match self.shape {
            Shape::Constant | Shape::Harmonic => {}
            Shape::Straight => self.set_line(lane, forcing.line()),
            Shape::Several => {
                for (row, entry) in self.table.iter_mut().zip(forcing.series(engine.clock)) {
                    row.0[lane] = entry;
                }
            }
        }
    }

    /// Taylor coefficients in every lane.
    #[inline(always)]
    fn series<V: Lane>(&self, time: V, low: V) -> DitherSeries<'_, V> {
        let mean: V = self.mean.load();
        let mut turn = [V::splat(1.0); 4];
        let mut line = [mean, V::splat(0.0)];
        match self.shape {
            Shape::Constant => {}
            // The table holds the whole series.
            Shape::Several => line[0] = V::splat(0.0),
            Shape::Straight => {
                let Line { began, value, slope } = &self.line;
                let piece =
                    Line { began: began.load(), value: value.load(), slope: slope.load::<V>() };
                line = [piece.at(time, low) + mean, piece.slope];
            }
            Shape::Harmonic => {
                let (sine, cosine) =
                    sin_cos_of_phase(self.rate.load::<V>(), time, low, self.phase.load());
                turn = [sine, cosine, -sine, -cosine];
            }
        }
        DitherSeries { table: &self.table, turn, line }
    }
}
