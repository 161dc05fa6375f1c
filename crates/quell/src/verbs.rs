//! The verbs of a study, one method each; [`VERBS`] lists what each of them needs.
//!
//! The command line and Python call [`verbs`] for any study. A belt is answered as its system; a disc has answers of its own where
//! the waves of its plate decide.

use crate::cite::{Sources, sources_of};
use crate::complaint::Failure;
use crate::needs::{StudyVerb, VERBS};
use crate::outcome::check::Valid;
use crate::outcome::{Answered, Outcome, Presented};
use crate::run::basins::{self, BasinsRequest};
use crate::run::bifurcation::SweepRequest;
use crate::run::disc::{self, motion, resonances};
use crate::run::found_attractor::AttractorRequest;
use crate::run::orbit::Wanted;
use crate::run::probability::{ProbabilityRequest, ProbabilityStart};
use crate::run::recorded_motion::ObservedMotion;
use crate::run::response::ResponseRequest;
use crate::run::simulate::MotionRequest;
use crate::run::system::receptance::{self, ReceptanceRequest};
use crate::run::system::tracked::TrackRequest;
use crate::run::system::{design, exact, has_equations, measured, modes, reach, tracked};
use crate::run::thresholds::curves::{self, CurvesRequest};
use crate::run::thresholds::{ThresholdsRequest, by_eigenvalues};
use crate::run::{
    actuator, bifurcation, describing, found_attractor, friction, noise_response, orbit,
    probability, ramp, response, simulate, stability, thresholds, waveforms, window,
};
use crate::running::Running;
use crate::said::Mention;
use crate::study::{DiscStudy, Kind, Study, StudyKind, StudyOf, SystemStudy, not_periodic};
use quell_numerics::interval::RealInterval;

/// The answer of a verb, or why it failed.
pub type Reply = Result<Box<dyn Outcome>, Failure>;

/// The verb of an option, without it.
fn without_option(name: &str) -> &str {
    name.split(" --").next().unwrap_or(name)
}

/// The verbs of one study. One whose needs the study does not meet returns an error that names those it has.
#[derive(Clone, Debug)]
pub struct Verbs {
    study: Study,
}

/// The verbs of a study.
pub fn verbs(study: &Study) -> Verbs {
    Verbs { study: study.clone() }
}

/// The system whose motions a verb is about: that of a belt, or a system itself.
///
/// # Errors
/// A study that does not meet the needs of the verb.
pub fn system_of(study: &Study, verb: &str) -> Result<SystemStudy, Failure> {
    verbs(study).system(verb)
}

