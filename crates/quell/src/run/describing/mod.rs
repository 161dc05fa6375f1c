//! `friction --describing`: averaged friction under a slow sinusoid of the slip velocity, and the limit cycles that it predicts.
//!
//! Of a belt the averages are those of finite-R averaging, and `limit` has the cycles of the limit of high frequency. Of a system
//! every average has the fast motion that the structure makes of the dither (`system`).

mod gains;
mod system;

use quell_linear::averaging::{Averaging, AveragingError, DescribedCycle, DescribingFunction};
use quell_model::units::Quantity;
use quell_model::{Belt, Direction};
use serde_json::Value as Json;

pub use gains::GainCurve;
pub use system::{DescribedContact, DescribedContacts, of_system};

use gains::small;

use crate::complaint::{Complaint, Failure};
use crate::contact_state::refused_of_belt;
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::range;
use crate::study::BeltStudy;
use crate::words::in_words;

/// The failure of an average.
fn failed(why: impl std::fmt::Display) -> Failure {
    Failure::Failed { key: "friction".to_owned(), why: why.to_string() }
}

/// Rejects an amplitude that is not above 0.
fn is_amplitude(largest: f64) -> Result<(), Failure> {
    if largest > 0.0 && largest.is_finite() {
        return Ok(());
    }
    let allowed = "a velocity amplitude above 0";
    Err(Complaint::option("--describing", largest.to_string(), allowed).into())
}

/// The describing function of a belt at its belt velocity.
#[derive(Clone, Debug)]
pub struct DescribedFriction {
    /// Mean and equivalent gain.
    pub curve: GainCurve,
    /// Every limit cycle up to the largest amplitude, ascending.
    pub cycles: Vec<DescribedCycle>,
    /// The same in the limit of high dither frequency; or why it is unavailable.
    pub limit: Result<LimitAveragedCycles, String>,
}

/// Limit cycles by averaging in the limit of high dither frequency.
#[derive(Clone, Debug)]
pub struct LimitAveragedCycles {
    /// The gain for a → 0, or why it has no value.
    pub small: Result<f64, String>,
    /// Every limit cycle, ascending.
    pub cycles: Vec<DescribedCycle>,
}

/// The describing function of a belt for velocity amplitudes up to `largest`.
///
/// # Errors
/// A complaint about an amplitude that is not above 0; [`Failure::Failed`] if an average has no value.
pub fn of_belt(study: &BeltStudy, largest: f64) -> Result<DescribedFriction, Failure> {
    refused_of_belt(study, "friction --describing")?;
    is_amplitude(largest)?;
    let belt = study.belt();
    let finite_r = Averaging::FiniteR;
    let function = DescribingFunction::of_belt(belt, finite_r).map_err(failed)?;
    let bare = belt.undithered();
    let without = DescribingFunction::of_belt(&bare, finite_r).map_err(failed)?;
    Ok(DescribedFriction {
        curve: GainCurve::new(&function, &without, largest).map_err(failed)?,
        cycles: cycles_of(belt, &function, largest).map_err(failed)?,
        limit: limit(belt, largest),
    })
}

fn cycles_of(
    belt: &Belt,
    function: &DescribingFunction,
    largest: f64,
) -> Result<Vec<DescribedCycle>, AveragingError> {
    function.cycles(largest, |gain| Ok::<f64, AveragingError>(balance(belt, gain)))
}

/// The cycles in the limit of high dither frequency.
fn limit(belt: &Belt, largest: f64) -> Result<LimitAveragedCycles, String> {
    if belt.dithers().is_empty() {
        return Err("the study has no dither".to_owned());
    }
    let of = || -> Result<LimitAveragedCycles, AveragingError> {
        let function = DescribingFunction::of_belt(belt, Averaging::Limit)?;
        let cycles = cycles_of(belt, &function, largest)?;
        Ok(LimitAveragedCycles { small: small(&function), cycles })
    };
    of().map_err(|why| why.to_string())
}

/// 2ζ + FN₁.
pub(crate) fn balance(belt: &Belt, gain: f64) -> f64 {
    belt.damping_rate(gain, belt.normal_load())
}

/// The smallest stable cycle.
fn first_stable(cycles: &[DescribedCycle]) -> Option<&DescribedCycle> {
    cycles.iter().find(|cycle| cycle.stable)
}

impl DescribedFriction {
    /// 2ζ + FN₁(a) at each amplitude.
    pub fn balances(&self, study: &BeltStudy) -> Vec<f64> {
        self.curve.gains().iter().map(|gain| balance(study.belt(), *gain)).collect()
    }

    /// The smallest stable limit cycle.
    ///
    /// # Errors
    /// Why no such cycle exists up to the largest amplitude.
    pub fn stable_cycle(&self, study: &BeltStudy) -> Result<&DescribedCycle, String> {
        let largest = in_words(study, Quantity::Velocity, self.curve.largest);
        first_stable(&self.cycles).ok_or_else(|| {
            let balances = self.balances(study);
            if balances.iter().all(|balance| *balance > 0.0) {
                format!("slow motions of every velocity amplitude up to {largest} decay")
            } else if balances.iter().all(|balance| *balance < 0.0) {
                format!("slow motions of every velocity amplitude up to {largest} grow")
            } else {
                format!("no stable cycle has a velocity amplitude up to {largest}")
            }
        })
    }

