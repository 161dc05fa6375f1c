//! Where the least dither leaves the range of a friction law, or is not fast.

use quell_design::least_dither::{Designed, FeasibleDesign};
use quell_dynamics::response::BAND_END;
use quell_model::Waveform;

use super::found::{DesignNumber, DesignNumbers, DesignedDither, LeastDitherFound};
use super::study_with_design::StudyWithDesign;
use crate::run::system::thresholds::reaches_the_band;
use crate::run::waveforms::label;

impl DesignNumbers {
    /// Corners of the box and the operating point that decides, the fastest first, as a rule.
    pub(super) fn points(&self, found: &FeasibleDesign) -> Vec<Vec<f64>> {
        let mut points: Vec<Vec<f64>> = vec![Vec::new()];
        for number in &self.over {
            let ends = [number.range.1, number.range.0];
            let longer = |point: &Vec<f64>| ends.map(|end| [point.as_slice(), &[end]].concat());
            points = points.iter().flat_map(longer).collect();
        }
        points.extend(found.critical.worst.clone());
        points
    }

    /// The verified dither at an operating point, as numbers of the study.
    pub(super) fn verified<'n>(
        &'n self,
        found: &FeasibleDesign,
        point: &[f64],
    ) -> Vec<(&'n str, f64)> {
        let others = self.others.iter().zip(found.critical.others.iter().copied());
        let at = self.over.iter().zip(point.iter().copied());
        let amplitude = [(&self.amplitude, found.verified_amplitude)];
        others.chain(at).chain(amplitude).map(in_units).collect()
    }

    /// Whether the least dither repeats in the band of the vibration.
    pub(super) fn is_slow(
        &self,
        designed: &Designed,
        waveform: &Waveform,
        study: &dyn StudyWithDesign,
    ) -> bool {
        let Ok(found) = &designed.answer else { return false };
        let reaches = |point: &Vec<f64>| {
            let system = study.system_with(waveform, &self.verified(found, point));
            system.is_ok_and(|system| reaches_the_band(&system))
        };
        self.points(found).iter().any(reaches)
    }

    /// Warnings where the dither takes the slip out of the range of a law.
    pub(super) fn beyond_laws(
        &self,
        found: &FeasibleDesign,
        waveform: &Waveform,
        study: &dyn StudyWithDesign,
    ) -> Vec<String> {
        let points = self.points(found);
        let warned =
            points.iter().map(|point| study.beyond_laws(waveform, &self.verified(found, point)));
        warned.into_iter().find(|warnings| !warnings.is_empty()).unwrap_or_default()
    }
}

impl LeastDitherFound {
    /// Warnings about dithers that are not fast: the one of the answer, and those that are not called least.
    pub(super) fn warnings_about_slow_ones(&self) -> Vec<String> {
        let band = format!("at or below {BAND_END} times the frequency of the vibration");
        if self.dither().is_slow {
            return vec![format!(
                "the {} repeats {band}: the motion in step with it vibrates slowly, which response_rms and response_peak give too",
                label(self.waveform())
            )];
        }
        let slow = self.tried.iter().filter(|tried| tried.is_slow);
        let slow: Vec<String> = slow.map(DesignedDither::label).collect();
        if slow.is_empty() {
            return Vec::new();
        }
        vec![format!(
            "not called least: {}, which would repeat {band}: the motion in step with such a dither vibrates slowly itself",
            slow.join(", ")
        )]
    }
}

/// A number of the equations with its path, in the unit of the path.
fn in_units((number, value): (&DesignNumber, f64)) -> (&str, f64) {
    (&number.path, value * number.per_unit)
}
