//! What answers about runs say alike: means of contacts, warnings, and why a run ended early.

use quell_dynamics::motion::{ContactMeans, MotionEnd, MotionStopped};
use quell_model::System;
use quell_model::units::Quantity;

use super::start::state_in_words;
use super::{failed, velocity_in_words};
use crate::complaint::Failure;
use crate::fields::Fields;
use crate::range;
use crate::study::SystemStudy;
use crate::words::{listed, plural};

/// The failure of a run that ended early: time, reason, and state.
pub(in crate::run) fn failed_run(verb: &str, system: &System, stopped: &MotionStopped) -> Failure {
    failed(
        verb,
        format!("{stopped}; the state there is {}", state_in_words(system, &stopped.state)),
    )
}

/// Warnings about slip beyond the ranges of the laws; `largest` is the largest slip speed of a contact.
pub fn beyond_laws(study: &SystemStudy, largest: impl Fn(usize) -> f64) -> Vec<String> {
    let in_words = |speed| velocity_in_words(study, speed);
    let contacts = study.system().contacts.iter().enumerate();
    let warning = |(index, contact)| range::at_contact(contact, largest(index), in_words);
    contacts.filter_map(warning).collect()
}

/// Adds the means of a contact.
pub(crate) fn put_means(fields: &mut Fields, means: Result<ContactMeans, &'static str>) {
    let of = |pick: fn(&ContactMeans) -> f64| means.as_ref().map(pick).map_err(|why| *why);
    fields
        .known("stick_fraction", Quantity::Ratio, of(|means| means.stick_fraction))
        .known("open_fraction", Quantity::Ratio, of(|means| means.open_fraction))
        .known("mean_friction", Quantity::Force, of(|means| means.friction))
        .known("mean_normal", Quantity::Force, of(|means| means.normal_load))
        .known("least_normal", Quantity::Force, of(|means| means.least_load))
        .known("friction_power", Quantity::Power, of(|means| means.friction_power));
}

/// Warnings of the engine about a run.
pub(crate) fn of_engine(system: &System, end: &MotionEnd) -> Vec<String> {
    let mut warnings = Vec::new();
    let releases = end.near_tangential_releases;
    if releases > 0 {
        warnings.push(format!(
            "{releases} release{} barely crossed the stiction threshold, where forward uniqueness is not guaranteed",
            plural(releases)
        ));
    }
    let dependent = end.dependent.iter().map(|contact| system.contacts[*contact].name.clone());
    let dependent: Vec<String> = dependent.collect();
    if !dependent.is_empty() {
        warnings.push(format!(
            "the friction forces in stick of contacts {} are not unique, because their tangents depend on each other: the \
             least-norm forces within the bounds are given; the motion is unique",
            listed(&dependent)
        ));
    }
    warnings
}
