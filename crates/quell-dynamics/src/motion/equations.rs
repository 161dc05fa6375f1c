//! A system as the engine needs it: rates of the state without its contacts, and what each contact reads and adds.
//!
//! ```text
//! ẋ = A x + p + Σ_j b_j u_j(t) + Σ_c [ (g_c + h_c s_cᵀx) T_c − h_c P_c ]
//! ```
//!
//! where A may depend on a speed over time (`speed_terms`), and
//! with g = M⁻¹t and h = M⁻¹n in the rows of velocities (first-order equations: the column g of the study). The springs of the
//! contacts are not in A: a contact reads its load N = N₀ + ΔN(t) + rᵀx, and adds the reaction P. Opening a contact then changes no
//! matrix, and a modal structure stays sparse.

use quell_model::System;
use quell_model::profile::Profile;
use quell_model::system::{Contact, InputTarget, Mechanical, Structure};
use quell_numerics::matrix::Matrix;

use super::contact_equation::ContactEquation;
use super::own_state::OwnState;
use super::plain_equations::PlainEquations;
use super::rates::{self, FastestRates};
use super::rows::{RowEntries, StateMatrix};
use super::speed_terms::SpeedMatrices;
use super::stopped::Immobile;
use crate::simulation::{Clock, Forcing};

impl ContactEquation {
    /// Whether the load is that of the study at any time, given its forcing, and acts on friction alone.
    pub(super) fn is_plain(&self, forcing: &ContactForcing) -> bool {
        let is_constant = forcing.load.is_constant() && forcing.factor.is_none();
        let acts_alone = self.across.is_empty() && self.slope.is_empty();
        is_constant && acts_alone && !self.is_compliant()
    }
}

/// The equations of a system.
#[derive(Clone, Debug)]
pub(super) struct MotionEquations {
    /// Length of the state: that of the structure, and one number for each contact with a state of its own.
    pub(super) size: usize,
    /// Length of the state of the structure.
    pub(super) structure_size: usize,
    pub(super) matrix: StateMatrix,
    pub(super) constant: Vec<f64>,
    /// Columns b of the inputs that are forces.
    pub(super) pushes: Vec<RowEntries>,
    /// What a speed over time adds to the matrix.
    pub(super) by_speed: Option<SpeedMatrices>,
    pub(super) contacts: Vec<ContactEquation>,
    /// Of the structure closed by its contacts.
    pub(super) rates: FastestRates,
    /// t_cᵀg_d and t_cᵀh_d.
    pub(super) coupling: Matrix,
    pub(super) follower: Matrix,
    /// Whether a contact has a slope row.
    pub(super) follows: bool,
    /// The same for vectors, if the system is small and its contacts are plain.
    pub(super) plain: Option<PlainEquations>,
}

/// What varies in time, along one run.
#[derive(Clone, Debug)]
pub(super) struct Forcings {
    pub(super) pushes: Vec<Forcing>,
    /// The speed on which the matrix depends.
    pub(super) speed: Option<Forcing>,
    pub(super) contacts: Vec<ContactForcing>,
}

/// What varies in time at a contact.
#[derive(Clone, Debug)]
pub(super) struct ContactForcing {
    /// v.
    pub(super) surface: Forcing,
    /// N₀ + ΔN.
    pub(super) load: Forcing,
    /// The part of N₀ + ΔN − N₀(0) without reaction on the structure.
    pub(super) guided: Forcing,
    /// Factor on the friction force.
    pub(super) factor: Option<Forcing>,
}

impl ContactForcing {
    /// Surface, load, guided part of the load, and factor.
    #[inline(always)]
    pub(super) fn all(&self) -> [Option<&Forcing>; 4] {
        [Some(&self.surface), Some(&self.load), Some(&self.guided), self.factor.as_ref()]
    }
}

/// N₀(t) − N₀(0) of a load over time on a contact with a normal row. What presses the contact on balances it at every moment, as it
/// balances a constant load: q is measured from the loaded rest of the moment. `None` where the load is constant or acts on no row.
fn balanced_change(contact: &Contact) -> Option<Profile> {
    let is_pressing = contact.normal.iter().flatten().any(|entry| *entry != 0.0);
    let varying = contact.varying_load.as_ref().filter(|_| is_pressing)?;
    Some(varying.clone().about(varying.mean() - contact.normal_load))
}

