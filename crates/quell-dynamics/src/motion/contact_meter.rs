//! What every contact does on average: integrals of the Taylor series of a motion, without sampling.

use std::sync::LazyLock;

use quell_numerics::dispatch::{InstructionSet, LaneWork, with_lanes};
use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::lane::{Lane, MOST_LANES};

use super::extremes::least;
use super::observer::{MotionObserver, MotionSegment, SegmentSeries};
use super::phase::ContactPhase;
use crate::simulation::{ORDER, RECIPROCALS, Series};

/// Nodes of the rule on a segment. It is exact up to degree 2·14 − 1 in the product of two series, each of which is cut at [`ORDER`]:
/// the terms of the product from there on are below those that the series leave out.
pub(super) const NODES: usize = 14;

const _: () = assert!(2 * NODES > ORDER + 1, "no term is lost that the series have");

/// Nodes and weights on [0, 1].
pub(super) static RULE: LazyLock<[[f64; NODES]; 2]> =
    LazyLock::new(|| GaussLegendre::new(NODES).on_unit_interval());

/// Means and extremes of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactMeans {
    /// Fraction of the time in stick.
    pub stick_fraction: f64,
    /// Fraction of the time during which it is open.
    pub open_fraction: f64,
    /// Mean of T; 0 while open.
    pub friction: f64,
    /// Mean of N; 0 while open.
    pub normal_load: f64,
    /// Mean of T γ, the power that friction dissipates.
    pub friction_power: f64,
    /// Least N; 0 if it was open.
    pub least_load: f64,
}

/// Integrals of one contact over a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ContactSums {
    stick: f64,
    open: f64,
    friction: f64,
    load: f64,
    work: f64,
    least_load: f64,
    largest_slip: f64,
}

impl ContactSums {
    const NONE: Self = Self {
        stick: 0.0,
        open: 0.0,
        friction: 0.0,
        load: 0.0,
        work: 0.0,
        least_load: f64::INFINITY,
        largest_slip: 0.0,
    };
}

/// Measures every contact of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactMeter {
    length: f64,
    sums: Vec<ContactSums>,
    set: InstructionSet,
}

impl ContactMeter {
    /// A meter of a motion with `contacts` contacts.
    pub fn new(contacts: usize) -> Self {
        let set = InstructionSet::widest();
        Self { length: 0.0, sums: vec![ContactSums::NONE; contacts], set }
    }

    /// The time measured so far.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The means of every contact; `None` if no time has been measured.
    pub fn means(&self) -> Option<Vec<ContactMeans>> {
        let length = self.length;
        let means = |sums: &ContactSums| ContactMeans {
            stick_fraction: sums.stick / length,
            open_fraction: sums.open / length,
            friction: sums.friction / length,
            normal_load: sums.load / length,
            friction_power: sums.work / length,
            least_load: sums.least_load,
        };
        (length > 0.0).then(|| self.sums.iter().map(means).collect())
    }

    /// The largest slip speed of a contact while it is closed, at the nodes and the ends of the segments.
    pub fn largest_slip(&self, contact: usize) -> f64 {
        self.sums[contact].largest_slip
    }
}

impl MotionObserver for ContactMeter {
    fn segment(&mut self, segment: &MotionSegment<'_>) {
        self.length += segment.duration();
        with_lanes(self.set, ContactsOnSegment { sums: &mut self.sums, segment });
    }
}

struct ContactsOnSegment<'a, 'b> {
    sums: &'a mut [ContactSums],
    segment: &'a MotionSegment<'b>,
}

impl LaneWork for ContactsOnSegment<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Lane>(self) {
        let Self { sums, segment } = self;
        let duration = segment.duration();
        let moments = moments_of(duration);
        for (contact, sums) in sums.iter_mut().enumerate() {
            match segment.phase(contact) {
                ContactPhase::Open => {
                    sums.open += duration;
                    sums.least_load = 0.0;
                    continue;
                }
                ContactPhase::Stick => sums.stick += duration,
                ContactPhase::Slip(_) => {}
            }
            sums.add_closed::<V>(segment, contact, &moments);
        }
    }
}

