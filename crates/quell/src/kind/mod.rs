//! The verbs of each kind of study, and one error for a verb that a kind does not have.
//!
//! The command line and Python call [`verbs`] for a study of any kind; a kind implements the verbs that it has. A new kind
//! needs a file here, its parser in `quell-study`, and its map points in [`crate::sweep`] if it has maps.

use std::fmt::Write as _;

use crate::cite::Sources;
use crate::complaint::{Failure, Origin};
use crate::outcome::{Answered, Outcome, Presented};
use crate::run::disc::{motion, resonances};
use crate::run::found_attractor::AttractorRequest;
use crate::run::orbit::Wanted;
use crate::run::probability::ProbabilityRequest;
use crate::run::recorded_motion::ObservedMotion;
use crate::run::response::ResponseRequest;
use crate::run::simulate::MotionRequest;
use crate::run::system::tracked::TrackRequest;
use crate::run::thresholds::ThresholdsRequest;
use crate::run::thresholds::curves::CurvesRequest;
use crate::run::{basins, belt_system, bifurcation};
use crate::study::{
    DiscSetup, Kind, Study, StudyKind, StudyOf, SystemStudy, not_available, varies_in_time,
};
use crate::sweep::Running;

mod belt;
mod disc;
mod noise;
mod system;

/// The answer of a verb, or why it failed.
pub type Reply = Result<Box<dyn Outcome>, Failure>;

/// The verbs of one study. A verb that its kind does not implement returns an error that names it.
pub trait Verbs: Send + Sync {
    /// Name of the kind.
    fn kind(&self) -> &'static str;

