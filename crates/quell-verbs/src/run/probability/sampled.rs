//! The kinds of study whose numbers can be uncertain, and the judges of one sample.

use std::fmt::Display;

use quell_design::least_dither::averaged_quiet;
use quell_dynamics::attractor::end_of_run;
use quell_linear::averaging::{AveragedVerdict, Averaging, criterion};
use quell_linear::growth::{Growth, Verdict, of_criterion};
use quell_model::disc::Disc;
use quell_model::units::Quantity;
use quell_model::{Dither, Input, OneMass, RefusedNumbers, System};
use quell_numerics::interval::RealInterval;

use super::unknown::{NoSampledGrowth, NoSampledThreshold, NoSampledVerdict, RefusedStart};
use super::{ProbabilityStart, verdict};
use crate::complaint::{Complaint, Failure};
use crate::contact_state::refused_where_averaged;
use crate::disc_units::DiscUnits;
use crate::fields::Fields;
use crate::run::protocol::Protocol;
use crate::run::quench_numbers::least_quiet;
use crate::run::sliding_growth::{SlidingGrowth, growth_of};
use crate::run::stability::FAST;
use crate::run::system::attractor::local_verdict;
use crate::run::system::has_equations;
use crate::status::Status;
use crate::study::{DiscStudy, ParameterId, SystemStudy, UnitSystem};
use crate::words::{more_digits, unit_after};

/// A growth rate with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedGrowth {
    /// The growth rate.
    pub rate: f64,
    /// Whether small motions grow, or why that is unknown.
    pub vibrates: Result<bool, Status>,
}

impl JudgedGrowth {
    fn of(growth: Growth) -> Self {
        let vibrates = match growth.verdict() {
            Verdict::Unstable => Ok(true),
            Verdict::Stable => Ok(false),
            Verdict::Undecided => Err(Status::WithinError),
        };
        Self { rate: growth.rate, vibrates }
    }
}

/// The growth of small motions of one sample, by averaging under dither.
#[derive(Clone, Debug, PartialEq)]
pub struct AveragedGrowth {
    /// With the response of the structure to the dither.
    pub growth: Result<JudgedGrowth, NoSampledGrowth>,
    /// Of one mass under dither in the limit R → ∞.
    pub limit: Option<Result<JudgedGrowth, NoSampledGrowth>>,
    /// Whether slip leaves the range of a friction law.
    pub beyond_range: bool,
    /// Whether the fast motion opens a contact.
    pub opens: bool,
    /// Whether a dither of one mass is hardly fast, so that averaging may be wrong.
    pub hardly_fast: bool,
}

impl AveragedGrowth {
    fn of(growth: Result<JudgedGrowth, NoSampledGrowth>) -> Self {
        Self { growth, limit: None, beyond_range: false, opens: false, hardly_fast: false }
    }
}

/// A study whose numbers can be uncertain.
pub trait SampledKind {
    /// What the study describes.
    type Sampled: Sync;

    /// Whether samples can be judged from this start.
    ///
    /// # Errors
    /// A complaint.
    fn can_be_sampled(&self, start: ProbabilityStart) -> Result<(), Failure>;

    /// What the study describes with these numbers.
    ///
    /// # Errors
    /// Why it is not valid.
    fn sampled_at(&self, numbers: &[(ParameterId, f64)]) -> Result<Self::Sampled, RefusedNumbers>;

    /// The growth of its small motions, by averaging under dither.
    fn averaged_growth(&self, sampled: &Self::Sampled) -> AveragedGrowth;

    /// The least amplitude of its first dither that is quiet, by averaging with the response to the dither or exactly: 0 where it is
    /// quiet without, infinite where no amplitude is.
    ///
    /// # Errors
    /// Why that is unknown.
    fn threshold(&self, sampled: &Self::Sampled, exactly: bool) -> Result<f64, NoSampledThreshold>;

    /// Whether it vibrates, by its exact motion.
    ///
    /// # Errors
    /// Why that is unknown.
    fn vibrates(
        &self,
        sampled: &Self::Sampled,
        start: ProbabilityStart,
    ) -> Result<bool, NoSampledVerdict>;

    /// An empty answer in the units of the study.
    fn fields(&self) -> Fields;

    /// A force of the equations with its unit.
    fn force_in_words(&self, force: f64) -> String;

    /// The unit of growth rates in sentences, pictures and datasets, and how many of them one of the equations is.
    fn unit_of_rates(&self) -> (&'static str, f64);

    /// Adds a growth rate to an answer.
    fn put_rate(&self, fields: &mut Fields, name: &str, rate: Result<f64, impl Display>) {
        fields.known_rate(name, rate);
    }
}

/// Growth of small motions of one mass in the limit R → ∞; its verdict is that of the criterion.
fn limit_growth(mass: &OneMass) -> Result<JudgedGrowth, NoSampledGrowth> {
    let found = criterion(mass.belt(), Averaging::Limit)?;
    let vibrates = match found.verdict {
        AveragedVerdict::Unstable => Ok(true),
        AveragedVerdict::Stable => Ok(false),
        AveragedVerdict::Undecided { .. } => Err(Status::WithinError),
    };
    Ok(JudgedGrowth { rate: mass.rate() * of_criterion(found.value), vibrates })
}

impl SampledKind for SystemStudy {
    type Sampled = System;

    fn can_be_sampled(&self, start: ProbabilityStart) -> Result<(), Failure> {
        if start != ProbabilityStart::Averaged {
            return has_equations(self, "orbit");
        }
        has_equations(self, "probability")?;
        if self.system().is_dithered() {
            refused_where_averaged(self, "probability")?;
        }
        Ok(())
    }

