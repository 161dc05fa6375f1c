//! The verbs of a system.

use serde_json::Value as Json;

use super::{Reply, Verbs, answer};
use crate::cite::{self, Sources};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::outcome::check::Valid;
use crate::outcome::{Answered, Outcome};
use crate::run::curves::CurvesRequest;
use crate::run::system::tracked::TrackRequest;
use crate::run::system::{exact, measured, modes, reach, stability, tracked};
use crate::run::thresholds::ThresholdsRequest;
use crate::study::{SystemSetup, SystemStudy};

impl Verbs for SystemStudy {
    fn kind(&self) -> &'static str {
        SystemSetup::NAME
    }

    fn names(&self) -> &'static [&'static str] {
        &["check", "cite", "modes", "stability", "thresholds", "resonances", "map"]
    }

    fn check(&self) -> Box<dyn Outcome> {
        Box::new(Answered::new(self, Valid))
    }

    fn sources(&self) -> Sources {
        cite::sources_of_system(self)
    }

    fn cite(&self) -> Box<dyn Outcome> {
        Box::new(Answered::new(self, self.sources()))
    }

    fn modes(&self) -> Reply {
        needs_matrices(self, "modes")?;
        answer(self, modes::run(self))
    }

    fn stability(&self) -> Reply {
        match self.frequency_response() {
            Some(response) => answer(self, measured::run(self, response)),
            None => answer(self, stability::run(self)),
        }
    }

    fn exact_stability(&self) -> Reply {
        needs_matrices(self, "stability --exact")?;
        answer(self, exact::run(self))
    }

    fn tracked_stability(&self, request: &TrackRequest) -> Reply {
        needs_matrices(self, "stability --parameter")?;
        answer(self, tracked::run(self, request))
    }

    fn reach(&self, frequencies: Option<(f64, f64)>) -> Reply {
        needs_matrices(self, "resonances")?;
        answer(self, reach::run(self, frequencies))
    }

    fn thresholds(&self, request: ThresholdsRequest) -> Reply {
        let ThresholdsRequest { parameter, from, to, .. } = request;
        let request = TrackRequest { parameter, window: (from, to), along: None };
        needs_matrices(self, "thresholds")?;
        answer(self, tracked::thresholds(self, &request))
    }

    fn threshold_curves(&self, request: &CurvesRequest) -> Reply {
        let CurvesRequest { parameter, window, along, between } = request.clone();
        let request = TrackRequest { parameter, window, along: Some((along, between)) };
        needs_matrices(self, "thresholds")?;
        answer(self, tracked::thresholds(self, &request))
    }
}

/// Refuses a verb that a measured frequency response cannot answer.
fn needs_matrices(study: &SystemStudy, verb: &str) -> Result<(), Failure> {
    if study.frequency_response().is_none() {
        return Ok(());
    }
    let key = "system.frequency_response";
    let allowed = format!(
        "{verb} needs masses and stiffness or modes; a measured frequency response gives the verdict of `stability` alone"
    );
    Err(Complaint::new(Fault::Conflict, key, Origin::Whole, Json::Null, allowed).into())
}
