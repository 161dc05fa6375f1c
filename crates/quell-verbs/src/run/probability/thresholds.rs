//! The least quiet amplitudes of samples, and their quantiles.

use quell_design::probability::quantile;
use quell_numerics::order::ascending;

use super::unknown::{NoSampledThreshold, NoThresholdQuantile};

/// Samples of which the threshold is computed by averaging, at most.
const MOST: usize = 10_000;

/// The least quiet amplitudes of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledThresholds {
    /// Known amplitudes of the first dither, ascending: 0 of a sample that is quiet without it, infinite of one that no amplitude
    /// quiets.
    pub amplitudes: Vec<f64>,
    /// Samples whose threshold is unknown.
    pub unknown: usize,
    /// Why the first of them is.
    pub why: Option<NoSampledThreshold>,
}

impl SampledThresholds {
    /// Whether the threshold of a sample is computed: averages of the first ones alone, which are random as any others.
    pub(super) fn includes(number: usize) -> bool {
        number < MOST
    }

    pub(super) fn of<'a>(
        thresholds: impl Iterator<Item = &'a Result<f64, NoSampledThreshold>>,
    ) -> Self {
        let mut found = Self { amplitudes: Vec::new(), unknown: 0, why: None };
        for threshold in thresholds {
            match threshold {
                Ok(amplitude) => found.amplitudes.push(*amplitude),
                Err(why) => {
                    found.unknown += 1;
                    found.why.get_or_insert_with(|| why.clone());
                }
            }
        }
        ascending(&mut found.amplitudes);
        found
    }

    /// The amplitude that is enough for a share of the samples.
    ///
    /// # Errors
    /// Why no amplitude is known to be.
    pub(crate) fn quantile(&self, share: f64) -> Result<f64, NoThresholdQuantile> {
        let unknown = || NoThresholdQuantile::NoneKnown(self.why.clone());
        let found = quantile(&self.amplitudes, share).ok_or_else(unknown)?;
        if found.is_finite() {
            return Ok(found);
        }
        let never = self.amplitudes.iter().filter(|amplitude| amplitude.is_infinite()).count();
        let all = self.amplitudes.len();
        Err(NoThresholdQuantile::NeverQuiet { never, all })
    }
}
