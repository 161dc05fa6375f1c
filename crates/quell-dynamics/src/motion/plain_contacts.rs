//! The steps of a run whose system has few coordinates and plain contacts: the coordinates side by side in one vector, the contacts in
//! another, whichever of them slip or stick.
//!
//! The equations are those of `step_recurrence` for such a system, with every operation on every number in the same order: a step has
//! the same bits here and there, so that a run may change from one to the other at any step, and machines without vectors of four
//! numbers take the other for all.

use quell_model::friction::{BranchSeries, ConstantsVisitor, FrictionConstants, LawSeries};
use quell_numerics::dispatch::{LaneWork, only_in_four_lanes};
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
    pushes: Vec<Numbers>,
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
        let mut equations = Self {
            coordinates,
            contacts: count,
            columns,
            constant: of_velocities(constant, coordinates)?,
            pushes: pushes
                .iter()
                .map(|push| of_velocities(push.few(), coordinates))
                .collect::<Option<_>>()?,
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
        let Some(mut vectors) =
            equations.plain.as_ref().and_then(|plain| PlainVectors::<V>::of(plain, run))
        else {
            return step_by_step(run);
        };
        while !run.is_over() {
            let room = run.prepare()?;
            if vectors.follows(run) {
                let step = vectors.step(run, room);
                run.accept(step, room)?;
            } else {
                vectors.write_scales(run);
                let step = run.expand(room.longest, room.room);
                vectors.read_scales(run);
                run.accept(step, room)?;
            }
        }
        vectors.write_scales(run);
        Ok(())
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
struct PlainPhases<V> {
    now: Vec<ContactNow>,
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
    most_zeros: usize,
}

/// The forces of sticking contacts.
struct PlainHolding<V> {
    /// Of which [`MotionRun::refreshed`].
    refreshed: u64,
    /// T of all contacts per γ̇ of one of them; the contacts whose conditions are used.
    gains: [V; MOST],
    independent: [bool; MOST],
    is_free: [bool; MOST],
    free: V,
}

/// A run in vectors: its numbers, and the series of its last step.
struct PlainVectors<'e, V: Lane> {
    equations: &'e PlainEquations,
    laws: FrictionConstants<V>,
    phases: PlainPhases<V>,
    holding: PlainHolding<V>,
    /// N of the contacts.
    pressed: V,
    /// Scales of displacements and velocities.
    scales: [V; 2],
    /// Coefficients of the forces.
    pushes: Vec<SeriesOf<f64>>,
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
            holding: PlainHolding::none(),
            pressed: vector(&pressed),
            scales: [zero; 2],
            pushes: run.series.pushes.clone(),
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
        if self.phases.now != run.now {
            self.phases.set(&run.now);
        }
        if self.holding.refreshed != run.refreshed {
            self.holding.set(run);
        }
        self.phases.is_plain
    }

    /// A step of the run, whose end is in its `scratch`, and whose series are written to it if it is observed or a guard may end it.
    #[inline(always)]
    fn step(&mut self, run: &mut MotionRun<'_>, room: StepRoom) -> ExpandedStep {
        self.begin(run);
        let StepRoom { longest, room, .. } = room;
        let MotionRun { tolerance, time_scale, .. } = *run;
        let limit = StepLimit { tolerance, time_scale, longest, room };
        let Self { equations, laws, phases, holding, pressed, scales, pushes, series } = self;
        let (phases, holding, pressed) = (&*phases, &*holding, *pressed);
        let length = laws.visit(PlainStep {
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
            series.write(equations, run);
        }
        let reached = if is_clear { None } else { run.guards().first(length) };
        let duration = reached.map_or(length, |reached| reached.after);
        series.end(duration, equations.coordinates, &mut run.scratch);
        ExpandedStep { duration, reached }
    }

    /// The state at the start, and what varies in time.
    #[inline(always)]
    fn begin(&mut self, run: &MotionRun<'_>) {
        let (upper, lower) = run.series.start().split_at(self.equations.coordinates);
        self.series.displacements[0] = vector(upper);
        self.series.velocities[0] = vector(lower);
        for (series, forcing) in self.pushes.iter_mut().zip(&run.forcings.pushes) {
            *series = forcing.series(run.clock);
        }
        for (place, forcing) in run.forcings.contacts.iter().enumerate() {
            if !forcing.surface.is_constant() {
                self.series.set_surface(place, &forcing.surface.series(run.clock));
            }
        }
    }
}

/// Writes the first numbers of a vector.
#[inline(always)]
fn write<V: Lane>(numbers: V, out: &mut [f64]) {
    let mut all = [0.0; MOST];
    numbers.store(&mut all);
    out.copy_from_slice(&all[..out.len()]);
}

impl<V: Lane> PlainPhases<V> {
    fn unknown() -> Self {
        let zero = V::splat(0.0);
        Self {
            now: Vec::new(),
            is_plain: false,
            slips: [false; MOST],
            any_slips: false,
            any_sticks: false,
            slipping: zero,
            sticking: zero,
            sign: zero,
            zeros: zero,
            most_zeros: 0,
        }
    }

