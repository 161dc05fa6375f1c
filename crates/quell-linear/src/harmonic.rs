//! Harmonic response of a sliding system: what an input of one frequency does at every contact.
//!
//! An input û e^{st}, s = iω, moves the structure about steady sliding with friction carried along:
//!
//! ```text
//! q̂ = [s²M + sC + K − Σ_c ((k + s d) μ (t + nσ) nᵀ + T n sᵀ)]⁻¹ (b û + Σ_c (μ(t + nσ) − n) ΔN̂_c)
//! â_c = −s t_cᵀq̂,    N̂_c = (k + s d) n_cᵀq̂ + ΔN̂_c
//! ```
//!
//! C and K with the dampers and springs of the contacts, μ, σ and T those of steady sliding without dither. The slope μ′ is not
//! carried along: averaging over the fast motion accounts for it. A load that guides take (no reaction) enters without −n. An
//! input that multiplies friction enters as (t + nσ) T û. First-order equations have (s − A)x̂ = b û + Σ g_c μ ΔN̂_c.

use num_complex::Complex64;
use quell_model::System;
use quell_model::system::InputTarget;
use quell_numerics::matrix::Matrix;

use crate::linearised::{FrictionSlopes, LinearContact, Linearised};
use crate::steady::entry;

/// What one input does at a contact, for û = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactResponse {
    /// Fast part â of the slip velocity.
    pub slip: Complex64,
    /// Fast part N̂ of the normal load.
    pub load: Complex64,
}

/// The response of the structure to one input of û = 1.
#[derive(Clone, Debug, PartialEq)]
pub struct HarmonicResponse {
    /// q̂, or x̂ of first-order equations.
    pub displacement: Vec<Complex64>,
    /// What reaches each contact.
    pub contacts: Vec<ContactResponse>,
}

/// The response to an input at the angular frequency ω; `None` at an undamped resonance.
pub fn response(
    system: &System,
    linear: &Linearised,
    target: &InputTarget,
    frequency: f64,
) -> Option<HarmonicResponse> {
    let n = linear.coordinates();
    let s = Complex64::new(0.0, frequency);
    let (dynamic, rate) = dynamic_stiffness(linear, frequency);
    let force: Vec<f64> = (0..n).map(|i| force_on(system, linear, target, i)).collect();
    let displacement = solve(&dynamic, &force)?;
    let along = |row: Option<&[f64]>| {
        let row = row.unwrap_or_default();
        row.iter().zip(&displacement).map(|(r, q)| q * *r).sum::<Complex64>()
    };
    let contacts = linear.contacts().iter().enumerate().map(|(index, contact)| {
        let (stiffness, damping) = contact.normal_spring();
        let direct = own_load(target, index);
        ContactResponse {
            slip: -rate * along(contact.tangent()),
            load: (s * damping + stiffness) * along(contact.normal()) + direct,
        }
    });
    let contacts = contacts.collect();
    Some(HarmonicResponse { displacement, contacts })
}

/// The equations of the sliding structure under one input, ẋ = A x + b u, friction carried along as in [`response`].
#[derive(Clone, Debug)]
pub struct DrivenEquations {
    /// A.
    pub matrix: Matrix,
    /// b.
    pub source: Vec<f64>,
    /// Number of coordinates; those of a mechanical structure come before their velocities.
    coordinates: usize,
}

impl DrivenEquations {
    /// For one input; `None` where the mass is singular.
    pub fn new(system: &System, linear: &Linearised, target: &InputTarget) -> Option<Self> {
        let n = linear.coordinates();
        let force = Matrix::from_fn(n, 1, |i, _| force_on(system, linear, target, i));
        let moved = match linear.matrices() {
            Some(matrices) => matrices.mass.solve(&force)?,
            None => force,
        };
        let frozen: Vec<FrictionSlopes> = linear
            .friction()
            .into_iter()
            .map(|friction| FrictionSlopes { by_velocity: 0.0, ..friction.at_once() })
            .collect();
        let matrix = linear.state_matrix_with(&frozen);
        let mut source = vec![0.0; matrix.rows() - n];
        source.extend(moved.as_slice());
        Some(Self { matrix, source, coordinates: n })
    }

    /// A row over the displacements (0) or the velocities (1) as a row over the state; first-order equations have the first only.
    pub fn over_state(&self, row: &[f64], order: usize) -> Vec<f64> {
        let mut whole = vec![0.0; self.matrix.rows()];
        let from = (order * self.coordinates).min(whole.len() - self.coordinates);
        whole[from..from + row.len()].copy_from_slice(row);
        whole
    }

    /// The rate of a row over the state, as a row over the state and the factor of the wave.
    pub(crate) fn rate_of(&self, row: &[f64]) -> (Vec<f64>, f64) {
        let states = self.matrix.rows();
        let along = |j: usize| (0..states).map(|i| row[i] * self.matrix[(i, j)]).sum();
        let direct = row.iter().zip(&self.source).map(|(row, b)| row * b).sum();
        ((0..states).map(along).collect(), direct)
    }

    /// The row of the slip velocity of a contact.
    pub fn slip_row(&self, contact: &LinearContact) -> Vec<f64> {
        let negative: Vec<f64> =
            contact.tangent().unwrap_or_default().iter().map(|entry| -entry).collect();
        self.over_state(&negative, 1)
    }

