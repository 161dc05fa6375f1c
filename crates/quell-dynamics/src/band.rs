//! The band of slow vibration, which contains the self-excited vibration and over which E is measured.

/// Upper end of the band, in ω₀ (2.27). Self-excited vibration is at about the natural frequency, 1, and the band ends below
/// its second harmonic. Lower, vibration would be missed; higher, a slow dither's own response would count as slow vibration.
pub const BAND_END: f64 = 1.9;