    /// Names of the verbs of the kind.
    fn names(&self) -> &'static [&'static str];

    /// Whether the answer of a verb has a picture.
    fn draws(&self, verb: &str) -> bool {
        !["check", "cite"].contains(&verb)
    }

    /// The values of the study.
    ///
    /// # Errors
    /// A law whose numbers are out of their bounds in the units of the study.
    fn check(&self) -> Reply;

    /// The equations and papers that the study's computations use.
    fn sources(&self) -> Sources;

    /// [`Verbs::sources`] as an answer.
    fn cite(&self) -> Box<dyn Outcome>;

    /// The friction law and the effective friction, at these slip velocities or on a grid; with `measured` also the friction of
    /// steady responses.
    ///
    /// # Errors
    /// A kind without this verb.
    fn friction(&self, at: Option<Vec<f64>>, measured: bool) -> Reply {
        let _ = (at, measured);
        Err(self.lacks("friction"))
    }

    /// Averaged friction under a slow sinusoid of the slip velocity, for velocity amplitudes up to one.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::describing::run`].
    fn describing(&self, largest: f64) -> Reply {
        let _ = largest;
        Err(self.lacks("friction --describing"))
    }

    /// Stability of steady sliding.
    ///
    /// # Errors
    /// A kind without this verb; numbers that overflow.
    fn stability(&self) -> Reply {
        Err(self.lacks("stability"))
    }

    /// The exact stability of the dithered motion in pure slip, by Floquet exponents.
    ///
    /// # Errors
    /// A kind without this verb; motion that is not pure slip.
    fn exact_stability(&self) -> Reply {
        Err(self.lacks("stability --exact"))
    }

    /// The eigenvalues of small motions followed over a parameter.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::system::tracked::run`].
    fn tracked_stability(&self, request: &TrackRequest) -> Reply {
        let _ = request;
        Err(self.lacks("stability --parameter"))
    }

    /// How far each dither reaches each contact, over a range of angular frequencies.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::system::reach::run`].
    fn reach(&self, frequencies: Option<(f64, f64)>) -> Reply {
        let _ = frequencies;
        Err(self.lacks("resonances without speeds"))
    }

    /// One motion, from a start that may differ from that of the study.
    ///
    /// # Errors
    /// As [`crate::run::simulate::run`].
    fn simulate(&self, request: &MotionRequest) -> Reply;

    /// The steady response; under noise of runs with different seeds; or what one run does between two of its times.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::response::run`], [`crate::run::noise_response::run`], [`crate::run::window::run`].
    fn response(&self, request: &ResponseRequest) -> Reply {
        let _ = request;
        Err(self.lacks("response"))
    }

    /// One run in which a drive, a load or an amplitude changes slowly, compared with the exact thresholds.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::ramp::run`].
    fn ramp(&self) -> Reply {
        Err(self.lacks("bifurcation --ramp"))
    }

    /// A periodic response and its multipliers.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::orbit::run`].
    fn orbit(&self, wanted: &Wanted) -> Reply {
        let _ = wanted;
        Err(self.lacks("orbit"))
    }

    /// The motion on which a run ends, and its Lyapunov exponents.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::found_attractor::run`].
    fn attractor(&self, request: &AttractorRequest) -> Reply {
        let _ = request;
        Err(self.lacks("attractor"))
    }

    /// Thresholds of one parameter.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::thresholds::run`].
    fn thresholds(&self, request: &ThresholdsRequest) -> Reply {
        let _ = request;
        Err(self.lacks("thresholds"))
    }

    /// Curves of thresholds in two parameters.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::thresholds::curves::run`].
    fn threshold_curves(&self, request: &CurvesRequest) -> Reply {
        let _ = request;
        Err(self.lacks("thresholds"))
    }

    /// The response along a parameter, swept up and down.
    ///
    /// # Errors
    /// A kind without this verb; as [`bifurcation::run`].
    fn bifurcation(&self, request: &bifurcation::SweepRequest, running: Running<'_>) -> Reply {
        let _ = (request, running);
        Err(self.lacks("bifurcation"))
    }

    /// The response on which each start ends.
    ///
    /// # Errors
    /// A kind without this verb; as [`basins::run`].
    fn basins(&self, request: &basins::BasinsRequest, running: Running<'_>) -> Reply {
        let _ = (request, running);
        Err(self.lacks("basins"))
    }

    /// The least dither of each waveform that quenches, and its cost.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::waveforms::run`].
    fn waveforms(&self) -> Reply {
        Err(self.lacks("waveforms"))
    }

    /// The thresholds by the atlas; with `exact` also those by continuation.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::atlas::run`].
    fn atlas(&self, exact: bool) -> Reply {
        let _ = exact;
        Err(self.lacks("atlas"))
    }

    /// The least dither that is quiet over a box of operating points.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::system::design::run`].
    fn design(&self) -> Reply {
        Err(self.lacks("design"))
    }

    /// Where over a range of frequencies of the dither, in numbers of the equations, the actuator can give what quenches.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::actuator::run`].
    fn actuator(&self, frequencies: Option<(f64, f64)>) -> Reply {
        let _ = frequencies;
        Err(self.lacks("actuator"))
    }

    /// How probable it is that a study with uncertain numbers vibrates.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::probability::run`].
    fn probability(&self, request: ProbabilityRequest, running: Running<'_>) -> Reply {
        let _ = (request, running);
        Err(self.lacks("probability"))
    }

    /// The exact motion as a sensor would record it, which `compare` and `fit --record` set against measurements; `verb` is the one
    /// that asks.
    ///
    /// # Errors
    /// A kind without motion; a start that does not exist.
    fn recorded_motion(&self, verb: &str) -> Result<ObservedMotion, Failure> {
        Err(self.lacks(verb))
    }

    /// Natural frequencies and shapes.
    ///
    /// # Errors
    /// A kind without this verb.
    fn modes(&self) -> Reply {
        Err(self.lacks("modes"))
    }

    /// Speeds at which waves meet.
    ///
    /// # Errors
    /// A kind without this verb; as [`resonances::run`].
    fn resonances(&self, request: resonances::ResonancesRequest) -> Reply {
        let _ = request;
        Err(self.lacks("resonances"))
    }

    /// The error of a verb that the kind does not have.
    fn lacks(&self, verb: &str) -> Failure {
        let mut complaint = not_available(verb, self.kind(), Origin::Whole);
        // An option that the kind lacks, of a verb that it has.
        let named = |name: &&'static str| match verb.strip_prefix(*name) {
            Some(option) if option.starts_with(" --") => format!("{name} without{option}"),
            _ => (*name).to_owned(),
        };
        let names: Vec<String> = self.names().iter().map(named).collect();
        let _ = write!(complaint.allowed, "; its verbs are {}", names.join(", "));
        complaint.into()
    }
}

