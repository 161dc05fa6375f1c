//! The grid of a figure: how many columns it has, how large its frames are, and the font sizes that suit them.

use super::axis_limits::shape_of_equal_scales;
use super::figure::{Figure, Size};
use super::font_sizes::FontSizes;
use super::geometry::FrameSize;

/// Least width and height of a frame (pixels).
const LEAST_FRAME: f64 = 60.0;
/// Largest width and height of a frame (pixels).
const LARGEST_FRAME: f64 = 2e4;
/// Width from which a frame is comfortable to read (pixels, 34 mm).
const COMFORTABLE: f64 = 130.0;
/// Least height of a frame in a figure of a given width (pixels, 30 mm): labels of the upright axis need it.
const LOWEST: f64 = 115.0;
/// Height of a page of a journal (pixels, 230 mm).
const PAGE: f64 = 870.0;

/// Space that a figure needs around its frames, across and upright (pixels), for a number of columns, a frame and its sizes.
pub(super) type FrameSurroundings = fn(&Figure, usize, FrameSize, FontSizes) -> FrameSize;

/// Columns, frames and font sizes of a figure.
#[derive(Debug, Clone, Copy)]
pub(super) struct FrameGrid {
    pub(super) columns: usize,
    /// Width and height of every frame (pixels).
    pub(super) frame: FrameSize,
    pub(super) sizes: FontSizes,
}

/// The number of columns that a figure is intended to have.
pub(super) fn columns_of(figure: &Figure) -> usize {
    figure.columns.max(1).min(figure.panels.len().max(1))
}

impl FrameGrid {
    pub(super) fn of(figure: &Figure, around: FrameSurroundings) -> Self {
        let columns = columns_of(figure);
        let usual = usual_frame(columns);
        let of_frame =
            |frame: FrameSize| Self { columns, frame, sizes: FontSizes::for_frame(frame.width) };
        match figure.size {
            Size::Auto => of_frame(usual),
            Size::Frame(width, height) => of_frame(FrameSize::new(
                sensible(width, usual.width),
                sensible(height, usual.height),
            )),
            Size::Whole(width, height) => {
                Self::whole(figure, columns, FrameSize::new(width, height), around)
            }
            Size::Wide(width) => Self::wide(figure, columns, width, around),
        }
    }

    /// A grid that fills a figure of this width and height.
    fn whole(
        figure: &Figure,
        columns: usize,
        FrameSize { width, height }: FrameSize,
        around: FrameSurroundings,
    ) -> Self {
        let rows = figure.panels.len().div_ceil(columns).max(1) as f64;
        let usual = usual_frame(columns);
        let mut frame = FrameSize::new(
            sensible(0.85 * width / columns as f64, usual.width),
            sensible(0.8 * height / rows, usual.height),
        );
        let sizes = FontSizes::for_frame(frame.width);
        // Margins depend on the tick labels and these on the frame size: three iterations converge.
        for _ in 0..3 {
            let FrameSize { width: across, height: upright } =
                around(figure, columns, frame, sizes);
            frame = FrameSize::new(
                sensible((width - across) / columns as f64, usual.width),
                sensible((height - upright) / rows, usual.height),
            );
        }
        Self { columns, frame, sizes }
    }

    /// The grid with most columns whose frames are comfortable; if it does not fit on a page, the one with the fewest columns
    /// that does, or else the lowest one.
    fn wide(figure: &Figure, columns: usize, width: f64, around: FrameSurroundings) -> Self {
        let candidates: Vec<(Self, f64)> = (1..=columns)
            .map(|columns| Self::of_width(figure, columns, width, around))
            .filter(|(grid, _)| grid.columns == 1 || grid.frame.width > LEAST_FRAME)
            .collect();
        let comfortable = candidates.iter().rposition(|(grid, _)| grid.frame.width >= COMFORTABLE);
        let first = comfortable.unwrap_or(0);
        let fitting = candidates[first..].iter().find(|(_, height)| *height <= PAGE);
        let lowest = || candidates.iter().min_by(|one, other| one.1.total_cmp(&other.1));
        fitting
            .or_else(lowest)
            .map_or(Self::of_width(figure, 1, width, around).0, |(grid, _)| *grid)
    }

    /// A grid of a figure of this width, and the height of the figure.
    fn of_width(
        figure: &Figure,
        columns: usize,
        width: f64,
        around: FrameSurroundings,
    ) -> (Self, f64) {
        let usual = usual_frame(columns);
        let equal = shape_of_equal_scales(figure, columns_of(figure));
        let shape = equal.unwrap_or(usual.height / usual.width);
        let least = if equal.is_some() { LEAST_FRAME } else { LOWEST };
        let mut frame =
            FrameSize::new(sensible(0.85 * width / columns as f64, usual.width), usual.height);
        let sizes = FontSizes::for_frame(frame.width);
        let mut height = 0.0;
        for _ in 0..3 {
            let FrameSize { width: across, height: upright } =
                around(figure, columns, frame, sizes);
            frame.width = sensible((width - across) / columns as f64, usual.width);
            frame.height = sensible((frame.width * shape).max(least), usual.height);
            height = upright;
        }
        let rows = figure.panels.len().div_ceil(columns).max(1);
        (Self { columns, frame, sizes }, height + frame.height * rows as f64)
    }
}

/// Width and height of a frame that suits this number of columns (pixels).
fn usual_frame(columns: usize) -> FrameSize {
    match columns {
        1 => FrameSize::new(440.0, 280.0),
        2 => FrameSize::new(300.0, 205.0),
        _ => FrameSize::new(225.0, 160.0),
    }
}

fn sensible(pixels: f64, usual: f64) -> f64 {
    if pixels.is_finite() { pixels.clamp(LEAST_FRAME, LARGEST_FRAME) } else { usual }
}
