//! Rigid motions of free structures, each listed once.
//!
//! A motion r with Kr = 0 and Cr = 0 has the eigenvalue 0 twice, with a single vector (r, 0): r itself and rt. Rounding splits the pair
//! into ±iδ, which are one mode with its conjugate, or into ±δ, which are two motions that the structure does not have. The number of
//! these motions is that of the independent r, which elimination finds; the spectrum has two eigenvalues near 0 for each.

use num_complex::Complex64;
use quell_numerics::matrix::Matrix;
use quell_numerics::polar::modulus;

use crate::linearised::Linearised;
use crate::spectrum::SmallMotion;

/// Share of its terms, for each coordinate, below which a sum of elimination is rounding.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Largest size of an eigenvalue that is 0 without rounding, relative to the largest eigenvalue: more than √`ROUNDING` for 1000 coordinates.
const SPLIT: f64 = 1e-3;

/// Share of the cancellation in Kφ below which a real pair ±δ is rounding of a file, whose numbers have ten digits.
const OF_FILES: f64 = 1e-9;

/// All motions of a structure without friction, each rigid one once, with λ = 0.
///
/// `motions` are all of its spectrum, complex conjugates included. Those of an elastic structure and of first-order equations are
/// returned as they are.
#[must_use]
pub fn rigid_once(linear: &Linearised, motions: Vec<SmallMotion>) -> Vec<SmallMotion> {
    let Some(matrices) = linear.matrices() else { return motions };
    let motions = exact(null_space([matrices.stiffness, matrices.damping]), motions);
    rounded([matrices.stiffness, matrices.damping], motions)
}

/// The motions with λ = 0 for each shape, in place of the two eigenvalues nearest to 0.
fn exact(shapes: Vec<Vec<f64>>, mut motions: Vec<SmallMotion>) -> Vec<SmallMotion> {
    let size = |motion: &SmallMotion| modulus(motion.eigenvalue);
    let mut sizes: Vec<f64> = motions.iter().map(size).collect();
    sizes.sort_by(f64::total_cmp);
    let count = 2 * shapes.len();
    let (Some(split), Some(largest)) = (sizes.get(count.wrapping_sub(1)), sizes.last()) else {
        return motions;
    };
    if *split > SPLIT * largest {
        return motions;
    }
    let mut left = count;
    motions.retain(|motion| {
        let is_near = left > 0 && size(motion) <= *split;
        left -= usize::from(is_near);
        !is_near
    });
    motions.extend(shapes.into_iter().map(|shape| {
        let shape = shape.into_iter().map(|x| Complex64::new(x, 0.0)).collect();
        resting(shape, *split)
    }));
    motions
}

/// The motions without those of positive real λ whose forces cancel up to the digits of a file; the others of their pairs have λ = 0.
fn rounded(matrices: [&Matrix; 2], motions: Vec<SmallMotion>) -> Vec<SmallMotion> {
    let is_rounding = |motion: &SmallMotion| {
        motion.eigenvalue.im == 0.0
            && motion.eigenvalue.re != 0.0
            && matrices.iter().all(|matrix| cancels(matrix, &motion.shape))
    };
    let kept = motions.into_iter().filter_map(|motion| match motion.eigenvalue.re > 0.0 {
        _ if !is_rounding(&motion) => Some(motion),
        true => None,
        false => {
            let error = modulus(motion.eigenvalue);
            Some(resting(motion.shape, error))
        }
    });
    kept.collect()
}

/// A motion that stays where it is put.
fn resting(shape: Vec<Complex64>, error: f64) -> SmallMotion {
    let eigenvalue = Complex64::new(0.0, 0.0);
    SmallMotion { eigenvalue, error, shape, friction_shares: Vec::new() }
}

/// Whether the terms of Aφ cancel up to the digits of a file; true of A = 0.
fn cancels(matrix: &Matrix, shape: &[Complex64]) -> bool {
    let (mut sum, mut terms) = (0.0_f64, 0.0_f64);
    for row in 0..shape.len() {
        let entries = || matrix.row(row).iter().zip(shape);
        sum = sum.max(modulus(entries().map(|(a, x)| x * *a).sum()));
        terms = terms.max(entries().map(|(a, x)| a.abs() * modulus(*x)).sum());
    }
    sum <= OF_FILES * terms
}

