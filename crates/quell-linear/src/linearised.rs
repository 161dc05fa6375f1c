//! Linearisation about steady sliding (systems of any number of contacts).
//!
//! In steady sliding q₀ every contact slips at γ_c = v_c ≠ 0, so that T_c = μ_c(v_c) N_c acts, with the mean of its factor where
//! an input multiplies it. Small motions y = (q − q₀, q̇) obey
//!
//! ```text
//! ẏ = [A₀ + Σ_c U_c Φ_c V_cᵀ] y,    U_c = (0, M⁻¹[t_c + n_cσ_c, n_c]),    V_c = [t_c on q̇, n_c on q, n_c on q̇, s_c on q]
//! Φ_c = [ −μ′N, μk, μd, 0 ;   0, −k, −d, T ],     σ_c = s_cᵀq₀
//! ```
//!
//! The contacts' own springs and dampers (−k, −d) are gathered in K and C once; what friction does (μ′, μ and T) is added for a
//! friction that is given, so that a row of a map shares the assembly.

use std::fmt;

use quell_model::System;
use quell_model::system::InputTarget;
use quell_numerics::matrix::Matrix;

/// Newton steps after which steady sliding is given up: slope rows alone make the equation nonlinear, and it converges in
/// a few steps or not at all.
const MOST_STEPS: usize = 50;

/// Why a system cannot be linearised.
#[derive(Clone, Debug, PartialEq)]
pub enum NoSteadySliding {
    /// The surface of a contact does not move.
    AtRest {
        /// Name of the contact.
        contact: String,
    },
    /// The contact is open in steady sliding.
    Open {
        /// Name of the contact.
        contact: String,
        /// Its normal load there.
        normal_load: f64,
    },
    /// The equations of steady sliding have no solution that was found, or the mass matrix is singular.
    Singular,
}

impl fmt::Display for NoSteadySliding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtRest { contact } => write!(f, "the surface of contact {contact} does not move"),
            Self::Open { contact, normal_load } => {
                write!(f, "contact {contact} is open in steady sliding, its load is {normal_load}")
            }
            Self::Singular => f.write_str("the equations of steady sliding are singular"),
        }
    }
}

impl std::error::Error for NoSteadySliding {}

/// A contact in steady sliding.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyContact {
    /// Friction coefficient μ(v), signed.
    pub coefficient: f64,
    /// Slope μ′(v).
    pub slope: f64,
    /// Normal load N at q₀.
    pub normal_load: f64,
    /// Friction T = μN without its factor.
    pub friction: f64,
    /// Mean of the factor on the friction force; 1 without an input on it.
    pub factor: f64,
    tangent: Option<Vec<f64>>,
    normal: Option<Vec<f64>>,
    slope_row: Option<Vec<f64>>,
    /// σ = sᵀq₀.
    tilt: f64,
    stiffness: f64,
    damping: f64,
    /// M⁻¹(t + nσ) and M⁻¹n.
    along: Vec<f64>,
    across: Vec<f64>,
}

/// The linear equations of small motions about steady sliding.
#[derive(Clone, Debug)]
pub struct Linearised {
    size: usize,
    /// q₀.
    position: Vec<f64>,
    /// C and K with the springs and dampers of the contacts, without friction.
    damping: Matrix,
    stiffness: Matrix,
    /// M⁻¹C and M⁻¹K of these.
    over_mass: [Matrix; 2],
    contacts: Vec<SteadyContact>,
}

