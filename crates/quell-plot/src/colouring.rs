//! Colouring: which colour a value of a map has.

use super::axis::{PlotAxis, Scale};
use super::palette::{Colour, PlotRole};
use super::shades::{Palette, tint};

/// How numbers are spread over a palette.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Spread {
    /// Equal steps.
    #[default]
    Linear,
    /// Equal ratios; what is not positive has the lowest colour.
    Log,
    /// Equal steps up to this size and equal ratios beyond it, on both sides of zero: asinh. A size
    /// that is not positive counts as a millionth of the range.
    SignedLog(f64),
}

/// A flat colour for one of few outcomes, or for what lies beyond a scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Tint {
    /// What it stands for.
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
}

/// How strongly outcomes are tinted: black lines and numbers stay readable.
const TINT: f64 = 0.34;

/// Colours of numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shading {
    /// The colours.
    pub palette: Palette,
    /// How numbers are spread over them.
    pub spread: Spread,
    /// Numbers at the ends of the palette; from the values themselves when not given. A diverging
    /// palette always reaches as far below zero as above.
    pub range: Option<(f64, f64)>,
    /// Another colour for numbers below this one.
    pub below: Option<(f64, Tint)>,
}

impl Shading {
    /// A palette with equal steps over all values.
    #[must_use]
    pub fn new(palette: Palette) -> Self {
        Self { palette, ..Self::default() }
    }

    /// How numbers are spread over the palette.
    #[must_use]
    pub fn spread(mut self, spread: Spread) -> Self {
        self.spread = spread;
        self
    }

    /// Numbers at the ends of the palette.
    #[must_use]
    pub fn range(mut self, lower: f64, upper: f64) -> Self {
        self.range = Some((lower, upper));
        self
    }

    /// Another colour for numbers below this one.
    #[must_use]
    pub fn below(mut self, limit: f64, tint: Tint) -> Self {
        self.below = Some((limit, tint));
        self
    }
}

/// How a map is coloured.
#[derive(Debug, Clone, PartialEq)]
pub enum Colouring {
    /// Numbers by a palette, with a colour bar.
    Shaded(Shading),
    /// The value is the place of its outcome in this list (0, 1, …), which the legend shows.
    Outcomes(Vec<Tint>),
}

/// Places of the colours in an image.
pub(super) const SHADES: usize = 250;
/// The colour for what lies below the scale.
const BELOW: u8 = 251;
/// Nothing is printed.
pub(super) const CLEAR: u8 = 255;

/// A colouring for the values of one map.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ColourMap {
    colouring: Colouring,
    /// Values at the ends of the palette.
    pub(super) range: (f64, f64),
}

impl ColourMap {
    /// The colouring when values lie between these extremes.
    pub(super) fn new(colouring: &Colouring, extremes: Option<(f64, f64)>) -> Self {
        let range = match colouring {
            Colouring::Outcomes(outcomes) => (0.0, outcomes.len() as f64),
            Colouring::Shaded(shading) => range_of(shading, extremes),
        };
        Self { colouring: colouring.clone(), range }
    }

    /// Where a value lies between the ends of the palette, from 0 to 1.
    pub(super) fn share(&self, value: f64) -> f64 {
        let (lower, upper) = self.range;
        let Colouring::Shaded(shading) = &self.colouring else {
            return 0.0;
        };
        let place = |value: f64| match shading.spread {
            Spread::Linear => value,
            Spread::Log => value.max(f64::MIN_POSITIVE).ln(),
            // asinh of what lies beyond overflows.
            Spread::SignedLog(size) => {
                let whole = lower.abs().max(upper.abs());
                let size = if size > 0.0 && size.is_finite() { size } else { 1e-6 * whole };
                (value / size).clamp(-1e300, 1e300).asinh()
            }
        };
        // Quarters, so that no difference leaves the range of numbers.
        let (low, high, at) =
            (0.25 * place(lower), 0.25 * place(upper), 0.25 * place(value.clamp(lower, upper)));
        ((at - low) / (high - low)).clamp(0.0, 1.0)
    }

