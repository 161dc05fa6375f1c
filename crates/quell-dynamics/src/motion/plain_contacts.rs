//! The steps of a run whose system has few coordinates and plain contacts: the coordinates side by side in one vector, the contacts in
//! another, whichever of them slip or stick.
//!
//! The equations are those of `step_recurrence` for such a system, with every operation on every number in the same order: a step has
//! the same bits here and there, so that a run may change from one to the other at any step, and machines without vectors of four
//! numbers take the other for all.

use quell_model::friction::{BranchSeries, ConstantsVisitor, FrictionConstants, LawSeries};
use quell_numerics::dispatch::{LaneWork, only_in_four_lanes};
use quell_numerics::for_each_order_below_16;
use quell_numerics::lane::Lane;
use quell_numerics::polynomial::side_by_side::proof_of_no_root;
use quell_numerics::polynomial::step_length;

use super::contact_equation::ContactEquation;
use super::contact_series::SeriesOf;
use super::engine::{MotionProgress, MotionRun, StepRoom};
use super::equations::MotionEquations;
use super::expansion::ExpandedStep;
use super::phase::{ContactNow, ContactPhase};
use super::rows::{RowEntries, StateMatrix, StateRow};
use super::series::horner_states;
use super::step_recurrence::{StepLimit, with_scale};
use crate::simulation::{ORDER, RECIPROCALS};

/// Most coordinates, and most contacts.
const MOST: usize = 4;

/// Most roots of a slip velocity at the start of a step.
const MOST_ZEROS: usize = 2;

/// A number of each coordinate, or of each contact; zeros in places without one.
type Numbers = [f64; MOST];

/// Coefficients of one order more than a series keeps: of the state, from its rates.
type StatesOf<V> = [V; ORDER + 2];

/// The equations of such a system.
#[derive(Clone, Debug)]
pub(super) struct PlainEquations {
    coordinates: usize,
    contacts: usize,
    /// −M⁻¹K, column by column, then −M⁻¹C.
    columns: [Numbers; 2 * MOST],
    constant: Numbers,
    /// The column of the first force, of zeros if there is none, and those of the others.
    pushes: (Numbers, Vec<Numbers>),
    /// t of all contacts, coordinate by coordinate.
    tangents: [Numbers; MOST],
    /// M⁻¹t, contact by contact.
    along: [Numbers; MOST],
    inverse_scales: Numbers,
    static_coefficients: Numbers,
    normal_loads: Numbers,
}

/// The lower half of a row or of a column over displacements and velocities; `None` if the upper one is not zero.
fn of_velocities(dense: &[f64], coordinates: usize) -> Option<Numbers> {
    let (upper, lower) = dense[..2 * coordinates].split_at(coordinates);
    upper.iter().all(|entry| *entry == 0.0).then(|| filled(lower))
}

/// Up to four numbers, then zeros.
fn filled(numbers: &[f64]) -> Numbers {
    let mut out = [0.0; MOST];
    out[..numbers.len()].copy_from_slice(numbers);
    out
}

impl PlainEquations {
    /// Those of a system; `None` of one that is not such a system, whatever its loads.
    pub(super) fn of(
        matrix: &StateMatrix,
        constant: &[f64],
        pushes: &[RowEntries],
        contacts: &[ContactEquation],
    ) -> Option<Self> {
        let (size, count) = (constant.len(), contacts.len());
        let coordinates = size / 2;
        let is_small = (1..=MOST).contains(&coordinates) && (1..=MOST).contains(&count);
        if !is_small || !size.is_multiple_of(2) {
            return None;
        }
        let mut columns = [[0.0; MOST]; 2 * MOST];
        for (j, column) in matrix.columns(size)?.chunks_exact(size).enumerate() {
            let (upper, lower) = column.split_at(coordinates);
            let follows =
                |(i, entry): (usize, &f64)| *entry == f64::from(u8::from(j == i + coordinates));
            if !upper.iter().enumerate().all(follows) {
                return None;
            }
            let place = if j < coordinates { j } else { MOST + j - coordinates };
            columns[place] = filled(lower);
        }
        let mut pushes = pushes.iter().map(|push| of_velocities(push.few(), coordinates));
        let first = pushes.next().unwrap_or(Some([0.0; MOST]))?;
        let pushes = (first, pushes.collect::<Option<_>>()?);
        let mut equations = Self {
            coordinates,
            contacts: count,
            columns,
            constant: of_velocities(constant, coordinates)?,
            pushes,
            tangents: [[0.0; MOST]; MOST],
            along: [[0.0; MOST]; MOST],
            inverse_scales: [0.0; MOST],
            static_coefficients: [0.0; MOST],
            normal_loads: [0.0; MOST],
        };
        for (place, contact) in contacts.iter().enumerate() {
            let is_rigid = contact.own.is_none() && contact.can_stick() && !contact.is_compliant();
            if !is_rigid || !contact.across.is_empty() || !contact.slope.is_empty() {
                return None;
            }
            let tangent = of_velocities(contact.tangent.few(), coordinates)?;
            for (row, entry) in equations.tangents.iter_mut().zip(tangent) {
                row[place] = entry;
            }
            equations.along[place] = of_velocities(contact.along.few(), coordinates)?;
            equations.inverse_scales[place] = contact.inverse_scale;
            equations.static_coefficients[place] = contact.static_coefficient;
            equations.normal_loads[place] = contact.normal_load;
        }
        Some(equations)
    }
}

