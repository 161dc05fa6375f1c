//! Lyapunov exponents of the motion on which a run ends, as `attractor` reports them.

use quell_dynamics::motion::{
    Immobile, LyapunovExponent, LyapunovExponents, LyapunovVerdict, Motion, MotionStart,
    NoExponents,
};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_linear::steady::NoSteadySliding;
use quell_model::System;
use quell_model::units::Quantity;
use quell_numerics::eigen::EigenError;

use crate::complaint::{Complaint, Failure};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::reasons::reasons;
use crate::words::digits;

/// Exponents that are computed at most: the largest of a large system.
const MOST_EXPONENTS: usize = 12;

/// A multiplier below this modulus may be rounding of 0.
const ERASED: f64 = 1e-9;

/// Difference between an exponent and the multiplier's beyond three standard errors that is allowed, over the record: the
/// logarithm of a length that is not the same at both of its ends.
const ENDS: f64 = 5.0;

/// Why an exponent is null.
const STICK: &str = "−∞: a stick erases changes of its slip velocity";

/// Times of a record of exponents.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExponentTimes {
    /// Time before the record; `None` for the usual one.
    pub settle: Option<f64>,
    /// Length of the record; `None` for the usual one.
    pub record: Option<f64>,
}

impl ExponentTimes {
    /// The times, of a motion whose slowest oscillation has this period.
    ///
    /// # Errors
    /// A complaint about a time below 0 and a record of no length; that of `slowest`.
    pub fn over(self, slowest: impl Fn() -> Result<f64, Failure>) -> Result<(f64, f64), Failure> {
        if let Some(settle) = self.settle.filter(|settle| settle.is_nan() || *settle < 0.0) {
            return Err(Complaint::option("--settle", settle, "0 or above").into());
        }
        if let Some(record) = self.record.filter(|record| record.is_nan() || *record <= 0.0) {
            let allowed = "above 0: exponents are means over the record";
            return Err(Complaint::option("--record", record, allowed).into());
        }
        let time = |given: Option<f64>, periods: f64| match given {
            Some(time) => Ok(time),
            None => slowest().map(|slowest| periods * slowest),
        };
        Ok((time(self.settle, SETTLE_PERIODS)?, time(self.record, RECORD_PERIODS)?))
    }
}

/// Periods of the slowest oscillation before the record: the changes turn into their directions.
pub const SETTLE_PERIODS: f64 = 50.0;

/// Periods of the slowest oscillation in the record.
pub const RECORD_PERIODS: f64 = 1000.0;

/// What the judge of where a run ends says about the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JudgedMotion {
    /// It is periodic.
    Periodic {
        /// Modulus of the deciding multiplier.
        radius: f64,
        /// Period.
        period: f64,
    },
    /// It is on a torus: the largest exponent is exactly 0.
    QuasiPeriodic,
    /// It is not periodic, as far as it was followed.
    NotPeriodic,
    /// Every contact slips steadily: the exponents are the growth rates of the small motions.
    SteadySliding,
    /// It is at rest, or nothing is known.
    Other,
}

/// The motion that is measured.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredMotion<'a> {
    /// The system that moves.
    pub system: &'a System,
    /// A state of the motion at t = 0.
    pub state: &'a [f64],
    /// Whether it moves without dither, so that it may be shifted in time.
    pub moves_freely: bool,
    /// What is known about it.
    pub judged: JudgedMotion,
}

/// Lyapunov exponents with what they are compared with.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredExponents {
    /// The exponents.
    pub found: LyapunovExponents,
    /// Time before the record; `None` of exponents that are eigenvalues.
    pub settle: Option<f64>,
    /// Whether the motion may be shifted in time.
    pub moves_freely: bool,
    /// What is known about the motion.
    pub judged: JudgedMotion,
    /// Number of exponents that were not computed.
    pub left_out: usize,
}

reasons! {
    /// Why the Lyapunov exponents of a motion are unknown.
    pub enum NoMeasuredExponents {
        /// No motion can be computed.
        Immobile(Immobile),
        /// They could not be measured.
        NotMeasured(NoExponents),
        /// There is no steady sliding.
        NoSliding(NoSteadySliding),
        /// The eigenvalues of small motions are unknown.
        Eigenvalues(EigenError),
        ;
    }
}

impl MeasuredExponents {
    /// Measures the exponents of a motion.
    ///
    /// # Errors
    /// Why they are not known.
    pub fn of(motion: &MeasuredMotion<'_>, times: (f64, f64)) -> Result<Self, NoMeasuredExponents> {
        let MeasuredMotion { system, state, moves_freely, judged } = *motion;
        if judged == JudgedMotion::SteadySliding {
            return Self::of_small_motions(system, state);
        }
        let engine = Motion::new(system)?;
        let count = engine.size().min(MOST_EXPONENTS);
        let start = MotionStart { time: 0.0, state: state.to_vec() };
        let found = engine.lyapunov_exponents(&start, times, count)?;
        let left_out = engine.size() - count;
        Ok(Self { found, settle: Some(times.0), moves_freely, judged, left_out })
    }

