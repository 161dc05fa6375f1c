//! The verbs of a system.

use super::{Reply, Verbs, answer};
use crate::cite::{self, Sources};
use crate::complaint::Failure;
use crate::outcome::check::Valid;
use crate::outcome::{Answered, Outcome};
use crate::run::basins::{self, BasinsRequest};
use crate::run::bifurcation::SweepRequest;
use crate::run::found_attractor::AttractorRequest;
use crate::run::orbit::Wanted;
use crate::run::recorded_motion::ObservedMotion;
use crate::run::response::ResponseRequest;
use crate::run::simulate::MotionRequest;
use crate::run::system::tracked::TrackRequest;
use crate::run::system::{design, exact, measured, modes, reach, tracked};
use crate::run::thresholds::curves::{self, CurvesRequest};
use crate::run::thresholds::{ThresholdsRequest, by_eigenvalues};
use crate::run::{
    actuator, bifurcation, describing, found_attractor, friction, noise_response, orbit,
    probability, ramp, response, simulate, stability, thresholds, waveforms, window,
};
use crate::study::{SystemSetup, SystemStudy};
use crate::sweep::Running;

impl Verbs for SystemStudy {
    fn kind(&self) -> &'static str {
        SystemSetup::NAME
    }

    fn names(&self) -> &'static [&'static str] {
        &[
            "check",
            "sketch",
            "report",
            "cite",
            "modes",
            "friction",
            "stability",
            "simulate",
            "response",
            "orbit",
            "attractor",
            "thresholds",
            "waveforms",
            "design",
            "actuator",
            "probability",
            "bifurcation",
            "basins",
            "resonances",
            "compare",
            "fit --record",
            "map",
        ]
    }

    fn draws(&self, verb: &str) -> bool {
        match verb {
            "check" | "cite" | "stability --exact" => false,
            "stability" => self.frequency_response().is_none(),
            _ => true,
        }
    }

    fn check(&self) -> Reply {
        answer(self, Ok(Valid))
    }

    fn sources(&self) -> Sources {
        cite::sources_of_system(self)
    }

    fn cite(&self) -> Box<dyn Outcome> {
        Box::new(Answered::new(self, self.sources()))
    }

    fn friction(&self, at: Option<Vec<f64>>, measured: bool) -> Reply {
        answer(self, friction::run(self, at.as_deref(), measured))
    }

    fn describing(&self, largest: f64) -> Reply {
        answer(self, describing::run(self, largest))
    }

    fn waveforms(&self) -> Reply {
        answer(self, waveforms::run(self))
    }

    fn design(&self) -> Reply {
        answer(self, design::run(self))
    }

    fn actuator(&self, frequencies: Option<(f64, f64)>) -> Reply {
        answer(self, actuator::run(self, frequencies))
    }

    fn probability(&self, request: probability::ProbabilityRequest, running: Running<'_>) -> Reply {
        answer(self, probability::run(self, request, running))
    }

    fn modes(&self) -> Reply {
        answer(self, modes::run(self))
    }

    fn stability(&self) -> Reply {
        match self.frequency_response() {
            Some(response) => answer(self, measured::run(self, response)),
            None => answer(self, stability::run(self)),
        }
    }

    fn exact_stability(&self) -> Reply {
        answer(self, exact::run(self))
    }

    fn tracked_stability(&self, request: &TrackRequest) -> Reply {
        answer(self, tracked::run(self, request))
    }

    fn reach(&self, frequencies: Option<(f64, f64)>) -> Reply {
        answer(self, reach::run(self, frequencies))
    }

    fn simulate(&self, request: &MotionRequest) -> Reply {
        answer(self, simulate::run(self, request))
    }

    fn response(&self, request: &ResponseRequest) -> Reply {
        if let Some(window) = request.window {
            return answer(self, window::run(self, window));
        }
        if request.seeds.is_some() || self.system().has_noise() {
            return answer(self, noise_response::run(self, *request));
        }
        answer(self, response::run(self, *request))
    }

    fn recorded_motion(&self, verb: &str) -> Result<ObservedMotion, Failure> {
        ObservedMotion::of(self, verb)
    }

    fn orbit(&self, wanted: &Wanted) -> Reply {
        answer(self, orbit::run(self, wanted))
    }

    fn attractor(&self, request: &AttractorRequest) -> Reply {
        answer(self, found_attractor::run(self, request))
    }

    fn thresholds(&self, request: &ThresholdsRequest) -> Reply {
        if by_eigenvalues(self, request)? {
            return answer(self, tracked::run(self, &request.tracked()));
        }
        answer(self, thresholds::run(self, request))
    }

    fn bifurcation(&self, request: &SweepRequest, running: Running<'_>) -> Reply {
        answer(self, bifurcation::run(self, request, running))
    }

    fn ramp(&self) -> Reply {
        answer(self, ramp::run(self))
    }

    fn basins(&self, request: &BasinsRequest, running: Running<'_>) -> Reply {
        answer(self, basins::run(self, request, running))
    }

    fn threshold_curves(&self, request: &CurvesRequest) -> Reply {
        if curves::is_dithered_in(self, request) {
            return answer(self, curves::run(self, request));
        }
        // Without dither the thresholds are those of steady sliding.
        answer(self, tracked::run(self, &curves::tracked(request)))
    }
}
