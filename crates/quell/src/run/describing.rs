//! `friction --describing`: averaged friction under a slow sinusoid of the slip velocity, and the limit cycles that it predicts.

use quell_linear::averaging::{
    AveragingError, AveragingOptions, DescribedCycle, DescribingFunction, EquivalentGain,
};
use quell_model::units::Quantity;
use quell_model::{Belt, Direction};
use rayon::prelude::*;
use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure};
use crate::contact_state::refused_of_belt;
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::range;
use crate::study::BeltStudy;
use crate::words::in_words;

/// Equal steps of the amplitude up to the largest one.
const STEPS: u32 = 100;

/// The describing function of a study at its belt velocity.
#[derive(Clone, Debug)]
pub struct DescribedFriction {
    /// Largest velocity amplitude.
    pub largest: f64,
    /// Mean and equivalent gain over the amplitudes, ascending.
    pub points: Vec<EquivalentGain>,
    /// The gain without dither at the same amplitudes.
    pub undithered: Vec<EquivalentGain>,
    /// The gain for a → 0, per unit velocity; or why it has no value.
    pub small: Result<f64, String>,
    /// Every limit cycle up to the largest amplitude, ascending.
    pub cycles: Vec<DescribedCycle>,
}

/// The describing function for velocity amplitudes up to `largest`.
///
/// # Errors
/// A complaint about an amplitude that is not above 0; [`Failure::Failed`] if an average has no value.
pub fn run(study: &BeltStudy, largest: f64) -> Result<DescribedFriction, Failure> {
    refused_of_belt(study, "friction --describing")?;
    if !(largest > 0.0 && largest.is_finite()) {
        let allowed = "a velocity amplitude above 0";
        return Err(Complaint::option("--describing", largest.to_string(), allowed).into());
    }
    let failed =
        |why: AveragingError| Failure::Failed { key: "friction".to_owned(), why: why.to_string() };
    let belt = study.belt();
    let function = DescribingFunction::new(belt, AveragingOptions::default()).map_err(failed)?;
    let bare = belt.undithered();
    let without = DescribingFunction::new(&bare, AveragingOptions::default()).map_err(failed)?;
    let mut amplitudes: Vec<f64> =
        (1..=STEPS).map(|k| largest * f64::from(k) / f64::from(STEPS)).collect();
    // Where a corner of the averaged law enters, the gain has a kink.
    amplitudes.extend(function.corner_amplitudes().into_iter().filter(|a| *a < largest));
    amplitudes.sort_unstable_by(f64::total_cmp);
    amplitudes.dedup();
    let over = |function: &DescribingFunction<'_>| -> Result<Vec<EquivalentGain>, Failure> {
        let found: Result<Vec<_>, _> =
            amplitudes.par_iter().map(|amplitude| function.at(*amplitude)).collect();
        found.map_err(failed)
    };
    let small = match function.small() {
        Ok(Some(slope)) => Ok(slope),
        Ok(None) => Err("the belt velocity equals the largest fast velocity, at which the slope of averaged friction jumps".to_owned()),
        Err(why) => Err(why.to_string()),
    };
    Ok(DescribedFriction {
        largest,
        points: over(&function)?,
        undithered: over(&without)?,
        small,
        cycles: function.cycles(largest).map_err(failed)?,
    })
}

/// 2ζ + FN₁.
pub(crate) fn balance(belt: &Belt, gain: f64) -> f64 {
    belt.normal_load().mul_add(gain, 2.0 * belt.damping_ratio())
}

impl DescribedFriction {
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

    /// 2ζ + FN₁(a) at each amplitude.
    pub fn balances(&self, study: &BeltStudy) -> Vec<f64> {
        self.points.iter().map(|point| balance(study.belt(), point.gain)).collect()
    }

    /// The smallest stable limit cycle.
    ///
    /// # Errors
    /// Why no such cycle exists up to the largest amplitude.
    pub fn stable_cycle(&self, study: &BeltStudy) -> Result<&DescribedCycle, String> {
        let largest = in_words(study, Quantity::Velocity, self.largest);
        self.cycles.iter().find(|cycle| cycle.stable).ok_or_else(|| {
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
        let small = match &self.small {
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
        let mut warnings = range::averaged_at(study, v0 + self.largest);
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
            .known("small_gain", Quantity::PerVelocity, self.small.clone())
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
        let cycles = self.cycles.iter().map(|cycle| {
            let mut inner = Fields::new(study.scales());
            inner
                .number("velocity_amplitude", Quantity::Velocity, cycle.amplitude)
                .number("amplitude", Quantity::Displacement, cycle.amplitude)
                .number("velocity_amplitude_error", Quantity::Velocity, cycle.error)
                .plain("stable", cycle.stable);
            inner
        });
        let errors = Self::column(&self.points, |point| point.error);
        fields
            .list("limit_cycles", cycles)
            .numbers("velocity_amplitude", Quantity::Velocity, &self.amplitudes())
            .numbers("mean_coefficient", Quantity::Ratio, &self.coefficients())
            .per_velocity("gain", &self.gains())
            .per_velocity("gain_error", &errors)
            .per_velocity("undithered_gain", &self.undithered_gains())
            .numbers("balance", Quantity::Ratio, &self.balances(study))
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// As a dataset.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        Dataset::new(study, "friction")
            .fact(self.sentence(study))
            .axis("velocity_amplitude", Quantity::Velocity, self.amplitudes())
            .array("mean_coefficient", Quantity::Ratio, self.coefficients())
            .per_velocity("gain", self.gains())
            .per_velocity("undithered_gain", self.undithered_gains())
            .array("balance", Quantity::Ratio, self.balances(study))
    }
}
