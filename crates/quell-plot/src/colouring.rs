//! Colouring: the mapping of values to colours in a heatmap.

use super::axis::{PlotAxis, Scale};
use super::geometry::PlotRange;
use super::palette::{Colour, PlotRole};
use super::shades::{Palette, outcome_opacity, tint};

/// Normalisation of numbers to a palette.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Spread {
    /// Linear.
    #[default]
    Linear,
    /// Logarithmic; values that are not positive have the lowest colour.
    Log,
    /// Linear up to this magnitude and logarithmic beyond it, on both sides of zero: asinh. A magnitude
    /// that is not positive is replaced by a millionth of the range.
    SignedLog(f64),
}

/// A flat colour for one of several outcomes, or for values below a scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Tint {
    /// What it represents.
    pub role: PlotRole,
    /// Text in the legend.
    pub label: String,
}

impl Tint {
    /// A tint of this role.
    #[must_use]
    pub fn new(role: PlotRole, label: impl Into<String>) -> Self {
        Self { role, label: label.into() }
    }

    /// Text in the legend.
    pub(super) fn label(&self) -> &str {
        &self.label
    }

    pub(super) fn colour(&self) -> Colour {
        tint(self.role.colour(), TINT)
    }

    /// The colour as outcome with this number, which differs from its neighbours in grey.
    pub(super) fn outcome_colour(&self, number: usize) -> Colour {
        let colour = self.role.colour();
        tint(colour, outcome_opacity(colour, number))
    }
}

/// Opacity of the tint of values below a scale, low enough to keep black lines and numbers readable.
const TINT: f64 = 0.34;

/// Colours of numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shading {
    /// The palette.
    pub palette: Palette,
    /// Normalisation of numbers to the palette.
    pub spread: Spread,
    /// Numbers at the ends of the palette; `None` for the extremes of the values. A diverging
    /// palette is always symmetric about zero.
    pub range: Option<PlotRange>,
    /// Another colour for numbers below this one.
    pub below: Option<(f64, Tint)>,
    /// Words in the legend for negative and for positive numbers of a palette whose middle is zero.
    pub signs: Option<Box<(String, String)>>,
}

impl Shading {
    /// A palette with a linear normalisation over all values.
    #[must_use]
    pub fn new(palette: Palette) -> Self {
        Self { palette, ..Self::default() }
    }

    /// Sets the normalisation.
    #[must_use]
    pub fn spread(mut self, spread: Spread) -> Self {
        self.spread = spread;
        self
    }

    /// Sets the numbers at the ends of the palette.
    #[must_use]
    pub fn range(mut self, lower: f64, upper: f64) -> Self {
        self.range = Some(PlotRange::new(lower, upper));
        self
    }

    /// Sets the words in the legend for negative and for positive numbers.
    #[must_use]
    pub fn signs(mut self, negative: impl Into<String>, positive: impl Into<String>) -> Self {
        self.signs = Some(Box::new((negative.into(), positive.into())));
        self
    }

    /// The words for negative and for positive numbers, each with a typical colour.
    pub(super) fn sign_keys(&self) -> [Option<(&str, Colour)>; 2] {
        let Some(words) = self.signs.as_deref().filter(|_| self.palette.is_two_sided()) else {
            return [None, None];
        };
        let (negative, positive) = words;
        let shades = self.palette.shades(SHADES);
        [
            Some((negative.as_str(), shades[SHADES / 5])),
            Some((positive.as_str(), shades[4 * SHADES / 5])),
        ]
    }

    /// Sets another colour for numbers below this one.
    #[must_use]
    pub fn below(mut self, limit: f64, tint: Tint) -> Self {
        self.below = Some((limit, tint));
        self
    }
}

/// Colouring of a heatmap.
#[derive(Debug, Clone, PartialEq)]
pub enum Colouring {
    /// Numbers mapped to a palette, with a colour bar.
    Shaded(Shading),
    /// Each value is the index of its outcome in this list (0, 1, …), which the legend shows.
    Outcomes(Vec<Tint>),
}

/// Number of palette colours in an image; their indices start at 0.
pub(super) const SHADES: usize = 250;
/// Index of the colour of values below the scale.
const BELOW: u8 = 251;
/// Index of the transparent colour.
pub(super) const CLEAR: u8 = 255;

