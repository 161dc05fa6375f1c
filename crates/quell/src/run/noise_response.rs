//! `response` under noise: runs with different seeds, and the share of them that ends without stick–slip.
//!
//! Noise does not repeat, so no orbit and no single record decides whether it quenches. Run k of N has the seed of the study plus k
//! for every noise, is integrated for the settling time, and its residual vibration E = M₁/M₀ (2.27) is measured over the record,
//! with the same record without dither. A run counts as quiet where E is below [`QUIET`]: friction turns the differences of the
//! lines' frequencies into a slow motion, so that E under noise is small but not zero. The share of quiet runs has the interval of
//! Wilson (1927) at 95 %, for which the runs are independent samples.

use quell_dynamics::response::{
    BAND_END, Compared, Observables, ResponseCase, Undefined, compare_many,
};
use quell_linear::linear_cost::{NoiseCost, noise_cost};
use quell_model::units::Quantity;
use quell_model::waveform::Noise;
use quell_model::{Belt, Direction, Waveform};
use rayon::prelude::*;
use serde_json::Value as Json;

use super::basins::{Share, StartLayout};
use super::{failed, start};
use crate::complaint::{Complaint, Failure};
use crate::contact_state::complaint_of_belt;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::range;
use crate::study::BeltStudy;
use crate::words::{digits, in_words, plural, start_in_words};

/// Number of runs by default: the interval of Wilson of 16 quiet runs of 16 begins at 81 %.
pub const SEEDS: usize = 16;

/// Most runs of one answer: the interval is then within 1 %.
pub const MOST_SEEDS: usize = 10_000;

/// Residual vibration below which a run under noise counts as quiet. Stick–slip has E near 1. A run without it has the slow motion
/// that the noise itself excites, which is largest, a third of the stick–slip, where sliding is only just stable. E passes from one
/// to the other without a gap: a smaller value counts more runs as vibrating, and E of every run is reported.
pub const QUIET: f64 = 0.5;

/// Runs of one work item: as many as fit into the lanes of a processor.
const ABREAST: usize = 8;

/// The response under noise.
#[derive(Clone, Debug)]
pub struct NoiseResponse {
    /// What is added to the seeds of the study in each run, from 0.
    pub seeds: Vec<u64>,
    /// The records of each run, with and without dither.
    pub runs: Vec<Compared>,
    /// The share of quiet runs, or why E is undefined.
    pub quiet: Result<Share, Undefined>,
    /// Root mean squares of the linear response to all tangential dither, or why they are unknown.
    pub cost: Result<NoiseCost, String>,
}

/// Measures runs with `seeds` different seeds.
///
/// # Errors
/// A number of seeds that is not allowed; a contact with a state; as [`super::response::run`].
pub fn run(study: &BeltStudy, seeds: Option<usize>) -> Result<NoiseResponse, Failure> {
    let count = seeds.unwrap_or(SEEDS);
    let belt = study.belt();
    if belt.dithers().iter().all(|dither| dither.waveform.is_periodic()) {
        let allowed = "left out: the dither is periodic, and every run of it is the same";
        return Err(Complaint::option("--seeds", count.to_string(), allowed).into());
    }
    if !(1..=MOST_SEEDS).contains(&count) {
        let allowed = format!("a whole number from 1 to {MOST_SEEDS}");
        return Err(Complaint::option("--seeds", count.to_string(), allowed).into());
    }
    if let Some(complaint) = complaint_of_belt(belt, "response") {
        return Err(complaint.into());
    }
    let start = start(study)?;
    let seeds: Vec<u64> = (0..count as u64).collect();
    let cases: Vec<ResponseCase> =
        seeds.iter().map(|by| ResponseCase { belt: belt.reseeded(*by), start }).collect();
    // The power of noise is that of its linear response; the stroke has no largest value.
    let observables = Observables { dither_cost: false };
    let found: Vec<Result<Compared, _>> = cases
        .par_chunks(ABREAST)
        .flat_map_iter(|cases| compare_many(cases, study.solver(), observables))
        .collect();
    let runs: Vec<Compared> = found.into_iter().collect::<Result<_, _>>().map_err(failed)?;
    let quiet = efficiencies(&runs).map(|each| {
        let inside: Vec<bool> = each.iter().map(|efficiency| *efficiency < QUIET).collect();
        Share::of(StartLayout::Sample { count, seed: 0 }, &inside)
    });
    Ok(NoiseResponse { seeds, runs, quiet, cost: cost(belt) })
}

