//! The table of the atlas at round numbers of the groups.

use quell_design::atlas::{Atlas, AtlasAnswer, AtlasLaw, AtlasPoint, WAVEFORMS};

/// Values of R.
pub(crate) const FREQUENCY_RATIOS: [f64; 5] = [5.0, 10.0, 20.0, 50.0, 200.0];
/// Values of ζ_f/R.
pub(crate) const DAMPINGS_PER_CYCLE: [f64; 5] = [0.001, 0.01, 0.05, 0.1, 0.2];
/// Values of κ.
pub(crate) const RELATIVE_DAMPINGS: [f64; 7] = [0.0, 0.02, 0.05, 0.1, 0.2, 0.5, 0.8];
/// Values of v₀/v_m over the largest of the law.
pub(crate) const VELOCITY_SHARES: [f64; 11] =
    [0.02, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

/// Every answer at round numbers: over law, waveform, R, ζ_f/R, κ and the share of the largest velocity, the last fastest.
pub(crate) fn round_numbers(atlas: &Atlas) -> Vec<Option<AtlasAnswer>> {
    let mut answers = Vec::new();
    for law in AtlasLaw::ALL {
        for waveform in WAVEFORMS {
            for frequency_ratio in FREQUENCY_RATIOS {
                for per_cycle in DAMPINGS_PER_CYCLE {
                    for relative_damping in RELATIVE_DAMPINGS {
                        answers.extend(VELOCITY_SHARES.map(|share| {
                            atlas.answer(&AtlasPoint {
                                law,
                                waveform: waveform.clone(),
                                relative_damping,
                                relative_velocity: share * law.largest_velocity(),
                                frequency_ratio,
                                friction_damping: per_cycle * frequency_ratio,
                            })
                        }));
                    }
                }
            }
        }
    }
    answers
}
