//! Averages along a section, weighted by a smooth bump function.
//!
//! Σ w(t) f / Σ w(t) with w(t) = exp(−1/(t(1 − t))) over the record of length n. For quasi-periodic motion it converges faster
//! than any power of 1/n, whereas the error of the plain mean is of order 1/n (Das, Saiki, Sander, Yorke, 2017).

/// The bump, normalised to Σ w = 1, for `count` values.
pub(super) fn weights(count: usize) -> Vec<f64> {
    let step = 1.0 / (count as f64 + 1.0);
    let mut weights: Vec<f64> = (1..=count).map(|k| bump(k as f64 * step)).collect();
    let sum: f64 = weights.iter().sum();
    for weight in &mut weights {
        *weight /= sum;
    }
    weights
}

/// exp(−1/(t(1 − t))) inside 0…1, 0 outside.
pub(super) fn bump(t: f64) -> f64 {
    let room = t * (1.0 - t);
    if room > 0.0 { libm::exp(-1.0 / room) } else { 0.0 }
}

/// Weighted mean.
pub(super) fn mean(weights: &[f64], values: impl IntoIterator<Item = f64>) -> f64 {
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}

/// Centre and second moments of states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moments {
    /// Mean of x and of x′.
    pub(super) centre: [f64; 2],
    /// Mean of (x − x̄)², (x − x̄)(x′ − x̄′), (x′ − x̄′)².
    pub(super) spread: [f64; 3],
}

impl Moments {
    /// The moments of a section, computed about its first state: a section that is a single state then has exactly no spread;
    /// about the origin, rounding of the squares would leave 10⁻⁸ of the distance.
    pub(super) fn of(section: &[(f64, f64)]) -> Self {
        let mut sums = Sums::default();
        let (first_x, first_v) = section.first().copied().unwrap_or_default();
        for (weight, &(x, v)) in weights(section.len()).iter().zip(section) {
            sums.add(*weight, x - first_x, v - first_v);
        }
        let moments = sums.moments();
        let [x, v] = moments.centre;
        Self { centre: [x + first_x, v + first_v], ..moments }
    }

    /// Root-mean-square distance from the centre.
    pub(super) fn size(&self) -> f64 {
        libm::sqrt((self.spread[0] + self.spread[2]).max(0.0))
    }

    /// The largest difference of centre and of size and shape, a length; `size` is the size of the motion that may differ.
    pub(super) fn distance(&self, other: &Self, size: f64) -> f64 {
        let centre = |k: usize| (self.centre[k] - other.centre[k]).abs();
        // δ(s²) = 2sδs.
        let size = size.max(f64::MIN_POSITIVE);
        let shape = |k: usize| 0.5 * (self.spread[k] - other.spread[k]).abs() / size;
        [centre(0), centre(1), shape(0), shape(1), shape(2)].into_iter().fold(0.0, f64::max)
    }
}

/// Weighted sums of 1, x, x′, x², xx′, x′².
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums([f64; 6]);

impl Sums {
    #[inline(always)]
    pub(super) fn add(&mut self, weight: f64, x: f64, v: f64) {
        let terms = [1.0, x, v, x * x, x * v, v * v];
        for (sum, term) in self.0.iter_mut().zip(terms) {
            *sum = f64::mul_add(weight, term, *sum);
        }
    }

    pub(super) fn moments(&self) -> Moments {
        let [one, x, v, xx, xv, vv] = self.0;
        let centre = [x / one, v / one];
        let [cx, cv] = centre;
        Moments { centre, spread: [xx / one - cx * cx, xv / one - cx * cv, vv / one - cv * cv] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_state_has_no_spread() {
        for state in [(0.517_215_1, 0.126_522_8), (1e8, -3.0)] {
            let moments = Moments::of(&[state; 64]);
            assert_eq!((moments.centre, moments.size()), ([state.0, state.1], 0.0));
        }
    }

    #[test]
    fn a_quasi_periodic_mean_converges_fast() {
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let value = |k: usize| {
            let angle = std::f64::consts::TAU * golden * k as f64;
            0.7 + angle.cos() + 0.3 * (2.0 * angle + 1.0).sin()
        };
        let weights = weights(1000);
        let found = mean(&weights, (0..1000).map(value));
        assert!((found - 0.7).abs() < 1e-12, "{found}");
        // The plain mean of the same record is a million times worse.
        let plain = (0..1000).map(value).sum::<f64>() / 1000.0;
        assert!((plain - 0.7).abs() > 1e-5, "{plain}");
    }
}
