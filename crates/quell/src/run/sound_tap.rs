//! The velocity of a belt's mass on its way to a sound.
//!
//! The mean velocity over an interval is the difference of the displacements at its ends over its length, exactly. The rounding
//! of the displacements is divided by the interval, at least 10⁻⁵/ω₀ in practice: it stays below 10⁻¹¹ of the displacement.

use quell_dynamics::simulation::{FinalState, Observer, Segment, Start};

use crate::complaint::Complaint;
use crate::sound::{RecordedMotion, Sound, SoundOptions, SoundPlan, SoundRecorder};
use crate::study::BeltStudy;

/// The plan for the sound of a run to τ = `until`, which starts at 0.
///
/// # Errors
/// As [`SoundPlan::new`].
pub(super) fn plan(
    study: &BeltStudy,
    until: f64,
    options: SoundOptions,
) -> Result<SoundPlan, Box<Complaint>> {
    let scales = study.scales();
    let motion = RecordedMotion {
        duration: until,
        time_per_second: scales
            .map_or(RecordedMotion::AUDIBLE, |scales| scales.angular_frequency()),
        natural_frequency: Some(1.0),
        fastest_forcing: fastest_dither(study),
    };
    SoundPlan::new(&motion, options)
}

/// The frequency ratio of the fastest dither that acts.
pub(super) fn fastest_dither(study: &BeltStudy) -> Option<f64> {
    let acting = study.belt().dithers().iter().filter(|dither| dither.amplitude > 0.0);
    acting.map(|dither| dither.frequency_ratio).reduce(f64::max)
}

/// Passes the velocity of a run on to a sound, if one is wanted.
#[derive(Debug)]
pub(super) struct SoundTap {
    recorder: Option<SoundRecorder>,
    first: f64,
    interval: f64,
    intervals: usize,
    /// Displacement at the beginning of the next interval.
    displacement: f64,
}

impl SoundTap {
    /// For a run from `start`.
    pub(super) fn new(start: Start, plan: Option<&SoundPlan>) -> Self {
        Self {
            recorder: plan.map(SoundPlan::recorder),
            first: start.time,
            interval: plan.map_or(0.0, SoundPlan::interval),
            intervals: plan.map_or(0, SoundPlan::intervals),
            displacement: start.displacement,
        }
    }

    /// The sound of the run that has ended here.
    pub(super) fn finish(mut self, end: &FinalState) -> Option<Sound> {
        let mut recorder = self.recorder.take()?;
        // The end of the last interval may round to just beyond the end of the run.
        if recorder.received() < self.intervals {
            recorder.push((end.displacement - self.displacement) / self.interval);
        }
        Some(recorder.finish())
    }
}

impl Observer for SoundTap {
    fn watches(&self) -> bool {
        self.recorder.is_some()
    }

    fn segment(&mut self, segment: &Segment<'_>) {
        let Some(recorder) = &mut self.recorder else { return };
        while recorder.received() < self.intervals {
            let ends = (recorder.received() + 1) as f64;
            let since = segment.clock().until(f64::mul_add(ends, self.interval, self.first));
            if since > segment.duration() {
                break;
            }
            let displacement = segment.displacement(since.max(0.0));
            recorder.push((displacement - self.displacement) / self.interval);
            self.displacement = displacement;
        }
    }
}
