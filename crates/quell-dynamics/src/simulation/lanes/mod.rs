//! Slip steps of many runs side by side.
//!
//! Each lane holds one run with its own time, step, phase, events and law constants. The events at
//! v_r = 0 and the sticks are handled by the run's engine ([`super::engine`]). A lane whose
//! run is over takes the next run of the queue. A lane performs only correctly rounded
//! operations on its own numbers, so that a run has the same bits alone, in any lane and
//! next to any neighbours; a single run is the case of one lane.
//!
//! The lanes of one loop share the kind of law, with different constants, and the shape of the forcing; runs are
//! grouped by these.
//!
//! A batch holds as many runs as there are lanes, each in its slot. A lane whose last step needs no service is not
//! serviced: its state is in `lane_state` alone, and the engine of its slot is brought up to date (synced) at the next service.

mod batch;
mod forcing_rows;
mod lane_state;
mod law_lanes;
mod root_search;
mod run_slot;

use quell_model::Direction;
use quell_model::friction::{LawSeries, LawVisitor};
use quell_numerics::dispatch::{InstructionSet, LaneWork, with_lanes};
use quell_numerics::lane::Lane;

use self::batch::{Batch, MOST_BATCHES, RunFinish};
use self::law_lanes::LawLanes;
use self::root_search::RootSearch;
use super::forcing::{ForcingShape, ForcingShapes};
use super::run::{RunTerms, SimulationRun};
use super::state::{RunResult, Stalled};

/// Integrates runs in the lanes of `set`. The results are in the order of the runs.
pub(super) fn side_by_side(
    set: InstructionSet,
    runs: Vec<SimulationRun<'_>>,
    terms: RunTerms,
) -> Vec<RunResult> {
    let mut outcomes = vec![Err(Stalled::NEVER_STARTED); runs.len()];
    let mut rest: Vec<(usize, SimulationRun<'_>)> = Vec::with_capacity(runs.len());
    for (number, run) in runs.into_iter().enumerate() {
        match run.belt.unsimulated() {
            Some(why) => outcomes[number] = Err(Stalled::before(&run.start, why)),
            None => rest.push((number, run)),
        }
    }
    while let Some((_, first)) = rest.first() {
        let (law, shapes) = (first.belt.friction().clone(), shapes_of(first, terms));
        let alike = |run: &SimulationRun<'_>| {
            run.belt.friction().is_alike(&law) && shapes_of(run, terms) == shapes
        };
        let (group, others) = rest.into_iter().partition(|(_, run)| alike(run));
        rest = others;
        law.visit(RunGroup { set, runs: group, shapes, terms, outcomes: &mut outcomes });
    }
    outcomes
}

fn shapes_of(run: &SimulationRun<'_>, terms: RunTerms) -> ForcingShapes {
    let shape = |direction| match ForcingShape::of(run.belt.dithers(), direction) {
        ForcingShape::Constant => ForcingShape::Constant,
        // A branch that is kept is watched: each of its steps has its own series.
        _ if terms.branch.is_some() => ForcingShape::Several,
        shape => shape,
    };
    (shape(Direction::Tangential), shape(Direction::Normal))
}

/// Runs that share a kind of law and the shapes of the forcing.
struct RunGroup<'q, 'a> {
    set: InstructionSet,
    runs: Vec<(usize, SimulationRun<'a>)>,
    shapes: ForcingShapes,
    terms: RunTerms,
    outcomes: &'q mut [RunResult],
}

impl LawVisitor for RunGroup<'_, '_> {
    type Output = ();

    fn visit<L: LawSeries>(self, _: &L) {
        with_lanes(self.set, RunGroupOf::<L> { group: self, law: std::marker::PhantomData });
    }
}

/// [`RunGroup`] with its law.
struct RunGroupOf<'q, 'a, L> {
    group: RunGroup<'q, 'a>,
    law: std::marker::PhantomData<L>,
}

impl<L: LawSeries> LaneWork for RunGroupOf<'_, '_, L> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lane>(self) {
        let RunGroup { set, runs, shapes, terms, outcomes } = self.group;
        let finish: &mut RunFinish<'_> = &mut |number, outcome| outcomes[number] = outcome;
        drive::<V, L>(runs, set, shapes, terms, finish);
    }
}

/// The loop: takes one slip step in all lanes of all batches, searches for roots of v_r where one
/// is possible, then services the runs that need it. A lane in which only slip occurs is not
/// serviced: its state is in the lanes alone.
#[inline(always)]
fn drive<V: Lane, L: LawSeries>(
    runs: Vec<(usize, SimulationRun<'_>)>,
    set: InstructionSet,
    shapes: ForcingShapes,
    terms: RunTerms,
    finish: &mut RunFinish<'_>,
) {
    let count = runs.len().div_ceil(V::LANES).clamp(1, MOST_BATCHES);
    let mut queue = runs.into_iter();
    let mut batches: Vec<_> = (0..count).map(|_| Batch::new(set, V::LANES, shapes)).collect();
    let mut laws: Vec<LawLanes<V, L>> = (0..count).map(|_| LawLanes::new()).collect();
    let mut search = RootSearch::new(set);
    loop {
        let mut occupied = 0;
        for (batch, laws) in batches.iter_mut().zip(&mut laws) {
            if batch.fill(&mut queue, terms, finish) {
                laws.refresh(batch);
            }
            occupied += batch.occupied;
            if batch.occupied > 0 {
                laws.step(batch);
            }
        }
        if occupied == 0 {
            return;
        }
        search.run::<V, L>(&mut batches, &laws);
        for batch in &mut batches {
            batch.service(finish);
        }
    }
}
