//! Axis limits: the range of x and y that each panel shows, separate or shared with other panels.
//!
//! Panels that share an axis show the range that all of them need, by the settings of the first panel's axis.

use super::axis::{AxisRange, PlotAxis, Scale};
use super::figure::{Figure, Panel, Sharing};
use super::geometry::{FrameSize, PlotRange};
use super::layer::Layer;

/// Limits of x and y of one panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct AxisLimits {
    pub(super) x: PlotRange,
    pub(super) y: PlotRange,
}

/// Limits of x and y of every panel.
pub(super) fn axis_limits(figure: &Figure, columns: usize) -> Vec<AxisLimits> {
    let panels = &figure.panels;
    let group = |sharing: Sharing, index: usize, aligned: usize| match sharing {
        Sharing::Separate => index,
        Sharing::Aligned => aligned,
        Sharing::All => 0,
    };
    let x_group = |index: usize| group(figure.sharing_x, index, index % columns);
    let y_group = |index: usize| group(figure.sharing_y, index, index / columns);

    let x_extents: Vec<Option<PlotRange>> =
        panels.iter().map(|panel| extent(panel, None)).collect();
    let x = shared(panels, &x_extents, x_group, |panel, extent| {
        let margin = if has_curves(panel) { 0.0 } else { 0.04 };
        exact(panel, &panel.x, extent).unwrap_or_else(|| panel.x.limits(extent, margin))
    });
    let y_extents: Vec<Option<PlotRange>> =
        panels.iter().zip(&x).map(|(panel, x)| extent(panel, Some(*x))).collect();
    let y = shared(panels, &y_extents, y_group, |panel, extent| {
        exact(panel, &panel.y, extent).unwrap_or_else(|| panel.y.limits(extent, 0.06))
    });
    x.into_iter().zip(y).map(|(x, y)| AxisLimits { x, y }).collect()
}

/// Widens the limits of panels with equal scales to the shape of the frame (pixels).
pub(super) fn widen_to_equal_scales(figure: &Figure, limits: &mut [AxisLimits], frame: FrameSize) {
    let widened = |range: PlotRange, length: f64| {
        let excess = 0.5 * (length - range.width()).max(0.0);
        PlotRange::new(range.lower - excess, range.upper + excess)
    };
    for (panel, AxisLimits { x, y }) in figure.panels.iter().zip(limits) {
        if panel.equal_scales {
            let unit = (frame.width / x.width()).min(frame.height / y.width());
            *x = widened(*x, frame.width / unit);
            *y = widened(*y, frame.height / unit);
        }
    }
}

/// Height over width of the frame that panels with equal scales fill; `None` without such panels.
pub(super) fn shape_of_equal_scales(figure: &Figure, columns: usize) -> Option<f64> {
    let limits = axis_limits(figure, columns);
    let equal = figure.panels.iter().zip(limits).filter(|(panel, _)| panel.equal_scales);
    equal.map(|(_, limits)| limits.y.width() / limits.x.width()).reduce(f64::max)
}

/// Common limits for all panels of a group, by the axis of its first panel.
fn shared(
    panels: &[Panel],
    extents: &[Option<PlotRange>],
    group: impl Fn(usize) -> usize,
    limits: impl Fn(&Panel, Option<PlotRange>) -> PlotRange,
) -> Vec<PlotRange> {
    (0..panels.len())
        .map(|index| {
            let members = || (0..panels.len()).filter(|other| group(*other) == group(index));
            let whole = members().filter_map(|member| extents[member]).reduce(PlotRange::hull);
            let first = members().next().unwrap_or(index);
            limits(&panels[first], whole)
        })
        .collect()
}

/// Limits of a map, which fills its frame without margins or rounding, unless its axis sets the limits.
fn exact(panel: &Panel, axis: &PlotAxis, extent: Option<PlotRange>) -> Option<PlotRange> {
    extent.filter(|extent| {
        let has_map = panel.layers.iter().any(is_map);
        has_map && axis.range == AxisRange::Auto && extent.lower < extent.upper
    })
}

fn is_map(layer: &Layer) -> bool {
    matches!(layer, Layer::Heatmap(_) | Layer::Contours(_))
}

/// True when a curve or a region spans the x axis, which then needs no margins.
fn has_curves(panel: &Panel) -> bool {
    panel.layers.iter().any(|layer| matches!(layer, Layer::Polyline(_) | Layer::Region(_)))
}

/// Extent of the layers in x, or in y of the points within the given limits of x.
fn extent(panel: &Panel, within: Option<PlotRange>) -> Option<PlotRange> {
    let axis = if within.is_some() { &panel.y } else { &panel.x };
    let mut whole: Option<PlotRange> = None;
    // In a panel with a map, the grid of the map determines the limits.
    let has_map = panel.layers.iter().any(is_map);
    for layer in panel.layers.iter().filter(|layer| !has_map || is_map(layer)) {
        layer.each_extent(|x, y| {
            let hidden = within.zip(x).is_some_and(|(range, x)| x < range.lower || x > range.upper);
            let value = if within.is_some() { y } else { x };
            let Some(value) = value.filter(|value| value.is_finite()) else {
                return;
            };
            if hidden || (axis.scale == Scale::Log && value <= 0.0) {
                return;
            }
            let value = PlotRange::new(value, value);
            whole = Some(whole.map_or(value, |whole| whole.hull(value)));
        });
    }
    whole
}
