//! Taylor series of small changes along a step.
//!
//! With the slip velocity w(t) and the load of every contact known as series, a small change δx obeys δẋ = J(t) δx with
//!
//! ```text
//! δT_c = −μ′(w) P t_cᵀδx + μ(w) f r_cᵀδx
//! ```
//!
//! for a slipping contact (P its load times the factor f), and δT_c such that the slip velocity stays zero for a sticking one. Order
//! by order this is the recurrence of the state itself, linear in δx. μ′(w(t)) is the composition of the law's own series about
//! w(0), from its recurrence along a straight path, with w(t).
//!
//! A contact with a state of its own has its change among the columns. T of an adhering slider changes by k_t δγ, that of a sliding one
//! is T = sμ(|γ|)N again, for any earlier change of its own number. Bristles have
//!
//! ```text
//! δż = (1 − σ₀ z u′) δγ − σ₀ u δz,    δT = P (σ₀ δz + σ₁ δż + σ₂ δγ) + (T/P) f δN,    u = |γ|/g(γ)
//! ```
//!
//! Changes are computed [`LANES`] columns at a time. Time is in units of the interval, so that the terms of order k are its
//! contributions at the end; where the last two are not negligible, the interval is shortened.

use quell_model::System;
use quell_model::friction::FrictionConstants;
use quell_model::system::InputTarget;
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::lane::horner;
use quell_numerics::polynomial::step_length;

use super::MOTION_TOLERANCE;
use super::change_block::{BlockSeries, ChangeRow, ColumnBlock, LANES, ZERO, add, product, times};
use super::equations::MotionEquations;
use super::law_along_slip::{along_slip, counted, divided, integrated, multiplied};
use super::observer::MotionSegment;
use super::own_state::{OwnSeries, OwnState, OwnStateKind};
use super::phase::{ContactNow, ContactPhase, OwnNow};
use super::stuck::StuckForces;
use crate::simulation::{ORDER, RECIPROCALS, Series, shift};

/// Bound on the last two retained terms, relative to the largest change, as for the state.
const TOLERANCE: f64 = MOTION_TOLERANCE;

/// Shortest interval over the step, and largest number of intervals.
const SHORTEST: f64 = 1e-9;
const MOST_INTERVALS: u32 = 200_000;

/// What a contact does on an interval, and its linearised friction in the interval's time.
#[derive(Clone, Debug)]
struct ContactChanges {
    tangent: ChangeRow,
    approach: ChangeRow,
    slope: ChangeRow,
    along: ChangeRow,
    across: ChangeRow,
    /// Whether an input is a factor on its friction.
    has_factor: bool,
    phase: ContactPhase,
    /// Whether it sticks with a force that its slip condition gives.
    is_free: bool,
    /// −δT/δγ and δT/δN, with their numbers of terms.
    by_slip: (Series, usize),
    by_load: (Series, usize),
    /// T and sᵀx, where the contact has a slope.
    friction: Series,
    tilt: Series,
    /// Its own number, and where it is the deflection of bristles, their equation linearised.
    own: Option<OwnState>,
    bristles: Option<Box<LinearBristles>>,
    /// Changes of slip, load, tilt, force, and of z and T/P of bristles, order by order.
    changes: Box<[BlockSeries; 6]>,
}

/// The equation of bristles linearised along an interval.
#[derive(Clone, Debug)]
struct LinearBristles {
    /// ∂ż/∂γ = 1 − σ₀ z u′ and −∂ż/∂z = σ₀ u.
    by_slip: Series,
    by_deflection: Series,
    /// P, and the change of T per change of the load.
    pressed: Series,
    by_load: Series,
}

/// Places in [`ContactChanges::changes`].
const SLIP: usize = 0;
const LOAD: usize = 1;
const TILT: usize = 2;
const FORCE: usize = 3;
const DEFLECTION: usize = 4;
const SHARE: usize = 5;

/// The memory of the series of changes, kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct ChangeSeries {
    contacts: Vec<ContactChanges>,
    /// Changes of one block, order by order, and their rates.
    orders: Vec<ColumnBlock>,
    rates: Vec<ColumnBlock>,
    /// Columns at the end of the interval.
    next: Vec<f64>,
}

/// The changes outgrow the finite numbers, or need too short intervals; or the forces of sticking contacts are not determined.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChangesLost;

