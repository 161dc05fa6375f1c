//! The kinds of study whose numbers can be uncertain, and the judges of one sample.

use quell_design::least_dither::{averaged_quiet_of_belt, averaged_quiet_of_system};
use quell_dynamics::attractor::reached;
use quell_dynamics::orbit::{OrbitVerdict, from_sliding};
use quell_dynamics::start::{InitialState, NoSquealingStart};
use quell_linear::averaging::{AveragedVerdict, Averaging, criterion};
use quell_linear::growth::{Growth, Verdict, of_criterion};
use quell_model::disc::Disc;
use quell_model::units::{Quantity, Scales};
use quell_model::{Belt, Input, System};

use super::ProbabilityStart;
use crate::complaint::{Complaint, Failure};
use crate::contact_state::refused_of_belt;
use crate::fields::Fields;
use crate::outcome::disc_units::DiscUnits;
use crate::range;
use crate::run::protocol::Protocol;
use crate::run::stability::FAST;
use crate::run::system::attractor::{end_of_run, local_verdict};
use crate::run::system::{has_equations, in_units};
use crate::study::{BeltStudy, DiscStudy, ParameterId, SystemStudy, UnitSystem};
use crate::sweep::{
    Status, growth_of_disc, growth_of_system, least_quiet_of_belt, least_quiet_of_system,
};
use crate::words::{digits, in_words};

/// Steps by which the dither grows from zero to the base response of a belt.
const GROWTH_STEPS: u32 = 8;

/// A growth rate with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedGrowth {
    /// The growth rate.
    pub rate: f64,
    /// Whether small motions grow, or why that is unknown.
    pub vibrates: Result<bool, String>,
}

impl JudgedGrowth {
    fn of(growth: Growth) -> Self {
        let vibrates = match growth.verdict() {
            Verdict::Unstable => Ok(true),
            Verdict::Stable => Ok(false),
            Verdict::Undecided => Err(Status::WithinError.about().to_owned()),
        };
        Self { rate: growth.rate, vibrates }
    }
}

/// The growth of small motions of one sample, by averaging under dither.
#[derive(Clone, Debug, PartialEq)]
pub struct AveragedGrowth {
    /// With the response of the structure to the dither: of a belt finite-R averaging.
    pub growth: Result<JudgedGrowth, String>,
    /// Of a dithered belt in the limit R → ∞.
    pub limit: Option<Result<JudgedGrowth, String>>,
    /// Whether slip leaves the range of a friction law.
    pub beyond_range: bool,
    /// Whether the fast motion opens a contact.
    pub opens: bool,
    /// Whether a dither of a belt is hardly fast, so that averaging may be wrong.
    pub hardly_fast: bool,
}

