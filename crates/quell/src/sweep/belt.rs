//! Maps of belts: responses and averages, and the quantities read from them.

use quell_dynamics::response::Effect;
use quell_linear::averaging::{
    AveragedVerdict, Criterion, CriticalAmplitude, SlopeSide, UndecidedBecause,
};
use quell_linear::growth::of_criterion as growth_rate;
use quell_model::units;

use super::cost;
use super::evaluate::{Computation, ResponseMeans, ResponseNumbers, Results, evaluate};
use super::grid::Grid;
use super::mapped::{Mapped, PointResults, PointScales};
use super::quantity::{MapQuantity, VERDICTS, Variable, VariableKind, variable};
use super::quench_variables as quench;
use super::status::Status;
use crate::study::{BeltSetup, BeltStudy};

/// Maps of belt studies.
pub(super) struct BeltPoints(BeltStudy);

impl BeltPoints {
    pub(super) fn of(study: BeltStudy) -> Self {
        Self(study)
    }
}

impl Mapped for BeltPoints {
    fn quantities(&self) -> &'static [MapQuantity] {
        QUANTITIES
    }

    fn seconds(&self, wanted: &[Computation]) -> f64 {
        cost::of_belt(&self.0, wanted)
    }

    fn compute(
        &self,
        grid: &Grid,
        indices: &[usize],
        wanted: &[Computation],
    ) -> Vec<Option<PointResults>> {
        let belt = |index: &usize| grid.study_at(*index).ok()?.belt().ok();
        let studies: Vec<Option<BeltStudy>> = indices.iter().map(belt).collect();
        let scales: Vec<_> = studies.iter().map(|study| study.as_ref().map(scales_of)).collect();
        let valid: Vec<BeltStudy> = studies.into_iter().flatten().collect();
        let mut results = evaluate(&valid, wanted).into_iter();
        scales
            .into_iter()
            .map(|scales| scales.and_then(|scales| results.next().map(|found| (scales, found))))
            .collect()
    }
}

fn scales_of(study: &BeltStudy) -> PointScales {
    study.scales().map_or(PointScales::Own, PointScales::Belt)
}

/// Statuses of a response other than known.
const OF_RESPONSE: &[Status] = &[Status::Stalled, Status::NoSquealingStart];

/// Statuses of the share of sticking other than known.
const OF_STICK: &[Status] = &[Status::Stalled, Status::NoSquealingStart, Status::NeverSticks];

/// Statuses of E other than known.
const OF_RESIDUAL_VIBRATION: &[Status] = &[
    Status::Stalled,
    Status::NoSquealingStart,
    Status::UnditheredSettles,
    Status::UnditheredAtRest,
    Status::UnditheredUnknown,
];

/// Statuses of power and stroke other than known.
const OF_COST: &[Status] = &[Status::Stalled, Status::NoSquealingStart, Status::OnlyNormalDither];

/// Statuses of averaging other than known.
const OF_AVERAGING: &[Status] = &[
    Status::AtCorner,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
];

/// Statuses of averaging in the limit of high frequency other than known.
const OF_LIMIT: &[Status] = &[
    Status::AtCorner,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
];

/// Statuses of verdicts other than known.
const OF_VERDICT: &[Status] = &[
    Status::WithinError,
    Status::AtCorner,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
];

/// Statuses of verdicts in the limit of high frequency other than known.
const OF_LIMIT_VERDICT: &[Status] = &[
    Status::WithinError,
    Status::AtCorner,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
];

/// Statuses of critical amplitudes other than known.
const OF_CRITICAL: &[Status] = &[
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
    Status::NeverChanges,
    Status::ChangesOnce,
];

/// Words of an effect; the first, the desired effect, is 0.
const EFFECTS: VariableKind = VariableKind::Word { words: &Effect::NAMES, unknown: "unknown" };

/// Statuses of an effect other than known.
const OF_EFFECT: &[Status] = &[
    Status::Stalled,
    Status::NoSquealingStart,
    Status::UnditheredUnknown,
    Status::StillChanging,
    Status::NoDither,
];

/// Words of a flag.
const SETTLED: VariableKind = VariableKind::Word { words: &["no", "yes"], unknown: "unknown" };

const RATIO: VariableKind = VariableKind::Number(units::Quantity::Ratio);
const LENGTH: VariableKind = VariableKind::Number(units::Quantity::Displacement);
const FORCE: VariableKind = VariableKind::Number(units::Quantity::Force);
const VELOCITY: VariableKind = VariableKind::Number(units::Quantity::Velocity);

