//! The variational equation of a system's run, with a jump at every event.
//!
//! Between events a small change obeys δẋ = J(t) δx, in stick with the forces that keep δγ = 0. At the moment at which a guard h
//! reaches zero it is multiplied by the saltation matrix
//!
//! ```text
//! S = I + (f⁺ − f⁻) ∇hᵀ / ḣ
//! ```
//!
//! with the rates f of the state on both sides, f⁺ after all decisions of that moment, and ḣ along the motion before. Where guards of
//! several contacts reach zero together, S = I + Σ Δf_c ∇h_cᵀ/ḣ_c with the part Δf_c of f⁺ − f⁻ that the force of each contact
//! causes: exact where no contact changes the rate of another's guard, one-sided otherwise. A smooth
//! release, a separation and a landing have f⁺ = f⁻ and S = I; a stick projects onto γ = 0. A jump of the dither happens at
//! a fixed time, regardless of the state: S = I there.
//!
//! Where two independent guards reach zero together, S depends on the order in which a change separates them: the multipliers
//! are one-sided, and [`MotionVariation::is_one_sided`] says so.
//!
//! A contact with a state of its own contributes its number to the state. Where a contact lands its own number begins at zero at that
//! moment, so that S has the row f⁺∇hᵀ/ḣ there. An elastic slider whose T drops at its release has no change of its own from there on:
//! T = sμN gives it. The ends of its slips, the sign changes of γ, and the reversals of bristles have f⁺ = f⁻ and S = I: T and ż are
//! continuous there. Where a slip ends at a sign change of γ (a law that rises with |γ|) Ṫ jumps, and S is that of the guard γ.
//!
//! Between events the changes are Taylor series like the state (`change_series`). Reference: Leine and Nijmeijer (2004), ch. 7.

use quell_model::System;
use quell_model::friction::{BranchSeries, FrictionConstants};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::matrix::Matrix;

use super::Motion;
use super::change_series::{ChangeSeries, ChangeStep};
use super::equations::MotionEquations;
use super::extremes::least;
use super::observer::{
    MotionEvent, MotionMoment, MotionObserver, MotionSegment, RecordedEvent, Trigger,
};
use super::own_state::{OwnState, OwnStateKind, law_of};
use super::phase::{ContactNow, ContactPhase, OwnNow};
use super::stopped::Immobile;
use super::stuck::{StuckForces, independent};
use crate::simulation::ORDER;

/// Share of itself by which T of an elastic slider drops: less is the rounding of a step.
const DROPPED: f64 = 1e-9;

/// Friction of a contact linearised at one instant: δT = −a tᵀδx + b rᵀδx + c δs, with the change δs of its own number.
#[derive(Clone, Copy, Debug, Default)]
struct LinearFriction {
    /// a = μ′ N.
    by_slip: f64,
    /// b = μ, times the factor on friction.
    by_load: f64,
    /// c: 1 of an elastic slider that adheres.
    by_own: f64,
    /// The factor on friction.
    factor: f64,
    /// T.
    friction: f64,
    /// sᵀx.
    tilt: f64,
}

/// Integrates the matrix of changes along a run, and records its events.
pub struct MotionVariation<'a> {
    system: &'a System,
    equations: &'a MotionEquations,
    laws: Vec<FrictionConstants>,
    /// Derivative of the state with respect to the initial one, column by column.
    columns: Vec<f64>,
    /// Events in order.
    pub events: Vec<RecordedEvent>,
    /// The least distance of each contact: of its slip velocity and of its load; infinite where it has no such event.
    pub approaches: Vec<[f64; 2]>,
    /// Whether independent guards reached zero together.
    pub is_one_sided: bool,
    /// Whether the integration of changes failed.
    pub has_failed: bool,
    /// ẋ and x at the end of the last step, and what the contacts did on it.
    rates: Vec<f64>,
    ends: Vec<f64>,
    now: Vec<ContactNow>,
    stuck: StuckForces,
    /// The guards of a moment whose f⁺ is not known yet.
    pending: Vec<PendingJump>,
    series: ChangeSeries,
    last: LinearFrictions,
    is_first: bool,
}

type LinearFrictions = Vec<LinearFriction>;

/// A guard that has reached zero: ∇h and ḣ.
struct PendingJump {
    contact: usize,
    gradient: Vec<f64>,
    rate: f64,
}

