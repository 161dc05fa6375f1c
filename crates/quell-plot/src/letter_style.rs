//! The style of letters: italics, a bar above, and the level of subscripts and superscripts.

/// Size of a subscript or superscript, as a fraction of the text size: 6 pt in the smallest text of a figure, 7.5 pt.
const SMALL: f64 = 0.8;
/// Baseline shift of a subscript (em of the text, downwards).
const LOWERED: f64 = 0.20;
/// Baseline shift of a superscript (em of the text, downwards).
const RAISED: f64 = -0.36;
/// Size of a subscript within a superscript, as a fraction of the text size.
const SMALLER: f64 = 0.55;
/// Baseline shift of a subscript within a superscript (em of the text, downwards).
const RAISED_LESS: f64 = -0.24;

/// Position of letters relative to the baseline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum ScriptLevel {
    #[default]
    Base,
    Lowered,
    Raised,
    RaisedLowered,
}

impl ScriptLevel {
    /// Size as a fraction of the text size.
    pub(super) fn share(self) -> f64 {
        match self {
            Self::Base => 1.0,
            Self::Lowered | Self::Raised => SMALL,
            Self::RaisedLowered => SMALLER,
        }
    }

    /// Distance below the baseline (em of the text).
    pub(super) fn depth(self) -> f64 {
        match self {
            Self::Base => 0.0,
            Self::Lowered => LOWERED,
            Self::Raised => RAISED,
            Self::RaisedLowered => RAISED_LESS,
        }
    }
}

/// Style of one letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct LetterStyle {
    pub(super) italic: bool,
    pub(super) barred: bool,
    pub(super) level: ScriptLevel,
}
