//! Mass on a moving belt.
