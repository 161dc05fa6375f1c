//! The unit in which a key gives its numbers.

use quell_model::parameter::Parameter;

/// The unit in which a key gives a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) enum KeyUnit {
    /// That of the study.
    Study,
    /// This one, by the suffix of the key.
    Suffix(&'static str),
    /// None: the number is a ratio in every study.
    Ratio,
}

impl KeyUnit {
    /// The unit of a key of a parameter.
    pub(in crate::study) fn of(parameter: Parameter, key: &str) -> Self {
        let other = parameter.si.iter().find(|other| other.key == key);
        match other.map(|other| other.unit) {
            Some("") if key.ends_with("ratio") => Self::Ratio,
            Some("") => Self::Study,
            Some(unit) => Self::Suffix(unit),
            None if parameter.is_pure() => Self::Ratio,
            None => Self::Study,
        }
    }
}
