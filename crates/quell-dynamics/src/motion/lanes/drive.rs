//! The loop of a group: which run is in which lane.

use quell_numerics::lane::{Lane, MOST_LANES};

use super::super::engine::{MotionRun, StepRoom};
use super::super::expansion::ExpandedStep;
use super::super::phase::ContactNow;
use super::super::series::horner_states;
use super::super::stopped::MotionStopped;
use super::numbers::LaneNumbers;
use super::request::{Finish, Queue, QueuedRun};
use super::shape::LaneShape;

/// Number of runs that are integrated one by one rather than in this number of lanes: a step in all lanes takes about as long as so
/// many steps alone.
pub(super) const fn few(lanes: usize) -> usize {
    lanes / 8
}

/// A run in its lane.
struct LaneSlot<'a> {
    /// Number of the run in the order of the requests.
    number: usize,
    run: MotionRun<'a>,
    /// Of the coming step.
    room: StepRoom,
    /// The phases that the lane has.
    now: Vec<ContactNow>,
    /// The forces of sticking contacts that the lane has.
    refreshed: u64,
}

impl LaneSlot<'_> {
    /// Writes to the lane what its next step needs.
    #[inline(always)]
    fn write<V: Lane>(&mut self, lane: usize, numbers: &mut LaneNumbers<V>) {
        let run = &self.run;
        if self.now != run.now {
            self.now.clone_from(&run.now);
            numbers.set_phases(lane, &run.now);
        }
        if self.refreshed != run.refreshed {
            self.refreshed = run.refreshed;
            numbers.set_holding(lane, run);
        }
        numbers.load(lane, run, self.room);
    }

    /// Accepts the step that the lane has taken, and prepares the next one. Whether the run goes on.
    #[inline(always)]
    fn accept<V: Lane>(
        &mut self,
        lane: usize,
        numbers: &mut LaneNumbers<V>,
    ) -> Result<bool, MotionStopped> {
        let run = &mut self.run;
        let length = numbers.length(lane);
        let is_clear = numbers.is_clear(lane);
        if run.watched || !is_clear {
            numbers.extract(lane, &mut run.series);
        }
        let reached = if is_clear { None } else { run.guards().first(length) };
        let duration = if let Some(reached) = &reached {
            horner_states(&run.series.states, reached.after, &mut run.scratch);
            reached.after
        } else {
            numbers.end(lane, &mut run.scratch);
            length
        };
        run.accept(ExpandedStep { duration, reached }, self.room)?;
        if run.is_over() {
            return Ok(false);
        }
        self.room = run.prepare()?;
        self.write(lane, numbers);
        Ok(true)
    }
}

/// The runs of one shape, and their lanes.
pub(super) struct LaneLoop<'a, 'f, V: Lane> {
    shape: &'f LaneShape,
    queue: std::vec::IntoIter<QueuedRun<'a>>,
    tolerance: f64,
    finish: Finish<'f>,
    /// Present from the first run on.
    numbers: Option<LaneNumbers<V>>,
    slots: [Option<LaneSlot<'a>>; MOST_LANES],
    /// Number of lanes with a run.
    occupied: usize,
}

impl<'a, 'f, V: Lane> LaneLoop<'a, 'f, V> {
    pub(super) fn new(
        shape: &'f LaneShape,
        queue: Queue<'a>,
        tolerance: f64,
        finish: Finish<'f>,
    ) -> Self {
        Self {
            shape,
            queue: queue.into_iter(),
            tolerance,
            finish,
            numbers: None,
            slots: std::array::from_fn(|_| None),
            occupied: 0,
        }
    }

    /// Runs all to their ends.
    #[inline(always)]
    pub(super) fn run(mut self) {
        self.fill();
        // With fewer runs the queue is empty.
        while self.occupied > few(V::LANES) {
            self.step();
            if self.occupied < V::LANES {
                self.fill();
            }
        }
        let numbers = self.numbers;
        for (lane, place) in self.slots.into_iter().enumerate() {
            if let (Some(mut slot), Some(numbers)) = (place, &numbers) {
                numbers.release(lane, &mut slot.run);
                (self.finish)(slot.number, slot.run.run_on());
            }
        }
    }

    /// Fills the empty lanes with the next runs of the queue.
    fn fill(&mut self) {
        let mut is_new = false;
        for lane in 0..V::LANES {
            while self.slots[lane].is_none() {
                let Some(next) = self.queue.next() else { break };
                let number = next.number;
                let mut run = next.prepared(self.tolerance);
                if let Err(why) = run.open() {
                    (self.finish)(number, Err(why));
                    continue;
                }
                if run.is_over() {
                    (self.finish)(number, run.end());
                    continue;
                }
                let room = match run.prepare() {
                    Ok(room) => room,
                    Err(why) => {
                        (self.finish)(number, Err(why));
                        continue;
                    }
                };
                let shape = self.shape;
                let numbers = self.numbers.get_or_insert_with(|| LaneNumbers::like(shape, &run));
                numbers.admit(lane, &run);
                let mut slot = LaneSlot { number, run, room, now: Vec::new(), refreshed: 0 };
                slot.write(lane, numbers);
                self.slots[lane] = Some(slot);
                self.occupied += 1;
                is_new = true;
            }
        }
        if let (true, Some(numbers)) = (is_new, &mut self.numbers) {
            numbers.begin();
        }
    }

    /// Takes a step in every lane, and lets each run accept its own.
    #[inline(always)]
    fn step(&mut self) {
        let Some(numbers) = &mut self.numbers else { return };
        numbers.step();
        for (lane, place) in self.slots.iter_mut().enumerate().take(V::LANES) {
            let Some(slot) = place else { continue };
            let goes_on = slot.accept(lane, numbers);
            if let Ok(true) = goes_on {
                continue;
            }
            numbers.evict(lane);
            self.occupied -= 1;
            if let Some(LaneSlot { number, run, .. }) = place.take() {
                (self.finish)(number, goes_on.and_then(|_| run.end()));
            }
        }
    }
}
