//! The harmonics of the dither: friction is f(τ) = f (m + α Σ_n c_n e^{inR′τ}), R′ the frequency ratio at which the dither repeats
//! itself.
//!
//! Every waveform is the sum of its harmonics, so that waves meet at w₁ = w₂ + hR′ for each h with c_h ≠ 0. Of a sine c_±1 = 1/2, of
//! a square wave c_n = ±2/(πn) for odd n, and of a burst R′ = R over the cycles of the carrier. Only |c_h| enters a meeting at
//! first order, so that the phase of the dither does not matter.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use num_complex::Complex64;
use quell_model::Waveform;

/// Coefficients kept per cycle of the carrier; those beyond are computed where they are needed.
const KEPT_PER_CYCLE: u32 = 64;

/// Largest number of coefficients kept.
const MOST_KEPT: u32 = 8192;

/// Size of a coefficient relative to the largest below which it is rounding.
const NONE: f64 = 1e-12;

/// Size of a coefficient relative to the largest from which it enters the sums of second order. The sums converge faster than
/// those of the squares of the coefficients, of which those left out are about 10⁻² where the wave jumps.
const STRONG: f64 = 1e-2;

/// The coefficients c_n of a waveform of unit amplitude that leads by a quarter of a cycle of its carrier.
#[derive(Debug, Clone)]
pub(super) struct Harmonics {
    waveform: Waveform,
    /// c_1, c_2, ….
    kept: Arc<[Complex64]>,
    largest: f64,
    /// n and c_n of the strong harmonics, of both signs, by n; c_0 = 0 among them, in whose place is the mean.
    strong: Arc<[(i32, Complex64)]>,
}

impl PartialEq for Harmonics {
    /// The waveform determines the rest.
    fn eq(&self, other: &Self) -> bool {
        self.waveform == other.waveform
    }
}

impl Harmonics {
    pub(super) fn of(waveform: &Waveform) -> Self {
        let count = match waveform {
            Waveform::Sine | Waveform::Fourier(_) => waveform.highest_order(),
            _ => KEPT_PER_CYCLE.saturating_mul(waveform.cycles()).min(MOST_KEPT),
        };
        let kept: Arc<[Complex64]> = (1..=count).map(|n| computed(waveform, n)).collect();
        let largest = kept.iter().map(|c| c.norm_sqr().sqrt()).fold(0.0, f64::max);
        let mut positive: Vec<(i32, Complex64)> = (1..)
            .zip(kept.iter().copied())
            .filter(|(_, c)| c.norm_sqr().sqrt() >= STRONG * largest)
            .collect();
        let mut strong: Vec<(i32, Complex64)> =
            positive.iter().rev().map(|(n, c)| (-n, c.conj())).collect();
        strong.push((0, Complex64::new(0.0, 0.0)));
        strong.append(&mut positive);
        Self { waveform: waveform.clone(), kept, largest, strong: strong.into() }
    }

    /// Cycles of the carrier in a period: R over R′.
    pub(super) fn cycles(&self) -> f64 {
        f64::from(self.waveform.cycles())
    }

    /// c_n, n ≠ 0.
    pub(super) fn coefficient(&self, n: i32) -> Complex64 {
        let order = n.unsigned_abs();
        let known = order.checked_sub(1).and_then(|index| self.kept.get(index as usize)).copied();
        let finite = matches!(self.waveform, Waveform::Sine | Waveform::Fourier(_));
        let value = match known {
            Some(value) => value,
            None if finite || order == 0 => Complex64::new(0.0, 0.0),
            None => computed(&self.waveform, order),
        };
        if n < 0 { value.conj() } else { value }
    }

    /// |c_n|; 0 where it is rounding.
    pub(super) fn size(&self, n: i32) -> f64 {
        let size = self.coefficient(n).norm_sqr().sqrt();
        if size > NONE * self.largest { size } else { 0.0 }
    }

    /// n and c_n of the harmonics that enter sums of second order, by n; (0, 0) is among them.
    pub(super) fn strong(&self) -> &[(i32, Complex64)] {
        &self.strong
    }

    /// Whether n is the sum of two strong harmonics, neither of which is the mean.
    pub(super) fn is_sum_of_strong(&self, n: i32) -> bool {
        let is_strong =
            |n: i32| n != 0 && self.strong.binary_search_by_key(&n, |(known, _)| *known).is_ok();
        self.strong.iter().any(|(a, _)| is_strong(*a) && is_strong(n - a))
    }
}

/// c_n = (a_n − ib_n)/2 · e^{inπ/2c}, c the cycles of a period.
fn computed(waveform: &Waveform, n: u32) -> Complex64 {
    let [cosine, sine] = waveform.fourier_coefficient(n);
    let (half_cosine, half_sine) = (0.5 * cosine, 0.5 * sine);
    let cycles = waveform.cycles();
    if cycles == 1 {
        // Multiplied by iⁿ.
        return match n % 4 {
            0 => Complex64::new(half_cosine, -half_sine),
            1 => Complex64::new(half_sine, half_cosine),
            2 => Complex64::new(-half_cosine, half_sine),
            _ => Complex64::new(-half_sine, -half_cosine),
        };
    }
    let quarters = u64::from(n) % (4 * u64::from(cycles));
    let (shift_sine, shift_cosine) = libm::sincos(FRAC_PI_2 * quarters as f64 / f64::from(cycles));
    Complex64::new(half_cosine, -half_sine) * Complex64::new(shift_cosine, shift_sine)
}
