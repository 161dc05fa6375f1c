//! The dither amplitude at which the residual vibration E falls below a level, at one frequency ratio.
//!
//! A row of amplitudes is measured side by side; the last interval of the row in which E falls through the level is
//! subdivided by the next row. E is measured: a crossing is found only to the accuracy with
//! which records of the given solver define it.

use std::ops::RangeInclusive;

use quell_model::Belt;

use super::measure::{ResponseCase, compare_many};
use super::solver::Solver;
use crate::simulation::Start;

/// Amplitudes of a row: the number of the widest lanes.
const ROW: u32 = 16;

/// Largest amplitude D in `amplitudes` of the first dither at which E falls through `level` with
/// growing D, to `closeness` relative to D; `None` if it does not fall through there, or where E
/// is undefined or a run stops.
pub fn amplitude_at_residual_vibration(
    belt: &Belt,
    start: Start,
    solver: &Solver,
    level: f64,
    amplitudes: RangeInclusive<f64>,
    closeness: f64,
) -> Option<f64> {
    let (mut from, mut to) = amplitudes.into_inner();
    while to - from > closeness * to {
        let row: Vec<f64> =
            (0..ROW).map(|k| from + (to - from) * f64::from(k) / f64::from(ROW - 1)).collect();
        let cases: Option<Vec<ResponseCase>> = row
            .iter()
            .map(|&amplitude| {
                let belt = belt.with_amplitude(0, amplitude).ok()?;
                Some(ResponseCase { belt, start })
            })
            .collect();
        let residual_vibrations: Option<Vec<f64>> = compare_many(&cases?, solver)
            .into_iter()
            .map(|compared| compared.ok()?.residual_vibration().ok())
            .collect();
        let residual_vibrations = residual_vibrations?;
        let last =
            residual_vibrations.windows(2).rposition(|pair| pair[0] > level && pair[1] <= level)?;
        (from, to) = (row[last], row[last + 1]);
        if residual_vibrations[last] == residual_vibrations[last + 1] {
            break;
        }
    }
    Some(0.5 * (from + to))
}
