//! Looks of letters as `<tspan>` elements.
//!
//! kuva prints one style per text, so each run is wrapped into private-use characters on the way in ([`Pen`]),
//! and these become elements on the way out ([`Tags::resolve`]).

use std::fmt::Write as _;

use super::fonts::{self, Face};
use super::letter_style::{LetterStyle, ScriptLevel};

const FIRST_TAG: u32 = 0xE000;
const LAST_TAG: u32 = 0xF000;
const CLOSE: char = '\u{F8FF}';
/// The bar over a letter: a macron moved back over it, higher over a tall letter (em of the text).
pub(super) const BAR: &str = "¯";
const BAR_OVER_TALL: f64 = -0.16;
/// Letters in italics lean to the right by this at the height of the bar (em).
const LEAN: f64 = 0.06;

/// What each private-use character stands for in one picture.
#[derive(Debug, Default)]
pub(super) struct Tags {
    opening: Vec<String>,
}

/// Writes runs one after the other and knows where the last one left off.
pub(super) struct Pen<'a> {
    tags: &'a mut Tags,
    text: String,
    /// Depth of the base line now (em of the text).
    depth: f64,
    /// Way to go before the next run (em of the text).
    aside: f64,
}

impl<'a> Pen<'a> {
    /// Nothing written yet.
    pub(super) fn new(tags: &'a mut Tags) -> Self {
        Self { tags, text: String::new(), depth: 0.0, aside: 0.0 }
    }

    /// What was written.
    pub(super) fn into_text(self) -> String {
        self.text
    }

    /// Writes letters of one look at this depth below the base line (em of the text).
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
    /// The character for a look that starts so far below and right of the last run (em of the text).
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
        // There are no more than a few dozen different looks.
        u32::try_from(index)
            .ok()
            .and_then(|index| char::from_u32(FIRST_TAG + index))
            .unwrap_or(CLOSE)
    }

    /// Puts the elements in place of the private-use characters.
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
