//! The slow equations of the waves' amplitudes: self terms and couplings.
//!
//! g² = φ(r₀)²/2 (l ≠ 0) or φ(r₀)² (l = 0), ρ = σg²/(2β), friction f(τ) = f₀ + f₁(e^{iRτ} + e^{−iRτ}):
//!
//! ```text
//! a₁' = D₁a₁ + c₁₂ a₂ e^{i(w₂ + hR − w₁)τ}
//! D = iρ (k − m w² + i c w − i l F₀) − ξβ
//! c₁₂ = i ρ₁ (g₂/g₁) [ (k − m w₂² + i c w₂) δ_h0 − i l₂ F_h ]
//! F_h = f_h                                           first order (5.43)–(5.54)
//! F_h = f_h + Σ_{a+b=h} f_a f_b H(w₂ + bR)            high friction (5.57)–(5.66)
//! H(y) = −i Σ l ρ/(y − w)     over all waves but those in resonance with y
//! ```
//!
//! No dither: f₀ = f. Normal, f(1 + α cos Rτ): f₀ = f, f₁ = αf/2. Tangential, fα cos Rτ: f₀ = 0, f₁ = αf/2.
//! ξ is the damping of a disc at rest: every wave decays with ξβ.

use num_complex::Complex64;

use super::wave::{Direction, SignedWave, Wave, WaveMode};

/// Mass, damper, spring and friction of the load, in units of the plate's mass and ω_ref.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLoad {
    /// Mass m* = m/M_p.
    pub mass: f64,
    /// Damping c* = c/(M_p ω_ref).
    pub damping: f64,
    /// Stiffness k* = k/(M_p ω_ref²).
    pub stiffness: f64,
    /// Friction f* = F_θ/(r₀ M_p ω_ref²).
    pub friction: f64,
}

/// What friction does in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Dither {
    /// f(τ) = f.
    None,
    /// f(τ) = f(1 + α cos Rτ), 0 ≤ α ≤ 1.
    Normal {
        /// Amplitude α.
        amplitude: f64,
        /// Frequency R in units of ω_ref.
        frequency_ratio: f64,
    },
    /// f(τ) = fα cos Rτ.
    Tangential {
        /// Amplitude α.
        amplitude: f64,
        /// Frequency R in units of ω_ref.
        frequency_ratio: f64,
    },
}

/// How far the expansion goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// m, c, k, f, ξ of order ε.
    First,
    /// High friction: f of order √ε, friction counted twice.
    Second,
}

/// Waves of a list of modes under a load.
#[derive(Debug, Clone, PartialEq)]
pub struct Waves {
    pub(super) modes: Vec<WaveMode>,
    pub(super) list: Vec<Wave>,
    pub(super) load: ContactLoad,
    pub(super) dither: Dither,
    pub(super) order: Order,
}

/// A value that cannot be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WaveError {
    /// There is no mode.
    NoModes,
    /// A value of this mode is not finite, its frequency not positive, or its damping negative.
    Mode {
        /// Index of the mode.
        mode: usize,
    },
    /// A value of the load is not finite, or mass, damping, stiffness or friction is negative.
    Load,
    /// The dither's frequency is not positive, or its amplitude is negative or, for normal dither, above 1.
    Dither,
}

impl core::fmt::Display for WaveError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NoModes => f.write_str("there is no mode"),
            Self::Mode { mode } => write!(
                f,
                "mode {mode}: the frequency must be positive, the damping not negative, the shape finite"
            ),
            Self::Load => f.write_str("mass, damping, stiffness and friction of the load must not be negative"),
            Self::Dither => f.write_str(
                "the dither's frequency must be positive and its amplitude not negative; for normal dither at most 1",
            ),
        }
    }
}

impl core::error::Error for WaveError {}

/// Two frequencies nearer than this are one resonance: rounding of β + sΩ is a thousand times smaller.
pub(super) const COINCIDENCE: f64 = 1e-9;

impl Waves {
    /// Waves of the given modes under one load, first order.
    ///
    /// # Errors
    /// [`WaveError`] where a value cannot be.
    pub fn new(modes: &[WaveMode], load: ContactLoad, dither: Dither) -> Result<Self, WaveError> {
        if modes.is_empty() {
            return Err(WaveError::NoModes);
        }
        let possible = |mode: &WaveMode| {
            mode.ratio > 0.0
                && mode.ratio.is_finite()
                && mode.shape_at_load.is_finite()
                && mode.damping >= 0.0
                && mode.damping.is_finite()
        };
        if let Some(mode) = modes.iter().position(|mode| !possible(mode)) {
            return Err(WaveError::Mode { mode });
        }
        let values = [load.mass, load.damping, load.stiffness, load.friction];
        if !values.iter().all(|value| *value >= 0.0 && value.is_finite()) {
            return Err(WaveError::Load);
        }
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let allowed = match dither {
            Dither::None => true,
            Dither::Normal { amplitude, frequency_ratio } => {
                (0.0..=1.0).contains(&amplitude) && positive(frequency_ratio)
            }
            Dither::Tangential { amplitude, frequency_ratio } => {
                amplitude >= 0.0 && amplitude.is_finite() && positive(frequency_ratio)
            }
        };
        if !allowed {
            return Err(WaveError::Dither);
        }
        Ok(Self { modes: modes.to_vec(), list: list(modes), load, dither, order: Order::First })
    }

