//! What can go wrong on the way from a figure to a picture.

use std::error::Error;
use std::fmt;

/// Why a picture could not be made.
#[derive(Debug)]
#[non_exhaustive]
pub enum PlotError {
    /// The picture is too large, or of no size, for a pixel image.
    PixelSize {
        /// Width asked for (pixels).
        width: u32,
        /// Height asked for (pixels).
        height: u32,
    },
    /// Values do not lie on a rectangular grid.
    Field {
        /// What is wrong with them.
        why: String,
    },
    /// The drawn scene could not be turned into pixels.
    Raster {
        /// What the rasteriser said.
        source: Box<dyn Error + Send + Sync>,
    },
}

impl fmt::Display for PlotError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PixelSize { width, height } => {
                write!(out, "a picture of {width} by {height} pixels cannot be made")
            }
            Self::Field { why } => write!(out, "the values of a map lie on no grid: {why}"),
            Self::Raster { source } => write!(out, "cannot turn the picture into pixels: {source}"),
        }
    }
}

impl Error for PlotError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Raster { source } => Some(source.as_ref()),
            Self::PixelSize { .. } | Self::Field { .. } => None,
        }
    }
}
