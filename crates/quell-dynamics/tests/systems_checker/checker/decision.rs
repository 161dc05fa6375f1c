//! Which of the contacts at rest stick, by trial of all 3^m combinations.

use super::Unchecked;
use super::linear::{dot, solve_in_place};

/// Distance to a boundary of a decision below which the decision is ambiguous.
pub(super) const TOO_CLOSE: f64 = 1e-9;

/// Static and sliding bounds that differ by less are equal.
const SMOOTH: f64 = 1e-12;

/// The contacts with zero slip velocity at one moment: γ̇ = w − G T within bounds of T.
#[derive(Clone, Debug)]
pub(super) struct Contest {
    /// w.
    pub(super) acceleration: Vec<f64>,
    /// G by rows.
    pub(super) coupling: Vec<f64>,
    /// μ_s N.
    pub(super) static_bounds: Vec<f64>,
    /// μ(0⁺) N.
    pub(super) sliding_bounds: Vec<f64>,
}

impl Contest {
    /// The directions in which the contacts slip; 0 for those that stick.
    ///
    /// `released` has the direction of each contact whose force has just reached its static bound, else 0. Without such a
    /// contact the decision starts with the static bounds.
    ///
    /// # Errors
    /// If a decision is too close to a boundary, or has no unique solution.
    pub(super) fn decide(&self, released: &[i8]) -> Result<Vec<i8>, Unchecked> {
        let count = self.acceleration.len();
        let mut at_bound: Vec<bool> = released.iter().map(|&direction| direction != 0).collect();
        if !at_bound.contains(&true) {
            if self.all_hold()? {
                return Ok(vec![0; count]);
            }
            let directions = self.box_problem(&self.static_bounds, &vec![0; count])?;
            at_bound = directions.iter().map(|&direction| direction != 0).collect();
        }
        let smooth = |c: usize| self.static_bounds[c] - self.sliding_bounds[c] < SMOOTH;
        let pinned: Vec<i8> = (0..count).map(|c| if smooth(c) { released[c] } else { 0 }).collect();
        loop {
            let bound =
                |c: usize| if at_bound[c] { self.sliding_bounds[c] } else { self.static_bounds[c] };
            let bounds: Vec<f64> = (0..count).map(bound).collect();
            let directions = self.box_problem(&bounds, &pinned)?;
            let mut changed = false;
            for (at_bound, direction) in at_bound.iter_mut().zip(&directions) {
                changed |= *direction != 0 && !*at_bound;
                *at_bound |= *direction != 0;
            }
            if !changed {
                return Ok(directions);
            }
        }
    }

    /// Whether the forces that hold all contacts are within the static bounds.
    fn all_hold(&self) -> Result<bool, Unchecked> {
        let (mut coupling, mut forces) = (self.coupling.clone(), self.acceleration.clone());
        if !solve_in_place(&mut coupling, &mut forces) {
            return Err(Unchecked::Failed("dependent contacts".to_owned()));
        }
        let margins =
            self.static_bounds.iter().zip(&forces).map(|(bound, force)| bound - force.abs());
        let margin = margins.fold(f64::INFINITY, f64::min);
        if margin.abs() < TOO_CLOSE {
            return Err(Unchecked::Ambiguous("holding forces at a static bound".to_owned()));
        }
        Ok(margin > 0.0)
    }

    /// The one combination of directions that satisfies all conditions: |T| ≤ bound where γ̇ = 0, else γ̇ in the direction
    /// of T at its bound. A pinned contact slips in its direction from γ̇ = 0.
    fn box_problem(&self, bounds: &[f64], pinned: &[i8]) -> Result<Vec<i8>, Unchecked> {
        let count = bounds.len();
        let (mut best, mut second) = ((f64::NEG_INFINITY, vec![0; count]), f64::NEG_INFINITY);
        for code in 0..3_usize.pow(u32::try_from(count).expect("few contacts")) {
            let direction =
                |c: usize| [0, 1, -1][code / 3_usize.pow(u32::try_from(c).expect("few")) % 3];
            let directions: Vec<i8> = (0..count).map(direction).collect();
            if directions.iter().zip(pinned).any(|(&direction, &pin)| pin != 0 && direction != pin)
            {
                continue;
            }
            let margin = self.margin(bounds, pinned, &directions);
            if margin > best.0 {
                second = best.0;
                best = (margin, directions);
            } else {
                second = second.max(margin);
            }
        }
        if best.0 < -TOO_CLOSE {
            return Err(Unchecked::Failed(
                "no combination of stick and slip is possible".to_owned(),
            ));
        }
        if second > TOO_CLOSE {
            return Err(Unchecked::Failed(
                "several combinations of stick and slip are possible".to_owned(),
            ));
        }
        if best.0 < TOO_CLOSE {
            return Err(Unchecked::Ambiguous(
                "a force at its bound without slip acceleration".to_owned(),
            ));
        }
        Ok(best.1)
    }

    /// The least margin of the conditions of one combination; negative if a condition is violated.
    fn margin(&self, bounds: &[f64], pinned: &[i8], directions: &[i8]) -> f64 {
        let count = bounds.len();
        let mut forces: Vec<f64> =
            (0..count).map(|c| f64::from(directions[c]) * bounds[c]).collect();
        let slip_acceleration = |c: usize, forces: &[f64]| {
            self.acceleration[c] - dot(&self.coupling[c * count..(c + 1) * count], forces)
        };
        let held: Vec<usize> = (0..count).filter(|&c| directions[c] == 0).collect();
        let mut right: Vec<f64> = held.iter().map(|&c| slip_acceleration(c, &forces)).collect();
        let entries =
            held.iter().flat_map(|&c| held.iter().map(move |&d| self.coupling[c * count + d]));
        if !solve_in_place(&mut entries.collect::<Vec<f64>>(), &mut right) {
            return f64::NEG_INFINITY;
        }
        for (&c, force) in held.iter().zip(right) {
            forces[c] = force;
        }
        let mut margin = f64::INFINITY;
        for c in 0..count {
            let own = if directions[c] == 0 {
                bounds[c] - forces[c].abs()
            } else {
                f64::from(directions[c]) * slip_acceleration(c, &forces)
            };
            let starts_at_zero = pinned[c] != 0 && own.abs() < TOO_CLOSE;
            margin = margin.min(if starts_at_zero { f64::INFINITY } else { own });
        }
        margin
    }
}