/// A run to its end, in vectors where it is such a run.
pub(super) fn run_to_end(run: &mut MotionRun<'_>) -> MotionProgress {
    match only_in_four_lanes(PlainRun(run)) {
        Ok(progress) => progress,
        Err(PlainRun(run)) => step_by_step(run),
    }
}

/// The run by the equations of any system.
fn step_by_step(run: &mut MotionRun<'_>) -> MotionProgress {
    while !run.is_over() {
        run.step()?;
    }
    Ok(())
}

struct PlainRun<'r, 'a>(&'r mut MotionRun<'a>);

impl LaneWork for PlainRun<'_, '_> {
    type Output = MotionProgress;

    #[inline(always)]
    fn run<V: Lane>(self) -> MotionProgress {
        let Self(run) = self;
        let equations: &MotionEquations = run.equations;
        let Some(vectors) =
            equations.plain.as_ref().and_then(|plain| PlainVectors::<V>::of(plain, run))
        else {
            return step_by_step(run);
        };
        // Places without a coordinate or a contact hold zeros, and cost time alone.
        if equations.contacts.len().max(run.equations.size / 2) <= 2 {
            vectors.run::<2>(run)
        } else {
            vectors.run::<MOST>(run)
        }
    }
}

/// A number of the coordinates or of the contacts side by side.
#[inline(always)]
fn vector<V: Lane>(numbers: &[f64]) -> V {
    V::load(&filled(numbers))
}

/// 1 where a condition holds.
#[inline(always)]
fn mask(holds: [bool; MOST]) -> [f64; MOST] {
    holds.map(|holds| f64::from(u8::from(holds)))
}

/// What the contacts do during a step.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each says of all contacts whether any needs some work"
)]
struct PlainPhases<V> {
    /// Whether they are those of the coming step.
    are_known: bool,
    /// Whether a slip velocity is zero at the start.
    any_zeros: bool,
    /// Whether vectors follow: no contact keeps its phase beyond a border or stands at its bound.
    is_plain: bool,
    slips: [bool; MOST],
    any_slips: bool,
    any_sticks: bool,
    /// 1 where the contact slips, sticks, or either.
    slipping: V,
    sticking: V,
    /// ±1; 1 in stick.
    sign: V,
    /// Multiplicity of the zero of γ at the start.
    zeros: V,
}

/// The forces of sticking contacts.
struct PlainHolding<V> {
    /// Of which [`MotionRun::refreshed`].
    refreshed: u64,
    /// T of all contacts per γ̇ of one of them: zeros where its condition is not used.
    gains: [V; MOST],
}

/// Coefficients of the first force, which is zero if there is none, and of the others.
type PushSeries = (SeriesOf<f64>, Vec<SeriesOf<f64>>);

/// A run in vectors: its numbers, and the series of its last step.
struct PlainVectors<'e, V: Lane> {
    equations: &'e PlainEquations,
    laws: FrictionConstants<V>,
    phases: PlainPhases<V>,
    surfaces_vary: bool,
    holding: PlainHolding<V>,
    /// N of the contacts.
    pressed: V,
    /// Scales of displacements and velocities.
    scales: [V; 2],
    pushes: PushSeries,
    series: PlainSeries<V>,
}

