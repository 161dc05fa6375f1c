//! `cite`: the equations and papers that a study's computations use.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use crate::cite::Sources;
use crate::study::StudyOf;

impl<K> Presented<K> for Sources {
    const NAME: &'static str = "sources";

    fn json(&self, _: &StudyOf<K>) -> Json {
        self.json()
    }

    fn table(&self, _: &StudyOf<K>) -> String {
        table(self)
    }
}

fn table(found: &Sources) -> String {
    let mut text = String::new();
    for source in found.unique() {
        let _ = writeln!(text, "[{}] {}", source.key, source.reference());
        let mut uses: Vec<(&str, Vec<&str>)> = Vec::new();
        for citation in found.citations.iter().filter(|citation| citation.source == source) {
            match uses.iter_mut().find(|(used, _)| *used == citation.used) {
                Some((_, verbs)) => verbs.push(citation.task.name()),
                None => uses.push((citation.used, vec![citation.task.name()])),
            }
        }
        for (used, verbs) in uses {
            let _ = writeln!(text, "    {used} ({})", verbs.join(", "));
        }
    }
    if !found.corrections.is_empty() {
        text.push_str("\nCorrections to the printed equations:\n");
    }
    for correction in &found.corrections {
        let _ = writeln!(text, "    {}: {}", correction.equations, correction.right);
    }
    text
}
