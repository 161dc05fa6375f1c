//! Friction of the contacts that stick: the forces for which their slip velocities stay zero.
//!
//! γ̇ = w − G T = 0 with G_cd = t_cᵀ(g_d + h_d σ_d). Where the rows of some are dependent (two pads on one rigid body) the forces are
//! not unique, but the motion is: the least-norm forces within the bounds. With the rows t_F = R t_B of the free contacts over
//! an independent subset B of them these are T = R (RᵀR)⁻¹ G_BB⁻¹ w_B; a contact that reaches its bound stays there (saturated),
//! while the others carry the rest.

use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::matrix::Matrix;

use super::contact_equation::ContactEquation;
use super::contact_series::ContactSeries;
use super::equations::MotionEquations;
use super::few::Few;
use super::phase::ContactNow;
use super::rows::StateStorage;

/// A row is dependent on others if they carry all but this share of it: the rounding of a Schur complement of rows whose condition
/// is up to 10⁵. Rows that differ by less share their forces by least norm, and the motion changes by as little.
pub(super) const DEPENDENT: f64 = 1e-10;

/// Forces of the sticking contacts that are not saturated.
#[derive(Clone, Debug, Default)]
pub(super) struct StuckForces {
    /// The contacts, in order.
    free: Few<usize>,
    /// Those with independent rows, whose conditions are used.
    independent: Few<usize>,
    /// T of the free contacts per w of the independent ones, row by row.
    gain: Few<f64>,
    /// σ of the free contacts at the moment for which the gain holds.
    tilts: Few<f64>,
    /// Whether the rows of the sticking contacts, saturated ones included, are dependent.
    pub(super) is_dependent: bool,
}

/// Forces of the sticking contacts that are not saturated.
#[derive(Clone, Copy, Debug)]
pub(super) struct HoldingForces<'a> {
    /// The contacts that are free, in order.
    pub(super) free: &'a [usize],
    /// Those with independent rows.
    pub(super) independent: &'a [usize],
    /// T of the free contacts per w of the independent ones, row by row.
    pub(super) gain: &'a [f64],
    /// σ of the free contacts.
    pub(super) tilts: &'a [f64],
}

impl HoldingForces<'_> {
    /// Adds the friction of order k that holds the contacts to the rates.
    #[inline(always)]
    pub(super) fn hold<S: StateStorage>(
        &self,
        storage: S,
        equations: &[ContactEquation],
        k: usize,
        contacts: &mut [ContactSeries],
        rates: &mut [f64],
    ) {
        // The conditions of all are read before any force is added: force by force into the series of this order.
        for &index in self.independent {
            let along = storage.dot(&equations[index].tangent, rates);
            contacts[index].lost = contacts[index].lost_slip(k, along);
        }
        let count = self.independent.len();
        for (place, &held) in self.free.iter().enumerate() {
            let mut force = 0.0;
            let gains = &self.gain[place * count..(place + 1) * count];
            for (&index, gain) in self.independent.iter().zip(gains) {
                force = f64::mul_add(*gain, contacts[index].lost, force);
            }
            contacts[held].friction[k] = force;
        }
        for (&index, tilt) in self.free.iter().zip(self.tilts) {
            let contact = &equations[index];
            let force = contacts[index].friction[k];
            storage.add(&contact.along, force, rates);
            if !contact.slope.is_empty() {
                storage.add(&contact.across, tilt * force, rates);
            }
        }
    }
}

/// G over a set of contacts, at their tilts.
pub(super) fn coupling(equations: &MotionEquations, members: &[usize], tilts: &[f64]) -> Matrix {
    Matrix::from_fn(members.len(), members.len(), |i, j| {
        let (c, d) = (members[i], members[j]);
        equations.follower[(c, d)].mul_add(tilts[d], equations.coupling[(c, d)])
    })
}

/// Whether no contact moves another at once.
pub(super) fn is_diagonal(matrix: &Matrix) -> bool {
    (0..matrix.rows()).all(|i| (0..matrix.rows()).all(|j| i == j || matrix[(i, j)] == 0.0))
}

/// The members of a set whose rows are independent, the first ones first.
pub(super) fn independent(matrix: &Matrix, among: &[usize]) -> Few<usize> {
    let mut chosen: Few<usize> = Few::new();
    for &next in among {
        if remainder(matrix, next, &chosen).is_some_and(|rest| rest > DEPENDENT) {
            chosen.push(next);
        }
    }
    chosen
}

