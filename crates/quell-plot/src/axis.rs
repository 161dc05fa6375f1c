//! Axes: name, symbol, unit, scale and limits of one coordinate.

use super::geometry::PlotRange;

/// Scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Linear.
    #[default]
    Linear,
    /// Logarithmic; values that are not positive are omitted.
    Log,
}

/// Limits of an axis: fixed, or determined by the layers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum AxisRange {
    /// The extent of the layers with a small margin.
    #[default]
    Auto,
    /// From the first to the second value.
    Between(f64, f64),
    /// A fixed lower limit; the layers determine the upper one.
    From(f64),
    /// A fixed upper limit; the layers determine the lower one.
    UpTo(f64),
}

/// One axis of a panel.
///
/// It prints as `name symbol (unit)`, with the symbol in italics: `slip velocity v_r (m/s)`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlotAxis {
    /// The quantity in words; may contain `$…$`.
    pub name: String,
    /// Its symbol in the syntax used between dollars, e.g. `v_r`; empty for none.
    pub symbol: String,
    /// Its unit; empty for a dimensionless quantity.
    pub unit: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// The limits.
    pub range: AxisRange,
    /// Values to label; `None` for automatic ticks.
    pub ticks: Option<Vec<f64>>,
}

impl PlotAxis {
    /// A linear axis for the quantity with this name.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Sets the symbol of the quantity, in the syntax used between dollars (`v_r`, `\bar{μ}`).
    #[must_use]
    pub fn symbol(mut self, symbol: impl Into<String>) -> Self {
        self.symbol = symbol.into();
        self
    }

    /// Sets the unit of the quantity.
    #[must_use]
    pub fn unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = unit.into();
        self
    }

    /// Makes the axis logarithmic.
    #[must_use]
    pub fn log(mut self) -> Self {
        self.scale = Scale::Log;
        self
    }

    /// Sets both limits.
    #[must_use]
    pub fn between(mut self, lower: f64, upper: f64) -> Self {
        self.range = AxisRange::Between(lower, upper);
        self
    }

    /// Sets the lower limit.
    #[must_use]
    pub fn from(mut self, lower: f64) -> Self {
        self.range = AxisRange::From(lower);
        self
    }

    /// Sets the upper limit.
    #[must_use]
    pub fn up_to(mut self, upper: f64) -> Self {
        self.range = AxisRange::UpTo(upper);
        self
    }

    /// Labels exactly these values.
    #[must_use]
    pub fn ticks(mut self, ticks: impl Into<Vec<f64>>) -> Self {
        self.ticks = Some(ticks.into());
        self
    }

    /// The whole label, before typesetting.
    pub(super) fn label(&self) -> String {
        let mut words = Vec::new();
        if !self.name.is_empty() {
            words.push(self.name.clone());
        }
        if !self.symbol.is_empty() {
            words.push(format!("${}$", self.symbol));
        }
        if !self.unit.is_empty() {
            words.push(format!("({})", self.unit));
        }
        words.join(" ")
    }

    /// The limits for layers of this extent (`None` if there are no layers).
    ///
    /// `margin` is the fraction of the length that is added at each end determined by the layers.
    pub(super) fn limits(&self, extent: Option<PlotRange>, margin: f64) -> PlotRange {
        let (fixed_lower, fixed_upper) = match self.range {
            AxisRange::Auto => (None, None),
            AxisRange::Between(lower, upper) => (Some(lower), Some(upper)),
            AxisRange::From(lower) => (Some(lower), None),
            AxisRange::UpTo(upper) => (None, Some(upper)),
        };
        let usable =
            |value: &f64| value.is_finite() && (self.scale == Scale::Linear || *value > 0.0);
        let (fixed_lower, fixed_upper) = (fixed_lower.filter(usable), fixed_upper.filter(usable));
        if let (Some(one), Some(other)) = (fixed_lower, fixed_upper)
            && one != other
        {
            return PlotRange::new(one.min(other), one.max(other));
        }
        let fallback = if self.scale == Scale::Log { (0.1, 1.0) } else { (0.0, 1.0) };
        let PlotRange { lower: least, upper: greatest } = extent.unwrap_or(PlotRange::new(
            fixed_lower
                .or(fixed_upper.map(|upper| self.step_away(upper, -1.0)))
                .unwrap_or(fallback.0),
            fixed_upper
                .or(fixed_lower.map(|lower| self.step_away(lower, 1.0)))
                .unwrap_or(fallback.1),
        ));
        if extent.is_none() && least < greatest {
            return PlotRange::new(least, greatest);
        }
        let (mut lower, mut upper) =
            (fixed_lower.unwrap_or(least), fixed_upper.unwrap_or(greatest));
        if lower > upper {
            (lower, upper) = match (fixed_lower, fixed_upper) {
                (Some(lower), None) => (lower, self.step_away(lower, 1.0)),
                (None, Some(upper)) => (self.step_away(upper, -1.0), upper),
                _ => (upper, lower),
            };
        }
        let width = self.along(upper) - self.along(lower);
        if width <= 1e-12 * self.along(upper).abs().max(self.along(lower).abs()) {
            return PlotRange::new(self.step_away(lower, -1.0), self.step_away(upper, 1.0));
        }
        // For a quantity that starts at zero (an amplitude, a time), the lower limit stays zero.
        let keeps_zero = self.scale == Scale::Linear && lower == 0.0;
        if fixed_lower.is_none() && !keeps_zero {
            lower = self.back(self.along(lower) - margin * width);
        }
        if fixed_upper.is_none() {
            upper = self.back(self.along(upper) + margin * width);
        }
        let rounded = self.round_ends(PlotRange::new(lower, upper));
        PlotRange::new(
            if fixed_lower.is_none() && !keeps_zero { rounded.lower } else { lower },
            if fixed_upper.is_none() { rounded.upper } else { upper },
        )
    }

    /// Moves the limits outwards to nearby round values: 99.999 becomes 100.
    fn round_ends(&self, PlotRange { lower, upper }: PlotRange) -> PlotRange {
        const CLOSE: f64 = 0.015;
        if self.scale == Scale::Log {
            return PlotRange::new(lower, upper);
        }
        let width = upper - lower;
        let step = libm::pow(10.0, libm::log10(width / 5.0).floor()) * 2.0;
        let (below, above) = ((lower / step).floor() * step, (upper / step).ceil() * step);
        PlotRange::new(
            if lower - below < CLOSE * width { below } else { lower },
            if above - upper < CLOSE * width { above } else { upper },
        )
    }

    /// Position of a value on the axis, before scaling to pixels.
    pub(super) fn along(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => libm::log10(value),
        }
    }

    fn back(&self, position: f64) -> f64 {
        match self.scale {
            Scale::Linear => position,
            Scale::Log => libm::pow(10.0, position),
        }
    }

    fn step_away(&self, value: f64, sign: f64) -> f64 {
        match self.scale {
            Scale::Linear if value == 0.0 => sign,
            Scale::Linear => value + sign * 0.1 * value.abs(),
            // An infinite limit, or zero, cannot be represented on the axis.
            Scale::Log => (value * libm::pow(2.0, sign)).clamp(f64::MIN_POSITIVE, f64::MAX),
        }
    }
}

