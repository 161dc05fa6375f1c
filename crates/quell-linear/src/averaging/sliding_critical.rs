//! Critical amplitudes of one dither of a system: where the verdict of averaging changes.
//!
//! The largest growth rate is followed over the amplitude of the dither, the other dithers unchanged. Its sign changes through
//! zero, or by a jump where the fast slip at a contact reaches the velocity of the surface: beyond it the contact reverses and
//! its mean friction rises steeply with the slip velocity.
//!
//! Where friction acts through a single slope, the slopes at which the verdict changes are known ([`CriticalSlopes`]): the mean slope is
//! followed to them, and growth rates are computed only around the changes and at a few amplitudes between. They have the last word:
//! where they disagree, the growth rate is followed instead.

use super::critical_amplitudes::Becomes;
use super::error::AveragingError;
use super::fast_inputs::{DitheredContact, FastInputs};
use super::sign_changes::{CrossingKind, SignChange, located, sign_changes};
use super::sliding::DitheredSystem;
use crate::critical_slopes::CriticalSlopes;
use crate::growth::{Verdict, verdicts_around};

/// Relative distance beyond a change at which contacts are examined: just past a jump.
const BEYOND_A_CHANGE: f64 = 1e-10;

/// Relative distances within which a change that follows from the slope is located by growth rates: from a hundred roundings of the
/// slope to one millionth. A change that growth rates do not see so near is not believed, and the growth rate is followed.
const WITHIN: [f64; 4] = [1e-12, 1e-10, 1e-8, 1e-6];

