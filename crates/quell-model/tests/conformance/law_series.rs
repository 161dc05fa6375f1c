//! The Taylor recurrence μ₀, μ₁, … along a slip w(t) = Σ wₖtᵏ, against the law itself.

use quell_model::friction::{BranchSeries, LawSeries, LawVisitor};
use quell_model::{Friction, LawKind};
use quell_numerics::lane::{Lane, LanePair, horner};

use crate::law_samples::all_samples;

/// Coefficients kept: enough that the remainder at |t| ≤ 1/4 is below rounding.
const TERMS: usize = 28;

/// Coefficients of the friction along a scaled slip on the branch of `sign`.
struct Along<'a, V> {
    sign: f64,
    slip: &'a [V; TERMS],
}

impl<V: Lane> LawVisitor for Along<'_, V> {
    type Output = [V; TERMS];

    fn visit<L: LawSeries>(self, law: &L) -> [V; TERMS] {
        let w = self.slip;
        let mut constants = L::constants::<V>(&vec![law.clone(); V::LANES]);
        let mut series = L::series::<V, TERMS>(&mut constants, V::splat(self.sign), w[0]);
        let slope = series.slope();
        let mut friction = [series.first(); TERMS];
        for k in 1..TERMS {
            friction[k] = slope * w[k] + series.lower(k, w);
        }
        friction
    }
}

/// Slips on the positive branch for |t| ≤ 1/4, with coefficients of every order.
fn slips() -> Vec<[f64; TERMS]> {
    [(1.1, 0.9), (0.4, -0.8), (2.7, 1.3), (6.0, -2.0)]
        .into_iter()
        .map(|(start, change)| {
            let mut slip = [start; TERMS];
            for (k, coefficient) in slip.iter_mut().enumerate().skip(1) {
                // Signs and sizes without any pattern in common with a law.
                *coefficient = change * (1.7 * (k * k) as f64 + 0.3).cos() / k as f64;
            }
            slip[1] = change;
            slip
        })
        .collect()
}

/// Friction on the branch of `sign` where the scaled slip has the magnitude of `w`.
fn exact(law: &Friction, sign: f64, w: f64) -> f64 {
    assert!(sign * w >= 0.0, "the slip left its branch");
    sign * law.coefficient(w.abs() * law.velocity_scale())
}

fn opposite(slip: &[f64; TERMS]) -> [f64; TERMS] {
    slip.map(|coefficient| -coefficient)
}

/// The polynomial of all terms is the law, up to rounding.
#[test]
fn the_series_gives_the_value_of_the_law() {
    for law in all_samples() {
        for slip in slips() {
            for (sign, slip) in [(1.0, slip), (-1.0, opposite(&slip))] {
                let friction = law.visit(Along { sign, slip: &slip });
                for t in [-0.25, -0.1, -1e-3, 0.0, 1e-5, 0.03, 0.18, 0.25] {
                    let exact = exact(&law, sign, horner(&slip, t));
                    let series = horner(&friction, t);
                    let size = horner(&friction.map(f64::abs), t.abs()).max(exact.abs());
                    assert!(
                        (series - exact).abs() <= 2e-14 * size,
                        "{law:?}, w₀ = {}, t = {t}: {series} against {exact}",
                        slip[0]
                    );
                }
            }
        }
    }
}

/// With its first K coefficients the series agrees to order K: halving t divides the error
/// by 2ᴷ. A single wrong coefficient limits the order of all longer series to its own.
#[test]
fn truncated_series_agree_to_their_order() {
    let mut measured = 0;
    for law in all_samples() {
        for slip in slips() {
            let friction = law.visit(Along { sign: 1.0, slip: &slip });
            let size =
                law.static_coefficient().max(law.coefficient(slip[0] * law.velocity_scale()));
            for terms in 1..=9 {
                let error = |t: f64| {
                    let series = horner(&friction[..terms], t);
                    (series - exact(&law, 1.0, horner(&slip, t))).abs()
                };
                // The larger of two signs: an error term may vanish on one side.
                let worst = |t: f64| error(t).max(error(-t));
                let (wide, narrow) = (worst(0.04), worst(0.02));
                if narrow <= 200.0 * f64::EPSILON * size {
                    continue;
                }
                let order = (wide / narrow).log2();
                assert!(
                    order > terms as f64 - 0.4,
                    "{law:?}, w₀ = {}: {terms} terms agree to order {order}",
                    slip[0]
                );
                measured += 1;
            }
        }
    }
    assert!(measured > 100, "only {measured} orders could be measured");
}

