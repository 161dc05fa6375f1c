//! The dither that is quiet in a share of random samples, as a sentence and as JSON.

use quell_design::least_dither::DesignObjective;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use super::answer::{limit_in_words, quantity_of};
use super::found::LeastDitherFound;
use super::study_with_design::StudyWithDesign;
use crate::fields::Fields;
use crate::words::digits;

impl LeastDitherFound {
    /// The dither of the share of samples that is asked for, in a sentence; `None` where none is.
    pub(super) fn confident_in_words(&self, study: &dyn StudyWithDesign) -> Option<String> {
        let asked = study.asked().and_then(|asked| asked.confidence);
        let found = match (asked, &self.confident) {
            (_, Ok(found)) => found,
            (None, Err(_)) => return None,
            (Some(asked), Err(why)) => {
                let share = digits(100.0 * asked.share);
                return Some(format!(
                    "An amplitude that is quiet in {share} % of the samples is unknown: {why}."
                ));
            }
        };
        let force = |value: f64| study.in_words(study.quantity_of_amplitude(), value);
        let RealInterval { lower: low, upper: high } = found.interval;
        let high =
            if high.is_finite() { format!("to {}", force(high)) } else { "upwards".to_owned() };
        let others = self.chosen_in_words(&found.dither.others);
        let beyond = match found.tightest() {
            Some((quantity, used)) if !found.is_allowed() => {
                format!(
                    ", but the {} would be {} times its limit",
                    limit_in_words(quantity),
                    digits(used)
                )
            }
            _ => String::new(),
        };
        Some(format!(
            "An amplitude of {}{others} is quiet in {} % of {} samples (95 % interval {} {high}), {} times the least one{beyond}.",
            force(found.dither.amplitude),
            digits(100.0 * found.confidence.share),
            found.confidence.samples,
            force(low),
            digits(found.dither.amplitude / found.least),
        ))
    }

    /// What a reader must know of the samples.
    pub(super) fn warnings_about_samples(&self) -> Vec<String> {
        let Ok(found) = &self.confident else { return Vec::new() };
        let of = |count: usize| format!("{count} of {} samples", found.confidence.samples);
        let mut warnings = Vec::new();
        if let (count, Some(why)) = &found.invalid {
            warnings.push(format!(
                "{} are no valid studies and are left out. The first: {why}",
                of(*count)
            ));
        }
        if let (count, Some(why)) = &found.unknown {
            warnings.push(format!(
                "the least amplitude of {} is unknown; they count as loud. The first: {why}",
                of(*count)
            ));
        }
        if found.loud_again > 0 {
            warnings.push(format!(
                "{} are quiet at a smaller amplitude and, by averaging, loud again at the one that is enough for the others: fewer samples \
                 are quiet than asked for",
                of(found.loud_again)
            ));
        }
        warnings
    }

    /// Adds `confident`.
    pub(super) fn put_confident(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        minimise: DesignObjective,
    ) {
        let found = match &self.confident {
            Ok(found) => found,
            Err(why) => {
                fields.unknown("confident", why);
                return;
            }
        };
        let quantity = study.quantity_of_amplitude();
        let RealInterval { lower: low, upper: high } = found.interval;
        let high = if high.is_finite() {
            Ok(high)
        } else {
            Err("samples that are never quiet lie within the interval")
        };
        let mut inner = study.fields();
        inner
            .measured("confidence", "1", found.confidence.share)
            .plain("samples", found.confidence.samples)
            .plain("seed", found.confidence.seed)
            .plain("parameters", self.by_path(found.dither.amplitude, &found.dither.others))
            .number("amplitude", quantity, found.dither.amplitude)
            .number("low", quantity, low)
            .known("high", quantity, high)
            .measured("over_least", "1", found.dither.amplitude / found.least)
            .known("objective", quantity_of(study, minimise), found.dither.objective.clone())
            .plain("allowed", found.is_allowed());
        let used = found.dither.used.iter().map(|(quantity, used)| {
            let mut inner = study.fields();
            inner.plain("limit", quantity.name()).known("used", Quantity::Ratio, used.clone());
            inner
        });
        inner
            .list("limits", used.collect::<Vec<_>>())
            .plain("exact", found.exact)
            .plain("never_quiet", found.never)
            .plain("loud_again", found.loud_again)
            .plain("unknown", found.unknown.0)
            .plain("invalid", found.invalid.0);
        fields.nested("confident", inner);
    }
}
