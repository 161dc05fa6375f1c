//! `bifurcation`: the response along a parameter swept up and down.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::attractor::words;
use crate::run::bifurcation::{Bifurcation, Branch};
use crate::study::{BeltSetup, BeltStudy};

impl Presented<BeltSetup> for Bifurcation {
    const TITLED: bool = true;

    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, _: &BeltStudy) -> String {
        table(self)
    }

    fn datasets(&self, study: &BeltStudy) -> Vec<(&'static str, Dataset)> {
        vec![("bifurcation", self.dataset(study))]
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::bifurcation(study, self)))
    }
}

fn table(done: &Bifurcation) -> String {
    let mut text = String::new();
    for branch in &done.branches {
        let _ = writeln!(text, "\n{}:", branch.direction.name());
        for interval in intervals(branch) {
            let _ = writeln!(text, "  {interval}");
        }
    }
    text
}

/// Ranges of neighbouring values with the same kind of response, one line each.
fn intervals(branch: &Branch) -> Vec<String> {
    let kind = |place: usize| {
        let point = &branch.points[place];
        match &point.response {
            // The frequency of a quasi-periodic response changes from value to value; a range shares the kind.
            Ok(attractor)
                if attractor.rotation.is_some_and(|rotation| rotation.ratio.is_none()) =>
            {
                attractor.kind.words()
            }
            Ok(attractor) => words(point.scales, attractor, point.period),
            Err(_) => "not settled".to_owned(),
        }
    };
    let mut lines = Vec::new();
    let mut from = 0;
    for place in 0..branch.points.len() {
        let last = place + 1 == branch.points.len();
        if last || kind(place + 1) != kind(from) {
            let value = |place: usize| figure(branch.points[place].value);
            let ends = if from == place {
                value(place)
            } else {
                format!("{} to {}", value(from), value(place))
            };
            lines.push(format!("{ends:<22}  {}", kind(from)));
            from = place + 1;
        }
    }
    lines
}
