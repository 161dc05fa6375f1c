//! First roots of many polynomials at once, one per lane, by the tests of [`super`].
//!
//! Rare cases are left to the scalar search: a polynomial whose Bernstein coefficients change
//! their sign more than once is returned as [`unsure`](Crossings). Every lane has its own stopping criterion
//! for the Newton iteration, so that a result does not depend on the other lanes.

use super::{ToBernstein, absolute_sum, derivative, margin_by_cubic, value};
use crate::lane::Lane;

/// Positive if Σ cₖ₊ₙtᵏ is proven to have no root on (0, h] by the first test of
/// [`super::first_crossing_after`]. The lanes may have different n = `zeros`, 0, 1 or 2;
/// coefficients below n must be zero. Requires N ≥ 6.
#[inline(always)]
pub fn margin_of_no_root<V: Lane, const N: usize>(c: &[V; N], zeros: V, h: V) -> V {
    // Dividing tⁿ out of Σ cₖtᵏ divides every scaled coefficient by hⁿ, which keeps the signs.
    let b = scaled(c, h);
    let sign = V::splat(1.0).zip(shifted(&b, zeros, 0), f64::copysign);
    let mut head = [sign; 4];
    for (k, coefficient) in head.iter_mut().enumerate() {
        *coefficient = shifted(&b, zeros, k) * sign;
    }
    let beyond_second = absolute_sum(&b, 6);
    let beyond_first = b[5].abs() + beyond_second;
    let beyond = b[4].abs() + beyond_first;
    margin_by_cubic(&head, pick(zeros, beyond, beyond_first, beyond_second))
}

/// Positive where [`super::first_crossing_after`] finds no root of Σ cₖ₊ₙtᵏ on (0, h] by its three tests, with their bits. It is
/// not positive where the first coefficient is zero or has another sign than `sign`, nor where that function has to halve the
/// interval. The lanes may have different n = `zeros`, 0, 1 or 2; only those where `wanted` is positive count.
#[inline(always)]
pub fn proof_of_no_root<V: Lane, const N: usize>(
    c: &[V; N],
    zeros: V,
    sign: V,
    h: V,
    wanted: V,
) -> V {
    let (zero, one) = (V::splat(0.0), V::splat(1.0));
    let mut a = *c;
    if zeros.any_positive() {
        for k in 0..N {
            let first = if k + 1 < N { c[k + 1] } else { zero };
            let second = if k + 2 < N { c[k + 2] } else { zero };
            a[k] = pick(zeros, c[k], first, second);
        }
    }
    let mut a = scaled(&a, h);
    for coefficient in &mut a {
        *coefficient = *coefficient * sign;
    }
    let by_cubic = margin_by_cubic(&[a[0], a[1], a[2], a[3]], absolute_sum(&a, 4));
    let by_cubic = by_cubic.where_positive(one, -one);
    if !wanted.where_positive(-by_cubic, -one).any_positive() {
        return by_cubic;
    }
    let mut slope_tail = zero;
    for (k, coefficient) in a.iter().enumerate().skip(2) {
        slope_tail = V::splat(k as f64).mul_add(coefficient.abs(), slope_tail);
    }
    let end = value(&a, one);
    let is_monotone = a[1].abs() - slope_tail;
    // No coefficient changes its sign; one that is not a number does.
    let mut keeps = one;
    for (j, coefficient) in bernstein(&a).into_iter().enumerate() {
        let coefficient = if j + 1 < N { coefficient } else { end };
        keeps = keeps.min(coefficient.map(|b| if b >= 0.0 { 1.0 } else { -1.0 }));
    }
    let starts = a[0].where_positive(one, -one);
    let by_shape = is_monotone.where_positive(one, keeps);
    let by_shape = by_shape.min(end.where_positive(one, -one)).min(starts);
    by_cubic.where_positive(one, by_shape)
}

/// Bernstein coefficients on [0, 1] of Σ aₖuᵏ, summed by ascending k.
#[inline(always)]
fn bernstein<V: Lane, const N: usize>(a: &[V; N]) -> [V; N] {
    let matrix = &ToBernstein::<N>::MATRIX;
    let mut bernstein = [a[0]; N];
    for k in 1..N {
        for j in k..N {
            bernstein[j] = V::splat(matrix[k][j]).mul_add(a[k], bernstein[j]);
        }
    }
    bernstein
}

/// Result of the search in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Crossings<V> {
    /// First root as a time, at most h; undefined if no root was found.
    pub time: V,
    /// 1 if a root was found, −1 if the step has no root, 0 if the scalar search must decide.
    pub found: V,
}