/// The places of a matrix whose rows the others carry.
pub(super) fn dependent(matrix: &Matrix) -> Vec<usize> {
    let carried = |place: &usize| {
        let others: Vec<usize> = (0..matrix.rows()).filter(|other| other != place).collect();
        let others = independent(matrix, &others);
        remainder(matrix, *place, &others).is_none_or(|rest| rest <= DEPENDENT)
    };
    (0..matrix.rows()).filter(carried).collect()
}

/// The part of a row that others do not carry, relative to it: its Schur complement.
pub(super) fn remainder(matrix: &Matrix, row: usize, others: &[usize]) -> Option<f64> {
    let own = matrix[(row, row)];
    if others.iter().all(|d| matrix[(*d, row)] == 0.0) {
        return Some(1.0);
    }
    let block = Matrix::from_fn(others.len(), others.len(), |i, j| matrix[(others[i], others[j])]);
    let right = Matrix::from_fn(others.len(), 1, |i, _| matrix[(others[i], row)]);
    let shares = block.solve(&right)?;
    let carried: f64 =
        others.iter().zip(shares.as_slice()).map(|(d, share)| matrix[(row, *d)] * share).sum();
    Some((own - carried) / own)
}

/// The least-norm forces that hold contacts at rest, from the slip accelerations that they have without these.
pub(super) struct Gains {
    /// Places of the contacts with independent rows, whose conditions are used.
    pub(super) independent: Few<usize>,
    /// T of all per w of the independent ones, row by row.
    pub(super) gain: Few<f64>,
}

impl Gains {
    /// For contacts with this G; `None` where their forces are not determined.
    pub(super) fn of(matrix: &Matrix) -> Option<Self> {
        let size = matrix.rows();
        let places: Few<usize> = (0..size).collect();
        if is_diagonal(matrix) {
            // With the bits of the general solution.
            let mut gain = Few::from_elem(0.0, size * size);
            for place in 0..size {
                gain[place * (size + 1)] = 1.0 / matrix[(place, place)];
            }
            let is_determined = gain.iter().all(|gain| gain.is_finite());
            return is_determined.then_some(Self { independent: places, gain });
        }
        let independent = independent(matrix, &places);
        let identity = Matrix::identity(independent.len());
        let gain = if independent.len() == size {
            matrix.solve(&identity)?
        } else {
            let entry = |i: usize, j: usize| matrix[(independent[i], independent[j])];
            let count = independent.len();
            let inverse = Matrix::from_fn(count, count, entry).solve(&identity)?;
            let shares =
                Matrix::from_fn(size, count, |i, j| matrix[(i, independent[j])]).times(&inverse);
            let normal = shares.transpose().times(&shares);
            shares.times(&normal.solve(&inverse)?)
        };
        Some(Self { independent, gain: Few::from_slice(gain.as_slice()) })
    }

    /// The forces for these slip accelerations.
    pub(super) fn forces(&self, accelerations: &[f64]) -> Few<f64> {
        let rows = self.gain.chunks_exact(self.independent.len());
        let force = |row: &[f64]| {
            let terms = row.iter().zip(&self.independent);
            terms.map(|(gain, place)| gain * accelerations[*place]).sum()
        };
        rows.map(force).collect()
    }
}

/// Corrects a state ([`StuckForces::project`]).
struct Projection<'a, F> {
    forces: &'a StuckForces,
    equations: &'a MotionEquations,
    surfaces: F,
    state: &'a mut [f64],
}

impl<F: Fn(usize) -> f64> Work for Projection<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.forces.project_by(self.equations, &self.surfaces, self.state);
    }
}

