//! The questions of Quell: a study and a request in, a typed answer out.
//!
//! Each verb is one function in [`run`]. What it needs of a study is a line of [`needs::VERBS`]. Nothing is drawn or printed here: the
//! crate `quell` presents the answers.
//!
//! | module | content |
//! |---|---|
//! | [`run`] | one function per question, with its answer |
//! | [`needs`] | what a question needs of a study, and the list of verbs |
//! | [`running`], [`parallel`] | threads, progress, interruption |
//! | [`status`] | why one of many values is known or unknown |
//! | [`dataset`], [`fields`], [`disc_units`] | labelled arrays, JSON objects, units of discs |
//! | [`output`] | files that are complete or absent |
//! | [`cite`] | sources of a study's computations |
//! | [`sound`] | the velocity of a motion as a sound file |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod cite;
pub mod contact_state;
pub mod dataset;
pub mod disc_units;
pub mod effort;
pub mod fields;
pub mod needs;
pub mod noise;
pub mod output;
pub mod parallel;
pub mod range;
mod reasons;
mod removed_mean;
pub mod run;
pub mod running;
pub mod sound;
pub mod status;
pub mod words;

pub use quell_input::{complaint, document, input, nearest, said};
pub use quell_study::{quantity, study};
