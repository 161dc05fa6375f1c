//! The Taylor series of a step: the state, and slip velocity, load and friction of every contact.
//!
//! Order by order: the state gives slip and load, these give friction by the law's recurrence (or, in stick, by the condition
//! that γ stays 0), and friction gives the next order of the state. Nothing is implicit: γ and N read the state, and friction
//! enters its derivative.

use quell_model::friction::{BranchSeries, FrictionConstants, FrictionSeries};
use quell_numerics::dispatch::Work;
use quell_numerics::polynomial::step_length;

use super::contact_series::ContactSeries;
use super::equations::{ContactEquation, Forcings, MotionEquations};
use super::phase::{ContactNow, ContactPhase};
use super::stuck::StuckForces;
use crate::simulation::{Clock, ORDER, RECIPROCALS, Series};

/// Series of a step; the memory is kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct StepSeries {
    size: usize,
    /// Order by order, the state side by side.
    pub(super) states: Vec<f64>,
    rates: Vec<f64>,
    pushes: Vec<Series>,
    pub(super) contacts: Vec<ContactSeries>,
    /// Magnitude of every number of the state in the last steps, over the time scale of the system.
    scales: Vec<f64>,
}

/// Share of the magnitude of a number that counts in the next step: a large transient is forgotten after some steps, so that it
/// does not loosen the tolerance of the motion that remains.
const FORGOTTEN: f64 = 0.8;

/// Limits on the length of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepLimit {
    /// Bound on the last two retained terms, relative to the scale of each number of the state.
    pub(super) tolerance: f64,
    /// Time scale of the system.
    pub(super) time_scale: f64,
    /// ORDER/2 radians of the fastest wave.
    pub(super) longest: f64,
    /// Time to the next moment that no step may pass.
    pub(super) room: f64,
}

