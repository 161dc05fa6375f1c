//! Sums and updates along rows in groups of [`LANES`] numbers, which fit one vector register.
//!
//! A sum has one accumulator per place in a group, added in a fixed order; the numbers after the last whole group are added to
//! the first accumulators. Rows padded with zeros to whole groups give the same bits as rows that are not.

/// Numbers in a group of a row.
pub(crate) const LANES: usize = 4;

/// Σ aⱼ bⱼ: one accumulator per place, then (0+1)+(2+3).
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0f64; LANES];
    let (a, b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let rest = a.remainder().iter().zip(b.remainder());
    for (a, b) in a.zip(b) {
        for lane in 0..LANES {
            sums[lane] = a[lane].mul_add(b[lane], sums[lane]);
        }
    }
    for (sum, (a, b)) in sums.iter_mut().zip(rest) {
        *sum = a.mul_add(*b, *sum);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// a ← a + f b.
#[inline(always)]
pub(crate) fn add_scaled(a: &mut [f64], f: f64, b: &[f64]) {
    let mut groups = a.chunks_exact_mut(LANES);
    let b = b.chunks_exact(LANES);
    let rest = b.remainder();
    for (a, b) in groups.by_ref().zip(b) {
        for lane in 0..LANES {
            a[lane] = f.mul_add(b[lane], a[lane]);
        }
    }
    for (a, b) in groups.into_remainder().iter_mut().zip(rest) {
        *a = f.mul_add(*b, *a);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padding_with_zeros_changes_no_bit() {
        for n in 1..12usize {
            let a: Vec<f64> = (0..n).map(|i| 1.0 / (1.0 + i as f64)).collect();
            let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
            let padded = |x: &[f64]| {
                let mut x = x.to_vec();
                x.resize(n.div_ceil(LANES) * LANES, 0.0);
                x
            };
            let exact: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            let sum = dot(&a, &b);
            assert!((sum - exact).abs() < 1e-15, "n = {n}");
            assert_eq!(sum.to_bits(), dot(&padded(&a), &padded(&b)).to_bits(), "n = {n}");
            let (mut short, mut long) = (a.clone(), padded(&a));
            add_scaled(&mut short, 0.3, &b);
            add_scaled(&mut long, 0.3, &padded(&b));
            assert_eq!(short, long[..n], "n = {n}");
        }
    }
}
