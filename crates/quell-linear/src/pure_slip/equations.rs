//! The equations of motion while every contact slips, and their derivative.

use quell_model::System;
use quell_model::system::{InputTarget, Mechanical};
use quell_numerics::matrix::Matrix;

use crate::linearised::Linearised;
use crate::steady::{NoSteadySliding, entry};

/// Contact quantities at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Instant {
    /// Slip velocity over its mean direction: positive while the contact slips as in steady sliding.
    pub(super) slip: f64,
    pub(super) normal_load: f64,
}

/// ẏ = f(t, y) with every contact slipping in the direction of its mean velocity.
#[derive(Debug)]
pub(super) struct PureSlip<'a> {
    system: &'a System,
    /// State matrix with the springs and dampers of the contacts, without friction.
    base: Matrix,
    constant: Vec<f64>,
    /// Columns M⁻¹t (or g), M⁻¹n and M⁻¹b of each input.
    along: Vec<Vec<f64>>,
    across: Vec<Vec<f64>>,
    pushed: Vec<Vec<f64>>,
    /// Number of coordinates, and the offset of velocities in a state.
    rows: usize,
    offset: usize,
}

impl<'a> PureSlip<'a> {
    pub(super) fn new(system: &'a System) -> Result<Self, NoSteadySliding> {
        let rows = system.structure.size();
        let linear = Linearised::frictionless(system)?;
        let none: Vec<f64> = vec![0.0; system.contacts.len()];
        let base = linear.state_matrix(&none);
        let mass = system.structure.mechanical().map(Mechanical::mass);
        let column = |row: &[f64]| -> Result<Vec<f64>, NoSteadySliding> {
            let Some(mass) = mass else { return Ok(row.to_vec()) };
            let right = Matrix::from_fn(rows, 1, |i, _| row[i]);
            Ok(mass.solve(&right).ok_or(NoSteadySliding::NoMass)?.as_slice().to_vec())
        };
        let none = vec![0.0; rows];
        let contacts = &system.contacts;
        let along = contacts.iter().map(|contact| match (&contact.force, &contact.tangent) {
            (Some(force), _) => Ok(force.clone()),
            (None, Some(tangent)) => column(tangent),
            (None, None) => Ok(none.clone()),
        });
        let across = contacts.iter().map(|contact| match &contact.normal {
            Some(normal) => column(normal),
            None => Ok(none.clone()),
        });
        let pushed = system.inputs.iter().map(|input| match &input.target {
            InputTarget::Force(row) => column(row),
            _ => Ok(none.clone()),
        });
        let (along, across) = (along.collect::<Result<_, _>>()?, across.collect::<Result<_, _>>()?);
        let pushed = pushed.collect::<Result<_, _>>()?;
        let offset = if mass.is_some() { rows } else { 0 };
        let constant = column(system.structure.force())?;
        Ok(Self { system, base, constant, along, across, pushed, rows, offset })
    }

    pub(super) fn size(&self) -> usize {
        self.base.rows()
    }

    /// Slip velocity and load of a contact.
    pub(super) fn instant(&self, contact: usize, time: f64, y: &[f64]) -> Instant {
        let (slip, normal_load, _) = self.at(contact, time, y);
        let direction = self.system.contacts[contact].surface_velocity.mean().signum();
        Instant { slip: direction * slip, normal_load }
    }

    /// Slip velocity γ, load N, and what modulates the load.
    fn at(&self, contact: usize, time: f64, y: &[f64]) -> (f64, f64, f64) {
        let given = &self.system.contacts[contact];
        let (position, velocity) = (&y[..self.rows], &y[self.offset..]);
        let dot = |row: &Option<Vec<f64>>, x: &[f64]| -> f64 {
            row.iter().flat_map(|row| row.iter().zip(x)).map(|(r, x)| r * x).sum()
        };
        let modulation: f64 = self
            .system
            .inputs
            .iter()
            .filter(|input| {
                matches!(input.target, InputTarget::NormalLoad { contact: at, .. } if at == contact)
            })
            .map(|input| input.profile.value(time))
            .sum();
        let load = given.normal_load
            + modulation
            + given.normal_stiffness * dot(&given.normal, position)
            + given.normal_damping * dot(&given.normal, velocity);
        (given.surface_velocity.value(time) - dot(&given.tangent, velocity), load, modulation)
    }

    /// The factor on the friction force of a contact.
    fn factor(&self, contact: usize, time: f64) -> f64 {
        let on_it = |target: &InputTarget| matches!(target, InputTarget::Friction { contact: at } if *at == contact);
        let mut factors = self.system.inputs.iter().filter(|input| on_it(&input.target)).peekable();
        if factors.peek().is_none() {
            return 1.0;
        }
        factors.map(|input| input.profile.value(time)).sum()
    }

    /// ẏ, and A(t) = ∂ẏ/∂y if wanted.
    pub(super) fn slope(
        &self,
        time: f64,
        y: &[f64],
        slope: &mut [f64],
        matrix: Option<&mut Matrix>,
    ) {
        let (rows, offset) = (self.rows, self.offset);
        for (i, value) in slope.iter_mut().enumerate() {
            *value = self.base.row(i).iter().zip(y).map(|(a, y)| a * y).sum();
        }
        for i in 0..rows {
            slope[offset + i] += self.constant[i];
        }
        for (input, column) in self.system.inputs.iter().zip(&self.pushed) {
            let value = input.profile.value(time);
            match input.target {
                InputTarget::Force(_) => add(&mut slope[offset..], value, column),
                InputTarget::NormalLoad { contact, reaction: true } => {
                    add(&mut slope[offset..], -value, &self.across[contact]);
                }
                _ => {}
            }
        }
        let mut matrix = matrix;
        if let Some(matrix) = &mut matrix {
            matrix.clone_from(&self.base);
        }
        for (index, contact) in self.system.contacts.iter().enumerate() {
            let (slip, load, _) = self.at(index, time, y);
            let direction = contact.surface_velocity.mean().signum();
            // The branch of steady sliding, continued to zero slip; what lies beyond is no pure slip.
            let speed = (direction * slip).max(0.0);
            let factor = self.factor(index, time);
            let coefficient = factor * direction * contact.friction.coefficient(speed);
            let force = coefficient * load;
            let tilt: f64 = (0..rows).map(|i| entry(contact.slope.as_deref(), i) * y[i]).sum();
            let along = |i: usize| self.along[index][i] + tilt * self.across[index][i];
            for i in 0..rows {
                slope[offset + i] += along(i) * force;
            }
            let Some(matrix) = &mut matrix else { continue };
            let by_velocity = factor * contact.friction.slope(speed) * load;
            for i in 0..rows {
                let (own, across) = (along(i), self.across[index][i]);
                let row = matrix.row_mut(offset + i);
                for j in 0..rows {
                    row[j] += across * force * entry(contact.slope.as_deref(), j);
                    row[offset + j] -= own * by_velocity * entry(contact.tangent.as_deref(), j);
                    let normal = entry(contact.normal.as_deref(), j);
                    row[j] += own * coefficient * contact.normal_stiffness * normal;
                    row[offset + j] += own * coefficient * contact.normal_damping * normal;
                }
            }
        }
    }
}

fn add(to: &mut [f64], factor: f64, column: &[f64]) {
    for (entry, value) in to.iter_mut().zip(column) {
        *entry += factor * value;
    }
}
