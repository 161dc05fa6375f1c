//! A batch: as many runs as there are lanes, and when each is serviced.

use quell_model::friction::SlidingLaw;
use quell_numerics::dispatch::InstructionSet;
use quell_numerics::lane::{Lane, MOST_LANES};

use super::super::engine::Engine;
use super::super::forcing::ForcingShapes;
use super::super::run::SimulationRun;
use super::super::slip_step::Next;
use super::super::state::RunResult;
use super::super::step_budget::CHECK_INTERVAL;
use super::lane_state::LaneState;
use super::run_slot::RunSlot;

/// Most batches of a loop: enough that the roots of one round fill the lanes of the search.
pub(super) const MOST_BATCHES: usize = 4;

/// As many runs as there are lanes.
pub(super) struct Batch<'a, V: Lane, L: SlidingLaw> {
    set: InstructionSet,
    pub(super) lanes: LaneState<V>,
    slots: [Option<RunSlot<'a>>; MOST_LANES],
    laws: Vec<L>,
    constants: Option<L::Constants<V>>,
    /// Number of lanes with a run.
    pub(super) occupied: usize,
    /// Number of lanes that wait for a run: every lane at first, then each whose run is over.
    waiting: usize,
    round: u64,
    /// Whether no run needs service after the last step.
    pub(super) all_clear: bool,
}

impl<'a, V: Lane, L: SlidingLaw> Batch<'a, V, L> {
    #[inline(always)]
    pub(super) fn new(set: InstructionSet, shapes: ForcingShapes) -> Self {
        Self {
            set,
            lanes: LaneState::new(shapes),
            slots: std::array::from_fn(|_| None),
            laws: Vec::with_capacity(V::LANES),
            constants: None,
            occupied: 0,
            waiting: V::LANES,
            round: 0,
            all_clear: true,
        }
    }

    /// Fills the empty lanes with the next runs of the queue.
    #[inline(never)]
    pub(super) fn fill(
        &mut self,
        queue: &mut impl Iterator<Item = (usize, SimulationRun<'a>, L)>,
        tolerance: f64,
        finish: &mut impl FnMut(usize, RunResult),
    ) {
        if self.waiting == 0 {
            return;
        }
        for (lane, slot) in self.slots.iter_mut().enumerate().take(V::LANES) {
            while slot.is_none() {
                let Some((number, run, law)) = queue.next() else { break };
                let mut engine = Engine::new(run, &law, tolerance);
                match engine.next(self.set) {
                    Next::Over(result) => finish(number, result),
                    Next::Slip(due) => {
                        if self.laws.is_empty() {
                            self.laws.resize(V::LANES, law.clone());
                        }
                        self.laws[lane] = law;
                        self.lanes.admit(lane, &engine);
                        self.lanes.load(lane, &engine, due);
                        *slot = Some(RunSlot { number, engine, due, synced: self.round });
                        self.occupied += 1;
                    }
                }
            }
            if slot.is_none() {
                self.lanes.evict(lane);
            }
        }
        self.waiting = 0;
        if !self.laws.is_empty() {
            self.constants = Some(L::constants::<V>(&self.laws));
        }
    }

    /// Takes one slip step in all lanes.
    #[inline(always)]
    pub(super) fn step(&mut self) {
        self.round += 1;
        if let Some(constants) = &mut self.constants {
            self.all_clear = self.lanes.step::<L>(constants);
        }
    }

    /// Lets the engines of the lanes that need service continue to their next slip step.
    #[inline]
    pub(super) fn service(&mut self, finish: &mut impl FnMut(usize, RunResult)) {
        if self.round.is_multiple_of(CHECK_INTERVAL) {
            self.check_budgets(finish);
        }
        if self.all_clear {
            return;
        }
        self.all_clear = true;
        for (lane, place) in self.slots.iter_mut().enumerate().take(V::LANES) {
            if !self.lanes.needs_service(lane) {
                continue;
            }
            let Some(slot) = place else { continue };
            if let Some(result) = self.lanes.service(self.set, lane, slot, self.round) {
                finish(slot.number, result);
                *place = None;
                self.occupied -= 1;
                self.waiting += 1;
            }
        }
    }

    /// Stops the runs that exceed their step budget in lanes that need no service: their engines receive no step.
    #[cold]
    fn check_budgets(&mut self, finish: &mut impl FnMut(usize, RunResult)) {
        for (lane, place) in self.slots.iter_mut().enumerate().take(V::LANES) {
            let Some(slot) = place else { continue };
            if self.lanes.needs_service(lane) {
                continue;
            }
            let checked = slot.engine.check_budget(self.round - slot.synced, self.lanes.time(lane));
            if let Err(stalled) = checked {
                finish(slot.number, Err(stalled));
                *place = None;
                self.occupied -= 1;
                self.waiting += 1;
            }
        }
    }
}
