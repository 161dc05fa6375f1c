//! The style of letters: italics, a bar above, and the level of subscripts and superscripts.

/// Size of a subscript or superscript, as a share of the text's.
const SMALL: f64 = 0.72;
/// How far they are lowered (em of the text, downwards).
const LOWERED: f64 = 0.20;
/// How far they are raised (em of the text, downwards).
const RAISED: f64 = -0.36;
/// Size of a subscript within a superscript, and how far it is raised.
const SMALLER: f64 = 0.55;
const RAISED_LESS: f64 = -0.24;
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum ScriptLevel {
    #[default]
    Base,
    Lowered,
    Raised,
    RaisedLowered,
}

impl ScriptLevel {
    /// Size as a share of the text's.
    pub(super) fn share(self) -> f64 {
        match self {
            Self::Base => 1.0,
            Self::Lowered | Self::Raised => SMALL,
            Self::RaisedLowered => SMALLER,
        }
    }

    /// Distance below the base line (em of the text).
    pub(super) fn depth(self) -> f64 {
        match self {
            Self::Base => 0.0,
            Self::Lowered => LOWERED,
            Self::Raised => RAISED,
            Self::RaisedLowered => RAISED_LESS,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct LetterStyle {
    pub(super) italic: bool,
    pub(super) barred: bool,
    pub(super) level: ScriptLevel,
}
