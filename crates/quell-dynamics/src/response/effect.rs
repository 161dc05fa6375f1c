//! The effect of a dither on a vibration, as one word.
//!
//! Two facts decide: whether the undithered run from this start keeps vibrating (of one mass by its cycle map, exactly), and where the
//! dithered run ends ([`SystemEnding`](super::SystemEnding), by the judge of every verb). The residual vibration E of the record
//! quantifies any remaining vibration; a record that still changes does not overrule where its run ends.

use std::fmt;

use super::measure::Undefined;
use super::record_lines::RecordLines;

/// A response that ends on no known motion is quenched with less than this fraction of the undithered vibration.
pub const QUENCHED: f64 = 0.01;

/// Residual vibration E below which the dissertation calls a vibration suppressed (5 % in figure 2.8), and a designed dither that repeats in
/// the band of the vibration is called quiet.
pub const SUPPRESSED: f64 = 0.05;

/// The effect of a dither on the vibration below 1.9 ω₀, from one start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect {
    /// It vibrates without dither, and ends quiet with it; where it ends on no known motion, less than a hundredth of the vibration remains.
    Quenches,
    /// It vibrates without dither, and less with it.
    Reduces,
    /// It vibrates without dither, and as much or more with it.
    Increases,
    /// It is quiet without dither, and vibrates with it.
    Causes,
    /// It is quiet without dither and with it.
    Quiet,
    /// Undetermined.
    Unknown(Uncertain),
}

impl Effect {
    /// Words in outputs, in the order of the codes in stores.
    pub const NAMES: [&'static str; 5] = ["quenches", "reduces", "increases", "causes", "quiet"];

    /// Index of its word in [`Effect::NAMES`], or why the effect is unknown.
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

    /// The word in outputs.
    pub fn name(self) -> &'static str {
        self.place().map_or("unknown", |place| Self::NAMES[place])
    }
}

/// Why an effect is unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uncertain {
    /// No dither acts.
    NoDither,
    /// The limit set of the undithered run is unknown.
    Undithered(Undefined),
    /// The record still changes, and where the dithered run settles does not decide.
    StillChanging,
    /// With dither the observed motion drifts.
    Drifts,
    /// The record does not resolve the change by the dither: E is 1 within this.
    Unresolved {
        /// Relative difference of the halves of the records.
        within: f64,
    },
}

impl fmt::Display for Uncertain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDither => f.write_str("no dither acts"),
            Self::Undithered(why) => why.fmt(f),
            Self::StillChanging => f.write_str(
                "the vibration with dither still changes within the record: settle for longer",
            ),
            Self::Drifts => f.write_str(
                "with dither the observed motion drifts: over the record it moves on by more than it vibrates",
            ),
            Self::Unresolved { within } => {
                write!(
                    f,
                    "the dither changes the vibration by less than the record resolves (a relative change of {within:.1e})"
                )
            }
        }
    }
}

impl std::error::Error for Uncertain {}

/// The vibrations with and without dither that decide an effect, of any structure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vibrations {
    /// M with dither.
    pub dithered: RecordLines,
    /// M without dither, from the same start.
    pub undithered: RecordLines,
    /// Whether the undithered run settles without vibration.
    pub quiet_without: bool,
    /// Whether the motion on which the dithered run ends is quiet; `None` where it is not known.
    pub quiet_with: Option<bool>,
}

impl Vibrations {
    /// The effect that the records show.
    pub fn effect(&self) -> Effect {
        let Self { dithered, undithered, quiet_without, quiet_with } = *self;
        let ratio = dithered.whole() / undithered.whole();
        let is_small = if quiet_without { dithered.is_negligible() } else { ratio < QUENCHED };
        let nothing = if quiet_without { Effect::Quiet } else { Effect::Quenches };
        // However small next to the undithered vibration, a slow motion that stays is no quiet.
        if is_small && (quiet_without || quiet_with != Some(false)) {
            // A vibration too small to be visible may still grow, unless the record is steady or decays, or the run is known to settle
            // without one.
            let decided = dithered.is_steady() || dithered.decays() || quiet_with.is_some();
            return if decided { nothing } else { Effect::Unknown(Uncertain::StillChanging) };
        }
        if !dithered.is_settled(undithered.whole()) && !dithered.is_steady() {
            return Effect::Unknown(Uncertain::StillChanging);
        }
        let within = dithered.unsteadiness().max(undithered.unsteadiness());
        match quiet_without {
            true => Effect::Causes,
            false if (ratio - 1.0).abs() <= within => {
                Effect::Unknown(Uncertain::Unresolved { within })
            }
            false if ratio < 1.0 => Effect::Reduces,
            false => Effect::Increases,
        }
    }
}
