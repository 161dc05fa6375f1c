//! Sources of the computations of a disc.

use quell_model::disc::DiscDither;

use super::citation::{Citation, Task};
use super::references::{
    CHAN_1994, IWAN_STAHL_1973, MICHAUX_2005, NAYFEH_MOOK_1979, TAKAHASHI_IMADA_1984,
    VOGEL_SKINNER_1965,
};
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;

/// Citations of a disc study.
pub(super) fn citations(study: &DiscStudy) -> Vec<Citation> {
    let mut citations = Vec::new();
    let mut cite = |task, source, used| citations.push(Citation { source, task, used });
    let computed = matches!(study.source(), ModeSource::Plate(_));
    if computed {
        cite(
            Task::Modes,
            MICHAUX_2005,
            "plate clamped inside and free outside (5.1)–(5.7), reference frequency (5.17)",
        );
        cite(Task::Modes, VOGEL_SKINNER_1965, "frequencies and shapes of the annular plate");
    }
    let motion = match study.disc().dither() {
        DiscDither::None => "equations of motion (5.15), (5.18)",
        DiscDither::Normal { .. } => "equations of motion under normal dither (5.22)–(5.25)",
        DiscDither::Tangential { .. } => {
            "equations of motion under tangential dither (5.31), (5.32)"
        }
    };
    cite(Task::Stability, MICHAUX_2005, motion);
    cite(Task::Stability, IWAN_STAHL_1973, "a disc under a rotating load");
    cite(Task::Stability, CHAN_1994, "friction as a follower force");
    if study.disc().dither() != DiscDither::None {
        cite(
            Task::Stability,
            TAKAHASHI_IMADA_1984,
            "Floquet exponents by a fourth-order splitting",
        );
    }
    cite(Task::Resonances, NAYFEH_MOOK_1979, "multiple scales");
    cite(
        Task::Resonances,
        MICHAUX_2005,
        "complex form (5.41), resonant speeds (5.55), (5.56), slow equations (5.43)–(5.54), (5.57)–(5.66)",
    );
    citations
}
