//! Eigenvalues of a Hessenberg matrix by Francis' double-shift QR iteration.
//!
//! Implicit double shifts from the trailing 2 × 2 block, exceptional shifts every tenth iteration, deflation where
//! a subdiagonal entry is below ε times its two neighbours on the diagonal (the algorithm `hqr` of Martin, Peters
//! and Wilkinson, *Numer. Math.* 14 (1970) 219). Only eigenvalues are computed, so reflectors act
//! on the active window; row operations extend over whole groups of the padded rows, where entries to the
//! right of the window are never read again.
//! The cost is about 10 n³ operations. Backward stable, like the reduction.

use num_complex::Complex64;

use crate::groups::LANES;

/// Maximum number of iterations for one eigenvalue; three or four are usual.
const ITERATIONS: usize = 90;

/// Eigenvalues of the n × n Hessenberg matrix in rows of length `stride`, with exact zeros below its
/// subdiagonal and zero padding; complex pairs are adjacent, positive imaginary part first.
/// `None` without convergence. The matrix is overwritten.
#[inline(always)]
pub(crate) fn eigenvalues(a: &mut [f64], n: usize, stride: usize) -> Option<Vec<Complex64>> {
    let mut values = vec![Complex64::new(0.0, 0.0); n];
    let norm: f64 = a.iter().map(|value| value.abs()).sum();
    if !norm.is_finite() {
        return None;
    }
    // Sum of exceptional shifts.
    let mut shift = 0.0;
    // Rows and columns below `end` are not yet deflated.
    let mut end = n;
    let mut iterations = 0;
    while end > 0 {
        let last = end - 1;
        let start = window_start(a, stride, last, norm);
        let x = a[last * stride + last];
        if start == last {
            values[last] = Complex64::new(x + shift, 0.0);
            end -= 1;
            iterations = 0;
            continue;
        }
        let y = a[(last - 1) * stride + last - 1];
        let w = a[last * stride + last - 1] * a[(last - 1) * stride + last];
        if start + 1 == last {
            [values[last - 1], values[last]] = of_two(x, y, w, shift);
            end -= 2;
            iterations = 0;
            continue;
        }
        if iterations == ITERATIONS {
            return None;
        }
        let mut shifts = (x, y, w);
        if iterations % 10 == 9 {
            shift += x;
            for i in 0..end {
                a[i * stride + i] -= x;
            }
            let s = a[last * stride + last - 1].abs() + a[(last - 1) * stride + last - 2].abs();
            shifts = (0.75 * s, 0.75 * s, -0.4375 * s * s);
        }
        iterations += 1;
        sweep(a, stride, start, last, shifts);
    }
    Some(values)
}

/// First row of the window that ends at `last`: the row of the nearest negligible subdiagonal entry above, which is set to zero.
#[inline(always)]
fn window_start(a: &mut [f64], stride: usize, last: usize, norm: f64) -> usize {
    let mut start = last;
    while start > 0 {
        let size = a[(start - 1) * stride + start - 1].abs() + a[start * stride + start].abs();
        let size = if size == 0.0 { norm } else { size };
        if a[start * stride + start - 1].abs() <= f64::EPSILON * size {
            a[start * stride + start - 1] = 0.0;
            break;
        }
        start -= 1;
    }
    start
}

/// Eigenvalues of a 2 × 2 block with the diagonal y, x and the product w of the other two entries.
#[inline(always)]
fn of_two(x: f64, y: f64, w: f64, shift: f64) -> [Complex64; 2] {
    let p = 0.5 * (y - x);
    let q = p.mul_add(p, w);
    let root = q.abs().sqrt();
    let x = x + shift;
    if q >= 0.0 {
        let z = if p < 0.0 { p - root } else { p + root };
        let other = if z == 0.0 { x } else { x - w / z };
        [Complex64::new(x + z, 0.0), Complex64::new(other, 0.0)]
    } else {
        [Complex64::new(x + p, root), Complex64::new(x + p, -root)]
    }
}

/// The row at which the bulge of a double-shift step may start, and its first column: two consecutive small subdiagonal entries
/// allow it to start below `start`.
#[inline(always)]
fn start_of_bulge(
    a: &[f64],
    stride: usize,
    start: usize,
    last: usize,
    (x, y, w): (f64, f64, f64),
) -> (usize, [f64; 3]) {
    let at = |i: usize, j: usize| i * stride + j;
    let mut m = last - 2;
    loop {
        let z = a[at(m, m)];
        let (dx, dy) = (x - z, y - z);
        let mut p = dx.mul_add(dy, -w) / a[at(m + 1, m)] + a[at(m, m + 1)];
        let mut q = a[at(m + 1, m + 1)] - z - dx - dy;
        let mut r = a[at(m + 2, m + 1)];
        let size = 1.0 / (p.abs() + q.abs() + r.abs());
        p *= size;
        q *= size;
        r *= size;
        if m == start {
            return (m, [p, q, r]);
        }
        let small = a[at(m, m - 1)].abs() * (q.abs() + r.abs());
        let large = p.abs() * (a[at(m - 1, m - 1)].abs() + z.abs() + a[at(m + 1, m + 1)].abs());
        if small <= f64::EPSILON * large {
            return (m, [p, q, r]);
        }
        m -= 1;
    }
}

