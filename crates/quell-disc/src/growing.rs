//! The speeds at which a motion of a disc grows, by all exponents along the line of speeds, with or without dither.
//!
//! First-order theory (`resonance`) knows pairs of waves. Strong friction makes three waves and more grow together, at speeds at which
//! no pair does: under the dither of figure 5.9 at the fourth speed of table 5.2. Here every marginal speed is a root of an exponent
//! (`marginal`), and between two of them the number of growing motions does not change, so that one point of each part decides.
//!
//! Limitation: that of `marginal`, an interval within a step of the grid without any sign of it at three points of the step. The grid
//! has points in and next to every predicted tongue.

use core::ops::RangeInclusive;

use quell_linear::floquet::NotFollowerDither;
use quell_model::Disc;
use quell_numerics::eigen::EigenError;
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending;
use quell_numerics::roots::{Closeness, minimise};

use crate::marginal::{DiscExponent, exponents, marginal_values, tongue_grid};

/// Relative accuracy of the speed of the largest growth.
const CLOSENESS: Closeness = Closeness { absolute: 0.0, relative: 1e-7 };

/// Points of an interval without a point of the grid, from which its largest growth is refined.
const INSIDE: u32 = 8;

/// An interval of speeds in which a motion grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowingSpeeds {
    /// Its lower end: an exact marginal speed, or the end of the range.
    pub from: f64,
    /// Its upper end.
    pub to: f64,
    /// The speed of the largest growth.
    pub peak_speed: f64,
    /// The largest growth rate.
    pub peak_growth: f64,
}

/// Every interval of a range of speeds in which a motion grows, in ascending order; `steps` is the number of equal steps of the range
/// that are searched in addition to the predicted tongues.
///
/// # Errors
/// [`NotFollowerDither`] where the exponents do not describe this disc or cannot be computed.
pub fn growing_speeds(
    disc: &Disc,
    speeds: &RangeInclusive<f64>,
    steps: u32,
) -> Result<Vec<GrowingSpeeds>, NotFollowerDither> {
    let (first, last) = (*speeds.start(), *speeds.end());
    let line = |speed: f64| -> Result<Vec<DiscExponent>, NotFollowerDither> {
        let there = disc
            .at_speed(speed)
            .map_err(|_| NotFollowerDither::Eigenvalues(EigenError::NotFinite))?;
        exponents(&there)
    };
    let grid = tongue_grid(disc, speeds, steps);
    let values = marginal_values(&line, &grid)?;
    let mut ends: Vec<f64> = core::iter::once(first)
        .chain(values.iter().map(|marginal| marginal.value))
        .chain([last])
        .collect();
    ends.dedup();
    if ends.len() == 1 {
        ends.push(last);
    }
    let mut parts: Vec<RealInterval> = Vec::new();
    for pair in ends.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        if !grows(&line(f64::midpoint(from, to))?) {
            continue;
        }
        match parts.last_mut() {
            Some(RealInterval { upper: end, .. }) if *end == from => *end = to,
            _ => parts.push(RealInterval::new(from, to)),
        }
    }
    parts.into_iter().map(|part| peak(&line, part, &grid)).collect()
}

/// Whether a motion grows by more than the error of its rate.
fn grows(exponents: &[DiscExponent]) -> bool {
    exponents.iter().any(|exponent| exponent.rate > exponent.error)
}

/// An interval with its largest growth.
fn peak(
    line: &dyn Fn(f64) -> Result<Vec<DiscExponent>, NotFollowerDither>,
    RealInterval { lower: from, upper: to }: RealInterval,
    grid: &[f64],
) -> Result<GrowingSpeeds, NotFollowerDither> {
    let rate = |speed: f64| -> Result<f64, NotFollowerDither> {
        Ok(line(speed)?.iter().map(|exponent| exponent.rate).fold(f64::NEG_INFINITY, f64::max))
    };
    let equal = |k: u32| (to - from).mul_add(f64::from(k) / f64::from(INSIDE), from);
    let mut inside: Vec<f64> = (0..=INSIDE).map(equal).collect();
    inside.extend(grid.iter().copied().filter(|speed| *speed > from && *speed < to));
    ascending(&mut inside);
    inside.dedup();
    let rates = inside.iter().map(|speed| rate(*speed)).collect::<Result<Vec<f64>, _>>()?;
    let best = (0..rates.len()).max_by(|a, b| rates[*a].total_cmp(&rates[*b])).unwrap_or(0);
    let (low, high) = (inside[best.saturating_sub(1)], inside[(best + 1).min(inside.len() - 1)]);
    let (mut peak_speed, mut peak_growth) = (inside[best], rates[best]);
    let loss = |speed: f64| rate(speed).map_or(f64::INFINITY, |rate| -rate);
    if let Ok(found) = minimise(loss, low, high, CLOSENESS)
        && -found.value > peak_growth
    {
        (peak_speed, peak_growth) = (found.location, -found.value);
    }
    Ok(GrowingSpeeds { from, to, peak_speed, peak_growth })
}
