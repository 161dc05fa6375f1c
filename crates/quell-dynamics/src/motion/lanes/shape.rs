//! The structure that the lanes of a group share.

use quell_model::System;
use quell_model::friction::Friction;

use super::super::contact_equation::ContactEquation;
use super::super::equations::{Forcings, MotionEquations};
use super::super::rows::StateRow;
use super::super::step_recurrence::FEW_CONTACTS;
use super::forcings::Varying;
use crate::simulation::Clock;

/// What decides which operations a step does, apart from the phases of the contacts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LaneShape {
    size: usize,
    pushes: Vec<Varying>,
    contacts: Vec<ContactShape>,
}

/// The part of a contact.
#[derive(Clone, Debug)]
struct ContactShape {
    /// Whether tangent, approach, slope, along and across are empty.
    empty: [bool; 5],
    /// How surface, load, the guided part of the load, and the factor vary.
    varying: [Option<Varying>; 4],
    law: Friction,
}

impl PartialEq for ContactShape {
    fn eq(&self, other: &Self) -> bool {
        (self.empty, self.varying) == (other.empty, other.varying) && self.law.is_alike(&other.law)
    }
}

impl LaneShape {
    /// The shape of a system with its equations; `None` if it cannot share lanes.
    pub(super) fn of(system: &System, equations: &MotionEquations) -> Option<Self> {
        let MotionEquations { size, contacts, by_speed, .. } = equations;
        let has_own_state = contacts.iter().any(|contact| contact.own.is_some());
        let is_small = [2, 4, 6, 8].contains(size) && contacts.len() <= FEW_CONTACTS;
        if !is_small || has_own_state || by_speed.is_some() {
            return None;
        }
        let forcings = Forcings::of(system, Clock::at(0.0));
        let shapes = contacts.iter().zip(&forcings.contacts).zip(&system.contacts);
        let shapes = shapes.map(|((equation, forcing), contact)| {
            let ContactEquation { tangent, approach, slope, along, across, .. } = equation;
            let varying = [&forcing.surface, &forcing.load, &forcing.guided].map(Varying::of);
            let [surface, load, guided] = varying.map(Some);
            ContactShape {
                empty: [tangent, approach, slope, along, across].map(StateRow::is_empty),
                varying: [surface, load, guided, forcing.factor.as_ref().map(Varying::of)],
                law: contact.friction.clone(),
            }
        });
        Some(Self {
            size: *size,
            pushes: forcings.pushes.iter().map(Varying::of).collect(),
            contacts: shapes.collect(),
        })
    }

    /// Laws like those of the contacts.
    pub(super) fn laws(&self) -> impl Iterator<Item = &Friction> {
        self.contacts.iter().map(|contact| &contact.law)
    }
}