impl<'a> MotionVariation<'a> {
    /// From the identity.
    ///
    /// # Errors
    /// [`Immobile`] where the system has no equations.
    pub fn new(motion: &'a Motion<'a>) -> Result<Self, Immobile> {
        let (system, equations) = (motion.system, motion.equations()?);
        let size = equations.size;
        Ok(Self {
            laws: system.contacts.iter().map(|c| law_of(&c.friction)).collect(),
            columns: Matrix::identity(size).as_slice().to_vec(),
            events: Vec::new(),
            approaches: vec![[f64::INFINITY; 2]; system.contacts.len()],
            is_one_sided: false,
            // The changes under a matrix that varies in time are not known.
            has_failed: equations.by_speed.is_some(),
            rates: vec![0.0; size],
            ends: Vec::new(),
            now: Vec::new(),
            stuck: StuckForces::default(),
            pending: Vec::new(),
            series: ChangeSeries::new(system, equations),
            last: Vec::new(),
            is_first: true,
            system,
            equations,
        })
    }

    /// The changes, column by column: any number of them.
    pub(super) fn columns_mut(&mut self) -> &mut Vec<f64> {
        &mut self.columns
    }

    /// Derivative of the state with respect to the initial one.
    pub fn matrix(&self) -> Matrix {
        let size = self.equations.size;
        Matrix::from_fn(size, size, |i, j| self.columns[j * size + i])
    }

    /// Friction of every contact linearised at a time after the start of a segment.
    fn instants(&mut self, segment: &MotionSegment<'_>, since: f64, out: &mut LinearFrictions) {
        out.clear();
        for index in 0..self.now.len() {
            let contact = &self.equations.contacts[index];
            let friction = MotionSegment::value(segment.friction(index), since);
            let tilt = MotionSegment::value(&segment.contact(index).tilt, since);
            let mut instant = LinearFriction { friction, tilt, ..LinearFriction::default() };
            // T = μ N times the factor on friction: what multiplies μ is `pressed`.
            let pressed = MotionSegment::value(&segment.contact(index).pressed, since);
            let load = MotionSegment::value(segment.normal_load(index), since);
            let factor = if load == 0.0 { 1.0 } else { pressed / load };
            instant.factor = factor;
            let own = contact.own.map(|own| own.kind);
            match (self.now[index].phase, own) {
                (ContactPhase::Slip(sign), _) => {
                    let slip = MotionSegment::value(segment.slip_velocity(index), since);
                    let (branch, turned) = match self.now[index].own {
                        OwnNow::Elastic(own) => (own.branch, f64::from(sign * own.branch)),
                        OwnNow::Rigid | OwnNow::Bristles => (sign, 1.0),
                    };
                    let branch =
                        self.laws[index].series::<1>(f64::from(branch), slip / contact.scale);
                    let slope = branch.slope() / contact.scale;
                    match own {
                        Some(OwnStateKind::Bristles { stiffness, damping, viscous }) => {
                            let level = branch.first();
                            let turnover = slip / level;
                            let own = contact.own.map_or(0, |own| own.place);
                            let deflection = segment.number(own, since);
                            let rise = (1.0 - turnover * slope) / level;
                            let rate_by_slip = 1.0 - stiffness * deflection * rise;
                            instant.by_slip = pressed * (damping * rate_by_slip + viscous);
                            instant.by_own = pressed * stiffness * (1.0 - damping * turnover);
                            let share = if pressed == 0.0 { 0.0 } else { friction / pressed };
                            instant.by_load = share * factor;
                        }
                        Some(OwnStateKind::Elastic { .. }) | None => {
                            instant.by_slip = turned * slope * pressed;
                            instant.by_load = turned * branch.first() * factor;
                        }
                    }
                }
                (ContactPhase::Stick, Some(_)) => instant.by_own = 1.0,
                (ContactPhase::Stick, None) => {
                    let side = f64::from(self.now[index].saturated);
                    instant.by_load = side * contact.static_coefficient * factor;
                }
                (ContactPhase::Open, _) => {}
            }
            out.push(instant);
        }
        if self.equations.follows {
            let tilts: Vec<f64> = out.iter().map(|instant| instant.tilt).collect();
            self.hold_at(&tilts);
        }
    }