impl Forcings {
    /// Those of a system, set to a moment.
    pub(super) fn of(system: &System, clock: Clock) -> Self {
        let pushes = system.inputs.iter().filter(|input| is_push(&input.target));
        let pushes = pushes.map(|input| Forcing::of_profiles(&[&input.profile], clock)).collect();
        let contacts = system.contacts.iter().enumerate();
        let contacts = contacts
            .map(|(index, contact)| {
                let on_load = |guided_only: bool| {
                    let inputs = system.inputs.iter().filter(move |input| {
                        matches!(input.target, InputTarget::NormalLoad { contact, reaction }
                            if contact == index && !(guided_only && reaction))
                    });
                    inputs.map(|input| &input.profile)
                };
                let steady = contact.load();
                let loads: Vec<_> = std::iter::once(&steady).chain(on_load(false)).collect();
                let balanced = balanced_change(contact);
                let guided: Vec<_> = balanced.iter().chain(on_load(true)).collect();
                let factors = system.inputs.iter().filter(
                    |input| matches!(input.target, InputTarget::Friction { contact } if contact == index),
                );
                let factors: Vec<_> = factors.map(|input| &input.profile).collect();
                ContactForcing {
                    surface: Forcing::of_profiles(&[&contact.surface_velocity], clock),
                    load: Forcing::of_profiles(&loads, clock),
                    guided: Forcing::of_profiles(&guided, clock),
                    factor: (!factors.is_empty()).then(|| Forcing::of_profiles(&factors, clock)),
                }
            })
            .collect();
        let by_speed = system.structure.mechanical().and_then(Mechanical::by_speed);
        let speed = by_speed.map(|given| Forcing::of_profiles(&[&given.speed], clock));
        Self { pushes, speed, contacts }
    }

    /// Every forcing.
    pub(super) fn all(&self) -> impl Iterator<Item = &Forcing> {
        let contacts = self.contacts.iter().flat_map(ContactForcing::all);
        self.pushes.iter().chain(&self.speed).chain(contacts.flatten())
    }

    /// The next kink or jump.
    pub(super) fn next_break(&self) -> f64 {
        self.all().fold(f64::INFINITY, |next, forcing| next.min(forcing.next_break()))
    }

    /// Highest frequency of any wave.
    pub(super) fn highest_rate(&self) -> f64 {
        self.all().fold(0.0, |rate: f64, forcing| rate.max(forcing.highest_rate()))
    }

    /// Advances past every break that is not after `clock`.
    pub(super) fn pass_breaks(&mut self, clock: Clock) {
        self.pushes.iter_mut().for_each(|forcing| forcing.pass_breaks(clock));
        if let Some(speed) = &mut self.speed {
            speed.pass_breaks(clock);
        }
        for contact in &mut self.contacts {
            contact.surface.pass_breaks(clock);
            contact.load.pass_breaks(clock);
            contact.guided.pass_breaks(clock);
            if let Some(factor) = &mut contact.factor {
                factor.pass_breaks(clock);
            }
        }
    }
}

fn is_push(target: &InputTarget) -> bool {
    matches!(target, InputTarget::Force(_))
}

