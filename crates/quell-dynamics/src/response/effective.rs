//! Effective friction measured on a trajectory (4.30), (4.31): means over one dither period.
//!
//! For a window [τ_i − π/R, τ_i + π/R] the mean slip velocity is exact, ⟨v_r⟩ = v₀ − (x(τ_i + π/R) − x(τ_i − π/R))R/(2π), and
//! the mean of f/N = μ(v_r) is integrated along the Taylor segments by Gauss–Legendre between neighbouring window
//! edges. Windows that contain stick (f/N is no function of v_r there) are dropped,
//! as in the dissertation.
//!
//! Purpose: a curve μ̄(v_r) that is independent of averaging. Limit: the slow velocity changes within one window;
//! [`WindowMean::drift`] reports by how much.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use quell_model::{Belt, Friction};
use quell_numerics::gauss_legendre::GaussLegendre;

use crate::simulation::{Observer, Segment, Stalled, Start, simulate};

/// Nodes and weights on [0, 1] of the rule for an interval.
static RULE: LazyLock<[[f64; 8]; 2]> = LazyLock::new(|| GaussLegendre::new(8).on_unit_interval());

/// Means over one dither period without stick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowMean {
    /// τ_i, the middle of the window.
    pub time: f64,
    /// ⟨v_r⟩ (4.31), a velocity.
    pub slip_velocity: f64,
    /// ⟨f/N⟩ (4.30), dimensionless.
    pub coefficient: f64,
    /// Change of the slow slip velocity across the window: ⟨v_r⟩ half a period later less half a period earlier. `None` at
    /// the ends of a run. (4.30) assumes it to be small.
    pub drift: Option<f64>,
}

/// Integrates `belt` from each start over `duration` and computes the means of all windows without stick, `per_period`
/// window edges (an even number, at least 2, or the next larger one) in each period 2π/`frequency_ratio`.
///
/// # Errors
/// [`Stalled`] if a run stops.
pub fn measured_effective_friction(
    belt: &Belt,
    frequency_ratio: f64,
    starts: &[Start],
    duration: f64,
    per_period: usize,
    tolerance: f64,
) -> Result<Vec<WindowMean>, Stalled> {
    let mut means = Vec::new();
    for &start in starts {
        let mut edges =
            EdgeRecorder::new(belt, start, frequency_ratio, per_period.max(1).div_ceil(2) * 2);
        simulate(belt, start, start.time + duration, tolerance, &mut edges)?;
        means.extend(edges.means());
    }
    Ok(means)
}

/// The integrals at a window edge, since the start of the run.
#[derive(Clone, Copy, Debug)]
struct WindowEdge {
    displacement: f64,
    /// ∫μ(v_r) dτ over slip.
    impulse: f64,
    /// Time spent in stick.
    stuck: f64,
}

/// Observer that records the integrals at equally spaced window edges.
#[derive(Clone, Debug)]
struct EdgeRecorder {
    law: Friction,
    belt_velocity: f64,
    start: f64,
    per_period: usize,
    period: f64,
    passed: Vec<WindowEdge>,
    now: WindowEdge,
}

impl EdgeRecorder {
    fn new(belt: &Belt, start: Start, frequency_ratio: f64, per_period: usize) -> Self {
        Self {
            law: belt.friction().clone(),
            belt_velocity: belt.belt_velocity(),
            start: start.time,
            per_period,
            period: TAU / frequency_ratio,
            passed: Vec::new(),
            now: WindowEdge { displacement: start.displacement, impulse: 0.0, stuck: 0.0 },
        }
    }

    fn time(&self, edge: usize) -> f64 {
        self.start + edge as f64 * self.period / self.per_period as f64
    }

    /// Adds the integrals between two moments of a segment.
    fn pass(&mut self, segment: &Segment<'_>, from: f64, to: f64) {
        if segment.slip_sign() == 0 {
            self.now.stuck += to - from;
            return;
        }
        let sign = f64::from(segment.slip_sign());
        let coefficient = |at: f64| {
            // v_r has the sign of the branch; the opposite sign next to an event is rounding.
            self.law.coefficient((sign * segment.slip_velocity(at)).max(0.0))
        };
        let [nodes, weights] = &*RULE;
        let at = |node: &f64| coefficient((to - from).mul_add(*node, from));
        let mean: f64 = nodes.iter().zip(weights).map(|(node, weight)| weight * at(node)).sum();
        self.now.impulse += sign * (to - from) * mean;
    }

    /// ⟨v_r⟩ of the window that begins at edge `first`.
    fn slip_velocity(&self, first: usize) -> Option<f64> {
        let (begin, end) = (self.passed.get(first)?, self.passed.get(first + self.per_period)?);
        Some(self.belt_velocity - (end.displacement - begin.displacement) / self.period)
    }

    fn means(&self) -> impl Iterator<Item = WindowMean> + '_ {
        let windows = self.passed.windows(self.per_period + 1);
        windows.enumerate().filter_map(|(first, window)| {
            let (begin, end) = (window[0], window[self.per_period]);
            (begin.stuck == end.stuck).then(|| WindowMean {
                time: self.time(first) + 0.5 * self.period,
                slip_velocity: self.slip_velocity(first).unwrap_or_default(),
                coefficient: (end.impulse - begin.impulse) / self.period,
                drift: first.checked_sub(self.per_period / 2).and_then(|before| {
                    Some(
                        self.slip_velocity(first + self.per_period / 2)?
                            - self.slip_velocity(before)?,
                    )
                }),
            })
        })
    }
}

impl Observer for EdgeRecorder {
    fn segment(&mut self, segment: &Segment<'_>) {
        let mut from = 0.0;
        loop {
            let to = segment.clock().until(self.time(self.passed.len()));
            if to > segment.duration() {
                break;
            }
            let to = to.max(0.0);
            self.pass(segment, from, to);
            self.now.displacement = segment.displacement(to);
            self.passed.push(self.now);
            from = to;
        }
        self.pass(segment, from, segment.duration());
    }
}
