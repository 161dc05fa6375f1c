//! What the numbers of a state are, and their names.

use super::{Contact, System};
use crate::units::Quantity;

/// What a number of a state is; places count from 0 in their lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateEntry {
    /// The displacement of a coordinate.
    Displacement(usize),
    /// The velocity of a coordinate.
    Velocity(usize),
    /// A state of first-order equations.
    State(usize),
    /// The number of a contact with a state of its own ([`Contact::has_state`]): the friction force of an elastic slider, or the mean
    /// deflection of bristles.
    Contact(usize),
}

impl System {
    /// What every number of a state is, in order: displacements, then velocities, or the states of first-order equations; then the
    /// contacts with a state of their own.
    pub fn layout(&self) -> Vec<StateEntry> {
        let size = self.structure.size();
        let structure: Vec<StateEntry> = match self.structure.mechanical() {
            Some(_) => {
                let displacements = (0..size).map(StateEntry::Displacement);
                displacements.chain((0..size).map(StateEntry::Velocity)).collect()
            }
            None => (0..size).map(StateEntry::State).collect(),
        };
        let own = self.contacts.iter().enumerate().filter(|(_, contact)| contact.has_state());
        structure.into_iter().chain(own.map(|(index, _)| StateEntry::Contact(index))).collect()
    }

    /// Names of the numbers of a state: coordinates and `velocity.` coordinate, or the states of first-order equations; then `friction.`
    /// contact of elastic sliders and `bristle.` contact of bristles.
    pub fn state_names(&self) -> Vec<String> {
        let names = self.structure.names();
        let name = |entry| match entry {
            StateEntry::Displacement(index) | StateEntry::State(index) => names[index].clone(),
            StateEntry::Velocity(index) => format!("velocity.{}", names[index]),
            StateEntry::Contact(index) => match &self.contacts[index] {
                contact if has_bristles(contact) => format!("bristle.{}", contact.name),
                contact => format!("friction.{}", contact.name),
            },
        };
        self.layout().into_iter().map(name).collect()
    }

    /// What the number at a place of a state is; `None` for first-order equations.
    pub fn state_quantity(&self, place: usize) -> Option<Quantity> {
        match *self.layout().get(place)? {
            StateEntry::Displacement(_) => Some(Quantity::Displacement),
            StateEntry::Velocity(_) => Some(Quantity::Velocity),
            StateEntry::State(_) => None,
            StateEntry::Contact(index) if has_bristles(&self.contacts[index]) => {
                Some(Quantity::Displacement)
            }
            StateEntry::Contact(_) => Some(Quantity::Force),
        }
    }
}

fn has_bristles(contact: &Contact) -> bool {
    contact.friction.bristles().is_some()
}
