//! `check`: the values of a valid study.

use quell_model::profile::{Profile, Wave};
use quell_model::system::{InputTarget, System};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::Presented;
use super::table::{TextTable, figure, figure_in_units};
use crate::noise::lines_in_words;
use crate::run::{check, disc, law};
use crate::study::{
    DiscSetup, DiscStudy, GivenSize, StudyOf, SystemSetup, SystemStudy, UnitSystem,
};
use crate::words::{quantity_at, unit_after};

/// Marks a valid study; the answer of `check` follows from the study alone.
#[derive(Clone, Copy, Debug)]
pub struct Valid;

impl Presented<DiscSetup> for Valid {
    const NAME: &'static str = "check";
    const TITLED: bool = true;

    fn json(&self, study: &DiscStudy) -> Json {
        disc::check::json(study)
    }

    fn sentence(&self, study: &DiscStudy) -> Option<String> {
        Some(disc::check::sentence(study))
    }

    fn table(&self, study: &DiscStudy) -> String {
        disc_table(study)
    }
}

impl Presented<SystemSetup> for Valid {
    const NAME: &'static str = "check";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        check::json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(check::sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        system_table(study)
    }
}

/// A size with its key, and what makes it a force.
fn size_in_words(given: &GivenSize, force: &str) -> String {
    let unit = if given.key.unit.is_empty() { force } else { given.key.unit };
    let space = if unit.is_empty() { "" } else { " " };
    let by = if given.key.needs_actuator() { ", by [actuator]" } else { "" };
    format!("{} = {}{space}{unit}{by}", given.path, figure(given.value))
}

fn axes<K>(table: &mut TextTable, study: &StudyOf<K>) {
    for sweep in study.sweeps() {
        let (first, last) = (sweep.axis.value(0), sweep.axis.value(usize::MAX));
        let points = sweep.axis.len();
        let unit = unit_after(Some(sweep.target.unit));
        let number = quantity_at(&sweep.path);
        table.word("axis", &format!("{number} from {first} to {last}{unit}, {points} points"));
    }
}

fn system_table(study: &SystemStudy) -> String {
    let system = study.system();
    let mut table = TextTable::default();
    table.word("units", study.units().name());
    let names = system.structure.names();
    let listed = names.iter().take(12).cloned().collect::<Vec<_>>().join(", ");
    let rest = if names.len() > 12 { ", …" } else { "" };
    table.word("coordinates", &format!("{}: {listed}{rest}", names.len()));
    let with = |quantity, value| figure_in_units(study.units(), quantity, value);
    let over_time = |quantity: Quantity, profile: &Profile| {
        let RealInterval { lower: least, upper: largest } = profile.bounds();
        if least == largest {
            return with(quantity, least);
        }
        format!("over time from {} to {}", with(quantity, least), with(quantity, largest))
    };
    if let Some([ratio]) = check::damping_ratios(study).as_deref() {
        table.word("damping ratio ζ", &figure(*ratio));
    }
    for contact in &system.contacts {
        let words = format!(
            "{}, normal load {}, belt velocity {}, {}",
            contact.name,
            over_time(Quantity::Force, &contact.load()),
            over_time(Quantity::Velocity, &contact.surface_velocity),
            contact.friction.kind().name()
        );
        table.word("contact", &words);
        let law = &contact.friction;
        for (parameter, value) in law.kind().parameters().iter().zip(law.values()) {
            let label = format!("  {} {}", parameter.key().replace('_', " "), parameter.symbol);
            table.word(&label, &with(parameter.quantity, value));
        }
        for (label, words) in law::words(law, &|speed| with(Quantity::Velocity, speed)) {
            table.word(&format!("  {}", label.trim_start()), &words);
        }
        if let Some((stiffness, breakaway)) = contact.tangential_stiffness.zip(contact.breakaway())
        {
            table.word("  tangential stiffness k_t", &with(Quantity::Stiffness, stiffness));
            table.word("    breakaway", &with(Quantity::Displacement, breakaway));
        }
    }
    let waves = system
        .inputs
        .iter()
        .flat_map(|input| input.profile.waves().iter().map(|wave| (&input.target, wave)));
    for (target, wave) in waves {
        let words = format!(
            "{} {}, amplitude {}{}, {}",
            wave.waveform.name(),
            place_in_words(system, target),
            with(Quantity::Force, wave.amplitude),
            if wave.envelope.is_some() { " times its envelope" } else { "" },
            frequency_of(study.units(), wave)
        );
        table.word("dither", &words);
    }
    for given in study.given_sizes() {
        let force = study.units().unit(Quantity::Force).unwrap_or_default();
        let words = size_in_words(given, force);
        table
            .word("amplitude", &format!("{} from {words}", with(Quantity::Force, given.amplitude)));
    }
    axes(&mut table, study);
    table.text()
}

