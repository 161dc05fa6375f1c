//! Gauss–Legendre collocation of the variational equation on one segment of slip, and the least slip velocity there.

use std::sync::LazyLock;

use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::lane::horner;

/// Collocation nodes of a segment.
pub(super) const NODES: usize = 8;

/// Gauss–Legendre collocation on [0, 1].
pub(super) struct Collocation {
    pub(super) nodes: [f64; NODES],
    pub(super) weights: [f64; NODES],
    /// `integrals[i][j]`: ∫₀^{cᵢ} of the j-th Lagrange polynomial.
    pub(super) integrals: [[f64; NODES]; NODES],
    /// The square of `integrals`.
    squares: [[f64; NODES]; NODES],
    /// Sums of the rows of `integrals`.
    reaches: [f64; NODES],
}

pub(super) static COLLOCATION: LazyLock<Collocation> = LazyLock::new(Collocation::new);

impl Collocation {
    fn new() -> Self {
        let [nodes, weights] = GaussLegendre::new(NODES).on_unit_interval();
        let mut integrals = [[0.0; NODES]; NODES];
        for (row, &end) in integrals.iter_mut().zip(&nodes) {
            for (j, entry) in row.iter_mut().enumerate() {
                let values = nodes.map(|node| lagrange(&nodes, j, end * node));
                *entry = end * values.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>();
            }
        }
        let mut squares = [[0.0; NODES]; NODES];
        for i in 0..NODES {
            for j in 0..NODES {
                squares[i][j] = (0..NODES).map(|k| integrals[i][k] * integrals[k][j]).sum();
            }
        }
        let reaches = integrals.map(|row| row.iter().sum());
        Self { nodes, weights, integrals, squares, reaches }
    }
}

/// The j-th Lagrange polynomial at a point.
fn lagrange(nodes: &[f64; NODES], j: usize, point: f64) -> f64 {
    let others = nodes.iter().enumerate().filter(|(k, _)| *k != j);
    others.map(|(_, node)| (point - node) / (nodes[j] - node)).product()
}

#[expect(
    clippy::needless_range_loop,
    reason = "small matrices by their indices, as in the formula"
)]
#[inline(always)]
pub(super) fn weighted(rule: &Collocation, values: &[f64; NODES]) -> f64 {
    let mut sum = 0.0;
    for k in 0..NODES {
        sum = values[k].mul_add(rule.weights[k], sum);
    }
    sum
}

/// Accelerations η′ at the nodes for two columns of changes: vᵢ = η + hΣaᵢⱼfⱼ, fᵢ = −(ξ + hΣaᵢⱼvⱼ) − rᵢvᵢ, by
/// elimination of v: (I + r h A + h²A²) f = −ξ − η(h A 1 + r). The matrix is the identity plus a small matrix,
/// so that elimination needs no pivoting: h is a step of the engine, at most 8 radians of the fastest oscillation
/// and in practice below 1.
#[expect(
    clippy::needless_range_loop,
    reason = "small matrices by their indices, as in the formula"
)]
#[inline(always)]
pub(super) fn forces(
    rule: &Collocation,
    rates: &[f64; NODES],
    h: f64,
    xi: [f64; 2],
    eta: [f64; 2],
) -> [[f64; NODES]; 2] {
    let mut system = [[0.0; NODES + 2]; NODES];
    for i in 0..NODES {
        for j in 0..NODES {
            system[i][j] = (rates[i] * h).mul_add(rule.integrals[i][j], h * h * rule.squares[i][j]);
        }
        system[i][i] += 1.0;
        for column in 0..2 {
            let reach = h.mul_add(rule.reaches[i], rates[i]);
            system[i][NODES + column] = -eta[column].mul_add(reach, xi[column]);
        }
    }
    for column in 0..NODES {
        let head = system[column];
        let inverse = 1.0 / head[column];
        for row in &mut system[column + 1..] {
            let factor = row[column] * inverse;
            for k in column..NODES + 2 {
                row[k] = (-factor).mul_add(head[k], row[k]);
            }
        }
    }
    let mut force = [[0.0; NODES]; 2];
    for row in (0..NODES).rev() {
        for column in 0..2 {
            let mut rest = system[row][NODES + column];
            for k in row + 1..NODES {
                rest = (-system[row][k]).mul_add(force[column][k], rest);
            }
            force[column][row] = rest / system[row][row];
        }
    }
    force
}

/// Least value of Σ cₖtᵏ times `unit` on [0, h], and its location: the lowest of the nodes and ends, or between its neighbours by
/// Newton's method on the derivative, safeguarded by a bracket.
#[inline(always)]
pub(super) fn least_of(
    rule: &Collocation,
    slip: &[f64],
    unit: f64,
    h: f64,
    speeds: &[f64; NODES],
) -> Option<(f64, f64)> {
    let value = |since: f64| unit * horner(slip, since);
    let mut points = [(0.0, 0.0); NODES + 2];
    points[0] = (0.0, value(0.0));
    points[NODES + 1] = (h, value(h));
    for k in 0..NODES {
        points[k + 1] = (rule.nodes[k] * h, speeds[k]);
    }
    let lowest = (0..NODES + 2).min_by(|a, b| points[*a].1.total_cmp(&points[*b].1))?;
    let (mut since, mut least) = points[lowest];
    if lowest == 0 && slip.get(1).is_none_or(|rate| unit * rate >= 0.0) {
        return Some((least, since));
    }
    let (mut low, mut high) =
        (points[lowest.saturating_sub(1)].0, points[(lowest + 1).min(NODES + 1)].0);
    for _ in 0..12 {
        let (mut slope, mut bend) = (0.0, 0.0);
        for (k, coefficient) in slip.iter().enumerate().skip(1).rev() {
            bend = bend * since + slope;
            slope = slope * since + unit * coefficient * k as f64;
        }
        if slope > 0.0 {
            high = since;
        } else {
            low = since;
        }
        let next = since - slope / bend;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let moved = (next - since).abs();
        since = next;
        if moved <= 1e-9 * h {
            break;
        }
    }
    let inside = value(since);
    if inside < least {
        least = inside;
    } else {
        since = points[lowest].0;
    }
    Some((least, since))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn collocation_integrates_polynomials_and_the_oscillator() {
        let rule = &*COLLOCATION;
        assert!((rule.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        let power: f64 = rule.nodes.iter().zip(rule.weights).map(|(x, w)| w * x.powi(15)).sum();
        assert!((power - 1.0 / 16.0).abs() < 1e-14);
        // ξ″ + 2ζξ′ + ξ = 0 over one step of 0.8.
        let (zeta, h) = (0.3_f64, 0.8_f64);
        let force = forces(rule, &[2.0 * zeta; NODES], h, [1.0, 0.0], [0.0, 1.0]);
        // ξ(h) = ξ + hη + h²Σwᵢ(1 − cᵢ)fᵢ.
        let double: f64 =
            (0..NODES).map(|k| rule.weights[k] * (1.0 - rule.nodes[k]) * force[0][k]).sum();
        let xi = 1.0 + h * h * double;
        let omega = (1.0 - zeta * zeta).sqrt();
        let exact = (-zeta * h).exp() * ((omega * h).cos() + zeta / omega * (omega * h).sin());
        assert!((xi - exact).abs() < 1e-14, "{xi} {exact}");
    }
}
