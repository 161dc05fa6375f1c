//! Passive observers of a run: they receive every smooth segment and every event, and change no bit of the result.

use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::lane::horner;
use quell_numerics::polynomial::first_crossing_after;

use super::clock::Clock;
use super::event::Event;
use super::taylor::ORDER;
use crate::sample_times::SampleTimes;

/// One smooth piece of a trajectory: a Taylor step of slip, or an interval of stick.
#[derive(Clone, Copy, Debug)]
pub struct Segment<'a> {
    pub(super) clock: Clock,
    pub(super) duration: f64,
    pub(super) slip_sign: i8,
    pub(super) unit: f64,
    /// v₀, not in `unit`.
    pub(super) belt_velocity: f64,
    /// Coefficients of x and of v_r, in `unit`.
    pub(super) displacement: &'a [f64],
    pub(super) slip: &'a [f64],
}

impl Segment<'_> {
    /// Its start, τ.
    #[inline(always)]
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// Its length, τ.
    #[inline(always)]
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// Sign of v_r; 0 in stick.
    #[inline(always)]
    pub fn slip_sign(&self) -> i8 {
        self.slip_sign
    }

    /// Coefficients of x and of v_r, in the unit of the engine.
    #[inline(always)]
    pub(crate) fn series(&self) -> (&[f64], &[f64]) {
        (self.displacement, self.slip)
    }

    /// Coefficients of v_r, and their unit.
    #[inline(always)]
    pub(crate) fn slip_series(&self) -> (&[f64], f64) {
        (self.slip, self.unit)
    }

    /// Displacement x at time `since` after its start, 0 ≤ `since` ≤ its duration: the series is inaccurate outside.
    pub fn displacement(&self, since: f64) -> f64 {
        self.unit * value_of(self.displacement, since)
    }

    /// [`Segment::displacement`] at N moments at once, for observers that are themselves compiled for
    /// the machine's best instruction set.
    #[inline(always)]
    pub(crate) fn displacements_at<const N: usize>(&self, since: &[f64; N]) -> [f64; N] {
        horner_at(self.displacement, since).map(|value| value * self.unit)
    }

    /// Velocity x′ at N moments, like [`Segment::displacements_at`].
    #[inline(always)]
    pub(crate) fn velocities_at<const N: usize>(&self, since: &[f64; N]) -> [f64; N] {
        self.slips_at(since).map(|slip| self.belt_velocity - slip)
    }

    /// Slip velocity v_r = v₀ − x′ at time `since` after its start, within the segment; 0 in stick.
    pub fn slip_velocity(&self, since: f64) -> f64 {
        self.unit * value_of(self.slip, since)
    }

    /// Velocity x′ at time `since` after its start, within the segment; exactly that of the belt in stick.
    pub fn velocity(&self, since: f64) -> f64 {
        self.belt_velocity - self.slip_velocity(since)
    }

    /// Slip velocity v_r at N moments, like [`Segment::displacements_at`].
    #[inline(always)]
    pub(crate) fn slips_at<const N: usize>(&self, since: &[f64; N]) -> [f64; N] {
        horner_at(self.slip, since).map(|value| value * self.unit)
    }
}

/// A Taylor polynomial at N moments at once.
#[inline(always)]
fn horner_at<const N: usize>(coefficients: &[f64], since: &[f64; N]) -> [f64; N] {
    let mut values = [0.0_f64; N];
    for &coefficient in coefficients.iter().rev() {
        for moment in 0..N {
            values[moment] = values[moment].mul_add(since[moment], coefficient);
        }
    }
    values
}

/// A Taylor polynomial at a moment, on the machine's best instruction set: observers are called
/// by the engine, not compiled into it.
struct SeriesValue<'a> {
    coefficients: &'a [f64],
    since: f64,
}

impl Work for SeriesValue<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        horner(self.coefficients, self.since)
    }
}

fn value_of(coefficients: &[f64], since: f64) -> f64 {
    with_fused_multiply_add(SeriesValue { coefficients, since })
}

/// Observes a run.
pub trait Observer {
    /// Called after a segment has been integrated.
    fn segment(&mut self, segment: &Segment<'_>) {
        let _ = segment;
    }

    /// Called after an event, which is at the end of the last segment.
    fn event(&mut self, event: &Event) {
        let _ = event;
    }

    /// Whether [`Observer::segment`] is to be called. Asked once, at the start of a run.
    fn watches(&self) -> bool {
        true
    }
}

impl Observer for () {
    fn watches(&self) -> bool {
        false
    }
}

impl<A: Observer, B: Observer> Observer for (A, B) {
    fn segment(&mut self, segment: &Segment<'_>) {
        self.0.segment(segment);
        self.1.segment(segment);
    }

