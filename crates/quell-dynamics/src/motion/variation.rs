//! The variational equation of a system's run, with a jump at every event.
//!
//! Between events a small change obeys δẋ = J(t) δx, in stick with the forces that keep δγ = 0. At the moment at which a guard h
//! reaches zero it is multiplied by the saltation matrix
//!
//! ```text
//! S = I + (f⁺ − f⁻) ∇hᵀ / ḣ
//! ```
//!
//! with the rates f of the state on both sides, f⁺ after all decisions of that moment, and ḣ along the motion before. A smooth
//! release, a separation and a landing have f⁺ = f⁻ and S = I; a stick projects onto γ = 0. A jump of the dither happens at
//! a fixed time, regardless of the state: S = I there.
//!
//! Where two independent guards reach zero together, S depends on the order in which a change separates them: the multipliers
//! are one-sided, and [`MotionVariation::is_one_sided`] says so.
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
use super::phase::{ContactNow, ContactPhase};
use super::rows::StateRow;
use super::stuck::StuckForces;
use crate::simulation::ORDER;

/// Friction of a contact linearised at one instant: δT = −a tᵀδx + b rᵀδx.
#[derive(Clone, Copy, Debug, Default)]
struct LinearFriction {
    /// a = μ′ N.
    by_slip: f64,
    /// b = μ, times the factor on friction.
    by_load: f64,
    /// The factor on friction.
    factor: f64,
    /// T.
    friction: f64,
    /// sᵀx.
    tilt: f64,
}

/// Least distance of the slip velocities and loads from zero, relative to the velocity of the surface and to N₀. At a surface at rest
/// slip is relative to the velocity that scales the friction law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastDistance {
    /// The distance.
    pub distance: f64,
    /// When.
    pub time: f64,
    /// The contact.
    pub contact: usize,
    /// Whether it is the distance of a load: of a separation.
    pub is_load: bool,
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
    /// Nearest approach to an event of a contact that slips.
    pub least: Option<LeastDistance>,
    /// The least distance of each contact: of its slip velocity and of its load; infinite where it has no such event.
    pub approaches: Vec<[f64; 2]>,
    /// Whether independent guards reached zero together.
    pub is_one_sided: bool,
    /// Whether the integration of changes failed.
    pub has_failed: bool,
    /// ẋ at the end of the last step, and what the contacts did on it.
    rates: Vec<f64>,
    now: Vec<ContactNow>,
    stuck: StuckForces,
    /// (∇h, ḣ) of an event whose f⁺ is not known yet.
    pending: Option<(Vec<f64>, f64)>,
    series: ChangeSeries,
    last: LinearFrictions,
    is_first: bool,
}

type LinearFrictions = Vec<LinearFriction>;

impl<'a> MotionVariation<'a> {
    /// From the identity.
    pub fn new(motion: &'a Motion<'a>) -> Self {
        let (system, equations) = (motion.system, &motion.equations);
        let size = equations.size;
        Self {
            laws: system.contacts.iter().map(|c| FrictionConstants::of(&c.friction)).collect(),
            columns: Matrix::identity(size).as_slice().to_vec(),
            events: Vec::new(),
            least: None,
            approaches: vec![[f64::INFINITY; 2]; system.contacts.len()],
            is_one_sided: false,
            has_failed: false,
            rates: vec![0.0; size],
            now: Vec::new(),
            stuck: StuckForces::default(),
            pending: None,
            series: ChangeSeries::new(system, equations),
            last: Vec::new(),
            is_first: true,
            system,
            equations,
        }
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
            let tilt = MotionSegment::value(&segment.contacts[index].tilt, since);
            let mut instant = LinearFriction { friction, tilt, ..LinearFriction::default() };
            // T = μ N times the factor on friction: what multiplies μ is `pressed`.
            let pressed = MotionSegment::value(&segment.contacts[index].pressed, since);
            let load = MotionSegment::value(segment.normal_load(index), since);
            let factor = if load == 0.0 { 1.0 } else { pressed / load };
            instant.factor = factor;
            match self.now[index].phase {
                ContactPhase::Slip(sign) => {
                    let slip = MotionSegment::value(segment.slip_velocity(index), since);
                    let branch =
                        self.laws[index].series::<1>(f64::from(sign), slip / contact.scale);
                    instant.by_slip = branch.slope() / contact.scale * pressed;
                    instant.by_load = branch.first() * factor;
                }
                ContactPhase::Stick => {
                    let side = f64::from(self.now[index].saturated);
                    instant.by_load = side * contact.static_coefficient * factor;
                }
                ContactPhase::Open => {}
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
            let force = instant.by_load * load - instant.by_slip * contact.tangent.dot(change);
            if force != 0.0 {
                contact.along.add_to(force, out);
                contact.across.add_to(force * instant.tilt, out);
            }
        }
    }

