//! Figures and panels.

use super::axis::PlotAxis;
use super::layer::Layer;
use super::typeset::RichText;

/// Placement of the legend of one panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Legend {
    /// At the first position inside the frame where it covers no data, otherwise above the frame.
    #[default]
    Auto,
    /// No legend.
    None,
    /// At this position inside the frame, even if it covers data.
    Inside(LegendPosition),
    /// In rows between the title and the frame.
    Above,
}

/// A position of the legend inside the frame of a panel.
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

/// One frame with two axes and its layers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Panel {
    /// Text above the frame, e.g. `(a) $D$ = 0.3`.
    pub title: String,
    /// Horizontal axis.
    pub x: PlotAxis,
    /// Vertical axis.
    pub y: PlotAxis,
    /// The layers: heatmaps are drawn first, then regions, reference lines, contours, lines, points and notes; layers of
    /// one kind are drawn in the order of this list.
    pub layers: Vec<Layer>,
    /// Placement of the legend; unused when the figure has a shared legend.
    pub legend: Legend,
    /// Whether a unit of x is as long as a unit of y, for circles and discs. Then the limits are widened where the frame
    /// has another shape. Both axes are linear.
    pub equal_scales: bool,
}

impl Panel {
    /// An empty panel.
    #[must_use]
    pub fn new(x: PlotAxis, y: PlotAxis) -> Self {
        Self { x, y, ..Self::default() }
    }

    /// Sets the text above the frame.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Makes a unit of x as long as a unit of y.
    #[must_use]
    pub fn equal_scales(mut self) -> Self {
        self.equal_scales = true;
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

    /// Sets the placement of the legend.
    #[must_use]
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }
}

/// Which panels share the limits of an axis, so that its tick labels are needed only once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sharing {
    /// Each panel has its own limits.
    #[default]
    Separate,
    /// The panels of one column (for x) or of one row (for y) share their limits.
    Aligned,
    /// All panels share their limits.
    All,
}

/// One legend for the whole figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SharedLegend {
    /// No shared legend: each panel has its own.
    #[default]
    None,
    /// Between the title and the panels.
    Above,
    /// Below the panels.
    Below,
}

/// Placement of the caption.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum CaptionPlacement {
    /// Below all panels.
    #[default]
    Below,
    /// Not drawn: the text next to the figure has it. An SVG has it as its description.
    Apart,
}

/// Size of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Size {
    /// A frame size that suits the number of columns.
    #[default]
    Auto,
    /// Width and height of each frame (pixels of 1/96 inch).
    Frame(f64, f64),
    /// Width and height of the whole figure (pixels of 1/96 inch).
    Whole(f64, f64),
    /// Width of the whole figure (pixels of 1/96 inch), such as the column of a journal. The height follows from the panels,
    /// which are placed in fewer columns where their frames would become too narrow. The text keeps its size.
    Wide(f64),
}

/// A figure: panels in rows and columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Title above all panels; empty for none.
    pub title: String,
    /// Caption or footnote, broken into lines as needed; empty for none.
    pub caption: String,
    /// Where the caption is.
    pub caption_placement: CaptionPlacement,
    /// The panels, row by row from the upper left.
    pub panels: Vec<Panel>,
    /// Number of columns.
    pub columns: usize,
    /// Which panels share the limits of x.
    pub sharing_x: Sharing,
    /// Which panels share the limits of y.
    pub sharing_y: Sharing,
    /// Legend for all panels.
    pub legend: SharedLegend,
    /// Size of the figure.
    pub size: Size,
}

impl Figure {
    /// A figure of one panel.
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
            caption_placement: CaptionPlacement::Below,
            panels: panels.into_iter().collect(),
            columns: columns.max(1),
            sharing_x: Sharing::Separate,
            sharing_y: Sharing::Separate,
            legend: SharedLegend::None,
            size: Size::Auto,
        }
    }

    /// Sets the title above all panels.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Sets the caption or footnote below all panels.
    #[must_use]
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Sets where the caption is.
    #[must_use]
    pub fn caption_placement(mut self, placement: CaptionPlacement) -> Self {
        self.caption_placement = placement;
        self
    }

    /// The caption without the syntax of symbols, as plain text.
    #[must_use]
    pub fn plain_caption(&self) -> String {
        RichText::parse(&self.caption).plain()
    }

    /// Sets which panels share the limits of x.
    #[must_use]
    pub fn sharing_x(mut self, sharing: Sharing) -> Self {
        self.sharing_x = sharing;
        self
    }

    /// Sets which panels share the limits of y.
    #[must_use]
    pub fn sharing_y(mut self, sharing: Sharing) -> Self {
        self.sharing_y = sharing;
        self
    }

    /// Sets the legend for all panels.
    #[must_use]
    pub fn legend(mut self, legend: SharedLegend) -> Self {
        self.legend = legend;
        self
    }

    /// Sets the size of the figure.
    #[must_use]
    pub fn size(mut self, size: Size) -> Self {
        self.size = size;
        self
    }
}
