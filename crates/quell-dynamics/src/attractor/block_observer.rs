//! What is seen of a block of periods: the section, sticks, and how fast areas shrink.
//!
//! In slip an area of nearby states shrinks with the rate 2ζ + μ′(v_r)N; a reversal multiplies it by a₊/a₋, a stick by zero. On
//! a closed curve that is filled quasi-periodically one exponent is zero along the curve, so that the other one, across
//! it, is minus the mean rate: a curve attracts if and only if that mean is positive. A run that dwells beside an unstable
//! curve between two basins looks settled, and this mean tells it apart.

use std::sync::LazyLock;

use quell_model::Belt;
use quell_numerics::dispatch::{Work, with_fused_multiply_add};
use quell_numerics::gauss_legendre::GaussLegendre;

use super::average::{Moments, Sums, bump};
use crate::contraction::mean_rate;
use crate::simulation::{Event, EventKind, Observer, Sampler, Segment};

/// Nodes of a segment: 10⁻⁶ of the rate on steps of the engine, where only its sign and size are asked for.
const NODES: usize = 5;

static RULE: LazyLock<[[f64; NODES]; 2]> =
    LazyLock::new(|| GaussLegendre::new(NODES).on_unit_interval());

/// Share of a segment over which an acceleration at its end is measured.
const BESIDE: f64 = 1e-5;

/// Nodes of a segment over which states are averaged: 10⁻⁷ of the forced motion's squares on steps that cover four radians
/// of them, for a slow motion may be a hundred times smaller than the forced one and is what is asked for.
const STATES: usize = 6;

static STATES_RULE: LazyLock<[[f64; STATES]; 2]> =
    LazyLock::new(|| GaussLegendre::new(STATES).on_unit_interval());

/// Watches a block that starts at τ = 0.
pub(super) struct Watch<'a> {
    sampler: Sampler,
    /// Samples a period.
    looks: usize,
    length: f64,
    sums: Sums,
    /// Time spent in stick.
    pub(super) stuck: f64,
    /// Number of times that the mass began to stick.
    pub(super) sticks: u64,
    contraction: Option<Contraction<'a>>,
}

impl<'a> Watch<'a> {
    /// A watch over `periods` of the strobe.
    pub(super) fn new(period: f64, periods: usize) -> Self {
        Self::looking(period, periods, 1)
    }

    /// The same with so many looks a period.
    pub(super) fn looking(period: f64, periods: usize, looks: usize) -> Self {
        Self {
            sampler: Sampler::new(0.0, period / looks as f64, periods * looks),
            looks,
            length: periods as f64 * period,
            sums: Sums::default(),
            stuck: 0.0,
            sticks: 0,
            contraction: None,
        }
    }

    /// The same with the contraction of area.
    pub(super) fn with_contraction(mut self, belt: &'a Belt) -> Self {
        self.contraction = Some(Contraction::new(belt, self.length));
        self
    }

    /// Centre, size and shape of the motion, averaged over time: where the slow motion is nearly locked the section creeps
    /// along its curve, and its own averages with it; these do not mind.
    pub(super) fn moments(&self) -> Moments {
        self.sums.moments()
    }

    /// The section, one state a period.
    pub(super) fn section(&self) -> Vec<(f64, f64)> {
        self.states().step_by(self.looks).collect()
    }

    /// The states of all looks.
    pub(super) fn states(&self) -> impl Iterator<Item = (f64, f64)> {
        self.sampler.samples.iter().map(|sample| (sample.displacement, sample.velocity))
    }

    /// Mean rate at which areas shrink, and its error, where it was watched.
    pub(super) fn contraction(&self) -> Option<(f64, f64)> {
        self.contraction.as_ref().map(Contraction::mean)
    }
}

impl Observer for Watch<'_> {
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
            EventKind::Release => {}
        }
    }
}

/// The states of one segment, with the machine's best instructions.
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
        let beside = BESIDE * h;
        if self.reversed && beside > 0.0 {
            let after = segment.slip_velocity(beside) / beside;
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
        if beside > 0.0 {
            self.before = segment.slip_velocity(h - beside) / -beside;
        }
    }

    fn add(&mut self, time: f64, amount: f64, duration: f64) {
        let place = time / self.length;
        for (sum, t) in self.sums.iter_mut().zip([place, 2.0 * place, 2.0 * place - 1.0]) {
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
