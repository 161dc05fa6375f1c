//! Maps of systems: growth rates without dither and by averaging, critical amplitudes, and the quantities read from them.

use quell_dynamics::motion::orbit::family::NoImage;
use quell_dynamics::motion::orbit::{NoMotionOrbit, base_motion};
use quell_dynamics::orbit::OrbitVerdict;
use quell_linear::averaging::{Becomes, CriticalInput, DitheredContact, DitheredSystem, NoAverage};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;
use quell_model::System;
use quell_model::units;

use super::evaluate::{Computation, Results, SystemOrbitPoint, SystemPoint};
use super::grid::Grid;
use super::mapped::{Mapped, PointResults};
use super::quantity::{MapQuantity, VERDICTS, Variable, VariableKind, decided, variable};
use super::status::Status;
use crate::range::outside_of_laws;
use crate::run::system::cycle::BASE_STEPS;
use crate::study::{SystemSetup, SystemStudy};

/// Seconds of one growth rate of ten states, and how often a search of critical amplitudes computes one.
const GROWTH: f64 = 5e-5;
const SEARCH: f64 = 300.0;

/// Seconds in which the base response of four states is followed.
const ORBIT: f64 = 3e-2;

/// Maps of studies of systems.
pub(super) struct SystemPoints(SystemStudy);

impl SystemPoints {
    pub(super) fn of(study: SystemStudy) -> Self {
        Self(study)
    }
}

impl Mapped for SystemPoints {
    fn quantities(&self) -> &'static [MapQuantity] {
        QUANTITIES
    }

    fn seconds(&self, wanted: &[Computation]) -> f64 {
        let states = self.0.system().structure.state_size() as f64;
        let growth = GROWTH * (states / 10.0).powi(2).max(0.1);
        let each = wanted.iter().map(|computation| match computation {
            Computation::SystemCritical => SEARCH * growth,
            Computation::SystemOrbit => ORBIT * (states / 4.0).powi(2).max(0.1),
            _ => growth,
        });
        each.sum()
    }

    fn compute(
        &self,
        grid: &Grid,
        indices: &[usize],
        wanted: &[Computation],
    ) -> Vec<Option<PointResults>> {
        let point = |index: &usize| {
            let system = self.0.system_at(&grid.numbers_at(*index)).ok()?;
            let measured = self.0.frequency_response().is_some();
            Some((None, if measured { unmeasured() } else { evaluate(&system, wanted) }))
        };
        indices.iter().map(point).collect()
    }
}

/// What a map shows of a measured structure: nothing.
fn unmeasured() -> Results {
    Results {
        system: Some(Err(Status::OnlyMeasured)),
        system_undithered: Some(Err(Status::OnlyMeasured)),
        system_critical: Some(Err(Status::OnlyMeasured)),
        system_orbit: Some(Err(Status::OnlyMeasured)),
        ..Results::default()
    }
}

fn evaluate(system: &System, wanted: &[Computation]) -> Results {
    let mut results = Results::default();
    for computation in wanted {
        match computation {
            Computation::SystemGrowth => results.system = Some(growth(system)),
            Computation::SystemGrowthUndithered => {
                results.system_undithered = Some(undithered(system));
            }
            Computation::SystemCritical => results.system_critical = Some(critical(system)),
            Computation::SystemOrbit => results.system_orbit = Some(base_response(system)),
            // A quantity of the steady response gets its computation here.
            _ => {}
        }
    }
    results
}

fn undithered(system: &System) -> Result<SystemPoint, Status> {
    let linear = Linearised::new(system).map_err(|_| Status::NoSteadySliding)?;
    let growth = spectrum::growth(&linear, &linear.friction()).map_err(|_| Status::NotFinite)?;
    let beyond_range = !outside_of_laws(system, None).is_empty();
    Ok(SystemPoint { growth, slip_ratio: 0.0, opens: false, beyond_range })
}

