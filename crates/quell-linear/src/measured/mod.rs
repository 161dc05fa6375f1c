//! The verdict on a structure that is known by its measured frequency response alone.
//!
//! The receptance H(iω) at the contacts and inputs closes a loop with the contacts: forces f = B(s) y and displacements y = G(s) f,
//! with y = (tᵀz, nᵀz, sᵀz) and f = (along t, along n) of every contact. For the friction of steady sliding
//!
//! ```text
//! f_t = −T_γ s y_t + T_N (k + s d) y_n,    f_n = σ f_t + T y_s − (k + s d) y_n
//! ```
//!
//! Sliding is stable if det(I − B(s)G(s)) has no zero with Re s > 0. The structure alone is stable, as everything that was
//! measured, so that their number follows from the turns of the determinant along the band (the generalised Nyquist criterion;
//! A. G. J. MacFarlane and I. Postlethwaite, *Int. J. Control* 25 (1977) 81). A growth rate is not known. The receptance must not
//! include the contacts' own springs.

mod loops;
mod no_verdict;
mod receptance;

use quell_model::System;

use crate::averaging::{Becomes, CriticalInput, CrossingKind, DitheredContact, FastInputs};
use crate::growth::Verdict;
use crate::linearised::FrictionLine;
use crate::steady::SteadyContact;
pub use loops::Turns;
pub use no_verdict::{NoMeasuredVerdict, NoTurns};
pub use receptance::Receptance;

/// Halvings of an interval of amplitudes, to about 10⁻⁸ of it.
const BISECTIONS: usize = 26;

/// Sliding of a measured structure.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredSliding {
    /// Number of unstable motions, from the turns of the determinant.
    pub turns: Turns,
    /// The contacts in steady or averaged sliding.
    pub contacts: Vec<SteadyContact>,
    /// What dither does to them; empty without.
    pub dithered: Vec<DitheredContact>,
}

impl MeasuredSliding {
    /// The verdict.
    pub fn verdict(&self) -> Verdict {
        if self.turns.unstable > 0 { Verdict::Unstable } else { Verdict::Stable }
    }
}

/// A measured structure with its contacts and inputs, prepared for any amplitudes.
#[derive(Clone, Debug)]
pub struct MeasuredSystem<'a> {
    system: &'a System,
    receptance: &'a Receptance,
    undithered: Vec<SteadyContact>,
    fast: FastInputs,
}

impl<'a> MeasuredSystem<'a> {
    /// Prepares a system whose rows are over the points of the receptance.
    ///
    /// # Errors
    /// [`NoMeasuredVerdict`] without steady sliding, or for dither that the band does not contain.
    pub fn new(system: &'a System, receptance: &'a Receptance) -> Result<Self, NoMeasuredVerdict> {
        let lines: Vec<FrictionLine> =
            system.contacts.iter().map(FrictionLine::of).collect::<Result<_, _>>()?;
        let undithered = loops::steady(system, receptance, &lines)?;
        let fast = FastInputs::new(system, |target, wave| {
            if wave.waveform != quell_model::Waveform::Sine {
                return Err(NoMeasuredVerdict::NotASine);
            }
            loops::response(system, receptance, &undithered, target, wave.frequency)
        })?;
        Ok(Self { system, receptance, undithered, fast })
    }

    /// Sliding without dither.
    ///
    /// # Errors
    /// [`NoMeasuredVerdict::NoTurns`].
    pub fn sliding(&self) -> Result<MeasuredSliding, NoMeasuredVerdict> {
        let contacts = self.undithered.clone();
        let turns = loops::turns(self.system, self.receptance, &contacts)?;
        Ok(MeasuredSliding { turns, contacts, dithered: Vec::new() })
    }

