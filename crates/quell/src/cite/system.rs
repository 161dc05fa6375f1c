//! Sources of the computations of a system.

use quell_model::{LawKind, System};

use super::citation::{Citation, Task};
use super::references::{
    ARMSTRONG_HELOUVRY_1994, CANUDAS_DE_WIT_1995, CHAN_1994, GELB_VANDER_VELDE_1968,
    HAIRER_NORSETT_WANNER_1993, HOFFMANN_2002, MICHAUX_2005, STEELE_2014, Source, THOMSEN_1999,
    WILSON_1927,
};
use crate::study::SystemStudy;

/// Citations of a study of a system. Modes have none: friction does not enter them.
pub(super) fn citations(study: &SystemStudy) -> Vec<Citation> {
    let system = study.system();
    let mut citations = Vec::new();
    let mut cite = |task, source, used| citations.push(Citation { source, task, used });
    for task in [Task::Stability, Task::Thresholds] {
        friction(system, |source, used| cite(task, source, used));
        if system.contacts.iter().any(|contact| contact.normal.is_some()) {
            cite(task, HOFFMANN_2002, "mode coupling: two frequencies merge under friction");
        }
    }
    if system.is_dithered() {
        let task = Task::Stability;
        cite(task, THOMSEN_1999, "averaging over the fast motion; effective friction");
        cite(task, MICHAUX_2005, "effective friction (2.21), here of each contact");
        let used = "periodic motion in pure slip and its multipliers by extrapolation (--exact)";
        cite(task, HAIRER_NORSETT_WANNER_1993, used);
    }
    friction(system, |source, used| cite(Task::Friction, source, used));
    let used = "describing function of averaged friction (--describing), with the structure in harmonic balance";
    cite(Task::Friction, GELB_VANDER_VELDE_1968, used);
    if system.is_dithered() {
        cite(Task::Friction, MICHAUX_2005, "effective friction (2.21), here of each contact");
    }
    if system.has_noise() {
        for task in [Task::Friction, Task::Stability] {
            cite(
                task,
                GELB_VANDER_VELDE_1968,
                "statistical linearisation: friction under a Gaussian velocity",
            );
        }
        cite(Task::Response, STEELE_2014, "the random numbers of noise (SplitMix64)");
        cite(Task::Response, WILSON_1927, "confidence interval of the share of quiet runs");
    }
    if !system.inputs.is_empty() {
        friction(system, |source, used| cite(Task::Resonances, source, used));
    }
    citations
}

/// Friction laws, and friction on surfaces that tilt.
fn friction(system: &System, mut cite: impl FnMut(Source, &'static str)) {
    let law = |kind| system.contacts.iter().any(|contact| contact.friction.kind() == kind);
    if law(LawKind::Stribeck) {
        cite(MICHAUX_2005, "Stribeck law (2.7)");
    }
    if law(LawKind::Decreasing) {
        cite(MICHAUX_2005, "decreasing law (2.8)");
    }
    if law(LawKind::StribeckExponential) {
        cite(ARMSTRONG_HELOUVRY_1994, "exponential Stribeck friction with a viscous part");
    }
    if law(LawKind::Lugre) {
        cite(CANUDAS_DE_WIT_1995, super::references::LUGRE);
    }
    if system.contacts.iter().any(|contact| contact.slope.is_some()) {
        cite(CHAN_1994, "friction as a follower force");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys of the sources that a verb cites.
    fn keys(contact: &str, dither: &str, task: Task) -> Vec<&'static str> {
        let text = format!(
            "schema = 1\n[system]\ncoordinates = [\"x\", \"y\"]\nmass = [1, 1]\nstiffness = [[2, 1], [1, 2]]\n\
             [[contact]]\ntangent = {{ x = 1 }}\nnormal_load = 1\nbelt_velocity = 1\n{contact}\n\
             [contact.friction]\nlaw = \"coulomb\"\ncoefficient = 0.3\n{dither}"
        );
        let study = SystemStudy::parse(&text, &[]).expect("valid");
        let found = citations(&study).into_iter().filter(|citation| citation.task == task);
        found.map(|citation| citation.source.key).collect()
    }

    #[test]
    fn a_source_is_cited_where_its_method_enters() {
        let spring = "normal = { y = 1 }\nnormal_stiffness = 1";
        let tilted = "normal = { y = 1 }\nnormal_stiffness = 1\nslope = { y = 0.1 }";
        let dither =
            "[[dither]]\nat = { x = 1 }\nwaveform = \"sine\"\namplitude = 1\nfrequency = 20";
        assert!(keys("", "", Task::Stability).is_empty());
        assert_eq!(keys(spring, "", Task::Stability), ["hoffmann2002"]);
        assert_eq!(keys(spring, "", Task::Thresholds), ["hoffmann2002"]);
        assert_eq!(keys(tilted, "", Task::Stability), ["chan1994", "hoffmann2002"]);
        let averaged = ["thomsen1999", "michaux2005", "hairer1993"];
        assert_eq!(keys("", dither, Task::Stability), averaged);
        assert_eq!(keys(tilted, dither, Task::Resonances), ["chan1994"]);
        assert!(keys(spring, dither, Task::Modes).is_empty());
        assert_eq!(keys("", dither, Task::Friction), ["gelb1968", "michaux2005"]);
    }
}