    /// The row of the load that the structure puts on a contact.
    pub fn load_row(&self, contact: &LinearContact) -> Vec<f64> {
        let (stiffness, damping) = contact.normal_spring();
        let normal = contact.normal().unwrap_or_default();
        let [mut row, velocity] = [0, 1].map(|order| self.over_state(normal, order));
        for (entry, rate) in row.iter_mut().zip(&velocity) {
            *entry = stiffness.mul_add(*entry, damping * rate);
        }
        row
    }
}

/// The dynamic stiffness with friction inside, and the factor that turns a displacement into a velocity of slip.
fn dynamic_stiffness(linear: &Linearised, frequency: f64) -> (ComplexMatrix, Complex64) {
    let s = Complex64::new(0.0, frequency);
    let Some(matrices) = linear.matrices() else {
        let matrix = linear.state_matrix_with(&[]);
        let at = |i: usize, j: usize| {
            let diagonal = if i == j { s } else { Complex64::ZERO };
            diagonal - matrix[(i, j)]
        };
        return (ComplexMatrix::from_fn(linear.coordinates(), at), Complex64::ONE);
    };
    let square = -frequency * frequency;
    let mut dynamic = ComplexMatrix::from_fn(linear.coordinates(), |i, j| {
        let elastic = square.mul_add(matrices.mass[(i, j)], matrices.stiffness[(i, j)]);
        Complex64::new(elastic, frequency * matrices.damping[(i, j)])
    });
    for contact in linear.contacts() {
        let (stiffness, damping) = contact.normal_spring();
        let spring = (s * damping + stiffness) * coefficient(contact);
        let friction = contact.steady.factor * contact.steady.friction;
        dynamic.subtract(spring, |i| along(contact, i), contact.normal());
        let across = |i| entry(contact.normal(), i);
        dynamic.subtract(Complex64::new(friction, 0.0), across, contact.slope_row());
    }
    (dynamic, s)
}

/// What a unit of an input adds to the load of a contact directly.
pub(crate) fn own_load(target: &InputTarget, index: usize) -> f64 {
    match target {
        InputTarget::NormalLoad { contact, .. } if *contact == index => 1.0,
        _ => 0.0,
    }
}

/// Entry i of the force of an input with û = 1.
pub(crate) fn force_on(
    system: &System,
    linear: &Linearised,
    target: &InputTarget,
    i: usize,
) -> f64 {
    let contact = |index: usize| linear.contacts().get(index);
    match target {
        InputTarget::Force(row) => row[i],
        InputTarget::NormalLoad { contact: index, reaction } => contact(*index).map_or(0.0, |at| {
            let own = system.contacts[*index].force.as_deref();
            let pushed = if *reaction { entry(at.normal(), i) } else { 0.0 };
            coefficient(at) * own.map_or_else(|| along(at, i), |column| column[i]) - pushed
        }),
        InputTarget::Friction { contact: index } => contact(*index).map_or(0.0, |at| {
            let own = system.contacts[*index].force.as_deref();
            at.steady.friction * own.map_or_else(|| along(at, i), |column| column[i])
        }),
    }
}

/// μ of steady sliding, with the mean of its factor.
fn coefficient(contact: &LinearContact) -> f64 {
    contact.steady.factor * contact.steady.line.coefficient
}

/// Entry i of t + nσ.
fn along(contact: &LinearContact, i: usize) -> f64 {
    entry(contact.tangent(), i) + entry(contact.normal(), i) * contact.steady.tilt
}

/// A square complex matrix, solved as a real one of twice the size.
struct ComplexMatrix {
    size: usize,
    values: Vec<Complex64>,
}

impl ComplexMatrix {
    fn from_fn(size: usize, at: impl Fn(usize, usize) -> Complex64) -> Self {
        let values = (0..size * size).map(|index| at(index / size, index % size)).collect();
        Self { size, values }
    }

    /// Subtracts factor·column·rowᵀ.
    fn subtract(&mut self, factor: Complex64, column: impl Fn(usize) -> f64, row: Option<&[f64]>) {
        let Some(row) = row else { return };
        for i in 0..self.size {
            let scale = factor * column(i);
            for (value, entry) in self.values[i * self.size..].iter_mut().zip(row) {
                *value -= scale * *entry;
            }
        }
    }
}

fn solve(matrix: &ComplexMatrix, right: &[f64]) -> Option<Vec<Complex64>> {
    let n = matrix.size;
    let at = |i: usize, j: usize| {
        let value = matrix.values[(i % n) * n + j % n];
        match (i < n, j < n) {
            (true, true) | (false, false) => value.re,
            (true, false) => -value.im,
            (false, true) => value.im,
        }
    };
    let right = Matrix::from_fn(2 * n, 1, |i, _| if i < n { right[i] } else { 0.0 });
    let solved = Matrix::from_fn(2 * n, 2 * n, at).solve(&right)?;
    let values = solved.as_slice();
    let finite = solved.is_finite();
    finite.then(|| (0..n).map(|i| Complex64::new(values[i], values[n + i])).collect())
}