/// A step, and what its contacts do.
#[derive(Clone, Copy)]
pub(super) struct ChangeStep<'a> {
    pub(super) equations: &'a MotionEquations,
    pub(super) segment: &'a MotionSegment<'a>,
    pub(super) now: &'a [ContactNow],
}

impl ChangeSeries {
    pub(super) fn new(system: &System, equations: &MotionEquations) -> Self {
        let contacts = equations.contacts.iter().enumerate().map(|(index, contact)| {
            ContactChanges {
            tangent: ChangeRow::of(&contact.tangent),
            approach: ChangeRow::of(&contact.approach),
            slope: ChangeRow::of(&contact.slope),
            along: ChangeRow::of(&contact.along),
            across: ChangeRow::of(&contact.across),
            has_factor: system.inputs.iter().any(|input| {
                matches!(input.target, InputTarget::Friction { contact } if contact == index)
            }),
            phase: ContactPhase::Open,
            is_free: false,
            by_slip: ([0.0; ORDER + 1], 0),
            by_load: ([0.0; ORDER + 1], 0),
            friction: [0.0; ORDER + 1],
            tilt: [0.0; ORDER + 1],
            own: contact.own,
            bristles: None,
            changes: Box::new([[ZERO; ORDER + 1]; 6]),
        }
        });
        Self {
            contacts: contacts.collect(),
            orders: vec![ZERO; (ORDER + 1) * equations.size],
            rates: vec![ZERO; equations.size],
            next: Vec::new(),
        }
    }

    /// Advances columns, one after the other, over a step. `stuck` has the forces of the sticking contacts at its start; those of
    /// tilted contacts vary along it.
    pub(super) fn advance(
        &mut self,
        step: ChangeStep<'_>,
        laws: &mut [FrictionConstants],
        stuck: &mut StuckForces,
        columns: &mut [f64],
    ) -> Result<(), ChangesLost> {
        let duration = step.segment.duration();
        let (mut since, mut length) = (0.0, duration);
        for _ in 0..MOST_INTERVALS {
            if since > 0.0 && step.equations.follows {
                let tilts = step.tilts(since);
                *stuck = StuckForces::of(step.equations, step.now, &tilts).ok_or(ChangesLost)?;
            }
            let share = with_fused_multiply_add(ChangeExpansion {
                step,
                stuck,
                interval: (since, length),
                laws: &mut *laws,
                columns: &*columns,
                series: self,
            });
            if share.is_nan() || share * length < SHORTEST * duration {
                return Err(ChangesLost);
            }
            if share < 1.0 {
                length *= share;
                if columns.len() > LANES * step.equations.size {
                    // The series of all blocks but the last are gone.
                    continue;
                }
            }
            columns.copy_from_slice(&self.next);
            since += length;
            let rest = duration - since;
            if rest <= SHORTEST * duration {
                return Ok(());
            }
            // Equal intervals, as many as the last one suggests.
            length = rest / (rest / length - 1e-9).ceil();
        }
        Err(ChangesLost)
    }
}

impl ChangeStep<'_> {
    fn tilts(&self, since: f64) -> Vec<f64> {
        let contacts = (0..self.segment.now.len()).map(|contact| self.segment.contact(contact));
        contacts.map(|contact| horner(&contact.tilt, since)).collect()
    }
}

/// One interval of a step.
struct ChangeExpansion<'a> {
    step: ChangeStep<'a>,
    stuck: &'a StuckForces,
    /// Its start after that of the step, and its length.
    interval: (f64, f64),
    laws: &'a mut [FrictionConstants],
    columns: &'a [f64],
    series: &'a mut ChangeSeries,
}

