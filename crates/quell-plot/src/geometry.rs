//! Points, ranges and sizes, in data coordinates or in pixels.

/// A point of a figure: in data coordinates, or in pixels from the upper left.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlotPoint {
    /// Horizontal coordinate.
    pub x: f64,
    /// Vertical coordinate.
    pub y: f64,
}

impl PlotPoint {
    /// The point with these coordinates.
    #[must_use]
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// The points whose coordinates are these numbers, pair by pair.
    pub fn zip(
        x: impl IntoIterator<Item = f64>,
        y: impl IntoIterator<Item = f64>,
    ) -> impl Iterator<Item = Self> {
        x.into_iter().zip(y).map(|(x, y)| Self { x, y })
    }

    /// Whether both coordinates are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }

    /// The point displaced by these lengths.
    #[must_use]
    pub fn moved(self, dx: f64, dy: f64) -> Self {
        Self { x: self.x + dx, y: self.y + dy }
    }

    /// Distance to another point.
    pub(super) fn distance(self, other: Self) -> f64 {
        libm::hypot(other.x - self.x, other.y - self.y)
    }
}

/// All numbers between two: the limits of an axis, or the values of a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlotRange {
    /// Least number.
    pub lower: f64,
    /// Greatest number.
    pub upper: f64,
}

impl PlotRange {
    /// The range with these ends, `lower` ≤ `upper`.
    #[must_use]
    pub const fn new(lower: f64, upper: f64) -> Self {
        Self { lower, upper }
    }

    /// The range between two numbers in either order.
    pub(super) fn between(one: f64, other: f64) -> Self {
        Self { lower: one.min(other), upper: one.max(other) }
    }

    /// Distance of the ends.
    #[must_use]
    pub fn width(self) -> f64 {
        self.upper - self.lower
    }

    /// Whether this number is in the range.
    #[must_use]
    pub fn contains(self, value: f64) -> bool {
        value >= self.lower && value <= self.upper
    }

    /// The least range that includes both.
    pub(super) fn hull(self, other: Self) -> Self {
        Self { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// The least range that includes all these numbers; `None` without numbers.
    pub(super) fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        values.into_iter().map(|value| Self::new(value, value)).reduce(Self::hull)
    }

    /// Whether the ranges have a number in common.
    pub(super) fn overlaps(self, other: Self) -> bool {
        self.lower <= other.upper && self.upper >= other.lower
    }
}

/// Width and height of a frame, a box or a text (pixels).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameSize {
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl FrameSize {
    /// A size of this width and height.
    #[must_use]
    pub const fn new(width: f64, height: f64) -> Self {
        Self { width, height }
    }
}
