//! The bifurcation diagram of a system: stroboscopic section and peak-to-peak over the parameter, swept up and down.

use quell_model::units::Quantity;
use quell_numerics::order::ascending_by;

use super::bifurcation::intervals;
use super::caption::{caption_of_system, with_varied};
use super::ruler::Ruler;
use super::system::axis_of;
use super::with_unstable;
use crate::plot::{Figure, Marker, Panel, PlotRole, Points, Polyline, SharedLegend, Sharing, Size};
use crate::run::bifurcation::SweepDirection;
use crate::run::system::attractor::SystemAttractor;
use crate::run::system::bifurcation::{SystemBifurcation, SystemBranch};
use crate::study::SystemStudy;

/// The diagram.
pub fn bifurcation(study: &SystemStudy, done: &SystemBifurcation) -> Figure {
    let range = &done.range;
    let (axis, varied) = axis_of(study, &range.parameter, (range.from, range.to));
    let across = || axis.clone();
    let attractors = || {
        let points = done.branches.iter().flat_map(|branch| &branch.points);
        points.filter_map(|point| point.attractor())
    };
    let states = attractors().flat_map(|attractor| attractor.section.iter().copied());
    let place = Ruler::of_system(study, Quantity::Displacement, states);
    let extent = attractors().map(SystemAttractor::size);
    let extent = Ruler::of_system(study, Quantity::Displacement, extent);
    let unstable = || {
        let first = done.branches.first().map_or(&[][..], |branch| &branch.points);
        let mut values: Vec<(f64, bool)> = first
            .iter()
            .map(|point| (point.value, point.local.as_ref().is_ok_and(|word| *word == "unstable")))
            .collect();
        ascending_by(&mut values, |a| a.0);
        let scaled = intervals(&values).into_iter();
        scaled.map(|(from, to)| (varied.place(from), varied.place(to))).collect::<Vec<_>>()
    };
    let mut section =
        with_unstable(Panel::new(across(), place.axis("section displacement", "")), unstable());
    let mut size =
        with_unstable(Panel::new(across(), extent.axis("peak-to-peak", "").from(0.0)), unstable());
    // The small marks of the sweep up are drawn over the larger circles of the sweep down.
    for branch in done.branches.iter().rev() {
        let (role, marker, width) = match branch.direction {
            SweepDirection::Up => (PlotRole::Series(0), Marker::Disc, 2.2),
            SweepDirection::Down => (PlotRole::Series(1), Marker::Circle, 4.2),
        };
        let label = format!("swept {}", branch.direction.name());
        let states = branch.points.iter().flat_map(|point| {
            let section = point.attractor().map_or(&[][..], |attractor| &attractor.section);
            section.iter().map(|x| (varied.place(point.value), place.place(*x))).collect::<Vec<_>>()
        });
        section = section.with(Points::new(role, states).marker(marker).size(width).label(label));
        size = size.with(Polyline::pieces(role, sizes(branch, &varied, &extent)).width(1.6));
    }
    Figure::grid(1, [section, size])
        .sharing_x(Sharing::All)
        .legend(SharedLegend::Above)
        .size(Size::Frame(560.0, 190.0))
        .title(study.title().unwrap_or_default())
        .caption(format!(
            "{} {}",
            done.sentence(study),
            with_varied(
                study,
                caption_of_system,
                &[(range.parameter.as_str().into(), range.from, range.to)]
            )
        ))
}

/// Peak-to-peak over the parameter, with a gap where the kind of motion changes.
fn sizes(branch: &SystemBranch, varied: &Ruler, extent: &Ruler) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut before = None;
    for point in &branch.points {
        let Some(attractor) = point.attractor() else {
            before = None;
            continue;
        };
        let place = (varied.place(point.value), extent.place(attractor.size()));
        match pieces.last_mut() {
            Some(piece) if before == Some(attractor.is_quiet()) => piece.push(place),
            _ => pieces.push(vec![place]),
        }
        before = Some(attractor.is_quiet());
    }
    pieces
}
