//! The series of a step in vectors, order by order, and its length.

use quell_model::friction::{BranchSeries, ConstantsVisitor, LawSeries};
use quell_numerics::for_each_order_below_16;
use quell_numerics::lane::Lane;
use quell_numerics::polynomial::side_by_side::proof_of_no_root;
use quell_numerics::polynomial::step_length;

use super::contact_series::SeriesOf;
use super::phase::{ContactNow, ContactPhase};
use super::plain_equations::{MOST, Numbers, PlainEquations};
use super::step_recurrence::{StepLimit, with_scale};
use super::stuck::StuckForces;
use crate::simulation::{ORDER, RECIPROCALS};

/// Most roots of a slip velocity at the start of a step.
const MOST_ZEROS: usize = 2;

/// Coefficients of one order more than a series keeps: of the state, from its rates.
pub(super) type RatedSeries<V> = [V; ORDER + 2];

/// Runs whose numbers share a vector, each with `N` places.
pub(super) const fn runs_of(places: usize) -> usize {
    MOST / places
}

/// What the contacts of all runs do during a step.
pub(super) struct PlainPhases {
    /// 1 where the contact slips, and where it sticks.
    pub(super) slipping: Numbers,
    pub(super) sticking: Numbers,
    /// ±1; 1 in stick.
    pub(super) sign: Numbers,
    /// Multiplicity of the zero of γ at the start.
    pub(super) zeros: Numbers,
    /// Whether any contact at this place of a run slips.
    pub(super) slips: [bool; MOST],
    pub(super) any_slips: bool,
    pub(super) any_sticks: bool,
}

impl PlainPhases {
    pub(super) fn none() -> Self {
        Self {
            slipping: [0.0; MOST],
            sticking: [0.0; MOST],
            sign: [1.0; MOST],
            zeros: [0.0; MOST],
            slips: [false; MOST],
            any_slips: false,
            any_sticks: false,
        }
    }

    /// Writes the phases of a run from a lane on; [`PlainPhases::combine`] must follow.
    #[inline(always)]
    pub(super) fn set<const N: usize>(&mut self, first: usize, now: &[ContactNow]) {
        for place in 0..N {
            let lane = first + place;
            let now = now.get(place);
            let direction = match now.map(|now| now.phase) {
                Some(ContactPhase::Slip(direction)) => direction,
                _ => 0,
            };
            let sticks = now.is_some_and(ContactNow::sticks);
            self.slipping[lane] = f64::from(direction.abs());
            self.sticking[lane] = f64::from(u8::from(sticks));
            self.sign[lane] = if direction < 0 { -1.0 } else { 1.0 };
            self.zeros[lane] = now.map_or(0.0, |now| now.slip_zeros as f64);
        }
    }

    /// Combines the phases of all runs.
    #[inline(always)]
    pub(super) fn combine<const N: usize>(&mut self) {
        self.slips = [false; MOST];
        for lane in 0..MOST {
            self.slips[lane % N] |= self.slipping[lane] > 0.0;
        }
        self.any_slips = self.slips.contains(&true);
        self.any_sticks = self.sticking.contains(&1.0);
    }
}

/// The equations of all runs, as those of [`PlainEquations`], and N of their contacts.
pub(super) struct PlainNumbers<V> {
    columns: [V; 2 * MOST],
    constant: V,
    pushes: (V, Vec<V>),
    tangents: [V; MOST],
    along: [V; MOST],
    inverse_scales: V,
    static_coefficients: V,
    normal_loads: V,
    pub(super) pressed: V,
    /// T of all contacts of a run per γ̇ of one of them: zeros where its condition is not used.
    gains: [V; MOST],
}

impl<V: Lane> PlainNumbers<V> {
    /// Zeros, for runs with so many forces after the first.
    pub(super) fn zeros(others: usize) -> Self {
        let zero = V::splat(0.0);
        Self {
            columns: [zero; 2 * MOST],
            constant: zero,
            pushes: (zero, vec![zero; others]),
            tangents: [zero; MOST],
            along: [zero; MOST],
            inverse_scales: zero,
            static_coefficients: zero,
            normal_loads: zero,
            pressed: zero,
            gains: [zero; MOST],
        }
    }

