//! The equations of a system of few coordinates whose contacts are plain, as vectors of four numbers.

use super::contact_equation::ContactEquation;
use super::rows::{RowEntries, StateMatrix};

/// Most coordinates, and most contacts.
pub(super) const MOST: usize = 4;

/// A number of each coordinate, or of each contact; zeros in places without one.
pub(super) type Numbers = [f64; MOST];

/// The equations of such a system.
#[derive(Clone, Debug)]
pub(super) struct PlainEquations {
    pub(super) coordinates: usize,
    pub(super) contacts: usize,
    /// −M⁻¹K, column by column, then −M⁻¹C.
    pub(super) columns: [Numbers; 2 * MOST],
    pub(super) constant: Numbers,
    /// The column of the first force, of zeros where no force acts, and those of the others.
    pub(super) pushes: (Numbers, Vec<Numbers>),
    /// t of all contacts, coordinate by coordinate.
    pub(super) tangents: [Numbers; MOST],
    /// M⁻¹t, contact by contact.
    pub(super) along: [Numbers; MOST],
    pub(super) inverse_scales: Numbers,
    pub(super) static_coefficients: Numbers,
    pub(super) normal_loads: Numbers,
}

/// The lower half of a row or of a column over displacements and velocities; `None` if the upper one is not zero.
fn of_velocities(dense: &[f64], coordinates: usize) -> Option<Numbers> {
    let (upper, lower) = dense[..2 * coordinates].split_at(coordinates);
    upper.iter().all(|entry| *entry == 0.0).then(|| filled(lower))
}

/// Up to four numbers, then zeros.
pub(super) fn filled(numbers: &[f64]) -> Numbers {
    let mut out = [0.0; MOST];
    out[..numbers.len()].copy_from_slice(numbers);
    out
}

impl PlainEquations {
    /// Those of a system; `None` of one that is not such a system. Its loads are not looked at.
    pub(super) fn of(
        matrix: &StateMatrix,
        constant: &[f64],
        pushes: &[RowEntries],
        contacts: &[ContactEquation],
    ) -> Option<Self> {
        let (size, count) = (constant.len(), contacts.len());
        let coordinates = size / 2;
        let is_small = (1..=MOST).contains(&coordinates) && (1..=MOST).contains(&count);
        if !is_small || !size.is_multiple_of(2) {
            return None;
        }
        let mut columns = [[0.0; MOST]; 2 * MOST];
        for (j, column) in matrix.columns(size)?.chunks_exact(size).enumerate() {
            let (upper, lower) = column.split_at(coordinates);
            let follows =
                |(i, entry): (usize, &f64)| *entry == f64::from(u8::from(j == i + coordinates));
            if !upper.iter().enumerate().all(follows) {
                return None;
            }
            let place = if j < coordinates { j } else { MOST + j - coordinates };
            columns[place] = filled(lower);
        }
        let mut pushes = pushes.iter().map(|push| of_velocities(push.few(), coordinates));
        let first = pushes.next().unwrap_or(Some([0.0; MOST]))?;
        let pushes = (first, pushes.collect::<Option<_>>()?);
        let mut equations = Self {
            coordinates,
            contacts: count,
            columns,
            constant: of_velocities(constant, coordinates)?,
            pushes,
            tangents: [[0.0; MOST]; MOST],
            along: [[0.0; MOST]; MOST],
            inverse_scales: [0.0; MOST],
            static_coefficients: [0.0; MOST],
            normal_loads: [0.0; MOST],
        };
        for (place, contact) in contacts.iter().enumerate() {
            let is_rigid = contact.own.is_none() && contact.can_stick() && !contact.is_compliant();
            if !is_rigid || !contact.across.is_empty() || !contact.slope.is_empty() {
                return None;
            }
            let tangent = of_velocities(contact.tangent.few(), coordinates)?;
            for (row, entry) in equations.tangents.iter_mut().zip(tangent) {
                row[place] = entry;
            }
            equations.along[place] = of_velocities(contact.along.few(), coordinates)?;
            equations.inverse_scales[place] = contact.inverse_scale;
            equations.static_coefficients[place] = contact.static_coefficient;
            equations.normal_loads[place] = contact.normal_load;
        }
        Some(equations)
    }
}
