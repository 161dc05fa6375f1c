//! The boundaries at which the dither of a map begins to quench, or to destabilise, according to averaging.
//!
//! For a map with an axis `dither.amplitude`: the critical amplitudes of averaging at each value of the other
//! axis. They are exact, not traced on the grid; in the limit of high frequency D = αR with α from [`critical_amplitudes`].

use quell_linear::averaging::{Averaging, Becomes, DitheredSystem, critical_amplitudes};
use quell_model::System;
use quell_model::parameter::DITHER_AMPLITUDE;

use crate::run::varied::key_of;
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
    let amplitude = key_of(grid.study(), DITHER_AMPLITUDE.path);
    match (first.path == amplitude, second.path == amplitude) {
        (true, false) => Some((first, second)),
        (false, true) => Some((second, first)),
        _ => None,
    }
}

/// As [`boundaries`], at other values of the axis that is not the amplitude.
pub fn boundaries_at(grid: &Grid, values: &[f64]) -> Vec<Boundary> {
    let Some((_, across)) = amplitude_and_other(grid) else { return Vec::new() };
    let model = grid.study().model();
    let Ok(parameter) = model.parameter(&across.path) else { return Vec::new() };
    let at: Vec<(f64, System)> = values
        .iter()
        .filter_map(|&value| Some((value, model.at(&[(parameter.clone(), value)]).ok()?)))
        .collect();
    let mut boundaries = Vec::new();
    for averaging in [Averaging::Limit, Averaging::FiniteR] {
        let critical: Vec<(f64, Vec<(f64, Becomes)>)> = at
            .iter()
            .filter_map(|(value, system)| Some((*value, critical(system, averaging)?)))
            .collect();
        for becomes in [Becomes::Stable, Becomes::Unstable] {
            let points: Vec<(f64, f64)> = critical
                .iter()
                .filter_map(|(value, critical)| {
                    let mut positive = critical.iter().filter(|(amplitude, _)| *amplitude > 0.0);
                    Some((*value, positive.find(|(_, change)| *change == becomes)?.0))
                })
                .collect();
            if !points.is_empty() {
                boundaries.push(Boundary { averaging, becomes, points });
            }
        }
    }
    boundaries
}

/// The critical amplitudes of the first dither; the limit of high frequency is that of one mass.
fn critical(system: &System, averaging: Averaging) -> Option<Vec<(f64, Becomes)>> {
    if averaging == Averaging::FiniteR {
        let found = DitheredSystem::new(system).ok()?.critical_amplitudes(0).ok()?;
        return Some(found.iter().map(|found| (found.amplitude, found.becomes)).collect());
    }
    let mass = system.one_averaged_mass()?;
    let unit = mass.amplitude(&system.inputs.first()?.target)
        * mass.belt().dithers().first()?.frequency_ratio;
    let found = critical_amplitudes(mass.belt(), averaging).ok()?;
    Some(found.iter().map(|found| (unit * found.amplitude_ratio, found.becomes)).collect())
}