/// The series of a step.
struct PlainSeries<V> {
    displacements: StatesOf<V>,
    velocities: StatesOf<V>,
    /// Zero in the last order, which no surface has.
    surfaces: StatesOf<V>,
    slip: SeriesOf<V>,
    scaled: SeriesOf<V>,
    friction: SeriesOf<V>,
}

impl<'e, V: Lane> PlainVectors<'e, V> {
    /// Of a run, whose loads must be constant and whose laws must differ in numbers alone.
    fn of(equations: &'e PlainEquations, run: &MotionRun<'_>) -> Option<Self> {
        let forcings = &run.forcings.contacts;
        let mut contacts = run.equations.contacts.iter().zip(forcings);
        if !contacts.all(|(contact, forcing)| contact.is_plain(forcing)) {
            return None;
        }
        let last = equations.contacts - 1;
        let laws: Vec<_> = (0..V::LANES)
            .map(|lane| run.system.contacts[lane.min(last)].friction.clone())
            .collect();
        let pressed: Vec<f64> =
            run.series.contacts.iter().map(|series| series.pressed[0]).collect();
        let zero = V::splat(0.0);
        let (states, series) = ([zero; ORDER + 2], [zero; ORDER + 1]);
        let mut vectors = Self {
            equations,
            laws: FrictionConstants::side_by_side(&laws)?,
            phases: PlainPhases::unknown(),
            surfaces_vary: !forcings.iter().all(|forcing| forcing.surface.is_constant()),
            holding: PlainHolding::none(),
            pressed: vector(&pressed),
            scales: [zero; 2],
            pushes: ([0.0; ORDER + 1], run.series.pushes.iter().skip(1).copied().collect()),
            series: PlainSeries {
                displacements: states,
                velocities: states,
                surfaces: states,
                slip: series,
                scaled: series,
                friction: series,
            },
        };
        for (place, contact) in run.series.contacts.iter().enumerate() {
            vectors.series.set_surface(place, &contact.surface);
        }
        vectors.read_scales(run);
        Some(vectors)
    }

    /// The run to its end, with as many coordinates and contacts as `N` at most.
    #[inline(always)]
    fn run<const N: usize>(mut self, run: &mut MotionRun<'_>) -> MotionProgress {
        while !run.is_over() {
            let room = run.prepare()?;
            if self.follows(run) {
                let step = self.step::<N>(run, room);
                run.accept(step, room)?;
            } else {
                self.write_scales(run);
                let step = run.expand(room.longest, room.room);
                self.read_scales(run);
                run.accept(step, room)?;
                self.phases.are_known = false;
            }
        }
        self.write_scales(run);
        Ok(())
    }

    fn read_scales(&mut self, run: &MotionRun<'_>) {
        let (upper, lower) = run.series.scales.split_at(self.equations.coordinates);
        self.scales = [vector(upper), vector(lower)];
    }

    fn write_scales(&self, run: &mut MotionRun<'_>) {
        let (upper, lower) = run.series.scales.split_at_mut(self.equations.coordinates);
        for (scales, out) in self.scales.iter().zip([upper, lower]) {
            write(*scales, out);
        }
    }

    /// Reads what the contacts do now. Whether vectors follow it.
    #[inline(always)]
    fn follows(&mut self, run: &MotionRun<'_>) -> bool {
        if !self.phases.are_known {
            self.phases.set(&run.now);
        }
        if self.holding.refreshed != run.refreshed {
            self.holding.set(run);
        }
        self.phases.is_plain
    }