/// Independent r with Ar = 0 for both matrices, largest entry 1, by elimination with complete pivoting.
///
/// Every entry carries the sum of its terms; where it is only rounding of these it is 0.
fn null_space(matrices: [&Matrix; 2]) -> Vec<Vec<f64>> {
    let n = matrices[0].columns();
    let rows = matrices.iter().flat_map(|matrix| (0..matrix.rows()).map(|i| matrix.row(i)));
    let mut rows: Vec<[Vec<f64>; 2]> = rows.filter_map(scaled_row).collect();
    let mut order: Vec<usize> = (0..n).collect();
    let rounding = ROUNDING * n as f64;
    let mut rank = 0;
    while let Some((row, column)) = largest_entry(&rows, rank, &order, rounding) {
        rows.swap(rank, row);
        order.swap(rank, column);
        let (done, left) = rows.split_at_mut(rank + 1);
        let (pivot_row, pivot) = (&done[rank], done[rank][0][order[rank]]);
        for [values, terms] in left {
            let factor = values[order[rank]] / pivot;
            if factor != 0.0 {
                for &j in &order[rank..] {
                    values[j] -= factor * pivot_row[0][j];
                    terms[j] += factor.abs() * pivot_row[1][j];
                }
            }
        }
        rank += 1;
    }
    order[rank..].iter().map(|&free| back_substituted(&rows, &order[..rank], free, n)).collect()
}

/// A row with its largest entry 1, and the sizes of its terms; `None` for a row of zeros.
fn scaled_row(row: &[f64]) -> Option<[Vec<f64>; 2]> {
    let largest = row.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let scaled: Vec<f64> = row.iter().map(|x| x / largest).collect();
    (largest > 0.0).then(|| [scaled.clone(), scaled.iter().map(|x| x.abs()).collect()])
}

/// Row and place in the order of the largest entry that is left and is more than rounding.
fn largest_entry(
    rows: &[[Vec<f64>; 2]],
    rank: usize,
    order: &[usize],
    rounding: f64,
) -> Option<(usize, usize)> {
    let mut found = None;
    let mut largest = 0.0;
    for (i, [values, terms]) in rows.iter().enumerate().skip(rank) {
        for (place, &j) in order.iter().enumerate().skip(rank) {
            let size = values[j].abs();
            if size > largest && size > rounding * terms[j] {
                (found, largest) = (Some((i, place)), size);
            }
        }
    }
    found
}

/// The solution with 1 at one free column and 0 at the others, scaled to a largest entry of 1.
fn back_substituted(rows: &[[Vec<f64>; 2]], pivots: &[usize], free: usize, n: usize) -> Vec<f64> {
    let mut shape = vec![0.0; n];
    shape[free] = 1.0;
    for (rank, &column) in pivots.iter().enumerate().rev() {
        let values = &rows[rank][0];
        let others = pivots[rank + 1..].iter().chain([&free]);
        let sum: f64 = others.map(|&j| values[j] * shape[j]).sum();
        shape[column] = -sum / values[column];
    }
    let largest = shape.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0);
    shape.iter().map(|x| x / largest).collect()
}

#[cfg(test)]
mod tests {
    use quell_model::System;
    use quell_model::system::{MassMatrix, Mechanical};

    use super::*;
    use crate::spectrum::spectrum;

    /// The frequencies |λ| of a structure as `modes` lists them, ascending.
    fn frequencies(mass: &[f64], stiffness: Matrix, damping: Matrix) -> Vec<f64> {
        let size = mass.len();
        let names = (0..size).map(|i| format!("x{i}")).collect();
        let masses = MassMatrix::dense(diagonal(mass));
        let structure = Mechanical::new(names, masses, damping, stiffness);
        let system =
            System { structure: structure.into(), contacts: Vec::new(), inputs: Vec::new() };
        let linear = Linearised::frictionless(&system).expect("a mass");
        let all = spectrum(&linear, &[]).expect("finite").motions;
        let once = rigid_once(&linear, all);
        let mut found: Vec<f64> = once
            .iter()
            .filter(|motion| motion.eigenvalue.im >= 0.0)
            .map(|motion| modulus(motion.eigenvalue))
            .collect();
        found.sort_by(f64::total_cmp);
        found
    }

