//! Any law under one dither by samples: the period is summed piece by piece.
//!
//! Between two samples s = α(G₀ + gδ + ½g′δ²) is linear (samples that are held) or quadratic (joined by lines). Each piece is divided
//! where s turns and where s = v, both roots of the quadratic in closed form. On each part the law is smooth, and s changes by a small
//! part of its velocity scale, so that a Gauss rule of few points is exact to rounding:
//!
//! μ̄ = (1/2π) Σ ∫ μ(v − s) dδ,   μ̄′ = (1/2π) [Σ ∫ μ′(v − s) dδ + 2μ(0⁺) Σ 1/|ds/dδ| over s = v].
//!
//! Two rules of different order give the error. Where it exceeds 10⁻¹² of the law, as for a law with an unbounded slope at rest, or
//! where the velocity scale of the law is tiny against a piece, the adaptive quadrature of `periodic` takes over. Cost: 14
//! evaluations of the law per sample.

use core::f64::consts::TAU;
use std::sync::LazyLock;

use quell_model::waveform::Piece;
use quell_model::{Friction, Waveform};
use quell_numerics::gauss_legendre::GaussLegendre;

use super::effective::{Effective, SlopeSide};

/// Change of s over the velocity scale of the law below which the short rules are exact.
const SHORT: f64 = 0.05;

/// The same for the long rules.
const LONG: f64 = 0.5;

/// Most parts of one piece.
const MOST_PARTS: f64 = 64.0;

/// Accuracy, in units of the law.
const CLOSENESS: f64 = 1e-12;

/// Two rules on [0, 1], as nodes with weights: the better one first.
type Rules = [Vec<[f64; 2]>; 2];

fn rule(points: usize) -> Vec<[f64; 2]> {
    fn pairs<const N: usize>() -> Vec<[f64; 2]> {
        let [nodes, weights] = GaussLegendre::new(N).on_unit_interval::<N>();
        nodes.into_iter().zip(weights).map(|(node, weight)| [node, weight]).collect()
    }
    match points {
        3 => pairs::<3>(),
        4 => pairs::<4>(),
        5 => pairs::<5>(),
        _ => pairs::<7>(),
    }
}

static SHORT_RULES: LazyLock<Rules> = LazyLock::new(|| [rule(4), rule(3)]);
static LONG_RULES: LazyLock<Rules> = LazyLock::new(|| [rule(7), rule(5)]);

/// The sums over the pieces: value and slope, each by both rules, and the densities at s = v.
#[derive(Default)]
struct PieceSums {
    value: [f64; 2],
    slope: [f64; 2],
    density: f64,
}

/// s over one piece: c₀ + c₁δ + c₂δ².
#[derive(Clone, Copy)]
struct PieceOfSlip([f64; 3]);

impl PieceOfSlip {
    fn at(self, delta: f64) -> f64 {
        let [constant, linear, square] = self.0;
        square.mul_add(delta, linear).mul_add(delta, constant)
    }

    fn rate(self, delta: f64) -> f64 {
        let [_, linear, square] = self.0;
        (2.0 * square).mul_add(delta, linear)
    }

    /// Where s = v between a and b, over which s is monotone and passes v.
    fn crossing(self, v: f64, (a, b): (f64, f64)) -> f64 {
        let [constant, linear, square] = self.0;
        let offset = constant - v;
        let root = (linear * linear - 4.0 * square * offset).max(0.0).sqrt();
        let larger = -0.5 * (linear + root.copysign(linear));
        let middle = 0.5 * (a + b);
        [larger / square, offset / larger]
            .into_iter()
            .filter(|found| found.is_finite())
            .min_by(|x, y| (x - middle).abs().total_cmp(&(y - middle).abs()))
            .unwrap_or(middle)
            .clamp(a, b)
    }
}

