//! Limit cycles of one mass by averaging in the limit of high dither frequency.

use quell_linear::averaging::{Averaging, AveragingError, DescribedCycle, DescribingFunction};
use quell_model::units::Quantity;
use quell_model::{Belt, System};

use super::gains::{NoSmallGain, small};
use super::unknown::{JudgedUpTo, NoStableCycle};
use crate::fields::Fields;
use crate::study::SystemStudy;

/// Limit cycles by averaging in the limit of high dither frequency.
#[derive(Clone, Debug)]
pub struct LimitAveragedCycles {
    /// The gain for a → 0, or why it has no value.
    pub small: Result<f64, NoSmallGain>,
    /// Every limit cycle, ascending.
    pub cycles: Vec<DescribedCycle>,
    /// Displacement of the coordinate over that of the mass.
    displacement: f64,
}

impl LimitAveragedCycles {
    /// Those up to a largest velocity amplitude; `None` where the system is not one mass under dither.
    pub(super) fn of(system: &System, largest: f64) -> Option<Result<Self, AveragingError>> {
        let mass = system.one_averaged_mass().filter(|_| system.is_dithered())?;
        let displacement = mass.displacement().abs();
        Some(Self::of_mass(mass.belt(), largest, displacement))
    }

    fn of_mass(belt: &Belt, largest: f64, displacement: f64) -> Result<Self, AveragingError> {
        let function = DescribingFunction::of_one_mass(belt, Averaging::Limit)?;
        // 2ζ + FN₁.
        let balance = |gain| Ok::<f64, AveragingError>(belt.damping_rate(gain, belt.normal_load()));
        let cycles = function.cycles(largest, balance)?;
        Ok(Self { small: small(&function), cycles, displacement })
    }

    pub(super) fn fields(&self, study: &SystemStudy, largest: f64) -> Fields {
        let empty = || Fields::in_units(study.units());
        let length = self.displacement * study.observe().first().map_or(1.0, |row| row.abs());
        let stable = self.cycles.iter().find(|cycle| cycle.stable).map(|cycle| cycle.amplitude);
        let largest = JudgedUpTo { amplitude: largest, units: study.units() };
        let stable = stable.ok_or(NoStableCycle::NoneStable(largest));
        let cycles = self.cycles.iter().map(|cycle| {
            let mut inner = empty();
            inner
                .number("velocity_amplitude", Quantity::Velocity, cycle.amplitude)
                .number("velocity_amplitude_error", Quantity::Velocity, cycle.error)
                .number("amplitude", Quantity::Displacement, length * cycle.amplitude)
                .plain("stable", cycle.stable);
            inner
        });
        let mut fields = empty();
        fields
            .known("small_gain", Quantity::PerVelocity, self.small.clone())
            .known("limit_cycle_velocity", Quantity::Velocity, stable.clone())
            .known("limit_cycle_amplitude", Quantity::Displacement, stable.map(|a| length * a))
            .list("limit_cycles", cycles.collect::<Vec<_>>());
        fields
    }
}
