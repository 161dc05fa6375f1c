//! The velocity of a belt's mass on its way to a sound.
//!
//! The rounding of the displacements is divided by the interval of the samples, at least 10⁻⁵/ω₀ in practice: it stays below 10⁻¹¹
//! of the displacement.

use quell_dynamics::simulation::{FinalState, Observer, Segment, Start};

use crate::complaint::Complaint;
use crate::sound::{RecordedMotion, Sound, SoundOptions, SoundPlan, VelocityTap};
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
pub(super) struct SoundTap(VelocityTap);

impl SoundTap {
    /// For a run from `start`.
    pub(super) fn new(start: Start, plan: Option<&SoundPlan>) -> Self {
        Self(VelocityTap::new(start.time, start.displacement, plan))
    }

    /// The sound of the run that has ended here.
    pub(super) fn finish(self, end: &FinalState) -> Option<Sound> {
        self.0.finish(end.displacement)
    }
}

impl Observer for SoundTap {
    fn watches(&self) -> bool {
        self.0.is_wanted()
    }

    fn segment(&mut self, segment: &Segment<'_>) {
        let until = |time| segment.clock().until(time);
        self.0.take(segment.duration(), until, |since| segment.displacement(since));
    }
}