impl Linearised {
    /// Linearises a system about steady sliding.
    ///
    /// # Errors
    /// [`NoSteadySliding`] with the contact and the reason.
    pub fn new(system: &System) -> Result<Self, NoSteadySliding> {
        let n = system.structure.size();
        let structure = system.structure.mechanical().ok_or(NoSteadySliding::Singular)?;
        let mut damping = structure.damping().clone();
        let mut stiffness = structure.stiffness().clone();
        for contact in &system.contacts {
            let Some(row) = &contact.normal else { continue };
            for (strength, matrix) in
                [(contact.normal_damping, &mut damping), (contact.normal_stiffness, &mut stiffness)]
            {
                if strength != 0.0 {
                    for i in 0..n {
                        for j in 0..n {
                            matrix[(i, j)] += strength * row[i] * row[j];
                        }
                    }
                }
            }
        }
        let mut contacts = steady_contacts(system)?;
        let position = steady_position(system, &stiffness, &contacts)?;
        for (contact, given) in contacts.iter_mut().zip(&system.contacts) {
            contact.tilt = product(contact.slope_row.as_deref(), &position);
            let approach = product(contact.normal.as_deref(), &position);
            contact.normal_load = given.normal_load + given.normal_stiffness * approach;
            contact.friction = contact.coefficient * contact.normal_load;
            if contact.normal_load <= 0.0 {
                let normal_load = contact.normal_load;
                return Err(NoSteadySliding::Open { contact: given.name.clone(), normal_load });
            }
        }
        let mass = structure.mass();
        let solve = |right: &Matrix| mass.solve(right).ok_or(NoSteadySliding::Singular);
        let columns = |row: &dyn Fn(&SteadyContact, usize) -> f64| {
            solve(&Matrix::from_fn(n, contacts.len(), |i, c| row(&contacts[c], i)))
        };
        let across = columns(&|contact, i| entry(contact.normal.as_deref(), i))?;
        let along = columns(&|contact, i| {
            let normal = entry(contact.normal.as_deref(), i);
            entry(contact.tangent.as_deref(), i) + normal * contact.tilt
        })?;
        for (c, contact) in contacts.iter_mut().enumerate() {
            contact.along = (0..n).map(|i| along[(i, c)]).collect();
            contact.across = (0..n).map(|i| across[(i, c)]).collect();
        }
        let over_mass = [solve(&damping)?, solve(&stiffness)?];
        Ok(Self { size: n, position, damping, stiffness, over_mass, contacts })
    }

    /// Number of coordinates; the state has twice as many numbers.
    pub fn coordinates(&self) -> usize {
        self.size
    }

    /// Steady sliding q₀.
    pub fn position(&self) -> &[f64] {
        &self.position
    }

    /// C with the dampers of the contacts.
    pub fn damping(&self) -> &Matrix {
        &self.damping
    }

    /// K with the springs of the contacts, without friction.
    pub fn stiffness(&self) -> &Matrix {
        &self.stiffness
    }

    /// The contacts in steady sliding.
    pub fn contacts(&self) -> &[SteadyContact] {
        &self.contacts
    }

    /// Mean friction of each contact, its factor included.
    pub fn mean_friction(&self) -> Vec<f64> {
        self.contacts.iter().map(|contact| contact.factor * contact.friction).collect()
    }

    /// The state matrix of small motions under a friction T_c that is given for each contact; μ_c = T_c/N_c, and the slope
    /// μ′_c changes in proportion.
    pub fn state_matrix(&self, friction: &[f64]) -> Matrix {
        let n = self.size;
        let [damping, stiffness] = &self.over_mass;
        let mut a = Matrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            a[(i, n + i)] = 1.0;
            let row = a.row_mut(n + i);
            for j in 0..n {
                row[j] = -stiffness[(i, j)];
                row[n + j] = -damping[(i, j)];
            }
            for (contact, &force) in self.contacts.iter().zip(friction) {
                contact.add_friction(force, i, row);
            }
        }
        a
    }

    /// U (columns (0, M⁻¹n_c)) and V (columns (s_c, 0)): a friction force T_c adds T_c U_c V_cᵀ to the state matrix where
    /// contacts have no tangent.
    pub fn follower_columns(&self) -> (Matrix, Matrix) {
        let (n, contacts) = (self.size, self.contacts.len());
        let u = Matrix::from_fn(2 * n, contacts, |i, c| {
            if i < n { 0.0 } else { self.contacts[c].across[i - n] }
        });
        let v = Matrix::from_fn(2 * n, contacts, |i, c| {
            if i < n { entry(self.contacts[c].slope_row.as_deref(), i) } else { 0.0 }
        });
        (u, v)
    }
}

impl SteadyContact {
    /// The normal row n, where the contact has one.
    pub fn normal(&self) -> Option<&[f64]> {
        self.normal.as_deref()
    }

    /// The slope row s, where the contact has one.
    pub fn slope_row(&self) -> Option<&[f64]> {
        self.slope_row.as_deref()
    }

    /// Whether the contact has a tangent, so that friction also acts on the structure's own sliding.
    pub fn has_tangent(&self) -> bool {
        self.tangent.is_some()
    }

