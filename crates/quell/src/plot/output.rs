//! Figures as SVG text, PNG bytes and files.
//!
//! A file is written beside its place under a temporary name and renamed when it is whole, so that
//! nobody ever finds half a picture.

use std::fs::{self, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicU64, Ordering};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use super::error::PlotError;
use super::figure::Figure;
use super::{draw, fonts};

/// Pixels of a PNG to one unit of the picture (1/96 inch): 192 dots per inch.
const PIXELS_PER_UNIT: f64 = 2.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Svg,
    Png,
}

impl Kind {
    fn of(path: &Path) -> Result<Self, PlotError> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().into_owned());
        match extension.as_deref().map(str::to_ascii_lowercase).as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(PlotError::UnknownExtension { path: path.to_path_buf(), extension }),
        }
    }
}

impl Figure {
    /// The picture as SVG. Equal figures give equal text.
    #[must_use]
    pub fn to_svg(&self) -> String {
        draw::figure(self)
    }

    /// The picture as PNG, 192 dots per inch. Equal figures give equal bytes.
    ///
    /// # Errors
    /// [`PlotError::PixelSize`] when it is too large, [`PlotError::Raster`] when the rasteriser fails.
    pub fn to_png(&self) -> Result<Vec<u8>, PlotError> {
        png(&self.to_svg())
    }

    /// Writes the picture to a `.svg` or `.png` file, whole or not at all.
    ///
    /// # Errors
    /// [`PlotError::UnknownExtension`] before anything is drawn, [`PlotError::Write`] when the file
    /// system refuses, and those of [`Figure::to_png`].
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), PlotError> {
        let path = path.as_ref();
        let bytes = match Kind::of(path)? {
            Kind::Svg => self.to_svg().into_bytes(),
            Kind::Png => self.to_png()?,
        };
        write_whole(path, &bytes)
            .map_err(|source| PlotError::Write { path: path.to_path_buf(), source })
    }

    /// Says whether [`Figure::write`] knows what to do with this path, before any work is done.
    ///
    /// # Errors
    /// [`PlotError::UnknownExtension`] when the name ends neither in `.svg` nor in `.png`.
    pub fn check_path(path: impl AsRef<Path>) -> Result<(), PlotError> {
        Kind::of(path.as_ref()).map(|_| ())
    }
}

fn png(svg: &str) -> Result<Vec<u8>, PlotError> {
    let options = Options {
        font_family: fonts::BUNDLED_FAMILY.to_string(),
        fontdb: fonts::database(),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options)
        .map_err(|source| PlotError::Raster { source: Box::new(source) })?;
    let pixels = |units: f32| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates; the pixel map refuses what is too large"
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

fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let (temporary, mut file) = beside(path)?;
    let written = file.write_all(bytes).and_then(|()| file.sync_all());
    drop(file);
    let placed = written.and_then(|()| fs::rename(&temporary, path));
    if placed.is_err() {
        // The first error is the one to tell; a leftover is the lesser evil.
        let _ = fs::remove_file(&temporary);
    }
    placed
}

/// A new file in the same folder, with a name that nobody else uses.
fn beside(path: &Path) -> io::Result<(PathBuf, fs::File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let name = path.file_name().ok_or(io::ErrorKind::InvalidInput)?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}-{}.part", process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
    let temporary = path.with_file_name(hidden);
    let file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
    Ok((temporary, file))
}
