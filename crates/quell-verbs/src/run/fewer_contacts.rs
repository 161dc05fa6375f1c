//! Few contacts in place of a surface of many, with what that changes.

use quell_linear::growth::Growth;
use quell_linear::patch::{patches, quadrature};

use crate::complaint::{Complaint, Failure};
use crate::run::stability;
use crate::run::system::{failed, oscillating, rate_of};
use crate::study::{ConvertedStudy, Kind, Study, SystemStudy};
use crate::words::{counted, digits};

/// Relative error of the sums over a surface that is allowed, where the request does not say.
pub const ERROR: f64 = 1e-6;

/// A study with few contacts.
#[derive(Clone, Debug)]
pub struct FewerContacts {
    /// The study.
    pub study: Study,
    /// Numbers of contacts, before and now.
    pub contacts: [usize; 2],
    /// Largest relative error of the sums over a surface.
    pub error: f64,
    /// The relative error that was allowed.
    pub allowed: f64,
    /// The leading small motion of the study and of that with few contacts, or why none is known.
    pub growth: [Result<Growth, String>; 2],
}

/// The study of a system with at most so many contacts on each surface, and no more than the relative error of the sums over it needs.
///
/// # Errors
/// Complaints about the numbers, a structure without masses, and paths to contacts that are left out.
pub fn run(study: &Study, most: usize, error: f64) -> Result<FewerContacts, Failure> {
    if most == 0 {
        let allowed = "at least 1 contact on each surface";
        return Err(Complaint::option("--contacts", most, allowed).into());
    }
    if !(0.0..1.0).contains(&error) {
        let allowed = "a relative error from 0 to below 1";
        return Err(Complaint::option("--error", error, allowed).into());
    }
    let system = study.system();
    let own = system.system();
    let groups = patches(own);
    let mut kept: Vec<(usize, f64)> = Vec::new();
    let alone =
        (0..own.contacts.len()).filter(|place| !groups.iter().flatten().any(|c| c == place));
    kept.extend(alone.map(|place| (place, 1.0)));
    let mut largest = 0.0f64;
    for group in groups {
        if group.len() == 1 {
            kept.push((group[0], 1.0));
            continue;
        }
        let found = quadrature(own, &group, most, error);
        let why = "contacts of first-order equations, or of a singular mass, have no kinetic energy to measure them by";
        let found = found.ok_or_else(|| failed("convert", why))?;
        largest = largest.max(found.error);
        kept.extend(found.kept);
    }
    kept.sort_unstable_by_key(|(place, _)| *place);
    let before = own.contacts.len();
    let few = study.with_contacts(&kept)?;
    let growth = [growth(&system), growth(&few.system())];
    let contacts = [before, kept.len()];
    Ok(FewerContacts { contacts, study: few, error: largest, allowed: error, growth })
}

/// The growth rate of the leading small motion.
fn growth(study: &SystemStudy) -> Result<Growth, String> {
    let found = stability::run(study).map_err(|why| why.to_string())?;
    Ok(found.spectrum.growth)
}

/// A study written as a system, with few contacts where that is asked.
#[derive(Clone, Debug)]
pub struct Conversion {
    converted: Option<ConvertedStudy>,
    fewer: Option<FewerContacts>,
    study: Study,
}

impl Conversion {
    /// The study as that of a system, with at most so many contacts on a surface and this error of its sums.
    ///
    /// # Errors
    /// A study of a system whose contacts are to stay; as [`Study::as_system`] and [`run`].
    pub fn of(study: &Study, fewer: Option<(usize, f64)>) -> Result<Self, Failure> {
        let is_system = matches!(study.kind(), Kind::System(_));
        let converted = match fewer {
            Some(_) if is_system => None,
            _ => Some(study.as_system()?),
        };
        let whole = converted.as_ref().map_or(study, |converted| &converted.study);
        let fewer = fewer.map(|(most, error)| run(whole, most, error)).transpose()?;
        let study = fewer.as_ref().map_or(whole, |fewer| &fewer.study).clone();
        Ok(Self { converted, fewer, study })
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// Its contacts, where there are fewer now.
    pub fn fewer(&self) -> Option<&FewerContacts> {
        self.fewer.as_ref()
    }

    /// The tables for which a system has no place.
    pub fn left_out(&self) -> &[String] {
        self.converted.as_ref().map_or(&[], |converted| &converted.left_out)
    }

    /// Whether it names files, relative to the folder of the original.
    pub fn names_files(&self) -> bool {
        self.converted.as_ref().map_or_else(|| self.study.names_files(), |known| known.names_files)
    }

    /// What was left out, and what is not known, in sentences.
    pub fn warnings(&self) -> Vec<String> {
        let converted = self.converted.iter().flat_map(ConvertedStudy::warnings);
        converted.chain(self.fewer.iter().flat_map(FewerContacts::warnings)).collect()
    }
}

impl FewerContacts {
    /// What stands for what, and what that changes.
    pub fn sentence(&self) -> String {
        let [before, now] = self.contacts;
        let units = self.study.units();
        let words = |growth: &Growth| {
            format!("{} {}", rate_of(units, growth.rate), oscillating(units, growth.frequency))
        };
        let change = match &self.growth {
            [Ok(whole), Ok(few)] => {
                format!("the largest growth rate is {} ({} before)", words(few), words(whole))
            }
            [Err(why), _] | [_, Err(why)] => format!("growth rates are not compared: {why}"),
        };
        format!(
            "{} stand{} for {before}, with a relative error of {} in the sums over their surfaces; {change}.",
            counted(now, "contact"),
            if now == 1 { "s" } else { "" },
            digits(self.error)
        )
    }

    /// What the answer does not cover.
    pub fn warnings(&self) -> Vec<String> {
        let few = (self.error > self.allowed).then(|| {
            format!(
                "these contacts leave a relative error of {}, and {} was allowed: more of them, or a larger --error",
                digits(self.error),
                digits(self.allowed)
            )
        });
        let verdicts = self.growth.each_ref().map(|growth| Some(growth.as_ref().ok()?.verdict()));
        let changed = match verdicts {
            [Some(before), Some(now)] if before != now => Some(format!(
                "sliding was {} and is {} with these contacts: they are too few",
                before.name(),
                now.name()
            )),
            _ => None,
        };
        let what = "a part of a surface sticks or opens alone only where a contact stands for it: compare motions that stick with more contacts";
        few.into_iter().chain(changed).chain([what.to_owned()]).collect()
    }
}
