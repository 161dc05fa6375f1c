//! Visibility: whether anything of a layer is drawn inside the limits of its panel.

use super::axis_limits::AxisLimits;
use super::figure::Panel;
use super::geometry::{PlotPoint, PlotRange};
use super::layer::{Layer, Orientation, RegionShape};

/// Whether anything of the layer is inside the limits.
pub(super) fn is_visible(layer: &Layer, panel: &Panel, limits: AxisLimits) -> bool {
    let AxisLimits { x: across, y: upright } = limits;
    let at = |value: f64| PlotRange::new(value, value);
    match layer {
        Layer::Polyline(line) => line.pieces.iter().any(|piece| crosses(piece, limits)),
        Layer::Points(points) => points
            .points
            .iter()
            .any(|point| across.overlaps(at(point.x)) && upright.overlaps(at(point.y))),
        Layer::Region(region) => match &region.shape {
            RegionShape::Polygon(corners) => {
                let x = PlotRange::of(corners.iter().map(|corner| corner.x));
                let y = PlotRange::of(corners.iter().map(|corner| corner.y));
                x.zip(y).is_some_and(|(x, y)| across.overlaps(x) && upright.overlaps(y))
            }
            RegionShape::AcrossX(from, to) => across.overlaps(PlotRange::between(*from, *to)),
            RegionShape::AcrossY(from, to) => upright.overlaps(PlotRange::between(*from, *to)),
        },
        Layer::ReferenceLine(rule) => {
            let limits = match rule.orientation {
                Orientation::Vertical => across,
                Orientation::Horizontal => upright,
            };
            limits.contains(rule.value)
        }
        Layer::Contours(isolines) => {
            isolines.lines(&panel.x, &panel.y).iter().flatten().any(|line| crosses(line, limits))
        }
        Layer::Note(_) | Layer::Heatmap(_) => true,
    }
}

/// Whether a stroke, or the rectangle around one of its segments, meets the limits.
fn crosses(points: &[PlotPoint], limits: AxisLimits) -> bool {
    let meets = |from: PlotPoint, to: PlotPoint| {
        limits.x.overlaps(PlotRange::between(from.x, to.x))
            && limits.y.overlaps(PlotRange::between(from.y, to.y))
    };
    match points {
        [only] => meets(*only, *only),
        points => points.windows(2).any(|pair| meets(pair[0], pair[1])),
    }
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
        let unit = PlotRange::new(0.0, 1.0);
        let limits = AxisLimits { x: unit, y: unit };
        let seen = |layer: Layer| is_visible(&layer, &panel, limits);
        let line = |points: [PlotPoint; 2]| Polyline::new(PlotRole::Exact, points).into();
        assert!(seen(line([PlotPoint::new(-1.0, 0.5), PlotPoint::new(2.0, 0.5)])));
        assert!(!seen(line([PlotPoint::new(-1.0, 1.5), PlotPoint::new(2.0, 1.5)])));
        assert!(!seen(Polyline::new(PlotRole::Exact, []).into()));
        assert!(seen(Points::new(PlotRole::Exact, [PlotPoint::new(1.0, 1.0)]).into()));
        assert!(!seen(Points::new(PlotRole::Exact, [PlotPoint::new(0.5, 1.1)]).into()));
        assert!(seen(Region::across_x(PlotRole::Stable, f64::NEG_INFINITY, 0.2).into()));
        assert!(!seen(Region::across_x(PlotRole::Stable, 1.2, 2.0).into()));
        assert!(!seen(
            Region::polygon(PlotRole::Stable, [PlotPoint::new(2.0, 0.0), PlotPoint::new(3.0, 1.0)])
                .into()
        ));
    }
}
