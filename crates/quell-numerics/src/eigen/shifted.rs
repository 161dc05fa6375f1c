//! Factorisation of a shifted Hessenberg matrix H − σ: right and left eigenvectors by inverse iteration.
//!
//! Elimination with pivoting between neighbouring rows, E·P·(H − σ) = U. A vanishing pivot (σ is an eigenvalue to the last
//! digit) is replaced by ε‖H‖, so that inverse iteration converges in one or two steps. Real and imaginary
//! parts are stored in separate arrays, in whole groups of lanes.
//! The left vector y solves yᵀ(H − σ) = 0 (transposed, not conjugated), so that for a simple eigenvalue yᵀx ≠ 0 and
//! yᵀEx / yᵀx is the change of the eigenvalue under a small change E.

use num_complex::Complex64;

use crate::groups::LANES;

/// Complex numbers with separate real and imaginary parts, in whole groups of lanes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Split {
    pub(crate) re: Vec<f64>,
    pub(crate) im: Vec<f64>,
}

impl Split {
    #[inline(always)]
    pub(crate) fn zeros(length: usize) -> Self {
        Self { re: vec![0.0; length], im: vec![0.0; length] }
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Complex64 {
        Complex64::new(self.re[i], self.im[i])
    }

    #[inline(always)]
    fn set(&mut self, i: usize, value: Complex64) {
        self.re[i] = value.re;
        self.im[i] = value.im;
    }

    #[inline(always)]
    fn swap(&mut self, i: usize, j: usize) {
        self.re.swap(i, j);
        self.im.swap(i, j);
    }

    /// Scales the vector to length one.
    #[inline(always)]
    fn normalise(&mut self) {
        let largest = self.re.iter().chain(&self.im).fold(0.0f64, |largest, value| {
            if value.abs() > largest { value.abs() } else { largest }
        });
        if largest == 0.0 || !largest.is_finite() {
            return;
        }
        let mut squares = 0.0;
        for (re, im) in self.re.iter_mut().zip(&mut self.im) {
            *re /= largest;
            *im /= largest;
            squares += *re * *re + *im * *im;
        }
        let factor = 1.0 / squares.sqrt();
        for (re, im) in self.re.iter_mut().zip(&mut self.im) {
            *re *= factor;
            *im *= factor;
        }
    }
}

/// The factors of H − σ.
#[derive(Clone, Debug)]
pub(crate) struct Shifted {
    n: usize,
    stride: usize,
    upper: Split,
    inverse_pivots: Vec<Complex64>,
    multipliers: Vec<Complex64>,
    swapped: Vec<bool>,
}

/// a − m·b over whole groups, with separate real and imaginary parts.
#[inline(always)]
fn subtract(a_re: &mut [f64], a_im: &mut [f64], m: Complex64, b_re: &[f64], b_im: &[f64]) {
    let a = a_re.chunks_exact_mut(LANES).zip(a_im.chunks_exact_mut(LANES));
    let b = b_re.chunks_exact(LANES).zip(b_im.chunks_exact(LANES));
    for ((a_re, a_im), (b_re, b_im)) in a.zip(b) {
        for lane in 0..LANES {
            a_re[lane] = m.im.mul_add(b_im[lane], (-m.re).mul_add(b_re[lane], a_re[lane]));
            a_im[lane] = (-m.im).mul_add(b_re[lane], (-m.re).mul_add(b_im[lane], a_im[lane]));
        }
    }
}

impl Shifted {
    /// Room for the factors of matrices of `n` rows of length `stride`.
    pub(crate) fn room(n: usize, stride: usize) -> Self {
        let none = Complex64::new(0.0, 0.0);
        Self {
            n,
            stride,
            upper: Split::zeros(n * stride),
            inverse_pivots: vec![none; n],
            multipliers: vec![none; n],
            swapped: vec![false; n],
        }
    }

    /// Factors H − σ; `h` is stored in rows of length `stride` and zero below the subdiagonal, `norm` is its norm.
    #[inline(always)]
    pub(crate) fn new(h: &[f64], n: usize, stride: usize, norm: f64, shift: Complex64) -> Self {
        let mut factors = Self::room(n, stride);
        factors.factor(h, norm, shift);
        factors
    }

    /// Factors another H − σ of the same size in the same room.
    #[inline(always)]
    pub(crate) fn factor(&mut self, h: &[f64], norm: f64, shift: Complex64) {
        let (n, stride) = (self.n, self.stride);
        for i in 0..n {
            // What is left of the first group with entries is never read.
            let row = i * stride + i.saturating_sub(1) / LANES * LANES..(i + 1) * stride;
            self.upper.re[row.clone()].copy_from_slice(&h[row.clone()]);
            self.upper.im[row].fill(0.0);
        }
        self.multipliers.fill(Complex64::new(0.0, 0.0));
        self.swapped.fill(false);
        for i in 0..n {
            self.upper.re[i * stride + i] -= shift.re;
            self.upper.im[i * stride + i] = -shift.im;
        }
        let tiny = f64::EPSILON * if norm == 0.0 { 1.0 } else { norm };
        for k in 0..n {
            self.eliminate(k, tiny);
        }
    }