    fn sampled_at(&self, numbers: &[(ParameterId, f64)]) -> Result<System, RefusedNumbers> {
        self.model().at(numbers).map_err(RefusedNumbers::by_study)
    }

    fn averaged_growth(&self, system: &System) -> AveragedGrowth {
        let mass = system.one_averaged_mass().filter(|_| system.has_waves());
        let is_slow = |dither: &Dither| dither.lowest_ratio() < FAST;
        let (growth, beyond_range, opens) = match SlidingGrowth::averaged(system) {
            Ok(found) => (
                Ok(JudgedGrowth::of(found.growth)),
                found.doubts.contains(&Status::BeyondRange),
                found.doubts.contains(&Status::Opens),
            ),
            Err(status) => (Err(status.into()), false, false),
        };
        AveragedGrowth {
            growth,
            limit: mass.as_ref().map(limit_growth),
            beyond_range,
            opens,
            hardly_fast: mass.is_some_and(|mass| mass.belt().dithers().iter().any(is_slow)),
        }
    }

    fn threshold(&self, system: &System, exactly: bool) -> Result<f64, NoSampledThreshold> {
        let acts = |input: &Input| !input.profile.waves().is_empty();
        let input = system.inputs.iter().position(acts).ok_or(NoSampledThreshold::NoDither)?;
        if exactly {
            return Ok(least_quiet(system, input)?);
        }
        let quiet = averaged_quiet(system, input, RealInterval::new(0.0, f64::INFINITY))?;
        Ok(quiet.least_from(0.0).unwrap_or(f64::INFINITY))
    }

    fn vibrates(&self, system: &System, start: ProbabilityStart) -> Result<bool, NoSampledVerdict> {
        let protocol = match start {
            ProbabilityStart::Averaged | ProbabilityStart::Local => {
                return match local_verdict(system)? {
                    "stable" => Ok(false),
                    "unstable" => Ok(true),
                    verdict => Err(NoSampledVerdict::Local(verdict)),
                };
            }
            ProbabilityStart::Rest => Protocol::Rest,
            ProbabilityStart::Squeal => Protocol::Squeal,
        };
        let state = match protocol.state(self, system) {
            Ok(state) => state,
            // Steady sliding is stable, and no run from the usual starts vibrates: nothing to quench.
            Err(_) if start == ProbabilityStart::Squeal && is_quiet_without_dither(system) => {
                return Ok(false);
            }
            Err(why) => return Err(RefusedStart(why).into()),
        };
        Ok(!end_of_run(system, &self.observe(), &state)?.attractor.quiet)
    }

    fn fields(&self) -> Fields {
        Fields::in_units(self.units())
    }

    fn force_in_words(&self, force: f64) -> String {
        more_digits(force) + &unit_after(self.units().unit(Quantity::Force))
    }

    fn unit_of_rates(&self) -> (&'static str, f64) {
        (if self.units() == UnitSystem::None { "1" } else { "1/s" }, 1.0)
    }
}

/// Whether steady sliding without dither is stable.
fn is_quiet_without_dither(system: &System) -> bool {
    local_verdict(&system.undithered()).is_ok_and(|verdict| verdict == "stable")
}

impl SampledKind for DiscStudy {
    type Sampled = Disc;

    fn can_be_sampled(&self, start: ProbabilityStart) -> Result<(), Failure> {
        match start {
            ProbabilityStart::Averaged | ProbabilityStart::Local => Ok(()),
            ProbabilityStart::Rest | ProbabilityStart::Squeal => {
                let allowed = "averaged or local of a disc, both by its exact exponents: its motions are linear";
                Err(Complaint::option("--start", start.name(), allowed).into())
            }
        }
    }

    fn sampled_at(&self, numbers: &[(ParameterId, f64)]) -> Result<Disc, RefusedNumbers> {
        let setup = self.setup_at(numbers).map_err(RefusedNumbers::by_study)?;
        Ok(setup.disc().clone())
    }

    fn averaged_growth(&self, disc: &Disc) -> AveragedGrowth {
        // A sample has an ω_ref of its own.
        let scales = disc.scales(0).filter(|_| DiscUnits::of(self).is_some());
        let one = scales.map_or(1.0, |scales| scales.angular_frequency());
        let growth = growth_of(disc, self.parts()).map(JudgedGrowth::of);
        let growth = growth.map(|growth| JudgedGrowth { rate: one * growth.rate, ..growth });
        AveragedGrowth::of(growth.map_err(NoSampledGrowth::from))
    }

    fn threshold(&self, _: &Disc, _: bool) -> Result<f64, NoSampledThreshold> {
        Err(NoSampledThreshold::OfDisc)
    }

    fn vibrates(&self, disc: &Disc, _: ProbabilityStart) -> Result<bool, NoSampledVerdict> {
        Ok(verdict(&self.averaged_growth(disc).growth)?)
    }

    fn fields(&self) -> Fields {
        Fields::new()
    }

    fn force_in_words(&self, force: f64) -> String {
        more_digits(force)
    }

    fn put_rate(&self, fields: &mut Fields, name: &str, rate: Result<f64, impl Display>) {
        match rate {
            Ok(rate) => fields.measured(name, self.unit_of_rates().0, rate),
            Err(why) => fields.unknown(name, why),
        };
    }

    fn unit_of_rates(&self) -> (&'static str, f64) {
        (if DiscUnits::of(self).is_some() { "1/s" } else { "ω_ref" }, 1.0)
    }
}
