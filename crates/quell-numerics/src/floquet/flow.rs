//! The exact solution of the constant part of a periodic system: x′ = A₀x in modal coordinates.
//!
//! A₀ is diagonalised once; a pair λ = σ ± iω has two real coordinates (Re z, Im z), a real eigenvalue has one, and only
//! the products of the modes with U and V are stored. Each mode is scaled so that its row of U and its column of V have
//! the same size, which balances the monodromy matrix. If A₀ is defective or nearly so (a mode with a
//! condition number above [`CONDITION`]), the original coordinates are used and e^{A₀t} is a dense matrix, which is correct
//! but much slower.

use num_complex::Complex64;

use crate::eigen::{Decomposition, EigenError, EigenPair};
use crate::matrix::Matrix;

/// Largest condition number for modal coordinates: above it they would lose more than three digits.
const CONDITION: f64 = 1e3;

/// Eigenvalues closer than this, relative to ‖A₀‖, form one group.
const NEARLY_EQUAL: f64 = 1e-7;

/// VᵀU counts as zero below this fraction of ‖U‖‖V‖: it is either zero by structure or clearly nonzero.
const NILPOTENT: f64 = 1e-14;

/// Coordinates in which the constant flow is applied.
#[derive(Clone, Debug)]
pub(super) enum Coordinates {
    /// One entry for each block: a complex pair (ω > 0) with two coordinates, or a real eigenvalue (ω = 0) with one.
    Modal(Vec<Complex64>),
    /// A₀ itself.
    Dense(Matrix),
}

/// A₀, U and V of x′ = A₀x + U Φ(t) Vᵀ x, applicable to any Φ.
#[derive(Clone, Debug)]
pub struct ConstantFlow {
    pub(super) size: usize,
    pub(super) rank: usize,
    pub(super) coordinates: Coordinates,
    /// U, and Vᵀ, in these coordinates.
    pub(super) u: Matrix,
    pub(super) v: Matrix,
    /// A₀U and VᵀA₀ in these coordinates.
    pub(super) au: Matrix,
    pub(super) va: Matrix,
    /// VᵀU and VᵀA₀U.
    pub(super) vu: Matrix,
    pub(super) vau: Matrix,
    /// Whether VᵀU = 0: then a kick does not change Vᵀx.
    pub(super) nilpotent: bool,
    /// Largest |λ| and largest |Re λ|.
    pub(super) fastest: f64,
    pub(super) strongest: f64,
    /// ε‖A₀‖ times the largest condition number: the effect of rounding on the eigenvalues of A₀.
    pub(super) rounding: f64,
}

impl ConstantFlow {
    /// From A₀ (n × n), U and V (n × r).
    ///
    /// # Errors
    /// [`EigenError`] for entries that are not finite.
    ///
    /// # Panics
    /// If the sizes do not match.
    pub fn new(a: &Matrix, u: &Matrix, v: &Matrix) -> Result<Self, EigenError> {
        assert!(
            u.rows() == a.rows() && v.rows() == a.rows() && u.columns() == v.columns(),
            "sizes"
        );
        if u.columns() == 0 {
            // Without kicks, a kick with no effect is used.
            let nothing = Matrix::zeros(a.rows(), 1);
            return Self::new(a, &nothing, &nothing);
        }
        let decomposition = Decomposition::new(a)?;
        let vt = v.transpose();
        let (au, va) = (a.times(u), vt.times(a));
        let (vu, vau) = (vt.times(u), vt.times(&au));
        let nilpotent = vu.largest() <= NILPOTENT * u.frobenius_norm() * v.frobenius_norm();
        let values = decomposition.values();
        let mut flow = Self {
            size: a.rows(),
            rank: u.columns(),
            coordinates: Coordinates::Modal(Vec::new()),
            u: u.clone(),
            v: vt,
            au,
            va,
            vu,
            vau,
            nilpotent,
            fastest: values.iter().fold(0.0, |most, z| crate::polar::modulus(*z).max(most)),
            strongest: values.iter().fold(0.0, |most, z| z.re.abs().max(most)),
            rounding: f64::EPSILON * decomposition.norm(),
        };
        let pairs = modes(&decomposition);
        let worst = pairs.iter().fold(1.0, |worst: f64, pair| worst.max(pair.condition));
        flow.rounding *= worst;
        if worst <= CONDITION {
            flow.make_modal(&pairs);
        } else {
            flow.coordinates = Coordinates::Dense(a.clone());
        }
        Ok(flow)
    }

    /// Whether kicks are nilpotent (VᵀU = 0), so that the exponents of the splitting are fourth-order accurate.
    pub fn is_nilpotent(&self) -> bool {
        self.nilpotent
    }