/// The verbs of a study.
pub fn verbs(study: &Study) -> Box<dyn Verbs> {
    let steady = match study.noise() {
        Some(key) => Box::new(UnderNoise { periodic: of_kind(study), key }),
        None => of_kind(study),
    };
    match study.varies_by() {
        Some(table) => Box::new(OverTime { steady, table }),
        None => steady,
    }
}

fn of_kind(study: &Study) -> Box<dyn Verbs> {
    match study.kind() {
        Kind::Belt(setup) => Box::new(study.narrowed(setup.as_ref())),
        Kind::Disc(setup) => Box::new(study.narrowed(setup.as_ref())),
        Kind::System(setup) => Box::new(study.narrowed(setup.as_ref())),
    }
}

/// The verbs of a study with noise, which are those of runs and of averages (`noise.rs`).
struct UnderNoise {
    /// The verbs of its kind.
    periodic: Box<dyn Verbs>,
    /// The key of the waveform.
    key: String,
}

/// The verbs of a study whose drive, load or dither varies in time, which are those of runs: every other verb is about a steady
/// study. `table` makes it vary.
struct OverTime {
    steady: Box<dyn Verbs>,
    table: &'static str,
}

impl Verbs for OverTime {
    fn kind(&self) -> &'static str {
        self.steady.kind()
    }

    fn names(&self) -> &'static [&'static str] {
        if self.kind() == DiscSetup::NAME {
            &["check", "sketch", "cite", "simulate", "response --window", "compare", "fit --record"]
        } else {
            &[
                "check",
                "sketch",
                "cite",
                "simulate",
                "response --window",
                "bifurcation --ramp",
                "compare",
                "fit --record",
            ]
        }
    }

    fn draws(&self, verb: &str) -> bool {
        self.steady.draws(verb)
    }

    fn check(&self) -> Reply {
        self.steady.check()
    }

    fn sources(&self) -> Sources {
        self.steady.sources()
    }

    fn cite(&self) -> Box<dyn Outcome> {
        self.steady.cite()
    }

    fn simulate(&self, request: &MotionRequest) -> Reply {
        self.steady.simulate(request)
    }

    fn response(&self, request: &ResponseRequest) -> Reply {
        match request.window {
            Some(_) => self.steady.response(request),
            None => Err(self.lacks("response")),
        }
    }

    fn ramp(&self) -> Reply {
        self.steady.ramp()
    }

    fn recorded_motion(&self, verb: &str) -> Result<ObservedMotion, Failure> {
        self.steady.recorded_motion(verb)
    }

    fn lacks(&self, verb: &str) -> Failure {
        varies_in_time(verb, self.table).into()
    }
}

/// The system whose motion `simulate` computes: that of a belt, that of the modes of a disc, or a system itself.
///
/// # Errors
/// A law whose numbers are out of their bounds in the units of the study.
pub fn moving_system(study: &Study) -> Result<SystemStudy, Failure> {
    match study.kind() {
        Kind::Belt(setup) => belt_system::described(&study.narrowed(setup.as_ref())),
        Kind::Disc(setup) => Ok(motion::at_rest(&study.narrowed(setup.as_ref()))),
        Kind::System(setup) => Ok(study.narrowed(setup.as_ref())),
    }
}

/// The system whose motions a verb is about: that of a belt, or a system itself.
///
/// # Errors
/// A kind without the verb; noise, which has no period.
pub fn system_of(study: &Study, verb: &str) -> Result<SystemStudy, Failure> {
    match study.kind() {
        Kind::Belt(setup) => belt_system::of(&study.narrowed(setup.as_ref()), verb),
        Kind::Disc(_) => Err(verbs(study).lacks(verb)),
        Kind::System(setup) => Ok(study.narrowed(setup.as_ref())),
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
