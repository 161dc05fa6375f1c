//! A motion on its way to a sound: its mean velocity over equal intervals.
//!
//! The mean velocity over an interval is the difference of the displacements at its ends over its length, exactly.

use super::{Sound, SoundPlan, SoundRecorder};

/// Passes the mean velocities of a run on to a sound, if one is wanted.
#[derive(Debug)]
pub(crate) struct VelocityTap {
    recorder: Option<SoundRecorder>,
    first: f64,
    interval: f64,
    intervals: usize,
    /// Displacement at the beginning of the next interval.
    displacement: f64,
}

impl VelocityTap {
    /// For a run from a time and a displacement.
    pub(crate) fn new(time: f64, displacement: f64, plan: Option<&SoundPlan>) -> Self {
        Self {
            recorder: plan.map(SoundPlan::recorder),
            first: time,
            interval: plan.map_or(0.0, SoundPlan::interval),
            intervals: plan.map_or(0, SoundPlan::intervals),
            displacement,
        }
    }

    /// Whether a sound is wanted.
    pub(crate) fn is_wanted(&self) -> bool {
        self.recorder.is_some()
    }

    /// Takes a segment of a run: `until` gives the time from its start to a time of the run, `at` the displacement after a time from
    /// its start.
    pub(crate) fn take(
        &mut self,
        duration: f64,
        until: impl Fn(f64) -> f64,
        mut at: impl FnMut(f64) -> f64,
    ) {
        let Some(recorder) = &mut self.recorder else { return };
        while recorder.received() < self.intervals {
            let ends = (recorder.received() + 1) as f64;
            let since = until(f64::mul_add(ends, self.interval, self.first));
            if since > duration {
                break;
            }
            let displacement = at(since.max(0.0));
            recorder.push((displacement - self.displacement) / self.interval);
            self.displacement = displacement;
        }
    }

    /// The sound of a run that has ended at a displacement.
    pub(crate) fn finish(mut self, displacement: f64) -> Option<Sound> {
        let mut recorder = self.recorder.take()?;
        // The end of the last interval may round to just beyond the end of the run.
        if recorder.received() < self.intervals {
            recorder.push((displacement - self.displacement) / self.interval);
        }
        Some(recorder.finish())
    }
}
