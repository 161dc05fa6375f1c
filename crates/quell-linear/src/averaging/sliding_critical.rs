//! Critical amplitudes of one dither of a system: where the verdict of averaging changes.
//!
//! The largest growth rate is followed over the amplitude of the dither, the other dithers unchanged. Its sign changes through
//! zero, or by a jump where the fast slip at a contact reaches the velocity of the surface: beyond it the contact reverses and
//! its mean friction rises steeply with the slip velocity.

use super::critical_amplitudes::Becomes;
use super::fast_inputs::{DitheredContact, FastInputs};
use super::no_average::NoAverage;
use super::sign_changes::{CrossingKind, sign_changes};
use super::sliding::DitheredSystem;
use crate::growth::{Verdict, verdicts_around};

/// Relative distance beyond a change at which contacts are examined: just past a jump.
const BEYOND_A_CHANGE: f64 = 1e-10;

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
    /// Whether the slip velocity of every contact is in the range of its friction law there.
    pub within_laws: bool,
}

impl DitheredSystem<'_> {
    /// Every amplitude of input `input` at which the averaged verdict changes, in ascending order; empty if the input does not
    /// reach any contact.
    ///
    /// # Errors
    /// [`NoAverage`] if a mean has no value.
    pub fn critical_amplitudes(&self, input: usize) -> Result<Vec<CriticalInput>, NoAverage> {
        let corners = self.fast().corners(self.system(), input)?;
        let points = FastInputs::amplitudes(&corners);
        let growth = |amplitude: f64| -> Result<f64, NoAverage> {
            let growth = self.average_with(Some((input, amplitude)))?.growth()?;
            Ok(if growth.verdict() == Verdict::Undecided { 0.0 } else { growth.rate })
        };
        let changes = sign_changes(growth, &points, &corners)?;
        let mut found = Vec::new();
        for change in changes {
            let amplitude = change.location;
            let verdict = |distance: f64| -> Result<Verdict, NoAverage> {
                let there = Some((input, amplitude * (1.0 + distance)));
                Ok(self.average_with(there)?.growth()?.verdict())
            };
            // Where a motion is neutral on one side, the verdict is undecided there and need not change.
            let becomes = match verdicts_around(verdict)? {
                [before, beyond] if before == beyond => continue,
                [_, Verdict::Stable] => Becomes::Stable,
                [_, Verdict::Unstable] => Becomes::Unstable,
                [_, Verdict::Undecided] => continue,
            };
            let there = self.average_with(Some((input, amplitude * (1.0 + BEYOND_A_CHANGE))))?;
            let mut contacts = self.system().contacts.iter().zip(&there.contacts);
            let within_laws = contacts.all(|(contact, found)| !found.leaves_law(contact));
            found.push(CriticalInput {
                amplitude,
                error: change.error,
                crossing: change.crossing,
                becomes,
                contacts_stay_closed: !there.contacts.iter().any(DitheredContact::opens),
                within_laws,
            });
        }
        Ok(found)
    }
}