    /// Those of steady sliding: the real parts of the eigenvalues, without a record.
    fn of_small_motions(system: &System, state: &[f64]) -> Result<Self, NoMeasuredExponents> {
        let linear = Linearised::new(system)?;
        let found = spectrum(&linear, &linear.friction())?;
        // An exponent and its interval are known to the bound on the eigenvalue.
        let exponents = found.motions.iter().map(|motion| LyapunovExponent::Rate {
            value: motion.eigenvalue.re,
            error: motion.error,
        });
        let exponents: Vec<LyapunovExponent> = exponents.take(MOST_EXPONENTS).collect();
        let left_out = found.motions.len() - exponents.len();
        let means = vec![Vec::new(); exponents.len()];
        let found = LyapunovExponents { exponents, means, time: 0.0, state: state.to_vec() };
        let judged = JudgedMotion::SteadySliding;
        Ok(Self { found, settle: None, moves_freely: false, judged, left_out })
    }

    /// Whether they are eigenvalues and not means over a record.
    pub fn are_eigenvalues(&self) -> bool {
        self.settle.is_none()
    }

    /// What is known about the motion: what the exponents say, or, where they leave it open and agree with it, the multiplier.
    pub fn verdict(&self) -> LyapunovVerdict {
        match (self.found.verdict(self.moves_freely), self.judged) {
            (LyapunovVerdict::Unknown, JudgedMotion::Periodic { radius, .. })
                if radius < 1.0 && self.agrees() == Some(true) =>
            {
                LyapunovVerdict::Regular
            }
            (verdict, _) => verdict,
        }
    }

    /// Whether the deciding exponent is ln|λ|/T of the deciding multiplier; `None` of a motion that is not periodic.
    pub fn agrees(&self) -> Option<bool> {
        let JudgedMotion::Periodic { radius, period } = self.judged else { return None };
        let rate = libm::log(radius) / period;
        Some(match self.found.deciding(self.moves_freely)? {
            LyapunovExponent::Erased => radius <= ERASED,
            LyapunovExponent::Rate { value, .. } if radius <= ERASED => {
                value * period <= libm::log(ERASED)
            }
            LyapunovExponent::Rate { value, error } => {
                (value - rate).abs() <= 3.0 * error + ENDS / self.found.time
            }
        })
    }

