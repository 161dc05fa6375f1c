//! Study files of the entries, with the dissertation's numbers or with others.

use std::path::Path;

use quell_model::Waveform;

use super::shared::SharedMeasurements;
use quell::complaint::{Complaint, Complaints, Failure, Fault};
use quell::document::{Node, Value};
use quell::study::vocabulary::DocumentKind;
use quell::study::{Axis, BeltStudy, Change, Study, Sweep, key_at};

/// Keys of a dither that only one waveform has: in a family of waveforms they are changed for that waveform alone.
const KEYS_OF_A_WAVEFORM: [(&str, &str); 8] = [
    ("carrier", "burst"),
    ("on", "burst"),
    ("off", "burst"),
    ("harmonics", "fourier"),
    ("values", "samples"),
    ("hold", "samples"),
    ("file", "samples"),
    ("band", "noise"),
];

/// An entry's name and study file.
#[derive(Clone, Debug)]
pub struct EntrySource {
    /// Name: `2.3`.
    pub name: &'static str,
    /// Its content in one line.
    pub about: &'static str,
    /// Text of the study file.
    pub text: &'static str,
    /// Largest number of points along an axis of its sweeps, if fewer than in the file.
    pub most_points: Option<usize>,
    /// Paths of which the figure has several values besides those of its axes.
    pub(super) families: &'static [&'static str],
    /// Measurements shared by the entries of the run.
    pub(super) shared: SharedMeasurements,
    /// Changes for numbers of one's own; empty for the figure of the dissertation.
    pub(super) own: Vec<Change>,
    /// The families among these changes.
    pub(super) own_families: Vec<(String, Vec<String>)>,
}

impl EntrySource {
    /// The same entry with numbers of one's own. A list of values replaces a family of the figure: the values of one of its axes, its
    /// waveforms, belt velocities or laws.
    ///
    /// # Errors
    /// A complaint about a list for a number of which the figure has one value.
    pub(super) fn with(mut self, changes: &[Change]) -> Result<Self, Failure> {
        if changes.is_empty() {
            return Ok(self);
        }
        let fine = Study::parse_in(self.text, &[], Path::new(""))?;
        let axes: Vec<&str> = fine.sweeps().iter().map(|sweep| sweep.path.as_str()).collect();
        let mut wrong = Vec::new();
        for change in changes {
            let path = change.path.trim();
            let listed = matches!(change.node.value, Value::List(_));
            if self.families.contains(&path) {
                let values = match &change.node.value {
                    Value::List(list) => list.iter().map(in_words).collect(),
                    _ => vec![in_words(&change.node)],
                };
                self.own_families.push((path.to_owned(), values));
            } else if let Some(axis) = axes.iter().position(|axis| *axis == path) {
                let origin = change.node.origin;
                let node = match &change.node.value {
                    Value::List(_) => change.node.clone(),
                    _ => Node { value: Value::List(vec![change.node.clone()]), origin },
                };
                self.own.push(Change { path: format!("sweep[{axis}].values"), node });
            } else if listed && takes_number(path) {
                let varied: Vec<&str> = axes.iter().chain(self.families).copied().collect();
                let varied =
                    if varied.is_empty() { "no number".to_owned() } else { varied.join(", ") };
                let allowed =
                    format!("one value; figure {} takes lists of values of {varied}", self.name);
                wrong.push(Complaint::new(
                    Fault::Value,
                    path,
                    change.node.origin,
                    change.node.given(),
                    allowed,
                ));
            } else {
                self.own.push(change.clone());
            }
        }
        if wrong.is_empty() { Ok(self) } else { Err(Complaints::from(wrong).into()) }
    }

    /// The same, after its study with these numbers has been read.
    ///
    /// # Errors
    /// Complaints about the changed study.
    pub(super) fn checked(self) -> Result<Self, Failure> {
        let waveforms: Vec<String> = self
            .family(WAVEFORMS, &[])
            .iter()
            .map(|waveform| format!("{WAVEFORMS}={waveform}"))
            .collect();
        Study::parse_in(self.text, &self.changes(&[])?, Path::new(""))?;
        for waveform in &waveforms {
            Study::parse_in(self.text, &self.changes(&[waveform])?, Path::new(""))?;
        }
        Ok(self)
    }

    /// Whether it has numbers of one's own.
    pub(super) fn is_own(&self) -> bool {
        !(self.own.is_empty() && self.own_families.is_empty())
    }

    /// Whether the values of an axis are one's own.
    pub(super) fn has_own_axis(&self, axis: usize) -> bool {
        self.own.iter().any(|change| change.path == format!("sweep[{axis}].values"))
    }

    /// The changes in words: `friction.reference_velocity = 0.3`.
    pub(super) fn own_words(&self) -> Vec<String> {
        let fine = Study::parse_in(self.text, &[], Path::new(""));
        let axis = |path: &str| -> Option<String> {
            let number: usize =
                path.strip_prefix("sweep[")?.strip_suffix("].values")?.parse().ok()?;
            Some(fine.as_ref().ok()?.sweeps().get(number)?.path.clone())
        };
        let numbers = self.own.iter().map(|change| {
            let path = axis(&change.path).unwrap_or_else(|| change.path.clone());
            let given = change.node.given().to_string();
            format!("{path} = {}", given.trim_matches(['[', ']', '"']).replace(',', ", "))
        });
        let families = self
            .own_families
            .iter()
            .map(|(path, values)| format!("{path} = {}", values.join(", ")));
        numbers.chain(families).collect()
    }

