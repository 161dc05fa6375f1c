//! Steady sliding of a system: the equilibrium at which every contact slips.
//!
//! ```text
//! K q = p + Σ_c (t_c + n_c s_cᵀq) T_c,    T_c = c N_c + r,    N_c = N₀ + k n_cᵀq
//! ```
//!
//! with K the stiffness with the springs of the contacts. Without dither c = μ(v_c) and r = 0; under fast dither both are
//! averages ([`FrictionLine`]). Slope rows alone make the equation nonlinear. First-order equations give A x + p + Σ g_c T_c = 0.

use std::fmt;

use quell_model::System;
use quell_model::digits::digits;
use quell_model::system::{Contact, InputTarget, Structure};
use quell_numerics::matrix::Matrix;

/// Newton steps after which steady sliding is given up: slope rows alone make the equation nonlinear, and it converges in
/// a few steps or not at all.
const MOST_STEPS: usize = 50;

/// Steps of Newton's method that no longer shrink are those of rounding below this share of the solution.
const STAGNANT: f64 = 1e-9;

/// Why a system has no steady sliding.
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
    /// The equations of steady sliding are singular, or Newton's method does not converge: a coordinate is held by nothing,
    /// or friction buckles the structure.
    Singular,
    /// The mass matrix is singular.
    NoMass,
    /// The matrices of the structure depend on a speed that varies in time.
    SpeedVaries,
}

impl fmt::Display for NoSteadySliding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AtRest { contact } => write!(f, "the surface of contact {contact} does not move"),
            Self::Open { contact, normal_load } => {
                let load = digits(*normal_load, 6);
                write!(f, "contact {contact} is open in steady sliding: its normal load would be {load}")
            }
            Self::Singular => f.write_str(
                "the equations of steady sliding are singular: no spring holds some coordinate, or friction buckles the structure",
            ),
            Self::NoMass => f.write_str("the mass matrix is singular"),
            Self::SpeedVaries => f.write_str(
                "the speed of the structure varies in time: steady sliding is that of the system of one moment",
            ),
        }
    }
}

impl std::error::Error for NoSteadySliding {}

/// Friction of a contact near steady sliding, as a function of its normal load: T = c N + r, ∂T/∂γ = c′ N + r′.
///
/// Without dither c = μ(v) and c′ = μ′(v), and r and r′ vanish. Under fast dither c is the mean of the coefficient and r the
/// mean of its product with the fluctuating load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionLine {
    /// c, signed like the slip velocity.
    pub coefficient: f64,
    /// r.
    pub constant: f64,
    /// c′.
    pub slope: f64,
    /// r′.
    pub slope_constant: f64,
    /// Whether the slopes are those of slightly faster slip alone: the fast slip just reaches the slow one.
    pub one_sided: bool,
}

impl FrictionLine {
    /// ∂T/∂γ under a normal load.
    pub fn slope_under(&self, normal_load: f64) -> f64 {
        self.slope * normal_load + self.slope_constant
    }

    /// The friction of a contact without dither, at the mean velocity of its surface.
    ///
    /// # Errors
    /// [`NoSteadySliding::AtRest`].
    pub fn of(contact: &Contact) -> Result<Self, NoSteadySliding> {
        let velocity = contact.surface_velocity.mean();
        if velocity == 0.0 {
            return Err(NoSteadySliding::AtRest { contact: contact.name.clone() });
        }
        Ok(Self {
            coefficient: velocity.signum() * contact.friction.coefficient(velocity.abs()),
            constant: 0.0,
            slope: contact.friction.slope(velocity.abs()),
            slope_constant: 0.0,
            one_sided: false,
        })
    }

    /// That of no friction: of a contact whose surface is at rest under fast slip, by symmetry.
    pub const NONE: Self =
        Self { coefficient: 0.0, constant: 0.0, slope: 0.0, slope_constant: 0.0, one_sided: false };
}

/// A contact in steady sliding.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyContact {
    /// Friction as a function of load and slip velocity.
    pub line: FrictionLine,
    /// Normal load N at q₀.
    pub normal_load: f64,
    /// Friction T without its factor.
    pub friction: f64,
    /// Mean of the factor on the friction force; 1 without an input on it.
    pub factor: f64,
    /// Tilt σ = sᵀq₀.
    pub tilt: f64,
}

/// Steady sliding.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadySliding {
    /// q₀ of a mechanical structure, x₀ of first-order equations.
    pub position: Vec<f64>,
    /// The contacts there.
    pub contacts: Vec<SteadyContact>,
}

impl SteadySliding {
    /// Steady sliding without dither.
    ///
    /// # Errors
    /// [`NoSteadySliding`] with the contact and the reason.
    pub fn new(system: &System) -> Result<Self, NoSteadySliding> {
        let lines: Vec<FrictionLine> =
            system.contacts.iter().map(FrictionLine::of).collect::<Result<_, _>>()?;
        Self::with(system, &lines)
    }