    fn event(&mut self, event: &Event) {
        self.0.event(event);
        self.1.event(event);
    }

    fn watches(&self) -> bool {
        self.0.watches() || self.1.watches()
    }
}

/// Records every event.
#[derive(Clone, Debug, Default)]
pub struct EventRecorder {
    /// The events, in order.
    pub events: Vec<Event>,
}

impl Observer for EventRecorder {
    fn watches(&self) -> bool {
        false
    }

    fn event(&mut self, event: &Event) {
        self.events.push(*event);
    }
}

/// The state at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// τ.
    pub time: f64,
    /// x.
    pub displacement: f64,
    /// x′.
    pub velocity: f64,
    /// Whether the mass moves with the belt.
    pub sticking: bool,
}

/// Samples the state at τ₀ + nΔ for n = 0, 1, …, which is dense output or a stroboscopic Poincaré section with Δ = 2π/R. Samples are values of the Taylor polynomials of the steps, not interpolated.
#[derive(Clone, Debug)]
pub struct Sampler {
    times: SampleTimes,
    /// The samples, in order.
    pub samples: Vec<Sample>,
}

impl Sampler {
    /// `count` samples from `first`, `step` apart.
    pub fn new(first: f64, step: f64, count: usize) -> Self {
        Self { times: SampleTimes::Even { first, step, count }, samples: Vec::with_capacity(count) }
    }
}

impl Observer for Sampler {
    fn segment(&mut self, segment: &Segment<'_>) {
        while let Some(time) = self.times.get(self.samples.len()) {
            let since = segment.clock.until(time);
            if since > segment.duration {
                break;
            }
            // A sample at the very start of a run may round to just before it.
            let since = since.max(0.0);
            self.samples.push(Sample {
                time,
                displacement: segment.displacement(since),
                velocity: segment.velocity(since),
                sticking: segment.slip_sign == 0,
            });
        }
    }
}

/// Poincaré section in state space: the moments at which x′ crosses a level upwards, located as accurately as events.
#[derive(Clone, Debug)]
pub struct VelocitySection {
    level: f64,
    /// The crossings, in order.
    pub crossings: Vec<Sample>,
}

impl VelocitySection {
    /// Section x′ = `level`, upward crossings.
    pub fn upward(level: f64) -> Self {
        Self { level, crossings: Vec::new() }
    }
}

impl Observer for VelocitySection {
    fn segment(&mut self, segment: &Segment<'_>) {
        with_fused_multiply_add(CrossingSearch { section: self, segment });
    }
}

/// The search for crossings on one segment.
struct CrossingSearch<'a, 'b> {
    section: &'a mut VelocitySection,
    segment: &'a Segment<'b>,
}

impl Work for CrossingSearch<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { section, segment } = self;
        // level − x′ falls through zero at an upward crossing. Each crossing is divided out
        // by shifting the expansion to it, so that later ones on the segment are found too.
        let mut shifted = [0.0; ORDER + 1];
        shifted[..segment.slip.len()].copy_from_slice(segment.slip);
        shifted[0] -= segment.belt_velocity / segment.unit;
        shifted[0] += section.level / segment.unit;
        if shifted[0] == 0.0 {
            return;
        }
        each_crossing(&mut shifted, segment.duration, |since, upward| {
            if upward {
                section.crossings.push(Sample {
                    time: segment.clock.after(since).time(),
                    displacement: segment.displacement(since),
                    velocity: segment.velocity(since),
                    sticking: segment.slip_sign == 0,
                });
            }
        });
    }
}

/// Every moment up to `duration` at which a Taylor polynomial changes sign, in order, and whether it falls there.
/// Zeros at the start are divided out. The polynomial is overwritten.
#[inline(always)]
fn each_crossing(series: &mut [f64; ORDER + 1], duration: f64, mut found: impl FnMut(f64, bool)) {
    let mut zeros = series.iter().take_while(|coefficient| **coefficient == 0.0).count();
    let mut since = 0.0;
    let mut rest = duration;
    while zeros < series.len() && rest > 0.0 {
        let Some(root) = first_crossing_after(series, zeros, rest) else {
            break;
        };
        let falls = series[zeros] > 0.0;
        since += root;
        rest -= root;
        found(since, falls);
        shift(series, root);
        // The value is on the far side now, however it rounds at the root.
        series[0] = series[0].abs().max(f64::MIN_POSITIVE) * if falls { -1.0 } else { 1.0 };
        zeros = 0;
    }
}

/// Re-expands Σ cₖtᵏ about `by`.
#[inline(always)]
pub(crate) fn shift(c: &mut [f64], by: f64) {
    for start in 0..c.len() {
        for k in (start..c.len() - 1).rev() {
            c[k] = f64::mul_add(c[k + 1], by, c[k]);
        }
    }
}
