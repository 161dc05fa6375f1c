//! What is said about a value that cannot be accepted.

use std::fmt;

/// One complaint: which key, which value, what is allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Invalid {
    /// Path of the parameter as in a study file, such as `belt.damping_ratio`.
    pub key: String,
    /// The value as it was given.
    pub value: String,
    /// What is allowed instead, with the reason where it is not plain.
    pub allowed: String,
}

impl Invalid {
    /// A complaint about `key`.
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
