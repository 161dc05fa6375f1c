//! What every contact does on average: integrals of the Taylor series of a motion, without sampling.

use std::sync::LazyLock;

use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::lane::horner;

use super::observer::{MotionObserver, MotionSegment};
use super::phase::ContactPhase;
use crate::simulation::ORDER;

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
        for (contact, sums) in self.sums.iter_mut().enumerate() {
            match self.segment.phase(contact) {
                ContactPhase::Open => {
                    sums.open += self.segment.duration();
                    sums.least_load = 0.0;
                    continue;
                }
                ContactPhase::Stick => sums.stick += self.segment.duration(),
                ContactPhase::Slip(_) => sums.add_slip(self.segment, contact),
            }
            sums.add_forces(self.segment, contact);
        }
    }
}

impl ContactSums {
    /// Friction and load of a closed contact, and the work of friction.
    #[inline(always)]
    fn add_forces(&mut self, segment: &MotionSegment<'_>, contact: usize) {
        let duration = segment.duration();
        let (friction, load) = (segment.friction(contact), segment.normal_load(contact));
        let slip = segment.slip_velocity(contact);
        // The spring of an elastic slider that adheres takes and returns work.
        let moves = !segment.is_held(contact);
        self.friction += integral(friction, duration);
        self.load += integral(load, duration);
        self.least_load = self.least_load.min(horner(load, 0.0)).min(horner(load, duration));
        let [nodes, weights] = &*RULE;
        for (node, weight) in nodes.iter().zip(weights) {
            let since = node * duration;
            self.least_load = self.least_load.min(horner(load, since));
            if moves {
                let power = horner(friction, since) * horner(slip, since);
                self.work = f64::mul_add(weight * duration, power, self.work);
            }
        }
    }

    #[inline(always)]
    fn add_slip(&mut self, segment: &MotionSegment<'_>, contact: usize) {
        let slip = segment.slip_velocity(contact);
        let moments = RULE[0].iter().copied().chain([0.0, 1.0]);
        self.largest_slip = moments
            .map(|moment| horner(slip, moment * segment.duration()).abs())
            .fold(self.largest_slip, f64::max);
    }
}

/// Integral of a series from 0 to `duration`.
#[inline(always)]
pub(super) fn integral(series: &[f64; ORDER + 1], duration: f64) -> f64 {
    let mut sum = 0.0;
    for (k, coefficient) in series.iter().enumerate().rev() {
        sum = f64::mul_add(sum, duration, coefficient / (k + 1) as f64);
    }
    sum * duration
}
