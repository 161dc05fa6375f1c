//! Any law under a periodic sum of dithers: quadrature over one period.
//!
//! μ̄(v) = (1/2π) ∫₀^{2π} μ(v − s)(1 + ν) dθ, split where the formula of a term changes, at the extrema of s, and where
//! s = v; μ̄′ = (1/2π) ∫ μ′(v − s)(1 + ν) dθ + 2μ(0⁺) Σ (1 + ν)/(2π|s′|) over the crossings s = v.
//!
//! Between two extrema s is monotone, so no crossing is lost. Extrema are found from the sign of ds/dθ at
//! [`SAMPLES`] points between breaks. A pair of extrema closer than that is missed; it leaves a kink
//! to the adaptive quadrature and costs accuracy only while v is between their two values.
//!
//! A single wave by samples, and a single response of a structure, are summed piece by piece (`pieces`).
//!
//! Accuracy: 10⁻¹², absolute, in units of μ_s (and of μ_s/v_m for the slope, away from extrema). There is no relative accuracy
//! for μ̄ → 0, because a sum need not have a symmetry.

use core::f64::consts::TAU;
use quell_model::Friction;
use quell_numerics::order::ascending;
use quell_numerics::quadrature::{QuadratureOptions, integrate};
use quell_numerics::roots::{Closeness, find_root};

use super::effective::{Effective, SlopeSide};
use super::error::{AveragingError, settled};
use super::periodic_motion::PeriodicMotion;
use super::pieces;

/// Points per smooth interval at which the sign of ds/dθ is evaluated.
const SAMPLES: usize = 8;

/// Slip velocity of a group, with its monotone intervals.
#[derive(Debug)]
pub(super) struct Signal<'a> {
    group: &'a PeriodicMotion,
    mean_square: f64,
    correlated: bool,
    /// Ends of the intervals in [0, 2π] with the value of s there, ascending in θ.
    ends: Vec<(f64, f64)>,
}

impl<'a> Signal<'a> {
    pub(super) fn new(group: &'a PeriodicMotion) -> Result<Self, AveragingError> {
        let mean_square = if group.distortion == 0.0 { 0.0 } else { group.normal_mean_square()? };
        let correlated = group.has_correlated_load();
        let mut signal = Self { group, mean_square, correlated, ends: Vec::new() };
        let mut edges = group.breaks();
        edges.insert(0, 0.0);
        edges.push(TAU);
        for pair in edges.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            if to - from <= 0.0 {
                continue;
            }
            signal.push_end(from);
            let at = |i: usize| from + (to - from) * (i as f64 + 0.5) / SAMPLES as f64;
            for i in 0..SAMPLES - 1 {
                let slope = |x: f64| signal.value_and_slope(x).1;
                if let Ok(root) = find_root(slope, at(i), at(i + 1), Closeness::default()) {
                    signal.push_end(root.location);
                }
            }
        }
        signal.push_end(TAU);
        Ok(signal)
    }

    fn push_end(&mut self, theta: f64) {
        let value = self.value_and_slope(theta).0;
        self.ends.push((theta, value));
    }

    /// s and ds/dθ.
    pub(super) fn value_and_slope(&self, theta: f64) -> (f64, f64) {
        let (tangential, tangential_slope) = PeriodicMotion::sum(&self.group.tangential, theta);
        let (normal, normal_slope) = PeriodicMotion::sum(&self.group.normal, theta);
        let d = self.group.distortion;
        (
            tangential + normal + d * (normal * normal - self.mean_square),
            tangential_slope + normal_slope * (1.0 + 2.0 * d * normal),
        )
    }

    /// ν(θ), or 0 where it cannot correlate with s.
    pub(super) fn load(&self, theta: f64) -> f64 {
        if self.correlated { self.group.load_at(theta) } else { 0.0 }
    }

    /// Ends of the intervals in which s is monotone.
    pub(super) fn edges(&self) -> impl Iterator<Item = f64> + '_ {
        self.ends.iter().map(|end| end.0)
    }

    /// Values of s at its extrema, which are the corners of the effective friction of this group.
    pub(super) fn extrema(&self) -> Vec<f64> {
        let mut values: Vec<f64> = self.ends.iter().map(|end| end.1).collect();
        ascending(&mut values);
        values.dedup_by(|a, b| (*a - *b).abs() <= 1e-14 * (a.abs() + b.abs()));
        values
    }

    /// Values of s at which a verdict may jump: the extrema; of a wave of very many pieces those at which s turns, because the
    /// corners between them are tiny, and a search over the amplitude finds a change at one of them without knowing it.
    pub(super) fn turning_values(&self) -> Vec<f64> {
        const MANY: usize = 64;
        if self.ends.len() <= MANY {
            return self.extrema();
        }
        let last = self.ends.len() - 1;
        let values = |k: usize| self.ends[k % last].1;
        let turns = |k: &usize| {
            let (before, here, after) = (values(k + last - 1), values(*k), values(k + 1));
            (here - before) * (after - here) <= 0.0
        };
        let mut found: Vec<f64> = (0..last).filter(turns).map(values).collect();
        ascending(&mut found);
        found.dedup_by(|a, b| (*a - *b).abs() <= 1e-14 * (a.abs() + b.abs()));
        found
    }

    /// Smallest and largest value of s.
    pub(super) fn range(&self) -> [f64; 2] {
        self.ends.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], end| {
            [low.min(end.1), high.max(end.1)]
        })
    }

    /// Phases where s = value.
    pub(super) fn crossings(&self, value: f64) -> Vec<f64> {
        let mut locations = Vec::new();
        for pair in self.ends.windows(2) {
            let ((from, a), (to, b)) = (pair[0], pair[1]);
            if (a < value) != (b < value) {
                let excess = |x: f64| self.value_and_slope(x).0 - value;
                if let Ok(root) = find_root(excess, from, to, Closeness::default()) {
                    locations.push(root.location);
                }
            }
        }
        locations
    }
}

