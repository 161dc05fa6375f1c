//! Why a structure gives no answer about a dither.

use std::fmt;

use quell_dynamics::attractor::NoOutcome;
use quell_dynamics::motion::{Immobile, MotionStopped};
use quell_dynamics::orbit::{NoOrbit, NoSlidingVerdict, NoSqueal};
use quell_linear::averaging::AveragingError;
use quell_linear::driven_point::NoDrivenPoint;
use quell_linear::floquet::NotFollowerDither;
use quell_linear::steady::NoSteadySliding;
use quell_model::{InvalidValues, RefusedNumbers};
use quell_numerics::eigen::EigenError;

use crate::actuator::UnknownDemand;

/// Where averaging ceases to describe the contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AveragingEnds {
    /// The slip leaves the range of a friction law.
    BeyondLaw,
    /// A contact opens.
    Opens,
}

/// A quantity that the dither of a disc does not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotOfDisc {
    /// An amplitude from which on all are quiet.
    LeastAmplitude,
    /// A slip velocity.
    SlipVelocity,
    /// The price of a motion.
    Price,
    /// An actuator.
    Actuator,
    /// Of tangential dither, a load that varies.
    VaryingLoad,
    /// A normal load, where no load of the disc has one.
    NormalLoad,
    /// A motion at all.
    Motion,
}

/// Why a structure gives no answer about a dither at an operating point.
#[derive(Clone, Debug, PartialEq)]
pub enum NoAnswer {
    /// There is no structure with these numbers.
    Refused(RefusedNumbers),
    /// There is no steady sliding.
    NoSliding(NoSteadySliding),
    /// The motion of the point on which the dither acts is unknown.
    NoDrivenPoint(NoDrivenPoint),
    /// The average is unknown.
    NoAverage(AveragingError),
    /// The eigenvalues of small motions are unknown.
    Eigenvalues(EigenError),
    /// The exponents of a disc are unknown.
    NoExponents(NotFollowerDither),
    /// There is no base response, or it was not found.
    NoOrbit(NoOrbit),
    /// No motion can be computed.
    Immobile(Immobile),
    /// A motion stopped.
    Stopped(Box<MotionStopped>),
    /// The verdict on steady sliding without dither is unknown.
    NoSlidingVerdict(NoSlidingVerdict),
    /// There is no limit cycle without dither from which a run could start.
    NoSqueal(NoSqueal),
    /// The outcome of a run is unknown.
    NoOutcome(NoOutcome),
    /// The outcome of a run at an amplitude is unknown, and none is known to be quiet.
    NoOutcomeAt {
        /// The amplitude.
        amplitude: f64,
        /// Why.
        why: NoOutcome,
    },
    /// No amplitude quenches by averaging, up to where averaging ends.
    NeverQuietByAveraging(Option<AveragingEnds>),
    /// No amplitude of the range is quiet at an operating point.
    NeverQuiet,
    /// The dither that is designed does not act.
    DoesNotAct,
    /// Nothing is observed.
    NothingObserved,
    /// The system has no contact.
    NoContact,
    /// A contact has no slip velocity.
    NoSlipVelocity,
    /// No contact has friction in steady sliding.
    NoFriction,
    /// The base response has no period.
    NoPeriod,
    /// A harmonic of the dither is at the frequency of an undamped motion.
    UndampedHarmonic,
    /// The dither of a disc does not have it.
    NotOfDisc(NotOfDisc),
    /// The study has no actuator.
    NoActuator,
    /// What the dither demands of its actuator is unknown.
    Demand(UnknownDemand),
    /// Runs from a start are not judged at larger amplitudes.
    BeyondLeast,
    /// The box has no points.
    EmptyBox,
    /// No choice of the design variables was tried.
    NothingTried,
    /// No choice of the design variables keeps every limit.
    NothingAllowed,
    /// The use of a limit is unknown.
    OfLimit {
        /// Name of the limit in a study.
        limit: &'static str,
        /// Why.
        why: Box<Self>,
    },
}

/// Conversions of reasons into the variants of an enum that hold them.
#[macro_export]
macro_rules! passed_on {
    ($name:ident: $($variant:ident($reason:ty)),* $(,)?) => {
        $(impl From<$reason> for $name {
            fn from(why: $reason) -> Self {
                Self::$variant(why)
            }
        })*
    };
}

