//! Errors in the input, and how a task can fail.

use std::fmt::{self, Write as _};
use std::ops::Deref;

use serde_json::{Value, json};

use crate::said::Said;

/// Where a wrong value was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Origin {
    /// A line of the study file, counted from 1.
    Line(usize),
    /// An argument of the command line, such as `--set`.
    Argument(&'static str),
    /// The study as a whole, for example where something is missing.
    Whole,
}

impl Origin {
    /// The line, if any.
    pub fn line(self) -> Option<usize> {
        match self {
            Self::Line(line) => Some(line),
            Self::Argument(_) | Self::Whole => None,
        }
    }
}

/// The kind of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fault {
    /// The command line is not understood.
    Usage,
    /// The text is not TOML.
    Syntax,
    /// A file or an output path cannot be used.
    Path,
    /// No such key, path or option.
    Unknown,
    /// A required key is missing.
    Missing,
    /// A value of the wrong kind or out of its range.
    Value,
    /// Two keys that exclude one another.
    Conflict,
    /// A dimensionless key in a study in SI, or an SI key in a dimensionless one.
    Mixed,
    /// A part of the design that is not implemented yet.
    NotBuilt,
}

impl Fault {
    /// Name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Usage => "usage",
            Self::Syntax => "syntax",
            Self::Path => "path",
            Self::Unknown => "unknown",
            Self::Missing => "missing",
            Self::Value => "value",
            Self::Conflict => "conflict",
            Self::Mixed => "mixed",
            Self::NotBuilt => "not-built",
        }
    }
}

/// One complaint about the input.
#[derive(Clone, Debug, PartialEq)]
pub struct Complaint {
    /// What is wrong.
    pub fault: Fault,
    /// Path of the key, such as `dither[1].amplitude`, or the option, such as `--until`.
    pub key: String,
    /// Where it was written.
    pub origin: Origin,
    /// The value as given; null if no value was given.
    pub value: Value,
    /// What is allowed instead.
    pub allowed: Said,
    /// The nearest valid key or value.
    pub suggestion: Option<String>,
}

impl Complaint {
    /// A complaint without suggestion.
    pub fn new(
        fault: Fault,
        key: impl Into<String>,
        origin: Origin,
        value: impl Into<Value>,
        allowed: impl Into<Said>,
    ) -> Self {
        Self {
            fault,
            key: key.into(),
            origin,
            value: value.into(),
            allowed: allowed.into(),
            suggestion: None,
        }
    }

    /// A complaint about the value of a command-line option.
    pub fn option(option: &'static str, value: impl Into<Value>, allowed: impl Into<Said>) -> Self {
        Self::new(Fault::Value, option, Origin::Argument(option), value, allowed)
    }

    /// The same complaint with a suggestion.
    #[must_use]
    pub fn suggesting(mut self, suggestion: Option<String>) -> Self {
        self.suggestion = suggestion;
        self
    }

    /// As an entry of `errors` in JSON.
    pub fn json(&self) -> Value {
        json!({
            "key": self.key,
            "line": self.origin.line(),
            "value": self.value,
            "allowed": &*self.allowed,
            "suggestion": self.suggestion,
            "fault": self.fault.name(),
            "message": self.to_string(),
        })
    }

    fn given(&self) -> String {
        match &self.value {
            Value::String(text) => text.clone(),
            value => value.to_string(),
        }
    }
}

/// In words, control characters of keys and values escaped: a terminal would obey them.
impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut words = String::new();
        self.write(&mut words)?;
        words.chars().try_for_each(|c| match c {
            '\n' | '\t' => f.write_char(c),
            c if c.is_control() => write!(f, "{}", c.escape_unicode()),
            c => f.write_char(c),
        })
    }
}

