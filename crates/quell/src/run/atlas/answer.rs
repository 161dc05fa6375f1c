//! The answer of `atlas`: sentence, warnings and JSON.

use std::fmt::Write as _;

use quell_design::atlas::{AtlasChange, AtlasErrors, AtlasLaw, AtlasRange, RANGE, WAVEFORMS};
use quell_model::Waveform;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::{AtlasFound, AtlasTables, ExactChange};
use crate::fields::Fields;
use crate::study::BeltStudy;
use crate::words::{in_words, plural};

/// Why a difference has no value without the continuation.
const NOT_REQUESTED: &str = "computed on request (exact)";

/// Why a difference of tables has no value.
const SHIPPED: &str = "not recomputed";

/// Why an error has no value.
const REMOVABLE: &str =
    "within the errors of the tables this change may not exist; the exact computation decides";

/// An error or a difference with two digits.
pub(crate) fn short_error(value: f64) -> String {
    quell_model::digits::digits(value, 2)
}

impl AtlasFound {
    /// The amplitude D of a number in v_m.
    pub(crate) fn amplitude(&self, relative: f64) -> f64 {
        self.reference_velocity * relative
    }

    /// The exact change that a change of the table stands for: the nearest of the same direction.
    ///
    /// # Errors
    /// Why no exact change is known.
    pub(crate) fn exact_of(&self, change: &AtlasChange) -> Result<ExactChange, String> {
        let found = self.exact.as_ref().ok_or(NOT_REQUESTED)?.as_ref().map_err(Clone::clone)?;
        let amplitude = self.amplitude(change.amplitude);
        let alike = found.iter().filter(|exact| exact.becomes_quiet == change.becomes_quiet);
        let distance = |exact: &ExactChange| (exact.amplitude - amplitude).abs();
        let nearest = alike.min_by(|a, b| distance(a).total_cmp(&distance(b))).copied();
        nearest.ok_or_else(|| "the continuation finds no such change".to_owned())
    }

    /// Whether the continuation finds the changes of the table; `None` where it was not requested or found no response.
    pub(crate) fn agrees(&self) -> Option<bool> {
        let found = self.exact.as_ref()?.as_ref().ok()?;
        let directions = found.iter().map(|exact| exact.becomes_quiet);
        Some(directions.eq(self.answer.changes.iter().map(|change| change.becomes_quiet)))
    }

    fn in_words(&self, study: &BeltStudy, relative: f64) -> String {
        let symbol = if study.scales().is_some() { "" } else { "D = " };
        format!("{symbol}{}", in_words(study, Quantity::Force, self.amplitude(relative)))
    }

    /// A change with its error.
    fn change_in_words(&self, study: &BeltStudy, change: &AtlasChange) -> String {
        let error = change.relative_error().map_or_else(
            || "error unknown".to_owned(),
            |error| format!("relative error at most {}", short_error(error)),
        );
        let amplitude = self.in_words(study, change.amplitude);
        format!("{amplitude} ({}, {error})", change.kind.name())
    }

