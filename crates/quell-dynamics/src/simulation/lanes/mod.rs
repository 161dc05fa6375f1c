//! Slip steps of many runs side by side.
//!
//! Each lane holds one run with its own time, step, phase, events and law constants; what
//! happens at v_r = 0 and in stick is the run's own affair ([`super::engine`]). A lane whose
//! run is over takes the next run of the queue. A lane computes nothing but correctly rounded
//! operations on its own numbers, so that a run has the same bits alone, in any lane and
//! beside any neighbours; one run alone is the case of one lane.
//!
//! Lanes of one loop share the law but for its numbers, and the shape of the forcing; runs are
//! grouped by these.

mod bench;
mod board;
mod rows;
mod search;
mod sliding;

use quell_model::Direction;
use quell_model::friction::{LawVisitor, SlidingLaw};
use quell_numerics::dispatch::{InstructionSet, LaneWork, with_lanes};
use quell_numerics::lane::Lane;

use self::bench::{Bench, MOST_BENCHES};
pub(super) use self::rows::Row;
use self::search::RootSearch;
pub(crate) use self::sliding::slide;
use super::forcing::Shape;
use super::{FinalState, Run, Stalled};

/// How a run ends.
type Outcome = Result<FinalState, Stalled>;

/// Runs in the lanes of `set`, outcomes in the order of the runs.
pub(super) fn side_by_side(
    set: InstructionSet,
    runs: Vec<Run<'_>>,
    tolerance: f64,
) -> Vec<Outcome> {
    let mut outcomes = vec![Err(Stalled::NEVER_STARTED); runs.len()];
    let mut rest: Vec<(usize, Run<'_>)> = Vec::with_capacity(runs.len());
    for (number, run) in runs.into_iter().enumerate() {
        match run.belt.friction().unsimulated() {
            Some(why) => outcomes[number] = Err(Stalled { time: run.start.time, why }),
            None => rest.push((number, run)),
        }
    }
    while let Some((_, first)) = rest.first() {
        let (law, shapes) = (first.belt.friction().clone(), shapes_of(first));
        let alike = |run: &Run<'_>| run.belt.friction().is_alike(&law) && shapes_of(run) == shapes;
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