    /// The forces of the sticking contacts at these tilts, with which they vary along a step.
    fn hold_at(&mut self, tilts: &[f64]) {
        match StuckForces::of(self.equations, &self.now, tilts) {
            Some(stuck) => self.stuck = stuck,
            None => self.has_failed = true,
        }
    }

    /// J δx without the forces that hold sticking contacts.
    fn rates_of(&self, instants: &LinearFrictions, change: &[f64], out: &mut [f64]) {
        self.equations.matrix.times(change, out);
        for (index, contact) in self.equations.contacts.iter().enumerate() {
            let (now, instant) = (&self.now[index], &instants[index]);
            if now.is_open() {
                continue;
            }
            let load = contact.approach.dot(change);
            if load != 0.0 {
                contact.across.add_to(-load, out);
            }
            if !contact.slope.is_empty() {
                contact.across.add_to(instant.friction * contact.slope.dot(change), out);
            }
            let own = contact.own.map_or(0.0, |own| instant.by_own * change[own.place]);
            let force =
                instant.by_load * load - instant.by_slip * contact.tangent.dot(change) + own;
            if force != 0.0 {
                contact.along.add_to(force, out);
                contact.across.add_to(force * instant.tilt, out);
            }
        }
    }

    /// Whether T of an elastic slider has dropped at a moment that leaves it in adhesion: it was released, slid at the lower level and
    /// adhered again at once. The moment of that depends on the state, and the change of T after it is not known here.
    fn drops_in_adhesion(&self, segment: &MotionSegment<'_>) -> bool {
        let contacts = self.now.iter().zip(segment.now).zip(&self.equations.contacts);
        contacts.enumerate().any(|(contact, ((before, now), equation))| {
            let Some(OwnState { place, kind: OwnStateKind::Elastic { .. } }) = equation.own else {
                return false;
            };
            let released = self.pending.iter().any(|jump| jump.contact == contact);
            let adhered = before.phase == ContactPhase::Stick || released;
            let (was, is) = (self.ends[place], segment.states()[place]);
            adhered
                && now.phase == ContactPhase::Stick
                && (is - was).abs() > DROPPED * was.abs().max(is.abs())
        })
    }

    /// Advances all columns over a segment.
    fn flow(&mut self, segment: &MotionSegment<'_>) {
        let step = ChangeStep { equations: self.equations, segment, now: &self.now };
        let Self { laws, stuck, columns, .. } = self;
        self.has_failed |= self.series.advance(step, laws, stuck, columns).is_err();
        // The margin of a contact that sticks or adheres is linearised at its root.
        if self.now.iter().any(|now| now.phase == ContactPhase::Stick) {
            let mut last = std::mem::take(&mut self.last);
            self.instants(segment, segment.duration, &mut last);
            self.last = last;
        }
    }

    /// Applies a jump once the rates behind it are known. Of contacts that reach their guards together each carries the part of the
    /// jump of the rates that its own force causes.
    fn jump(&mut self, after: &[f64]) {
        let pending = std::mem::take(&mut self.pending);
        let [first, others @ ..] = pending.as_slice() else { return };
        let size = self.equations.size;
        let mut own: Vec<f64> = after.iter().zip(&self.rates).map(|(a, b)| a - b).collect();
        let shares = self.shares_of(&pending, &own).filter(|_| !others.is_empty());
        let parts: Vec<Vec<f64>> = others
            .iter()
            .enumerate()
            .map(|(place, other)| {
                let mut part = vec![0.0; size];
                if let Some(shares) = &shares {
                    let column = &self.equations.contacts[other.contact].along;
                    column.add_to(shares[place + 1], &mut part);
                }
                own.iter_mut().zip(&part).for_each(|(own, part)| *own -= part);
                part
            })
            .collect();
        let mut parts = parts;
        self.own_parts(&pending, after, &mut own, &mut parts);
        for column in self.columns.chunks_mut(size) {
            let before = column.to_vec();
            for (jump, part) in [(first, &own)].into_iter().chain(others.iter().zip(&parts)) {
                let height: f64 = jump.gradient.iter().zip(&before).map(|(g, x)| g * x).sum();
                let share = height / jump.rate;
                for (value, part) in column.iter_mut().zip(part) {
                    *value = part.mul_add(share, *value);
                }
            }
        }
        if !others.is_empty() {
            self.project();
        }
    }

