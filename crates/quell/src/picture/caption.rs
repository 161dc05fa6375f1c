//! Captions: law, belt, dither and initial state of a study in one line.

use quell_model::Direction;
use quell_model::units::Quantity;

use super::ruler::{short, words};
use crate::study::disc::ModeSource;
use crate::study::{BeltStudy, DiscStudy, Kind, Study, SystemStudy};
use crate::words::{plural, start_in_words};

/// The study in one line.
pub(super) fn caption(study: &BeltStudy) -> String {
    let belt = study.belt();
    let law = belt.friction().kind();
    let mut parts = vec![
        format!("{} law", capitalised(law.name())),
        format!("$ζ$ = {}", short(belt.damping_ratio())),
    ];
    let load = if study.scales().is_some() { "N_0" } else { "F" };
    let velocity = if study.scales().is_some() { "V_0" } else { "v_0" };
    parts.push(format!("${load}$ = {}", words(study, Quantity::Force, belt.normal_load())));
    parts
        .push(format!("${velocity}$ = {}", words(study, Quantity::Velocity, belt.belt_velocity())));
    for (parameter, value) in law.parameters().iter().zip(belt.friction().values()) {
        parts.push(format!("${}$ = {}", parameter.symbol, words(study, parameter.quantity, value)));
    }
    for dither in belt.dithers() {
        let letter = match dither.direction {
            Direction::Tangential => "T",
            Direction::Normal => "N",
        };
        let (force, rate) = match study.scales() {
            Some(_) => (format!("A_{letter}"), format!("f_{letter}")),
            None => (format!("D_{letter}"), format!("R_{letter}")),
        };
        let phase = match dither.phase {
            0.0 => String::new(),
            phase => format!(", $φ$ = {phase}"),
        };
        parts.push(format!(
            "{} {} dither, ${force}$ = {}, ${rate}$ = {}{phase}",
            dither.direction.name(),
            dither.waveform.name(),
            words(study, Quantity::Force, dither.amplitude),
            words(study, Quantity::FrequencyRatio, dither.frequency_ratio),
        ));
    }
    parts.join(", ")
}

/// The study and its initial state in one line.
pub(super) fn caption_of_run(study: &BeltStudy) -> String {
    format!("{}; {}.", caption(study), start_in_words(study))
}

/// A disc study in one line.
pub(super) fn caption_of_disc(study: &DiscStudy) -> String {
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
    if let Some(damping) = disc.get("disc.modal_damping") {
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
    match disc.dither() {
        quell_model::disc::DiscDither::None => parts.push("no dither".to_owned()),
        quell_model::disc::DiscDither::Normal { amplitude, frequency_ratio } => {
            parts.push(format!("normal dither, $α$ = {amplitude}, $R$ = {frequency_ratio}"));
        }
        quell_model::disc::DiscDither::Tangential { amplitude, frequency_ratio } => {
            parts.push(format!("tangential dither, $α$ = {amplitude}, $R$ = {frequency_ratio}"));
        }
    }
    let without = study.without();
    if !without.is_empty() {
        parts.push(format!("without {}", without.join(", ")));
    }
    format!("{}.", parts.join(", "))
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// The caption of a study of a system.
pub(super) fn caption_of_system(study: &SystemStudy) -> String {
    let size = study.system().structure.size();
    let mut parts = vec![format!("{size} coordinate{}", plural(size))];
    parts.extend(super::sketch::contacts_and_dithers(study));
    format!("{}.", parts.join(". "))
}

/// The caption of a study of any kind.
pub(super) fn caption_of(study: &Study) -> String {
    match study.kind() {
        Kind::Belt(setup) => caption_of_run(&study.narrowed(setup.as_ref())),
        Kind::Disc(setup) => caption_of_disc(&study.narrowed(setup.as_ref())),
        Kind::System(setup) => caption_of_system(&study.narrowed(setup.as_ref())),
    }
}
