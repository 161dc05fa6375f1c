//! Figures as SVG text, PDF and PNG bytes; `quell::picture::write` writes them to files.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, Options, Tree};
use svg2pdf::{ConversionOptions, PageOptions};

use super::error::PlotError;
use super::figure::Figure;
use super::{draw, fonts};

/// Pixels of a PNG per unit of the figure (1/96 inch): 192 dots per inch.
const PIXELS_PER_UNIT: f64 = 2.0;

impl Figure {
    /// Renders the figure as SVG. Equal figures give equal text.
    #[must_use]
    pub fn to_svg(&self) -> String {
        draw::figure(self)
    }

    /// Renders the figure as PNG, 192 dots per inch. Equal figures give equal bytes.
    ///
    /// # Errors
    /// [`PlotError::PixelSize`] when the figure is too large, [`PlotError::Raster`] when the rasteriser fails.
    pub fn to_png(&self) -> Result<Vec<u8>, PlotError> {
        png(&self.to_svg())
    }

    /// Renders the figure as PDF: one page of the figure's size, with curves and text as vectors and its fonts embedded. Equal
    /// figures give equal pages; the order of the objects in the file may differ.
    ///
    /// # Errors
    /// [`PlotError::Page`] when the figure cannot be converted.
    pub fn to_pdf(&self) -> Result<Vec<u8>, PlotError> {
        pdf(&self.to_svg())
    }
}

/// Dots per inch of a figure's unit, the pixel of CSS.
const UNITS_PER_INCH: f32 = 96.0;

fn tree(svg: &str) -> Result<Tree, usvg::Error> {
    let options = Options {
        font_family: fonts::BUNDLED_FAMILY.to_string(),
        fontdb: fonts::database(),
        ..Options::default()
    };
    Tree::from_str(svg, &options)
}

pub(super) fn pdf(svg: &str) -> Result<Vec<u8>, PlotError> {
    let tree = tree(svg).map_err(|source| PlotError::Page { source: Box::new(source) })?;
    let page = PageOptions { dpi: UNITS_PER_INCH };
    svg2pdf::to_pdf(&tree, ConversionOptions::default(), page)
        .map_err(|error| PlotError::Page { source: error.to_string().into() })
}

pub(super) fn png(svg: &str) -> Result<Vec<u8>, PlotError> {
    let tree = tree(svg).map_err(|source| PlotError::Raster { source: Box::new(source) })?;
    let pixels = |units: f32| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates; the pixel map rejects sizes that are too large"
        )]
        let pixels = (f64::from(units) * PIXELS_PER_UNIT).round() as u32;
        pixels
    };
    let (width, height) = (pixels(tree.size().width()), pixels(tree.size().height()));
    let mut pixmap = Pixmap::new(width, height).ok_or(PlotError::PixelSize { width, height })?;
    #[expect(clippy::cast_possible_truncation, reason = "a small constant")]
    let scale = PIXELS_PER_UNIT as f32;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    pixmap.encode_png().map_err(|source| PlotError::Raster { source: Box::new(source) })
}
