//! Limits on the effort of a verb, so that none runs indefinitely.

/// Largest number of integration steps in all runs of one search: for an orbit, for the attractor of a start, or for one value
/// of a parameter. Ordinary searches take a hundredth of it.
pub const STEPS_OF_A_SEARCH: u64 = 100_000_000;

/// Largest number of integration steps in all runs of a verb with many searches.
pub(crate) const STEPS_OF_MANY_SEARCHES: u64 = 10 * STEPS_OF_A_SEARCH;

/// Largest number of integration steps for one of several alternatives that a verb compares, some ten seconds. Where a motion is very
/// sensitive, a branch has many short steps.
pub(crate) const STEPS_OF_AN_ALTERNATIVE: u64 = STEPS_OF_A_SEARCH / 10;
