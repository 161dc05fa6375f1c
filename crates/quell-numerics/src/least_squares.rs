//! Linear least squares by Householder reflections, for tall systems of a few columns.
//!
//! An own implementation whose sums have a fixed order, so that a fit has the same bits on every machine.

/// Solution of min ‖A x − b‖ with its residuals.
#[derive(Clone, Debug, PartialEq)]
pub struct LeastSquares {
    /// x.
    pub solution: Vec<f64>,
    /// b − A x, row by row.
    pub residuals: Vec<f64>,
    /// Leverage of each row, 0…1: the diagonal of A(AᵀA)⁻¹Aᵀ.
    pub leverages: Vec<f64>,
}

/// Relative length of a column's orthogonal remainder below which the column is linearly dependent on the others.
const DEPENDENT: f64 = 1e-13;

/// Solves the problem for the columns of A, each as long as `data`, b; the solution has one entry per column. `None` if the
/// lengths differ, if there are more columns than rows, or if columns are linearly dependent to 10⁻¹³ of their length.
pub fn least_squares(columns: &[Vec<f64>], data: &[f64]) -> Option<LeastSquares> {
    let (rows, count) = (data.len(), columns.len());
    if count > rows || columns.iter().any(|column| column.len() != rows) {
        return None;
    }
    let mut triangle = columns.to_vec();
    let mut reflected = data.to_vec();
    let mut reflectors: Vec<Vec<f64>> = Vec::with_capacity(count);
    for j in 0..count {
        let whole = norm(&triangle[j]);
        let rest = norm(&triangle[j][j..]);
        if rest.is_nan() || rest <= DEPENDENT * whole {
            return None;
        }
        let mut reflector = vec![0.0; rows];
        reflector[j..].copy_from_slice(&triangle[j][j..]);
        reflector[j] += rest.copysign(triangle[j][j]);
        for column in triangle[j..].iter_mut().chain([&mut reflected]) {
            reflect(&reflector, column);
        }
        reflectors.push(reflector);
    }
    let mut solution = vec![0.0; count];
    for j in (0..count).rev() {
        let known: f64 = (j + 1..count).map(|k| triangle[k][j] * solution[k]).sum();
        solution[j] = (reflected[j] - known) / triangle[j][j];
    }
    let fitted = |row: usize| -> f64 { (0..count).map(|j| columns[j][row] * solution[j]).sum() };
    let residuals = (0..rows).map(|row| data[row] - fitted(row)).collect();
    // The leverages are the squared rows of the orthonormal columns Q = H₁H₂… eⱼ.
    let mut leverages = vec![0.0; rows];
    for j in 0..count {
        let mut column = vec![0.0; rows];
        column[j] = 1.0;
        for reflector in reflectors.iter().rev() {
            reflect(reflector, &mut column);
        }
        for (leverage, entry) in leverages.iter_mut().zip(column) {
            *leverage += entry * entry;
        }
    }
    Some(LeastSquares { solution, residuals, leverages })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// x − 2 r (r·x)/(r·r).
fn reflect(reflector: &[f64], column: &mut [f64]) {
    let share = 2.0 * dot(reflector, column) / dot(reflector, reflector);
    for (entry, r) in column.iter_mut().zip(reflector) {
        *entry -= share * r;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_fitted_with_its_leverages() {
        let x: Vec<f64> = (0..9).map(f64::from).collect();
        let columns = [vec![1.0; 9], x.clone()];
        let exact: Vec<f64> = x.iter().map(|x| 2.0 - 0.5 * x).collect();
        let found = least_squares(&columns, &exact).expect("independent");
        assert!((found.solution[0] - 2.0).abs() < 1e-14 && (found.solution[1] + 0.5).abs() < 1e-14);
        // Leverages of a line on nine equal steps: 1/9 + (i − 4)²/60; their sum is the rank.
        for (i, leverage) in found.leverages.iter().enumerate() {
            let away = i as f64 - 4.0;
            assert!((leverage - (1.0 / 9.0 + away * away / 60.0)).abs() < 1e-14);
        }
        // The residuals are orthogonal to the columns.
        let bent: Vec<f64> = x.iter().map(|x| x * x).collect();
        let left = least_squares(&columns, &bent).expect("independent").residuals;
        for column in &columns {
            assert!(dot(column, &left).abs() < 1e-12);
        }
    }

    #[test]
    fn problems_without_a_unique_solution_are_rejected() {
        let column = vec![1.0, 2.0, 3.0];
        assert_eq!(least_squares(&[column.clone(), column.clone()], &[1.0, 2.0, 3.0]), None);
        assert_eq!(least_squares(&[vec![1.0], vec![2.0]], &[1.0]), None);
        assert_eq!(least_squares(&[vec![0.0; 3]], &[1.0, 2.0, 3.0]), None);
    }
}