impl Complaint {
    fn write(&self, f: &mut String) -> fmt::Result {
        match self.origin {
            Origin::Line(line) => write!(f, "line {line}: ")?,
            Origin::Argument(option) if option != self.key && self.fault != Fault::Usage => {
                write!(f, "{option}: ")?;
            }
            Origin::Argument(_) | Origin::Whole => {}
        }
        let Self { key, allowed, .. } = self;
        match self.fault {
            Fault::Usage => write!(f, "{allowed}")?,
            Fault::Syntax => write!(f, "invalid TOML: {allowed}")?,
            Fault::Path => match &self.value {
                Value::Null => write!(f, "{key}: {allowed}")?,
                _ => write!(f, "{key} {}: {allowed}", self.given())?,
            },
            Fault::Unknown => write!(f, "unknown {key}")?,
            Fault::Missing => write!(f, "{key} is missing: {allowed}")?,
            Fault::Value => write!(f, "{key} = {}: must be {allowed}", self.given())?,
            Fault::Conflict | Fault::Mixed | Fault::NotBuilt if allowed.starts_with("left out") => {
                write!(f, "{key}: must be {allowed}")?;
            }
            Fault::Conflict | Fault::Mixed | Fault::NotBuilt => write!(f, "{key}: {allowed}")?,
        }
        match (&self.suggestion, self.fault) {
            // The message already names the right key.
            (_, Fault::Mixed) => Ok(()),
            (Some(suggestion), _) => write!(f, "; did you mean {suggestion}?"),
            (None, Fault::Unknown) if !allowed.is_empty() => {
                write!(f, "; expected one of: {allowed}")
            }
            (None, _) => Ok(()),
        }
    }
}

/// All errors found in an input, at least one. `?` converts it into a [`Failure`].
#[derive(Clone, Debug, PartialEq)]
pub struct Complaints(Vec<Complaint>);

impl Complaints {
    /// These complaints and further ones.
    #[must_use]
    pub fn and(mut self, further: impl IntoIterator<Item = Complaint>) -> Self {
        self.0.extend(further);
        self
    }
}

impl From<Vec<Complaint>> for Complaints {
    fn from(complaints: Vec<Complaint>) -> Self {
        Self(complaints)
    }
}

impl From<Complaint> for Complaints {
    fn from(complaint: Complaint) -> Self {
        Self(vec![complaint])
    }
}

impl From<Box<Complaint>> for Complaints {
    fn from(complaint: Box<Complaint>) -> Self {
        Self(vec![*complaint])
    }
}

impl Deref for Complaints {
    type Target = [Complaint];

    fn deref(&self) -> &[Complaint] {
        &self.0
    }
}

impl IntoIterator for Complaints {
    type Item = Complaint;
    type IntoIter = std::vec::IntoIter<Complaint>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl fmt::Display for Complaints {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, complaint) in self.0.iter().enumerate() {
            let end = if index + 1 < self.0.len() { "\n" } else { "" };
            write!(f, "{complaint}{end}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Complaints {}

/// Why a task gave no result.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// The input is invalid: all errors together (exit status 2).
    Wrong(Complaints),
    /// The input is valid, but the task failed (exit status 1).
    Failed {
        /// What failed, such as the path that could not be written.
        key: String,
        /// The reason, in one sentence.
        why: Said,
    },
}

impl Failure {
    /// Exit status of a process that ends with this failure.
    pub fn exit_status(&self) -> u8 {
        match self {
            Self::Wrong(_) => 2,
            Self::Failed { .. } => 1,
        }
    }

    /// The failure as one JSON object.
    pub fn json(&self) -> Value {
        let errors: Vec<Value> = match self {
            Self::Wrong(complaints) => complaints.iter().map(Complaint::json).collect(),
            Self::Failed { key, why } => vec![json!({
                "key": key,
                "line": null,
                "value": null,
                "allowed": null,
                "suggestion": null,
                "fault": "failed",
                "message": &**why,
            })],
        };
        json!({ "ok": false, "errors": errors })
    }
}

impl From<Complaint> for Failure {
    fn from(complaint: Complaint) -> Self {
        Self::Wrong(complaint.into())
    }
}

impl From<Box<Complaint>> for Failure {
    fn from(complaint: Box<Complaint>) -> Self {
        Self::Wrong(complaint.into())
    }
}

impl From<Vec<Complaint>> for Failure {
    fn from(complaints: Vec<Complaint>) -> Self {
        Self::Wrong(complaints.into())
    }
}

impl From<Complaints> for Failure {
    fn from(complaints: Complaints) -> Self {
        Self::Wrong(complaints)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Wrong(complaints) => complaints.fmt(f),
            Self::Failed { key, why } => write!(f, "{key}: {why}"),
        }
    }
}

impl std::error::Error for Failure {}
