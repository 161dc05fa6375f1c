//! Why a number of a map is known or unknown: the codes of `<quantity>_status`.
//!
//! Published codes never change, because stores keep them: 32 was that of a measured structure, which is refused now.

use quell_design::quench::NotQuenched;
use quell_dynamics::response::{Uncertain, Undefined};
use quell_linear::averaging::AveragingError;

/// Status of one number of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Status {
    /// The number is known.
    Known = 0,
    /// The axis values together do not form a valid study.
    InvalidStudy = 1,
    /// The engine stopped.
    Stalled = 2,
    /// A squealing start is requested, but no limit cycle exists.
    NoSquealingStart = 3,
    /// The number is infinite or NaN.
    NotFinite = 4,
    /// E: the undithered run settles to steady sliding.
    UnditheredSettles = 10,
    /// E: the undithered run does not move.
    UnditheredAtRest = 11,
    /// Power and stroke: all dither is normal.
    OnlyNormalDither = 12,
    /// E: the outcome of the undithered run is unknown.
    UnditheredUnknown = 13,
    /// The effect: the vibration still changes within the record, and the end of the run does not decide.
    StillChanging = 14,
    /// The effect: the record does not resolve what the dither changes.
    Unresolved = 15,
    /// A criterion of zero within its error.
    WithinError = 20,
    /// The belt is exactly as fast as the fast motion.
    AtCorner = 21,
    /// Friction is set-valued: no slip and no fast motion.
    SetValued = 22,
    /// Too many incommensurate dithers for averaging.
    TooManyGroups = 23,
    /// The dither is not above resonance.
    NotFast = 24,
    /// A quadrature did not converge.
    NotConverged = 25,
    /// The study has no dither.
    NoDither = 26,
    /// No amplitude changes averaged stability.
    NeverChanges = 27,
    /// Averaged stability changes at one amplitude only.
    ChangesOnce = 28,
    /// The number is known, but slip left the range of the friction law.
    BeyondRange = 29,
    /// A system has no steady sliding.
    NoSteadySliding = 30,
    /// A dither excites an undamped resonance.
    Resonance = 31,
    /// The number is known, but the fast motion opens a contact, which averaging does not describe.
    Opens = 33,
    /// A system has no base response, or it could not be followed.
    NoBaseResponse = 34,
    /// The structure has no periodic response to the waveform.
    NoAverageOfWaveform = 35,
    /// The number is known, but it is that of the law without the state of its contact, which differs here.
    WithoutState = 36,
    /// The law is that of bristles, which never stick.
    NeverSticks = 37,
    /// Sliding is stable without the first dither.
    QuietWithoutDither = 38,
    /// No amplitude of the first dither up to the limit of the search makes the base response stable.
    NeverQuiet = 39,
    /// The base response stays stable up to the limit of the search.
    StaysQuiet = 40,
    /// The base response is not stable at the limit of the search.
    LoudAtLimit = 41,
    /// The first dither moves no contact.
    NoReach = 42,
    /// A dither is a factor on a friction force, which averaging does not describe.
    FrictionFactor = 44,
    /// The system is not one mass on a moving surface.
    NotOneMass = 45,
    /// The record of a response is too long, or too short for the band of slow vibration.
    RecordLength = 46,
    /// Not computed yet, or lost: the fill value of a store.
    Missing = 255,
}

impl std::fmt::Display for Status {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.about())
    }
}

