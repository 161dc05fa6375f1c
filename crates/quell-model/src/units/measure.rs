//! Numbers with units: `5.7kN`, `0.36 km/h`, `30deg`, `2%`, `15.8 N·s/m`.
//!
//! A unit is a product of symbols with exponents, `·`, `*` or a space between factors and `/` before a
//! divisor: `kg/m³`, `N s/m`, `m/s^2`. Powers of ten go into the exponent of the number before it is
//! read, so that `50ms` is the same double as `0.05`. Study files, options of the command line and
//! arguments in Python are all read here.

use std::fmt;

/// Exponents of kilogram, metre, second, radian and ampere.
type Dimension = [i8; 5];

/// Metric prefixes with their powers of ten.
const PREFIXES: &[(&str, i32)] = &[
    ("n", -9),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("m", -3),
    ("c", -2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
];

/// A symbol: its size in SI as power of ten, numerator and denominator, its dimension, whether it takes a prefix.
type Symbol = (&'static str, i32, [f64; 2], Dimension, bool);

/// Symbols of units. A frequency counts cycles: 60 rpm are 1 Hz.
const SYMBOLS: &[Symbol] = &[
    ("1", 0, [1.0, 1.0], [0, 0, 0, 0, 0], false),
    ("%", -2, [1.0, 1.0], [0, 0, 0, 0, 0], false),
    ("g", -3, [1.0, 1.0], [1, 0, 0, 0, 0], true),
    ("m", 0, [1.0, 1.0], [0, 1, 0, 0, 0], true),
    ("s", 0, [1.0, 1.0], [0, 0, 1, 0, 0], true),
    ("min", 0, [60.0, 1.0], [0, 0, 1, 0, 0], false),
    ("h", 0, [3600.0, 1.0], [0, 0, 1, 0, 0], false),
    ("N", 0, [1.0, 1.0], [1, 1, -2, 0, 0], true),
    ("Nm", 0, [1.0, 1.0], [1, 2, -2, 0, 0], true),
    ("Ns", 0, [1.0, 1.0], [1, 1, -1, 0, 0], true),
    ("Pa", 0, [1.0, 1.0], [1, -1, -2, 0, 0], true),
    // The international inch and foot, and the pound-force: the avoirdupois pound under standard gravity. "Pound" alone is a mass or a force.
    ("in", 0, [127.0, 5000.0], [0, 1, 0, 0, 0], false),
    ("ft", 0, [381.0, 1250.0], [0, 1, 0, 0, 0], false),
    ("lbf", 0, [8_896_443_230_521.0, 2e12], [1, 1, -2, 0, 0], false),
    ("W", 0, [1.0, 1.0], [1, 2, -3, 0, 0], true),
    ("Hz", 0, [1.0, 1.0], [0, 0, -1, 0, 0], true),
    ("rpm", 0, [1.0, 60.0], [0, 0, -1, 0, 0], false),
    ("rad", 0, [1.0, 1.0], [0, 0, 0, 1, 0], true),
    ("deg", 0, [std::f64::consts::PI, 180.0], [0, 0, 0, 1, 0], false),
    ("°", 0, [std::f64::consts::PI, 180.0], [0, 0, 0, 1, 0], false),
    ("A", 0, [1.0, 1.0], [0, 0, 0, 0, 1], true),
    ("V", 0, [1.0, 1.0], [1, 2, -3, 0, -1], true),
    ("Ω", 0, [1.0, 1.0], [1, 2, -3, 0, -2], true),
    ("Ohm", 0, [1.0, 1.0], [1, 2, -3, 0, -2], true),
    ("F", 0, [1.0, 1.0], [-1, -2, 4, 0, 2], true),
    ("H", 0, [1.0, 1.0], [1, 2, -2, 0, -2], true),
];

/// A unit: 10^ten · over/under times the SI units of its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Unit {
    ten: i32,
    over: f64,
    under: f64,
    dimension: Dimension,
}

/// Why a text is not a number in the requested unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unread {
    /// It does not start with a number.
    NotANumber,
    /// What follows the number is not a unit.
    UnknownUnit(String),
    /// The unit has another dimension.
    OtherDimension(String),
    /// A unit for a dimensionless number, in a study without SI.
    NoUnitHere(String),
}

impl fmt::Display for Unread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber => write!(f, "the value does not start with a number"),
            Self::UnknownUnit(unit) => write!(f, "{unit} is not a unit"),
            Self::OtherDimension(unit) => write!(f, "{unit} is a unit of another quantity"),
            Self::NoUnitHere(unit) => write!(f, "no unit is allowed here, got {unit}"),
        }
    }
}