    /// The jump of the rate of a contact's own number belongs to the guard of that contact alone.
    fn own_parts(
        &self,
        pending: &[PendingJump],
        after: &[f64],
        first: &mut [f64],
        others: &mut [Vec<f64>],
    ) {
        for (contact, equation) in self.equations.contacts.iter().enumerate() {
            let Some(OwnState { place, .. }) = equation.own else { continue };
            first[place] = 0.0;
            for part in others.iter_mut() {
                part[place] = 0.0;
            }
            let jump = after[place] - self.rates[place];
            match pending.iter().position(|jump| jump.contact == contact) {
                Some(0) => first[place] = jump,
                Some(other) => others[other - 1][place] = jump,
                None => {}
            }
        }
    }

    /// The forces of contacts that together cause a jump of the rates, by least squares; `None` where their columns depend on each
    /// other.
    fn shares_of(&self, pending: &[PendingJump], jump: &[f64]) -> Option<Vec<f64>> {
        let size = self.equations.size;
        let columns: Vec<Vec<f64>> = pending
            .iter()
            .map(|of| self.equations.contacts[of.contact].along.dense(size))
            .collect();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let count = columns.len();
        let normal = Matrix::from_fn(count, count, |i, j| product(&columns[i], &columns[j]));
        let right = Matrix::from_fn(count, 1, |i, _| product(&columns[i], jump));
        let places: Vec<usize> = (0..count).collect();
        if independent(&normal, &places).len() < count {
            return None;
        }
        let shares = normal.solve(&right).filter(Matrix::is_finite)?;
        Some(shares.as_slice().to_vec())
    }

    /// Removes what a change of a sticking contact's slip velocity would be: it is lost at once.
    fn project(&mut self) {
        let size = self.equations.size;
        let mut columns = std::mem::take(&mut self.columns);
        for column in columns.chunks_mut(size) {
            self.stuck.project(self.equations, |_| 0.0, column);
        }
        self.columns = columns;
    }

    /// ∇h of the guard that reached zero, while the contacts still do what they did before; `ends_slip` says whether its contact sticks or
    /// adheres from there on.
    fn gradient(&mut self, trigger: Trigger, ends_slip: bool) -> Option<Vec<f64>> {
        let size = self.equations.size;
        match trigger {
            // Where a contact lands, its own number begins at zero.
            Trigger::Load(contact) => {
                let equation = &self.equations.contacts[contact];
                let lands = self.now[contact].is_open() && equation.own.is_some();
                let row = || equation.approach.dense(size).into_iter().map(|entry| -entry);
                lands.then(|| row().collect())
            }
            Trigger::Turn(_) if !ends_slip => None,
            Trigger::Turn(contact) => {
                let OwnNow::Elastic(own) = self.now[contact].own else { return None };
                let row = self.equations.contacts[contact].tangent.dense(size);
                Some(row.into_iter().map(|entry| -f64::from(own.branch) * entry).collect())
            }
            Trigger::Slip(contact) if self.equations.contacts[contact].own.is_some() => None,
            Trigger::Slip(contact) => {
                let sign = f64::from(self.now[contact].phase.slip_sign());
                let row = self.equations.contacts[contact].tangent.dense(size);
                Some(row.into_iter().map(|entry| -sign * entry).collect())
            }
            // At the very start no neighbouring motion is released earlier.
            Trigger::Margin(..) if self.last.is_empty() => None,
            Trigger::Margin(contact, side) => {
                let equation = &self.equations.contacts[contact];
                if let Some(own) = equation.own {
                    let level = equation.static_coefficient * self.last[contact].factor;
                    let mut gradient: Vec<f64> = equation.approach.dense(size);
                    for entry in &mut gradient {
                        *entry *= level;
                    }
                    gradient[own.place] -= f64::from(side);
                    return Some(gradient);
                }
                let mut change = vec![0.0; size];
                let mut out = vec![0.0; size];
                let mut gradient = vec![0.0; size];
                for j in 0..size {
                    change.fill(0.0);
                    change[j] = 1.0;
                    self.rates_of(&self.last, &change, &mut out);
                    let force = self.stuck.change_of_force(self.equations, contact, &out);
                    let level = equation.static_coefficient * self.last[contact].factor;
                    let load = level * equation.approach.dot(&change);
                    gradient[j] = load - f64::from(side) * force;
                }
                Some(gradient)
            }
        }
    }

