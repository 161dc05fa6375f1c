//! Bifurcation diagrams: stroboscopic section, amplitude and slow frequency over the parameter, swept up and down.

use quell_dynamics::attractor::Attractor;
use quell_dynamics::orbit::OrbitVerdict;
use quell_model::units::Quantity;
use quell_numerics::order::ascending_by;

use super::caption::{VariedNumber, caption_of_run, with_varied};
use super::ruler::Ruler;
use super::sweep::{short_name, unit_or_none};
use super::with_unstable;
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, SharedLegend, Sharing, Size,
};
use crate::run::bifurcation::{Bifurcation, Branch, SweepDirection};
use crate::run::varied::Varied;
use crate::study::BeltStudy;

/// Maximum number of states of all sections that are drawn: more states overlap, and the file would have many megabytes.
const MOST_STATES: usize = 16_000;

/// Number of states of each section that are always drawn.
const STATES: usize = 12;

/// The axis of a varied parameter over its values, and its ruler.
pub(super) fn axis(varied: &Varied) -> (PlotAxis, Ruler) {
    let (_, from, to) = range(varied);
    let ruler = Ruler::of_unit(unit_or_none(varied.unit), from.abs().max(to.abs()));
    let axis =
        ruler.axis(short_name(varied.about), &varied.symbol.unwrap_or("").replace('₀', "_0"));
    (axis.between(ruler.place(from), ruler.place(to)), ruler)
}

/// The range of a varied parameter.
pub(super) fn range(varied: &Varied) -> VariedNumber<'_> {
    let ends = varied.values.first().zip(varied.values.last());
    let (from, to) = ends.map_or((0.0, 0.0), |(from, to)| (*from, *to));
    (varied.path.as_str().into(), from, to)
}

/// Intervals in which a condition holds; their ends are midpoints between neighbouring values.
pub(super) fn intervals(values: &[(f64, bool)]) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    for (place, (value, holds)) in values.iter().enumerate() {
        if !holds {
            continue;
        }
        let middle =
            |other: Option<&(f64, bool)>| other.map_or(*value, |other| 0.5 * (other.0 + value));
        let before = middle(place.checked_sub(1).and_then(|place| values.get(place)));
        let behind = middle(values.get(place + 1));
        match found.last_mut() {
            Some(last) if last.1 >= before => last.1 = behind,
            _ => found.push((before, behind)),
        }
    }
    found
}

/// The diagram.
pub fn bifurcation(study: &BeltStudy, done: &Bifurcation) -> Figure {
    let attractors = || {
        done.branches
            .iter()
            .flat_map(|branch| &branch.points)
            .filter_map(|point| point.response.as_ref().ok())
    };
    let ruler = Ruler::of(
        study,
        Quantity::Displacement,
        attractors().flat_map(|attractor| [attractor.lowest, attractor.highest]),
    );
    let count = attractors().count().max(1);
    let each = (MOST_STATES / count).max(STATES);
    let (across, varied) = axis(&done.varied);
    let unstable: Vec<(f64, f64)> = unstable(done)
        .into_iter()
        .map(|(from, to)| (varied.place(from), varied.place(to)))
        .collect();
    let panel = |up: PlotAxis| with_unstable(Panel::new(across.clone(), up), unstable.clone());
    let mut section = panel(ruler.axis("section displacement", "x"));
    let mut size = panel(ruler.axis("peak-to-peak", "").from(0.0));
    let mut frequency = panel(PlotAxis::new("slow frequency").symbol("ω/ω_0"));
    // The small marks of the sweep up are drawn over the larger circles of the sweep down.
    for branch in done.branches.iter().rev() {
        let (role, marker, width) = look(branch.direction);
        let label = format!("swept {}", branch.direction.name());
        let settled = || {
            branch.points.iter().filter_map(|point| Some((point, point.response.as_ref().ok()?)))
        };
        let states = settled().flat_map(|(point, attractor)| {
            let step = attractor.section.len().div_ceil(each).max(1);
            let states = attractor.section.iter().step_by(step);
            states.map(|(x, _)| (varied.place(point.value), ruler.place(*x))).collect::<Vec<_>>()
        });
        section = section.with(Points::new(role, states).marker(marker).size(width).label(label));
        let sizes = line(branch, &varied, |attractor| Some(ruler.place(attractor.size())));
        size = size.with(Polyline::pieces(role, sizes).width(1.6));
        let turning = settled().filter_map(|(point, attractor)| {
            Some((varied.place(point.value), attractor.frequency(point.period)?))
        });
        frequency = frequency.with(Points::new(role, turning).marker(marker).size(width + 1.0));
    }
    let mut panels = vec![section, size];
    if attractors().any(|attractor| attractor.rotation.is_some()) {
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
            with_varied(study, caption_of_run, &[range(&done.varied)])
        ))
}

/// Role, marker and size of a direction, such that both are visible where they coincide.
fn look(direction: SweepDirection) -> (PlotRole, Marker, f64) {
    match direction {
        SweepDirection::Up => (PlotRole::Series(0), Marker::Disc, 2.2),
        SweepDirection::Down => (PlotRole::Series(1), Marker::Circle, 4.2),
    }
}

/// Intervals in which the base response is unstable.
fn unstable(done: &Bifurcation) -> Vec<(f64, f64)> {
    let Some(branch) = done.branches.first() else { return Vec::new() };
    let mut values: Vec<(f64, bool)> = branch
        .points
        .iter()
        .map(|point| (point.value, point.local == Ok(OrbitVerdict::Unstable)))
        .collect();
    ascending_by(&mut values, |a| a.0);
    intervals(&values)
}

/// A quantity of a branch, with a gap where it jumps between a quiescent response and another.
fn line(
    branch: &Branch,
    varied: &Ruler,
    value: impl Fn(&Attractor) -> Option<f64>,
) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut before: Option<bool> = None;
    for point in &branch.points {
        let Some(y) = point.response.as_ref().ok().and_then(&value) else {
            before = None;
            continue;
        };
        let at = varied.place(point.value);
        match pieces.last_mut() {
            Some(piece) if before == point.quiet() => piece.push((at, y)),
            _ => pieces.push(vec![(at, y)]),
        }
        before = point.quiet();
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::intervals;

    #[test]
    fn intervals_end_halfway_to_their_neighbours() {
        let values = [(0.0, true), (1.0, true), (2.0, false), (3.0, false), (4.0, true)];
        assert_eq!(intervals(&values), [(0.0, 1.5), (3.5, 4.0)]);
    }
}
