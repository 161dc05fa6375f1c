//! What a dither does to a vibration, in one word.
//!
//! Two facts decide: whether the undithered run from this start keeps vibrating (the cycle map, exactly), and where the dithered
//! run ends ([`reached`]: on the base response, elsewhere, or unknown). The residual vibration E of the record says how much is
//! left where something is left; a record that still changes does not overrule where its run ends.

use std::fmt;

use quell_model::Belt;

use super::Undefined;
use super::measure::Compared;
use crate::attractor::{Reached, Strobe, reached};
use crate::orbit::NoOrbit;
use crate::simulation::Start;

/// Below this share of the undithered vibration nothing is left of it: a response is quenched.
pub const QUENCHED: f64 = 0.01;

/// Slow vibration below this share of F is none: the distance within which a state counts as the base response.
const NONE: f64 = 1e-6;

/// What a dither does to the vibration below 1.9 ω₀, from one start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect {
    /// It vibrates without dither; less than a hundredth is left with it.
    Quenches,
    /// It vibrates without dither; less is left with it.
    Reduces,
    /// It vibrates without dither, and as much or more with it.
    Increases,
    /// It is quiet without dither, and vibrates with it.
    Causes,
    /// It is quiet without dither and with it.
    Quiet,
    /// Nothing is sure.
    Unknown(Uncertain),
}

impl Effect {
    /// Words in outputs, in the order of the codes in stores.
    pub const NAMES: [&'static str; 5] = ["quenches", "reduces", "increases", "causes", "quiet"];

    /// Place of its word in [`Effect::NAMES`], or why there is none.
    ///
    /// # Errors
    /// [`Uncertain`].
    pub fn place(self) -> Result<usize, Uncertain> {
        Ok(match self {
            Self::Quenches => 0,
            Self::Reduces => 1,
            Self::Increases => 2,
            Self::Causes => 3,
            Self::Quiet => 4,
            Self::Unknown(why) => return Err(why),
        })
    }

    /// Its word.
    pub fn name(self) -> &'static str {
        self.place().map_or("unknown", |place| Self::NAMES[place])
    }
}

/// Why an effect is unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uncertain {
    /// No dither acts.
    NoDither,
    /// Where the undithered run ends.
    Undithered(Undefined),
    /// The record still changes, and where the dithered run ends does not decide.
    StillChanging,
    /// The record does not resolve what the dither changes: E is 1 within this.
    Unresolved {
        /// How far the halves of the records differ, relatively.
        within: f64,
    },
}

impl fmt::Display for Uncertain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDither => f.write_str("no dither acts"),
            Self::Undithered(why) => why.fmt(f),
            Self::StillChanging => f.write_str(
                "the vibration with dither still changes within the record; settle for longer",
            ),
            Self::Unresolved { within } => {
                write!(
                    f,
                    "it changes the vibration by less than the record resolves ({within:.1e} of it)"
                )
            }
        }
    }
}

impl std::error::Error for Uncertain {}

/// Where the dithered run of a case ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// On the base response, elsewhere, or not settled.
    Reached(Reached),
    /// It was not found, and why.
    Unknown(NoOrbit),
}

impl Ending {
    /// Of the run of a belt from a start.
    pub fn of(belt: &Belt, start: Start) -> Self {
        match reached(belt, start) {
            Ok(reached) => Self::Reached(reached),
            Err(why) => Self::Unknown(why),
        }
    }

    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reached(Reached::Base) => "base response",
            Self::Reached(Reached::Forced) => "another response without slow motion of its own",
            Self::Reached(Reached::Elsewhere) => "another response",
            Self::Reached(Reached::Unsettled | Reached::Unknown) | Self::Unknown(_) => "unknown",
        }
    }

    /// Whether no slow motion is left but what the dither itself forces.
    fn is_quiet(self) -> bool {
        matches!(self, Self::Reached(reached) if reached.is_quiet() == Some(true))
    }
}

/// The effect of a belt's dither from a start, from what was measured and from where the run ends.
pub fn effect(belt: &Belt, compared: &Compared, ending: Ending) -> Effect {
    if belt.dithers().iter().all(|dither| dither.amplitude == 0.0) {
        return Effect::Unknown(Uncertain::NoDither);
    }
    let quiet_without = match compared.efficiency() {
        Err(why @ Undefined::UnditheredUnknown) => {
            return Effect::Unknown(Uncertain::Undithered(why));
        }
        Err(Undefined::UnditheredSettles | Undefined::UnditheredAtRest) => true,
        Ok(_) => false,
    };
    if ending.is_quiet() && Strobe::of(belt).is_ok_and(|strobe| !strobe.reaches_the_band()) {
        return if quiet_without { Effect::Quiet } else { Effect::Quenches };
    }
    let dithered = &compared.dithered;
    let ratio = dithered.lines.whole / compared.undithered.lines.whole;
    let negligible = if quiet_without {
        dithered.lines.whole < NONE * belt.normal_load()
    } else {
        ratio < QUENCHED
    };
    let nothing = if quiet_without { Effect::Quiet } else { Effect::Quenches };
    if negligible {
        // Nothing is seen of a vibration that may still grow, unless the record is steady or the run is known to end without one.
        let done = dithered.is_steady() || ending.is_quiet();
        return if done { nothing } else { Effect::Unknown(Uncertain::StillChanging) };
    }
    if !compared.settled() && !dithered.is_steady() {
        return Effect::Unknown(Uncertain::StillChanging);
    }
    let within = dithered.unsteadiness().max(compared.undithered.unsteadiness());
    match quiet_without {
        true => Effect::Causes,
        false if (ratio - 1.0).abs() <= within => Effect::Unknown(Uncertain::Unresolved { within }),
        false if ratio < 1.0 => Effect::Reduces,
        false => Effect::Increases,
    }
}

/// Whether the record still shows a vibration of which nothing is left in the end.
pub(super) fn still_decays(effect: Effect, compared: &Compared) -> bool {
    let ratio = compared.dithered.lines.whole / compared.undithered.lines.whole;
    effect == Effect::Quenches && ratio >= QUENCHED
}