    /// Adds what the friction T does to coordinate i: [t + nσ](−μ′N tᵀq̇ + μ(k nᵀq + d nᵀq̇)) + n T sᵀq.
    fn add_friction(&self, force: f64, i: usize, row: &mut [f64]) {
        if force == 0.0 {
            return;
        }
        let n = row.len() / 2;
        if let Some(slope) = &self.slope_row {
            let factor = force * self.across[i];
            for (entry, slope) in row[..n].iter_mut().zip(slope) {
                *entry += factor * slope;
            }
        }
        if self.along[i] == 0.0 {
            return;
        }
        let coefficient = force / self.normal_load;
        if let Some(tangent) = &self.tangent {
            let share = if self.coefficient == 0.0 { 1.0 } else { coefficient / self.coefficient };
            let rate = share * self.slope * self.normal_load;
            for (entry, tangent) in row[n..].iter_mut().zip(tangent) {
                *entry -= self.along[i] * rate * tangent;
            }
        }
        if let Some(normal) = &self.normal {
            for (half, strength) in row.chunks_mut(n).zip([self.stiffness, self.damping]) {
                for (entry, normal) in half.iter_mut().zip(normal) {
                    *entry += self.along[i] * coefficient * strength * normal;
                }
            }
        }
    }
}

/// Laws and rows of the contacts; loads and tilts are those of q = 0 so far.
fn steady_contacts(system: &System) -> Result<Vec<SteadyContact>, NoSteadySliding> {
    let mut contacts = Vec::with_capacity(system.contacts.len());
    for (index, contact) in system.contacts.iter().enumerate() {
        let velocity = contact.surface_velocity.mean();
        if velocity == 0.0 {
            return Err(NoSteadySliding::AtRest { contact: contact.name.clone() });
        }
        let coefficient = velocity.signum() * contact.friction.coefficient(velocity.abs());
        let mut factors = system.inputs.iter().filter(
            |input| matches!(input.target, InputTarget::Friction { contact } if contact == index),
        );
        contacts.push(SteadyContact {
            coefficient,
            slope: contact.friction.slope(velocity.abs()),
            normal_load: contact.normal_load,
            friction: coefficient * contact.normal_load,
            factor: factors.next().map_or(1.0, |input| input.profile.mean()),
            tangent: contact.tangent.clone(),
            normal: contact.normal.clone(),
            slope_row: contact.slope.clone(),
            tilt: 0.0,
            stiffness: contact.normal_stiffness,
            damping: contact.normal_damping,
            along: Vec::new(),
            across: Vec::new(),
        });
    }
    Ok(contacts)
}

/// Steady sliding: K q = p + Σ (t + n sᵀq) μN(q), K with the springs of the contacts, by Newton's method from q = 0.
fn steady_position(
    system: &System,
    stiffness: &Matrix,
    contacts: &[SteadyContact],
) -> Result<Vec<f64>, NoSteadySliding> {
    let n = system.structure.size();
    let mut position = vec![0.0; n];
    for _ in 0..MOST_STEPS {
        let mut residual: Vec<f64> = (0..n)
            .map(|i| {
                let spring: f64 = stiffness.row(i).iter().zip(&position).map(|(k, q)| k * q).sum();
                system.structure.force()[i] - spring
            })
            .collect();
        let mut jacobian = stiffness.clone();
        for contact in contacts {
            let tilt = product(contact.slope_row.as_deref(), &position);
            let load = contact.normal_load
                + contact.stiffness * product(contact.normal.as_deref(), &position);
            let coefficient = contact.factor * contact.coefficient;
            for i in 0..n {
                let normal = entry(contact.normal.as_deref(), i);
                let along = entry(contact.tangent.as_deref(), i) + normal * tilt;
                residual[i] += along * coefficient * load;
                for j in 0..n {
                    let approach = contact.stiffness * entry(contact.normal.as_deref(), j);
                    jacobian[(i, j)] -= along * coefficient * approach
                        + normal * coefficient * load * entry(contact.slope_row.as_deref(), j);
                }
            }
        }
        if residual.iter().all(|force| *force == 0.0) {
            return Ok(position);
        }
        let right = Matrix::from_fn(n, 1, |i, _| residual[i]);
        let step = jacobian.solve(&right).ok_or(NoSteadySliding::Singular)?;
        let length = step.largest();
        if !length.is_finite() {
            return Err(NoSteadySliding::Singular);
        }
        let largest = position.iter().fold(0.0, |largest: f64, q| largest.max(q.abs()));
        for (q, step) in position.iter_mut().zip(step.as_slice()) {
            *q += step;
        }
        if length <= 4.0 * f64::EPSILON * largest {
            return Ok(position);
        }
    }
    Err(NoSteadySliding::Singular)
}

