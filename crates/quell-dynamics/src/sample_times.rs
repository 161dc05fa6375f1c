//! The times at which a run is sampled.

/// Times in ascending order.
#[derive(Clone, Debug)]
pub(crate) enum SampleTimes {
    /// `count` times from `first`, `step` apart.
    Even {
        /// The first time.
        first: f64,
        /// Time between two samples.
        step: f64,
        /// Number of samples.
        count: usize,
    },
    /// These times.
    Given(Vec<f64>),
}

impl SampleTimes {
    /// The time of a sample; `None` after the last.
    #[inline]
    pub(crate) fn get(&self, index: usize) -> Option<f64> {
        match self {
            Self::Even { first, step, count } => {
                (index < *count).then(|| f64::mul_add(index as f64, *step, *first))
            }
            Self::Given(times) => times.get(index).copied(),
        }
    }
}
