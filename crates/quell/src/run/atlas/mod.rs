//! `atlas`: the thresholds of a belt from the tables of `quell_design::atlas`, and the tables themselves.
//!
//! The tables are dimensionless; a study is placed in them by its groups, and their answer is scaled back to its units by v_m. With
//! `exact` the continuation of the quench amplitude runs too, and the answer reports the difference.

mod answer;
mod round_numbers;

use quell_design::atlas::{
    Atlas, AtlasAnswer, AtlasErrors, AtlasPoint, AtlasTable, ERROR_BANDS, OutsideAtlas,
};
use quell_design::quench::quench;
use quell_dynamics::simulation::within;
use quell_model::units::Quantity;
use serde_json::Value as Json;
use std::sync::atomic::Ordering;

pub(crate) use round_numbers::{
    DAMPINGS_PER_CYCLE, FREQUENCY_RATIOS, RELATIVE_DAMPINGS, VELOCITY_SHARES, round_numbers,
};

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::effort::STEPS_OF_A_SEARCH;
use crate::parallel::Parallel;
use crate::run::varied::key_of;
use crate::study::BeltStudy;
use crate::sweep::Running;
use crate::words::in_words;

/// Share of the grazing amplitude below which a continuation that ends has missed changes.
const LOST_BEFORE: f64 = 1.0 - 1e-3;

/// A change of the verdict that the continuation found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactChange {
    /// The amplitude D.
    pub amplitude: f64,
    /// Whether slightly larger amplitudes are quiet.
    pub becomes_quiet: bool,
}

/// The thresholds of a study by the atlas.
#[derive(Clone, Debug, PartialEq)]
pub struct AtlasFound {
    /// The answer in dimensionless groups.
    pub answer: AtlasAnswer,
    /// v_m in the numbers of the equations: the scale of amplitudes.
    pub reference_velocity: f64,
    /// The amplitude of the study.
    pub own_amplitude: f64,
    /// The changes by continuation, in ascending order, or why they are unknown; `None` if not requested.
    pub exact: Option<Result<Vec<ExactChange>, String>>,
}

/// The thresholds of a study by the atlas, and with `exact` also by continuation.
///
/// # Errors
/// A complaint about every key that places the study outside the atlas.
pub fn run(study: &BeltStudy, exact: bool) -> Result<AtlasFound, Failure> {
    let belt = study.belt();
    let point = AtlasPoint::of_belt(belt).map_err(|outside| {
        let complaints: Vec<Complaint> =
            outside.iter().map(|outside| complaint(study, outside)).collect();
        Failure::from(complaints)
    })?;
    let answer = Atlas::shipped().answer(&point).ok_or_else(|| Failure::Failed {
        key: "atlas".to_owned(),
        why: "the atlas lacks the tables of this law and waveform".to_owned(),
    })?;
    let exact = exact.then(|| {
        let found = within(STEPS_OF_A_SEARCH, || quench(&belt.system(), 0));
        let found = found.map_err(|why| format!("the base response was not followed: {why:?}"))?;
        let grazing = answer.grazing.0 * belt.friction().velocity_scale();
        if let Some(end) = found.branch.end.filter(|end| *end < LOST_BEFORE * grazing) {
            let end = in_words(study, Quantity::Force, end);
            return Err(format!("the continuation lost the base response at {end}"));
        }
        let changes = found.branch.changes.iter().map(|change| ExactChange {
            amplitude: change.amplitude,
            becomes_quiet: change.becomes_quiet,
        });
        Ok(changes.collect())
    });
    Ok(AtlasFound {
        answer,
        reference_velocity: belt.friction().velocity_scale(),
        own_amplitude: belt.dithers().first().map_or(0.0, |dither| dither.amplitude),
        exact,
    })
}