/// The colouring of one heatmap with the range of its values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColourMap {
    colouring: Colouring,
    /// Values at the ends of the palette.
    pub(super) range: PlotRange,
}

impl ColourMap {
    /// The colouring of values between these extremes.
    pub(super) fn new(colouring: &Colouring, extremes: Option<PlotRange>) -> Self {
        let range = match colouring {
            Colouring::Outcomes(outcomes) => PlotRange::new(0.0, outcomes.len() as f64),
            Colouring::Shaded(shading) => range_of(shading, extremes),
        };
        Self { colouring: colouring.clone(), range }
    }

    /// Position of a value between the ends of the palette, from 0 to 1.
    pub(super) fn share(&self, value: f64) -> f64 {
        let PlotRange { lower, upper } = self.range;
        let Colouring::Shaded(shading) = &self.colouring else {
            return 0.0;
        };
        let position = |value: f64| match shading.spread {
            Spread::Linear => value,
            Spread::Log => libm::log(value.max(f64::MIN_POSITIVE)),
            // asinh of larger values overflows.
            Spread::SignedLog(size) => {
                let whole = lower.abs().max(upper.abs());
                let size = if size > 0.0 && size.is_finite() { size } else { 1e-6 * whole };
                (value / size).clamp(-1e300, 1e300).asinh()
            }
        };
        // Quarters, so that no difference overflows.
        let (low, high, at) = (
            0.25 * position(lower),
            0.25 * position(upper),
            0.25 * position(value.clamp(lower, upper)),
        );
        ((at - low) / (high - low)).clamp(0.0, 1.0)
    }

    /// Index of a value's colour in the image.
    pub(super) fn index(&self, value: f64) -> u8 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to the number of colours"
        )]
        let position = |position: f64| position as u8;
        match &self.colouring {
            Colouring::Outcomes(outcomes) => {
                let whole = value.round();
                let known = whole >= 0.0 && whole < outcomes.len().min(SHADES) as f64;
                if known { position(whole) } else { CLEAR }
            }
            Colouring::Shaded(shading) => match &shading.below {
                Some((limit, _)) if value < *limit => BELOW,
                _ => position((self.share(value) * (SHADES - 1) as f64).round()),
            },
        }
    }

    /// All colours of the image in order of their indices; the last is transparent.
    pub(super) fn colours(&self) -> Vec<Colour> {
        let mut colours = match &self.colouring {
            Colouring::Outcomes(outcomes) => {
                let numbered = outcomes.iter().take(SHADES).enumerate();
                numbered.map(|(number, outcome)| outcome.outcome_colour(number)).collect()
            }
            Colouring::Shaded(shading) => shading.palette.shades(SHADES),
        };
        colours.resize(usize::from(CLEAR) + 1, (255, 255, 255));
        if let Colouring::Shaded(Shading { below: Some((_, tint)), .. }) = &self.colouring {
            colours[usize::from(BELOW)] = tint.colour();
        }
        colours
    }

    /// Whether there are values below and above the range that get the end colours of the palette.
    pub(super) fn overflows(&self, extremes: Option<PlotRange>) -> (bool, bool) {
        let Colouring::Shaded(shading) = &self.colouring else {
            return (false, false);
        };
        let PlotRange { lower: least, upper: most } = extremes.unwrap_or(self.range);
        let slack = 1e-9 * self.range.width();
        (
            least < self.range.lower - slack && shading.below.is_none(),
            most > self.range.upper + slack,
        )
    }

    /// The axis of the colour bar.
    pub(super) fn axis(&self, quantity: &PlotAxis) -> PlotAxis {
        let axis = quantity.clone().between(self.range.lower, self.range.upper);
        match self.spread() {
            Spread::Log => axis.log(),
            _ => PlotAxis { scale: Scale::Linear, ..axis },
        }
    }

    pub(super) fn spread(&self) -> Spread {
        match &self.colouring {
            Colouring::Shaded(shading) => shading.spread,
            Colouring::Outcomes(_) => Spread::Linear,
        }
    }
}

