//! Study files of the entries and the cases of a figure.

use std::fmt::Display;

use quell_model::{LawKind, Waveform};

use super::shared::Shared;
use quell::complaint::Failure;
use quell::study::{Axis, BeltStudy, Change, Sweep};

/// An entry's name and study file.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name: `2.3`.
    pub name: &'static str,
    /// What it shows, in one line.
    pub about: &'static str,
    /// Text of the study file.
    pub text: &'static str,
    /// Most points along an axis of its sweeps, where they shall be fewer than the file says.
    pub most_points: Option<usize>,
    /// What other entries of the run have measured.
    pub(super) shared: Shared,
}

impl Source {
    /// The study.
    ///
    /// # Errors
    /// Complaints about the study file, which a test excludes.
    pub fn study(&self) -> Result<BeltStudy, Failure> {
        self.changed(&[])
    }

    /// The study after changes such as `friction.law=decreasing`.
    ///
    /// # Errors
    /// Complaints about the changed study.
    pub fn changed(&self, changes: &[&str]) -> Result<BeltStudy, Failure> {
        let changes: Result<Vec<Change>, _> =
            changes.iter().map(|change| Change::parse(change, "reproduce")).collect();
        let mut changes = changes?;
        if self.most_points.is_some() {
            let fine = BeltStudy::parse(self.text, &changes)?;
            changes.extend(self.coarser(fine.sweeps())?);
        }
        Ok(BeltStudy::parse(self.text, &changes)?)
    }

    /// The changes that leave the axes of a study no more points than allowed; listed values stay.
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

    /// The study with each waveform.
    ///
    /// # Errors
    /// Complaints about a changed study.
    pub fn with_waveforms(&self) -> Result<Vec<(Waveform, BeltStudy)>, Failure> {
        Waveform::ALL
            .iter()
            .map(|&waveform| {
                let study = self.changed(&[&format!("dither.waveform={}", waveform.name())])?;
                Ok((waveform, study))
            })
            .collect()
    }
}

/// Values of the axis that varies `path`; empty where the study has none.
pub(super) fn values(study: &BeltStudy, path: &str) -> Vec<f64> {
    study
        .sweeps()
        .iter()
        .find(|sweep| sweep.path == path)
        .map(|sweep| (0..sweep.axis.len()).map(|index| sweep.axis.value(index)).collect())
        .unwrap_or_default()
}

/// A number without the rounding of its last digits.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// (a), (b), … of a panel.
pub(super) fn letter(index: usize) -> char {
    char::from(b'a' + u8::try_from(index % 26).unwrap_or(0))
}

/// How a law is called in a sentence.
pub(super) fn law_name(kind: LawKind) -> &'static str {
    match kind {
        LawKind::Stribeck => "Stribeck",
        LawKind::Decreasing => "decreasing",
        // No figure has another; its name says enough.
        kind => kind.name(),
    }
}

/// How a waveform is called in a title.
pub(super) fn waveform_name(waveform: Waveform) -> &'static str {
    match waveform {
        Waveform::Sine => "sinusoidal",
        Waveform::Triangle => "triangular",
        Waveform::Square => "square",
    }
}

/// A piece of work that gave no value.
pub(super) fn failed(name: &str, why: &impl Display) -> Failure {
    Failure::Failed { key: format!("reproduce {name}"), why: why.to_string() }
}

/// ζ, F, v_m, μ_s, μ_m of a caption.
pub(super) fn parameters(study: &BeltStudy) -> String {
    let belt = study.belt();
    let law = belt.friction();
    let values = law.values();
    let [static_level, minimum] =
        [values.first().copied(), values.get(1).copied()].map(|v| v.unwrap_or(0.0));
    format!(
        "$F$ = {}, $v_m$ = {}, $μ_s$ = {static_level}, $μ_m$ = {minimum}",
        belt.normal_load(),
        law.velocity_scale()
    )
}