    /// Writes the equations of a run from a lane on.
    pub(super) fn set<const N: usize>(&mut self, first: usize, equations: &PlainEquations) {
        let rows = [
            (&mut self.constant, &equations.constant),
            (&mut self.pushes.0, &equations.pushes.0),
            (&mut self.inverse_scales, &equations.inverse_scales),
            (&mut self.static_coefficients, &equations.static_coefficients),
            (&mut self.normal_loads, &equations.normal_loads),
        ];
        let columns = self.columns.iter_mut().zip(&equations.columns);
        let others = self.pushes.1.iter_mut().zip(&equations.pushes.1);
        let tangents = self.tangents.iter_mut().zip(&equations.tangents);
        let along = self.along.iter_mut().zip(&equations.along);
        for (vector, numbers) in
            rows.into_iter().chain(columns).chain(others).chain(tangents).chain(along)
        {
            set_run::<V, N>(vector, first, numbers);
        }
    }

    /// Writes the forces of the sticking contacts of a run.
    #[inline(always)]
    pub(super) fn hold<const N: usize>(&mut self, first: usize, stuck: &StuckForces) {
        let mut gains = [[0.0; MOST]; MOST];
        for (held, shares) in stuck.gains() {
            for (other, gain) in shares {
                gains[other][held] = gain;
            }
        }
        for (vector, numbers) in self.gains.iter_mut().zip(&gains) {
            set_run::<V, N>(vector, first, numbers);
        }
    }
}

/// A term of friction over its scale in the lanes of sticking contacts, else 0.
#[inline(always)]
fn share<V: Lane>(term: V, scale: V, sticking: V) -> V {
    let share = term.abs().zip(scale, |term, scale| if scale > 0.0 { term / scale } else { 0.0 });
    sticking.where_positive(share, V::splat(0.0))
}

/// Writes the numbers of a run from a lane on.
#[inline(always)]
pub(super) fn set_run<V: Lane, const N: usize>(vector: &mut V, first: usize, numbers: &[f64]) {
    for (place, number) in numbers.iter().enumerate().take(N) {
        vector.set_lane(first + place, *number);
    }
}

/// Writes the series of a force of a run to its lanes.
#[inline(always)]
pub(super) fn set_push<V: Lane, const N: usize>(
    push: &mut SeriesOf<V>,
    first: usize,
    series: &SeriesOf<f64>,
) {
    for (out, term) in push.iter_mut().zip(series) {
        for place in 0..N {
            out.set_lane(first + place, *term);
        }
    }
}

/// The number of each run at one of its `N` places, at all of them.
#[inline(always)]
pub(super) fn spread<V: Lane, const N: usize>(vector: V, place: usize) -> V {
    if const { N == 2 } { vector.pairwise(place) } else { V::splat(vector.lane(place)) }
}

/// The largest number of each run, at least 0.
#[inline(always)]
fn largest<V: Lane, const N: usize>(vector: V) -> V {
    let mut most = spread::<V, N>(vector, 0);
    for place in 1..N {
        most = most.max(spread::<V, N>(vector, place));
    }
    most.max(V::splat(0.0))
}

/// Coefficients of the first force, which is zero where no force acts, and of the others.
pub(super) type PushSeries<V> = (SeriesOf<V>, Vec<SeriesOf<V>>);

/// The series of a step.
pub(super) struct PlainSeries<V> {
    pub(super) displacements: RatedSeries<V>,
    pub(super) velocities: RatedSeries<V>,
    /// Zero in the last order, which no surface has.
    pub(super) surfaces: RatedSeries<V>,
    pub(super) slip: SeriesOf<V>,
    pub(super) scaled: SeriesOf<V>,
    pub(super) friction: SeriesOf<V>,
}

