//! `probability`: how probable it is that a study with uncertain numbers vibrates.
//!
//! Each sample is a study with the numbers of one random point (`[uncertainty]`). Its growth rate is that of averaging, and its
//! verdict that of the requested start: by averaging, by the multipliers of the base response, or by where the run from rest or from
//! the undithered limit cycle ends. The judges are those of `stability`, `orbit`, `thresholds` and `attractor`.

mod answer;
mod sampled;
mod thresholds;
mod unknown;

use std::sync::atomic::Ordering;

use quell_numerics::interval::RealInterval;

use crate::parallel::Parallel;
use quell_design::probability::{SobolIndices, binomial_interval, quantile, sobol_indices};
use quell_model::RefusedNumbers;
use quell_numerics::order::ascending;

pub use sampled::{AveragedGrowth, JudgedGrowth, SampledKind};
pub use thresholds::SampledThresholds;
pub use unknown::{
    NoIndices, NoSampledGrowth, NoSampledThreshold, NoSampledVerdict, NoThresholdQuantile,
    RefusedStart,
};

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::running::Running;
use crate::study::{ParameterId, StudyKind, StudyOf};

/// Samples of a verdict that needs no run.
pub const SAMPLES: usize = 100_000;

/// Samples of a verdict by exact motions.
pub const SAMPLES_OF_MOTIONS: usize = 1000;

/// Most samples.
pub const MOST_SAMPLES: usize = 10_000_000;

/// Points in one piece of work.
const CHUNK: usize = 64;

/// What decides whether a sample vibrates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProbabilityStart {
    /// Averaged growth of small motions.
    #[default]
    Averaged,
    /// The multipliers of the base response; without dither the growth of small motions.
    Local,
    /// The end of the run from rest.
    Rest,
    /// The end of the run from the undithered limit cycle.
    Squeal,
}

impl ProbabilityStart {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Averaged, Self::Local, Self::Rest, Self::Squeal];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Averaged => "averaged",
            Self::Local => "local",
            Self::Rest => "rest",
            Self::Squeal => "squeal",
        }
    }

    /// The start with this name.
    ///
    /// # Errors
    /// A complaint with the names.
    pub fn named(name: &str) -> Result<Self, Box<Complaint>> {
        let found = Self::ALL.into_iter().find(|known| known.name() == name);
        found.ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            let complaint =
                Complaint::option("--start", name, format!("one of {}", names.join(", ")));
            Box::new(complaint.suggesting(crate::nearest::word(name, names)))
        })
    }

    /// What decides, in words.
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Averaged => "by averaging",
            Self::Local => "by the multipliers of its base response",
            Self::Rest => "on the run from rest",
            Self::Squeal => "on the run from the undithered limit cycle",
        }
    }

    fn samples(self) -> usize {
        if self == Self::Averaged { SAMPLES } else { SAMPLES_OF_MOTIONS }
    }
}

/// Options of `probability`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProbabilityRequest {
    /// Number of samples; the default depends on the start.
    pub samples: Option<usize>,
    /// Seed of the random numbers.
    pub seed: u64,
    /// What decides whether a sample vibrates.
    pub start: ProbabilityStart,
}

impl Default for ProbabilityRequest {
    fn default() -> Self {
        Self { samples: None, seed: 1, start: ProbabilityStart::default() }
    }
}

/// Verdicts of samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct VerdictTally {
    /// Samples that vibrate.
    pub vibrating: usize,
    /// Samples that do not.
    pub quiet: usize,
    /// Samples whose verdict is unknown.
    pub unknown: usize,
    /// Why the first of them is.
    pub why: Option<NoSampledVerdict>,
}

impl VerdictTally {
    fn of<'a>(verdicts: impl Iterator<Item = &'a Result<bool, NoSampledVerdict>>) -> Self {
        let mut tally = Self::default();
        for verdict in verdicts {
            match verdict {
                Ok(true) => tally.vibrating += 1,
                Ok(false) => tally.quiet += 1,
                Err(why) => {
                    tally.unknown += 1;
                    tally.why.get_or_insert_with(|| why.clone());
                }
            }
        }
        tally
    }

    /// Share of the samples with a verdict that vibrate.
    pub fn probability(&self) -> Option<f64> {
        let known = self.vibrating + self.quiet;
        (known > 0).then(|| self.vibrating as f64 / known as f64)
    }

    /// The 95 % interval of the probability, wide enough for any verdict of the samples whose verdict is unknown.
    pub fn interval(&self) -> RealInterval {
        let all = self.vibrating + self.quiet + self.unknown;
        let RealInterval { lower: low, .. } = binomial_interval(self.vibrating, all);
        let RealInterval { upper: high, .. } =
            binomial_interval(self.vibrating + self.unknown, all);
        RealInterval::new(low, high)
    }
}

/// Growth rates of the samples by one method of averaging.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledGrowth {
    /// Known growth rates, ascending.
    pub rates: Vec<f64>,
    /// Samples whose growth rate is unknown.
    pub unknown: usize,
    /// Why the first of them is.
    pub why: Option<NoSampledGrowth>,
    /// Sobol indices of each group of numbers, or why they are unknown.
    pub indices: Vec<Result<SobolIndices, NoIndices>>,
}

