//! Normal dither by an actuator in series with the spring of a contact: what moves it, and what it costs.
//!
//! An actuator that lengthens by u between the structure and the surface presses the contact by k u + d u̇ more than the approach
//! of the structure does, where k is the normal stiffness of the contact and d its damping. A modulation ΔN of the load therefore
//! needs k u + d u̇ = ΔN. The actuator works against the whole normal load, so that it delivers the mean power ⟨N u̇⟩: what the
//! structure takes up, and what the damping of the contact loses. A prescribed load has no stiffness, so that both are unknown.

use quell_model::Waveform;
use quell_model::profile::Wave;
use quell_model::waveform::Piece;
use quell_numerics::matrix::Matrix;
use quell_numerics::periodic_polynomial::PeriodicPolynomial;

use crate::periodic_response::{NoPeriodicResponse, ResponseToWave};

/// Difference of two values of a waveform, over the larger, below which they do not jump.
const EQUAL: f64 = 1e-12;

/// Why the motion of an actuator has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoSeriesActuator {
    /// The contact has no normal stiffness: any elongation would give the same load.
    NoSpring,
    /// The waveform jumps, and without normal damping the actuator would have to.
    Jumps,
    /// An envelope changes the amplitude over time, so that there is no periodic motion.
    Varies,
    /// There is no periodic motion.
    NoResponse(NoPeriodicResponse),
}

