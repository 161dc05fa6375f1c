//! The slope of a friction law along a slip: the composition of the law's own series with that of the slip, and products of series.

use quell_model::friction::{BranchSeries, FrictionConstants};
use quell_numerics::lane::partial_product;

use crate::simulation::{ORDER, RECIPROCALS, Series};

/// Terms of a composition below this share of the largest are lost in its rounding.
const NEGLIGIBLE: f64 = 1e-18;

/// A series with the number of its terms up to the last that is not zero.
#[inline(always)]
pub(super) fn counted(series: Series) -> (Series, usize) {
    let terms = series.iter().rposition(|term| *term != 0.0).map_or(0, |last| last + 1);
    (series, terms)
}

/// The product of two series, of which the first often is constant.
#[inline(always)]
pub(super) fn multiplied(a: &Series, b: &Series) -> Series {
    let terms = counted(*a).1;
    let mut product = [0.0; ORDER + 1];
    for (j, a) in a[..terms].iter().enumerate() {
        for (term, b) in product[j..].iter_mut().zip(b) {
            *term = f64::mul_add(*a, *b, *term);
        }
    }
    product
}

/// The quotient of two series.
#[inline(always)]
pub(super) fn divided(a: &Series, b: &Series) -> Series {
    let inverse = 1.0 / b[0];
    let mut quotient = [0.0; ORDER + 1];
    for k in 0..=ORDER {
        let known = partial_product(b, &quotient, k, 1, k);
        quotient[k] = (a[k] - known) * inverse;
    }
    quotient
}

/// μ at the start of a slip w(t), and the series of μ′(w(t)) up to the order that the last order of a change needs.
#[inline(always)]
pub(super) fn along_slip(law: &mut FrictionConstants, sign: f64, w: &Series) -> (f64, Series) {
    // In units of a bound on the change of w, in which the law's own series decreases as fast as that of the motion.
    let change: f64 = w[1..].iter().map(|term| term.abs()).sum();
    let mut path = [0.0; ORDER + 1];
    (path[0], path[1]) = (w[0], change);
    let mut branch = law.series::<{ ORDER + 1 }>(sign, w[0]);
    let mut slopes = [0.0; ORDER + 1];
    slopes[0] = branch.slope();
    if change > 0.0 {
        let inverse = 1.0 / change;
        for k in 1..=ORDER {
            // Beyond the first order a straight path has no part from the slope, and at the first no other.
            let term = branch.lower(k, &path);
            if k > 1 {
                slopes[k - 1] = k as f64 * inverse * term;
            }
        }
    }
    let mut relative = w.map(|term| if change > 0.0 { term / change } else { 0.0 });
    relative[0] = 0.0;
    (branch.first(), composed(&slopes, &relative))
}

/// Σ aⱼ uʲ for a series u that begins at the first order and whose coefficients add up to at most 1, below the last order.
#[inline(always)]
fn composed(outer: &Series, inner: &Series) -> Series {
    let largest = outer.iter().fold(0.0, |most: f64, term| most.max(term.abs()));
    // A term contributes at most itself to any coefficient.
    let counts = |term: &f64| !term.is_finite() || term.abs() > NEGLIGIBLE * largest;
    let mut sum = [0.0; ORDER + 1];
    let Some(highest) = outer.iter().rposition(counts) else { return sum };
    sum[0] = outer[highest];
    for j in (0..highest).rev() {
        // What is multiplied j times more by u is needed up to the order 15 − j only.
        sum = if j < ORDER / 2 {
            multiplied_by_inner::<ORDER>(&sum, inner)
        } else {
            multiplied_by_inner::<{ ORDER / 2 }>(&sum, inner)
        };
        sum[0] = outer[j];
    }
    sum
}

