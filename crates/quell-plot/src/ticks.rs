//! Ticks: positions of the marks of an axis, and their labels.

use super::axis::{PlotAxis, Scale};
use super::geometry::PlotRange;
use super::typeset::{RichText, number};

/// The marks of one axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    /// Values with a label, and the label.
    pub(super) major: Vec<(f64, RichText)>,
    /// Values with a short mark and no label.
    pub(super) minor: Vec<f64>,
    /// Exponent of the power of ten factored out of all labels; 0 for none.
    pub(super) exponent: i32,
}

/// Space for tick labels along the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Room {
    /// Labels side by side, in this many pixels at this font size.
    Across(f64, f64),
    /// Labels one above the other, in this many pixels.
    Upright(f64),
}

impl Ticks {
    /// The power of ten factored out of all labels; `None` for none.
    pub(super) fn exponent_label(&self) -> Option<RichText> {
        (self.exponent != 0).then(|| RichText::parse(&format!("$×10^{{{}}}$", self.exponent)))
    }

    /// Ticks for an axis with these limits.
    pub(super) fn of(axis: &PlotAxis, limits: PlotRange, room: Room) -> Self {
        if let Some(chosen) = &axis.ticks {
            let inside = |value: &f64| *value >= limits.lower && *value <= limits.upper;
            let values: Vec<f64> = chosen.iter().copied().filter(inside).collect();
            let step = values
                .windows(2)
                .map(|pair| (pair[1] - pair[0]).abs())
                .fold(limits.width(), f64::min);
            return Self::linear(values, Vec::new(), step);
        }
        if axis.scale == Scale::Log && limits.upper / limits.lower >= 10.0 {
            return Self::logarithmic(limits, room);
        }
        let most = match room {
            Room::Across(pixels, _) => pixels / 42.0,
            Room::Upright(pixels) => pixels / 36.0,
        };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "2 to 9")]
        let mut count = most.clamp(2.0, 9.0) as usize;
        loop {
            let ticks = Self::evenly(limits, count);
            if count <= 2 || ticks.fits(axis, limits, room) {
                return ticks;
            }
            count -= 1;
        }
    }

    fn evenly(limits: PlotRange, count: usize) -> Self {
        let step = step_for(limits.width() / count as f64);
        let values = multiples(limits, step);
        let leading = step / libm::pow(10.0, (libm::log10(step) + 1e-9).floor());
        let parts = if (leading - 2.0).abs() < 0.1 { 4 } else { 5 };
        let minor = values
            .first()
            .map(|first| {
                (-parts..=parts * 12)
                    .map(|part| first + step * f64::from(part) / f64::from(parts))
                    .filter(|value| *value > limits.lower && *value < limits.upper)
                    .collect()
            })
            .unwrap_or_default();
        Self::linear(values, minor, step)
    }

    fn linear(values: Vec<f64>, minor: Vec<f64>, step: f64) -> Self {
        let greatest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let exponent = if greatest >= 1e5 || (greatest > 0.0 && greatest < 2e-3) {
            #[expect(clippy::cast_possible_truncation, reason = "a decimal exponent")]
            let exponent = libm::log10(greatest).floor() as i32;
            exponent
        } else {
            0
        };
        let unit = 10f64.powi(exponent);
        let decimals = decimals(step / unit);
        let major = values
            .into_iter()
            .map(|value| (value, RichText::parse(&number(value / unit, decimals))))
            .collect();
        Self { major, minor, exponent }
    }

    fn logarithmic(limits: PlotRange, room: Room) -> Self {
        let (low, high) = (libm::log10(limits.lower), libm::log10(limits.upper));
        let decades = high - low;
        let most = match room {
            Room::Across(pixels, _) => pixels / 45.0,
            Room::Upright(pixels) => pixels / 26.0,
        };
        let leading: &[f64] = match most / decades.max(0.1) {
            dense if dense >= 3.0 && decades < 3.0 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        #[expect(clippy::cast_possible_truncation, reason = "decimal exponents")]
        let (first, last, stride) =
            (low.floor() as i32, high.ceil() as i32, (decades / most).ceil().max(1.0) as i32);
        let plain = first >= -2 && last <= 3 && decades < 3.2;
        let inside = |value: &f64| {
            *value >= limits.lower * (1.0 - 1e-9) && *value <= limits.upper * (1.0 + 1e-9)
        };
        let (mut major, mut minor) = (Vec::new(), Vec::new());
        for exponent in first..=last {
            let decade = 10f64.powi(exponent);
            for digit in 1..=9 {
                let value = f64::from(digit) * decade;
                let labelled =
                    leading.contains(&f64::from(digit)) && exponent.rem_euclid(stride) == 0;
                if !inside(&value) {
                } else if labelled {
                    major.push((value, RichText::parse(&power(digit, exponent, plain))));
                } else if stride == 1 || digit == 1 {
                    minor.push(value);
                }
            }
        }
        Self { major, minor, exponent: 0 }
    }

    fn fits(&self, axis: &PlotAxis, limits: PlotRange, room: Room) -> bool {
        let Room::Across(pixels, size) = room else {
            return true;
        };
        let per_unit = pixels / (axis.along(limits.upper) - axis.along(limits.lower));
        self.major.windows(2).all(|pair| {
            let apart = (axis.along(pair[1].0) - axis.along(pair[0].0)) * per_unit;
            apart
                >= 0.5 * (pair[0].1.width(size, false) + pair[1].1.width(size, false)) + 0.9 * size
        })
    }
}

