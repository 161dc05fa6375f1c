//! Mass on a moving belt.

pub mod averaging;
