//! What the computations of a disc rest on, and where the print of chapter 5 is wrong.

use quell_disc::Dither;

use super::{Citation, Correction, MICHAUX_2005, Sources, Task};
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;

const BOTH: &[Task] = &[Task::Stability, Task::Resonances];

/// Citations and corrections of a disc study.
pub(super) fn sources(study: &DiscStudy) -> Sources {
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
    Sources { citations, corrections: corrections(computed, study.disc().dither()) }
}

fn corrections(computed: bool, dither: Dither) -> Vec<Correction> {
    let dithered = dither != Dither::None;
    let entries: [(bool, Correction); 8] = [
        (
            true,
            Correction {
                equations: "(5.18), (5.25), (5.32)",
                right: "the double sum has A_ij″ and A_ij′, as (5.15) has them; taken literally the verdict flips",
                tasks: BOTH,
            },
        ),
        (
            computed,
            Correction {
                equations: "(5.2), (5.5)",
                right: "(∂ᵣᵣ + ∂ᵣ/r + ∂_θθ/r²)² is an operator, without w inside; ∂²/∂θ², not ∂/∂θ²",
                tasks: &[Task::Modes],
            },
        ),
        (
            computed,
            Correction {
                equations: "(5.7b)",
                right: "there is no sin 0: for j = 0 the condition does not hold",
                tasks: &[Task::Modes],
            },
        ),
        (
            true,
            Correction {
                equations: "(5.14), text of figures 5.8–5.15",
                right: "modal damping ξ of a disc at rest is 2ξβ(A′ − qΩB), 2ξβ(B′ + qΩA); without the circulatory pair the \
                        free disc would be unstable beyond Ω = β/q",
                tasks: BOTH,
            },
        ),
        (
            true,
            Correction {
                equations: "(5.39)–(5.66)",
                right: "complex modes need half of R² for l ≠ 0: with (5.7) put in literally every coupling is doubled",
                tasks: &[Task::Resonances],
            },
        ),
        (
            dithered,
            Correction {
                equations: "(5.40)–(5.51)",
                right: "α cos Rτ is α/2 in the complex form",
                tasks: &[Task::Resonances],
            },
        ),
        (
            true,
            Correction {
                equations: "(5.55), table 5.1",
                right: "Ω = 0 is a meeting too; places alone say nothing of instability",
                tasks: &[Task::Resonances],
            },
        ),
        (
            matches!(dither, Dither::Tangential { .. }),
            Correction {
                equations: "text after (5.56)",
                right: "tangential dither does suppress the undithered tongues at first order: they are driven by the mean \
                        friction, which it takes away",
                tasks: &[Task::Resonances],
            },
        ),
    ];
    entries.into_iter().filter(|(bears, _)| *bears).map(|(_, correction)| correction).collect()
}
