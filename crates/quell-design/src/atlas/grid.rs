//! Axes with Chebyshev nodes, and the barycentric interpolation over them.
//!
//! The nodes are the roots of the Chebyshev polynomial of first kind, mapped to the interval of the axis: x_k = a + (b − a) sin²θ_k,
//! θ_k = (2k + 1)π/(4n). The polynomial through values at them is Σ w_k f_k/(x − x_k) / Σ w_k/(x − x_k), w_k = (−1)^k sin 2θ_k, and
//! converges geometrically for an analytic function: J.-P. Berrut and L. N. Trefethen, "Barycentric Lagrange interpolation", SIAM
//! Review 46 (2004), section 5. With the roots no end of an axis is a node, which keeps steady sliding and the grazing itself out of
//! the tables.

use core::f64::consts::PI;

use quell_numerics::interval::RealInterval;

/// An axis of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct AtlasAxis {
    /// Name of the group.
    pub name: String,
    /// Its interval.
    pub range: RealInterval,
    /// Number of nodes, at least 1.
    pub count: usize,
}

impl AtlasAxis {
    /// An axis.
    pub fn new(name: &str, range: RealInterval, count: usize) -> Self {
        Self { name: name.to_owned(), range, count }
    }

    fn angle(&self, index: usize) -> f64 {
        (2 * index + 1) as f64 * PI / (4 * self.count) as f64
    }

    /// The nodes, in ascending order.
    pub fn nodes(&self) -> Vec<f64> {
        let RealInterval { lower: low, upper: high } = self.range;
        let node = |index| {
            let sine = libm::sin(self.angle(index));
            (high - low).mul_add(sine * sine, low)
        };
        (0..self.count).map(node).collect()
    }

    /// The factors of the values at the nodes in the polynomial at `x`; their sum is 1.
    pub fn weights(&self, x: f64) -> Vec<f64> {
        let nodes = self.nodes();
        if let Some(exact) = nodes.iter().position(|node| *node == x) {
            return (0..self.count).map(|index| if index == exact { 1.0 } else { 0.0 }).collect();
        }
        let weight = |(index, node): (usize, &f64)| {
            let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
            sign * libm::sin(2.0 * self.angle(index)) / (x - node)
        };
        let weights: Vec<f64> = nodes.iter().enumerate().map(weight).collect();
        let sum: f64 = weights.iter().sum();
        weights.into_iter().map(|weight| weight / sum).collect()
    }
}

/// Every node of a grid, the last axis fastest.
pub(super) fn grid_nodes(axes: &[AtlasAxis]) -> Vec<Vec<f64>> {
    axes.iter().fold(vec![Vec::new()], |before, axis| {
        let nodes = axis.nodes();
        let longer = |first: Vec<f64>| {
            let with = |node: &f64| [first.as_slice(), &[*node]].concat();
            nodes.iter().map(with).collect::<Vec<_>>()
        };
        before.into_iter().flat_map(longer).collect()
    })
}

/// Values over a grid reduced to those over its last axes, by the interpolation at `place` in the first ones.
pub(super) fn reduced(axes: &[AtlasAxis], values: &[f64], place: &[f64]) -> Vec<f64> {
    axes.iter().zip(place).fold(values.to_vec(), |values, (axis, x)| {
        let rest = values.len() / axis.count;
        let weights = axis.weights(*x);
        let mut sums = vec![0.0; rest];
        for (weight, row) in weights.iter().zip(values.chunks_exact(rest.max(1))) {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum += weight * value;
            }
        }
        sums
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polynomial of the degree of each axis is reproduced.
    #[test]
    fn polynomials_are_reproduced() {
        let axes = [
            AtlasAxis::new("a", RealInterval::new(-1.0, 2.0), 4),
            AtlasAxis::new("b", RealInterval::new(0.0, 0.5), 3),
        ];
        let polynomial = |a: f64, b: f64| a * a * a - 2.0 * a * b * b + 3.0 * b;
        let nodes = grid_nodes(&axes);
        assert_eq!(nodes.len(), 12);
        let values: Vec<f64> = nodes.iter().map(|node| polynomial(node[0], node[1])).collect();
        for (a, b) in [(-1.0, 0.0), (0.3, 0.41), (2.0, 0.5), (nodes[5][0], nodes[5][1])] {
            let found = reduced(&axes, &values, &[a, b]);
            // Rounding of values up to 10.
            assert!((found[0] - polynomial(a, b)).abs() < 1e-13, "{found:?} at {a}, {b}");
        }
    }

    /// The polynomial through an analytic function converges by a factor per node: e^x on [0, 1] by 12 nodes to rounding.
    #[test]
    fn an_analytic_function_converges() {
        let error = |count: usize| {
            let axis = AtlasAxis::new("x", RealInterval::new(0.0, 1.0), count);
            let values: Vec<f64> = axis.nodes().into_iter().map(libm::exp).collect();
            let at = |x: f64| reduced(std::slice::from_ref(&axis), &values, &[x])[0] - libm::exp(x);
            (0..=50).map(|step| at(f64::from(step) / 50.0).abs()).fold(0.0, f64::max)
        };
        assert!(error(12) < 1e-14, "{}", error(12));
        assert!(error(4) > 1e-5 && error(4) < 1e-3, "{}", error(4));
    }
}
