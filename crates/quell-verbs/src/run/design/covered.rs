//! The part of the box that one dither serves where none serves it all, in words and as JSON.

use quell_design::least_dither::{BeyondCovered, CoveredBox, NoCoveredBox};
use quell_model::units::Quantity;

use super::answer::limit_in_words;
use super::found::{DesignNumber, LeastDitherFound};
use super::study_with_design::StudyWithDesign;
use crate::fields::Fields;
use crate::words::{digits, plural, quantity_at};

impl LeastDitherFound {
    /// Whether a dither that is not known to be the least serves the whole box.
    pub(super) fn is_covered_whole(&self) -> bool {
        self.covered.as_ref().is_ok_and(CoveredBox::is_whole)
    }

    /// The part of the box that one dither serves, in words; empty where none is known.
    /// `is_larger` where the least amplitude exceeds a limit that this one keeps.
    pub(super) fn covered_in_words(&self, one: &str, is_larger: bool) -> String {
        let (Ok(part), Some(number)) = (&self.covered, self.over.first()) else {
            return String::new();
        };
        let [low, high] =
            [part.ends.lower, part.ends.upper].map(|end| digits(end * number.per_unit));
        let examined = format!(
            "{} point{} of that range that {} examined, at most {} apart",
            part.points,
            plural(part.points as u64),
            if part.points == 1 { "was" } else { "were" },
            digits(part.largest_gap * number.per_unit)
        );
        let is_quiet = self.is_quiet() == Ok(true);
        let leaves = self.residual_in_words();
        if part.is_whole() {
            let serves = match (is_quiet, is_larger) {
                (true, true) => format!(" A larger amplitude does: a {one} is quiet and keeps"),
                (true, false) => format!(" A {one} is quiet and keeps"),
                (false, _) => format!(" With a {one} the motion stays in step and keeps"),
            };
            let is_smallest = part.amplitude <= self.amplitude.range.lower;
            let smaller = if is_smallest { "" } else { "; a smaller amplitude may do so too" };
            return format!("{serves} every limit at all {examined}{leaves}{smaller}.");
        }
        let mut sides: Vec<String> = Vec::new();
        for ((side, end), beyond) in
            [("above", &high), ("below", &low)].into_iter().zip(part.beyond.iter().rev())
        {
            sides.push(format!("{side} {end} {}", beyond_in_words(beyond)));
        }
        let serves = if is_quiet {
            format!(" One {one} suffices")
        } else {
            format!(" With one {one} the motion stays in step")
        };
        format!(
            "{serves} for the {} from {low} to {high}, at all {examined}{leaves}; {}.",
            quantity_at(&number.path),
            sides.join("; ")
        )
    }

    /// Adds `covered`, `examined` and the dither to which they belong.
    pub(super) fn put_covered(&self, fields: &mut Fields, study: &dyn StudyWithDesign) {
        let part = match (&self.covered, self.over.first()) {
            (Ok(part), Some(number)) => Ok((part, number)),
            (Err(why), _) => Err(why.clone()),
            (_, None) => Err(NoCoveredBox::OnePoint.into()),
        };
        match part {
            Ok((part, number)) => {
                let ends = [part.ends.lower * number.per_unit, part.ends.upper * number.per_unit];
                let path = number.path.as_str();
                fields.plain("covered", serde_json::json!({ path: ends }));
                fields.nested("examined", examined(study, part, number));
                fields.plain("parameters", self.by_path(part.amplitude, &part.others));
            }
            Err(why) => {
                for name in ["covered", "examined", "parameters"] {
                    fields.unknown(name, &why);
                }
            }
        }
    }
}

/// What was examined of a part of the box, and what is known next to it.
fn examined(study: &dyn StudyWithDesign, part: &CoveredBox, number: &DesignNumber) -> Fields {
    let mut inner = study.fields();
    let gap = part.largest_gap * number.per_unit;
    inner.plain("points", part.points).number("largest_gap", Quantity::Ratio, gap);
    for (name, beyond) in ["below", "above"].into_iter().zip(&part.beyond) {
        match beyond {
            BeyondCovered::BoxEnds => inner.plain(name, "not examined"),
            BeyondCovered::Loud => inner.plain(name, "loud"),
            BeyondCovered::Exceeds(quantity) => inner.plain(name, quantity.name()),
            BeyondCovered::Unknown(why) => inner.unknown(name, why),
        };
    }
    inner
}

fn beyond_in_words(beyond: &BeyondCovered) -> String {
    match beyond {
        BeyondCovered::BoxEnds => "nothing was examined".to_owned(),
        BeyondCovered::Loud => "it vibrates".to_owned(),
        BeyondCovered::Exceeds(quantity) => {
            format!("the {} exceeds its limit", limit_in_words(*quantity))
        }
        BeyondCovered::Unknown(why) => {
            // The reason without its advice, which is for one response.
            let why = why.to_string();
            let why = why.split(';').next().unwrap_or_default();
            format!("it is unknown whether it suffices ({why})")
        }
    }
}