    /// Averaged sliding, with another amplitude of one input if given.
    ///
    /// # Errors
    /// [`NoMeasuredVerdict`] if a mean has no value or the determinant does not decide.
    pub fn average(
        &self,
        changed: Option<(usize, f64)>,
    ) -> Result<MeasuredSliding, NoMeasuredVerdict> {
        let lines = self.fast.lines(self.system, changed)?;
        let contacts = loops::steady(self.system, self.receptance, &lines)?;
        let turns = loops::turns(self.system, self.receptance, &contacts)?;
        let dithered = self.fast.contacts(self.system, &contacts, changed)?;
        Ok(MeasuredSliding { turns, contacts, dithered })
    }

    /// The error of interpolation between the measured frequencies of each critical amplitude of an input: how far it is from that by
    /// every second frequency. Of a rational function through smooth values this is more than its error. `None` where every second
    /// frequency does not decide, or finds other changes.
    pub fn interpolation_errors(&self, input: usize, found: &[CriticalInput]) -> Vec<Option<f64>> {
        let receptance = self.receptance.every_second();
        let coarse = MeasuredSystem::new(self.system, &receptance)
            .and_then(|prepared| prepared.critical_amplitudes(input))
            .unwrap_or_default();
        let same = coarse.len() == found.len()
            && coarse.iter().zip(found).all(|(a, b)| a.becomes == b.becomes);
        found
            .iter()
            .enumerate()
            .map(|(k, own)| same.then(|| (own.amplitude - coarse[k].amplitude).abs()))
            .collect()
    }

    /// Every amplitude of an input at which the averaged verdict changes, ascending.
    ///
    /// # Errors
    /// As [`MeasuredSystem::average`].
    pub fn critical_amplitudes(
        &self,
        input: usize,
    ) -> Result<Vec<CriticalInput>, NoMeasuredVerdict> {
        let corners = self.fast.corners(self.system, input)?;
        let mut decided: Vec<(f64, bool)> = Vec::new();
        for amplitude in FastInputs::amplitudes(&corners) {
            if let Some(unstable) = self.is_unstable(input, amplitude)? {
                decided.push((amplitude, unstable));
            }
        }
        let mut found = Vec::new();
        for pair in decided.windows(2) {
            let ((below, was_unstable), (beyond, unstable)) = (pair[0], pair[1]);
            if was_unstable == unstable {
                continue;
            }
            let low = self.last_decided(input, (below, was_unstable), beyond)?;
            let high = self.last_decided(input, (beyond, unstable), low)?;
            let (amplitude, error) = (0.5 * (low + high), 0.5 * (high - low));
            let there =
                self.fast.contacts(self.system, &self.undithered, Some((input, amplitude)))?;
            let corner =
                corners.iter().find(|at| (**at - amplitude).abs() <= error.max(1e-9 * amplitude));
            let mut contacts = self.system.contacts.iter().zip(&there);
            let within_laws = contacts.all(|(contact, found)| !found.leaves_law(contact));
            found.push(CriticalInput {
                amplitude: corner.copied().unwrap_or(amplitude),
                error,
                crossing: if corner.is_some() { CrossingKind::Jump } else { CrossingKind::Root },
                becomes: if unstable { Becomes::Unstable } else { Becomes::Stable },
                contacts_stay_closed: !there.iter().any(DitheredContact::opens),
                within_laws,
            });
        }
        Ok(found)
    }

    /// Whether sliding is unstable at an amplitude; `None` where the band does not decide, near a marginal motion.
    fn is_unstable(&self, input: usize, amplitude: f64) -> Result<Option<bool>, NoMeasuredVerdict> {
        match self.average(Some((input, amplitude))) {
            Ok(found) => Ok(Some(found.turns.unstable > 0)),
            Err(NoMeasuredVerdict::NoTurns(_)) => Ok(None),
            Err(why) => Err(why),
        }
    }

    /// The amplitude nearest to `other` at which the verdict is still that of `from`, by bisection.
    fn last_decided(
        &self,
        input: usize,
        (from, unstable): (f64, bool),
        other: f64,
    ) -> Result<f64, NoMeasuredVerdict> {
        let (mut here, mut there) = (from, other);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (here + there);
            if self.is_unstable(input, middle)? == Some(unstable) {
                here = middle;
            } else {
                there = middle;
            }
        }
        Ok(here)
    }
}