/// First roots of Σ cₖ₊ₙtᵏ on (0, h] in the lanes where `wanted` is positive; conditions as for
/// [`margin_of_no_root`].
#[inline(always)]
pub fn first_crossings<V: Lane, const N: usize>(
    c: &[V; N],
    zeros: V,
    h: V,
    wanted: V,
) -> Crossings<V> {
    let b = scaled(c, h);
    let mut a = [V::splat(0.0); N];
    for k in 0..N {
        a[k] = if k + 2 < N {
            shifted(&b, zeros, k)
        } else if k + 1 < N {
            pick(zeros, b[k], b[k + 1], V::splat(0.0))
        } else {
            pick(zeros, b[k], V::splat(0.0), V::splat(0.0))
        };
    }
    let sign = V::splat(1.0).zip(a[0], f64::copysign);
    for coefficient in &mut a {
        *coefficient = *coefficient * sign;
    }
    let (variations, guess) = control_polygon(&a);
    let one = V::splat(1.0);
    // The number of variations is an integer: ½ and 1½ separate 0, 1 and more.
    let several = variations - V::splat(1.5);
    let found = several
        .where_positive(V::splat(0.0), (variations - V::splat(0.5)).where_positive(one, -one));
    let u = polished(&a, guess, wanted.min(found));
    Crossings { time: (u * h).min(h), found }
}

/// cₖhᵏ.
#[inline(always)]
fn scaled<V: Lane, const N: usize>(c: &[V; N], h: V) -> [V; N] {
    let square = h * h;
    let (mut even, mut odd) = (V::splat(1.0), h);
    let mut b = [V::splat(0.0); N];
    for k in 0..N {
        if k % 2 == 0 {
            b[k] = c[k] * even;
            even = even * square;
        } else {
            b[k] = c[k] * odd;
            odd = odd * square;
        }
    }
    b
}

/// Selects the first, second or third argument for n = 0, 1 or 2.
#[inline(always)]
fn pick<V: Lane>(zeros: V, none: V, one: V, two: V) -> V {
    (zeros - V::splat(1.5)).where_positive(two, zeros.where_positive(one, none))
}

/// Coefficient k after dividing out n roots at 0.
#[inline(always)]
fn shifted<V: Lane, const N: usize>(b: &[V; N], zeros: V, k: usize) -> V {
    pick(zeros, b[k], b[k + 1], b[k + 2])
}

/// Number of sign changes in the Bernstein coefficients of Σ aₖuᵏ on [0, 1], ignoring zeros, and the point at which
/// the control polygon first decreases through zero.
#[inline(always)]
fn control_polygon<V: Lane, const N: usize>(a: &[V; N]) -> (V, V) {
    let mut bernstein = bernstein(a);
    // The next step starts from the value at the end, so its sign decides.
    bernstein[N - 1] = value(a, V::splat(1.0));
    let one = V::splat(1.0);
    let mut variations = V::splat(0.0);
    let mut last = one;
    // The neighbouring points between which the polygon first decreases through zero.
    let (mut above, mut below, mut position) = (one, -one, one);
    let mut fallen = -one;
    for (j, &coefficient) in bernstein.iter().enumerate().skip(1) {
        let changes = -(coefficient * last);
        variations = variations + changes.where_positive(one, V::splat(0.0));
        let falls_now = (-coefficient).min(-fallen);
        above = falls_now.where_positive(bernstein[j - 1], above);
        below = falls_now.where_positive(coefficient, below);
        position = falls_now.where_positive(V::splat((j - 1) as f64), position);
        fallen = falls_now.where_positive(one, fallen);
        last = coefficient.abs().where_positive(one.zip(coefficient, f64::copysign), last);
    }
    let share = above.zip(above - below, |above, drop| above / drop);
    let crossing = (position + share) * V::splat(1.0 / (N - 1) as f64);
    let guess = fallen.where_positive(crossing, one);
    // An exact zero at the end is a root.
    let ends_at_zero = fallen.where_positive(-one, -bernstein[N - 1].abs());
    let touches = ends_at_zero.map(|x| if x == 0.0 { 1.0 } else { 0.0 });
    (variations + touches, guess.max(V::splat(0.0)).min(one))
}

