//! `response` under noise: runs with different seeds, and the share of them that ends without stick–slip.
//!
//! Noise does not repeat, so no orbit and no single record decides whether it quenches. Run k of N has the seed of the study plus k
//! for every noise, is integrated for the settling time, and its residual vibration E = M₁/M₀ (2.27) is measured over the record,
//! with the same record without dither. A run counts as quiet where E is below [`QUIET`]: friction turns the differences of the
//! lines' frequencies into a slow motion, so that E under noise is small but not zero. The share of quiet runs has the interval of
//! Wilson (1927) at 95 %, for which the runs are independent samples.

mod runs;

use quell_linear::averaging::AveragingError;
use quell_linear::driven_point::NoDrivenPoint;
use quell_linear::linear_cost::NoiseCost;
use quell_linear::steady::NoSteadySliding;
use quell_model::units::Quantity;
use quell_numerics::eigen::EigenError;
use quell_numerics::order::ascending;
use serde_json::Value as Json;

use super::basins::{Share, StartLayout};
use crate::complaint::{Complaint, Failure};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::reasons::reasons;
use crate::run::response::NoResidualVibration;
use crate::words::{capital, digits, plural};

pub use runs::run;

/// Number of runs by default: the interval of Wilson of 16 quiet runs of 16 begins at 81 %.
pub const SEEDS: usize = 16;

/// Most runs of one answer: the interval is then within 1 %.
pub const MOST_SEEDS: usize = 10_000;

/// Residual vibration below which a run under noise counts as quiet. Stick–slip has E near 1. A run without it has the slow motion
/// that the noise itself excites, which is largest, a third of the stick–slip, where sliding is only just stable. E passes from one
/// to the other without a gap: a smaller value counts more runs as vibrating, and E of every run is reported.
pub const QUIET: f64 = 0.5;

/// What a contact did in one run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoisyContact {
    /// Share of the record in stick.
    pub stick_fraction: f64,
    /// Mean friction force.
    pub friction: f64,
}

reasons! {
    /// Why the root mean squares of a dither are unknown.
    pub enum NoNoiseCost {
        /// There is no steady sliding.
        NoSliding(NoSteadySliding),
        /// The cost is unknown.
        NoCost(NoDrivenPoint),
        /// The dither is no sum of sines, but the waveform with this name.
        NoSines(&'static str) => "it is computed for sums of sines, and this dither is a \"{}\"",
        ;
        /// The input has no wave, or several.
        NotOneWave => "the input has no wave, or several",
    }
}

reasons! {
    /// Why the spread of E over the runs is unknown.
    enum NoSpread {
        /// E is undefined.
        Undefined(NoResidualVibration),
        ;
        /// No run was made.
        NoRun => "no run",
    }
}

reasons! {
    /// Why the averaged growth rate of small slow motions is unknown.
    pub enum NoAveragedGrowth {
        /// There is no average.
        NoAverage(AveragingError),
        /// The eigenvalues are unknown.
        Eigenvalues(EigenError),
        ;
    }
}

/// One run under noise.
#[derive(Clone, Debug, PartialEq)]
pub struct NoisyRun {
    /// The seed of its first noise.
    pub seed: u64,
    /// E, or why it is undefined.
    pub residual_vibration: Result<f64, NoResidualVibration>,
    /// M, the largest spectral amplitude in the band of slow vibration.
    pub amplitude: f64,
    /// Whether M of the halves of the record agree.
    pub settled: bool,
    /// The contacts, in the order of the study.
    pub contacts: Vec<NoisyContact>,
}

/// The response under noise.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseResponse {
    /// The runs; run k has the seeds of the study plus k.
    pub runs: Vec<NoisyRun>,
    /// Names of the contacts.
    pub contacts: Vec<String>,
    /// M without dither.
    pub undithered_amplitude: f64,
    /// Mean friction of every contact without dither.
    pub undithered_friction: Vec<f64>,
    /// Root mean squares of the linear response to the dither, to each of them, or why they are unknown.
    pub costs: Vec<Result<NoiseCost, NoNoiseCost>>,
    /// Largest growth rate of small slow motions, averaged over the Gaussian distribution of the noise; or why it is unknown.
    pub averaged: Result<f64, NoAveragedGrowth>,
    /// The start of every run in words.
    pub start: String,
    /// Time before the record.
    pub settle: f64,
    /// Length of a record.
    pub length: f64,
    /// Upper end of the band in which M is measured, an angular frequency.
    pub band_end: f64,
    /// Warnings about slip beyond the range of a law.
    pub warnings: Vec<String>,
}

