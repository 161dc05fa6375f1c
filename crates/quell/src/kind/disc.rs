//! The verbs of a disc.

use super::{Reply, Verbs, answer};
use crate::cite::{self, Sources};
use crate::complaint::Failure;
use crate::outcome::check::Valid;
use crate::outcome::{Answered, Outcome};
use crate::run::disc::{design, modes, motion, resonances, stability};
use crate::run::probability;
use crate::run::recorded_motion::ObservedMotion;
use crate::run::response::ResponseRequest;
use crate::run::simulate::MotionRequest;
use crate::study::{DiscSetup, DiscStudy};
use crate::sweep::Running;

impl Verbs for DiscStudy {
    fn kind(&self) -> &'static str {
        DiscSetup::NAME
    }

    fn names(&self) -> &'static [&'static str] {
        &[
            "check",
            "sketch",
            "report",
            "cite",
            "modes",
            "stability",
            "simulate",
            "response --window",
            "design",
            "probability",
            "resonances",
            "compare",
            "fit --record",
            "map",
        ]
    }

    fn check(&self) -> Reply {
        answer(self, Ok(Valid))
    }

    fn sources(&self) -> Sources {
        cite::sources_of_disc(self)
    }

    fn cite(&self) -> Box<dyn Outcome> {
        Box::new(Answered::new(self, self.sources()))
    }

    fn stability(&self) -> Reply {
        answer(self, stability::run(self))
    }

    fn simulate(&self, request: &MotionRequest) -> Reply {
        answer(self, motion::run(self, request))
    }

    fn response(&self, request: &ResponseRequest) -> Reply {
        // Its vibration without dither grows without bound or dies out: there is no steady one to compare with.
        match request.window {
            Some(_) => Verbs::response(&motion::disturbed(self)?, request),
            None => Err(self.lacks("response")),
        }
    }

    fn design(&self) -> Reply {
        answer(self, design::run(self))
    }

    fn probability(&self, request: probability::ProbabilityRequest, running: Running<'_>) -> Reply {
        answer(self, probability::run(self, request, running))
    }

    fn recorded_motion(&self, verb: &str) -> Result<ObservedMotion, Failure> {
        ObservedMotion::of(&motion::at_rest(self), verb)
    }

    fn modes(&self) -> Reply {
        answer(self, Ok(modes::run(self)))
    }

    fn resonances(&self, request: resonances::ResonancesRequest) -> Reply {
        answer(self, resonances::run(self, request))
    }
}
