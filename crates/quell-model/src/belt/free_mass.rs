//! A contact of a structure in the limit of high dither frequency, where springs and dampers do nothing: a free mass.

use quell_numerics::matrix::Matrix;

use super::Belt;
use super::one_mass::dither_of;
use crate::dither::{Direction, Dither};
use crate::profile::Profile;
use crate::system::{Contact, Input, InputTarget, System};

impl System {
    /// The belt with the fast motion of a contact in the limit of high dither frequency, where the masses of the structure are free: an input p
    /// moves the contact as tᵀM⁻¹p on a mass of 1, and its load and friction act as through tᵀM⁻¹t. Velocities and times are those of the
    /// system. Its spring and its damper stand for nothing.
    ///
    /// # Errors
    /// Why the contact has no such belt.
    ///
    /// ```
    /// use quell_model::{Belt, Coulomb, Dither, Direction, Friction, Waveform};
    ///
    /// let law = Friction::Coulomb(Coulomb::constant(0.4));
    /// let dither = Dither {
    ///     direction: Direction::Tangential,
    ///     waveform: Waveform::Sine,
    ///     amplitude: 0.3,
    ///     frequency_ratio: 10.0,
    ///     phase: 0.0,
    ///     envelope: None,
    /// };
    /// let belt = Belt::new(0.05, 1.0, 0.5, law, vec![dither])?;
    /// let limit = belt.system().free_mass(0).expect("a mass");
    /// assert_eq!(limit.fast_velocity(), belt.fast_velocity());
    /// # Ok::<(), quell_model::InvalidValues>(())
    /// ```
    pub fn free_mass(&self, contact: usize) -> Result<Belt, &'static str> {
        let own = &self.contacts[contact];
        let mechanical = self
            .structure
            .mechanical()
            .ok_or("first-order equations do not say which motions are of masses")?;
        let tangent = own.tangent.as_deref().ok_or("the contact moves no coordinate")?;
        steady(own)?;
        let rows = Matrix::from_fn(mechanical.size(), 1, |row, _| tangent[row]);
        let moved = mechanical.mass().solve(&rows).ok_or("the mass matrix is singular")?;
        // M is symmetric: tᵀM⁻¹p is (M⁻¹t)ᵀp.
        let along = |row: &[f64]| -> f64 {
            row.iter().enumerate().map(|(index, part)| moved[(index, 0)] * part).sum()
        };
        let mobility = along(tangent);
        if !(mobility.is_normal() && mobility > 0.0) {
            return Err("the contact moves no mass");
        }
        let (mut load, mut dithers) = (own.normal_load, Vec::new());
        for Input { target, profile } in &self.inputs {
            let (direction, share) = match target {
                InputTarget::Force(row) => (Direction::Tangential, along(row)),
                InputTarget::NormalLoad { contact: at, .. } if *at == contact => {
                    load += profile.mean();
                    (Direction::Normal, mobility)
                }
                InputTarget::NormalLoad { .. } | InputTarget::Friction { .. } => {
                    return Err("another contact, or friction itself, is dithered");
                }
            };
            dithers.extend(free_dithers(direction, share, profile)?);
        }
        let belt = Belt {
            damping_ratio: 0.0,
            normal_load: mobility * load,
            belt_velocity: own.surface_velocity.mean().abs(),
            friction: own.friction.clone(),
            dithers,
            tangential_stiffness: own.tangential_stiffness.map(|stiffness| mobility * stiffness),
            normal_stiffness: 0.0,
            drive: None,
            load: None,
            scales: None,
        };
        if belt.total_amplitude(Direction::Normal) > belt.normal_load {
            return Err("the dither opens the contact");
        }
        Ok(belt)
    }
}

/// Rejects a contact whose load or surface has a motion of its own.
fn steady(contact: &Contact) -> Result<(), &'static str> {
    if contact.normal.is_some() || contact.slope.is_some() {
        return Err("the load of the contact follows the motion");
    }
    let surface = &contact.surface_velocity;
    if contact.varying_load.is_some() || !surface.is_steady() || !surface.waves().is_empty() {
        return Err("the surface or the load of the contact varies in time");
    }
    Ok(())
}

fn free_dithers(
    direction: Direction,
    share: f64,
    profile: &Profile,
) -> Result<Vec<Dither>, &'static str> {
    if !profile.is_steady() {
        return Err("a dither varies in time");
    }
    let waves = profile.waves().iter().map(|wave| {
        let dither = dither_of(direction, share * wave.amplitude, (wave.frequency, wave));
        dither.ok_or("a dither pushes backwards, and has no mirror image")
    });
    waves.collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::Waveform;
    use crate::friction::LawKind;
    use crate::system::{MassMatrix, Mechanical};

    #[test]
    fn a_contact_of_two_masses_moves_as_its_own_mass() {
        let law = LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("valid");
        let dither = |direction, amplitude| Dither {
            direction,
            waveform: Waveform::Sine,
            amplitude,
            frequency_ratio: 10.0,
            phase: 0.0,
            envelope: None,
        };
        let dithers = vec![dither(Direction::Tangential, 0.3), dither(Direction::Normal, 0.5)];
        let belt = Belt::new(0.005, 1.0, 0.05, law, dithers).expect("valid");
        let mut system = belt.system();
        let two =
            |a: f64, b: f64| Matrix::from_fn(2, 2, |i, j| if i == j { [a, b][i] } else { 0.0 });
        let (names, mass) =
            (vec!["a".to_owned(), "b".to_owned()], MassMatrix::dense(two(4.0, 7.0)));
        system.structure = Mechanical::new(names, mass, two(0.1, 0.1), two(1.0, 1.0)).into();
        system.contacts[0].tangent = Some(vec![2.0, 0.0]);
        for input in &mut system.inputs {
            if let InputTarget::Force(row) = &mut input.target {
                *row = vec![-2.0, 5.0];
            }
        }
        let free = system.free_mass(0).expect("a mass");
        // tᵀM⁻¹t = 4/4.
        assert_eq!(free.normal_load(), 1.0);
        assert_eq!(free.dithers()[0].amplitude, 0.3);
        assert_eq!(free.dithers()[0].phase, PI);
        assert_eq!(free.dithers()[1], belt.dithers()[1]);
        let mut opened = system.clone();
        opened.contacts[0].normal_load = 0.4;
        assert_eq!(opened.free_mass(0), Err("the dither opens the contact"));
        system.contacts[0].normal = Some(vec![0.0, 1.0]);
        assert!(system.free_mass(0).is_err());
    }
}
