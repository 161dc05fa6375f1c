//! The verbs of a belt.

use quell_model::units::Quantity;

use super::{Reply, Verbs, answer};
use crate::cite::{self, Sources};
use crate::complaint::Failure;
use crate::contact_state::refused_of_belt;
use crate::outcome::{Answered, Outcome};
use crate::run::found_attractor::AttractorRequest;
use crate::run::recorded_motion::ObservedMotion;
use crate::run::response::ResponseRequest;
use crate::run::simulate::MotionRequest;
use crate::run::thresholds::ThresholdsRequest;
use crate::run::thresholds::curves::CurvesRequest;
use crate::run::{atlas, basins, belt_system, bifurcation, orbit, probability};
use crate::study::{BeltSetup, BeltStudy};
use crate::sweep::Running;

impl Verbs for BeltStudy {
    fn kind(&self) -> &'static str {
        BeltSetup::NAME
    }

    fn names(&self) -> &'static [&'static str] {
        &[
            "check",
            "sketch",
            "report",
            "cite",
            "friction",
            "stability",
            "simulate",
            "response",
            "orbit",
            "attractor",
            "thresholds",
            "atlas",
            "waveforms",
            "design",
            "actuator",
            "probability",
            "bifurcation",
            "basins",
            "compare",
            "fit --record",
            "map",
        ]
    }

    fn check(&self) -> Reply {
        belt_system::checked(self)?.check()
    }

    fn sources(&self) -> Sources {
        cite::sources(self)
    }

    fn cite(&self) -> Box<dyn Outcome> {
        Box::new(Answered::new(self, self.sources()))
    }

    fn friction(&self, at: Option<Vec<f64>>, measured: bool) -> Reply {
        // The slip velocities come in the numbers of the equations.
        let one = self.scales().map_or(1.0, |scales| scales.to_units(Quantity::Velocity, 1.0));
        let at = at.map(|at| at.into_iter().map(|v| one * v).collect());
        belt_system::described(self)?.friction(at, measured)
    }

    fn describing(&self, largest: f64) -> Reply {
        // The amplitude comes in the numbers of the equations.
        let one = self.scales().map_or(1.0, |scales| scales.to_units(Quantity::Velocity, 1.0));
        belt_system::described(self)?.describing(one * largest)
    }

    fn stability(&self) -> Reply {
        belt_system::described(self)?.stability()
    }

    fn simulate(&self, request: &MotionRequest) -> Reply {
        Verbs::simulate(&belt_system::described(self)?, request)
    }

    fn response(&self, request: &ResponseRequest) -> Reply {
        Verbs::response(&belt_system::described(self)?, request)
    }

    fn recorded_motion(&self, verb: &str) -> Result<ObservedMotion, Failure> {
        belt_system::described(self)?.recorded_motion(verb)
    }

    fn ramp(&self) -> Reply {
        belt_system::of(self, "bifurcation --ramp")?.ramp()
    }

    fn attractor(&self, request: &AttractorRequest) -> Reply {
        belt_system::of(self, "attractor")?.attractor(request)
    }

    fn orbit(&self, wanted: &orbit::Wanted) -> Reply {
        belt_system::of(self, "orbit")?.orbit(wanted)
    }

    fn thresholds(&self, request: &ThresholdsRequest) -> Reply {
        belt_system::of(self, "thresholds")?.thresholds(request)
    }

    fn threshold_curves(&self, request: &CurvesRequest) -> Reply {
        belt_system::of(self, "thresholds")?.threshold_curves(request)
    }

    fn design(&self) -> Reply {
        refused_of_belt(self, "design")?;
        Verbs::design(&belt_system::described(self)?)
    }

    fn actuator(&self, frequencies: Option<(f64, f64)>) -> Reply {
        refused_of_belt(self, "actuator")?;
        // The frequencies come as ratios.
        let time = self.scales().map_or(1.0, |scales| scales.to_units(Quantity::Time, 1.0));
        let frequencies = frequencies.map(|(from, to)| (from / time, to / time));
        Verbs::actuator(&belt_system::described(self)?, frequencies)
    }

    fn probability(&self, request: probability::ProbabilityRequest, running: Running<'_>) -> Reply {
        Verbs::probability(&belt_system::described(self)?, request, running)
    }

    fn atlas(&self, exact: bool) -> Reply {
        answer(self, atlas::run(self, exact))
    }

    fn waveforms(&self) -> Reply {
        belt_system::of(self, "waveforms")?.waveforms()
    }

    fn bifurcation(&self, request: &bifurcation::SweepRequest, running: Running<'_>) -> Reply {
        belt_system::of(self, "bifurcation")?.bifurcation(request, running)
    }

    fn basins(&self, request: &basins::BasinsRequest, running: Running<'_>) -> Reply {
        belt_system::of(self, "basins")?.basins(request, running)
    }
}
