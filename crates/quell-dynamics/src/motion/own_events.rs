//! Transitions of contacts with a state of their own: release, adhesion and reversal.
//!
//! Each of them decides alone: its friction is given by its state and its slip, so that no force is sought. Where a decision depends on
//! rates at the moment (the direction in which bristles start, the multiplicity of a zero) the step from there is expanded, and read.

use quell_model::Friction;
use quell_model::friction::SlidingLaw;

use super::departure::Departure;
use super::engine::{MotionProgress, MotionRun};
use super::guards::{carried_through_jump, level_margin, margin_above};
use super::own_friction::own_speed;
use super::own_state::{OwnState, OwnStateKind};
use super::phase::{ContactNow, ContactPhase, ElasticNow, OwnNow};
use super::stopped::MotionStopped;
use crate::simulation::{ORDER, Series};

/// Forces within this share of a level are at it: they are ends of steps, accurate to their tolerance.
const AT_LEVEL: f64 = 1e-11;

/// Forces within this share of the sliding level are near it: a guess of a periodic motion that slides misses the level by the square of
/// its error.
const NEAR_LEVEL: f64 = 1e-2;

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
        if force.abs() > bound * (1.0 + AT_LEVEL) && force.abs() < level * (1.0 - AT_LEVEL) {
            self.set_elastic(contact, ContactPhase::Stick, slip, |own| own.beyond = direction);
        } else if force.abs() > bound * (1.0 + AT_LEVEL) {
            self.set_elastic(contact, ContactPhase::Slip(direction), slip, |_| {});
        } else if is_at(level) {
            self.set_elastic(contact, ContactPhase::Slip(direction), slip, |_| {});
            self.leave_zero(contact, 0)?;
            let leaves = self.own_speed_leaves(contact)?;
            if leaves.sign == direction {
                self.note_speed_zeros(contact, leaves.zeros);
            } else {
                self.series_start(contact, force);
                self.adhere(contact, direction)?;
            }
        }
        let adheres_below = match self.now[contact].own {
            OwnNow::Elastic(own) => own.beyond == 0,
            OwnNow::Rigid | OwnNow::Bristles => false,
        };
        if self.now[contact].phase == ContactPhase::Stick && adheres_below && is_at(bound) {
            let zeros = self.bound_margin(contact, direction)?.zeros;
            self.note_zeros(contact, usize::from(direction < 0), zeros);
        }
        Ok(())
    }

    /// The state with T of the elastic sliders that are near their sliding levels put at them, where they slide from there on, and these
    /// contacts; `None` where no T changes.
    pub(super) fn at_sliding_levels(mut self) -> Option<(Vec<f64>, Vec<usize>)> {
        let given = self.series.start().to_vec();
        let mut near = Vec::new();
        for contact in 0..self.now.len() {
            let Some((OwnState { kind: OwnStateKind::Elastic { .. }, place }, force)) =
                self.own(contact)
            else {
                continue;
            };
            let pressed = self.load(contact).max(0.0) * self.factor(contact);
            let slip = self.slip(contact).0;
            let level = self.system.contacts[contact].friction.coefficient(slip.abs()) * pressed;
            let off = (force.abs() - level).abs();
            if off > AT_LEVEL * level && off <= NEAR_LEVEL * level {
                self.series_start(contact, level.copysign(force));
                near.push((contact, place));
            }
        }
        if near.is_empty() {
            return None;
        }
        let mut state = self.series.start().to_vec();
        self.open().ok()?;
        near.retain(|(contact, place)| {
            let slides = matches!(self.now[*contact].phase, ContactPhase::Slip(_));
            if !slides {
                state[*place] = given[*place];
            }
            slides
        });
        let contacts: Vec<usize> = near.into_iter().map(|(contact, _)| contact).collect();
        (!contacts.is_empty()).then_some((state, contacts))
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
        let leaves = self.slip_leaves(contact, 1)?;
        if leaves.sign != 0 {
            self.slip_after(contact, leaves);
        }
        Ok(())
    }

    /// Bristles slip on from a zero of γ.
    fn slip_after(&mut self, contact: usize, Departure { zeros, sign }: Departure) {
        let load_zeros = self.now[contact].load_zeros;
        let now = self.now_in(contact, ContactPhase::Slip(sign));
        self.now[contact] = ContactNow { slip_zeros: zeros, load_zeros, ..now };
    }

    /// The slip of a contact with a state of its own has ended: its own speed, or of bristles γ, has reached zero.
    pub(super) fn own_slip_ends(&mut self, contact: usize, is_immediate: bool) -> MotionProgress {
        let load_zeros = self.now[contact].load_zeros;
        let ContactPhase::Slip(direction) = self.now[contact].phase else { return Ok(()) };
        let OwnNow::Elastic(elastic) = self.now[contact].own else {
            let leaves = self.slip_leaves(contact, 1)?;
            let reversed = Departure { zeros: 1, sign: -direction };
            self.slip_after(contact, if leaves.sign == 0 { reversed } else { leaves });
            return Ok(());
        };
        if is_immediate && !elastic.is_released {
            // T of a spring does not jump up: it adheres with what it carried before its load did.
            let carried = self.series.contacts[contact].own.as_ref().map(|own| own.carried);
            if let Some(carried) = carried {
                self.series_start(contact, carried);
            }
        }
        self.adhere(contact, direction)?;
        self.now[contact].load_zeros = load_zeros;
        Ok(())
    }

    /// An elastic slider adheres from here; `direction` is the side on which T may be at a bound. T of a spring does not jump up: beyond
    /// its static bound it adheres on while the sliding level is higher.
    fn adhere(&mut self, contact: usize, direction: i8) -> MotionProgress {
        let slip = self.slip(contact).0;
        let pressed = self.load(contact) * self.factor(contact);
        let bound = self.equations.contacts[contact].static_coefficient * pressed;
        let level = self.system.contacts[contact].friction.coefficient(slip.abs()) * pressed;
        let force = f64::from(direction) * self.own(contact).map_or(0.0, |(_, force)| force);
        let is_at = |level: f64| (level - force).abs() <= AT_LEVEL * level;
        self.set_elastic(contact, ContactPhase::Stick, slip, |_| {});
        let mut zeros = 0;
        if is_at(bound) {
            let margin = self.bound_margin(contact, direction)?;
            zeros = margin.zeros;
            if margin.sign >= 0 {
                self.note_zeros(contact, usize::from(direction < 0), zeros);
                return Ok(());
            }
        } else if force <= bound {
            return Ok(());
        }
        self.set_elastic(contact, ContactPhase::Stick, slip, |own| own.beyond = direction);
        self.leave_zero(contact, 0)?;
        self.note_zeros(contact, 1, zeros);
        if is_at(level) {
            let zeros = self.level_margin(contact)?.zeros;
            self.note_zeros(contact, 0, zeros);
        }
        Ok(())
    }

    /// An elastic slider has reached its static bound, or, where it adheres beyond it, the sliding level or the static bound again.
    pub(super) fn own_release(&mut self, contact: usize, direction: i8) -> MotionProgress {
        let load_zeros = self.now[contact].load_zeros;
        let slip = self.slip(contact).0;
        let beyond = match self.now[contact].own {
            OwnNow::Elastic(own) => own.beyond,
            OwnNow::Rigid | OwnNow::Bristles => 0,
        };
        let side = if beyond == 0 { direction } else { beyond };
        let pressed = self.load(contact) * self.factor(contact);
        let bound = self.equations.contacts[contact].static_coefficient * pressed;
        let level = self.system.contacts[contact].friction.coefficient(slip.abs()) * pressed;
        let force = f64::from(side) * self.own(contact).map_or(0.0, |(_, force)| force);
        let returns = direction == -beyond || bound - force > AT_LEVEL * bound;
        if beyond != 0 && returns {
            self.set_elastic(contact, ContactPhase::Stick, slip, |_| {});
            if (bound - force).abs() <= AT_LEVEL * bound {
                let zeros = self.bound_margin(contact, beyond)?.zeros;
                self.note_zeros(contact, usize::from(beyond < 0), zeros);
            }
            self.now[contact].load_zeros = load_zeros;
            return Ok(());
        }
        if level - force > AT_LEVEL * level {
            self.set_elastic(contact, ContactPhase::Stick, slip, |own| own.beyond = side);
            self.leave_zero(contact, 0)?;
            if beyond == 0 && (bound - force).abs() <= AT_LEVEL * bound {
                let zeros = self.bound_margin(contact, side)?.zeros;
                self.note_zeros(contact, 1, zeros);
            }
            self.now[contact].load_zeros = load_zeros;
            return Ok(());
        }
        let released = |own: &mut ElasticNow| own.is_released = true;
        self.set_elastic(contact, ContactPhase::Slip(direction), slip, released);
        self.now[contact].load_zeros = load_zeros;
        self.leave_zero(contact, 0)?;
        let zeros = self.own_speed_leaves(contact)?.zeros;
        self.note_speed_zeros(contact, zeros);
        Ok(())
    }

    /// γ of an elastic slider that slides has changed its sign: |γ| has a kink there, at which its own speed jumps. Under a law that rises
    /// with |γ| the slip ends there.
    pub(super) fn own_turn(&mut self, contact: usize) -> MotionProgress {
        let ContactPhase::Slip(direction) = self.now[contact].phase else { return Ok(()) };
        self.leave_zero(contact, 1)?;
        let leaves = self.own_speed_leaves(contact)?;
        if leaves.sign == -direction {
            return self.own_slip_ends(contact, false);
        }
        self.note_speed_zeros(contact, leaves.zeros);
        Ok(())
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
        let bound = self.equations.contacts[contact].static_coefficient;
        let level = self.system.contacts[contact].friction.coefficient(slip.abs());
        let direction = if slip < 0.0 { -1 } else { 1 };
        let rise = self.series.contacts[contact].pressed[1];
        let pull = stiffness * slip.abs();
        if load_zeros > 0 && pull > bound.max(level) * rise {
            self.set_elastic(contact, ContactPhase::Slip(direction), slip, |_| {});
            self.now[contact].load_zeros = load_zeros;
        } else if load_zeros > 0 && pull > bound * rise {
            self.set_elastic(contact, ContactPhase::Stick, slip, |own| {
                (own.beyond, own.margin_zeros) = (direction, [1, 1]);
            });
            self.now[contact].load_zeros = load_zeros;
        } else if load_zeros == 0 {
            self.set_elastic(contact, ContactPhase::Stick, slip, |_| {});
        }
        Ok(())
    }

    /// At the end of a run at a jump of a load, T is what an elastic slider carries through the jump: from there the next run decides.
    pub(super) fn keep_carried(&mut self) {
        for contact in 0..self.now.len() {
            let series = &self.series.contacts[contact];
            if let Some(carried) = carried_through_jump(&self.now[contact], series) {
                self.series_start(contact, carried);
            }
        }
    }

    /// Sets what an elastic slider does.
    fn set_elastic(
        &mut self,
        contact: usize,
        phase: ContactPhase,
        slip: f64,
        change: impl FnOnce(&mut ElasticNow),
    ) {
        let mut own = ElasticNow::default();
        change(&mut own);
        let direction = if own.beyond == 0 { phase.slip_sign() } else { own.beyond };
        own.branch = match direction {
            0 => 0,
            _ if own.branch != 0 => own.branch,
            _ if slip < 0.0 => -1,
            _ if slip > 0.0 => 1,
            direction => direction,
        };
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

    /// How γ leaves zero, if it is zero to rounding; its first `known` terms are zero.
    fn slip_leaves(&mut self, contact: usize, known: usize) -> Result<Departure, MotionStopped> {
        self.look_ahead()?;
        let size = if known == 0 { self.slip(contact).1 } else { 0.0 };
        let slip = &self.series.contacts[contact].slip;
        Ok(Departure::of(slip, known, size, self.time_scale))
    }

    /// An elastic slider whose law is evaluated, and whose γ is zero to rounding, takes the branch of the sign that γ is about to have.
    fn leave_zero(&mut self, contact: usize, known: usize) -> MotionProgress {
        let Departure { zeros, sign } = self.slip_leaves(contact, known)?;
        let now = &mut self.now[contact];
        if let OwnNow::Elastic(own) = &mut now.own
            && zeros > 0
            && sign != 0
        {
            own.branch = sign;
            now.slip_zeros = zeros;
        }
        Ok(())
    }

    /// k_t; 0 of bristles and of rigid contacts.
    fn spring(&self, contact: usize) -> f64 {
        match self.equations.contacts[contact].own {
            Some(OwnState { kind: OwnStateKind::Elastic { stiffness }, .. }) => stiffness,
            _ => 0.0,
        }
    }

    /// How the own speed of an elastic slider that slides leaves zero, if it is zero to rounding.
    fn own_speed_leaves(&mut self, contact: usize) -> Result<Departure, MotionStopped> {
        self.look_ahead()?;
        let stiffness = self.spring(contact);
        let series = &self.series.contacts[contact];
        let mut speed = [0.0; ORDER + 1];
        own_speed(series, stiffness, &mut speed);
        let size = self.slip(contact).1 + (series.friction[1] / stiffness).abs();
        // The last term is beyond the order of the step.
        Ok(Departure::of(&speed[..ORDER], 0, size, self.time_scale))
    }

    /// How the static bound minus T on one side leaves zero, of a slider that adheres: it falls at the rate k_t γ − μ_s Ṅ.
    fn bound_margin(&mut self, contact: usize, direction: i8) -> Result<Departure, MotionStopped> {
        self.look_ahead()?;
        let level = self.equations.contacts[contact].static_coefficient;
        let series = &self.series.contacts[contact];
        let margin = margin_above(level, f64::from(direction), series);
        Ok(self.margin_leaves(contact, &margin, level * series.pressed[1]))
    }

    /// The same of the sliding level, of a slider that adheres beyond its static bound.
    fn level_margin(&mut self, contact: usize) -> Result<Departure, MotionStopped> {
        self.look_ahead()?;
        let OwnNow::Elastic(own) = self.now[contact].own else {
            return Ok(Departure { zeros: 1, sign: 1 });
        };
        let series = &self.series.contacts[contact];
        let margin = level_margin(own, series);
        let rise = f64::mul_add(f64::from(own.beyond), series.friction[1], margin[1]);
        Ok(self.margin_leaves(contact, &margin, rise))
    }

    /// How a margin that is zero leaves zero; `rise` is the rate of its level, the other part of its own rate.
    fn margin_leaves(&self, contact: usize, margin: &Series, rise: f64) -> Departure {
        let size = f64::mul_add(self.spring(contact), self.slip(contact).1, rise.abs());
        Departure::of(margin, 1, size, self.time_scale)
    }

    /// Notes the multiplicity of the zero of the own speed of an elastic slider that slides.
    fn note_speed_zeros(&mut self, contact: usize, zeros: usize) {
        if let OwnNow::Elastic(own) = &mut self.now[contact].own {
            own.speed_zeros = zeros;
        }
    }

    /// Notes the multiplicity of the zero of a margin of an elastic slider.
    fn note_zeros(&mut self, contact: usize, place: usize, zeros: usize) {
        if let OwnNow::Elastic(own) = &mut self.now[contact].own {
            own.margin_zeros[place] = zeros;
        }
    }
}

/// g at a slip velocity.
fn level_at(law: &Friction, slip: f64) -> f64 {
    match law {
        Friction::Lugre(law) => law.level().coefficient(slip.abs()),
        law => law.coefficient(slip.abs()),
    }
}
