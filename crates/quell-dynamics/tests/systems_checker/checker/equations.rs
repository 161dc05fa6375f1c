//! The equations of a system with given modes of its contacts, assembled entry by entry.

use quell_model::System;
use quell_model::friction::Friction;
use quell_model::system::{Contact, InputTarget, Structure};
use quell_numerics::matrix::Matrix;

use super::Unchecked;
use super::decision::Contest;
use super::linear::{dot, solve_in_place};
use super::waves::{Smooth, jumps, next_break};

/// What a contact does between two events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// Slips; the sign is that of the slip velocity.
    Slip(i8),
    /// Sticks.
    Stick,
    /// Is open.
    Open,
}

/// The profiles of a system between two breaks.
#[derive(Clone, Debug)]
pub(super) struct Drive {
    inputs: Vec<Smooth>,
    surfaces: Vec<Smooth>,
}

/// Contact quantities and the rate of the state at one instant.
#[derive(Clone, Debug)]
pub(super) struct Instant {
    /// ẏ.
    pub(super) rate: Vec<f64>,
    /// Slip velocities γ.
    pub(super) slip: Vec<f64>,
    /// Normal loads N; of an open contact the negative value that a contact able to pull would have.
    pub(super) load: Vec<f64>,
    /// Friction forces T.
    pub(super) force: Vec<f64>,
    /// Slopes sᵀq of the surfaces.
    tilt: Vec<f64>,
}

/// The equations ẋ = A x + … with a column for each force that enters.
#[derive(Clone, Debug)]
pub(super) struct Equations<'a> {
    /// The system.
    pub(super) system: &'a System,
    /// Length of a row, and the first entry of the state whose rate depends on forces.
    rows: usize,
    offset: usize,
    /// Rates of the entries from `offset` on by the state, without contacts.
    matrix: Matrix,
    constant: Vec<f64>,
    /// Columns M⁻¹t (or g) and M⁻¹n of each contact, M⁻¹b of each input.
    along: Vec<Vec<f64>>,
    across: Vec<Vec<f64>>,
    pushed: Vec<Vec<f64>>,
    /// Rows t, n and s of each contact, zero where it has none.
    tangent: Vec<Vec<f64>>,
    normal: Vec<Vec<f64>>,
    slope: Vec<Vec<f64>>,
}

impl<'a> Equations<'a> {
    /// Assembles the equations.
    ///
    /// # Errors
    /// What this checker does not cover, or a singular mass matrix.
    pub(super) fn new(system: &'a System) -> Result<Self, Unchecked> {
        covered(system)?;
        let rows = system.structure.size();
        let inverse = inverse_mass(&system.structure)?;
        let row = |row: &Option<Vec<f64>>| row.clone().unwrap_or_else(|| vec![0.0; rows]);
        let column =
            |row: &[f64]| -> Vec<f64> { (0..rows).map(|i| dot(inverse.row(i), row)).collect() };
        let contacts = &system.contacts;
        let tangent: Vec<_> = contacts.iter().map(|contact| row(&contact.tangent)).collect();
        let normal: Vec<_> = contacts.iter().map(|contact| row(&contact.normal)).collect();
        let slope = contacts.iter().map(|contact| row(&contact.slope)).collect();
        let along = contacts.iter().zip(&tangent);
        let along = along
            .map(|(contact, tangent)| contact.force.clone().unwrap_or_else(|| column(tangent)));
        let pushed = system.inputs.iter().map(|input| match &input.target {
            InputTarget::Force(row) => column(row),
            _ => vec![0.0; rows],
        });
        let mechanical = system.structure.mechanical();
        let matrix = match &system.structure {
            Structure::Mechanical(structure) => {
                let by_position = inverse.times(structure.stiffness());
                let by_velocity = inverse.times(structure.damping());
                Matrix::from_fn(rows, 2 * rows, |i, j| {
                    if j < rows { -by_position.row(i)[j] } else { -by_velocity.row(i)[j - rows] }
                })
            }
            Structure::StateSpace(structure) => structure.matrix().clone(),
        };
        Ok(Self {
            system,
            rows,
            offset: if mechanical.is_some() { rows } else { 0 },
            matrix,
            constant: column(system.structure.force()),
            along: along.collect(),
            across: normal.iter().map(|normal| column(normal)).collect(),
            pushed: pushed.collect(),
            tangent,
            normal,
            slope,
        })
    }