    /// The result in a few sentences.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let mut text = String::new();
        let changes = &self.answer.changes;
        let words = |change: &AtlasChange| self.change_in_words(study, change);
        match (self.answer.lost(), self.answer.last()) {
            (None, None) => text.push_str(
                "By the atlas steady sliding is stable without dither, and no amplitude destabilises it.",
            ),
            (None, Some(last)) => {
                let _ = write!(text, "By the atlas the base response is stable from {} on and unstable below.", words(last));
            }
            (Some(lost), Some(last)) if changes.len() == 2 => {
                let _ = write!(
                    text,
                    "By the atlas steady sliding is stable without dither; dither destabilises the base response from {} on and \
                     quenches from {} on.",
                    words(lost),
                    words(last)
                );
            }
            (_, last) => {
                let _ = write!(text, "By the atlas the verdict on the base response changes {} times", changes.len());
                if let Some(last) = last {
                    let _ = write!(text, "; it is stable from {} on", words(last));
                }
                text.push('.');
            }
        }
        match (self.agrees(), self.largest_difference()) {
            (Some(true), Some(difference)) => {
                let _ = write!(
                    text,
                    " The exact amplitude{} differ{} by at most {} of the amplitude.",
                    plural(changes.len()),
                    if changes.len() == 1 { "s" } else { "" },
                    short_error(difference)
                );
            }
            (Some(true), None) => text.push_str(" The exact computation agrees."),
            (Some(false), _) => {
                text.push_str(" The exact computation finds other changes.");
            }
            (None, _) => {}
        }
        text
    }

    /// The largest relative difference from the exact amplitudes, where there are any.
    pub(crate) fn largest_difference(&self) -> Option<f64> {
        let differences = self.answer.changes.iter().filter_map(|change| {
            let exact = self.exact_of(change).ok()?;
            Some((self.amplitude(change.amplitude) / exact.amplitude - 1.0).abs())
        });
        differences.reduce(f64::max)
    }

    /// Warnings: amplitudes that depend strongly on the errors of the tables, and slip beyond the range of the law.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let mut warnings = Vec::new();
        for change in self.answer.changes.iter().filter(|change| change.is_sensitive()) {
            let amplitude = self.in_words(study, change.amplitude);
            warnings.push(match change.relative_error() {
                Some(error) => format!(
                    "the change at {amplitude} is sensitive: the errors of the tables can move it by {} of the amplitude; the exact \
                     computation (exact) has no such error",
                    short_error(error)
                ),
                None => format!(
                    "the change at {amplitude} is uncertain: within the errors of the tables it may not exist; the exact computation \
                     (exact) decides"
                ),
            });
        }
        if self.answer.may_change_more {
            warnings.push(
                "within the errors of the tables the verdict may change at further amplitudes; the exact computation (exact) decides"
                    .to_owned(),
            );
        }
        if self.agrees() == Some(false) {
            warnings.push(
                "the exact computation finds other changes than the tables; it is right".to_owned(),
            );
        }
        let fastest = 2.0 * study.belt().belt_velocity();
        if let Some(range) = study.belt().friction().range().filter(|range| fastest > range.upper) {
            warnings.push(format!(
                "at the grazing slip reaches about {}, beyond {} ({})",
                in_words(study, Quantity::Velocity, fastest),
                in_words(study, Quantity::Velocity, range.upper),
                range.limit
            ));
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let answer = &self.answer;
        let point = &answer.point;
        let mut fields = Fields::new(study.scales());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("law", point.law.name())
            .plain("waveform", point.waveform.name())
            .number("relative_damping", Quantity::Ratio, point.relative_damping)
            .number("relative_velocity", Quantity::Ratio, point.relative_velocity)
            .number("frequency_ratio", Quantity::Ratio, point.frequency_ratio)
            .number("friction_damping", Quantity::Ratio, point.friction_damping)
            .number("friction_damping_per_cycle", Quantity::Ratio, point.damping_per_cycle())
            .number("reference_velocity", Quantity::Velocity, self.reference_velocity)
            .number("neutral_damping_without_dither", Quantity::Ratio, answer.neutral_without)
            .plain("quiet_without", answer.quiet_without)
            .plain("quiet", answer.is_quiet(self.own_amplitude / self.reference_velocity));
        let mut grazing = Fields::new(study.scales());
        self.amplitudes(&mut grazing, answer.grazing.0);
        grazing.number("relative_error", Quantity::Ratio, answer.grazing.1 / answer.grazing.0);
        fields.nested("grazing", grazing);
        let quench = answer.last().map(|change| self.amplitude(change.amplitude));
        let quench = quench.ok_or_else(|| "every amplitude is quiet".to_owned());
        fields.known("quench_amplitude", Quantity::Force, quench);
        let lost = answer.lost().map(|change| self.amplitude(change.amplitude));
        let why = if answer.quiet_without {
            "no amplitude destabilises steady sliding"
        } else {
            "steady sliding is unstable without dither, and what is quenched stays quiet"
        };
        fields.known("lost_amplitude", Quantity::Force, lost.ok_or_else(|| why.to_owned()));
        fields
            .list("changes", answer.changes.iter().map(|change| self.change_fields(study, change)));
        let why = match &self.exact {
            Some(Err(why)) => why.as_str(),
            _ => NOT_REQUESTED,
        };
        match self.agrees() {
            Some(agrees) => fields.plain("exact_agrees", agrees),
            None => fields.unknown("exact_agrees", why),
        };
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// An amplitude as D and α, in the units of the study and over v_m.
    fn amplitudes(&self, fields: &mut Fields, relative: f64) {
        let ratio = self.answer.point.frequency_ratio;
        fields
            .number("amplitude", Quantity::Force, self.amplitude(relative))
            .number("relative_amplitude", Quantity::Ratio, relative)
            .number("relative_amplitude_ratio", Quantity::Ratio, relative / ratio);
    }

    fn change_fields(&self, study: &BeltStudy, change: &AtlasChange) -> Fields {
        let mut inner = Fields::new(study.scales());
        self.amplitudes(&mut inner, change.amplitude);
        let error = change.relative_error().ok_or_else(|| REMOVABLE.to_owned());
        let exact = self.exact_of(change).map(|exact| exact.amplitude);
        let difference = exact.clone().map(|exact| self.amplitude(change.amplitude) / exact - 1.0);
        inner
            .plain("kind", change.kind.name())
            .plain("becomes_quiet", change.becomes_quiet)
            .known("relative_error", Quantity::Ratio, error)
            .plain("sensitive", change.is_sensitive())
            .known("exact_amplitude", Quantity::Force, exact)
            .known("relative_difference", Quantity::Ratio, difference);
        inner
    }
}