    /// Advances all columns over a segment.
    fn flow(&mut self, segment: &MotionSegment<'_>) {
        let step = ChangeStep { equations: self.equations, segment, now: &self.now };
        let Self { laws, stuck, columns, .. } = self;
        self.has_failed |= self.series.advance(step, laws, stuck, columns).is_err();
        // The margin of a contact that sticks is linearised at its root.
        if self.now.iter().any(ContactNow::sticks) {
            let mut last = std::mem::take(&mut self.last);
            self.instants(segment, segment.duration, &mut last);
            self.last = last;
        }
    }

    /// Applies a jump once the rates behind it are known.
    fn jump(&mut self, after: &[f64]) {
        let Some((gradient, rate)) = self.pending.take() else { return };
        let size = self.equations.size;
        for column in self.columns.chunks_mut(size) {
            let height: f64 = gradient.iter().zip(column.iter()).map(|(g, x)| g * x).sum();
            let share = height / rate;
            for ((value, after), before) in column.iter_mut().zip(after).zip(&self.rates) {
                *value = (after - before).mul_add(share, *value);
            }
        }
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

    /// ∇h of the guard that reached zero, while the contacts still do what they did before.
    fn gradient(&mut self, trigger: Trigger) -> Option<Vec<f64>> {
        let size = self.equations.size;
        match trigger {
            Trigger::Load(_) => None,
            Trigger::Slip(contact) => {
                let sign = f64::from(self.now[contact].phase.slip_sign());
                let row = self.equations.contacts[contact].tangent.dense(size);
                Some(row.into_iter().map(|entry| -sign * entry).collect())
            }
            Trigger::Margin(contact, side) => {
                let equation = &self.equations.contacts[contact];
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
            let contact = &self.system.contacts[index];
            let mut nearer = |series: &[f64; ORDER + 1], scale: f64, is_load: bool| {
                let known = self.approaches[index][usize::from(is_load)];
                // With a margin for the rounding of the bound.
                let may_be = scale * lower_bound(series, segment.duration);
                if may_be - 1e-12 * series[0].abs() * scale > known {
                    return;
                }
                let (lowest, since) = least(series, segment.duration);
                let distance = scale * lowest;
                let known = &mut self.approaches[index][usize::from(is_load)];
                *known = known.min(distance);
                if self.least.is_none_or(|known| distance < known.distance) {
                    let time = segment.clock.time() + since;
                    self.least = Some(LeastDistance { distance, time, contact: index, is_load });
                }
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
        let size = self.equations.size;
        let sticks_alike = |(a, b): (&ContactNow, &ContactNow)| {
            (a.sticks(), a.saturated) == (b.sticks(), b.saturated)
        };
        let is_held = self.now.len() == segment.now.len()
            && !self.equations.follows
            && self.now.iter().zip(segment.now).all(sticks_alike);
        self.now.clear();
        self.now.extend_from_slice(segment.now);
        if !is_held {
            let tilts: Vec<f64> = segment.contacts.iter().map(|contact| contact.tilt[0]).collect();
            self.hold_at(&tilts);
        }
        self.jump(&segment.states[size..2 * size]);
        if std::mem::take(&mut self.is_first) {
            self.project();
        }
        self.watch(segment);
        self.flow(segment);
        let (states, since) = (segment.states, segment.duration);
        with_fused_multiply_add(RatesAt { states, since, out: &mut self.rates });
    }

    fn event(&mut self, event: &MotionEvent<'_>) {
        self.events.push(event.recorded());
    }

    fn moment(&mut self, moment: &MotionMoment<'_>) {
        self.is_one_sided |= moment.is_one_sided;
        if self.now.is_empty() || moment.is_jump || self.pending.is_some() {
            return;
        }
        self.pending = self.gradient(moment.trigger).map(|gradient| (gradient, -moment.rate));
    }
}