    /// A step of the run, whose end is in its `scratch`, and whose series are written to it if it is observed or a guard may end it.
    #[inline(always)]
    fn step<const N: usize>(&mut self, run: &mut MotionRun<'_>, room: StepRoom) -> ExpandedStep {
        self.begin(run);
        let StepRoom { longest, room, .. } = room;
        let MotionRun { tolerance, time_scale, .. } = *run;
        let limit = StepLimit { tolerance, time_scale, longest, room };
        let Self { equations, laws, phases, holding, pressed, scales, pushes, series, .. } = self;
        let (phases, holding, pressed) = (&*phases, &*holding, *pressed);
        let length = laws.visit(PlainStep::<V, N> {
            equations,
            phases,
            holding,
            pressed,
            scales,
            pushes,
            series,
            limit,
        });
        let is_clear = series.is_clear(equations, phases, pressed, length);
        if run.watched || !is_clear {
            series.write::<N>(equations, run);
        }
        if let (true, Some((first, others))) = (run.watched, run.series.pushes.split_first_mut()) {
            *first = pushes.0;
            others.copy_from_slice(&pushes.1);
        }
        let reached = if is_clear { None } else { run.guards().first(length) };
        let duration = reached.map_or(length, |reached| reached.after);
        series.end(duration, equations.coordinates, &mut run.scratch);
        self.phases.are_known = reached.is_none() && !self.phases.any_zeros;
        ExpandedStep { duration, reached }
    }

    /// The state at the start, and what varies in time.
    #[inline(always)]
    fn begin(&mut self, run: &MotionRun<'_>) {
        let (upper, lower) = run.series.start().split_at(self.equations.coordinates);
        self.series.displacements[0] = vector(upper);
        self.series.velocities[0] = vector(lower);
        if let Some((first, others)) = run.forcings.pushes.split_first() {
            self.pushes.0 = first.series(run.clock);
            for (series, forcing) in self.pushes.1.iter_mut().zip(others) {
                *series = forcing.series(run.clock);
            }
        }
        if self.surfaces_vary {
            for (place, forcing) in run.forcings.contacts.iter().enumerate() {
                self.series.set_surface(place, &forcing.surface.series(run.clock));
            }
        }
    }
}

/// Writes the first numbers of a vector.
#[inline(always)]
fn write<V: Lane>(numbers: V, out: &mut [f64]) {
    // One by one, because a copy of so few is a call.
    for (place, out) in out.iter_mut().enumerate().take(MOST) {
        *out = numbers.lane(place);
    }
}

impl<V: Lane> PlainPhases<V> {
    fn unknown() -> Self {
        let zero = V::splat(0.0);
        Self {
            are_known: false,
            any_zeros: false,
            is_plain: false,
            slips: [false; MOST],
            any_slips: false,
            any_sticks: false,
            slipping: zero,
            sticking: zero,
            sign: zero,
            zeros: zero,
        }
    }

    #[inline(always)]
    fn set(&mut self, now: &[ContactNow]) {
        let mut sign = [1.0; MOST];
        let (mut zeros, mut sticks) = ([0.0; MOST], [false; MOST]);
        self.slips = [false; MOST];
        (self.are_known, self.any_zeros, self.is_plain) = (true, false, true);
        for (place, now) in now.iter().enumerate().take(MOST) {
            self.is_plain &= !now.kept && now.saturated == 0;
            zeros[place] = now.slip_zeros as f64;
            self.any_zeros |= now.slip_zeros > 0;
            match now.phase {
                ContactPhase::Slip(direction) => {
                    self.slips[place] = true;
                    sign[place] = f64::from(direction);
                }
                ContactPhase::Stick => sticks[place] = true,
                ContactPhase::Open => self.is_plain = false,
            }
        }
        self.any_slips = self.slips.contains(&true);
        self.any_sticks = sticks.contains(&true);
        self.slipping = V::load(&mask(self.slips));
        self.sticking = V::load(&mask(sticks));
        (self.sign, self.zeros) = (V::load(&sign), V::load(&zeros));
    }
}

impl<V: Lane> PlainHolding<V> {
    fn none() -> Self {
        Self { refreshed: 0, gains: [V::splat(0.0); MOST] }
    }

    fn set(&mut self, run: &MotionRun<'_>) {
        let mut gains = [[0.0; MOST]; MOST];
        for (held, shares) in run.stuck.gains() {
            for (other, gain) in shares {
                gains[other][held] = gain;
            }
        }
        *self = Self { refreshed: run.refreshed, gains: gains.map(|column| V::load(&column)) };
    }
}

/// Computes the series of a step, for laws of one recurrence.
struct PlainStep<'s, V, const N: usize> {
    equations: &'s PlainEquations,
    phases: &'s PlainPhases<V>,
    holding: &'s PlainHolding<V>,
    pressed: V,
    scales: &'s mut [V; 2],
    pushes: &'s PushSeries,
    series: &'s mut PlainSeries<V>,
    limit: StepLimit,
}

