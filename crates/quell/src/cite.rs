//! Which equations and sources a study's computations use, and where the print was corrected.
//!
//! Equation numbers are those of Michaux (2005). Each correction was found by comparing the
//! printed formula with quadrature of its definition; the numbers are in `reference/`.

use quell_model::{Belt, Direction, LawKind, Waveform};
use serde_json::{Value as Json, json};

use crate::study::Study;

/// A computation, named after its verb.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Task {
    /// Effective friction.
    Friction,
    /// Averaged stability of steady sliding.
    Stability,
    /// A trajectory with its events.
    Simulate,
    /// The steady response.
    Response,
}

impl Task {
    /// Every task.
    pub const ALL: &'static [Self] = &[
        Self::Friction,
        Self::Stability,
        Self::Simulate,
        Self::Response,
    ];

    /// Name of the verb.
    pub fn name(self) -> &'static str {
        match self {
            Self::Friction => "friction",
            Self::Stability => "stability",
            Self::Simulate => "simulate",
            Self::Response => "response",
        }
    }
}

/// A published source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// Key in `references.bib`.
    pub key: &'static str,
    /// The full reference.
    pub reference: &'static str,
}

/// The dissertation that states the problem and whose equations are numbered here.
pub const MICHAUX_2005: Source = Source {
    key: "michaux2005",
    reference: "M. A. Michaux: Suppression of Friction-Induced Oscillations through Use of \
                High-Frequency Dither Signals. PhD thesis, Georgia Institute of Technology, 2005",
};
/// Averaging of the belt with tangential dither, and the Stribeck law used here.
pub const THOMSEN_1999: Source = Source {
    key: "thomsen1999",
    reference: "J. J. Thomsen: Using fast vibrations to quench friction-induced oscillations. \
                Journal of Sound and Vibration 228(5), 1079–1102, 1999",
};
/// Stick-slip of the undithered belt.
pub const THOMSEN_FIDLIN_2003: Source = Source {
    key: "thomsen2003",
    reference: "J. J. Thomsen, A. Fidlin: Analytical approximations for stick–slip vibration \
                amplitudes. International Journal of Non-Linear Mechanics 38(3), 389–403, 2003",
};
/// Dither against brake squeal, on a brake.
pub const CUNEFARE_GRAF_2002: Source = Source {
    key: "cunefare2002",
    reference: "K. A. Cunefare, A. J. Graf: Experimental active control of automotive disc brake \
                rotor squeal using dither. Journal of Sound and Vibration 250(4), 579–590, 2002",
};
/// Taylor steps and their control.
pub const JORBA_ZOU_2005: Source = Source {
    key: "jorba2005",
    reference: "À. Jorba, M. Zou: A software package for the numerical integration of ODEs by \
                means of high-order Taylor methods. Experimental Mathematics 14(1), 99–117, 2005",
};
/// Solutions of differential equations with set-valued right-hand sides.
pub const FILIPPOV_1988: Source = Source {
    key: "filippov1988",
    reference: "A. F. Filippov: Differential Equations with Discontinuous Righthand Sides. \
                Kluwer, Dordrecht, 1988",
};
/// The Hann window and its peers.
pub const HARRIS_1978: Source = Source {
    key: "harris1978",
    reference: "F. J. Harris: On the use of windows for harmonic analysis with the discrete \
                Fourier transform. Proceedings of the IEEE 66(1), 51–83, 1978",
};

/// Every source that can be cited.
pub const SOURCES: &[Source] = &[
    MICHAUX_2005,
    THOMSEN_1999,
    THOMSEN_FIDLIN_2003,
    CUNEFARE_GRAF_2002,
    JORBA_ZOU_2005,
    FILIPPOV_1988,
    HARRIS_1978,
];

/// A source with what is used of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Citation {
    /// The source.
    pub source: Source,
    /// The computation that uses it.
    pub task: Task,
    /// The equations used, or what it is used for.
    pub used: &'static str,
}

/// A place where the print was corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Correction {
    /// Equations of the dissertation.
    pub equations: &'static str,
    /// What it should be.
    pub right: &'static str,
    /// The computations concerned.
    pub tasks: &'static [Task],
}

/// What a study's computations rest on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sources {
    /// Citations, task by task.
    pub citations: Vec<Citation>,
    /// Corrections that bear on this study.
    pub corrections: Vec<Correction>,
}

/// What a study's computations rest on.
pub fn sources(study: &Study) -> Sources {
    let belt = study.belt();
    let mut citations = Vec::new();
    let mut cite = |task, source, used| citations.push(Citation { source, task, used });
    for &task in Task::ALL {
        cite(task, MICHAUX_2005, model(belt));
        match task {
            Task::Friction | Task::Stability => averaging(belt, task, &mut cite),
            Task::Simulate | Task::Response => simulation(task, &mut cite),
        }
    }
    Sources {
        citations,
        corrections: corrections(belt),
    }
}

