//! Basins of a system in the plane of starts.

use super::caption::caption_of_system;
use super::map::{MapAxis, MapKind, MappedQuantity, map_panel};
use super::undrawable;
use crate::complaint::Failure;
use crate::plot::{Figure, Legend, PlotAxis, PlotRole, Size};
use crate::run::system::basins::{SystemBasin, SystemBasins};
use crate::study::SystemStudy;

/// Reason in the legend for a start without colour.
const UNKNOWN: &str = "outcome unknown";

/// The picture of basins.
///
/// # Errors
/// [`Failure::Failed`] if it cannot be drawn.
pub fn basins(study: &SystemStudy, done: &SystemBasins) -> Result<Figure, Failure> {
    let axis = |number: usize| MapAxis {
        axis: PlotAxis::new(done.names[number].as_str()),
        values: done.values[number].clone(),
    };
    let (columns, rows) = (done.values[0].len(), done.values[1].len());
    let places = (0..columns).flat_map(|column| (0..rows).map(move |row| row * columns + column));
    let outcome = |(place, basin): (usize, &SystemBasin)| {
        let share = 100.0 * basin.share.fraction;
        (role(&done.basins, place), format!("{}: {share:.1} %", basin.attractor.words()))
    };
    let picture = MappedQuantity {
        values: places.map(|at| done.ends[at].map(|place| place as f64).ok_or(0)).collect(),
        axes: vec![axis(0), axis(1)],
        quantity: PlotAxis::new("outcome"),
        kind: MapKind::Outcome(done.basins.iter().enumerate().map(outcome).collect()),
        reasons: vec![UNKNOWN.to_owned()],
        over: Vec::new(),
    };
    let panel = map_panel(&picture, false).map_err(undrawable)?.legend(Legend::Above);
    Ok(Figure::single(panel)
        .size(Size::Frame(420.0, 330.0))
        .title(study.title().unwrap_or_default())
        .caption(format!("{} {}", done.sentence(study), caption_of_system(study))))
}

/// The quiescent motion is blue, the largest other one red.
fn role(basins: &[SystemBasin], place: usize) -> PlotRole {
    let quiet_first = basins.first().is_some_and(|basin| basin.attractor.is_quiet());
    match (quiet_first, place) {
        (true, 0) => PlotRole::Stable,
        (true, 1) | (false, 0) => PlotRole::Unstable,
        _ => PlotRole::Series(place + 1),
    }
}
