//! The band of slow vibration, in which self-excited vibration lies and E is measured.

/// Upper end of the band, in ω₀ (2.27).
pub const BAND_END: f64 = 1.9;