/// Mapping of an axis: converts values to pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mapping {
    scale: Scale,
    origin: f64,
    slope: f64,
    first_pixel: f64,
    /// Least and greatest value shown.
    pub(super) limits: PlotRange,
}

impl Mapping {
    pub(super) fn new(
        axis: &PlotAxis,
        limits: PlotRange,
        first_pixel: f64,
        last_pixel: f64,
    ) -> Self {
        let origin = axis.along(limits.lower);
        let slope = (last_pixel - first_pixel) / (axis.along(limits.upper) - origin);
        Self { scale: axis.scale, origin, slope, first_pixel, limits }
    }

    /// Position on the axis, before scaling to pixels, of a pixel.
    pub(super) fn along(&self, pixel: f64) -> f64 {
        self.origin + (pixel - self.first_pixel) / self.slope
    }

    /// Pixel of a position on the axis before scaling; clamped far outside the frame.
    pub(super) fn pixel_of_position(&self, along: f64) -> f64 {
        (self.first_pixel + (along - self.origin) * self.slope).clamp(-1e5, 1e5)
    }

    /// Pixel of a value; `None` for a value that this axis cannot represent.
    pub(super) fn pixel(&self, value: f64) -> Option<f64> {
        let along = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => libm::log10(value),
            Scale::Log => return None,
        };
        let pixel = self.first_pixel + (along - self.origin) * self.slope;
        // Far outside the frame the exact coordinate is irrelevant.
        pixel.is_finite().then(|| pixel.clamp(-1e5, 1e5))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_snap_to_round_values_and_zero() {
        let axis = PlotAxis::new("time");
        assert_eq!(axis.limits(Some(PlotRange::new(0.0, 99.999)), 0.0), PlotRange::new(0.0, 100.0));
        assert_eq!(axis.limits(Some(PlotRange::new(0.0, 93.0)), 0.0), PlotRange::new(0.0, 93.0));
        assert_eq!(
            axis.clone().up_to(50.0).limits(Some(PlotRange::new(-1.0, 99.0)), 0.0).upper,
            50.0
        );
    }

    #[test]
    fn limits_are_finite_and_distinct() {
        for axis in [
            PlotAxis::new("x"),
            PlotAxis::new("x").log(),
            PlotAxis::new("x").from(5.0),
            PlotAxis::new("x").between(2.0, 2.0),
        ] {
            for extent in [None, Some((3.0, 3.0)), Some((1e-300, 1e-300)), Some((0.5, 1.0))] {
                let extent = extent.map(|(lower, upper)| PlotRange { lower, upper });
                let PlotRange { lower, upper } = axis.limits(extent, 0.05);
                assert!(
                    lower < upper && lower.is_finite() && upper.is_finite(),
                    "{axis:?} {extent:?}"
                );
            }
        }
    }

    #[test]
    fn reversed_limits_are_swapped() {
        assert_eq!(
            PlotAxis::new("x").between(3.0, 1.0).limits(Some(PlotRange::new(0.0, 9.0)), 0.1),
            PlotRange::new(1.0, 3.0)
        );
    }

    #[test]
    fn a_log_axis_omits_values_that_are_not_positive() {
        let mapping =
            Mapping::new(&PlotAxis::new("x").log(), PlotRange::new(1.0, 100.0), 0.0, 200.0);
        assert_eq!(mapping.pixel(0.0), None);
        assert!((mapping.pixel(10.0).unwrap_or(f64::NAN) - 100.0).abs() < 1e-9);
    }
}
