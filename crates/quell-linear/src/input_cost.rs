//! The steady response of a sliding system to one dither at its driven point: stroke, velocity, power.
//!
//! The structure is that of steady sliding without the slope of friction ([`crate::harmonic`]), and the response is exact for every
//! waveform ([`crate::periodic_response`]). A force b u(t) has the stroke of bᵀq, the largest velocity |bᵀq̇|, and the mean power
//! ⟨u bᵀq̇⟩. Of one mass it is [`crate::linear_cost`].

use quell_model::System;
use quell_model::profile::Wave;
use quell_model::system::InputTarget;

use crate::harmonic::DrivenEquations;
use crate::linear_cost::LinearCost;
use crate::linearised::Linearised;
use crate::periodic_response::{NoPeriodicResponse, ResponseToWave};

/// Why the cost of a dither has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoInputCost {
    /// The dither modulates the load of a contact.
    Modulation,
    /// First-order equations: where the dither acts is no displacement.
    FirstOrder,
    /// The mass matrix is singular.
    Singular,
    /// There is no periodic response.
    NoResponse(NoPeriodicResponse),
}

impl core::fmt::Display for NoInputCost {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Modulation => f.write_str(
                "this dither modulates the load of a contact: it has no stroke of its own",
            ),
            Self::FirstOrder => f.write_str(
                "first-order equations do not give the displacement on which the input acts",
            ),
            Self::Singular => f.write_str("the mass of the structure is singular"),
            Self::NoResponse(why) => why.fmt(f),
        }
    }
}

impl core::error::Error for NoInputCost {}

/// Stroke and largest velocity of the driven point, and mean power of a wave, in the units of the system.
///
/// # Errors
/// [`NoInputCost`].
pub fn input_cost(
    system: &System,
    sliding: &Linearised,
    target: &InputTarget,
    wave: &Wave,
) -> Result<LinearCost, NoInputCost> {
    let InputTarget::Force(row) = target else { return Err(NoInputCost::Modulation) };
    if sliding.matrices().is_none() {
        return Err(NoInputCost::FirstOrder);
    }
    let equations = DrivenEquations::new(system, sliding, target).ok_or(NoInputCost::Singular)?;
    let [along, rate] = [0, 1].map(|order| equations.over_state(row, order));
    let nothing = vec![0.0; along.len()];
    let response =
        ResponseToWave::new(&equations.matrix, &equations.source, &wave.waveform, wave.frequency)
            .map_err(NoInputCost::NoResponse)?;
    let outputs = response.outputs(&[(&along, 0.0), (&rate, 0.0), (&nothing, 1.0)]);
    let [[least, largest], [slowest, fastest]] = [0, 1].map(|output| outputs[output].range());
    let amplitude = wave.amplitude.abs();
    Ok(LinearCost {
        stroke: amplitude * (largest - least),
        velocity: amplitude * fastest.max(-slowest),
        power: amplitude * amplitude * outputs[1].mean_of_product(&outputs[2]),
    })
}
