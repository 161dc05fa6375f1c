//! Settled records measured while integrating, many cases side by side. Nothing of a
//! trajectory is kept: memory does not grow with the length of a run.

use quell_model::{Belt, Direction};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::spectrum::low_band::LargestLines;

use super::cost::{self, Meter};
use super::listener::{Listener, Sampling};
use super::{HALVES_AGREE, HALVES_NEGLIGIBLE, Solver, Undefined};
use crate::orbit::NoOrbit;
use crate::orbit::cycle::keeps_vibrating;
use crate::simulation::{
    Event, FinalState, InstructionSet, LargestSlip, Observer, Run, Segment, Stalled, Start,
    simulate_many_with,
};

/// Amplitude, relative to F, of which nothing is left but the engine's error and rounding: it need not settle.
const NOTHING: f64 = 1e-9;

/// Relative error of M from the engine and from rounding, where its halves agree by chance: a thousand times the tolerance of a
/// step, as [`NOTHING`]. Smaller, noise would decide whether a dither increases or reduces.
const ROUNDING: f64 = NOTHING;

/// A belt and where it starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The belt.
    pub belt: Belt,
    /// Where it starts.
    pub start: Start,
}

/// Which observables are wanted besides those that cost nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Power and stroke of the dither.
    pub dither_cost: bool,
}

/// What was measured on the settled record of one run. Lengths in the study's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// M, the largest spectral amplitude of x at 0 < ω ≤ 1.9, of the record and of its halves.
    pub lines: LargestLines,
    /// Share of the record spent in stick.
    pub stick_fraction: f64,
    /// Mean friction force ⟨f⟩ over k.
    pub mean_friction: f64,
    /// Mean power ⟨D_T g_T x′⟩ over kω₀; `None` if not wanted, or when all dither is normal.
    pub dither_power: Option<f64>,
    /// Peak-to-peak displacement at the frequencies of the tangential dithers; `None` as for the power.
    pub dither_stroke: Option<f64>,
    /// Smallest normal load.
    pub minimum_normal_load: f64,
    /// Largest slip speed |v_r| in the record.
    pub largest_slip: f64,
    /// Stick, release and reversal events in the record.
    pub events: u64,
    /// F, the scale of lengths.
    load: f64,
}

impl Measured {
    /// Whether M of the halves agree, relatively or against `reference`.
    pub(super) fn is_settled(&self, reference: f64) -> bool {
        let [first, second] = self.lines.halves;
        let difference = (first - second).abs();
        difference <= HALVES_AGREE * first.max(second)
            || difference <= HALVES_NEGLIGIBLE * reference
            || first.max(second) <= NOTHING * self.load
    }

    /// By what share M of the halves differ: as closely as the record tells M.
    pub(super) fn unsteadiness(&self) -> f64 {
        let [first, second] = self.lines.halves;
        let largest = first.max(second);
        let difference = (first - second).abs();
        if largest > 0.0 { (difference / largest).max(ROUNDING) } else { 0.0 }
    }

    /// Whether M of the halves agree relatively: nothing grows or falls by more than a hundredth over half a record.
    pub(super) fn is_steady(&self) -> bool {
        self.is_settled(0.0)
    }
}

/// A case with and without its dither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// With dither.
    pub dithered: Measured,
    /// Without, from the same state.
    pub undithered: Measured,
    /// Whether the undithered run keeps vibrating, by the cycle map; or why E is undefined.
    pub vibrates: Result<(), Undefined>,
}

impl Compared {
    /// E = M₁/M₀ (2.27).
    ///
    /// # Errors
    /// Why it is undefined.
    pub fn efficiency(&self) -> Result<f64, Undefined> {
        self.vibrates?;
        Ok(self.dithered.lines.whole / self.undithered.lines.whole)
    }

    /// Whether M of the halves of the dithered record agree.
    pub fn settled(&self) -> bool {
        self.dithered.is_settled(self.undithered.lines.whole)
    }

    /// The same for the undithered run.
    pub fn undithered_settled(&self) -> bool {
        self.undithered.is_settled(self.undithered.lines.whole)
    }
}

/// Measures the settled response of every case with and without its dither, the cases side by
/// side in lanes. Cases that differ in their dither alone share one undithered run. A
/// result has the same bits whatever the other cases are.
pub fn compare_many(
    cases: &[Case],
    solver: &Solver,
    wanted: Wanted,
) -> Vec<Result<Compared, Stalled>> {
    let mut without: Vec<Case> = Vec::new();
    let mut places = Vec::with_capacity(cases.len());
    for case in cases {
        let undithered = Case { belt: case.belt.undithered(), start: case.start };
        // Neighbours of a map are most often alike.
        let place = without.iter().rposition(|known| *known == undithered);
        places.push(place.unwrap_or_else(|| {
            without.push(undithered);
            without.len() - 1
        }));
    }
    let undithered = measure_many(&without, solver, Wanted::default());
    let vibrates: Vec<_> = without.iter().map(keeps_vibrating_without).collect();
    let dithered = measure_many(cases, solver, wanted);
    dithered
        .into_iter()
        .zip(places)
        .map(|(dithered, place)| {
            let (undithered, vibrates) = (undithered[place]?, vibrates[place]?);
            Ok(Compared { dithered: dithered?, undithered, vibrates })
        })
        .collect()
}

