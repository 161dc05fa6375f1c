//! Effective friction measured on a trajectory (4.30), (4.31): means over one dither period.
//!
//! For a window [τ_i − π/R, τ_i + π/R] the mean slip velocity is exact, ⟨v_r⟩ = v₀ − (x(τ_i + π/R) − x(τ_i − π/R))R/(2π), and
//! the mean of f/N is integrated piece by piece between neighbouring window edges: in slip f/N = μ(v_r) along the Taylor segments
//! by Gauss–Legendre, in stick f/N = (2ζv₀ + x − Σ D_T g_T)/N by adaptive quadrature. (4.30) holds "regardless of the system
//! stick/slip state"; each window reports the fraction of it that sticks, so that a caller can drop such windows.
//!
//! Purpose: a curve μ̄(v_r) that is independent of averaging. There are two readings of it:
//! * [`measured_effective_friction`]: windows along transients. Limit: the slow velocity changes within one window;
//!   [`WindowMean::drift`] reports by how much.
//! * [`steady_effective_friction`]: the response with the dither's own period on a belt of the slip velocity in question. Its slow
//!   velocity is exactly zero, so that ⟨v_r⟩ is exactly the belt velocity. The response need not be stable.

use std::f64::consts::{PI, TAU};
use std::fmt;
use std::sync::LazyLock;

use quell_model::{Belt, Direction, Dither, System};
use quell_numerics::gauss_legendre::GaussLegendre;
use quell_numerics::quadrature::{QuadratureError, QuadratureOptions, integrate};

use crate::attractor::{MotionKind, end_of_run};
use crate::orbit::{
    BASE_STEPS, NoOrbit, Orbit, OrbitVerdict, base_response, near, verdict_of_sliding,
};
use crate::simulation::{Observer, Segment, Stalled, Start, simulate};

/// Nodes and weights on [0, 1] of the rule for an interval.
static RULE: LazyLock<[[f64; 8]; 2]> = LazyLock::new(|| GaussLegendre::new(8).on_unit_interval());

/// Accuracy of an integral over stick. The waveforms are smooth between a few breaks, which halving finds.
const STICK: QuadratureOptions =
    QuadratureOptions { relative: 1e-10, absolute: 1e-13, panels: 1, evaluations: 20_000 };

/// Means over one dither period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowMean {
    /// τ_i, the middle of the window.
    pub time: f64,
    /// ⟨v_r⟩ (4.31), a velocity.
    pub slip_velocity: f64,
    /// ⟨f/N⟩ (4.30), dimensionless.
    pub coefficient: f64,
    /// Fraction of the window spent in stick.
    pub stick_fraction: f64,
    /// Change of the slow slip velocity across the window: ⟨v_r⟩ half a period later less half a period earlier. `None` at
    /// the ends of a run. (4.30) assumes it to be small.
    pub drift: Option<f64>,
}

/// Integrates `belt` from each start over `duration` and computes the means of all windows, `per_period` (an even number, at least 2, or the next larger one) in each period 2π/`frequency_ratio`.
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
        let edges_per_period = per_period.max(1).div_ceil(2) * 2;
        let mut edges = EdgeRecorder::new(belt, start, TAU / frequency_ratio, edges_per_period);
        simulate(belt, start, start.time + duration, tolerance, &mut edges)?;
        means.extend(edges.means());
    }
    Ok(means)
}

/// The integrals at a window edge, since the start of the run.
#[derive(Clone, Copy, Debug)]
struct WindowEdge {
    displacement: f64,
    /// ∫f/N dτ.
    impulse: f64,
    /// Time spent in stick.
    stuck: f64,
}

/// Observer that records the integrals at equally spaced window edges.
#[derive(Clone, Debug)]
struct EdgeRecorder {
    belt: Belt,
    start: f64,
    per_period: usize,
    period: f64,
    passed: Vec<WindowEdge>,
    now: WindowEdge,
}

