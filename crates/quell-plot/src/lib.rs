//! Pictures: the one door through which every figure of Quell is made.
//!
//! A [`Figure`] is a grid of [`Panel`]s; a panel has two [`Axis`] and layers, which speak of the
//! field and never of the drawing library: [`Line`], [`Points`], [`Region`], [`Rule`], [`Note`], and
//! for maps [`Grid`] (a field as colours) and [`Contours`] (its isolines).
//! What a curve *means* is its [`Role`]; the role decides colour, width and dashes, so that
//! "dithered" looks the same in every picture of the project.
//!
//! ```
//! use quell_plot::{Axis, Figure, Line, Panel, Role};
//!
//! let times: Vec<f64> = (0..500).map(|step| 0.1 * f64::from(step)).collect();
//! let free = times.iter().map(|&time| (time, time.sin()));
//! let dithered = times.iter().map(|&time| (time, (-0.1 * time).exp() * time.sin()));
//! let panel = Panel::new(Axis::new("time").symbol("τ"), Axis::new("displacement").symbol("x"))
//!     .title("(a) $D$ = 0.3")
//!     .with(Line::new(Role::Undithered, free).label("undithered"))
//!     .with(Line::new(Role::Dithered, dithered).label("dithered"));
//! let svg = Figure::single(panel).to_svg();
//! assert!(svg.starts_with("<svg"));
//! ```
//!
//! Labels are plain text with `$…$` for symbols; `typeset` says what may stand between the dollars.
//!
//! Scenes are drawn by kuva (primitives, escaping, SVG, bundled DejaVu fonts) and turned into PNG
//! by resvg. Axes, panel grids, legends and clipping are arranged here, because kuva's own figure
//! knows no subscripts, no polygons, no broken curves, and clips nothing at the axes.

mod arrange;
mod axis;
mod bar;
mod canvas;
mod colouring;
mod describe;
mod draw;
mod error;
mod field;
mod figure;
mod fonts;
mod isoline;
mod layer;
mod legend;
mod line_labels;
mod map_layers;
mod maps;
mod marks;
mod obstacles;
mod output;
mod palette;
mod raster;
mod rules;
mod shades;
mod stretches;
mod thin;
mod ticks;
mod tspan;
mod typeset;

pub use axis::{Axis, Range, Scale};
pub use colouring::{Colouring, Shading, Spread, Tint};
pub use error::PlotError;
pub use field::Field;
pub use figure::{Figure, Legend, Panel, Place, SharedLegend, Sharing, Size};
pub use isoline::{Isoline, isolines};
pub use layer::{Direction, Fill, Layer, Line, Marker, Note, Points, Region, Rule, Shape};
pub use map_layers::{Contours, Gap, Grid};
pub use palette::{LineStyle, Role};
pub use shades::Palette;

/// A label as HTML: what prints in italics, lowered, raised or barred in a picture does so on a page.
///
/// ```
/// assert_eq!(quell_plot::html("$v_m$ < 1"), "<i>v</i><sub>m</sub> &lt; 1");
/// ```
pub fn html(label: &str) -> String {
    typeset::Label::parse(label).html()
}
