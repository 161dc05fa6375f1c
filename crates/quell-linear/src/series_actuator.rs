//! Normal dither by an actuator in series with the spring of a contact: what moves it, and what it costs.
//!
//! An actuator that lengthens by u between the structure and the surface presses the contact by k u + d u̇ more than the approach
//! of the structure does, where k is the normal stiffness of the contact and d its damping. A modulation ΔN of the load therefore
//! needs k u + d u̇ = ΔN. The actuator works against the whole normal load, so that it delivers the mean power ⟨N u̇⟩: what the
//! structure takes up, and what the damping of the contact loses. A prescribed load has no stiffness, so that both are unknown.

use quell_model::Waveform;
use quell_model::profile::Wave;
use quell_numerics::matrix::Matrix;
use quell_numerics::periodic_polynomial::PeriodicPolynomial;

use crate::periodic_response::{NoPeriodicResponse, ResponseToWave};

/// A jump of a function is larger than this share of its range.
const JUMP: f64 = 1e-9;

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
                "the contact has no normal_stiffness, through which an actuator could act",
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

/// A row over the states, and the factor of the wave itself.
pub(crate) type OutputRow = (Vec<f64>, f64);

/// The equations x′ = A x + b g of a structure together with the elongation of an actuator, k u + d u̇ = g: with damping u is a state more,
/// after those of the structure.
#[derive(Clone, Debug)]
pub(crate) struct WithElongation {
    pub(crate) matrix: Matrix,
    pub(crate) source: Vec<f64>,
    /// u.
    pub(crate) elongation: OutputRow,
}

impl WithElongation {
    /// On a contact of this normal stiffness and damping.
    pub(crate) fn new(
        matrix: &Matrix,
        source: &[f64],
        stiffness: f64,
        damping: f64,
    ) -> Result<Self, NoSeriesActuator> {
        if stiffness <= 0.0 {
            return Err(NoSeriesActuator::NoSpring);
        }
        let n = matrix.rows();
        let mut source = source.to_vec();
        if damping == 0.0 {
            let elongation = (vec![0.0; n], stiffness.recip());
            return Ok(Self { matrix: matrix.clone(), source, elongation });
        }
        let matrix = Matrix::from_fn(n + 1, n + 1, |i, j| match (i == n, j == n) {
            (false, false) => matrix[(i, j)],
            (true, true) => -stiffness / damping,
            _ => 0.0,
        });
        source.push(damping.recip());
        let elongation = (0..=n).map(|i| f64::from(u8::from(i == n))).collect();
        Ok(Self { matrix, source, elongation: (elongation, 0.0) })
    }
}

/// Whether a function has a jump, as opposed to a rounding error.
pub(crate) fn jumps(function: &PeriodicPolynomial) -> bool {
    let [least, largest] = function.range();
    function.largest_jump() > JUMP * (largest - least)
}

/// The elongation of an actuator under one wave of the load.
#[derive(Clone, Debug)]
pub struct SeriesActuator {
    wave: Wave,
    /// Elongation over the phase, for unit amplitude.
    elongation: PeriodicPolynomial,
}

impl SeriesActuator {
    /// On a contact of this normal stiffness and damping.
    ///
    /// # Errors
    /// [`NoSeriesActuator`].
    pub fn new(wave: &Wave, stiffness: f64, damping: f64) -> Result<Self, NoSeriesActuator> {
        let equations = WithElongation::new(&Matrix::zeros(0, 0), &[], stiffness, damping)?;
        if wave.envelope.is_some() {
            return Err(NoSeriesActuator::Varies);
        }
        let elongation = equations.elongation(&wave.waveform, wave.frequency)?;
        Ok(Self { wave: wave.clone(), elongation })
    }

    /// Peak-to-peak elongation, a length.
    pub fn stroke(&self) -> f64 {
        let [least, largest] = self.elongation.range();
        self.wave.amplitude.abs() * (largest - least)
    }

    /// u̇ at a time.
    pub fn rate_at(&self, time: f64) -> f64 {
        let phase = self.wave.frequency.mul_add(time, self.wave.phase);
        let (_, slope) = self.elongation.value_and_slope(phase);
        self.wave.amplitude * self.wave.frequency * slope
    }
}

impl WithElongation {
    /// u over the phase, for a wave of unit amplitude.
    fn elongation(
        &self,
        waveform: &Waveform,
        frequency: f64,
    ) -> Result<PeriodicPolynomial, NoSeriesActuator> {
        let response = ResponseToWave::new(&self.matrix, &self.source, waveform, frequency)
            .map_err(NoSeriesActuator::NoResponse)?;
        let (row, direct) = &self.elongation;
        let elongation = response.outputs(&[(row, *direct)]).pop();
        match elongation {
            Some(elongation) if !jumps(&elongation) => Ok(elongation),
            _ => Err(NoSeriesActuator::Jumps),
        }
    }
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