/// The variables of the exact quench amplitude.
const QUENCH: [Variable; quench::VARIABLES] = quench::variables(FORCE);

/// The quantities of a map of belts.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    belt("effect", "effect of the dither on the vibration: quenches, reduces, increases, causes, or quiet with and without it", Computation::ResponseWithEffect, &[
        variable(("effect", ""), "effect of the dither", EFFECTS, OF_EFFECT, effect),
    ]),
    belt("residual-vibration", "residual vibration E = M₁/M₀ (2.27), the dissertation's efficiency metric: the share that remains under dither; 0 if quenched", Computation::Response, &[
        variable(("residual_vibration", "E"), "residual vibration E = M₁/M₀", RATIO, OF_RESIDUAL_VIBRATION, |r| steady(r)?.residual_vibration.map_err(Status::from)),
    ]),
    belt("amplitude", "largest spectral amplitude M of the displacement below 1.9 ω₀", Computation::Response, &[
        variable(("amplitude", "M"), "spectral amplitude of the slow vibration", LENGTH, OF_RESPONSE, |r| Ok(steady(r)?.amplitude)),
    ]),
    belt("undithered-amplitude", "spectral amplitude M₀ of the run without dither", Computation::Response, &[
        variable(("undithered_amplitude", "M_0"), "spectral amplitude without dither", LENGTH, OF_RESPONSE, |r| Ok(steady(r)?.undithered_amplitude)),
    ]),
    belt("stick-fraction", "fraction of the time spent sticking", Computation::ResponseWithCost, &[
        variable(("stick_fraction", ""), "fraction of the time spent sticking", RATIO, OF_STICK, |r| means(r)?.stick_fraction),
    ]),
    belt(SETTLED_NAME, "whether the amplitudes of the two halves of the record agree", Computation::Response, &[
        variable(("settled", ""), "whether the response has settled", SETTLED, OF_RESPONSE, |r| Ok(f64::from(u8::from(steady(r)?.settled)))),
    ]),
    belt("mean-friction", "mean friction force divided by k", Computation::ResponseWithCost, &[
        variable(("mean_friction", "⟨f⟩"), "mean friction force", FORCE, OF_RESPONSE, |r| Ok(means(r)?.friction)),
    ]),
    belt("dither-power", "mean power supplied by tangential dither", Computation::ResponseWithCost, &[
        variable(("dither_power", "P"), "mean power of the dither", VariableKind::Number(units::Quantity::Power), OF_COST, |r| Ok(means(r)?.dither?.0)),
    ]),
    belt("dither-stroke", "peak-to-peak displacement of the point on which tangential dither acts", Computation::ResponseWithCost, &[
        variable(("dither_stroke", ""), "stroke of tangential dither", LENGTH, OF_COST, |r| Ok(means(r)?.dither?.1)),
    ]),
    belt("minimum-normal-load", "smallest normal load divided by k", Computation::ResponseWithCost, &[
        variable(("minimum_normal_load", "N_{min}"), "smallest normal load", FORCE, OF_RESPONSE, |r| Ok(means(r)?.least_load)),
    ]),
    belt("verdict", "verdict of finite-R averaging on steady sliding, with the oscillator's own response to the dither: stable or unstable", Computation::Criterion, &[
        variable(("verdict", ""), "averaged verdict on steady sliding", VERDICTS, OF_VERDICT, |r| verdict(averaged(r)?)),
    ]),
    belt("criterion", "criterion of stability 2ζ + Fμ̄′ by finite-R averaging: unstable where negative", Computation::Criterion, &[
        variable(("criterion", "2ζ + F\\bar{μ}′"), "criterion of averaged stability", RATIO, OF_AVERAGING, |r| value(averaged(r)?)),
    ]),
    belt("growth", "growth rate of small slow motions by finite-R averaging, per unit τ", Computation::Criterion, &[
        variable(("growth", "Re ρ"), "averaged growth rate of small slow motions", VariableKind::Rate, OF_AVERAGING, |r| Ok(growth_rate(value(averaged(r)?)?))),
    ]),
    belt("critical-amplitude", "smallest and largest amplitude ratio α = D/R of the first dither at which stability by finite-R averaging changes", Computation::CriticalAmplitudes, &[
        variable(("critical_amplitude", "α_c"), "smallest critical amplitude ratio of the first dither", VELOCITY, OF_CRITICAL, |r| critical(r.critical_amplitudes.as_ref(), false)),
        variable(("critical_amplitude_upper", "α_c"), "largest critical amplitude ratio of the first dither, where there are several", VELOCITY, OF_CRITICAL, |r| critical(r.critical_amplitudes.as_ref(), true)),
    ]),
    belt("limit-verdict", "averaged verdict (2.26) in the limit of high dither frequency, R → ∞: that of the dissertation", Computation::LimitCriterion, &[
        variable(("limit_verdict", ""), "averaged verdict on steady sliding for R → ∞", VERDICTS, OF_LIMIT_VERDICT, |r| verdict(limit(r)?)),
    ]),
    belt("limit-criterion", "criterion of averaged stability 2ζ + Fμ̄′ (2.26) in the limit R → ∞", Computation::LimitCriterion, &[
        variable(("limit_criterion", "2ζ + F\\bar{μ}′"), "criterion of averaged stability for R → ∞", RATIO, OF_LIMIT, |r| value(limit(r)?)),
    ]),
    belt("limit-growth", "growth rate of small slow motions by averaging in the limit R → ∞, per unit τ", Computation::LimitCriterion, &[
        variable(("limit_growth", "Re ρ"), "averaged growth rate of small slow motions for R → ∞", VariableKind::Rate, OF_LIMIT, |r| Ok(growth_rate(value(limit(r)?)?))),
    ]),
    belt("limit-critical-amplitude", "smallest and largest amplitude ratio α = D/R of the first dither at which averaged stability changes in the limit R → ∞", Computation::LimitCriticalAmplitudes, &[
        variable(("limit_critical_amplitude", "α_c"), "smallest critical amplitude ratio of the first dither for R → ∞", VELOCITY, OF_CRITICAL, |r| critical(r.limit_critical_amplitudes.as_ref(), false)),
        variable(("limit_critical_amplitude_upper", "α_c"), "largest critical amplitude ratio of the first dither for R → ∞, where there are several", VELOCITY, OF_CRITICAL, |r| critical(r.limit_critical_amplitudes.as_ref(), true)),
    ]),
    belt(quench::NAME, quench::ABOUT, Computation::Quench, &QUENCH),
];

