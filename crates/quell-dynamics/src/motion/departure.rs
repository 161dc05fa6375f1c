//! How a number that is zero leaves zero: by the first term of its series that is not rounding.
//!
//! A number that has been located at zero has the size of rounding, and so may its first derivatives have: the sign of such a term
//! says nothing. The terms are compared with each other in the time scale of the system.

/// Terms below this share of the largest are rounding.
const ROUNDING: f64 = 1e-9;

/// Most halvings of the time scale: a series whose lower half vanishes has no other.
const MOST_HALVINGS: u32 = 64;

/// How a number leaves zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Departure {
    /// Number of its first terms that are rounding: the multiplicity of its zero.
    pub(super) zeros: usize,
    /// Its sign after that; 0 if every term is zero.
    pub(super) sign: i8,
}

impl Departure {
    /// Of Σ cₖtᵏ with k from `known` on: the lower terms are zero. `size` is the size of the parts of c at `known`, whose difference
    /// may be rounding.
    pub(super) fn of(series: &[f64], known: usize, size: f64, time_scale: f64) -> Self {
        let given = series.get(known..).unwrap_or_default();
        let terms = scaled_within_convergence(given, time_scale);
        let largest = terms.iter().fold(0.0, |most: f64, term| most.max(term.abs()));
        let least = ROUNDING * largest.max(size);
        // Where the parts are far larger than all terms, the largest term decides.
        let first = terms
            .iter()
            .position(|term| term.abs() > least)
            .or_else(|| terms.iter().position(|term| largest > 0.0 && term.abs() == largest));
        let Some(first) = first else { return Self { zeros: known, sign: 0 } };
        Self { zeros: known + first, sign: if terms[first] < 0.0 { -1 } else { 1 } }
    }
}

/// The terms after the time scale, which is halved until the higher half of them is not above the lower one: beyond the convergence of a
/// series, as of a steep law, its highest terms would hide all others.
fn scaled_within_convergence(given: &[f64], mut time_scale: f64) -> Vec<f64> {
    let mut terms = Vec::new();
    for _ in 0..MOST_HALVINGS {
        let mut scale = 1.0;
        terms.clear();
        terms.extend(given.iter().map(|term| {
            let scaled = term * scale;
            scale *= time_scale;
            scaled
        }));
        let largest = |part: &[f64]| part.iter().fold(0.0, |most: f64, term| most.max(term.abs()));
        let (lower, higher) = terms.split_at(terms.len().div_ceil(2));
        if largest(higher) <= largest(lower) {
            break;
        }
        time_scale *= 0.5;
    }
    terms
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_term_above_rounding_decides() {
        let of = |series: &[f64], known, size| {
            let mut all = [0.0; 17];
            all[..series.len()].copy_from_slice(series);
            Departure::of(&all, known, size, 0.1)
        };
        // A velocity that reverses: its value is rounding, of either sign.
        for rounding in [1e-17, -1e-17, 0.0] {
            let found = of(&[rounding, -3.0, 0.5], 0, 1e-17);
            assert_eq!(found, Departure { zeros: 1, sign: -1 });
        }
        assert_eq!(of(&[0.2, -3.0], 0, 0.2), Departure { zeros: 0, sign: 1 });
        // A difference of large parts is rounding.
        assert_eq!(of(&[0.0, 1e-12, 2.0], 1, 5.0), Departure { zeros: 2, sign: 1 });
        assert_eq!(of(&[7.0, 1e-3, 2.0], 1, 5.0), Departure { zeros: 1, sign: 1 });
        assert_eq!(of(&[0.0, 1e-12, -1e-13], 0, 1.0), Departure { zeros: 1, sign: 1 });
        assert_eq!(of(&[0.0; 4], 0, 1.0), Departure { zeros: 0, sign: 0 });
        // A series that converges within a tenth of the time scale alone: 0.04 is not rounding.
        let steep: Vec<f64> = (0..17).map(|k| 0.04 * 100_f64.powi(k)).collect();
        assert_eq!(of(&steep, 0, 0.04), Departure { zeros: 0, sign: 1 });
        assert_eq!(of(&[&[1e-18], &steep[1..]].concat(), 0, 1e-18).zeros, 1);
    }
}