/// The number of runs of a study.
///
/// # Errors
/// A complaint about `--seeds`.
fn number_of_runs(seeds: Option<usize>, is_noise: bool) -> Result<usize, Failure> {
    let count = seeds.unwrap_or(SEEDS);
    let refused =
        |allowed: String| Err(Complaint::option("--seeds", count.to_string(), allowed).into());
    if !is_noise {
        return refused(
            "left out: the dither is periodic, and every run of it is the same".to_owned(),
        );
    }
    if !(1..=MOST_SEEDS).contains(&count) {
        return refused(format!("a whole number from 1 to {MOST_SEEDS}"));
    }
    Ok(count)
}

/// Least, median and largest of some values.
fn spread(values: &[f64]) -> Option<[f64; 3]> {
    let mut values = values.to_vec();
    ascending(&mut values);
    let (first, last) = (*values.first()?, *values.last()?);
    let middle = values.len() / 2;
    let median = if values.len().is_multiple_of(2) {
        0.5 * (values[middle - 1] + values[middle])
    } else {
        values[middle]
    };
    Some([first, median, last])
}

impl NoiseResponse {
    /// E of every run.
    ///
    /// # Errors
    /// Why E is undefined.
    pub fn residual_vibrations(&self) -> Result<Vec<f64>, NoResidualVibration> {
        self.runs.iter().map(|run| run.residual_vibration).collect()
    }

    /// The share of quiet runs.
    ///
    /// # Errors
    /// Why E is undefined.
    pub fn quiet(&self) -> Result<Share, NoResidualVibration> {
        let inside: Vec<bool> = self
            .residual_vibrations()?
            .iter()
            .map(|residual_vibration| *residual_vibration < QUIET)
            .collect();
        Ok(Share::of(StartLayout::Sample { count: self.runs.len(), seed: 0 }, &inside))
    }

    /// Mean friction of a contact over the runs.
    fn friction(&self, contact: usize) -> f64 {
        let each = self.runs.iter().map(|run| run.contacts[contact].friction);
        each.sum::<f64>() / self.runs.len() as f64
    }

    fn column(&self, value: impl Fn(&NoisyRun) -> f64) -> Vec<f64> {
        self.runs.iter().map(value).collect()
    }

    fn seeds(&self) -> Vec<u64> {
        self.runs.iter().map(|run| run.seed).collect()
    }

    /// The share of quiet runs and the record; `in_words` writes a quantity with its unit.
    pub fn sentence(&self, in_words: impl Fn(Quantity, f64) -> String) -> String {
        let count = self.runs.len();
        let runs = format!("{count} run{} with different seeds", plural(count));
        let result = match (&self.quiet(), &self.residual_vibrations()) {
            (Ok(share), Ok(each)) => {
                let [least, median, largest] = spread(each)
                    .unwrap_or([0.0; 3])
                    .map(|value| quell_model::digits::digits(value, 3));
                format!(
                    "of {runs}, {} end without stick–slip: {}. The residual vibration E has the median {median}, from {least} to \
                     {largest}",
                    share.starts,
                    share.percent()
                )
            }
            (Err(why), _) | (_, Err(why)) => {
                format!("{runs} were computed, but the share that quenches is unknown: {why}")
            }
        };
        let [settle, length] =
            [self.settle, self.length].map(|time| in_words(Quantity::Time, time));
        format!(
            "{}, {result}. Each run is measured for {length} after t = {settle}.",
            capital(&self.start)
        )
    }

