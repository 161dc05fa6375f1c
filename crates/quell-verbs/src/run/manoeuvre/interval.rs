//! An interval in which a run vibrates.

/// The level of vibration above which an interval of vibration begins, and the lower one below which it has ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VibrationLimits {
    /// Level above which it begins.
    pub begins_above: f64,
    /// Level below which it has ended.
    pub ends_below: f64,
}

/// The level of vibration at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VibrationLevel {
    /// The middle of the window of time.
    pub time: f64,
    /// Half of the peak-to-peak displacement within one natural period, without its drift.
    pub level: f64,
}

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
