//! Noise in the answers of a study: its band in words and in JSON, and the warning about few lines.

use quell_model::System;
use quell_model::system::{Input, InputTarget};
use quell_model::units::Quantity;
use quell_model::waveform::{FEWEST_GAUSSIAN_LINES, Noise};
use serde_json::{Value as Json, json};

use crate::words::plural;

/// "64 lines, seed 1".
pub fn lines_in_words(noise: &Noise) -> String {
    let count = noise.lines().len();
    format!("{count} line{}, seed {}", plural(count), noise.seed())
}

/// The two ends of the band of a dither in words, "8 to 12"; `in_words` writes a frequency.
pub fn band_in_words(
    noise: &Noise,
    middle: f64,
    in_words: impl Fn(Quantity, f64) -> String,
) -> String {
    let [low, high] = noise.band(middle).map(|end| in_words(Quantity::FrequencyRatio, end));
    format!("{low} to {high}")
}

/// Lines and seed as JSON, with the ends of the band of a dither.
pub(crate) fn json(noise: &Noise, middle: f64) -> Json {
    json!({
        "band": noise.band(middle),
        "lines": noise.lines().len(),
        "seed": noise.seed(),
    })
}

/// The warning about averages over noise of so few lines that their distribution is not Gaussian.
pub(crate) fn few_lines(system: &System) -> Option<String> {
    let noises = system.waves().filter_map(|wave| wave.waveform.noise());
    let few =
        noises.filter(|noise| !noise.is_gaussian()).min_by_key(|noise| noise.lines().len())?;
    let count = few.lines().len();
    Some(format!(
        "averages assume that the velocity under noise is Gaussian; with {count} line{}, fewer than {FEWEST_GAUSSIAN_LINES}, the mean \
         friction over the lines differs from that by more than 1 % of the static level",
        plural(count)
    ))
}

/// The warning about finite-R averaging under normal noise, of which the second order is left out.
pub(crate) fn normal_noise(system: &System) -> Option<String> {
    let of_load = |input: &Input| matches!(input.target, InputTarget::NormalLoad { .. });
    let mut waves =
        system.inputs.iter().filter(|input| of_load(input)).flat_map(|input| input.profile.waves());
    waves.any(|wave| wave.waveform.noise().is_some()).then(|| {
        "averaging under noise of a load has the response of the structure to each line and the first order of the motion alone: the \
         second order has slow differences of the lines' frequencies, and no Gaussian distribution"
            .to_owned()
    })
}
