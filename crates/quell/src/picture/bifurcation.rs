//! The bifurcation diagram: stroboscopic section, peak-to-peak and slow frequency over the parameter, swept up and down.

use quell_dynamics::attractor::SystemAttractor;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending_by;

use super::caption::caption_of_varied;
use super::ruler::Ruler;
use super::system::axis_of;
use super::with_unstable;
use crate::plot::{
    Figure, Marker, Panel, PlotPoint, PlotRole, Points, Polyline, SharedLegend, Sharing, Size,
};
use crate::run::bifurcation::{Bifurcation, Branch, SweepDirection};
use crate::study::SystemStudy;

/// Maximum number of states of all sections that are drawn: more states overlap, and the file would have many megabytes.
const MOST_STATES: usize = 16_000;

/// Number of states of each section that are always drawn.
const STATES: usize = 12;

/// Intervals in which a condition holds; their ends are midpoints between neighbouring values.
pub(super) fn intervals(values: &[(f64, bool)]) -> Vec<RealInterval> {
    let mut found: Vec<RealInterval> = Vec::new();
    for (place, (value, holds)) in values.iter().enumerate() {
        if !holds {
            continue;
        }
        let middle =
            |other: Option<&(f64, bool)>| other.map_or(*value, |other| 0.5 * (other.0 + value));
        let before = middle(place.checked_sub(1).and_then(|place| values.get(place)));
        let behind = middle(values.get(place + 1));
        match found.last_mut() {
            Some(last) if last.upper >= before => last.upper = behind,
            _ => found.push(RealInterval::new(before, behind)),
        }
    }
    found
}

/// The diagram.
pub fn bifurcation(study: &SystemStudy, done: &Bifurcation) -> Figure {
    let range = &done.range;
    let (axis, varied) = axis_of(study, &range.parameter, RealInterval::new(range.from, range.to));
    let across = || axis.clone();
    let attractors = || {
        let points = done.branches.iter().flat_map(|branch| &branch.points);
        points.filter_map(|point| point.attractor())
    };
    let states = attractors().flat_map(|attractor| attractor.section.iter().copied());
    let place = Ruler::new(study, Quantity::Displacement, states);
    let extent = attractors().map(SystemAttractor::size);
    let extent = Ruler::new(study, Quantity::Displacement, extent);
    let unstable = || {
        let first = done.branches.first().map_or(&[][..], |branch| &branch.points);
        let mut values: Vec<(f64, bool)> = first
            .iter()
            .map(|point| (point.value, point.local.as_ref().is_ok_and(|word| *word == "unstable")))
            .collect();
        ascending_by(&mut values, |a| a.0);
        let scaled = intervals(&values).into_iter();
        scaled
            .map(|range| RealInterval::new(varied.place(range.lower), varied.place(range.upper)))
            .collect::<Vec<_>>()
    };
    let mut section =
        with_unstable(Panel::new(across(), place.axis("section displacement", "")), unstable());
    let mut size =
        with_unstable(Panel::new(across(), extent.axis("peak-to-peak", "").from(0.0)), unstable());
    let each = (MOST_STATES / attractors().count().max(1)).max(STATES);
    let slow = attractors().filter_map(|attractor| attractor.slow);
    let slow = Ruler::new(study, Quantity::FrequencyRatio, slow);
    let up = slow.axis("slow frequency", "");
    let mut frequency = with_unstable(Panel::new(across(), up), unstable());
    // The small marks of the sweep up are drawn over the larger circles of the sweep down.
    for branch in done.branches.iter().rev() {
        let (role, marker, width) = match branch.direction {
            SweepDirection::Up => (PlotRole::Series(0), Marker::Disc, 2.2),
            SweepDirection::Down => (PlotRole::Series(1), Marker::Circle, 4.2),
        };
        let label = format!("swept {}", branch.direction.name());
        let states = branch.points.iter().flat_map(|point| {
            let section = point.attractor().map_or(&[][..], |attractor| &attractor.section);
            let step = section.len().div_ceil(each).max(1);
            let states = section.iter().step_by(step);
            states
                .map(|x| PlotPoint::new(varied.place(point.value), place.place(*x)))
                .collect::<Vec<_>>()
        });
        section = section.with(Points::new(role, states).marker(marker).size(width).label(label));
        size = size.with(Polyline::pieces(role, sizes(branch, &varied, &extent)).width(1.6));
        let turning = branch.points.iter().filter_map(|point| {
            Some(PlotPoint::new(varied.place(point.value), slow.place(point.attractor()?.slow?)))
        });
        frequency = frequency.with(Points::new(role, turning).marker(marker).size(width + 1.0));
    }
    let mut panels = vec![section, size];
    if attractors().any(|attractor| attractor.slow.is_some()) {
        panels.push(frequency);
    }
    Figure::grid(1, panels)
        .sharing_x(Sharing::All)
        .legend(SharedLegend::Above)
        .size(Size::Frame(560.0, 190.0))
        .title(study.title().unwrap_or_default())
        .caption(format!(
            "{} {}",
            done.sentence(study),
            caption_of_varied(study, &[(range.parameter.as_str().into(), range.from, range.to)])
        ))
}

/// Peak-to-peak over the parameter, with a gap where the kind of motion changes.
fn sizes(branch: &Branch, varied: &Ruler, extent: &Ruler) -> Vec<Vec<PlotPoint>> {
    let mut pieces: Vec<Vec<PlotPoint>> = Vec::new();
    let mut before = None;
    for point in &branch.points {
        let Some(attractor) = point.attractor() else {
            before = None;
            continue;
        };
        let place = PlotPoint::new(varied.place(point.value), extent.place(attractor.size()));
        match pieces.last_mut() {
            Some(piece) if before == Some(attractor.quiet) => piece.push(place),
            _ => pieces.push(vec![place]),
        }
        before = Some(attractor.quiet);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use quell_numerics::interval::RealInterval;

    use super::intervals;

    #[test]
    fn intervals_end_halfway_to_their_neighbours() {
        let values = [(0.0, true), (1.0, true), (2.0, false), (3.0, false), (4.0, true)];
        assert_eq!(intervals(&values), [RealInterval::new(0.0, 1.5), RealInterval::new(3.5, 4.0)]);
    }
}
