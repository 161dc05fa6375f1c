//! Axes of quantities, with unit and metric prefix in a study in SI.

use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use crate::plot::PlotAxis;
use crate::study::{BeltStudy, SystemStudy, UnitSystem};

/// Units that take a metric prefix; the other ones already have a scale, or are squares and quotients.
const PREFIXED: &[&str] = &["N", "Hz", "W", "m", "m/s", "s"];

/// Metric prefixes from large to small.
const PREFIXES: &[(&str, f64)] = &[("k", 1e3), ("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9)];

/// Scale and unit of a quantity along an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ruler {
    /// Value along the axis of one dimensionless unit of the equations.
    factor: f64,
    /// Unit; empty for dimensionless numbers of the equations.
    unit: String,
}

impl Ruler {
    /// A ruler for values up to `largest` in magnitude (dimensionless).
    pub(super) fn scaled(study: &BeltStudy, quantity: Quantity, largest: f64) -> Self {
        let Some((si, unit)) = study.scales().and_then(|scales| scales.one(quantity)) else {
            return Self { factor: 1.0, unit: String::new() };
        };
        let ruler = Self::of_unit(unit, largest * si);
        Self { factor: si * ruler.factor, ..ruler }
    }

    /// A ruler for values in this unit up to `largest` in magnitude; an empty unit for dimensionless numbers.
    pub(super) fn of_unit(unit: &str, largest: f64) -> Self {
        let size = largest.abs();
        // The prefix kilo is not used for lengths and times.
        let kilo = matches!(unit, "N" | "Hz" | "W");
        let fits = |(prefix, scale): &&(&str, f64)| {
            PREFIXED.contains(&unit) && size >= *scale && (kilo || *prefix != "k")
        };
        let (prefix, scale) = PREFIXES.iter().find(fits).copied().unwrap_or(("", 1.0));
        Self { factor: scale.recip(), unit: format!("{prefix}{unit}") }
    }

    /// A ruler for these values of a quantity of a system, in the units of its study.
    pub(super) fn new(
        study: &SystemStudy,
        quantity: Quantity,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        let unit = study.units().unit(quantity).unwrap_or_default();
        match study.units() {
            UnitSystem::Si => Self::of_unit(unit, largest(values)),
            UnitSystem::None | UnitSystem::MmTonneSecond => {
                Self { factor: 1.0, unit: unit.to_owned() }
            }
        }
    }

    /// A ruler for the number of a system at a path, up to `largest` in magnitude.
    pub(super) fn of_path(study: &SystemStudy, path: &str, largest: f64) -> Self {
        let unit = study.unit_of(path).filter(|unit| *unit != "1").unwrap_or_default();
        match study.units() {
            UnitSystem::Si => Self::of_unit(unit, largest),
            UnitSystem::None | UnitSystem::MmTonneSecond => {
                Self { factor: 1.0, unit: unit.to_owned() }
            }
        }
    }

    /// The plot axis of a quantity.
    pub(super) fn axis(&self, name: &str, symbol: &str) -> PlotAxis {
        let axis = PlotAxis::new(name).symbol(symbol);
        if self.unit.is_empty() { axis } else { axis.unit(self.unit.clone()) }
    }

    /// Position of a value along the axis.
    pub(super) fn place(&self, value: f64) -> f64 {
        value * self.factor
    }

    /// Text of a value with its unit.
    pub(super) fn words(&self, value: f64) -> String {
        let number = short(self.place(value));
        if self.unit.is_empty() { number } else { format!("{number} {}", self.unit) }
    }
}

/// The largest finite magnitude.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(f64::abs).filter(|size| size.is_finite()).fold(0.0, f64::max)
}

/// A number with four significant digits.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.3e}");
    text.parse::<f64>().map_or(text, |rounded| rounded.to_string())
}

/// A value of a study with its unit, for captions and labels.
pub(super) fn words(study: &BeltStudy, quantity: Quantity, value: f64) -> String {
    Ruler::scaled(study, quantity, value).words(value)
}

/// The axis of time between two times, and its ruler.
pub(super) fn time_between(
    study: &SystemStudy,
    RealInterval { lower: from, upper: to }: RealInterval,
) -> (PlotAxis, Ruler) {
    let ruler = Ruler::new(study, Quantity::Time, [from, to]);
    let axis = ruler.axis("time", "t").between(ruler.place(from), ruler.place(to));
    (axis, ruler)
}