#[test]
fn both_branches_are_odd_to_the_last_bit() {
    for law in all_samples() {
        for slip in slips() {
            let above = law.visit(Along { sign: 1.0, slip: &slip });
            let below = law.visit(Along { sign: -1.0, slip: &opposite(&slip) });
            for k in 0..TERMS {
                assert_eq!(above[k], -below[k], "{law:?}, k = {k}");
            }
        }
    }
}

#[test]
fn a_lane_gives_the_same_bits_as_a_scalar() {
    let slips = slips();
    for law in all_samples() {
        for (first, second) in slips.iter().zip(slips.iter().rev()) {
            let both: [LanePair<f64>; TERMS] =
                std::array::from_fn(|k| LanePair::load(&[first[k], second[k]]));
            let together = law.visit(Along { sign: 1.0, slip: &both });
            let one = law.visit(Along { sign: 1.0, slip: first });
            let other = law.visit(Along { sign: 1.0, slip: second });
            for k in 0..TERMS {
                let mut lanes = [0.0; 2];
                together[k].store(&mut lanes);
                let alone = [one[k], other[k]];
                assert_eq!(lanes.map(f64::to_bits), alone.map(f64::to_bits), "{law:?}, k = {k}");
            }
        }
    }
}

/// Order of the step whose length a law may limit.
const ORDER: usize = 16;

/// The part of a step of length 1 along a slip of [`TERMS`] coefficients that a law trusts.
struct Trusted<'a>(&'a [f64; TERMS]);

impl LawVisitor for Trusted<'_> {
    type Output = f64;

    fn visit<L: LawSeries>(self, law: &L) -> f64 {
        let w = &self.0[..=ORDER];
        let mut constants = L::constants::<f64>(std::slice::from_ref(law));
        let mut series = L::series::<f64, { ORDER + 1 }>(&mut constants, 1.0, w[0]);
        for k in 1..ORDER {
            series.lower(k, w);
        }
        series.trusted(w, 1.0)
    }
}

/// Over the length that a law trusts, the last two retained terms bound the rest, where they are
/// small: a step with larger ones is never taken.
#[test]
fn the_trusted_length_keeps_the_remainder_below_the_last_terms() {
    let mut judged = 0;
    for law in all_samples() {
        for (start, change) in [(0.0, 40.0), (40.0, -40.0), (11.0, -8.0), (3.0, 2.0), (0.4, -0.3)] {
            let mut slip = [0.0; TERMS];
            (slip[0], slip[1]) = (start, change);
            let mut length = law.visit(Trusted(&slip));
            assert!(length > 0.0 && length <= 1.0, "{law:?}: no step could advance");
            let friction = law.visit(Along { sign: 1.0, slip: &slip });
            let kept = &friction[..=ORDER];
            let last = |length: f64| {
                (kept[ORDER] * length.powi(16)).abs() + (kept[ORDER - 1] * length.powi(15)).abs()
            };
            let numeric = LawKind::NUMERIC.contains(&law.kind());
            while !numeric && last(length) > 1e-6 * law.static_coefficient() {
                length *= 0.5;
            }
            let size = horner(&friction.map(f64::abs), length);
            let remainder =
                (horner(kept, length) - exact(&law, 1.0, start + change * length)).abs();
            // A geometric rest, as of a pole at 1.3 times the length, is up to 3 of its last terms.
            let share = if numeric { 1.0 } else { 3.0 };
            assert!(
                remainder <= share * last(length) + 1e-13 * size,
                "{law:?} from {start} by {change}: {remainder} > {}",
                last(length)
            );
            judged += 1;
        }
    }
    assert!(judged > 100);
}
