//! The steady response of a sliding system to one dither at its driven point: stroke, velocity, power.
//!
//! The motion is that of [`crate::driven_point`]. A force b u(t) has the stroke of bᵀq, the largest velocity |bᵀq̇|, and the mean power
//! ⟨u bᵀq̇⟩. A modulation of the load of a contact has those of an actuator in series with it. Of one mass it is [`crate::linear_cost`].
//! Noise has root mean squares alone, sums over its lines.

use num_complex::Complex64;
use quell_model::System;
use quell_model::profile::Wave;
use quell_model::system::InputTarget;
use quell_model::waveform::WaveSine;

use crate::driven_point::{DrivenPoint, NoDrivenPoint, PointOutput};
use crate::harmonic;
use crate::linear_cost::{LinearCost, NoiseCost};
use crate::linearised::Linearised;
use crate::periodic_response::NoPeriodicResponse;
use crate::series_actuator::NoSeriesActuator;

/// Stroke and largest velocity of the driven point, and mean power of a wave, in the units of the system.
///
/// # Errors
/// [`NoDrivenPoint`].
pub fn input_cost(
    system: &System,
    sliding: &Linearised,
    target: &InputTarget,
    wave: &Wave,
) -> Result<LinearCost, NoDrivenPoint> {
    let point = DrivenPoint::of_input(system, sliding, target, &wave.waveform, wave.frequency)?;
    let wanted = [PointOutput::DISPLACEMENT, PointOutput::VELOCITY, PointOutput::FORCE];
    let outputs = point.outputs(&wanted);
    let [[least, largest], [slowest, fastest]] = [0, 1].map(|output| outputs[output].range());
    let amplitude = wave.amplitude.abs();
    Ok(LinearCost {
        stroke: amplitude * (largest - least),
        velocity: amplitude * fastest.max(-slowest),
        power: amplitude * amplitude * outputs[1].mean_of_product(&outputs[2]),
    })
}

/// Root mean squares of the force, of the displacement and of the velocity of the driven point, and mean power, of a sine or a sum of
/// sines, such as noise: each line of amplitude A adds ½A²|bᵀq̂|².
///
/// # Errors
/// [`NoDrivenPoint`].
pub fn noise_input_cost(
    system: &System,
    sliding: &Linearised,
    target: &InputTarget,
    wave: &Wave,
) -> Result<NoiseCost, NoDrivenPoint> {
    match target {
        InputTarget::Friction { .. } => return Err(NoDrivenPoint::Factor),
        InputTarget::Force(_) if sliding.matrices().is_none() => {
            return Err(NoDrivenPoint::FirstOrder);
        }
        InputTarget::NormalLoad { contact, .. }
            if sliding.contacts()[*contact].normal_spring().0 <= 0.0 =>
        {
            return Err(NoDrivenPoint::InSeries(NoSeriesActuator::NoSpring));
        }
        InputTarget::Force(_) | InputTarget::NormalLoad { .. } => {}
    }
    let mut squares = [0.0; 3];
    let mut power = 0.0;
    let one = || vec![WaveSine { multiple: 1.0, amplitude: 1.0, phase: 0.0 }];
    for line in wave.waveform.sines().unwrap_or_else(one) {
        let frequency = line.multiple * wave.frequency;
        let found = harmonic::response(system, sliding, target, frequency)
            .ok_or(NoDrivenPoint::NoResponse(NoPeriodicResponse::Resonance))?;
        let (at, force): (Complex64, Complex64) = match target {
            InputTarget::NormalLoad { contact, .. } => {
                let (stiffness, damping) = sliding.contacts()[*contact].normal_spring();
                let spring = Complex64::new(stiffness, damping * frequency);
                (spring.inv(), found.contacts[*contact].load)
            }
            InputTarget::Force(row) => {
                let along = row.iter().zip(&found.displacement).map(|(b, q)| q * *b);
                (along.sum(), Complex64::ONE)
            }
            InputTarget::Friction { .. } => return Err(NoDrivenPoint::Factor),
        };
        let amplitude = line.amplitude * wave.amplitude;
        let mean_square = 0.5 * amplitude * amplitude;
        let velocity = Complex64::new(0.0, frequency) * at;
        squares[0] += mean_square * force.norm_sqr();
        squares[1] += mean_square * at.norm_sqr();
        squares[2] += mean_square * velocity.norm_sqr();
        power += mean_square * (force.conj() * velocity).re;
    }
    let [force, displacement, velocity] = squares.map(f64::sqrt);
    Ok(NoiseCost { force, displacement, velocity, power })
}

#[cfg(test)]
mod tests {
    use quell_model::waveform::Noise;
    use quell_model::{Belt, Coulomb, Direction, Dither, Friction, Waveform};

    use super::*;
    use crate::linear_cost::noise_cost;

    /// The mass of a belt as a system has the cost of the belt.
    #[test]
    fn noise_on_one_mass() {
        let noise = Noise::new([2.0, 5.0], 16, 9).expect("noise");
        let dither = Dither {
            direction: Direction::Tangential,
            waveform: Waveform::Noise(noise.into()),
            amplitude: 0.7,
            frequency_ratio: 3.5,
            phase: 0.0,
            envelope: None,
        };
        let law = Friction::Coulomb(Coulomb::constant(0.4));
        let belt = Belt::new(0.05, 1.0, 0.5, law, vec![dither.clone()]).expect("a belt");
        let system = belt.system();
        let sliding = Linearised::new(&system).expect("sliding");
        let input = &system.inputs[0];
        let wave = &input.profile.waves()[0];
        let found = noise_input_cost(&system, &sliding, &input.target, wave).expect("a cost");
        let exact = noise_cost(&dither, 0.05).expect("a cost");
        for (one, other) in [
            (found.force, exact.force),
            (found.displacement, exact.displacement),
            (found.velocity, exact.velocity),
            (found.power, exact.power),
        ] {
            assert!((one / other - 1.0).abs() < 1e-12, "{found:?} {exact:?}");
        }
    }
}
