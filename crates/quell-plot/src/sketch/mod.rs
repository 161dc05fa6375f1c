//! Mechanical drawings: masses, springs, dampers, supports, moving surfaces, discs, arrows and the symbols next to them.
//!
//! A [`Sketch`] is data like a figure: parts with their shapes in pixels of 1/96 inch, labels that find a free position next
//! to their parts, and a key that gives the meaning and value of each symbol below the drawing. It knows no physics: the caller
//! decides what is drawn where.
//!
//! ```
//! use quell_plot::{LabelSide, Sketch, SketchKey, SketchPart, SketchShape};
//!
//! let spring = SketchShape::Spring { from: (20.0, 40.0), to: (80.0, 40.0) };
//! let sketch = Sketch::new(85.0)
//!     .with(SketchPart::new("spring", "spring of the wall", spring).label("$k$", &[LabelSide::Above]))
//!     .with_key(SketchKey::new("spring", ["$k$ = 4 N/m"]));
//! assert!(sketch.to_svg().contains("<title>spring of the wall</title>"));
//! assert!(sketch.collisions().is_empty());
//! ```

mod draw;
mod labels;
mod part;
mod shape;

pub use part::{LabelSide, SketchKey, SketchLabel, SketchPart};
pub use shape::{SketchInk, SketchShape, WaveGlyph};

use super::error::PlotError;
use super::output;

/// Pixels of 1/96 inch in a millimetre.
pub(super) const PIXELS_PER_MM: f64 = 96.0 / 25.4;
/// A sheet up to this width is drawn at scale 1; a wider one is magnified (mm).
const PLAIN_WIDTH: f64 = 85.0;
/// The largest magnification.
const MOST_SCALE: f64 = 1.35;

/// A mechanical drawing with a key of its symbols.
#[derive(Debug, Clone, PartialEq)]
pub struct Sketch {
    /// Title, for readers of the file; it is not drawn.
    pub title: String,
    /// Description in words, for readers who do not see the drawing.
    pub description: String,
    /// Width of the sheet (mm).
    pub width_mm: f64,
    /// The parts, drawn in this order.
    pub parts: Vec<SketchPart>,
    /// The meaning and values of the symbols, below the drawing.
    pub key: Vec<SketchKey>,
}

impl Sketch {
    /// An empty sheet of this width (mm).
    #[must_use]
    pub fn new(width_mm: f64) -> Self {
        let (title, description) = (String::new(), String::new());
        Self { title, description, width_mm, parts: Vec::new(), key: Vec::new() }
    }

    /// Adds a part.
    #[must_use]
    pub fn with(mut self, part: SketchPart) -> Self {
        self.parts.push(part);
        self
    }

    /// Adds a row of the key.
    #[must_use]
    pub fn with_key(mut self, entry: SketchKey) -> Self {
        self.key.push(entry);
        self
    }

    /// Magnification of the drawing and its texts on a wide sheet.
    pub fn scale(&self) -> f64 {
        (self.width_mm / PLAIN_WIDTH).sqrt().clamp(1.0, MOST_SCALE)
    }

    /// Width that shapes can use (pixels of 1/96 inch before magnification).
    pub fn room(&self) -> f64 {
        self.width_mm * PIXELS_PER_MM / self.scale()
    }

    /// Height of the sheet (mm), which follows from the parts and the key.
    pub fn height_mm(&self) -> f64 {
        draw::height(self) * self.scale() / PIXELS_PER_MM
    }

    /// Size of the smallest text that is not a subscript (points of 1/72 inch).
    pub fn text_size(&self) -> f64 {
        f64::from(draw::TEXT) * self.scale() * 0.75
    }

    /// Texts that cover another text or a stroke, or that leave the sheet; each in words. A good layout has none.
    pub fn collisions(&self) -> Vec<String> {
        labels::place(self).collisions
    }

    /// Renders the sketch as SVG. Equal sketches give equal text.
    #[must_use]
    pub fn to_svg(&self) -> String {
        draw::svg(self)
    }

    /// Renders the sketch as PNG, 192 dots per inch. Equal sketches give equal bytes.
    ///
    /// # Errors
    /// [`PlotError::PixelSize`] when the sketch is too large, [`PlotError::Raster`] when the rasteriser fails.
    pub fn to_png(&self) -> Result<Vec<u8>, PlotError> {
        output::png(&self.to_svg())
    }

    /// Renders the sketch as PDF. Equal sketches give equal bytes.
    ///
    /// # Errors
    /// [`PlotError::Page`] when the sketch cannot be converted.
    pub fn to_pdf(&self) -> Result<Vec<u8>, PlotError> {
        output::pdf(&self.to_svg())
    }
}
