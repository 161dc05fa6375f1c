//! `quell map` by the real binary: what it answers, and what its stores survive.

mod answers;
mod faults;
mod place;
mod shards;
mod strangers;
