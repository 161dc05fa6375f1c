//! A sketch as SVG, PDF and PNG, and its collisions.

use super::draw;
use super::labels::place;
use super::sheet::{PIXELS_PER_MM, Sketch};
use crate::error::PlotError;
use crate::output;

impl Sketch {
    /// Height of the sheet (mm), which follows from the parts and the key.
    pub fn height_mm(&self) -> f64 {
        draw::height(self) * self.scale() / PIXELS_PER_MM
    }

    /// Texts that cover another text or a stroke, or that leave the sheet; each in words. A good layout has none.
    pub fn collisions(&self) -> Vec<String> {
        place(self).collisions
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
