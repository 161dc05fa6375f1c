//! Every key a study file can have, made from the registry of parameters.
//!
//! One list serves the reader, `--set`, sweeps, suggestions and the JSON Schema.

mod course;
mod key;
mod keys;
mod resolve;
pub mod size;
mod words;

/// What the key [`UNITS`] is.
pub const UNITS_ABOUT: &str =
    "units of bare numbers [default: none; SI where mass and stiffness of a belt are given]";

/// The key of the units of bare numbers, in the table of a belt, a disc or a system.
pub const UNITS: &str = "units";

pub use course::{CourseKey, CourseTable, DISC_DRIVE, DRIVE, ENVELOPE, LOAD, LOAD_ENVELOPE};
pub use key::{Key, Role, SCHEMA_ABOUT, Section, WAVE_KEYS, WaveKey, join};
pub use keys::{key, keys, keys_of};
pub use resolve::{Address, resolve, with_unit};
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
    fn paths_are_unique_and_resolve_to_themselves() {
        let mut paths: Vec<String> = keys().iter().map(Key::path).collect();
        for path in &paths {
            let address = resolve(path).expect(path);
            assert_eq!(&address.key.path(), path);
        }
        paths.sort();
        let count = paths.len();
        paths.dedup();
        assert_eq!(paths.len(), count);
    }

    #[test]
    fn every_parameter_stands_in_its_table() {
        for key in keys() {
            if let Role::Number(parameter) = key.role {
                assert_eq!(key.path(), parameter.path);
            }
        }
    }

    #[test]
    fn indices_belong_to_lists_alone() {
        assert_eq!(resolve("dither[1].amplitude_n").map(|found| found.index), Ok(Some(1)));
        assert!(resolve("belt[0].damping_ratio").is_err());
        assert!(resolve("dither[one].amplitude").is_err());
    }
}
