//! Study files of the entries.

use quell_model::Waveform;

use super::shared::SharedMeasurements;
use quell::complaint::Failure;
use quell::study::{Axis, BeltStudy, Change, Sweep};

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
    /// Measurements shared by the entries of the run.
    pub(super) shared: SharedMeasurements,
}

impl EntrySource {
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
        let changes: Result<Vec<Change>, _> =
            changes.iter().map(|change| Change::parse(change, "reproduce")).collect();
        let mut changes = changes?;
        if self.most_points.is_some() {
            let fine = BeltStudy::parse(self.text, &changes)?;
            changes.extend(self.coarser(fine.sweeps())?);
        }
        Ok(BeltStudy::parse(self.text, &changes)?)
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

    /// The study with each waveform.
    ///
    /// # Errors
    /// Complaints about a changed study.
    pub fn with_waveforms(&self) -> Result<Vec<(Waveform, BeltStudy)>, Failure> {
        Waveform::NAMED
            .iter()
            .map(|waveform| {
                let study = self.changed(&[&format!("dither.waveform={}", waveform.name())])?;
                Ok((waveform.clone(), study))
            })
            .collect()
    }
}
