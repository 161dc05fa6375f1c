//! Coefficients of normal forms at a Hopf, a Neimark–Sacker and a flip bifurcation.
//!
//! Where a pair of eigenvalues crosses the stability limit, the linear part of the equations decides nothing, and the second and
//! third derivatives decide. With A the first derivative, B(u, v) and C(u, v, w) the second and third ones as symmetric forms, q
//! the eigenvector of the critical eigenvalue, p its left vector and ⟨p, q⟩ = 1:
//!
//! ```text
//! Hopf            A q = iωq     l₁ = Re[⟨p, C(q, q, q̄)⟩ − 2⟨p, B(q, A⁻¹B(q, q̄))⟩ + ⟨p, B(q̄, (2iω − A)⁻¹B(q, q))⟩]/(2ω)
//! Neimark–Sacker  A q = e^{iθ}q  a = ½Re{e^{−iθ}[⟨p, C(q, q, q̄)⟩ + 2⟨p, B(q, (1 − A)⁻¹B(q, q̄))⟩
//!                                              + ⟨p, B(q̄, (e^{2iθ} − A)⁻¹B(q, q))⟩]}
//! flip            A q = −q       f = −⟨p, C(q, q, q)⟩/6 − ½⟨p, B(q, (1 − A)⁻¹B(q, q))⟩
//! ```
//!
//! (Kuznetsov, *Elements of Applied Bifurcation Theory*, 3rd ed. 2004, sec. 5.4; l₁ is his eq. 5.39, and f is −c of his flip, so
//! that the three signs agree.) With x = 2 Re(z q) to first order, or x = z q for the flip, the amplitude |z| obeys
//!
//! ```text
//! d|z|/dt = Re λ |z| + ω l₁ |z|³,    |z| → |λ||z| + a|z|³,    |z| → |λ||z| + f|z|³
//! ```
//!
//! A coefficient below zero means a supercritical bifurcation: beyond the threshold the vibration is stable, and its amplitude
//! starts at zero. Above zero it is subcritical: an unstable vibration exists before the threshold, and beyond it the motion jumps.
//!
//! The numbers scale with |q|⁻²: the caller chooses the norm of q, and the signs do not depend on it.

use num_complex::Complex64;

use crate::eigen::EigenPair;
use crate::matrix::Matrix;
use crate::polar::modulus;

/// The second and third derivatives along a critical vector q.
pub trait DerivativesAlong {
    /// B(q, v) for any vector v.
    fn quadratic(&self, v: &[Complex64]) -> Vec<Complex64>;

    /// C(q, q, q̄).
    fn cubic(&self) -> Vec<Complex64>;
}

/// A coefficient and the size of the terms from which it is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FormCoefficient {
    /// The coefficient.
    pub value: f64,
    /// Bound on its rounding: the sizes of its terms, each with the conditions of what it is computed from, times ε.
    pub rounding: f64,
}

/// A critical eigenvalue with its vectors, ⟨p, q⟩ = 1.
#[derive(Clone, Debug)]
pub struct CriticalPair {
    /// The eigenvalue.
    pub value: Complex64,
    /// q.
    pub right: Vec<Complex64>,
    /// p̄: ⟨p, x⟩ is its product with x without conjugation.
    pub left: Vec<Complex64>,
    /// Condition number of the eigenvalue.
    pub condition: f64,
}

impl CriticalPair {
    /// The pair with a vector q whose first `leading` numbers have the Euclidean norm 1. `None` if they vanish, or if the
    /// eigenvalue is defective.
    pub fn new(pair: &EigenPair, leading: usize) -> Option<Self> {
        let squares: f64 = pair.right.iter().take(leading).map(Complex64::norm_sqr).sum();
        let length = libm::sqrt(squares);
        let largest = pair.right.iter().fold(0.0, |m: f64, z| m.max(modulus(*z)));
        let vanishes = length.is_nan() || length <= 1e-12 * largest;
        if vanishes || !pair.condition.is_finite() {
            return None;
        }
        let right: Vec<Complex64> = pair.right.iter().map(|z| z / length).collect();
        let product = times(&pair.left, &right);
        let left = pair.left.iter().map(|z| z / product).collect();
        Some(Self { value: pair.value, right, left, condition: pair.condition })
    }
}

/// ω l₁ of the pair iω of a matrix: the coefficient of |z|³ in d|z|/dt. `None` where the matrix, or 2iω − A, is singular.
pub fn hopf(
    matrix: &Matrix,
    pair: &CriticalPair,
    forms: &impl DerivativesAlong,
) -> Option<FormCoefficient> {
    let turn = Complex64::new(0.0, pair.value.im);
    let shifts = [Complex64::new(0.0, 0.0), 2.0 * turn];
    coefficient(matrix, pair, forms, shifts, Complex64::new(1.0, 0.0))
}

/// a of the pair e^{iθ} of the derivative of a map. `None` where 1 − A, or e^{2iθ} − A, is singular.
pub fn neimark_sacker(
    matrix: &Matrix,
    pair: &CriticalPair,
    forms: &impl DerivativesAlong,
) -> Option<FormCoefficient> {
    let turn = pair.value / modulus(pair.value);
    coefficient(matrix, pair, forms, [Complex64::new(1.0, 0.0), turn * turn], turn.conj())
}