    /// Number of entries of the state.
    pub(super) fn size(&self) -> usize {
        self.offset + self.rows
    }

    /// The contact of an index.
    pub(super) fn contact(&self, contact: usize) -> &Contact {
        &self.system.contacts[contact]
    }

    /// Whether a contact can open.
    pub(super) fn is_compliant(&self, contact: usize) -> bool {
        self.contact(contact).normal.is_some()
    }

    /// An instant with room for the numbers of this system.
    pub(super) fn instant(&self) -> Instant {
        let contacts = vec![0.0; self.system.contacts.len()];
        Instant {
            rate: vec![0.0; self.size()],
            slip: contacts.clone(),
            load: contacts.clone(),
            force: contacts.clone(),
            tilt: contacts,
        }
    }

    /// The first kink or jump of any profile after a time.
    pub(super) fn next_break(&self, after: f64) -> f64 {
        let inputs = self.system.inputs.iter().map(|input| &input.profile);
        let surfaces = self.system.contacts.iter().map(|contact| &contact.surface_velocity);
        inputs
            .chain(surfaces)
            .map(|profile| next_break(profile, after))
            .fold(f64::INFINITY, f64::min)
    }

    /// The profiles between two times without a break between them.
    pub(super) fn drive(&self, from: f64, to: f64) -> Drive {
        let inputs = self.system.inputs.iter().map(|input| &input.profile);
        let surfaces = self.system.contacts.iter().map(|contact| &contact.surface_velocity);
        Drive {
            inputs: inputs.map(|profile| Smooth::between(profile, from, to)).collect(),
            surfaces: surfaces.map(|profile| Smooth::between(profile, from, to)).collect(),
        }
    }

    /// Everything at one instant, for given modes.
    pub(super) fn evaluate(
        &self,
        drive: &Drive,
        time: f64,
        state: &[f64],
        modes: &[Mode],
        at: &mut Instant,
    ) {
        self.evaluate_free(drive, time, state, modes, at);
        if modes.contains(&Mode::Stick) {
            self.hold(drive, time, modes, at);
        }
    }

    /// Everything at one instant, without the forces of sticking contacts.
    fn evaluate_free(
        &self,
        drive: &Drive,
        time: f64,
        state: &[f64],
        modes: &[Mode],
        at: &mut Instant,
    ) {
        let (position, velocity) = (&state[..self.rows], &state[self.offset..]);
        at.rate[..self.offset].copy_from_slice(&state[self.size() - self.offset..]);
        for i in 0..self.rows {
            at.rate[self.offset + i] = self.constant[i] + dot(self.matrix.row(i), state);
        }
        for (profile, column) in drive.inputs.iter().zip(&self.pushed) {
            self.push(profile.value(time), column, at);
        }
        for (c, &mode) in modes.iter().enumerate() {
            let contact = self.contact(c);
            let approach = contact.normal_stiffness * dot(&self.normal[c], position)
                + contact.normal_damping * dot(&self.normal[c], velocity);
            let (reacted, guided) = self.modulation(drive, c, time);
            let load = contact.normal_load + reacted + guided + approach;
            // An open contact reacts as one without load: N − N₀ and what guides do not take of it.
            let reaction =
                if mode == Mode::Open { -contact.normal_load - guided } else { approach + reacted };
            if self.is_compliant(c) {
                self.push(-reaction, &self.across[c], at);
            }
            at.slip[c] = drive.surfaces[c].value(time) - dot(&self.tangent[c], velocity);
            at.load[c] = load;
            at.tilt[c] = dot(&self.slope[c], position);
            at.force[c] = 0.0;
            if let Mode::Slip(sign) = mode {
                let sign = f64::from(sign);
                self.rub(c, sign * branch(&contact.friction, sign * at.slip[c]) * load, at);
            }
        }
    }

    /// Adds the forces that keep the sticking contacts at rest.
    fn hold(&self, drive: &Drive, time: f64, modes: &[Mode], at: &mut Instant) {
        let (contacts, mut forces, mut coupling) = self.balance(drive, time, modes, at);
        if !solve_in_place(&mut coupling, &mut forces) {
            forces.fill(f64::NAN);
        }
        for (&c, &force) in contacts.iter().zip(&forces) {
            self.rub(c, force, at);
        }
    }