impl<V: Lane, const N: usize> ConstantsVisitor<V> for PlainStep<'_, V, N> {
    /// The length of the step.
    type Output = f64;

    #[inline(always)]
    fn visit<L: LawSeries>(mut self, constants: &mut L::Constants<V>) -> f64 {
        let inverse_scale = V::load(&self.equations.inverse_scales);
        let mut branch = self.branch::<L>(constants, inverse_scale);
        let drag = branch.slope() * inverse_scale * self.pressed;
        self.order(0, &mut branch, drag, inverse_scale);
        if const { N == 2 } {
            const { assert!(ORDER == 16, "unrolled up to order 16") };
            for_each_order_below_16!(J, {
                const K: usize = J + 1;
                self.order(K, &mut branch, drag, inverse_scale);
            });
        } else {
            // In a third of the time to compile.
            for k in 1..=ORDER {
                self.order(k, &mut branch, drag, inverse_scale);
            }
        }
        self.length(&branch)
    }
}

#[expect(
    clippy::needless_range_loop,
    reason = "loops over indices are unrolled, with constant lanes; those over iterators are not"
)]
impl<V: Lane, const N: usize> PlainStep<'_, V, N> {
    /// Σ over the coordinates of a row of each contact times one vector.
    #[inline(always)]
    fn read(&self, vector: V) -> V {
        let tangents = &self.equations.tangents;
        let mut sum = V::load(&tangents[0]) * V::splat(vector.lane(0));
        for j in 1..N {
            sum = V::load(&tangents[j]).mul_add(V::splat(vector.lane(j)), sum);
        }
        sum
    }

    /// The laws' recurrence at the start of the step.
    #[inline(always)]
    fn branch<'c, L: LawSeries>(
        &self,
        constants: &'c mut L::Constants<V>,
        inverse_scale: V,
    ) -> L::Series<'c, V, { ORDER + 1 }> {
        let slip = self.series.surfaces[0] - self.read(self.series.velocities[0]);
        let rests = self.phases.sticking.max(self.phases.zeros);
        let slip = rests.where_positive(V::splat(0.0), slip);
        L::series(constants, self.phases.sign, slip * inverse_scale)
    }

    /// One order: forces from the state, then the next order of the state.
    #[inline(always)]
    fn order(&mut self, k: usize, branch: &mut impl BranchSeries<V>, drag: V, inverse_scale: V) {
        let zero = V::splat(0.0);
        let phases = self.phases;
        let velocity = self.series.velocities[k];
        let mut rates = self.free_rates(k);
        let slip = self.series.surfaces[k] - self.read(velocity);
        let mut rests = phases.sticking;
        if k < MOST_ZEROS {
            rests = rests.max(phases.zeros - V::splat(k as f64));
        }
        let slip = rests.where_positive(zero, slip);
        let scaled = slip * inverse_scale;
        self.series.slip[k] = slip;
        self.series.scaled[k] = scaled;
        let mut friction = zero;
        if phases.any_slips {
            let force = if k == 0 {
                branch.first() * self.pressed
            } else {
                // The newest coefficient of γ waits for one operation only.
                drag.mul_add(slip, branch.lower(k, &self.series.scaled) * self.pressed)
            };
            friction = phases.slipping.where_positive(force, zero);
            rates = self.acted(rates, friction);
        }
        if phases.any_sticks {
            let force = self.held(k, rates);
            rates = self.acted(rates, force);
            friction = phases.sticking.where_positive(force, friction);
        }
        self.series.friction[k] = friction;
        let inverse = V::splat(RECIPROCALS[k + 1]);
        self.series.displacements[k + 1] = velocity * inverse;
        self.series.velocities[k + 1] = rates * inverse;
    }

    /// ẍ of order k without friction.
    #[inline(always)]
    fn free_rates(&self, k: usize) -> V {
        let PlainEquations { columns, constant, pushes, .. } = self.equations;
        let mut rates = V::splat(0.0);
        let (displacement, velocity) = (self.series.displacements[k], self.series.velocities[k]);
        for j in 0..N {
            rates = V::load(&columns[j]).mul_add(V::splat(displacement.lane(j)), rates);
        }
        for j in 0..N {
            rates = V::load(&columns[MOST + j]).mul_add(V::splat(velocity.lane(j)), rates);
        }
        if k == 0 {
            rates = rates + V::load(constant);
        }
        let (first, others) = pushes;
        rates = V::load(first).mul_add(V::splat(self.pushes.0[k]), rates);
        for (push, series) in others.iter().zip(&self.pushes.1) {
            rates = V::load(push).mul_add(V::splat(series[k]), rates);
        }
        rates
    }

    /// Rates with the friction of the contacts, one after the other.
    #[inline(always)]
    fn acted(&self, mut rates: V, friction: V) -> V {
        for place in 0..N {
            let along = V::load(&self.equations.along[place]);
            rates = along.mul_add(V::splat(friction.lane(place)), rates);
        }
        rates
    }

    /// The forces of order k that hold the sticking contacts, 0 of the others.
    #[inline(always)]
    fn held(&self, k: usize, rates: V) -> V {
        let along = self.read(rates);
        let lost = V::splat((k + 1) as f64).mul_add(self.series.surfaces[k + 1], -along);
        let mut force = V::splat(0.0);
        for place in 0..N {
            force = self.holding.gains[place].mul_add(V::splat(lost.lane(place)), force);
        }
        force
    }

    /// Length over which the last retained terms stay below the tolerance.
    #[inline(always)]
    fn length(&mut self, branch: &impl BranchSeries<V>) -> f64 {
        let zero = V::splat(0.0);
        let (mut last, mut previous) = (zero, zero);
        let PlainSeries { displacements, velocities, friction, scaled, .. } = &*self.series;
        for (states, kept) in [displacements, velocities].into_iter().zip(self.scales.iter_mut()) {
            let inverse = with_scale(kept, V::splat(self.limit.time_scale), |k| states[k].abs());
            last = (states[ORDER].abs() * inverse).max(last);
            previous = (states[ORDER - 1].abs() * inverse).max(previous);
        }
        if self.phases.any_sticks {
            let level = V::load(&self.equations.static_coefficients);
            let pressed = level * self.pressed.abs();
            let scale = pressed.max(level * V::load(&self.equations.normal_loads));
            let share = |term: V| {
                let share = |term, scale| if scale > 0.0 { term / scale } else { 0.0 };
                self.phases.sticking.where_positive(term.abs().zip(scale, share), zero)
            };
            last = share(friction[ORDER]).max(last);
            previous = share(friction[ORDER - 1]).max(previous);
        }
        let StepLimit { tolerance, longest, room, .. } = self.limit;
        let length = step_length(tolerance, largest(last), largest(previous), ORDER);
        let mut length = Lane::min(Lane::min(length, longest), room);
        for (place, slips) in self.phases.slips.into_iter().enumerate() {
            if slips {
                length = branch.trusted(scaled, V::splat(length)).lane(place);
            }
        }
        length
    }
}

