//! Layers of a panel: curves, points, regions, reference lines and notes.

use super::geometry::PlotPoint;
use super::map_layers::{Contours, Heatmap};
use super::palette::{LineStyle, PlotRole};
use super::shades::outcome_opacity;

/// A curve of one or more pieces with one legend entry.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyline {
    /// What the curve represents.
    pub role: PlotRole,
    /// The pieces, each a list of (x, y); pieces are not connected.
    pub pieces: Vec<Vec<PlotPoint>>,
    /// Dashes; `None` for those of the role.
    pub style: Option<LineStyle>,
    /// Width in pixels; `None` for that of the role.
    pub width: Option<f64>,
    /// Text in the legend; empty for no entry.
    pub label: String,
}

impl Polyline {
    /// A curve through these points. A non-finite point ends a piece.
    #[must_use]
    pub fn new(role: PlotRole, points: impl IntoIterator<Item = PlotPoint>) -> Self {
        Self::pieces(role, [points])
    }

    /// A curve of several pieces, with gaps between them.
    #[must_use]
    pub fn pieces<Piece>(role: PlotRole, pieces: impl IntoIterator<Item = Piece>) -> Self
    where
        Piece: IntoIterator<Item = PlotPoint>,
    {
        let mut whole = Vec::new();
        for piece in pieces {
            let mut current = Vec::new();
            for point in piece {
                if point.is_finite() {
                    current.push(point);
                } else if !current.is_empty() {
                    whole.push(std::mem::take(&mut current));
                }
            }
            if !current.is_empty() {
                whole.push(current);
            }
        }
        Self { role, pieces: whole, style: None, width: None, label: String::new() }
    }

    /// Text in the legend.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Overrides the dashes of the role.
    #[must_use]
    pub fn style(mut self, style: LineStyle) -> Self {
        self.style = Some(style);
        self
    }

    /// Overrides the width of the role (pixels).
    #[must_use]
    pub fn width(mut self, width: f64) -> Self {
        self.width = Some(width);
        self
    }
}

/// Shape of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Marker {
    /// Filled circle.
    #[default]
    Disc,
    /// Open circle.
    Circle,
    /// Diagonal cross.
    Cross,
}

/// Scattered points.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// What the points represent.
    pub role: PlotRole,
    /// The points (x, y).
    pub points: Vec<PlotPoint>,
    /// Shape of the markers.
    pub marker: Marker,
    /// Diameter of the markers (pixels).
    pub size: f64,
    /// Text in the legend; empty for no entry.
    pub label: String,
}

impl Points {
    /// Discs of 5 pixels at these points; non-finite points are omitted.
    #[must_use]
    pub fn new(role: PlotRole, points: impl IntoIterator<Item = PlotPoint>) -> Self {
        let points = points.into_iter().filter(PlotPoint::is_finite).collect();
        Self { role, points, marker: Marker::Disc, size: 5.0, label: String::new() }
    }

    /// Sets the shape of the markers.
    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.marker = marker;
        self
    }

    /// Sets the diameter of the markers (pixels).
    #[must_use]
    pub fn size(mut self, size: f64) -> Self {
        self.size = size;
        self
    }

    /// Text in the legend.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }
}

/// Fill style of a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fill {
    /// A light tint that keeps curves readable.
    #[default]
    Shade,
    /// A stronger tint.
    Solid,
    /// Thin diagonal strokes, for a region on top of another.
    Hatched,
    /// A tint whose grey level differs from those of outcomes with neighbouring numbers.
    Outcome(usize),
}

impl Fill {
    /// Opacity of a tint of this role; `None` for a hatch.
    pub(super) fn opacity(self, role: PlotRole) -> Option<f64> {
        match self {
            Self::Outcome(number) => Some(outcome_opacity(role.colour(), number)),
            Self::Shade => Some(0.16),
            Self::Solid => Some(0.38),
            Self::Hatched => None,
        }
    }
}

/// Shape of a region.
#[derive(Debug, Clone, PartialEq)]
pub enum RegionShape {
    /// The interior of a closed polygon of (x, y).
    Polygon(Vec<PlotPoint>),
    /// The vertical strip between two values of x; infinite values extend to the frame.
    AcrossX(f64, f64),
    /// The horizontal strip between two values of y; infinite values extend to the frame.
    AcrossY(f64, f64),
}

/// A region of the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// What the region represents.
    pub role: PlotRole,
    /// Its shape.
    pub shape: RegionShape,
    /// Its fill style.
    pub fill: Fill,
    /// Text in the legend; empty for no entry.
    pub label: String,
}

impl Region {
    /// The interior of a polygon, which is closed automatically.
    #[must_use]
    pub fn polygon(role: PlotRole, corners: impl IntoIterator<Item = PlotPoint>) -> Self {
        let corners = corners.into_iter().filter(PlotPoint::is_finite).collect();
        Self::of(role, RegionShape::Polygon(corners))
    }

    /// The region between two curves, each given from left to right; their x values may differ.
    #[must_use]
    pub fn between(
        role: PlotRole,
        lower: impl IntoIterator<Item = PlotPoint>,
        upper: impl IntoIterator<Item = PlotPoint>,
    ) -> Self {
        let mut back: Vec<_> = upper.into_iter().collect();
        back.reverse();
        Self::polygon(role, lower.into_iter().chain(back))
    }

