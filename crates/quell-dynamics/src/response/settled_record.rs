//! The settled record of one run.

use quell_model::{Contact, System};
use quell_numerics::spectrum::Spectrum;
use quell_numerics::spectrum::low_band::{LargestLines, LowBand};

use super::record_grid::RecordGrid;
use super::record_lines::RecordLines;
use super::record_tones::{lines_of, spectrum_of};
use super::response_plan::ResponsePlan;
use super::system_ending::{SystemEnding, drifts};
use crate::motion::{
    ContactMeans, ContactMeter, InputCost, InputMeter, Motion, MotionEnd, MotionObserver,
    MotionSegment, MotionStart, MotionStopped, ReadingSampler, RowMeter,
};
use crate::orbit::is_on_sliding;

/// The settled record of one run.
#[derive(Clone, Debug)]
pub struct SettledRecord {
    /// Where the run ends.
    pub ending: SystemEnding,
    /// Range, mean and deviation of the row: over one period of the orbit, or over the record.
    pub observed: RowMeter,
    /// Time of the first sample after the start.
    pub from: f64,
    /// Step between the samples.
    pub step: f64,
    /// The row at equal steps.
    pub samples: Vec<f64>,
    /// Its rate of change there.
    pub rates: Vec<f64>,
    /// Spectrum of the samples.
    pub spectrum: Spectrum,
    /// M in the band of slow vibration.
    pub lines: LargestLines,
    /// The contacts over one period of the orbit, or over the record.
    pub contacts: Vec<ContactMeans>,
    /// The inputs over one period of the orbit, or over the record.
    pub inputs: Vec<InputCost>,
    /// Largest slip speed of every contact from the start to the end of the record, transient included; 0 where the law has no range that
    /// slip may leave.
    pub largest_slip: Vec<f64>,
    /// A length that scales the motion: of one mass the load over the stiffness, otherwise the largest magnitude of the row from the start
    /// to the end of the record.
    pub(super) scale: f64,
    /// The end of the record.
    pub end: MotionEnd,
    /// The end of the settling time.
    settled: MotionEnd,
    /// Whether the record begins on the motion that repeats itself, on which the run ends.
    on_motion: bool,
}

/// What a run does over a record.
struct Recorded {
    samples: Vec<f64>,
    rates: Vec<f64>,
    end: MotionEnd,
}

impl SettledRecord {
    /// Settles a run and measures its record, without its lines, whose band depends on the undithered record.
    ///
    /// # Errors
    /// [`MotionStopped`].
    pub(super) fn of(
        motion: &Motion<'_>,
        start: &MotionStart,
        plan: &ResponsePlan,
        grid: RecordGrid,
    ) -> Result<Self, MotionStopped> {
        let (system, tolerance) = (motion.system(), motion.run_tolerance(plan.tolerance));
        let has_range = |contact: &Contact| contact.friction.range().is_some();
        let watched = if system.contacts.iter().any(has_range) { system.contacts.len() } else { 0 };
        let mut slip = ContactMeter::new(watched);
        let mut transient = RowMeter::new(&plan.row, start.time, grid.step, 0);
        let until = start.time + plan.settle;
        let mass = system.one_mass();
        let settled = match &mass {
            Some(_) => motion.run(start, until, tolerance, &mut slip)?,
            None => motion.run(start, until, tolerance, &mut (&mut slip, &mut transient))?,
        };
        let mut ending = SystemEnding::of(system, &plan.row, start, &settled);
        // Rounding may drive a run away from unstable sliding within its record.
        let leaves = ending == SystemEnding::UnstableSliding
            && !is_on_sliding(
                system,
                &motion.run(&settled.restart(), until + plan.length, tolerance, &mut ())?.state,
            );
        if leaves {
            ending = SystemEnding::judged(system, &plan.row, start);
        }
        let repeats = match ending.period() {
            Some(period) => Some((ending.record_from(motion, tolerance, &settled)?, period)),
            None => None,
        };
        let on_motion = repeats.is_some() && (mass.is_none() || leaves);
        let begin = repeats.as_ref().filter(|_| on_motion).map(|(start, _)| start.clone());
        let from = begin.unwrap_or_else(|| settled.restart());
        let mut meters = RunMeters::new(motion, &plan.row);
        let Recorded { samples, rates, end } = match &repeats {
            Some((start, period)) => {
                motion.run(start, start.time + period, tolerance, &mut meters)?;
                recorded(motion, plan, grid, &from, &mut slip)?
            }
            None => recorded(motion, plan, grid, &from, &mut (&mut slip, &mut meters))?,
        };
        let row = plan.row.first().copied().unwrap_or_default();
        let scale = if let Some(mass) = &mass {
            (row * mass.displacement() * mass.belt().normal_load()).abs()
        } else {
            let most = samples.iter().fold(0.0, |most: f64, sample| most.max(sample.abs()));
            transient.largest().max(most).max(meters.row.largest())
        };
        Ok(Self {
            spectrum: spectrum_of(&samples, grid.step),
            ending: ending.with_record(&samples),
            contacts: meters.contacts.means().unwrap_or_default(),
            inputs: meters.inputs.costs().unwrap_or_default(),
            observed: meters.row,
            from: until,
            step: grid.step,
            samples,
            rates,
            lines: LargestLines { whole: 0.0, halves: [0.0; 2] },
            largest_slip: (0..system.contacts.len())
                .map(|contact| if contact < watched { slip.largest_slip(contact) } else { 0.0 })
                .collect(),
            scale,
            end,
            settled,
            on_motion,
        })
    }

