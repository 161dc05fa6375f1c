//! Where the least dither leaves the range of a friction law, or is not fast.

use quell_design::least_dither::{CoveredBox, FeasibleDesign};
use quell_dynamics::response::BAND_END;
use quell_model::Waveform;
use quell_numerics::interval::RealInterval;

use super::found::{DesignNumber, DesignNumbers, DesignedDither, LeastDitherFound};
use super::study_with_design::StudyWithDesign;
use crate::run::waveforms::label;
use quell_dynamics::response::wave_reaches_the_band;

/// A dither of an answer, and operating points at which the answer says that it is quiet.
pub(super) struct ClaimedDither<'a> {
    /// Its amplitude.
    amplitude: f64,
    /// Values of the other design variables.
    others: &'a [f64],
    /// The operating points.
    pub(super) points: Vec<Vec<f64>>,
}

impl<'a> ClaimedDither<'a> {
    /// The dither that serves a part of the box: at both ends and in the middle.
    fn of_part(part: &'a CoveredBox) -> Self {
        let RealInterval { lower: low, upper: high } = part.ends;
        let points = [high, low, 0.5 * (low + high)].map(|value| vec![value]).to_vec();
        Self { amplitude: part.amplitude, others: &part.others, points }
    }
}

impl DesignNumbers {
    /// The verified dither: at the corners of the box and the operating point that decides, the fastest first, as a rule.
    pub(super) fn verified<'a>(&self, found: &'a FeasibleDesign) -> ClaimedDither<'a> {
        let mut points: Vec<Vec<f64>> = vec![Vec::new()];
        for number in &self.over {
            let ends = [number.range.upper, number.range.lower];
            let longer = |point: &Vec<f64>| ends.map(|end| [point.as_slice(), &[end]].concat());
            points = points.iter().flat_map(longer).collect();
        }
        points.extend(found.critical.worst.clone());
        ClaimedDither {
            amplitude: found.verified_amplitude,
            others: &found.critical.others,
            points,
        }
    }

    /// A dither at an operating point, as numbers of the study.
    pub(super) fn at<'n>(
        &'n self,
        dither: &ClaimedDither<'_>,
        point: &[f64],
    ) -> Vec<(&'n str, f64)> {
        let others = self.others.iter().zip(dither.others.iter().copied());
        let at = self.over.iter().zip(point.iter().copied());
        let amplitude = [(&self.amplitude, dither.amplitude)];
        others.chain(at).chain(amplitude).map(in_units).collect()
    }

    /// Whether a dither repeats in the band of the vibration.
    pub(super) fn is_slow(
        &self,
        dither: &ClaimedDither<'_>,
        waveform: &Waveform,
        study: &dyn StudyWithDesign,
    ) -> bool {
        let reaches = |point: &Vec<f64>| {
            let system = study.system_with(waveform, &self.at(dither, point));
            system.is_ok_and(|system| wave_reaches_the_band(&system))
        };
        dither.points.iter().any(reaches)
    }

    /// Warnings where a dither takes the slip out of the range of a law.
    pub(super) fn beyond_laws(
        &self,
        dither: &ClaimedDither<'_>,
        waveform: &Waveform,
        study: &dyn StudyWithDesign,
    ) -> Vec<String> {
        let points = dither.points.iter();
        let mut warned = points.map(|point| study.beyond_laws(waveform, &self.at(dither, point)));
        warned.find(|warnings| !warnings.is_empty()).unwrap_or_default()
    }
}

impl LeastDitherFound {
    /// The dither of the answer: the verified one, or the one that serves a part of the box.
    pub(super) fn claimed(&self, numbers: &DesignNumbers) -> Option<ClaimedDither<'_>> {
        match &self.answer().answer {
            Ok(found) => Some(numbers.verified(found)),
            Err(_) => self.covered.as_ref().ok().map(ClaimedDither::of_part),
        }
    }

    /// Warnings about dithers that are not fast: the one of the answer, and those that are not called least.
    pub(super) fn warnings_about_slow_ones(&self) -> Vec<String> {
        let band = format!("at or below {BAND_END} times the frequency of the vibration");
        if self.slow.is_some() {
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
