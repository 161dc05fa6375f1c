//! A frame that is as small as what is drawn in it.

use crate::plot::{AxisRange, Layer, Panel, PlotAxis};

/// Space around the curves, as a share of their extent.
const SPACE: f64 = 0.06;

/// The panel with axes that its curves fill: the window that was searched may be much larger.
pub(super) fn filled(mut panel: Panel) -> Panel {
    let window = |axis: &PlotAxis| match axis.range {
        AxisRange::Between(from, to) => Some((from.min(to), from.max(to))),
        _ => None,
    };
    let (Some(x), Some(y)) = (window(&panel.x), window(&panel.y)) else { return panel };
    let inside = |range: (f64, f64), value: f64| (range.0..=range.1).contains(&value);
    let points: Vec<(f64, f64)> = panel
        .layers
        .iter()
        .filter_map(|layer| if let Layer::Polyline(line) = layer { Some(line) } else { None })
        .flat_map(|line| line.pieces.iter().flatten().copied())
        .filter(|point| inside(x, point.0) && inside(y, point.1))
        .collect();
    let fit = |window: (f64, f64), of: fn(&(f64, f64)) -> f64| {
        let low = points.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = points.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        // A level line keeps a tenth of the window around it.
        let space = if high > low { SPACE * (high - low) } else { 0.1 * (window.1 - window.0) };
        ((low - space).max(window.0), (high + space).min(window.1))
    };
    if points.is_empty() {
        return panel;
    }
    let ((left, right), (bottom, top)) = (fit(x, |point| point.0), fit(y, |point| point.1));
    panel.x = panel.x.between(left, right);
    panel.y = panel.y.between(bottom, top);
    panel
}