    /// The caption of its figure: what it shows, and for the dissertation's numbers what its print says. With numbers of one's own
    /// it says so instead of naming a figure of the dissertation.
    pub(super) fn caption(&self, shows: &str, about_the_print: &str) -> String {
        if self.is_own() {
            return format!(
                "Own numbers, {}: computed like figure {} of Michaux (2005), but no figure of that dissertation. {shows}",
                self.own_words().join("; "),
                self.name
            );
        }
        let gap = if about_the_print.is_empty() { "" } else { " " };
        format!("Figure {}. {shows}{gap}{about_the_print}", self.name)
    }

    /// The values of a family: one's own, or those of the dissertation.
    pub(super) fn family(&self, path: &str, of_the_dissertation: &[&str]) -> Vec<String> {
        let own = self.own_families.iter().rev().find(|(known, _)| known == path);
        own.map_or_else(
            || of_the_dissertation.iter().map(|value| (*value).to_owned()).collect(),
            |(_, values)| values.clone(),
        )
    }

    /// The study.
    ///
    /// # Errors
    /// Complaints about the study file; a test checks that it has no fault.
    pub fn study(&self) -> Result<BeltStudy, Failure> {
        self.changed(&[])
    }

    /// The study after changes such as `friction.law=decreasing`.
    ///
    /// # Errors
    /// Complaints about the changed study.
    pub fn changed(&self, changes: &[&str]) -> Result<BeltStudy, Failure> {
        let mut changes = self.changes(changes)?;
        if self.most_points.is_some() {
            let fine = BeltStudy::parse(self.text, &changes)?;
            changes.extend(self.coarser(fine.sweeps())?);
        }
        Ok(BeltStudy::parse(self.text, &changes)?)
    }

    /// One's own changes, followed by these of a panel.
    pub(super) fn changes(&self, changes: &[&str]) -> Result<Vec<Change>, Failure> {
        let panel = changes
            .iter()
            .map(|change| Change::parse(change, "reproduce"))
            .collect::<Result<Vec<Change>, _>>()?;
        let waveform = panel.iter().rev().find(|change| change.path == "dither.waveform");
        let serves = |change: &&Change| {
            let key = change.path.trim().rsplit('.').next().unwrap_or_default();
            let of = KEYS_OF_A_WAVEFORM.iter().find(|(known, _)| *known == key);
            let Some((_, of)) = of.filter(|_| change.path.starts_with("dither")) else {
                return true;
            };
            match waveform {
                Some(waveform) => in_words(&waveform.node) == *of,
                // Without a panel the study has the waveform of its file.
                None => !self.own_families.iter().any(|(path, _)| path == WAVEFORMS),
            }
        };
        Ok(self.own.iter().filter(serves).cloned().chain(panel.iter().cloned()).collect())
    }

    /// Changes that limit the number of points on the axes of a study; listed values are kept.
    pub(super) fn coarser(&self, sweeps: &[Sweep]) -> Result<Vec<Change>, Failure> {
        let Some(most) = self.most_points else { return Ok(Vec::new()) };
        let mut changes = Vec::new();
        for (number, sweep) in sweeps.iter().enumerate() {
            if !matches!(sweep.axis, Axis::Values(_)) && sweep.axis.len() > most {
                changes
                    .push(Change::parse(&format!("sweep[{number}].points={most}"), "reproduce")?);
            }
        }
        Ok(changes)
    }

    /// The study with each waveform of the figure.
    ///
    /// # Errors
    /// Complaints about a changed study.
    pub fn with_waveforms(&self) -> Result<Vec<(Waveform, BeltStudy)>, Failure> {
        self.family(WAVEFORMS, &NAMED_WAVEFORMS)
            .iter()
            .map(|name| {
                let study = self.changed(&[&format!("{WAVEFORMS}={name}")])?;
                Ok((study.belt().dithers()[0].waveform.clone(), study))
            })
            .collect()
    }
}

/// Path of the family of waveforms.
pub(super) const WAVEFORMS: &str = "dither.waveform";

/// The waveforms of chapter 3.
pub(super) const NAMED_WAVEFORMS: [&str; 3] = ["sine", "triangle", "square"];

/// Whether a path names a number of a study.
fn takes_number(path: &str) -> bool {
    let kinds = [DocumentKind::Belt, DocumentKind::Disc];
    let found = |kind| key_at(path, kind).is_ok_and(|address| address.key.takes_number());
    kinds.into_iter().any(found)
}

/// A value as it is written after `path=`.
fn in_words(node: &Node) -> String {
    match &node.value {
        Value::Number(number) => number.to_string(),
        Value::Text(text) | Value::Date(text) => text.clone(),
        Value::Flag(flag) => flag.to_string(),
        Value::List(_) | Value::Table(_) => node.given().to_string(),
    }
}
