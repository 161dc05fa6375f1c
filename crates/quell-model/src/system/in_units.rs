//! A system whose numbers are scaled, in other units.

use quell_numerics::matrix::Matrix;

use super::{
    Contact, Input, InputTarget, MassMatrix, Mechanical, SpeedDependence, Structure, System,
};
use crate::profile::Profile;
use crate::units::UnitValues;
use crate::{Invalid, InvalidValues};

/// A profile whose values have this unit.
fn in_unit(profile: &Profile, own: f64, unit: &UnitValues) -> Profile {
    profile.scaled(own).in_time_unit(unit.time)
}

impl System {
    /// The same motions in other units, of a mechanical structure whose coordinates are lengths.
    ///
    /// # Errors
    /// A law whose numbers are out of their bounds in the other units; first-order equations, whose states may be anything.
    pub fn in_units(&self, unit: &UnitValues) -> Result<Self, InvalidValues> {
        let Structure::Mechanical(structure) = &self.structure else {
            let allowed = "coordinates: the states of first-order equations may be any quantities";
            return Err(Invalid::new("system.states", "given", allowed).into());
        };
        let contacts = self.contacts.iter().map(|contact| contact.in_units(unit));
        let inputs = self.inputs.iter().map(|input| {
            let own = match input.target {
                InputTarget::Force(_) | InputTarget::NormalLoad { .. } => unit.force,
                InputTarget::Friction { .. } => 1.0,
            };
            let profile = in_unit(&input.profile, own, unit);
            Input { target: input.target.clone(), profile }
        });
        Ok(Self {
            structure: structure.in_units(unit).into(),
            inputs: inputs.collect(),
            contacts: contacts.collect::<Result<_, InvalidValues>>()?,
        })
    }
}

impl Contact {
    fn in_units(&self, unit: &UnitValues) -> Result<Self, InvalidValues> {
        let spring = |stiffness: f64| stiffness * unit.force / unit.length;
        Ok(Self {
            // A slope is an angle for a length.
            slope: self.slope.as_ref().map(|row| row.iter().map(|s| s / unit.length).collect()),
            normal_load: unit.force * self.normal_load,
            varying_load: self.varying_load.as_ref().map(|load| in_unit(load, unit.force, unit)),
            normal_stiffness: spring(self.normal_stiffness),
            normal_damping: self.normal_damping * unit.force / unit.velocity,
            surface_velocity: in_unit(&self.surface_velocity, unit.velocity, unit),
            friction: self.friction.in_units(unit)?,
            tangential_stiffness: self.tangential_stiffness.map(spring),
            ..self.clone()
        })
    }
}

impl Mechanical {
    fn in_units(&self, unit: &UnitValues) -> Self {
        let times = |matrix: &Matrix, factor: &dyn Fn(f64) -> f64| {
            Matrix::from_fn(matrix.rows(), matrix.columns(), |i, j| factor(matrix[(i, j)]))
        };
        let mass = match unit.mass {
            1.0 => self.mass().clone(),
            own => MassMatrix::dense(times(&self.mass().matrix(), &|mass| own * mass)),
        };
        let damper = |value: f64| value * unit.force / unit.velocity;
        let spring = |value: f64| value * unit.force / unit.length;
        let scaled = Self::new(
            self.coordinates().to_vec(),
            mass,
            times(self.damping(), &damper),
            times(self.stiffness(), &spring),
        );
        let scaled = scaled.under(self.force().iter().map(|force| unit.force * force).collect());
        let Some(by_speed) = self.by_speed() else { return scaled };
        let time = unit.time;
        scaled.at_speed(SpeedDependence {
            speed: in_unit(&by_speed.speed, time.recip(), unit),
            damping: times(&by_speed.damping, &|value| damper(value) * time),
            stiffness: times(&by_speed.stiffness, &|value| spring(value) * time),
            square: times(&by_speed.square, &|value| spring(value) * time * time),
            rate: times(&by_speed.rate, &|value| spring(value) * time * time),
        })
    }
}