impl Work for ChangeExpansion<'_> {
    type Output = f64;

    /// Returns the share of the interval over which the last terms are negligible, 1 if they are at its end, NaN where they are not
    /// finite. Where the share is 1 or the columns are one block, writes the columns at its end.
    #[inline(always)]
    fn run(mut self) -> f64 {
        self.linearise();
        let size = self.step.equations.size;
        let ChangeSeries { contacts, orders, rates, next } = self.series;
        next.resize(self.columns.len(), 0.0);
        let (mut last, mut previous, mut largest) = (0.0_f64, 0.0_f64, f64::MIN_POSITIVE);
        let is_one_block = self.columns.len() <= LANES * size;
        let blocks = self.columns.chunks(LANES * size).zip(next.chunks_mut(LANES * size));
        for (columns, next) in blocks {
            for (i, change) in orders[..size].iter_mut().enumerate() {
                *change = std::array::from_fn(|lane| {
                    columns.get(lane * size + i).copied().unwrap_or(0.0)
                });
            }
            let equations = self.step.equations;
            expand(equations, self.stuck, self.interval.1, contacts, (orders, rates));
            let largest_of = |k: usize, so_far: f64| {
                let order = orders[k * size..(k + 1) * size].as_flattened();
                order.iter().fold(so_far, |so_far, change| most(so_far, change.abs()))
            };
            last = largest_of(ORDER, last);
            previous = largest_of(ORDER - 1, previous);
            largest = largest_of(0, largest);
            let end = if is_one_block {
                negligible_over(last / largest, previous / largest)
            } else {
                1.0
            };
            for i in 0..size {
                let mut sum = orders[ORDER * size + i];
                for k in (0..ORDER).rev() {
                    let term = &orders[k * size + i];
                    sum = std::array::from_fn(|lane| f64::mul_add(sum[lane], end, term[lane]));
                }
                for (lane, value) in sum.into_iter().enumerate() {
                    if let Some(next) = next.get_mut(lane * size + i) {
                        *next = value;
                    }
                }
            }
        }
        negligible_over(last / largest, previous / largest)
    }
}

/// The share of an interval over which the last two terms, given at its end, are within the tolerance.
#[inline(always)]
fn negligible_over(last: f64, previous: f64) -> f64 {
    if last <= TOLERANCE && previous <= TOLERANCE {
        return 1.0;
    }
    if !(last.is_finite() && previous.is_finite()) {
        return f64::NAN;
    }
    // Below 1, so that an interval that is repeated is shorter.
    0.95 * step_length(TOLERANCE, last, previous, ORDER).min(1.0)
}

/// The larger of two numbers; NaN if one is.
#[inline(always)]
fn most(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b }
}

impl ChangeExpansion<'_> {
    /// Linearises the friction of every contact along the interval.
    #[inline(always)]
    fn linearise(&mut self) {
        let ChangeStep { equations, segment, now } = self.step;
        let interval = self.interval;
        for (index, contact) in self.series.contacts.iter_mut().enumerate() {
            let (equation, along) = (&equations.contacts[index], segment.contact(index));
            contact.phase = now[index].phase;
            contact.is_free = now[index].sticks() && now[index].saturated == 0;
            (contact.by_slip.1, contact.by_load.1) = (0, 0);
            if !contact.slope.is_empty() {
                contact.friction = within(&along.friction, interval);
                contact.tilt = within(&along.tilt, interval);
            }
            let factor = |series: &mut Series| {
                if contact.has_factor {
                    *series = multiplied(series, &within(&along.factor, interval));
                }
            };
            if let Some(OwnState { kind: OwnStateKind::Bristles { stiffness, .. }, .. }) =
                contact.own
            {
                let ContactPhase::Slip(sign) = contact.phase else { continue };
                let Some(own) = along.own.as_deref() else { continue };
                let scaled = within(&along.scaled, interval);
                let law = &mut self.laws[index];
                let (first, slope) = along_slip(law, f64::from(sign), &scaled);
                let level = (integrated(first, &slope, &scaled), slope, equation.inverse_scale);
                let pressed = within(&along.pressed, interval);
                let mut by_load = within(&own.share, interval);
                factor(&mut by_load);
                let linear = linear_bristles(own, interval, level, stiffness);
                let [by_slip, by_deflection] = linear;
                let linear = LinearBristles { by_slip, by_deflection, pressed, by_load };
                contact.bristles = Some(Box::new(linear));
                continue;
            }
            match contact.phase {
                ContactPhase::Slip(sign) => {
                    let scaled = within(&along.scaled, interval);
                    let law = &mut self.laws[index];
                    // An elastic slider is on the branch of γ, and slides in a direction of its own.
                    let (branch, turned) = match now[index].own {
                        OwnNow::Elastic(own) => (own.branch, f64::from(sign * own.branch)),
                        OwnNow::Rigid | OwnNow::Bristles => (sign, 1.0),
                    };
                    let (first, slope) = along_slip(law, f64::from(branch), &scaled);
                    let (first, slope) = (turned * first, slope.map(|term| turned * term));
                    let mut pressed = [along.pressed[0]; ORDER + 1];
                    if along.is_plain {
                        pressed[1..].fill(0.0);
                    } else {
                        pressed = within(&along.pressed, interval);
                    }
                    let mut by_slip = multiplied(&pressed, &slope);
                    for term in &mut by_slip {
                        *term *= equation.inverse_scale;
                    }
                    contact.by_slip = counted(by_slip);
                    if !contact.approach.is_empty() {
                        let mut by_load = integrated(first, &slope, &scaled);
                        factor(&mut by_load);
                        contact.by_load = counted(by_load);
                    }
                }
                ContactPhase::Stick if !contact.is_free && !contact.approach.is_empty() => {
                    let mut by_load = [0.0; ORDER + 1];
                    by_load[0] = f64::from(now[index].saturated) * equation.static_coefficient;
                    factor(&mut by_load);
                    contact.by_load = counted(by_load);
                }
                ContactPhase::Stick | ContactPhase::Open => {}
            }
        }
    }
}

