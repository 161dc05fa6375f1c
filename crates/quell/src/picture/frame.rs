//! A frame that is as small as what is drawn in it.

use crate::plot::{AxisRange, Layer, Panel, PlotAxis, PlotPoint, PlotRange};

/// Space around the curves, as a share of their extent.
const SPACE: f64 = 0.06;

/// The panel with axes that its curves fill: the window that was searched may be much larger.
pub(super) fn filled(mut panel: Panel) -> Panel {
    let window = |axis: &PlotAxis| match axis.range {
        AxisRange::Between(from, to) => Some(PlotRange::new(from.min(to), from.max(to))),
        _ => None,
    };
    let (Some(x), Some(y)) = (window(&panel.x), window(&panel.y)) else { return panel };
    let points: Vec<PlotPoint> = panel
        .layers
        .iter()
        .filter_map(|layer| if let Layer::Polyline(line) = layer { Some(line) } else { None })
        .flat_map(|line| line.pieces.iter().flatten().copied())
        .filter(|point| x.contains(point.x) && y.contains(point.y))
        .collect();
    let fit = |window: PlotRange, of: fn(&PlotPoint) -> f64| {
        let low = points.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = points.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        // A level line keeps a tenth of the window around it.
        let space = if high > low { SPACE * (high - low) } else { 0.1 * window.width() };
        ((low - space).max(window.lower), (high + space).min(window.upper))
    };
    if points.is_empty() {
        return panel;
    }
    let ((left, right), (bottom, top)) = (fit(x, |point| point.x), fit(y, |point| point.y));
    panel.x = panel.x.between(left, right);
    panel.y = panel.y.between(bottom, top);
    panel
}
