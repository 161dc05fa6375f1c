//! Eigenvalues of complex tridiagonal matrices: all of them by QL, a single one by Newton's method.
//!
//! The eigenvalues depend only on the diagonal d and the products c of opposite off-diagonal entries, so that any tridiagonal
//! matrix is equivalent to the complex symmetric one with √c next to the diagonal. QL with implicit Wilkinson shifts on this
//! matrix costs O(n²) in total, compared with O(n³) for a general matrix; see Cullum and Willoughby (1996). Its rotations are
//! orthogonal, not unitary: they may be large, and for rare matrices they break down, in which case all values are found at once by
//! Newton steps that repel each other.
//!
//! One eigenvalue is refined by p/p′ of p(μ) = det(T − μ), from the quotients of successive leading minors; this costs
//! O(n) per step, and the result does not depend on the quality of the start if the iteration converges.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::EigenError;
use crate::polar::{from_polar, modulus, square_root};

/// Maximum number of QL sweeps for one eigenvalue before it is given up; two or three are usual.
const SWEEPS: usize = 60;

/// Maximum number of steps of all values at once; the start is far from graded values, to which each step brings them by a constant factor.
const REPULSIONS: usize = 400;

/// Relative size of the last step of a value: the number of its digits triples with each, down to rounding.
const SETTLED: f64 = 1e-11;

/// Maximum number of Newton steps.
const NEWTON_STEPS: usize = 12;

/// Fraction of the norm below which an entry next to the diagonal is negligible.
const NEGLIGIBLE: f64 = 1e-3 * f64::EPSILON;

/// A complex tridiagonal matrix, up to a diagonal similarity transformation.
#[derive(Clone, Debug)]
pub struct Tridiagonal {
    /// The diagonal d.
    pub diagonal: Vec<Complex64>,
    /// c: entry (k, k + 1) times entry (k + 1, k), one fewer than d.
    pub across: Vec<Complex64>,
}

impl Tridiagonal {
    /// All eigenvalues.
    ///
    /// # Errors
    /// [`EigenError`] if an entry is not finite or the iteration does not converge.
    pub fn eigenvalues(&self) -> Result<Vec<Complex64>, EigenError> {
        let entries = self.diagonal.iter().chain(&self.across);
        if !entries.into_iter().all(|z| z.re.is_finite() && z.im.is_finite()) {
            return Err(EigenError::NotFinite);
        }
        match self.by_ql() {
            Some(values) => Ok(values),
            None => self.by_repulsion().ok_or(EigenError::NotConverged),
        }
    }

    /// QL with implicit shifts; `None` if it breaks down.
    fn by_ql(&self) -> Option<Vec<Complex64>> {
        let n = self.diagonal.len();
        let mut d = self.diagonal.clone();
        let mut e: Vec<Complex64> = self.across.iter().map(|&c| square_root(c)).collect();
        e.push(Complex64::new(0.0, 0.0));
        let size = |z: Complex64| z.re.abs() + z.im.abs();
        let norm = d.iter().chain(&e).fold(0.0, |most: f64, &z| most.max(size(z)));
        for first in 0..n {
            let mut sweeps = 0;
            loop {
                let small = |k: usize| {
                    let neighbour = f64::EPSILON * (size(d[k]) + size(d[k + 1]));
                    size(e[k]) <= neighbour.max(NEGLIGIBLE * norm)
                };
                let last = (first..n - 1).find(|&k| small(k)).unwrap_or(n - 1);
                if last == first {
                    break;
                }
                sweeps += 1;
                if sweeps > SWEEPS {
                    return None;
                }
                sweep(&mut d, &mut e, first, last)?;
            }
        }
        d.iter().all(|z| z.re.is_finite() && z.im.is_finite()).then_some(d)
    }