    /// The sticking contacts, their slip accelerations without their own forces, and the matrix G by rows.
    fn balance(
        &self,
        drive: &Drive,
        time: f64,
        modes: &[Mode],
        at: &Instant,
    ) -> (Vec<usize>, Vec<f64>, Vec<f64>) {
        let contacts: Vec<usize> = (0..modes.len()).filter(|&c| modes[c] == Mode::Stick).collect();
        let free = |&c: &usize| {
            drive.surfaces[c].rate(time) - dot(&self.tangent[c], &at.rate[self.offset..])
        };
        let acceleration = contacts.iter().map(free).collect();
        let mut coupling = Vec::with_capacity(contacts.len() * contacts.len());
        for &c in &contacts {
            for &d in &contacts {
                let across = dot(&self.tangent[c], &self.across[d]);
                coupling.push(dot(&self.tangent[c], &self.along[d]) + at.tilt[d] * across);
            }
        }
        (contacts, acceleration, coupling)
    }

    /// The decision among the contacts whose mode is `Stick`.
    pub(super) fn contest(
        &self,
        drive: &Drive,
        time: f64,
        state: &[f64],
        modes: &[Mode],
    ) -> (Vec<usize>, Contest) {
        let mut at = self.instant();
        self.evaluate_free(drive, time, state, modes, &mut at);
        let (contacts, acceleration, coupling) = self.balance(drive, time, modes, &at);
        let law = |c: usize| &self.contact(c).friction;
        let static_bounds =
            contacts.iter().map(|&c| law(c).static_coefficient() * at.load[c]).collect();
        let sliding_bounds =
            contacts.iter().map(|&c| law(c).coefficient(0.0) * at.load[c]).collect();
        (contacts, Contest { acceleration, coupling, static_bounds, sliding_bounds })
    }

    /// Lets the friction force of a contact act on the structure.
    fn rub(&self, contact: usize, force: f64, at: &mut Instant) {
        at.force[contact] = force;
        self.push(force, &self.along[contact], at);
        let tilted = force * at.tilt[contact];
        if tilted != 0.0 {
            self.push(tilted, &self.across[contact], at);
        }
    }

    /// Adds a force along a column.
    fn push(&self, force: f64, column: &[f64], at: &mut Instant) {
        for (rate, entry) in at.rate[self.offset..].iter_mut().zip(column) {
            *rate += force * entry;
        }
    }

    /// The modulation of the load of a contact: with reaction on the structure, and taken by guides.
    fn modulation(&self, drive: &Drive, at: usize, time: f64) -> (f64, f64) {
        let mut sums = (0.0, 0.0);
        for (input, profile) in self.system.inputs.iter().zip(&drive.inputs) {
            match input.target {
                InputTarget::NormalLoad { contact, reaction: true } if contact == at => {
                    sums.0 += profile.value(time);
                }
                InputTarget::NormalLoad { contact, reaction: false } if contact == at => {
                    sums.1 += profile.value(time);
                }
                _ => {}
            }
        }
        sums
    }
}

/// Fails where the checker does not cover a system.
fn covered(system: &System) -> Result<(), Unchecked> {
    let fail = |why: &str| Err(Unchecked::Failed(why.to_owned()));
    let states = system.structure.mechanical().is_none();
    for contact in &system.contacts {
        if states && (contact.normal.is_some() || contact.slope.is_some()) {
            return fail("a normal or slope row over the states of first-order equations");
        }
        if states != contact.force.is_some() {
            return fail(
                "the column g of a contact belongs to first-order equations, and only there",
            );
        }
        if jumps(&contact.surface_velocity) {
            return fail("a surface velocity that jumps");
        }
    }
    for input in &system.inputs {
        if matches!(input.target, InputTarget::Friction { .. }) {
            return fail("a factor on the friction force");
        }
    }
    Ok(())
}

/// M⁻¹, or the identity for first-order equations.
fn inverse_mass(structure: &Structure) -> Result<Matrix, Unchecked> {
    let identity = Matrix::identity(structure.size());
    let Some(mechanical) = structure.mechanical() else { return Ok(identity) };
    let inverse = mechanical.mass().matrix().solve(&identity);
    inverse.ok_or_else(|| Unchecked::Failed("singular mass matrix".to_owned()))
}

/// The sliding coefficient, continued smoothly beyond zero slip speed.
///
/// Trial steps that end just beyond a stop need the continuation; no result does.
fn branch(friction: &Friction, speed: f64) -> f64 {
    if speed >= 0.0 {
        friction.coefficient(speed)
    } else {
        2.0 * friction.coefficient(0.0) - friction.coefficient(-speed)
    }
}
