//! The schema of the keys that describe a waveform.

use quell_model::waveform::{LARGEST_SEED, MOST_LINES, NOISE};
use serde_json::{Value as Json, json};

use crate::study::vocabulary::{Choice, WaveKey};

/// The keys of noise, and those of periodic waveforms (`periodic`) that noise does not have: a dither has one or the other.
pub(super) fn noise_or_periodic(periodic: &[&str]) -> Json {
    let none_of = |keys: &[&str]| {
        let each: Vec<Json> = keys.iter().map(|key| json!({ "required": [key] })).collect();
        json!({ "anyOf": each })
    };
    json!({ "anyOf": [
        { "properties": { "waveform": { "const": NOISE } }, "not": none_of(periodic) },
        {
            "properties": { "waveform": { "not": { "const": NOISE } } },
            "not": none_of(&["band", "band_hz", "lines", "seed"]),
        },
    ] })
}

/// The value of a part of the description of a waveform.
pub(super) fn property(wave: WaveKey) -> Json {
    let count = |least: u32| json!({ "type": "integer", "minimum": least });
    match wave {
        WaveKey::Harmonics => json!({
            "type": "array", "minItems": 1, "items": {
                "type": "object", "required": ["order"], "additionalProperties": false,
                "properties": {
                    "order": { "type": "integer", "minimum": 1 },
                    "sine": { "type": "number" },
                    "cosine": { "type": "number" },
                },
            },
        }),
        WaveKey::Values => json!({ "type": "array", "minItems": 2, "items": { "type": "number" } }),
        WaveKey::File => json!({ "type": "string" }),
        WaveKey::Hold => json!({ "enum": Choice::Hold.names() }),
        WaveKey::Carrier => json!({ "enum": Choice::Carrier.names() }),
        WaveKey::On => count(1),
        WaveKey::Off => count(0),
        WaveKey::Band | WaveKey::BandHz => json!({
            "type": "array", "items": { "type": ["number", "string"] }, "minItems": 2, "maxItems": 2,
        }),
        WaveKey::Lines => json!({ "type": "integer", "minimum": 1, "maximum": MOST_LINES }),
        WaveKey::Seed => json!({ "type": "integer", "minimum": 0, "maximum": LARGEST_SEED }),
    }
}