/// How probable it is that a study vibrates.
#[derive(Clone, Debug, PartialEq)]
pub struct VibrationProbability {
    /// What decides.
    pub start: ProbabilityStart,
    /// Number of samples.
    pub samples: usize,
    /// Seed.
    pub seed: u64,
    /// Paths of the uncertain numbers.
    pub paths: Vec<String>,
    /// Groups of correlated numbers; a number that is independent is a group of its own.
    pub groups: Vec<Vec<usize>>,
    /// The verdicts.
    pub verdicts: VerdictTally,
    /// The verdicts of averaging in the limit R → ∞, of one mass under dither judged by averaging.
    pub limit_verdicts: Option<VerdictTally>,
    /// The growth rates by averaging with the response of the structure to the dither.
    pub growth: SampledGrowth,
    /// Those in the limit R → ∞, of one mass under dither.
    pub limit_growth: Option<SampledGrowth>,
    /// The least quiet amplitudes of the first dither, by averaging or, judged by the base response, exactly.
    pub thresholds: SampledThresholds,
    /// Samples in which slip leaves the range of a friction law.
    pub beyond_range: usize,
    /// Samples in which the fast motion opens a contact, which averaging does not describe.
    pub opens: usize,
    /// Samples with a dither that is hardly fast, of a belt judged by averaging.
    pub hardly_fast: usize,
    /// Samples about which the two methods of averaging disagree.
    pub apart: usize,
    /// Samples that are no valid studies.
    pub invalid: usize,
    /// Why the first of them is none.
    pub invalid_why: Option<RefusedNumbers>,
}

/// One sample: its growth at the first point, the second, and the mixed ones, its verdict and its threshold.
struct JudgedSample {
    first: AveragedGrowth,
    second: AveragedGrowth,
    mixed: Vec<AveragedGrowth>,
    verdict: Result<bool, NoSampledVerdict>,
    threshold: Option<Result<f64, NoSampledThreshold>>,
}

/// How probable it is that a study vibrates.
///
/// # Errors
/// A complaint about a study without `[uncertainty]`, about the request, or about a start that the kind of study does not have;
/// [`Failure::Failed`] if it was stopped.
pub fn run<K>(
    study: &StudyOf<K>,
    request: ProbabilityRequest,
    running: Running<'_>,
) -> Result<VibrationProbability, Failure>
where
    K: StudyKind + Sync + Send,
    StudyOf<K>: SampledKind,
{
    let ProbabilityRequest { samples, seed, start } = request;
    let Some(uncertainty) = study.uncertainty() else {
        let allowed = "a table [uncertainty] with distributions, such as \"belt.damping_ratio\" = { lognormal = [0.05, 0.5] }";
        let null = serde_json::Value::Null;
        return Err(
            Complaint::new(Fault::Missing, "uncertainty", Origin::Whole, null, allowed).into()
        );
    };
    let samples = samples.unwrap_or_else(|| start.samples());
    if !(1..=MOST_SAMPLES).contains(&samples) {
        let allowed = format!("a whole number from 1 to {MOST_SAMPLES}");
        return Err(Complaint::option("--samples", samples, allowed).into());
    }
    study.can_be_sampled(start)?;
    let joint = uncertainty.joint();
    let paths: Vec<String> = uncertainty.paths().map(str::to_owned).collect();
    let model = study.model();
    let parameters =
        paths.iter().map(|path| model.parameter(path)).collect::<Result<Vec<_>, _>>()?;
    let single = joint.groups().len() == 1;
    let sample = |number: usize| -> Result<JudgedSample, RefusedNumbers> {
        let points = joint.sample(seed, number as u64);
        let at = |values: &[f64]| {
            let numbers: Vec<(ParameterId, f64)> =
                parameters.iter().cloned().zip(values.iter().copied()).collect();
            study.sampled_at(&numbers)
        };
        let first = at(&points.first)?;
        let growth = study.averaged_growth(&first);
        let verdict = match start {
            ProbabilityStart::Averaged => verdict(&growth.growth).map_err(NoSampledVerdict::from),
            _ => study.vibrates(&first, start),
        };
        let threshold = SampledThresholds::includes(number).then(|| match start {
            ProbabilityStart::Averaged => study.threshold(&first, false),
            ProbabilityStart::Local => study.threshold(&first, true),
            ProbabilityStart::Rest | ProbabilityStart::Squeal => Err(NoSampledThreshold::OfRuns),
        });
        let second = study.averaged_growth(&at(&points.second)?);
        // With one group the mixed point is the second one.
        let mixed = if single {
            vec![second.clone()]
        } else {
            let mixed = points.mixed.iter().map(|values| Ok(study.averaged_growth(&at(values)?)));
            mixed.collect::<Result<_, RefusedNumbers>>()?
        };
        Ok(JudgedSample { first: growth, second, mixed, verdict, threshold })
    };
    running.progress.begin(samples, 0);
    let pool = running.pool()?;
    let chunks: Vec<usize> = (0..samples.div_ceil(CHUNK)).collect();
    let of_chunk = |chunk: &usize| {
        if running.stop.load(Ordering::Relaxed) {
            return None;
        }
        let range = chunk * CHUNK..samples.min((chunk + 1) * CHUNK);
        let done: Vec<Result<JudgedSample, RefusedNumbers>> = range.map(sample).collect();
        running.progress.advance(done.len());
        Some(done)
    };
    let found: Option<Vec<Vec<Result<JudgedSample, RefusedNumbers>>>> =
        pool.install(|| chunks.in_parallel(of_chunk).collect());
    running.progress.end();
    let Some(found) = found else { return Err(super::stopped("probability")) };
    let mut valid: Vec<JudgedSample> = Vec::with_capacity(samples);
    let (mut invalid, mut invalid_why) = (0, None);
    for sample in found.into_iter().flatten() {
        match sample {
            Ok(sample) => valid.push(sample),
            Err(why) => {
                invalid += 1;
                invalid_why.get_or_insert(why);
            }
        }
    }
    let groups = joint.groups().to_vec();
    let averaged = start == ProbabilityStart::Averaged;
    let has_limit = valid.iter().any(|sample| sample.first.limit.is_some());
    let limit_verdicts = limit_verdicts(&valid);
    Ok(VibrationProbability {
        start,
        samples,
        seed,
        paths,
        verdicts: VerdictTally::of(valid.iter().map(|sample| &sample.verdict)),
        limit_verdicts: (has_limit && averaged).then(|| VerdictTally::of(limit_verdicts.iter())),
        growth: growth(&valid, &groups, |growth| Some(&growth.growth)),
        limit_growth: has_limit.then(|| growth(&valid, &groups, |growth| growth.limit.as_ref())),
        thresholds: SampledThresholds::of(
            valid.iter().filter_map(|sample| sample.threshold.as_ref()),
        ),
        beyond_range: valid.iter().filter(|sample| sample.first.beyond_range).count(),
        opens: valid.iter().filter(|sample| sample.first.opens).count(),
        hardly_fast: valid.iter().filter(|sample| averaged && sample.first.hardly_fast).count(),
        apart: valid.iter().filter(|sample| averaged && disagree(&sample.first)).count(),
        groups,
        invalid,
        invalid_why,
    })
}

