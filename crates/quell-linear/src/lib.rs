//! Linear questions about structures with friction contacts: pure functions of valid values.
//!
//! * [`averaging`]: effective friction under fast dither, stability of steady sliding, critical amplitudes;
//! * [`growth`]: growth rate, its error and the verdict that they allow.

pub mod averaging;
pub mod growth;
