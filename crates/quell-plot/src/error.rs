//! Errors of rendering a figure.

use std::error::Error;
use std::fmt;

/// The reason why a figure could not be rendered.
#[derive(Debug)]
#[non_exhaustive]
pub enum PlotError {
    /// The figure is too large for a pixel image, or its size is zero.
    PixelSize {
        /// Requested width (pixels).
        width: u32,
        /// Requested height (pixels).
        height: u32,
    },
    /// The values do not form a rectangular grid.
    Field {
        /// The reason.
        why: String,
    },
    /// The figure could not be converted to a page of PDF.
    Page {
        /// Error of the converter.
        source: Box<dyn Error + Send + Sync>,
    },
    /// The figure could not be rasterised.
    Raster {
        /// Error of the rasteriser.
        source: Box<dyn Error + Send + Sync>,
    },
}

impl fmt::Display for PlotError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PixelSize { width, height } => {
                write!(out, "cannot create an image of {width} by {height} pixels")
            }
            Self::Field { why } => write!(out, "the values of a map do not form a grid: {why}"),
            Self::Page { source } => write!(out, "cannot convert the figure to PDF: {source}"),
            Self::Raster { source } => write!(out, "cannot rasterise the figure: {source}"),
        }
    }
}

impl Error for PlotError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Page { source } | Self::Raster { source } => Some(source.as_ref()),
            Self::PixelSize { .. } | Self::Field { .. } => None,
        }
    }
}
