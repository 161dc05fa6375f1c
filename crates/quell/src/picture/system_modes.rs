//! Shapes of the natural motions of a system: the displacement of every coordinate, as stems.

use super::caption::caption;
use super::ruler::short;
use crate::plot::{
    Figure, Legend, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine,
    Sharing,
};
use crate::run::system::modes::{SystemModes, natural};
use crate::study::{SystemStudy, UnitSystem};

/// Maximum number of shapes in a picture.
const MOST_SHAPES: usize = 12;
/// Most names of coordinates in the caption.
const MOST_NAMES: usize = 12;

/// The picture of the modes.
pub fn modes(study: &SystemStudy, done: &SystemModes) -> Figure {
    let names = study.system().structure.names();
    let panels: Vec<Panel> = done
        .modes
        .iter()
        .take(MOST_SHAPES)
        .enumerate()
        .map(|(place, motion)| {
            let (frequency, unit) = match study.units() {
                UnitSystem::None => (natural(motion), ""),
                _ => (natural(motion) / std::f64::consts::TAU, " Hz"),
            };
            let damping = short(motion.damping_ratio());
            let title = format!("({}) {}{unit}, $ζ$ = {damping}", place + 1, short(frequency));
            let tips: Vec<PlotPoint> = motion
                .shape
                .iter()
                .enumerate()
                .map(|(coordinate, z)| PlotPoint::new((coordinate + 1) as f64, z.re))
                .collect();
            let stems = tips.iter().map(|&tip| [PlotPoint::new(tip.x, 0.0), tip]);
            let ticks: Vec<f64> = if names.len() <= MOST_NAMES {
                (1..=names.len()).map(|number| number as f64).collect()
            } else {
                Vec::new()
            };
            let across = PlotAxis::new("coordinate").between(0.5, names.len() as f64 + 0.5);
            let across = if ticks.is_empty() { across } else { across.ticks(ticks) };
            Panel::new(across, PlotAxis::new("shape").between(-1.1, 1.1))
                .with(ReferenceLine::horizontal(0.0).role(PlotRole::Guide))
                .with(Polyline::pieces(PlotRole::Exact, stems))
                .with(Points::new(PlotRole::Exact, tips).marker(Marker::Disc).size(5.0))
                .title(title)
                .legend(Legend::None)
        })
        .collect();
    let columns = panels.len().clamp(1, 3);
    Figure::grid(columns, panels)
        .sharing_x(Sharing::All)
        .sharing_y(Sharing::All)
        .title(study.title().unwrap_or_default())
        .caption(whole_caption(study, done))
}

/// The coordinates in their order, and how many shapes are left out.
fn whole_caption(study: &SystemStudy, done: &SystemModes) -> String {
    let names = study.system().structure.names();
    let listed = names.iter().take(MOST_NAMES).cloned().collect::<Vec<_>>().join(", ");
    let more = if names.len() > MOST_NAMES { ", …" } else { "" };
    let left = done.modes.len().saturating_sub(MOST_SHAPES);
    let shown = if left > 0 {
        format!(" The first {MOST_SHAPES} of {} modes.", done.modes.len())
    } else {
        String::new()
    };
    format!(
        "Natural motions without friction, with the springs of the contacts. Coordinates: {listed}{more}.{shown} {}",
        caption(study)
    )
}
