//! What a friction law depends on at a contact of a system.

use quell_numerics::matrix::Matrix;

use super::{Contact, InputTarget, Structure, System};
use crate::friction::Surroundings;
use crate::profile::Wave;

impl System {
    /// The load of a contact, and the largest slip speed that its surface and its dither reach together: up to a multiple of it a formula
    /// is proven. That of the surface is its largest speed, that of the dither the fast velocity of the contact in the limit of high
    /// frequency, where masses are free: Σ |tᵀM⁻¹b| A max|G|/ω over forces, of loads μ_s times |tᵀM⁻¹t|.
    pub fn surroundings(&self, contact: usize) -> Surroundings {
        let slip = self.contacts[contact].surface_velocity.bounds().magnitude();
        let normal_load = self.contacts[contact].normal_load;
        Surroundings { normal_load, slip: slip + self.fast_velocity(contact) }
    }

    /// The largest fast velocity of a contact in the limit of high frequency.
    fn fast_velocity(&self, contact: usize) -> f64 {
        let Contact { tangent, force, friction, .. } = &self.contacts[contact];
        let Some(tangent) = tangent.as_deref().filter(|_| self.has_waves()) else { return 0.0 };
        let moved = self.moved_by(tangent);
        let own = product(force.as_deref().unwrap_or(&moved), tangent);
        let speeds = self.inputs.iter().map(|input| {
            let effect = match &input.target {
                InputTarget::Force(row) => product(row, &moved),
                InputTarget::NormalLoad { contact: at, .. } if *at == contact => {
                    friction.static_coefficient() * own
                }
                InputTarget::NormalLoad { .. } | InputTarget::Friction { .. } => 0.0,
            };
            effect.abs() * input.profile.waves().iter().map(speed_per_effect).sum::<f64>()
        });
        speeds.sum()
    }

    /// Velocities after a unit impulse on a row, M⁻¹t, by whose symmetry tᵀM⁻¹b follows for every b; of first-order equations t itself.
    /// 0 where the mass is singular.
    fn moved_by(&self, row: &[f64]) -> Vec<f64> {
        match &self.structure {
            Structure::Mechanical(structure) => {
                let column = Matrix::from_fn(row.len(), 1, |i, _| row[i]);
                let moved = structure.mass().solve(&column);
                moved.map_or_else(|| vec![0.0; row.len()], |moved| moved.as_slice().to_vec())
            }
            Structure::StateSpace(_) => row.to_vec(),
        }
    }
}

fn product(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

/// A max|G|/ω of a wave.
fn speed_per_effect(wave: &Wave) -> f64 {
    wave.amplitude * wave.waveform.peak_integral() / wave.frequency
}

#[cfg(test)]
mod tests {
    use crate::friction::Friction;
    use crate::{Belt, Direction, Dither, LawKind, Waveform};

    /// A belt and its system have one range, along the belt and on the load.
    #[test]
    fn the_range_of_a_belt_is_that_of_its_system() {
        let law = || -> Friction { LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]).expect("a law") };
        for (direction, waveform) in [
            (Direction::Tangential, Waveform::Sine),
            (Direction::Tangential, Waveform::Square),
            (Direction::Normal, Waveform::Triangle),
        ] {
            let (amplitude, frequency_ratio, phase) = (0.5, 10.0, 0.0);
            let dither =
                Dither { direction, waveform, amplitude, frequency_ratio, phase, envelope: None };
            let belt = Belt::new(0.01, 1.0, 0.2, law(), vec![dither]).expect("a belt");
            let around = belt.system().surroundings(0);
            assert_eq!(around.normal_load, 1.0);
            let slip = belt.belt_velocity() + belt.fast_velocity();
            assert!((around.slip - slip).abs() < 1e-15 * slip, "{} {slip}", around.slip);
            assert!(slip > 0.2 + 0.015);
        }
    }
}