/// Reads a number in the unit `wanted`: a plain number is in that unit already, one with a unit is converted to it.
/// `None` stands for a dimensionless number.
///
/// # Errors
/// [`Unread`], if the text is not a number, or its unit is unknown or has another dimension.
pub fn read(text: &str, wanted: Option<&str>) -> Result<f64, Unread> {
    let text = text.trim();
    let (number, rest) = text.split_at(length_of_number(text));
    let unit = rest.trim();
    if unit.is_empty() {
        return text.parse().map_err(|_| Unread::NotANumber);
    }
    let plain: f64 = number.parse().map_err(|_| Unread::NotANumber)?;
    let given = Unit::parse(unit).ok_or_else(|| Unread::UnknownUnit(unit.to_owned()))?;
    let Some(wanted) = wanted.and_then(Unit::parse) else {
        return Err(Unread::NoUnitHere(unit.to_owned()));
    };
    if given.dimension != wanted.dimension {
        return Err(Unread::OtherDimension(unit.to_owned()));
    }
    let shifted = shifted(number, given.ten - wanted.ten).unwrap_or(plain);
    Ok(shifted * (given.over * wanted.under) / (given.under * wanted.over))
}

/// Converts a value to another unit; `None` if the dimensions differ.
pub fn convert(value: f64, from: &str, to: &str) -> Option<f64> {
    if from == to {
        return Some(value);
    }
    let (from, to) = (Unit::parse(from)?, Unit::parse(to)?);
    let tens = libm::pow(10.0, f64::from(from.ten - to.ten));
    let size = tens * (from.over * to.under) / (from.under * to.over);
    (from.dimension == to.dimension).then_some(value * size)
}

/// Whether a text is a unit.
pub fn is_unit(text: &str) -> bool {
    !text.trim().is_empty() && Unit::parse(text).is_some()
}

/// Splits a finite number from the text after it, which may be a unit; `None` if it does not start with a number.
pub fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let (number, unit) = text.split_at(length_of_number(text));
    let number: f64 = number.parse().ok().filter(|number: &f64| number.is_finite())?;
    Some((number, unit.trim()))
}

/// A number with a unit multiplied by a factor, in the same unit; `None` if the text is something else.
pub fn scaled(text: &str, factor: f64) -> Option<String> {
    let text = text.trim();
    let (number, unit) = text.split_at(length_of_number(text));
    let known = !unit.trim().is_empty() && Unit::parse(unit.trim()).is_some();
    let number: f64 = number.parse().ok().filter(|_| known)?;
    Some(format!("{:?} {}", factor * number, unit.trim()))
}

/// The number at the start of a text, without regard to its unit.
pub fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    text[..length_of_number(text)].parse().ok().filter(|number: &f64| number.is_finite())
}

/// Whether a text is a number followed by something that may be a unit.
pub fn has_unit(text: &str) -> bool {
    let text = text.trim();
    let length = length_of_number(text);
    length > 0 && !text[length..].trim().is_empty()
}

/// Length of the decimal number at the start of a text; 0 if it does not start with one.
fn length_of_number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        bytes[from.min(bytes.len())..].iter().take_while(|byte| byte.is_ascii_digit()).count()
    };
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(sign);
    let mut end = sign + whole;
    let mut fraction = 0;
    if bytes.get(end) == Some(&b'.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return 0;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > 0 {
            end += 1 + sign + exponent;
        }
    }
    end
}

/// A decimal number times a power of ten, rounded once.
fn shifted(number: &str, by: i32) -> Option<f64> {
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let exponent = exponent.parse::<i32>().ok()?.checked_add(by)?;
    format!("{mantissa}e{exponent}").parse().ok()
}

impl Unit {
    /// Reads a product of symbols; `None` if it is not one.
    fn parse(text: &str) -> Option<Self> {
        let mut product = Self { ten: 0, over: 1.0, under: 1.0, dimension: [0; 5] };
        let mut divides = false;
        let mut rest = text.trim();
        while !rest.is_empty() {
            let end = rest.find(['·', '⋅', '*', '/', ' ']).unwrap_or(rest.len());
            product.times(&rest[..end], divides)?;
            rest = rest[end..].trim_start();
            divides = rest.starts_with('/');
            if let Some(next) = rest.strip_prefix(['·', '⋅', '*', '/']) {
                rest = next.trim_start();
                if rest.is_empty() {
                    return None;
                }
            }
        }
        Some(product)
    }

    /// Multiplies by a symbol with its exponent, or divides by it.
    fn times(&mut self, factor: &str, divides: bool) -> Option<()> {
        let (symbol, exponent) = exponent(factor);
        let (ten, [over, under], dimension) = symbol_of(symbol)?;
        for _ in 0..exponent {
            let (over, under) = if divides { (under, over) } else { (over, under) };
            self.ten += if divides { -ten } else { ten };
            self.over *= over;
            self.under *= under;
            for (sum, part) in self.dimension.iter_mut().zip(dimension) {
                *sum = sum.checked_add(if divides { -part } else { part })?;
            }
        }
        Some(())
    }
}

