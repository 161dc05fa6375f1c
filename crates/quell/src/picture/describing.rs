//! The balance of energy of slow motions over their amplitude, by the describing function of averaged friction.

use quell_model::units::Quantity;

use super::caption::caption;
use super::ruler::Ruler;
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, ReferenceLine, Region,
};
use crate::run::describing::{DescribedFriction, balance};
use crate::study::BeltStudy;

/// The picture of 2ζ + FN₁ over the velocity amplitude, with the limit cycles.
pub fn describing(study: &BeltStudy, done: &DescribedFriction) -> Figure {
    let amplitudes = done.amplitudes();
    let ruler = Ruler::new(study, Quantity::Velocity, done.largest);
    let line = |role, values: Vec<f64>| {
        let places = amplitudes.iter().map(|amplitude| ruler.place(*amplitude));
        Polyline::new(role, places.zip(values).collect::<Vec<_>>())
    };
    let mut panel = Panel::new(
        ruler.axis("slow velocity amplitude", "a").between(0.0, ruler.place(done.largest)),
        PlotAxis::new("balance").symbol("2ζ + FN_1"),
    )
    .with(Region::across_y(PlotRole::Unstable, f64::NEG_INFINITY, 0.0).label("motions grow"))
    .with(ReferenceLine::horizontal(0.0));
    if !study.belt().dithers().is_empty() {
        let gains = done.undithered_gains();
        let bare = gains.into_iter().map(|gain| balance(study.belt(), gain)).collect();
        panel = panel.with(line(PlotRole::Undithered, bare).label("without dither"));
    }
    panel = panel.with(line(PlotRole::Averaged, done.balances(study)).label("averaged"));
    for (stable, label) in [(true, "stable cycle"), (false, "unstable cycle")] {
        let places: Vec<(f64, f64)> = done
            .cycles
            .iter()
            .filter(|cycle| cycle.stable == stable)
            .map(|cycle| (ruler.place(cycle.amplitude), 0.0))
            .collect();
        if !places.is_empty() {
            let marker = if stable { Marker::Disc } else { Marker::Circle };
            let points = Points::new(PlotRole::Exact, places).marker(marker).size(7.0);
            panel = panel.with(points.label(label));
        }
    }
    Figure::single(panel)
        .title(study.title().unwrap_or_default())
        .caption(format!("{}; by the describing function of averaged friction.", caption(study)))
}
