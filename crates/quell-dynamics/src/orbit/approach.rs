//! The approach of a run to steady sliding: every small motion about it shrinks at the rate of its eigenvalue, long before the run is
//! at rest.

use num_complex::Complex64;
use quell_linear::linearised::Linearised;
use quell_model::System;
use quell_numerics::eigen::Decomposition;
use quell_numerics::polar::modulus;

use super::periodic::sliding_state;
use crate::decay::decays_at;

/// Parts of the motion smaller than this share of the largest are not compared: through the curvature of the friction law the others
/// feed them. With a larger share a slow part that decides could be left out; with a smaller one the approach is recognised later.
const SHARE: f64 = 1e-2;

/// Comparisons one after the other that must agree. With fewer a run that passes by could agree by chance; more only take longer.
const AGREEMENTS: u32 = 3;

/// One small motion about steady sliding, which decays.
struct DecayingMotion {
    rate: f64,
    left: Vec<Complex64>,
    /// Size of its right vector: the product with `left` times this is its size in the state.
    size: f64,
}

/// The approach of one run.
pub(super) struct ApproachToSliding {
    sliding: Vec<f64>,
    parts: Vec<DecayingMotion>,
    /// Time and sizes of the parts at the last comparison, and how many comparisons have agreed.
    last: Option<(f64, Vec<f64>)>,
    agreed: u32,
}

impl ApproachToSliding {
    /// For a system whose steady sliding exists and is stable.
    pub(super) fn of(system: &System) -> Option<Self> {
        if system.has_contact_state() {
            // Its small motions are not those of the linear system.
            return None;
        }
        let sliding = sliding_state(system).ok()?;
        let linear = Linearised::new(system).ok()?;
        let matrix = linear.state_matrix_with(&linear.friction());
        let decomposition = Decomposition::new(&matrix).ok()?;
        let count = decomposition.values().len();
        let mut parts = Vec::with_capacity(count);
        for index in 0..count {
            let pair = decomposition.pair(index);
            if !pair.condition.is_finite() || pair.value.re >= -decomposition.error_of(&pair) {
                return None;
            }
            let size = pair.right.iter().fold(0.0, |m: f64, x| m.max(modulus(*x)));
            parts.push(DecayingMotion { rate: pair.value.re, left: pair.left, size });
        }
        (sliding.len() == count).then_some(Self { sliding, parts, last: None, agreed: 0 })
    }

    /// Steady sliding, if the run, at this state and time, has approached it at the rates of the small motions about it since the last
    /// calls. A run whose contacts have released since does not.
    pub(super) fn certain(
        &mut self,
        time: f64,
        state: &[f64],
        has_released: bool,
    ) -> Option<Vec<f64>> {
        let off: Vec<f64> = state.iter().zip(&self.sliding).map(|(a, b)| a - b).collect();
        if has_released {
            (self.last, self.agreed) = (None, 0);
            return None;
        }
        let sizes: Vec<f64> = self
            .parts
            .iter()
            .map(|part| {
                let along: Complex64 = part.left.iter().zip(&off).map(|(y, d)| y * d).sum();
                part.size * modulus(along)
            })
            .collect();
        let (before, earlier) = self.last.replace((time, sizes.clone()))?;
        let largest = earlier.iter().fold(0.0, |m: f64, size| m.max(*size));
        let agrees =
            self.parts.iter().zip(earlier.iter().zip(&sizes)).all(|(part, (then, now))| {
                *then <= SHARE * largest || {
                    let measured = libm::log(now / then) / (time - before);
                    decays_at(measured, part.rate)
                }
            });
        self.agreed = if agrees { self.agreed + 1 } else { 0 };
        (self.agreed >= AGREEMENTS).then(|| self.sliding.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_that_decays_at_its_rates_approaches_and_another_does_not() {
        let parts = || {
            let part = |rate: f64, place: usize| {
                let mut left = vec![Complex64::new(0.0, 0.0); 2];
                left[place] = Complex64::new(1.0, 0.0);
                DecayingMotion { rate, left, size: 1.0 }
            };
            vec![part(-0.1, 0), part(-0.3, 1)]
        };
        let run = |motion: &dyn Fn(f64) -> [f64; 2], released: bool| {
            let sliding = vec![1.0, 2.0];
            let mut approach = ApproachToSliding { sliding, parts: parts(), last: None, agreed: 0 };
            (0..8).any(|step| {
                let time = 0.5 * f64::from(step);
                let [x, y] = motion(time);
                approach.certain(time, &[1.0 + x, 2.0 + y], released).is_some()
            })
        };
        let decaying = |t: f64| [0.05 * libm::exp(-0.1 * t), 0.02 * libm::exp(-0.3 * t)];
        assert!(run(&decaying, false));
        assert!(!run(&decaying, true));
        assert!(!run(&|t| [0.05 * libm::exp(-0.08 * t), 0.0], false));
        assert!(!run(&|t| [0.05 * libm::cos(t), 0.0], false));
    }
}
