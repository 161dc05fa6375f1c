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
//! Changes are computed [`LANES`] columns at a time. Time is in units of the interval, so that the terms of order k are its
//! contributions at the end; where the last two are not negligible, the interval is shortened.

use quell_model::System;
use quell_model::friction::{BranchSeries, FrictionConstants};
use quell_model::system::InputTarget;
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::lane::{horner, partial_product};
use quell_numerics::polynomial::step_length;

use super::MOTION_TOLERANCE;
use super::equations::MotionEquations;
use super::observer::MotionSegment;
use super::phase::{ContactNow, ContactPhase};
use super::rows::{RowEntries, StateMatrix};
use super::stuck::StuckForces;
use crate::simulation::{ORDER, RECIPROCALS, Series, shift};

/// Columns that are advanced together.
const LANES: usize = 4;

/// One number of each of the columns.
type ColumnBlock = [f64; LANES];

/// A series of them.
type BlockSeries = [ColumnBlock; ORDER + 1];

const ZERO: ColumnBlock = [0.0; LANES];

/// Bound on the last two retained terms, relative to the largest change, as for the state.
const TOLERANCE: f64 = MOTION_TOLERANCE;

/// Terms of a composition below this share of the largest are lost in its rounding.
const NEGLIGIBLE: f64 = 1e-18;

/// Shortest interval over the step, and largest number of intervals.
const SHORTEST: f64 = 1e-9;
const MOST_INTERVALS: u32 = 200_000;

/// The entries of a row or column over the state that are not zero.
#[derive(Clone, Debug)]
struct ChangeRow(Vec<(usize, f64)>);

impl ChangeRow {
    fn of(row: &RowEntries) -> Self {
        Self(row.pairs().filter(|(_, value)| *value != 0.0).collect())
    }

    #[inline(always)]
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The row times a change.
    #[inline(always)]
    fn dot(&self, change: &[ColumnBlock]) -> ColumnBlock {
        let mut sum = ZERO;
        for &(place, value) in &self.0 {
            add(&mut sum, value, &change[place]);
        }
        sum
    }

    /// Adds a multiple of the column to a change.
    #[inline(always)]
    fn add_to(&self, factor: &ColumnBlock, change: &mut [ColumnBlock]) {
        for &(place, value) in &self.0 {
            add(&mut change[place], value, factor);
        }
    }
}

#[inline(always)]
fn add(sum: &mut ColumnBlock, factor: f64, block: &ColumnBlock) {
    for lane in 0..LANES {
        sum[lane] = f64::mul_add(factor, block[lane], sum[lane]);
    }
}

/// Σ aⱼ bₖ₋ⱼ over j = `from`…k, with the `terms` coefficients of a that are not zero.
#[inline(always)]
fn product(a: &[f64], terms: usize, b: &BlockSeries, k: usize, from: usize) -> ColumnBlock {
    let (mut even, mut odd) = (ZERO, ZERO);
    let end = terms.min(k + 1);
    let mut j = from;
    while j + 1 < end {
        add(&mut even, a[j], &b[k - j]);
        add(&mut odd, a[j + 1], &b[k - j - 1]);
        j += 2;
    }
    if j < end {
        add(&mut even, a[j], &b[k - j]);
    }
    std::array::from_fn(|lane| even[lane] + odd[lane])
}

/// What a contact does on an interval, and its linearised friction in the interval's time.
#[derive(Clone, Debug)]
struct LinearContact {
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
    /// Changes of slip, load, tilt and force, order by order.
    changes: Box<[BlockSeries; 4]>,
}

/// Places in [`LinearContact::changes`].
const SLIP: usize = 0;
const LOAD: usize = 1;
const TILT: usize = 2;
const FORCE: usize = 3;