/// The least of 1, 2 and 5 times a power of ten that is at least 0.65 `wanted`.
fn step_for(wanted: f64) -> f64 {
    let least = 0.65 * wanted;
    let decade = libm::pow(10.0, libm::log10(least).floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|leading| leading * decade)
        .find(|step| *step >= least * (1.0 - 1e-9))
        .unwrap_or(wanted)
}

/// Share of a step within which two numbers are one tick.
const CLOSE: f64 = 1e-6;

/// The multiples of `step` within the limits.
///
/// `step` is that of [`step_for`], which leaves about 15 of them at most.
fn multiples(PlotRange { lower, upper }: PlotRange, step: f64) -> Vec<f64> {
    // The range of the limits overflows.
    if !step.is_finite() {
        return Vec::new();
    }
    let first = (lower / step).floor();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let last = ((upper / step).ceil() - first) as u8;
    let mut values: Vec<f64> = (0..=last)
        .map(|index| (first + f64::from(index)) * step)
        .filter(|value| (lower - CLOSE * step..=upper + CLOSE * step).contains(value))
        .map(|value| {
            let rounded = rounded(value);
            let is_close = (rounded - value).abs() <= CLOSE * step;
            // A product may leave the limits by its rounding error.
            (if is_close { rounded } else { value }).clamp(lower, upper)
        })
        .collect();
    values.dedup();
    values
}

/// The value without the rounding error of a product, to nine decimals: 0.3 for 3 × 0.1.
fn rounded(value: f64) -> f64 {
    const NINE: f64 = 1e9;
    let scaled = value * NINE;
    if scaled.fract() == 0.0 { value } else { scaled.round() / NINE }
}

fn power(digit: i32, exponent: i32, plain: bool) -> String {
    if plain {
        let decimals = usize::try_from(-exponent).unwrap_or(0);
        return number(f64::from(digit) * 10f64.powi(exponent), decimals);
    }
    let mantissa = if digit == 1 { String::new() } else { format!("{digit}·") };
    format!("{mantissa}$10^{{{exponent}}}$")
}

/// Number of decimals that distinguishes multiples of `step`.
fn decimals(step: f64) -> usize {
    (0..9)
        .find(|decimals| {
            let scaled = step * 10f64.powi(*decimals);
            (scaled - scaled.round()).abs() <= 1e-6 * scaled && scaled.round() >= 1.0
        })
        .map_or(9, |decimals| decimals.unsigned_abs() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(ticks: &Ticks) -> Vec<f64> {
        ticks.major.iter().map(|(value, _)| *value).collect()
    }

    #[test]
    fn labels_of_one_axis_have_equal_decimals() {
        let ticks = Ticks::of(&PlotAxis::new("x"), PlotRange::new(0.0, 1.0), Room::Upright(200.0));
        assert_eq!(ticks.major[0].1, RichText::parse("0.0"));
        assert!(ticks.major.len() >= 4);
        assert_eq!(decimals(0.25), 2);
        assert_eq!(decimals(20.0), 0);
    }

    #[test]
    fn multiples_are_within_the_limits_and_without_rounding_errors() {
        assert_eq!(multiples(PlotRange::new(0.0, 0.3), 0.1), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(multiples(PlotRange::new(0.0, 0.35), 0.1), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(multiples(PlotRange::new(-0.2, 0.21), 0.1), [-0.2, -0.1, 0.0, 0.1, 0.2]);
        assert_eq!(multiples(PlotRange::new(1.0, 1.7), 0.2), [1.0, 1.2, 1.4, 1.6]);
        assert_eq!(multiples(PlotRange::new(2.5e-12, 6e-12), 1e-12), [3e-12, 4e-12, 5e-12, 6e-12]);
        assert!(multiples(PlotRange::new(0.31, 0.39), 0.1).is_empty());
        assert!(multiples(PlotRange::new(f64::MIN, f64::MAX), f64::INFINITY).is_empty());
    }

    #[test]
    fn small_values_share_a_power_of_ten() {
        let ticks = Ticks::of(&PlotAxis::new("x"), PlotRange::new(0.0, 3e-5), Room::Upright(200.0));
        assert_eq!(ticks.exponent, -5);
    }

    #[test]
    fn a_log_axis_is_labelled_at_decades() {
        let axis = PlotAxis::new("f").log();
        let ticks = Ticks::of(&axis, PlotRange::new(1e-6, 1e2), Room::Upright(300.0));
        assert!(printed(&ticks).iter().any(|value| (value - 1e-3).abs() < 1e-12));
        assert!(ticks.major.len() >= 4 && ticks.major.len() <= 9);
    }

    #[test]
    fn labels_side_by_side_do_not_overlap() {
        let ticks = Ticks::of(
            &PlotAxis::new("x"),
            PlotRange::new(-0.0123, 0.0117),
            Room::Across(120.0, 11.0),
        );
        let widest =
            ticks.major.iter().map(|(_, label)| label.width(11.0, false)).fold(0.0, f64::max);
        assert!(widest * ticks.major.len() as f64 <= 160.0);
    }
}
