//! Visibility: whether anything of a layer is drawn inside the limits of its panel.

use super::axis_limits::AxisLimits;
use super::figure::Panel;
use super::layer::{Layer, Orientation, RegionShape};

/// Whether anything of the layer is inside the limits.
pub(super) fn is_visible(layer: &Layer, panel: &Panel, limits: AxisLimits) -> bool {
    let (across, upright) = limits;
    match layer {
        Layer::Polyline(line) => line.pieces.iter().any(|piece| crosses(piece, limits)),
        Layer::Points(points) => points
            .points
            .iter()
            .any(|&(x, y)| overlaps((x, x), across) && overlaps((y, y), upright)),
        Layer::Region(region) => match &region.shape {
            RegionShape::Polygon(corners) => {
                let extent = |pick: fn(&(f64, f64)) -> f64| {
                    let values = corners.iter().map(pick);
                    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                        (low.min(value), high.max(value))
                    })
                };
                overlaps(extent(|corner| corner.0), across)
                    && overlaps(extent(|corner| corner.1), upright)
            }
            RegionShape::AcrossX(from, to) => overlaps((from.min(*to), to.max(*from)), across),
            RegionShape::AcrossY(from, to) => overlaps((from.min(*to), to.max(*from)), upright),
        },
        Layer::ReferenceLine(rule) => {
            let limits = match rule.orientation {
                Orientation::Vertical => across,
                Orientation::Horizontal => upright,
            };
            overlaps((rule.value, rule.value), limits)
        }
        Layer::Contours(isolines) => {
            isolines.lines(&panel.x, &panel.y).iter().flatten().any(|line| crosses(line, limits))
        }
        Layer::Note(_) | Layer::Heatmap(_) => true,
    }
}

/// Whether a stroke, or the rectangle around one of its segments, meets the limits.
fn crosses(points: &[(f64, f64)], (across, upright): AxisLimits) -> bool {
    let meets = |from: (f64, f64), to: (f64, f64)| {
        overlaps((from.0.min(to.0), from.0.max(to.0)), across)
            && overlaps((from.1.min(to.1), from.1.max(to.1)), upright)
    };
    match points {
        [only] => meets(*only, *only),
        points => points.windows(2).any(|pair| meets(pair[0], pair[1])),
    }
}

fn overlaps((low, high): (f64, f64), limits: (f64, f64)) -> bool {
    let (lower, upper) = (limits.0.min(limits.1), limits.0.max(limits.1));
    low <= upper && high >= lower
}

#[cfg(test)]
mod tests {
    use super::super::axis::PlotAxis;
    use super::super::layer::{Points, Polyline, Region};
    use super::super::palette::PlotRole;
    use super::*;

    #[test]
    fn a_layer_outside_the_limits_is_not_visible() {
        let panel = Panel::new(PlotAxis::new("x"), PlotAxis::new("y"));
        let limits = ((0.0, 1.0), (0.0, 1.0));
        let seen = |layer: Layer| is_visible(&layer, &panel, limits);
        let line = |points: [(f64, f64); 2]| Polyline::new(PlotRole::Exact, points).into();
        assert!(seen(line([(-1.0, 0.5), (2.0, 0.5)])));
        assert!(!seen(line([(-1.0, 1.5), (2.0, 1.5)])));
        assert!(!seen(Polyline::new(PlotRole::Exact, []).into()));
        assert!(seen(Points::new(PlotRole::Exact, [(1.0, 1.0)]).into()));
        assert!(!seen(Points::new(PlotRole::Exact, [(0.5, 1.1)]).into()));
        assert!(seen(Region::across_x(PlotRole::Stable, f64::NEG_INFINITY, 0.2).into()));
        assert!(!seen(Region::across_x(PlotRole::Stable, 1.2, 2.0).into()));
        assert!(!seen(Region::polygon(PlotRole::Stable, [(2.0, 0.0), (3.0, 1.0)]).into()));
    }
}
