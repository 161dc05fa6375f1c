//! Equations and sources that a study's computations use, and corrections of the printed text.
//!
//! Equation numbers are those of Michaux (2005). Each correction was found by comparing the printed formula with quadrature of
//! its definition; the numbers are in `reference/`.

use quell_model::{Belt, Direction, LawKind};
use serde_json::{Value as Json, json};

use crate::study::{BeltStudy, DiscStudy, Kind, Study, SystemStudy};

pub mod bibliography;
mod citation;
mod correction;
mod corrections;
mod disc;
pub mod errata;
pub mod page;
mod references;
mod system;

use correction::has;

pub use citation::{Citation, Task};
pub use correction::{Bears, Correction, DiscKind, Proof};
pub use corrections::CORRECTIONS;
pub use references::{
    ARMSTRONG_HELOUVRY_1994, CANUDAS_DE_WIT_1995, CHAN_1994, CUNEFARE_GRAF_2002,
    DAS_SAIKI_SANDER_YORKE_2017, FILIPPOV_1988, GELB_VANDER_VELDE_1968, HAIRER_NORSETT_WANNER_1993,
    HARRIS_1978, HOFFMANN_2002, IWAN_STAHL_1973, JORBA_ZOU_2005, MENCK_2013, MICHAUX_2005,
    NAYFEH_MOOK_1979, SOURCES, STEELE_2014, Source, TAKAHASHI_IMADA_1984, THOMSEN_1999,
    THOMSEN_FIDLIN_2003, VOGEL_SKINNER_1965, WILSON_1927,
};

/// Sources of a study's computations.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    /// Citations, task by task.
    pub citations: Vec<Citation>,
    /// Corrections that concern this study.
    pub corrections: Vec<Correction>,
}

/// Sources of the computations of a belt study, and the corrections that concern it.
pub fn sources(study: &BeltStudy) -> Sources {
    gather(citations(study), |bears| bears.on_belt(study.belt()))
}

/// Sources and corrections of a disc study.
pub fn sources_of_disc(study: &DiscStudy) -> Sources {
    gather(disc::citations(study), |bears| bears.on_disc(study))
}

/// Sources of the computations of a study of a system. The corrections concern the equations of belts and discs alone.
pub fn sources_of_system(study: &SystemStudy) -> Sources {
    gather(system::citations(study), |_| false)
}

/// Sources and corrections of a study of any kind.
pub fn sources_of(study: &Study) -> Sources {
    match study.kind() {
        Kind::Belt(setup) => sources(&study.narrowed(setup.as_ref())),
        Kind::Disc(setup) => sources_of_disc(&study.narrowed(setup.as_ref())),
        Kind::System(setup) => sources_of_system(&study.narrowed(setup.as_ref())),
    }
}

/// The citations with the corrections that concern the study and enter a computation.
fn gather(citations: Vec<Citation>, bears: impl Fn(Bears) -> bool) -> Sources {
    let concerned =
        |correction: &&Correction| !correction.tasks.is_empty() && bears(correction.bears);
    Sources { citations, corrections: CORRECTIONS.iter().filter(concerned).copied().collect() }
}

fn citations(study: &BeltStudy) -> Vec<Citation> {
    let belt = study.belt();
    let mut citations = Vec::new();
    let mut cite = |task, source, used| citations.push(Citation { source, task, used });
    for &task in Task::ALL {
        cite(task, MICHAUX_2005, model(belt));
        if belt.friction().kind() == LawKind::StribeckExponential {
            let used = "exponential Stribeck friction with a viscous part";
            cite(task, ARMSTRONG_HELOUVRY_1994, used);
        }
        if belt.friction().kind() == LawKind::Lugre {
            cite(task, CANUDAS_DE_WIT_1995, references::LUGRE);
        }
        if task == Task::Friction {
            let used = "describing function of averaged friction (friction --describing)";
            cite(task, GELB_VANDER_VELDE_1968, used);
        }
        match task {
            Task::Friction | Task::Stability => averaging(belt, task, &mut cite),
            Task::Simulate | Task::Response => {
                simulation(task, &mut cite);
                let noise = belt.dithers().iter().any(|dither| !dither.waveform.is_periodic());
                if noise {
                    cite(task, STEELE_2014, "the random numbers of noise (SplitMix64)");
                    if task == Task::Response {
                        cite(task, WILSON_1927, "confidence interval of the share of quiet runs");
                    }
                }
            }
            Task::Bifurcation | Task::Basins => attractors(task, &mut cite),
            Task::Thresholds | Task::Modes | Task::Resonances => {}
        }
    }
    citations
}

