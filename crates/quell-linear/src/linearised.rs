//! Linearisation about steady sliding (systems of any number of contacts).
//!
//! In steady sliding q₀ every contact slips at γ_c = v_c ≠ 0 ([`SteadySliding`]), and friction acts with the mean of its factor
//! where an input multiplies it. Small motions y = (q − q₀, q̇) obey
//!
//! ```text
//! ẏ = [A₀ + Σ_c U_c Φ_c V_cᵀ] y,    U_c = (0, M⁻¹[t_c + n_cσ_c, n_c]),    V_c = [t_c on q̇, n_c on q, n_c on q̇, s_c on q]
//! Φ_c = [ −T_γ, T_N k, T_N d, 0 ;   0, −k, −d, T ],     σ_c = s_cᵀq₀
//! ```
//!
//! with T_γ = μ′N and T_N = μ without dither. The contacts' own springs and dampers (−k, −d) are gathered in K and C once; what
//! friction does (T_γ, T_N and T) is added for a friction that is given, so that a row of a map shares the assembly. First-order
//! equations have U_c = g_c, V_c = t_c and Φ_c = −T_γ.
//!
//! Bristles (LuGre) add their deflections z_c as states after those of the structure ([`BristleSlopes`]).

use num_complex::Complex64;
use quell_model::system::{Contact, Structure};
use quell_model::{Friction, System};
use quell_numerics::matrix::Matrix;

pub use crate::steady::{FrictionLine, NoSteadySliding};
use crate::steady::{SteadyContact, SteadySliding, entry, with_dampers, with_springs};

/// Friction of a contact near steady sliding: its force and how it changes with slip velocity and load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionSlopes {
    /// T.
    pub force: f64,
    /// T_γ = ∂T/∂γ.
    pub by_velocity: f64,
    /// T_N = ∂T/∂N.
    pub by_load: f64,
    /// How bristles move; `None` of a friction that follows the slip velocity at once. T_γ is then the slope of steady friction.
    pub bristles: Option<BristleSlopes>,
}

/// Small motions of bristles about steady sliding at the slip velocity V: ζ̇ = aδγ − bζ and δT = T_z ζ + T_γ δγ, where
///
/// ```text
/// a = Vg′/g,    b = σ₀|V|/g,    T_z = N(σ₀ − σ₁b),    T_γ = N(σ₁a + σ₂)
/// ```
///
/// follow from ż = γ − σ₀|γ|z/g(γ), T = N(σ₀z + σ₁ż + σ₂γ). At rest relative to each other, ζ = aδγ/b gives the slope N(g′ + σ₂)
/// of steady friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BristleSlopes {
    /// a, by which the slip velocity deflects them.
    pub by_slip: f64,
    /// b, the rate at which they relax.
    pub rate: f64,
    /// T_z = ∂T/∂z.
    pub by_deflection: f64,
    /// T_γ at a deflection that does not change.
    pub at_once: f64,
}

impl BristleSlopes {
    /// The bristles of a contact that slides steadily under the load N; `None` of another law.
    fn of(contact: &Contact, normal_load: f64, factor: f64) -> Option<Self> {
        let Friction::Lugre(law) = &contact.friction else { return None };
        let bristles = contact.friction.bristles()?;
        let speed = contact.surface_velocity.mean().abs();
        let level = Friction::StribeckExponential(law.level());
        let (saturated, slope) = (level.coefficient(speed), level.slope(speed));
        let (by_slip, rate) = (speed * slope / saturated, bristles.stiffness * speed / saturated);
        let load = factor * normal_load;
        Some(Self {
            by_slip,
            rate,
            by_deflection: load * (bristles.stiffness - bristles.damping * rate),
            at_once: load * (bristles.damping * by_slip + bristles.viscous),
        })
    }
}

impl FrictionSlopes {
    /// The friction of the steady law, which follows the slip velocity at once.
    #[must_use]
    pub fn at_once(self) -> Self {
        Self { bristles: None, ..self }
    }

    /// ∂T/∂γ at fixed deflections of bristles.
    fn direct(&self) -> f64 {
        self.bristles.map_or(self.by_velocity, |bristles| bristles.at_once)
    }

    /// ∂T/∂γ for a motion e^{λt}.
    pub fn by_velocity_of(&self, eigenvalue: Complex64) -> Complex64 {
        match self.bristles {
            None => Complex64::new(self.by_velocity, 0.0),
            Some(BristleSlopes { by_slip, rate, by_deflection, at_once }) => {
                by_deflection * by_slip / (eigenvalue + rate) + at_once
            }
        }
    }
}

