//! Front door of Quell.

pub mod complaint;
pub mod plot;
pub mod study;

pub use complaint::{Complaint, Failure, Fault, Origin};
pub use study::{Change, Study};
