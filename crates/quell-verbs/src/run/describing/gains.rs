//! Mean and equivalent gain of averaged friction over the amplitude of the slow slip velocity.

use quell_linear::averaging::{AveragingError, DescribingFunction, EquivalentGain};
use quell_model::units::Quantity;
use quell_numerics::order::ascending;

use crate::fields::Fields;
use crate::parallel::Parallel;
use crate::reasons::reasons;

/// Equal steps of the amplitude up to the largest one.
const STEPS: u32 = 100;

/// Mean and equivalent gain of one contact.
#[derive(Clone, Debug)]
pub struct GainCurve {
    /// Largest velocity amplitude.
    pub largest: f64,
    /// Mean and equivalent gain over the amplitudes, ascending.
    pub points: Vec<EquivalentGain>,
    /// The gain without dither at the same amplitudes.
    pub undithered: Vec<EquivalentGain>,
    /// The gain for a → 0, per unit velocity; or why it has no value.
    pub small: Result<f64, NoSmallGain>,
}

reasons! {
    /// Why the gain for a → 0 has no value.
    pub enum NoSmallGain {
        /// The law has no average.
        NoAverage(AveragingError),
        ;
        /// The surface is as fast as the largest fast motion.
        AtCorner =>
            "the belt velocity equals the largest fast velocity, at which the slope of averaged friction jumps",
    }
}

/// The gain for a → 0, or why it has no value.
pub(super) fn small(function: &DescribingFunction) -> Result<f64, NoSmallGain> {
    function.small()?.ok_or(NoSmallGain::AtCorner)
}

impl GainCurve {
    /// The curves with and without dither for velocity amplitudes up to `largest`.
    pub(super) fn new(
        function: &DescribingFunction,
        without: &DescribingFunction,
        largest: f64,
    ) -> Result<Self, AveragingError> {
        let mut amplitudes: Vec<f64> =
            (1..=STEPS).map(|k| largest * f64::from(k) / f64::from(STEPS)).collect();
        // Where a corner of the averaged law enters, the gain has a kink.
        amplitudes.extend(function.corner_amplitudes().into_iter().filter(|a| *a < largest));
        ascending(&mut amplitudes);
        // A corner at one of the equal steps differs from it by rounding alone.
        amplitudes.dedup_by(|a, b| (*a - *b).abs() <= 1e-12 * largest);
        let over = |function: &DescribingFunction| -> Result<Vec<EquivalentGain>, AveragingError> {
            let found: Vec<Result<EquivalentGain, AveragingError>> =
                amplitudes.in_parallel(|amplitude| function.at(*amplitude)).collect();
            found.into_iter().collect()
        };
        let (points, undithered) = (over(function)?, over(without)?);
        Ok(Self { largest, points, undithered, small: small(function) })
    }

    fn column(points: &[EquivalentGain], of: fn(&EquivalentGain) -> f64) -> Vec<f64> {
        points.iter().map(of).collect()
    }

    /// The velocity amplitudes.
    pub fn amplitudes(&self) -> Vec<f64> {
        Self::column(&self.points, |point| point.amplitude)
    }

    /// μ₀(a) at each amplitude.
    pub fn coefficients(&self) -> Vec<f64> {
        Self::column(&self.points, |point| point.coefficient)
    }

    /// N₁(a) at each amplitude.
    pub fn gains(&self) -> Vec<f64> {
        Self::column(&self.points, |point| point.gain)
    }

    /// N₁(a) without dither.
    pub fn undithered_gains(&self) -> Vec<f64> {
        Self::column(&self.undithered, |point| point.gain)
    }

    /// The rows of a table: ten equal steps. The full grid goes to files and programs.
    pub fn tenths(&self) -> impl Iterator<Item = (usize, &EquivalentGain, &EquivalentGain)> {
        let shown = |amplitude: f64| {
            let tenths = 10.0 * amplitude / self.largest;
            (tenths - tenths.round()).abs() < 1e-9
        };
        let rows = self.points.iter().zip(&self.undithered).enumerate();
        let rows = rows.map(|(index, (point, bare))| (index, point, bare));
        rows.filter(move |(_, point, _)| shown(point.amplitude))
    }

    pub(super) fn put(&self, fields: &mut Fields) {
        let errors = Self::column(&self.points, |point| point.error);
        fields
            .numbers("velocity_amplitude", Quantity::Velocity, &self.amplitudes())
            .numbers("mean_coefficient", Quantity::Ratio, &self.coefficients())
            .per_velocity("gain", &self.gains())
            .per_velocity("gain_error", &errors)
            .per_velocity("undithered_gain", &self.undithered_gains());
    }
}
