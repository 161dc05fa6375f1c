//! The verbs of each kind of study, and one error for a verb that a kind does not have.
//!
//! The command line and Python call [`verbs`] for a study of any kind; a kind implements the verbs that it has. A new kind
//! needs a file here, its parser in `quell-study`, and its map points in [`crate::sweep`] if it has maps.

use serde_json::Value as Json;

use crate::cite::Sources;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::outcome::Outcome;
use crate::run::disc::resonances;
use crate::run::orbit::Wanted;
use crate::run::{basins, bifurcation, curves, simulate, thresholds};
use crate::study::{Kind, Study};
use crate::sweep::Running;

mod belt;
mod disc;
mod system;

/// The answer of a verb, or why it failed.
pub type Reply = Result<Box<dyn Outcome>, Failure>;

/// The verbs of one study. A verb that its kind does not implement returns an error that names it.
pub trait Verbs: Send + Sync {
    /// Name of the kind.
    fn kind(&self) -> &'static str;

    /// Names of the verbs of the kind.
    fn names(&self) -> &'static [&'static str];

    /// The values of the study.
    fn check(&self) -> Box<dyn Outcome>;

    /// The equations and papers that the study's computations use.
    fn sources(&self) -> Sources;

    /// [`Verbs::sources`] as an answer.
    fn cite(&self) -> Box<dyn Outcome>;

    /// The friction law and the effective friction, at these slip velocities or on a grid.
    ///
    /// # Errors
    /// A kind without this verb.
    fn friction(&self, at: Option<Vec<f64>>) -> Reply {
        let _ = at;
        Err(self.lacks("friction"))
    }

    /// Stability of steady sliding.
    ///
    /// # Errors
    /// A kind without this verb; numbers that overflow.
    fn stability(&self) -> Reply {
        Err(self.lacks("stability"))
    }

    /// One trajectory up to τ = `until`.
    ///
    /// # Errors
    /// A kind without this verb; as [`simulate::run`].
    fn simulate(&self, until: f64, options: simulate::Options) -> Reply {
        let _ = (until, options);
        Err(self.lacks("simulate"))
    }

    /// The steady response.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::response::run`].
    fn response(&self) -> Reply {
        Err(self.lacks("response"))
    }

    /// A periodic response and its multipliers.
    ///
    /// # Errors
    /// A kind without this verb; as [`crate::run::orbit::run`].
    fn orbit(&self, wanted: Wanted) -> Reply {
        let _ = wanted;
        Err(self.lacks("orbit"))
    }

    /// Thresholds of one parameter.
    ///
    /// # Errors
    /// A kind without this verb; as [`thresholds::run`].
    fn thresholds(&self, request: thresholds::ThresholdsRequest) -> Reply {
        let _ = request;
        Err(self.lacks("thresholds"))
    }

    /// Curves of thresholds in two parameters.
    ///
    /// # Errors
    /// A kind without this verb; as [`curves::run`].
    fn threshold_curves(&self, request: &curves::CurvesRequest) -> Reply {
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
        let (kind, names) = (self.kind(), self.names().join(", "));
        let allowed = format!("{verb} is not available for a {kind} study; its verbs are {names}");
        Complaint::new(Fault::Conflict, kind, Origin::Whole, Json::Null, allowed).into()
    }
}

/// The verbs of a study.
///
/// # Errors
/// None of today's kinds: a kind that has no verbs would be refused.
pub fn verbs(study: &Study) -> Result<Box<dyn Verbs>, Failure> {
    Ok(match study.kind() {
        Kind::Belt(_) => Box::new(study.belt()?),
        Kind::Disc(_) => Box::new(study.disc()?),
        Kind::System(_) => Box::new(study.system()?),
    })
}
