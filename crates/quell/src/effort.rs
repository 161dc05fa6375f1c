//! The largest effort of a verb, so that none runs indefinitely.

/// Most steps of all runs that one search takes: for an orbit, for where one start ends, or for one value of a parameter.
/// Ordinary ones take a hundredth of it.
pub(crate) const STEPS_OF_A_SEARCH: u64 = 100_000_000;

/// Most steps of all runs that a verb of many searches takes.
pub(crate) const STEPS_OF_MANY_SEARCHES: u64 = 10 * STEPS_OF_A_SEARCH;
