//! `bifurcation`: the response along a parameter swept up and down.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::table::figure;
use super::{Answered, Outcome};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::input::Inputs;
use crate::picture;
use crate::plot::Figure;
use crate::run::attractor::words;
use crate::run::bifurcation::{Bifurcation, Branch};
use crate::study::BeltSetup;

impl Outcome for Answered<BeltSetup, Bifurcation> {
    fn inputs(&self) -> Inputs {
        self.study.inputs()
    }

    fn json(&self) -> Json {
        self.done.json(&self.study)
    }

    fn title(&self) -> Option<&str> {
        self.study.title()
    }

    fn sentence(&self) -> Option<String> {
        Some(self.done.sentence(&self.study))
    }

    fn table(&self) -> String {
        table(&self.done)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("bifurcation", self.done.dataset(&self.study))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::bifurcation(&self.study, &self.done)))
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
