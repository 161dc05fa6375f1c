//! Why parts of the answer to a design are unknown.

use std::fmt;

use quell_design::NoAnswer;
use quell_design::least_dither::{LimitedQuantity, NoCoveredBox, NoLeastSensitivity};
use quell_dynamics::orbit::NoOrbit;
use quell_dynamics::response::ResponseRefused;
use quell_model::RefusedNumbers;
use quell_numerics::continuation::sensitivity::NoSensitivity;

use crate::complaint::Failure;
use crate::reasons::reasons;
use crate::run::response::NoResidualVibration;
use crate::words::digits;

/// Numbers of a study that are differentiated at most, each of which takes a few periods of motion: matrices of large structures are
/// written as numbers too.
pub(super) const MOST_NUMBERS: usize = 400;

reasons! {
    /// Why no part of the range is known for which one dither suffices.
    pub enum NoCoveredPart {
        /// None was found.
        NotFound(NoCoveredBox),
        ;
        /// One dither serves the whole range.
        Whole => "one dither suffices for the whole range",
    }
}

reasons! {
    /// Why a design has no schedule.
    pub enum NoSchedule {
        ;
        /// Runs from a start decide.
        FromStart => "runs from a start are judged only where they decide",
        /// No dither is allowed.
        NothingAllowed => "no dither is allowed",
        /// The operating points have no coordinate, or several.
        NotOneCoordinate => "the box of operating points has not exactly one coordinate",
    }
}

reasons! {
    /// Why it is unknown what a schedule saves.
    pub enum NoSaving {
        /// There is no schedule.
        NoSchedule(NoSchedule),
        /// The objective is unknown.
        NoObjective(NoAnswer),
        ;
        /// No dither is allowed.
        NothingAllowed => "no dither is allowed",
        /// There is nothing of which a share could be saved.
        NotPositive => "the objective of the single dither is not positive",
    }
}

reasons! {
    /// Why the least amplitude has no derivatives.
    pub enum NoDesignSensitivity {
        /// There is no system with the numbers of the design.
        Refused(RefusedNumbers),
        /// The threshold has no derivatives.
        NoDerivatives(NoLeastSensitivity),
        ;
        /// No dither is allowed.
        NothingAllowed => "no dither is allowed",
        /// Runs from a start decide.
        FromStart =>
            "the amplitude is that of runs from a start, which depends on numbers by jumps",
        /// The range of amplitudes decides.
        QuietEverywhere =>
            "the smallest allowed amplitude is quiet everywhere: no threshold decides",
        /// The design chooses nothing.
        NothingChosen => "nothing is chosen",
    }
}

reasons! {
    /// Why the least amplitude has no derivative with respect to a number.
    pub enum NoAmplitudeRate {
        /// The number cannot vary.
        Refused(RefusedNumbers),
        /// The derivative is unknown.
        NoSensitivity(NoSensitivity),
        ;
        /// The study has too many numbers.
        BeyondMost => &format!("the first {MOST_NUMBERS} numbers of a study are differentiated"),
        /// It was not computed.
        NotComputed => "it was not computed",
    }
}

reasons! {
    /// Why the response to a dither in the band of the vibration is unknown.
    pub enum NoSlowResponse {
        /// There is no system with the numbers of the dither.
        Refused(RefusedNumbers),
        /// The study has no record.
        NoPlan(Failure),
        /// The base response is unknown.
        NoBaseResponse(NoOrbit),
        /// The response could not be measured.
        NotMeasured(ResponseRefused),
        /// The residual vibration is undefined.
        NoResidualVibration(NoResidualVibration),
        ;
        /// The spectrum is empty.
        NoLine => "the response has no line",
        /// The study is a disc.
        OfDisc => "the dither of a disc varies its friction and moves nothing",
        /// The design claims no operating point.
        NoPoints => "the box has no points",
        /// The dither is not in the band of the vibration.
        AboveBand => "the dither repeats above the band of the vibration",
    }
}

reasons! {
    /// Why the residual vibration under a dither in the band of the vibration has no level.
    pub enum NoSlowLevel {
        /// It is unknown.
        NoResponse(NoSlowResponse),
        ;
        /// It is zero.
        Zero => "E is zero, which has no level in decibels",
    }
}

/// Why no dither is known that is quiet in a share of random samples.
#[derive(Clone, Debug, PartialEq)]
pub enum NoConfidentDither {
    /// The design does not ask for one.
    NotAsked,
    /// The study is a disc.
    OfDisc,
    /// No dither is allowed.
    NothingAllowed,
    /// The choice of the other design variables did not settle.
    Unsettled,
    /// No sample was drawn.
    NoSamples,
    /// No sample is a valid study: why the first is not.
    AllInvalid(RefusedNumbers),
    /// Too many samples are never quiet, or not known to be.
    NeverQuiet {
        /// Their number.
        never: usize,
        /// The number of valid samples.
        all: usize,
        /// Why the first of them is unknown, if one is.
        first: Option<NoAnswer>,
    },
    /// The amplitude that the samples need is beyond its range.
    BeyondRange {
        /// That amplitude over the least one.
        factor: f64,
    },
    /// The amplitude that the samples need exceeds a limit.
    Limit {
        /// The limited quantity.
        quantity: LimitedQuantity,
        /// Its value over the limit.
        used: f64,
        /// The amplitude over the least one.
        factor: f64,
    },
    /// No dither of the larger amplitude is known.
    NoAnswer(NoAnswer),
}

impl fmt::Display for NoConfidentDither {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAsked => f.write_str("design.confidence is not given"),
            Self::OfDisc => f.write_str("design.confidence is for belts and systems"),
            Self::NothingAllowed => f.write_str("no dither is allowed"),
            Self::Unsettled => f.write_str("the choice under the limits did not settle"),
            Self::NoSamples => f.write_str("there are no samples"),
            Self::AllInvalid(why) => write!(f, "no sample is a valid study: {why}"),
            Self::NeverQuiet { never, all, first } => {
                write!(
                    f,
                    "no amplitude of the range is known to be quiet in {never} of {all} samples"
                )?;
                first.as_ref().map_or(Ok(()), |why| write!(f, "; the first: {why}"))
            }
            Self::BeyondRange { factor } => write!(
                f,
                "{} times the least amplitude, which the samples need, is beyond its range",
                digits(*factor)
            ),
            Self::Limit { quantity, used, factor } => write!(
                f,
                "{} would be {} times its limit at the amplitude that the samples need, {} times the least one",
                quantity.name(),
                digits(*used),
                digits(*factor)
            ),
            Self::NoAnswer(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoConfidentDither {}
