//! All quantities of maps, and their lookup by name.

use super::quantity::MapQuantity;
use super::{belt, disc, system};
use crate::complaint::{Complaint, Fault, Origin};
use crate::nearest;
use crate::study::BeltSetup;

impl MapQuantity {
    /// The quantity of a belt with this name.
    ///
    /// # Errors
    /// A complaint about `option` with the nearest name.
    pub fn named(name: &str, option: &'static str) -> Result<&'static Self, Box<Complaint>> {
        Self::named_for(BeltSetup::NAME, name, option)
    }

    /// The quantity with this name for a kind of study, itself named as by [`crate::study::Kind::name`].
    ///
    /// # Errors
    /// A complaint about `option` with the nearest name.
    pub fn named_for(
        kind: &str,
        name: &str,
        option: &'static str,
    ) -> Result<&'static Self, Box<Complaint>> {
        let there =
            || QUANTITIES.iter().copied().flatten().filter(|quantity| quantity.kind == kind);
        if let Some(found) = there().find(|quantity| quantity.name == name) {
            return Ok(found);
        }
        let names: Vec<&str> = there().map(|quantity| quantity.name).collect();
        let allowed = format!("one of {}", names.join(", "));
        let complaint =
            Complaint::new(Fault::Value, option, Origin::Argument(option), name, allowed);
        let nearest = nearest::word(&name.replace('_', "-"), names);
        Err(Box::new(complaint.suggesting(nearest)))
    }
}

/// All quantities, by kind of study.
pub const QUANTITIES: &[&[MapQuantity]] = &[belt::QUANTITIES, disc::QUANTITIES, system::QUANTITIES];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_variables_follow_them() {
        for of_kind in QUANTITIES {
            let mut names: Vec<&str> = of_kind.iter().map(|quantity| quantity.name).collect();
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count);
        }
        for quantity in QUANTITIES.iter().copied().flatten() {
            let first = quantity.variables.first().expect("a variable");
            assert_eq!(first.name, quantity.name.replace('-', "_"));
            let found = MapQuantity::named_for(quantity.kind, quantity.name, "--quantity");
            assert_eq!(found, Ok(quantity));
        }
        let refused =
            MapQuantity::named("stick_fraction", "--quantity").expect_err("an underscore");
        assert_eq!(refused.suggestion.as_deref(), Some("stick-fraction"));
    }
}
