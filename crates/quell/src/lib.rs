//! Front door of Quell.

pub mod plot;