    /// Measures M in the band of slow vibration. A record that has not settled begins again on the motion on which the run is found to end,
    /// if that repeats itself or is rest; `reference`: M without dither, if it is known.
    ///
    /// # Errors
    /// [`MotionStopped`].
    pub(super) fn measure_lines(
        &mut self,
        motion: &Motion<'_>,
        plan: &ResponsePlan,
        (grid, band_end): (RecordGrid, f64),
        reference: Option<f64>,
    ) -> Result<(), MotionStopped> {
        self.lines = self.lines_in(motion.system(), grid, band_end);
        let found = RecordLines { lines: self.lines, scale: self.scale };
        let is_settled =
            found.is_settled(reference.unwrap_or(self.lines.whole)) && !drifts(&self.samples);
        let is_known = self.ending.period().is_some() || self.ending.is_rest();
        if !self.on_motion && !is_settled && is_known {
            let tolerance = motion.run_tolerance(plan.tolerance);
            let from = self.ending.record_from(motion, tolerance, &self.settled)?;
            let again = if self.ending.is_rest() {
                let mut meters = RunMeters::new(motion, &plan.row);
                let again = recorded(motion, plan, grid, &from, &mut meters)?;
                self.contacts = meters.contacts.means().unwrap_or_default();
                self.inputs = meters.inputs.costs().unwrap_or_default();
                self.observed = meters.row;
                again
            } else {
                // Its means are those of a period already.
                recorded(motion, plan, grid, &from, &mut ())?
            };
            self.spectrum = spectrum_of(&again.samples, grid.step);
            (self.samples, self.rates, self.end) = (again.samples, again.rates, again.end);
            self.on_motion = true;
            self.lines = self.lines_in(motion.system(), grid, band_end);
        }
        if self.on_motion {
            // The halves of a periodic motion differ by where the window cuts it.
            self.lines.halves = [self.lines.whole; 2];
        }
        Ok(())
    }

    fn lines_in(&self, system: &System, grid: RecordGrid, band_end: f64) -> LargestLines {
        let Some(cell) = grid.cell else {
            return lines_of(&self.samples, system, self.step, band_end);
        };
        // As maps of belts, which measure while they integrate.
        let rate = system.one_mass().map_or(1.0, |mass| mass.rate());
        let mut band = LowBand::new(grid.count, rate * grid.step, cell);
        self.samples.iter().for_each(|sample| band.push(*sample));
        band.largest_lines(band_end / rate)
    }

    /// Frequency of the largest line, if there is a vibration.
    pub(super) fn strongest_line(&self) -> Option<f64> {
        if self.ending.is_rest() {
            return None;
        }
        let lines = self.spectrum.frequencies().zip(self.spectrum.amplitudes()).skip(1);
        let largest = lines.max_by(|a, b| a.1.total_cmp(b.1));
        largest.filter(|(_, amplitude)| **amplitude > 0.0).map(|(frequency, _)| frequency)
    }
}

/// Samples a run from a state over the length of a record.
fn recorded(
    motion: &Motion<'_>,
    plan: &ResponsePlan,
    grid: RecordGrid,
    from: &MotionStart,
    observer: impl MotionObserver,
) -> Result<Recorded, MotionStopped> {
    let times: Vec<f64> =
        (0..grid.count).map(|number| f64::mul_add(number as f64, grid.step, from.time)).collect();
    let mut sampler = ReadingSampler::new(&plan.row, 0, &times);
    let (tolerance, until) = (motion.run_tolerance(plan.tolerance), from.time + plan.length);
    let end = motion.run(from, until, tolerance, &mut (observer, &mut sampler))?;
    let ReadingSampler { values: samples, rates, .. } = sampler;
    Ok(Recorded { samples, rates, end })
}

/// What is measured over a period or a record.
struct RunMeters<'s> {
    contacts: ContactMeter,
    inputs: InputMeter<'s>,
    row: RowMeter,
}

impl<'s> RunMeters<'s> {
    fn new(motion: &Motion<'s>, row: &[f64]) -> Self {
        let system = motion.system();
        Self {
            contacts: ContactMeter::new(system.contacts.len()),
            inputs: InputMeter::new(system),
            row: RowMeter::new(row, 0.0, 0.0, 0),
        }
    }
}

impl MotionObserver for RunMeters<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        self.contacts.segment(segment);
        self.inputs.segment(segment);
        self.row.segment(segment);
    }
}