/// One implicit double-shift step on rows `start`…`last`.
#[inline(always)]
fn sweep(a: &mut [f64], stride: usize, start: usize, last: usize, shifts: (f64, f64, f64)) {
    let at = |i: usize, j: usize| i * stride + j;
    let (m, [mut p, mut q, mut r]) = start_of_bulge(a, stride, start, last, shifts);
    for k in m..last {
        let three = k + 1 != last;
        let mut size = 1.0;
        if k != m {
            p = a[at(k, k - 1)];
            q = a[at(k + 1, k - 1)];
            r = if three { a[at(k + 2, k - 1)] } else { 0.0 };
            size = p.abs() + q.abs() + r.abs();
            if size == 0.0 {
                continue;
            }
            let inverse = 1.0 / size;
            p *= inverse;
            q *= inverse;
            r *= inverse;
        }
        let norm = p.mul_add(p, q.mul_add(q, r * r)).sqrt();
        let s = if p < 0.0 { -norm } else { norm };
        if s == 0.0 {
            continue;
        }
        let corner =
            if k == m { if start == m { 0.0 } else { -a[at(k, k - 1)] } } else { -s * size };
        p += s;
        let (over_s, over_p) = (1.0 / s, 1.0 / p);
        let (x, y, z) = (p * over_s, q * over_s, r * over_s);
        q *= over_p;
        r *= over_p;
        // Whole groups from the one that contains column k: further left the three rows are zero except for the entries
        // written below.
        let from = k / LANES * LANES;
        let to = (last / LANES + 1) * LANES;
        if three {
            rotate_three_rows(&mut a[at(k, 0)..at(k + 3, 0)], stride, from..to, [x, y, z], [q, r]);
            for row in a[at(start, 0)..at(last.min(k + 3) + 1, 0)].chunks_exact_mut(stride) {
                let [a, b, c] = &mut row[k..k + 3] else { continue };
                let t = z.mul_add(*c, y.mul_add(*b, x * *a));
                *a -= t;
                *b = (-t).mul_add(q, *b);
                *c = (-t).mul_add(r, *c);
            }
        } else {
            rotate_two_rows(&mut a[at(k, 0)..at(k + 2, 0)], stride, from..to, [x, y], q);
            for row in a[at(start, 0)..at(last + 1, 0)].chunks_exact_mut(stride) {
                let [a, b] = &mut row[k..k + 2] else { continue };
                let t = y.mul_add(*b, x * *a);
                *a -= t;
                *b = (-t).mul_add(q, *b);
            }
        }
        if k > 0 {
            a[at(k, k - 1)] = corner;
            a[at(k + 1, k - 1)] = 0.0;
            if three {
                a[at(k + 2, k - 1)] = 0.0;
            }
        }
    }
}

/// Applies the reflector of three rows from the left to the columns of `range`.
#[inline(always)]
fn rotate_three_rows(
    rows: &mut [f64],
    stride: usize,
    range: core::ops::Range<usize>,
    [x, y, z]: [f64; 3],
    [q, r]: [f64; 2],
) {
    let (first, rest) = rows.split_at_mut(stride);
    let (second, third) = rest.split_at_mut(stride);
    let first = first[range.clone()].chunks_exact_mut(LANES);
    let second = second[range.clone()].chunks_exact_mut(LANES);
    let third = third[range].chunks_exact_mut(LANES);
    for ((a, b), c) in first.zip(second).zip(third) {
        for lane in 0..LANES {
            let t = r.mul_add(c[lane], q.mul_add(b[lane], a[lane]));
            a[lane] = (-t).mul_add(x, a[lane]);
            b[lane] = (-t).mul_add(y, b[lane]);
            c[lane] = (-t).mul_add(z, c[lane]);
        }
    }
}

/// Applies the reflector of two rows from the left to the columns of `range`.
#[inline(always)]
fn rotate_two_rows(
    rows: &mut [f64],
    stride: usize,
    range: core::ops::Range<usize>,
    [x, y]: [f64; 2],
    q: f64,
) {
    let (first, second) = rows.split_at_mut(stride);
    let first = first[range.clone()].chunks_exact_mut(LANES);
    let second = second[range].chunks_exact_mut(LANES);
    for (a, b) in first.zip(second) {
        for lane in 0..LANES {
            let t = q.mul_add(b[lane], a[lane]);
            a[lane] = (-t).mul_add(x, a[lane]);
            b[lane] = (-t).mul_add(y, b[lane]);
        }
    }
}
