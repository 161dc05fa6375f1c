//! What the computations of a disc rest on.

use quell_disc::Dither;

use super::{Citation, MICHAUX_2005, Task};
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;

/// Citations of a disc study.
pub(super) fn citations(study: &DiscStudy) -> Vec<Citation> {
    let mut citations = Vec::new();
    let mut cite = |task, used| citations.push(Citation { source: MICHAUX_2005, task, used });
    let computed = matches!(study.source(), ModeSource::Plate(_));
    if computed {
        cite(
            Task::Modes,
            "plate clamped inside and free outside (5.1)–(5.7), reference frequency (5.17)",
        );
    }
    let motion = match study.disc().dither() {
        Dither::None => "equations of motion (5.15), (5.18)",
        Dither::Normal { .. } => "equations of motion under normal dither (5.22)–(5.25)",
        Dither::Tangential { .. } => "equations of motion under tangential dither (5.31), (5.32)",
    };
    cite(Task::Stability, motion);
    cite(
        Task::Resonances,
        "complex form (5.41), places (5.55), (5.56), slow equations (5.43)–(5.54), (5.57)–(5.66)",
    );
    citations
}