impl Status {
    /// Every status, in the order of the codes.
    pub const ALL: &'static [Self] = &[
        Self::Known,
        Self::InvalidStudy,
        Self::Stalled,
        Self::NoSquealingStart,
        Self::NotFinite,
        Self::UnditheredSettles,
        Self::UnditheredAtRest,
        Self::OnlyNormalDither,
        Self::UnditheredUnknown,
        Self::StillChanging,
        Self::Unresolved,
        Self::WithinError,
        Self::AtCorner,
        Self::SetValued,
        Self::TooManyGroups,
        Self::NotFast,
        Self::NotConverged,
        Self::NoDither,
        Self::NeverChanges,
        Self::ChangesOnce,
        Self::BeyondRange,
        Self::NoSteadySliding,
        Self::Resonance,
        Self::Opens,
        Self::NoBaseResponse,
        Self::NoAverageOfWaveform,
        Self::WithoutState,
        Self::NeverSticks,
        Self::QuietWithoutDither,
        Self::NeverQuiet,
        Self::StaysQuiet,
        Self::LoudAtLimit,
        Self::NoReach,
        Self::FrictionFactor,
        Self::NotOneMass,
        Self::RecordLength,
        Self::Missing,
    ];

    /// Its code in a store.
    pub const fn code(self) -> u8 {
        self as u8
    }

    /// The status of a known number, whose slip may leave the range of a friction law.
    pub const fn of_range(is_left: bool) -> Self {
        if is_left { Self::BeyondRange } else { Self::Known }
    }

    /// Whether the number is known.
    pub const fn has_number(self) -> bool {
        matches!(self, Self::Known | Self::BeyondRange | Self::Opens | Self::WithoutState)
    }

    /// The status with a code.
    pub fn of_code(code: u8) -> Option<Self> {
        Self::ALL.iter().copied().find(|status| status.code() == code)
    }

    /// Its name in JSON, CSV and `flag_meanings`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Known => "known",
            Self::InvalidStudy => "invalid_study",
            Self::Stalled => "stalled",
            Self::NoSquealingStart => "no_squealing_start",
            Self::NotFinite => "not_finite",
            Self::UnditheredSettles => "undithered_settles",
            Self::UnditheredAtRest => "undithered_at_rest",
            Self::OnlyNormalDither => "only_normal_dither",
            Self::UnditheredUnknown => "undithered_unknown",
            Self::StillChanging => "still_changing",
            Self::Unresolved => "unresolved",
            Self::WithinError => "within_error",
            Self::AtCorner => "at_corner",
            Self::SetValued => "set_valued_friction",
            Self::TooManyGroups => "too_many_groups",
            Self::NotFast => "not_fast",
            Self::NotConverged => "not_converged",
            Self::NoDither => "no_dither",
            Self::NeverChanges => "never_changes",
            Self::ChangesOnce => "changes_once",
            Self::BeyondRange => "beyond_range",
            Self::NoSteadySliding => "no_steady_sliding",
            Self::Resonance => "resonance",
            Self::Opens => "opens",
            Self::NoBaseResponse => "no_base_response",
            Self::NoAverageOfWaveform => "no_average_of_waveform",
            Self::WithoutState => "without_state",
            Self::NeverSticks => "never_sticks",
            Self::QuietWithoutDither => "quiet_without_dither",
            Self::NeverQuiet => "never_quiet",
            Self::StaysQuiet => "stays_quiet",
            Self::LoudAtLimit => "loud_at_limit",
            Self::NoReach => "no_reach",
            Self::FrictionFactor => "friction_factor",
            Self::NotOneMass => "not_one_mass",
            Self::RecordLength => "record_length",
            Self::Missing => "missing",
        }
    }

    /// Its meaning, in one sentence without the full stop.
    pub fn about(self) -> &'static str {
        match self {
            Self::Known => "the value is known",
            Self::InvalidStudy => "the axis values together do not form a valid study",
            Self::Stalled => "the integration stopped: its steps became too small or too many",
            Self::NoSquealingStart => {
                "the start is squealing, but without dither there is no limit cycle here"
            }
            Self::NotFinite => "the value is not finite",
            Self::UnditheredSettles => {
                "without dither the motion settles to steady sliding from this start, so there is no \
                 vibration to compare with"
            }
            Self::UnditheredAtRest => {
                "the belt does not move, so without dither the mass comes to rest"
            }
            Self::UnditheredUnknown => "where the undithered run from this start ends is unknown",
            Self::StillChanging => {
                "the vibration still changes within the record: settle for longer"
            }
            Self::Unresolved => "the dither changes the vibration by less than the record resolves",
            Self::OnlyNormalDither => {
                "all dither is normal, and the model has no motion in the normal direction"
            }
            Self::WithinError => "the criterion is zero within its error",
            Self::AtCorner => {
                "the belt is exactly as fast as the fast motion, where the criterion of stability jumps"
            }
            Self::SetValued => {
                "without slip and fast motion, friction can take any value up to the static level"
            }
            Self::TooManyGroups => "too many incommensurate dithers for averaging",
            Self::NotFast => {
                "the dither is not above resonance (R ≤ 1), as this averaging requires"
            }
            Self::NotConverged => "an integral of the averaging did not reach its tolerance",
            Self::NoDither => "there is no dither",
            Self::NeverChanges => "no amplitude of the first dither changes averaged stability",
            Self::ChangesOnce => "averaged stability changes at one amplitude only, the lower one",
            Self::BeyondRange => {
                "the value is known, but slip leaves the range of the friction law"
            }
            Self::NoSteadySliding => "there is no steady sliding",
            Self::Resonance => "a dither excites an undamped resonance of the structure",
            Self::Opens => {
                "the value is known, but the fast motion opens a contact, which averaging does not describe"
            }
            Self::NoBaseResponse => {
                "the base response ends before the dither reaches its amplitude, or could not be followed"
            }
            Self::FrictionFactor => {
                "a dither is a factor on a friction force, which averaging does not describe"
            }
            Self::NoAverageOfWaveform => {
                "the structure has no periodic response to the waveform that averaging could use"
            }
            Self::WithoutState => {
                "the value is known, but it averages the friction law without the state of its contact, which follows the dither here"
            }
            Self::NeverSticks => "bristles slip at any load, however slowly, and never stick",
            Self::QuietWithoutDither => NotQuenched::QuietWithout.words(),
            Self::NeverQuiet => NotQuenched::NeverQuiet.words(),
            Self::StaysQuiet => "the base response stays stable up to the limit of the search",
            Self::LoudAtLimit => "the base response is not stable at the limit of the search",
            Self::NoReach => "the dither moves no contact",
            Self::NotOneMass => {
                "the system is not one mass with a spring and a prescribed load on a surface of velocity v ≥ 0"
            }
            Self::RecordLength => {
                "the record of the response is too long to be kept, or too short for the band of slow vibration: change its length"
            }
            Self::Missing => "not computed yet",
        }
    }
}