impl AveragedGrowth {
    fn of(growth: Result<JudgedGrowth, String>) -> Self {
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
    fn sampled_at(&self, numbers: &[(ParameterId, f64)]) -> Result<Self::Sampled, String>;

    /// The growth of its small motions, by averaging under dither.
    fn averaged_growth(&self, sampled: &Self::Sampled) -> AveragedGrowth;

    /// The least amplitude of its first dither that is quiet, by averaging with the response to the dither or exactly: 0 where it is
    /// quiet without, infinite where no amplitude is.
    ///
    /// # Errors
    /// Why that is unknown.
    fn threshold(&self, sampled: &Self::Sampled, exactly: bool) -> Result<f64, String>;

    /// Whether it vibrates, by its exact motion.
    ///
    /// # Errors
    /// Why that is unknown.
    fn vibrates(&self, sampled: &Self::Sampled, start: ProbabilityStart) -> Result<bool, String>;

    /// An empty answer in the units of the study.
    fn fields(&self) -> Fields;

    /// A force of the equations with its unit.
    fn force_in_words(&self, force: f64) -> String;

    /// The unit of growth rates in sentences, pictures and datasets, and how many of them one of the equations is.
    fn unit_of_rates(&self) -> (&'static str, f64);

    /// Adds a growth rate to an answer.
    fn put_rate(&self, fields: &mut Fields, name: &str, rate: Result<f64, String>) {
        fields.rate(name, rate);
    }
}

/// Why a study without dither has no threshold.
const NO_DITHER: &str = "the study has no dither";

/// A belt of a sample. Its equations may have other scales than those of the study: the mass or the stiffness may be uncertain.
pub struct SampledBelt {
    belt: Belt,
    /// Rates and forces of the study's equations that one of this belt's is.
    rate: f64,
    force: f64,
}

impl SampledBelt {
    fn new(belt: Belt, scales: Option<(Scales, Scales)>) -> Self {
        let (mut rate, mut force) = (1.0, 1.0);
        if let Some((study, own)) = scales {
            let force_of = |scales: &Scales| scales.per_unit(Quantity::Force);
            rate = own.angular_frequency() / study.angular_frequency();
            force = force_of(&own) / force_of(&study);
        }
        Self { belt, rate, force }
    }

    fn growth(&self, options: Averaging) -> Result<JudgedGrowth, String> {
        let found = by_averaging(&self.belt, options)?;
        Ok(JudgedGrowth { rate: self.rate * found.rate, ..found })
    }
}

impl SampledKind for BeltStudy {
    type Sampled = SampledBelt;

    fn can_be_sampled(&self, start: ProbabilityStart) -> Result<(), Failure> {
        if start == ProbabilityStart::Averaged {
            // Averages are over the distribution of noise.
            return match crate::contact_state::complaint_of_belt(self.belt(), "probability") {
                Some(complaint) => Err(complaint.into()),
                None => Ok(()),
            };
        }
        refused_of_belt(self, "probability")
    }

    fn sampled_at(&self, numbers: &[(ParameterId, f64)]) -> Result<SampledBelt, String> {
        let setup = self.setup_at(numbers).map_err(|why| why.to_string())?;
        let belt = setup.belt();
        Ok(SampledBelt::new(belt.clone(), self.scales().zip(belt.scales())))
    }

    fn averaged_growth(&self, sampled: &SampledBelt) -> AveragedGrowth {
        let belt = &sampled.belt;
        let amplitude = belt.dithers().first().map_or(0.0, |dither| dither.amplitude);
        let slip = range::at_amplitude(belt, amplitude);
        let beyond_range = belt.friction().range().is_some_and(|range| slip > range.upper);
        let growth = sampled.growth(Averaging::FiniteR);
        let limit = (!belt.dithers().is_empty()).then(|| sampled.growth(Averaging::Limit));
        let hardly_fast = belt.dithers().iter().any(|dither| dither.lowest_ratio() < FAST);
        AveragedGrowth { growth, limit, beyond_range, opens: false, hardly_fast }
    }

    fn threshold(&self, sampled: &SampledBelt, exactly: bool) -> Result<f64, String> {
        let belt = &sampled.belt;
        if belt.dithers().is_empty() {
            return Err(NO_DITHER.to_owned());
        }
        let least = if exactly {
            least_quiet_of_belt(belt).map_err(|why| why.about().to_owned())?
        } else {
            let quiet = averaged_quiet_of_belt(belt, (0.0, f64::INFINITY));
            quiet.map_err(|why| why.to_string())?.least_from(0.0).unwrap_or(f64::INFINITY)
        };
        Ok(sampled.force * least)
    }

    fn vibrates(&self, sampled: &SampledBelt, start: ProbabilityStart) -> Result<bool, String> {
        let belt = &sampled.belt;
        let initial = match start {
            ProbabilityStart::Averaged | ProbabilityStart::Local => return is_unstable(belt),
            ProbabilityStart::Rest => InitialState::Rest,
            ProbabilityStart::Squeal => InitialState::Squealing,
        };
        let start = match initial.resolve(belt) {
            Ok(start) => start,
            // Nothing to quench.
            Err(NoSquealingStart::SettlesToSliding | NoSquealingStart::BeltAtRest) => {
                return Ok(false);
            }
            Err(NoSquealingStart::Stalled(why)) => return Err(why.to_string()),
        };
        let reached = reached(belt, start).map_err(|why| why.to_string())?;
        let quiet = reached.is_quiet().ok_or("the run has not settled")?;
        Ok(!quiet)
    }

    fn fields(&self) -> Fields {
        Fields::new(self.scales())
    }

    fn force_in_words(&self, force: f64) -> String {
        in_words(self, Quantity::Force, force)
    }

    fn unit_of_rates(&self) -> (&'static str, f64) {
        self.scales().map_or(("ω₀", 1.0), |scales| ("1/s", scales.angular_frequency()))
    }
}

fn by_averaging(belt: &Belt, options: Averaging) -> Result<JudgedGrowth, String> {
    let found = criterion(belt, options).map_err(|why| why.to_string())?;
    let vibrates = match found.verdict {
        AveragedVerdict::Unstable => Ok(true),
        AveragedVerdict::Stable => Ok(false),
        AveragedVerdict::Undecided { .. } => Err(Status::WithinError.about().to_owned()),
    };
    Ok(JudgedGrowth { rate: of_criterion(found.value), vibrates })
}

/// Whether the base response of a belt is unstable; without dither steady sliding.
fn is_unstable(belt: &Belt) -> Result<bool, String> {
    if !belt.dithers().iter().any(|dither| dither.amplitude != 0.0) {
        return by_averaging(belt, Averaging::FiniteR)?.vibrates;
    }
    match from_sliding(belt, GROWTH_STEPS).map_err(|why| why.to_string())?.verdict() {
        OrbitVerdict::Stable => Ok(false),
        OrbitVerdict::Unstable => Ok(true),
        OrbitVerdict::Undecided => Err("the verdict on the base response is undecided".to_owned()),
    }
}

impl SampledKind for SystemStudy {
    type Sampled = System;

    fn can_be_sampled(&self, start: ProbabilityStart) -> Result<(), Failure> {
        let verb = if start == ProbabilityStart::Averaged { "probability" } else { "orbit" };
        has_equations(self, verb)
    }

    fn sampled_at(&self, numbers: &[(ParameterId, f64)]) -> Result<System, String> {
        self.model().at(numbers).map_err(|why| why.to_string())
    }

    fn averaged_growth(&self, system: &System) -> AveragedGrowth {
        match growth_of_system(system) {
            Ok(point) => AveragedGrowth {
                growth: Ok(JudgedGrowth::of(point.growth)),
                limit: None,
                beyond_range: point.beyond_range,
                opens: point.opens,
                hardly_fast: false,
            },
            Err(status) => AveragedGrowth::of(Err(status.about().to_owned())),
        }
    }

    fn threshold(&self, system: &System, exactly: bool) -> Result<f64, String> {
        let acts = |input: &Input| !input.profile.waves().is_empty();
        let input = system.inputs.iter().position(acts).ok_or(NO_DITHER)?;
        if exactly {
            return least_quiet_of_system(system, input).map_err(|why| why.about().to_owned());
        }
        let quiet = averaged_quiet_of_system(system, input, (0.0, f64::INFINITY));
        Ok(quiet.map_err(|why| why.to_string())?.least_from(0.0).unwrap_or(f64::INFINITY))
    }

    fn vibrates(&self, system: &System, start: ProbabilityStart) -> Result<bool, String> {
        let protocol = match start {
            ProbabilityStart::Averaged | ProbabilityStart::Local => {
                return match local_verdict(system)? {
                    "stable" => Ok(false),
                    "unstable" => Ok(true),
                    verdict => Err(format!("the base response is {verdict}")),
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
            Err(why) => return Err(said(&why)),
        };
        let end = end_of_run(system, &self.observe(), &state)?;
        Ok(!end.attractor.quiet)
    }

    fn fields(&self) -> Fields {
        Fields::of_system(self.units())
    }

    fn force_in_words(&self, force: f64) -> String {
        in_units(self.units(), Quantity::Force, force)
    }

    fn unit_of_rates(&self) -> (&'static str, f64) {
        (if self.units() == UnitSystem::None { "1" } else { "1/s" }, 1.0)
    }
}

/// Whether steady sliding without dither is stable.
fn is_quiet_without_dither(system: &System) -> bool {
    local_verdict(&system.undithered()).is_ok_and(|verdict| verdict == "stable")
}

/// Why a start does not exist.
fn said(why: &Failure) -> String {
    match why {
        Failure::Wrong(complaints) => complaints
            .iter()
            .map(|complaint| complaint.allowed.clone())
            .collect::<Vec<_>>()
            .join("; "),
        Failure::Failed { why, .. } => why.clone(),
    }
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

    fn sampled_at(&self, numbers: &[(ParameterId, f64)]) -> Result<Disc, String> {
        let setup = self.setup_at(numbers).map_err(|why| why.to_string())?;
        Ok(setup.disc().clone())
    }

    fn averaged_growth(&self, disc: &Disc) -> AveragedGrowth {
        // A sample has an ω_ref of its own.
        let scales = disc.scales(0).filter(|_| DiscUnits::of(self).is_some());
        let one = scales.map_or(1.0, |scales| scales.angular_frequency());
        let growth = growth_of_disc(disc, self.parts()).map(JudgedGrowth::of);
        let growth = growth.map(|growth| JudgedGrowth { rate: one * growth.rate, ..growth });
        AveragedGrowth::of(growth.map_err(|status| status.about().to_owned()))
    }

    fn threshold(&self, _: &Disc, _: bool) -> Result<f64, String> {
        Err("thresholds are those of belts and systems: `thresholds` has those of a disc"
            .to_owned())
    }

    fn vibrates(&self, disc: &Disc, _: ProbabilityStart) -> Result<bool, String> {
        self.averaged_growth(disc).growth?.vibrates
    }

    fn fields(&self) -> Fields {
        Fields::new(None)
    }

    fn force_in_words(&self, force: f64) -> String {
        digits(force)
    }

    fn put_rate(&self, fields: &mut Fields, name: &str, rate: Result<f64, String>) {
        match rate {
            Ok(rate) => fields.measured(name, self.unit_of_rates().0, rate),
            Err(why) => fields.unknown(name, why),
        };
    }

    fn unit_of_rates(&self) -> (&'static str, f64) {
        (if DiscUnits::of(self).is_some() { "1/s" } else { "ω_ref" }, 1.0)
    }
}
