//! Where the least dither leaves the range of a friction law, or is not fast.

use quell_dynamics::response::BAND_END;

use super::found::{DesignNumber, LeastDitherFound};
use super::study_with_design::StudyWithDesign;
use crate::run::system::thresholds::reaches_the_band;
use crate::run::waveforms::label;

impl LeastDitherFound {
    /// Warnings where the dither of the answer takes the slip out of the range of a law, at a corner of the box or the point that decides,
    /// and where it is not fast.
    pub(super) fn validity(&self, study: &dyn StudyWithDesign) -> Vec<String> {
        let Ok(found) = &self.answer().answer else { return Vec::new() };
        let mut points: Vec<Vec<f64>> = vec![Vec::new()];
        for number in &self.over {
            // The fastest first, as a rule.
            let ends = [number.range.1, number.range.0];
            let longer = |point: &Vec<f64>| ends.map(|end| [point.as_slice(), &[end]].concat());
            points = points.iter().flat_map(longer).collect();
        }
        points.extend(found.critical.worst.clone());
        let amplitude = [(&self.amplitude, found.verified_amplitude)];
        let others = self.others.iter().zip(found.critical.others.iter().copied());
        let numbers_at = |point: &Vec<f64>| -> Vec<(&str, f64)> {
            let at = self.over.iter().zip(point.iter().copied());
            others.clone().chain(at).chain(amplitude).map(in_units).collect()
        };
        let warned =
            points.iter().map(|point| study.beyond_laws(self.waveform(), &numbers_at(point)));
        let of_laws = warned.into_iter().find(|warnings| !warnings.is_empty()).unwrap_or_default();
        let is_slow = |point: &Vec<f64>| {
            let system = study.system_with(self.waveform(), &numbers_at(point));
            system.is_ok_and(|system| reaches_the_band(&system))
        };
        let slow = points.iter().any(is_slow).then(|| {
            format!(
                "the {} repeats at or below {BAND_END} times the frequency of the vibration: quiet means that the motion is in step with it, \
                 and that motion vibrates slowly; response_rms and response_peak give it",
                label(self.waveform())
            )
        });
        of_laws.into_iter().chain(slow).collect()
    }
}

/// A number of the equations with its path, in the unit of the path.
fn in_units((number, value): (&DesignNumber, f64)) -> (&str, f64) {
    (&number.path, value * number.per_unit)
}
