//! Maps: quantities over the product of axes.
//!
//! ```text
//! study with [[sweep]] → Grid (points) ┐
//! names of quantities  → Sheet (arrays) ┴→ Plan (chunks) → runner → arrays, store
//! ```
//!
//! An axis of a disc's speed gets more points than it specifies: see `refine`.
//!
//! A point is the study with its numbers set as by `--set`, and its result depends on
//! nothing else: it has the same bits alone, in any chunk and with any number of threads.

mod chunks;
mod grid;
mod map_quantity;
mod plan;
mod points;
mod quantity;
mod refine;
mod runner;
mod shard;
mod sheet;

pub use chunks::Chunks;
pub use grid::{Grid, GridAxis, MOST_POINTS};
pub use map_quantity::{MapQuantity, Variable, VariableKind};
pub use plan::Plan;
pub use quantity::QUANTITIES;
pub(crate) use runner::run;
pub use shard::Shard;
pub use sheet::{Content, Data, MISSING, MapArray, Sheet, VariableArrays};
