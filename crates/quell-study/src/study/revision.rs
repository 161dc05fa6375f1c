//! Studies out of other studies: a text with changes, the point of a map, and what both kinds of study say of themselves.

use super::change::Change;
use super::measures;
use super::mirror::{Table, Value};
use super::sweep::Sweep;
use super::vocabulary::SCHEMA_VERSION;
use crate::complaint::{Complaint, Fault, Origin};

/// Checks a text after changing it; what cannot be changed is told together with what the check finds.
pub(super) fn changed<S>(
    text: &str,
    changes: &[Change],
    check: impl FnOnce(Table, Vec<String>) -> Result<S, Vec<Complaint>>,
) -> Result<S, Vec<Complaint>> {
    let mut mirror = Table::parse(text)?;
    let refused: Vec<Complaint> = changes
        .iter()
        .filter_map(|change| change.apply(&mut mirror).err())
        .map(|complaint| *complaint)
        .collect();
    measures::resolve(&mut mirror);
    match check(mirror, changes.iter().map(Change::to_string).collect()) {
        Ok(study) if refused.is_empty() => Ok(study),
        Ok(_) => Err(refused),
        Err(mut complaints) => {
            complaints.extend(refused);
            Err(complaints)
        }
    }
}

/// The mirror and the changes of a study at one point of a map: its numbers set in order, and no axes.
pub(super) fn at<'a>(
    mirror: &Table,
    changes: &[String],
    numbers: impl IntoIterator<Item = (&'a str, f64)>,
) -> Result<(Table, Vec<String>), Vec<Complaint>> {
    let mut mirror = mirror.clone();
    mirror.remove("sweep");
    let mut changes = changes.to_vec();
    for (path, value) in numbers {
        let change = Change::number(path, value, "[[sweep]]");
        change.apply(&mut mirror).map_err(|complaint| vec![*complaint])?;
        changes.push(change.to_string());
    }
    Ok((mirror, changes))
}

/// Every value of a study and what is known beside its mirror, in the order of paths; neither title nor axes. The version
/// of the file is among them also where the text leaves it out.
pub(super) fn settings(
    mirror: &Table,
    beside: impl IntoIterator<Item = (String, String)>,
) -> Vec<(String, String)> {
    let mut settings = Vec::new();
    for (name, node) in mirror.iter().filter(|(name, _)| !matches!(*name, "title" | "sweep")) {
        node.leaves(name, &mut settings);
    }
    if !mirror.has("schema") {
        settings.push(("schema".to_owned(), format!("{:?}", f64::from(SCHEMA_VERSION))));
    }
    settings.extend(beside);
    settings.sort();
    settings
}

/// Whether a study is valid at the ends of every axis; `at` makes it there.
pub(super) fn ends_valid<S>(
    mirror: &Table,
    sweeps: &[Sweep],
    at: impl Fn([(&str, f64); 1]) -> Result<S, Vec<Complaint>>,
) -> Result<(), Vec<Complaint>> {
    let mut complaints = Vec::new();
    for (index, sweep) in sweeps.iter().enumerate() {
        let entry = match mirror.get("sweep").map(|node| &node.value) {
            Some(Value::List(list)) => list.get(index),
            _ => None,
        };
        let origin = entry.map_or(Origin::Whole, |node| node.origin);
        for value in sweep.axis.extremes() {
            let Err(wrong) = at([(&sweep.path, value)]) else { continue };
            complaints.extend(wrong.into_iter().map(|mut complaint| {
                if complaint.fault == Fault::Value {
                    complaint.allowed = format!(
                        "a path and values that make valid studies; {} = {value} must be {}",
                        complaint.key, complaint.allowed
                    );
                }
                let key = format!("sweep[{index}].parameter");
                Complaint { key, origin, value: sweep.path.clone().into(), ..complaint }
            }));
        }
    }
    complaints.dedup_by(|a, b| a.key == b.key && a.fault == b.fault && a.allowed == b.allowed);
    if complaints.is_empty() { Ok(()) } else { Err(complaints) }
}
