//! `simulate`: one trajectory with its events.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::table::{TextTable, figure_of};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::simulate::{Options, Simulation, run};
use crate::sound::SoundOptions;
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for Simulation {
    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        table(study, self)
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        let mut datasets = Vec::new();
        if self.samples.is_some() {
            datasets.push(("trajectory", self.dataset(study)));
        }
        if self.events.is_some() {
            datasets.push(("events", self.events_dataset(study)));
        }
        datasets
    }

    /// The sound is the requested one, or one with the default options.
    fn sound(&self, study: &BeltStudy) -> Option<Result<Vec<u8>, Failure>> {
        let wav = |done: &Self| {
            let comment = done.sound_sentence(study).unwrap_or_default();
            done.sound.as_ref().map(|sound| sound.wav(&comment))
        };
        if let Some(bytes) = wav(self) {
            return Some(Ok(bytes));
        }
        let start = self.given.then_some(self.start);
        let options = Options { start, sound: Some(SoundOptions::default()), ..Options::default() };
        match run(study, self.end.time, options) {
            Ok(done) => wav(&done).map(Ok),
            Err(failure) => Some(Err(failure)),
        }
    }

    /// The picture shows the run without dither next to this one.
    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        if self.samples.is_some() && self.undithered_samples.is_some() {
            return Some(Ok(picture::simulate(study, self)));
        }
        let start = self.given.then_some(self.start);
        let options = Options { start, samples: true, undithered: true, ..Options::default() };
        let both = run(study, self.end.time, options);
        Some(both.map(|both| picture::simulate(study, &both)))
    }
}

fn table(study: &BeltStudy, done: &Simulation) -> String {
    let mut text = String::new();
    if let Some(events) = &done.events {
        text.push('\n');
        let symbol = if study.scales().is_some() { "t" } else { "τ" };
        let _ = writeln!(text, "  {symbol:>14}  {:<8}  {:>4}  {:>14}", "event", "slip", "x");
        for event in events {
            let time = figure_of(study, Quantity::Time, event.time);
            let place = figure_of(study, Quantity::Displacement, event.displacement);
            let _ = writeln!(
                text,
                "  {time:>14}  {:<8}  {:>4}  {place:>14}",
                event.kind.name(),
                event.slip_sign
            );
        }
        text.push('\n');
    }
    let end = &done.end;
    let mut table = TextTable::new(study.scales());
    table.number("time τ", Quantity::Time, end.time);
    table.number("displacement x", Quantity::Displacement, end.displacement);
    table.number("velocity x′", Quantity::Velocity, end.velocity);
    table.word("sticking", if end.sticking { "yes" } else { "no" });
    table.word("events", &end.events.to_string());
    table.word("steps", &end.steps.to_string());
    text + &table.text()
}
