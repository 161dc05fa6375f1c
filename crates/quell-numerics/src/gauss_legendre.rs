//! Nodes and weights of Gauss–Legendre quadrature of any order on [−1, 1].
//!
//! The nodes are the zeros of the Legendre polynomial Pₙ by Newton's iteration from Tricomi's approximation
//! cos(π(i − ¼)/(n + ½)); weights 2/((1 − x²) Pₙ'²). Exact for polynomials up to degree 2n − 1, to a few units of rounding.
//! Reference: P. J. Davis, P. Rabinowitz, *Methods of Numerical Integration*, 2nd ed. (1984), section 2.7.

/// Nodes in ascending order, and their weights.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussLegendre {
    /// Nodes xᵢ in (−1, 1).
    pub nodes: Vec<f64>,
    /// Weights wᵢ > 0; their sum is 2.
    pub weights: Vec<f64>,
}

/// Newton's iteration converges quadratically from a start accurate to 10⁻³ or better: six steps are more than enough.
const STEPS: usize = 8;

impl GaussLegendre {
    /// The rule with `count` nodes (at least one).
    #[must_use]
    pub fn new(count: usize) -> Self {
        let count = count.max(1);
        let (mut nodes, mut weights) = (vec![0.0; count], vec![0.0; count]);
        let order = count as f64;
        for i in 0..count.div_ceil(2) {
            let mut x = libm::cos(core::f64::consts::PI * (i as f64 + 0.75) / (order + 0.5));
            let mut slope = 1.0;
            for _ in 0..STEPS {
                let (value, previous) = legendre_pair(count, x);
                slope = order * (x * value - previous) / (x * x - 1.0);
                x -= value / slope;
            }
            if 2 * i + 1 == count {
                x = 0.0;
            }
            let weight = 2.0 / ((1.0 - x * x) * slope * slope);
            (nodes[i], nodes[count - 1 - i]) = (-x, x);
            (weights[i], weights[count - 1 - i]) = (weight, weight);
        }
        Self { nodes, weights }
    }

    /// The same rule on [0, 1] as tables: the first N nodes and weights, padded with zeros if the rule has fewer.
    #[must_use]
    pub fn on_unit_interval<const N: usize>(&self) -> [[f64; N]; 2] {
        let table = |values: &[f64], map: fn(f64) -> f64| {
            core::array::from_fn(|k| values.get(k).map_or(0.0, |value| map(*value)))
        };
        [table(&self.nodes, |node| 0.5 * (1.0 + node)), table(&self.weights, |w| 0.5 * w)]
    }
}

/// Pₙ(x) and Pₙ₋₁(x), n ≥ 1.
fn legendre_pair(n: usize, x: f64) -> (f64, f64) {
    let values = legendre(n, x);
    (values[n], values[n - 1])
}

/// P₀(x) … Pₙ(x) by the three-term recurrence.
#[must_use]
pub fn legendre(n: usize, x: f64) -> Vec<f64> {
    let mut values = vec![1.0; n + 1];
    if n >= 1 {
        values[1] = x;
    }
    for j in 1..n {
        let order = j as f64;
        values[j + 1] =
            ((2.0 * order + 1.0) * x * values[j] - order * values[j - 1]) / (order + 1.0);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ x^m = 2/(m + 1) for even m up to 2n − 1, and not beyond.
    #[test]
    fn exact_up_to_degree_2n_minus_1() {
        for count in [1, 2, 3, 7, 20, 41, 64] {
            let rule = GaussLegendre::new(count);
            let integral = |power: i32| -> f64 {
                rule.nodes.iter().zip(&rule.weights).map(|(x, w)| w * x.powi(power)).sum()
            };
            for power in 0..2 * i32::try_from(count).expect("small") {
                let exact = if power % 2 == 0 { 2.0 / f64::from(power + 1) } else { 0.0 };
                assert!((integral(power) - exact).abs() < 4e-15, "{count} nodes, x^{power}");
            }
            if count <= 7 {
                let power = 2 * i32::try_from(count).expect("small");
                assert!((integral(power) - 2.0 / f64::from(power + 1)).abs() > 1e-5);
            }
            assert!(rule.nodes.windows(2).all(|pair| pair[0] < pair[1]));
        }
    }

    #[test]
    fn on_the_unit_interval() {
        let [nodes, weights] = GaussLegendre::new(6).on_unit_interval::<6>();
        let power: f64 = nodes.iter().zip(weights).map(|(x, w)| w * x.powi(11)).sum();
        assert!((power - 1.0 / 12.0).abs() < 1e-16 && nodes.iter().all(|x| (0.0..1.0).contains(x)));
    }

    /// P₅(x) = (63x⁵ − 70x³ + 15x)/8.
    #[test]
    fn legendre_polynomial() {
        let x = 0.37_f64;
        let exact = (63.0 * x.powi(5) - 70.0 * x.powi(3) + 15.0 * x) / 8.0;
        assert!((legendre(5, x)[5] - exact).abs() < 1e-15);
    }
}