impl MotionEquations {
    pub(super) fn new(system: &System) -> Result<Self, Immobile> {
        let rows = system.structure.size();
        let mass = system.structure.mechanical().map(Mechanical::mass);
        let offset = if mass.is_some() { rows } else { 0 };
        let column = |row: &[f64]| -> Result<RowEntries, Immobile> {
            let Some(mass) = mass else { return Ok(RowEntries::at(row, 0)) };
            let right = Matrix::from_fn(rows, 1, |i, _| row[i]);
            let solved = mass.solve(&right).ok_or(Immobile::NoMass)?;
            Ok(RowEntries::at(solved.as_slice(), offset))
        };
        let matrix = state_matrix(&system.structure)?;
        let structure_size = matrix.rows();
        let contacts = system.contacts.iter().map(|contact| {
            let optional = |row: &Option<Vec<f64>>| match row {
                Some(row) => column(row),
                None => Ok(RowEntries::default()),
            };
            let along = match &contact.force {
                Some(force) => RowEntries::at(force, 0),
                None => optional(&contact.tangent)?,
            };
            contact_equation(contact, offset, along, optional(&contact.normal)?)
        });
        let mut contacts: Vec<ContactEquation> = contacts.collect::<Result<_, _>>()?;
        let size = places_of_states(system, &mut contacts, structure_size);
        let matrix = widened(&matrix, size);
        let pushes = system.inputs.iter().filter_map(|input| match &input.target {
            InputTarget::Force(row) => Some(column(row)),
            _ => None,
        });
        let pushes = pushes.collect::<Result<Vec<_>, _>>()?;
        let constant = column(system.structure.force())?.dense(size);
        let count = contacts.len();
        let product = |of: fn(&ContactEquation) -> &RowEntries| {
            Matrix::from_fn(count, count, |c, d| contacts[c].tangent.product(of(&contacts[d])))
        };
        let coupling = product(|contact| &contact.along);
        let follower = product(|contact| &contact.across);
        let by_speed = system.structure.mechanical().and_then(SpeedMatrices::of).transpose()?;
        let closed = rates::adhering(&matrix, &contacts);
        let closed = match &by_speed {
            Some(given) => given.largest(&closed),
            None => closed,
        };
        let rates = FastestRates::of(&system.structure, closed, &contacts);
        let follows = contacts.iter().any(|contact| !contact.slope.is_empty());
        let matrix = StateMatrix::of(&matrix);
        let plain = match &by_speed {
            None => PlainEquations::of(&matrix, &constant, &pushes, &contacts),
            Some(_) => None,
        };
        Ok(Self {
            size,
            structure_size,
            matrix,
            constant,
            pushes,
            by_speed,
            contacts,
            rates,
            coupling,
            follower,
            follows,
            plain,
        })
    }
}

/// Gives each contact with a state its place after the states of the structure. Returns the length of the whole state.
fn places_of_states(
    system: &System,
    contacts: &mut [ContactEquation],
    structure_size: usize,
) -> usize {
    let mut size = structure_size;
    for (equation, contact) in contacts.iter_mut().zip(&system.contacts) {
        equation.own = OwnState::of(contact, size);
        size += usize::from(equation.own.is_some());
    }
    size
}

/// A square matrix with rows and columns of zeros up to `size`.
fn widened(matrix: &Matrix, size: usize) -> Matrix {
    let known = matrix.rows();
    if size == known {
        return matrix.clone();
    }
    Matrix::from_fn(size, size, |i, j| if i < known && j < known { matrix[(i, j)] } else { 0.0 })
}

fn contact_equation(
    contact: &Contact,
    offset: usize,
    along: RowEntries,
    across: RowEntries,
) -> Result<ContactEquation, Immobile> {
    if let Some(why) = contact.friction.unsimulated() {
        return Err(Immobile::Law { contact: contact.name.clone(), why });
    }
    let row = |row: &Option<Vec<f64>>, offset| {
        row.as_ref().map(|row| RowEntries::at(row, offset)).unwrap_or_default()
    };
    let normal = contact.normal.as_deref().unwrap_or_default();
    let mut loads = vec![0.0; offset + contact.normal.as_ref().map_or(0, Vec::len)];
    for (place, entry) in normal.iter().enumerate() {
        if contact.normal_stiffness != 0.0 {
            loads[place] += contact.normal_stiffness * entry;
        }
        if contact.normal_damping != 0.0 {
            loads[offset + place] += contact.normal_damping * entry;
        }
    }
    Ok(ContactEquation {
        tangent: row(&contact.tangent, offset),
        approach: RowEntries::at(&loads, 0),
        slope: row(&contact.slope, 0),
        along,
        across,
        normal_load: contact.normal_load,
        scale: contact.friction.velocity_scale(),
        inverse_scale: 1.0 / contact.friction.velocity_scale(),
        static_coefficient: contact.friction.static_coefficient(),
        sliding_coefficient: contact.friction.coefficient(0.0),
        own: None,
    })
}

/// A of ẋ = A x without contacts.
fn state_matrix(structure: &Structure) -> Result<Matrix, Immobile> {
    let mechanical = match structure {
        Structure::StateSpace(states) => return Ok(states.matrix().clone()),
        Structure::Mechanical(mechanical) => mechanical,
    };
    let n = mechanical.size();
    let solved = |matrix: &Matrix| mechanical.mass().solve(matrix).ok_or(Immobile::NoMass);
    let (stiffness, damping) = (solved(mechanical.stiffness())?, solved(mechanical.damping())?);
    Ok(Matrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, _) => f64::from(u8::from(j == i + n)),
        (false, true) => -stiffness[(i - n, j)],
        (false, false) => -damping[(i - n, j - n)],
    }))
}