impl std::fmt::Display for NoSeriesActuator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoSpring => f.write_str(
                "the contact has no normal stiffness, through which an actuator could act",
            ),
            Self::Jumps => f.write_str(
                "the waveform jumps, and an actuator on a contact without normal damping would have to jump too",
            ),
            Self::Varies => f.write_str("the amplitude of the dither varies in time"),
            Self::NoResponse(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoSeriesActuator {}

/// The elongation of an actuator under one wave of the load.
#[derive(Clone, Debug)]
pub struct SeriesActuator {
    wave: Wave,
    stiffness: f64,
    /// Elongation and its rate over the phase, for unit amplitude; `None` without damping, where u = ΔN/k.
    damped: Option<[PeriodicPolynomial; 2]>,
}

impl SeriesActuator {
    /// On a contact of this normal stiffness and damping.
    ///
    /// # Errors
    /// [`NoSeriesActuator`].
    pub fn new(wave: &Wave, stiffness: f64, damping: f64) -> Result<Self, NoSeriesActuator> {
        if stiffness <= 0.0 {
            return Err(NoSeriesActuator::NoSpring);
        }
        if wave.envelope.is_some() {
            return Err(NoSeriesActuator::Varies);
        }
        if !wave.waveform.is_periodic() {
            return Err(NoSeriesActuator::NoResponse(NoPeriodicResponse::Noise));
        }
        let wave = wave.clone();
        if damping == 0.0 {
            if jumps(&wave.waveform) {
                return Err(NoSeriesActuator::Jumps);
            }
            return Ok(Self { wave, stiffness, damped: None });
        }
        let matrix = Matrix::from_fn(1, 1, |_, _| -stiffness / damping);
        let response =
            ResponseToWave::new(&matrix, &[damping.recip()], &wave.waveform, wave.frequency)
                .map_err(NoSeriesActuator::NoResponse)?;
        // u̇ = (g − k u)/d.
        let rows: [(&[f64], f64); 2] = [(&[1.0], 0.0), (&[-stiffness / damping], damping.recip())];
        let mut outputs = response.outputs(&rows);
        let (Some(rate), Some(elongation)) = (outputs.pop(), outputs.pop()) else {
            return Err(NoSeriesActuator::NoSpring);
        };
        Ok(Self { wave, stiffness, damped: Some([elongation, rate]) })
    }

    /// Peak-to-peak elongation, a length.
    pub fn stroke(&self) -> f64 {
        let [least, largest] = if let Some([elongation, _]) = &self.damped {
            elongation.range()
        } else {
            let (least, largest) = self.wave.waveform.range();
            [least / self.stiffness, largest / self.stiffness]
        };
        self.wave.amplitude.abs() * (largest - least)
    }

    /// u̇ at a time.
    pub fn rate_at(&self, time: f64) -> f64 {
        let phase = self.wave.frequency.mul_add(time, self.wave.phase);
        let rate = match &self.damped {
            Some([_, rate]) => rate.value_and_slope(phase).0,
            None => self.wave.frequency * self.wave.waveform.slope(phase) / self.stiffness,
        };
        self.wave.amplitude * rate
    }
}

/// Whether a waveform has a jump.
fn jumps(waveform: &Waveform) -> bool {
    let (breaks, pieces) = (waveform.breaks(), waveform.pieces());
    let largest = waveform.peak();
    breaks.iter().enumerate().any(|(place, start)| {
        let before = (place + breaks.len() - 1) % breaks.len();
        let length = (start - breaks[before]).rem_euclid(waveform.period());
        let length = if length == 0.0 { waveform.period() } else { length };
        let last = match pieces[before] {
            Piece::Affine { value, slope } => slope.mul_add(length, value),
            Piece::Harmonic => libm::sin(*start),
        };
        let first = match pieces[place] {
            Piece::Affine { value, .. } => value,
            Piece::Harmonic => libm::sin(*start),
        };
        (first - last).abs() > EQUAL * largest
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use quell_model::waveform::{Burst, Hold, SampledWave};

    use super::*;

    fn wave(waveform: Waveform) -> Wave {
        Wave { waveform, amplitude: 0.3, frequency: 5.0, phase: 0.4, envelope: None }
    }

    fn samples(hold: Hold) -> Waveform {
        Waveform::Samples(SampledWave::new(vec![1.0, -0.4, 0.2], hold).expect("valid").into())
    }

    #[test]
    fn a_sine_through_spring_and_damper() {
        let (k, d) = (7.0, 0.6);
        let actuator = SeriesActuator::new(&wave(Waveform::Sine), k, d).expect("a motion");
        let size = 0.3 / libm::hypot(k, 5.0 * d);
        assert!((actuator.stroke() - 2.0 * size).abs() < 1e-14);
        let lag = libm::atan2(5.0 * d, k);
        for step in 0..20 {
            let time = 0.1 * f64::from(step);
            let exact = 5.0 * size * libm::cos(5.0 * time + 0.4 - lag);
            assert!((actuator.rate_at(time) - exact).abs() < 1e-13);
        }
    }

    /// With little damping the elongation is that of the spring alone.
    #[test]
    fn the_limit_without_damping() {
        let burst = Burst::new(Waveform::Sine, 2, 1).expect("valid").into_waveform();
        for waveform in [Waveform::Sine, Waveform::Triangle, samples(Hold::Linear), burst] {
            let [elastic, damped] = [0.0, 1e-3]
                .map(|d| SeriesActuator::new(&wave(waveform.clone()), 7.0, d).expect("a motion"));
            assert!((elastic.stroke() / damped.stroke() - 1.0).abs() < 5e-3, "{waveform:?}");
            let mean = |actuator: &SeriesActuator| {
                let period = waveform.period() / 5.0;
                let at = |k: i32| actuator.rate_at(period * (f64::from(k) + 0.5) / 3000.0);
                (0..3000).map(at).sum::<f64>() * TAU / 3000.0
            };
            assert!(mean(&elastic).abs() < 1e-3 && mean(&damped).abs() < 1e-3, "{waveform:?}");
        }
    }

    #[test]
    fn refused() {
        let of = |waveform, k, d| SeriesActuator::new(&wave(waveform), k, d).map(|_| ());
        assert_eq!(of(Waveform::Sine, 0.0, 1.0), Err(NoSeriesActuator::NoSpring));
        assert_eq!(of(Waveform::Square, 1.0, 0.0), Err(NoSeriesActuator::Jumps));
        assert_eq!(of(samples(Hold::Zero), 1.0, 0.0), Err(NoSeriesActuator::Jumps));
        assert_eq!(of(Waveform::Square, 1.0, 0.1), Ok(()));
        let carrier = Burst::new(Waveform::Square, 1, 1).expect("valid").into_waveform();
        assert_eq!(of(carrier, 1.0, 0.0), Err(NoSeriesActuator::Jumps));
    }
}
