//! As many runs as there are lanes, and when each is looked after.

use quell_model::friction::SlidingLaw;
use quell_numerics::dispatch::InstructionSet;
use quell_numerics::lane::{Lane, MOST_LANES};

use super::super::Run;
use super::super::engine::Engine;
use super::super::pace::EVERY;
use super::super::slip_step::{Next, SlipDue};
use super::board::Board;
use super::{Outcome, Shapes};

/// Most benches of a loop: enough that the roots of one round fill the lanes of the search.
pub(super) const MOST_BENCHES: usize = 4;

/// A run in its lane.
pub(super) struct Seat<'a> {
    number: usize,
    pub(super) engine: Engine<'a>,
    pub(super) due: SlipDue,
    /// Turn of the loop in which `engine` last knew where the run is.
    pub(super) known: u64,
}

/// As many runs as there are lanes.
pub(super) struct Bench<'a, V: Lane, L: SlidingLaw> {
    set: InstructionSet,
    pub(super) board: Board<V>,
    seats: [Option<Seat<'a>>; MOST_LANES],
    laws: Vec<L>,
    constants: Option<L::Constants<V>>,
    /// Number of lanes with a run.
    pub(super) seated: usize,
    /// Number of lanes that ask for one: every lane at first, then each whose run is over.
    waiting: usize,
    turn: u64,
    /// Whether no run needs a look after the last step.
    pub(super) all_clear: bool,
}

impl<'a, V: Lane, L: SlidingLaw> Bench<'a, V, L> {
    #[inline(always)]
    pub(super) fn new(set: InstructionSet, shapes: Shapes) -> Self {
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
    pub(super) fn fill(
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
                            self.laws.resize(V::LANES, law.clone());
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
    pub(super) fn step(&mut self) {
        self.turn += 1;
        if let Some(constants) = &mut self.constants {
            self.all_clear = self.board.step::<L>(constants);
        }
    }

    /// Lets the engines of the lanes that are not clear go on to their next slip step.
    #[inline(always)]
    pub(super) fn look_after(&mut self, over: &mut impl FnMut(usize, Outcome)) {
        if self.turn.is_multiple_of(EVERY) {
            self.look_at_clocks(over);
        }
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

    /// Ends the runs of clear lanes that do not get on: their engines see no step.
    #[cold]
    fn look_at_clocks(&mut self, over: &mut impl FnMut(usize, Outcome)) {
        for (lane, place) in self.seats.iter_mut().enumerate().take(V::LANES) {
            let Some(seat) = place else { continue };
            if !self.board.is_clear(lane) {
                continue;
            }
            let looked = seat.engine.look(self.turn - seat.known, self.board.time(lane));
            if let Err(stalled) = looked {
                over(seat.number, Err(stalled));
                *place = None;
                self.seated -= 1;
                self.waiting += 1;
            }
        }
    }
}
