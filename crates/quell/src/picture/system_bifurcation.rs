//! The bifurcation diagram of a system: stroboscopic section and peak-to-peak over the parameter, swept up and down.

use quell_model::units::Quantity;

use super::bifurcation::intervals;
use super::caption::caption_of_system;
use super::system::axis_of;
use super::system_orbit::axis;
use super::with_unstable;
use crate::plot::{Figure, Marker, Panel, PlotRole, Points, Polyline, SharedLegend, Sharing, Size};
use crate::run::bifurcation::SweepDirection;
use crate::run::system::bifurcation::{SystemBifurcation, SystemBranch};
use crate::study::SystemStudy;

/// The diagram.
pub fn bifurcation(study: &SystemStudy, done: &SystemBifurcation) -> Figure {
    let range = &done.range;
    let across = || axis_of(study, &range.parameter).between(range.from, range.to);
    let unstable = || {
        let first = done.branches.first().map_or(&[][..], |branch| &branch.points);
        let mut values: Vec<(f64, bool)> = first
            .iter()
            .map(|point| (point.value, point.local.as_ref().is_ok_and(|word| *word == "unstable")))
            .collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        intervals(&values)
    };
    let length = Quantity::Displacement;
    let mut section = with_unstable(
        Panel::new(across(), axis(study, "section displacement", length)),
        unstable(),
    );
    let mut size = with_unstable(
        Panel::new(across(), axis(study, "peak-to-peak", length).from(0.0)),
        unstable(),
    );
    for branch in &done.branches {
        let (role, marker, width) = match branch.direction {
            SweepDirection::Up => (PlotRole::Series(0), Marker::Disc, 2.2),
            SweepDirection::Down => (PlotRole::Series(1), Marker::Circle, 3.0),
        };
        let label = format!("swept {}", branch.direction.name());
        let states = branch.points.iter().flat_map(|point| {
            let section = point.attractor().map_or(&[][..], |attractor| &attractor.section);
            section.iter().map(|x| (point.value, *x)).collect::<Vec<_>>()
        });
        section = section.with(Points::new(role, states).marker(marker).size(width).label(label));
        size = size.with(Polyline::pieces(role, sizes(branch)).width(1.6));
    }
    Figure::grid(1, [section, size])
        .sharing_x(Sharing::All)
        .legend(SharedLegend::Above)
        .size(Size::Frame(560.0, 190.0))
        .title(study.title().unwrap_or_default())
        .caption(format!("{} {}", done.sentence(study), caption_of_system(study)))
}

/// Peak-to-peak over the parameter, with a gap where the kind of motion changes.
fn sizes(branch: &SystemBranch) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut before = None;
    for point in &branch.points {
        let Some(attractor) = point.attractor() else {
            before = None;
            continue;
        };
        match pieces.last_mut() {
            Some(piece) if before == Some(attractor.is_quiet()) => {
                piece.push((point.value, attractor.size()));
            }
            _ => pieces.push(vec![(point.value, attractor.size())]),
        }
        before = Some(attractor.is_quiet());
    }
    pieces
}
