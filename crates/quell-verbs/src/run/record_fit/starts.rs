//! Where the search of `fit --record` begins.
//!
//! The residuals of a stick-slip record have many local minima, because its phase runs. Numbers of the study are therefore first tried on a
//! fixed quasi-random set about the study, and ranked by two features without a phase: the frequency of the largest line and the root mean
//! square. For the best of them the shift is tried over a period of the record.

use std::f64::consts::TAU;

use quell_design::decay::dominant_frequency;
use quell_input::record::TimeSeries;
use quell_numerics::damped_least_squares::FittedFunction;
use quell_numerics::order::ascending_by;
use quell_numerics::random::SplitMix;

use super::model::RecordModel;
use super::request::{FreeNumber, FreeStart};

/// Points of the set, and the factor by which a number is moved at most.
const TRIED: usize = 24;
const FACTOR: f64 = 1.6;

/// Points that go on, by their features.
const KEPT: usize = 5;

/// Shifts within a period of the record.
const SHIFTS: usize = 48;

/// Shifts that go on, for each point.
const KEPT_SHIFTS: usize = 2;

/// Samples per period of the features.
const PER_PERIOD: f64 = 40.0;

/// Periods over which the features are measured.
const PERIODS: f64 = 6.0;

/// A period of a study is as important as its size where it differs by this share of it: the phase runs away faster than the size.
const PERIOD_WEIGHT: f64 = 5.0;

/// The period of the largest line of a record, in its unit of time; `None` if it does not vibrate.
pub(super) fn period(record: &TimeSeries) -> Option<f64> {
    let times: Vec<f64> = record.times.iter().map(|time| time - record.times[0]).collect();
    dominant_frequency(&times, &record.values).ok().map(|omega| TAU / omega)
}

/// Starts of the search over the first samples of the model.
pub(super) fn starts(
    model: &mut RecordModel<'_>,
    free: &[FreeStart],
    period: Option<f64>,
    (mean, size): (f64, f64),
) -> Vec<Vec<f64>> {
    let base: Vec<f64> = free.iter().map(|one| one.start.unwrap_or(0.0)).collect();
    let mut points = vec![base.clone()];
    let moved = |one: &FreeStart| {
        matches!(one.number, FreeNumber::OfStudy(_)) && one.start.is_some_and(|value| value != 0.0)
    };
    if free.iter().any(moved) {
        let mut random = SplitMix::new(1);
        for _ in 0..TRIED {
            let values = base.iter().zip(free).map(|(value, one)| {
                let power = 2.0 * random.share() - 1.0;
                if moved(one) { value * libm::pow(FACTOR, power) } else { *value }
            });
            points.push(values.collect());
        }
    }
    // An unknown offset begins at the mean of the record.
    for point in &mut points {
        for (value, one) in point.iter_mut().zip(free) {
            if one.number == FreeNumber::Offset && one.start == Some(0.0) {
                *value = mean;
            }
        }
    }
    let mut ranked: Vec<(f64, Vec<f64>)> = points
        .into_iter()
        .enumerate()
        .filter_map(|(place, point)| {
            if model.is_stopped() {
                return None;
            }
            let distance = distance(model, &point, period, size);
            // The study itself is always tried.
            Some((if place == 0 { -1.0 } else { distance? }, point))
        })
        .collect();
    ascending_by(&mut ranked, |a| a.0);
    ranked.truncate(KEPT);
    let points = ranked.into_iter().map(|(_, point)| point);
    let shift = free.iter().position(|one| one.number == FreeNumber::Shift && one.start.is_none());
    match (shift, period) {
        (Some(place), Some(period)) => {
            points.flat_map(|point| shifted(model, &point, place, period)).collect()
        }
        _ => points.collect(),
    }
}

/// How far the features of a study are from those of the record; `None` if it has none.
fn distance(model: &RecordModel<'_>, at: &[f64], period: Option<f64>, size: f64) -> Option<f64> {
    let period = period?;
    let step = period / PER_PERIOD;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let count = (PERIODS * PER_PERIOD) as usize;
    let times: Vec<f64> = (0..count).map(|k| k as f64 * step).collect();
    let values = model.plain(at, &times).ok()?.values;
    let mean = values.iter().sum::<f64>() / count as f64;
    let own = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / count as f64).sqrt();
    let frequency = dominant_frequency(&times, &values).ok()?;
    let of_period = PERIOD_WEIGHT * libm::log(TAU / frequency / period);
    let has_gain = model.free.contains(&FreeNumber::Gain);
    let of_size = if has_gain || own <= 0.0 { 0.0 } else { libm::log(own / size) };
    Some(libm::hypot(of_period, of_size))
}

/// The point with the shifts that fit best over a period.
fn shifted(model: &mut RecordModel<'_>, point: &[f64], place: usize, period: f64) -> Vec<Vec<f64>> {
    let at = |shift: f64| {
        let mut values = point.to_vec();
        values[place] = shift;
        values
    };
    let data = &model.record.values[..model.count];
    let each: Vec<(f64, f64)> = (0..SHIFTS)
        .filter_map(|k| {
            let shift = period * k as f64 / SHIFTS as f64;
            let values = model.values(&at(shift))?;
            // Without the means: the offset may be free.
            let off: Vec<f64> = data.iter().zip(&values).map(|(y, f)| y - f).collect();
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            Some((off.iter().map(|r| (r - mean) * (r - mean)).sum(), shift))
        })
        .collect();
    let count = each.len();
    let mut least: Vec<(f64, f64)> = (0..count)
        .filter(|k| {
            let (before, after) = (each[(k + count - 1) % count].0, each[(k + 1) % count].0);
            each[*k].0 <= before && each[*k].0 <= after
        })
        .map(|k| each[k])
        .collect();
    ascending_by(&mut least, |a| a.0);
    least.truncate(KEPT_SHIFTS);
    least.into_iter().map(|(_, shift)| at(shift)).collect()
}
