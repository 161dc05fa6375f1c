//! Study files: document → a valid [`Study`]; all errors are reported together.
//!
//! | module | what |
//! |---|---|
//! | [`study`] | the study of any kind, its keys, and changes to it |
//! | [`quantity`] | numbers with units in options and arguments |
//! | [`schema`] | the JSON Schema of a study file |
//!
//! Text, files and complaints are those of `quell_input`. This crate computes nothing: the engines take the belt or the disc of a study, and the crate `quell` runs them.
//!
//! ```
//! use quell_study::Study;
//!
//! let text = "
//!     [belt]
//!     damping_ratio = 0.005
//!     normal_load = 1.0
//!     belt_velocity = 0.05
//!     [friction]
//!     law = \"coulomb\"
//!     coefficient = 0.3
//! ";
//! let study = Study::parse(text, &[]).expect("valid");
//! assert_eq!(study.belt().expect("a belt").belt().belt_velocity(), 0.05);
//! let wrong = Study::parse(&text.replace("0.05", "-1"), &[]).expect_err("a belt moves forwards");
//! assert_eq!(wrong[0].key, "belt.belt_velocity");
//! ```

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod quantity;
pub mod schema;
pub mod study;

pub use quell_input::complaint::{Complaint, Complaints, Failure, Fault, Origin};
pub use study::{BeltStudy, Change, DiscStudy, Kind, Study};