/// A contact of linearised equations.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearContact {
    /// The contact in steady sliding.
    pub steady: SteadyContact,
    tangent: Option<Vec<f64>>,
    normal: Option<Vec<f64>>,
    slope_row: Option<Vec<f64>>,
    stiffness: f64,
    damping: f64,
    /// M⁻¹(t + nσ), or g.
    along: Vec<f64>,
    /// M⁻¹n.
    across: Vec<f64>,
    bristles: Option<BristleSlopes>,
}

/// What is linear without friction.
#[derive(Clone, Debug)]
enum LinearEquations {
    Mechanical {
        /// M.
        mass: Matrix,
        /// C and K with the springs and dampers of the contacts.
        damping: Matrix,
        stiffness: Matrix,
        /// M⁻¹C and M⁻¹K of these.
        over_mass: [Matrix; 2],
    },
    StateSpace(Matrix),
}

/// The linear equations of small motions about steady sliding.
#[derive(Clone, Debug)]
pub struct Linearised {
    position: Vec<f64>,
    equations: LinearEquations,
    contacts: Vec<LinearContact>,
}

/// M, C and K of a mechanical structure with the springs and dampers of its contacts, friction left out.
#[derive(Clone, Copy, Debug)]
pub struct Matrices<'a> {
    /// M.
    pub mass: &'a Matrix,
    /// C.
    pub damping: &'a Matrix,
    /// K.
    pub stiffness: &'a Matrix,
}

impl Linearised {
    /// Linearises a system about its steady sliding without dither.
    ///
    /// # Errors
    /// [`NoSteadySliding`] with the contact and the reason.
    pub fn new(system: &System) -> Result<Self, NoSteadySliding> {
        let mut linear = Self::about(system, SteadySliding::new(system)?)?;
        for (linear, contact) in linear.contacts.iter_mut().zip(&system.contacts) {
            let SteadyContact { normal_load, factor, .. } = linear.steady;
            linear.bristles = BristleSlopes::of(contact, normal_load, factor);
        }
        Ok(linear)
    }

    /// The equations without friction about q = 0: masses, dampers and springs, those of the contacts included. There need not
    /// be any steady sliding.
    ///
    /// # Errors
    /// [`NoSteadySliding::NoMass`].
    pub fn frictionless(system: &System) -> Result<Self, NoSteadySliding> {
        let position = vec![0.0; system.structure.size()];
        let none = vec![FrictionLine::NONE; system.contacts.len()];
        let at_rest = SteadySliding::at(system, position, &none);
        Self::about(system, at_rest)
    }

    /// Linearises a system about a steady sliding, whose friction follows the slip velocity at once.
    ///
    /// # Errors
    /// [`NoSteadySliding::NoMass`], [`NoSteadySliding::SpeedVaries`].
    pub fn about(system: &System, steady: SteadySliding) -> Result<Self, NoSteadySliding> {
        let n = system.structure.size();
        let given = system.contacts.iter();
        let mut contacts: Vec<LinearContact> = given
            .zip(steady.contacts)
            .map(|(contact, steady)| LinearContact {
                steady,
                tangent: contact.tangent.clone(),
                normal: contact.normal.clone(),
                slope_row: contact.slope.clone(),
                stiffness: contact.normal_stiffness,
                damping: contact.normal_damping,
                along: contact.force.clone().unwrap_or_else(|| vec![0.0; n]),
                across: vec![0.0; n],
                bristles: None,
            })
            .collect();
        let equations = match &system.structure {
            Structure::StateSpace(states) => LinearEquations::StateSpace(states.matrix().clone()),
            Structure::Mechanical(mechanical) if mechanical.by_speed().is_some() => {
                return Err(NoSteadySliding::SpeedVaries);
            }
            Structure::Mechanical(mechanical) => {
                let damping = with_dampers(system, mechanical.damping());
                let stiffness = with_springs(system, mechanical.stiffness());
                let mass = mechanical.mass();
                let solve = |right: &Matrix| mass.solve(right).ok_or(NoSteadySliding::NoMass);
                let columns = |row: &dyn Fn(&LinearContact, usize) -> f64| {
                    solve(&Matrix::from_fn(n, contacts.len(), |i, c| row(&contacts[c], i)))
                };
                let across = columns(&|contact, i| entry(contact.normal.as_deref(), i))?;
                let along = columns(&|contact, i| {
                    let normal = entry(contact.normal.as_deref(), i);
                    entry(contact.tangent.as_deref(), i) + normal * contact.steady.tilt
                })?;
                for (c, contact) in contacts.iter_mut().enumerate() {
                    contact.along = (0..n).map(|i| along[(i, c)]).collect();
                    contact.across = (0..n).map(|i| across[(i, c)]).collect();
                }
                let over_mass = [solve(&damping)?, solve(&stiffness)?];
                LinearEquations::Mechanical { mass: mass.matrix(), damping, stiffness, over_mass }
            }
        };
        Ok(Self { position: steady.position, equations, contacts })
    }

