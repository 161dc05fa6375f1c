//! One number of a study varied over a range: `--parameter PATH --from A --to B --points N`.

use crate::study::vocabulary::size::SignalMeasure;
use crate::study::vocabulary::{DocumentKind, Role, join};
use crate::study::{Study, SystemStudy, key_at, with_unit};

/// What a varied number must be.
pub(super) const OF_THE_EQUATIONS: &str = "a number of the equations, such as one of a contact, a friction law or a dither; this one changes none of them";

/// Most values of a range.
pub const MOST_VALUES: usize = 100_000;

/// A requested number of a study and the range of its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Path of the number.
    pub parameter: String,
    /// First value, in the unit of the key.
    pub from: f64,
    /// Last value, above the first.
    pub to: f64,
    /// Number of values, both ends included.
    pub points: usize,
}

/// The number of the equations that a path means which names none itself, such as the peak amplitude for a root mean square.
pub(super) fn number_meant(study: &SystemStudy, path: &str) -> Option<String> {
    let table = path.trim().rsplit_once('.').map_or("", |(table, _)| table);
    let meant = match key_at(path, study.document_kind()) {
        Ok(address) => address.key.parameter().map(|parameter| join(table, parameter.key())),
        Err(nearest) => nearest,
    };
    meant.filter(|path| study.number(path).is_some())
}

/// Why a key that gives an amplitude by another size than its peak cannot be varied here.
pub(super) fn not_a_peak(path: &str, kind: DocumentKind) -> Option<&'static str> {
    let role = key_at(path, kind).ok()?.key.role;
    let measure = match role {
        Role::Size(_, size) if size.needs_actuator() => {
            return Some(
                "the force of a voltage or current depends on the frequency and the waveform",
            );
        }
        Role::Size(_, size) => size.measure,
        _ => return None,
    };
    match measure {
        SignalMeasure::Peak => None,
        SignalMeasure::RootMeanSquare => Some("a root mean square depends on the waveform"),
        SignalMeasure::PeakToPeak => Some("a peak-to-peak value depends on the waveform"),
    }
}

/// The key by which a study gives a number of the equations: a frequency in hertz in a study with units.
pub fn key_of(study: &Study, path: &str) -> String {
    if study.scales().is_some() { with_unit(path) } else { path.to_owned() }
}
