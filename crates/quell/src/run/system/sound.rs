//! The velocity of the observed row of a system on its way to a sound.
//!
//! The mean velocity over an interval is the difference of the observed value at its ends over its length, exactly.

use quell_dynamics::motion::{MotionEnd, MotionObserver, MotionSegment, MotionStart};

use crate::complaint::Complaint;
use crate::sound::{RecordedMotion, Sound, SoundOptions, SoundPlan, SoundRecorder};
use crate::study::SystemStudy;

/// The plan for the sound of a run of some duration.
///
/// # Errors
/// As [`SoundPlan::new`].
pub(super) fn plan(
    study: &SystemStudy,
    duration: f64,
    options: SoundOptions,
) -> Result<SoundPlan, Box<Complaint>> {
    let waves = study.system().inputs.iter().flat_map(|input| input.profile.waves());
    let acting = waves.filter(|wave| wave.amplitude != 0.0);
    let motion = RecordedMotion {
        duration,
        time_per_second: study.time_per_second().unwrap_or(RecordedMotion::AUDIBLE),
        natural_frequency: None,
        fastest_forcing: acting.map(|wave| wave.frequency).reduce(f64::max),
    };
    SoundPlan::new(&motion, options)
}

/// Passes the velocity of the observed row on to a sound, if one is wanted.
pub(super) struct MotionSoundTap {
    recorder: Option<SoundRecorder>,
    row: Vec<f64>,
    first: f64,
    interval: f64,
    intervals: usize,
    /// Observed value at the beginning of the next interval.
    observed: f64,
    state: Vec<f64>,
}

fn observed(row: &[f64], state: &[f64]) -> f64 {
    row.iter().zip(state).map(|(r, x)| r * x).sum()
}

impl MotionSoundTap {
    /// For a run from `start`, of a row over the coordinates, or over the states of first-order equations.
    pub(super) fn new(start: &MotionStart, row: &[f64], plan: Option<&SoundPlan>) -> Self {
        Self {
            recorder: plan.map(SoundPlan::recorder),
            first: start.time,
            interval: plan.map_or(0.0, SoundPlan::interval),
            intervals: plan.map_or(0, SoundPlan::intervals),
            observed: observed(row, &start.state),
            row: row.to_vec(),
            state: vec![0.0; start.state.len()],
        }
    }

    /// The sound of the run that has ended here.
    pub(super) fn finish(mut self, end: &MotionEnd) -> Option<Sound> {
        let mut recorder = self.recorder.take()?;
        // The end of the last interval may round to just beyond the end of the run.
        if recorder.received() < self.intervals {
            recorder.push((observed(&self.row, &end.state) - self.observed) / self.interval);
        }
        Some(recorder.finish())
    }
}

impl MotionObserver for MotionSoundTap {
    fn watches(&self) -> bool {
        self.recorder.is_some()
    }

    fn segment(&mut self, segment: &MotionSegment<'_>) {
        let Some(recorder) = &mut self.recorder else { return };
        while recorder.received() < self.intervals {
            let ends = (recorder.received() + 1) as f64;
            let since = segment.clock().until(f64::mul_add(ends, self.interval, self.first));
            if since > segment.duration() {
                break;
            }
            segment.state(since.max(0.0), &mut self.state);
            let now = observed(&self.row, &self.state);
            recorder.push((now - self.observed) / self.interval);
            self.observed = now;
        }
    }
}