fn growth(system: &System) -> Result<SystemPoint, Status> {
    let average = DitheredSystem::new(system).and_then(|prepared| prepared.average());
    let average = average.map_err(|why| status(&why))?;
    let growth = average.growth().map_err(|_| Status::NotFinite)?;
    let contacts = system.contacts.iter().zip(&average.contacts);
    let ratios = contacts
        .map(|(contact, found)| found.slip_amplitude / contact.surface_velocity.mean().abs());
    Ok(SystemPoint {
        growth,
        slip_ratio: ratios.fold(0.0, f64::max),
        opens: average.contacts.iter().any(DitheredContact::opens),
        beyond_range: !outside_of_laws(system, Some(&average.contacts)).is_empty(),
    })
}

fn critical(system: &System) -> Result<Vec<CriticalInput>, Status> {
    if system.inputs.is_empty() {
        return Err(Status::NoDither);
    }
    let found = DitheredSystem::new(system).and_then(|prepared| prepared.critical_amplitudes(0));
    found.map_err(|why| status(&why))
}

fn base_response(system: &System) -> Result<SystemOrbitPoint, Status> {
    match base_motion(system, BASE_STEPS) {
        Ok(orbit) => Ok(SystemOrbitPoint { radius: orbit.radius(), verdict: orbit.verdict() }),
        Err(NoMotionOrbit::NoDither) => Err(Status::NoDither),
        Err(NoMotionOrbit::NoSliding(_)) => Err(Status::NoSteadySliding),
        Err(NoMotionOrbit::NoImage(NoImage::Stopped(_))) => Err(Status::Stalled),
        Err(_) => Err(Status::NoBaseResponse),
    }
}

fn status(why: &NoAverage) -> Status {
    match why {
        NoAverage::NoSteadySliding(_) => Status::NoSteadySliding,
        NoAverage::Resonance { .. } => Status::Resonance,
        NoAverage::TooManyFrequencies { .. } => Status::TooManyGroups,
        NoAverage::Mean(why) => why.into(),
        NoAverage::Eigenvalues(_) => Status::NotFinite,
    }
}

const RATE: VariableKind = VariableKind::SystemRate;
const FORCE: VariableKind = VariableKind::SystemForce;
const RATIO: VariableKind = VariableKind::Number(units::Quantity::Ratio);

/// Statuses of averages other than known.
const OF_AVERAGE: &[Status] = &[
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoSteadySliding,
    Status::Resonance,
    Status::OnlyMeasured,
    Status::Opens,
];

/// Statuses of verdicts other than known.
const OF_VERDICT: &[Status] = &[
    Status::WithinError,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoSteadySliding,
    Status::Resonance,
    Status::OnlyMeasured,
    Status::Opens,
];

/// Statuses of critical amplitudes other than known.
const OF_CRITICAL: &[Status] = &[
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
    Status::NeverChanges,
    Status::NoSteadySliding,
    Status::Resonance,
    Status::OnlyMeasured,
    Status::Opens,
];

/// Statuses of base responses other than known.
const OF_ORBIT: &[Status] = &[
    Status::Stalled,
    Status::NoDither,
    Status::NoSteadySliding,
    Status::OnlyMeasured,
    Status::NoBaseResponse,
];

/// Statuses of verdicts on base responses other than known.
const OF_ORBIT_VERDICT: &[Status] = &[
    Status::Stalled,
    Status::WithinError,
    Status::NoDither,
    Status::NoSteadySliding,
    Status::OnlyMeasured,
    Status::NoBaseResponse,
];

