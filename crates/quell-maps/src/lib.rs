//! Maps: quantities over the product of axes.
//!
//! ```text
//! study with [[sweep]] → Grid (points) ┐
//! names of quantities  → Sheet (arrays) ┴→ Plan (chunks) → runner → arrays, store → FinishedMap
//! ```
//!
//! | module | content |
//! |---|---|
//! | [`sweep`] | points, quantities, chunks |
//! | [`store`] | stores that survive interruptions |
//! | [`map`] | a map computed, resumed or shared among processes, and its boundaries |

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod map;
pub mod store;
pub mod sweep;

use quell_input::{complaint, nearest};
use quell_study::study;
use quell_verbs::{
    cite, contact_state, dataset, disc_units, effort, fields, needs, output, parallel, range, run,
    running, status, words,
};
