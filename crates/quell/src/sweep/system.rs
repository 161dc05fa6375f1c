//! Maps of systems: growth rates without dither and by averaging, critical amplitudes, base responses, the motions on which runs
//! end, steady responses, and the quantities read from them.

use quell_dynamics::attractor::end_of_run;
use quell_dynamics::motion::orbit::family::NoImage;
use quell_dynamics::motion::orbit::{BASE_STEPS, NoMotionOrbit, base_motion};
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::response::Effect;
use quell_linear::averaging::{Becomes, CriticalInput, DitheredContact, DitheredSystem};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;
use quell_model::units;
use quell_model::{Contact, System};

use super::evaluate::{
    Computation, Results, SystemEndPoint, SystemOrbitPoint, SystemPoint, SystemResponsePoint,
};
use super::grid::Grid;
use super::mapped::{Mapped, PointResults, PointScales};
use super::quantity::{MapQuantity, VERDICTS, Variable, VariableKind, decided, variable};
use super::quench::quench_numbers;
use super::quench_variables as quench;
use super::status::Status;
use crate::complaint::Failure;
use crate::contact_state::averaged_without_states;
use crate::range::outside_of_laws;
use crate::run::protocol::Protocol;
use crate::run::response::{self, ResponseRequest};
use crate::run::system::of_runs::beyond_laws;
use crate::study::{SystemSetup, SystemStudy};

/// Seconds of one growth rate of ten states, and how often a search of critical amplitudes computes one.
const GROWTH: f64 = 5e-5;
const SEARCH: f64 = 300.0;

/// Seconds in which the base response of four states is followed.
const ORBIT: f64 = 3e-2;

/// Seconds in which it is followed over the amplitude of a dither.
const QUENCH_COST: f64 = 1e-1;

/// Seconds of a run of four states to the motion on which it ends, and of a steady response with and without dither.
const END: f64 = 2e-2;
const RESPONSE: f64 = 1e-1;

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
        let states = self.0.system().state_size() as f64;
        let growth = GROWTH * (states / 10.0).powi(2).max(0.1);
        let each = wanted.iter().map(|computation| match computation {
            Computation::SystemCritical => SEARCH * growth,
            Computation::SystemQuench => {
                SEARCH * growth + QUENCH_COST * (states / 4.0).powi(2).max(0.1)
            }
            Computation::SystemOrbit => ORBIT * (states / 4.0).powi(2).max(0.1),
            Computation::SystemEnd => END * (states / 4.0).powi(2).max(0.1),
            Computation::SystemResponse => RESPONSE * (states / 4.0).powi(2).max(0.1),
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
            let numbers = grid.numbers_at(*index);
            let system = self.0.model().at(&numbers).ok()?;
            if self.0.frequency_response().is_some() {
                return Some((PointScales::Own, unmeasured()));
            }
            let mut results = evaluate(&system, wanted);
            // Runs have a start, which a study gives.
            let runs = [Computation::SystemEnd, Computation::SystemResponse];
            if wanted.iter().any(|computation| runs.contains(computation)) {
                let study = grid.study_at(*index).ok()?.system().ok()?;
                if wanted.contains(&Computation::SystemEnd) {
                    results.system_end = Some(end(&study, &system));
                }
                if wanted.contains(&Computation::SystemResponse) {
                    results.system_response = Some(steady_response(&study));
                }
            }
            Some((PointScales::Own, results))
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
        quench: Some(Err(Status::OnlyMeasured)),
        system_orbit: Some(Err(Status::OnlyMeasured)),
        system_end: Some(Err(Status::OnlyMeasured)),
        system_response: Some(Err(Status::OnlyMeasured)),
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
            Computation::SystemQuench => {
                results.quench = Some(quench_numbers(system, 0));
            }
            Computation::SystemOrbit => results.system_orbit = Some(base_response(system)),
            _ => {}
        }
    }
    results
}

fn undithered(system: &System) -> Result<SystemPoint, Status> {
    let linear = Linearised::new(system).map_err(|_| Status::NoSteadySliding)?;
    let growth = spectrum::growth(&linear, &linear.friction()).map_err(|_| Status::NotFinite)?;
    let beyond_range = !outside_of_laws(system, crate::words::digits, None).is_empty();
    Ok(SystemPoint { growth, slip_ratio: 0.0, opens: false, beyond_range, without_state: false })
}

