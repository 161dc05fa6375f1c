//! Limits on the effort of a verb, so that none runs indefinitely.

/// Largest number of integration steps in all runs of one search: for an orbit, for the attractor of a start, or for one value
/// of a parameter. Ordinary searches take a hundredth of it.
pub(crate) const STEPS_OF_A_SEARCH: u64 = 100_000_000;

/// Largest number of integration steps in all runs of a verb with many searches.
pub(crate) const STEPS_OF_MANY_SEARCHES: u64 = 10 * STEPS_OF_A_SEARCH;
