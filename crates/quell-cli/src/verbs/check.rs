//! `quell check`: is the study right?

use clap::Args;
use quell::Failure;
use quell::run::check::Check;
use quell::run::disc::check as disc;
use quell::run::law;
use quell::{DiscStudy, Subject};
use quell_model::units::Quantity;

use crate::answer::Answer;
use crate::arguments::StudyArguments;
use crate::table::Table;

/// Checks a study file and prints its values
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let study = match arguments.study.read_any()? {
        Subject::Belt(study) => *study,
        Subject::Disc(study) => {
            return Ok(Answer::new(arguments.study.json, &disc::json(&study), || of_disc(&study)));
        }
    };
    let text = || {
        let belt = study.belt();
        let mut table = Table::new(study.scales());
        table.number("damping ratio ζ", Quantity::DampingRatio, belt.damping_ratio());
        table.number("normal load F", Quantity::Force, belt.normal_load());
        table.number("belt velocity v₀", Quantity::Velocity, belt.belt_velocity());
        let law = belt.friction().kind();
        table.word("friction law", law.name());
        for (parameter, value) in law.parameters().iter().zip(belt.friction().values()) {
            let label = format!("{} {}", parameter.key().replace('_', " "), parameter.symbol);
            table.number(&label, parameter.quantity, value);
        }
        for (label, words) in law::words(&study) {
            table.word(&label, &words);
        }
        for dither in belt.dithers() {
            table
                .word("dither", &format!("{} {}", dither.direction.name(), dither.waveform.name()));
            table.number("  amplitude D", Quantity::Force, dither.amplitude);
            table.number("  frequency ratio R", Quantity::FrequencyRatio, dither.frequency_ratio);
            table.number("  phase φ", Quantity::Angle, dither.phase);
            table.number("  amplitude ratio α = D/R", Quantity::Velocity, dither.amplitude_ratio());
        }
        for sweep in study.sweeps() {
            let last = sweep.axis.value(usize::MAX);
            let (first, points) = (sweep.axis.value(0), sweep.axis.len());
            table.word("axis", &format!("{} from {first} to {last}, {points} points", sweep.path));
        }
        let title = study.title().map(|title| format!("{title}: ")).unwrap_or_default();
        format!("{title}the study is valid.\n{}", table.text())
    };
    Ok(Answer::new(arguments.study.json, &Check { study: &study }.json(), text))
}

fn of_disc(study: &DiscStudy) -> String {
    let object = disc::json(study);
    let mut table = Table::new(None);
    let word =
        |value: &serde_json::Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    table.word(
        "modes",
        &format!("{}, from the {}", object["disc"]["modes"], word(&object["disc"]["modes_from"])),
    );
    table.word("speed Ω", &object["disc"]["speed"].to_string());
    for (index, load) in object["disc"]["loads"].as_array().into_iter().flatten().enumerate() {
        let words: Vec<String> = load
            .as_object()
            .into_iter()
            .flatten()
            .map(|(name, value)| format!("{} {value}", name.replace('_', " ")))
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
    let without = study.without();
    if !without.is_empty() {
        table.word("without", &without.join(", "));
    }
    for sweep in study.sweeps() {
        let (first, last) = (sweep.axis.value(0), sweep.axis.value(usize::MAX));
        let points = sweep.axis.len();
        table.word("axis", &format!("{} from {first} to {last}, {points} points", sweep.path));
    }
    let title = study.title().map(|title| format!("{title}: ")).unwrap_or_default();
    format!("{title}the study is valid.\n{}", table.text())
}
