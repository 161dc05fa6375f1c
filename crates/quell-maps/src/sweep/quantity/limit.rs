//! Averaging of one mass: the criterion of the dissertation, and averages in its limit of high dither frequency, R → ∞.

use quell_linear::averaging::{
    AveragedVerdict, Averaging, Criterion, CriticalAmplitude, SlopeSide, UndecidedBecause,
    criterion, critical_amplitudes,
};
use quell_linear::growth::of_criterion;
use quell_model::units::Quantity;
use quell_model::{Belt, OneMass, System};

use crate::contact_state::{FastContact, without_state};
use crate::needs::Needs;
use crate::range;
use crate::run::sliding_growth::SlidingGrowth;
use crate::status::Status;
use crate::sweep::map_quantity::{
    MapQuantity, OF_AVERAGES, RATIO, VERDICTS, VariableKind, variable,
};
use crate::sweep::points::{ChunkPoints, PointComputation, Subject};

const VELOCITY: VariableKind = VariableKind::Number(Quantity::Velocity);

/// The quantities.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<SlidingGrowth>("criterion", "criterion of stability 2ζ + Fμ̄′ by finite-R averaging: unstable where negative", Needs::ONE_MASS, &[
        variable(("criterion", "2ζ + F\\bar{μ}′"), "criterion of averaged stability", RATIO, OF_AVERAGES, |points| points.values(SlidingGrowth::criterion)),
    ]),
    MapQuantity::of::<LimitCriterion>("limit-verdict", "averaged verdict (2.26) in the limit of high dither frequency, R → ∞: that of the dissertation", Needs::ONE_MASS, &[
        variable(("limit_verdict", ""), "averaged verdict on steady sliding for R → ∞", VERDICTS, OF_AVERAGES, |points| points.values(|found: &LimitCriterion| found.verdict())),
    ]),
    MapQuantity::of::<LimitCriterion>("limit-criterion", "criterion of averaged stability 2ζ + Fμ̄′ (2.26) in the limit R → ∞", Needs::ONE_MASS, &[
        variable(("limit_criterion", "2ζ + F\\bar{μ}′"), "criterion of averaged stability for R → ∞", RATIO, OF_AVERAGES, |points| points.values(|found: &LimitCriterion| found.value())),
    ]),
    MapQuantity::of::<LimitCriterion>("limit-growth", "growth rate of small slow motions by averaging in the limit R → ∞", Needs::ONE_MASS, &[
        variable(("limit_growth", "Re ρ"), "averaged growth rate of small slow motions for R → ∞", VariableKind::Rate, OF_AVERAGES, |points| points.values(|found: &LimitCriterion| found.growth())),
    ]),
    MapQuantity::of::<LimitCriticals>("limit-critical-amplitude", "smallest and largest amplitude ratio α = D/R of the first dither at which averaged stability changes in the limit R → ∞", Needs::ONE_MASS, &[
        variable(("limit_critical_amplitude", "α_c"), "smallest critical amplitude ratio of the first dither for R → ∞", VELOCITY, OF_AVERAGES, |points| points.values(LimitCriticals::first)),
        variable(("limit_critical_amplitude_upper", "α_c"), "largest critical amplitude ratio of the first dither for R → ∞, where there are several", VELOCITY, OF_AVERAGES, |points| points.values(LimitCriticals::last)),
    ]),
];

/// Seconds of one averaged criterion in closed form or by quadrature.
const CRITERION: f64 = 1e-4;

/// How often a search of critical amplitudes computes one.
const SEARCH: f64 = 100.0;

/// The criterion in the limit of high frequency, and what qualifies it.
struct LimitCriterion {
    criterion: Criterion,
    /// ω of the mass: what one of its rates is in the units of the study.
    rate: f64,
    status: Status,
}

