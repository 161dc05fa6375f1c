//! Eigenvalues and eigenvectors of small dense real matrices.
//!
//! An own implementation of balancing, Hessenberg reduction and Francis' QR iteration, compiled with fused multiply-add if the
//! machine supports it: it gives the same bits on every machine and, below fifty rows, is several times faster than a library
//! designed for large matrices. No matrix is known for which the iteration does not converge. The tests compare it with `faer` on random,
//! defective and badly scaled matrices.
//!
//! Accuracy: the values are those of A + E with ‖E‖ ≤ n ε ‖A‖ (A balanced); a simple eigenvalue changes by at most
//! κ‖E‖ with κ = ‖x‖‖y‖/|yᵀx| ([`EigenPair::condition`]), a defective one by the square root of ‖E‖.

mod balance;
mod francis;
mod hessenberg;
mod rightmost;
mod shifted;
mod tridiagonal;

use num_complex::Complex64;

use crate::dispatch::{Work, with_fused_multiply_add};
use crate::matrix::Matrix;
use crate::polar::modulus;
use hessenberg::{Reflectors, stride_of};
pub use rightmost::Rightmost;
pub(crate) use shifted::{Shifted, Split};
pub use tridiagonal::Tridiagonal;

/// The reason why eigenvalues could not be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EigenError {
    /// An entry is not finite.
    NotFinite,
    /// The iteration did not converge.
    NotConverged,
}

impl core::fmt::Display for EigenError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotFinite => {
                write!(f, "a matrix with entries that are not finite has no eigenvalues")
            }
            Self::NotConverged => write!(f, "the iteration for eigenvalues did not converge"),
        }
    }
}

impl core::error::Error for EigenError {}

/// Balances a square matrix A ← D⁻¹AD by powers of two and returns the diagonal of D.
pub fn balanced(a: &mut Matrix) -> Vec<f64> {
    let n = a.rows();
    balance::balance(a.as_mut_slice(), n, n)
}

/// Eigenvalues of a square matrix in the order of deflation; complex pairs are adjacent.
///
/// # Errors
/// [`EigenError`] if an entry is not finite or the iteration does not converge.
pub fn eigenvalues(a: &Matrix) -> Result<Vec<Complex64>, EigenError> {
    Ok(Decomposition::new(a)?.values)
}

/// The diagonal and the entries below it of the Hessenberg form of a square matrix: of a symmetric one those of a tridiagonal matrix with
/// the same eigenvalues. `None` if an entry is not finite.
pub(crate) fn hessenberg_bands(a: &Matrix) -> Option<(Vec<f64>, Vec<f64>)> {
    with_fused_multiply_add(Bands(a))
}

struct Bands<'a>(&'a Matrix);

impl Work for Bands<'_> {
    type Output = Option<(Vec<f64>, Vec<f64>)>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let n = self.0.rows();
        let stride = stride_of(n);
        let mut h = in_padded_rows(self.0, stride);
        hessenberg::reduce(&mut h, n, stride);
        let diagonal = (0..n).map(|i| h[i * stride + i]).collect();
        let below = (1..n).map(|i| h[i * stride + i - 1]).collect();
        self.0.is_finite().then_some((diagonal, below))
    }
}

/// The entries of a square matrix in rows of length `stride`, padded with zeros.
#[inline(always)]
fn in_padded_rows(a: &Matrix, stride: usize) -> Vec<f64> {
    let mut rows = vec![0.0; a.rows() * stride];
    for (i, row) in rows.chunks_exact_mut(stride.max(1)).enumerate() {
        row[..a.columns()].copy_from_slice(a.row(i));
    }
    rows
}

/// The eigenvalues of a real matrix, with the data needed to compute vectors of a few of them.
#[derive(Clone, Debug)]
pub struct Decomposition {
    n: usize,
    stride: usize,
    scales: Vec<f64>,
    reflectors: Reflectors,
    hessenberg: Vec<f64>,
    norm: f64,
    values: Vec<Complex64>,
}

