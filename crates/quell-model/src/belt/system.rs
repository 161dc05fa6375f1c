//! A belt as a system of one coordinate, in the numbers of the equations or in SI.

use quell_numerics::matrix::Matrix;

use super::Belt;
use crate::InvalidValues;
use crate::dither::Direction;
use crate::friction::Surroundings;
use crate::profile::Profile;
use crate::system::{Contact, Input, InputTarget, MassMatrix, Mechanical, System};
use crate::units::{Quantity, Scales, UnitValues};

impl Belt {
    /// One coordinate of unit mass and stiffness; its contact is loaded by F, and normal dither has no reaction (4.1).
    pub fn system(&self) -> System {
        let one = |value: f64| Matrix::from_fn(1, 1, |_, _| value);
        let structure = Mechanical::new(
            vec!["x".to_owned()],
            MassMatrix::identity(1),
            one(2.0 * self.damping_ratio),
            one(1.0),
        );
        let velocity = self.drive.clone().unwrap_or_else(|| Profile::constant(self.belt_velocity));
        let contact = Contact {
            name: "belt".to_owned(),
            tangent: Some(vec![1.0]),
            force: None,
            normal: None,
            slope: None,
            normal_load: self.normal_load,
            varying_load: self.load.clone(),
            normal_stiffness: self.normal_stiffness,
            normal_damping: 0.0,
            surface_velocity: velocity,
            friction: self.friction.clone(),
            tangential_stiffness: self.tangential_stiffness,
        };
        let inputs = self.dithers.iter().map(|dither| Input {
            target: match dither.direction {
                Direction::Tangential => InputTarget::Force(vec![1.0]),
                Direction::Normal => InputTarget::NormalLoad { contact: 0, reaction: false },
            },
            profile: Profile::default().with(dither.wave()),
        });
        System { structure: structure.into(), contacts: vec![contact], inputs: inputs.collect() }
    }

    /// The system of a belt with mass and stiffness in SI: kilogram, metre, second and newton, frequencies angular. `None` without
    /// them.
    ///
    /// # Errors
    /// A law whose numbers are out of their bounds in metres per second.
    pub fn system_in_units(&self) -> Option<Result<System, InvalidValues>> {
        let unit = units_of(&self.scales?);
        let Surroundings { normal_load, slip } = self.surroundings();
        // F is a length over 1/ω₀ here, so that a law without a velocity of its own is counted in a velocity.
        let around =
            Surroundings { normal_load: unit.velocity * normal_load, slip: unit.velocity * slip };
        Some(self.system().in_units(&unit).and_then(|mut system| {
            for contact in &mut system.contacts {
                contact.friction = contact.friction.placed(&around)?;
            }
            Ok(system)
        }))
    }
}

/// Lengths of a belt are metres.
fn units_of(scales: &Scales) -> UnitValues {
    let of = |quantity| scales.per_unit(quantity);
    UnitValues {
        mass: of(Quantity::Mass),
        length: 1.0,
        time: of(Quantity::Time),
        force: of(Quantity::Force),
        velocity: of(Quantity::Velocity),
    }
}
