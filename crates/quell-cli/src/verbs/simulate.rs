//! `quell simulate`: one trajectory with its events.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use quell::kind::verbs;
use quell::run::simulate::Options;
use quell::sound::SoundOptions;
use quell::{Complaint, Failure, Fault, Origin, Study};

use super::numbers::{duration, scales};
use crate::answer::Answer;
use crate::arguments::{Gathered, Outputs, PlotArguments, StudyArguments, WAV, answer, inputs};

/// Simulates one run and locates every event at the contact
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Duration τ; in a study in SI in seconds, or a time such as 50ms
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: String,
    /// Lists every event; with --save FILE.csv also writes them to a second file, such as run_events.csv next to run.csv
    #[arg(long)]
    events: bool,
    #[command(flatten)]
    plot: PlotArguments,
    /// Saves the trajectory as a table, or its velocity as sound (44.1 kHz, 16 bits, mono)
    #[arg(long, value_name = "FILE.csv|.wav")]
    save: Option<PathBuf>,
    #[command(flatten)]
    sound: SoundArguments,
}

/// The options of a sound.
#[derive(Debug, Args)]
struct SoundArguments {
    /// Multiplies every frequency of the sound [default: 1, in SI real time, otherwise ω₀ at 110 Hz]
    #[arg(long, value_name = "FACTOR", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    transpose: Option<String>,
    /// Fraction of full scale per unit of velocity, in SI per m/s [default: the largest sample at -3 dB]
    #[arg(long, value_name = "G", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    gain: Option<String>,
}

impl SoundArguments {
    /// The options of the sound, if one is saved.
    fn read(&self, saved: bool, study: Option<&Study>) -> Result<Option<SoundOptions>, Failure> {
        let mut complaints = Gathered::default();
        let mut options = SoundOptions::default();
        if let Some(text) = &self.transpose {
            needs_sound("--transpose", text, saved, &mut complaints);
            let found = complaints.take(SoundOptions::transposition(text));
            options.transposition = found.unwrap_or_default();
        }
        if let Some(text) = &self.gain {
            needs_sound("--gain", text, saved, &mut complaints);
            options.gain = complaints.take(SoundOptions::gain(text, scales(study)));
        }
        complaints.finish(Some(saved.then_some(options)))
    }
}

/// Rejects an option of a sound where no sound is saved.
fn needs_sound(option: &'static str, text: &str, saved: bool, complaints: &mut Gathered) {
    if !saved {
        let (origin, allowed) = (Origin::Argument(option), "requires --save FILE.wav");
        let complaint = Complaint::new(Fault::Conflict, option, origin, text, allowed);
        complaints.take::<()>(Err(complaint));
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let until = complaints.take(duration("--until", &arguments.until, study.as_ref()));
    let save = arguments.save.as_deref();
    let extension = save.and_then(|path| path.extension()?.to_str());
    let is_sound = extension.is_some_and(|extension| extension.eq_ignore_ascii_case(WAV));
    let sound = complaints.take(arguments.sound.read(is_sound, study.as_ref()));
    let parts: &[&str] = if arguments.events && !is_sound { &["events"] } else { &[] };
    let outputs = complaints.take(Outputs::prepare(save, &["csv", WAV], parts, &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let ((study, until), (sound, (outputs, plot))) =
        complaints.finish(study.zip(until).zip(sound.zip(outputs.zip(plot))))?;

    let options = Options {
        events: arguments.events,
        samples: save.is_some() && sound.is_none() || plot.wanted(),
        undithered: plot.wanted(),
        sound,
    };
    let done = verbs(&study).simulate(until, options)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