/// Whether the undithered run of a case keeps vibrating, or why E is undefined.
///
/// # Errors
/// [`Stalled`].
pub(super) fn keeps_vibrating_without(case: &Case) -> Result<Result<(), Undefined>, Stalled> {
    if case.belt.belt_velocity() == 0.0 {
        return Ok(Err(Undefined::UnditheredAtRest));
    }
    match keeps_vibrating(&case.belt, case.start) {
        Ok(true) => Ok(Ok(())),
        Ok(false) => Ok(Err(Undefined::UnditheredSettles)),
        Err(NoOrbit::Stalled(stalled)) => Err(stalled),
        Err(_) => Ok(Err(Undefined::UnditheredUnknown)),
    }
}

/// Measures the settled record of every case.
pub fn measure_many(
    cases: &[Case],
    solver: &Solver,
    wanted: Wanted,
) -> Vec<Result<Measured, Stalled>> {
    record_many(cases, solver, wanted, |_, _| ())
        .into_iter()
        .map(|outcome| outcome.map(|(measured, ())| measured))
        .collect()
}

/// [`measure_many`] with one more observer on each record.
pub(super) fn record_many<O: Observer>(
    cases: &[Case],
    solver: &Solver,
    wanted: Wanted,
    observer: impl Fn(&Case, &Sampling) -> O,
) -> Vec<Result<(Measured, O), Stalled>> {
    let set = if cases.len() == 1 { InstructionSet::Fma } else { InstructionSet::widest() };
    let mut nobody = vec![(); cases.len()];
    let runs = cases
        .iter()
        .zip(&mut nobody)
        .map(|(Case { belt, start }, observer)| Run {
            belt,
            start: *start,
            until: start.time + solver.settle,
            observer,
        })
        .collect();
    let settled = simulate_many_with(set, runs, solver.tolerance);
    let mut watches: Vec<Result<Watch<O>, Stalled>> = cases
        .iter()
        .zip(settled)
        .map(|(case, settled)| {
            let settled = settled?;
            let sampling = Sampling::of(&case.belt, case.start.time + solver.settle, solver);
            Ok(Watch {
                settled,
                sampling,
                meter: Meter::new(&case.belt, &settled, wanted.dither_cost),
                listener: Listener::new(&case.belt, sampling, wanted.dither_cost),
                slip: LargestSlip::of(&case.belt),
                observer: observer(case, &sampling),
            })
        })
        .collect();
    let runs = cases
        .iter()
        .zip(&mut watches)
        .filter_map(|(case, watch)| {
            let watch = watch.as_mut().ok()?;
            let (start, until) = (watch.settled.restart(), watch.sampling.end());
            Some(Run { belt: &case.belt, start, until, observer: watch })
        })
        .collect();
    let mut ends = simulate_many_with(set, runs, solver.tolerance).into_iter();
    cases
        .iter()
        .zip(watches)
        .map(|(case, watch)| {
            let watch = watch?;
            let end = ends.next().unwrap_or(Err(Stalled::NEVER_STARTED))?;
            Ok(watch.measured(case, wanted, &end))
        })
        .collect()
}

/// Who watches a record.
struct Watch<O> {
    settled: FinalState,
    sampling: Sampling,
    meter: Meter,
    listener: Listener,
    slip: LargestSlip,
    observer: O,
}

impl<O> Watch<O> {
    fn measured(mut self, case: &Case, wanted: Wanted, end: &FinalState) -> (Measured, O) {
        let belt = &case.belt;
        self.meter.finish(belt, &self.settled, end);
        self.listener.finish(end.displacement);
        let only_normal = belt.total_amplitude(Direction::Tangential) == 0.0
            && belt.total_amplitude(Direction::Normal) > 0.0;
        let has_cost = wanted.dither_cost && !only_normal;
        let length = self.sampling.end() - self.sampling.from;
        let measured = Measured {
            lines: self.listener.largest_lines(),
            stick_fraction: self.meter.stick_fraction(),
            mean_friction: self.meter.mean_friction(),
            dither_power: has_cost.then(|| self.meter.dither_power()),
            dither_stroke: has_cost.then(|| self.listener.stroke()),
            minimum_normal_load: cost::minimum_normal_load(belt, self.sampling.from, length),
            largest_slip: self.slip.speed,
            events: end.events,
            load: belt.normal_load(),
        };
        (measured, self.observer)
    }
}

/// One segment, with the machine's best instructions.
struct Watching<'a, 'b> {
    meter: &'a mut Meter,
    listener: &'a mut Listener,
    segment: &'a Segment<'b>,
}

impl Work for Watching<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.meter.add_segment(self.segment);
        self.listener.hear_segment(self.segment);
    }
}

impl<O: Observer> Observer for Watch<O> {
    fn segment(&mut self, segment: &Segment<'_>) {
        let Self { meter, listener, .. } = self;
        with_fused_multiply_add(Watching { meter, listener, segment });
        self.slip.segment(segment);
        if self.observer.watches() {
            self.observer.segment(segment);
        }
    }

    fn event(&mut self, event: &Event) {
        self.observer.event(event);
    }
}
