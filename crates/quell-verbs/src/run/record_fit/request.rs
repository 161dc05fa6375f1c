//! What `fit --record` estimates: numbers of a study, and numbers of the measurement.

use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::study::Study;

/// A free number.
#[derive(Clone, Debug, PartialEq)]
pub enum FreeNumber {
    /// A number of the study by its path.
    OfStudy(String),
    /// Time of the first sample: in a study whose motion a dither or a profile paces, from the start of the run; else from its highest
    /// displacement after settling.
    Shift,
    /// The reading of the sensor at zero.
    Offset,
    /// Factor of the readings of the study.
    Gain,
}

/// Names of the numbers of the measurement.
pub const MEASUREMENT: [&str; 3] = ["record.shift", "record.offset", "record.gain"];

impl FreeNumber {
    /// From a name.
    fn named(name: &str) -> Self {
        match name {
            "record.shift" => Self::Shift,
            "record.offset" => Self::Offset,
            "record.gain" => Self::Gain,
            path => Self::OfStudy(path.to_owned()),
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        match self {
            Self::OfStudy(path) => path,
            Self::Shift => MEASUREMENT[0],
            Self::Offset => MEASUREMENT[1],
            Self::Gain => MEASUREMENT[2],
        }
    }
}

/// A free number with the value at which the search begins.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeStart {
    /// The number.
    pub number: FreeNumber,
    /// Its start; `None` where the record gives it.
    pub start: Option<f64>,
}

/// `NAME` or `NAME=START` for every free number, checked against the study.
///
/// # Errors
/// Every number that the study does not have, that is given twice, or that has no start.
pub(super) fn free_numbers(study: &Study, free: &[String]) -> Result<Vec<FreeStart>, Failure> {
    let mut wrong = Vec::new();
    let mut found: Vec<FreeStart> = Vec::new();
    for text in free {
        let (name, given) = match text.split_once('=') {
            Some((name, value)) => {
                let value = value.trim().parse::<f64>().ok().filter(|value| value.is_finite());
                if value.is_none() {
                    let allowed = "NAME=START with a finite number";
                    wrong.push(Complaint::option("--free", text.as_str(), allowed));
                    continue;
                }
                (name.trim(), value)
            }
            None => (text.trim(), None),
        };
        let number = FreeNumber::named(name);
        if found.iter().any(|one| one.number == number) {
            wrong.push(Complaint::option("--free", name, "each number once"));
            continue;
        }
        let start = match &number {
            FreeNumber::OfStudy(path) => match started(study, path, given) {
                Ok(start) => Some(start),
                Err(why) => {
                    wrong.extend(why);
                    continue;
                }
            },
            FreeNumber::Shift => given,
            FreeNumber::Offset => Some(given.unwrap_or(0.0)),
            FreeNumber::Gain => Some(given.unwrap_or(1.0)),
        };
        found.push(FreeStart { number, start });
    }
    if found.is_empty() && wrong.is_empty() {
        let allowed = format!(
            "the numbers to estimate: paths of the study, such as belt.damping_ratio, and {}",
            MEASUREMENT.join(", ")
        );
        wrong.push(Complaint::new(
            Fault::Missing,
            "--free",
            Origin::Argument("--free"),
            Json::Null,
            allowed,
        ));
    }
    if wrong.is_empty() { Ok(found) } else { Err(wrong.into()) }
}

/// The start of a number of the study: given, or its value in the study.
fn started(study: &Study, path: &str, given: Option<f64>) -> Result<f64, Vec<Complaint>> {
    let Some(start) = given.or_else(|| study.number(path)) else {
        // The complaint of a path that does not exist has the nearest one.
        if let Err(wrong) = study.with(path, 1.0)
            && wrong.iter().any(|complaint| complaint.fault == Fault::Unknown)
        {
            return Err(wrong.into_iter().map(for_option).collect());
        }
        let allowed = format!("a number that the study gives, or {path}=START");
        return Err(vec![Complaint::option("--free", path, allowed)]);
    };
    match study.at([(path, start)]) {
        Ok(_) => Ok(start),
        Err(wrong) => Err(wrong.into_iter().map(for_option).collect()),
    }
}

fn for_option(complaint: Complaint) -> Complaint {
    let allowed = format!("such that {} is {}", complaint.key, complaint.allowed);
    let allowed =
        if complaint.fault == Fault::Unknown { complaint.allowed.clone() } else { allowed.into() };
    Complaint { origin: Origin::Argument("--free"), allowed, ..complaint }
}
