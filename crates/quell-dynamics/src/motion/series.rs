//! The Taylor series of a step: the state, and slip velocity, load and friction of every contact.
//!
//! Order by order: the state gives slip and load, these give friction by the law's recurrence (or, in stick, by the condition
//! that γ stays 0), and friction gives the next order of the state. Nothing is implicit: γ and N read the state, and friction
//! enters its derivative.

use super::contact_series::ContactSeries;
use super::equations::{Forcings, MotionEquations};
use crate::simulation::{Clock, ORDER, Series};

/// Series of a step; the memory is kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct StepSeries {
    size: usize,
    /// Order by order, the state side by side.
    pub(super) states: Vec<f64>,
    /// Memory of the state and its rates of one order.
    pub(super) buffers: [Vec<f64>; 2],
    pub(super) pushes: Vec<Series>,
    pub(super) contacts: Vec<ContactSeries>,
    /// Magnitude of every number of the state in the last steps, over the time scale of the system.
    pub(super) scales: Vec<f64>,
}

impl StepSeries {
    pub(super) fn new(equations: &MotionEquations, forcings: &Forcings, clock: Clock) -> Self {
        let size = equations.size;
        let contacts = equations.contacts.iter().zip(&forcings.contacts);
        let contacts = contacts.map(|(contact, forcing)| {
            let given = forcing.load.series(clock);
            ContactSeries {
                is_plain: contact.is_plain(forcing),
                surface: forcing.surface.series(clock),
                given,
                load: given,
                pressed: given,
                guided: forcing.guided.series(clock),
                ..ContactSeries::ZERO
            }
        });
        Self {
            size,
            states: vec![0.0; (ORDER + 2) * size],
            buffers: [vec![0.0; size], vec![0.0; size]],
            pushes: vec![[0.0; ORDER + 1]; equations.pushes.len()],
            contacts: contacts.collect(),
            scales: vec![0.0; size],
        }
    }

    /// The state at the start of the step.
    pub(super) fn start(&self) -> &[f64] {
        &self.states[..self.size]
    }

    /// Sets the state at the start of the next step.
    pub(super) fn set_start(&mut self, state: &[f64]) {
        self.states[..self.size].copy_from_slice(state);
    }
}

/// The state of a series at a time after its start.
#[inline(always)]
pub(super) fn horner_states(states: &[f64], since: f64, out: &mut [f64]) {
    let size = out.len();
    out.copy_from_slice(&states[ORDER * size..(ORDER + 1) * size]);
    for k in (0..ORDER).rev() {
        for (value, coefficient) in out.iter_mut().zip(&states[k * size..(k + 1) * size]) {
            *value = f64::mul_add(*value, since, *coefficient);
        }
    }
}