fn steady(results: &Results) -> Result<ResponseNumbers, Status> {
    results.steady.unwrap_or(Err(Status::Missing))
}

fn means(results: &Results) -> Result<ResponseMeans, Status> {
    steady(results)?.means.ok_or(Status::Missing)
}

#[expect(clippy::cast_precision_loss, reason = "one of five words")]
fn effect(results: &Results) -> Result<f64, Status> {
    Ok(results.effect.unwrap_or(Err(Status::Missing))?.place()? as f64)
}

fn averaged(results: &Results) -> Result<&Criterion, Status> {
    known(results.criterion.as_ref())
}

fn limit(results: &Results) -> Result<&Criterion, Status> {
    known(results.limit_criterion.as_ref())
}

fn known<T>(found: Option<&Result<T, Status>>) -> Result<&T, Status> {
    found.map_or(Err(Status::Missing), |found| found.as_ref().map_err(|status| *status))
}

/// A criterion; at a corner, where it jumps, it has no value.
fn value(criterion: &Criterion) -> Result<f64, Status> {
    match criterion.effective.side {
        SlopeSide::Both => Ok(criterion.value),
        SlopeSide::Outer => Err(Status::AtCorner),
    }
}

fn verdict(criterion: &Criterion) -> Result<f64, Status> {
    match criterion.verdict {
        AveragedVerdict::Unstable => Ok(0.0),
        AveragedVerdict::Stable => Ok(1.0),
        AveragedVerdict::Undecided { why: UndecidedBecause::WithinError } => {
            Err(Status::WithinError)
        }
        AveragedVerdict::Undecided { why: UndecidedBecause::AtCorner } => Err(Status::AtCorner),
    }
}

/// Critical amplitudes of one model of the fast motion.
type Criticals = Result<Vec<CriticalAmplitude>, Status>;

fn critical(results: Option<&Criticals>, upper: bool) -> Result<f64, Status> {
    match (known(results)?.as_slice(), upper) {
        ([], _) => Err(Status::NeverChanges),
        ([first, ..], false) => Ok(first.amplitude_ratio),
        ([_], true) => Err(Status::ChangesOnce),
        ([.., last], true) => Ok(last.amplitude_ratio),
    }
}

const fn belt(
    name: &'static str,
    about: &'static str,
    computation: Computation,
    variables: &'static [Variable],
) -> MapQuantity {
    MapQuantity { name, about, kind: BeltSetup::NAME, computation, variables }
}

/// Whether a response has settled; added to every quantity of a response.
pub(super) const SETTLED_NAME: &str = "settled";
