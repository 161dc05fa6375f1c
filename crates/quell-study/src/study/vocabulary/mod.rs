//! Every key a study file can have, made from the registry of parameters.
//!
//! One list serves the readers, `--set`, sweeps, suggestions and the JSON Schema.

mod course;
mod distributions;
mod key;
mod key_unit;
mod keys;
mod of_systems;
mod section;
pub mod size;
mod wave;
mod words;

/// What the key [`UNITS`] is.
pub const UNITS_ABOUT: &str =
    "units of bare numbers [default: none; SI where mass and stiffness of a belt are given]";

/// The key of the units of bare numbers, in the table of a belt, a disc or a system.
pub const UNITS: &str = "units";

pub use course::{CourseKey, CourseTable, DISC_DRIVE, DRIVE, ENVELOPE, LOAD, LOAD_ENVELOPE};
pub(crate) use distributions::{CORRELATED, DISTRIBUTIONS, JOINTLY_NORMAL};
pub use key::{Key, Role, RowUnit, SCHEMA_ABOUT, join};
pub(in crate::study) use key_unit::KeyUnit;
pub use keys::{key, keys, keys_of, law_keys};
pub use section::{DocumentKind, KeyScope, Section};
pub use wave::{WAVE_KEYS, WaveKey};
pub use words::{Choice, FRICTION};

/// Version of the study file that this program reads.
pub const SCHEMA_VERSION: u32 = 1;

/// Tables of the design that are not implemented yet.
pub const NOT_BUILT: &[&str] = &["input", "sample"];

/// Maximum number of points of an axis of a map.
pub const MOST_POINTS: u32 = 10_000_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_in_the_tables_of_a_kind() {
        for kind in DocumentKind::ALL {
            for section in Section::ALL {
                let mut names: Vec<&str> = keys_of(*section, kind).map(|key| key.name).collect();
                let count = names.len();
                names.sort_unstable();
                names.dedup();
                assert_eq!(names.len(), count, "{kind:?} {section:?}");
            }
        }
    }

    #[test]
    fn every_key_is_found_in_its_table() {
        assert!(Section::ALL.is_sorted());
        for key in keys() {
            let kind = DocumentKind::ALL.into_iter().find(|kind| key.scope.includes(*kind));
            let found = super::key(key.section, key.name, kind.expect("a kind"));
            assert_eq!(found, Some(key), "{}", key.path());
        }
    }

    #[test]
    fn every_parameter_stands_in_its_table() {
        for key in keys() {
            if let Role::Number(parameter) = key.role {
                // What oscillates stands in several tables.
                let inner =
                    key.section.oscillates().is_some() && key.path().ends_with(parameter.path);
                assert!(inner || key.path() == parameter.path, "{}", parameter.path);
            }
        }
    }
}