    /// Number n of coordinates, or of states of first-order equations.
    pub fn coordinates(&self) -> usize {
        self.position.len()
    }

    /// Steady sliding q₀, or x₀ of first-order equations.
    pub fn position(&self) -> &[f64] {
        &self.position
    }

    /// M, C and K with the springs and dampers of the contacts; `None` for first-order equations.
    pub fn matrices(&self) -> Option<Matrices<'_>> {
        match &self.equations {
            LinearEquations::Mechanical { mass, damping, stiffness, .. } => {
                Some(Matrices { mass, damping, stiffness })
            }
            LinearEquations::StateSpace(_) => None,
        }
    }

    /// The contacts in steady sliding.
    pub fn contacts(&self) -> &[LinearContact] {
        &self.contacts
    }

    /// Mean friction of each contact, its factor included.
    pub fn mean_friction(&self) -> Vec<f64> {
        let contacts = self.contacts.iter().map(|contact| &contact.steady);
        contacts.map(|contact| contact.factor * contact.friction).collect()
    }

    /// The friction of each contact in steady sliding, its factor included.
    pub fn friction(&self) -> Vec<FrictionSlopes> {
        let slopes = |contact: &LinearContact| {
            let SteadyContact { line, normal_load, friction, factor, .. } = contact.steady;
            FrictionSlopes {
                force: factor * friction,
                by_velocity: factor * line.slope_under(normal_load),
                by_load: factor * line.coefficient,
                bristles: contact.bristles,
            }
        };
        self.contacts.iter().map(slopes).collect()
    }

    /// The state matrix of small motions under a friction T_c that is given for each contact without dither; μ_c = T_c/N_c,
    /// and the slope μ′_c changes in proportion.
    pub fn state_matrix(&self, friction: &[f64]) -> Matrix {
        let contacts = self.contacts.iter().map(|contact| &contact.steady).zip(friction);
        let slopes: Vec<FrictionSlopes> = contacts
            .map(|(SteadyContact { line, normal_load, .. }, &force)| {
                let by_load = force / normal_load;
                let unchanged = line.coefficient == 0.0;
                let share = if unchanged { 1.0 } else { by_load / line.coefficient };
                let by_velocity = share * line.slope * normal_load;
                FrictionSlopes { force, by_velocity, by_load, bristles: None }
            })
            .collect();
        self.state_matrix_with(&slopes)
    }

    /// The state matrix of small motions under a given friction of each contact: the states of the structure, then the deflections
    /// of bristles in the order of their contacts.
    pub fn state_matrix_with(&self, friction: &[FrictionSlopes]) -> Matrix {
        let rigid = self.structure_matrix(friction);
        let moving: Vec<(&LinearContact, BristleSlopes)> = self
            .contacts
            .iter()
            .zip(friction)
            .filter_map(|(contact, friction)| Some((contact, friction.bristles?)))
            .collect();
        if moving.is_empty() {
            return rigid;
        }
        let (n, size) = (self.coordinates(), rigid.rows());
        let mut a = Matrix::zeros(size + moving.len(), size + moving.len());
        for i in 0..size {
            a.row_mut(i)[..size].copy_from_slice(rigid.row(i));
        }
        // The last n states are velocities, or all those of first-order equations.
        let first = size - n;
        for (index, (contact, bristles)) in moving.into_iter().enumerate() {
            let own = size + index;
            for i in 0..n {
                a[(first + i, own)] = contact.along[i] * bristles.by_deflection;
            }
            add(&mut a.row_mut(own)[first..size], -bristles.by_slip, contact.tangent.as_deref());
            a[(own, own)] = -bristles.rate;
        }
        a
    }

    /// The rows and columns of the structure in the state matrix.
    fn structure_matrix(&self, friction: &[FrictionSlopes]) -> Matrix {
        let n = self.coordinates();
        let [damping, stiffness] = match &self.equations {
            LinearEquations::Mechanical { over_mass, .. } => over_mass,
            LinearEquations::StateSpace(matrix) => {
                let mut a = matrix.clone();
                for (contact, friction) in self.contacts.iter().zip(friction) {
                    for i in 0..n {
                        add(
                            a.row_mut(i),
                            -contact.along[i] * friction.direct(),
                            contact.tangent.as_deref(),
                        );
                    }
                }
                return a;
            }
        };
        let mut a = Matrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            a[(i, n + i)] = 1.0;
            let row = a.row_mut(n + i);
            for j in 0..n {
                row[j] = -stiffness[(i, j)];
                row[n + j] = -damping[(i, j)];
            }
            for (contact, friction) in self.contacts.iter().zip(friction) {
                contact.add_friction(friction, i, row);
            }
        }
        a
    }

    /// U (columns (0, M⁻¹n_c)) and V (columns (s_c, 0)): a friction force T_c adds T_c U_c V_cᵀ to the state matrix where
    /// contacts have no tangent.
    pub fn follower_columns(&self) -> (Matrix, Matrix) {
        let (n, contacts) = (self.coordinates(), self.contacts.len());
        let u = Matrix::from_fn(2 * n, contacts, |i, c| {
            if i < n { 0.0 } else { self.contacts[c].across[i - n] }
        });
        let v = Matrix::from_fn(2 * n, contacts, |i, c| {
            if i < n { entry(self.contacts[c].slope_row.as_deref(), i) } else { 0.0 }
        });
        (u, v)
    }
}

