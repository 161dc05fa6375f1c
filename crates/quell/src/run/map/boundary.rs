//! The boundaries at which the dither of a map begins to quench, or to destabilise, according to averaging.
//!
//! For a map with an axis `dither.amplitude`: the critical amplitudes of averaging at each value of the other
//! axis. They are exact, not traced on the grid: D = αR with α from [`critical_amplitudes`].

use quell_linear::averaging::{Averaging, Becomes, CriticalAmplitude, critical_amplitudes};

use quell_model::parameter::DITHER_AMPLITUDE;
use quell_model::units::Quantity;

use crate::run::varied::key_of;
use crate::study::BeltStudy;
use crate::sweep::{Grid, GridAxis};

/// One boundary of averaging in the plane of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// Model of the fast motion: αG, or the oscillator's own response (finite-R averaging).
    pub averaging: Averaging,
    /// The stability of sliding above this amplitude.
    pub becomes: Becomes,
    /// (value of the other axis, amplitude in the unit of its axis), in the order of that axis.
    pub points: Vec<(f64, f64)>,
}

/// The boundaries of averaging in a plane of two axes, one of which is the amplitude of the first dither;
/// empty for other planes. For each averaging method, the smallest positive amplitude that quenches and
/// the smallest that destabilises. Points without a result are left out.
pub fn boundaries(grid: &Grid) -> Vec<Boundary> {
    amplitude_and_other(grid)
        .map_or_else(Vec::new, |(_, across)| boundaries_at(grid, &across.values))
}

/// The axis of the amplitude of the first dither, and the other one, in a plane of two axes.
pub fn amplitude_and_other(grid: &Grid) -> Option<(&GridAxis, &GridAxis)> {
    let [first, second] = grid.axes() else { return None };
    let amplitude = key_of(&grid.study().belt().ok()?, DITHER_AMPLITUDE.path);
    match (first.path == amplitude, second.path == amplitude) {
        (true, false) => Some((first, second)),
        (false, true) => Some((second, first)),
        _ => None,
    }
}

/// As [`boundaries`], at other values of the axis that is not the amplitude.
pub fn boundaries_at(grid: &Grid, values: &[f64]) -> Vec<Boundary> {
    let (Some((_, across)), Ok(study)) = (amplitude_and_other(grid), grid.study().belt()) else {
        return Vec::new();
    };
    let force =
        |study: &BeltStudy| study.scales().map_or(1.0, |scales| scales.per_unit(Quantity::Force));
    let at: Vec<(f64, BeltStudy)> = values
        .iter()
        .filter_map(|&value| Some((value, study.with(&across.path, value).ok()?)))
        .collect();
    let mut boundaries = Vec::new();
    for averaging in [Averaging::Limit, Averaging::FiniteR] {
        let critical: Vec<(f64, f64, Vec<CriticalAmplitude>)> = at
            .iter()
            .filter_map(|(value, study)| {
                let ratio = study.belt().dithers().first()?.frequency_ratio;
                let unit = ratio * force(study);
                Some((*value, unit, critical_amplitudes(study.belt(), averaging).ok()?))
            })
            .collect();
        for becomes in [Becomes::Stable, Becomes::Unstable] {
            let points: Vec<(f64, f64)> = critical
                .iter()
                .filter_map(|(value, unit, critical)| {
                    let alpha = critical
                        .iter()
                        .map(|critical| (critical.amplitude_ratio, critical.becomes))
                        .find(|(alpha, change)| *alpha > 0.0 && *change == becomes)?
                        .0;
                    Some((*value, alpha * unit))
                })
                .collect();
            if !points.is_empty() {
                boundaries.push(Boundary { averaging, becomes, points });
            }
        }
    }
    boundaries
}
