//! `design`: the least dither that is quiet over a box of operating points, under limits.
//!
//! | file | contents |
//! |---|---|
//! | (in `run::disc` and `run::system`) | the question about a kind of study |
//! | `study_with_design` | what a kind of study answers about itself |
//! | `least`, `sampling`, `sensitivity` | the search over waveforms, random samples, derivatives |
//! | `found` | what is found |
//! | `answer`, `confident`, `covered`, `drive`, `frontier`, `schedule`, `slow`, `validity` | its parts as sentences, warnings and JSON |

mod answer;
mod confident;
mod covered;
mod drive;
mod found;
pub mod frontier;
mod least;
mod sampling;
mod schedule;
mod sensitivity;
mod slow;
mod slow_response;
mod study_with_design;
mod unknown;
mod validity;
mod waveform;

pub use answer::quantity_of;
pub use found::{
    AmplitudeRate, ConfidentDither, DesignNumber, DesignSensitivity, DesignedDither,
    LeastDitherFound,
};
pub(crate) use found::{DesignNumbers, TriedDither};
pub(crate) use least::{asked, at_end, least_dither, least_system_dithers, without_amplitude};
pub use slow_response::{LargestSlowResponse, SlowResponse};
pub use study_with_design::{FrequencyScale, StudyWithDesign};
pub use unknown::{
    NoAmplitudeRate, NoConfidentDither, NoCoveredPart, NoDesignSensitivity, NoSaving, NoSchedule,
    NoSlowLevel, NoSlowResponse,
};
pub(crate) use waveform::{system_with_waveform, with_wave};