    fn make_modal(&mut self, pairs: &[EigenPair]) {
        let (n, r) = (self.size, self.rank);
        let (mut u, mut v) = (Matrix::zeros(n, r), Matrix::zeros(r, n));
        let (mut au, mut va) = (Matrix::zeros(n, r), Matrix::zeros(r, n));
        let mut at = 0;
        for pair in pairs {
            let real = pair.value.im == 0.0;
            let along = |side: &[Complex64], c: usize, of: &dyn Fn(usize, usize) -> f64| {
                side.iter().enumerate().map(|(i, z)| z * of(i, c)).sum::<Complex64>()
            };
            let mut b: Vec<Complex64> =
                (0..r).map(|c| along(&pair.left, c, &|i, c| self.u[(i, c)])).collect();
            let mut c: Vec<Complex64> =
                (0..r).map(|c| along(&pair.right, c, &|i, c| self.v[(c, i)])).collect();
            let size =
                |side: &[Complex64]| side.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
            let (in_size, out_size) = (size(&b), size(&c));
            let scale = if in_size > 0.0 && out_size > 0.0 {
                (in_size / (2.0 * out_size)).sqrt()
            } else {
                1.0
            };
            for value in &mut b {
                *value /= scale;
            }
            for value in &mut c {
                *value *= scale;
            }
            for k in 0..r {
                if real {
                    u[(at, k)] = b[k].re;
                    v[(k, at)] = c[k].re;
                    au[(at, k)] = pair.value.re * b[k].re;
                    va[(k, at)] = pair.value.re * c[k].re;
                } else {
                    let (ab, ca) = (pair.value * b[k], pair.value * c[k]);
                    u[(at, k)] = b[k].re;
                    u[(at + 1, k)] = b[k].im;
                    au[(at, k)] = ab.re;
                    au[(at + 1, k)] = ab.im;
                    v[(k, at)] = 2.0 * c[k].re;
                    v[(k, at + 1)] = -2.0 * c[k].im;
                    va[(k, at)] = 2.0 * ca.re;
                    va[(k, at + 1)] = -2.0 * ca.im;
                }
            }
            at += if real { 1 } else { 2 };
        }
        self.coordinates = Coordinates::Modal(pairs.iter().map(|pair| pair.value).collect());
        (self.u, self.v, self.au, self.va) = (u, v, au, va);
    }
}

/// The modes of A₀ with Im λ ≥ 0. Left and right vectors are biorthonormal even for equal eigenvalues: within a group of
/// equal eigenvalues the inverse iterations start from different vectors, and Y ← (YᵀX)⁻¹Y makes the vectors dual.
fn modes(decomposition: &Decomposition) -> Vec<EigenPair> {
    let values = decomposition.values();
    let mut open: Vec<usize> = (0..values.len()).filter(|&i| values[i].im >= 0.0).collect();
    let near = NEARLY_EQUAL * decomposition.norm();
    let mut modes = Vec::with_capacity(open.len());
    while let Some(&first) = open.first() {
        let close = |i: usize| crate::polar::modulus(values[i] - values[first]) <= near;
        let group: Vec<usize> = open.iter().copied().filter(|&i| close(i)).collect();
        open.retain(|&i| !close(i));
        let mut pairs: Vec<EigenPair> = group
            .iter()
            .enumerate()
            .map(|(variant, &i)| decomposition.pair_from(i, variant))
            .collect();
        if pairs.len() > 1 {
            make_dual(&mut pairs);
        }
        modes.extend(pairs);
    }
    modes
}

/// Y ← (YᵀX)⁻¹Y by elimination with pivoting; recomputes the condition numbers, infinite if the vectors are linearly dependent.
fn make_dual(pairs: &mut [EigenPair]) {
    let k = pairs.len();
    let product =
        |x: &[Complex64], y: &[Complex64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<Complex64>();
    let mut gram: Vec<Vec<Complex64>> = (0..k)
        .map(|i| (0..k).map(|j| product(&pairs[i].left, &pairs[j].right)).collect())
        .collect();
    let mut left: Vec<Vec<Complex64>> = pairs.iter().map(|pair| pair.left.clone()).collect();
    for c in 0..k {
        let size = |row: &Vec<Complex64>| row[c].norm_sqr();
        let pivot = (c..k).max_by(|&i, &j| size(&gram[i]).total_cmp(&size(&gram[j]))).unwrap_or(c);
        gram.swap(c, pivot);
        left.swap(c, pivot);
        let inverse = gram[c][c].inv();
        for z in gram[c].iter_mut().chain(&mut left[c]) {
            *z *= inverse;
        }
        let (row, dual) = (gram[c].clone(), left[c].clone());
        for i in (0..k).filter(|&i| i != c) {
            let factor = gram[i][c];
            for (z, from) in gram[i].iter_mut().zip(&row) {
                *z -= factor * from;
            }
            for (z, from) in left[i].iter_mut().zip(&dual) {
                *z -= factor * from;
            }
        }
    }
    let length = |x: &[Complex64]| x.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
    for (pair, left) in pairs.iter_mut().zip(left) {
        let condition = length(&pair.right) * length(&left);
        pair.condition = if condition.is_finite() { condition } else { f64::INFINITY };
        pair.left = left;
    }
}