/// The largest of four numbers.
#[inline(always)]
fn largest<V: Lane>(numbers: V) -> f64 {
    let first = Lane::max(numbers.lane(0), numbers.lane(1));
    Lane::max(first, Lane::max(numbers.lane(2), numbers.lane(3)))
}

impl<V: Lane> PlainSeries<V> {
    #[inline(always)]
    fn set_surface(&mut self, place: usize, surface: &SeriesOf<f64>) {
        for (out, term) in self.surfaces.iter_mut().zip(surface) {
            out.set_lane(place, *term);
        }
    }

    /// Whether no guard is found that reaches zero within `length`, without halving the step.
    #[inline(always)]
    fn is_clear(
        &self,
        equations: &PlainEquations,
        phases: &PlainPhases<V>,
        pressed: V,
        length: f64,
    ) -> bool {
        let (zero, one, length) = (V::splat(0.0), V::splat(1.0), V::splat(length));
        let (slipping, sticking) = (phases.slipping, phases.sticking);
        if !phases.any_sticks {
            let proof = proof_of_no_root(&self.slip, phases.zeros, phases.sign, length, slipping);
            return !slipping.where_positive(-proof, zero).any_positive();
        }
        // Of a contact that sticks the margin above its bounds stands in the place of γ: at the upper one first, then at the lower one.
        let level = V::load(&equations.static_coefficients);
        let mut clear = one;
        for (side, wanted) in [(one, slipping.max(sticking)), (-one, sticking)] {
            let mut guards = self.slip;
            for (k, (guard, friction)) in guards.iter_mut().zip(&self.friction).enumerate() {
                let pressed = if k == 0 { pressed } else { zero };
                let margin = level.mul_add(pressed, -(side * *friction));
                *guard = sticking.where_positive(margin, *guard);
            }
            let proof = proof_of_no_root(&guards, phases.zeros, phases.sign, length, wanted);
            clear = clear.min(wanted.where_positive(proof, one));
        }
        !(-clear).any_positive()
    }