    /// All zeros of p at once by Newton steps that repel each other (Ehrlich and Aberth): Bini, Gemignani and Tisseur, *SIAM J. Matrix Anal.
    /// Appl.* 27 (2005) 153. It needs no factorisation, so that nothing can break down.
    fn by_repulsion(&self) -> Option<Vec<Complex64>> {
        let n = self.diagonal.len();
        let centre = self.diagonal.iter().sum::<Complex64>() / n as f64;
        let beside: Vec<f64> = self.across.iter().map(|&c| modulus(square_root(c))).collect();
        let reach = |k: usize| {
            let neighbours =
                beside.get(k).unwrap_or(&0.0) + beside.get(k.wrapping_sub(1)).unwrap_or(&0.0);
            modulus(self.diagonal[k] - centre) + neighbours
        };
        // Gershgorin's circles lie in that about the mean; the starts are on a smaller one, without symmetry.
        let radius = (0..n).map(reach).fold(0.0, f64::max);
        let turn = |k: usize| TAU * k as f64 / n as f64 + 0.7;
        let mut values: Vec<Complex64> =
            (0..n).map(|k| centre + from_polar(0.5 * radius, turn(k))).collect();
        let mut settled = vec![false; n];
        for _ in 0..REPULSIONS {
            for k in 0..n {
                if settled[k] {
                    continue;
                }
                let value = values[k];
                let others = (0..n).filter(|&other| other != k && values[other] != value);
                let repulsion: Complex64 = others.map(|other| (value - values[other]).inv()).sum();
                let newton = self.newton_step(value);
                let step = newton / (-newton * repulsion + 1.0);
                values[k] = value - step;
                settled[k] = modulus(step) <= SETTLED * (modulus(value) + 0.1 * radius);
            }
            if settled.iter().all(|&done| done) {
                return Some(values);
            }
        }
        None
    }

    /// The eigenvalue to which Newton's method converges from `start`, to the last digits; `None` if it does not converge or
    /// leaves the circle of radius `within` about the start.
    pub fn refine(&self, start: Complex64, within: f64) -> Option<Complex64> {
        let mut value = start;
        for _ in 0..NEWTON_STEPS {
            let step = self.newton_step(value);
            let next = value - step;
            // False for values that are not finite.
            let near = modulus(next - start) <= within;
            if !near {
                return None;
            }
            value = next;
            if modulus(step) <= 1e-11 * modulus(value) {
                // Newton's method doubles the number of digits: one more step reaches rounding level.
                return Some(value - self.newton_step(value));
            }
        }
        None
    }

    /// p/p′ at μ.
    fn newton_step(&self, value: Complex64) -> Complex64 {
        let zero = Complex64::new(0.0, 0.0);
        let (mut inverse, mut slope, mut sum) = (zero, zero, zero);
        for (k, &diagonal) in self.diagonal.iter().enumerate() {
            // q = p_k/p_{k−1} and its derivative.
            let share = if k == 0 { zero } else { self.across[k - 1] * inverse };
            let mut quotient = diagonal - value - share;
            if quotient.norm_sqr() == 0.0 {
                quotient = Complex64::new(f64::MIN_POSITIVE.sqrt(), 0.0);
            }
            let derivative = share * inverse * slope - 1.0;
            inverse = quotient.inv();
            slope = derivative;
            sum += derivative * inverse;
        }
        sum.inv()
    }
}

