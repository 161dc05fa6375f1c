//! Initial-condition protocols: the state from which runs start, and how a door reads it.

use quell_dynamics::orbit::{sliding_state, squealing_state};
use quell_model::System;

use super::system::start::{StateNumbers, named, pair, read_state, start_in_words, start_with};
use crate::complaint::{Complaint, Complaints, Failure, Fault, Origin};
use crate::study::{SystemStart, SystemStudy};

/// The state from which a run starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Protocol {
    /// The start of the study.
    #[default]
    Study,
    /// Every number of the state is 0.
    Rest,
    /// Steady sliding without dither.
    Sliding,
    /// The limit cycle without dither.
    Squeal,
    /// The start of the study with these numbers.
    From(StateNumbers),
}

impl Protocol {
    /// Name of its field in JSON.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Study => "from_initial",
            Self::Rest => "from_rest",
            Self::Sliding => "from_sliding",
            Self::Squeal => "from_squeal",
            Self::From(_) => "from_start",
        }
    }

    /// The start in words, such as "from rest".
    pub fn words(&self, study: &SystemStudy) -> String {
        match self {
            Self::Study => start_in_words(study, &StateNumbers::new()),
            Self::Rest => "from rest".to_owned(),
            Self::Sliding => "from steady sliding".to_owned(),
            Self::Squeal => "from the undithered limit cycle".to_owned(),
            Self::From(numbers) => start_in_words(study, numbers),
        }
    }

    /// The state at t = 0 in a system, that of the study with some numbers changed.
    ///
    /// # Errors
    /// Why there is no such state.
    pub fn state(&self, study: &SystemStudy, system: &System) -> Result<Vec<f64>, Failure> {
        let refused = |option: &'static str, why: String| -> Failure {
            let why = why.strip_prefix("another state: ").unwrap_or(&why);
            let allowed = format!("choose another start: {why}");
            let origin = Origin::Argument(option);
            Complaint::new(Fault::Conflict, option, origin, serde_json::Value::Null, allowed).into()
        };
        match self {
            // Named states depend on the system.
            Self::Study => match study.initial() {
                SystemStart::Sliding => Self::Sliding.state(study, system),
                SystemStart::Squealing => Self::Squeal.state(study, system),
                _ => Ok(start_with(study, &StateNumbers::new())?.state),
            },
            Self::From(numbers) => Ok(start_with(study, numbers)?.state),
            Self::Rest => Ok(vec![0.0; system.state_size()]),
            Self::Sliding => {
                sliding_state(system).map_err(|why| refused("--from-sliding", why.to_string()))
            }
            Self::Squeal => {
                squealing_state(system).map_err(|why| refused("--from-squeal", why.to_string()))
            }
        }
    }
}

/// Displacement and velocity of one coordinate, as an option gives them.
///
/// # Errors
/// A complaint about each number, or about several coordinates.
pub fn pair_of(
    study: &SystemStudy,
    option: &'static str,
    (x, v): (&str, &str),
) -> Result<StateNumbers, Complaints> {
    pair(study, (x, v)).map_err(|wrong| renamed(&wrong, option))
}

/// Numbers of a state by name, as an option gives them.
///
/// # Errors
/// A complaint about every pair.
pub fn numbers_of(
    study: &SystemStudy,
    option: &'static str,
    pairs: &[(String, String)],
) -> Result<StateNumbers, Complaints> {
    let pairs = pairs.iter().map(|(name, value)| Ok((name.as_str(), value.as_str())));
    named(study, pairs).map_err(|wrong| renamed(&wrong, option))
}

/// Complaints about a state as those about an option.
fn renamed(wrong: &Complaints, option: &'static str) -> Complaints {
    let renamed = |complaint: &Complaint| Complaint {
        key: option.to_owned(),
        origin: Origin::Argument(option),
        ..complaint.clone()
    };
    wrong.iter().map(renamed).collect::<Vec<Complaint>>().into()
}

/// Reads `name=value,…` given by an option.
///
/// # Errors
/// A complaint about every part.
pub fn read_state_of(
    study: &SystemStudy,
    option: &'static str,
    text: &str,
) -> Result<StateNumbers, Complaints> {
    read_state(study, text).map_err(|wrong| renamed(&wrong, option))
}