    /// Place of a value's colour in the image.
    pub(super) fn index(&self, value: f64) -> u8 {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to the number of colours"
        )]
        let place = |place: f64| place as u8;
        match &self.colouring {
            Colouring::Outcomes(outcomes) => {
                let whole = value.round();
                let known = whole >= 0.0 && whole < outcomes.len().min(SHADES) as f64;
                if known { place(whole) } else { CLEAR }
            }
            Colouring::Shaded(shading) => match &shading.below {
                Some((limit, _)) if value < *limit => BELOW,
                _ => place((self.share(value) * (SHADES - 1) as f64).round()),
            },
        }
    }

    /// All colours of the image, in order; the last is clear.
    pub(super) fn colours(&self) -> Vec<Colour> {
        let mut colours = match &self.colouring {
            Colouring::Outcomes(outcomes) => {
                outcomes.iter().take(SHADES).map(Tint::colour).collect()
            }
            Colouring::Shaded(shading) => shading.palette.shades(SHADES),
        };
        colours.resize(usize::from(CLEAR) + 1, (255, 255, 255));
        if let Colouring::Shaded(Shading { below: Some((_, tint)), .. }) = &self.colouring {
            colours[usize::from(BELOW)] = tint.colour();
        }
        colours
    }

    /// Whether values below and above the palette's ends have its end colours.
    pub(super) fn overflows(&self, extremes: Option<(f64, f64)>) -> (bool, bool) {
        let Colouring::Shaded(shading) = &self.colouring else {
            return (false, false);
        };
        let (least, most) = extremes.unwrap_or(self.range);
        let slack = 1e-9 * (self.range.1 - self.range.0);
        (least < self.range.0 - slack && shading.below.is_none(), most > self.range.1 + slack)
    }

    /// The axis of the colour bar.
    pub(super) fn axis(&self, quantity: &PlotAxis) -> PlotAxis {
        let axis = quantity.clone().between(self.range.0, self.range.1);
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

/// Values at the ends of the palette: given or found, in order and apart.
fn range_of(shading: &Shading, extremes: Option<(f64, f64)>) -> (f64, f64) {
    let finite = |range: &(f64, f64)| range.0.is_finite() && range.1.is_finite();
    let found = shading.range.filter(finite).or(extremes).unwrap_or((0.0, 1.0));
    let (mut lower, mut upper) = (found.0.min(found.1), found.0.max(found.1));
    if shading.palette == Palette::Diverging {
        upper = upper.abs().max(lower.abs());
        lower = -upper;
    }
    if shading.spread == Spread::Log {
        upper = if upper > 0.0 { upper } else { 1.0 };
        // What is not positive says nothing about the lower end: six decades are shown.
        lower = if lower > 0.0 { lower } else { 1e-6 * upper };
    }
    if lower < upper {
        return (lower, upper);
    }
    let away = if lower == 0.0 { 1.0 } else { 0.1 * lower.abs() };
    (lower - away, upper + away)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colour_map(shading: Shading, extremes: (f64, f64)) -> ColourMap {
        ColourMap::new(&Colouring::Shaded(shading), Some(extremes))
    }

    #[test]
    fn zero_lies_in_the_middle_of_a_diverging_palette() {
        for spread in [Spread::Linear, Spread::SignedLog(1e-3)] {
            let shading = Shading::new(Palette::Diverging).spread(spread);
            let colour_map = colour_map(shading, (-0.2, 3.0));
            assert_eq!(colour_map.range, (-3.0, 3.0));
            assert!((colour_map.share(0.0) - 0.5).abs() < 1e-15);
            assert!((colour_map.share(0.7) + colour_map.share(-0.7) - 1.0).abs() < 1e-15);
            assert_eq!((colour_map.share(3.0), colour_map.share(-9.0)), (1.0, 0.0));
        }
    }

    #[test]
    fn ratios_are_equal_on_a_log_spread() {
        let colour_map = colour_map(Shading::default().spread(Spread::Log), (1e-4, 1.0));
        assert!((colour_map.share(1e-2) - 0.5).abs() < 1e-12);
        assert_eq!(colour_map.share(-1.0), 0.0);
    }

    #[test]
    fn every_range_has_a_length() {
        for extremes in [(0.0, 0.0), (3.0, 3.0), (-1e308, 1e308), (-2.0, -1.0)] {
            for spread in [Spread::Linear, Spread::Log, Spread::SignedLog(1.0)] {
                for palette in [Palette::Viridis, Palette::Diverging] {
                    let colour_map = colour_map(Shading::new(palette).spread(spread), extremes);
                    assert!(colour_map.range.0 < colour_map.range.1, "{extremes:?} {spread:?}");
                    assert!(colour_map.share(0.3).is_finite());
                }
            }
        }
    }

    #[test]
    fn what_lies_below_the_scale_can_have_its_own_colour() {
        let tint = Tint::new(PlotRole::Unstable, "worse");
        let colour_map =
            colour_map(Shading::new(Palette::Pale).range(0.0, 1.0).below(0.0, tint), (-1.0, 2.0));
        assert_eq!(colour_map.index(-0.1), BELOW);
        assert_eq!(colour_map.index(0.0), 0);
        assert_eq!(usize::from(colour_map.index(5.0)), SHADES - 1);
        assert_eq!(colour_map.overflows(Some((-1.0, 2.0))), (false, true));
        assert_eq!(colour_map.colours().len(), 256);
    }

    #[test]
    fn an_outcome_that_is_not_listed_is_not_printed() {
        let outcomes = Colouring::Outcomes(vec![Tint::new(PlotRole::Stable, "stable")]);
        let colour_map = ColourMap::new(&outcomes, Some((0.0, 1.0)));
        assert_eq!(
            (colour_map.index(0.0), colour_map.index(1.0), colour_map.index(-1.0)),
            (0, CLEAR, CLEAR)
        );
    }
}
