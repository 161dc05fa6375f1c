//! One conformance suite for every friction law and every waveform.
//!
//! It runs over [`quell_model::LawKind::ALL`] and [`quell_model::Waveform::NAMED`]: a new law
//! or waveform is one file and one line in its list, and is tested here without any change.

mod law_numbers;
mod law_powers;
mod law_samples;
mod law_scaling;
mod law_series;
mod law_validity;
mod waveform;
mod waveform_integral;