impl LimitCriterion {
    fn of(system: &System) -> Result<Self, Status> {
        let mass = system.one_averaged_mass().ok_or(Status::NotOneMass)?;
        let belt = mass.belt();
        if belt.dithers().is_empty() {
            return Err(Status::NoDither);
        }
        let criterion = criterion(belt, Averaging::Limit).map_err(Status::from)?;
        let status = qualified(
            system,
            (belt, belt.fast_velocity()),
            range::with_dither(belt, belt.belt_velocity()),
        );
        Ok(Self { criterion, rate: mass.rate(), status })
    }

    /// At a corner, where it jumps, it has no value.
    fn value(&self) -> Result<f64, Status> {
        match self.criterion.effective.side {
            SlopeSide::Both => Ok(self.criterion.value),
            SlopeSide::Outer => Err(Status::AtCorner),
        }
    }

    fn growth(&self) -> Result<f64, Status> {
        Ok(self.rate * of_criterion(self.value()?))
    }

    fn verdict(&self) -> Result<f64, Status> {
        if !self.criterion.value.is_finite() && self.criterion.effective.side == SlopeSide::Both {
            return Err(Status::NotFinite);
        }
        match self.criterion.verdict {
            AveragedVerdict::Unstable => Ok(0.0),
            AveragedVerdict::Stable => Ok(1.0),
            AveragedVerdict::Undecided { why: UndecidedBecause::WithinError } => {
                Err(Status::WithinError)
            }
            AveragedVerdict::Undecided { why: UndecidedBecause::AtCorner } => Err(Status::AtCorner),
        }
    }
}

/// Whether an average of the law whose slip reaches `slip` leaves the range of the law, or differs from that of the contact with its
/// state, under a fast slip velocity of this amplitude.
fn qualified(system: &System, (belt, fast): (&Belt, f64), slip: f64) -> Status {
    let leaves = belt.friction().range().is_some_and(|range| slip > range.upper);
    let fast = FastContact { slip: fast, speed: belt.belt_velocity() };
    let bristles = system.contacts.iter().any(|contact| contact.friction.bristles().is_some());
    if leaves {
        Status::BeyondRange
    } else if bristles || without_state(system, 0, fast).is_some() {
        Status::WithoutState
    } else {
        Status::Known
    }
}

impl PointComputation for LimitCriterion {
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        points.each(|point| Self::of(point.system()?))
    }

    fn seconds(_: &Subject) -> f64 {
        CRITERION
    }

    fn qualification(&self, _: f64) -> Status {
        self.status
    }
}

/// Every critical amplitude ratio in the limit of high frequency, in order.
struct LimitCriticals {
    found: Vec<CriticalAmplitude>,
    system: System,
    mass: OneMass,
}

impl LimitCriticals {
    fn of(system: &System) -> Result<Self, Status> {
        let mass = system.one_averaged_mass().ok_or(Status::NotOneMass)?;
        if mass.belt().dithers().is_empty() {
            return Err(Status::NoDither);
        }
        let found = critical_amplitudes(mass.belt(), Averaging::Limit).map_err(Status::from)?;
        Ok(Self { found, system: system.clone(), mass })
    }

    fn first(&self) -> Result<f64, Status> {
        self.found.first().map(|first| first.amplitude_ratio).ok_or(Status::NeverChanges)
    }

    fn last(&self) -> Result<f64, Status> {
        match &self.found[..] {
            [] => Err(Status::NeverChanges),
            [_] => Err(Status::ChangesOnce),
            [.., last] => Ok(last.amplitude_ratio),
        }
    }
}

impl PointComputation for LimitCriticals {
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        points.each(|point| Self::of(point.system()?))
    }

    fn seconds(_: &Subject) -> f64 {
        SEARCH * CRITERION
    }

    fn qualification(&self, ratio: f64) -> Status {
        let belt = self.mass.belt();
        let first = belt.dithers().first();
        let amplitude = ratio * first.map_or(1.0, |dither| dither.frequency_ratio);
        let acting = belt.with_amplitude(0, amplitude);
        let fast = acting.as_ref().unwrap_or(belt).fast_velocity();
        qualified(&self.system, (belt, fast), range::at_amplitude(belt, amplitude))
    }
}
