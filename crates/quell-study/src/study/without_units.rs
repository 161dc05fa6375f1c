//! Files in units that a study without units cannot take.

use std::fmt;

/// Why the unit of a file needs a study with units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WithoutUnits {
    /// A column is in SI.
    Si {
        /// Its name without a unit.
        plain: &'static str,
        /// Its name.
        si: &'static str,
    },
    /// Frequencies are in hertz.
    Hertz,
}

impl fmt::Display for WithoutUnits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Si { plain, si } => write!(
                f,
                "a CSV file with a column {plain}: the study has no units, but {si} is in SI"
            ),
            Self::Hertz => f.write_str(
                "a CSV file with a column frequency: the study has no units, but frequency_hz is in hertz; or add \
                 system.units = \"SI\" or \"mm-t-s\"",
            ),
        }
    }
}

impl std::error::Error for WithoutUnits {}