/// The quantities of a map of systems.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    system("growth", "largest growth rate, by averaging under dither, its verdict and the bound on its error", Computation::SystemGrowth, &[
        variable(("growth", "Re λ"), "largest growth rate", RATE, OF_AVERAGE, |r| Ok(grown(r)?.growth.rate)),
        variable(("growth_error", ""), "bound on the error of the growth rate", RATE, OF_AVERAGE, |r| Ok(grown(r)?.growth.error)),
        variable(("growth_verdict", ""), "whether the sign of the growth rate is certain within its error", VERDICTS, OF_VERDICT, |r| decided(grown(r)?.growth)),
    ]),
    system("frequency", "angular frequency of the fastest growing motion", Computation::SystemGrowth, &[
        variable(("frequency", "Im λ"), "angular frequency of the fastest growing motion", RATE, OF_AVERAGE, |r| Ok(grown(r)?.growth.frequency)),
    ]),
    system("verdict", "verdict on steady sliding: stable or unstable, undecided within its error", Computation::SystemGrowth, &[
        variable(("verdict", ""), "verdict on steady sliding", VERDICTS, OF_VERDICT, |r| decided(grown(r)?.growth)),
    ]),
    system("slip-ratio", "largest fast slip velocity over the velocity of its surface: from 1 on a contact reverses", Computation::SystemGrowth, &[
        variable(("slip_ratio", "|â|/v"), "largest fast slip over the velocity of its surface", RATIO, OF_AVERAGE, |r| Ok(grown(r)?.slip_ratio)),
    ]),
    system("growth-undithered", "largest growth rate without dither", Computation::SystemGrowthUndithered, &[
        variable(("growth_undithered", "Re λ_0"), "largest growth rate without dither", RATE, &[Status::NoSteadySliding, Status::OnlyMeasured], |r| Ok(grown_undithered(r)?.growth.rate)),
        variable(("growth_undithered_error", ""), "bound on the error of the growth rate without dither", RATE, &[Status::NoSteadySliding, Status::OnlyMeasured], |r| Ok(grown_undithered(r)?.growth.error)),
    ]),
    system("critical-amplitude", "smallest amplitude of the first dither that makes sliding stable, by averaging", Computation::SystemCritical, &[
        variable(("critical_amplitude", "A*"), "smallest amplitude that makes sliding stable", FORCE, OF_CRITICAL, |r| first(r, Becomes::Stable)),
    ]),
    system("destabilising-amplitude", "smallest amplitude of the first dither that makes sliding unstable, by averaging", Computation::SystemCritical, &[
        variable(("destabilising_amplitude", "A°"), "smallest amplitude that makes sliding unstable", FORCE, OF_CRITICAL, |r| first(r, Becomes::Unstable)),
    ]),
    system("orbit-verdict", "verdict on the base response by its multipliers", Computation::SystemOrbit, &[
        variable(("orbit_verdict", ""), "verdict on the base response by its multipliers", VERDICTS, OF_ORBIT_VERDICT, judged),
    ]),
    system("orbit-radius", "modulus of the deciding multiplier of the base response: stable below 1", Computation::SystemOrbit, &[
        variable(("orbit_radius", "|λ|"), "modulus of the deciding multiplier", RATIO, OF_ORBIT, |r| Ok(orbit(r)?.radius)),
    ]),
];

const fn system(
    name: &'static str,
    about: &'static str,
    computation: Computation,
    variables: &'static [Variable],
) -> MapQuantity {
    MapQuantity { name, about, kind: SystemSetup::NAME, computation, variables }
}

fn grown(results: &Results) -> Result<SystemPoint, Status> {
    results.system.unwrap_or(Err(Status::Missing))
}

fn grown_undithered(results: &Results) -> Result<SystemPoint, Status> {
    results.system_undithered.unwrap_or(Err(Status::Missing))
}

fn orbit(results: &Results) -> Result<SystemOrbitPoint, Status> {
    results.system_orbit.unwrap_or(Err(Status::Missing))
}

fn judged(results: &Results) -> Result<f64, Status> {
    match orbit(results)?.verdict {
        OrbitVerdict::Unstable => Ok(0.0),
        OrbitVerdict::Stable => Ok(1.0),
        OrbitVerdict::Undecided => Err(Status::WithinError),
    }
}

fn first(results: &Results, becomes: Becomes) -> Result<f64, Status> {
    let found = results.system_critical.as_ref().ok_or(Status::Missing)?;
    let found = found.as_ref().map_err(|status| *status)?;
    let first = found.iter().find(|critical| critical.becomes == becomes);
    first.map(|critical| critical.amplitude).ok_or(Status::NeverChanges)
}