/// Entry i of a row; 0 without one.
fn entry(row: Option<&[f64]>, i: usize) -> f64 {
    row.map_or(0.0, |row| row[i])
}

/// rowᵀq; 0 without a row.
fn product(row: Option<&[f64]>, position: &[f64]) -> f64 {
    row.map_or(0.0, |row| row.iter().zip(position).map(|(r, q)| r * q).sum())
}

#[cfg(test)]
mod tests {
    use quell_model::profile::Profile;
    use quell_model::system::{Contact, MassMatrix, Mechanical};
    use quell_model::{Belt, Friction, LawKind, Parametrisation};

    use super::*;
    use crate::eigenvalues;

    #[test]
    fn a_belt_as_a_system_has_its_own_growth() {
        let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("valid");
        let belt = Belt::new(0.005, 1.3, 0.05, law, Vec::new()).expect("valid");
        let linear = Linearised::new(&belt.system()).expect("slides");
        assert!((linear.position()[0] - belt.steady_sliding()).abs() < 1e-15);
        let growth = eigenvalues::growth(&linear, &linear.mean_friction()).expect("finite");
        let rate = belt.damping_rate(belt.friction().slope(0.05), belt.normal_load());
        assert!((growth.rate + 0.5 * rate).abs() < 1e-14, "{} {rate}", growth.rate);
        let square = 0.25f64.mul_add(-rate * rate, 1.0);
        assert!((growth.frequency - square.sqrt()).abs() < 1e-14);
    }

    /// Mode coupling (Hoffmann et al. 2002): K = [[2, 1], [1, 2]] with the contact's spring k₃ = 4/3, unstable from μ = 3/4 on.
    #[test]
    fn mode_coupling_begins_at_three_quarters() {
        let growth = |coefficient: f64| {
            let stiffness = [[2.0, 1.0], [1.0, 2.0 / 3.0]];
            let structure = Mechanical::new(
                vec!["x".to_owned(), "y".to_owned()],
                MassMatrix::identity(2),
                Matrix::zeros(2, 2),
                Matrix::from_fn(2, 2, |i, j| stiffness[i][j]),
            );
            let contact = Contact {
                name: "pad".to_owned(),
                tangent: Some(vec![1.0, 0.0]),
                force: None,
                normal: Some(vec![0.0, 1.0]),
                slope: None,
                normal_load: 1.0,
                normal_stiffness: 4.0 / 3.0,
                normal_damping: 0.0,
                surface_velocity: Profile::constant(0.05),
                friction: Friction::Coulomb(quell_model::Coulomb::constant(coefficient)),
            };
            let system =
                System { structure: structure.into(), contacts: vec![contact], inputs: Vec::new() };
            let linear = Linearised::new(&system).expect("slides");
            eigenvalues::growth(&linear, &linear.mean_friction()).expect("finite").rate
        };
        assert!(growth(0.7499) < 1e-9, "{}", growth(0.7499));
        assert!(growth(0.7501) > 1e-3);
        // λ² = −2 ± √(1 − μ·4/3): past the coalescence |Re λ| follows from the square root.
        let beyond: f64 = growth(0.9);
        let root = num_complex::Complex64::new(-2.0, (0.9f64 * 4.0 / 3.0 - 1.0).sqrt()).sqrt();
        assert!((beyond - root.re.abs()).abs() < 1e-12, "{beyond} {root}");
    }

    #[test]
    fn what_does_not_slide_is_refused() {
        let law = LawKind::Coulomb.build(&[0.3, 0.3, 0.0]).expect("valid");
        let belt = Belt::new(0.005, 1.0, 0.0, law, Vec::new()).expect("valid");
        let why = Linearised::new(&belt.system()).expect_err("a belt at rest");
        assert_eq!(why, NoSteadySliding::AtRest { contact: "belt".to_owned() });
    }
}
