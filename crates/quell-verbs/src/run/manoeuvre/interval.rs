//! An interval in which a run vibrates.

/// An interval of vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VibrationInterval {
    /// Its beginning; the start of the run if it vibrates there already.
    pub from: f64,
    /// Its end; the end of the run if it still vibrates there.
    pub to: f64,
    /// Largest vibration in it: half of the peak-to-peak displacement within one natural period, without its drift.
    pub level: f64,
}
