//! Random samples of the uncertain numbers of a design, and the dither that is quiet in a share of them.

use quell_design::NoAnswer;
use quell_design::least_dither::{
    DesignPoint, DesignProblem, DesignStart, LeastOfSample, LimitedQuantity, NoDesign, NoLeast,
    SampledLeast, SampledQuiet, ScaledPlant, design,
};
use quell_design::tasks::InTurn;
use quell_dynamics::simulation::within;
use quell_model::RefusedNumbers;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::found::{ConfidentDither, DesignNumber, DesignNumbers};
use super::study_with_design::StudyWithDesign;
use super::unknown::NoConfidentDither;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::parallel::Parallel;
use crate::study::{Confidence, Design, Uncertainty};

/// The quiet amplitudes of a sample for a waveform by its number: of numbers by path, with the other design variables.
pub(crate) type SampleOf<'a> =
    dyn Fn(usize, &[(&str, f64)], &[f64]) -> Result<SampledQuiet<'a>, RefusedNumbers> + Sync + 'a;

/// The same of one waveform.
type SampleAtPoint<'a, 's> =
    dyn Fn(&[(&str, f64)], &[f64]) -> Result<SampledQuiet<'s>, RefusedNumbers> + Sync + 'a;

/// Times that the other design variables are chosen again for the larger amplitude that the samples need.
const ROUNDS: usize = 4;

/// Relative change of the ratio of that amplitude to the least one at which the choice is accepted.
const CLOSENESS: f64 = 1e-3;

/// Random samples of the uncertain numbers of a study.
pub(super) struct DrawnSamples<'a> {
    confidence: Confidence,
    uncertainty: &'a Uncertainty,
}

/// The samples that a design asks for, if any.
///
/// # Errors
/// A complaint about an uncertain number that the design gives, or about runs from afar.
pub(super) fn sampling<'a>(
    study: &'a dyn StudyWithDesign,
    asked: &Design,
    numbers: &DesignNumbers,
) -> Result<Option<DrawnSamples<'a>>, Failure> {
    let Some(confidence) = asked.confidence else { return Ok(None) };
    let Some(uncertainty) = study.uncertain() else {
        let allowed = "a table [uncertainty] with distributions, such as \"belt.damping_ratio\" = { lognormal = [0.05, 0.5] }: \
                       design.confidence is a share of its samples";
        let (origin, null) = (Origin::Whole, Json::Null);
        return Err(Complaint::new(Fault::Missing, "uncertainty", origin, null, allowed).into());
    };
    let refuse = |key: &str, given: Json, allowed: String| -> Failure {
        Complaint::new(Fault::Conflict, key, Origin::Whole, given, allowed).into()
    };
    if asked.start != DesignStart::Local {
        let allowed = "\"local\" with design.confidence: the exact thresholds of the base response decide about samples";
        return Err(refuse("design.start", asked.start.name().into(), allowed.to_owned()));
    }
    let DesignNumbers { amplitude, others, over } = numbers;
    let mut given = [amplitude].into_iter().chain(others).chain(over);
    let both = |number: &&DesignNumber| uncertainty.paths().any(|path| path == number.path);
    if let Some(number) = given.find(both) {
        let allowed = format!(
            "without {}, which [design] gives: a number of design.vary is chosen, one of design.over takes every value of its range",
            number.path
        );
        return Err(refuse("uncertainty", number.path.as_str().into(), allowed));
    }
    Ok(Some(DrawnSamples { confidence, uncertainty }))
}

/// What is known of one sample by averaging.
enum Averaged {
    Invalid(RefusedNumbers),
    Least(LeastOfSample),
    Never,
    Unknown(NoAnswer),
}

/// The least amplitude that is quiet in a share of the samples.
struct Quantile {
    amplitude: f64,
    interval: RealInterval,
    exact: usize,
    never: usize,
    loud_again: usize,
    unknown: (usize, Option<NoAnswer>),
    invalid: (usize, Option<RefusedNumbers>),
}

