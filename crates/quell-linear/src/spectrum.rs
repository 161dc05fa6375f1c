//! Every small motion about steady sliding: eigenvalue with its bound, shape, and the work that friction does in it.
//!
//! The work is that of the mean power of friction over a period, as a share of the growth rate. With E the mean energy of a
//! motion q̂ e^{λt} and P_c the mean power of the fluctuating friction force at contact c,
//!
//! ```text
//! Re λ = (Σ_c P_c + P_damping + P_circulatory)/(2E),    E = ¼(v̂ᴴMv̂ + q̂ᴴK_s q̂),    v̂ = λq̂
//! P_c = ½ Re[ ((t + nσ)ᵀv̂)* (−T_γ tᵀv̂ + T_N (k nᵀq̂ + d nᵀv̂)) + (nᵀv̂)* T sᵀq̂ ]
//! ```
//!
//! K_s is the symmetric part of K with the springs of the contacts, and T_γ of bristles is complex. The identity is exact, for real
//! eigenvalues too.

use num_complex::Complex64;
use quell_numerics::eigen::{Decomposition, EigenError};
use quell_numerics::matrix::Matrix;
use quell_numerics::order::descending_by;

use crate::growth::Growth;
use crate::linearised::{FrictionSlopes, LinearContact, Linearised, Matrices};

/// One small motion e^{λt}.
#[derive(Clone, Debug, PartialEq)]
pub struct SmallMotion {
    /// λ.
    pub eigenvalue: Complex64,
    /// Bound on the error of λ.
    pub error: f64,
    /// Shape over the coordinates or states, scaled so that its largest entry is 1.
    pub shape: Vec<Complex64>,
    /// Share of Re λ that the friction of each contact does work for; empty for first-order equations, whose energy is not
    /// known, and for a motion without energy.
    pub friction_shares: Vec<f64>,
}

impl SmallMotion {
    /// |Im λ|.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.im.abs()
    }

    /// −Re λ/|λ|; 0 for Re λ = 0, never −0.
    pub fn damping_ratio(&self) -> f64 {
        let size = quell_numerics::polar::modulus(self.eigenvalue);
        if size > 0.0 { 0.0 - self.eigenvalue.re / size } else { 0.0 }
    }
}

/// Every small motion, the fastest growing first.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionSpectrum {
    /// Largest growth rate with its bound.
    pub growth: Growth,
    /// One motion for each eigenvalue, complex conjugates included: those that may lead by their errors from the fastest on, then the others by
    /// falling growth rate.
    pub motions: Vec<SmallMotion>,
}

/// Every small motion under a given friction of each contact.
///
/// # Errors
/// [`EigenError`] where the matrix overflows.
pub fn spectrum(
    linear: &Linearised,
    friction: &[FrictionSlopes],
) -> Result<MotionSpectrum, EigenError> {
    let matrix = linear.state_matrix_with(friction);
    let decomposition = Decomposition::new(&matrix)?;
    let growth = growth_of(&decomposition)?;
    let mut motions: Vec<SmallMotion> = decomposition
        .pairs()
        .map(|pair| {
            let error = decomposition.error_of(&pair);
            let n = linear.coordinates();
            let friction_shares = match linear.matrices() {
                Some(matrices) => shares(linear, matrices, friction, &pair.right[..n], pair.value),
                None => Vec::new(),
            };
            let shape = scaled(&pair.right[..n]);
            SmallMotion { eigenvalue: pair.value, error, shape, friction_shares }
        })
        .collect();
    motions.sort_by(|a, b| {
        let (a, b) = (a.eigenvalue, b.eigenvalue);
        b.re.total_cmp(&a.re).then(a.im.abs().total_cmp(&b.im.abs())).then(b.im.total_cmp(&a.im))
    });
    // Of those that may lead by their errors the fastest does, as in `growth`: rounding chooses nowhere.
    let largest = motions.first().map_or(f64::NEG_INFINITY, |motion| motion.eigenvalue.re);
    let (mut leaders, others): (Vec<_>, Vec<_>) = motions
        .into_iter()
        .partition(|motion: &SmallMotion| motion.eigenvalue.re + motion.error >= largest);
    descending_by(&mut leaders, |motion| motion.eigenvalue.im.abs());
    leaders.extend(others);
    Ok(MotionSpectrum { growth, motions: leaders })
}

/// Largest growth rate under a given friction of each contact.
///
/// # Errors
/// As [`spectrum`].
pub fn growth(linear: &Linearised, friction: &[FrictionSlopes]) -> Result<Growth, EigenError> {
    growth_of(&Decomposition::new(&linear.state_matrix_with(friction))?)
}

/// Largest growth rate; the bound includes the rounding of the assembly of the matrix.
pub(crate) fn growth_of(decomposition: &Decomposition) -> Result<Growth, EigenError> {
    let rightmost = decomposition.rightmost().ok_or(EigenError::NotConverged)?;
    Ok(Growth {
        rate: rightmost.value.re,
        error: rightmost.error + 4.0 * f64::EPSILON * decomposition.norm(),
        frequency: rightmost.value.im,
    })
}

/// The shape with its largest entry turned to 1; unchanged if it vanishes.
fn scaled(shape: &[Complex64]) -> Vec<Complex64> {
    let size = |z: &Complex64| quell_numerics::polar::modulus(*z);
    let largest = shape.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
    match largest {
        Some(largest) if size(largest) > 0.0 => shape.iter().map(|z| z / largest).collect(),
        _ => shape.to_vec(),
    }
}

fn shares(
    linear: &Linearised,
    matrices: Matrices<'_>,
    friction: &[FrictionSlopes],
    displacement: &[Complex64],
    eigenvalue: Complex64,
) -> Vec<f64> {
    let velocity: Vec<Complex64> = displacement.iter().map(|q| q * eigenvalue).collect();
    let energy = 0.25 * (form(matrices.mass, &velocity) + form(matrices.stiffness, displacement));
    if energy == 0.0 || !energy.is_finite() {
        return Vec::new();
    }
    let contacts = linear.contacts().iter().zip(friction);
    let power = contacts.map(|(contact, friction)| {
        power(contact, friction, eigenvalue, [displacement, &velocity]) / (2.0 * energy)
    });
    power.collect()
}

/// Mean power of the fluctuating friction force of a contact.
fn power(
    contact: &LinearContact,
    friction: &FrictionSlopes,
    eigenvalue: Complex64,
    [displacement, velocity]: [&[Complex64]; 2],
) -> f64 {
    let along = |row: Option<&[f64]>, x: &[Complex64]| -> Complex64 {
        row.unwrap_or_default().iter().zip(x).map(|(r, x)| x * *r).sum()
    };
    let (stiffness, damping) = contact.normal_spring();
    let sliding = along(contact.tangent(), velocity);
    let approach = along(contact.normal(), displacement);
    let rate = along(contact.normal(), velocity);
    let force = (approach * stiffness + rate * damping) * friction.by_load
        - sliding * friction.by_velocity_of(eigenvalue);
    let turned = along(contact.slope_row(), displacement) * friction.force;
    let at = sliding + rate * contact.steady.tilt;
    0.5 * (at.conj() * force + rate.conj() * turned).re
}

/// xᴴAx of the symmetric part of A.
fn form(matrix: &Matrix, x: &[Complex64]) -> f64 {
    let n = x.len();
    (0..n)
        .map(|i| {
            let row: Complex64 = matrix.row(i).iter().zip(x).map(|(a, x)| x * *a).sum();
            (x[i].conj() * row).re
        })
        .sum()
}