impl StepSeries {
    pub(super) fn new(equations: &MotionEquations, forcings: &Forcings, clock: Clock) -> Self {
        let size = equations.size;
        let contacts = forcings.contacts.iter().map(|forcing| ContactSeries {
            surface: forcing.surface.series(clock),
            given: forcing.load.series(clock),
            guided: forcing.guided.series(clock),
            ..ContactSeries::ZERO
        });
        Self {
            size,
            states: vec![0.0; (ORDER + 2) * size],
            rates: vec![0.0; size],
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

    /// Value of every number of the state at a time after the start of the step.
    #[inline(always)]
    pub(super) fn state_at(&self, since: f64, out: &mut [f64]) {
        horner_states(&self.states, since, out);
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

/// Computes the series of a step and its length.
pub(super) struct StepExpansion<'a> {
    pub(super) equations: &'a MotionEquations,
    pub(super) forcings: &'a Forcings,
    pub(super) laws: &'a mut [FrictionConstants],
    pub(super) now: &'a [ContactNow],
    pub(super) stuck: &'a StuckForces,
    pub(super) clock: Clock,
    pub(super) limit: StepLimit,
    pub(super) out: &'a mut StepSeries,
}

impl Work for StepExpansion<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(mut self) -> f64 {
        self.forcings();
        let mut branches = self.branches();
        for k in 0..=ORDER {
            self.order(k, &mut branches);
        }
        let length = self.length();
        let mut length = length.min(self.limit.longest).min(self.limit.room);
        for (branch, contact) in branches.iter().zip(&self.out.contacts) {
            if let Some(branch) = branch {
                length = branch.trusted(&contact.scaled, length);
            }
        }
        length
    }
}

/// One recurrence for each slipping contact.
type Branches<'c> = Vec<Option<FrictionSeries<'c, { ORDER + 1 }>>>;

impl<'a> StepExpansion<'a> {
    /// Series of what varies in time; constant ones were written when the run began.
    #[inline(always)]
    fn forcings(&mut self) {
        for (series, forcing) in self.out.pushes.iter_mut().zip(&self.forcings.pushes) {
            *series = forcing.series(self.clock);
        }
        for (contact, forcing) in self.out.contacts.iter_mut().zip(&self.forcings.contacts) {
            if !forcing.surface.is_constant() {
                contact.surface = forcing.surface.series(self.clock);
            }
            if !forcing.load.is_constant() {
                contact.given = forcing.load.series(self.clock);
            }
            if !forcing.guided.is_constant() {
                contact.guided = forcing.guided.series(self.clock);
            }
            if let Some(factor) = &forcing.factor {
                contact.factor = factor.series(self.clock);
            }
        }
    }

    /// The laws' recurrences at the start of the step.
    #[inline(always)]
    fn branches(&mut self) -> Branches<'a> {
        let laws = std::mem::take(&mut self.laws);
        let mut branches = Vec::with_capacity(laws.len());
        for (index, law) in laws.iter_mut().enumerate() {
            let ContactPhase::Slip(sign) = self.now[index].phase else {
                branches.push(None);
                continue;
            };
            let contact = &self.equations.contacts[index];
            let surface = self.out.contacts[index].surface[0];
            let slip = if self.now[index].slip_zeros > 0 {
                0.0
            } else {
                surface - contact.tangent.dot(self.out.start())
            };
            branches.push(Some(law.series::<{ ORDER + 1 }>(f64::from(sign), slip / contact.scale)));
        }
        branches
    }

    /// One order: forces from the state, then the next order of the state.
    #[inline(always)]
    fn order(&mut self, k: usize, branches: &mut Branches<'_>) {
        let size = self.out.size;
        let (head, tail) = self.out.states.split_at_mut((k + 1) * size);
        let state = &head[k * size..];
        let rates = &mut self.out.rates[..size];
        self.equations.matrix.times(state, rates);
        if k == 0 {
            for (rate, constant) in rates.iter_mut().zip(&self.equations.constant) {
                *rate += constant;
            }
        }
        for (push, series) in self.equations.pushes.iter().zip(&self.out.pushes) {
            if series[k] != 0.0 {
                push.add_to(series[k], rates);
            }
        }
        for (index, contact) in self.equations.contacts.iter().enumerate() {
            let series = &mut self.out.contacts[index];
            let now = &self.now[index];
            let guided = !self.forcings.contacts[index].guided.is_constant();
            read(k, contact, now, state, series, rates, guided);
            let steady =
                !contact.is_compliant() && self.forcings.contacts[index].load.is_constant();
            press(k, series, self.forcings.contacts[index].factor.is_some());
            let force = match (now.phase, &mut branches[index]) {
                (ContactPhase::Slip(_), Some(branch)) => {
                    let w = series.slip[k] / contact.scale;
                    series.scaled[k] = w;
                    series.coefficient[k] = if k == 0 {
                        branch.first()
                    } else {
                        f64::mul_add(branch.slope(), w, branch.lower(k, &series.scaled))
                    };
                    if steady && self.forcings.contacts[index].factor.is_none() {
                        series.coefficient[k] * series.pressed[0]
                    } else {
                        convolution(&series.coefficient, &series.pressed, k, 0)
                    }
                }
                (ContactPhase::Stick, _) if now.saturated != 0 => {
                    f64::from(now.saturated) * contact.static_coefficient * series.pressed[k]
                }
                _ => {
                    series.friction[k] = 0.0;
                    if !contact.slope.is_empty() && now.sticks() {
                        // T of this order is not known yet; what it owes to the lower orders is.
                        let known = convolution(&series.tilt, &series.friction, k, 1);
                        contact.across.add_to(known, rates);
                    }
                    continue;
                }
            };
            series.friction[k] = force;
            contact.along.add_to(force, rates);
            if !contact.slope.is_empty() {
                let tilted = convolution(&series.tilt, &series.friction, k, 0);
                contact.across.add_to(tilted, rates);
            }
        }
        self.stuck.hold(self.equations, k, &mut self.out.contacts, rates);
        for (next, rate) in tail[..size].iter_mut().zip(rates.iter()) {
            *next = rate * RECIPROCALS[k + 1];
        }
    }

    /// Length over which the last retained terms stay below the tolerance.
    #[inline(always)]
    fn length(&mut self) -> f64 {
        let size = self.out.size;
        let time = self.limit.time_scale;
        let (mut last, mut previous) = (0.0_f64, 0.0_f64);
        for i in 0..size {
            let at = |k: usize| self.out.states[k * size + i].abs();
            let mut scale = at(4);
            for k in (0..4).rev() {
                scale = (scale * time).max(at(k));
            }
            scale = scale.max(FORGOTTEN * self.out.scales[i]);
            self.out.scales[i] = scale;
            if scale > 0.0 {
                last = last.max(at(ORDER) / scale);
                previous = previous.max(at(ORDER - 1) / scale);
            }
        }
        for (index, contact) in self.equations.contacts.iter().enumerate() {
            let series = &self.out.contacts[index];
            let mut bound = |terms: &Series, scale: f64| {
                if scale > 0.0 {
                    last = (terms[ORDER].abs() / scale).max(last);
                    previous = (terms[ORDER - 1].abs() / scale).max(previous);
                }
            };
            if self.now[index].sticks() {
                let level = contact.static_coefficient * series.pressed[0].abs();
                bound(
                    &series.friction,
                    level.max(contact.static_coefficient * contact.normal_load),
                );
            }
            if contact.is_compliant() || !self.forcings.contacts[index].load.is_constant() {
                bound(&series.load, series.load[0].abs().max(contact.normal_load));
            }
        }
        step_length(self.limit.tolerance, last, previous, ORDER)
    }
}

/// Slip velocity, load and tilt of a contact at order k, and its reaction on the structure.
#[inline(always)]
fn read(
    k: usize,
    contact: &ContactEquation,
    now: &ContactNow,
    state: &[f64],
    series: &mut ContactSeries,
    rates: &mut [f64],
    guided: bool,
) {
    let is_zero = now.sticks() || k < now.slip_zeros;
    series.slip[k] = if is_zero { 0.0 } else { series.surface[k] - contact.tangent.dot(state) };
    series.load[k] = if contact.is_compliant() {
        series.given[k] + contact.approach.dot(state)
    } else {
        series.given[k]
    };
    if !contact.across.is_empty() {
        let rest = if k == 0 { contact.normal_load } else { 0.0 };
        let carried = if guided { rest + series.guided[k] } else { rest };
        let load = if now.is_open() { 0.0 } else { series.load[k] };
        let reaction = load - carried;
        if reaction != 0.0 {
            contact.across.add_to(-reaction, rates);
        }
    }
    if k < now.load_zeros {
        series.load[k] = 0.0;
    }
    if !contact.slope.is_empty() {
        series.tilt[k] = contact.slope.dot(state);
    }
}

/// What the coefficient of friction multiplies.
#[inline(always)]
fn press(k: usize, series: &mut ContactSeries, has_factor: bool) {
    series.pressed[k] =
        if has_factor { convolution(&series.factor, &series.load, k, 0) } else { series.load[k] };
}

/// Σ aᵢ bₖ₋ᵢ over i = `from`…k.
#[inline(always)]
fn convolution(a: &Series, b: &Series, k: usize, from: usize) -> f64 {
    let mut sum = 0.0;
    for i in from..=k {
        sum = f64::mul_add(a[i], b[k - i], sum);
    }
    sum
}