/// One in this many amplitudes is judged by growth rates too, some ten in all: where the two verdicts differ, critical slopes are missing.
/// A choice of effort. Missing slopes whose whole interval lies between two of these amplitudes are not noticed.
const JUDGED: usize = 24;

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
    /// [`AveragingError`] if a mean has no value.
    pub fn critical_amplitudes(&self, input: usize) -> Result<Vec<CriticalInput>, AveragingError> {
        let corners = self.fast().corners(self.system(), input)?;
        let points = FastInputs::amplitudes(&corners);
        let changes = match self.changes_by_slope(input, &points, &corners)? {
            Some(changes) => changes,
            None => sign_changes(|amplitude| self.growth_at(input, amplitude), &points, &corners)?,
        };
        let mut found = Vec::new();
        for change in changes {
            let amplitude = change.location;
            let verdict = |distance: f64| -> Result<Verdict, AveragingError> {
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

    /// The growth rate at an amplitude; 0 where it is 0 within its error.
    fn growth_at(&self, input: usize, amplitude: f64) -> Result<f64, AveragingError> {
        let growth = self.average_with(Some((input, amplitude)))?.growth()?;
        Ok(if growth.verdict() == Verdict::Undecided { 0.0 } else { growth.rate })
    }

    /// The changes of the verdict, by the slope of mean friction; `None` where it is not friction's only action, or where
    /// growth rates disagree.
    fn changes_by_slope(
        &self,
        input: usize,
        points: &[f64],
        corners: &[f64],
    ) -> Result<Option<Vec<SignChange>>, AveragingError> {
        let Some(critical) = CriticalSlopes::of(self.sliding()) else { return Ok(None) };
        let contact = &self.sliding().contacts()[0].steady;
        let line = self.fast().line_over(self.system(), (0, input))?;
        let distance = |amplitude: f64| -> Result<f64, AveragingError> {
            let line = line(amplitude)?;
            Ok(critical.distance(contact.factor * line.slope_under(contact.normal_load)))
        };
        let growth = |amplitude: f64| self.growth_at(input, amplitude);
        for amplitude in points.iter().copied().step_by(JUDGED) {
            if (distance(amplitude)? > 0.0) != (growth(amplitude)? > 0.0) {
                return Ok(None);
            }
        }
        let mut changes = sign_changes(distance, points, corners)?;
        for change in &mut changes {
            if corners.contains(&change.location) {
                continue;
            }
            let Some(exactly) = self.around(input, change)? else { return Ok(None) };
            *change = exactly;
        }
        Ok(Some(changes))
    }

    /// A change of the verdict where the growth rate changes its sign, next to a known one; `None` if it does not change there.
    fn around(
        &self,
        input: usize,
        change: &SignChange,
    ) -> Result<Option<SignChange>, AveragingError> {
        let mut growth = |amplitude: f64| self.growth_at(input, amplitude);
        for within in WITHIN {
            let [below, above] = [-within, within].map(|share| change.location * (1.0 + share));
            let (before, after) = (growth(below)?, growth(above)?);
            if (before > 0.0) != (after > 0.0) {
                if (after > 0.0) != change.becomes_positive {
                    return Ok(None);
                }
                let crossing = change.crossing;
                return Ok(Some(SignChange {
                    crossing,
                    ..located(&mut growth, below, above, change.becomes_positive)?
                }));
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use quell_model::profile::{Profile, Wave};
    use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical, StateSpace};
    use quell_model::{LawKind, System, Waveform};
    use quell_numerics::matrix::Matrix;
    use quell_numerics::random::SplitMix;

    use super::*;

    /// A structure of n coordinates, circulatory and gyroscopic parts included, or first-order equations whose friction acts elsewhere
    /// than where it is measured; one contact, one dither.
    fn random_system(random: &mut SplitMix, n: usize, first_order: bool) -> System {
        let mut between = |low: f64, high: f64| low + (high - low) * random.share();
        let names: Vec<String> = (0..n).map(|i| format!("x{i}")).collect();
        let mut row = |size: f64| (0..n).map(|_| between(-size, size)).collect::<Vec<f64>>();
        let (tangent, input, other) = (row(1.0), row(1.0), row(0.1));
        let mut square = |diagonal: &dyn Fn(usize) -> f64, size: f64| {
            let mut values = Matrix::zeros(n, n);
            values.as_mut_slice().iter_mut().for_each(|value| *value = between(-size, size));
            (0..n).for_each(|i| values[(i, i)] = diagonal(i));
            values
        };
        let (force, structure) = if first_order {
            let rates = square(&|i| -0.05 - 0.1 * i as f64, 0.6);
            let column: Vec<f64> = tangent.iter().zip(&other).map(|(t, o)| t + o).collect();
            (Some(column), StateSpace::new(names, rates).into())
        } else {
            let damping = square(&|_| 0.02, 0.004);
            let stiffness = square(&|i| 1.0 + 1.7 * i as f64, 0.15);
            let mass = MassMatrix::identity(n).attach(0.3, input.clone());
            (None, Mechanical::new(names, mass, damping, stiffness).into())
        };
        let contact = Contact {
            name: "pad".to_owned(),
            tangent: Some(tangent),
            force,
            normal: None,
            slope: None,
            normal_load: between(0.05, 0.6),
            normal_stiffness: 0.0,
            tangential_stiffness: None,
            normal_damping: 0.0,
            surface_velocity: Profile::constant(between(0.03, 0.4)),
            friction: LawKind::Stribeck.build(&[0.4, 0.25, 0.2]).expect("valid"),
            varying_load: None,
        };
        let waveform = if between(0.0, 1.0) < 0.5 { Waveform::Sine } else { Waveform::Square };
        let frequency = between(4.0, 30.0);
        let wave = Wave { waveform, amplitude: 1.0, frequency, phase: 0.0, envelope: None };
        let profile = Profile::constant(0.0).with(wave);
        let inputs = vec![Input { target: InputTarget::Force(input), profile }];
        System { structure, contacts: vec![contact], inputs }
    }

    /// Both methods agree, on structures that have changes and on structures that have none.
    #[test]
    fn slopes_and_growth_rates_give_the_same_changes() {
        let mut random = SplitMix::new(20);
        let (mut judged, mut changed) = (0, 0);
        for case in 0..200 {
            let system = random_system(&mut random, 1 + case % 5, case % 3 == 2);
            let Ok(prepared) = DitheredSystem::new(&system) else { continue };
            let corners = prepared.fast().corners(&system, 0).expect("corners");
            let points = FastInputs::amplitudes(&corners);
            let growth = |amplitude: f64| prepared.growth_at(0, amplitude);
            let Ok(expected) = sign_changes(growth, &points, &corners) else { continue };
            let found = prepared.changes_by_slope(0, &points, &corners).expect("means");
            let Some(found) = found else { panic!("case {case}: {expected:?}") };
            judged += 1;
            changed += usize::from(!expected.is_empty());
            assert_eq!(found.len(), expected.len(), "case {case}: {found:?} {expected:?}");
            for (found, expected) in found.iter().zip(&expected) {
                let off = (found.location / expected.location - 1.0).abs();
                assert!(off < 1e-12, "case {case}: {found:?} {expected:?}");
                assert_eq!(found.becomes_positive, expected.becomes_positive, "case {case}");
                assert_eq!(found.crossing, expected.crossing, "case {case}");
            }
        }
        assert!(judged > 150 && changed > 50, "{judged} {changed}");
    }
}