    /// The state after a time.
    #[inline(always)]
    fn end(&self, since: f64, coordinates: usize, out: &mut [f64]) {
        let since = V::splat(since);
        let (upper, lower) = out.split_at_mut(coordinates);
        for (states, out) in [&self.displacements, &self.velocities].into_iter().zip([upper, lower])
        {
            let mut end = [V::splat(0.0)];
            horner_states(states, since, &mut end);
            write(end[0], out);
        }
    }

    /// Writes the series to a run.
    #[inline(always)]
    fn write<const N: usize>(&self, equations: &PlainEquations, run: &mut MotionRun<'_>) {
        let (coordinates, states) = (equations.coordinates, &mut run.series.states[..]);
        if coordinates == N {
            let orders = states.as_chunks_mut::<N>().0.as_chunks_mut::<2>().0.iter_mut();
            let known = self.displacements.iter().zip(&self.velocities);
            for ([upper, lower], (displacement, velocity)) in orders.zip(known) {
                *upper = std::array::from_fn(|i| displacement.lane(i));
                *lower = std::array::from_fn(|i| velocity.lane(i));
            }
        } else {
            for (k, states) in states.chunks_exact_mut(2 * coordinates).enumerate() {
                let (upper, lower) = states.split_at_mut(coordinates);
                write(self.displacements[k], upper);
                write(self.velocities[k], lower);
            }
        }
        for place in 0..N {
            let Some(contact) = run.series.contacts.get_mut(place) else { break };
            for k in 0..=ORDER {
                contact.slip[k] = self.slip[k].lane(place);
                contact.friction[k] = self.friction[k].lane(place);
            }
            if !run.forcings.contacts[place].surface.is_constant() {
                for k in 0..=ORDER {
                    contact.surface[k] = self.surfaces[k].lane(place);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use quell_model::friction::Friction;
    use quell_model::profile::{Profile, Wave};
    use quell_model::system::{Contact, Input, InputTarget, MassMatrix, Mechanical};
    use quell_model::{LawKind, System, Waveform};
    use quell_numerics::matrix::Matrix;

    use super::*;
    use crate::motion::{
        MOTION_TOLERANCE, Motion, MotionEnd, MotionRecorder, MotionStart, MotionStopped,
        RecordedEvent,
    };

    fn wave(waveform: Waveform, amplitude: f64, frequency: f64) -> Wave {
        Wave { waveform, amplitude, frequency, phase: 0.3, envelope: None }
    }

    fn law(kind: LawKind, contact: usize) -> Friction {
        let level = 0.4 - 0.03 * contact as f64;
        let values = match kind {
            LawKind::Coulomb => vec![0.7 * level, level, 0.02],
            LawKind::StribeckExponential => vec![0.7 * level, level, 0.1, 1.0, 0.02],
            _ => vec![level, 0.7 * level, 0.2],
        };
        kind.build(&values).expect("values within their bounds")
    }

    /// A chain of masses, each on a surface of its own, with off-diagonal masses, a moving surface and two forces.
    fn chain(coordinates: usize, contacts: usize, kind: LawKind) -> System {
        let mass = Matrix::from_fn(coordinates, coordinates, |i, j| match i.abs_diff(j) {
            0 => 1.0 + 0.2 * i as f64,
            1 => 0.1,
            _ => 0.0,
        });
        let stiffness = Matrix::from_fn(coordinates, coordinates, |i, j| match i.abs_diff(j) {
            0 => 2.2,
            1 => -0.9,
            _ => 0.0,
        });
        let damping =
            Matrix::from_fn(coordinates, coordinates, |i, j| if i == j { 0.02 } else { 0.0 });
        let at = |place: usize| {
            (0..coordinates).map(|i| f64::from(u8::from(i == place))).collect::<Vec<_>>()
        };
        let contact = |number: usize| Contact {
            name: format!("pad {number}"),
            tangent: Some(at(number % coordinates)),
            force: None,
            normal: None,
            slope: None,
            normal_load: 1.0 + 0.3 * number as f64,
            normal_stiffness: 0.0,
            tangential_stiffness: None,
            normal_damping: 0.0,
            surface_velocity: match number {
                1 => Profile::constant(0.06).with(wave(Waveform::Sine, 0.02, 3.0)),
                _ => Profile::constant(0.05),
            },
            friction: law(kind, number),
            varying_load: None,
        };
        let force = |place: usize, wave| Input {
            target: InputTarget::Force(at(place)),
            profile: Profile::default().with(wave),
        };
        let names = (0..coordinates).map(|i| format!("x{i}")).collect();
        System {
            structure: Mechanical::new(names, MassMatrix::dense(mass), damping, stiffness).into(),
            contacts: (0..contacts).map(contact).collect(),
            inputs: vec![
                force(0, wave(Waveform::Sine, 0.35, 10.0)),
                force(coordinates - 1, wave(Waveform::Triangle, 0.1, 7.0)),
            ],
        }
    }

    /// The end and the events of a run that takes its steps by `all`.
    fn run_by(
        motion: &Motion<'_>,
        all: fn(&mut MotionRun<'_>) -> MotionProgress,
    ) -> (Result<MotionEnd, MotionStopped>, Vec<RecordedEvent>) {
        let start = MotionStart { time: 0.0, state: vec![0.0; motion.size()] };
        let mut recorder = MotionRecorder::default();
        let system = (motion.system, motion.equations().expect("a mass for each coordinate"));
        let mut run = MotionRun::new(system, &start, 60.0, MOTION_TOLERANCE, &mut recorder);
        run.open().expect("a start");
        let end = all(&mut run).and_then(|()| run.end());
        (end, recorder.events)
    }

    #[test]
    fn vectors_have_the_bits_of_the_equations_of_any_system() {
        let kinds = [
            LawKind::Stribeck,
            LawKind::Coulomb,
            LawKind::StribeckExponential,
            LawKind::Decreasing,
        ];
        let mut events = 0;
        for (coordinates, contacts) in [(1, 2), (2, 1), (2, 2), (3, 2), (3, 4), (4, 4)] {
            for kind in kinds {
                let system = chain(coordinates, contacts, kind);
                let motion = Motion::new(&system).expect("a system that moves");
                let plain = motion.equations().expect("equations").plain.as_ref();
                assert!(plain.is_some(), "{coordinates} coordinates, {contacts} contacts");
                let (one, other) = (run_by(&motion, run_to_end), run_by(&motion, step_by_step));
                assert_eq!(one, other, "{coordinates} coordinates, {contacts} contacts, {kind:?}");
                assert!(one.0.is_ok(), "{:?}", one.0);
                events += one.1.len();
            }
        }
        assert!(events > 2000, "{events} events");
    }

    #[test]
    fn contacts_that_open_or_tilt_and_long_chains_are_left_to_the_general_equations() {
        let is_plain = |system: &System| {
            let motion = Motion::new(system).expect("a system that moves");
            motion.equations().is_ok_and(|equations| equations.plain.is_some())
        };
        assert!(is_plain(&chain(2, 2, LawKind::Stribeck)));
        assert!(!is_plain(&chain(5, 2, LawKind::Stribeck)));
        assert!(!is_plain(&chain(2, 5, LawKind::Stribeck)));
        let mut system = chain(2, 2, LawKind::Stribeck);
        (system.contacts[0].normal, system.contacts[0].normal_stiffness) =
            (Some(vec![0.0, 1.0]), 4.0);
        assert!(!is_plain(&system));
        let mut system = chain(2, 2, LawKind::Stribeck);
        system.contacts[1].slope = Some(vec![0.1, 0.0]);
        assert!(!is_plain(&system));
    }
}
