//! A slow ramp: the motion over the value of the ramp, with the exact thresholds.

use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use super::caption::caption;
use super::ruler::Ruler;
use crate::plot::{
    Figure, LineStyle, Panel, PlotPoint, PlotRole, Polyline, ReferenceLine, SharedLegend, Sharing,
    Size,
};
use crate::run::ramp::Ramp;
use crate::study::SystemStudy;

/// Displacement, and vibration within one natural period, over the value of the ramp; rising and falling values apart.
pub(crate) fn ramp(study: &SystemStudy, done: &Ramp) -> Figure {
    let ruler = |quantity, values: Vec<f64>| Ruler::new(study, quantity, values);
    let RealInterval { lower: least, upper: largest } = done.ramped.range();
    let across = ruler(done.ramped.quantity, vec![least, largest]);
    let place = ruler(Quantity::Displacement, done.motion.displacement.clone());
    let axis = || {
        let axis = across.axis(&done.ramped.words, "");
        axis.between(across.place(least), across.place(largest))
    };
    let displacement =
        PlotPoint::zip(done.motion.times.iter().copied(), done.motion.displacement.clone());
    let mut motion = with_ways(
        Panel::new(axis(), place.axis("observed displacement", "")),
        done,
        |at| PlotPoint::new(across.place(done.ramped.value(at.x)), place.place(at.y)),
        displacement,
    );
    let levels = done.motion.levels();
    let size = ruler(Quantity::Displacement, levels.iter().map(|at| at.level).collect());
    let mut vibration = with_ways(
        Panel::new(axis(), size.axis("slow vibration", "").from(0.0)),
        done,
        |at| PlotPoint::new(across.place(done.ramped.value(at.x)), size.place(at.y)),
        levels.iter().map(|at| PlotPoint::new(at.time, at.level)),
    );
    for (number, threshold) in done.thresholds.iter().flatten().enumerate() {
        let line =
            || ReferenceLine::vertical(across.place(threshold.value)).style(LineStyle::Dashed);
        let label = if number == 0 { "exact threshold" } else { "" };
        motion = motion.with(if label.is_empty() { line() } else { line().label(label) });
        vibration = vibration.with(line());
    }
    Figure::grid(1, [motion, vibration])
        .sharing_x(Sharing::All)
        .legend(SharedLegend::Above)
        .size(Size::Frame(560.0, 190.0))
        .title(study.title().unwrap_or_default())
        .caption(format!("{} {}", caption(study), done.sentence(study)))
}

/// Adds values over time as one curve for each interval in which the ramp rises or falls; `placed` puts a value at a time on the axes.
fn with_ways(
    panel: Panel,
    done: &Ramp,
    placed: impl Fn(PlotPoint) -> PlotPoint,
    values: impl Iterator<Item = PlotPoint>,
) -> Panel {
    let rises = |time: f64| {
        let (times, knots) = (done.ramped.knots.times(), done.ramped.knots.values());
        let next = times.partition_point(|knot| *knot <= time).clamp(1, times.len() - 1);
        knots[next] >= knots[next - 1]
    };
    let mut ways: [Vec<Vec<PlotPoint>>; 2] = Default::default();
    let mut last = None;
    for value in values {
        let way = usize::from(!rises(value.x));
        if last != Some(way) {
            ways[way].push(Vec::new());
        }
        last = Some(way);
        if let Some(piece) = ways[way].last_mut() {
            piece.push(placed(value));
        }
    }
    let looks = [(PlotRole::Series(0), "rising"), (PlotRole::Series(1), "falling")];
    let curves = ways.into_iter().zip(looks).filter(|(pieces, _)| !pieces.is_empty());
    let curves = curves.map(|(pieces, (role, label))| Polyline::pieces(role, pieces).label(label));
    panel.with_all(curves.collect::<Vec<_>>())
}
