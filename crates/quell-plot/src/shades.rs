//! Shades: perceptually uniform palettes.
//!
//! A palette is a smooth curve (Catmull–Rom) through a few published colours, parametrised by arc length in OKLab
//! (B. Ottosson, A perceptual color space for image processing, 2020), so that equal steps of the
//! number look equally large.
//!
//! - [`Palette::Viridis`]: S. van der Walt, N. Smith, the default of Matplotlib 2 (2015, CC0).
//! - [`Palette::Pale`]: the light half of `YlGnBu` of C. A. Brewer, M. Harrower, ColorBrewer
//!   (The Cartographic Journal 40, 2003): black lines and numbers stay readable on it.
//! - [`Palette::Diverging`]: `RdBu` of ColorBrewer without its darkest ends, on which black lines would be
//!   invisible; red for positive numbers, nearly white at zero.
//! - [`Palette::Sign`]: the light blues and the darker reds of ColorBrewer with a step at zero, so that the sign is seen in
//!   grey: every negative number is lighter than every positive one.

use super::palette::Colour;

/// A colour palette for numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Palette {
    /// Dark violet to yellow.
    #[default]
    Viridis,
    /// Pale yellow to light blue, for maps with lines over them.
    Pale,
    /// Blue through nearly white to red, for numbers on both sides of zero.
    Diverging,
    /// Pale blues below zero, darker reds above: for numbers whose sign is what matters. The two sides differ in grey.
    Sign,
}

const VIRIDIS: &[u32] =
    &[0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c, 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725];
const PALE: &[u32] = &[0xffffd9, 0xedf8b1, 0xc7e9b4, 0x7fcdbb, 0x41b6c4];
const BELOW_ZERO: &[u32] = &[0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7];
const NEGATIVE: &[u32] = &[0x9ecae1, 0xc6dbef, 0xdeebf7, 0xf7fbff];
const POSITIVE: &[u32] = &[0xec8f6a, 0xd6604d, 0xb2182b];
const ABOVE_ZERO: &[u32] = &[0xf7f7f7, 0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b];

impl Palette {
    /// `count` colours from the lower end to the upper end.
    pub(super) fn shades(self, count: usize) -> Vec<Colour> {
        match self {
            Self::Viridis => interpolate(VIRIDIS, &shares(count)),
            Self::Pale => interpolate(PALE, &shares(count)),
            Self::Diverging => two_sided(BELOW_ZERO, ABOVE_ZERO, count),
            Self::Sign => two_sided(NEGATIVE, POSITIVE, count),
        }
    }

    /// Whether the colours belong to fixed signs, so that zero is in the middle of the palette.
    pub(super) fn is_two_sided(self) -> bool {
        matches!(self, Self::Diverging | Self::Sign)
    }
}

/// `count` colours of which those of the lower half are on one curve and the others on another.
fn two_sided(below: &[u32], above: &[u32], count: usize) -> Vec<Colour> {
    let (lower, upper): (Vec<f64>, Vec<f64>) =
        shares(count).into_iter().partition(|share| *share < 0.5);
    let lower: Vec<f64> = lower.iter().map(|share| 2.0 * share).collect();
    let upper: Vec<f64> = upper.iter().map(|share| 2.0 * share - 1.0).collect();
    let mut shades = interpolate(below, &lower);
    shades.extend(interpolate(above, &upper));
    shades
}

fn shares(count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1).max(1) as f64;
    (0..count).map(|step| step as f64 / last).collect()
}

/// Colours at these fractions of the arc length of the curve through the stops.
fn interpolate(stops: &[u32], shares: &[f64]) -> Vec<Colour> {
    let stops = smooth(&stops.iter().map(|stop| lab(split(*stop))).collect::<Vec<_>>());
    let mut reached = vec![0.0];
    for pair in stops.windows(2) {
        reached.push(reached[reached.len() - 1] + distance(pair[0], pair[1]));
    }
    let whole = reached[reached.len() - 1];
    let position = |share: &f64| {
        let wanted = share.clamp(0.0, 1.0) * whole;
        let leg = reached.partition_point(|way| *way <= wanted).clamp(1, stops.len() - 1);
        let share = (wanted - reached[leg - 1]) / (reached[leg] - reached[leg - 1]);
        let (from, to) = (stops[leg - 1], stops[leg]);
        colour([0, 1, 2].map(|axis| from[axis] + share * (to[axis] - from[axis])))
    };
    shares.iter().map(position).collect()
}

/// Dense points on the Catmull–Rom curve through these points, which has no corners.
fn smooth(stops: &[[f64; 3]]) -> Vec<[f64; 3]> {
    const PARTS: u32 = 24;
    let last = stops.len() - 1;
    let mut points = Vec::new();
    for leg in 0..last {
        let (from, to) = (stops[leg], stops[leg + 1]);
        let (before, after) = (stops[leg.saturating_sub(1)], stops[(leg + 2).min(last)]);
        points.extend((0..PARTS).map(|part| {
            let t = f64::from(part) / f64::from(PARTS);
            [0, 1, 2].map(|axis| {
                let (a, b, c, d) = (before[axis], from[axis], to[axis], after[axis]);
                let bend = 2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a);
                b + 0.5 * t * (c - a + t * bend)
            })
        }));
    }
    points.push(stops[last]);
    points
}

fn split(code: u32) -> Colour {
    let [_, red, green, blue] = code.to_be_bytes();
    (red, green, blue)
}

