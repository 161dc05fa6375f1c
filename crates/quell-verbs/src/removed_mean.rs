//! The mean of samples: a dither has zero mean, so that the mean of samples is taken out, which `check` reports.

use quell_model::Waveform;

use crate::words::digits;

/// Means below this share of the peak are rounding.
const ROUNDING: f64 = 1e-12;

/// A warning about each waveform of a study from whose samples a mean was taken out.
pub(crate) fn warnings<'a>(waveforms: impl Iterator<Item = &'a Waveform>) -> Vec<String> {
    let of = |(place, waveform): (usize, &Waveform)| {
        let Waveform::Samples(samples) = waveform else { return None };
        let mean = samples.mean();
        (mean.abs() > ROUNDING * waveform.peak()).then(|| {
            format!(
                "the samples of dither[{place}] have the mean {}, which is taken out: a dither has zero mean",
                digits(mean)
            )
        })
    };
    waveforms.enumerate().filter_map(of).collect()
}