    fn diagonal(entries: &[f64]) -> Matrix {
        let size = entries.len();
        Matrix::from_fn(size, size, |i, j| if i == j { entries[i] } else { 0.0 })
    }

    fn chain(size: usize) -> Matrix {
        Matrix::from_fn(size, size, |i, j| match i.abs_diff(j) {
            0 if i == 0 || i + 1 == size => 1.0,
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        })
    }

    #[test]
    fn a_free_chain_has_as_many_modes_as_masses() {
        for size in [2, 3, 4, 5, 6, 12, 23, 40] {
            let mass: Vec<f64> = (0..size).map(|i| 1.0 + 0.1 * i as f64).collect();
            let found = frequencies(&mass, chain(size), Matrix::zeros(size, size));
            assert_eq!(found.len(), size, "{found:?}");
            assert_eq!(found[0], 0.0);
            assert!(found[1] > 1e-3, "{found:?}");
        }
        let found = frequencies(&[1.0, 1.1, 1.2], chain(3), Matrix::zeros(3, 3));
        // From the quadratic of the two elastic motions.
        assert!((found[1] - 0.955_434_6).abs() < 1e-6 && (found[2] - 1.654_89).abs() < 1e-5);
    }

    #[test]
    fn each_of_several_rigid_motions_is_listed_once() {
        let size = 9;
        let stiffness = Matrix::from_fn(size, size, |i, j| {
            if i / 3 == j / 3 { chain(3)[(i % 3, j % 3)] } else { 0.0 }
        });
        let mass: Vec<f64> = (0..size).map(|i| 1.0 + 0.3 * i as f64).collect();
        for factor in [0.0, 1e-3] {
            let mut damping = Matrix::zeros(size, size);
            damping.add_scaled(factor, &stiffness);
            let found = frequencies(&mass, stiffness.clone(), damping);
            assert_eq!(found.len(), size, "{found:?}");
            assert_eq!(found.iter().filter(|f| **f == 0.0).count(), 3, "{found:?}");
        }
    }

    #[test]
    fn modal_coordinates_have_as_many_modes() {
        let natural = [0.0, 0.0, 0.0, 0.0, 0.0, 1e-5, 73.0, 73.0, 1032.0, 1054.0, 2581.0];
        let stiffness: Vec<f64> = natural.iter().map(|w| w * w).collect();
        let damping: Vec<f64> = natural.iter().map(|w| 0.02 * w).collect();
        let found = frequencies(&[1.0; 11], diagonal(&stiffness), diagonal(&damping));
        assert_eq!(found.len(), 11, "{found:?}");
        assert_eq!(found.iter().filter(|f| **f == 0.0).count(), 5, "{found:?}");
    }

    #[test]
    fn matrices_with_ten_digits_and_a_single_free_mass_have_rigid_motions() {
        let mut stiffness = chain(3);
        stiffness[(1, 1)] -= 1e-10;
        assert_eq!(frequencies(&[1.0, 1.1, 1.2], stiffness.clone(), Matrix::zeros(3, 3)).len(), 3);
        stiffness[(1, 1)] += 3e-10;
        assert_eq!(frequencies(&[1.0, 1.1, 1.2], stiffness.clone(), Matrix::zeros(3, 3)).len(), 3);
        assert_eq!(frequencies(&[2.0], Matrix::zeros(1, 1), Matrix::zeros(1, 1)), [0.0]);
    }

    #[test]
    fn what_is_not_free_is_unchanged() {
        let mut held = chain(3);
        held[(0, 0)] += 1e-6;
        let found = frequencies(&[1.0, 1.0, 1.0], held, Matrix::zeros(3, 3));
        assert!((found[0] - (1e-6_f64 / 3.0).sqrt()).abs() < 1e-8, "{found:?}");
        // A damper to the ground: λ = 0 and −c/m are motions of their own; negative stiffness: ±1.
        let damper = Matrix::identity(1);
        assert_eq!(frequencies(&[1.0], Matrix::zeros(1, 1), damper), [0.0, 1.0]);
        let falling = Matrix::from_fn(1, 1, |_, _| -1.0);
        assert_eq!(frequencies(&[1.0], falling, Matrix::zeros(1, 1)).len(), 2);
    }
}