/// The root of Σ aₖuᵏ in [0, 1], where it decreases from positive to negative values, in the lanes where `wanted`
/// is positive: Newton's method safeguarded by its bracket.
#[inline(always)]
fn polished<V: Lane, const N: usize>(a: &[V; N], guess: V, wanted: V) -> V {
    let slopes = derivative(a);
    let (mut low, mut high) = (V::splat(0.0), V::splat(1.0));
    let mut u = guess;
    let mut open = wanted;
    for _ in 0..80 {
        if !open.any_positive() {
            break;
        }
        let (height, slope) = (value(a, u), value(&slopes, u));
        low = height.where_positive(u, low);
        high = height.where_positive(high, u);
        let newton = u - height.zip(slope, |height, slope| height / slope);
        // Newton's method doubles the number of digits: after a correction this small the error is below rounding.
        let converged = V::splat(1e-9) * u - (newton - u).abs();
        let inside = (newton - low).min(high - newton);
        let middle = V::splat(0.5) * (low + high);
        let next = inside.where_positive(newton, middle);
        let last = converged.where_positive(newton.max(low).min(high), next);
        u = open.where_positive(last, u);
        let narrow = V::splat(2.0 * f64::EPSILON) * high - (high - low);
        let done = converged.max(narrow);
        open = done.where_positive(V::splat(-1.0), open);
    }
    u
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dispatch::{InstructionSet, LaneWork, with_lanes};
    use crate::lane::MOST_LANES;
    use crate::polynomial::first_crossing_after;

    const N: usize = 17;

    /// Several polynomials, stored by coefficient.
    struct Search<'a> {
        rows: &'a [[f64; MOST_LANES]; N],
        zeros: &'a [f64; MOST_LANES],
        h: f64,
    }

    impl LaneWork for Search<'_> {
        /// Margin, found, time, proof of no root.
        type Output = Vec<[f64; 4]>;

        #[inline(always)]
        fn run<V: Lane>(self) -> Vec<[f64; 4]> {
            let mut results = Vec::new();
            for first in (0..MOST_LANES).step_by(V::LANES) {
                let c: [V; N] = std::array::from_fn(|k| V::load(&self.rows[k][first..]));
                let zeros = V::load(&self.zeros[first..]);
                let h = V::splat(self.h);
                let margin = margin_of_no_root(&c, zeros, h);
                let crossings = first_crossings(&c, zeros, h, V::splat(1.0));
                let mut lanes = [[0.0; MOST_LANES]; 4];
                margin.store(&mut lanes[0]);
                crossings.found.store(&mut lanes[1]);
                crossings.time.store(&mut lanes[2]);
                let sign = V::splat(1.0).zip(pick(zeros, c[0], c[1], c[2]), f64::copysign);
                let proof = |sign| proof_of_no_root(&c, zeros, sign, h, V::splat(1.0));
                proof(sign).store(&mut lanes[3]);
                assert!(!proof(-sign).any_positive());
                results.extend((0..V::LANES).map(|lane| lanes.map(|row| row[lane])));
            }
            results
        }
    }

    /// Random polynomials with 0, 1 or 2 roots at the start, with few and many oscillations.
    fn rows(
        random: &mut impl FnMut() -> f64,
        growth: f64,
    ) -> ([[f64; MOST_LANES]; N], [f64; MOST_LANES]) {
        let mut rows = [[0.0; MOST_LANES]; N];
        let mut zeros = [0.0; MOST_LANES];
        for lane in 0..MOST_LANES {
            zeros[lane] = (lane % 3) as f64;
            let mut scale = 1.0;
            for (k, row) in rows.iter_mut().enumerate() {
                scale *= growth;
                row[lane] = if k < lane % 3 { 0.0 } else { random() * scale };
            }
        }
        (rows, zeros)
    }

    #[test]
    fn lanes_agree_with_the_scalar_search_and_with_each_other() {
        let mut state = 0x2545_f491_4f6c_dd1d_u64;
        let mut random = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut counts = [0; 4];
        for round in 0..600 {
            let growth = [0.4, 0.9, 1.4][round % 3];
            let (rows, zeros) = rows(&mut random, growth);
            let h = 0.2 + 0.9 * (random() + 0.5);
            let search = |set| with_lanes(set, Search { rows: &rows, zeros: &zeros, h });
            let alone = search(InstructionSet::Baseline);
            for set in InstructionSet::ALL {
                let bits = |row: &[f64; 4]| row.map(f64::to_bits);
                let lanes: Vec<_> = search(set).iter().map(bits).collect();
                assert_eq!(lanes, alone.iter().map(bits).collect::<Vec<_>>(), "{}", set.name());
            }
            for (lane, &[margin, found, time, proof]) in alone.iter().enumerate() {
                let c: [f64; N] = std::array::from_fn(|k| rows[k][lane]);
                let scalar = first_crossing_after(&c, lane % 3, h);
                // The control polygon of the lanes, with the same bits as the scalar one, changes its sign where there is no proof.
                assert!(proof < 0.0 || scalar.is_none(), "a proof of no root is wrong");
                assert!(proof > 0.0 || margin <= 0.0 && found != -1.0, "a proof is missed");
                counts[3] += usize::from(proof > 0.0 && margin <= 0.0);
                if margin > 0.0 {
                    assert_eq!(scalar, None, "a proof of no root is wrong");
                }
                match (found, scalar) {
                    (1.0, Some(root)) => {
                        assert!((time - root).abs() < 1e-11 * h, "{time} against {root}");
                        counts[0] += 1;
                    }
                    (-1.0, None) => counts[1] += 1,
                    (0.0, _) => counts[2] += 1,
                    other => panic!("lane {lane}: {other:?}"),
                }
            }
        }
        assert!(counts.iter().all(|&count| count > 300), "{counts:?}");
    }

    #[test]
    fn a_root_at_the_end_of_the_step_is_included() {
        let mut c = [0.0; N];
        (c[0], c[1]) = (1.0, -2.0);
        let crossings = first_crossings(&c, 0.0, 0.5, 1.0);
        assert_eq!(crossings.found, 1.0);
        assert!((crossings.time - 0.5).abs() < 1e-15);
    }
}
