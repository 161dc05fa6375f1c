//! Letter styles as `<tspan>` elements.
//!
//! kuva supports one style per text, so each run is wrapped in private-use characters before it is passed to kuva
//! ([`Pen`]), and these are replaced by elements in kuva's output ([`Tags::resolve`]).

use std::fmt::Write as _;

use super::fonts::{self, Face};
use super::letter_style::{LetterStyle, ScriptLevel};

const FIRST_TAG: u32 = 0xE000;
const LAST_TAG: u32 = 0xF000;
const CLOSE: char = '\u{F8FF}';
/// The bar over a letter: a macron moved back over it.
pub(super) const BAR: &str = "¯";
/// Baseline shift of the bar over a tall letter (em of the text).
const BAR_OVER_TALL: f64 = -0.16;
/// Shift of italic letters to the right at the height of the bar (em).
const LEAN: f64 = 0.06;

/// The opening tag that each private-use character represents in one figure.
#[derive(Debug, Default)]
pub(super) struct Tags {
    opening: Vec<String>,
}

/// Writes runs one after another and tracks the current baseline and horizontal offset.
pub(super) struct Pen<'a> {
    tags: &'a mut Tags,
    text: String,
    /// Current depth of the baseline (em of the text).
    depth: f64,
    /// Horizontal shift before the next run (em of the text).
    aside: f64,
}

impl<'a> Pen<'a> {
    /// An empty text.
    pub(super) fn new(tags: &'a mut Tags) -> Self {
        Self { tags, text: String::new(), depth: 0.0, aside: 0.0 }
    }

    /// The encoded text.
    pub(super) fn into_text(self) -> String {
        self.text
    }

    /// Writes letters of one style at this depth below the baseline (em of the text).
    pub(super) fn put(&mut self, printed: &str, look: LetterStyle, depth: f64) {
        let (down, aside) = (depth - self.depth, std::mem::take(&mut self.aside));
        self.depth = depth;
        if look == LetterStyle::default() && down == 0.0 && aside == 0.0 {
            self.text.push_str(printed);
        } else {
            self.text.push(self.tags.open(look, down, aside));
            self.text.push_str(printed);
            self.text.push(CLOSE);
        }
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

impl Tags {
    /// The private-use character for a style whose run is shifted down and to the right of the last run (em of the text).
    fn open(&mut self, look: LetterStyle, down: f64, aside: f64) -> char {
        let mut tag = String::from("<tspan");
        if look.italic {
            tag.push_str(" font-style=\"italic\"");
        }
        let share = look.level.share();
        if look.level != ScriptLevel::Base {
            let _ = write!(tag, " font-size=\"{:.0}%\"", 100.0 * share);
        }
        if aside != 0.0 {
            let _ = write!(tag, " dx=\"{:.3}em\"", aside / share);
        }
        if down != 0.0 {
            let _ = write!(tag, " dy=\"{:.3}em\"", down / share);
        }
        tag.push('>');
        let index = self.opening.iter().position(|known| *known == tag).unwrap_or_else(|| {
            self.opening.push(tag);
            self.opening.len() - 1
        });
        // At most a few dozen different styles occur.
        u32::try_from(index)
            .ok()
            .and_then(|index| char::from_u32(FIRST_TAG + index))
            .unwrap_or(CLOSE)
    }

    /// Replaces the private-use characters by their elements.
    pub(super) fn resolve(&self, svg: &str) -> String {
        let mut resolved = String::with_capacity(svg.len() + 1024);
        for letter in svg.chars() {
            match u32::from(letter) {
                code @ FIRST_TAG..=LAST_TAG => {
                    if let Some(tag) = self.opening.get((code - FIRST_TAG) as usize) {
                        resolved.push_str(tag);
                    }
                }
                _ if letter == CLOSE => resolved.push_str("</tspan>"),
                _ => resolved.push(letter),
            }
        }
        resolved
    }
}
