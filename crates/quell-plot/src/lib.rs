//! Plotting: every figure of Quell is made by this crate.
//!
//! A [`Figure`] is a grid of [`Panel`]s; a panel has two [`PlotAxis`] and layers, which are independent of the
//! drawing library: [`Polyline`], [`Points`], [`Region`], [`ReferenceLine`], [`Note`], and
//! for maps [`Heatmap`] (a field as colours) and [`Contours`] (its isolines).
//! What a curve *represents* is its [`PlotRole`]; the role sets colour, width and dashes, so that
//! "dithered" looks the same in every figure of the project.
//!
//! ```
//! use quell_plot::{PlotAxis, Figure, Polyline, Panel, PlotPoint, PlotRole};
//!
//! let times: Vec<f64> = (0..500).map(|step| 0.1 * f64::from(step)).collect();
//! let free = times.iter().map(|&time| PlotPoint::new(time, time.sin()));
//! let dithered = times.iter().map(|&time| PlotPoint::new(time, (-0.1 * time).exp() * time.sin()));
//! let panel = Panel::new(PlotAxis::new("time").symbol("τ"), PlotAxis::new("displacement").symbol("x"))
//!     .title("(a) $D$ = 0.3")
//!     .with(Polyline::new(PlotRole::Undithered, free).label("undithered"))
//!     .with(Polyline::new(PlotRole::Dithered, dithered).label("dithered"));
//! let svg = Figure::single(panel).to_svg();
//! assert!(svg.starts_with("<svg"));
//! ```
//!
//! Labels are plain text with `$…$` for symbols; the module `typeset` documents the syntax between the dollars.
//!
//! The crate lays out the figure and writes the SVG itself; resvg converts it to PNG and svg2pdf to PDF, with
//! the bundled DejaVu fonts.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod arrange;
mod axis;
mod axis_limits;
mod canvas;
mod colour_bar;
mod colouring;
mod describe;
mod draw;
mod envelope;
mod error;
mod field;
mod figure;
mod font_sizes;
mod fonts;
mod geometry;
mod grid;
mod isoline;
mod layer;
mod layout;
mod legend;
mod letter_style;
mod line_labels;
mod map_layers;
mod maps;
mod marks;
mod obstacles;
mod output;
mod palette;
mod projection;
mod raster;
mod reference_line_labels;
mod shades;
mod sketch;
mod svg;
mod thin;
mod ticks;
mod tspan;
mod typeset;
mod visibility;

pub use axis::{AxisRange, PlotAxis, Scale};
pub use colouring::{Colouring, Shading, Spread, Tint};
pub use error::PlotError;
pub use field::Field;
pub use figure::{
    CaptionPlacement, Figure, Legend, LegendPosition, Panel, SharedLegend, Sharing, Size,
};
pub use geometry::{FrameSize, PlotPoint, PlotRange};
pub use isoline::{Isoline, isolines};
pub use layer::{
    Fill, Layer, Marker, Note, Orientation, Points, Polyline, ReferenceLine, Region, RegionShape,
};
pub use map_layers::{Contours, Gap, Heatmap};
pub use palette::{LineStyle, PlotRole};
pub use shades::Palette;
pub use sketch::{
    LabelSide, Sketch, SketchInk, SketchKey, SketchLabel, SketchPart, SketchShape, WaveGlyph,
};

/// Converts a label to HTML, with the same italics, subscripts, superscripts and bars as in a figure.
///
/// ```
/// assert_eq!(quell_plot::html("$v_m$ < 1"), "<i>v</i><sub>m</sub> &lt; 1");
/// ```
pub fn html(label: &str) -> String {
    typeset::RichText::parse(label).html()
}