    /// The vertical strip between two values of x.
    #[must_use]
    pub fn across_x(role: PlotRole, from: f64, to: f64) -> Self {
        Self::of(role, RegionShape::AcrossX(from, to))
    }

    /// The horizontal strip between two values of y.
    #[must_use]
    pub fn across_y(role: PlotRole, from: f64, to: f64) -> Self {
        Self::of(role, RegionShape::AcrossY(from, to))
    }

    fn of(role: PlotRole, shape: RegionShape) -> Self {
        Self { role, shape, fill: Fill::Shade, label: String::new() }
    }

    /// Sets the fill style.
    #[must_use]
    pub fn fill(mut self, fill: Fill) -> Self {
        self.fill = fill;
        self
    }

    /// Text in the legend.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }
}

/// Orientation of a reference line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Orientation {
    /// At one x, from bottom to top.
    Vertical,
    /// At one y, from left to right.
    Horizontal,
}

/// A straight line across the whole panel, at one value.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceLine {
    /// What the line represents.
    pub role: PlotRole,
    /// Vertical or horizontal.
    pub orientation: Orientation,
    /// The x of a vertical line, the y of a horizontal one.
    pub value: f64,
    /// Dashes; `None` for those of the role.
    pub style: Option<LineStyle>,
    /// Text next to the line; empty for none.
    pub label: String,
}

impl ReferenceLine {
    /// A thin dotted grey line at this x.
    #[must_use]
    pub fn vertical(x: f64) -> Self {
        Self::of(Orientation::Vertical, x)
    }

    /// A thin dotted grey line at this y.
    #[must_use]
    pub fn horizontal(y: f64) -> Self {
        Self::of(Orientation::Horizontal, y)
    }

    fn of(orientation: Orientation, value: f64) -> Self {
        Self { role: PlotRole::Guide, orientation, value, style: None, label: String::new() }
    }

    /// Sets what the line represents.
    #[must_use]
    pub fn role(mut self, role: PlotRole) -> Self {
        self.role = role;
        self
    }

    /// Overrides the dashes of the role.
    #[must_use]
    pub fn style(mut self, style: LineStyle) -> Self {
        self.style = Some(style);
        self
    }

    /// Sets the text next to the line; it is placed where it covers least.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }
}

/// A text at a point in data coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// The point (x, y) it belongs to.
    pub at: PlotPoint,
    /// The text.
    pub text: String,
    /// Role that sets the colour; `None` for black.
    pub role: Option<PlotRole>,
}

impl Note {
    /// A text centred on (x, y).
    #[must_use]
    pub fn new(x: f64, y: f64, text: impl Into<String>) -> Self {
        Self { at: PlotPoint::new(x, y), text: text.into(), role: None }
    }

    /// Uses the colour of this role.
    #[must_use]
    pub fn role(mut self, role: PlotRole) -> Self {
        self.role = Some(role);
        self
    }
}

/// One layer of a panel.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Layer {
    /// A curve.
    Polyline(Polyline),
    /// Points.
    Points(Points),
    /// A region of the plane.
    Region(Region),
    /// A line at one value.
    ReferenceLine(ReferenceLine),
    /// A text.
    Note(Note),
    /// A field as colours.
    Heatmap(Heatmap),
    /// Isolines of a field.
    Contours(Contours),
}

macro_rules! layer_from {
    ($($kind:ident),*) => {$(
        impl From<$kind> for Layer {
            fn from(layer: $kind) -> Self {
                Self::$kind(layer)
            }
        }
    )*};
}
layer_from!(Polyline, Points, Region, ReferenceLine, Note, Heatmap, Contours);

impl Layer {
    /// Calls `visit` with every (x, y) that the axis limits must include; strips and reference lines have one coordinate only.
    pub(super) fn each_extent(&self, mut visit: impl FnMut(Option<f64>, Option<f64>)) {
        match self {
            Self::Polyline(line) => {
                for &PlotPoint { x, y } in line.pieces.iter().flatten() {
                    visit(Some(x), Some(y));
                }
            }
            Self::Points(points) => {
                for &PlotPoint { x, y } in &points.points {
                    visit(Some(x), Some(y));
                }
            }
            Self::Region(region) => match &region.shape {
                RegionShape::Polygon(corners) => {
                    for &PlotPoint { x, y } in corners {
                        visit(Some(x), Some(y));
                    }
                }
                RegionShape::AcrossX(from, to) => {
                    visit(Some(*from), None);
                    visit(Some(*to), None);
                }
                RegionShape::AcrossY(from, to) => {
                    visit(None, Some(*from));
                    visit(None, Some(*to));
                }
            },
            Self::ReferenceLine(rule) => match rule.orientation {
                Orientation::Vertical => visit(Some(rule.value), None),
                Orientation::Horizontal => visit(None, Some(rule.value)),
            },
            Self::Note(note) => visit(Some(note.at.x), Some(note.at.y)),
            Self::Heatmap(Heatmap { field, .. }) | Self::Contours(Contours { field, .. }) => {
                for PlotPoint { x, y } in field.corners() {
                    visit(Some(x), Some(y));
                }
            }
        }
    }
}