impl EdgeRecorder {
    fn new(belt: &Belt, start: Start, period: f64, per_period: usize) -> Self {
        Self {
            belt: belt.clone(),
            start: start.time,
            per_period,
            period,
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
            self.now.impulse += self.stick_impulse(segment, from, to);
            return;
        }
        let sign = f64::from(segment.slip_sign());
        let coefficient = |at: f64| {
            // v_r has the sign of the branch; the opposite sign next to an event is rounding.
            self.belt.friction().coefficient((sign * segment.slip_velocity(at)).max(0.0))
        };
        let [nodes, weights] = &*RULE;
        let at = |node: &f64| coefficient((to - from).mul_add(*node, from));
        let mean: f64 = nodes.iter().zip(weights).map(|(node, weight)| weight * at(node)).sum();
        self.now.impulse += sign * (to - from) * mean;
    }

    /// ∫f_s/N dτ between two moments of stick. |f_s| ≤ μ_s N, so that the ratio is bounded where the load vanishes.
    fn stick_impulse(&self, segment: &Segment<'_>, from: f64, to: f64) -> f64 {
        let belt = &self.belt;
        let most = belt.friction().static_coefficient();
        let damper = 2.0 * belt.damping_ratio() * belt.belt_velocity();
        let ratio = |since: f64| {
            let time = segment.clock().after(since).time();
            let dither = belt.dither_force(Direction::Tangential, time);
            let force = damper + segment.displacement(since) - dither;
            let load = belt.normal_load_at(time);
            if load > 0.0 { (force / load).clamp(-most, most) } else { 0.0 }
        };
        match integrate(ratio, from, to, &[], &STICK) {
            Ok(found) => found.value,
            // The best value that was reached; the integrand is bounded and no longer than a part of a period.
            Err(QuadratureError::Rounding { best } | QuadratureError::Evaluations { best }) => {
                best.value
            }
            Err(_) => f64::NAN,
        }
    }

    /// ⟨v_r⟩ of the window that begins at edge `first`.
    fn slip_velocity(&self, first: usize) -> Option<f64> {
        let (begin, end) = (self.passed.get(first)?, self.passed.get(first + self.per_period)?);
        Some(self.belt.belt_velocity() - (end.displacement - begin.displacement) / self.period)
    }

