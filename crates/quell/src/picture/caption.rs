//! Captions: law, belt, dither and initial state of a study in one line.

use std::borrow::Cow;

use quell_model::Waveform;
use quell_model::disc::DiscDither;

use super::ruler::short;
use crate::run::check::damping_ratios;
use crate::study::disc::ModeSource;
use crate::study::{DiscStudy, Kind, Study, StudyKind, StudyOf, SystemStudy};
use crate::words::plural;

/// A disc study in one line.
pub(super) fn disc_caption(study: &DiscStudy) -> String {
    let disc = study.disc();
    let mut parts = Vec::new();
    match study.source() {
        ModeSource::Plate(plate) => parts.push(format!(
            "plate $b$/$a$ = {}, $ν$ = {}, $N$ = ({}, {})",
            plate.plate.inner_radius_ratio(),
            plate.plate.poisson_ratio(),
            plate.radial_modes,
            plate.nodal_diameters
        )),
        _ => parts.push(format!("{} given modes", disc.modes().len())),
    }
    if let Some(damping) = disc.modal_damping() {
        parts.push(format!("$ξ$ = {}", short(damping)));
    }
    for (load, radius) in disc.loads().iter().zip(study.radii()) {
        let place = radius.map_or_else(String::new, |radius| format!(" at $r_0$/$a$ = {radius}"));
        let phase = match load.dither_phase {
            0.0 => String::new(),
            phase => format!(", $φ$ = {}°", short(phase.to_degrees())),
        };
        parts.push(format!(
            "load $m$ = {}, $c$ = {}, $k$ = {}, $f$ = {}{phase}{place}",
            short(load.mass),
            short(load.damping),
            short(load.stiffness),
            short(load.friction)
        ));
    }
    let wave = match disc.waveform() {
        Waveform::Sine => String::new(),
        other => format!("{} ", other.name()),
    };
    let dither = match disc.dither() {
        DiscDither::None => "no dither".to_owned(),
        DiscDither::Normal { amplitude, frequency_ratio } => {
            format!("normal {wave}dither, $α$ = {amplitude}, $R$ = {frequency_ratio}")
        }
        DiscDither::Tangential { amplitude, frequency_ratio } => {
            format!("tangential {wave}dither, $α$ = {amplitude}, $R$ = {frequency_ratio}")
        }
    };
    parts.push(dither);
    if disc.envelope().is_some() {
        parts.push("its amplitude varies in time".to_owned());
    }
    if disc.drive().is_some() {
        parts.push("$Ω$ varies in time".to_owned());
    }
    if disc.loads().iter().any(|load| load.share.is_some()) {
        parts.push("the load varies in time".to_owned());
    }
    let without = study.without();
    if !without.is_empty() {
        parts.push(format!("without {}", without.join(", ")));
    }
    format!("{}.", parts.join(", "))
}

/// A number of a study that a picture varies: its path, and the ends of its range.
pub(super) type VariedNumber<'a> = (Cow<'a, str>, f64, f64);

/// A caption of a study, in which "varied" stands for every value that changes over these ranges.
pub(super) fn with_varied<K: StudyKind + Into<Kind>>(
    study: &StudyOf<K>,
    caption: impl Fn(&StudyOf<K>) -> String,
    ranges: &[VariedNumber],
) -> String {
    ranges.iter().fold(caption(study), |text, (path, from, to)| {
        match (study.with(path, *from), study.with(path, *to)) {
            (Ok(first), Ok(last)) => where_equal(&text, &caption(&first), &caption(&last)),
            _ => text,
        }
    })
}

/// The caption of a system, in which "varied" stands for the numbers that are varied.
pub(super) fn caption_of_varied(study: &SystemStudy, ranges: &[VariedNumber]) -> String {
    ranges.iter().fold(caption(study), |text, (path, from, to)| {
        let at = |value: f64| {
            let parameter = study.model().parameter(path).ok()?;
            Some(caption(&study.varied(&[(parameter, value)]).ok()?))
        };
        match (at(*from), at(*to)) {
            (Some(first), Some(last)) => where_equal(&text, &first, &last),
            _ => text,
        }
    })
}

/// The text, in which "varied" stands for the values that differ between two other texts of the same items.
fn where_equal(text: &str, one: &str, other: &str) -> String {
    const SEPARATOR: &str = ", ";
    let items = |text: &str| text.split(SEPARATOR).map(str::to_owned).collect::<Vec<String>>();
    let (mut shown, first, last) = (items(text), items(one), items(other));
    if shown.len() != first.len() || shown.len() != last.len() {
        return text.to_owned();
    }
    for ((item, one), other) in shown.iter_mut().zip(&first).zip(&last) {
        if one != other
            && let Some((name, value)) = item.split_once(" = ")
        {
            let ends = [";", ". ", " at "].iter().filter_map(|end| value.find(end));
            let whole = value.strip_suffix('.').unwrap_or(value).len();
            let end = ends.min().unwrap_or(whole);
            *item = format!("{name} varied{}", &value[end..]);
        }
    }
    shown.join(SEPARATOR)
}

/// The caption of a study of a system.
pub(super) fn caption(study: &SystemStudy) -> String {
    let size = study.system().structure.size();
    let coordinates = format!("{size} coordinate{}", plural(size));
    let mut parts = vec![match damping_ratios(study).as_deref() {
        Some([ratio]) => format!("{coordinates}, $ζ$ = {}", short(*ratio)),
        _ => coordinates,
    }];
    parts.extend(super::sketch::contacts_and_dithers(study));
    format!("{}.", parts.join(". "))
}

/// The caption of a study of any kind.
pub(super) fn caption_of(study: &Study) -> String {
    match study.disc() {
        Ok(disc) => disc_caption(&disc),
        Err(_) => caption(&study.system()),
    }
}

#[cfg(test)]
mod tests {
    use super::where_equal;

    #[test]
    fn varied_values_are_named_and_the_others_stay() {
        let text = "Load $m$ = 2, $k$ = 0.5 at $r$ = 1, $D$ = 3; from rest.";
        let changed = |k: &str, d: &str| text.replace("0.5", k).replace("3;", d);
        let shown = where_equal(text, &changed("1", "1;"), &changed("2", "1;"));
        assert_eq!(shown, "Load $m$ = 2, $k$ varied at $r$ = 1, $D$ = 3; from rest.");
        let shown = where_equal(text, &changed("1", "1;"), &changed("1", "2;"));
        assert_eq!(shown, "Load $m$ = 2, $k$ = 0.5 at $r$ = 1, $D$ varied; from rest.");
        assert_eq!(where_equal("$D$ = 3.", "$D$ = 4.", "$D$ = 5."), "$D$ varied.");
        assert_eq!(where_equal("a, b = 1", "b = 2", "b = 3"), "a, b = 1");
    }
}