    /// How the verdict contradicts what the judge of where the run ends says; `None` if it does not.
    pub fn contradiction(&self) -> Option<&'static str> {
        match (self.judged, self.verdict()) {
            (JudgedMotion::Periodic { .. }, _) if self.agrees() == Some(false) => Some(
                "the Lyapunov exponents contradict the multipliers of the motion: the record left the motion, or it is too short; \
                 try another --settle or --record",
            ),
            (JudgedMotion::QuasiPeriodic | JudgedMotion::NotPeriodic, LyapunovVerdict::Regular) => {
                Some(
                    "every Lyapunov exponent is below 0, as of a stable periodic motion, but the run was not found to end on one: \
                     its period may be longer than those tried, or the record may be too short",
                )
            }
            (JudgedMotion::QuasiPeriodic, LyapunovVerdict::Irregular) => Some(
                "the section of the motion looks quasi-periodic, but its largest Lyapunov exponent is above 0: lengthen the record",
            ),
            _ => None,
        }
    }

    /// The answer in a sentence; `rate` writes a rate with its unit.
    pub fn sentence(&self, rate: impl Fn(f64) -> String) -> String {
        let which = if self.moves_freely {
            "Apart from the exponent 0 of a shift in time, its largest Lyapunov exponent"
        } else {
            "Its largest Lyapunov exponent"
        };
        let is_open = self.found.verdict(self.moves_freely) == LyapunovVerdict::Unknown;
        let verdict = match self.verdict() {
            LyapunovVerdict::Regular if is_open => {
                "0 is within three standard errors, but the motion is periodic with all multipliers inside the unit circle, and so \
                 it is regular"
            }
            LyapunovVerdict::Regular => "the motion is regular",
            LyapunovVerdict::Irregular => "the motion is irregular (chaotic)",
            LyapunovVerdict::Unknown => {
                "whether the motion is regular is unknown, because 0 is within three standard errors"
            }
        };
        match self.found.deciding(self.moves_freely) {
            Some(LyapunovExponent::Rate { value, error }) => {
                let (value, error) = (rate(value), rate(error));
                if self.are_eigenvalues() {
                    return format!(
                        "{which} is {value}, the largest growth rate of a small motion: {verdict}."
                    );
                }
                format!("{which} is {value} (standard error {error}): {verdict}.")
            }
            Some(LyapunovExponent::Erased) => {
                format!("{which} is −∞, because sticks erase every small change: {verdict}.")
            }
            None => format!("It has no further exponent: {verdict}."),
        }
    }

    /// Warnings, among them a contradiction to the multipliers.
    pub fn warnings(&self) -> Vec<String> {
        let contradiction = self.contradiction().map(str::to_owned);
        let left_out = (self.left_out > 0)
            .then(|| format!("only the {MOST_EXPONENTS} largest Lyapunov exponents were computed"));
        contradiction.into_iter().chain(left_out).collect()
    }

    /// A time of the record, or the reason for exponents without one.
    fn recorded(&self, time: f64) -> Result<f64, &'static str> {
        let why = "the exponents are eigenvalues of small motions, not means over a record";
        if self.are_eigenvalues() { Err(why) } else { Ok(time) }
    }

    /// Adds the fields to an object.
    pub(super) fn put(&self, fields: &mut Fields) {
        let exponents = &self.found.exponents;
        let part = |pick: fn(f64, f64) -> f64| -> Vec<Option<f64>> {
            let known = |exponent: &LyapunovExponent| match exponent {
                LyapunovExponent::Rate { value, error } => Some(pick(*value, *error)),
                LyapunovExponent::Erased => None,
            };
            exponents.iter().map(known).collect()
        };
        fields
            .rates("exponents", &part(|value, _| value), STICK)
            .rates("errors", &part(|_, error| error), STICK)
            .known("time", Quantity::Time, self.recorded(self.found.time))
            .known("settle", Quantity::Time, self.recorded(self.settle.unwrap_or_default()))
            .plain("verdict", self.verdict().name());
        if self.verdict() == LyapunovVerdict::Unknown {
            fields.why(
                "verdict",
                "0 is within three standard errors of the deciding exponent: a quasi-periodic motion has exactly 0, and a longer \
                 record narrows the error",
            );
        }
        let shift = self.found.shift_in_time(self.moves_freely);
        match shift {
            Some(place) => fields.plain("shift_in_time", place),
            None => fields
                .unknown("shift_in_time", "dither fixes the phase of the motion, or it is at rest"),
        };
        let deciding = self.found.deciding(self.moves_freely).map(|exponent| exponent.rate());
        let deciding = deciding.filter(|rate| rate.is_finite()).ok_or(STICK);
        fields.known_rate("deciding", deciding);
        let dimension = self.found.kaplan_yorke_dimension(self.moves_freely);
        let dimension = dimension
            .ok_or("the errors of the exponents, or those that were not computed, leave it open");
        fields.known("kaplan_yorke_dimension", Quantity::Ratio, dimension);
        let not_periodic = "the motion has no multiplier: it is steady, or no period was found";
        let expected = match self.judged {
            JudgedMotion::Periodic { radius, period } => {
                let rate = libm::log(radius) / period;
                if rate.is_finite() { Ok(rate) } else { Err(STICK) }
            }
            _ => Err(not_periodic),
        };
        fields.known_rate("of_multiplier", expected);
        match self.agrees() {
            Some(agrees) => fields.plain("agrees_with_multipliers", agrees),
            None => fields.unknown("agrees_with_multipliers", not_periodic),
        };
        match self.contradiction() {
            Some(why) => fields.plain("contradiction", why),
            None => {
                fields.unknown("contradiction", "the exponents and the kind of the motion agree")
            }
        };
    }

    /// The exponents over the time up to which they are averaged; `time` and `rate` are the units with their values in a unit of
    /// the equations.
    pub fn dataset(&self, dataset: Dataset, time: (&str, f64), rate: (&str, f64)) -> Dataset {
        let times = self.times().map(|value| time.1 * value).collect();
        let dataset = dataset.with_axis(Array::new("time", time.0, times));
        let kept = self.found.means.iter().enumerate().filter(|(_, means)| !means.is_empty());
        kept.fold(dataset, |dataset, (index, means)| {
            let values = means.iter().map(|value| rate.1 * value).collect();
            dataset.with(Array::new(format!("exponent_{}", index + 1), rate.0, values))
        })
    }

    /// Ends of the blocks of the record.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        let blocks = self.found.means.iter().map(Vec::len).max().unwrap_or(0);
        let time = self.found.time;
        (1..=blocks).map(move |block| time * block as f64 / blocks as f64)
    }

    /// The table of exponents for people.
    pub fn table(&self, rate: impl Fn(f64) -> String) -> String {
        let shift = self.found.shift_in_time(self.moves_freely);
        let rows = self.found.exponents.iter().enumerate().map(|(index, exponent)| {
            let of_shift =
                if Some(index) == shift { " (of a shift in time: exactly 0)" } else { "" };
            let value = match exponent {
                LyapunovExponent::Rate { value, error } => {
                    format!("{} ± {}{of_shift}", rate(*value), rate(*error))
                }
                LyapunovExponent::Erased => "−∞ (erased by sticks)".to_owned(),
            };
            format!("  exponent {:<27}{value}\n", index + 1)
        });
        let rows: String = rows.collect();
        match self.found.kaplan_yorke_dimension(self.moves_freely) {
            Some(dimension) => {
                format!("{rows}  {:<36}{}\n", "Kaplan–Yorke dimension", digits(dimension))
            }
            None => rows,
        }
    }
}
