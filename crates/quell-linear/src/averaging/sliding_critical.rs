//! Critical amplitudes of one dither of a system: where the verdict of averaging changes.
//!
//! The largest growth rate is followed over the amplitude of the dither, the other dithers unchanged. Its sign changes through
//! zero, or by a jump where the fast slip at a contact reaches the velocity of the surface: beyond it the contact reverses and
//! its mean friction rises steeply with the slip velocity.

use super::critical_amplitudes::Becomes;
use super::sign_changes::{CrossingKind, sign_changes};
use super::sliding::{DitheredSystem, NoAverage};
use crate::growth::Verdict;

/// Amplitudes are searched from the smallest corner divided by this …
const BELOW: f64 = 1e3;
/// … up to the largest corner times this. Far beyond a corner mean friction falls like the inverse of the amplitude.
const BEYOND: f64 = 30.0;
/// Ratio of neighbouring amplitudes of the search.
const STEP: f64 = 1.05;
/// Amplitudes on each side of a corner, each at half the distance of the last.
const AROUND: i32 = 14;
/// Relative distance at which the verdict beyond a change is evaluated.
const ASIDE: f64 = 1e-6;

/// An amplitude at which the averaged verdict changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalInput {
    /// Amplitude of the dither.
    pub amplitude: f64,
    /// Bound on its error.
    pub error: f64,
    /// Root or jump.
    pub crossing: CrossingKind,
    /// The verdict beyond it.
    pub becomes: Becomes,
    /// Whether every contact stays closed there.
    pub contacts_stay_closed: bool,
}

impl DitheredSystem<'_> {
    /// Every amplitude of input `input` at which the averaged verdict changes, in ascending order; empty if the input does not
    /// reach any contact.
    ///
    /// # Errors
    /// [`NoAverage`] if a mean has no value.
    pub fn critical_amplitudes(&self, input: usize) -> Result<Vec<CriticalInput>, NoAverage> {
        let corners = self.corners(input)?;
        let (Some(&least), Some(&largest)) = (corners.first(), corners.last()) else {
            return Ok(Vec::new());
        };
        let points = amplitudes(least, largest, &corners);
        let growth = |amplitude: f64| -> Result<f64, NoAverage> {
            let growth = self.average_with(Some((input, amplitude)))?.growth()?;
            Ok(if growth.verdict() == Verdict::Undecided { 0.0 } else { growth.rate })
        };
        let changes = sign_changes(growth, &points, &corners)?;
        let mut found = Vec::new();
        for change in changes {
            let amplitude = change.location;
            let beyond = self.average_with(Some((input, amplitude * (1.0 + ASIDE))))?;
            let becomes = match (change.becomes_positive, beyond.growth()?.verdict()) {
                (true, _) => Becomes::Unstable,
                (false, Verdict::Stable) => Becomes::Stable,
                // The motion is neutral beyond: its verdict does not become stable.
                (false, _) => continue,
            };
            found.push(CriticalInput {
                amplitude,
                error: change.error,
                crossing: change.crossing,
                becomes,
                contacts_stay_closed: !beyond.contacts.iter().any(|contact| contact.opens()),
            });
        }
        Ok(found)
    }

    /// Amplitudes at which the fast slip of a contact reaches the velocity of its surface, ascending.
    fn corners(&self, input: usize) -> Result<Vec<f64>, NoAverage> {
        let mut corners: Vec<f64> = Vec::new();
        for contact in 0..self.system().contacts.len() {
            let excess = |amplitude: f64| self.reversal_excess(contact, Some((input, amplitude)));
            let (at_none, at_one) = (excess(0.0)?, excess(1.0)?);
            let alone = self.system().inputs.len() == 1;
            if at_one == at_none {
                continue;
            }
            // The slip of a single dither is proportional to its amplitude.
            let proportional = -at_none / (at_one - at_none);
            if alone {
                corners.push(proportional);
                continue;
            }
            let scale = proportional.abs().max(f64::MIN_POSITIVE);
            let points: Vec<f64> =
                (0..240).map(|k| scale * libm::exp(-9.0 + 0.06 * f64::from(k))).collect();
            let changes = sign_changes(excess, &points, &[])?;
            corners.extend(changes.into_iter().map(|change| change.location));
        }
        corners.retain(|corner| corner.is_finite() && *corner > 0.0);
        corners.sort_unstable_by(f64::total_cmp);
        corners.dedup_by(|a, b| (*a - *b).abs() <= 1e-14 * b.abs());
        Ok(corners)
    }
}

/// Amplitudes of the search: in equal ratios, and closer to the corners.
fn amplitudes(least: f64, largest: f64, corners: &[f64]) -> Vec<f64> {
    let (mut amplitude, end) = (least / BELOW, largest * BEYOND);
    let mut points = vec![0.0];
    while amplitude < end {
        points.push(amplitude);
        amplitude *= STEP;
    }
    points.push(end);
    for corner in corners {
        let distances = (1..=AROUND).map(|k| 2f64.powi(-k));
        points.extend(distances.flat_map(|d| [corner * (1.0 - d), corner * (1.0 + d)]));
    }
    points.sort_unstable_by(f64::total_cmp);
    points.dedup();
    points
}
