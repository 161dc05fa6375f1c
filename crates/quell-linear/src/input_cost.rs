//! The steady response of a sliding system to one dither at its driven point: stroke, velocity, power.
//!
//! The motion is that of [`crate::driven_point`]. A force b u(t) has the stroke of bᵀq, the largest velocity |bᵀq̇|, and the mean power
//! ⟨u bᵀq̇⟩. Of one mass it is [`crate::linear_cost`].

use quell_model::System;
use quell_model::profile::Wave;
use quell_model::system::InputTarget;

use crate::driven_point::{DrivenPoint, NoDrivenPoint, PointOutput};
use crate::linear_cost::LinearCost;
use crate::linearised::Linearised;

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
