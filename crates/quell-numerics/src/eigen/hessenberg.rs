//! Reduction to Hessenberg form by Householder reflectors: QᵀAQ = H, H zero below the first subdiagonal.
//!
//! Reflector k acts on rows and columns k+1…n−1 and maps column k to a multiple of its first entry. From the left it is
//! wᵀ = vᵀA, A ← A − β v wᵀ; from the right A ← A − β (Av) vᵀ. Rows are padded to whole groups of [`LANES`]: every loop
//! runs over whole groups, and a sum over a row has one accumulator per lane, added in a fixed order.
//! Backward stable: the eigenvalues are those of A + E with ‖E‖ of the order of n ε ‖A‖.

use crate::dispatch::{Work, with_fused_multiply_add};
use crate::groups::{LANES, add_scaled, dot};

/// Length of a padded row.
pub(crate) const fn stride_of(n: usize) -> usize {
    n.div_ceil(LANES) * LANES
}

/// The reflectors of a reduction: row k contains v of reflector k (zero up to k) and β.
#[derive(Clone, Debug)]
pub(crate) struct Reflectors {
    n: usize,
    stride: usize,
    vectors: Vec<f64>,
    factors: Vec<f64>,
}

impl Reflectors {
    /// x ← Qᵀ x.
    pub(crate) fn reduce_vector(&self, x: &mut [f64]) {
        let all = 0..self.factors.len();
        with_fused_multiply_add(Applied { reflectors: self, order: all, x });
    }

    /// x ← Q x.
    pub(crate) fn out_of_reduced(&self, x: &mut [f64]) {
        let all = (0..self.factors.len()).rev();
        with_fused_multiply_add(Applied { reflectors: self, order: all, x });
    }

    #[inline(always)]
    fn apply(&self, k: usize, x: &mut [f64]) {
        // From the group that contains entry k + 1; v is zero before.
        let from = (k + 1) / LANES * LANES;
        let v = &self.vectors[k * self.stride + from..k * self.stride + self.n];
        let x = &mut x[from..self.n];
        let along = dot(v, x);
        add_scaled(x, -self.factors[k] * along, v);
    }
}

/// Reflectors applied to a vector in an order.
struct Applied<'a, O> {
    reflectors: &'a Reflectors,
    order: O,
    x: &'a mut [f64],
}

impl<O: Iterator<Item = usize>> Work for Applied<'_, O> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { reflectors, order, x } = self;
        for k in order {
            reflectors.apply(k, x);
        }
    }
}

/// Reduces the n × n matrix in rows of length `stride` (padding zero) to Hessenberg form; zeros are
/// written below the subdiagonal.
#[inline(always)]
pub(crate) fn reduce(a: &mut [f64], n: usize, stride: usize) -> Reflectors {
    let count = n.saturating_sub(2);
    let mut reflectors =
        Reflectors { n, stride, vectors: vec![0.0; count * stride], factors: vec![0.0; count] };
    let mut along = vec![0.0; stride];
    for k in 0..count {
        let v = &mut reflectors.vectors[k * stride..(k + 1) * stride];
        for i in k + 1..n {
            v[i] = a[i * stride + k];
        }
        let largest = v.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
        if v[k + 2..].iter().all(|&value| value == 0.0) || !largest.is_finite() {
            v.fill(0.0);
            continue;
        }
        // Scaled by the largest entry, so that no square overflows or underflows.
        for value in v.iter_mut() {
            *value /= largest;
        }
        let norm = dot(v, v).sqrt();
        let first = v[k + 1];
        let signed = if first < 0.0 { -norm } else { norm };
        v[k + 1] = first + signed;
        let beta = 1.0 / (signed * v[k + 1]);
        reflectors.factors[k] = beta;
        // Whole groups that contain all columns from k on.
        let from = k / LANES * LANES;
        let along = &mut along[from..];
        along.fill(0.0);
        for i in k + 1..n {
            add_scaled(along, v[i], &a[i * stride + from..(i + 1) * stride]);
        }
        for i in k + 1..n {
            add_scaled(&mut a[i * stride + from..(i + 1) * stride], -beta * v[i], along);
        }
        let from = (k + 1) / LANES * LANES;
        for row in a.chunks_exact_mut(stride).take(n) {
            let factor = -beta * dot(&row[from..], &v[from..]);
            add_scaled(&mut row[from..], factor, &v[from..]);
        }
        a[(k + 1) * stride + k] = -signed * largest;
        for i in k + 2..n {
            a[i * stride + k] = 0.0;
        }
    }
    reflectors
}
