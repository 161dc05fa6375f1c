//! Why no periodic response was found.

use std::fmt;

use quell_numerics::continuation::shooting::NotClosed;

use crate::simulation::{Stalled, Start};

/// Why a run has not settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unsettled {
    /// It still moved when its periods were over.
    Moving,
    /// It dwells in slip where areas grow: near an unstable curve between two basins.
    Dwelling,
}

impl Unsettled {
    /// A description.
    pub fn about(self) -> &'static str {
        match self {
            Self::Moving => "it still moved when its periods were over",
            Self::Dwelling => "it dwells near an unstable curve between two basins",
        }
    }
}

/// Why there is no periodic response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoOrbit {
    /// There is no dither: the response has no period of its own.
    NoDither,
    /// The frequencies of the dithers have no common period.
    Incommensurate,
    /// Newton's method did not converge.
    NotConverged {
        /// Number of steps.
        steps: u32,
        /// Mismatch at the last step.
        residual: f64,
        /// The state there.
        at: Start,
    },
    /// A multiplier is 1 to rounding, so that Newton's step is undefined.
    Degenerate {
        /// Number of steps.
        steps: u32,
        /// Mismatch there.
        residual: f64,
        /// The state there.
        at: Start,
    },
    /// An orbit was found, but not the intended one.
    Another {
        /// Its distance from the expected state.
        distance: f64,
        /// Its state.
        at: Start,
    },
    /// The base response ends before the dither reaches its amplitude.
    Ends {
        /// Fraction of the amplitude up to which it exists.
        share: f64,
    },
    /// The base response could not be followed to the dither's amplitude.
    LostOnTheWay {
        /// Fraction of the amplitude up to which it was followed.
        share: f64,
    },
    /// The run ends on a response that does not repeat within this number of common periods.
    NoPeriod {
        /// The number.
        most: u32,
    },
    /// The run comes to rest on a belt that does not move.
    AtRest,
    /// The run had not settled when its periods were over.
    Unsettled(Unsettled),
    /// The undithered run converges neither to a known limit cycle nor to stable steady sliding.
    NoLimit,
    /// At a negative slip velocity a tangential burst would have to change its sign, which is no burst.
    NoMirror,
    /// A parameter cannot take this value.
    Invalid {
        /// The value.
        value: f64,
    },
    /// The engine stopped.
    Stalled(Stalled),
}

impl NoOrbit {
    /// Whether the base response does not exist, as opposed to not having been found.
    pub fn is_absence(&self) -> bool {
        matches!(self, Self::Ends { .. } | Self::Degenerate { .. } | Self::Another { .. })
    }
}

impl fmt::Display for NoOrbit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDither => f.write_str("without dither the response has no prescribed period"),
            Self::Incommensurate => {
                f.write_str("the frequencies of the dithers have no common period")
            }
            Self::NotConverged { steps, residual, at } => write!(
                f,
                "shooting stopped after {steps} steps at x = {}, x′ = {} with a mismatch of {residual:.1e}",
                at.displacement, at.velocity
            ),
            Self::Degenerate { steps, residual, at } => write!(
                f,
                "shooting stopped after {steps} steps at x = {}, x′ = {} with a mismatch of {residual:.1e}: \
                 a multiplier is 1 there",
                at.displacement, at.velocity
            ),
            Self::Another { distance, at } => write!(
                f,
                "shooting found an orbit at x = {}, x′ = {}, but {distance:.1e} from the expected state: another one",
                at.displacement, at.velocity
            ),
            Self::Ends { share } => write!(
                f,
                "the base response ends at {} of the dither's amplitude: no base response exists beyond it; look near a state, or \
                 for what a run ends on",
                rounded(*share)
            ),
            Self::LostOnTheWay { share } => write!(
                f,
                "the base response could not be followed beyond {} of the dither's amplitude",
                rounded(*share)
            ),
            Self::NoPeriod { most } => write!(
                f,
                "the run ends on a response that does not repeat within {most} periods of the dither: \
                 it is quasi-periodic or locked at a longer period"
            ),
            Self::AtRest => {
                f.write_str("without dither the mass comes to rest on a belt that does not move: there is no orbit")
            }
            Self::Unsettled(why) => write!(f, "the run has not settled: {}", why.about()),
            Self::NoLimit => f.write_str(
                "the run converges neither to a known limit cycle nor to stable steady sliding",
            ),
            Self::NoMirror => {
                f.write_str("a burst is no burst after a change of sign, which a negative slip velocity needs")
            }
            Self::Invalid { value } => write!(f, "a parameter cannot take the value {value}"),
            Self::Stalled(stalled) => stalled.fmt(f),
        }
    }
}

/// A number with seven significant digits, however small.
fn rounded(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

impl std::error::Error for NoOrbit {}

impl From<NotClosed<NoOrbit>> for NoOrbit {
    fn from(why: NotClosed<NoOrbit>) -> Self {
        let start = |at: &[f64]| Start::of_state(at);
        match why {
            NotClosed::TooManySteps { steps, residual, at } => {
                Self::NotConverged { steps, residual, at: start(&at) }
            }
            NotClosed::Singular { steps, residual, at } => {
                Self::Degenerate { steps, residual, at: start(&at) }
            }
            NotClosed::Strayed { distance, at, .. } => Self::Another { distance, at: start(&at) },
            NotClosed::NoImage { why, .. } => why,
        }
    }
}