impl ContactSums {
    /// Friction and load of a closed contact, its largest slip speed, and the work of friction.
    #[inline(always)]
    fn add_closed<V: Lane>(&mut self, segment: &MotionSegment<'_>, contact: usize, at: &NodeTimes) {
        let duration = segment.duration();
        let load = segment.normal_load(contact);
        let loads = if load[1..].iter().all(|term| *term == 0.0) {
            self.load += load[0] * duration;
            self.least_load = lesser(self.least_load, load[0]);
            [load[0]; MOMENTS]
        } else {
            let loads = values_at::<V>(load, at);
            self.load = f64::mul_add(duration, mean_of(&loads), self.load);
            // A bound on the distance from the first value: most segments stay above the least so far.
            let terms = load[1..].iter().rev();
            let reach = terms.fold(0.0, |sum: f64, c| f64::mul_add(sum, duration, c.abs()));
            if f64::mul_add(-reach, duration, load[0]) < self.least_load {
                self.least_load = lesser(self.least_load, least(load, duration).0);
            }
            loads
        };
        // The spring of an elastic slider that adheres takes and returns work.
        if segment.is_held(contact) {
            let forces = values_at::<V>(segment.friction(contact), at);
            self.friction = f64::mul_add(duration, mean_of(&forces), self.friction);
            return;
        }
        let slips = values_at::<V>(segment.slip_velocity(contact), at);
        let mut forces = match segment.series {
            SegmentSeries::Known { .. } => values_at::<V>(segment.friction(contact), at),
            SegmentSeries::OfMass(piece) => piece.frictions_at(&slips, &loads),
        };
        self.friction = f64::mul_add(duration, mean_of(&forces), self.friction);
        if matches!(segment.phase(contact), ContactPhase::Slip(_)) {
            self.largest_slip =
                slips.iter().fold(self.largest_slip, |most, slip| greater(most, slip.abs()));
        }
        forces.iter_mut().zip(&slips).for_each(|(force, slip)| *force *= slip);
        self.work = f64::mul_add(duration, mean_of(&forces), self.work);
    }
}

/// The lesser of two numbers, neither of which is NaN.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The greater of two numbers, neither of which is NaN.
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The nodes of the rule on a segment, and its ends.
pub(super) type NodeTimes = [f64; MOMENTS];

/// As many as the widest lanes, or a multiple.
const MOMENTS: usize = MOST_LANES;

const _: () = assert!(MOMENTS == NODES + 2, "the nodes and both ends");

/// The nodes on [0, 1], and its ends, which have no weight.
static PLACES: LazyLock<NodeTimes> = LazyLock::new(|| with_ends(&RULE[0], [0.0, 1.0]));
static WEIGHTS: LazyLock<NodeTimes> = LazyLock::new(|| with_ends(&RULE[1], [0.0, 0.0]));

fn with_ends(of_nodes: &[f64; NODES], of_ends: [f64; 2]) -> NodeTimes {
    let mut all = [0.0; MOMENTS];
    all.iter_mut().zip(of_nodes.iter().chain(&of_ends)).for_each(|(all, number)| *all = *number);
    all
}

/// The nodes of the rule on a segment of this length, and its ends.
#[inline(always)]
pub(super) fn moments_of(duration: f64) -> NodeTimes {
    PLACES.map(|place| place * duration)
}

/// Mean over a segment of what is known at its moments.
#[inline(always)]
pub(super) fn mean_of(values: &NodeTimes) -> f64 {
    // Sums that do not wait for each other, the same ones in lanes of any width.
    let mut sums = [0.0; 4];
    let weights = WEIGHTS.as_chunks::<4>().0;
    for (values, weights) in values.as_chunks::<4>().0.iter().zip(weights) {
        for place in 0..4 {
            sums[place] = f64::mul_add(values[place], weights[place], sums[place]);
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// A Taylor polynomial at all moments.
#[inline(always)]
pub(super) fn values_at<V: Lane>(series: &Series, moments: &NodeTimes) -> NodeTimes {
    let mut values = [0.0; MOMENTS];
    let groups = values.chunks_exact_mut(V::LANES).zip(moments.chunks_exact(V::LANES));
    for (values, moments) in groups {
        let since = V::load(moments);
        let mut value = V::splat(0.0);
        for coefficient in series.iter().rev() {
            value = value.mul_add(since, V::splat(*coefficient));
        }
        value.store(values);
    }
    values
}

/// Integral of a series from 0 to `duration`.
#[inline(always)]
pub(super) fn integral(series: &[f64; ORDER + 1], duration: f64) -> f64 {
    let mut sum = 0.0;
    for (coefficient, inverse) in series.iter().zip(&RECIPROCALS[1..]).rev() {
        sum = f64::mul_add(sum, duration, coefficient * inverse);
    }
    sum * duration
}
