//! Values that a law accepts and rejects, and the names of laws.

use quell_model::parameter::Parameter;
use quell_model::{Invalid, LawKind};

use crate::law_samples::{all_samples, samples};

/// The keys of complaints, in order.
fn keys(complaints: &[Invalid]) -> Vec<&str> {
    complaints.iter().map(|complaint| complaint.key.as_str()).collect()
}

#[test]
fn values_build_the_same_law_again() {
    for law in all_samples() {
        let values = law.values();
        assert_eq!(values.len(), law.kind().parameters().len());
        if LawKind::NUMERIC.contains(&law.kind()) {
            assert_eq!(law.kind().build(&values), Ok(law));
        } else {
            let complaints = law.kind().build(&values).expect_err("its data are missing");
            assert_eq!(keys(&complaints), ["friction.law"], "{law:?}");
        }
    }
}

/// Each number can be read and set by its path; any other path is rejected.
#[test]
fn numbers_are_set_by_their_paths() {
    for law in all_samples() {
        for (parameter, value) in law.kind().parameters().iter().zip(law.values()) {
            assert_eq!(law.get(parameter.path), Some(value), "{law:?}");
            let same = law.with(parameter.path, value).expect("its own value");
            assert_eq!(same.values(), law.values());
            let complaints = law.with(parameter.path, f64::NAN).expect_err("no number");
            assert_eq!(keys(&complaints), [parameter.path], "{law:?}");
        }
        assert_eq!(law.get("friction.nothing"), None);
        let complaints = law.with("friction.nothing", 1.0).expect_err("no such path");
        assert_eq!(keys(&complaints), ["friction.nothing"], "{law:?}");
    }
}

/// Numbers that a parameter must not accept.
fn impossible(parameter: &Parameter) -> Vec<f64> {
    let mut values = vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    if parameter.bounds.lower.is_finite() {
        values.push(parameter.bounds.lower - 1.0);
    }
    if parameter.bounds.upper.is_finite() {
        values.push(parameter.bounds.upper + 1.0);
    }
    if !parameter.bounds.lower_included {
        values.push(parameter.bounds.lower);
    }
    values
}

#[test]
fn impossible_values_are_rejected_by_name() {
    for &kind in LawKind::NUMERIC {
        let valid = samples(kind)[0].values();
        for (index, parameter) in kind.parameters().iter().enumerate() {
            for value in impossible(parameter) {
                let mut values = valid.clone();
                values[index] = value;
                let complaints = kind.build(&values).expect_err(parameter.path);
                assert!(
                    complaints.iter().any(|complaint| complaint.key == parameter.path),
                    "{} = {value}: {complaints:?}",
                    parameter.path
                );
            }
        }
    }
}

/// No law of friction has a negative coefficient or velocity scale, even where its bounds would allow one.
#[test]
fn negative_values_are_rejected() {
    for &kind in LawKind::NUMERIC {
        let valid = samples(kind)[0].values();
        for (index, parameter) in kind.parameters().iter().enumerate() {
            let mut values = valid.clone();
            values[index] = -0.3;
            let complaints = kind.build(&values).expect_err(parameter.path);
            assert!(complaints.iter().any(|complaint| complaint.key == parameter.path));
        }
    }
}

#[test]
fn all_complaints_are_returned_at_once() {
    for &kind in LawKind::NUMERIC {
        let wrong = vec![f64::NAN; kind.parameters().len()];
        let complaints = kind.build(&wrong).expect_err(kind.name());
        for parameter in kind.parameters() {
            let named = complaints.iter().filter(|complaint| complaint.key == parameter.path);
            assert_eq!(named.count(), 1, "{}", parameter.path);
        }
    }
}

#[test]
fn a_wrong_number_of_values_is_a_complaint() {
    for &kind in LawKind::NUMERIC {
        let mut values = samples(kind)[0].values();
        values.push(0.1);
        let count = format!("({})", kind.parameters().len());
        let refused = |values: &[f64]| {
            let complaints = kind.build(values).expect_err("a wrong number of values");
            assert_eq!(keys(&complaints), ["friction"], "{}", kind.name());
            assert_eq!(complaints[0].value, values.len().to_string(), "{}", kind.name());
            assert!(complaints[0].allowed.ends_with(&count), "{}: {complaints:?}", kind.name());
        };
        refused(&values);
        values.truncate(values.len() - 2);
        refused(&values);
        refused(&[]);
    }
}

#[test]
fn names_round_trip_and_paths_belong_to_the_friction_table() {
    for (index, &kind) in LawKind::ALL.iter().enumerate() {
        assert_eq!(LawKind::from_name(kind.name()), Some(kind));
        assert!(LawKind::ALL[..index].iter().all(|other| other.name() != kind.name()));
        assert!(kind.name().chars().all(|c| c.is_ascii_lowercase() || "_-".contains(c)));
        assert!(!kind.about().is_empty());
        for (index, parameter) in kind.parameters().iter().enumerate() {
            assert_eq!(parameter.table(), "friction", "{}", parameter.path);
            let earlier = &kind.parameters()[..index];
            assert!(earlier.iter().all(|other| other.path != parameter.path));
        }
    }
    for unknown in ["", "no such law", "Stribeck"] {
        assert_eq!(LawKind::from_name(unknown), None);
    }
}