/// The first `N` coefficients of a series times one that begins at the first order.
#[inline(always)]
fn multiplied_by_inner<const N: usize>(series: &Series, inner: &Series) -> Series {
    // Behind zeros, so that every shifted copy of it has the same length.
    let mut behind = [0.0; 2 * ORDER];
    behind[ORDER..ORDER + N].copy_from_slice(&series[..N]);
    let mut sum = [0.0; N];
    for l in 1..N {
        let shifted = &behind[ORDER - l..ORDER - l + N];
        for (sum, term) in sum.iter_mut().zip(shifted) {
            *sum = f64::mul_add(inner[l], *term, *sum);
        }
    }
    let mut product = [0.0; ORDER + 1];
    product[..N].copy_from_slice(&sum);
    product
}

/// The series of μ along a slip from that of its slope: d(μ(w(t)))/dt = μ′ ẇ.
#[inline(always)]
pub(super) fn integrated(first: f64, slope: &Series, w: &Series) -> Series {
    let mut rates = [0.0; ORDER + 1];
    for k in 0..ORDER {
        rates[k] = (k + 1) as f64 * w[k + 1];
    }
    let mut series = [0.0; ORDER + 1];
    series[0] = first;
    for k in 1..=ORDER {
        series[k] = partial_product(slope, &rates, k - 1, 0, k - 1) * RECIPROCALS[k];
    }
    series
}

#[cfg(test)]
mod tests {
    use quell_model::LawKind;
    use quell_model::friction::Expression;
    use quell_model::friction::Friction;
    use quell_numerics::lane::horner;

    use super::*;

    /// The slope of every law along a slip that turns, against the law itself at times of the interval.
    #[test]
    fn the_slope_along_a_slip_is_that_of_the_law() {
        let formula = "0.3 + 0.1*exp(-abs(v)/0.2) + 0.05*v^2/(1 + v^2)";
        let laws = [
            LawKind::Stribeck.build(&[0.4, 0.2857, 0.2]),
            LawKind::StribeckExponential.build(&[0.25, 0.4, 0.1, 2.0, 0.05]),
            LawKind::Decreasing.build(&[0.4, 0.25, 0.1]),
            LawKind::Coulomb.build(&[0.3, 0.3, 0.0]),
            Expression::new(formula, &[], None, 1.0).map(Friction::Expression),
        ];
        for law in laws {
            let law = law.expect("valid");
            for sign in [1.0, -1.0] {
                let mut slip = [0.0; ORDER + 1];
                slip[..4].copy_from_slice(&[0.8, -0.2, 0.3, -0.05]);
                let slip = slip.map(|term| sign * term);
                let mut constants = FrictionConstants::of(&law);
                let (first, slopes) = along_slip(&mut constants, sign, &slip);
                let values = integrated(first, &slopes, &slip);
                for at in [0.0, 0.1, 0.2, 0.3] {
                    let w = horner(&slip, at);
                    let exact = law.velocity_scale() * law.slope(w.abs() * law.velocity_scale());
                    assert!((horner(&slopes, at) - exact).abs() < 1e-9, "{law:?} {at}");
                    let value = sign * law.coefficient(w.abs() * law.velocity_scale());
                    assert!((horner(&values, at) - value).abs() < 1e-10, "{law:?} {at}");
                }
            }
        }
    }

    #[test]
    fn the_composition_of_an_exponential_and_a_sine_has_its_known_coefficients() {
        let mut factorial = 1.0;
        let outer: Series = std::array::from_fn(|k| {
            factorial *= k.max(1) as f64;
            1.0 / factorial
        });
        let sine: Series = std::array::from_fn(|k| match k % 4 {
            1 => outer[k],
            3 => -outer[k],
            _ => 0.0,
        });
        // exp(sin t) = 1 + t + t²/2 − t⁴/8 − t⁵/15 − t⁶/240 + t⁷/90 + 31t⁸/5760 + …
        let exact =
            [1.0, 1.0, 0.5, 0.0, -1.0 / 8.0, -1.0 / 15.0, -1.0 / 240.0, 1.0 / 90.0, 31.0 / 5760.0];
        let found = composed(&outer, &sine);
        for (found, exact) in found.iter().zip(exact) {
            assert!((found - exact).abs() < 1e-15, "{found} {exact}");
        }
    }
}
