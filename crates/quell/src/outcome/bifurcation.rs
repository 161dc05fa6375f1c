//! `bifurcation`: the motion along a parameter, swept up and down.

use std::fmt::Write as _;

use quell_dynamics::attractor::MotionKind;
use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::bifurcation::{Bifurcation, Branch, SweepPoint, words};
use crate::study::{SystemSetup, SystemStudy};

impl Presented<SystemSetup> for Bifurcation {
    const NAME: &'static str = "bifurcation";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        let mut text = String::new();
        for branch in &self.branches {
            let _ = writeln!(text, "\n{}:", branch.direction.name());
            for interval in intervals(study, branch) {
                let _ = writeln!(text, "  {interval}");
            }
        }
        text
    }

    fn datasets(&self, study: &SystemStudy) -> Vec<(&'static str, Dataset)> {
        vec![("bifurcation", self.dataset(study))]
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::bifurcation::bifurcation(study, self)))
    }
}

/// The motion of a point as a range shares it: the frequency of a quasi-periodic one changes from value to value.
fn kind(study: &SystemStudy, point: &SweepPoint) -> String {
    let attractor = point.attractor();
    if attractor.is_some_and(|attractor| matches!(attractor.kind, MotionKind::QuasiPeriodic { .. }))
    {
        return "quasi-periodic".to_owned();
    }
    words(study, point)
}

/// Ranges of neighbouring values with the same kind of motion, one line each.
fn intervals(study: &SystemStudy, branch: &Branch) -> Vec<String> {
    let mut lines = Vec::new();
    let mut from = 0;
    for place in 0..branch.points.len() {
        let last = place + 1 == branch.points.len();
        if last || kind(study, &branch.points[place + 1]) != kind(study, &branch.points[from]) {
            let value = |place: usize| figure(branch.points[place].value);
            let ends = if from == place {
                value(place)
            } else {
                format!("{} to {}", value(from), value(place))
            };
            lines.push(format!("{ends:<22}  {}", kind(study, &branch.points[from])));
            from = place + 1;
        }
    }
    lines
}