/// f of the multiplier −1 of the derivative of a map. `None` where 1 − A is singular.
pub fn flip(
    matrix: &Matrix,
    pair: &CriticalPair,
    forms: &impl DerivativesAlong,
) -> Option<FormCoefficient> {
    let square = forms.quadratic(&pair.right);
    let bent = Resolved::new(matrix, Complex64::new(1.0, 0.0), &square)?;
    let by_bent = forms.quadratic(&bent.vector);
    let cubic = Resolved::plain(forms.cubic());
    let terms = [
        (-cubic.along(pair) / 6.0, cubic.size(pair) / 6.0),
        (-0.5 * times(&pair.left, &by_bent), 0.5 * bent.condition * size(&pair.left, &by_bent)),
    ];
    Some(gathered(&terms, pair))
}

/// ½Re{f[⟨p, C(q, q, q̄)⟩ + 2⟨p, B(q, (s₀ − A)⁻¹B(q, q̄))⟩ + ⟨p, B(q̄, (s₂ − A)⁻¹B(q, q))⟩]} with a factor f of modulus 1.
fn coefficient(
    matrix: &Matrix,
    pair: &CriticalPair,
    forms: &impl DerivativesAlong,
    shifts: [Complex64; 2],
    factor: Complex64,
) -> Option<FormCoefficient> {
    let steady = forms.quadratic(&conjugate(&pair.right));
    let double = forms.quadratic(&pair.right);
    let steady = Resolved::new(matrix, shifts[0], &steady)?;
    let double = Resolved::new(matrix, shifts[1], &double)?;
    let cubic = Resolved::plain(forms.cubic());
    // B(q̄, v) is the conjugate of B(q, v̄).
    let by_steady = forms.quadratic(&steady.vector);
    let by_double = conjugate(&forms.quadratic(&conjugate(&double.vector)));
    let terms = [
        (0.5 * factor * cubic.along(pair), 0.5 * cubic.size(pair)),
        (factor * times(&pair.left, &by_steady), steady.condition * size(&pair.left, &by_steady)),
        (
            0.5 * factor * times(&pair.left, &by_double),
            0.5 * double.condition * size(&pair.left, &by_double),
        ),
    ];
    Some(gathered(&terms, pair))
}

fn gathered(terms: &[(Complex64, f64)], pair: &CriticalPair) -> FormCoefficient {
    let value = terms.iter().map(|(value, _)| value.re).sum();
    let sizes: f64 = terms.iter().map(|(_, size)| size).sum();
    let count = pair.right.len() as f64;
    FormCoefficient { value, rounding: count * f64::EPSILON * pair.condition * sizes }
}

/// A solution of (s − A) x = b.
struct Resolved {
    vector: Vec<Complex64>,
    /// ‖x‖‖s − A‖/‖b‖: how much relative errors of A may grow in x. 1 where nothing was solved.
    condition: f64,
}

impl Resolved {
    fn plain(vector: Vec<Complex64>) -> Self {
        Self { vector, condition: 1.0 }
    }

    /// By a real system of twice the size.
    fn new(matrix: &Matrix, shift: Complex64, right: &[Complex64]) -> Option<Self> {
        let n = matrix.rows();
        if right.iter().all(|z| *z == Complex64::new(0.0, 0.0)) {
            return Some(Self::plain(right.to_vec()));
        }
        let doubled = Matrix::from_fn(2 * n, 2 * n, |i, j| {
            let unit = if i % n == j % n { 1.0 } else { 0.0 };
            match (i < n, j < n) {
                (true, true) | (false, false) => unit * shift.re - matrix[(i % n, j % n)],
                (true, false) => -unit * shift.im,
                (false, true) => unit * shift.im,
            }
        });
        let parts = |i: usize| if i < n { right[i].re } else { right[i - n].im };
        let solved = doubled.solve(&Matrix::from_fn(2 * n, 1, |i, _| parts(i)))?;
        if !solved.is_finite() {
            return None;
        }
        let values = solved.as_slice();
        let vector = (0..n).map(|i| Complex64::new(values[i], values[n + i])).collect();
        let length: f64 = right.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        let condition = solved.frobenius_norm() * doubled.frobenius_norm() / length;
        Some(Self { vector, condition: condition.max(1.0) })
    }

    fn along(&self, pair: &CriticalPair) -> Complex64 {
        times(&pair.left, &self.vector)
    }

    fn size(&self, pair: &CriticalPair) -> f64 {
        self.condition * size(&pair.left, &self.vector)
    }
}

/// Σ aᵢbᵢ, without conjugation.
fn times(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Σ |aᵢ||bᵢ|.
fn size(a: &[Complex64], b: &[Complex64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| modulus(*a) * modulus(*b)).sum()
}

/// The conjugate of every entry.
pub fn conjugate(vector: &[Complex64]) -> Vec<Complex64> {
    vector.iter().map(Complex64::conj).collect()
}
