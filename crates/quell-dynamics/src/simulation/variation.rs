//! The variational equation of a run, with a jump at every event.
//!
//! In slip a small change (ξ, η) of (x, x′) obeys
//!
//! ```text
//! ξ′ = η,   η′ = −ξ − (2ζ + μ′(v_r)N) η
//! ```
//!
//! At v_r = 0 it is multiplied by the saltation matrix I + (f₊ − f₋)nᵀ/(nᵀf₋), n = (0, 1):
//! a reversal gives diag(1, a₊/a₋) with the accelerations a on both sides, a stick diag(1, 0).
//!
//! A release happens on h = σf_s − μ_sN = 0, n = (σ, 0): with f₋ = (v₀, 0) and f₊ = (v₀, a₊), a₊ = −σ(μ_s − μ(0⁺))N, it adds
//! (a₊σ/ḣ)ξ to η, ḣ = σ(v₀ − Σ D_T g_T′) − μ_sN′ along the stick: where friction starts below its static level a
//! later release starts later by the same time. Where friction starts at that level, or where a jump of the dither releases
//! the contact at a fixed time, a release changes nothing.
//!
//! Scheme: Gauss–Legendre collocation with 8 nodes, of order 16 like the Taylor step that provides the series for μ′.

use quell_model::{Belt, Direction};
use quell_numerics::dispatch::{Work, with_fused_multiply_add};

use super::collocation::{COLLOCATION, NODES, forces, least_of, weighted};
use super::event::{Event, EventKind};
use super::observer::{Observer, Segment};
use crate::contraction::rates_along;

/// A 2 × 2 matrix, row by row.
pub type Matrix2 = [[f64; 2]; 2];

/// Integrates the matrix of changes along a run.
#[derive(Clone, Debug)]
pub struct Variation<'a> {
    belt: &'a Belt,
    /// Derivative of the final state with respect to the initial state.
    pub matrix: Matrix2,
    /// ∫(2ζ + μ′N) over slip.
    pub damping: f64,
    /// Events in order, with the sign of v_r afterwards.
    pub events: Vec<(EventKind, i8)>,
    /// Least slip velocity in the direction of slip, and its time.
    pub least: Option<(f64, f64)>,
    /// Time spent in stick.
    pub stuck: f64,
    sign: i8,
}

impl<'a> Variation<'a> {
    /// Of a run that begins.
    pub fn new(belt: &'a Belt) -> Self {
        Self {
            belt,
            matrix: [[1.0, 0.0], [0.0, 1.0]],
            damping: 0.0,
            events: Vec::new(),
            least: None,
            stuck: 0.0,
            sign: 0,
        }
    }

    /// x″ at v_r = 0 on the branch of a sign.
    fn acceleration(&self, event: &Event, sign: i8) -> f64 {
        let friction = self.belt.friction().coefficient(0.0) * self.belt.normal_load_at(event.time);
        f64::from(sign) * friction
            - 2.0 * self.belt.damping_ratio() * self.belt.belt_velocity()
            - event.displacement
            + self.belt.dither_force(Direction::Tangential, event.time)
    }
}

/// A dither jumps at a break if its values just before and after differ by more than this fraction of its amplitude.
const JUMP: f64 = 1e-3;

impl Variation<'_> {
    /// η after a release per ξ before it.
    fn release(&self, event: &Event) -> f64 {
        let belt = self.belt;
        let law = belt.friction();
        if law.starts_at_static_level() || is_at_jump(belt, event.time) {
            return 0.0;
        }
        let sign = f64::from(event.slip_sign);
        let growth = sign
            * (belt.belt_velocity() - dither_rates(belt, Direction::Tangential, event.time))
            - law.static_coefficient() * dither_rates(belt, Direction::Normal, event.time);
        let jump =
            (law.static_coefficient() - law.coefficient(0.0)) * belt.normal_load_at(event.time);
        // a₊σ/ḣ with a₊ = −σ jump.
        -jump / growth
    }
}

