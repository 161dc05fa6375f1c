//! The velocity of the observed row of a system on its way to a sound.

use quell_dynamics::motion::{MotionEnd, MotionObserver, MotionSegment, MotionStart};
use quell_numerics::interval::RealInterval;

use crate::complaint::Complaint;
use crate::run::system::periods::lowest_natural;
use crate::run::system::start::observed_state;
use crate::sound::{RecordedMotion, Sound, SoundOptions, SoundPlan, VelocityTap};
use crate::study::SystemStudy;

/// The plan for the sound of a run.
///
/// # Errors
/// As [`SoundPlan::new`].
pub(super) fn plan(
    study: &SystemStudy,
    RealInterval { lower: from, upper: until }: RealInterval,
    options: SoundOptions,
) -> Result<SoundPlan, Box<Complaint>> {
    let motion = RecordedMotion {
        duration: until - from,
        time_per_second: study.time_per_second().unwrap_or(RecordedMotion::AUDIBLE),
        natural_frequency: lowest_natural(study, from),
        fastest_forcing: study.system().acting_frequencies().reduce(f64::max),
    };
    SoundPlan::new(&motion, options)
}

/// Passes the velocity of the observed row on to a sound, if one is wanted.
pub(super) struct MotionSoundTap {
    tap: VelocityTap,
    row: Vec<f64>,
}

impl MotionSoundTap {
    /// For a run from `start`.
    pub(super) fn new(study: &SystemStudy, start: &MotionStart, plan: Option<&SoundPlan>) -> Self {
        let (begin, _) = observed_state(study, &start.state);
        Self { tap: VelocityTap::new(start.time, begin, plan), row: study.observe() }
    }

    /// The sound of the run that has ended here.
    pub(super) fn finish(self, study: &SystemStudy, end: &MotionEnd) -> Option<Sound> {
        self.tap.finish(observed_state(study, &end.state).0)
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
