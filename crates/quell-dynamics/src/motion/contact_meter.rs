//! What every contact does on average: integrals of the Taylor series of a motion, without sampling.

use std::sync::LazyLock;

use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::gauss_legendre::GaussLegendre;

use super::observer::{MotionObserver, MotionSegment};
use super::phase::ContactPhase;
use crate::simulation::{ORDER, RECIPROCALS, Series, horner_at};

/// Nodes of the rule on a segment: it is exact for the product of two of its series.
const NODES: usize = ORDER + 1;

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
}

impl ContactMeter {
    /// A meter of a motion with `contacts` contacts.
    pub fn new(contacts: usize) -> Self {
        Self { length: 0.0, sums: vec![ContactSums::NONE; contacts] }
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
        with_fused_multiply_add(ContactsOnSegment { sums: &mut self.sums, segment });
    }
}

struct ContactsOnSegment<'a, 'b> {
    sums: &'a mut [ContactSums],
    segment: &'a MotionSegment<'b>,
}

impl Work for ContactsOnSegment<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
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
            sums.add_closed(segment, contact, &moments);
        }
    }
}

impl ContactSums {
    /// Friction and load of a closed contact, its largest slip speed, and the work of friction.
    #[inline(always)]
    fn add_closed(&mut self, segment: &MotionSegment<'_>, contact: usize, moments: &NodeTimes) {
        let duration = segment.duration();
        let (friction, load) = (segment.friction(contact), segment.normal_load(contact));
        self.friction += integral(friction, duration);
        if load[1..].iter().all(|term| *term == 0.0) {
            self.load += load[0] * duration;
            self.least_load = lesser(self.least_load, load[0]);
        } else {
            self.load += integral(load, duration);
            self.least_load = values_at(load, moments).into_iter().fold(self.least_load, lesser);
        }
        // The spring of an elastic slider that adheres takes and returns work.
        if segment.is_held(contact) {
            return;
        }
        let slips = values_at(segment.slip_velocity(contact), moments);
        if matches!(segment.phase(contact), ContactPhase::Slip(_)) {
            for slip in slips {
                if slip.abs() > self.largest_slip {
                    self.largest_slip = slip.abs();
                }
            }
        }
        let forces = values_at(friction, moments);
        let rule = RULE[1].iter().zip(forces.iter().zip(&slips));
        for (weight, (force, slip)) in rule {
            self.work = f64::mul_add(weight * duration, force * slip, self.work);
        }
    }
}

/// The lesser of two numbers, neither of which is NaN.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The nodes of the rule on a segment, and its ends.
type NodeTimes = [f64; MOMENTS];

/// A multiple of the moments of a group.
const MOMENTS: usize = 20;

/// As many moments as a vector holds.
const GROUP: usize = 4;

const _: () = assert!(MOMENTS >= NODES + 2, "the nodes and both ends");

/// The moments of a segment.
#[inline(always)]
fn moments_of(duration: f64) -> NodeTimes {
    let mut moments = [duration; MOMENTS];
    moments[NODES] = 0.0;
    for (moment, node) in moments.iter_mut().zip(&RULE[0]) {
        *moment = node * duration;
    }
    moments
}

/// A Taylor polynomial at all moments at once.
#[inline(always)]
fn values_at(series: &Series, moments: &NodeTimes) -> NodeTimes {
    let mut values = [0.0; MOMENTS];
    let (groups, _) = values.as_chunks_mut::<GROUP>();
    for (group, moments) in groups.iter_mut().zip(moments.as_chunks::<GROUP>().0) {
        *group = horner_at(series, moments);
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
