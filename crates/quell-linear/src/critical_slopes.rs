//! The slopes of friction at which small motions change their verdict, without a search.
//!
//! Where friction acts on small motions only through the slope T_γ of a single contact (it has no normal spring and no slope row, and
//! no bristles), their matrix is A − T_γ b tᵀ, a feedback of rank one. It has the eigenvalue iω exactly if
//!
//! ```text
//! 1 + T_γ H(iω) = 0,    H(s) = tᵀ(s − A)⁻¹b,
//! ```
//!
//! so that H(iω) is real, and iω a zero of G(s) = H(s) − H(−s). The zeros of sG(s), whose direct term D = 2tᵀb does not vanish
//! for a structure with mass, are eigenvalues of
//!
//! ```text
//! Z = Â − B CÂ/D,    Â = diag(A, −A),    B = (b, b),    C = (tᵀ, tᵀ).
//! ```
//!
//! With Z x = s x and u = −CÂx/D, the first half of x is (s − A)⁻¹b u, hence T_γ = −u/(tᵀx₁). Every eigenvalue near the axis is a
//! candidate, and the verdict between neighbouring slopes is that of the eigenvalues of small motions themselves: a candidate too
//! many costs one more of them, and changes nothing.

use num_complex::Complex64;
use quell_numerics::eigen::Decomposition;
use quell_numerics::matrix::Matrix;
use quell_numerics::order::ascending;
use quell_numerics::polar::modulus;

use crate::growth::Verdict;
use crate::linearised::{FrictionSlopes, LinearContact, Linearised};
use crate::spectrum::growth;

/// Distance of a candidate from the imaginary axis over its modulus. Rounding moves a double zero by the square root of 10⁻¹⁶; the rest
/// is a margin, for a candidate too many changes nothing, and one that is missed would join two intervals of different verdicts.
const NEAR_THE_AXIS: f64 = 1e-5;

/// Slopes closer than this share of the largest are one: some hundred roundings, within which the eigenvalues decide nothing.
const SAME: f64 = 1e-13;

/// The slopes T_γ at which small motions may change their verdict, and the verdict between them.
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalSlopes {
    /// Ascending.
    slopes: Vec<f64>,
    /// Whether small motions grow below the first slope, between neighbours, and above the last.
    grows: Vec<bool>,
}

impl CriticalSlopes {
    /// Those of a sliding system; `None` if friction acts on small motions by more than one slope, or if the matrix is degenerate.
    pub fn of(linear: &Linearised) -> Option<Self> {
        let (contact, tangent) = only_slope(linear)?;
        let frozen = FrictionSlopes { by_velocity: 0.0, ..*linear.friction().first()? };
        let matrix = linear.state_matrix_with(&[frozen]);
        let size = matrix.rows();
        let first = size - linear.coordinates();
        let over_states = |row: &[f64]| {
            let mut whole = vec![0.0; size];
            whole[first..first + row.len()].copy_from_slice(row);
            whole
        };
        let (column, row) = (over_states(contact.along()), over_states(tangent));
        let mut slopes = candidates(&matrix, &column, &row)?;
        slopes.push(0.0);
        ascending(&mut slopes);
        let largest = slopes.iter().fold(0.0, |most: f64, slope| most.max(slope.abs()));
        slopes.dedup_by(|a, b| (*a - *b).abs() <= SAME * largest);
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let mut between = vec![slopes[0] - scale];
        between.extend(slopes.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
        between.push(slopes[slopes.len() - 1] + scale);
        let grows = between.into_iter().map(|by_velocity| {
            let friction = FrictionSlopes { by_velocity, ..frozen };
            Some(growth(linear, &[friction]).ok()?.verdict() == Verdict::Unstable)
        });
        let grows = grows.collect::<Option<Vec<bool>>>()?;
        Some(Self { slopes, grows })
    }

    /// How far a slope is from the nearest one at which the verdict changes: positive where small motions grow. It is continuous, and
    /// infinite where the verdict never changes.
    pub fn distance(&self, slope: f64) -> f64 {
        let here = self.slopes.partition_point(|critical| *critical < slope);
        let grows = self.grows[here];
        let above = (here..self.slopes.len()).find(|place| self.grows[place + 1] != grows);
        let below = (0..here).rev().find(|place| self.grows[*place] != grows);
        let to = |place: usize| (self.slopes[place] - slope).abs();
        let distance = above.map_or(f64::INFINITY, to).min(below.map_or(f64::INFINITY, to));
        if grows { distance } else { -distance }
    }
}

/// The contact through whose slope alone friction acts on small motions, and its row.
fn only_slope(linear: &Linearised) -> Option<(&LinearContact, &[f64])> {
    let [contact] = linear.contacts() else { return None };
    let has_more = contact.normal().is_some()
        || contact.slope_row().is_some()
        || linear.friction().iter().any(|friction| friction.bristles.is_some());
    if has_more { None } else { Some((contact, contact.tangent()?)) }
}

/// −1/H(iω) at every ω at which it is real, and further slopes; `None` where the direct term vanishes or the iteration fails.
fn candidates(matrix: &Matrix, column: &[f64], row: &[f64]) -> Option<Vec<f64>> {
    let n = matrix.rows();
    let direct = 2.0 * row.iter().zip(column).map(|(t, b)| t * b).sum::<f64>();
    if direct == 0.0 || !direct.is_finite() {
        return None;
    }
    // tᵀA: CÂ is this and its negative.
    let through: Vec<f64> =
        (0..n).map(|j| row.iter().enumerate().map(|(i, t)| t * matrix[(i, j)]).sum()).collect();
    let zeros = Matrix::from_fn(2 * n, 2 * n, |i, j| {
        let (half, other) = (i / n, j / n);
        let sign = if other == 0 { 1.0 } else { -1.0 };
        let own = if half == other { sign * matrix[(i % n, j % n)] } else { 0.0 };
        own - column[i % n] * sign * through[j % n] / direct
    });
    let decomposition = Decomposition::new(&zeros).ok()?;
    let mut found = Vec::new();
    // At s = 0, where Z has a double eigenvalue of its own, H(0) = −tᵀA⁻¹b directly.
    if let Some(still) = matrix.solve(&Matrix::from_fn(n, 1, |i, _| column[i])) {
        found.push(row.iter().zip(still.as_slice()).map(|(t, x)| t * x).sum::<f64>().recip());
    }
    for (index, value) in decomposition.values().iter().enumerate() {
        let size = modulus(*value);
        if value.im < 0.0 || value.re.abs() > NEAR_THE_AXIS * size {
            continue;
        }
        let state = decomposition.pair(index).right;
        let output = |row: &[f64], state: &[Complex64]| {
            row.iter().zip(state).map(|(entry, x)| x * *entry).sum::<Complex64>()
        };
        let input = -(output(&through, &state[..n]) - output(&through, &state[n..])) / direct;
        found.push(-(input / output(row, &state[..n])).re);
    }
    found.retain(|slope| slope.is_finite());
    Some(found)
}
