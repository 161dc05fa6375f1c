//! Equations and sources that a study's computations use, and corrections of the printed text.
//!
//! Equation numbers are those of Michaux (2005). Each correction was found by comparing the printed formula with quadrature of
//! its definition; the numbers are in `reference/`.

use serde_json::{Value as Json, json};

use crate::study::Study;

pub mod bibliography;
mod citation;
mod cited_study;
mod correction;
mod corrections;
pub mod errata;
pub mod page;
mod references;
mod uses;

use cited_study::CitedStudy;

pub use citation::{Citation, Task};
pub use correction::{Bears, Correction, DiscKind, Proof};
pub use corrections::CORRECTIONS;
pub use references::*;

/// Sources of a study's computations.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Sources {
    /// Citations, task by task.
    pub citations: Vec<Citation>,
    /// Corrections that concern this study.
    pub corrections: Vec<Correction>,
}

/// Sources of the computations of a study, and the corrections that concern it and enter one of them.
pub fn sources_of(study: &Study) -> Sources {
    let cited = CitedStudy::of(study);
    let concerned =
        |correction: &&Correction| !correction.tasks.is_empty() && correction.bears.on(&cited);
    Sources {
        citations: uses::citations(&cited),
        corrections: CORRECTIONS.iter().filter(concerned).copied().collect(),
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

    /// What the sources are used for, each use once.
    pub fn uses(&self) -> Vec<&'static str> {
        let mut uses = Vec::new();
        for citation in &self.citations {
            if !uses.contains(&citation.used) {
                uses.push(citation.used);
            }
        }
        uses
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
                json!({ "key": source.key, "reference": source.reference(), "used": used })
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
    fn only_corrections_that_concern_the_study_are_listed() {
        let listed = |law, waveform, direction| {
            let found = sources_of(&study(law, waveform, direction)).corrections;
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
        let found = sources_of(&study("stribeck", "sine", "tangential"));
        // Friction does not enter modes.
        for task in Task::ALL.iter().filter(|task| **task != Task::Modes) {
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
