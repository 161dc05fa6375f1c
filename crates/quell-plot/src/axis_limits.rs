//! Stretches: what every panel shows of its coordinates, alone or shared with others.
//!
//! Panels that share a coordinate show what all of them need, by the axis of the first of them.

use super::axis::{AxisRange, PlotAxis, Scale};
use super::figure::{Figure, Panel, Sharing};
use super::layer::Layer;

/// What a panel shows of x and of y.
pub(super) type AxisLimits = ((f64, f64), (f64, f64));
type Extent = Option<(f64, f64)>;

/// What every panel shows of x and y.
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
        let air = if has_curves(panel) { 0.0 } else { 0.04 };
        exact(panel, &panel.x, extent).unwrap_or_else(|| panel.x.limits(extent, air))
    });
    let y_extents: Vec<Extent> =
        panels.iter().zip(&x).map(|(panel, x)| extent(panel, Some(*x))).collect();
    let y = shared(panels, &y_extents, y_group, |panel, extent| {
        exact(panel, &panel.y, extent).unwrap_or_else(|| panel.y.limits(extent, 0.06))
    });
    x.into_iter().zip(y).collect()
}

/// One stretch for all panels of a group, by the axis of its first panel.
fn shared(
    panels: &[Panel],
    extents: &[Extent],
    group: impl Fn(usize) -> usize,
    stretch: impl Fn(&Panel, Extent) -> (f64, f64),
) -> Vec<(f64, f64)> {
    (0..panels.len())
        .map(|index| {
            let members = || (0..panels.len()).filter(|other| group(*other) == group(index));
            let whole = members()
                .filter_map(|member| extents[member])
                .reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)));
            let first = members().next().unwrap_or(index);
            stretch(&panels[first], whole)
        })
        .collect()
}

/// A map fills its frame: no air, no rounding, unless its axis says what to show.
fn exact(panel: &Panel, axis: &PlotAxis, extent: Extent) -> Option<(f64, f64)> {
    extent.filter(|(lower, upper)| {
        panel.layers.iter().any(is_map) && axis.range == AxisRange::Auto && lower < upper
    })
}

fn is_map(layer: &Layer) -> bool {
    matches!(layer, Layer::Heatmap(_) | Layer::Contours(_))
}

/// True when a curve or a region spans the x axis, so that it needs no air at its ends.
fn has_curves(panel: &Panel) -> bool {
    panel.layers.iter().any(|layer| matches!(layer, Layer::Polyline(_) | Layer::Region(_)))
}

/// Least and greatest x that the layers need, or y of what lies within the stretch of x.
fn extent(panel: &Panel, within: Option<(f64, f64)>) -> Extent {
    let axis = if within.is_some() { &panel.y } else { &panel.x };
    let mut whole: Extent = None;
    // Where there is a map, its grid decides what is shown.
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
