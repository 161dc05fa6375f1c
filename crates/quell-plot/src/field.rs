//! Fields: one number at each point of a rectangular grid, for colour maps and isolines.

use super::axis::Scale;
use super::error::PlotError;
use super::geometry::{PlotPoint, PlotRange};

/// Values at the points of a rectangular grid whose steps need not be equal.
///
/// A point without a value is `None`; the layer that shows the field gives the reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    x: Vec<f64>,
    y: Vec<f64>,
    values: Vec<Option<f64>>,
}

impl Field {
    /// A field of `x.len() · y.len()` values in row-major order: the row of the least y first, x varying
    /// fastest. Non-finite values are treated as missing.
    ///
    /// # Errors
    /// [`PlotError::Field`] when an axis is empty, not finite or not strictly increasing, or
    /// when the number of values does not match.
    pub fn new(x: Vec<f64>, y: Vec<f64>, values: Vec<Option<f64>>) -> Result<Self, PlotError> {
        for (name, axis) in [("x", &x), ("y", &y)] {
            if axis.is_empty() {
                return Err(PlotError::Field { why: format!("the {name} axis has no values") });
            }
            if axis.iter().any(|value| !value.is_finite()) {
                return Err(PlotError::Field {
                    why: format!("the {name} axis has a value that is not finite"),
                });
            }
            let mut steps = axis.iter().zip(axis.iter().skip(1));
            if let Some((from, to)) = steps.find(|(from, to)| from >= to) {
                return Err(PlotError::Field {
                    why: format!("the {name} axis does not increase from {from} to {to}"),
                });
            }
        }
        if values.len() != x.len() * y.len() {
            return Err(PlotError::Field {
                why: format!("{} by {} points have {} values", x.len(), y.len(), values.len()),
            });
        }
        let values = values.into_iter().map(|value| value.filter(|value| value.is_finite()));
        Ok(Self { values: values.collect(), x, y })
    }

    /// A field whose value at column and row is `value(column, row)`.
    ///
    /// # Errors
    /// [`PlotError::Field`] when an axis is empty, not finite or not strictly increasing.
    pub fn from_fn(
        x: Vec<f64>,
        y: Vec<f64>,
        mut value: impl FnMut(usize, usize) -> Option<f64>,
    ) -> Result<Self, PlotError> {
        let points = (0..y.len()).flat_map(|row| (0..x.len()).map(move |column| (column, row)));
        let values = points.map(|(column, row)| value(column, row)).collect();
        Self::new(x, y, values)
    }

    /// Values of x, increasing.
    #[must_use]
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// Values of y, increasing.
    #[must_use]
    pub fn y(&self) -> &[f64] {
        &self.y
    }

    /// All values, row by row.
    #[must_use]
    pub fn values(&self) -> &[Option<f64>] {
        &self.values
    }

    /// Least and greatest value; `None` if the field has no values.
    #[must_use]
    pub fn extremes(&self) -> Option<PlotRange> {
        PlotRange::of(self.values.iter().flatten().copied())
    }

    /// The corners (x, y) of the grid.
    pub(super) fn corners(&self) -> [PlotPoint; 2] {
        let ends = |axis: &[f64]| {
            let first = axis.first().copied().unwrap_or(0.0);
            (first, axis.last().copied().unwrap_or(first))
        };
        let (x, y) = (ends(&self.x), ends(&self.y));
        [PlotPoint::new(x.0, y.0), PlotPoint::new(x.1, y.1)]
    }
}

/// Borders between the cells around these values, halfway between them along the axis: one more than the values.
///
/// The outer cells are symmetric about their values; the cell of a single value is unbounded.
/// On a logarithmic axis, values that are not positive lie infinitely far down.
pub(super) fn borders(values: &[f64], scale: Scale) -> Vec<f64> {
    let along = |value: f64| match scale {
        Scale::Linear => value,
        Scale::Log if value > 0.0 => libm::log10(value),
        Scale::Log => f64::NEG_INFINITY,
    };
    let positions: Vec<f64> = values.iter().map(|value| along(*value)).collect();
    let inner = positions.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let (first, last) = match positions.as_slice() {
        [first, second, ..] => {
            let count = positions.len();
            (
                first - 0.5 * (second - first),
                positions[count - 1] + 0.5 * (positions[count - 1] - positions[count - 2]),
            )
        }
        _ => (f64::NEG_INFINITY, f64::INFINITY),
    };
    // Two values at minus infinity have no midpoint; their cells are empty.
    let clean = |position: f64| if position.is_nan() { f64::NEG_INFINITY } else { position };
    std::iter::once(first).chain(inner).chain(std::iter::once(last)).map(clean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_rejects_invalid_grids() {
        let axis = || vec![0.0, 1.0];
        assert!(Field::new(axis(), axis(), vec![None; 4]).is_ok());
        for (x, y, count) in [
            (vec![], axis(), 0),
            (axis(), vec![1.0, 1.0], 4),
            (axis(), vec![1.0, 0.0], 4),
            (vec![0.0, f64::NAN], axis(), 4),
            (axis(), axis(), 3),
        ] {
            assert!(matches!(
                Field::new(x, y, vec![Some(1.0); count]),
                Err(PlotError::Field { .. })
            ));
        }
    }

    #[test]
    fn non_finite_values_are_missing() {
        let field = Field::new(vec![0.0, 1.0], vec![0.0], vec![Some(f64::NAN), Some(2.0)]);
        assert_eq!(field.expect("a field").extremes(), Some(PlotRange::new(2.0, 2.0)));
    }

    #[test]
    fn cells_end_halfway_between_neighbours() {
        assert_eq!(borders(&[0.0, 1.0, 3.0], Scale::Linear), vec![-0.5, 0.5, 2.0, 4.0]);
        assert_eq!(borders(&[1.0, 100.0], Scale::Log), vec![-1.0, 1.0, 3.0]);
        assert!(borders(&[0.0, 0.0, 1.0], Scale::Log).iter().all(|border| !border.is_nan()));
    }
}