/// Effective friction at slow slip velocity `v` under one periodic group.
pub(super) fn effective(
    law: &Friction,
    group: &PeriodicMotion,
    v: f64,
) -> Result<Effective, AveragingError> {
    if let Some((wave, amplitude)) = group.single_polynomial()
        && let Some(found) = pieces::effective(law, wave, amplitude, v)
    {
        return Ok(found);
    }
    let signal = Signal::new(group)?;
    mean(law, &signal, 1.0, v)
}

/// ⟨μ(v − s)(base + ν)⟩ and its frozen slope.
pub(super) fn mean(
    law: &Friction,
    signal: &Signal<'_>,
    base: f64,
    v: f64,
) -> Result<Effective, AveragingError> {
    let start = law.coefficient(0.0);
    let [low, high] = signal.range();
    let rounding = 8.0 * f64::EPSILON * (low.abs() + high.abs());
    let at_corner = (v - high).abs() <= rounding || (v - low).abs() <= rounding;
    // The outer slope at the corner: a tangential contact is not a crossing.
    let crossings = if at_corner { Vec::new() } else { signal.crossings(v) };
    let jump: f64 = crossings
        .iter()
        .map(|&x| (base + signal.load(x)) / (TAU * signal.value_and_slope(x).1.abs()))
        .sum::<f64>()
        * 2.0
        * start;
    let mut cuts: Vec<f64> = signal.edges().chain(crossings.iter().copied()).collect();
    // Laws that decrease over a small fraction of the fast velocity: split around the crossings.
    for offset in [-6.0, 6.0] {
        cuts.extend(signal.crossings(v + offset * law.velocity_scale()));
    }
    let value = |x: f64| {
        let slip = v - signal.value_and_slope(x).0;
        law.coefficient(slip.abs()).copysign(slip) * (base + signal.load(x))
    };
    let slope =
        |x: f64| law.slope((v - signal.value_and_slope(x).0).abs()) * (base + signal.load(x));
    let fastest = (v - low).abs().max((v - high).abs());
    let scale = start.abs() + law.coefficient(fastest).abs();
    let slope_scale =
        law.slope(0.0).abs() + law.slope(fastest).abs() + start / law.velocity_scale();
    let options = |absolute: f64| QuadratureOptions {
        relative: 1e-13,
        absolute: 1e-13 * absolute,
        ..QuadratureOptions::default()
    };
    let value = settled(integrate(value, 0.0, TAU, &cuts, &options(scale)))?;
    let smooth = settled(integrate(slope, 0.0, TAU, &cuts, &options(slope_scale)))?;
    let side = if at_corner { SlopeSide::Outer } else { SlopeSide::Both };
    let mut effective =
        Effective::closed([value.value / TAU, 0.0], [jump, smooth.value / TAU], slope_scale, side);
    effective.coefficient_error += value.error / TAU + 1e-14 * scale;
    effective.slope_error += smooth.error / TAU;
    Ok(effective)
}