/// The complaint about a key that places a study outside, in the units of the study.
fn complaint(study: &BeltStudy, outside: &OutsideAtlas) -> Complaint {
    let OutsideAtlas { key, value, word, range, allowed } = outside;
    let address = study.address(key).ok();
    let quantity = address.and_then(|address| address.quantity).unwrap_or(Quantity::Ratio);
    let scale = study.scales().and_then(|scales| scales.one(quantity)).map_or(1.0, |(one, _)| one);
    let words = |value: f64| in_words(study, quantity, value);
    let allowed = match range {
        None => allowed.clone(),
        Some((0.0, most)) => format!("at most {}: {allowed}", words(*most)),
        Some((least, most)) => {
            format!("from {} to {}: {allowed}", words(*least), words(*most))
        }
    };
    let is_given = value.is_some() || word.is_some();
    let fault = match () {
        () if allowed.starts_with("left out") => Fault::Conflict,
        () if is_given => Fault::Value,
        () => Fault::Missing,
    };
    let number = value.map(|value| Json::from(scale * value));
    let value = number.or(word.map(Json::from)).unwrap_or(Json::Null);
    let key = key_of(&study.into(), key);
    Complaint::new(fault, key, Origin::Whole, value, allowed)
}

/// How a recomputed table differs from the shipped one.
#[derive(Clone, Debug, PartialEq)]
pub struct TableDifference {
    /// The largest difference of a value.
    pub largest: f64,
    /// The axes of its node.
    pub node: Vec<f64>,
    /// Nodes that have no exact value.
    pub missing: usize,
}

/// The tables of the atlas.
#[derive(Clone, Debug)]
pub struct AtlasTables {
    /// The tables and their errors, recomputed if requested.
    pub atlas: Atlas,
    /// How each recomputed table differs from the shipped one; `None` if they were not recomputed.
    pub differences: Option<Vec<TableDifference>>,
}

/// The tables as shipped.
pub fn tables() -> AtlasTables {
    AtlasTables { atlas: Atlas::shipped().clone(), differences: None }
}

/// Number of random points per table and band at which the errors are measured.
const ERROR_POINTS: usize = 200;

/// Seed of these points.
const ERROR_SEED: u64 = 2005;

/// The tables and their errors, computed again; minutes on two cores.
///
/// # Errors
/// [`Failure::Failed`] after a stop, or if no threads can be started.
pub fn recomputed(running: Running<'_>) -> Result<AtlasTables, Failure> {
    let shipped = Atlas::shipped();
    let stopped = || running.stop.load(Ordering::Relaxed);
    let pool = running.pool()?;
    let total = shipped.tables.iter().map(|table| table.values.len()).sum::<usize>();
    let sampled = shipped.tables.len() * ERROR_BANDS.len() * ERROR_POINTS;
    running.progress.begin(total + sampled, 0);
    let exact = |table: &AtlasTable, places: &[Vec<f64>]| -> Vec<Option<f64>> {
        let value = |place: &Vec<f64>| {
            if stopped() {
                return None;
            }
            let found = AtlasTable::compute(table.law, &table.waveform, table.surface, place).ok();
            running.progress.advance(1);
            found
        };
        pool.install(|| places.in_parallel(value).collect())
    };
    let mut atlas = Atlas::default();
    let mut differences = Vec::new();
    for table in &shipped.tables {
        let nodes = AtlasTable::nodes(table.law, table.surface);
        let values = exact(table, &nodes);
        differences.push(TableDifference::of(table, &nodes, &values));
        // A node without an exact value keeps that of the shipped table.
        let kept = values.iter().zip(&table.values).map(|(new, old)| new.unwrap_or(*old));
        atlas.tables.push(AtlasTable { values: kept.collect(), ..table.clone() });
    }
    for table in &shipped.tables {
        for band in ERROR_BANDS {
            let of = (table.law, &table.waveform, table.surface);
            let points = (ERROR_POINTS, ERROR_SEED);
            let exact = |places: &[Vec<f64>]| exact(table, places);
            atlas.errors.extend(AtlasErrors::measured(&atlas, of, band, points, exact));
        }
    }
    running.progress.end();
    if stopped() {
        return Err(super::stopped("atlas"));
    }
    Ok(AtlasTables { atlas, differences: Some(differences) })
}

impl TableDifference {
    fn of(table: &AtlasTable, nodes: &[Vec<f64>], exact: &[Option<f64>]) -> Self {
        let known = table.values.iter().zip(exact).zip(nodes);
        let known =
            known.filter_map(|((old, new), node)| Some(((new.as_ref()? - old).abs(), node)));
        let largest = known.max_by(|a, b| a.0.total_cmp(&b.0));
        Self {
            largest: largest.map_or(0.0, |(difference, _)| difference),
            node: largest.map_or_else(Vec::new, |(_, node)| node.clone()),
            missing: exact.iter().filter(|value| value.is_none()).count(),
        }
    }
}
