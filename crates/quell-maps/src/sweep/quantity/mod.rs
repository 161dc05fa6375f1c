//! The quantities that a map can show: each is one value with its name, what it needs of a study, its variables and how they are read.
//!
//! ```text
//! ChunkPoints → PointComputation (one type for each computation, done once for all quantities that read it) → values of variables
//! ```
//!
//! A quantity is added in the file of its computation, or with a new one in a file of its own that [`QUANTITIES`] lists.

mod critical;
mod end;
mod growth;
mod limit;
mod means;
mod orbit;
mod quench;
mod response;

use super::map_quantity::MapQuantity;
use crate::complaint::{Complaint, Fault, Origin};
use crate::nearest;
use crate::run::system::measured_alone;
use crate::study::Study;

pub(super) use response::SETTLED;

/// All quantities, by their computation.
pub const QUANTITIES: &[&[MapQuantity]] = &[
    response::QUANTITIES,
    means::QUANTITIES,
    end::QUANTITIES,
    growth::QUANTITIES,
    critical::QUANTITIES,
    quench::QUANTITIES,
    orbit::QUANTITIES,
    limit::QUANTITIES,
];

impl MapQuantity {
    /// The quantity with this name.
    ///
    /// # Errors
    /// A complaint about `option` with the nearest name.
    pub fn named(name: &str, option: &'static str) -> Result<&'static Self, Box<Complaint>> {
        let all = || QUANTITIES.iter().copied().flatten();
        if let Some(found) = all().find(|quantity| quantity.name == name) {
            return Ok(found);
        }
        let names: Vec<&str> = all().map(|quantity| quantity.name).collect();
        let allowed = format!("one of {}", names.join(", "));
        let complaint =
            Complaint::new(Fault::Value, option, Origin::Argument(option), name, allowed);
        let nearest = nearest::word(&name.replace('_', "-"), names);
        Err(Box::new(complaint.suggesting(nearest)))
    }

    /// Rejects a study that does not meet its needs.
    ///
    /// # Errors
    /// A complaint with the quantities of the study.
    pub(super) fn accepts(&self, study: &Study) -> Result<(), Box<Complaint>> {
        let name = format!("map --quantity {}", self.name);
        if let Some(complaint) = measured_alone(&study.system(), &name) {
            return Err(Box::new(complaint));
        }
        let Some(refused) = self.needs.refused(study, &name) else { return Ok(()) };
        if study.varies_by().is_some() || self.needs.suit(study) {
            return Err(Box::new(refused));
        }
        let all = QUANTITIES.iter().copied().flatten();
        let names: Vec<&str> =
            all.filter(|one| one.needs.are_met(study)).map(|one| one.name).collect();
        let allowed = format!(
            "for a study of {}; quantities of this study are {}",
            self.needs.about(),
            names.join(", ")
        );
        let option = "--quantity";
        let origin = Origin::Argument(option);
        Err(Box::new(Complaint::new(Fault::Value, option, origin, self.name, allowed)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_variables_follow_them() {
        let mut names: Vec<&str> = Vec::new();
        for quantity in QUANTITIES.iter().copied().flatten() {
            let first = quantity.variables.first().expect("a variable");
            assert_eq!(first.name, quantity.name.replace('-', "_"));
            assert_eq!(MapQuantity::named(quantity.name, "--quantity"), Ok(quantity));
            assert!(!names.contains(&quantity.name), "{} twice", quantity.name);
            names.push(quantity.name);
        }
        let refused =
            MapQuantity::named("stick_fraction", "--quantity").expect_err("an underscore");
        assert_eq!(refused.suggestion.as_deref(), Some("stick-fraction"));
    }
}
