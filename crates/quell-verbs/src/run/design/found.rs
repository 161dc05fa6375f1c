//! What a design finds, in numbers of the equations.

use quell_design::NoAnswer;
use quell_design::least_dither::{
    CoveredBox, DesignPoint, Designed, LimitedQuantity, ScheduledDither,
};
use quell_dynamics::orbit::ThresholdKind;
use quell_model::{RefusedNumbers, Waveform};
use quell_numerics::interval::RealInterval;

use super::slow_response::LargestSlowResponse;
use super::study_with_design::StudyWithDesign;
use super::unknown::{
    NoAmplitudeRate, NoConfidentDither, NoCoveredPart, NoDesignSensitivity, NoSchedule,
    NoSlowResponse,
};
use crate::run::waveforms::label;
use crate::study::{BurstNumber, Confidence};
use crate::words::{digits, quantity_is};

/// Share of a limit up to which it is kept at the amplitude of samples: the choice of the other design variables ends within this.
const KEPT: f64 = 1.002;

/// A number of the study that a design chooses or ranges over.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignNumber {
    /// Path as it was written.
    pub path: String,
    /// Value of the named key that corresponds to 1 in the equations.
    pub per_unit: f64,
    /// The unit of the named key; empty without one.
    pub unit: String,
    /// Smallest and largest value, in numbers of the equations.
    pub range: RealInterval,
}

impl DesignNumber {
    /// A value, of the equations, in words: "dither frequency 13000 Hz".
    pub(super) fn in_words(&self, value: f64) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        quantity_is(&self.path, &format!("{}{unit}", digits(value * self.per_unit)))
    }
}

/// The least dither of a study.
#[derive(Clone, Debug)]
pub struct LeastDitherFound {
    /// The amplitude.
    pub amplitude: DesignNumber,
    /// The other numbers that are chosen.
    pub others: Vec<DesignNumber>,
    /// The box of operating points.
    pub over: Vec<DesignNumber>,
    /// The answer of each dither that was tried, in the order of the study: every waveform at the first place, then at the next.
    pub tried: Vec<DesignedDither>,
    /// The dither of the answer: the best feasible one, or the first.
    pub best: usize,
    /// The numbers of bursts that are chosen, with their paths.
    pub periods: Vec<(String, BurstNumber)>,
    /// Where no dither is allowed: the largest part of the box for which the one that comes nearest suffices.
    pub covered: Result<CoveredBox, NoCoveredPart>,
    /// The exact least dither at single operating points of a box of one coordinate: a schedule in place of one dither; or why it has
    /// no points.
    pub schedule: Result<Vec<ScheduledDither>, NoSchedule>,
    /// Warnings where the dither of the answer takes the slip out of the range of a law.
    pub beyond_laws: Vec<String>,
    /// Why the averages, which do not know the states of contacts, differ from those with them at the least dither.
    pub without_state: Vec<String>,
    /// For a disc whose box is a range of speeds, the exact thresholds in amplitude at speeds of the range, with the dither of the
    /// answer.
    pub tongues: Vec<(f64, Vec<f64>)>,
    /// How the least amplitude depends on the numbers of the study, or why that is unknown.
    pub sensitivity: Result<DesignSensitivity, NoDesignSensitivity>,
    /// The dither that is quiet in the share of random samples that is asked for, or why it is unknown.
    pub confident: Result<ConfidentDither, NoConfidentDither>,
    /// Of a dither that repeats in the band of the vibration, the response to it where it is largest, or why it is unknown; `None` of
    /// other dithers, whose response has no slow vibration.
    pub slow: Option<Result<LargestSlowResponse, NoSlowResponse>>,
}

/// A dither that was tried.
#[derive(Clone, Debug)]
pub struct DesignedDither {
    /// Its waveform.
    pub waveform: Waveform,
    /// Where it acts, if the design tries several places.
    pub place: Option<String>,
    /// Whether its least dither repeats in the band of the vibration, so that the motion in step with it vibrates slowly.
    pub is_slow: bool,
    /// The answer.
    pub designed: Designed,
}

impl DesignedDither {
    /// Its waveform and its place in words.
    pub fn label(&self) -> String {
        let waveform = label(&self.waveform);
        match &self.place {
            Some(place) => format!("{waveform} at {place}"),
            None => waveform,
        }
    }
}

/// A dither that is tried: its waveform, its place, the study with it at that place, and how the structure answers.
pub(crate) struct TriedDither<'a, P> {
    pub(crate) waveform: Waveform,
    pub(crate) place: Option<String>,
    pub(crate) study: &'a dyn StudyWithDesign,
    pub(crate) plant: P,
}

impl DesignNumber {
    /// Smallest and largest value in the unit of the path.
    pub(super) fn range_in_units(&self) -> RealInterval {
        RealInterval::new(self.range.lower * self.per_unit, self.range.upper * self.per_unit)
    }
}

/// The numbers that a design chooses and over which it ranges.
#[derive(Clone, Debug)]
pub(crate) struct DesignNumbers {
    pub(crate) amplitude: DesignNumber,
    pub(crate) others: Vec<DesignNumber>,
    pub(crate) over: Vec<DesignNumber>,
}

/// The derivative of the least amplitude with respect to one number.
#[derive(Clone, Debug, PartialEq)]
pub struct AmplitudeRate {
    /// Path of the number in the study.
    pub path: String,
    /// Its value, in the unit of its key.
    pub value: f64,
    /// The derivative: the unit of the amplitude per unit of the number; or why it is unknown.
    pub rate: Result<f64, NoAmplitudeRate>,
}

/// How the least amplitude of a design depends on the numbers of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignSensitivity {
    /// The kind of the threshold that decides.
    pub kind: ThresholdKind,
    /// The threshold that it meets at the operating point that decides, if any.
    pub meets: Option<ThresholdKind>,
    /// The least amplitude, in the unit of its path.
    pub amplitude: f64,
    /// The derivatives, in the order of the study.
    pub rates: Vec<AmplitudeRate>,
}

/// A dither that is quiet in a share of random samples.
#[derive(Clone, Debug, PartialEq)]
pub struct ConfidentDither {
    /// What was asked for.
    pub confidence: Confidence,
    /// The dither, with its objective and the use of every limit.
    pub dither: DesignPoint,
    /// The 95 % interval of the amplitude; the upper end is infinite where samples are never quiet.
    pub interval: RealInterval,
    /// The least amplitude of the study's own numbers with the same other design variables.
    pub least: f64,
    /// Samples whose exact threshold was computed.
    pub exact: usize,
    /// Samples that no amplitude of the range quiets.
    pub never: usize,
    /// Samples that are quiet at a smaller amplitude and, by averaging, loud at this one.
    pub loud_again: usize,
    /// Samples without a known least amplitude, which count as loud, and why the first of them is.
    pub unknown: (usize, Option<NoAnswer>),
    /// Samples that are no valid studies, which are left out, and why the first of them is.
    pub invalid: (usize, Option<RefusedNumbers>),
}

impl ConfidentDither {
    /// Whether every limit is kept.
    pub fn is_allowed(&self) -> bool {
        self.dither.use_of_limits() <= KEPT
    }

    /// The limit that is used most, with its share.
    pub(super) fn tightest(&self) -> Option<(LimitedQuantity, f64)> {
        let known = self.dither.used.iter();
        let known = known.filter_map(|(quantity, used)| Some((*quantity, *used.as_ref().ok()?)));
        known.max_by(|a, b| a.1.total_cmp(&b.1))
    }
}