/// Computes the series of a step, for laws of one recurrence.
pub(super) struct PlainStep<'s, V, const N: usize> {
    pub(super) numbers: &'s PlainNumbers<V>,
    pub(super) phases: &'s PlainPhases,
    pub(super) scales: &'s mut [V; 2],
    pub(super) pushes: &'s PushSeries<V>,
    pub(super) series: &'s mut PlainSeries<V>,
    pub(super) limit: StepLimit<V>,
}

impl<V: Lane, const N: usize> ConstantsVisitor<V> for PlainStep<'_, V, N> {
    /// The length of the step of each run, in all of its lanes.
    type Output = V;

    #[inline(always)]
    fn visit<L: LawSeries>(mut self, constants: &mut L::Constants<V>) -> V {
        let inverse_scale = self.numbers.inverse_scales;
        let mut branch = self.branch::<L>(constants, inverse_scale);
        let drag = branch.slope() * inverse_scale * self.numbers.pressed;
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
        let tangents = &self.numbers.tangents;
        let mut sum = tangents[0] * spread::<V, N>(vector, 0);
        for j in 1..N {
            sum = tangents[j].mul_add(spread::<V, N>(vector, j), sum);
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
        let rests = V::load(&self.phases.sticking).max(V::load(&self.phases.zeros));
        let slip = rests.where_positive(V::splat(0.0), slip);
        L::series(constants, V::load(&self.phases.sign), slip * inverse_scale)
    }

    /// One order: forces from the state, then the next order of the state.
    #[inline(always)]
    fn order(&mut self, k: usize, branch: &mut impl BranchSeries<V>, drag: V, inverse_scale: V) {
        let zero = V::splat(0.0);
        let phases = self.phases;
        let velocity = self.series.velocities[k];
        let mut rates = self.free_rates(k);
        let slip = self.series.surfaces[k] - self.read(velocity);
        let mut rests = V::load(&phases.sticking);
        if k < MOST_ZEROS {
            rests = rests.max(V::load(&phases.zeros) - V::splat(k as f64));
        }
        let slip = rests.where_positive(zero, slip);
        let scaled = slip * inverse_scale;
        self.series.slip[k] = slip;
        self.series.scaled[k] = scaled;
        let mut friction = zero;
        if phases.any_slips {
            let force = if k == 0 {
                branch.first() * self.numbers.pressed
            } else {
                // The newest coefficient of γ waits for one operation only.
                drag.mul_add(slip, branch.lower(k, &self.series.scaled) * self.numbers.pressed)
            };
            friction = V::load(&phases.slipping).where_positive(force, zero);
            rates = self.acted(rates, friction);
        }
        if phases.any_sticks {
            let force = self.held(k, rates);
            rates = self.acted(rates, force);
            friction = V::load(&phases.sticking).where_positive(force, friction);
        }
        self.series.friction[k] = friction;
        let inverse = V::splat(RECIPROCALS[k + 1]);
        self.series.displacements[k + 1] = velocity * inverse;
        self.series.velocities[k + 1] = rates * inverse;
    }

    /// ẍ of order k without friction.
    #[inline(always)]
    fn free_rates(&self, k: usize) -> V {
        let PlainNumbers { columns, constant, pushes, .. } = self.numbers;
        let mut rates = V::splat(0.0);
        let (displacement, velocity) = (self.series.displacements[k], self.series.velocities[k]);
        for j in 0..N {
            rates = columns[j].mul_add(spread::<V, N>(displacement, j), rates);
        }
        for j in 0..N {
            rates = columns[MOST + j].mul_add(spread::<V, N>(velocity, j), rates);
        }
        if k == 0 {
            rates = rates + *constant;
        }
        let (first, others) = pushes;
        rates = first.mul_add(self.pushes.0[k], rates);
        for (push, series) in others.iter().zip(&self.pushes.1) {
            rates = push.mul_add(series[k], rates);
        }
        rates
    }

    /// Rates with the friction of the contacts, one after the other.
    #[inline(always)]
    fn acted(&self, mut rates: V, friction: V) -> V {
        for place in 0..N {
            rates = self.numbers.along[place].mul_add(spread::<V, N>(friction, place), rates);
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
            force = self.numbers.gains[place].mul_add(spread::<V, N>(lost, place), force);
        }
        force
    }

    /// Length over which the last retained terms stay below the tolerance.
    #[inline(always)]
    fn length(&mut self, branch: &impl BranchSeries<V>) -> V {
        let zero = V::splat(0.0);
        let (mut last, mut previous) = (zero, zero);
        let PlainSeries { displacements, velocities, friction, scaled, .. } = &*self.series;
        let StepLimit { tolerance, time_scale, longest, room } = self.limit;
        for (states, kept) in [displacements, velocities].into_iter().zip(self.scales.iter_mut()) {
            let terms = [states[0], states[1], states[2], states[3], states[4]];
            let inverse = with_scale(kept, time_scale, &terms);
            last = (states[ORDER].abs() * inverse).max(last);
            previous = (states[ORDER - 1].abs() * inverse).max(previous);
        }
        if self.phases.any_sticks {
            let PlainNumbers { static_coefficients: level, pressed, normal_loads, .. } =
                self.numbers;
            let scale = (*level * pressed.abs()).max(*level * *normal_loads);
            let sticking = V::load(&self.phases.sticking);
            last = share(friction[ORDER], scale, sticking).max(last);
            previous = share(friction[ORDER - 1], scale, sticking).max(previous);
        }
        let (last, previous) = (largest::<V, N>(last), largest::<V, N>(previous));
        let mut length = step_length(tolerance, last, previous, ORDER).min(longest).min(room);
        for place in 0..N {
            if self.phases.slips[place] {
                let slips = spread::<V, N>(V::load(&self.phases.slipping), place);
                let trusted = spread::<V, N>(branch.trusted(scaled, length), place);
                length = slips.where_positive(trusted, length);
            }
        }
        length
    }
}