/// An eigenvalue with its vectors.
#[derive(Clone, Debug)]
pub struct EigenPair {
    /// The eigenvalue.
    pub value: Complex64,
    /// Right vector x, A x = λ x.
    pub right: Vec<Complex64>,
    /// Left vector y, yᵀA = λ yᵀ (transposed, not conjugated), scaled so that yᵀx = 1 unless that vanishes.
    pub left: Vec<Complex64>,
    /// Condition number κ = ‖x‖‖y‖/|yᵀx| in balanced coordinates: the change of the eigenvalue per unit change of the matrix.
    pub condition: f64,
}

struct Reduce<'a> {
    a: &'a Matrix,
    balanced: bool,
}

impl Work for Reduce<'_> {
    type Output = Result<Decomposition, EigenError>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let n = self.a.rows();
        let stride = stride_of(n);
        let mut h = in_padded_rows(self.a, stride);
        let mut squares = 0.0;
        let scales = if self.balanced { balance::balance(&mut h, n, stride) } else { vec![1.0; n] };
        for value in &h {
            squares += value * value;
        }
        let norm = squares.sqrt();
        if !norm.is_finite() && !self.a.is_finite() {
            return Err(EigenError::NotFinite);
        }
        let reflectors = hessenberg::reduce(&mut h, n, stride);
        let mut work = h.clone();
        let values = francis::eigenvalues(&mut work, n, stride).ok_or(EigenError::NotConverged)?;
        Ok(Decomposition { n, stride, scales, reflectors, hessenberg: h, norm, values })
    }
}

impl Decomposition {
    /// Balances the matrix, reduces it to Hessenberg form and computes its eigenvalues.
    ///
    /// # Errors
    /// [`EigenError`] if an entry is not finite or the iteration does not converge.
    pub fn new(a: &Matrix) -> Result<Self, EigenError> {
        with_fused_multiply_add(Reduce { a, balanced: true })
    }

    /// As [`Decomposition::new`] for a matrix that is known to be balanced.
    ///
    /// # Errors
    /// As [`Decomposition::new`].
    pub fn of_balanced(a: &Matrix) -> Result<Self, EigenError> {
        with_fused_multiply_add(Reduce { a, balanced: false })
    }

    /// All eigenvalues, in the order of deflation; complex pairs are adjacent.
    pub fn values(&self) -> &[Complex64] {
        &self.values
    }

    /// Frobenius norm of the balanced matrix.
    pub fn norm(&self) -> f64 {
        self.norm
    }

    /// n ε ‖A‖: the computed values are exact for a matrix that differs from the balanced one by at most this.
    pub fn backward_error(&self) -> f64 {
        self.n as f64 * f64::EPSILON * self.norm
    }

    /// Eigenvalue `index` with its right and left vector, by inverse iteration.
    pub fn pair(&self, index: usize) -> EigenPair {
        self.pair_from(index, 0)
    }

    /// Every eigenvalue with its vectors, in their order; of two conjugate ones the second has the conjugate vectors, to the bit those of
    /// [`Decomposition::pair`].
    pub fn pairs(&self) -> impl Iterator<Item = EigenPair> {
        let mut room = Shifted::room(self.n, self.stride);
        let mut before: Option<EigenPair> = None;
        self.values.iter().map(move |value| {
            let conjugate =
                before.take().filter(|known| value.im != 0.0 && known.value == value.conj());
            let pair = match conjugate {
                Some(known) => known.conjugate(),
                None => self.pair_in(&mut room, *value, 0),
            };
            before = Some(pair.clone());
            pair
        })
    }

    /// As [`Decomposition::pair`] with another starting vector, which gives another vector for a multiple eigenvalue.
    pub(crate) fn pair_from(&self, index: usize, variant: usize) -> EigenPair {
        let mut room = Shifted::room(self.n, self.stride);
        self.pair_in(&mut room, self.values[index], variant)
    }

    /// The same with room for the factors.
    fn pair_in(&self, room: &mut Shifted, value: Complex64, variant: usize) -> EigenPair {
        let (right, left) = with_fused_multiply_add(Vectors { of: self, room, value, variant });
        let product = product_without_conjugation(&right, &left);
        let size = modulus(product);
        let condition = if size > 0.0 { 1.0 / size } else { f64::INFINITY };
        let right = self.outside(right, |scale| scale, Complex64::new(1.0, 0.0));
        let factor = if size > 0.0 { product.inv() } else { Complex64::new(1.0, 0.0) };
        let left = self.outside(left, f64::recip, factor);
        EigenPair { value, right, left, condition }
    }

