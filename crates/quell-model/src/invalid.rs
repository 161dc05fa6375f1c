//! Invalid values: which key, which value, and what is allowed.

use std::fmt;
use std::ops::Deref;

/// One invalid value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Invalid {
    /// Path of the parameter as in a study file, such as `belt.damping_ratio`.
    pub key: String,
    /// The value as given.
    pub value: String,
    /// The allowed values, with the reason if it is not obvious.
    pub allowed: String,
}

impl Invalid {
    /// The value of `key` is not allowed.
    pub fn new(
        key: impl Into<String>,
        value: impl fmt::Display,
        allowed: impl Into<String>,
    ) -> Self {
        Self { key: key.into(), value: value.to_string(), allowed: allowed.into() }
    }
}

impl fmt::Display for Invalid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}: must be {}", self.key, self.value, self.allowed)
    }
}

impl std::error::Error for Invalid {}

/// All invalid values of one construction, at least one: the error type of constructors.
///
/// It derefs to a slice of [`Invalid`], prints one line for each, and is an [`std::error::Error`], so that `?` works:
///
/// ```
/// use quell_model::{Belt, LawKind};
///
/// fn belt(velocity: f64) -> Result<Belt, Box<dyn std::error::Error>> {
///     let law = LawKind::Coulomb.build(&[0.3, 0.3, 0.0])?;
///     Ok(Belt::new(0.005, 1.0, velocity, law, Vec::new())?)
/// }
///
/// assert!(belt(0.05).is_ok());
/// let why = belt(-1.0).expect_err("a belt moves forwards");
/// assert!(why.to_string().starts_with("belt.belt_velocity = -1: must be"));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidValues(Vec<Invalid>);

impl InvalidValues {
    /// These values, at least one.
    pub(crate) fn of(found: Vec<Invalid>) -> Self {
        Self(found)
    }

    /// Each invalid value after `change`.
    #[must_use]
    pub fn map(self, change: impl FnMut(Invalid) -> Invalid) -> Self {
        Self(self.0.into_iter().map(change).collect())
    }
}

impl From<Invalid> for InvalidValues {
    fn from(invalid: Invalid) -> Self {
        Self(vec![invalid])
    }
}

impl Deref for InvalidValues {
    type Target = [Invalid];

    fn deref(&self) -> &[Invalid] {
        &self.0
    }
}

impl IntoIterator for InvalidValues {
    type Item = Invalid;
    type IntoIter = std::vec::IntoIter<Invalid>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl fmt::Display for InvalidValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, invalid) in self.0.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            invalid.fmt(f)?;
        }
        Ok(())
    }
}

impl std::error::Error for InvalidValues {}
