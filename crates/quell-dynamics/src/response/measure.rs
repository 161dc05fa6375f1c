//! Settled records measured while integrating, many cases side by side. The trajectory is not
//! stored: memory does not grow with the length of a run.

use std::fmt;

use quell_model::Belt;
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::spectrum::low_band::LargestLines;

use super::record_lines::RecordLines;
use super::solver::Solver;
use super::spectral_meter::{Sampling, SpectralMeter};
use crate::orbit::{CycleMapError, OrbitVerdict, keeps_vibrating, verdict_of_sliding};
use crate::simulation::{
    FinalState, InstructionSet, LargestSlip, Observer, Segment, SimulationRun, Stalled, Start,
    simulate_many_with,
};

/// Why E is undefined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Undefined {
    /// The undithered run from this state settles to steady sliding; a limit cycle may still
    /// exist elsewhere.
    UnditheredSettles,
    /// The belt does not move (v₀ = 0), so that the undithered run comes to rest.
    UnditheredAtRest,
    /// The limit set of the undithered run is unknown.
    UnditheredUnknown,
    /// The undithered run stays in steady sliding, which is unstable.
    UnditheredUnstable,
    /// The undithered run drifts.
    UnditheredDrifts,
    /// What is observed of the undithered vibration is not in the band of slow vibration.
    UnditheredStill,
}

impl Undefined {
    /// Whether nothing of the undithered run vibrates in the band in the end.
    pub fn is_quiet(self) -> bool {
        matches!(self, Self::UnditheredSettles | Self::UnditheredAtRest | Self::UnditheredStill)
    }

    /// Whether it is unknown if the undithered run vibrates.
    pub fn is_unknown(self) -> bool {
        matches!(self, Self::UnditheredUnknown | Self::UnditheredUnstable | Self::UnditheredDrifts)
    }
}

impl fmt::Display for Undefined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::UnditheredSettles => {
                "without dither the belt settles to steady sliding from this start, so there is \
                 no vibration to compare with (a limit cycle may exist from another start)"
            }
            Self::UnditheredAtRest => {
                "the belt does not move (v₀ = 0), so without dither the mass comes to rest, and \
                 there is no vibration to compare with"
            }
            Self::UnditheredUnknown => {
                "where the undithered run from this start ends is unknown: it converges neither to \
                 a known limit cycle nor to stable steady sliding"
            }
            Self::UnditheredUnstable => {
                "without dither the run stays in steady sliding, which is unstable, because its start does not disturb it: choose \
                 another start"
            }
            Self::UnditheredStill => {
                "without dither what is observed does not vibrate in the band of slow vibration, so there is no vibration to compare with"
            }
            Self::UnditheredDrifts => {
                "without dither the observed motion drifts: over the record it moves on by more than it vibrates"
            }
        })
    }
}

impl std::error::Error for Undefined {}

/// A belt and its initial state.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseCase {
    /// The belt.
    pub belt: Belt,
    /// The initial state.
    pub start: Start,
}

/// The measurements on the settled record of one run. Lengths in the study's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredRecord {
    /// M, the largest spectral amplitude of x at 0 < ω ≤ 1.9, of the record and of its halves.
    pub lines: LargestLines,
    /// Fraction of the record spent in stick.
    pub stick_fraction: f64,
    /// Largest slip speed |v_r| in the record.
    pub largest_slip: f64,
    /// Stick, release and reversal events in the record.
    pub events: u64,
    /// F, the scale of lengths.
    load: f64,
}

impl MeasuredRecord {
    /// M, with F as the length that scales it.
    pub(super) fn record(&self) -> RecordLines {
        RecordLines { lines: self.lines, scale: self.load }
    }
}

/// A case with and without its dither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compared {
    /// With dither.
    pub dithered: MeasuredRecord,
    /// Without dither, from the same state.
    pub undithered: MeasuredRecord,
    /// Whether the undithered run keeps vibrating, by the cycle map; or why E is undefined.
    pub vibrates: Result<(), Undefined>,
}

impl Compared {
    /// E = M₁/M₀ (2.27).
    ///
    /// # Errors
    /// Why E is undefined.
    pub fn residual_vibration(&self) -> Result<f64, Undefined> {
        self.vibrates_in_band()?;
        Ok(self.dithered.lines.whole / self.undithered.lines.whole)
    }

    /// Whether the undithered run keeps vibrating in the band, or why E is undefined.
    pub(super) fn vibrates_in_band(&self) -> Result<(), Undefined> {
        let still = self.undithered.record().is_negligible();
        self.vibrates.and(if still { Err(Undefined::UnditheredStill) } else { Ok(()) })
    }

    /// Whether M of the halves of the dithered record agree, and the run has left its first stick.
    pub fn settled(&self) -> bool {
        self.dithered.record().is_settled(self.undithered.lines.whole)
            && !self.still_sticks(&self.dithered)
    }

    /// Whether M of the halves of the undithered record agree, and the run has left its first stick.
    pub fn undithered_settled(&self) -> bool {
        self.undithered.record().is_settled(self.undithered.lines.whole)
            && !self.still_sticks(&self.undithered)
    }

    /// Whether a moving belt still carries the mass along in its first stick: no motion on it sticks indefinitely.
    fn still_sticks(&self, measured: &MeasuredRecord) -> bool {
        let moves = self.vibrates != Err(Undefined::UnditheredAtRest);
        moves && measured.events == 0 && measured.stick_fraction > 0.5
    }
}

