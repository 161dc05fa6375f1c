//! One conformance suite for every belt of `quell_zoo`, through every engine that applies.
//!
//! Asserted are identities and the agreement of two methods, no numbers: a new model is one line in the zoo, and is tested
//! here without a change.

mod attractors;
mod averaging;
#[path = "../shared/balance.rs"]
mod balance;
#[path = "../shared/orbits.rs"]
mod belt_orbits;
mod orbits;
mod response;
mod simulation;
