//! The tests of the command line.
//!
//! One program: each links the whole workspace, and its tests share the processors.

mod actuator;
mod actuator_range;
mod attractors;
mod command_line;
mod convert;
mod disc;
mod dither_sizes;
mod doors;
mod endings;
mod exchange;
mod extremes;
mod fit;
mod inputs;
mod noise;
mod orbit;
mod pages;
mod place;
mod receptance;
#[path = "place/repository.rs"]
mod repository;
mod reproduce;
mod si;
mod sound;
mod systems;