passed_on! {
    NoAnswer:
    Refused(RefusedNumbers),
    NoSliding(NoSteadySliding),
    NoDrivenPoint(NoDrivenPoint),
    NoAverage(AveragingError),
    Eigenvalues(EigenError),
    NoExponents(NotFollowerDither),
    NoOrbit(NoOrbit),
    Immobile(Immobile),
    NoSlidingVerdict(NoSlidingVerdict),
    Demand(UnknownDemand),
}

impl From<InvalidValues> for NoAnswer {
    fn from(why: InvalidValues) -> Self {
        Self::Refused(why.into())
    }
}

impl From<MotionStopped> for NoAnswer {
    fn from(why: MotionStopped) -> Self {
        Self::Stopped(Box::new(why))
    }
}

impl fmt::Display for AveragingEnds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::BeyondLaw => "the slip leaves the range of a friction law",
            Self::Opens => "a contact opens",
        })
    }
}

impl fmt::Display for NotOfDisc {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::LeastAmplitude => {
                "the amplitudes of a disc are judged up to a largest one: its waves grow again at larger ones"
            }
            Self::SlipVelocity => {
                "the dither of a disc varies its friction: it adds no slip velocity"
            }
            Self::Price => {
                "the dither of a disc varies its friction and moves nothing: it has no stroke, velocity or power"
            }
            Self::Actuator => {
                "an actuator gives normal dither of a disc in SI whose loads have a normal_load and a friction law"
            }
            Self::VaryingLoad => "tangential dither leaves the normal load as it is",
            Self::NormalLoad => "no load of the disc has a normal_load",
            Self::Motion => "the disc has no motion",
        })
    }
}

impl fmt::Display for NoAnswer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(why) => why.fmt(f),
            Self::NoSliding(why) => why.fmt(f),
            Self::NoDrivenPoint(why) => why.fmt(f),
            Self::NoAverage(why) => why.fmt(f),
            Self::Eigenvalues(why) => why.fmt(f),
            Self::NoExponents(why) => why.fmt(f),
            Self::NoOrbit(why) => why.fmt(f),
            Self::Immobile(why) => why.fmt(f),
            Self::Stopped(why) => why.fmt(f),
            Self::NoSlidingVerdict(why) => why.fmt(f),
            Self::NoSqueal(why) => write!(f, "the limit cycle without dither: {why}"),
            Self::NoOutcome(why) => why.fmt(f),
            Self::NoOutcomeAt { amplitude, why } => {
                write!(f, "the run at the amplitude {amplitude}: {why}")
            }
            Self::NeverQuietByAveraging(None) => {
                f.write_str("no amplitude of this frequency quenches by averaging")
            }
            Self::NeverQuietByAveraging(Some(ends)) => {
                write!(f, "no amplitude quenches by averaging before {ends}")
            }
            Self::NeverQuiet => f.write_str("no amplitude of the range is quiet there"),
            Self::DoesNotAct => f.write_str("the dither that is designed does not act"),
            Self::NothingObserved => {
                f.write_str("the structure has no displacement that is observed")
            }
            Self::NoContact => f.write_str("the system has no contact"),
            Self::NoSlipVelocity => f.write_str("the contact has no slip velocity"),
            Self::NoFriction => f.write_str("no contact has friction in steady sliding"),
            Self::NoPeriod => f.write_str("the base response has no period"),
            Self::UndampedHarmonic => {
                f.write_str("a harmonic of the dither is at the frequency of an undamped motion")
            }
            Self::NotOfDisc(what) => what.fmt(f),
            Self::NoActuator => f.write_str("the study has no [actuator]"),
            Self::Demand(why) => why.fmt(f),
            Self::BeyondLeast => {
                f.write_str("runs from a start are judged only up to the least amplitude")
            }
            Self::EmptyBox => f.write_str("the box has no points"),
            Self::NothingTried => f.write_str("nothing was tried"),
            Self::NothingAllowed => f.write_str("no choice keeps every limit"),
            Self::OfLimit { limit, why } => write!(f, "{limit}: {why}"),
        }
    }
}

impl std::error::Error for NoAnswer {}
