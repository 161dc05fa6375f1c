//! Shape of a fast slip velocity s(θ): the velocity of the mass over one period of one dither.
//!
//! There are two models, both scaled so that the amplitude in front of the shape is α = D/R:
//! * [`FastWave::Integral`]: s = αG(θ), the leading order of averaging (2.21), (3.19);
//! * [`FastWave::Oscillator`]: the exact periodic velocity of the undamped oscillator x″ + x = D g(Rτ), which contains
//!   every order in 1/R of the fast motion at no extra cost. With β = π/(2R) it is, for a
//!   sine, R²/(R² − 1) G; triangle, (2R²/(π cos β)) (cos β − cos(θ/R)) on |θ| ≤ π/2, continued antiperiodically;
//!   square, (R/cos β) sin((θ − π/2)/R) on 0 ≤ θ ≤ π, continued evenly. Damping is omitted deliberately: at a stability boundary
//!   the damper and the averaged friction slope cancel. Requires R > 1.
//!
//! * [`FastWave::Response`]: the periodic response of a linear structure, of every order in 1/R
//!   ([`crate::periodic_response`]): of the undamped oscillator to other waveforms, and of systems.
//!
//! The shapes of the sine, the triangle and the square are even and antiperiodic, and hence determined by a quarter wave σ(δ):
//! s = σ(θ − π/2) on [0, π]. σ is odd and increases from 0 at δ = 0 (to relative accuracy, also for tiny δ) to its peak at
//! δ = π/2. Other waveforms have no quarter wave (a sum of harmonics enters as its harmonics, each a sine), and averages over
//! them are by quadrature over the whole period.

use core::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use quell_model::Waveform;
use quell_model::waveform::Piece;
use quell_numerics::periodic_polynomial::PeriodicPolynomial;

/// Shape of the fast slip velocity of one dither, for unit amplitude α = D/R.
#[derive(Clone, Debug, PartialEq)]
pub enum FastWave {
    /// G, the zero-mean integral of the waveform: the limit of high frequency.
    Integral(Waveform),
    /// Velocity response of the undamped oscillator, divided by D/R.
    Oscillator {
        /// Waveform of the force.
        waveform: Waveform,
        /// Frequency ratio R > 1.
        frequency_ratio: f64,
    },
    /// Velocity response of a structure, by polynomials of the phase of the carrier.
    Response(Arc<PeriodicPolynomial>),
}

impl FastWave {
    /// Waveform of a force whose response has a formula.
    fn waveform(&self) -> Option<&Waveform> {
        match self {
            Self::Integral(waveform) | Self::Oscillator { waveform, .. } => Some(waveform),
            Self::Response(_) => None,
        }
    }

    /// Whether the shape is known from a quarter wave, as for the waveforms of the dissertation.
    pub fn is_symmetric(&self) -> bool {
        self.waveform().is_some_and(Waveform::is_symmetric)
    }

    /// Number of cycles 2π of the phase in one period: more than one for bursts.
    pub fn cycles(&self) -> u32 {
        match self {
            Self::Integral(waveform) | Self::Oscillator { waveform, .. } => waveform.cycles(),
            Self::Response(response) => cycles_of(response),
        }
    }

    /// Whether the shape is that of a sine.
    pub(super) fn is_sine(&self) -> bool {
        self.waveform() == Some(&Waveform::Sine)
    }

    /// Phases within the period between which the shape keeps its formula and its direction.
    pub(super) fn ends_of_monotone_parts(&self) -> Vec<f64> {
        match self {
            Self::Integral(waveform) | Self::Oscillator { waveform, .. } => {
                ends_of_monotone_parts(waveform)
            }
            Self::Response(response) => ends_of_response(response),
        }
    }

    /// The same shape with a separate factor. An oscillator preserves the shape of a sine, so the closed forms for G apply.
    pub(crate) fn canonical(self) -> (Self, f64) {
        match self {
            Self::Oscillator { waveform: Waveform::Sine, frequency_ratio: r } => {
                (Self::Integral(Waveform::Sine), sine_gain(r))
            }
            other => (other, 1.0),
        }
    }

    /// Largest value: G_max = 1, π/4, π/2 in the limit of high frequency.
    pub fn peak(&self) -> f64 {
        match self {
            Self::Integral(waveform) => waveform.peak_integral(),
            Self::Response(response) => {
                let [least, largest] = response.range();
                largest.max(-least)
            }
            Self::Oscillator { waveform, frequency_ratio: r } => {
                let r = *r;
                let half = FRAC_PI_2 / r;
                match waveform {
                    Waveform::Triangle => {
                        let s = libm::sin(0.5 * half);
                        4.0 * r * r * s * s / (PI * libm::cos(half))
                    }
                    Waveform::Square => r * libm::tan(half),
                    _ => sine_gain(r) * waveform.peak_integral(),
                }
            }
        }
    }

