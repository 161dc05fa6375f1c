//! Runs of many systems side by side.
//!
//! Each lane holds one run with its own system, time, step, phases and events. The expansion of a step, its length, the first test of
//! every guard and the state at the end of the step are computed in all lanes at once; roots, decisions and observers are those of each
//! run's engine. A lane whose run is over takes the next run of the queue. A lane performs only correctly rounded operations on its own
//! numbers, by the same equations as a run alone (`step_recurrence`), so that a run has the same bits alone, in any lane and next to any
//! neighbours.
//!
//! The lanes of one group share the structure of their systems: the numbers of states and contacts, which rows are empty, the kinds of
//! law, and what varies in time. Systems with other numbers of states than 2, 4, 6 or 8, or more than 4 contacts, run one by one.
//!
//! | file | contents |
//! |---|---|
//! | `request` | what a run is computed from |
//! | `shape` | the structure that the lanes of a group share |
//! | `numbers` | the numbers of all lanes, and the step that they take |
//! | `forcings`, `holding` | of these numbers, what varies in time and the forces of sticking contacts |
//! | `drive` | the loop: which run is in which lane |

mod drive;
mod forcings;
mod holding;
mod numbers;
mod request;
mod shape;

use quell_numerics::dispatch::{InstructionSet, LaneWork, with_lanes};
use quell_numerics::lane::Lane;

use self::drive::LaneLoop;
pub use self::request::PlannedMotion;
use self::request::{Finish, Queue, QueuedRun};
use self::shape::LaneShape;
use super::MotionEngine;
use super::one_mass::{PlannedMass, run_masses};
use super::state::MotionEnd;
use super::stopped::MotionStopped;

/// Integrates many runs side by side in the lanes of the machine's widest instruction set.
///
/// Every run has the same bits and events as by [`Motion::run`](super::Motion::run), for any other runs in the lanes and on any instruction set. Runs of
/// systems with the same structure share lanes: equal numbers of states (2, 4, 6 or 8) and contacts (at most 4), equal kinds of law,
/// and the same numbers that vary in time. Other runs are integrated one by one. The results are in the order of the requests.
///
/// `tolerance` bounds the last two retained Taylor terms of a step ([`MOTION_TOLERANCE`](super::MOTION_TOLERANCE)). Each result is the
/// end of its run, or [`MotionStopped`] with time, state and reason.
///
/// # Panics
/// If a start has not as many numbers as the state of its system.
pub fn run_many(
    requests: Vec<PlannedMotion<'_>>,
    tolerance: f64,
) -> Vec<Result<MotionEnd, MotionStopped>> {
    run_many_with(InstructionSet::widest(), requests, tolerance)
}

/// [`run_many`] with a given instruction set, or the widest available one if the machine lacks it.
///
/// # Panics
/// If a start has not as many numbers as the state of its system.
pub fn run_many_with(
    set: InstructionSet,
    requests: Vec<PlannedMotion<'_>>,
    tolerance: f64,
) -> Vec<Result<MotionEnd, MotionStopped>> {
    let mut ends: Vec<Option<Result<MotionEnd, MotionStopped>>> = Vec::new();
    ends.resize_with(requests.len(), || None);
    let mut groups: Vec<(Option<LaneShape>, Queue<'_>)> = Vec::new();
    let mut masses: (Vec<usize>, Vec<PlannedMass<'_>>) = (Vec::new(), Vec::new());
    for (number, request) in requests.into_iter().enumerate() {
        assert_eq!(request.start.state.len(), request.motion.size(), "numbers of the state");
        let equations = match &request.motion.engine {
            MotionEngine::OneMass(mass, _) => {
                let PlannedMotion { start, until, observer, .. } = request;
                masses.0.push(number);
                masses.1.push(PlannedMass { mass, start, until, observer });
                continue;
            }
            MotionEngine::General(equations) => equations.as_ref(),
        };
        let shape = LaneShape::of(request.motion.system, equations);
        let run = QueuedRun { number, equations, request };
        match groups.iter_mut().find(|(other, _)| *other == shape) {
            Some((_, group)) => group.push(run),
            None => groups.push((shape, vec![run])),
        }
    }
    for (number, end) in masses.0.into_iter().zip(run_masses(set, masses.1, tolerance)) {
        ends[number] = Some(end);
    }
    for (shape, queue) in groups {
        let mut finish = |number: usize, end| ends[number] = Some(end);
        match shape {
            None => run_one_by_one(queue, tolerance, &mut finish),
            Some(shape) => {
                let finish = &mut finish;
                with_lanes(set, RunsOfOneShape { shape, queue, tolerance, finish });
            }
        }
    }
    // Every request is in one group, and every run of a group finishes.
    ends.into_iter().flatten().collect()
}

fn run_one_by_one(queue: Queue<'_>, tolerance: f64, finish: Finish<'_>) {
    for run in queue {
        finish(run.number, run.prepared(tolerance).run());
    }
}

/// Runs that share lanes.
struct RunsOfOneShape<'a, 'f> {
    shape: LaneShape,
    queue: Queue<'a>,
    tolerance: f64,
    finish: Finish<'f>,
}

impl LaneWork for RunsOfOneShape<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lane>(self) {
        let Self { shape, queue, tolerance, finish } = self;
        if const { V::LANES == 1 } || queue.len() <= drive::few(V::LANES) {
            // The lanes would cost more than they save.
            run_one_by_one(queue, tolerance, finish);
        } else {
            LaneLoop::<V>::new(&shape, queue, tolerance, finish).run();
        }
    }
}