/// The equations of motion and of the friction law.
fn model(belt: &Belt) -> &'static str {
    let normal = has(belt, Direction::Normal, None);
    match (belt.friction().kind(), normal) {
        (LawKind::Stribeck, false) => "equation of motion (2.1), (3.1); Stribeck law (2.7)",
        (LawKind::Stribeck, true) => "equation of motion (2.1), (3.1), (4.1); Stribeck law (2.7)",
        (LawKind::Decreasing, false) => "equation of motion (2.1), (3.1); decreasing law (2.8)",
        (LawKind::Decreasing, true) => {
            "equation of motion (2.1), (3.1), (4.1); decreasing law (2.8)"
        }
        (LawKind::Coulomb | LawKind::StribeckExponential | LawKind::Lugre, false) => {
            "equation of motion (2.1), (3.1)"
        }
        (LawKind::Coulomb | LawKind::StribeckExponential | LawKind::Lugre, true) => {
            "equation of motion (2.1), (3.1), (4.1)"
        }
        (LawKind::Expression | LawKind::Samples, false) => {
            "equation of motion (2.1), (3.1); the law is defined in the study"
        }
        (LawKind::Expression | LawKind::Samples, true) => {
            "equation of motion (2.1), (3.1), (4.1); the law is defined in the study"
        }
    }
}

fn averaging(belt: &Belt, task: Task, cite: &mut impl FnMut(Task, Source, &'static str)) {
    cite(task, THOMSEN_1999, "averaging over the fast motion; effective friction");
    if has(belt, Direction::Tangential, None) {
        cite(
            task,
            MICHAUX_2005,
            "effective friction under tangential dither (2.21), (3.19)–(3.27)",
        );
        if let Some(used) = closed_form(belt.friction().kind()) {
            cite(task, MICHAUX_2005, used);
        }
    }
    if has(belt, Direction::Normal, None) {
        cite(
            task,
            MICHAUX_2005,
            "fast motion under normal dither (4.13)–(4.23), effective friction (4.27), (4.28)",
        );
    }
    if belt.dithers().iter().any(|dither| !dither.waveform.is_periodic()) {
        let used = "mean and gain of friction under Gaussian noise (statistical linearisation)";
        cite(task, GELB_VANDER_VELDE_1968, used);
    }
    if task == Task::Stability {
        cite(
            task,
            MICHAUX_2005,
            "criterion of stability (2.26), thresholds (3.41)–(3.62), (4.33)–(4.42)",
        );
    }
}

fn closed_form(law: LawKind) -> Option<&'static str> {
    match law {
        LawKind::Stribeck => Some("closed forms (3.29)–(3.31)"),
        LawKind::Decreasing => Some("closed forms (3.36)–(3.39), (B.10), (C.7)"),
        // Any other law is integrated by quadrature.
        LawKind::Coulomb
        | LawKind::StribeckExponential
        | LawKind::Lugre
        | LawKind::Expression
        | LawKind::Samples => None,
    }
}

