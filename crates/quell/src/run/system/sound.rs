//! The velocity of the observed row of a system on its way to a sound.

use quell_dynamics::motion::{MotionEnd, MotionObserver, MotionSegment, MotionStart};

use crate::complaint::Complaint;
use crate::sound::{RecordedMotion, Sound, SoundOptions, SoundPlan, VelocityTap};
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
    let motion = RecordedMotion {
        duration,
        time_per_second: study.time_per_second().unwrap_or(RecordedMotion::AUDIBLE),
        natural_frequency: None,
        fastest_forcing: study.system().acting_frequencies().reduce(f64::max),
    };
    SoundPlan::new(&motion, options)
}

/// Passes the velocity of the observed row on to a sound, if one is wanted.
pub(super) struct MotionSoundTap {
    tap: VelocityTap,
    row: Vec<f64>,
}

fn observed(row: &[f64], state: &[f64]) -> f64 {
    row.iter().zip(state).map(|(r, x)| r * x).sum()
}

impl MotionSoundTap {
    /// For a run from `start`, of a row over the coordinates, or over the states of first-order equations.
    pub(super) fn new(start: &MotionStart, row: &[f64], plan: Option<&SoundPlan>) -> Self {
        let tap = VelocityTap::new(start.time, observed(row, &start.state), plan);
        Self { tap, row: row.to_vec() }
    }

    /// The sound of the run that has ended here.
    pub(super) fn finish(self, end: &MotionEnd) -> Option<Sound> {
        self.tap.finish(observed(&self.row, &end.state))
    }
}

impl MotionObserver for MotionSoundTap {
    fn watches(&self) -> bool {
        self.tap.is_wanted()
    }

    fn segment(&mut self, segment: &MotionSegment<'_>) {
        if !self.tap.is_wanted() {
            return;
        }
        let series = segment.row(&self.row, 0);
        let until = |time| segment.clock().until(time);
        self.tap.take(segment.duration(), until, |since| MotionSegment::value(&series, since));
    }
}