/// Equations of motion and law.
fn model(belt: &Belt) -> &'static str {
    let normal = has(belt, Direction::Normal, None);
    match (belt.friction().kind(), normal) {
        (LawKind::Stribeck, false) => "equation of motion (2.1), (3.1); Stribeck law (2.7)",
        (LawKind::Stribeck, true) => "equation of motion (2.1), (3.1), (4.1); Stribeck law (2.7)",
        (LawKind::Decreasing, false) => "equation of motion (2.1), (3.1); decreasing law (2.8)",
        (LawKind::Decreasing, true) => {
            "equation of motion (2.1), (3.1), (4.1); decreasing law (2.8)"
        }
    }
}

fn averaging(belt: &Belt, task: Task, cite: &mut impl FnMut(Task, Source, &'static str)) {
    cite(
        task,
        THOMSEN_1999,
        "averaging over the fast motion; effective friction",
    );
    if has(belt, Direction::Tangential, None) {
        cite(
            task,
            MICHAUX_2005,
            "effective friction under tangential dither (2.21), (3.19)–(3.27)",
        );
        cite(task, MICHAUX_2005, closed_form(belt.friction().kind()));
    }
    if has(belt, Direction::Normal, None) {
        cite(
            task,
            MICHAUX_2005,
            "fast motion under normal dither (4.13)–(4.23), effective friction (4.27), (4.28)",
        );
    }
    if task == Task::Stability {
        cite(
            task,
            MICHAUX_2005,
            "criterion of stability (2.26), thresholds (3.41)–(3.62), (4.33)–(4.42)",
        );
    }
}

fn closed_form(law: LawKind) -> &'static str {
    match law {
        LawKind::Stribeck => "closed forms (3.29)–(3.31)",
        LawKind::Decreasing => "closed forms (3.36)–(3.39), (B.10), (C.7)",
    }
}

