//! Letter styles as `<tspan>` elements.

use std::fmt::Write as _;

use super::fonts::{self, Face};
use super::letter_style::{LetterStyle, ScriptLevel};
use super::svg::Escaped;

/// The bar over a letter: a macron moved back over it.
pub(super) const BAR: &str = "¯";
/// Baseline shift of the bar over a tall letter (em of the text).
const BAR_OVER_TALL: f64 = -0.16;
/// Shift of italic letters to the right at the height of the bar (em).
const LEAN: f64 = 0.06;

/// Writes runs one after another and tracks the current baseline and horizontal offset.
#[derive(Debug, Default)]
pub(super) struct Pen {
    text: String,
    /// Current depth of the baseline (em of the text).
    depth: f64,
    /// Horizontal shift before the next run (em of the text).
    aside: f64,
}

impl Pen {
    /// The text as contents of a `<text>` element.
    pub(super) fn into_text(self) -> String {
        self.text
    }

    /// Writes letters of one style at this depth below the baseline (em of the text).
    pub(super) fn put(&mut self, printed: &str, look: LetterStyle, depth: f64) {
        let (down, aside) = (depth - self.depth, std::mem::take(&mut self.aside));
        self.depth = depth;
        let is_plain = look == LetterStyle::default() && down == 0.0 && aside == 0.0;
        if !is_plain {
            self.open(look, down, aside);
        }
        let _ = write!(self.text, "{}", Escaped(printed));
        if !is_plain {
            self.text.push_str("</tspan>");
        }
    }

    /// Opens an element for a style whose run is shifted down and to the right of the last run (em of the text).
    fn open(&mut self, look: LetterStyle, down: f64, aside: f64) {
        self.text.push_str("<tspan");
        if look.italic {
            self.text.push_str(" font-style=\"italic\"");
        }
        let share = look.level.share();
        if look.level != ScriptLevel::Base {
            let _ = write!(self.text, " font-size=\"{:.0}%\"", 100.0 * share);
        }
        if aside != 0.0 {
            let _ = write!(self.text, " dx=\"{:.3}em\"", aside / share);
        }
        if down != 0.0 {
            let _ = write!(self.text, " dy=\"{:.3}em\"", down / share);
        }
        self.text.push('>');
    }

    /// Writes a letter with a bar over it.
    pub(super) fn put_barred(&mut self, letter: char, look: LetterStyle) {
        let letter_text = letter.to_string();
        let face = if look.italic { Face::Oblique } else { Face::Regular };
        let lean = if look.italic { LEAN } else { 0.0 };
        let (own, bar) = (fonts::width(&letter_text, face), fonts::width(BAR, Face::Regular));
        self.put(&letter_text, look, 0.0);
        let tall = letter.is_uppercase() || "bdfhkltβδζθλξφψ".contains(letter);
        self.aside = lean - 0.5 * (own + bar);
        self.put(BAR, LetterStyle::default(), if tall { BAR_OVER_TALL } else { 0.0 });
        self.aside = 0.5 * (own - bar) - lean;
    }
}