    /// The same with another order of the expansion.
    #[must_use]
    pub fn with_order(self, order: Order) -> Self {
        Self { order, ..self }
    }

    /// The same with another friction f; a negative one counts as 0.
    #[must_use]
    pub fn with_friction(&self, friction: f64) -> Self {
        let load = ContactLoad { friction: friction.max(0.0), ..self.load };
        Self { load, ..self.clone() }
    }

    /// The same with another frequency of the dither, if there is a dither.
    ///
    /// # Errors
    /// [`WaveError::Dither`] where the frequency is not a positive number.
    pub fn with_dither_frequency(&self, frequency_ratio: f64) -> Result<Self, WaveError> {
        let dither = match self.dither {
            Dither::None => Dither::None,
            Dither::Normal { amplitude, .. } => Dither::Normal { amplitude, frequency_ratio },
            Dither::Tangential { amplitude, .. } => {
                Dither::Tangential { amplitude, frequency_ratio }
            }
        };
        Self::new(&self.modes, self.load, dither).map(|waves| waves.with_order(self.order))
    }

    /// All waves, conjugates not counted.
    #[must_use]
    pub fn waves(&self) -> &[Wave] {
        &self.list
    }

    /// Growth rate of one wave away from every resonance, −(g²/2β)[c(β + sΩ) − s f₀] − ξβ at first order.
    #[must_use]
    pub fn growth_rate(&self, wave: &Wave, speed: f64) -> f64 {
        self.self_term(&SignedWave::new(wave, false), speed, &[]).re
    }

    /// Friction f at which a backward wave by itself becomes unstable, c(β/l + Ω) + 2ξβ²/(l g²); `None` where it does
    /// not: forward and axisymmetric waves, waves with a node at the load, and under tangential dither, whose mean is zero.
    #[must_use]
    pub fn friction_limit(&self, wave: &Wave, speed: f64) -> Option<f64> {
        let mode = &self.modes[wave.mode];
        let (mean, _) = self.friction_parts(1.0);
        let l = wave.signed_diameters();
        let g2 = self.coupling_squared(wave.mode);
        (l > 0.0 && g2 > 0.0 && mean > 0.0).then(|| {
            self.load.damping * (mode.ratio / l + speed)
                + 2.0 * mode.damping * mode.ratio * mode.ratio / (l * g2)
        })
    }

    /// Frequency R of the dither, where there is one.
    pub(super) fn dither_frequency(&self) -> Option<f64> {
        match self.dither {
            Dither::None => None,
            Dither::Normal { frequency_ratio, .. } | Dither::Tangential { frequency_ratio, .. } => {
                Some(frequency_ratio)
            }
        }
    }

    /// f₀ and f₁ for a friction f.
    pub(super) fn friction_parts(&self, friction: f64) -> (f64, f64) {
        match self.dither {
            Dither::None => (friction, 0.0),
            Dither::Normal { amplitude, .. } => (friction, 0.5 * amplitude * friction),
            Dither::Tangential { amplitude, .. } => (0.0, 0.5 * amplitude * friction),
        }
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

    /// F_h for a slope of frequency w; `resonant` waves take no part in the second order.
    fn effective_friction(
        &self,
        h: i32,
        frequency: f64,
        speed: f64,
        resonant: &[SignedWave],
    ) -> Complex64 {
        let (mean, half) = self.friction_parts(self.load.friction);
        let part = |a: i32| match a {
            0 => mean,
            1 | -1 => half,
            _ => 0.0,
        };
        let mut sum = Complex64::new(part(h), 0.0);
        if self.order == Order::Second {
            let dither = self.dither_frequency().unwrap_or(0.0);
            for b in -1..=1 {
                let product = part(h - b) * part(b);
                if product != 0.0 {
                    let place = frequency + f64::from(b) * dither;
                    sum += product * self.slope_response(place, speed, resonant);
                }
            }
        }
        sum
    }

    /// H(y) = −i Σ l ρ/(y − w): slope at the load for a unit friction moment of frequency y.
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

/// Waves of the modes, in the order of the list.
fn list(modes: &[WaveMode]) -> Vec<Wave> {
    let mut waves = Vec::with_capacity(2 * modes.len());
    for (index, mode) in modes.iter().enumerate() {
        let lower = |other: &(usize, &WaveMode)| {
            other.1.diameters == mode.diameters
                && (other.1.ratio < mode.ratio || (other.1.ratio == mode.ratio && other.0 < index))
        };
        let radial = 1 + modes.iter().enumerate().filter(lower).count();
        let directions: &[Direction] = if mode.diameters == 0 {
            &[Direction::Axisymmetric]
        } else {
            &[Direction::Forward, Direction::Backward]
        };
        for direction in directions {
            let diameters = mode.diameters;
            waves.push(Wave { mode: index, radial, diameters, direction: *direction });
        }
    }
    waves
}
