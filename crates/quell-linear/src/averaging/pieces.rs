//! Any law under one wave by polynomials: the period is summed piece by piece.
//!
//! The wave is the integral of samples, s = α(G₀ + gδ + ½g′δ²) between two of them, or the response of a structure
//! ([`crate::periodic_response`]). Each piece is divided where s turns and where s = v; both roots have a closed form under samples. On
//! each part the law is smooth, and s changes by a small part of its velocity scale, so that a Gauss rule of few points is exact to
//! rounding:
//!
//! μ̄ = (1/Θ) Σ ∫ μ(v − s) dδ,   μ̄′ = (1/Θ) [Σ ∫ μ′(v − s) dδ + 2μ(0⁺) Σ 1/|ds/dδ| over s = v],   Θ the period.
//!
//! Two rules of different order give the error. Where it exceeds 10⁻¹² of the law, as for a law with an unbounded slope at rest, or
//! where the velocity scale of the law is tiny against a piece, the adaptive quadrature of `periodic` takes over. Cost: 14
//! evaluations of the law per sample.

use std::sync::LazyLock;

use quell_model::Friction;
use quell_model::waveform::Piece;
use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::periodic_polynomial::{slope_of, value_of};
use quell_numerics::roots::{Closeness, find_root};

use super::effective::{Effective, SlopeSide};
use super::wave::FastWave;

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

/// s over an interval by its coefficients, and the part of the interval on which it is monotone.
struct PolynomialPart {
    coefficients: Vec<f64>,
    ends: [f64; 2],
    /// s at the ends. The end of a part has the value at the start of the next one, so that every crossing is counted once.
    values: [f64; 2],
}

impl PolynomialPart {
    fn at(&self, delta: f64) -> f64 {
        value_of(&self.coefficients, delta)
    }

    fn rate(&self, delta: f64) -> f64 {
        slope_of(&self.coefficients, delta)
    }

    /// Where the part passes s = v.
    fn crossing(&self, v: f64) -> f64 {
        let [a, b] = self.ends;
        let middle = 0.5 * (a + b);
        let &[constant, linear, square] = self.coefficients.as_slice() else {
            let excess = |delta: f64| self.at(delta) - v;
            let nearest = if self.at(a).abs() < self.at(b).abs() { a } else { b };
            return find_root(excess, a, b, Closeness::default())
                .map_or(nearest, |root| root.location);
        };
        let offset = constant - v;
        let root = (linear * linear - 4.0 * square * offset).max(0.0).sqrt();
        let larger = -0.5 * (linear + root.copysign(linear));
        [larger / square, offset / larger]
            .into_iter()
            .filter(|found| found.is_finite())
            .min_by(|x, y| (x - middle).abs().total_cmp(&(y - middle).abs()))
            .unwrap_or(middle)
            .clamp(a, b)
    }
}

/// s = αG of samples over one period, or a response times α; `None` for other waves.
fn parts(wave: &FastWave, alpha: f64) -> Option<Vec<PolynomialPart>> {
    let mut parts = Vec::new();
    let mut push = |coefficients: &[f64], ends: [f64; 2]| {
        let coefficients: Vec<f64> = coefficients.iter().map(|c| alpha * c).collect();
        let first = value_of(&coefficients, ends[0]);
        parts.push(PolynomialPart { coefficients, ends, values: [first, first] });
    };
    match wave {
        FastWave::Integral(waveform) => {
            let breaks = waveform.breaks();
            for (place, piece) in waveform.pieces().iter().enumerate() {
                let Piece::Affine { value, slope } = *piece else { return None };
                let start = breaks[place];
                let end = breaks.get(place + 1).copied().unwrap_or_else(|| waveform.period());
                let own = [waveform.integral(start), value, 0.5 * slope];
                let (turn, length) = (-value / slope, end - start);
                if turn > 0.0 && turn < length {
                    push(&own, [0.0, turn]);
                    push(&own, [turn, length]);
                } else {
                    push(&own, [0.0, length]);
                }
            }
        }
        FastWave::Response(response) => {
            response.monotone_parts().for_each(|part| push(part.coefficients, part.ends));
        }
        FastWave::Oscillator { .. } => return None,
    }
    for place in 0..parts.len() {
        parts[place].values[1] = parts[(place + 1) % parts.len()].values[0];
    }
    Some(parts)
}

/// Least and largest value, and the period.
fn extent(wave: &FastWave) -> ([f64; 2], f64) {
    match wave {
        FastWave::Response(response) => (response.range(), response.period()),
        FastWave::Integral(waveform) | FastWave::Oscillator { waveform, .. } => {
            let range = waveform.integral_range();
            ([range.lower, range.upper], waveform.period())
        }
    }
}

/// Effective friction under s = α·wave at slip velocity `v`; `None` where the rules do not settle.
pub(super) fn effective(law: &Friction, wave: &FastWave, alpha: f64, v: f64) -> Option<Effective> {
    let ([least, largest], period) = extent(wave);
    let (low, high) = (alpha * least, alpha * largest);
    let rounding = 8.0 * f64::EPSILON * (low.abs() + high.abs());
    // At the corner of the whole wave the contact is tangential, and no crossing.
    let at_corner = (v - high).abs() <= rounding || (v - low).abs() <= rounding;
    let mut sums = PieceSums::default();
    for part in parts(wave, alpha)? {
        sums.monotone(law, v, &part, at_corner)?;
    }
    let at_rest = law.coefficient(0.0);
    let fastest = (v - low).abs().max((v - high).abs());
    let scale = at_rest.abs() + law.coefficient(fastest).abs();
    let slope_scale =
        law.slope(0.0).abs() + law.slope(fastest).abs() + at_rest / law.velocity_scale();
    let value_error = (sums.value[0] - sums.value[1]).abs() / period;
    let slope_error = (sums.slope[0] - sums.slope[1]).abs() / period;
    let settled = value_error <= CLOSENESS * scale && slope_error <= CLOSENESS * slope_scale;
    if !settled || !sums.density.is_finite() {
        return None;
    }
    let side = if at_corner { SlopeSide::Outer } else { SlopeSide::Both };
    let jump = 2.0 * at_rest * sums.density / period;
    let mut effective = Effective::closed(
        [sums.value[0] / period, 0.0],
        [jump, sums.slope[0] / period],
        slope_scale,
        side,
    );
    effective.coefficient_error += value_error + 1e-14 * scale;
    effective.slope_error += slope_error;
    Some(effective)
}

impl PieceSums {
    /// Adds an interval over which s is monotone.
    fn monotone(
        &mut self,
        law: &Friction,
        v: f64,
        part: &PolynomialPart,
        at_corner: bool,
    ) -> Option<()> {
        let ([from, to], [first, last]) = (part.ends, part.values);
        if (first < v) == (last < v) || at_corner {
            return self.part(law, v, part, [from, to]);
        }
        let crossing = part.crossing(v);
        self.density += part.rate(crossing).abs().recip();
        self.part(law, v, part, [from, crossing])?;
        self.part(law, v, part, [crossing, to])
    }

    /// Adds an interval in which the slip velocity v − s keeps its sign.
    fn part(
        &mut self,
        law: &Friction,
        v: f64,
        slip: &PolynomialPart,
        [from, to]: [f64; 2],
    ) -> Option<()> {
        let length = to - from;
        if length <= 0.0 {
            return Some(());
        }
        let sign = (v - slip.at(0.5 * (from + to))).signum();
        let change = (slip.at(to) - slip.at(from)).abs() / law.velocity_scale();
        // The short rules are exact for quadratics.
        let (rules, parts) = if change <= SHORT && slip.coefficients.len() <= 3 {
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
