//! Initial states of a run: rest, sliding, squealing, or a given state.

use std::fmt;

use quell_model::Belt;

use crate::orbit::{CycleMapError, squeal};
use crate::simulation::{Stalled, Start};

/// The initial state of a study, at τ = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum InitialState {
    /// x = 0, x′ = 0.
    #[default]
    Rest,
    /// Steady sliding without dither: x = μ(v₀)F, x′ = 0.
    Sliding,
    /// On the limit cycle of the undithered belt, at the moment of its release (or, if the
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

/// Why no squealing start exists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoSquealingStart {
    /// The undithered belt, released from its static threshold, settles to steady sliding.
    SettlesToSliding,
    /// v₀ = 0: the mass is not driven.
    BeltAtRest,
    /// The engine stopped.
    Stalled(Stalled),
}

impl fmt::Display for NoSquealingStart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SettlesToSliding => f.write_str(
                "the undithered belt has no limit cycle here: released from its static threshold, \
                 it settles to steady sliding",
            ),
            Self::BeltAtRest => {
                f.write_str("the belt does not move (v₀ = 0), so there is no squeal")
            }
            Self::Stalled(stalled) => stalled.fmt(f),
        }
    }
}

impl std::error::Error for NoSquealingStart {}

impl InitialState {
    /// The numerical state.
    ///
    /// # Errors
    /// [`NoSquealingStart`] if a squealing start is requested and none exists.
    pub fn resolve(&self, belt: &Belt) -> Result<Start, NoSquealingStart> {
        let (displacement, velocity) = match *self {
            Self::Rest => (0.0, 0.0),
            Self::Sliding => (belt.steady_sliding(), 0.0),
            Self::Squealing => return squealing(belt),
            Self::Explicit { displacement, velocity } => (displacement, velocity),
        };
        Ok(Start { time: 0.0, displacement, velocity })
    }
}

/// A state on the undithered limit cycle ([`squeal`]).
fn squealing(belt: &Belt) -> Result<Start, NoSquealingStart> {
    if belt.belt_velocity() == 0.0 {
        return Err(NoSquealingStart::BeltAtRest);
    }
    match squeal(belt) {
        Ok(found) => found.ok_or(NoSquealingStart::SettlesToSliding),
        Err(CycleMapError::Stalled(stalled)) => Err(NoSquealingStart::Stalled(stalled)),
        Err(CycleMapError::NoLimit) => Err(NoSquealingStart::SettlesToSliding),
    }
}
