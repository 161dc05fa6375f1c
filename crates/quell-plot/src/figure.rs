//! Figures and panels: what a picture consists of.

use super::axis::PlotAxis;
use super::layer::Layer;

/// Where the legend of one panel stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Legend {
    /// In the first place inside the frame where it covers no data, else above the frame.
    #[default]
    Auto,
    /// Nowhere.
    None,
    /// At this place inside the frame, whatever it covers.
    Inside(LegendPosition),
    /// In lines between the title and the frame.
    Above,
}

/// A place inside the frame of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LegendPosition {
    /// Upper right corner.
    TopRight,
    /// Upper left corner.
    TopLeft,
    /// Lower right corner.
    BottomRight,
    /// Lower left corner.
    BottomLeft,
    /// Middle of the upper edge.
    Top,
    /// Middle of the lower edge.
    Bottom,
    /// Middle of the right edge.
    Right,
    /// Middle of the left edge.
    Left,
}

/// One frame with two axes and layers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// Text above the frame, e.g. `(a) $D$ = 0.3`.
    pub title: String,
    /// Horizontal axis.
    pub x: PlotAxis,
    /// Vertical axis.
    pub y: PlotAxis,
    /// What is drawn: regions below, then rules, lines, points and notes, each kind in this order.
    pub layers: Vec<Layer>,
    /// Where the legend stands; unused when the figure has a shared one.
    pub legend: Legend,
}

impl Panel {
    /// An empty panel.
    #[must_use]
    pub fn new(x: PlotAxis, y: PlotAxis) -> Self {
        Self { x, y, ..Self::default() }
    }

    /// Text above the frame.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Adds one layer.
    #[must_use]
    pub fn with(mut self, layer: impl Into<Layer>) -> Self {
        self.layers.push(layer.into());
        self
    }

    /// Adds several layers of one kind.
    #[must_use]
    pub fn with_all<L: Into<Layer>>(mut self, layers: impl IntoIterator<Item = L>) -> Self {
        self.layers.extend(layers.into_iter().map(Into::into));
        self
    }

    /// Where the legend stands.
    #[must_use]
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }
}

/// Which panels show the same stretch of a coordinate, and so need its numbers only once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sharing {
    /// Each panel has its own.
    #[default]
    Separate,
    /// The panels of one column (for x) or of one row (for y) share it.
    Aligned,
    /// All panels share it.
    All,
}

/// One legend for the whole figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SharedLegend {
    /// None: each panel has its own.
    #[default]
    None,
    /// Between the title and the panels.
    Above,
    /// Below the panels.
    Below,
}

/// How large a figure is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Size {
    /// Frames of a size that suits the number of columns.
    #[default]
    Auto,
    /// Each frame this wide and high (pixels of 1/96 inch).
    Frame(f64, f64),
    /// The whole picture this wide and high (pixels of 1/96 inch).
    Whole(f64, f64),
}

/// A picture: panels in rows and columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Title above all; empty for none.
    pub title: String,
    /// Caption or footnote below all; it is broken into lines as needed; empty for none.
    pub caption: String,
    /// The panels, row by row from the upper left.
    pub panels: Vec<Panel>,
    /// How many panels stand side by side.
    pub columns: usize,
    /// Which panels share the stretch of x.
    pub sharing_x: Sharing,
    /// Which panels share the stretch of y.
    pub sharing_y: Sharing,
    /// One legend for all panels.
    pub legend: SharedLegend,
    /// How large the picture is.
    pub size: Size,
}

impl Figure {
    /// One panel alone.
    #[must_use]
    pub fn single(panel: Panel) -> Self {
        Self::grid(1, [panel])
    }

    /// Panels in rows of `columns` (at least 1), filled from the upper left.
    #[must_use]
    pub fn grid(columns: usize, panels: impl IntoIterator<Item = Panel>) -> Self {
        Self {
            title: String::new(),
            caption: String::new(),
            panels: panels.into_iter().collect(),
            columns: columns.max(1),
            sharing_x: Sharing::Separate,
            sharing_y: Sharing::Separate,
            legend: SharedLegend::None,
            size: Size::Auto,
        }
    }

    /// Title above all.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Caption or footnote below all.
    #[must_use]
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Which panels share the stretch of x.
    #[must_use]
    pub fn sharing_x(mut self, sharing: Sharing) -> Self {
        self.sharing_x = sharing;
        self
    }

    /// Which panels share the stretch of y.
    #[must_use]
    pub fn sharing_y(mut self, sharing: Sharing) -> Self {
        self.sharing_y = sharing;
        self
    }

    /// One legend for all panels.
    #[must_use]
    pub fn legend(mut self, legend: SharedLegend) -> Self {
        self.legend = legend;
        self
    }

    /// How large the picture is.
    #[must_use]
    pub fn size(mut self, size: Size) -> Self {
        self.size = size;
        self
    }
}
