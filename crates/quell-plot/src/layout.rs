//! Layout of a figure: positions of its frames, margins and texts, with their contents.

use super::axis::Mapping;
use super::canvas::Rectangle;
use super::colour_bar::ColourBar;
use super::figure::Panel;
use super::font_sizes::FontSizes;
use super::geometry::PlotRange;
use super::legend::LegendEntry;
use super::ticks::Ticks;
use super::typeset::RichText;

/// Space between a tick label and its frame (pixels).
pub(super) const NUMBER_GAP: f64 = 6.0;
/// Space between the tick labels and the axis label (pixels).
pub(super) const LABEL_GAP: f64 = 7.0;

/// Placement of the legend of one panel.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LegendLayout {
    None,
    Box(Rectangle),
    Above,
}

/// Layout of one panel.
#[derive(Debug, Clone)]
pub(super) struct PanelLayout {
    pub(super) frame: Rectangle,
    pub(super) x_limits: PlotRange,
    pub(super) y_limits: PlotRange,
    pub(super) x_ticks: Ticks,
    pub(super) y_ticks: Ticks,
    pub(super) x_numbers: bool,
    pub(super) y_numbers: bool,
    pub(super) x_label: Vec<RichText>,
    pub(super) y_label: Vec<RichText>,
    pub(super) title: Vec<RichText>,
    /// Distance from the frame to the nearest baseline of the y label.
    pub(super) y_label_distance: f64,
    pub(super) entries: Vec<LegendEntry>,
    pub(super) legend: LegendLayout,
    /// Left and right end of a legend above the frame, as distances from the frame: it may extend over the margins.
    pub(super) legend_overhang: (f64, f64),
    pub(super) bar: Option<ColourBar>,
}

impl PanelLayout {
    /// Left end and width of a legend above the frame.
    pub(super) fn legend_span(&self) -> (f64, f64) {
        let (left, right) = self.legend_overhang;
        (self.frame.left - left, self.frame.width() + left + right)
    }

    /// The mappings of both axes of a panel.
    pub(super) fn mappings(&self, panel: &Panel) -> (Mapping, Mapping) {
        let frame = self.frame;
        (
            Mapping::new(&panel.x, self.x_limits, frame.left, frame.right),
            Mapping::new(&panel.y, self.y_limits, frame.bottom, frame.top),
        )
    }
}

/// Layout of a figure.
#[derive(Debug)]
pub(super) struct FigureLayout {
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) sizes: FontSizes,
    pub(super) panels: Vec<PanelLayout>,
    pub(super) title: Vec<RichText>,
    pub(super) caption: Vec<RichText>,
    /// Top of the caption.
    pub(super) caption_top: f64,
    pub(super) shared: Vec<LegendEntry>,
    /// Top of the shared legend.
    pub(super) shared_top: f64,
    /// Left and right of all frames.
    pub(super) body: PlotRange,
}