    /// Steady sliding with given friction, one line for each contact.
    ///
    /// # Errors
    /// [`NoSteadySliding`] with the contact and the reason.
    pub fn with(system: &System, lines: &[FrictionLine]) -> Result<Self, NoSteadySliding> {
        let factors: Vec<f64> = (0..lines.len()).map(|index| mean_factor(system, index)).collect();
        let position = match &system.structure {
            Structure::Mechanical(mechanical) if mechanical.by_speed().is_some() => {
                return Err(NoSteadySliding::SpeedVaries);
            }
            Structure::Mechanical(mechanical) => {
                let stiffness = with_springs(system, mechanical.stiffness());
                equilibrium(system, &stiffness, lines, &factors)?
            }
            Structure::StateSpace(states) => {
                // No normal row: loads are prescribed, and one step solves the linear equation.
                let right = Matrix::from_fn(states.names().len(), 1, |i, _| {
                    let contacts = system.contacts.iter().zip(lines).zip(&factors);
                    let friction = contacts.map(|((contact, line), factor)| {
                        let force = line.coefficient * contact.normal_load + line.constant;
                        entry(contact.force.as_deref(), i) * factor * force
                    });
                    -states.force()[i] - friction.sum::<f64>()
                });
                let solved = states.matrix().solve(&right).ok_or(NoSteadySliding::Singular)?;
                if !solved.is_finite() {
                    return Err(NoSteadySliding::Singular);
                }
                solved.as_slice().to_vec()
            }
        };
        let steady = Self::at(system, position, lines);
        let open = steady.contacts.iter().position(|contact| contact.normal_load <= 0.0);
        if let Some(index) = open {
            let normal_load = steady.contacts[index].normal_load;
            let contact = system.contacts[index].name.clone();
            return Err(NoSteadySliding::Open { contact, normal_load });
        }
        Ok(steady)
    }

    /// The contacts at a given position.
    pub(crate) fn at(system: &System, position: Vec<f64>, lines: &[FrictionLine]) -> Self {
        let given = system.contacts.iter().enumerate().zip(lines);
        let contacts = given
            .map(|((index, given), &line)| {
                let tilt = product(given.slope.as_deref(), &position);
                let approach = product(given.normal.as_deref(), &position);
                let normal_load = given.normal_load + given.normal_stiffness * approach;
                let friction = line.coefficient * normal_load + line.constant;
                let factor = mean_factor(system, index);
                SteadyContact { line, normal_load, friction, factor, tilt }
            })
            .collect();
        Self { position, contacts }
    }
}

/// Mean of the factors on the friction force of a contact; 1 without any.
pub(crate) fn mean_factor(system: &System, index: usize) -> f64 {
    let on_it = |target: &InputTarget| matches!(target, InputTarget::Friction { contact } if *contact == index);
    let mut factors = system.inputs.iter().filter(|input| on_it(&input.target)).peekable();
    if factors.peek().is_none() {
        return 1.0;
    }
    factors.map(|input| input.profile.mean()).sum()
}

/// K (or C) with the springs (dampers) of the contacts added.
pub(crate) fn with_springs(system: &System, stiffness: &Matrix) -> Matrix {
    added(system, stiffness, |contact| contact.normal_stiffness)
}

/// C with the dampers of the contacts added.
pub(crate) fn with_dampers(system: &System, damping: &Matrix) -> Matrix {
    added(system, damping, |contact| contact.normal_damping)
}

fn added(system: &System, matrix: &Matrix, strength: impl Fn(&Contact) -> f64) -> Matrix {
    let mut matrix = matrix.clone();
    for contact in &system.contacts {
        if let (Some(row), true) = (&contact.normal, strength(contact) != 0.0) {
            matrix.add_outer(strength(contact), row);
        }
    }
    matrix
}

/// Solves K q = p + Σ (t + n sᵀq) T(q), K with the springs of the contacts, by Newton's method from q = 0.
fn equilibrium(
    system: &System,
    stiffness: &Matrix,
    lines: &[FrictionLine],
    factors: &[f64],
) -> Result<Vec<f64>, NoSteadySliding> {
    let n = system.structure.size();
    let mut position = vec![0.0; n];
    let mut previous = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let mut residual: Vec<f64> = (0..n)
            .map(|i| {
                let spring: f64 = stiffness.row(i).iter().zip(&position).map(|(k, q)| k * q).sum();
                system.structure.force()[i] - spring
            })
            .collect();
        let mut jacobian = stiffness.clone();
        for ((contact, line), factor) in system.contacts.iter().zip(lines).zip(factors) {
            let tilt = product(contact.slope.as_deref(), &position);
            let load = contact.normal_load
                + contact.normal_stiffness * product(contact.normal.as_deref(), &position);
            let coefficient = factor * line.coefficient;
            let force = coefficient * load + factor * line.constant;
            for i in 0..n {
                let normal = entry(contact.normal.as_deref(), i);
                let along = entry(contact.tangent.as_deref(), i) + normal * tilt;
                residual[i] += along * force;
                for j in 0..n {
                    let approach = contact.normal_stiffness * entry(contact.normal.as_deref(), j);
                    jacobian[(i, j)] -= along * coefficient * approach
                        + normal * force * entry(contact.slope.as_deref(), j);
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
        // Near a singular matrix rounding keeps the steps above the usual bound, and they cease to shrink.
        let stagnant = length <= STAGNANT * largest && length >= 0.5 * previous;
        if length <= 4.0 * f64::EPSILON * largest || stagnant {
            return Ok(position);
        }
        previous = length;
    }
    Err(NoSteadySliding::Singular)
}

/// Entry i of a row; 0 without one.
pub(crate) fn entry(row: Option<&[f64]>, i: usize) -> f64 {
    row.map_or(0.0, |row| row[i])
}

/// rowᵀq; 0 without a row.
pub(crate) fn product(row: Option<&[f64]>, position: &[f64]) -> f64 {
    row.map_or(0.0, |row| row.iter().zip(position).map(|(r, q)| r * q).sum())
}
