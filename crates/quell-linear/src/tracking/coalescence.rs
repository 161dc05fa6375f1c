//! Coalescence of two eigenvalues: mode coupling.
//!
//! The square of the difference of two eigenvalues, (λᵢ − λⱼ)², is analytic through a coalescence, where they are not. While both
//! are on one line (two frequencies of equal decay) it is negative, beyond (one frequency, two growth rates) positive: its zero
//! is simple and is found as accurately as any root.

use num_complex::Complex64;
use quell_numerics::order::ascending_by;
use quell_numerics::polar::modulus;
use quell_numerics::roots::{Closeness, find_root};

use super::family::{Family, TrackedPoint, at};

/// The imaginary part of (λᵢ − λⱼ)² over its real part below which the two are on a common line: exactly zero there, up to the
/// rounding of close eigenvalues. Unequal damping, which leaves no coalescence, is far above.
const ON_A_LINE: f64 = 1e-6;

/// Distance over the frequency, squared, below which two eigenvalues may coalesce within a step; matching has made steps short
/// long before.
const NEAR: f64 = 1e-2;

/// A coalescence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coalescence {
    pub(super) value: f64,
    pub(super) error: f64,
    /// The double eigenvalue.
    pub(super) eigenvalue: Complex64,
}

/// Every coalescence of two oscillating motions between neighbouring points.
pub(super) fn of_piece<F: Family>(family: &F, piece: &[TrackedPoint]) -> Vec<Coalescence> {
    let mut found: Vec<Coalescence> = Vec::new();
    for pair in piece.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let n = a.eigenvalues.len();
        for i in 0..n {
            for j in 0..i {
                if !is_candidate(a, b, (i, j)) {
                    continue;
                }
                let middle = 0.5 * (a.eigenvalues[i] + a.eigenvalues[j]);
                let square = |value: f64| square_near(family, value, middle);
                let Ok(root) = find_root(square, a.value, b.value, Closeness::default()) else {
                    continue;
                };
                let known = found.iter().any(|known| {
                    (known.value - root.location).abs()
                        <= 1e-9 * (b.value - a.value).abs().max(root.location.abs())
                        && modulus(known.eigenvalue - middle) <= NEAR * modulus(middle)
                });
                if !known {
                    found.push(Coalescence {
                        value: root.location,
                        error: root.width,
                        eigenvalue: middle,
                    });
                }
            }
        }
    }
    found
}

/// Whether (λᵢ − λⱼ)² changes from one line to the other between two points, both eigenvalues in the upper half plane.
fn is_candidate(a: &TrackedPoint, b: &TrackedPoint, (i, j): (usize, usize)) -> bool {
    let upper = |point: &TrackedPoint, index: usize| point.eigenvalues[index].im > 0.0;
    if ![i, j].iter().all(|&index| upper(a, index) && upper(b, index)) {
        return false;
    }
    let square = |point: &TrackedPoint| {
        let difference = point.eigenvalues[i] - point.eigenvalues[j];
        (difference * difference, modulus(point.eigenvalues[i]))
    };
    let ((before, size), (after, _)) = (square(a), square(b));
    let near = |z: Complex64| modulus(z) <= NEAR * size * size;
    let on_a_line = |z: Complex64| z.im.abs() <= ON_A_LINE * z.re.abs() + 1e-14 * size * size;
    let changes = (before.re > 0.0) != (after.re > 0.0);
    changes && near(before) && near(after) && on_a_line(before) && on_a_line(after)
}

/// Re (λᵢ − λⱼ)² of the two eigenvalues nearest to `middle`.
fn square_near<F: Family>(family: &F, value: f64, middle: Complex64) -> f64 {
    let Ok(point) = at(family, value) else { return f64::NAN };
    let mut values = point.eigenvalues;
    ascending_by(&mut values, |a| modulus(a - middle));
    match values.as_slice() {
        [first, second, ..] => ((first - second) * (first - second)).re,
        _ => f64::NAN,
    }
}