/// Splits a factor into symbol and exponent: `m³`, `m^3` and `m3` all mean m cubed.
fn exponent(factor: &str) -> (&str, u8) {
    for (suffix, exponent) in [("²", 2), ("³", 3), ("2", 2), ("3", 3)] {
        if let Some(symbol) = factor.strip_suffix(suffix) {
            let symbol = symbol.trim_end_matches('^');
            if !symbol.is_empty() {
                return (symbol, exponent);
            }
        }
    }
    (factor, 1)
}

/// Power of ten, numerator and denominator, and dimension of a symbol with or without a prefix.
fn symbol_of(text: &str) -> Option<(i32, [f64; 2], Dimension)> {
    if let Some(&(_, ten, size, dimension, _)) = SYMBOLS.iter().find(|symbol| symbol.0 == text) {
        return Some((ten, size, dimension));
    }
    PREFIXES.iter().find_map(|&(prefix, more)| {
        let symbol = text.strip_prefix(prefix)?;
        let prefixed = |known: &&Symbol| known.4 && known.0 == symbol;
        let &(_, ten, size, dimension, _) = SYMBOLS.iter().find(prefixed)?;
        Some((ten + more, size, dimension))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_to_the_last_digit() {
        for (text, wanted, value) in [
            ("5.7kN", "N", 5700.0),
            ("50ms", "s", 0.05),
            ("0.36 km/h", "m/s", 0.1),
            ("1um", "m", 1e-6),
            ("1µm", "m", 1e-6),
            ("-3e-2 mm", "m", -3e-5),
            ("50mm/s", "m/s", 0.05),
            ("20kHz", "Hz", 20_000.0),
            ("600rpm", "Hz", 10.0),
            ("10Hz", "rpm", 600.0),
            ("15.8 N s/m", "N·s/m", 15.8),
            ("15.8Ns/m", "N·s/m", 15.8),
            ("1 kN*s/m", "N·s/m", 1000.0),
            ("6.19e8N/m", "N/m", 6.19e8),
            ("0.619 kN/um", "N/m", 6.19e8),
            ("200GPa", "Pa", 2e11),
            ("500g", "kg", 0.5),
            ("7.8 g/cm³", "kg/m³", 7800.0),
            ("7800kg/m3", "kg/m³", 7800.0),
            ("180deg", "rad", std::f64::consts::PI),
            ("90°", "deg", 90.0),
            ("2%", "1", 0.02),
            ("2min", "s", 120.0),
            ("3.1uF", "F", 3.1e-6),
            ("20 mA", "A", 0.02),
            ("1.2kV", "V", 1200.0),
            ("12 W/A", "V", 12.0),
            ("5 V·s/A", "mH", 5000.0),
            ("8Ohm", "V/A", 8.0),
            ("24 N/A", "N/A", 24.0),
            ("9.84mNm", "N m", 9.84e-3),
            ("32 % kNm", "Nm", 320.0),
            ("0.1", "N", 0.1),
            ("1e3", "Hz", 1e3),
            ("3 cm", "m", 0.03),
            ("2 lbf", "N", 8.896_443_230_521),
            ("4 in/s", "m/s", 0.101_6),
            ("3 in", "m", 0.076_2),
            ("100 lbf/in", "N/m", 17_512.683_524_647_637),
        ] {
            assert_eq!(read(text, Some(wanted)), Ok(value), "{text} in {wanted}");
        }
    }

    #[test]
    fn what_is_no_number_of_the_unit_is_refused() {
        assert_eq!(read("3m", Some("s")), Err(Unread::OtherDimension("m".into())));
        assert_eq!(read("3 rad", Some("Hz")), Err(Unread::OtherDimension("rad".into())));
        assert_eq!(read("5kN", None), Err(Unread::NoUnitHere("kN".into())));
        for (text, unit) in
            [("3parsec", "parsec"), ("3N/", "N/"), ("3 kmin", "kmin"), ("3nan", "nan")]
        {
            assert_eq!(read(text, Some("s")), Err(Unread::UnknownUnit(unit.into())), "{text}");
        }
        for text in ["", "s", "fast", "--json", "e3", ".", "-"] {
            assert_eq!(read(text, Some("s")), Err(Unread::NotANumber), "{text}");
        }
        assert_eq!(convert(600.0, "rpm", "Hz"), Some(10.0));
        assert_eq!(convert(1.0, "N", "m"), None);
        assert!(has_unit("5kN") && has_unit("5 ?") && !has_unit("5e3") && !has_unit("kN"));
    }
}
