//! Transitions of contacts with a state of their own: release, adhesion and reversal.
//!
//! Each of them decides alone: its friction is given by its state and its slip, so that no force is sought. Where a decision depends on
//! rates at the moment (the direction in which bristles start, the multiplicity of a zero) the step from there is expanded, and read.

use quell_model::Friction;
use quell_model::friction::SlidingLaw;

use super::engine::{MotionProgress, MotionRun};
use super::own_friction::own_speed;
use super::own_state::{OwnState, OwnStateKind};
use super::phase::{ContactNow, ContactPhase, ElasticNow, OwnNow};
use crate::simulation::ORDER;

/// Forces within this share of a level are at it: they are ends of steps, accurate to their tolerance.
const AT_LEVEL: f64 = 1e-11;

/// Rates below this share of their terms are zero to rounding.
const ZERO_RATE: f64 = 1e-9;

/// Terms of a slip velocity below this share of the largest are rounding where a run begins.
const NO_TERM: f64 = 1e-12;

impl MotionRun<'_> {
    /// The state of a contact, and its number; `None` of a rigid one.
    fn own(&self, contact: usize) -> Option<(OwnState, f64)> {
        let own = self.equations.contacts[contact].own?;
        Some((own, self.series.start()[own.place]))
    }

    /// Friction of a contact with a state of its own now; `None` of a rigid one.
    pub(super) fn own_force(&self, contact: usize) -> Option<f64> {
        let (own, number) = self.own(contact)?;
        let now = &self.now[contact];
        if now.is_open() {
            return Some(0.0);
        }
        let pressed = self.load(contact) * self.factor(contact);
        let slip = self.slip(contact).0;
        let law = &self.system.contacts[contact].friction;
        Some(match (own.kind, now.phase) {
            (OwnStateKind::Elastic { .. }, ContactPhase::Slip(direction)) => {
                f64::from(direction) * law.coefficient(slip.abs()) * pressed
            }
            (OwnStateKind::Elastic { .. }, _) => number,
            (OwnStateKind::Bristles { stiffness, damping, viscous }, _) => {
                let level = level_at(law, slip);
                let rate = slip - stiffness * slip.abs() / level * number;
                pressed * (stiffness * number + damping * rate + viscous * slip)
            }
        })
    }

    /// The phase of a contact that keeps its state, or opens.
    pub(super) fn now_in(&self, contact: usize, phase: ContactPhase) -> ContactNow {
        match self.equations.contacts[contact].own {
            Some(own) => own.now(phase),
            None => ContactNow::of(phase),
        }
    }

    /// What the contacts with states of their own do at the start of a run: no event.
    pub(super) fn begin_own(&mut self) -> MotionProgress {
        for contact in 0..self.now.len() {
            let Some((own, number)) = self.own(contact) else { continue };
            if self.now[contact].kept || self.now[contact].is_open() {
                continue;
            }
            match own.kind {
                OwnStateKind::Elastic { .. } => self.begin_elastic(contact, number)?,
                OwnStateKind::Bristles { .. } => self.begin_bristles(contact)?,
            }
        }
        Ok(())
    }

    /// An elastic slider slides at the start of a run if T is at the sliding level and its own speed in that direction, or if T is
    /// beyond its static bound. Otherwise it adheres.
    fn begin_elastic(&mut self, contact: usize, force: f64) -> MotionProgress {
        let direction: i8 = if force < 0.0 { -1 } else { 1 };
        let pressed = self.load(contact).max(0.0) * self.factor(contact);
        let slip = self.slip(contact).0;
        let bound = self.equations.contacts[contact].static_coefficient * pressed;
        let level = self.system.contacts[contact].friction.coefficient(slip.abs()) * pressed;
        self.set_elastic(contact, ContactPhase::Stick, slip, |_| {});
        let is_at = |level: f64| level > 0.0 && (force.abs() - level).abs() <= AT_LEVEL * level;
        if force.abs() > bound * (1.0 + AT_LEVEL) {
            self.set_elastic(contact, ContactPhase::Slip(direction), slip, |_| {});
        } else if is_at(level) {
            self.set_elastic(contact, ContactPhase::Slip(direction), slip, |_| {});
            let (speed, _) = self.own_speed_now(contact)?;
            if f64::from(direction) * speed <= 0.0 {
                self.series_start(contact, force);
                self.set_elastic(contact, ContactPhase::Stick, slip, |_| {});
            }
        }
        if self.now[contact].phase == ContactPhase::Stick && is_at(bound) {
            self.find_margin_zeros(contact, direction)?;
        }
        Ok(())
    }

    /// T of an elastic slider that slides from the start of a run follows from the slip and the load, for any number before.
    pub(super) fn begin_sliding(&mut self, contact: usize, direction: i8) {
        let Some((OwnState { kind: OwnStateKind::Elastic { .. }, .. }, _)) = self.own(contact)
        else {
            return;
        };
        let pressed = self.load(contact).max(0.0) * self.factor(contact);
        let slip = self.slip(contact).0;
        let level = self.system.contacts[contact].friction.coefficient(slip.abs()) * pressed;
        self.series_start(contact, f64::from(direction) * level);
    }

    /// Bristles slip in the direction of γ; where γ = 0, in that of its first derivative that is not zero.
    fn begin_bristles(&mut self, contact: usize) -> MotionProgress {
        if self.now[contact].slip_zeros == 0 {
            return Ok(());
        }
        self.look_ahead()?;
        let slip = &self.series.contacts[contact].slip;
        let mut terms = *slip;
        let mut scale = 1.0;
        for term in &mut terms {
            *term *= scale;
            scale *= self.time_scale;
        }
        let largest = terms.iter().fold(0.0, |most: f64, term| most.max(term.abs()));
        let first = (1..=ORDER).find(|k| terms[*k].abs() > NO_TERM * largest);
        if let Some(first) = first {
            let direction = if terms[first] < 0.0 { -1 } else { 1 };
            let now = self.now_in(contact, ContactPhase::Slip(direction));
            self.now[contact] = ContactNow { slip_zeros: first, ..now };
        }
        Ok(())
    }

    /// The slip of a contact with a state of its own has ended: its own speed, or of bristles γ, has reached zero.
    pub(super) fn own_slip_ends(&mut self, contact: usize, is_immediate: bool) -> MotionProgress {
        let load_zeros = self.now[contact].load_zeros;
        let ContactPhase::Slip(direction) = self.now[contact].phase else { return Ok(()) };
        let OwnNow::Elastic(elastic) = self.now[contact].own else {
            let now = self.now_in(contact, ContactPhase::Slip(-direction));
            self.now[contact] = ContactNow { slip_zeros: 1, load_zeros, ..now };
            return Ok(());
        };
        if is_immediate && !elastic.is_released {
            // T of a spring does not jump up: it adheres with what it carried before its load did.
            let carried = self.series.contacts[contact].own.as_ref().map(|own| own.carried);
            if let Some(carried) = carried {
                self.series_start(contact, carried);
            }
        }
        let slip = self.slip(contact).0;
        self.set_elastic(contact, ContactPhase::Stick, slip, |_| {});
        self.now[contact].load_zeros = load_zeros;
        let pressed = self.load(contact) * self.factor(contact);
        let bound = self.equations.contacts[contact].static_coefficient * pressed;
        let force = f64::from(direction) * self.own(contact).map_or(0.0, |(_, force)| force);
        if (bound - force).abs() <= AT_LEVEL * bound {
            self.find_margin_zeros(contact, direction)?;
        }
        Ok(())
    }

    /// An elastic slider has reached its static bound.
    pub(super) fn own_release(&mut self, contact: usize, direction: i8) -> MotionProgress {
        let load_zeros = self.now[contact].load_zeros;
        let slip = self.slip(contact).0;
        let released = |own: &mut ElasticNow| own.is_released = true;
        self.set_elastic(contact, ContactPhase::Slip(direction), slip, released);
        self.now[contact].load_zeros = load_zeros;
        let (speed, terms) = self.own_speed_now(contact)?;
        if speed.abs() <= ZERO_RATE * terms
            && let OwnNow::Elastic(own) = &mut self.now[contact].own
        {
            own.speed_zeros = 1;
        }
        Ok(())
    }

    /// γ of an elastic slider that slides has changed its sign: |γ| has a kink there.
    pub(super) fn own_turn(&mut self, contact: usize) {
        let now = &mut self.now[contact];
        if let (OwnNow::Elastic(own), ContactPhase::Slip(_)) = (&mut now.own, now.phase) {
            own.branch = -own.branch;
            now.slip_zeros = 1;
        }
    }

    /// A contact with a state of its own has landed: an elastic slider slides at once where the load rises slower than its spring.
    pub(super) fn own_landing(&mut self, contact: usize) -> MotionProgress {
        let Some((OwnState { kind: OwnStateKind::Elastic { stiffness }, .. }, _)) =
            self.own(contact)
        else {
            return Ok(());
        };
        let load_zeros = self.now[contact].load_zeros;
        let slip = self.slip(contact).0;
        self.set_elastic(contact, ContactPhase::Stick, slip, |own| own.margin_zeros = [1, 1]);
        self.now[contact].load_zeros = load_zeros;
        self.look_ahead()?;
        let level = self.equations.contacts[contact].static_coefficient;
        let rise = level * self.series.contacts[contact].pressed[1];
        if load_zeros > 0 && stiffness * slip.abs() > rise {
            let direction = if slip < 0.0 { -1 } else { 1 };
            self.set_elastic(contact, ContactPhase::Slip(direction), slip, |_| {});
            self.now[contact].load_zeros = load_zeros;
        } else if load_zeros == 0 {
            self.set_elastic(contact, ContactPhase::Stick, slip, |_| {});
        }
        Ok(())
    }

    /// Sets what an elastic slider does.
    fn set_elastic(
        &mut self,
        contact: usize,
        phase: ContactPhase,
        slip: f64,
        change: impl FnOnce(&mut ElasticNow),
    ) {
        let branch = match phase {
            ContactPhase::Slip(direction) if slip == 0.0 => direction,
            ContactPhase::Slip(_) => {
                if slip < 0.0 {
                    -1
                } else {
                    1
                }
            }
            ContactPhase::Stick | ContactPhase::Open => 0,
        };
        let mut own = ElasticNow { branch, ..ElasticNow::default() };
        change(&mut own);
        self.now[contact] = ContactNow { own: OwnNow::Elastic(own), ..ContactNow::of(phase) };
    }

    /// Sets the number of a contact at the start of the next step.
    fn series_start(&mut self, contact: usize, number: f64) {
        if let Some(own) = self.equations.contacts[contact].own {
            self.series.states[own.place] = number;
        }
    }

    /// Expands the step from here, for its rates alone.
    fn look_ahead(&mut self) -> MotionProgress {
        self.refresh()?;
        self.expand(self.longest, self.time_scale);
        Ok(())
    }

    /// The own speed of an elastic slider that slides, and the size of its terms.
    fn own_speed_now(&mut self, contact: usize) -> Result<(f64, f64), super::MotionStopped> {
        self.look_ahead()?;
        let Some(OwnState { kind: OwnStateKind::Elastic { stiffness }, .. }) =
            self.equations.contacts[contact].own
        else {
            return Ok((0.0, 0.0));
        };
        let series = &self.series.contacts[contact];
        let mut speed = [0.0; ORDER + 1];
        own_speed(series, stiffness, &mut speed);
        let spring = (series.friction[1] / stiffness).abs();
        Ok((speed[0], self.slip(contact).1 + spring))
    }

    /// The multiplicity of the zero of the margin of an elastic slider that begins to adhere at its static bound: 2 where its own
    /// speed is zero, for the margin falls at the rate k_t γ − μ_s Ṅ; else 1.
    fn find_margin_zeros(&mut self, contact: usize, direction: i8) -> MotionProgress {
        self.look_ahead()?;
        let level = self.equations.contacts[contact].static_coefficient;
        let size = self.slip(contact).1;
        let series = &self.series.contacts[contact];
        let side = f64::from(direction);
        let rate = f64::mul_add(level, series.pressed[1], -(side * series.friction[1]));
        let per_slip = match self.equations.contacts[contact].own {
            Some(OwnState { kind: OwnStateKind::Elastic { stiffness }, .. }) => stiffness,
            _ => 0.0,
        };
        let terms = (level * series.pressed[1]).abs() + per_slip * size;
        let zeros = if rate.abs() <= ZERO_RATE * terms { 2 } else { 1 };
        if let OwnNow::Elastic(own) = &mut self.now[contact].own {
            own.margin_zeros[usize::from(direction < 0)] = zeros;
        }
        Ok(())
    }
}

/// g at a slip velocity.
fn level_at(law: &Friction, slip: f64) -> f64 {
    match law {
        Friction::Lugre(law) => law.level().coefficient(slip.abs()),
        law => law.coefficient(slip.abs()),
    }
}
