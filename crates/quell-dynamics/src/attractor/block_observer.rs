//! Observation of a block of periods: the section, the sticks, and the contraction of areas.
//!
//! In slip an area of nearby states shrinks at the rate 2ζ + μ′(v_r)N; a reversal multiplies it by a₊/a₋, a stick by zero. On
//! a closed curve that is filled quasi-periodically the exponent along the curve is zero, so that the transverse exponent
//! is minus the mean rate: a curve attracts if and only if that mean is positive. A run that dwells near an unstable
//! curve between two basins appears settled, and this mean identifies it.

use std::sync::LazyLock;

use quell_model::Belt;
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::gauss_legendre::GaussLegendre;

use super::average::{Moments, Sums, bump};
use crate::contraction::mean_rate;
use crate::simulation::{Event, EventKind, Observer, Sampler, Segment};

/// Quadrature nodes of a segment for the rate: accurate to 10⁻⁶ of the rate on steps of the engine, where only its sign and size
/// matter. With fewer nodes the sign of a mean near zero would depend on the quadrature; more only take longer.
const NODES: usize = 5;

static RULE: LazyLock<[[f64; NODES]; 2]> =
    LazyLock::new(|| GaussLegendre::new(NODES).on_unit_interval());

/// Fraction of a segment over which an acceleration at its end is measured. With a larger value the curvature
/// would affect the ratio at a reversal; with a smaller one the difference of slip velocities would be rounding error.
const AT_END: f64 = 1e-5;

/// Quadrature nodes of a segment for averages of the state: accurate to 10⁻⁷ of the squares of the forced motion on steps that
/// cover four radians of it, because the slow motion of interest may be a hundred times smaller than the forced one. With fewer
/// nodes the error of the forced motion would be taken for a change of the slow one; more only take longer.
const STATES: usize = 6;

static STATES_RULE: LazyLock<[[f64; STATES]; 2]> =
    LazyLock::new(|| GaussLegendre::new(STATES).on_unit_interval());

/// Observes a block that starts at τ = 0.
pub(super) struct BlockObserver<'a> {
    sampler: Sampler,
    /// Samples per period.
    samples_per_period: usize,
    length: f64,
    sums: Sums,
    /// Time spent in stick.
    pub(super) stuck: f64,
    /// Number of times that the mass began to stick.
    pub(super) sticks: u64,
    contraction: Option<Contraction<'a>>,
}

impl<'a> BlockObserver<'a> {
    /// For `periods` of the section, one sample each.
    pub(super) fn new(period: f64, periods: usize) -> Self {
        Self::with_samples(period, periods, 1)
    }

    /// For `periods` of the section, with several samples per period.
    pub(super) fn with_samples(period: f64, periods: usize, samples_per_period: usize) -> Self {
        Self {
            sampler: Sampler::new(
                0.0,
                period / samples_per_period as f64,
                periods * samples_per_period,
            ),
            samples_per_period,
            length: periods as f64 * period,
            sums: Sums::default(),
            stuck: 0.0,
            sticks: 0,
            contraction: None,
        }
    }

    /// Also observes the contraction of areas.
    pub(super) fn with_contraction(mut self, belt: &'a Belt) -> Self {
        self.contraction = Some(Contraction::new(belt, self.length));
        self
    }

    /// Centre, size and shape of the motion, averaged over time: where the slow motion is nearly locked the section creeps
    /// along its curve, and so do the section's averages; the time averages are unaffected.
    pub(super) fn moments(&self) -> Moments {
        self.sums.moments()
    }

    /// The section, one state a period.
    pub(super) fn section(&self) -> Vec<(f64, f64)> {
        self.states().step_by(self.samples_per_period).collect()
    }

    /// The states of all samples.
    pub(super) fn states(&self) -> impl Iterator<Item = (f64, f64)> {
        self.sampler.samples.iter().map(|sample| (sample.displacement, sample.velocity))
    }

    /// Mean rate at which areas shrink, and its error, if it was observed.
    pub(super) fn contraction(&self) -> Option<(f64, f64)> {
        self.contraction.as_ref().map(Contraction::mean)
    }
}

impl Observer for BlockObserver<'_> {
    fn segment(&mut self, segment: &Segment<'_>) {
        self.sampler.segment(segment);
        let middle = segment.clock().time() + 0.5 * segment.duration();
        let weight = bump(middle / self.length);
        with_fused_multiply_add(Average { sums: &mut self.sums, segment, weight });
        if segment.slip_sign() == 0 {
            self.stuck += segment.duration();
        }
        if let Some(contraction) = &mut self.contraction {
            contraction.segment(segment);
        }
    }

    fn event(&mut self, event: &Event) {
        match event.kind {
            EventKind::Stick => self.sticks += 1,
            EventKind::Reversal => {
                if let Some(contraction) = &mut self.contraction {
                    contraction.reversed = true;
                }
            }
            EventKind::Release | EventKind::Separation | EventKind::Landing => {}
        }
    }
}

/// The states of one segment, on the machine's best instruction set.
struct Average<'a, 'b> {
    sums: &'a mut Sums,
    segment: &'a Segment<'b>,
    weight: f64,
}

impl Work for Average<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let [nodes, weights] = &*STATES_RULE;
        let h = self.segment.duration();
        let since = nodes.map(|node| node * h);
        let x = self.segment.displacements_at(&since);
        let v = self.segment.velocities_at(&since);
        for k in 0..STATES {
            self.sums.add(self.weight * h * weights[k], x[k], v[k]);
        }
    }
}

/// ∫(2ζ + μ′N)dτ − Σ ln|a₊/a₋|, weighted over the block and over each half of it.
struct Contraction<'a> {
    belt: &'a Belt,
    length: f64,
    /// Σ w·rate and Σ w·h of the block and of its halves.
    sums: [(f64, f64); 3],
    /// The acceleration of v_r at the end of the last segment, and whether a reversal followed.
    before: f64,
    reversed: bool,
}

impl<'a> Contraction<'a> {
    fn new(belt: &'a Belt, length: f64) -> Self {
        Self { belt, length, sums: [(0.0, 0.0); 3], before: 0.0, reversed: false }
    }

    fn segment(&mut self, segment: &Segment<'_>) {
        let h = segment.duration();
        let aside = AT_END * h;
        if self.reversed && aside > 0.0 {
            let after = segment.slip_velocity(aside) / aside;
            self.add(segment.clock().time(), -libm::log((after / self.before).abs()), 0.0);
        }
        self.reversed = false;
        let middle = segment.clock().time() + 0.5 * h;
        if segment.slip_sign() == 0 {
            self.add(middle, 0.0, h);
            return;
        }
        let mean = mean_rate(self.belt, segment, &RULE);
        self.add(middle, h * mean, h);
        if aside > 0.0 {
            self.before = segment.slip_velocity(h - aside) / -aside;
        }
    }

    fn add(&mut self, time: f64, amount: f64, duration: f64) {
        let fraction = time / self.length;
        let times = [fraction, 2.0 * fraction, 2.0 * fraction - 1.0];
        for (sum, t) in self.sums.iter_mut().zip(times) {
            let weight = bump(t);
            sum.0 += weight * amount;
            sum.1 += weight * duration;
        }
    }

    fn mean(&self) -> (f64, f64) {
        let [whole, first, second] = self.sums.map(|(sum, time)| sum / time);
        (whole, (first - second).abs())
    }
}