    fn means(&self) -> impl Iterator<Item = WindowMean> + '_ {
        let windows = self.passed.windows(self.per_period + 1);
        windows.enumerate().map(|(first, window)| {
            let (begin, end) = (window[0], window[self.per_period]);
            WindowMean {
                time: self.time(first) + 0.5 * self.period,
                slip_velocity: self.slip_velocity(first).unwrap_or_default(),
                coefficient: (end.impulse - begin.impulse) / self.period,
                stick_fraction: (end.stuck - begin.stuck) / self.period,
                drift: first.checked_sub(self.per_period / 2).and_then(|before| {
                    Some(
                        self.slip_velocity(first + self.per_period / 2)?
                            - self.slip_velocity(before)?,
                    )
                }),
            }
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

/// Effective friction of a steady response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyFriction {
    /// ⟨f/N⟩ (4.30) with the sign of the force, dimensionless.
    pub coefficient: f64,
    /// Fraction of the period spent in stick.
    pub stick_fraction: f64,
    /// Stability of the response on which it is measured, with the damping and the load of the belt.
    pub verdict: OrbitVerdict,
    /// Whether the response continues steady sliding; otherwise it is the one of the dither's period on which a run from steady
    /// sliding ends.
    pub base: bool,
}

/// Window edges in a period of a steady response: a piece of stick between them is short.
const STEADY_EDGES: usize = 16;

/// Why there is no steady response whose friction is measured.
#[derive(Clone, Debug, PartialEq)]
pub enum NoSteadyFriction {
    /// The surface cannot move at this slip velocity.
    Invalid {
        /// The slip velocity.
        slip_velocity: f64,
    },
    /// At a negative slip velocity a tangential burst would have to change its sign, which is no burst.
    NoMirror,
    /// The response does not exist or was not found.
    NoOrbit(NoOrbit),
    /// The engine stopped.
    Stalled(Stalled),
}

impl fmt::Display for NoSteadyFriction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Invalid { slip_velocity } => {
                write!(f, "the surface cannot move at a slip velocity of {slip_velocity}")
            }
            Self::NoMirror => f.write_str(
                "a burst is no burst after a change of sign, which a negative slip velocity needs",
            ),
            Self::NoOrbit(why) => why.fmt(f),
            Self::Stalled(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoSteadyFriction {}

/// Effective friction (4.30) at a mean slip velocity (4.31), without averaging: the belt moves at `slip_velocity`, and f/N is
/// averaged over the period of the response that continues steady sliding as the dither grows, or where that does not exist, of
/// the one of the same period on which a run from steady sliding ends. Stick counts. A negative slip
/// velocity is the mirror image: displacements and tangential forces change sign. Without dither it is the law itself.
///
/// # Errors
/// [`NoSteadyFriction`] where that response does not exist or is not found, dithers have no common period, or the slip velocity is 0 or not
/// a number.
pub fn steady_effective_friction(
    belt: &Belt,
    slip_velocity: f64,
    tolerance: f64,
) -> Result<SteadyFriction, NoSteadyFriction> {
    let belt = moving_at(belt, slip_velocity)?;
    if belt.total_amplitude(Direction::Tangential) + belt.total_amplitude(Direction::Normal) == 0.0
    {
        return Ok(SteadyFriction {
            coefficient: belt.friction().coefficient(slip_velocity.abs()) * slip_velocity.signum(),
            stick_fraction: 0.0,
            verdict: verdict_of_sliding(&belt),
            base: true,
        });
    }
    let system = belt.system();
    let (orbit, base) = match base_response(&system, BASE_STEPS) {
        Ok(orbit) => (orbit, true),
        Err(why) => {
            let reached = reached_in_step(&system, belt.steady_sliding());
            (reached.ok_or(NoSteadyFriction::NoOrbit(why))?, false)
        }
    };
    let (start, period) = (Start::of_state(&orbit.state), orbit.period);
    let mut edges = EdgeRecorder::new(&belt, start, period, STEADY_EDGES);
    // A little longer, so that the last edge is passed.
    simulate(&belt, start, period * (1.0 + 1e-9), tolerance, &mut edges)
        .map_err(NoSteadyFriction::Stalled)?;
    let none = NoSteadyFriction::Invalid { slip_velocity };
    let window = edges.means().next().ok_or(none)?;
    Ok(SteadyFriction {
        coefficient: window.coefficient * slip_velocity.signum(),
        stick_fraction: window.stick_fraction,
        verdict: orbit.verdict(),
        base,
    })
}

/// The response of the dither's period on which a run from steady sliding ends, if it ends on one.
fn reached_in_step(system: &System, sliding: f64) -> Option<Orbit> {
    let end = end_of_run(system, &[1.0], &[sliding, 0.0]).ok()?.attractor;
    let MotionKind::Periodic { periods: 1, .. } = end.kind else { return None };
    near(system, &end.state, 1).ok()
}

/// The belt with this slip velocity in steady sliding, reflected where it is negative: tangential dither changes its sign, by
/// half a period of a waveform with g(s + π) = −g(s), by −g of another one. A burst has no −g.
fn moving_at(belt: &Belt, slip_velocity: f64) -> Result<Belt, NoSteadyFriction> {
    if slip_velocity == 0.0 {
        return Err(NoSteadyFriction::Invalid { slip_velocity });
    }
    let mirrored = |dither: &Dither| {
        if slip_velocity > 0.0 || dither.direction == Direction::Normal {
            return Some(dither.clone());
        }
        if dither.waveform.is_symmetric() {
            return Some(Dither { phase: dither.phase + PI, ..dither.clone() });
        }
        let waveform = dither.waveform.negated()?;
        Some(Dither { waveform, ..dither.clone() })
    };
    let dithers: Option<Vec<Dither>> = belt.dithers().iter().map(mirrored).collect();
    Belt::new(
        belt.damping_ratio(),
        belt.normal_load(),
        slip_velocity.abs(),
        belt.friction().clone(),
        dithers.ok_or(NoSteadyFriction::NoMirror)?,
    )
    .map_err(|_| NoSteadyFriction::Invalid { slip_velocity })
}
