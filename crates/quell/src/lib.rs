//! Front door of Quell.

pub mod cite;
pub mod dataset;
pub mod fields;
pub mod output;
pub mod picture;
pub mod run;
pub mod store;
pub mod sweep;
pub mod template;

pub use quell_plot as plot;
pub use quell_study::{complaint, input, quantity, schema, study};

pub use complaint::{Complaint, Failure, Fault, Origin};
pub use study::{Change, DiscStudy, Study, Subject};