    /// The factors of H − σ.
    #[inline(always)]
    pub(crate) fn shifted(&self, shift: Complex64) -> Shifted {
        Shifted::new(&self.hessenberg, self.n, self.stride, self.norm, shift)
    }

    /// Solves (A − σ)x = b for several real b, in O(n²) each; `None` where σ is an eigenvalue up to rounding.
    pub fn solve_shifted(
        &self,
        shift: Complex64,
        columns: &[Vec<f64>],
    ) -> Option<Vec<Vec<Complex64>>> {
        let nearest = self.values.iter().map(|value| modulus(value - shift));
        if nearest.fold(f64::INFINITY, f64::min) <= self.backward_error() {
            return None;
        }
        let reduced = columns.iter().map(|column| {
            let mut inside = Split::zeros(self.stride);
            let entries = column.iter().zip(&self.scales).map(|(entry, scale)| entry / scale);
            inside.re.iter_mut().zip(entries).for_each(|(to, entry)| *to = entry);
            self.reflectors.reduce_vector(&mut inside.re);
            inside
        });
        let solved =
            with_fused_multiply_add(SolvedColumns { of: self, shift, right: reduced.collect() });
        let one = Complex64::new(1.0, 0.0);
        let outside: Vec<Vec<Complex64>> =
            solved.into_iter().map(|x| self.outside(x, |scale| scale, one)).collect();
        outside.iter().flatten().all(|entry| entry.is_finite()).then_some(outside)
    }

    /// Transforms a vector from the reduced coordinates to those of the matrix: Dᵖ Q x.
    fn outside(
        &self,
        mut x: Split,
        scale: impl Fn(f64) -> f64,
        factor: Complex64,
    ) -> Vec<Complex64> {
        self.reflectors.out_of_reduced(&mut x.re);
        self.reflectors.out_of_reduced(&mut x.im);
        (0..self.n)
            .map(|i| Complex64::new(x.re[i], x.im[i]) * factor * scale(self.scales[i]))
            .collect()
    }

    /// Qᵀ x in place, for a matrix that was not balanced.
    pub(crate) fn column_inside(&self, x: &mut [f64]) {
        self.reflectors.reduce_vector(x);
    }

    /// Q x in place, for a matrix that was not balanced.
    pub(crate) fn column_outside(&self, x: &mut [f64]) {
        self.reflectors.out_of_reduced(x);
    }
}

impl EigenPair {
    /// That of the conjugate eigenvalue of a real matrix.
    fn conjugate(&self) -> Self {
        let conjugate = |vector: &[Complex64]| vector.iter().map(Complex64::conj).collect();
        Self {
            value: self.value.conj(),
            right: conjugate(&self.right),
            left: conjugate(&self.left),
            condition: self.condition,
        }
    }
}

struct Vectors<'a> {
    of: &'a Decomposition,
    room: &'a mut Shifted,
    value: Complex64,
    variant: usize,
}

impl Work for Vectors<'_> {
    type Output = (Split, Split);

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { of, room, value, variant } = self;
        room.factor(&of.hessenberg, of.norm, value);
        room.vectors(variant)
    }
}

struct SolvedColumns<'a> {
    of: &'a Decomposition,
    shift: Complex64,
    right: Vec<Split>,
}

impl Work for SolvedColumns<'_> {
    type Output = Vec<Split>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let factors = self.of.shifted(self.shift);
        self.right.into_iter().map(|right| factors.solve(right)).collect()
    }
}

/// Σ xᵢ yᵢ, without conjugation.
#[inline(always)]
pub(crate) fn product_without_conjugation(x: &Split, y: &Split) -> Complex64 {
    let (mut re, mut im) = (0.0, 0.0);
    for i in 0..x.re.len() {
        re += x.re[i] * y.re[i] - x.im[i] * y.im[i];
        im += x.re[i] * y.im[i] + x.im[i] * y.re[i];
    }
    Complex64::new(re, im)
}
