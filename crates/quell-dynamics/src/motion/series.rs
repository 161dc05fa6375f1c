//! The Taylor series of a step: the state, and slip velocity, load and friction of every contact.
//!
//! Order by order: the state gives slip and load, these give friction by the law's recurrence (or, in stick, by the condition
//! that γ stays 0), and friction gives the next order of the state. Nothing is implicit: γ and N read the state, and friction
//! enters its derivative.

use quell_numerics::lane::Lane;

use super::contact_series::{ContactSeries, SeriesOf};
use super::equations::{Forcings, MotionEquations};
use super::own_state::OwnSeries;
use super::speed_terms::SpeedSeries;
use crate::simulation::{Clock, ORDER};

/// Series of a step; the memory is kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct StepSeries {
    size: usize,
    /// Order by order, the state side by side.
    pub(super) states: Vec<f64>,
    /// Memory of the state and its rates of one order.
    pub(super) buffers: [Vec<f64>; 2],
    pub(super) pushes: Vec<SeriesOf<f64>>,
    pub(super) contacts: Vec<ContactSeries>,
    /// The terms of a speed over time: none in lanes.
    pub(super) by_speed: Option<Box<SpeedSeries>>,
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
                load_varies: contact.is_compliant() || !forcing.load.is_constant(),
                is_guided: !forcing.guided.is_constant(),
                has_factor: forcing.factor.is_some(),
                surface: forcing.surface.series(clock),
                given,
                load: given,
                pressed: given,
                guided: forcing.guided.series(clock),
                own: contact.own.map(|_| Box::new(OwnSeries::zero())),
                ..ContactSeries::zero()
            }
        });
        let by_speed = equations.by_speed.as_ref().map(|given| Box::new(SpeedSeries::new(given)));
        Self { by_speed, ..Self::with(size, equations.pushes.len(), contacts.collect()) }
    }
}

impl StepSeries {
    /// With a state of zeros.
    pub(super) fn with(size: usize, pushes: usize, contacts: Vec<ContactSeries>) -> Self {
        let zeros = |count: usize| vec![0.0; count];
        Self {
            size,
            states: zeros((ORDER + 2) * size),
            buffers: [zeros(size), zeros(size)],
            pushes: vec![[0.0; ORDER + 1]; pushes],
            contacts,
            by_speed: None,
            scales: zeros(size),
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
pub(super) fn horner_states<V: Lane>(states: &[V], since: V, out: &mut [V]) {
    let size = out.len();
    out.copy_from_slice(&states[ORDER * size..(ORDER + 1) * size]);
    for k in (0..ORDER).rev() {
        for (value, coefficient) in out.iter_mut().zip(&states[k * size..(k + 1) * size]) {
            *value = value.mul_add(since, *coefficient);
        }
    }
}