impl StuckForces {
    /// For the contacts that stick now; `None` where their forces are not determined.
    pub(super) fn of(
        equations: &MotionEquations,
        now: &[ContactNow],
        tilts: &[f64],
    ) -> Option<Self> {
        let sticking: Few<usize> = (0..now.len()).filter(|c| now[*c].sticks()).collect();
        if sticking.is_empty() {
            return Some(Self::default());
        }
        let apart = |c: &usize, d: &usize| c == d || equations.coupling[(*c, *d)] == 0.0;
        if !equations.follows
            && sticking
                .iter()
                .all(|c| now[*c].saturated == 0 && sticking.iter().all(|d| apart(c, d)))
        {
            return Self::apart(equations, sticking);
        }
        let all = coupling(equations, &sticking, tilts);
        let places: Few<usize> = (0..sticking.len()).collect();
        let is_dependent = independent(&all, &places).len() < sticking.len();
        let free: Few<usize> =
            sticking.iter().copied().filter(|c| now[*c].saturated == 0).collect();
        if free.is_empty() {
            return Some(Self { is_dependent, ..Self::default() });
        }
        let matrix =
            if free.len() == sticking.len() { all } else { coupling(equations, &free, tilts) };
        let Gains { independent, gain } = Gains::of(&matrix)?;
        Some(Self {
            independent: independent.iter().map(|place| free[*place]).collect(),
            tilts: free.iter().map(|c| tilts[*c]).collect(),
            free,
            gain,
            is_dependent,
        })
    }

    /// For contacts of which none moves another at once.
    fn apart(equations: &MotionEquations, sticking: Few<usize>) -> Option<Self> {
        let size = sticking.len();
        let mut gain = Few::from_elem(0.0, size * size);
        for (place, &contact) in sticking.iter().enumerate() {
            let own = 1.0 / equations.coupling[(contact, contact)];
            if !own.is_finite() {
                return None;
            }
            gain[place * (size + 1)] = own;
        }
        let (tilts, independent) = (Few::from_elem(0.0, size), sticking.clone());
        Some(Self { free: sticking, independent, gain, tilts, is_dependent: false })
    }

    /// The forces of one run, for the equations of a step.
    #[inline(always)]
    pub(super) fn holding(&self) -> HoldingForces<'_> {
        HoldingForces {
            free: &self.free,
            independent: &self.independent,
            gain: &self.gain,
            tilts: &self.tilts,
        }
    }

    /// Corrects a state in which the slip velocities of the sticking contacts have drifted from zero by rounding.
    pub(super) fn project(
        &self,
        equations: &MotionEquations,
        surfaces: impl Fn(usize) -> f64,
        state: &mut [f64],
    ) {
        with_fused_multiply_add(Projection { forces: self, equations, surfaces, state });
    }

    #[inline(always)]
    fn project_by(
        &self,
        equations: &MotionEquations,
        surfaces: &impl Fn(usize) -> f64,
        state: &mut [f64],
    ) {
        let drift = |state: &[f64], index: usize| {
            surfaces(index) - equations.contacts[index].tangent.dot(state)
        };
        let lost: Few<f64> = self.independent.iter().map(|index| drift(state, *index)).collect();
        for (place, &index) in self.free.iter().enumerate() {
            let row = &self.gain[place * lost.len()..(place + 1) * lost.len()];
            let impulse: f64 = row.iter().zip(&lost).map(|(gain, lost)| gain * lost).sum();
            let contact = &equations.contacts[index];
            contact.along.add_to(impulse, state);
            if !contact.slope.is_empty() {
                contact.across.add_to(self.tilts[place] * impulse, state);
            }
        }
    }

    /// The contacts that are held, each with the contacts whose conditions give its force: γ̇ of these without the forces that are
    /// sought, times the gains.
    #[inline(always)]
    pub(super) fn gains(
        &self,
    ) -> impl Iterator<Item = (usize, impl Iterator<Item = (usize, f64)>)> {
        let count = self.independent.len();
        self.free.iter().enumerate().map(move |(place, &held)| {
            let gains = &self.gain[place * count..(place + 1) * count];
            (held, self.independent.iter().copied().zip(gains.iter().copied()))
        })
    }

    /// Change of the force of a sticking contact, from the rates of a change without these forces; 0 for other contacts.
    pub(super) fn change_of_force(
        &self,
        equations: &MotionEquations,
        contact: usize,
        rates: &[f64],
    ) -> f64 {
        let Some(place) = self.free.iter().position(|index| *index == contact) else { return 0.0 };
        let count = self.independent.len();
        let lost = |j: usize| -equations.contacts[self.independent[j]].tangent.dot(rates);
        (0..count).map(|j| self.gain[place * count + j] * lost(j)).sum()
    }

    /// Whether nothing is held.
    pub(super) fn is_empty(&self) -> bool {
        self.free.is_empty()
    }
}
