//! The slow equations of the wave amplitudes: self terms and couplings.
//!
//! g² = φ(r₀)²/2 (l ≠ 0) or φ(r₀)² (l = 0), ρ = σg²/(2β), friction f(τ) = f₀ + f₁(e^{iRτ} + e^{−iRτ}):
//!
//! ```text
//! a₁' = D₁a₁ + c₁₂ a₂ e^{i(w₂ + hR − w₁)τ}
//! D = iρ (k − m w² + i c w − i l F₀) − ξβ
//! c₁₂ = i ρ₁ (g₂/g₁) [ (k − m w₂² + i c w₂) δ_h0 − i l₂ F_h ]
//! F_h = f_h                                           first order (5.43)–(5.54)
//! F_h = f_h + Σ_{a+b=h} f_a f_b H(w₂ + bR)            high friction (5.57)–(5.66)
//! H(y) = −i Σ l ρ/(y − w)     over all waves except those in resonance with y
//! ```
//!
//! Without dither: f₀ = f. Normal dither, f(1 + α cos Rτ): f₀ = f, f₁ = αf/2. Tangential dither, fα cos Rτ: f₀ = 0, f₁ = αf/2.
//! Other waveforms have f_h = αf c_h at every harmonic (`harmonics`); at second order their sums extend over the strong ones.
//! ξ is the damping ratio of a disc at rest: every wave decays at the rate ξβ.

use core::ops::RangeInclusive;

use num_complex::Complex64;

use crate::boundaries::NOT_PLAIN;

use super::harmonics::Harmonics;
use super::wave::{SignedWave, TravellingWave, WaveDirection};
use quell_model::disc::{Disc, DiscDither};
use quell_model::disc::{Load, Mode};

/// Order of the expansion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// m, c, k, f, ξ of order ε.
    First,
    /// High friction: f of order √ε, with the terms quadratic in friction.
    Second,
}

/// Waves of the modes of a disc under its load.
#[derive(Debug, Clone, PartialEq)]
pub struct Waves {
    pub(super) modes: Vec<Mode>,
    pub(super) list: Vec<TravellingWave>,
    pub(super) load: Load,
    pub(super) dither: DiscDither,
    pub(super) harmonics: Harmonics,
    pub(super) order: Order,
}

/// Why resonance theory does not apply to a disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WaveError {
    /// The number of loads is not one: the couplings of several loads interfere, which the expansion neglects.
    Loads(usize),
    /// The load is distributed, its pad moves, or a law gives its friction.
    NotPlain,
    /// Centrifugal stress changes the frequencies of the waves with the speed.
    Stiffened,
    /// Friction is negative: describe the disc from the other side instead (−Ω, −f).
    NegativeFriction {
        /// The friction given.
        friction: f64,
    },
    /// The dither frequency is not a positive number.
    Frequency {
        /// The frequency given.
        frequency_ratio: f64,
    },
}

impl core::fmt::Display for WaveError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Loads(count) => {
                write!(f, "resonance theory applies to one load only, but the disc has {count}")
            }
            Self::NotPlain => f.write_str(NOT_PLAIN),
            Self::Stiffened => f.write_str(
                "resonance theory requires frequencies that do not depend on the speed, but centrifugal stress stiffens the disc",
            ),
            Self::NegativeFriction { friction } => write!(
                f,
                "the friction is {friction}, but resonance theory requires a positive one: change the signs of speed and friction"
            ),
            Self::Frequency { frequency_ratio } => {
                write!(
                    f,
                    "the dither frequency is {frequency_ratio}, but must be a positive number"
                )
            }
        }
    }
}

impl core::error::Error for WaveError {}

/// Two frequencies closer than this are one resonance. The rounding of β + sΩ is a thousand times smaller.
pub(super) const COINCIDENCE: f64 = 1e-9;

impl Waves {
    /// Waves of a disc under its single load, to first order. The speed of the disc is ignored.
    ///
    /// # Errors
    /// [`WaveError::Loads`], [`WaveError::NegativeFriction`].
    pub fn new(disc: &Disc) -> Result<Self, WaveError> {
        let [load] = disc.loads() else { return Err(WaveError::Loads(disc.loads().len())) };
        if !disc.is_plain() {
            return Err(WaveError::NotPlain);
        }
        if disc.is_stiffened() {
            return Err(WaveError::Stiffened);
        }
        if load.friction < 0.0 {
            return Err(WaveError::NegativeFriction { friction: load.friction });
        }
        let modes: Vec<Mode> = disc
            .modes()
            .iter()
            .enumerate()
            .map(|(index, mode)| Mode { shape_at_load: disc.shape(index, 0), ..*mode })
            .collect();
        let list = list(&modes);
        let harmonics = Harmonics::of(disc.waveform());
        let (load, dither) = (load.clone(), disc.dither());
        Ok(Self { modes, list, load, dither, harmonics, order: Order::First })
    }