impl<V: Lane> PlainSeries<V> {
    /// Writes the speed of a surface to the lane of its contact.
    #[inline(always)]
    pub(super) fn set_surface(&mut self, lane: usize, surface: &SeriesOf<f64>) {
        for (out, term) in self.surfaces.iter_mut().zip(surface) {
            out.set_lane(lane, *term);
        }
    }

    /// Positive in a lane where a guard may reach zero within `length`, as far as is known without halving the step. A run that is alone
    /// in a vector of two has its lower margins in the lanes of the second.
    #[inline(always)]
    pub(super) fn doubts(
        &self,
        numbers: &PlainNumbers<V>,
        phases: &PlainPhases,
        (length, is_alone): (V, bool),
    ) -> V {
        let (zero, one) = (V::splat(0.0), V::splat(1.0));
        let (zeros, sign) = (V::load(&phases.zeros), V::load(&phases.sign));
        let (slipping, sticking) = (V::load(&phases.slipping), V::load(&phases.sticking));
        if !phases.any_sticks {
            let proof = proof_of_no_root(&self.slip, zeros, sign, length, slipping);
            return slipping.where_positive(-proof, zero);
        }
        // Of a contact that sticks the margin above its bounds stands in the place of γ: at the upper one first, then at the lower one.
        let level = numbers.static_coefficients;
        let all = slipping.max(sticking);
        let mut doubts = zero;
        let both = V::load(&[1.0, 1.0, -1.0, -1.0]);
        let (at_once, in_turn) = ([(both, all)], [(one, all), (-one, sticking)]);
        let sides: &[(V, V)] = if is_alone { &at_once } else { &in_turn };
        for &(side, wanted) in sides {
            let mut guards = self.slip;
            for (k, (guard, friction)) in guards.iter_mut().zip(&self.friction).enumerate() {
                let pressed = if k == 0 { numbers.pressed } else { zero };
                let margin = level.mul_add(pressed, -(side * *friction));
                *guard = sticking.where_positive(margin, *guard);
            }
            let proof = proof_of_no_root(&guards, zeros, sign, length, wanted);
            doubts = doubts.max(wanted.where_positive(-proof, zero));
        }
        doubts
    }
}