/// Where a dither acts.
fn place_in_words(system: &System, target: &InputTarget) -> String {
    let name = |contact: usize| system.contacts.get(contact).map_or("", |known| &known.name);
    match target {
        InputTarget::Force(row) => {
            let names = system.structure.names().iter().zip(row);
            let driven = names.filter(|(_, share)| **share != 0.0).map(|(name, _)| name.as_str());
            format!("on {}", driven.collect::<Vec<_>>().join(", "))
        }
        InputTarget::NormalLoad { contact, .. } => format!("of the load of {}", name(*contact)),
        InputTarget::Friction { contact } => format!("of the friction of {}", name(*contact)),
    }
}

/// The frequency of a wave, of noise its band.
fn frequency_of(units: UnitSystem, wave: &Wave) -> String {
    let of = |frequency: f64| match units {
        UnitSystem::None => figure(frequency),
        _ => figure(frequency / std::f64::consts::TAU),
    };
    let noise = wave.waveform.noise().map(|noise| {
        let [low, high] = noise.band(wave.frequency).map(of);
        (format!("{low} to {high}"), format!(" ({})", lines_in_words(noise)))
    });
    let (range, lines) = noise.unwrap_or_else(|| (of(wave.frequency), String::new()));
    match units {
        UnitSystem::None => format!("angular frequency {range}{lines}"),
        _ => format!("{range} Hz{lines}"),
    }
}

fn disc_table(study: &DiscStudy) -> String {
    let object = disc::check::json(study);
    let mut table = TextTable::default();
    let word = |value: &Json| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    table.word(
        "modes",
        &format!("{}, from the {}", object["disc"]["modes"], word(&object["disc"]["modes_from"])),
    );
    let disc = &object["disc"];
    let unit = |name: &str| word(&disc["units"][name]);
    if study.disc().drive().is_none() {
        table.word("speed Ω", &format!("{} {}", disc["speed"], unit("speed")));
    } else {
        let (least, largest) = (&disc["least_speed"], &disc["largest_speed"]);
        let words = format!("{least} to {largest} {}", unit("least_speed"));
        table.word("speed Ω, over time", &words);
    }
    for (index, load) in object["disc"]["loads"].as_array().into_iter().flatten().enumerate() {
        let words: Vec<String> = load
            .as_object()
            .into_iter()
            .flatten()
            .filter(|(name, _)| *name != "units")
            .map(|(name, value)| {
                let unit = load["units"][name].as_str().filter(|unit| !unit.starts_with('1'));
                let unit = unit.map_or_else(String::new, |unit| format!(" {unit}"));
                format!("{} {value}{unit}", quantity_at(name))
            })
            .collect();
        table.word(&format!("load {index}"), &words.join(", "));
    }
    if object["dither"].is_object() {
        let dither = &object["dither"];
        let words = format!(
            "{}, amplitude {}, frequency ratio {}",
            word(&dither["direction"]),
            dither["amplitude"],
            dither["frequency_ratio"]
        );
        table.word("dither", &words);
    }
    for given in study.given_sizes() {
        let words =
            format!("{} of the load from {}", figure(given.amplitude), size_in_words(given, ""));
        table.word("amplitude", &words);
    }
    let without = study.without();
    if !without.is_empty() {
        table.word("without", &without.join(", "));
    }
    axes(&mut table, study);
    table.text()
}