impl DrawnSamples<'_> {
    /// The dither near a design that is quiet in the share of the samples that is asked for.
    ///
    /// # Errors
    /// Why it does not exist.
    pub(super) fn confident(
        &self,
        problem: &DesignProblem<'_>,
        critical: &DesignPoint,
        sample: &SampleAtPoint<'_, '_>,
    ) -> Result<ConfidentDither, NoConfidentDither> {
        let mut chosen = critical.clone();
        let mut factor = None;
        for round in 1..=ROUNDS {
            let found = self.quantile(problem, &chosen, sample)?;
            let dither = problem.with_amplitude(&chosen, found.amplitude);
            let ratio = found.amplitude / chosen.amplitude;
            let settled =
                factor.is_some_and(|factor: f64| (ratio / factor - 1.0).abs() < CLOSENESS);
            let free = !problem.others.is_empty() && round < ROUNDS;
            if settled || !free || dither.use_of_limits() <= 1.0 {
                let Quantile { interval, exact, never, loud_again, unknown, invalid, .. } = found;
                return Ok(ConfidentDither {
                    confidence: self.confidence,
                    dither,
                    interval,
                    least: chosen.amplitude,
                    exact,
                    never,
                    loud_again,
                    unknown,
                    invalid,
                });
            }
            // The other design variables that keep the limits under the larger amplitude.
            factor = Some(ratio);
            chosen = enlarged(problem, ratio)?;
        }
        Err(NoConfidentDither::Unsettled)
    }

    /// The amplitude that is enough for the share of the samples, with the other variables of a design.
    fn quantile(
        &self,
        problem: &DesignProblem<'_>,
        design: &DesignPoint,
        sample: &SampleAtPoint<'_, '_>,
    ) -> Result<Quantile, NoConfidentDither> {
        // The samples themselves are judged in parallel.
        let problem = &DesignProblem { tasks: &InTurn, ..*problem };
        let Confidence { share, samples, seed } = self.confidence;
        let paths: Vec<&str> = self.uncertainty.paths().collect();
        let joint = self.uncertainty.joint();
        let drawn = |number: usize| {
            let values = joint.sample(seed, number as u64).first;
            let numbers: Vec<(&str, f64)> = paths.iter().copied().zip(values).collect();
            sample(&numbers, &design.others)
        };
        let samples = AveragedSamples::judged(samples, problem, design, &drawn)?;
        let (known, unknown) = samples.exactly(problem, share, &drawn);
        let quantile = known.quantile(share).ok_or(NoConfidentDither::NoSamples)?;
        let never = samples.never();
        if !quantile.value.is_finite() {
            return Err(NoConfidentDither::NeverQuiet {
                never: never + unknown.len(),
                all: samples.valid.len(),
                first: unknown.into_iter().next(),
            });
        }
        let loud = |place: &usize| {
            samples.least(*place) < quantile.interval.lower
                && !known.contains(*place)
                && drawn(samples.valid[*place]).is_ok_and(|sample| {
                    !problem.is_quiet_by_averaging(&sample, design, quantile.value)
                })
        };
        let places: Vec<usize> = (0..samples.valid.len()).collect();
        let loud_again = places.in_parallel(loud).filter(|is_loud| *is_loud).count();
        Ok(Quantile {
            amplitude: quantile.value,
            interval: quantile.interval,
            exact: known.known(),
            never,
            loud_again,
            unknown: counted(unknown),
            invalid: counted(samples.reasons(|sample| match sample {
                Averaged::Invalid(why) => Some(why.clone()),
                _ => None,
            })),
        })
    }
}

/// The number of some reasons, and the first of them.
fn counted<W>(whys: Vec<W>) -> (usize, Option<W>) {
    (whys.len(), whys.into_iter().next())
}

/// A sample by its number.
type SampleByNumber<'a, 's> = dyn Fn(usize) -> Result<SampledQuiet<'s>, RefusedNumbers> + Sync + 'a;

/// Samples judged by averaging.
struct AveragedSamples {
    all: Vec<Averaged>,
    /// The numbers of those that are valid studies.
    valid: Vec<usize>,
}