/// Measures the settled response of every case with and without its dither, the cases side by
/// side in lanes. Cases that differ only in their dither share one undithered run. The bits of a
/// result do not depend on the other cases.
pub fn compare_many(cases: &[ResponseCase], solver: &Solver) -> Vec<Result<Compared, Stalled>> {
    let mut without: Vec<ResponseCase> = Vec::new();
    let mut indices = Vec::with_capacity(cases.len());
    for case in cases {
        let undithered = ResponseCase { belt: case.belt.undithered(), start: case.start };
        // Neighbouring points of a map usually share the undithered run.
        let index = without.iter().rposition(|known| *known == undithered);
        indices.push(index.unwrap_or_else(|| {
            without.push(undithered);
            without.len() - 1
        }));
    }
    let undithered = measure_many(&without, solver);
    let vibrates: Vec<_> = without.iter().map(keeps_vibrating_without).collect();
    let dithered = measure_many(cases, solver);
    dithered
        .into_iter()
        .zip(indices)
        .map(|(dithered, index)| {
            let (undithered, vibrates) = (undithered[index]?, vibrates[index]?);
            Ok(Compared { dithered: dithered?, undithered, vibrates })
        })
        .collect()
}

/// Whether the undithered run of a case keeps vibrating, or why E is undefined.
///
/// # Errors
/// [`Stalled`].
pub(super) fn keeps_vibrating_without(
    case: &ResponseCase,
) -> Result<Result<(), Undefined>, Stalled> {
    if case.belt.belt_velocity() == 0.0 {
        return Ok(Err(Undefined::UnditheredAtRest));
    }
    match keeps_vibrating(&case.belt, case.start) {
        Ok(true) => Ok(Ok(())),
        // A run that does not leave unstable sliding started exactly there.
        Ok(false) if verdict_of_sliding(&case.belt.undithered()) == OrbitVerdict::Unstable => {
            Ok(Err(Undefined::UnditheredUnstable))
        }
        Ok(false) => Ok(Err(Undefined::UnditheredSettles)),
        Err(CycleMapError::Stalled(stalled)) => Err(stalled),
        Err(CycleMapError::NoLimit) => Ok(Err(Undefined::UnditheredUnknown)),
    }
}

/// Measures the settled record of every case.
fn measure_many(cases: &[ResponseCase], solver: &Solver) -> Vec<Result<MeasuredRecord, Stalled>> {
    let set = if cases.len() == 1 { InstructionSet::Fma } else { InstructionSet::widest() };
    let mut no_observers = vec![(); cases.len()];
    let runs = cases
        .iter()
        .zip(&mut no_observers)
        .map(|(ResponseCase { belt, start }, observer)| SimulationRun {
            belt,
            start: *start,
            until: start.time + solver.settle,
            observer,
        })
        .collect();
    let settled = simulate_many_with(set, runs, solver.tolerance);
    let mut observers: Vec<Result<RecordObserver, Stalled>> = cases
        .iter()
        .zip(settled)
        .map(|(case, settled)| Ok(RecordObserver::new(case, settled?, solver)))
        .collect();
    let runs = cases
        .iter()
        .zip(&mut observers)
        .filter_map(|(case, observer)| {
            let observer = observer.as_mut().ok()?;
            let (start, until) = (observer.settled.restart(), observer.sampling.end());
            Some(SimulationRun { belt: &case.belt, start, until, observer })
        })
        .collect();
    let mut ends = simulate_many_with(set, runs, solver.tolerance).into_iter();
    cases
        .iter()
        .zip(observers)
        .map(|(case, observer)| {
            let observer = observer?;
            let end = ends.next().unwrap_or(Err(Stalled::NEVER_STARTED))?;
            Ok(observer.measured(&case.belt, &end))
        })
        .collect()
}

/// The observer of a record.
struct RecordObserver {
    settled: FinalState,
    sampling: Sampling,
    spectral: SpectralMeter,
    slip: LargestSlip,
    stuck: f64,
}

impl RecordObserver {
    fn new(case: &ResponseCase, settled: FinalState, solver: &Solver) -> Self {
        let sampling = Sampling::of(&case.belt, case.start.time + solver.settle, solver);
        Self {
            settled,
            sampling,
            spectral: SpectralMeter::new(&case.belt, sampling),
            slip: LargestSlip::of(&case.belt),
            stuck: 0.0,
        }
    }

    fn measured(mut self, belt: &Belt, end: &FinalState) -> MeasuredRecord {
        self.spectral.finish(end.displacement);
        MeasuredRecord {
            lines: self.spectral.largest_lines(),
            stick_fraction: self.stuck / (self.sampling.end() - self.sampling.from),
            largest_slip: self.slip.speed,
            events: end.events,
            load: belt.normal_load(),
        }
    }
}

/// The measurements of one segment, on the machine's best instruction set.
struct SegmentMeasurement<'a, 'b> {
    spectral: &'a mut SpectralMeter,
    segment: &'a Segment<'b>,
}

impl Work for SegmentMeasurement<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.spectral.add_segment(self.segment);
    }
}

impl Observer for RecordObserver {
    fn segment(&mut self, segment: &Segment<'_>) {
        if segment.slip_sign() == 0 {
            self.stuck += segment.duration();
        }
        with_fused_multiply_add(SegmentMeasurement { spectral: &mut self.spectral, segment });
        self.slip.segment(segment);
    }
}
