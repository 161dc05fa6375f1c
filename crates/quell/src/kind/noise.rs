//! The verbs of a study with noise: runs, and averages over the distribution of the noise. Every other verb is about a response that
//! repeats, and one refusal names it.

use super::{Reply, UnderNoise, Verbs};
use crate::cite::Sources;
use crate::complaint::Failure;
use crate::outcome::Outcome;
use crate::run::probability::{ProbabilityRequest, ProbabilityStart};
use crate::run::recorded_motion::ObservedMotion;
use crate::run::response::ResponseRequest;
use crate::run::simulate::MotionRequest;
use crate::study::{BeltSetup, not_periodic};
use crate::sweep::Running;

impl Verbs for UnderNoise {
    fn kind(&self) -> &'static str {
        self.periodic.kind()
    }

    fn names(&self) -> &'static [&'static str] {
        match self.periodic.kind() {
            BeltSetup::NAME => &[
                "check",
                "sketch",
                "cite",
                "friction",
                "stability",
                "simulate",
                "response",
                "probability",
                "compare",
                "map",
            ],
            _ => &[
                "check",
                "sketch",
                "cite",
                "modes",
                "friction",
                "stability",
                "resonances",
                "simulate",
                "response",
                "map",
                "compare",
            ],
        }
    }

    fn draws(&self, verb: &str) -> bool {
        self.periodic.draws(verb)
    }

    fn check(&self) -> Reply {
        self.periodic.check()
    }

    fn sources(&self) -> Sources {
        self.periodic.sources()
    }

    fn cite(&self) -> Box<dyn Outcome> {
        self.periodic.cite()
    }

    fn friction(&self, at: Option<Vec<f64>>, measured: bool) -> Reply {
        if measured {
            return Err(self.lacks("friction --measured"));
        }
        self.periodic.friction(at, measured)
    }

    fn describing(&self, largest: f64) -> Reply {
        self.periodic.describing(largest)
    }

    fn stability(&self) -> Reply {
        self.periodic.stability()
    }

    fn probability(&self, request: ProbabilityRequest, running: Running<'_>) -> Reply {
        if self.kind() != BeltSetup::NAME || request.start != ProbabilityStart::Averaged {
            return Err(self.lacks("probability"));
        }
        self.periodic.probability(request, running)
    }

    fn modes(&self) -> Reply {
        self.periodic.modes()
    }

    fn reach(&self, frequencies: Option<(f64, f64)>) -> Reply {
        self.periodic.reach(frequencies)
    }

    fn simulate(&self, request: &MotionRequest) -> Reply {
        self.periodic.simulate(request)
    }

    fn response(&self, request: &ResponseRequest) -> Reply {
        self.periodic.response(request)
    }

    fn recorded_motion(&self, verb: &str) -> Result<ObservedMotion, Failure> {
        self.periodic.recorded_motion(verb)
    }

    fn lacks(&self, verb: &str) -> Failure {
        not_periodic(verb, self.key.as_str()).into()
    }
}
