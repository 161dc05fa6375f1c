//! Tests of the binary: answers of `quell map`, and faults that its stores survive.

mod answers;
mod faults;
mod place;
mod shards;
mod strangers;
