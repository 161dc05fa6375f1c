//! A belt as a system of one coordinate, in the numbers of the equations or in SI.

use quell_numerics::matrix::Matrix;

use super::Belt;
use crate::InvalidValues;
use crate::dither::Direction;
use crate::friction::{Friction, Surroundings};
use crate::profile::Profile;
use crate::system::{Contact, Input, InputTarget, MassMatrix, Mechanical, System};
use crate::units::{Quantity, Scales};

/// The values of one unit of the numbers of the equations.
struct UnitValues {
    mass: f64,
    force: f64,
    velocity: f64,
    time: f64,
}

impl UnitValues {
    const SCALED: Self = Self { mass: 1.0, force: 1.0, velocity: 1.0, time: 1.0 };

    fn in_si(scales: &Scales) -> Self {
        let of = |quantity| scales.per_unit(quantity);
        Self {
            mass: of(Quantity::Mass),
            force: of(Quantity::Force),
            velocity: of(Quantity::Velocity),
            time: of(Quantity::Time),
        }
    }
}

impl Belt {
    /// One coordinate of unit mass and stiffness; its contact is loaded by F, and normal dither has no reaction (4.1).
    pub fn system(&self) -> System {
        self.system_of(&UnitValues::SCALED, self.friction.clone())
    }

    /// The system of a belt with mass and stiffness in SI: kilogram, metre, second and newton, frequencies angular. `None` without
    /// them.
    ///
    /// # Errors
    /// A law whose numbers are out of their bounds in metres per second.
    pub fn system_in_units(&self) -> Option<Result<System, InvalidValues>> {
        let scales = self.scales?;
        let unit = UnitValues::in_si(&scales);
        let Surroundings { normal_load, slip } = self.surroundings();
        // F is a length over 1/ω₀ here, so that a law without a velocity of its own is counted in a velocity.
        let around =
            Surroundings { normal_load: unit.velocity * normal_load, slip: unit.velocity * slip };
        let friction = self.friction.in_si(&scales).and_then(|law| law.placed(&around));
        Some(friction.map(|friction| self.system_of(&unit, friction)))
    }

    fn system_of(&self, unit: &UnitValues, friction: Friction) -> System {
        let one = |value: f64| Matrix::from_fn(1, 1, |_, _| value);
        let force = |profile: &Profile| profile.scaled(unit.force).in_time_unit(unit.time);
        let mass = match unit.mass {
            1.0 => MassMatrix::identity(1),
            mass => MassMatrix::dense(one(mass)),
        };
        let structure = Mechanical::new(
            vec!["x".to_owned()],
            mass,
            one(2.0 * self.damping_ratio * unit.force / unit.velocity),
            one(unit.force),
        );
        let velocity = self.drive.clone().unwrap_or_else(|| Profile::constant(self.belt_velocity));
        let contact = Contact {
            name: "belt".to_owned(),
            tangent: Some(vec![1.0]),
            force: None,
            normal: None,
            slope: None,
            normal_load: unit.force * self.normal_load,
            varying_load: self.load.as_ref().map(force),
            normal_stiffness: 0.0,
            normal_damping: 0.0,
            surface_velocity: velocity.scaled(unit.velocity).in_time_unit(unit.time),
            friction,
            tangential_stiffness: self.tangential_stiffness.map(|stiffness| unit.force * stiffness),
        };
        let inputs = self.dithers.iter().map(|dither| Input {
            target: match dither.direction {
                Direction::Tangential => InputTarget::Force(vec![1.0]),
                Direction::Normal => InputTarget::NormalLoad { contact: 0, reaction: false },
            },
            profile: force(&Profile::default().with(dither.wave())),
        });
        System { structure: structure.into(), contacts: vec![contact], inputs: inputs.collect() }
    }
}