    /// Warnings about the answer.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        let unsettled = self.runs.iter().filter(|run| !run.settled).count();
        let near = self.residual_vibrations().map_or(0, |each| {
            each.iter()
                .filter(|residual_vibration| {
                    (0.5 * QUIET..2.0 * QUIET).contains(*residual_vibration)
                })
                .count()
        });
        if near > 0 {
            warnings.push(format!(
                "the residual vibration of {near} of {} runs is within a factor of 2 of {QUIET}, below which a run counts as quiet \
                 (in {unsettled} the halves of the record differ, as random records do): raise --record",
                self.runs.len()
            ));
        }
        warnings
    }

    /// The runs as JSON.
    fn put(&self, fields: &mut Fields, sentence: String) {
        fields.plain("ok", true).plain("sentence", sentence);
        fields.plain("runs", self.runs.len()).number("quiet_below", Quantity::Ratio, QUIET);
        let share = |value: fn(&Share) -> f64| self.quiet().map(|share| value(&share));
        match self.quiet() {
            Ok(share) => fields.plain("quiet_runs", share.starts),
            Err(why) => fields.unknown("quiet_runs", why),
        };
        fields
            .known("quiet_fraction", Quantity::Ratio, share(|share| share.fraction))
            .known("quiet_fraction_low", Quantity::Ratio, share(|share| share.low))
            .known("quiet_fraction_high", Quantity::Ratio, share(|share| share.high))
            .plain("interval", "Wilson, 95 %")
            .known_rate("averaged_growth_rate", self.averaged.clone())
            .plain("seeds", self.seeds());
        let each = self.residual_vibrations();
        match &each {
            Ok(each) => fields.numbers("residual_vibration", Quantity::Ratio, each),
            Err(why) => fields.unknown("residual_vibration", why),
        };
        let of = |place: usize| {
            let each = each.as_ref().map_err(|why| NoSpread::Undefined(*why))?;
            spread(each).map(|all| all[place]).ok_or(NoSpread::NoRun)
        };
        fields
            .known("residual_vibration_least", Quantity::Ratio, of(0))
            .known("residual_vibration_median", Quantity::Ratio, of(1))
            .known("residual_vibration_largest", Quantity::Ratio, of(2))
            .numbers("amplitude", Quantity::Displacement, &self.column(|run| run.amplitude))
            .number("undithered_amplitude", Quantity::Displacement, self.undithered_amplitude)
            .number("settle", Quantity::Time, self.settle)
            .number("record_length", Quantity::Time, self.length)
            .plain("warnings", self.warnings());
    }

    /// Stick and mean friction of a contact.
    fn put_contact(&self, fields: &mut Fields, contact: usize) {
        let stuck = self.column(|run| run.contacts[contact].stick_fraction);
        fields
            .numbers("stick_fraction", Quantity::Ratio, &stuck)
            .number("mean_friction", Quantity::Force, self.friction(contact))
            .number("mean_friction_undithered", Quantity::Force, self.undithered_friction[contact]);
    }

    /// Root mean squares of the dither; its peaks have no value.
    fn put_cost(cost: &Result<NoiseCost, NoNoiseCost>, fields: &mut Fields) {
        let of = |value: fn(&NoiseCost) -> f64| cost.as_ref().map(value).map_err(Clone::clone);
        let peak = || Err("noise has no largest value; see the root mean square");
        fields
            .known("force_rms", Quantity::Force, of(|cost| cost.force))
            .known("displacement_rms", Quantity::Displacement, of(|cost| cost.displacement))
            .known("velocity_rms", Quantity::Velocity, of(|cost| cost.velocity))
            .known("power", Quantity::Power, of(|cost| cost.power))
            .known("force_peak", Quantity::Force, peak())
            .known("stroke", Quantity::Displacement, peak());
    }

    /// As JSON.
    pub fn json(&self, empty: impl Fn() -> Fields, sentence: String) -> Json {
        let mut fields = empty();
        self.put(&mut fields, sentence);
        let contacts = self.contacts.iter().enumerate().map(|(contact, name)| {
            let mut inner = empty();
            inner.plain("name", name.as_str());
            self.put_contact(&mut inner, contact);
            inner
        });
        fields.number("band_end", Quantity::FrequencyRatio, self.band_end);
        fields.list("contacts", contacts.collect::<Vec<_>>());
        let dithers = self.costs.iter().map(|cost| {
            let mut inner = empty();
            Self::put_cost(cost, &mut inner);
            inner
        });
        fields.list("dithers", dithers.collect::<Vec<_>>());
        fields.finish()
    }

    /// Adds the runs to a dataset; contacts have their names where there are several.
    pub fn columns(&self, dataset: Dataset) -> Dataset {
        let seeds = self.runs.iter().map(|run| run.seed as f64).collect();
        let residual_vibration =
            self.column(|run| *run.residual_vibration.as_ref().unwrap_or(&f64::NAN));
        let mut dataset = dataset
            .fact(format!("start: {}", self.start))
            .with_axis(Array::new("seed", "1", seeds))
            .array("residual_vibration", Quantity::Ratio, residual_vibration)
            .array("amplitude", Quantity::Displacement, self.column(|run| run.amplitude));
        for (contact, name) in self.contacts.iter().enumerate() {
            let of = match self.contacts.len() {
                1 => String::new(),
                _ => format!("_{name}"),
            };
            let stuck = self.column(|run| run.contacts[contact].stick_fraction);
            let friction = self.column(|run| run.contacts[contact].friction);
            dataset = dataset.array(&format!("stick_fraction{of}"), Quantity::Ratio, stuck).array(
                &format!("mean_friction{of}"),
                Quantity::Force,
                friction,
            );
        }
        dataset
    }

    /// The numbers of the table: label and value in words.
    pub fn rows(&self) -> Vec<(String, String)> {
        let mut rows = Vec::new();
        let mut row = |label: &str, value: String| rows.push((label.to_owned(), value));
        match self.quiet() {
            Ok(share) => row("runs without stick–slip", share.percent()),
            Err(why) => row("runs without stick–slip", format!("unknown: {why}")),
        }
        if let Some([least, median, largest]) =
            self.residual_vibrations().ok().and_then(|each| spread(&each))
        {
            row("residual vibration E, median", digits(median));
            row("  least", digits(least));
            row("  largest", digits(largest));
        }
        row("counts as quiet below E", format!("{QUIET}"));
        row(
            "averaged growth rate",
            match &self.averaged {
                Ok(rate) => digits(*rate),
                Err(why) => format!("unknown: {why}"),
            },
        );
        rows
    }
}
