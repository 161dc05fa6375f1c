//! Runs that come back near one of their own states: when Newton's method may close an orbit there, and whether the orbit is the
//! one on which the run ends.

use crate::motion::MOTION_TOLERANCE;

/// Mismatch of two states, relative to their size, below which Newton's method is tried. A larger value costs attempts that fail,
/// a smaller one only time until the run is nearer.
pub(super) const NEAR: f64 = 3e-2;

/// Distance, relative to the state, between an orbit and a run that is on its way to it. An orbit further away is another one.
pub(super) const SAME: f64 = 0.2;

/// Distance from a motion, relative to the state, within which a run is on it: far below any difference that matters, far above the
/// error of a run. Another motion nearer than this would be missed.
pub(super) const ON_IT: f64 = 1e-6;

/// A run repeats itself after several periods, not one, if its states are nearer to each other by this factor. Errors cost one
/// attempt: a multiple of the least period is reduced later.
const MUCH_NEARER: f64 = 0.3;

/// Mismatch, relative to the state, of a cycle whose residual no longer shrinks: an unstable or stiff cycle amplifies the error of a
/// step, and a thousandfold is accepted. If that is wrong the residual, which is reported, shows it.
pub(super) const STAGNANT: f64 = 1e3 * MOTION_TOLERANCE;

/// Mismatch, relative to the state, that a state known to [`STAGNANT`] may have after a period with multipliers up to a thousand:
/// a part of a period that closes to it is a period, and a state that moves by less in a period is an equilibrium.
pub(super) const COARSE: f64 = 1e3 * STAGNANT;

/// Largest difference of the numbers of two states.
pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}

/// The returns of a state that are much nearer than every earlier one: after how many of the earlier states, the latest first and
/// counted from 1, and its distance then. The nearest is last.
pub(super) fn returns<'a>(
    last: &[f64],
    earlier: impl Iterator<Item = &'a [f64]>,
) -> Vec<(usize, f64)> {
    let mut found: Vec<(usize, f64)> = Vec::new();
    for (place, state) in earlier.enumerate() {
        let now = distance(last, state);
        if found.last().is_none_or(|(_, best)| now < MUCH_NEARER * best) {
            found.push((place + 1, now));
        }
    }
    found
}

/// The nearest of the [`returns`].
pub(super) fn nearest_return<'a>(
    last: &[f64],
    earlier: impl Iterator<Item = &'a [f64]>,
) -> Option<(usize, f64)> {
    returns(last, earlier).pop()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_comes_back_after_the_fewest_that_are_about_as_near() {
        let states = [[0.02], [0.001], [0.5], [0.0009], [1e-5]];
        let after =
            |count: usize| nearest_return(&[0.0], states[..count].iter().map(<[f64; 1]>::as_slice));
        assert_eq!(after(0), None);
        assert_eq!(after(1), Some((1, 0.02)));
        assert_eq!(after(4), Some((2, 0.001)));
        assert_eq!(after(5), Some((5, 1e-5)));
    }
}