/// The verdicts in the limit of high dither frequency, of the samples that have one.
fn limit_verdicts(samples: &[JudgedSample]) -> Vec<Result<bool, NoSampledVerdict>> {
    let growths = samples.iter().filter_map(|sample| sample.first.limit.as_ref());
    growths.map(|growth| Ok(verdict(growth)?)).collect()
}

/// Whether the two methods of averaging have different verdicts.
fn disagree(growth: &AveragedGrowth) -> bool {
    let limit = growth.limit.as_ref().and_then(|found| verdict(found).ok());
    limit.is_some_and(|limit| verdict(&growth.growth).is_ok_and(|own| own != limit))
}

/// The verdict of a growth rate.
fn verdict(growth: &OneGrowth) -> Result<bool, NoSampledGrowth> {
    Ok(growth.as_ref().map_err(Clone::clone)?.vibrates?)
}

/// A growth rate of one method of averaging.
type OneGrowth = Result<JudgedGrowth, NoSampledGrowth>;

/// The growth rates of samples by one method of averaging.
fn growth(
    samples: &[JudgedSample],
    groups: &[Vec<usize>],
    of: impl Fn(&AveragedGrowth) -> Option<&OneGrowth>,
) -> SampledGrowth {
    let rate = |growth: &AveragedGrowth| Some(of(growth)?.as_ref().ok()?.rate);
    let mut rates: Vec<f64> = samples.iter().filter_map(|sample| rate(&sample.first)).collect();
    ascending(&mut rates);
    let unknown = samples.len() - rates.len();
    let why = samples.iter().find_map(|sample| of(&sample.first)?.as_ref().err().cloned());
    let indices = (0..groups.len()).map(|group| {
        let triple = |sample: &JudgedSample| {
            Some((rate(&sample.first)?, rate(&sample.second)?, rate(&sample.mixed[group])?))
        };
        let known: Vec<(f64, f64, f64)> = samples.iter().filter_map(triple).collect();
        if unknown > 0 && 2 * unknown > samples.len() {
            return Err(NoIndices::MostUnknown);
        }
        sobol_indices(&known).ok_or(NoIndices::NoVariance)
    });
    SampledGrowth { indices: indices.collect(), unknown, why, rates }
}

impl SampledGrowth {
    /// Growth rates times a factor, and the share of the samples up to each, at most `points` of them.
    pub fn distribution(&self, points: usize, factor: f64) -> (Vec<f64>, Vec<f64>) {
        let shares = super::evenly(RealInterval::new(0.0, 1.0), points);
        let at = |share: f64| Some((factor * quantile(&self.rates, share)?, share));
        shares.into_iter().filter_map(at).unzip()
    }
}
