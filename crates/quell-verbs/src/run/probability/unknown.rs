//! Why a sample has no verdict, growth rate or threshold.

use std::fmt;

use quell_dynamics::attractor::NoEnd;
use quell_linear::averaging::AveragingError;

use crate::complaint::Failure;
use crate::reasons::reasons;
use crate::run::system::attractor::NoLocalVerdict;
use crate::status::Status;

reasons! {
    /// Why the growth rate of a sample is unknown, or does not decide whether the sample vibrates.
    pub enum NoSampledGrowth {
        /// Averaging has no value in the limit of high dither frequency.
        NoAverage(AveragingError),
        /// The growth rate has no value, or is zero within its error.
        Unknown(Status),
        ;
    }
}

/// Why the run of a sample has no start.
#[derive(Clone, Debug, PartialEq)]
pub struct RefusedStart(pub Failure);

impl fmt::Display for RefusedStart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Failure::Wrong(complaints) => {
                let allowed = complaints.iter().map(|complaint| &*complaint.allowed);
                f.write_str(&allowed.collect::<Vec<_>>().join("; "))
            }
            Failure::Failed { why, .. } => f.write_str(why),
        }
    }
}

impl std::error::Error for RefusedStart {}

reasons! {
    /// Why it is unknown whether a sample vibrates.
    pub enum NoSampledVerdict {
        /// The growth rate does not decide.
        NoGrowth(NoSampledGrowth),
        /// The local stability is unknown.
        NoLocalVerdict(NoLocalVerdict),
        /// The local stability is not decided.
        Local(&'static str) => "the base response is {}",
        /// The run has no start.
        NoStart(RefusedStart),
        /// The end of the run is unknown.
        NoEnd(NoEnd),
        ;
    }
}

reasons! {
    /// Why the threshold of a sample is unknown.
    pub enum NoSampledThreshold {
        /// Averaging has no value.
        NoAverage(AveragingError),
        /// The exact threshold is unknown.
        NotExact(Status),
        ;
        /// A run judges the samples.
        OfRuns => "thresholds are those of small motions: by averaging, or with --start local",
        /// The study has no dither.
        NoDither => "the study has no dither",
        /// The study is a disc.
        OfDisc =>
            "thresholds are those of belts and systems: `thresholds` has those of a disc",
    }
}

reasons! {
    /// Why Sobol indices are unknown.
    pub enum NoIndices {
        ;
        /// The number is correlated with others.
        Correlated =>
            "it is correlated with other numbers: indices are known for their group, in groups",
        /// Most growth rates are unknown.
        MostUnknown => "most growth rates are unknown",
        /// The growth rates do not vary.
        NoVariance => "the growth rates do not vary, or too few are known",
    }
}

/// Why no amplitude is known to be enough for a share of the samples.
#[derive(Clone, Debug, PartialEq)]
pub enum NoThresholdQuantile {
    /// No threshold is known: why the first is unknown, if one was computed.
    NoneKnown(Option<NoSampledThreshold>),
    /// No amplitude is quiet in too many samples.
    NeverQuiet {
        /// Samples in which no amplitude is quiet.
        never: usize,
        /// Samples with a known threshold.
        all: usize,
    },
}

impl fmt::Display for NoThresholdQuantile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoneKnown(Some(why)) => why.fmt(f),
            Self::NoneKnown(None) => f.write_str("no threshold is known"),
            Self::NeverQuiet { never, all } => {
                write!(f, "no amplitude is quiet in {never} of {all} samples")
            }
        }
    }
}

impl std::error::Error for NoThresholdQuantile {}
