//! Colours, widths and dashes of all roles.
//!
//! The colours are those of Okabe and Ito (2008), which remain distinct under the common kinds of
//! colour blindness; roles also differ in dashes or width, so that they can be distinguished in a
//! greyscale print.

/// A colour as red, green, blue.
pub(super) type Colour = (u8, u8, u8);

const BLACK: Colour = (0x00, 0x00, 0x00);
const BLUE: Colour = (0x00, 0x72, 0xB2);
const VERMILLION: Colour = (0xD5, 0x5E, 0x00);
const GREEN: Colour = (0x00, 0x9E, 0x73);
const PURPLE: Colour = (0xCC, 0x79, 0xA7);
const ORANGE: Colour = (0xE6, 0x9F, 0x00);
const SKY: Colour = (0x56, 0xB4, 0xE9);
const GREY: Colour = (0x80, 0x80, 0x80);

/// Colour of frames, ticks and text.
pub(super) const FRAME: Colour = (0x22, 0x22, 0x22);
/// Colour of the background.
pub(super) const PAPER: Colour = (0xFF, 0xFF, 0xFF);
/// Colour of footnotes.
pub(super) const FAINT: Colour = (0x55, 0x55, 0x55);
/// Background colour of hatched cells without a value, so that cells too small for a stroke remain visible.
pub(super) const GAP: Colour = (0xD6, 0xD6, 0xD6);
/// Edge colour of a legend box.
pub(super) const LEGEND_EDGE: Colour = (0xC8, 0xC8, 0xC8);

/// Colours of numbered series, in order (the yellow of the set is too pale for lines).
const SERIES: [Colour; 7] = [BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, BLACK];

/// What a curve, a set of points or a region represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PlotRole {
    /// The response with dither: solid blue.
    Dithered,
    /// The response without dither: dashed grey.
    Undithered,
    /// The prediction of averaging: dash-dotted vermillion, wider.
    Averaged,
    /// The result of exact numerics: solid black.
    Exact,
    /// Values printed in a publication: black.
    Printed,
    /// A boundary in a parameter plane: solid black.
    Boundary,
    /// A set of parameters where sliding is stable: blue.
    Stable,
    /// A set of parameters where sliding is unstable: vermillion.
    Unstable,
    /// A set of parameters whose stability could not be determined: grey.
    Undecided,
    /// A line that only guides the eye: thin dotted grey.
    Guide,
    /// Member number `n`, from 0, of a family of curves: seven colours and seven styles of dashes. Colours repeat after seven
    /// members, with other dashes.
    Series(usize),
}

/// Dash style of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum LineStyle {
    /// No gaps.
    Solid,
    /// Long dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// Dash, dot.
    DashDotted,
    /// Longer dashes with short gaps.
    LongDashed,
    /// Dash, dot, dot.
    DashDotDotted,
    /// Short dashes.
    ShortDashed,
}

/// Dashes of numbered series, in order: neighbours differ most.
const SERIES_STYLES: [LineStyle; 7] = [
    LineStyle::Solid,
    LineStyle::Dashed,
    LineStyle::Dotted,
    LineStyle::DashDotted,
    LineStyle::LongDashed,
    LineStyle::ShortDashed,
    LineStyle::DashDotDotted,
];

impl LineStyle {
    /// Dash lengths for a line of this width (pixels); `None` for a solid line.
    pub(super) fn dashes(self, width: f64) -> Option<String> {
        let scale = width.max(1.0);
        let lengths = self.pattern();
        let words: Vec<String> =
            lengths.iter().map(|length| format!("{:.1}", length * scale)).collect();
        (!words.is_empty()).then(|| words.join(" "))
    }

    /// Alternating lengths of dashes and gaps, in line widths; empty for a solid line.
    pub(super) fn pattern(self) -> &'static [f64] {
        match self {
            Self::Solid => &[],
            Self::Dashed => &[4.5, 2.8],
            Self::Dotted => &[1.2, 2.2],
            Self::DashDotted => &[5.5, 2.2, 1.2, 2.2],
            Self::LongDashed => &[10.0, 2.5],
            Self::DashDotDotted => &[5.5, 1.8, 1.2, 1.8, 1.2, 1.8],
            Self::ShortDashed => &[2.6, 1.6],
        }
    }
}

impl PlotRole {
    pub(super) fn colour(self) -> Colour {
        match self {
            Self::Dithered | Self::Stable => BLUE,
            Self::Averaged | Self::Unstable => VERMILLION,
            Self::Undithered | Self::Undecided | Self::Guide => GREY,
            Self::Exact | Self::Printed | Self::Boundary => BLACK,
            Self::Series(number) => SERIES[number % SERIES.len()],
        }
    }

    pub(super) fn style(self) -> LineStyle {
        match self {
            Self::Undithered => LineStyle::Dashed,
            Self::Guide => LineStyle::Dotted,
            Self::Averaged => LineStyle::DashDotted,
            // After one round the dashes move on by one, so that no two of 49 members look alike.
            Self::Series(number) => {
                SERIES_STYLES[(number + number / SERIES.len()) % SERIES_STYLES.len()]
            }
            _ => LineStyle::Solid,
        }
    }

    /// Line width (pixels).
    pub(super) fn width(self) -> f64 {
        match self {
            Self::Averaged => 1.8,
            Self::Guide => 0.9,
            Self::Undithered | Self::Boundary => 1.3,
            _ => 1.4,
        }
    }
}