impl AtlasTables {
    /// Number of values.
    pub(crate) fn values(&self) -> usize {
        self.atlas.tables.iter().map(|table| table.values.len()).sum()
    }

    /// The largest difference of a recomputed value from the shipped one; `None` if nothing was recomputed.
    pub(crate) fn largest_difference(&self) -> Option<f64> {
        let differences = self.differences.as_ref()?.iter();
        differences.map(|difference| difference.largest).reduce(f64::max)
    }

    /// The nodes without an exact value; `None` if nothing was recomputed.
    pub(crate) fn missing(&self) -> Option<usize> {
        Some(self.differences.as_ref()?.iter().map(|difference| difference.missing).sum())
    }

    /// The result in a few sentences.
    pub fn sentence(&self) -> String {
        let AtlasRange { relative_damping, frequency_ratio, damping_per_cycle, .. } = RANGE;
        let laws: Vec<&str> = AtlasLaw::ALL.into_iter().map(AtlasLaw::name).collect();
        let waveforms: Vec<&str> = WAVEFORMS.iter().map(Waveform::name).collect();
        let mut text = format!(
            "The atlas has {} exact values for the laws {} under {} dither, and answers for κ from {} to {}, R from {} to {} and \
             ζ_f/R up to {}.",
            self.values(),
            laws.join(", "),
            waveforms.join(", "),
            relative_damping.0,
            relative_damping.1,
            frequency_ratio.0,
            frequency_ratio.1,
            damping_per_cycle.1
        );
        if let (Some(largest), Some(missing)) = (self.largest_difference(), self.missing()) {
            let _ =
                write!(text, " Recomputed, its values differ by at most {}", short_error(largest));
            if missing > 0 {
                let _ = write!(text, "; {missing} could not be recomputed");
            }
            text.push('.');
        }
        text
    }

    /// As JSON.
    pub fn json(&self) -> Json {
        let mut fields = Fields::new(None);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence())
            .plain("laws", AtlasLaw::ALL.map(AtlasLaw::name).to_vec())
            .plain("waveforms", WAVEFORMS.iter().map(Waveform::name).collect::<Vec<_>>())
            .plain("values", self.values());
        fields.nested("least", range_fields(|range| range.0));
        fields.nested("most", range_fields(|range| range.1));
        fields.list("errors", self.atlas.errors.iter().map(error_fields));
        let difference = self.largest_difference().ok_or_else(|| SHIPPED.to_owned());
        fields.known("largest_difference", Quantity::Ratio, difference);
        match self.missing() {
            Some(missing) => fields.plain("missing", missing),
            None => fields.unknown("missing", SHIPPED),
        };
        fields.plain("warnings", Vec::<String>::new());
        fields.finish()
    }
}

/// One end of the range of each group.
fn range_fields(end: fn((f64, f64)) -> f64) -> Fields {
    let AtlasRange { relative_damping, velocity_share, frequency_ratio, damping_per_cycle } = RANGE;
    let mut inner = Fields::new(None);
    inner
        .number("relative_damping", Quantity::Ratio, end(relative_damping))
        .number("velocity_share", Quantity::Ratio, end(velocity_share))
        .number("frequency_ratio", Quantity::Ratio, end(frequency_ratio))
        .number("friction_damping_per_cycle", Quantity::Ratio, end(damping_per_cycle));
    inner
}

fn error_fields(errors: &AtlasErrors) -> Fields {
    let mut inner = Fields::new(None);
    let [median, high, largest] = errors.quantiles;
    inner
        .plain("law", errors.law.name())
        .plain("waveform", errors.waveform.name())
        .plain("surface", errors.surface.name())
        .number("from", Quantity::Ratio, errors.band.0)
        .number("to", Quantity::Ratio, errors.band.1)
        .plain("points", errors.points)
        .number("median", Quantity::Ratio, median)
        .number("quantile_90", Quantity::Ratio, high)
        .number("largest", Quantity::Ratio, largest)
        .number("stated", Quantity::Ratio, errors.stated());
    inner
}