impl Verbs {
    /// Names of the verbs of the study; an option by itself where it has that option of a verb alone.
    pub fn names(&self) -> Vec<&'static str> {
        let mut names: Vec<&'static str> = Vec::new();
        for verb in VERBS.iter().filter(|verb| verb.needs.are_met(&self.study)) {
            if !names.contains(&without_option(verb.name)) {
                names.push(verb.name);
            }
        }
        names
    }

    /// Whether the answer of a verb has a picture.
    pub fn draws(&self, verb: &str) -> bool {
        let is_measured = || self.study.system().frequency_response().is_some();
        StudyVerb::named(verb).is_none_or(|known| known.draws)
            && !(verb == "stability" && is_measured())
    }

    /// Rejects a verb whose needs the study does not meet.
    pub(crate) fn has(&self, name: &str) -> Result<(), Failure> {
        let Some(verb) = StudyVerb::named(name) else { return Ok(()) };
        let Some(mut complaint) = verb.needs.refused(&self.study, name) else { return Ok(()) };
        if !verb.needs.suit(&self.study) {
            let names = self.names();
            let named = |known: &&'static str| match name.strip_prefix(*known) {
                Some(option) if option.starts_with(" --") => format!("{known} without{option}"),
                _ => (*known).to_owned(),
            };
            let names: Vec<String> = names.iter().map(named).collect();
            let verbs = format!("; its verbs are {}", names.join(", "));
            complaint.allowed = complaint.allowed.text(verbs);
            if self.disc().is_some() {
                let convert = Mention::Verb("convert".to_owned());
                let allowed = complaint.allowed.text("; ").mention(convert);
                complaint.allowed = allowed.text(" writes it as a system, which can be asked");
            }
        }
        Err(complaint.into())
    }

    /// The system that a verb is about.
    fn system(&self, verb: &str) -> Result<SystemStudy, Failure> {
        self.has(verb)?;
        Ok(self.study.system())
    }

    /// The disc; `None` of another study.
    fn disc(&self) -> Option<DiscStudy> {
        self.study.disc().ok()
    }

    /// The values of the study.
    ///
    /// # Errors
    /// A law whose numbers are out of their bounds in the units of the study.
    pub fn check(&self) -> Reply {
        match self.study.kind() {
            Kind::Disc(setup) => answer(&self.study.narrowed(setup.as_ref()), Ok(Valid)),
            Kind::Belt(_) | Kind::System(_) => answer(&self.study.system(), Ok(Valid)),
        }
    }

    /// The equations and papers that the study's computations use.
    pub fn sources(&self) -> Sources {
        sources_of(&self.study)
    }

    /// [`Verbs::sources`] as an answer.
    pub fn cite(&self) -> Box<dyn Outcome> {
        Box::new(Answered::new(&self.study, self.sources()))
    }

    /// The friction law and the effective friction, at these slip velocities or on a grid; with `measured` also the friction of
    /// steady responses.
    ///
    /// # Errors
    /// As [`friction::run`].
    pub fn friction(&self, at: Option<&[f64]>, measured: bool) -> Reply {
        let study = self.system(if measured { "friction --measured" } else { "friction" })?;
        answer(&study, friction::run(&study, at, measured))
    }

    /// Averaged friction under a slow sinusoid of the slip velocity, for velocity amplitudes up to one.
    ///
    /// # Errors
    /// As [`describing::run`].
    pub fn describing(&self, largest: f64) -> Reply {
        let study = self.system("friction --describing")?;
        answer(&study, describing::run(&study, largest))
    }

    /// Stability of steady sliding.
    ///
    /// # Errors
    /// Numbers that overflow.
    pub fn stability(&self) -> Reply {
        self.has("stability")?;
        if let Some(disc) = self.disc() {
            return answer(&disc, disc::stability::run(&disc));
        }
        let study = self.study.system();
        match study.frequency_response() {
            Some(response) => answer(&study, measured::run(&study, response)),
            None => answer(&study, stability::run(&study)),
        }
    }

    /// The exact stability of the dithered motion in pure slip, by Floquet exponents.
    ///
    /// # Errors
    /// Motion that is not pure slip.
    pub fn exact_stability(&self) -> Reply {
        let study = self.system("stability --exact")?;
        answer(&study, exact::run(&study))
    }

    /// The eigenvalues of small motions followed over a parameter.
    ///
    /// # Errors
    /// As [`tracked::run`].
    pub fn tracked_stability(&self, request: &TrackRequest) -> Reply {
        let study = self.system("stability --parameter")?;
        answer(&study, tracked::run(&study, request))
    }

    /// How far each dither reaches each contact, over a range of angular frequencies.
    ///
    /// # Errors
    /// As [`reach::run`].
    pub fn reach(&self, frequencies: Option<RealInterval>) -> Reply {
        let study = self.system("resonances")?;
        answer(&study, reach::run(&study, frequencies))
    }

    /// Speeds at which waves of a disc meet.
    ///
    /// # Errors
    /// As [`resonances::run`]; a study without waves.
    pub fn resonances(&self, request: resonances::ResonancesRequest) -> Reply {
        self.has("resonances")?;
        let disc = self.study.disc().map_err(|complaint| *complaint)?;
        answer(&disc, resonances::run(&disc, request))
    }

    /// One motion, from a start that may differ from that of the study.
    ///
    /// # Errors
    /// As [`simulate::run`].
    pub fn simulate(&self, request: &MotionRequest) -> Reply {
        if let Some(disc) = self.disc() {
            return answer(&disc, motion::run(&disc, request));
        }
        let study = self.system("simulate")?;
        answer(&study, simulate::run(&study, request))
    }

    /// The steady response; under noise of runs with different seeds; or what one run does between two of its times.
    ///
    /// # Errors
    /// As [`response::run`], [`noise_response::run`], [`window::run`].
    pub fn response(&self, request: &ResponseRequest) -> Reply {
        if let Some(ends) = request.window {
            self.has("response --window")?;
            let study = match self.disc() {
                Some(disc) => motion::disturbed(&disc)?,
                None => self.study.system(),
            };
            return answer(&study, window::run(&study, ends));
        }
        // The vibration of a disc without dither grows without bound or dies out: there is no steady one to compare with.
        let study = self.system("response")?;
        if request.seeds.is_some() || study.system().has_noise() {
            return answer(&study, noise_response::run(&study, *request));
        }
        answer(&study, response::run(&study, *request))
    }

    /// One run in which a drive, a load or an amplitude changes slowly, compared with the exact thresholds.
    ///
    /// # Errors
    /// As [`ramp::run`].
    pub fn ramp(&self) -> Reply {
        let study = self.system("bifurcation --ramp")?;
        answer(&study, ramp::run(&study))
    }

    /// A periodic response and its multipliers.
    ///
    /// # Errors
    /// As [`orbit::run`].
    pub fn orbit(&self, wanted: &Wanted) -> Reply {
        let study = self.system("orbit")?;
        answer(&study, orbit::run(&study, wanted))
    }

    /// The motion on which a run ends, and its Lyapunov exponents.
    ///
    /// # Errors
    /// As [`found_attractor::run`].
    pub fn attractor(&self, request: &AttractorRequest) -> Reply {
        let study = self.system("attractor")?;
        answer(&study, found_attractor::run(&study, request))
    }

    /// Thresholds of one parameter.
    ///
    /// # Errors
    /// As [`thresholds::run`].
    pub fn thresholds(&self, request: &ThresholdsRequest) -> Reply {
        let study = self.system("thresholds")?;
        has_equations(&study, "thresholds")?;
        if by_eigenvalues(&study, request)? {
            return answer(&study, tracked::run(&study, &request.tracked()));
        }
        answer(&study, thresholds::run(&study, request))
    }

    /// Curves of thresholds in two parameters.
    ///
    /// # Errors
    /// As [`curves::run`].
    pub fn threshold_curves(&self, request: &CurvesRequest) -> Reply {
        let study = self.system("thresholds")?;
        has_equations(&study, "thresholds")?;
        if curves::is_dithered_in(&study, request) {
            return answer(&study, curves::run(&study, request));
        }
        // Without dither the thresholds are those of steady sliding.
        answer(&study, tracked::run(&study, &curves::tracked(request)))
    }

    /// The response along a parameter, swept up and down.
    ///
    /// # Errors
    /// As [`bifurcation::run`].
    pub fn bifurcation(&self, request: &SweepRequest, running: Running<'_>) -> Reply {
        let study = self.system("bifurcation")?;
        answer(&study, bifurcation::run(&study, request, running))
    }

    /// The response on which each start ends.
    ///
    /// # Errors
    /// As [`basins::run`].
    pub fn basins(&self, request: &BasinsRequest, running: Running<'_>) -> Reply {
        let study = self.system("basins")?;
        answer(&study, basins::run(&study, request, running))
    }

    /// The least dither of each waveform that quenches, and its cost.
    ///
    /// # Errors
    /// As [`waveforms::run`].
    pub fn waveforms(&self) -> Reply {
        let study = self.system("waveforms")?;
        answer(&study, waveforms::run(&study))
    }

    /// The least dither that is quiet over a box of operating points.
    ///
    /// # Errors
    /// As [`design::run`].
    pub fn design(&self) -> Reply {
        self.has("design")?;
        if let Some(disc) = self.disc() {
            return answer(&disc, disc::design::run(&disc));
        }
        let study = self.study.system();
        answer(&study, design::run(&study))
    }

    /// Where over a range of angular frequencies of the dither the actuator can give what quenches.
    ///
    /// # Errors
    /// As [`actuator::run`].
    pub fn actuator(&self, frequencies: Option<RealInterval>) -> Reply {
        let study = self.system("actuator")?;
        // The actuator of a disc is in SI, as the system of the disc is then.
        let study = match self.disc().and_then(|disc| disc.actuator().cloned()) {
            Some(_) => self.study.as_system()?.study.system(),
            None => study,
        };
        answer(&study, actuator::run(&study, frequencies))
    }

    /// How probable it is that a study with uncertain numbers vibrates.
    ///
    /// # Errors
    /// As [`probability::run`].
    pub fn probability(&self, request: ProbabilityRequest, running: Running<'_>) -> Reply {
        self.has("probability")?;
        // Runs under noise have no end.
        if let Some(key) = self.study.noise()
            && request.start != ProbabilityStart::Averaged
        {
            return Err(not_periodic("probability", key).into());
        }
        if let Some(disc) = self.disc() {
            return answer(&disc, probability::run(&disc, request, running));
        }
        let study = self.study.system();
        answer(&study, probability::run(&study, request, running))
    }

    /// The exact motion as a sensor would record it, which `compare` and `fit --record` set against measurements; `verb` is the one
    /// that asks.
    ///
    /// # Errors
    /// A start that does not exist.
    pub fn recorded_motion(&self, verb: &str) -> Result<ObservedMotion, Failure> {
        ObservedMotion::of(&self.study.system(), verb)
    }

    /// Natural frequencies and shapes.
    ///
    /// # Errors
    /// As [`modes::run`].
    pub fn modes(&self) -> Reply {
        self.has("modes")?;
        if let Some(disc) = self.disc() {
            return answer(&disc, Ok(disc::modes::run(&disc)));
        }
        let study = self.study.system();
        answer(&study, modes::run(&study))
    }

    /// Displacement over force between rows, over frequency.
    ///
    /// # Errors
    /// As [`receptance::run`].
    pub fn receptance(&self, request: &ReceptanceRequest) -> Reply {
        let study = self.system("receptance")?;
        answer(&study, receptance::run(&study, request))
    }
}

/// The result of a verb with its study, or why the verb failed.
fn answer<K, D>(study: &StudyOf<K>, done: Result<D, Failure>) -> Reply
where
    K: StudyKind + Send + Sync + 'static,
    D: Presented<K> + 'static,
{
    Ok(Box::new(Answered::new(study, done?)))
}