/// One QL sweep on rows `first`…`last`; `None` if a rotation is not finite.
fn sweep(d: &mut [Complex64], e: &mut [Complex64], first: usize, last: usize) -> Option<()> {
    let one = Complex64::new(1.0, 0.0);
    // Wilkinson's shift: the eigenvalue of the leading 2 × 2 block that is closer to its first diagonal entry.
    let g = (d[first + 1] - d[first]) / (e[first] * 2.0);
    let r = square_root(g * g + 1.0);
    let larger = if (g + r).norm_sqr() >= (g - r).norm_sqr() { g + r } else { g - r };
    let mut g = d[last] - d[first] + e[first] / larger;
    let (mut s, mut c, mut p) = (one, one, Complex64::new(0.0, 0.0));
    for k in (first..last).rev() {
        let (f, b) = (s * e[k], c * e[k]);
        let r = square_root(f * f + g * g);
        e[k + 1] = r;
        if r.norm_sqr() == 0.0 {
            if f.norm_sqr() > 0.0 {
                // f² + g² = 0 with f ≠ 0: no orthogonal rotation.
                return None;
            }
            d[k + 1] -= p;
            e[last] = Complex64::new(0.0, 0.0);
            return Some(());
        }
        let inverse = r.inv();
        s = f * inverse;
        c = g * inverse;
        g = d[k + 1] - p;
        let rotated = (d[k] - g) * s + c * b * 2.0;
        p = s * rotated;
        d[k + 1] = g + p;
        g = c * rotated - b;
        if !(g.re.is_finite() && g.im.is_finite()) {
            return None;
        }
    }
    d[first] -= p;
    e[first] = g;
    e[last] = Complex64::new(0.0, 0.0);
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(state: &mut u64) -> f64 {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        (*state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }

    /// Random matrices: uniform, graded towards both ends, and with a zero diagonal.
    fn sample(kind: usize, n: usize, state: &mut u64) -> Tridiagonal {
        let mut number = |k: usize| {
            let middle = (k as f64 - 0.5 * n as f64).abs();
            let size = if kind == 1 { libm::exp(-0.5 * middle) } else { 1.0 };
            Complex64::new(random(state), random(state)) * size
        };
        let diagonal: Vec<Complex64> =
            (0..n).map(|k| if kind == 2 { Complex64::new(0.0, 0.0) } else { number(k) }).collect();
        let across = (0..n - 1).map(|k| number(k) * number(k + 1)).collect();
        Tridiagonal { diagonal, across }
    }

    #[test]
    fn ql_agrees_with_values_that_repel_each_other() {
        let mut state = 0x9e37_79b9_7f4a_7c15;
        let (mut rotated, mut worst) = (0, 0.0f64);
        for round in 0..300 {
            let n = 1 + round % 60;
            let matrix = sample(round % 3, n, &mut state);
            let mut repelled = matrix.by_repulsion().expect("converges");
            let Some(found) = matrix.by_ql() else { continue };
            rotated += 1;
            let norm = repelled.iter().map(|z| modulus(*z)).fold(0.0, f64::max);
            for value in found {
                let near = (0..repelled.len()).min_by(|&i, &j| {
                    modulus(repelled[i] - value).total_cmp(&modulus(repelled[j] - value))
                });
                let other = repelled.swap_remove(near.expect("as many"));
                // The condition numbers of these eigenvalues are several hundred.
                worst = worst.max(modulus(value - other) / norm);
            }
        }
        println!("{rotated} matrices, worst difference {worst:.1e}");
        assert!(rotated > 295 && worst < 1e-10, "{rotated} {worst:e}");
    }

    #[test]
    fn newton_converges_to_the_eigenvalues_of_ql() {
        let mut state = 0x2545_f491_4f6c_dd1d;
        for round in 0..60 {
            let matrix = sample(round % 3, 30, &mut state);
            let values = matrix.eigenvalues().expect("finite");
            for &value in &values {
                let gap = values
                    .iter()
                    .map(|other| modulus(other - value))
                    .filter(|gap| *gap > 0.0)
                    .fold(f64::INFINITY, f64::min);
                let start = value + Complex64::new(1e-3, 1e-3) * gap;
                let found = matrix.refine(start, 0.5 * gap).expect("it is near");
                assert!(modulus(found - value) <= 1e-9 * modulus(value) + 1e-12, "{found} {value}");
            }
        }
    }

    #[test]
    fn eigenvalues_agree_with_a_closed_form() {
        // 2 on the diagonal and 1 next to it: 2 + 2 cos(kπ/(n + 1)).
        let n = 17;
        let one = Complex64::new(1.0, 0.0);
        let matrix = Tridiagonal { diagonal: vec![one * 2.0; n], across: vec![one; n - 1] };
        let mut found: Vec<f64> =
            matrix.eigenvalues().expect("finite").iter().map(|z| z.re).collect();
        found.sort_by(f64::total_cmp);
        for (k, value) in found.iter().rev().enumerate() {
            let exact = 2.0 + 2.0 * libm::cos(core::f64::consts::PI * (k + 1) as f64 / 18.0);
            assert!((value - exact).abs() < 1e-14, "{value} {exact}");
        }
        let endless = Tridiagonal { diagonal: vec![one * f64::NAN], across: vec![] };
        assert_eq!(endless.eigenvalues(), Err(EigenError::NotFinite));
    }
}