    /// Quarter wave σ(δ) of a symmetric waveform, 0 ≤ δ ≤ π/2.
    pub(crate) fn quarter(&self, delta: f64) -> f64 {
        match self {
            Self::Integral(Waveform::Triangle) => delta * (1.0 - delta / PI),
            Self::Integral(Waveform::Square) => delta,
            Self::Integral(_) => libm::sin(delta),
            &Self::Oscillator { ref waveform, frequency_ratio: r } => match waveform {
                Waveform::Triangle => {
                    let product = libm::sin(0.5 * delta / r) * libm::sin(0.5 * (PI - delta) / r);
                    4.0 * r * r / (PI * libm::cos(FRAC_PI_2 / r)) * product
                }
                Waveform::Square => r * libm::sin(delta / r) / libm::cos(FRAC_PI_2 / r),
                _ => sine_gain(r) * libm::sin(delta),
            },
            Self::Response(response) => response.value_and_slope(delta + FRAC_PI_2).0,
        }
    }

    /// dσ/dδ at 0 ≤ δ ≤ π/2.
    pub(crate) fn quarter_slope(&self, delta: f64) -> f64 {
        match self {
            Self::Integral(Waveform::Triangle) => 1.0 - 2.0 * delta / PI,
            Self::Integral(Waveform::Square) => 1.0,
            Self::Integral(_) => libm::cos(delta),
            &Self::Oscillator { ref waveform, frequency_ratio: r } => match waveform {
                Waveform::Triangle => {
                    let factor = 2.0 * r / (PI * libm::cos(FRAC_PI_2 / r));
                    factor * libm::sin((FRAC_PI_2 - delta) / r)
                }
                Waveform::Square => libm::cos(delta / r) / libm::cos(FRAC_PI_2 / r),
                _ => sine_gain(r) * libm::cos(delta),
            },
            Self::Response(response) => response.value_and_slope(delta + FRAC_PI_2).1,
        }
    }

    /// The δ in [0, π/2] at which ασ(δ) = value, and α dσ/dδ there, for 0 ≤ value < α·peak. Both are free of cancellation near
    /// either end. Of a symmetric waveform.
    pub(crate) fn crossing(&self, amplitude: f64, value: f64) -> (f64, f64) {
        let peak = amplitude * self.peak();
        let below = peak - value;
        match self {
            Self::Integral(Waveform::Triangle) => {
                let root = (below / peak).sqrt();
                // δ = (π/2)(1 − √(1 − value/peak))
                (FRAC_PI_2 * (value / peak) / (1.0 + root), amplitude * root)
            }
            Self::Integral(Waveform::Square) => (value / amplitude, amplitude),
            Self::Integral(_) | Self::Response(_) => {
                let steepness = (below * (peak + value)).sqrt();
                (libm::atan2(value, steepness), steepness)
            }
            &Self::Oscillator { waveform: Waveform::Triangle, frequency_ratio: r } => {
                let scale = 4.0 * r * r * amplitude / (PI * libm::cos(FRAC_PI_2 / r));
                let from_peak = 2.0 * r * libm::asin((below / scale).sqrt().min(1.0));
                let steepness = 0.5 * scale / r * libm::sin(from_peak / r);
                let mut delta = (FRAC_PI_2 - from_peak).max(0.0);
                // Near 0, δ has lost digits in the subtraction. Two Newton steps restore them.
                for _ in 0..2 {
                    if delta < 1.0 {
                        delta -= (amplitude * self.quarter(delta) - value)
                            / (amplitude * self.quarter_slope(delta));
                    }
                }
                (delta.max(0.0), steepness)
            }
            &Self::Oscillator { waveform: Waveform::Square, frequency_ratio: r } => {
                let half = libm::cos(FRAC_PI_2 / r);
                let delta = r * libm::asin((value * half / (amplitude * r)).min(1.0));
                (delta, amplitude * self.quarter_slope(delta))
            }
            Self::Oscillator { frequency_ratio, .. } => Self::Integral(Waveform::Sine)
                .crossing(amplitude * sine_gain(*frequency_ratio), value),
        }
    }

    /// s(θ) and ds/dθ for unit amplitude at any θ. At a corner of s, the slope beyond it.
    pub(crate) fn value_and_slope(&self, phase: f64) -> (f64, f64) {
        match self {
            Self::Response(response) => return response.value_and_slope(phase),
            Self::Integral(waveform) if !waveform.is_symmetric() => {
                return (waveform.integral(phase), waveform.value(phase));
            }
            Self::Integral(_) | Self::Oscillator { .. } => {}
        }
        let phase = phase.rem_euclid(TAU);
        let (folded, direction) = if phase < PI { (phase, 1.0) } else { (TAU - phase, -1.0) };
        let delta = folded - FRAC_PI_2;
        let size = delta.abs().min(FRAC_PI_2);
        (self.quarter(size).copysign(delta), direction * self.quarter_slope(size))
    }
}

