//! The least amplitude of a dither at which it makes two waves grow at one speed, at first order.
//!
//! The product of the couplings of a pair that meets at a harmonic of the dither is p = α² p₁ > 0 (`pair`), and neither the dampings
//! η₁, η₂ nor the frequencies depend on α at this order. With the detuning D at the speed, frequency shifts included, the pair grows
//! from
//!
//! ```text
//! α² = η₁ η₂ (1 + D²/(η₁ + η₂)²) / p₁
//! ```
//!
//! on. A pair of a forward and a backward wave has p₁ < 0 and no such amplitude.

use super::meetings::MeetingFamily;
use super::waves::{Order, Waves};
use quell_model::disc::DiscDither;

impl Waves {
    /// These waves with another amplitude of the dither, if there is dither.
    #[must_use]
    pub fn with_dither_amplitude(&self, amplitude: f64) -> Self {
        let dither = match self.dither {
            DiscDither::None => DiscDither::None,
            DiscDither::Normal { frequency_ratio, .. } => {
                DiscDither::Normal { amplitude, frequency_ratio }
            }
            DiscDither::Tangential { frequency_ratio, .. } => {
                DiscDither::Tangential { amplitude, frequency_ratio }
            }
        };
        Self { dither, ..self.clone() }
    }

    /// The least amplitude at which a pair of waves that the dither couples grows at a speed; `None` without such a pair. Waves that
    /// grow by themselves are left out: no amplitude is theirs.
    #[must_use]
    pub fn least_growing_amplitude(&self, speed: f64) -> Option<f64> {
        let unit = self.with_dither_amplitude(1.0).with_order(Order::First);
        let repetition = unit.dither_frequency()?;
        let driven = unit.driven(&(speed..=speed), repetition).into_iter();
        let families = driven.flat_map(|h| unit.families(h));
        families
            .filter_map(|family| unit.amplitude_of(&family, speed, repetition))
            .min_by(f64::total_cmp)
    }

    fn amplitude_of(&self, family: &MeetingFamily, speed: f64, repetition: f64) -> Option<f64> {
        let pair = self.pair(&Self::meeting_of(family, speed));
        let (first, second) = (-pair.first.re, -pair.second.re);
        let product = pair.product.re;
        if !(first > 0.0 && second > 0.0 && product > 0.0) {
            return None;
        }
        let [one, two] = family.signed();
        let apart = self.signed_frequency(&one, speed) - self.signed_frequency(&two, speed);
        let detuning = apart - f64::from(family.h) * repetition + pair.first.im - pair.second.im;
        let share = detuning / (first + second);
        Some((first * second * share.mul_add(share, 1.0) / product).sqrt())
    }
}