    /// These waves with another order of the expansion.
    #[must_use]
    pub fn with_order(self, order: Order) -> Self {
        Self { order, ..self }
    }

    /// These waves with another friction f, which must not be negative.
    #[must_use]
    pub fn with_friction(&self, friction: f64) -> Self {
        debug_assert!(friction >= 0.0, "friction {friction} < 0");
        let load = Load { friction, ..self.load.clone() };
        Self { load, ..self.clone() }
    }

    /// These waves with another dither frequency, if there is dither.
    ///
    /// # Errors
    /// [`WaveError::Frequency`] where the frequency is not a positive number.
    pub fn with_dither_frequency(&self, frequency_ratio: f64) -> Result<Self, WaveError> {
        if !(frequency_ratio > 0.0 && frequency_ratio.is_finite()) {
            return Err(WaveError::Frequency { frequency_ratio });
        }
        let dither = match self.dither {
            DiscDither::None => DiscDither::None,
            DiscDither::Normal { amplitude, .. } => {
                DiscDither::Normal { amplitude, frequency_ratio }
            }
            DiscDither::Tangential { amplitude, .. } => {
                DiscDither::Tangential { amplitude, frequency_ratio }
            }
        };
        Ok(Self { dither, ..self.clone() })
    }

    /// All waves, without conjugates.
    #[must_use]
    pub fn waves(&self) -> &[TravellingWave] {
        &self.list
    }

    /// Growth rate of one wave away from every resonance: −(g²/2β)[c(β + sΩ) − s f₀] − ξβ at first order.
    #[must_use]
    pub fn growth_rate(&self, wave: &TravellingWave, speed: f64) -> f64 {
        self.self_term(&SignedWave::new(wave, false), speed, &[]).re
    }

    /// Frequency ratio R′ at which the dither repeats itself, if there is dither: R, of a burst R over its cycles.
    pub(super) fn dither_frequency(&self) -> Option<f64> {
        self.dither.frequency_ratio().map(|ratio| ratio / self.harmonics.cycles())
    }

    /// f₀ and |f_h| for a friction f.
    pub(super) fn friction_parts(&self, friction: f64, h: i32) -> (f64, f64) {
        let (mean, amplitude) = self.dither.mean_and_amplitude();
        (mean * friction, self.harmonics.size(h) * amplitude * friction)
    }

    /// The largest harmonic at which two waves can meet at a speed of this size, for a dither that repeats itself at the
    /// frequency ratio R′.
    pub(super) fn highest_harmonic(&self, speed: f64, repetition: f64) -> f64 {
        let fastest = |wave: &TravellingWave| {
            wave.signed_diameters().abs().mul_add(speed.abs(), self.modes[wave.mode].ratio)
        };
        // A meeting at the end of the range counts as inside.
        2.0 * self.list.iter().map(fastest).fold(0.0, f64::max) / repetition + COINCIDENCE
    }

    /// Number of harmonics of the dither that are examined for meetings in a range of speeds at a frequency ratio R of its
    /// carrier; their meetings are proportional to it. 0 without dither.
    #[must_use]
    pub fn harmonics_within(&self, speeds: &RangeInclusive<f64>, frequency_ratio: f64) -> f64 {
        let speed = speeds.start().abs().max(speeds.end().abs());
        let repetition = frequency_ratio / self.harmonics.cycles();
        match self.dither {
            DiscDither::None => 0.0,
            _ => self.highest_harmonic(speed, repetition).floor(),
        }
    }

    /// The harmonics h ≥ 1 of the dither at which two waves can meet and couple in a range of speeds, for a dither that repeats
    /// itself at the frequency ratio R′.
    pub(super) fn driven(&self, speeds: &RangeInclusive<f64>, repetition: f64) -> Vec<i32> {
        let speed = speeds.start().abs().max(speeds.end().abs());
        let highest = self.highest_harmonic(speed, repetition).min(f64::from(i32::MAX));
        let acts = |h: &i32| {
            let second = self.order == Order::Second && self.harmonics.is_sum_of_strong(*h);
            self.harmonics.size(*h) > 0.0 || second
        };
        (1..=i32::MAX).take_while(|h| f64::from(*h) <= highest).filter(acts).collect()
    }

    /// g² of a mode.
    pub(super) fn coupling_squared(&self, mode: usize) -> f64 {
        let mode = &self.modes[mode];
        let square = mode.shape_at_load * mode.shape_at_load;
        if mode.diameters == 0 { square } else { 0.5 * square }
    }