/// ∂ż/∂γ and −∂ż/∂z of bristles along an interval, from the signed level, its slope, and the reciprocal of the velocity that scales it.
#[inline(always)]
fn linear_bristles(
    own: &OwnSeries,
    interval: (f64, f64),
    (level, slope, inverse_scale): (Series, Series, f64),
    stiffness: f64,
) -> [Series; 2] {
    let turnover = within(&own.turnover, interval);
    let deflection = within(&own.deflection, interval);
    // u = γ/L, so that u′ = (1 − u L′)/L.
    let mut rise = multiplied(&turnover, &slope).map(|term| -inverse_scale * term);
    rise[0] += 1.0;
    let rise = divided(&rise, &level);
    let mut by_slip = multiplied(&rise, &deflection).map(|term| -stiffness * term);
    by_slip[0] += 1.0;
    [by_slip, turnover.map(|term| stiffness * term)]
}

/// A series of a step in the time of an interval of it.
#[inline(always)]
fn within(series: &Series, (since, length): (f64, f64)) -> Series {
    let mut series = *series;
    if since > 0.0 {
        shift(&mut series, since);
    }
    let mut power = 1.0;
    for term in &mut series {
        *term *= power;
        power *= length;
    }
    series
}

/// The series of one block of columns over an interval, from its first order.
#[inline(always)]
fn expand(
    equations: &MotionEquations,
    stuck: &StuckForces,
    length: f64,
    contacts: &mut [ContactChanges],
    (orders, rates): (&mut [ColumnBlock], &mut [ColumnBlock]),
) {
    let size = rates.len();
    for k in 0..ORDER {
        let (known, next) = orders.split_at_mut((k + 1) * size);
        let change = &mut known[k * size..];
        times(&equations.matrix, change, rates);
        for contact in contacts.iter_mut() {
            contact.force(k, change, rates);
            contact.own(k, change);
        }
        hold(stuck, k, contacts, rates);
        let share = length * RECIPROCALS[k + 1];
        for (next, rate) in next[..size].iter_mut().zip(rates.iter()) {
            *next = rate.map(|rate| rate * share);
        }
    }
}

impl ContactChanges {
    /// The change of the contact's forces at order k, where the conditions of stick do not give it.
    #[inline(always)]
    fn force(&mut self, k: usize, change: &[ColumnBlock], rates: &mut [ColumnBlock]) {
        if self.phase == ContactPhase::Open {
            return;
        }
        if !self.approach.is_empty() {
            let load = self.approach.dot(change);
            self.changes[LOAD][k] = load;
            self.across.add_to(&load.map(|load| -load), rates);
        }
        let is_tilted = !self.slope.is_empty();
        if is_tilted {
            self.changes[TILT][k] = self.slope.dot(change);
            let turned = product(&self.friction, ORDER + 1, &self.changes[TILT], k, 0);
            self.across.add_to(&turned, rates);
        }
        if self.is_free {
            if is_tilted {
                // What the tilt owes to the lower orders of the force.
                self.changes[FORCE][k] = ZERO;
                let known = product(&self.tilt, ORDER + 1, &self.changes[FORCE], k, 1);
                self.across.add_to(&known, rates);
            }
            return;
        }
        let force = match self.own {
            Some(OwnState { place, kind: OwnStateKind::Elastic { stiffness } })
                if self.phase == ContactPhase::Stick =>
            {
                rates[place] = self.tangent.dot(change).map(|slip| -stiffness * slip);
                change[place]
            }
            Some(OwnState { place, kind: OwnStateKind::Bristles { .. } }) => {
                let (force, rate) = self.of_bristles(k, change);
                rates[place] = rate;
                force
            }
            Some(_) | None => self.by_law(k, change),
        };
        self.changes[FORCE][k] = force;
        self.along.add_to(&force, rates);
        if is_tilted {
            let tilted = product(&self.tilt, ORDER + 1, &self.changes[FORCE], k, 0);
            self.across.add_to(&tilted, rates);
        }
    }