/// The memory of the series of changes, kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct ChangeSeries {
    contacts: Vec<LinearContact>,
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
            LinearContact {
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
            changes: Box::new([[ZERO; ORDER + 1]; 4]),
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
        let contacts = self.segment.contacts.iter();
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
            for i in 0..size {
                for lane in 0..LANES {
                    last = most(last, orders[ORDER * size + i][lane].abs());
                    previous = most(previous, orders[(ORDER - 1) * size + i][lane].abs());
                    largest = most(largest, orders[i][lane].abs());
                }
            }
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
            let (equation, along) = (&equations.contacts[index], &segment.contacts[index]);
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
            match contact.phase {
                ContactPhase::Slip(sign) => {
                    let scaled = within(&along.scaled, interval);
                    let law = &mut self.laws[index];
                    let (first, slope) = along_slip(law, f64::from(sign), &scaled);
                    let mut pressed = [along.pressed[0]; ORDER + 1];
                    if along.is_plain {
                        pressed[1..].fill(0.0);
                    } else {
                        pressed = within(&along.pressed, interval);
                    }
                    let mut by_slip = multiplied(&pressed, &slope);
                    by_slip.iter_mut().for_each(|term| *term *= equation.inverse_scale);
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

/// A series with the number of its terms up to the last that is not zero.
#[inline(always)]
fn counted(series: Series) -> (Series, usize) {
    let terms = series.iter().rposition(|term| *term != 0.0).map_or(0, |last| last + 1);
    (series, terms)
}

/// The product of two series, of which the first often is constant.
#[inline(always)]
fn multiplied(a: &Series, b: &Series) -> Series {
    let terms = counted(*a).1;
    let mut product = [0.0; ORDER + 1];
    for (j, a) in a[..terms].iter().enumerate() {
        for (term, b) in product[j..].iter_mut().zip(b) {
            *term = f64::mul_add(*a, *b, *term);
        }
    }
    product
}

/// μ at the start of a slip w(t), and the series of μ′(w(t)) up to the order that the last order of a change needs.
#[inline(always)]
fn along_slip(law: &mut FrictionConstants, sign: f64, w: &Series) -> (f64, Series) {
    // In units of a bound on the change of w, in which the law's own series decreases as fast as that of the motion.
    let change: f64 = w[1..].iter().map(|term| term.abs()).sum();
    let mut path = [0.0; ORDER + 1];
    (path[0], path[1]) = (w[0], change);
    let mut branch = law.series::<{ ORDER + 1 }>(sign, w[0]);
    let mut slopes = [0.0; ORDER + 1];
    slopes[0] = branch.slope();
    if change > 0.0 {
        let inverse = 1.0 / change;
        for k in 1..=ORDER {
            // Beyond the first order a straight path has no part from the slope, and at the first no other.
            let term = branch.lower(k, &path);
            if k > 1 {
                slopes[k - 1] = k as f64 * inverse * term;
            }
        }
    }
    let mut relative = w.map(|term| if change > 0.0 { term / change } else { 0.0 });
    relative[0] = 0.0;
    (branch.first(), composed(&slopes, &relative))
}

/// Σ aⱼ uʲ for a series u that begins at the first order and whose coefficients add up to at most 1, below the last order.
#[inline(always)]
fn composed(outer: &Series, inner: &Series) -> Series {
    let largest = outer.iter().fold(0.0, |most: f64, term| most.max(term.abs()));
    // A term contributes at most itself to any coefficient.
    let counts = |term: &f64| !(term.abs() <= NEGLIGIBLE * largest);
    let mut sum = [0.0; ORDER + 1];
    let Some(highest) = outer.iter().rposition(counts) else { return sum };
    sum[0] = outer[highest];
    for j in (0..highest).rev() {
        // What is multiplied j times more by u is needed up to the order 15 − j only.
        sum = if j < ORDER / 2 {
            multiplied_by_inner::<ORDER>(&sum, inner)
        } else {
            multiplied_by_inner::<{ ORDER / 2 }>(&sum, inner)
        };
        sum[0] = outer[j];
    }
    sum
}

/// The first `N` coefficients of a series times one that begins at the first order.
#[inline(always)]
fn multiplied_by_inner<const N: usize>(series: &Series, inner: &Series) -> Series {
    // Behind zeros, so that every shifted copy of it has the same length.
    let mut behind = [0.0; 2 * ORDER];
    behind[ORDER..ORDER + N].copy_from_slice(&series[..N]);
    let mut sum = [0.0; N];
    for l in 1..N {
        let shifted = &behind[ORDER - l..ORDER - l + N];
        for (sum, term) in sum.iter_mut().zip(shifted) {
            *sum = f64::mul_add(inner[l], *term, *sum);
        }
    }
    let mut product = [0.0; ORDER + 1];
    product[..N].copy_from_slice(&sum);
    product
}

/// The series of μ along a slip from that of its slope: d(μ(w(t)))/dt = μ′ ẇ.
#[inline(always)]
fn integrated(first: f64, slope: &Series, w: &Series) -> Series {
    let mut rates = [0.0; ORDER + 1];
    for k in 0..ORDER {
        rates[k] = (k + 1) as f64 * w[k + 1];
    }
    let mut series = [0.0; ORDER + 1];
    series[0] = first;
    for k in 1..=ORDER {
        series[k] = partial_product(slope, &rates, k - 1, 0, k - 1) * RECIPROCALS[k];
    }
    series
}

/// The series of one block of columns over an interval, from its first order.
#[inline(always)]
fn expand(
    equations: &MotionEquations,
    stuck: &StuckForces,
    length: f64,
    contacts: &mut [LinearContact],
    (orders, rates): (&mut [ColumnBlock], &mut [ColumnBlock]),
) {
    let size = rates.len();
    for k in 0..ORDER {
        let (known, next) = orders.split_at_mut((k + 1) * size);
        let change = &known[k * size..];
        times(&equations.matrix, change, rates);
        for contact in contacts.iter_mut() {
            contact.force(k, change, rates);
        }
        hold(stuck, k, contacts, rates);
        let share = length * RECIPROCALS[k + 1];
        for (next, rate) in next[..size].iter_mut().zip(rates.iter()) {
            *next = rate.map(|rate| rate * share);
        }
    }
}

impl LinearContact {
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
        let mut force = product(&self.by_load.0, self.by_load.1, &self.changes[LOAD], k, 0);
        if self.by_slip.1 > 0 {
            self.changes[SLIP][k] = self.tangent.dot(change);
            let lost = product(&self.by_slip.0, self.by_slip.1, &self.changes[SLIP], k, 0);
            add(&mut force, -1.0, &lost);
        }
        self.along.add_to(&force, rates);
        if is_tilted {
            self.changes[FORCE][k] = force;
            let tilted = product(&self.tilt, ORDER + 1, &self.changes[FORCE], k, 0);
            self.across.add_to(&tilted, rates);
        }
    }
}

/// Adds the changes of the forces that keep the slip velocities of sticking contacts at zero.
#[inline(always)]
fn hold(stuck: &StuckForces, k: usize, contacts: &mut [LinearContact], rates: &mut [ColumnBlock]) {
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

/// Writes the state matrix times a change to `out`.
#[inline(always)]
fn times(matrix: &StateMatrix, change: &[ColumnBlock], out: &mut [ColumnBlock]) {
    match matrix {
        StateMatrix::Modal(stiffness, damping) => {
            let (displacements, velocities) = change.split_at(stiffness.len());
            let (upper, lower) = out.split_at_mut(stiffness.len());
            upper.copy_from_slice(velocities);
            for (i, out) in lower.iter_mut().enumerate() {
                *out = ZERO;
                add(out, -stiffness[i], &displacements[i]);
                add(out, -damping[i], &velocities[i]);
            }
        }
        StateMatrix::Small(columns) => {
            out.fill(ZERO);
            for (column, entry) in columns.chunks(change.len()).zip(change) {
                for (out, value) in out.iter_mut().zip(column) {
                    add(out, *value, entry);
                }
            }
        }
        StateMatrix::Sparse(starts, entries) => {
            for (i, out) in out.iter_mut().enumerate() {
                *out = ZERO;
                for &(place, value) in &entries[starts[i]..starts[i + 1]] {
                    add(out, value, &change[place]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use quell_model::LawKind;
    use quell_model::friction::Expression;
    use quell_model::friction::Friction;

    use super::*;

    /// The slope of every law along a slip that turns, against the law itself at times of the interval.
    #[test]
    fn the_slope_along_a_slip_is_that_of_the_law() {
        let formula = "0.3 + 0.1*exp(-abs(v)/0.2) + 0.05*v^2/(1 + v^2)";
        let laws = [
            LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]),
            LawKind::StribeckExponential.build(&[0.25, 0.4, 0.1, 2.0, 0.05]),
            LawKind::Decreasing.build(&[0.4, 0.25, 0.1]),
            LawKind::Coulomb.build(&[0.3, 0.3, 0.0]),
            Expression::new(formula, &[], None, 1.0).map(Friction::Expression),
        ];
        for law in laws {
            let law = law.expect("valid");
            for sign in [1.0, -1.0] {
                let mut slip = [0.0; ORDER + 1];
                slip[..4].copy_from_slice(&[0.8, -0.2, 0.3, -0.05]);
                let slip = slip.map(|term| sign * term);
                let mut constants = FrictionConstants::of(&law);
                let (first, slopes) = along_slip(&mut constants, sign, &slip);
                let values = integrated(first, &slopes, &slip);
                for at in [0.0, 0.1, 0.2, 0.3] {
                    let w = horner(&slip, at);
                    let exact = law.velocity_scale() * law.slope(w.abs() * law.velocity_scale());
                    assert!((horner(&slopes, at) - exact).abs() < 1e-9, "{law:?} {at}");
                    let value = sign * law.coefficient(w.abs() * law.velocity_scale());
                    assert!((horner(&values, at) - value).abs() < 1e-10, "{law:?} {at}");
                }
            }
        }
    }

    #[test]
    fn the_composition_of_an_exponential_and_a_sine_has_its_known_coefficients() {
        let mut factorial = 1.0;
        let outer: Series = std::array::from_fn(|k| {
            factorial *= k.max(1) as f64;
            1.0 / factorial
        });
        let sine: Series = std::array::from_fn(|k| match k % 4 {
            1 => outer[k],
            3 => -outer[k],
            _ => 0.0,
        });
        // exp(sin t) = 1 + t + t²/2 − t⁴/8 − t⁵/15 − t⁶/240 + t⁷/90 + 31t⁸/5760 + …
        let exact =
            [1.0, 1.0, 0.5, 0.0, -1.0 / 8.0, -1.0 / 15.0, -1.0 / 240.0, 1.0 / 90.0, 31.0 / 5760.0];
        let found = composed(&outer, &sine);
        for (found, exact) in found.iter().zip(exact) {
            assert!((found - exact).abs() < 1e-15, "{found} {exact}");
        }
    }
}