/// Effective friction under s = α·G of samples at slip velocity `v`; `None` where the rules do not settle.
pub(super) fn effective(
    law: &Friction,
    waveform: &Waveform,
    alpha: f64,
    v: f64,
) -> Option<Effective> {
    let (breaks, pieces) = (waveform.breaks(), waveform.pieces());
    let (least, largest) = waveform.integral_range();
    let (low, high) = (alpha * least, alpha * largest);
    let rounding = 8.0 * f64::EPSILON * (low.abs() + high.abs());
    let at_corner = (v - high).abs() <= rounding || (v - low).abs() <= rounding;
    let mut sums = PieceSums::default();
    // G at the end of a piece is that at the start of the next one, so that every crossing is counted once.
    let starts: Vec<f64> = breaks.iter().map(|at| alpha * waveform.integral(*at)).collect();
    for (place, piece) in pieces.iter().enumerate() {
        let Piece::Affine { value, slope } = *piece else { return None };
        let start = breaks[place];
        let length = breaks.get(place + 1).copied().unwrap_or_else(|| waveform.period()) - start;
        let slip = PieceOfSlip([starts[place], alpha * value, 0.5 * alpha * slope]);
        let end = starts[(place + 1) % starts.len()];
        let turn = -value / slope;
        if turn > 0.0 && turn < length {
            let turned = slip.at(turn);
            sums.monotone(law, v, slip, ([0.0, turn], [starts[place], turned]), at_corner)?;
            sums.monotone(law, v, slip, ([turn, length], [turned, end]), at_corner)?;
        } else {
            sums.monotone(law, v, slip, ([0.0, length], [starts[place], end]), at_corner)?;
        }
    }
    let at_rest = law.coefficient(0.0);
    let fastest = (v - low).abs().max((v - high).abs());
    let scale = at_rest.abs() + law.coefficient(fastest).abs();
    let slope_scale =
        law.slope(0.0).abs() + law.slope(fastest).abs() + at_rest / law.velocity_scale();
    let value_error = (sums.value[0] - sums.value[1]).abs() / TAU;
    let slope_error = (sums.slope[0] - sums.slope[1]).abs() / TAU;
    let settled = value_error <= CLOSENESS * scale && slope_error <= CLOSENESS * slope_scale;
    if !settled || !sums.density.is_finite() {
        return None;
    }
    let side = if at_corner { SlopeSide::Outer } else { SlopeSide::Both };
    let jump = 2.0 * at_rest * sums.density / TAU;
    let mut effective = Effective::closed(
        [sums.value[0] / TAU, 0.0],
        [jump, sums.slope[0] / TAU],
        slope_scale,
        side,
    );
    effective.coefficient_error += value_error + 1e-14 * scale;
    effective.slope_error += slope_error;
    Some(effective)
}

impl PieceSums {
    /// Adds an interval over which s is monotone, given with the values of s at its ends.
    fn monotone(
        &mut self,
        law: &Friction,
        v: f64,
        slip: PieceOfSlip,
        ([from, to], [first, last]): ([f64; 2], [f64; 2]),
        at_corner: bool,
    ) -> Option<()> {
        // At the corner of the whole wave the contact is tangential, and no crossing.
        if (first < v) == (last < v) || at_corner {
            return self.part(law, v, slip, [from, to]);
        }
        let crossing = slip.crossing(v, (from, to));
        self.density += slip.rate(crossing).abs().recip();
        self.part(law, v, slip, [from, crossing])?;
        self.part(law, v, slip, [crossing, to])
    }

    /// Adds an interval in which the slip velocity v − s keeps its sign.
    fn part(
        &mut self,
        law: &Friction,
        v: f64,
        slip: PieceOfSlip,
        [from, to]: [f64; 2],
    ) -> Option<()> {
        let length = to - from;
        if length <= 0.0 {
            return Some(());
        }
        let sign = (v - slip.at(0.5 * (from + to))).signum();
        let change = (slip.at(to) - slip.at(from)).abs() / law.velocity_scale();
        let (rules, parts) = if change <= SHORT {
            (&*SHORT_RULES, 1.0)
        } else {
            (&*LONG_RULES, (change / LONG).ceil())
        };
        if parts.is_nan() || parts > MOST_PARTS {
            return None;
        }
        let step = length / parts;
        let mut part = 0.0;
        while part < parts {
            let start = part.mul_add(step, from);
            for (which, rule) in rules.iter().enumerate() {
                for [node, weight] in rule {
                    let speed = (sign * (v - slip.at(step.mul_add(*node, start)))).max(0.0);
                    self.value[which] += weight * step * sign * law.coefficient(speed);
                    self.slope[which] += weight * step * law.slope(speed);
                }
            }
            part += 1.0;
        }
        Some(())
    }
}