/// Distance from a moment, in radians of each dither, at which a jump is detected.
const ASIDE: f64 = 1e-6;

/// Whether a dither jumps at a moment.
fn is_at_jump(belt: &Belt, time: f64) -> bool {
    belt.dithers().iter().any(|dither| {
        let phase = f64::mul_add(dither.frequency_ratio, time, dither.phase);
        let waveform = &dither.waveform;
        let change = waveform.value(phase + ASIDE) - waveform.value(phase - ASIDE);
        dither.amplitude > 0.0 && change.abs() > JUMP
    })
}

/// Σ D R g′ of one direction.
fn dither_rates(belt: &Belt, direction: Direction, time: f64) -> f64 {
    belt.dithers_along(direction)
        .map(|dither| {
            let phase = f64::mul_add(dither.frequency_ratio, time, dither.phase);
            dither.amplitude * dither.frequency_ratio * dither.waveform.slope(phase)
        })
        .sum()
}

/// A segment of slip along which the changes are integrated.
struct Along<'v, 'b, 's, 'c> {
    variation: &'v mut Variation<'b>,
    segment: &'s Segment<'c>,
    /// |v_r| and the rate at the nodes.
    speeds: [f64; NODES],
    rates: [f64; NODES],
}

impl Work for Along<'_, '_, '_, '_> {
    type Output = ();

    #[expect(
        clippy::needless_range_loop,
        reason = "small matrices by their indices, as in the formula"
    )]
    #[inline(always)]
    fn run(self) {
        let Along { variation, segment, speeds, rates } = self;
        let rule = &*COLLOCATION;
        let h = segment.duration();
        let sign = f64::from(segment.slip_sign());
        let (slip, unit) = segment.slip_series();
        variation.damping += h * weighted(rule, &rates);
        let [upper, lower] = variation.matrix;
        let force = forces(rule, &rates, h, [upper[0], upper[1]], [lower[0], lower[1]]);
        for column in 0..2 {
            let mut velocity = [lower[column]; NODES];
            for i in 0..NODES {
                for j in 0..NODES {
                    velocity[i] = (h * rule.integrals[i][j]).mul_add(force[column][j], velocity[i]);
                }
            }
            variation.matrix[0][column] += h * weighted(rule, &velocity);
            variation.matrix[1][column] += h * weighted(rule, &force[column]);
        }
        if let Some((least, since)) = least_of(rule, slip, sign * unit, h, &speeds)
            && variation.least.is_none_or(|known| least < known.0)
        {
            variation.least = Some((least, segment.clock().time() + since));
        }
    }
}

impl Observer for Variation<'_> {
    fn segment(&mut self, segment: &Segment<'_>) {
        self.sign = segment.slip_sign();
        if self.sign == 0 {
            self.stuck += segment.duration();
            // A run that begins in stick begins on v_r = 0: a change of velocity is lost at once.
            self.matrix[1] = [0.0; 2];
        } else {
            let since = COLLOCATION.nodes.map(|node| node * segment.duration());
            let (speeds, rates) = rates_along(self.belt, segment, &since);
            with_fused_multiply_add(Along { variation: self, segment, speeds, rates });
        }
    }

    fn event(&mut self, event: &Event) {
        let factor = match event.kind {
            EventKind::Stick => 0.0,
            EventKind::Release | EventKind::Separation | EventKind::Landing => 1.0,
            EventKind::Reversal => {
                self.acceleration(event, event.slip_sign) / self.acceleration(event, self.sign)
            }
        };
        let gain = if event.kind == EventKind::Release { self.release(event) } else { 0.0 };
        for column in 0..2 {
            let change = self.matrix[0][column];
            self.matrix[1][column] = factor * self.matrix[1][column] + gain * change;
        }
        self.events.push((event.kind, event.slip_sign));
    }
}
