//! The response to a least dither that repeats in the band of the vibration: what remains there, and the tone that replaces the vibration.
//!
//! Such a dither may be followed in step, and shake the structure as much as the vibration that it quenches. E is that of `response`, started
//! on the base response.

use quell_dynamics::response::{Peak, SUPPRESSED};
use quell_model::units::Quantity;

use super::found::{DesignNumbers, LeastDitherFound};
use super::slow_response::LargestSlowResponse;
use super::study_with_design::StudyWithDesign;
use super::unknown::{NoSlowLevel, NoSlowResponse};
use crate::fields::Fields;
use crate::run::effect_words::{level_of, percent};

/// The keys of [`LeastDitherFound::put_slow`].
pub(super) const OF_SLOW: [&str; 5] =
    ["quiet", "residual_vibration", "level_db", "tone_frequency", "tone_amplitude"];

impl LeastDitherFound {
    /// The largest response to the dither of the answer at the operating points of its claim, where it repeats in the band of the
    /// vibration.
    pub(super) fn slow_response(
        &self,
        numbers: &DesignNumbers,
        study: &dyn StudyWithDesign,
    ) -> Option<Result<LargestSlowResponse, NoSlowResponse>> {
        let dither = self.claimed(numbers)?;
        if !numbers.is_slow(&dither, self.waveform(), study) {
            return None;
        }
        let mut largest: Option<LargestSlowResponse> = None;
        let mut failed = None;
        for point in &dither.points {
            match study.slow_response(self.waveform(), &numbers.at(&dither, point)) {
                Ok(response)
                    if largest.as_ref().is_none_or(|known| {
                        response.residual_vibration > known.response.residual_vibration
                    }) =>
                {
                    largest = Some(LargestSlowResponse { response, point: point.clone() });
                }
                Ok(_) => {}
                Err(why) => failed = failed.or(Some(why)),
            }
        }
        Some(largest.ok_or(failed.unwrap_or(NoSlowResponse::NoPoints)))
    }

    /// Whether the dither of the answer is quiet: its response has no slow vibration, or one that is below a share of that without dither.
    ///
    /// # Errors
    /// Why it is unknown.
    pub(super) fn is_quiet(&self) -> Result<bool, NoSlowResponse> {
        match &self.slow {
            None => Ok(true),
            Some(Ok(slow)) => Ok(slow.response.residual_vibration < SUPPRESSED),
            Some(Err(why)) => Err(why.clone()),
        }
    }

    /// The residual vibration under a dither in the band of the vibration, as the end of a sentence; empty of other dithers.
    pub(super) fn residual_in_words(&self) -> String {
        let residual = match &self.slow {
            None => return String::new(),
            Some(Ok(slow)) => slow.response.residual_vibration,
            Some(Err(why)) => return format!("; it leaves an unknown residual vibration ({why})"),
        };
        let level = level_of(residual).map_or(String::new(), |level| format!(" ({level:.1} dB)"));
        format!("; it leaves a residual vibration of {}{level}", percent(residual))
    }

    /// Where that vibration is largest, and its tone, in a sentence; `None` of other dithers.
    pub(super) fn slow_in_words(&self, study: &dyn StudyWithDesign) -> Option<String> {
        let LargestSlowResponse { response, point } = self.slow.as_ref()?.as_ref().ok()?;
        let scale = study.frequency_scale();
        let [with, without] = response.tones.map(|tone| {
            let size = study.in_words(Quantity::Displacement, tone.amplitude);
            (scale.with_noun(tone.frequency), size)
        });
        Some(format!(
            "The residual vibration is that below {}{}: a tone at {} of {} in place of the vibration at {} of {}.",
            scale.with_noun(response.band_end),
            self.point_in_words(point),
            with.0,
            with.1,
            without.0,
            without.1
        ))
    }

    /// Adds `quiet`, the residual vibration and the tone.
    pub(super) fn put_slow(&self, fields: &mut Fields) {
        match self.is_quiet() {
            Ok(quiet) => fields.plain("quiet", quiet),
            Err(why) => fields.unknown("quiet", why),
        };
        let known = match &self.slow {
            None => Err(NoSlowResponse::AboveBand),
            Some(slow) => slow.as_ref().map(|slow| slow.response).map_err(Clone::clone),
        };
        let residual = match &self.slow {
            // Every line of the response is a multiple of the frequency at which the dither repeats.
            None => Ok(0.0),
            Some(_) => known.clone().map(|response| response.residual_vibration),
        };
        let level = residual.clone().map_err(NoSlowLevel::from);
        let level = level.and_then(|residual| level_of(residual).ok_or(NoSlowLevel::Zero));
        fields.known("residual_vibration", Quantity::Ratio, residual);
        fields.known("level_db", Quantity::Ratio, level);
        let tone = |of: fn(Peak) -> f64| known.clone().map(|response| of(response.tones[0]));
        fields.known("tone_frequency", Quantity::FrequencyRatio, tone(|tone| tone.frequency));
        fields.known("tone_amplitude", Quantity::Displacement, tone(|tone| tone.amplitude));
    }
}
