//! Multipliers of several nearly equal maps, from the eigenvalues of one of them.
//!
//! One QR iteration on a map S gives all multipliers. For those that may be the largest, inverse iteration gives the right and
//! left vectors x, y; the multiplier of another map M follows from x ← x − (S − μ)⁻¹(Mx − θx), θ = yᵀMx/yᵀx, with the component
//! along x removed. Each iteration costs O(n²) and reduces the error by a factor ‖M − S‖κ/gap, 10⁻⁴ or less after processing.
//! If it does not converge, the full eigenvalue problem is solved.

use num_complex::Complex64;

use crate::dispatch::{Work, with_fused_multiply_add};
use crate::eigen::{Decomposition, Shifted, Split, product_without_conjugation};
use crate::groups::dot;
use crate::matrix::Matrix;
use crate::polar::modulus;

/// Maximum number of iterations; two or three are usual.
const ITERATIONS: usize = 12;

/// Relative change of a multiplier below which it is rounding.
const CONVERGED: f64 = 4e-16;

/// A multiplier of the map S with the data needed to compute it for other maps.
pub(super) struct TrackedMultiplier {
    /// Its condition number κ.
    pub(super) condition: f64,
    shifted: Shifted,
    right: Split,
    left: Split,
    /// x and y in the original coordinates of the maps.
    right_outside: Split,
    left_outside: Split,
}

struct FactorAndVectors<'a> {
    of: &'a Decomposition,
    value: Complex64,
}

impl Work for FactorAndVectors<'_> {
    type Output = (Shifted, Split, Split);

    #[inline(always)]
    fn run(self) -> Self::Output {
        let shifted = self.of.shifted(self.value);
        let (right, left) = shifted.vectors(0);
        (shifted, right, left)
    }
}

struct Solve<'a>(&'a Shifted, Split);

impl Work for Solve<'_> {
    type Output = Split;

    #[inline(always)]
    fn run(self) -> Split {
        self.0.solve(self.1)
    }
}

/// M x of a complex vector.
struct Apply<'a>(&'a Matrix, &'a Split);

impl Work for Apply<'_> {
    type Output = Split;

    #[inline(always)]
    fn run(self) -> Split {
        let Self(map, x) = self;
        let n = map.rows();
        let mut product = Split::zeros(x.re.len());
        for i in 0..n {
            product.re[i] = dot(map.row(i), &x.re[..n]);
            product.im[i] = dot(map.row(i), &x.im[..n]);
        }
        product
    }
}

/// a − f b.
fn subtract(a: &mut Split, f: Complex64, b: &Split) {
    for i in 0..a.re.len() {
        a.re[i] -= f.re * b.re[i] - f.im * b.im[i];
        a.im[i] -= f.re * b.im[i] + f.im * b.re[i];
    }
}

impl TrackedMultiplier {
    /// Multiplier `index` of the map S; `None` if its vectors are unusable (a defective multiplier).
    pub(super) fn new(of: &Decomposition, index: usize) -> Option<Self> {
        let multiplier = of.values()[index];
        let (shifted, mut right, left) =
            with_fused_multiply_add(FactorAndVectors { of, value: multiplier });
        let product = product_without_conjugation(&left, &right);
        let size = modulus(product);
        if size.is_nan() || size < 1e-10 {
            return None;
        }
        // yᵀx = 1.
        let mut scaled = Split::zeros(right.re.len());
        subtract(&mut scaled, -product.inv(), &right);
        right = scaled;
        let outside = |x: &Split| {
            let mut x = x.clone();
            of.column_outside(&mut x.re);
            of.column_outside(&mut x.im);
            x
        };
        let (right_outside, left_outside) = (outside(&right), outside(&left));
        Some(Self { condition: 1.0 / size, shifted, right, left, right_outside, left_outside })
    }

    /// The corresponding multiplier of another map; `None` if the iteration does not converge.
    pub(super) fn in_map(&self, of: &Decomposition, map: &Matrix) -> Option<Complex64> {
        let mut x = self.right_outside.clone();
        let mut last: Option<(Complex64, f64)> = None;
        for _ in 0..ITERATIONS {
            let mut image = with_fused_multiply_add(Apply(map, &x));
            let theta = product_without_conjugation(&self.left_outside, &image);
            if !(theta.re.is_finite() && theta.im.is_finite()) {
                return None;
            }
            let size = modulus(theta);
            if let Some((before, change)) = last {
                let now = modulus(theta - before);
                if now <= CONVERGED * size {
                    return Some(theta);
                }
                // A change that no longer decreases is rounding if it is small, otherwise no convergence.
                if now >= 0.5 * change {
                    return (now <= 1e-14 * self.condition * size).then_some(theta);
                }
                last = Some((theta, now));
                // The next change will be smaller by the same factor.
                if now * (now / change) <= CONVERGED * size && change < f64::INFINITY {
                    return Some(theta);
                }
            } else {
                last = Some((theta, f64::INFINITY));
            }
            subtract(&mut image, theta, &x);
            of.column_inside(&mut image.re);
            of.column_inside(&mut image.im);
            let mut correction = with_fused_multiply_add(Solve(&self.shifted, image));
            let along = product_without_conjugation(&self.left, &correction);
            subtract(&mut correction, along, &self.right);
            of.column_outside(&mut correction.re);
            of.column_outside(&mut correction.im);
            subtract(&mut x, Complex64::new(1.0, 0.0), &correction);
        }
        None
    }
}
