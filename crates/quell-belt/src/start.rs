//! Where a run starts: at rest, sliding, squealing, or at a given state.

use std::fmt;

use quell_model::Belt;

use crate::response::Solver;
use crate::simulation::{
    EventKind, EventRecorder, Sampler, Stalled, Start, VelocitySection, simulate,
};

/// The state in which a study starts, at τ = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum InitialState {
    /// x = 0, x′ = 0.
    #[default]
    Rest,
    /// Steady sliding without dither: x = μ(v₀)F, x′ = 0.
    Sliding,
    /// On the limit cycle of the undithered belt, at the moment of its release (or, where the
    /// cycle never sticks, at its smallest displacement).
    Squealing,
    /// A given state.
    Explicit {
        /// x(0).
        displacement: f64,
        /// x′(0).
        velocity: f64,
    },
}

/// Why there is no squealing start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoSquealingStart {
    /// The undithered belt, released from its static threshold, settles to steady sliding.
    SettlesToSliding,
    /// v₀ = 0: nothing moves the mass.
    BeltAtRest,
    /// The engine stopped.
    Stalled(Stalled),
}

impl fmt::Display for NoSquealingStart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SettlesToSliding => f.write_str(
                "the undithered belt has no limit cycle here: released from its static threshold \
                 it settles to steady sliding",
            ),
            Self::BeltAtRest => f.write_str("the belt does not move (v₀ = 0), so nothing squeals"),
            Self::Stalled(stalled) => stalled.fmt(f),
        }
    }
}

impl std::error::Error for NoSquealingStart {}

impl InitialState {
    /// The state in numbers.
    ///
    /// # Errors
    /// [`NoSquealingStart`] where a squealing start is asked for and there is none.
    pub fn resolve(&self, belt: &Belt, solver: &Solver) -> Result<Start, NoSquealingStart> {
        let (displacement, velocity) = match *self {
            Self::Rest => (0.0, 0.0),
            Self::Sliding => (belt.steady_sliding(), 0.0),
            Self::Squealing => return squealing(belt, solver),
            Self::Explicit { displacement, velocity } => (displacement, velocity),
        };
        Ok(Start { time: 0.0, displacement, velocity })
    }
}

/// The state in which the mass leaves the belt without dither, whatever came before: x = μ_sF − 2ζv₀, x′ = v₀.
pub(crate) fn released(belt: &Belt) -> Start {
    let threshold = belt.friction().static_coefficient() * belt.normal_load();
    Start {
        time: 0.0,
        displacement: threshold - 2.0 * belt.damping_ratio() * belt.belt_velocity(),
        velocity: belt.belt_velocity(),
    }
}

/// A state on the undithered limit cycle.
///
/// Once the mass sticks it releases at x = μ_sF − 2ζv₀, x′ = v₀, whatever came before: if it
/// sticks again after that release, the release is a point of the cycle, exactly.
fn squealing(belt: &Belt, solver: &Solver) -> Result<Start, NoSquealingStart> {
    if belt.belt_velocity() == 0.0 {
        return Err(NoSquealingStart::BeltAtRest);
    }
    let belt = belt.undithered();
    let release = released(&belt);
    let run = |from: Start, length: f64, observer: &mut (EventRecorder, Sampler)| {
        simulate(&belt, from, from.time + length, solver.tolerance, observer)
            .map_err(NoSquealingStart::Stalled)
    };
    let mut watch = (EventRecorder::default(), Sampler::new(0.0, 1.0, 0));
    let settled = run(release, solver.settle, &mut watch)?;
    if watch.0.events.iter().any(|event| event.kind == EventKind::Stick) {
        return Ok(release);
    }
    // No stick: a cycle in pure slip keeps its size, a decaying one loses it.
    let size = |samples: &Sampler| {
        let displacements = samples.samples.iter().map(|sample| sample.displacement);
        let low = displacements.clone().fold(f64::INFINITY, f64::min);
        displacements.fold(f64::NEG_INFINITY, f64::max) - low
    };
    let window = 4.0 * std::f64::consts::TAU;
    let sampled = |from: Start| {
        let mut watch = (EventRecorder::default(), Sampler::new(from.time, 0.02 * window, 50));
        let end = run(from, window, &mut watch)?;
        Ok((size(&watch.1), end))
    };
    let (before, end) = sampled(settled.restart())?;
    let later = run(end.restart(), solver.settle.max(window), &mut watch)?;
    let (after, end) = sampled(later.restart())?;
    let negligible = 1e-6 * belt.normal_load();
    if after < 0.95 * before || after < negligible {
        return Err(NoSquealingStart::SettlesToSliding);
    }
    let mut section = VelocitySection::upward(0.0);
    simulate(&belt, end.restart(), end.time + window, solver.tolerance, &mut section)
        .map_err(NoSquealingStart::Stalled)?;
    let lowest = section.crossings.first().ok_or(NoSquealingStart::SettlesToSliding)?;
    Ok(Start { time: 0.0, displacement: lowest.displacement, velocity: lowest.velocity })
}
