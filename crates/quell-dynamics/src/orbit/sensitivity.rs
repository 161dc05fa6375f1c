//! Derivatives of a threshold of a system with respect to its numbers, by [`quell_numerics::continuation::sensitivity`].
//!
//! The derivative of a grazing or a separation is that of its first contact where several graze together: for equal contacts and a
//! number that they share all have the same one.

use quell_numerics::continuation::sensitivity::{
    NoSensitivity, ThresholdPoint, ThresholdSensitivity, threshold_sensitivity,
};
use quell_numerics::continuation::threshold::BifurcationKind;

use super::curves::GuardedFamily;
use super::family::{BorderGuard, OrbitFamily, SystemAt};
use super::periodic::scale_of;
use super::threshold_kind::ThresholdKind;
use super::thresholds::Threshold;
use crate::motion::Motion;

/// The derivatives of thresholds of the base response that meet (of one, mostly). `parameters` are first those that they determine, one
/// for each, then those by which they are differentiated; `sizes` are typical sizes of all of them, above zero.
///
/// # Errors
/// [`NoSensitivity`]; [`NoSensitivity::OtherKind`] for a threshold without a test function, and where two grazings meet.
pub fn sensitivity_of_threshold(
    at: &SystemAt<'_>,
    met: &[&Threshold],
    parameters: &[f64],
    sizes: &[f64],
) -> Result<ThresholdSensitivity, NoSensitivity> {
    let is_contact = |kind| matches!(kind, ThresholdKind::Grazing | ThresholdKind::Separation);
    let touching: Vec<&&Threshold> =
        met.iter().filter(|threshold| is_contact(threshold.kind)).collect();
    let first = touching.first().copied().or(met.first()).ok_or(NoSensitivity::OtherKind)?;
    let guards: Vec<BorderGuard> = touching
        .iter()
        .flat_map(|threshold| {
            let is_load = threshold.kind == ThresholdKind::Separation;
            threshold.contacts.iter().map(move |contact| BorderGuard { contact: *contact, is_load })
        })
        .collect();
    if touching.len() > 1 || guards.is_empty() != touching.is_empty() {
        return Err(NoSensitivity::OtherKind);
    }
    let kinds = met.iter().map(|threshold| match threshold.kind {
        ThresholdKind::Separation => Ok(BifurcationKind::Grazing),
        kind => kind.event().ok_or(NoSensitivity::OtherKind),
    });
    let kinds: Vec<BifurcationKind> = kinds.collect::<Result<_, _>>()?;
    let system = at(parameters).map_err(|_| NoSensitivity::OtherEvents)?;
    let motion = Motion::new(&system).map_err(|_| NoSensitivity::OtherEvents)?;
    let scale = scale_of(&motion, &first.state);
    let family = OrbitFamily { at, periods: 1, size: first.state.len(), scale };
    let point = ThresholdPoint {
        kinds: &kinds,
        held: &first.signature,
        state: &first.state,
        parameters,
        sizes,
    };
    threshold_sensitivity(&GuardedFamily { family, guards }, &point)
}