fn distance(one: [f64; 3], other: [f64; 3]) -> f64 {
    one.iter().zip(other).map(|(one, other)| (one - other).powi(2)).sum::<f64>().sqrt()
}

/// sRGB (IEC 61966-2-1) to OKLab.
fn lab((red, green, blue): Colour) -> [f64; 3] {
    let linear = |level: u8| {
        let share = f64::from(level) / 255.0;
        if share <= 0.04045 { share / 12.92 } else { libm::pow((share + 0.055) / 1.055, 2.4) }
    };
    let (r, g, b) = (linear(red), linear(green), linear(blue));
    let l = libm::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
    let m = libm::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
    let s = libm::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    [
        0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
        1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
        0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s,
    ]
}

/// OKLab to sRGB.
fn colour([lightness, a, b]: [f64; 3]) -> Colour {
    let l = (lightness + 0.3963377774 * a + 0.2158037573 * b).powi(3);
    let m = (lightness - 0.1055613458 * a - 0.0638541728 * b).powi(3);
    let s = (lightness - 0.0894841775 * a - 1.2914855480 * b).powi(3);
    let level = |linear: f64| {
        let share = if linear <= 0.0031308 {
            12.92 * linear
        } else {
            1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "clamped to 0 to 255"
        )]
        let level = (255.0 * share).round().clamp(0.0, 255.0) as u8;
        level
    };
    (
        level(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
        level(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
        level(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s),
    )
}

/// Luma of ITU-R BT.601, the grey of common converters.
fn grey((red, green, blue): Colour) -> f64 {
    0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue)
}

/// Grey levels of numbered outcomes in turn: neighbours differ most, and all are light enough for black lines.
const OUTCOME_GREYS: [f64; 6] = [224.0, 150.0, 188.0, 120.0, 206.0, 135.0];

/// Opacity at which a colour on white has the grey level of this outcome.
pub(super) fn outcome_opacity(colour: Colour, number: usize) -> f64 {
    let wanted = OUTCOME_GREYS[number % OUTCOME_GREYS.len()];
    ((255.0 - wanted) / (255.0 - grey(colour))).min(1.0)
}

/// A colour at this opacity on a white background.
pub(super) fn tint((red, green, blue): Colour, opacity: f64) -> Colour {
    let mix = |level: u8| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between level and 255"
        )]
        let mixed = (255.0 - opacity.clamp(0.0, 1.0) * (255.0 - f64::from(level))).round() as u8;
        mixed
    };
    (mix(red), mix(green), mix(blue))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PlotRole;

    #[test]
    fn ends_and_middle_are_the_published_colours() {
        let ends = |palette: Palette| {
            let shades = palette.shades(255);
            assert_eq!(shades.len(), 255);
            (shades[0], shades[127], shades[254])
        };
        assert_eq!(ends(Palette::Viridis).0, (0x44, 0x01, 0x54));
        assert_eq!(ends(Palette::Viridis).2, (0xfd, 0xe7, 0x25));
        assert_eq!(ends(Palette::Pale).2, (0x41, 0xb6, 0xc4));
        let diverging = ends(Palette::Diverging);
        assert_eq!(diverging, ((0x21, 0x66, 0xac), (0xf7, 0xf7, 0xf7), (0xb2, 0x18, 0x2b)));
    }

    #[test]
    fn equal_steps_look_equally_large() {
        for palette in [Palette::Viridis, Palette::Pale, Palette::Diverging] {
            let shades: Vec<_> = palette.shades(17).into_iter().map(lab).collect();
            // The two arms of the diverging palette differ in length.
            for arm in [&shades[..9], &shades[8..]] {
                let steps: Vec<f64> =
                    arm.windows(2).map(|pair| distance(pair[0], pair[1])).collect();
                let least = steps.iter().copied().fold(f64::INFINITY, f64::min);
                let most = steps.iter().copied().fold(0.0, f64::max);
                // Colours are whole numbers of 255, a tenth of the least step.
                assert!(most < 1.2 * least, "{palette:?} {least} {most}");
            }
        }
    }

    #[test]
    fn the_sign_is_seen_in_grey() {
        let shades: Vec<f64> = Palette::Sign.shades(250).into_iter().map(grey).collect();
        let (below, above) = shades.split_at(125);
        let darkest = below.iter().copied().fold(f64::INFINITY, f64::min);
        let lightest = above.iter().copied().fold(0.0, f64::max);
        assert!(darkest > lightest + 20.0, "{darkest} {lightest}");
    }

    #[test]
    fn outcomes_differ_in_grey_whatever_their_colours() {
        let roles =
            [PlotRole::Stable, PlotRole::Unstable, PlotRole::Series(2), PlotRole::Series(4)];
        for one in roles {
            for other in roles {
                let level = |role: PlotRole, number| {
                    grey(tint(role.colour(), outcome_opacity(role.colour(), number)))
                };
                for number in 0..5 {
                    let step = (level(one, number) - level(other, number + 1)).abs();
                    assert!(step > 20.0, "{one:?} {other:?} {number} {step}");
                }
            }
        }
    }

    #[test]
    fn the_pale_palette_is_light() {
        assert!(Palette::Pale.shades(32).into_iter().all(|shade| lab(shade)[0] > 0.7));
    }

    #[test]
    fn conversion_to_oklab_and_back_is_exact() {
        for code in [0x000000, 0xffffff, 0x440154, 0xd6604d, 0x010203] {
            assert_eq!(colour(lab(split(code))), split(code));
        }
    }
}