/// Values at the ends of the palette, given or determined from the extremes, in increasing order and distinct.
fn range_of(shading: &Shading, extremes: Option<PlotRange>) -> PlotRange {
    let finite = |range: &PlotRange| range.lower.is_finite() && range.upper.is_finite();
    let found = shading.range.filter(finite).or(extremes).unwrap_or(PlotRange::new(0.0, 1.0));
    let (mut lower, mut upper) = (found.lower.min(found.upper), found.lower.max(found.upper));
    if shading.palette.is_two_sided() {
        upper = upper.abs().max(lower.abs());
        lower = -upper;
    }
    if shading.spread == Spread::Log {
        upper = if upper > 0.0 { upper } else { 1.0 };
        // A value that is not positive does not determine the lower end: six decades are shown.
        lower = if lower > 0.0 { lower } else { 1e-6 * upper };
    }
    if lower < upper {
        return PlotRange::new(lower, upper);
    }
    let away = if lower == 0.0 { 1.0 } else { 0.1 * lower.abs() };
    PlotRange::new(lower - away, upper + away)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colour_map(shading: Shading, extremes: PlotRange) -> ColourMap {
        ColourMap::new(&Colouring::Shaded(shading), Some(extremes))
    }

    #[test]
    fn a_diverging_palette_is_centred_on_zero() {
        for spread in [Spread::Linear, Spread::SignedLog(1e-3)] {
            let shading = Shading::new(Palette::Diverging).spread(spread);
            let colour_map = colour_map(shading, PlotRange::new(-0.2, 3.0));
            assert_eq!(colour_map.range, PlotRange::new(-3.0, 3.0));
            assert!((colour_map.share(0.0) - 0.5).abs() < 1e-15);
            assert!((colour_map.share(0.7) + colour_map.share(-0.7) - 1.0).abs() < 1e-15);
            assert_eq!((colour_map.share(3.0), colour_map.share(-9.0)), (1.0, 0.0));
        }
    }

    #[test]
    fn a_log_spread_is_linear_in_the_logarithm() {
        let colour_map =
            colour_map(Shading::default().spread(Spread::Log), PlotRange::new(1e-4, 1.0));
        assert!((colour_map.share(1e-2) - 0.5).abs() < 1e-12);
        assert_eq!(colour_map.share(-1.0), 0.0);
    }

    #[test]
    fn every_range_has_distinct_ends() {
        for extremes in [
            PlotRange::new(0.0, 0.0),
            PlotRange::new(3.0, 3.0),
            PlotRange::new(-1e308, 1e308),
            PlotRange::new(-2.0, -1.0),
        ] {
            for spread in [Spread::Linear, Spread::Log, Spread::SignedLog(1.0)] {
                for palette in [Palette::Viridis, Palette::Diverging] {
                    let colour_map = colour_map(Shading::new(palette).spread(spread), extremes);
                    assert!(
                        colour_map.range.lower < colour_map.range.upper,
                        "{extremes:?} {spread:?}"
                    );
                    assert!(colour_map.share(0.3).is_finite());
                }
            }
        }
    }

    #[test]
    fn values_below_the_scale_can_have_their_own_colour() {
        let tint = Tint::new(PlotRole::Unstable, "worse");
        let colour_map = colour_map(
            Shading::new(Palette::Pale).range(0.0, 1.0).below(0.0, tint),
            PlotRange::new(-1.0, 2.0),
        );
        assert_eq!(colour_map.index(-0.1), BELOW);
        assert_eq!(colour_map.index(0.0), 0);
        assert_eq!(usize::from(colour_map.index(5.0)), SHADES - 1);
        assert_eq!(colour_map.overflows(Some(PlotRange::new(-1.0, 2.0))), (false, true));
        assert_eq!(colour_map.colours().len(), 256);
    }

    #[test]
    fn an_unlisted_outcome_is_transparent() {
        let outcomes = Colouring::Outcomes(vec![Tint::new(PlotRole::Stable, "stable")]);
        let colour_map = ColourMap::new(&outcomes, Some(PlotRange::new(0.0, 1.0)));
        assert_eq!(
            (colour_map.index(0.0), colour_map.index(1.0), colour_map.index(-1.0)),
            (0, CLEAR, CLEAR)
        );
    }
}
