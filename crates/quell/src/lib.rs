//! Front door of Quell.

pub mod cite;
pub mod complaint;
pub mod dataset;
pub mod fields;
pub mod input;
pub mod output;
pub mod picture;
pub mod plot;
pub mod quantity;
pub mod reproduce;
pub mod run;
pub mod schema;
pub mod store;
pub mod study;
pub mod sweep;
pub mod template;

pub use complaint::{Complaint, Failure, Fault, Origin};
pub use study::{Change, DiscStudy, Study, Subject};