fn simulation(task: Task, cite: &mut impl FnMut(Task, Source, &'static str)) {
    cite(
        task,
        JORBA_ZOU_2005,
        "Taylor steps and the choice of their length",
    );
    cite(
        task,
        FILIPPOV_1988,
        "what a solution is where the friction law is set-valued",
    );
    if task == Task::Response {
        cite(task, MICHAUX_2005, "efficiency of dither (2.27)");
        cite(task, HARRIS_1978, "Hann window of the spectrum");
        cite(
            task,
            THOMSEN_FIDLIN_2003,
            "the stick-slip of the belt without dither",
        );
        cite(task, CUNEFARE_GRAF_2002, "dither against squeal");
    }
}

fn has(belt: &Belt, direction: Direction, waveform: Option<Waveform>) -> bool {
    belt.dithers_along(direction)
        .any(|dither| waveform.is_none_or(|waveform| dither.waveform == waveform))
}

/// Corrections that bear on a belt.
fn corrections(belt: &Belt) -> Vec<Correction> {
    use Direction::{Normal, Tangential};
    use Waveform::{Sine, Square, Triangle};
    const BOTH: &[Task] = &[Task::Friction, Task::Stability];
    const STABILITY: &[Task] = &[Task::Stability];
    let stribeck = belt.friction().kind() == LawKind::Stribeck;
    let decreasing = belt.friction().kind() == LawKind::Decreasing;
    let with = |direction, waveform| has(belt, direction, Some(waveform));
    let (tangential, normal) = (has(belt, Tangential, None), has(belt, Normal, None));
    let entries: [(bool, &'static str, &'static str, &'static [Task]); 13] = [
        (
            tangential,
            "(2.21), (3.19)",
            "the effective friction is ⟨μ(v_r − αG)⟩: x′ = Z′ + αG; the printed + is forgiven by \
             antiperiodic waveforms only",
            BOTH,
        ),
        (
            tangential,
            "text after (3.25)",
            "G is even, not odd: τ₂ = 2π − τ₁ needs it",
            BOTH,
        ),
        (
            decreasing && with(Tangential, Triangle),
            "(3.38a), (B.4), (B.10a)",
            "the erf terms inside carry e^{γ−w}, not e^{−w−γ}",
            BOTH,
        ),
        (
            decreasing && with(Tangential, Triangle),
            "(B.3), (B.5)",
            "the prefactor is exp(v_r/v_m − πα/(4v_m))",
            BOTH,
        ),
        (
            decreasing && with(Tangential, Triangle),
            "(3.53a)",
            "first exponent −1/2; second term with 1/(2√(γ−w)), twice; erf terms with e^{γ−w}",
            BOTH,
        ),
        (
            decreasing && with(Tangential, Square),
            "(3.36a)",
            "|v_r| inside the bracket: for v_r < 0 the print counts the sign twice",
            BOTH,
        ),
        (
            stribeck && with(Tangential, Sine),
            "(3.44), (4.34)",
            "stable at every belt speed from v_m √((2/3)(1 − κ)) on, without the nested root",
            STABILITY,
        ),
        (
            stribeck && with(Tangential, Triangle),
            "(3.45)–(3.47), (4.35)",
            "3⟨G²⟩ = π²/10 and ⟨G²⟩ = π²/30 instead of π²/16 and π²/48",
            BOTH,
        ),
        (
            stribeck && with(Tangential, Triangle),
            "(3.48), (4.36)",
            "(v_m/π) √((240/23)(1 − κ)) instead of (2/π) v_m √(3 − 4v_mζ/(FΔμ))",
            STABILITY,
        ),
        (
            stribeck && with(Normal, Square),
            "(4.38)",
            "1/π instead of 2/π: the print is twice too large",
            STABILITY,
        ),
        (
            normal,
            "(4.32)",
            "φ′ stays frozen in the derivative: 2ζ + F⟨μ′(v₀ − φ′)⟩; the total derivative that the \
             text describes is wrong",
            STABILITY,
        ),
        (
            normal,
            "(4.34), (4.36), (4.38), (4.40), (4.42)",
            "they hold μ(v₀) and so are not valid at any belt speed until μ is taken at v₀ = α^L G_max",
            STABILITY,
        ),
        (
            true,
            "(2.27)",
            "the record is not stated: here a settling time is discarded, the mean removed, a Hann \
             window applied; E is undefined where the undithered run settles to steady sliding",
            &[Task::Response],
        ),
    ];
    entries
        .into_iter()
        .filter(|(applies, ..)| *applies)
        .map(|(_, equations, right, tasks)| Correction {
            equations,
            right,
            tasks,
        })
        .collect()
}

impl Sources {
    /// The sources without repetition, in the order of [`SOURCES`].
    pub fn unique(&self) -> Vec<Source> {
        let cited = |source: &&Source| {
            self.citations
                .iter()
                .any(|citation| citation.source == **source)
        };
        SOURCES.iter().filter(cited).copied().collect()
    }

    /// As JSON.
    pub fn json(&self) -> Json {
        let sources: Vec<Json> = self
            .unique()
            .into_iter()
            .map(|source| {
                let used: Vec<Json> = self
                    .citations
                    .iter()
                    .filter(|citation| citation.source == source)
                    .map(|citation| json!({ "verb": citation.task.name(), "for": citation.used }))
                    .collect();
                json!({ "key": source.key, "reference": source.reference, "used": used })
            })
            .collect();
        let corrections: Vec<Json> = self
            .corrections
            .iter()
            .map(|correction| {
                let verbs: Vec<&str> = correction.tasks.iter().map(|task| task.name()).collect();
                json!({
                    "source": MICHAUX_2005.key,
                    "equations": correction.equations,
                    "right": correction.right,
                    "verbs": verbs,
                })
            })
            .collect();
        json!({ "ok": true, "sources": sources, "corrections": corrections })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study(law: &str, waveform: &str, direction: &str) -> Study {
        let text = format!(
            "schema = 1\n[belt]\ndamping_ratio = 0.1\nnormal_load = 1\nbelt_velocity = 1\n\
             [friction]\nlaw = \"{law}\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2\n\
             reference_velocity = 1\n[dither]\nwaveform = \"{waveform}\"\n\
             direction = \"{direction}\"\namplitude = 0.1\nfrequency_ratio = 10\n"
        );
        Study::parse(&text, &[]).expect("valid")
    }

    #[test]
    fn only_corrections_that_bear_on_the_study_are_told() {
        let told = |law, waveform, direction| {
            let found = sources(&study(law, waveform, direction)).corrections;
            found
                .iter()
                .map(|correction| correction.equations)
                .collect::<Vec<_>>()
                .join("; ")
        };
        assert!(told("decreasing", "triangle", "tangential").contains("(3.38a)"));
        assert!(!told("decreasing", "sine", "tangential").contains("(3.38a)"));
        assert!(!told("stribeck", "triangle", "tangential").contains("(3.53a)"));
        assert!(told("stribeck", "sine", "normal").contains("(4.32)"));
        assert!(!told("stribeck", "sine", "tangential").contains("(4.32)"));
    }

    #[test]
    fn every_task_cites_something_and_keys_are_unique() {
        let found = sources(&study("stribeck", "sine", "tangential"));
        for task in Task::ALL {
            assert!(
                found
                    .citations
                    .iter()
                    .any(|citation| citation.task == *task)
            );
        }
        let mut keys: Vec<&str> = SOURCES.iter().map(|source| source.key).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), SOURCES.len());
    }
}
