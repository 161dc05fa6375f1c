//! Gauss–Legendre rules of any number of points.
//!
//! The nodes are the zeros of the Legendre polynomial P_n, found by Newton's method from Tricomi's cos(π(i − ¼)/(n + ½)); the
//! weights are 2/((1 − x²)P′_n(x)²). The rule is exact for polynomials up to degree 2n − 1. P_n comes from its three-term
//! recurrence, whose rounding grows with n: nodes and weights have errors of some 10⁻¹⁵ up to a few hundred points.

use core::f64::consts::PI;

/// Most steps of Newton's method for a node; four suffice from Tricomi's start.
const MOST_STEPS: usize = 20;

/// Nodes and weights on [−1, 1], in ascending order; one point for n = 0.
pub fn gauss_legendre(points: usize) -> Vec<(f64, f64)> {
    let n = points.max(1);
    let half: Vec<(f64, f64)> = (0..n / 2).map(|i| node(n, i)).collect();
    let mut rule: Vec<(f64, f64)> = half.iter().map(|&(x, w)| (-x, w)).collect();
    if n % 2 == 1 {
        let (_, slope) = legendre(n, 0.0);
        rule.push((0.0, 2.0 / (slope * slope)));
    }
    rule.extend(half.into_iter().rev());
    rule
}

/// The node i from the right end, and its weight.
fn node(n: usize, i: usize) -> (f64, f64) {
    let mut x = libm::cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
    for _ in 0..MOST_STEPS {
        let (value, slope) = legendre(n, x);
        let step = value / slope;
        x -= step;
        if step.abs() <= f64::EPSILON {
            break;
        }
    }
    let (_, slope) = legendre(n, x);
    (x, 2.0 / ((1.0 - x) * (1.0 + x) * slope * slope))
}

/// P_n and its derivative inside (−1, 1).
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, x);
    for k in 2..=n {
        let k = k as f64;
        let next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k;
        (before, value) = (value, next);
    }
    let slope = n as f64 * (before - x * value) / ((1.0 - x) * (1.0 + x));
    (value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_degree_2n_minus_1_are_exact() {
        for n in [1, 2, 3, 8, 17, 64, 200] {
            let rule = gauss_legendre(n);
            assert_eq!(rule.len(), n);
            assert!(rule.windows(2).all(|pair| pair[0].0 < pair[1].0));
            for degree in [0, 1, 2, 2 * n - 2, 2 * n - 1] {
                let power = |x: f64| (0..degree).map(|_| x).product::<f64>();
                let sum: f64 = rule.iter().map(|&(x, w)| w * power(x)).sum();
                let exact = if degree % 2 == 0 { 2.0 / (degree as f64 + 1.0) } else { 0.0 };
                assert!((sum - exact).abs() < 1e-13, "{n} {degree}: {sum} {exact}");
            }
        }
    }
}