    fn watch(&mut self, segment: &MotionSegment<'_>) {
        for index in 0..self.now.len() {
            let ContactPhase::Slip(sign) = self.now[index].phase else { continue };
            let equation = &self.equations.contacts[index];
            if equation.own.is_some() {
                // Its phases follow from its state: its motion is not continued beyond a border.
                continue;
            }
            let contact = &self.system.contacts[index];
            let mut nearer = |series: &[f64; ORDER + 1], scale: f64, is_load: bool| {
                let known = self.approaches[index][usize::from(is_load)];
                // With a margin for the rounding of the bound.
                let may_be = scale * lower_bound(series, segment.duration);
                if may_be - 1e-12 * series[0].abs() * scale > known {
                    return;
                }
                let (lowest, _) = least(series, segment.duration);
                let known = &mut self.approaches[index][usize::from(is_load)];
                *known = known.min(scale * lowest);
            };
            if equation.can_stick() {
                let speed = contact.surface_velocity.mean().abs();
                let scale = 1.0 / if speed > 0.0 { speed } else { equation.scale };
                let slip = segment.slip_velocity(index).map(|c| f64::from(sign) * c);
                nearer(&slip, scale, false);
            }
            if equation.is_compliant() {
                nearer(segment.normal_load(index), 1.0 / contact.normal_load, true);
            }
        }
    }
}

/// The rates of a series of the state at a time after its start.
struct RatesAt<'a> {
    states: &'a [f64],
    since: f64,
    out: &'a mut [f64],
}

impl Work for RatesAt<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let size = self.out.len();
        self.out.fill(0.0);
        for k in (1..=ORDER).rev() {
            for (rate, term) in self.out.iter_mut().zip(&self.states[k * size..]) {
                *rate = f64::mul_add(*rate, self.since, k as f64 * term);
            }
        }
    }
}

/// A bound from below on a series on [0, `duration`].
fn lower_bound(series: &[f64; ORDER + 1], duration: f64) -> f64 {
    let mut change = 0.0;
    for term in series[1..].iter().rev() {
        change = (change + term.abs()) * duration;
    }
    series[0] - change
}

impl MotionObserver for MotionVariation<'_> {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        if self.has_failed {
            self.watch(segment);
            return;
        }
        let size = self.equations.size;
        let sticks_alike = |(a, b): (&ContactNow, &ContactNow)| {
            (a.sticks(), a.saturated) == (b.sticks(), b.saturated)
        };
        let is_held = self.now.len() == segment.now.len()
            && !self.equations.follows
            && self.now.iter().zip(segment.now).all(sticks_alike);
        self.has_failed |= self.drops_in_adhesion(segment);
        self.now.clear();
        self.now.extend_from_slice(segment.now);
        if !is_held {
            let tilts: Vec<f64> =
                (0..segment.now.len()).map(|contact| segment.contact(contact).tilt[0]).collect();
            self.hold_at(&tilts);
        }
        self.jump(&segment.states()[size..2 * size]);
        if std::mem::take(&mut self.is_first) {
            self.project();
        }
        self.watch(segment);
        self.flow(segment);
        let (states, since) = (segment.states(), segment.duration);
        with_fused_multiply_add(RatesAt { states, since, out: &mut self.rates });
        self.ends.resize(size, 0.0);
        segment.state(since, &mut self.ends);
    }

    fn event(&mut self, event: &MotionEvent<'_>) {
        self.events.push(event.recorded());
    }

    fn moment(&mut self, moment: &MotionMoment<'_>) {
        self.is_one_sided |= moment.is_one_sided;
        if self.now.is_empty() || moment.is_jump || !self.pending.is_empty() {
            return;
        }
        for &(trigger, rate) in moment.triggers {
            let (Trigger::Slip(contact)
            | Trigger::Margin(contact, _)
            | Trigger::Load(contact)
            | Trigger::Turn(contact)) = trigger;
            let ends_slip = moment.after[contact] == ContactPhase::Stick;
            if let Some(gradient) = self.gradient(trigger, ends_slip) {
                self.pending.push(PendingJump { contact, gradient, rate: -rate });
            }
        }
    }
}