    /// The result in one or two sentences.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let belt = study.belt();
        let dithered = !belt.dithers().is_empty();
        let which = if dithered { "friction averaged over the dither" } else { "friction" };
        let velocity = in_words(study, Quantity::Velocity, belt.belt_velocity());
        let words = |cycle: &DescribedCycle| in_words(study, Quantity::Velocity, cycle.amplitude);
        let small = match &self.curve.small {
            Ok(slope) if balance(belt, *slope) < 0.0 => "Small slow motions grow.",
            Ok(_) => "Small slow motions decay.",
            Err(_) => "The growth of small slow motions is unknown.",
        };
        let cycles = match self.stable_cycle(study) {
            Ok(cycle) => {
                let before = self
                    .cycles
                    .iter()
                    .find(|other| !other.stable && other.amplitude < cycle.amplitude);
                let from = before.map_or_else(String::new, |other| {
                    format!(" Motions above the velocity amplitude {} grow.", words(other))
                });
                format!("{from} A stable limit cycle has the velocity amplitude {}.", words(cycle))
            }
            Err(why) => format!(" No limit cycle: {why}."),
        };
        format!("By the describing function of {which} at v₀ = {velocity}: {small}{cycles}")
    }

    /// Warnings: a slow motion that reverses or sticks, normal dither, and slip beyond the range of the law.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let belt = study.belt();
        let v0 = belt.belt_velocity();
        let mut warnings = range::averaged_at(study, v0 + self.curve.largest);
        let reverses = self.cycles.iter().any(|cycle| cycle.stable && cycle.amplitude > v0);
        if reverses {
            warnings.push(
                "the slow velocity of the limit cycle exceeds the belt velocity: the mass may stick in each slow period, so that \
                 the motion is no sinusoid; response gives its amplitude"
                    .to_owned(),
            );
        }
        if belt.dithers_along(Direction::Normal).next().is_some() {
            warnings.push(
                "the fast motion under normal dither is that at the belt velocity; it changes over a slow motion of large amplitude"
                    .to_owned(),
            );
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let mut fields = Fields::new(study.scales());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .number("belt_velocity", Quantity::Velocity, study.belt().belt_velocity())
            .known("small_gain", Quantity::PerVelocity, self.curve.small.clone())
            .known(
                "limit_cycle_velocity",
                Quantity::Velocity,
                self.stable_cycle(study).map(|cycle| cycle.amplitude),
            )
            .known(
                "limit_cycle_amplitude",
                Quantity::Displacement,
                self.stable_cycle(study).map(|cycle| cycle.amplitude),
            );
        let empty = || Fields::new(study.scales());
        fields.list("limit_cycles", put_cycles(&self.cycles, &empty));
        self.put_limit(study, &mut fields);
        self.curve.put(&mut fields);
        fields
            .numbers("balance", Quantity::Ratio, &self.balances(study))
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The cycles in the limit of high dither frequency.
    fn put_limit(&self, study: &BeltStudy, fields: &mut Fields) {
        let empty = || Fields::new(study.scales());
        let found = match &self.limit {
            Ok(found) => found,
            Err(why) => {
                fields.unknown("limit", why.as_str());
                return;
            }
        };
        let mut inner = empty();
        let stable = first_stable(&found.cycles).map(|cycle| cycle.amplitude);
        let largest = in_words(study, Quantity::Velocity, self.curve.largest);
        let stable = stable
            .ok_or_else(|| format!("no stable cycle has a velocity amplitude up to {largest}"));
        inner
            .known("small_gain", Quantity::PerVelocity, found.small.clone())
            .known("limit_cycle_velocity", Quantity::Velocity, stable.clone())
            .known("limit_cycle_amplitude", Quantity::Displacement, stable)
            .list("limit_cycles", put_cycles(&found.cycles, &empty));
        fields.nested("limit", inner);
    }

    /// As a dataset.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let dataset = Dataset::new(study, "friction").fact(self.sentence(study));
        self.curve.columns(dataset).array("balance", Quantity::Ratio, self.balances(study))
    }
}

/// The cycles of a belt: the velocity amplitude is that of the displacement too.
fn put_cycles(cycles: &[DescribedCycle], empty: &impl Fn() -> Fields) -> Vec<Fields> {
    let each = cycles.iter().map(|cycle| {
        let mut inner = empty();
        inner
            .number("velocity_amplitude", Quantity::Velocity, cycle.amplitude)
            .number("amplitude", Quantity::Displacement, cycle.amplitude)
            .number("velocity_amplitude_error", Quantity::Velocity, cycle.error)
            .plain("stable", cycle.stable);
        inner
    });
    each.collect()
}
