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

mod belt;
mod catalogue;
mod chunks;
mod cost;
mod disc;
mod evaluate;
mod grid;
mod kind;
mod mapped;
mod plan;
mod quantity;
mod quench;
mod quench_variables;
mod refine;
mod runner;
mod shard;
mod sheet;
mod status;
mod system;

pub use catalogue::QUANTITIES;
pub use chunks::Chunks;
pub(crate) use disc::growth_alone as growth_of_disc;
pub use evaluate::{Computation, ResponseNumbers, Results};
pub use grid::{Grid, GridAxis, MOST_POINTS};
pub use plan::Plan;
pub use quantity::{MapQuantity, Variable, VariableKind};
pub use quench::QuenchNumbers;
pub(crate) use quench::least_quiet;
pub(crate) use runner::run;
pub use runner::{MOST_THREADS, Progress, Running};
pub use shard::Shard;
pub use sheet::{Content, Data, MISSING, MapArray, Sheet, VariableArrays};
pub use status::Status;
pub(crate) use system::growth as growth_of_system;
