//! Fast motion of a mass: groups of incommensurate frequencies, each of them periodic, and noise.

use quell_numerics::order::ascending;

use super::error::AveragingError;
use super::periodic::Signal;
use super::periodic_motion::{PeriodicMotion, SlipTerm};
use super::wave::FastWave;

/// Standard deviations of a Gaussian velocity that count as its range: it is beyond them for 6·10⁻⁵ of the time.
pub(super) const REACH: f64 = 4.0;

/// Relative difference of two velocities that are the same up to the rounding of both.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Fast motion: groups of incommensurate frequencies, each periodic, and a Gaussian velocity that is independent of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FastMotion {
    groups: Vec<PeriodicMotion>,
    /// Standard deviation of the Gaussian velocity.
    noise: f64,
}

impl FastMotion {
    /// Motion of groups of mutually incommensurate frequencies. Groups that do not move the mass are dropped:
    /// a load that is uncorrelated with the slip has no mean effect.
    #[must_use]
    pub fn new(groups: Vec<PeriodicMotion>) -> Self {
        let mut groups = groups;
        for group in &mut groups {
            group.tangential.retain(|t| t.amplitude != 0.0);
            group.normal.retain(|t| t.amplitude != 0.0);
            group.load.retain(|t| t.amplitude != 0.0);
        }
        groups.retain(|group| !group.is_still());
        Self { groups, noise: 0.0 }
    }

    /// The same motion with a Gaussian velocity of a standard deviation.
    #[must_use]
    pub fn with_noise(self, deviation: f64) -> Self {
        Self { noise: deviation, ..self }
    }

    /// Whether the load of some group fluctuates.
    pub(super) fn has_load(&self) -> bool {
        self.groups.iter().any(|group| !group.load.is_empty())
    }

    /// The motion under dithers of that many times the amplitude.
    pub(super) fn times(&self, factor: f64) -> Self {
        let groups = self.groups.iter().map(|group| group.times(factor)).collect();
        Self::new(groups).with_noise(factor.abs() * self.noise)
    }

    /// The same slip under a steady load.
    pub(super) fn without_load(&self) -> Self {
        let groups = self.groups.iter().map(PeriodicMotion::without_load);
        Self { groups: groups.collect(), noise: self.noise }
    }

    /// Standard deviation of the Gaussian velocity; 0 without noise. With noise the average has neither corners nor jumps.
    #[must_use]
    pub fn noise(&self) -> f64 {
        self.noise
    }

    /// A single fast slip velocity amplitude·wave.
    #[must_use]
    pub fn single(wave: FastWave, amplitude: f64) -> Self {
        let harmonic = wave.cycles();
        let term = SlipTerm { wave, amplitude, harmonic, phase: 0.0 };
        Self::new(vec![PeriodicMotion { tangential: vec![term], ..PeriodicMotion::default() }])
    }

    /// The groups, all of which move the mass.
    #[must_use]
    pub fn groups(&self) -> &[PeriodicMotion] {
        &self.groups
    }

    /// Smallest and largest fast slip velocity s, summed over the groups; of noise four standard deviations.
    ///
    /// # Errors
    /// A quadrature that did not converge.
    pub(super) fn slip_range(&self) -> Result<[f64; 2], AveragingError> {
        let noise = REACH * self.noise;
        self.groups.iter().try_fold([-noise, noise], |[low, high], group| {
            let range = match group.single_term() {
                Some((wave, amplitude)) => {
                    let peak = amplitude.abs() * wave.peak();
                    [-peak, peak]
                }
                None => Signal::new(group)?.range(),
            };
            Ok([low + range[0], high + range[1]])
        })
    }

    /// Slip velocities at which averaged friction has a corner or, without fast motion, its jump: sums of the extrema of the
    /// groups. With noise it has neither.
    ///
    /// # Errors
    /// A quadrature that did not converge.
    pub(super) fn corners(&self) -> Result<Vec<f64>, AveragingError> {
        if self.noise > 0.0 {
            return Ok(Vec::new());
        }
        let mut sums = vec![0.0];
        for group in &self.groups {
            let extrema = match group.single_term() {
                Some((wave, amplitude)) => {
                    let peak = amplitude.abs() * wave.peak();
                    vec![-peak, peak]
                }
                None => Signal::new(group)?.turning_values(),
            };
            sums = extrema.iter().flat_map(|own| sums.iter().map(move |sum| own + sum)).collect();
            ascending(&mut sums);
            sums.dedup();
        }
        Ok(sums)
    }

    /// A slow slip velocity, or the fast velocity that it equals up to the rounding of both (of an amplitude ratio D/R, for instance):
    /// next to it the inner slope grows like the inverse root of the distance, and would be the rounding of that distance.
    ///
    /// # Errors
    /// A quadrature that did not converge.
    pub(super) fn at_corner(&self, v: f64) -> Result<f64, AveragingError> {
        if self.noise > 0.0 {
            return Ok(v);
        }
        let [low, high] = self.slip_range()?;
        let corner = if v < 0.0 { low } else { high };
        Ok(if (v - corner).abs() <= ROUNDING * corner.abs() { corner } else { v })
    }

    /// Largest fast slip velocity, max s summed over the groups.
    ///
    /// # Errors
    /// A quadrature that did not converge.
    pub fn largest_slip(&self) -> Result<f64, AveragingError> {
        Ok(self.slip_range()?[1])
    }
}