    /// The change of a friction force that its law gives.
    #[inline(always)]
    fn by_law(&mut self, k: usize, change: &[ColumnBlock]) -> ColumnBlock {
        let mut force = product(&self.by_load.0, self.by_load.1, &self.changes[LOAD], k, 0);
        if self.by_slip.1 > 0 {
            self.changes[SLIP][k] = self.tangent.dot(change);
            let lost = product(&self.by_slip.0, self.by_slip.1, &self.changes[SLIP], k, 0);
            add(&mut force, -1.0, &lost);
        }
        force
    }

    /// The changes of the force of bristles and of ż.
    #[inline(always)]
    fn of_bristles(&mut self, k: usize, change: &[ColumnBlock]) -> (ColumnBlock, ColumnBlock) {
        let (Some(own), Some(linear)) = (self.own, &self.bristles) else { return (ZERO, ZERO) };
        let OwnStateKind::Bristles { stiffness, damping, viscous } = own.kind else {
            return (ZERO, ZERO);
        };
        let slip = self.tangent.dot(change).map(|value| -value);
        self.changes[SLIP][k] = slip;
        self.changes[DEFLECTION][k] = change[own.place];
        let terms = ORDER + 1;
        let mut rate = product(&linear.by_slip, terms, &self.changes[SLIP], k, 0);
        let lost = product(&linear.by_deflection, terms, &self.changes[DEFLECTION], k, 0);
        add(&mut rate, -1.0, &lost);
        let mut share = ZERO;
        add(&mut share, stiffness, &change[own.place]);
        add(&mut share, damping, &rate);
        add(&mut share, viscous, &slip);
        self.changes[SHARE][k] = share;
        let mut force = product(&linear.pressed, terms, &self.changes[SHARE], k, 0);
        if !self.approach.is_empty() {
            let by_load = product(&linear.by_load, terms, &self.changes[LOAD], k, 0);
            add(&mut force, 1.0, &by_load);
        }
        (force, rate)
    }

    /// Where the state of the structure gives the contact's own number, that of a sliding or an open contact, its change at order k.
    #[inline(always)]
    fn own(&self, k: usize, change: &mut [ColumnBlock]) {
        let Some(own) = self.own else { return };
        match (own.kind, self.phase) {
            (_, ContactPhase::Open) => change[own.place] = ZERO,
            (OwnStateKind::Elastic { .. }, ContactPhase::Slip(_)) => {
                change[own.place] = self.changes[FORCE][k];
            }
            _ => {}
        }
    }
}

/// Adds the changes of the forces that keep the slip velocities of sticking contacts at zero.
#[inline(always)]
fn hold(stuck: &StuckForces, k: usize, contacts: &mut [ContactChanges], rates: &mut [ColumnBlock]) {
    // The conditions of all are read before any force is added.
    for (held, gains) in stuck.gains() {
        let mut force = ZERO;
        for (index, gain) in gains {
            add(&mut force, -gain, &contacts[index].tangent.dot(rates));
        }
        contacts[held].changes[FORCE][k] = force;
    }
    for (held, _) in stuck.gains() {
        let contact = &contacts[held];
        let force = contact.changes[FORCE][k];
        contact.along.add_to(&force, rates);
        if !contact.slope.is_empty() {
            contact.across.add_to(&force.map(|force| force * contact.tilt[0]), rates);
        }
    }
}
