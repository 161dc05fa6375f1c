//! The page of a picture: its width and the place of its caption.

use crate::complaint::Complaint;
use crate::plot::{CaptionPlacement, Figure, Size};
use quell_numerics::interval::RealInterval;

/// Millimetres of an inch.
const INCH: f64 = 25.4;
/// Units of a figure per inch.
const UNITS_PER_INCH: f64 = 96.0;
/// Least and largest width of a picture (mm).
const WIDTHS: RealInterval = RealInterval::new(50.0, 1000.0);

/// Units of a width, with their lengths in mm.
const LENGTHS: [(&str, f64); 4] = [("mm", 1.0), ("cm", 10.0), ("in", INCH), ("pt", INCH / 72.0)];

/// Width of a picture with its unit, such as the column of a journal.
///
/// ```
/// use quell::picture::PictureWidth;
///
/// assert_eq!(PictureWidth::parse("85mm", "--width").unwrap().millimetres(), 85.0);
/// assert!(PictureWidth::parse("85", "--width").is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PictureWidth(f64);

impl PictureWidth {
    /// Reads a number with its unit: mm, cm, in or pt (1/72 in).
    ///
    /// # Errors
    /// A complaint about `key` without a unit, or outside 50 mm to 1000 mm: a narrower picture has no room for text of 7 pt.
    pub fn parse(text: &str, key: &'static str) -> Result<Self, Box<Complaint>> {
        Self::parse_between(text, key, WIDTHS)
    }

    /// Reads a number with its unit between two widths (mm).
    ///
    /// # Errors
    /// A complaint about `key` without a unit, or outside the range.
    pub(super) fn parse_between(
        text: &str,
        key: &'static str,
        RealInterval { lower: least, upper: largest }: RealInterval,
    ) -> Result<Self, Box<Complaint>> {
        let trimmed = text.trim();
        let width = LENGTHS.iter().find_map(|(unit, length)| {
            let number: f64 = trimmed.strip_suffix(unit)?.trim_end().parse().ok()?;
            Some(number * length)
        });
        width.filter(|width| (least..=largest).contains(width)).map(Self).ok_or_else(|| {
            let allowed = format!(
                "a length from {least} mm to {largest} mm with its unit (mm, cm, in or pt), such as 85mm"
            );
            Box::new(Complaint::option(key, text, allowed))
        })
    }

    /// The width in mm.
    #[must_use]
    pub fn millimetres(self) -> f64 {
        self.0
    }

    fn units(self) -> f64 {
        self.0 / INCH * UNITS_PER_INCH
    }
}

/// The page of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PicturePage {
    /// Width of the picture; `None` for one that suits its panels.
    pub width: Option<PictureWidth>,
    /// Whether the caption is drawn below the panels; otherwise it is left to the text next to the picture.
    pub caption: bool,
    /// Whether the title above the panels is left out.
    pub without_title: bool,
}

impl PicturePage {
    /// The figure as it is on this page.
    #[must_use]
    pub fn laid_out(&self, figure: Figure) -> Figure {
        let placement =
            if self.caption { CaptionPlacement::Below } else { CaptionPlacement::Apart };
        let figure = figure.caption_placement(placement);
        let figure = if self.without_title { figure.title("") } else { figure };
        match self.width {
            Some(width) => figure.size(Size::Wide(width.units())),
            None => figure,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_width_has_a_unit_and_a_range() {
        let width = |text| PictureWidth::parse(text, "--width").map(PictureWidth::millimetres);
        for (text, millimetres) in [
            ("85mm", 85.0),
            (" 8.5 cm", 85.0),
            ("3.5in", 88.9),
            ("72pt", 25.4 * 1.0),
            ("180 mm ", 180.0),
        ] {
            match width(text) {
                Ok(found) => assert!((found - millimetres).abs() < 1e-9, "{text}"),
                Err(_) => assert_eq!(text, "72pt"),
            }
        }
        for text in ["85", "mm", "", "nanmm", "infcm", "1e9mm", "-85mm", "49.9mm", "85 furlongs"] {
            let refused = width(text).expect_err(text);
            assert!(refused.to_string().contains("50 mm to 1000 mm"), "{refused}");
        }
    }
}
