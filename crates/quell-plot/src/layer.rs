//! Layers of a panel: curves, points, regions, rules and notes.

use super::map_layers::{Contours, Heatmap};
use super::palette::{LineStyle, PlotRole};

/// A curve, perhaps in several pieces, under one entry of the legend.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyline {
    /// What the curve stands for.
    pub role: PlotRole,
    /// The pieces, each a list of (x, y); no stroke leads from one piece to the next.
    pub pieces: Vec<Vec<(f64, f64)>>,
    /// Dashes, where the role's own are not wanted.
    pub style: Option<LineStyle>,
    /// Width in pixels, where the role's own is not wanted.
    pub width: Option<f64>,
    /// Text in the legend; empty for no entry.
    pub label: String,
}

impl Polyline {
    /// A curve through these points. A point that is not finite ends one piece.
    #[must_use]
    pub fn new(role: PlotRole, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        Self::pieces(role, [points])
    }

    /// A curve of several pieces: a discontinuity stays open between them.
    #[must_use]
    pub fn pieces<Piece>(role: PlotRole, pieces: impl IntoIterator<Item = Piece>) -> Self
    where
        Piece: IntoIterator<Item = (f64, f64)>,
    {
        let mut whole = Vec::new();
        for piece in pieces {
            let mut current = Vec::new();
            for (x, y) in piece {
                if x.is_finite() && y.is_finite() {
                    current.push((x, y));
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

    /// Dashes other than the role's.
    #[must_use]
    pub fn style(mut self, style: LineStyle) -> Self {
        self.style = Some(style);
        self
    }

    /// Width (pixels) other than the role's.
    #[must_use]
    pub fn width(mut self, width: f64) -> Self {
        self.width = Some(width);
        self
    }
}

/// Shape of a point.
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

/// Separate points.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    /// What the points stand for.
    pub role: PlotRole,
    /// The points (x, y).
    pub points: Vec<(f64, f64)>,
    /// Their shape.
    pub marker: Marker,
    /// Their diameter (pixels).
    pub size: f64,
    /// Text in the legend; empty for no entry.
    pub label: String,
}

impl Points {
    /// Discs of 5 pixels at these points; a point that is not finite is left out.
    #[must_use]
    pub fn new(role: PlotRole, points: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let points = points.into_iter().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        Self { role, points, marker: Marker::Disc, size: 5.0, label: String::new() }
    }

    /// Shape of the points.
    #[must_use]
    pub fn marker(mut self, marker: Marker) -> Self {
        self.marker = marker;
        self
    }

    /// Diameter of the points (pixels).
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

/// How a region is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Fill {
    /// A light tint, under which curves stay readable.
    #[default]
    Shade,
    /// A stronger tint.
    Solid,
    /// Thin diagonal strokes, for a second region over a first.
    Hatched,
}

impl Fill {
    /// Opacity of a tint; none of strokes.
    pub(super) fn opacity(self) -> Option<f64> {
        match self {
            Self::Shade => Some(0.16),
            Self::Solid => Some(0.38),
            Self::Hatched => None,
        }
    }
}

/// What a region covers.
#[derive(Debug, Clone, PartialEq)]
pub enum RegionShape {
    /// The inside of a closed polygon of (x, y).
    Polygon(Vec<(f64, f64)>),
    /// All y while x is between two values; infinite values reach the frame.
    AcrossX(f64, f64),
    /// All x while y is between two values; infinite values reach the frame.
    AcrossY(f64, f64),
}

/// A part of the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// What the region stands for.
    pub role: PlotRole,
    /// What it covers.
    pub shape: RegionShape,
    /// How it is filled.
    pub fill: Fill,
    /// Text in the legend; empty for no entry.
    pub label: String,
}

impl Region {
    /// The inside of a polygon; it closes itself.
    #[must_use]
    pub fn polygon(role: PlotRole, corners: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let corners = corners.into_iter().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        Self::of(role, RegionShape::Polygon(corners))
    }

    /// What lies between two curves, each given from left to right; their x need not be the same.
    #[must_use]
    pub fn between(
        role: PlotRole,
        lower: impl IntoIterator<Item = (f64, f64)>,
        upper: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let mut back: Vec<_> = upper.into_iter().collect();
        back.reverse();
        Self::polygon(role, lower.into_iter().chain(back))
    }

    /// The vertical strip between two x.
    #[must_use]
    pub fn across_x(role: PlotRole, from: f64, to: f64) -> Self {
        Self::of(role, RegionShape::AcrossX(from, to))
    }

    /// The horizontal strip between two y.
    #[must_use]
    pub fn across_y(role: PlotRole, from: f64, to: f64) -> Self {
        Self::of(role, RegionShape::AcrossY(from, to))
    }

    fn of(role: PlotRole, shape: RegionShape) -> Self {
        Self { role, shape, fill: Fill::Shade, label: String::new() }
    }

    /// How the region is filled.
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

/// Direction of a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Orientation {
    /// At one x, from bottom to top.
    Vertical,
    /// At one y, from left to right.
    Horizontal,
}

/// A straight line through the whole panel, at one value.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceLine {
    /// What the rule stands for.
    pub role: PlotRole,
    /// Upright or level.
    pub orientation: Orientation,
    /// The x of an upright rule, the y of a level one.
    pub value: f64,
    /// Dashes, where the role's own are not wanted.
    pub style: Option<LineStyle>,
    /// Text beside the rule; empty for none.
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

    /// What the rule stands for.
    #[must_use]
    pub fn role(mut self, role: PlotRole) -> Self {
        self.role = role;
        self
    }

    /// Dashes other than the role's.
    #[must_use]
    pub fn style(mut self, style: LineStyle) -> Self {
        self.style = Some(style);
        self
    }

    /// Text beside the rule; it takes whichever end covers no data.
    #[must_use]
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }
}

/// A text at a point of the data.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// The point (x, y) it belongs to.
    pub at: (f64, f64),
    /// The text.
    pub text: String,
    /// Colour of this role in place of black.
    pub role: Option<PlotRole>,
}

impl Note {
    /// A text centred on (x, y).
    #[must_use]
    pub fn new(x: f64, y: f64, text: impl Into<String>) -> Self {
        Self { at: (x, y), text: text.into(), role: None }
    }

    /// Prints in the colour of this role.
    #[must_use]
    pub fn role(mut self, role: PlotRole) -> Self {
        self.role = Some(role);
        self
    }
}

/// Anything that can lie on a panel.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Layer {
    /// A curve.
    Polyline(Polyline),
    /// Points.
    Points(Points),
    /// A part of the plane.
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
    /// Hands every (x, y) that asks for room on the axes to `visit`; a strip or a rule asks in one coordinate only.
    pub(super) fn each_extent(&self, mut visit: impl FnMut(Option<f64>, Option<f64>)) {
        match self {
            Self::Polyline(line) => {
                for &(x, y) in line.pieces.iter().flatten() {
                    visit(Some(x), Some(y));
                }
            }
            Self::Points(points) => {
                for &(x, y) in &points.points {
                    visit(Some(x), Some(y));
                }
            }
            Self::Region(region) => match &region.shape {
                RegionShape::Polygon(corners) => {
                    for &(x, y) in corners {
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
            Self::Note(note) => visit(Some(note.at.0), Some(note.at.1)),
            Self::Heatmap(Heatmap { field, .. }) | Self::Contours(Contours { field, .. }) => {
                for (x, y) in field.corners() {
                    visit(Some(x), Some(y));
                }
            }
        }
    }
}