    #[inline(always)]
    fn set(&mut self, now: &[ContactNow]) {
        self.now.clear();
        self.now.extend_from_slice(now);
        let mut sign = [1.0; MOST];
        let (mut zeros, mut sticks) = ([0.0; MOST], [false; MOST]);
        self.slips = [false; MOST];
        self.is_plain = true;
        self.most_zeros = 0;
        for (place, now) in now.iter().enumerate().take(MOST) {
            self.is_plain &= !now.kept && now.saturated == 0;
            zeros[place] = now.slip_zeros as f64;
            self.most_zeros = self.most_zeros.max(now.slip_zeros);
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
        let zero = V::splat(0.0);
        let nobody = [false; MOST];
        Self { refreshed: 0, gains: [zero; MOST], independent: nobody, is_free: nobody, free: zero }
    }

    fn set(&mut self, run: &MotionRun<'_>) {
        *self = Self { refreshed: run.refreshed, ..Self::none() };
        let mut gains = [[0.0; MOST]; MOST];
        for (held, shares) in run.stuck.gains() {
            self.is_free[held] = true;
            for (other, gain) in shares {
                self.independent[other] = true;
                gains[other][held] = gain;
            }
        }
        self.gains = gains.map(|column| V::load(&column));
        self.free = V::load(&mask(self.is_free));
    }
}

/// Computes the series of a step, for laws of one recurrence.
struct PlainStep<'s, V> {
    equations: &'s PlainEquations,
    phases: &'s PlainPhases<V>,
    holding: &'s PlainHolding<V>,
    pressed: V,
    scales: &'s mut [V; 2],
    pushes: &'s [SeriesOf<f64>],
    series: &'s mut PlainSeries<V>,
    limit: StepLimit,
}

impl<V: Lane> ConstantsVisitor<V> for PlainStep<'_, V> {
    /// The length of the step.
    type Output = f64;

    #[inline(always)]
    fn visit<L: LawSeries>(mut self, constants: &mut L::Constants<V>) -> f64 {
        let inverse_scale = V::load(&self.equations.inverse_scales);
        let mut branch = self.branch::<L>(constants, inverse_scale);
        let drag = branch.slope() * inverse_scale * self.pressed;
        for k in 0..=ORDER {
            self.order(k, &mut branch, drag, inverse_scale);
        }
        self.length(&branch)
    }
}

impl<V: Lane> PlainStep<'_, V> {
    /// Σ over the coordinates of a row of each contact times one vector.
    #[inline(always)]
    fn read(&self, vector: V) -> V {
        let tangents = &self.equations.tangents;
        let mut sum = V::load(&tangents[0]) * V::splat(vector.lane(0));
        for (j, tangent) in tangents.iter().enumerate().skip(1) {
            if j < self.equations.coordinates {
                sum = V::load(tangent).mul_add(V::splat(vector.lane(j)), sum);
            }
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
        let rests = phases.sticking.max(phases.zeros - V::splat(k as f64));
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
            rates = self.acted(rates, friction, &phases.slips);
        }
        if phases.any_sticks {
            friction = self.held(k, rates, friction);
            rates = self.acted(rates, friction, &self.holding.is_free);
        }
        self.series.friction[k] = friction;
        let inverse = V::splat(RECIPROCALS[k + 1]);
        self.series.displacements[k + 1] = velocity * inverse;
        self.series.velocities[k + 1] = rates * inverse;
    }

    /// ẍ of order k without friction.
    #[inline(always)]
    fn free_rates(&self, k: usize) -> V {
        let PlainEquations { coordinates, columns, constant, pushes, .. } = self.equations;
        let mut rates = V::splat(0.0);
        let (stiffness, damping) = columns.split_at(MOST);
        for (half, state) in
            [(stiffness, self.series.displacements[k]), (damping, self.series.velocities[k])]
        {
            for (j, column) in half.iter().enumerate() {
                if j < *coordinates {
                    rates = V::load(column).mul_add(V::splat(state.lane(j)), rates);
                }
            }
        }
        if k == 0 {
            rates = rates + V::load(constant);
        }
        for (push, series) in pushes.iter().zip(self.pushes) {
            rates = V::load(push).mul_add(V::splat(series[k]), rates);
        }
        rates
    }

    /// Rates with the friction of some contacts, one after the other.
    #[inline(always)]
    fn acted(&self, mut rates: V, friction: V, which: &[bool; MOST]) -> V {
        for (place, along) in self.equations.along.iter().enumerate() {
            if which[place] {
                rates = V::load(along).mul_add(V::splat(friction.lane(place)), rates);
            }
        }
        rates
    }

    /// Friction of order k with the forces that hold the sticking contacts.
    #[inline(always)]
    fn held(&self, k: usize, rates: V, friction: V) -> V {
        let along = self.read(rates);
        let lost = V::splat((k + 1) as f64).mul_add(self.series.surfaces[k + 1], -along);
        let mut force = V::splat(0.0);
        for (place, gain) in self.holding.gains.iter().enumerate() {
            if self.holding.independent[place] {
                force = gain.mul_add(V::splat(lost.lane(place)), force);
            }
        }
        self.holding.free.where_positive(force, friction)
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
    fn write(&self, equations: &PlainEquations, run: &mut MotionRun<'_>) {
        let coordinates = equations.coordinates;
        let orders = run.series.states.chunks_exact_mut(2 * coordinates);
        for (k, states) in orders.enumerate() {
            let (upper, lower) = states.split_at_mut(coordinates);
            write(self.displacements[k], upper);
            write(self.velocities[k], lower);
        }
        for (place, contact) in run.series.contacts.iter_mut().enumerate() {
            for k in 0..=ORDER {
                contact.slip[k] = self.slip[k].lane(place);
                contact.friction[k] = self.friction[k].lane(place);
            }
            if run.forcings.contacts[place].surface.is_constant() {
                continue;
            }
            for k in 0..=ORDER {
                contact.surface[k] = self.surfaces[k].lane(place);
            }
        }
    }
}