/// E of every run.
fn efficiencies(runs: &[Compared]) -> Result<Vec<f64>, Undefined> {
    runs.iter().map(Compared::efficiency).collect()
}

/// Root mean squares under all tangential dithers, whose lines are independent.
fn cost(belt: &Belt) -> Result<NoiseCost, String> {
    let mut sum = NoiseCost { force: 0.0, displacement: 0.0, velocity: 0.0, power: 0.0 };
    let mut any = false;
    for dither in belt.dithers_along(Direction::Tangential) {
        if dither.waveform != Waveform::Sine && !dither.waveform.is_sum_of_sines() {
            let name = dither.waveform.name();
            return Err(format!("it is computed for sums of sines, and a dither is a \"{name}\""));
        }
        let own = noise_cost(dither, belt.damping_ratio()).map_err(|why| why.to_string())?;
        let add = |all: f64, own: f64| all.hypot(own);
        sum = NoiseCost {
            force: add(sum.force, own.force),
            displacement: add(sum.displacement, own.displacement),
            velocity: add(sum.velocity, own.velocity),
            power: sum.power + own.power,
        };
        any = true;
    }
    if any { Ok(sum) } else { Err("all dither is normal".to_owned()) }
}

/// Least, median and largest of some values.
fn spread(values: &[f64]) -> Option<[f64; 3]> {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
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
    /// E of every run, or why it is undefined.
    ///
    /// # Errors
    /// [`Undefined`].
    pub fn efficiencies(&self) -> Result<Vec<f64>, Undefined> {
        efficiencies(&self.runs)
    }

    /// Mean over the runs of a number of each.
    fn mean(&self, value: impl Fn(&Compared) -> f64) -> f64 {
        self.runs.iter().map(value).sum::<f64>() / self.runs.len() as f64
    }

    /// The share of quiet runs and the record.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let from = start_in_words(study);
        let count = self.runs.len();
        let runs = format!("{count} run{} with different seeds", plural(count));
        let result = match (&self.quiet, &self.efficiencies()) {
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
        let time = if study.scales().is_some() { "t" } else { "τ" };
        let settle = in_words(study, Quantity::Time, study.solver().settle);
        let length = in_words(study, Quantity::Time, Self::record_length(study));
        format!(
            "Started {from}, {result}. Each run is measured for {length} after {time} = {settle}."
        )
    }

    /// Length of a record: slow periods 2π.
    fn record_length(study: &BeltStudy) -> f64 {
        std::f64::consts::TAU * f64::from(study.solver().record_periods)
    }

    /// Warnings about the answer.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let mut warnings = range::averaged(study);
        let unsettled = self.runs.iter().filter(|run| !run.settled()).count();
        let near = self.efficiencies().map_or(0, |each| {
            each.iter()
                .filter(|efficiency| (0.5 * QUIET..2.0 * QUIET).contains(*efficiency))
                .count()
        });
        if near > 0 {
            warnings.push(format!(
                "the residual vibration of {near} of {} runs is within a factor of 2 of {QUIET}, below which a run counts as quiet \
                 (in {unsettled} the halves of the record differ, as random records do): raise solver.record_periods",
                self.runs.len()
            ));
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let mut fields = Fields::new(study.scales());
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        fields.plain("runs", self.runs.len()).number("quiet_below", Quantity::Ratio, QUIET);
        let share =
            |value: fn(&Share) -> f64| self.quiet.as_ref().map(value).map_err(ToString::to_string);
        match &self.quiet {
            Ok(share) => fields.plain("quiet_runs", share.starts),
            Err(why) => fields.unknown("quiet_runs", why.to_string()),
        };
        fields
            .known("quiet_fraction", Quantity::Ratio, share(|share| share.fraction))
            .known("quiet_fraction_low", Quantity::Ratio, share(|share| share.low))
            .known("quiet_fraction_high", Quantity::Ratio, share(|share| share.high))
            .plain("interval", "Wilson, 95 %")
            .plain("seeds", self.first_seeds(study));
        let each = self.efficiencies().map_err(|why| why.to_string());
        match &each {
            Ok(each) => fields.numbers("efficiency", Quantity::Ratio, each),
            Err(why) => fields.unknown("efficiency", why.as_str()),
        };
        let of = |place: usize| {
            let spread = each.as_ref().map_err(Clone::clone).map(|each| spread(each));
            spread.and_then(|found| found.map(|all| all[place]).ok_or_else(|| "no run".to_owned()))
        };
        fields
            .known("efficiency_least", Quantity::Ratio, of(0))
            .known("efficiency_median", Quantity::Ratio, of(1))
            .known("efficiency_largest", Quantity::Ratio, of(2))
            .numbers("amplitude", Quantity::Displacement, &self.amplitudes())
            .numbers("stick_fraction", Quantity::Ratio, &self.stick_fractions())
            .number(
                "undithered_amplitude",
                Quantity::Displacement,
                self.mean(|run| run.undithered.lines.whole),
            )
            .number("mean_friction", Quantity::Force, self.mean(|run| run.dithered.mean_friction))
            .number(
                "mean_friction_undithered",
                Quantity::Force,
                self.mean(|run| run.undithered.mean_friction),
            );
        self.put_cost(study, &mut fields);
        fields
            .number("settle", Quantity::Time, study.solver().settle)
            .number("record_length", Quantity::Time, Self::record_length(study))
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Root mean squares of the dither; its peaks have no value.
    fn put_cost(&self, study: &BeltStudy, fields: &mut Fields) {
        let of = |value: fn(&NoiseCost) -> f64| self.cost.as_ref().map(value).map_err(Clone::clone);
        let mut inner = Fields::new(study.scales());
        let peak = || Err("noise has no largest value; see the root mean square".to_owned());
        inner
            .known("force_rms", Quantity::Force, of(|cost| cost.force))
            .known("displacement_rms", Quantity::Displacement, of(|cost| cost.displacement))
            .known("velocity_rms", Quantity::Velocity, of(|cost| cost.velocity))
            .known("power", Quantity::Power, of(|cost| cost.power))
            .known("force_peak", Quantity::Force, peak())
            .known("stroke", Quantity::Displacement, peak());
        fields.nested("cost", inner);
    }

    /// The seed of the first noise in each run.
    fn first_seeds(&self, study: &BeltStudy) -> Vec<u64> {
        let of = |by: &u64| {
            let belt = study.belt().reseeded(*by);
            let first = belt.dithers().iter().find_map(|dither| dither.waveform.noise());
            first.map_or(*by, Noise::seed)
        };
        self.seeds.iter().map(of).collect()
    }

    fn amplitudes(&self) -> Vec<f64> {
        self.runs.iter().map(|run| run.dithered.lines.whole).collect()
    }

    fn stick_fractions(&self) -> Vec<f64> {
        self.runs.iter().map(|run| run.dithered.stick_fraction).collect()
    }

    /// The runs as a dataset.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let seeds = self.first_seeds(study).into_iter().map(|seed| seed as f64).collect();
        let efficiency = self.efficiencies().unwrap_or_else(|_| vec![f64::NAN; self.runs.len()]);
        Dataset::new(study, "response: seeds")
            .fact(format!("start: {}", start_in_words(study)))
            .with_axis(Array::new("seed", "1", seeds))
            .array("efficiency", Quantity::Ratio, efficiency)
            .array("amplitude", Quantity::Displacement, self.amplitudes())
            .array("stick_fraction", Quantity::Ratio, self.stick_fractions())
            .array(
                "mean_friction",
                Quantity::Force,
                self.runs.iter().map(|run| run.dithered.mean_friction).collect(),
            )
    }

    /// The numbers of the table: label and value in words.
    pub(crate) fn rows(&self) -> Vec<(String, String)> {
        let mut rows = Vec::new();
        let mut row = |label: &str, value: String| rows.push((label.to_owned(), value));
        match &self.quiet {
            Ok(share) => row("runs without stick–slip", share.percent()),
            Err(why) => row("runs without stick–slip", format!("unknown: {why}")),
        }
        if let Some([least, median, largest]) =
            self.efficiencies().ok().and_then(|each| spread(&each))
        {
            row("residual vibration E, median", digits(median));
            row("  least", digits(least));
            row("  largest", digits(largest));
        }
        row("counts as quiet below E", format!("{QUIET}"));
        row("band of E, up to", format!("{BAND_END} ω₀"));
        rows
    }
}
