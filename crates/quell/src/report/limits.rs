//! What a report did not examine, as facts of its study.

use quell_model::units::Quantity;

use super::parts::{ReportedAnswer, Unexamined};
use super::plan::amplitude_of;
use crate::run::system::{frequency_in_words, in_units};
use crate::study::disc::ModeSource;
use crate::study::{DiscStudy, Study, SystemStudy};
use crate::words::{counted, digits};

/// The most names that are written of a list.
const MOST_NAMES: usize = 12;

/// What no verb of the report examines.
pub(super) fn of(study: &Study, answers: &[ReportedAnswer]) -> Vec<Unexamined> {
    let mut all = match study.disc() {
        Ok(disc) => about_waves(&disc),
        Err(_) => about_motions(&study.system(), answers),
    };
    all.extend(windows(answers));
    all.extend(amplitudes_of_zero(study));
    all.push(parameters(study));
    all
}

fn about_waves(study: &DiscStudy) -> Vec<Unexamined> {
    let disc = study.disc();
    let modes = disc.modes();
    let most = modes.iter().map(|mode| mode.diameters).max().unwrap_or(0);
    let highest = modes.iter().map(|mode| mode.ratio).fold(0.0, f64::max);
    let left_out = match study.source() {
        ModeSource::Plate(plate) => format!(
            "The model has {}: up to {} radial modes and {most} nodal diameters, up to the frequency ratio {}.",
            counted(modes.len(), "mode"),
            plate.radial_modes,
            digits(highest)
        ),
        _ => format!(
            "The model has the {}, up to {most} nodal diameters and the frequency ratio {}.",
            counted(modes.len(), "listed mode"),
            digits(highest)
        ),
    };
    let mut all = vec![
        Unexamined::new("Modes left out", left_out),
        Unexamined::new(
            "Large motions",
            "All verdicts are about small motions. How large an unstable motion becomes was not computed.",
        ),
    ];
    if study.design().is_none() {
        all.push(Unexamined::new(
            "Other speeds",
            format!(
                "The verdicts of `stability` hold at Ω = {} only; `quell map` computes maps over speed and friction.",
                digits(disc.speed())
            ),
        ));
    }
    let without = study.without();
    if !without.is_empty() {
        all.push(Unexamined::new(
            "Contributions left out",
            format!("The study leaves out {}.", without.join(", ")),
        ));
    }
    all
}

fn about_motions(study: &SystemStudy, answers: &[ReportedAnswer]) -> Vec<Unexamined> {
    let start =
        answers.iter().find(|answer| answer.verb == "response").map(|answer| answer.start.as_str());
    let mut all = Vec::new();
    if let Some(start) = start {
        all.push(Unexamined::new(
            "Other starts",
            format!("The runs began {start}. Another start may end on another motion; `quell basins` examines them."),
        ));
    }
    let system = study.system();
    let names = system.structure.names();
    let modal = !names.is_empty() && names.iter().all(|name| name.contains('.'));
    if let (true, Some(mechanical)) = (modal, system.structure.mechanical()) {
        let highest = (0..names.len())
            .map(|place| mechanical.stiffness()[(place, place)].max(0.0).sqrt())
            .fold(0.0, f64::max);
        let fastest = system.acting_frequencies().fold(0.0, f64::max);
        let dither = if fastest > highest {
            format!(", below the dither's {}", digits(fastest))
        } else {
            String::new()
        };
        all.push(Unexamined::new(
            "Modes left out",
            format!(
                "The model has {}, up to the angular frequency {}{dither}.",
                counted(names.len(), "mode"),
                digits(highest)
            ),
        ));
    }
    if let [_] = names {
        all.push(Unexamined::new(
            "Other motions of the structure",
            "The structure has one degree of freedom; its other modes are not in the model.",
        ));
    }
    let units = study.units();
    for contact in &system.contacts {
        let law = contact.friction.kind().name();
        let load = if contact.normal.is_some() {
            "follows the approach of its surfaces"
        } else {
            "is prescribed"
        };
        let range = contact.friction.range().map_or(String::new(), |range| {
            let [lower, upper] =
                [range.lower, range.upper].map(|end| in_units(units, Quantity::Velocity, end));
            format!(" The law holds for slip velocities from {lower} to {upper} ({}).", range.limit)
        });
        all.push(Unexamined::new(
            "Other friction laws",
            format!(
                "Contact {} has the law “{law}” only; its normal load {load}.{range}",
                contact.name
            ),
        ));
    }
    let designed = study.design().map_or(&[][..], |design| &design.vary);
    let varies = |what: &str| designed.iter().any(|range| range.path.contains(what));
    for wave in system.waves().filter(|_| !varies("frequency")) {
        all.push(Unexamined::new(
            "Other dither frequencies",
            format!(
                "A dither has {} only; `quell map` computes maps over amplitude and frequency.",
                frequency_in_words(units, wave.lowest())
            ),
        ));
    }
    all
}

/// Amplitudes outside the windows of thresholds.
fn windows(answers: &[ReportedAnswer]) -> Vec<Unexamined> {
    answers
        .iter()
        .filter_map(|answer| answer.chosen.as_ref())
        .map(|window| {
            Unexamined::new("Other amplitudes", format!("Thresholds were searched for {window}."))
        })
        .collect()
}

/// Dithers of amplitude 0, which have no window of thresholds.
fn amplitudes_of_zero(study: &Study) -> Vec<Unexamined> {
    let system = study.system();
    let amplitudes: Vec<f64> = system.system().inputs.iter().map(amplitude_of).collect();
    let zero = amplitudes.iter().filter(|amplitude| **amplitude == 0.0).count();
    if zero == 0 {
        return Vec::new();
    }
    let fact = "A dither of the study has the amplitude 0, around which no window of thresholds was chosen; \
                `quell thresholds --parameter dither.amplitude` examines one.";
    vec![Unexamined::new("Amplitudes that change the outcome", fact)]
}

/// The numbers of the study, all taken as exact.
fn parameters(study: &Study) -> Unexamined {
    let numbers: Vec<String> = study
        .settings()
        .into_iter()
        .filter(|(path, value)| {
            let asked = ["schema", "sweep", "design"].iter().any(|table| path.starts_with(table));
            let sampled =
                study.uncertainty().is_some_and(|known| known.paths().any(|known| known == path));
            !asked && !sampled && value.parse::<f64>().is_ok()
        })
        .map(|(path, _)| format!("`{path}`"))
        .collect();
    let named = numbers.iter().take(MOST_NAMES).cloned().collect::<Vec<_>>().join(", ");
    let rest = if numbers.len() > MOST_NAMES { ", …" } else { "" };
    Unexamined::new(
        "Uncertainty of the parameters",
        format!("The {} numbers of the study were taken as exact: {named}{rest}.", numbers.len()),
    )
}
