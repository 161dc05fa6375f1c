//! `quell simulate`: one trajectory with its events.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use quell::kind::{moving_system, verbs};
use quell::run::simulate::{Options, Start};
use quell::run::system::simulate::MotionRequest;
use quell::run::system::start::{duration as duration_of_motion, read_state};
use quell::sound::SoundOptions;
use quell::study::SystemStudy;
use quell::{Complaint, Failure, Fault, Origin, Study};
use serde_json::Value as Json;

use super::numbers::{duration, scales, state};
use crate::answer::Answer;
use crate::arguments::{
    Gathered, Outputs, Plot, PlotArguments, StudyArguments, WAV, answer, inputs,
};

/// Simulates one run and locates every event at the contact
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Duration: τ of a belt, time in the units of a system, or in 1/ω_ref of a disc; in a study in SI in seconds, or a time such as
    /// 50ms [default: 100 periods of the slowest oscillation of a system; of a disc, until a small motion has grown]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: Option<String>,
    /// Start of a system: numbers that replace those of the study's start, such as x=0.1,velocity.x=-2; of a disc, numbers that
    /// replace those of rest, such as A2=0.1; of a belt, the state x,v, such as 0.3,0
    #[arg(long, value_name = "NAME=VALUE,…|X,V", allow_hyphen_values = true, value_hint = ValueHint::Other)]
    start: Option<String>,
    /// Lists every event; with --save FILE.csv also writes them to a second file, such as run_events.csv next to run.csv
    #[arg(long)]
    events: bool,
    #[command(flatten)]
    plot: PlotArguments,
    /// Saves the trajectory as a table (.csv, .mat for MATLAB, .nc for NetCDF), or its velocity as sound (44.1 kHz, 16 bits, mono)
    #[arg(long, value_name = "FILE.csv|.mat|.nc|.wav")]
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

impl Arguments {
    /// The run of a system or a disc.
    fn request(&self, study: &SystemStudy, samples: bool) -> Result<MotionRequest, Failure> {
        let mut complaints = Gathered::default();
        let read = |text: &str| duration_of_motion(study, text, "--until");
        let until = complaints.take(self.until.as_deref().map(read).transpose());
        let start = self.start.as_deref().map(|text| read_state(study, text));
        let start = complaints.take(start.transpose());
        let (until, start) = complaints.finish(until.zip(start))?;
        Ok(MotionRequest {
            until,
            start: start.unwrap_or_default(),
            events: self.events,
            samples,
            ..MotionRequest::default()
        })
    }

    /// The duration of the run of a belt, which must be given, and its start.
    fn run_of_belt(&self, study: &Study) -> Result<(f64, Option<Start>), Failure> {
        let mut complaints = Gathered::default();
        let begin = self.start.as_deref().map(|text| state("--start", text, Some(study)));
        let begin = complaints.take(begin.transpose());
        let until = match &self.until {
            Some(text) => duration("--until", text, Some(study)),
            None => Err(Box::new(Complaint::new(
                Fault::Missing,
                "--until",
                Origin::Argument("--until"),
                Json::Null,
                "a duration, such as 50",
            ))),
        };
        let until = complaints.take(until);
        let (until, begin) = complaints.finish(until.zip(begin))?;
        let begin = begin.map(|(x, v)| Start { time: 0.0, displacement: x, velocity: v });
        Ok((until, begin))
    }
}

/// Runs the verb.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Gathered::default();
    let study = complaints.take(arguments.study.read());
    let inputs = inputs(study.as_ref());
    let save = arguments.save.as_deref();
    let extension = save.and_then(|path| path.extension()?.to_str());
    let is_sound = extension.is_some_and(|extension| extension.eq_ignore_ascii_case(WAV));
    let sound = complaints.take(arguments.sound.read(is_sound, study.as_ref()));
    let parts: &[&str] = if arguments.events && !is_sound { &["events"] } else { &[] };
    let outputs = complaints.take(Outputs::prepare(save, &[WAV], parts, &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    if let Some((study, system)) =
        study.as_ref().and_then(|study| Some((study, moving_system(study)?)))
    {
        let sampled = save.is_some() && !is_sound || plot.as_ref().is_some_and(Plot::wanted);
        let request = complaints.take(arguments.request(&system, sampled));
        let ((request, sound), (outputs, plot)) =
            complaints.finish(request.zip(sound).zip(outputs.zip(plot)))?;
        let request = MotionRequest { sound, ..request };
        let done = verbs(study).simulate_from(&request)?;
        return answer(arguments.study.json, done.as_ref(), outputs, plot);
    }
    let until = if let Some(study) = study.as_ref() {
        complaints.take(arguments.run_of_belt(study))
    } else {
        // Which options apply depends on the kind of the study, which is unknown: only what is given is examined.
        let given = arguments.until.as_deref().map(|text| duration("--until", text, None));
        complaints.take(given.transpose()).map(|until| (until.unwrap_or_default(), None))
    };
    let ((study, (until, start)), (sound, (outputs, plot))) =
        complaints.finish(study.zip(until).zip(sound.zip(outputs.zip(plot))))?;

    let options = Options {
        start,
        times: None,
        events: arguments.events,
        samples: save.is_some() && sound.is_none() || plot.wanted(),
        undithered: plot.wanted(),
        sound,
    };
    let done = verbs(&study).simulate(until, options)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