impl From<Undefined> for Status {
    fn from(why: Undefined) -> Self {
        match why {
            Undefined::UnditheredSettles | Undefined::UnditheredStill => Self::UnditheredSettles,
            Undefined::UnditheredAtRest => Self::UnditheredAtRest,
            Undefined::UnditheredUnknown
            | Undefined::UnditheredUnstable
            | Undefined::UnditheredDrifts => Self::UnditheredUnknown,
        }
    }
}

impl From<Uncertain> for Status {
    fn from(why: Uncertain) -> Self {
        match why {
            Uncertain::NoDither => Self::NoDither,
            Uncertain::Undithered(why) => why.into(),
            Uncertain::StillChanging | Uncertain::Drifts => Self::StillChanging,
            Uncertain::Unresolved { .. } => Self::Unresolved,
        }
    }
}

impl From<AveragingError> for Status {
    fn from(why: AveragingError) -> Self {
        match why {
            AveragingError::SetValued { .. } => Self::SetValued,
            AveragingError::TooManyGroups { .. } => Self::TooManyGroups,
            AveragingError::NotFast { .. } => Self::NotFast,
            AveragingError::NoSteadySliding(_) => Self::NoSteadySliding,
            AveragingError::Resonance { .. } => Self::Resonance,
            AveragingError::FrictionFactor => Self::FrictionFactor,
            AveragingError::NoResponse(_) => Self::NoAverageOfWaveform,
            AveragingError::Eigenvalues(_) => Self::NotFinite,
            AveragingError::Quadrature(_) => Self::NotConverged,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_and_names_are_unique() {
        for (index, status) in Status::ALL.iter().enumerate() {
            assert_eq!(Status::of_code(status.code()), Some(*status));
            for other in &Status::ALL[..index] {
                assert!(status.code() > other.code() && status.name() != other.name());
            }
        }
    }
}