    #[inline(always)]
    fn eliminate(&mut self, k: usize, tiny: f64) {
        let (n, stride) = (self.n, self.stride);
        let at = k * stride + k;
        let mut pivot = self.upper.get(at);
        if k + 1 < n {
            let below = self.upper.get(at + stride);
            let from = k / LANES * LANES;
            let (head_re, tail_re) = self.upper.re.split_at_mut((k + 1) * stride);
            let (head_im, tail_im) = self.upper.im.split_at_mut((k + 1) * stride);
            let (row_re, row_im) =
                (&mut head_re[k * stride + from..], &mut head_im[k * stride + from..]);
            let (next_re, next_im) = (&mut tail_re[from..stride], &mut tail_im[from..stride]);
            let mut other = below;
            if below.re.abs() + below.im.abs() > pivot.re.abs() + pivot.im.abs() {
                self.swapped[k] = true;
                row_re.swap_with_slice(next_re);
                row_im.swap_with_slice(next_im);
                (pivot, other) = (below, pivot);
            }
            if pivot.re.abs() + pivot.im.abs() < tiny {
                pivot = Complex64::new(tiny, 0.0);
            }
            let inverse = pivot.inv();
            let multiplier = other * inverse;
            if multiplier.re != 0.0 || multiplier.im != 0.0 {
                subtract(next_re, next_im, multiplier, row_re, row_im);
            }
            self.multipliers[k] = multiplier;
            self.inverse_pivots[k] = inverse;
        } else {
            if pivot.re.abs() + pivot.im.abs() < tiny {
                pivot = Complex64::new(tiny, 0.0);
            }
            self.inverse_pivots[k] = pivot.inv();
        }
    }

    /// Solves U x = b.
    #[inline(always)]
    fn back(&self, b: &Split) -> Split {
        let stride = self.stride;
        let mut x = Split::zeros(stride);
        for k in (0..self.n).rev() {
            let from = k / LANES * LANES;
            let row_re = &self.upper.re[k * stride + from..(k + 1) * stride];
            let row_im = &self.upper.im[k * stride + from..(k + 1) * stride];
            let (mut re, mut im) = ([0.0f64; LANES], [0.0f64; LANES]);
            // Entries of x up to k are still zero, so whole groups give the correct sum.
            let row = row_re.chunks_exact(LANES).zip(row_im.chunks_exact(LANES));
            let known = x.re[from..].chunks_exact(LANES).zip(x.im[from..].chunks_exact(LANES));
            for ((u_re, u_im), (x_re, x_im)) in row.zip(known) {
                for lane in 0..LANES {
                    re[lane] =
                        (-u_im[lane]).mul_add(x_im[lane], u_re[lane].mul_add(x_re[lane], re[lane]));
                    im[lane] =
                        u_im[lane].mul_add(x_re[lane], u_re[lane].mul_add(x_im[lane], im[lane]));
                }
            }
            let sum = Complex64::new(
                (re[0] + re[1]) + (re[2] + re[3]),
                (im[0] + im[1]) + (im[2] + im[3]),
            );
            x.set(k, (b.get(k) - sum) * self.inverse_pivots[k]);
        }
        x
    }

    /// Solves (H − σ) x = b.
    #[inline(always)]
    pub(crate) fn solve(&self, mut b: Split) -> Split {
        for k in 0..self.n.saturating_sub(1) {
            if self.swapped[k] {
                b.swap(k, k + 1);
            }
            let value = b.get(k + 1) - self.multipliers[k] * b.get(k);
            b.set(k + 1, value);
        }
        self.back(&b)
    }

    /// Solves (H − σ)ᵀ y = b.
    #[inline(always)]
    pub(crate) fn solve_transposed(&self, mut b: Split) -> Split {
        let stride = self.stride;
        for k in 0..self.n {
            let value = b.get(k) * self.inverse_pivots[k];
            let from = k / LANES * LANES;
            subtract(
                &mut b.re[from..],
                &mut b.im[from..],
                value,
                &self.upper.re[k * stride + from..(k + 1) * stride],
                &self.upper.im[k * stride + from..(k + 1) * stride],
            );
            b.set(k, value);
        }
        for k in (0..self.n.saturating_sub(1)).rev() {
            let value = b.get(k) - self.multipliers[k] * b.get(k + 1);
            b.set(k, value);
            if self.swapped[k] {
                b.swap(k, k + 1);
            }
        }
        b
    }

    /// Right and left eigenvector of the eigenvalue closest to σ, each of length one. For a multiple eigenvalue, other
    /// values of `variant` give other vectors of its eigenspace.
    #[inline(always)]
    pub(crate) fn vectors(&self, variant: usize) -> (Split, Split) {
        let mut start = Split::zeros(self.stride);
        for i in 0..self.n {
            // Not symmetric, so that no symmetry of the matrix makes it orthogonal to the eigenvector.
            let flipped = variant > 0 && (i / variant) % 2 == 1;
            start.re[i] = if flipped { -1.0 } else { 1.0 } + 0.01 * i as f64;
        }
        let mut left = self.solve_transposed(start.clone());
        left.normalise();
        left = self.solve_transposed(left);
        left.normalise();
        let mut right = self.back(&start);
        right.normalise();
        right = self.solve(right);
        right.normalise();
        (right, left)
    }
}
