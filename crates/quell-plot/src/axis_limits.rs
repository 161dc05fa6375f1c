//! Axis limits: the range of x and y that each panel shows, separate or shared with other panels.
//!
//! Panels that share an axis show the range that all of them need, by the settings of the first panel's axis.

use super::axis::{AxisRange, PlotAxis, Scale};
use super::figure::{Figure, Panel, Sharing};
use super::layer::Layer;

/// Limits of x and y of one panel.
pub(super) type AxisLimits = ((f64, f64), (f64, f64));
type Extent = Option<(f64, f64)>;

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

    let x_extents: Vec<Extent> = panels.iter().map(|panel| extent(panel, None)).collect();
    let x = shared(panels, &x_extents, x_group, |panel, extent| {
        let margin = if has_curves(panel) { 0.0 } else { 0.04 };
        exact(panel, &panel.x, extent).unwrap_or_else(|| panel.x.limits(extent, margin))
    });
    let y_extents: Vec<Extent> =
        panels.iter().zip(&x).map(|(panel, x)| extent(panel, Some(*x))).collect();
    let y = shared(panels, &y_extents, y_group, |panel, extent| {
        exact(panel, &panel.y, extent).unwrap_or_else(|| panel.y.limits(extent, 0.06))
    });
    x.into_iter().zip(y).collect()
}

/// Widens the limits of panels with equal scales to the shape of the frame (pixels).
pub(super) fn widen_to_equal_scales(figure: &Figure, limits: &mut [AxisLimits], frame: (f64, f64)) {
    let widened = |(lower, upper): (f64, f64), length: f64| {
        let excess = 0.5 * (length - (upper - lower)).max(0.0);
        (lower - excess, upper + excess)
    };
    for (panel, (across, upright)) in figure.panels.iter().zip(limits) {
        if panel.equal_scales {
            let unit = (frame.0 / (across.1 - across.0)).min(frame.1 / (upright.1 - upright.0));
            *across = widened(*across, frame.0 / unit);
            *upright = widened(*upright, frame.1 / unit);
        }
    }
}

/// Height over width of the frame that panels with equal scales fill; `None` without such panels.
pub(super) fn shape_of_equal_scales(figure: &Figure, columns: usize) -> Option<f64> {
    let limits = axis_limits(figure, columns);
    let equal = figure.panels.iter().zip(limits).filter(|(panel, _)| panel.equal_scales);
    equal
        .map(|(_, (across, upright))| (upright.1 - upright.0) / (across.1 - across.0))
        .reduce(f64::max)
}

/// Common limits for all panels of a group, by the axis of its first panel.
fn shared(
    panels: &[Panel],
    extents: &[Extent],
    group: impl Fn(usize) -> usize,
    limits: impl Fn(&Panel, Extent) -> (f64, f64),
) -> Vec<(f64, f64)> {
    (0..panels.len())
        .map(|index| {
            let members = || (0..panels.len()).filter(|other| group(*other) == group(index));
            let whole = members()
                .filter_map(|member| extents[member])
                .reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)));
            let first = members().next().unwrap_or(index);
            limits(&panels[first], whole)
        })
        .collect()
}

/// Limits of a map, which fills its frame without margins or rounding, unless its axis sets the limits.
fn exact(panel: &Panel, axis: &PlotAxis, extent: Extent) -> Option<(f64, f64)> {
    extent.filter(|(lower, upper)| {
        panel.layers.iter().any(is_map) && axis.range == AxisRange::Auto && lower < upper
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
fn extent(panel: &Panel, within: Option<(f64, f64)>) -> Extent {
    let axis = if within.is_some() { &panel.y } else { &panel.x };
    let mut whole: Extent = None;
    // In a panel with a map, the grid of the map determines the limits.
    let has_map = panel.layers.iter().any(is_map);
    for layer in panel.layers.iter().filter(|layer| !has_map || is_map(layer)) {
        layer.each_extent(|x, y| {
            let hidden = within.zip(x).is_some_and(|((lower, upper), x)| x < lower || x > upper);
            let value = if within.is_some() { y } else { x };
            let Some(value) = value.filter(|value| value.is_finite()) else {
                return;
            };
            if hidden || (axis.scale == Scale::Log && value <= 0.0) {
                return;
            }
            whole = Some(whole.map_or((value, value), |(lower, upper): (f64, f64)| {
                (lower.min(value), upper.max(value))
            }));
        });
    }
    whole
}
