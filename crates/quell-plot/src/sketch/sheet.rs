//! The sheet of a sketch: its parts, its key and its size.

use super::part::{SketchKey, SketchPart};

/// Size of all texts (pixels); 7.5 points at scale 1.
pub(super) const TEXT: u32 = 10;
/// Distance of the drawing from the upper edge.
pub(super) const MARGIN: f64 = 6.0;
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

    /// Size of the smallest text that is not a subscript (points of 1/72 inch).
    pub fn text_size(&self) -> f64 {
        f64::from(TEXT) * self.scale() * 0.75
    }
}
