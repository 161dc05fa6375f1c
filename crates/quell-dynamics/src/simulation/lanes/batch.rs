//! A batch: as many runs as there are lanes, and when each is serviced.

use quell_model::Friction;
use quell_numerics::dispatch::InstructionSet;
use quell_numerics::lane::MOST_LANES;

use super::super::engine::Engine;
use super::super::forcing::ForcingShapes;
use super::super::run::{RunTerms, SimulationRun};
use super::super::slip_step::Next;
use super::super::state::RunResult;
use super::super::step_budget::CHECK_INTERVAL;
use super::lane_state::LaneState;
use super::run_slot::RunSlot;

/// Most batches of a loop: enough that the roots of one round fill the lanes of the search.
pub(super) const MOST_BATCHES: usize = 4;

/// As many runs as there are lanes. What they share of their law is in [`LawLanes`](super::law_lanes::LawLanes).
pub(super) struct Batch<'a> {
    set: InstructionSet,
    pub(super) lanes: LaneState,
    /// One for each lane.
    slots: Vec<Option<RunSlot<'a>>>,
    /// Number of lanes with a run.
    pub(super) occupied: usize,
    /// Number of lanes that wait for a run: every lane at first, then each whose run is over.
    waiting: usize,
    pub(super) round: u64,
    /// Whether no run needs service after the last step.
    pub(super) all_clear: bool,
}

/// Takes the number and the result of a run that is over.
pub(super) type RunFinish<'f> = dyn FnMut(usize, RunResult) + 'f;

impl<'a> Batch<'a> {
    pub(super) fn new(set: InstructionSet, lanes: usize, shapes: ForcingShapes) -> Self {
        debug_assert!(lanes <= MOST_LANES);
        Self {
            set,
            lanes: LaneState::new(lanes, shapes),
            slots: (0..lanes).map(|_| None).collect(),
            occupied: 0,
            waiting: lanes,
            round: 0,
            all_clear: true,
        }
    }

    /// Fills the empty lanes with the next runs of the queue. Returns whether there were any empty lanes.
    #[inline(never)]
    pub(super) fn fill(
        &mut self,
        queue: &mut dyn Iterator<Item = (usize, SimulationRun<'a>)>,
        terms: RunTerms,
        finish: &mut RunFinish<'_>,
    ) -> bool {
        if self.waiting == 0 {
            return false;
        }
        for (lane, slot) in self.slots.iter_mut().enumerate() {
            while slot.is_none() {
                let Some((number, run)) = queue.next() else { break };
                let belt = run.belt;
                let mut engine = Engine::new(run, terms);
                match engine.next(self.set) {
                    Next::Over(result) => finish(number, result),
                    Next::Slip(due) => {
                        self.lanes.admit(lane, &engine);
                        self.lanes.load(lane, &engine, due);
                        *slot = Some(RunSlot { number, belt, engine, due, synced: self.round });
                        self.occupied += 1;
                    }
                }
            }
            if slot.is_none() {
                self.lanes.evict(lane);
            }
        }
        self.waiting = 0;
        true
    }

    /// The laws of the runs, with their lanes.
    pub(super) fn frictions(&self) -> impl Iterator<Item = (usize, &'a Friction)> {
        let slots = self.slots.iter().enumerate();
        slots.filter_map(|(lane, slot)| Some((lane, slot.as_ref()?.belt.friction())))
    }

    /// Lets the engines of the lanes that need service continue to their next slip step.
    #[inline]
    pub(super) fn service(&mut self, finish: &mut RunFinish<'_>) {
        if self.round.is_multiple_of(CHECK_INTERVAL) {
            self.check_budgets(finish);
        }
        if self.all_clear {
            return;
        }
        self.all_clear = true;
        for (lane, place) in self.slots.iter_mut().enumerate() {
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
    fn check_budgets(&mut self, finish: &mut RunFinish<'_>) {
        for (lane, place) in self.slots.iter_mut().enumerate() {
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