/// Cycles 2π in the period of a response.
pub(super) fn cycles_of(response: &PeriodicPolynomial) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the period of a waveform is a small number of cycles"
    )]
    let cycles = (response.period() / TAU).round() as u32;
    cycles
}

/// Phases within the period of a response at which its formula or its direction changes.
pub(super) fn ends_of_response(response: &PeriodicPolynomial) -> Vec<f64> {
    response.starts().iter().chain(response.turns()).copied().collect()
}

/// Phases within the period between which neither g nor G changes its formula or direction: the quarters of a symmetric
/// waveform; the breaks and the zeros of g of another one.
pub(super) fn ends_of_monotone_parts(waveform: &Waveform) -> Vec<f64> {
    if waveform.is_symmetric() {
        return (0..4).map(|quarter| 0.25 * TAU * f64::from(quarter)).collect();
    }
    let breaks = waveform.breaks();
    let mut ends = breaks.to_vec();
    for (place, piece) in waveform.pieces().iter().enumerate() {
        let start = breaks[place];
        let end = breaks.get(place + 1).copied().unwrap_or_else(|| waveform.period());
        match *piece {
            Piece::Harmonic => {
                let mut quarter = start + 0.25 * TAU;
                while quarter < end {
                    ends.push(quarter);
                    quarter += 0.25 * TAU;
                }
            }
            Piece::Affine { value, slope } => {
                let zero = start - value / slope;
                if zero > start && zero < end {
                    ends.push(zero);
                }
            }
        }
    }
    ends
}

/// R²/(R² − 1): the velocity of the oscillator divided by D/R at the frequency of the force.
pub(super) fn sine_gain(r: f64) -> f64 {
    r * r / ((r - 1.0) * (r + 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<FastWave> {
        let mut waves = Vec::new();
        for waveform in Waveform::NAMED {
            waves.push(FastWave::Integral(waveform.clone()));
            for frequency_ratio in [1.3, 5.0, 10.0, 1e4] {
                waves.push(FastWave::Oscillator { waveform: waveform.clone(), frequency_ratio });
            }
        }
        waves
    }

    /// The integral shapes are G itself, and the shapes of the oscillator converge to it.
    #[test]
    fn integral_of_the_waveform() {
        for waveform in Waveform::NAMED {
            for k in -50..120 {
                let theta = 0.1 * f64::from(k);
                let (s, slope) = FastWave::Integral(waveform.clone()).value_and_slope(theta);
                assert!((s - waveform.integral(theta)).abs() < 4e-15, "{waveform:?} {theta}");
                assert!((slope - waveform.value(theta)).abs() < 1e-14, "{waveform:?} {theta}");
                let far = FastWave::Oscillator { waveform: waveform.clone(), frequency_ratio: 1e5 };
                assert!((far.value_and_slope(theta).0 - s).abs() < 1e-9);
            }
        }
    }

    /// s″ + s/R² = g′ by finite differences, away from breaks: the velocity of the oscillator satisfies v″ + v = D R g′, and
    /// its slope jumps where the force does.
    #[test]
    fn oscillator_equation() {
        for waveform in Waveform::NAMED {
            let r = 3.0;
            let wave = FastWave::Oscillator { waveform: waveform.clone(), frequency_ratio: r };
            let h = 1e-3;
            for k in 0..60 {
                let theta = 0.05 + 0.1 * f64::from(k);
                let near_break =
                    [0.0, 0.5, 1.0, 1.5, 2.0].iter().any(|q| (theta - q * PI).abs() < 2.1 * h);
                if near_break {
                    continue;
                }
                let s = |x: f64| wave.value_and_slope(x).0;
                let second = (s(theta + h) - 2.0 * s(theta) + s(theta - h)) / (h * h);
                let force = (waveform.value(theta + h) - waveform.value(theta - h)) / (2.0 * h);
                assert!((second + s(theta) / (r * r) - force).abs() < 1e-5, "{waveform:?} {theta}");
            }
        }
    }

    /// Quarter waves rise from 0 to the peak, and `crossing` inverts them to relative accuracy.
    #[test]
    fn crossings() {
        for wave in all() {
            let alpha = 0.37;
            let top = alpha * wave.quarter(FRAC_PI_2);
            assert!((top / (alpha * wave.peak()) - 1.0).abs() < 1e-14, "{wave:?}");
            for k in 0..200 {
                let delta = FRAC_PI_2 * libm::exp(-0.15 * f64::from(k) - 0.001);
                let value = alpha * wave.quarter(delta);
                let (found, steepness) = wave.crossing(alpha, value);
                // Near a smooth peak δ is as ill-conditioned as a square root.
                let slack = 1e-13 + 1e-15 / (FRAC_PI_2 - delta);
                assert!((found / delta - 1.0).abs() < slack, "{wave:?} {delta}: {found}");
                let exact = alpha * wave.quarter_slope(delta);
                assert!((steepness / exact - 1.0).abs() < 1e-9, "{wave:?} {delta}");
            }
        }
    }
}
