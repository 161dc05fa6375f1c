//! `simulate`: one motion with every event.

use std::fmt::Write as _;

use quell_model::units::Quantity;
use serde_json::Value as Json;

use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::outcome::Presented;
use crate::outcome::table::{figure, heading};
use crate::picture;
use crate::plot::Figure;
use crate::run::simulate::history::KINDS;
use crate::run::simulate::{MotionRequest, Simulation, run};
use crate::sound::SoundOptions;
use crate::study::{SystemSetup, SystemStudy};
use crate::words::unit_after;

/// Numbers of a state that a table lists.
const MOST_NUMBERS: usize = 12;

impl Presented<SystemSetup> for Simulation {
    const NAME: &'static str = "simulation";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn notes(&self, study: &SystemStudy) -> Vec<String> {
        self.notes(study)
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = String::new();
        if self.request.events {
            events(study, self, &mut text);
        }
        contacts(study, self, &mut text);
        final_state(study, self, &mut text);
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        let samples = self.samples.as_ref();
        let samples = samples.map(|samples| ("trajectory", self.dataset(study, samples)));
        samples.into_iter().chain([("events", self.events_dataset(study))]).collect()
    }

    /// The sound is the requested one, or one with the default options.
    fn sound(&self, study: &SystemStudy) -> Option<Result<Vec<u8>, Failure>> {
        let wav = |done: &Self| {
            let comment = done.sound_sentence(study).unwrap_or_default();
            done.sound.as_ref().map(|sound| sound.wav(&comment))
        };
        if let Some(bytes) = wav(self) {
            return Some(Ok(bytes));
        }
        let sound = Some(SoundOptions::default());
        let request = MotionRequest { until: Some(self.end.time), sound, ..self.request.clone() };
        match run(study, &request) {
            Ok(done) => wav(&done).map(Ok),
            Err(failure) => Some(Err(failure)),
        }
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        figure_with(self, study, true)
    }
}

/// The picture, with the motion from the same start without dither or not.
pub(super) fn figure_with(
    motion: &Simulation,
    study: &SystemStudy,
    undithered: bool,
) -> Option<Result<Figure, Failure>> {
    let is_whole = motion.request.undithered == undithered && motion.request.times.is_none();
    if let (Some(samples), true) = (&motion.samples, is_whole) {
        return Some(Ok(picture::simulate(study, motion, samples)));
    }
    let request = MotionRequest {
        until: Some(motion.end.time),
        samples: true,
        undithered,
        times: None,
        ..motion.request.clone()
    };
    let done = match run(study, &request) {
        Ok(done) => done,
        Err(failure) => return Some(Err(failure)),
    };
    let samples = done.samples.as_ref()?;
    Some(Ok(picture::simulate(study, &done, samples)))
}

/// Every event.
fn events(study: &SystemStudy, done: &Simulation, text: &mut String) {
    let time = heading("time", study.units().unit(Quantity::Time));
    let _ = writeln!(text, "\n  {time:>14}  {:<10}  {:>4}  contact", "event", "slip");
    for event in &done.history.events {
        let _ = writeln!(
            text,
            "  {:>14}  {:<10}  {:>4}  {}",
            figure(event.time),
            event.kind.name(),
            event.slip_sign,
            study.system().contacts[event.contact].name
        );
    }
    text.push('\n');
}

/// Events, fractions and forces of every contact.
fn contacts(study: &SystemStudy, done: &Simulation, text: &mut String) {
    let contacts = &study.system().contacts;
    if contacts.is_empty() {
        return;
    }
    let width = contacts.iter().map(|contact| contact.name.chars().count()).max().unwrap_or(0);
    let width = width.max("contact".len());
    let _ = write!(text, "  {:<width$}  {:>10}  {:>10}", "contact", "in stick", "open");
    for kind in KINDS {
        let _ = write!(text, "  {:>11}", format!("{}s", kind.name()));
    }
    text.push('\n');
    for (index, contact) in contacts.iter().enumerate() {
        let of = |means: Option<f64>| means.map_or("-".to_owned(), figure);
        let means = done.means.as_ref().map(|means| means[index]);
        let _ = write!(
            text,
            "  {:<width$}  {:>10}  {:>10}",
            contact.name,
            of(means.map(|means| means.stick_fraction)),
            of(means.map(|means| means.open_fraction))
        );
        for count in done.history.counts[index] {
            let _ = write!(text, "  {count:>11}");
        }
        text.push('\n');
    }
}

/// The state at the end.
fn final_state(study: &SystemStudy, done: &Simulation, text: &mut String) {
    let system = study.system();
    let names = system.state_names();
    let width = names.iter().take(MOST_NUMBERS).map(|name| name.chars().count()).max();
    let width = width.unwrap_or(0).max("final state".len());
    let _ = writeln!(text, "  final state");
    for (place, value) in done.end.state.iter().enumerate().take(MOST_NUMBERS) {
        let quantity = system.state_quantity(place);
        let unit = unit_after(quantity.and_then(|quantity| study.units().unit(quantity)));
        let _ = writeln!(text, "  {:<width$}  {}{unit}", names[place], figure(*value));
    }
    if names.len() > MOST_NUMBERS {
        let _ = writeln!(text, "  … and {} more; --json lists all", names.len() - MOST_NUMBERS);
    }
}
