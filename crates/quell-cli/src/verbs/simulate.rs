//! `quell simulate`: one trajectory with its events.

use std::path::PathBuf;

use clap::{Args, ValueHint};
use quell::run::simulate::MotionRequest;
use quell::run::system::start::{duration as duration_of_motion, read_state};
use quell::sound::SoundOptions;
use quell::study::{SystemStudy, UnitSystem};
use quell::verbs::verbs;
use quell::{Complaint, Failure, Fault, Origin, Study, quantity};

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
    /// 50ms [default: 100 periods of the slowest oscillation; of a disc, until a small motion has grown]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    until: Option<String>,
    /// Numbers that replace those of the study's start, such as x=0.1,velocity.x=-2, of one coordinate also x,v, such as 0.3,0; of a
    /// disc, numbers that replace those of rest, such as A2=0.1
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
    fn read(&self, saved: bool, units: UnitSystem) -> Result<Option<SoundOptions>, Failure> {
        let mut complaints = Gathered::default();
        let mut options = SoundOptions::default();
        if let Some(text) = &self.transpose {
            needs_sound("--transpose", text, saved, &mut complaints);
            let found = complaints.take(SoundOptions::transposition(text));
            options.transposition = found.unwrap_or_default();
        }
        if let Some(text) = &self.gain {
            needs_sound("--gain", text, saved, &mut complaints);
            options.gain = complaints.take(SoundOptions::gain(text, units));
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
    /// The run of a study whose motion is that of this system.
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

    /// What can be examined without a study: the duration.
    fn examined(&self) -> Result<MotionRequest, Failure> {
        let until = self
            .until
            .as_deref()
            .map(|text| quantity::duration(text, UnitSystem::Si, "--until"))
            .transpose()?;
        Ok(MotionRequest { until, ..MotionRequest::default() })
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
    let moving = study.as_ref().map(Study::system);
    let units = moving.as_ref().map_or(UnitSystem::None, SystemStudy::units);
    let sound = complaints.take(arguments.sound.read(is_sound, units));
    let parts: &[&str] = if arguments.events && !is_sound { &["events"] } else { &[] };
    let outputs = complaints.take(Outputs::prepare(save, &[WAV], parts, &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let sampled = save.is_some() && !is_sound || plot.as_ref().is_some_and(Plot::wanted);
    let request = match &moving {
        Some(system) => complaints.take(arguments.request(system, sampled)),
        None => complaints.take(arguments.examined()),
    };
    let ((study, request), (sound, (outputs, plot))) =
        complaints.finish(study.zip(request).zip(sound.zip(outputs.zip(plot))))?;
    let request = MotionRequest { sound, undithered: plot.wanted(), ..request };
    let done = verbs(&study).simulate(&request)?;
    answer(arguments.study.json, done.as_ref(), outputs, plot)
}