/// The largest growth rate of a system, by averaging under dither.
pub(crate) fn growth(system: &System) -> Result<SystemPoint, Status> {
    let average = DitheredSystem::new(system).and_then(|prepared| prepared.average());
    let average = average.map_err(|why| Status::from(&why))?;
    let growth = average.growth().map_err(|_| Status::NotFinite)?;
    let contacts = system.contacts.iter().zip(&average.contacts);
    let ratios = contacts
        .map(|(contact, found)| found.slip_amplitude / contact.surface_velocity.mean().abs());
    Ok(SystemPoint {
        growth,
        slip_ratio: ratios.fold(0.0, f64::max),
        opens: average.contacts.iter().any(DitheredContact::opens),
        beyond_range: !outside_of_laws(system, crate::words::digits, Some(&average.contacts))
            .is_empty(),
        without_state: !averaged_without_states(system, &average.contacts).is_empty(),
    })
}

fn critical(system: &System) -> Result<Vec<(CriticalInput, bool)>, Status> {
    if system.inputs.is_empty() {
        return Err(Status::NoDither);
    }
    let prepared = DitheredSystem::new(system).map_err(|why| Status::from(&why))?;
    let found = prepared.critical_amplitudes(0).map_err(|why| Status::from(&why))?;
    let differs = |critical: &CriticalInput| {
        let average = prepared.average_with(Some((0, critical.amplitude)));
        average.is_ok_and(|at| !averaged_without_states(system, &at.contacts).is_empty())
    };
    Ok(found.into_iter().map(|critical| (critical, differs(&critical))).collect())
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

/// The motion on which the run from the start of a study ends.
fn end(study: &SystemStudy, system: &System) -> Result<SystemEndPoint, Status> {
    let start = Protocol::Study.state(study, system).map_err(|_| Status::NoSquealingStart)?;
    let end = end_of_run(system, &study.observe(), &start);
    let attractor = end.map_err(|_| Status::Stalled)?.attractor;
    let sticks = |contact: &Contact| contact.friction.bristles().is_none();
    let shares = system.contacts.iter().zip(&attractor.stick);
    let most = shares
        .filter(|(contact, _)| sticks(contact))
        .map(|(_, share)| *share)
        .max_by(f64::total_cmp);
    Ok(SystemEndPoint {
        kind: attractor.kind_code(),
        peak_to_peak: attractor.size(),
        stick_fraction: most.ok_or(Status::NeverSticks),
    })
}

/// The steady response of a study, as `response` measures it.
fn steady_response(study: &SystemStudy) -> Result<SystemResponsePoint, Status> {
    let found = response::run(study, ResponseRequest::default()).map_err(|why| match why {
        Failure::Wrong(_) => Status::InvalidStudy,
        Failure::Failed { .. } => Status::Stalled,
    })?;
    let response = &found.response;
    Ok(SystemResponsePoint {
        residual_vibration: response.residual_vibration,
        effect: response.effect,
        amplitude: response.dithered.lines.whole,
        undithered_amplitude: response.undithered.lines.whole,
        beyond_range: !beyond_laws(study, |contact| response.largest_slip(contact)).is_empty(),
    })
}

const RATE: VariableKind = VariableKind::SystemRate;
const FORCE: VariableKind = VariableKind::SystemNumber(units::Quantity::Force);
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
    Status::FrictionFactor,
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
    Status::FrictionFactor,
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
    Status::FrictionFactor,
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

/// Statuses of the motions on which runs end, other than known.
const OF_END: &[Status] = &[Status::Stalled, Status::NoSquealingStart, Status::OnlyMeasured];

/// Statuses of the share of sticking other than known.
const OF_STICK: &[Status] =
    &[Status::Stalled, Status::NoSquealingStart, Status::OnlyMeasured, Status::NeverSticks];

/// Statuses of steady responses other than known.
const OF_RESPONSE: &[Status] = &[Status::Stalled, Status::OnlyMeasured];

/// Statuses of E other than known.
const OF_RESIDUAL_VIBRATION: &[Status] = &[
    Status::Stalled,
    Status::UnditheredSettles,
    Status::UnditheredAtRest,
    Status::UnditheredUnknown,
    Status::OnlyMeasured,
];

/// Statuses of an effect other than known.
const OF_EFFECT: &[Status] = &[
    Status::Stalled,
    Status::UnditheredSettles,
    Status::UnditheredAtRest,
    Status::UnditheredUnknown,
    Status::StillChanging,
    Status::Unresolved,
    Status::NoDither,
    Status::OnlyMeasured,
];

const LENGTH: VariableKind = VariableKind::SystemNumber(units::Quantity::Displacement);

/// Words of an effect.
const EFFECTS: VariableKind = VariableKind::Word { words: &Effect::NAMES, unknown: "unknown" };

/// Words of the motions on which runs end, in the order of their codes.
const MOTIONS: VariableKind = VariableKind::Word {
    words: &["period-1", "locked", "not-periodic", "limit-cycle", "rest"],
    unknown: "unknown",
};

/// The variables of the exact quench amplitude.
const QUENCH: [Variable; quench::VARIABLES] = quench::variables(FORCE);

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
    system(quench::NAME, quench::ABOUT, Computation::SystemQuench, &QUENCH),
    system("orbit-verdict", "verdict on the base response by its multipliers", Computation::SystemOrbit, &[
        variable(("orbit_verdict", ""), "verdict on the base response by its multipliers", VERDICTS, OF_ORBIT_VERDICT, judged),
    ]),
    system("orbit-radius", "modulus of the deciding multiplier of the base response: stable below 1", Computation::SystemOrbit, &[
        variable(("orbit_radius", "|λ|"), "modulus of the deciding multiplier", RATIO, OF_ORBIT, |r| Ok(orbit(r)?.radius)),
    ]),
    system("ends-on", "the motion on which the run of the study ends: period-1 (in step with the dither), locked, not-periodic, limit-cycle, rest", Computation::SystemEnd, &[
        variable(("ends_on", ""), "motion on which the run ends", MOTIONS, OF_END, |r| Ok(f64::from(ended(r)?.kind))),
    ]),
    system("peak-to-peak", "peak-to-peak of the observed displacement of the motion on which the run ends", Computation::SystemEnd, &[
        variable(("peak_to_peak", ""), "peak-to-peak of the observed displacement", LENGTH, OF_END, |r| Ok(ended(r)?.peak_to_peak)),
    ]),
    system("stick-fraction", "largest fraction of the time that a contact sticks, on the motion on which the run ends", Computation::SystemEnd, &[
        variable(("stick_fraction", ""), "largest fraction of the time that a contact sticks", RATIO, OF_STICK, |r| ended(r)?.stick_fraction),
    ]),
    system("effect", "effect of the dither on the vibration: quenches, reduces, increases, causes, or quiet with and without it", Computation::SystemResponse, &[
        variable(("effect", ""), "effect of the dither", EFFECTS, OF_EFFECT, effect),
    ]),
    system("residual-vibration", "residual vibration E = M₁/M₀, the share that remains under dither; 0 if quenched", Computation::SystemResponse, &[
        variable(("residual_vibration", "E"), "residual vibration E = M₁/M₀", RATIO, OF_RESIDUAL_VIBRATION, |r| responded(r)?.residual_vibration.map_err(Status::from)),
    ]),
    system("amplitude", "largest spectral amplitude M of the observed displacement below the dither", Computation::SystemResponse, &[
        variable(("amplitude", "M"), "spectral amplitude of the slow vibration", LENGTH, OF_RESPONSE, |r| Ok(responded(r)?.amplitude)),
    ]),
    system("undithered-amplitude", "spectral amplitude M₀ of the run without dither", Computation::SystemResponse, &[
        variable(("undithered_amplitude", "M_0"), "spectral amplitude without dither", LENGTH, OF_RESPONSE, |r| Ok(responded(r)?.undithered_amplitude)),
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

fn ended(results: &Results) -> Result<SystemEndPoint, Status> {
    results.system_end.unwrap_or(Err(Status::Missing))
}

fn responded(results: &Results) -> Result<SystemResponsePoint, Status> {
    results.system_response.unwrap_or(Err(Status::Missing))
}

#[expect(clippy::cast_precision_loss, reason = "one of five words")]
fn effect(results: &Results) -> Result<f64, Status> {
    Ok(responded(results)?.effect.place()? as f64)
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
    let first = found.iter().find(|(critical, _)| critical.becomes == becomes);
    first.map(|(critical, _)| critical.amplitude).ok_or(Status::NeverChanges)
}
