//! The boundaries at which the dither of a map begins to quench, or to destabilise, according to averaging.
//!
//! For a map with an axis `dither.amplitude`: the critical amplitudes of averaging at each value of the other
//! axis. They are exact, not traced on the grid: D = αR with α from [`critical_amplitudes`].

use quell_linear::averaging::{
    AveragingOptions, Becomes, CriticalAmplitude, FastResponse, critical_amplitudes,
};

use crate::study::BeltStudy;
use crate::sweep::Grid;

/// The axis along which averaging gives an amplitude.
const AMPLITUDE: &str = "dither.amplitude";

/// One boundary of averaging in the plane of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary {
    /// Model of the fast motion: αG, or the oscillator's own response ("sharper").
    pub response: FastResponse,
    /// The stability of sliding above this amplitude.
    pub becomes: Becomes,
    /// (value of the other axis, amplitude), in the order of that axis.
    pub points: Vec<(f64, f64)>,
}

/// The boundaries of averaging in a plane of two axes, one of which is the amplitude of the first dither;
/// empty for other planes. For each averaging method, the smallest positive amplitude that quenches and
/// the smallest that destabilises. Points without a result are left out.
pub fn boundaries(grid: &Grid) -> Vec<Boundary> {
    let [first, second] = grid.axes() else {
        return Vec::new();
    };
    let Ok(study) = grid.study().belt() else { return Vec::new() };
    let across = match (first.path == AMPLITUDE, second.path == AMPLITUDE) {
        (true, false) => second,
        (false, true) => first,
        _ => return Vec::new(),
    };
    let at: Vec<(f64, BeltStudy)> = across
        .values
        .iter()
        .filter_map(|&value| Some((value, study.with(&across.path, value).ok()?)))
        .collect();
    let mut boundaries = Vec::new();
    for response in [FastResponse::Limit, FastResponse::Oscillator] {
        let options = AveragingOptions { response, ..AveragingOptions::default() };
        let critical: Vec<(f64, f64, Vec<CriticalAmplitude>)> = at
            .iter()
            .filter_map(|(value, study)| {
                let ratio = study.belt().dithers().first()?.frequency_ratio;
                Some((*value, ratio, critical_amplitudes(study.belt(), options).ok()?))
            })
            .collect();
        for becomes in [Becomes::Stable, Becomes::Unstable] {
            let points: Vec<(f64, f64)> = critical
                .iter()
                .filter_map(|(value, ratio, critical)| {
                    let alpha = critical
                        .iter()
                        .map(|critical| (critical.amplitude_ratio, critical.becomes))
                        .find(|(alpha, change)| *alpha > 0.0 && *change == becomes)?
                        .0;
                    Some((*value, alpha * ratio))
                })
                .collect();
            if !points.is_empty() {
                boundaries.push(Boundary { response, becomes, points });
            }
        }
    }
    boundaries
}