    /// ρ = σg²/(2β).
    pub(super) fn rho(&self, wave: &SignedWave) -> f64 {
        wave.sigma * self.coupling_squared(wave.mode) / (2.0 * self.modes[wave.mode].ratio)
    }

    /// w = lΩ + σβ.
    pub(super) fn signed_frequency(&self, wave: &SignedWave, speed: f64) -> f64 {
        wave.l * speed + wave.sigma * self.modes[wave.mode].ratio
    }

    /// k − m w² + i c w.
    pub(super) fn impedance(&self, frequency: f64) -> Complex64 {
        let load = &self.load;
        Complex64::new(load.stiffness - load.mass * frequency * frequency, load.damping * frequency)
    }

    /// F_h for a slope of frequency w; `resonant` waves are excluded from the second order.
    fn effective_friction(
        &self,
        h: i32,
        frequency: f64,
        speed: f64,
        resonant: &[SignedWave],
    ) -> Complex64 {
        let friction = self.load.friction;
        let (mean, amplitude) = self.dither.mean_and_amplitude();
        let part = |a: i32| match a {
            0 => Complex64::new(mean * friction, 0.0),
            _ => self.harmonics.coefficient(a) * amplitude * friction,
        };
        let mut sum = part(h);
        if self.order == Order::Second {
            let dither = self.dither_frequency().unwrap_or(0.0);
            for &(b, _) in self.harmonics.strong() {
                let product = part(h - b) * part(b);
                if product.norm_sqr() > 0.0 {
                    let shifted = frequency + f64::from(b) * dither;
                    sum += product * self.slope_response(shifted, speed, resonant);
                }
            }
        }
        sum
    }

    /// H(y) = −i Σ l ρ/(y − w): slope at the load due to a unit friction moment of frequency y.
    fn slope_response(&self, y: f64, speed: f64, resonant: &[SignedWave]) -> Complex64 {
        let mut sum = 0.0;
        for wave in &self.list {
            for conjugate in [false, true] {
                let wave = SignedWave::new(wave, conjugate);
                let distance = y - self.signed_frequency(&wave, speed);
                if resonant.contains(&wave) && distance.abs() < COINCIDENCE {
                    continue;
                }
                sum += wave.l * self.rho(&wave) / distance;
            }
        }
        Complex64::new(0.0, -sum)
    }

    /// D of a wave.
    pub(super) fn self_term(
        &self,
        wave: &SignedWave,
        speed: f64,
        resonant: &[SignedWave],
    ) -> Complex64 {
        let mode = &self.modes[wave.mode];
        let w = self.signed_frequency(wave, speed);
        let both: &[SignedWave] =
            if resonant.is_empty() { core::slice::from_ref(wave) } else { resonant };
        let i = Complex64::i();
        let friction = self.effective_friction(0, w, speed, both);
        i * self.rho(wave) * (self.impedance(w) - i * wave.l * friction) - mode.damping * mode.ratio
    }

    /// c₁₂c₂₁ of a pair with w₁ = w₂ + hR.
    pub(super) fn coupling_product(
        &self,
        first: &SignedWave,
        second: &SignedWave,
        h: i32,
        speed: f64,
    ) -> Complex64 {
        let i = Complex64::i();
        let resonant = [*first, *second];
        let factor = |wave: &SignedWave, shift: i32| {
            let w = self.signed_frequency(wave, speed);
            let friction = self.effective_friction(shift, w, speed, &resonant);
            let plain = if h == 0 { self.impedance(w) } else { Complex64::new(0.0, 0.0) };
            plain - i * wave.l * friction
        };
        -self.rho(first) * self.rho(second) * factor(second, h) * factor(first, -h)
    }
}

/// Waves of the modes, in the order of the modes.
fn list(modes: &[Mode]) -> Vec<TravellingWave> {
    let mut waves = Vec::with_capacity(2 * modes.len());
    for (index, mode) in modes.iter().enumerate() {
        let lower = |other: &(usize, &Mode)| {
            other.1.diameters == mode.diameters
                && (other.1.ratio < mode.ratio || (other.1.ratio == mode.ratio && other.0 < index))
        };
        let radial = 1 + modes.iter().enumerate().filter(lower).count();
        let directions: &[WaveDirection] = if mode.diameters == 0 {
            &[WaveDirection::Axisymmetric]
        } else {
            &[WaveDirection::Forward, WaveDirection::Backward]
        };
        for direction in directions {
            let diameters = mode.diameters;
            waves.push(TravellingWave { mode: index, radial, diameters, direction: *direction });
        }
    }
    waves
}
