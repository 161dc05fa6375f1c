//! Quantities that vary in time: a constant, values at knots, and periodic waves. Dither, its envelope, drives and loads are profiles.

use quell_numerics::interval::RealInterval;

mod knots;
mod wave;

pub use knots::{KnotPiece, KnotShape, Knots, MOST_KNOTS};
pub use wave::Wave;

/// A quantity over time: a constant, a course given at knots, and waves, all added. Drives, loads and inputs take one.
///
/// ```
/// use quell_model::profile::{Profile, Wave};
/// use quell_model::Waveform;
///
/// let wave = Wave { waveform: Waveform::Sine, amplitude: 0.5, frequency: 10.0, phase: 0.0, envelope: None };
/// let load = Profile::constant(2.0).with(wave);
/// assert_eq!(load.mean(), 2.0);
/// assert_eq!(load.value(0.0), 2.0);
/// assert!(load.is_steady());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    mean: f64,
    knots: Option<Knots>,
    waves: Vec<Wave>,
}

impl Profile {
    /// The same value at all times.
    pub fn constant(value: f64) -> Self {
        Self { mean: value, ..Self::default() }
    }

    /// The course of these knots.
    pub fn over(knots: Knots) -> Self {
        Self { knots: Some(knots), ..Self::default() }
    }

    /// The same profile with a further wave.
    #[must_use]
    pub fn with(mut self, wave: Wave) -> Self {
        self.waves.push(wave);
        self
    }

    /// The constant part. Of a profile without knots it is the mean over time.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The course given at knots, if any.
    pub fn knots(&self) -> Option<&Knots> {
        self.knots.as_ref()
    }

    /// The waves, each of zero mean.
    pub fn waves(&self) -> &[Wave] {
        &self.waves
    }

    /// Whether the profile is a constant and waves of constant amplitude: without knots and envelopes.
    pub fn is_steady(&self) -> bool {
        self.knots.is_none() && self.waves.iter().all(|wave| wave.envelope.is_none())
    }

    /// The steady profile with the constant part and the amplitudes of a time.
    #[must_use]
    pub fn steady_at(&self, time: f64) -> Self {
        let waves = self.waves.iter().map(|wave| wave.steady_at(time));
        Self { mean: self.without_waves().value(time), knots: None, waves: waves.collect() }
    }

    /// The same profile with another constant part.
    #[must_use]
    pub fn about(self, mean: f64) -> Self {
        Self { mean, ..self }
    }

    /// The profile of the opposite sign.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let reversed = self.with_waves_scaled(-1.0);
        Self { mean: -self.mean, knots: self.knots.as_ref().map(Knots::reversed), ..reversed }
    }

    /// The profile multiplied by a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let knots = self.knots.as_ref().map(|knots| knots.scaled(factor));
        Self { mean: factor * self.mean, knots, ..self.with_waves_scaled(factor) }
    }

    /// The same profile in another unit of time, of which one unit of its own is `factor`.
    #[must_use]
    pub fn in_time_unit(&self, factor: f64) -> Self {
        let knots = |knots: &Knots| knots.in_time_unit(factor);
        let wave = |wave: &Wave| Wave {
            frequency: wave.frequency / factor,
            envelope: wave.envelope.as_ref().map(knots),
            ..wave.clone()
        };
        Self {
            mean: self.mean,
            knots: self.knots.as_ref().map(knots),
            waves: self.waves.iter().map(wave).collect(),
        }
    }

    /// The same profile without its waves.
    #[must_use]
    pub fn without_waves(&self) -> Self {
        Self { waves: Vec::new(), ..self.clone() }
    }

    /// The same profile with the amplitudes of its waves multiplied by a factor.
    #[must_use]
    pub fn with_waves_scaled(&self, factor: f64) -> Self {
        let scaled = |wave: &Wave| Wave { amplitude: factor * wave.amplitude, ..wave.clone() };
        Self { waves: self.waves.iter().map(scaled).collect(), ..self.clone() }
    }

    /// The same profile in which the seed of noise is greater by a number.
    #[must_use]
    pub fn reseeded(&self, by: u64) -> Self {
        let other = |wave: &Wave| Wave { waveform: wave.waveform.reseeded(by), ..wave.clone() };
        Self { waves: self.waves.iter().map(other).collect(), ..self.clone() }
    }

    /// The value at the time t.
    pub fn value(&self, time: f64) -> f64 {
        let course = self.knots.as_ref().map_or(0.0, |knots| knots.value(time));
        self.mean + course + self.waves.iter().map(|wave| wave.value(time)).sum::<f64>()
    }

    /// Bounds of the value at all times: those of the knots and of all waves.
    pub fn bounds(&self) -> RealInterval {
        let knots = self.knots.as_ref().map_or(RealInterval::point(0.0), Knots::range);
        let waves = || self.waves.iter().map(Wave::range);
        let (fall, rise): (f64, f64) =
            (waves().map(|wave| -wave.lower).sum(), waves().map(|wave| wave.upper).sum());
        RealInterval::new(self.mean + knots.lower - fall, self.mean + knots.upper + rise)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Waveform;

    #[test]
    fn the_steady_profile_of_a_time_has_its_value() {
        let knots = |values: Vec<f64>| Knots::new(vec![0.0, 4.0], values, KnotShape::Smooth);
        let envelope = knots(vec![0.0, 1.0]).ok();
        let wave =
            Wave { waveform: Waveform::Sine, amplitude: 0.5, frequency: 3.0, phase: 0.2, envelope };
        let profile = Profile::over(knots(vec![1.0, -2.0]).expect("valid")).with(wave);
        assert!(!profile.is_steady());
        for time in [-1.0, 0.0, 1.3, 4.0, 7.0] {
            let steady = profile.steady_at(time);
            assert!(steady.is_steady());
            assert!((steady.value(time) - profile.value(time)).abs() < 1e-15);
        }
        assert_eq!(profile.bounds(), RealInterval::new(-2.5, 1.5));
        for time in [-1.0, 1.3, 7.0] {
            assert!((profile.scaled(-3.0).value(time) + 3.0 * profile.value(time)).abs() < 1e-14);
        }
    }
}