impl LinearContact {
    /// The tangent row t, where the contact has one.
    pub fn tangent(&self) -> Option<&[f64]> {
        self.tangent.as_deref()
    }

    /// The normal row n, where the contact has one.
    pub fn normal(&self) -> Option<&[f64]> {
        self.normal.as_deref()
    }

    /// The slope row s, where the contact has one.
    pub fn slope_row(&self) -> Option<&[f64]> {
        self.slope_row.as_deref()
    }

    /// M⁻¹(t + nσ), or g.
    pub(crate) fn along(&self) -> &[f64] {
        &self.along
    }

    /// M⁻¹n.
    pub(crate) fn across(&self) -> &[f64] {
        &self.across
    }

    /// Normal stiffness k and damping d.
    pub fn normal_spring(&self) -> (f64, f64) {
        (self.stiffness, self.damping)
    }

    /// Adds what friction does to coordinate i: [t + nσ](−T_γ tᵀq̇ + T_N(k nᵀq + d nᵀq̇)) + n T sᵀq.
    fn add_friction(&self, friction: &FrictionSlopes, i: usize, row: &mut [f64]) {
        let (on_position, on_velocity) = row.split_at_mut(row.len() / 2);
        if friction.force != 0.0 {
            add(on_position, friction.force * self.across[i], self.slope_row.as_deref());
        }
        if self.along[i] == 0.0 {
            return;
        }
        let by_velocity = friction.direct();
        if by_velocity != 0.0 {
            add(on_velocity, -(self.along[i] * by_velocity), self.tangent.as_deref());
        }
        if friction.by_load != 0.0 {
            let factor = self.along[i] * friction.by_load;
            add(on_position, factor * self.stiffness, self.normal.as_deref());
            add(on_velocity, factor * self.damping, self.normal.as_deref());
        }
    }
}

/// Adds a multiple of a row, if there is one.
fn add(to: &mut [f64], factor: f64, row: Option<&[f64]>) {
    for (entry, value) in to.iter_mut().zip(row.unwrap_or_default()) {
        *entry += factor * value;
    }
}

#[cfg(test)]
mod tests {
    use quell_model::profile::Profile;
    use quell_model::system::{Contact, MassMatrix, Mechanical};
    use quell_model::{Belt, Friction, LawKind};

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
                tangential_stiffness: None,
                normal_damping: 0.0,
                surface_velocity: Profile::constant(0.05),
                friction: Friction::Coulomb(quell_model::Coulomb::constant(coefficient)),
                varying_load: None,
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
        let root = Complex64::new(-2.0, (0.9f64 * 4.0 / 3.0 - 1.0).sqrt()).sqrt();
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