fn simulation(task: Task, cite: &mut impl FnMut(Task, Source, &'static str)) {
    cite(task, JORBA_ZOU_2005, "Taylor steps and the choice of their length");
    cite(task, FILIPPOV_1988, "definition of a solution for a set-valued friction law");
    if task == Task::Response {
        cite(task, MICHAUX_2005, "residual vibration E under dither (2.27)");
        cite(task, HARRIS_1978, "Hann window of the spectrum");
        cite(task, THOMSEN_FIDLIN_2003, "the stick-slip of the belt without dither");
        cite(task, CUNEFARE_GRAF_2002, "dither against squeal");
    }
}

fn attractors(task: Task, cite: &mut impl FnMut(Task, Source, &'static str)) {
    simulation(task, cite);
    cite(task, DAS_SAIKI_SANDER_YORKE_2017, "averages of a section and rotation numbers");
    if task == Task::Basins {
        cite(task, MENCK_2013, "the share of starts that reach a response");
        cite(task, WILSON_1927, "confidence interval of a sampled share");
    }
}

impl Sources {
    /// The citations and corrections that concern these tasks.
    #[must_use]
    pub fn of_tasks(&self, tasks: &[Task]) -> Self {
        let concerned = |of: &[Task]| of.iter().any(|task| tasks.contains(task));
        Self {
            citations: self
                .citations
                .iter()
                .filter(|citation| tasks.contains(&citation.task))
                .copied()
                .collect(),
            corrections: self
                .corrections
                .iter()
                .filter(|correction| concerned(correction.tasks))
                .copied()
                .collect(),
        }
    }

    /// Adds the citations and corrections of another study that are not contained yet.
    pub fn extend(&mut self, other: &Self) {
        for citation in &other.citations {
            if !self.citations.contains(citation) {
                self.citations.push(*citation);
            }
        }
        for correction in &other.corrections {
            if !self.corrections.contains(correction) {
                self.corrections.push(*correction);
            }
        }
    }

    /// The sources without repetition, in the order of [`SOURCES`].
    pub fn unique(&self) -> Vec<Source> {
        let cited =
            |source: &&Source| self.citations.iter().any(|citation| citation.source == **source);
        SOURCES.iter().filter(cited).copied().collect()
    }

    /// The sources as BibTeX entries.
    pub fn bibtex(&self) -> String {
        let keys = self.unique().into_iter().map(|source| source.key);
        let entries: Vec<&str> = keys.filter_map(bibliography::entry).collect();
        entries.join("\n\n") + "\n"
    }

    /// The sources as JSON.
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
                    "printed": correction.printed,
                    "right": correction.right,
                    "verbs": verbs,
                })
            })
            .collect();
        let warnings: [&str; 0] = [];
        json!({
            "ok": true,
            "sources": sources,
            "corrections": corrections,
            "bibtex": self.bibtex(),
            "warnings": warnings,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn study(law: &str, waveform: &str, direction: &str) -> BeltStudy {
        let text = format!(
            "schema = 1\n[belt]\ndamping_ratio = 0.1\nnormal_load = 1\nbelt_velocity = 1\n\
             [friction]\nlaw = \"{law}\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.2\n\
             reference_velocity = 1\n[dither]\nwaveform = \"{waveform}\"\n\
             direction = \"{direction}\"\namplitude = 0.1\nfrequency_ratio = 10\n"
        );
        BeltStudy::parse(&text, &[]).expect("valid")
    }

    #[test]
    fn only_corrections_that_concern_the_study_are_listed() {
        let listed = |law, waveform, direction| {
            let found = sources(&study(law, waveform, direction)).corrections;
            found.iter().map(|correction| correction.equations).collect::<Vec<_>>().join("; ")
        };
        assert!(listed("decreasing", "triangle", "tangential").contains("(3.38a)"));
        assert!(!listed("decreasing", "sine", "tangential").contains("(3.38a)"));
        assert!(!listed("stribeck", "triangle", "tangential").contains("(3.53a)"));
        assert!(listed("stribeck", "sine", "normal").contains("(4.24), (4.28), (4.32)"));
        assert!(!listed("stribeck", "sine", "tangential").contains("(4.24), (4.28), (4.32)"));
    }

    #[test]
    fn every_task_cites_something_and_keys_are_unique() {
        let found = sources(&study("stribeck", "sine", "tangential"));
        for task in Task::ALL {
            assert!(found.citations.iter().any(|citation| citation.task == *task));
        }
        let mut keys: Vec<&str> = SOURCES.iter().map(|source| source.key).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), SOURCES.len());
    }

    /// The tests named as proofs of corrections exist.
    #[test]
    fn every_proof_exists() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for correction in CORRECTIONS {
            let Proof::Test { file, name } = correction.proof else {
                assert!(correction.tasks.is_empty(), "{}", correction.equations);
                continue;
            };
            let text = std::fs::read_to_string(root.join(file)).expect(file);
            let test = format!("#[test]\nfn {name}()");
            assert!(text.contains(&test), "{}: {file} has {name}", correction.equations);
        }
    }
}
