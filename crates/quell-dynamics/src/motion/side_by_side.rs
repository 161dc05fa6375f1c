//! Many runs at once: those of small systems with plain contacts two by two in vectors (`plain_contacts`), belts in the lanes of their own
//! engine, others one by one.
//!
//! A run has the same bits alone and next to any other.

use quell_model::friction::Friction;
use quell_numerics::dispatch::InstructionSet;

use super::drive::{one_by_one, places_of, to_their_ends};
use super::engine::{MotionProgress, MotionRun};
use super::one_mass::{PlannedMass, run_masses};
use super::state::MotionEnd;
use super::stopped::MotionStopped;
use super::{Motion, MotionEngine, MotionObserver, MotionStart};

/// A run of a system, to be computed side by side with others.
pub struct PlannedMotion<'a> {
    /// The system.
    pub motion: &'a Motion<'a>,
    /// Where the run starts.
    pub start: MotionStart,
    /// The time at which it ends.
    pub until: f64,
    /// Receives its segments and events.
    pub observer: &'a mut dyn MotionObserver,
}

/// What runs must share to stand in one vector.
#[derive(PartialEq)]
struct SharedShape {
    places: Option<usize>,
    pushes: usize,
    law: Option<AlikeLaw>,
}

/// A law, equal to those that differ from it in numbers alone.
struct AlikeLaw(Friction);

impl PartialEq for AlikeLaw {
    fn eq(&self, other: &Self) -> bool {
        self.0.is_alike(&other.0)
    }
}

impl SharedShape {
    fn of(run: &MotionRun<'_>) -> Self {
        let law = run.system.contacts.first().map(|contact| AlikeLaw(contact.friction.clone()));
        Self { places: places_of(run), pushes: run.forcings.pushes.len(), law }
    }
}

/// Runs of a group that are prepared at a time: their numbers are in memory together.
const PREPARED: usize = 64;

/// Integrates many runs: belts in the lanes of the machine's widest instruction set, systems of up to two coordinates and two plain
/// contacts two by two in vectors, others one by one. The results are in the order of the requests.
///
/// Every run has the same bits and events as by [`Motion::run`], next to any other runs and on any instruction set. `tolerance` bounds
/// the last two retained Taylor terms of a step ([`MOTION_TOLERANCE`](super::MOTION_TOLERANCE)). Each result is the end of its run, or
/// [`MotionStopped`] with time, state and reason.
///
/// # Panics
/// If a start has not as many numbers as the state of its system.
pub fn run_many(
    requests: Vec<PlannedMotion<'_>>,
    tolerance: f64,
) -> Vec<Result<MotionEnd, MotionStopped>> {
    run_many_with(InstructionSet::widest(), requests, tolerance)
}

/// [`run_many`] with a given instruction set for belts, or the widest available one if the machine lacks it. Systems are in vectors of
/// four numbers where the machine has them, and one by one with [`InstructionSet::Baseline`].
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
    let mut masses: (Vec<usize>, Vec<PlannedMass<'_>>) = (Vec::new(), Vec::new());
    let mut others: Vec<(usize, PlannedMotion<'_>)> = Vec::new();
    for (number, request) in requests.into_iter().enumerate() {
        assert_eq!(request.start.state.len(), request.motion.size(), "numbers of the state");
        let PlannedMotion { motion, start, until, observer } = request;
        if let MotionEngine::OneMass(mass, _) = &motion.engine {
            masses.0.push(number);
            masses.1.push(PlannedMass { mass, start, until, observer });
        } else {
            others.push((number, PlannedMotion { motion, start, until, observer }));
        }
    }
    for (number, end) in masses.0.into_iter().zip(run_masses(set, masses.1, tolerance)) {
        ends[number] = Some(end);
    }
    let mut others = others.into_iter().peekable();
    while others.peek().is_some() {
        let opened = others.by_ref().take(PREPARED).filter_map(|(number, request)| {
            let PlannedMotion { motion, start, until, observer } = request;
            let MotionEngine::General(equations) = &motion.engine else { return None };
            let parts = (motion.system, equations.as_ref());
            let mut run = MotionRun::new(parts, &start, until, tolerance, observer);
            match run.open() {
                Ok(()) => Some((number, run)),
                Err(why) => {
                    ends[number] = Some(Err(why));
                    None
                }
            }
        });
        let mut opened: Vec<(usize, MotionRun<'_>)> = opened.collect();
        let mut ended: Vec<Option<MotionProgress>> = Vec::new();
        ended.resize_with(opened.len(), || None);
        run_groups(set, &mut opened, &mut ended);
        for ((number, run), ended) in opened.into_iter().zip(ended) {
            ends[number] = ended.map(|ended| ended.and_then(|()| run.end()));
        }
    }
    // Every request is in one group, and every run of a group finishes.
    ends.into_iter().flatten().collect()
}

/// Runs those of each shape to their ends.
fn run_groups(
    set: InstructionSet,
    opened: &mut [(usize, MotionRun<'_>)],
    ended: &mut [Option<MotionProgress>],
) {
    let mut groups: Vec<(SharedShape, Vec<usize>, Vec<&mut MotionRun<'_>>)> = Vec::new();
    for (place, (_, run)) in opened.iter_mut().enumerate() {
        let shape = SharedShape::of(run);
        match groups.iter_mut().find(|(other, ..)| *other == shape) {
            Some((_, places, runs)) => {
                places.push(place);
                runs.push(run);
            }
            None => groups.push((shape, vec![place], vec![run])),
        }
    }
    for (_, places, mut runs) in groups {
        let mut finish = |number: usize, end| ended[places[number]] = Some(end);
        if set == InstructionSet::Baseline {
            one_by_one(&mut runs, &mut finish);
        } else {
            to_their_ends(&mut runs, &mut finish);
        }
    }
}