impl AveragedSamples {
    /// Judges samples, in parallel.
    ///
    /// # Errors
    /// That none is a valid study.
    fn judged(
        count: usize,
        problem: &DesignProblem<'_>,
        design: &DesignPoint,
        drawn: &SampleByNumber<'_, '_>,
    ) -> Result<Self, NoConfidentDither> {
        let averaged = |number: &usize| match drawn(*number) {
            Err(why) => Averaged::Invalid(why),
            Ok(sample) => match problem.averaged_least_of(&sample, design) {
                Ok(least) => Averaged::Least(least),
                Err(NoLeast::NeverQuiet { .. }) => Averaged::Never,
                Err(NoLeast::Failed { why, .. }) => Averaged::Unknown(why),
            },
        };
        let numbers: Vec<usize> = (0..count).collect();
        let all: Vec<Averaged> = numbers.in_parallel(averaged).collect();
        let is_valid = |number: &usize| !matches!(all[*number], Averaged::Invalid(_));
        let valid: Vec<usize> = (0..count).filter(is_valid).collect();
        match all.first() {
            Some(Averaged::Invalid(why)) if valid.is_empty() => {
                Err(NoConfidentDither::AllInvalid(why.clone()))
            }
            _ => Ok(Self { all, valid }),
        }
    }

    /// The least amplitude of a valid sample by averaging.
    fn least(&self, place: usize) -> f64 {
        match &self.all[self.valid[place]] {
            Averaged::Least(least) => least.amplitude(),
            _ => f64::INFINITY,
        }
    }

    /// Samples in which no amplitude is quiet by averaging.
    fn never(&self) -> usize {
        self.all.iter().filter(|sample| matches!(sample, Averaged::Never)).count()
    }

    fn reasons<W>(&self, why: impl Fn(&Averaged) -> Option<W>) -> Vec<W> {
        self.all.iter().filter_map(why).collect()
    }

    /// The least amplitudes, exact where they decide about a quantile, and why amplitudes are unknown.
    fn exactly(
        &self,
        problem: &DesignProblem<'_>,
        share: f64,
        drawn: &SampleByNumber<'_, '_>,
    ) -> (SampledLeast, Vec<NoAnswer>) {
        let mut unknown = self.reasons(|sample| match sample {
            Averaged::Unknown(why) => Some(why.clone()),
            _ => None,
        });
        let least = |place: usize| self.least(place);
        let mut known = SampledLeast::new((0..self.valid.len()).map(least).collect());
        let exactly = |&place: &usize| -> (usize, Result<f64, NoLeast>) {
            let Averaged::Least(least) = &self.all[self.valid[place]] else {
                return (place, Ok(f64::INFINITY));
            };
            let failed =
                |why: RefusedNumbers| NoLeast::Failed { point: Vec::new(), why: why.into() };
            let found = drawn(self.valid[place]).map_err(failed).and_then(|sample| {
                within(STEPS_OF_MANY_SEARCHES, || problem.exact_least_of(&sample, least))
            });
            (place, found)
        };
        loop {
            let needed = known.needed(share);
            if needed.is_empty() {
                return (known, unknown);
            }
            let found: Vec<_> = needed.in_parallel(exactly).collect();
            for (place, exact) in found {
                let exact = exact.unwrap_or_else(|why| {
                    if let NoLeast::Failed { why, .. } = why {
                        unknown.push(why);
                    }
                    f64::INFINITY
                });
                known.add(place, exact);
            }
        }
    }
}

/// The design whose dither, enlarged by a factor, keeps every limit.
///
/// # Errors
/// Why it does not exist.
fn enlarged(problem: &DesignProblem<'_>, factor: f64) -> Result<DesignPoint, NoConfidentDither> {
    let plant = ScaledPlant { plant: problem.plant, factor };
    let RealInterval { lower: from, upper: to } = problem.amplitude;
    let limits: Vec<(LimitedQuantity, f64)> = problem
        .limits
        .iter()
        .map(|(quantity, limit)| match quantity {
            LimitedQuantity::Amplitude => (*quantity, limit / factor),
            _ => (*quantity, *limit),
        })
        .collect();
    let amplitude = RealInterval::new(from, (to / factor).max(from));
    let problem = DesignProblem { plant: &plant, amplitude, limits: &limits, ..*problem };
    let found = within(STEPS_OF_MANY_SEARCHES, || design(problem));
    found.answer.map(|found| found.critical).map_err(|none| match none.why {
        NoDesign::NeverQuiet { .. } => NoConfidentDither::BeyondRange { factor },
        NoDesign::Limit { quantity, used, .. } => {
            NoConfidentDither::Limit { quantity, used, factor }
        }
        NoDesign::Unlimited { why, .. } | NoDesign::Failed { why, .. } => {
            NoConfidentDither::NoAnswer(why)
        }
    })
}
