//! The forces of sticking contacts in every lane.

use quell_numerics::lane::Lane;

use super::super::stuck::{HoldingForces, StuckForces};

/// The forces of the sticking contacts of every run: contact by contact, and those of [`HoldingForces`] for all lanes together.
pub(super) struct LaneHolding<V> {
    contacts: usize,
    /// T of a contact per w of another, row by row.
    gains: Vec<V>,
    tilts: Vec<V>,
    is_free: Vec<V>,
    is_independent: Vec<V>,
    /// For the contacts that are free or independent in any lane.
    together: Together<V>,
}

struct Together<V> {
    free: Vec<usize>,
    independent: Vec<usize>,
    gain: Vec<V>,
    tilts: Vec<V>,
    is_free: Vec<V>,
    is_independent: Vec<V>,
}

impl<V: Lane> LaneHolding<V> {
    pub(super) fn new(contacts: usize) -> Self {
        let zeros = |count| vec![V::splat(0.0); count];
        Self {
            contacts,
            gains: zeros(contacts * contacts),
            tilts: zeros(contacts),
            is_free: zeros(contacts),
            is_independent: zeros(contacts),
            together: Together {
                free: Vec::new(),
                independent: Vec::new(),
                gain: Vec::new(),
                tilts: Vec::new(),
                is_free: Vec::new(),
                is_independent: Vec::new(),
            },
        }
    }

    /// Writes the forces of one run; [`LaneHolding::combine`] must follow.
    pub(super) fn set(&mut self, lane: usize, forces: &StuckForces) {
        let HoldingForces { free, independent, gain, tilts, .. } = forces.holding();
        for contact in 0..self.contacts {
            self.is_free[contact].set_lane(lane, 0.0);
            self.is_independent[contact].set_lane(lane, 0.0);
        }
        for &contact in independent {
            self.is_independent[contact].set_lane(lane, 1.0);
        }
        for (place, &contact) in free.iter().enumerate() {
            self.is_free[contact].set_lane(lane, 1.0);
            self.tilts[contact].set_lane(lane, tilts[place]);
            for (other, &index) in independent.iter().enumerate() {
                let gain = gain[place * independent.len() + other];
                self.gains[contact * self.contacts + index].set_lane(lane, gain);
            }
        }
    }

    /// Combines the forces of all lanes.
    pub(super) fn combine(&mut self) {
        let Together { free, independent, gain, tilts, is_free, is_independent } =
            &mut self.together;
        let any = |masks: &[V], out: &mut Vec<usize>| {
            out.clear();
            out.extend((0..masks.len()).filter(|contact| masks[*contact].any_positive()));
        };
        any(&self.is_free, free);
        any(&self.is_independent, independent);
        gain.clear();
        tilts.clear();
        is_free.clear();
        is_independent.clear();
        is_independent.extend(independent.iter().map(|index| self.is_independent[*index]));
        for &contact in &*free {
            is_free.push(self.is_free[contact]);
            tilts.push(self.tilts[contact]);
            let row = &self.gains[contact * self.contacts..(contact + 1) * self.contacts];
            gain.extend(independent.iter().map(|index| row[*index]));
        }
    }

    #[inline(always)]
    pub(super) fn forces(&self) -> HoldingForces<'_, V> {
        HoldingForces {
            free: &self.together.free,
            independent: &self.together.independent,
            gain: &self.together.gain,
            tilts: &self.together.tilts,
            is_free: &self.together.is_free,
            is_independent: &self.together.is_independent,
        }
    }
}
