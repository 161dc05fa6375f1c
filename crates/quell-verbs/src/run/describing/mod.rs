//! `friction --describing`: the describing function of every contact, and the slow vibration that a weak dither leaves.
//!
//! Each contact has the fast motion that the structure makes of all dithers there, under its mean load in averaged sliding. The slow
//! vibration is that of harmonic balance with the structure ([`SlowVibration`]), where it holds. Of one mass `limit` has the cycles by
//! averaging in the limit of high dither frequency.

mod gains;
mod limit;
mod unknown;

use quell_linear::averaging::{
    AveragedLaw, AveragedSliding, AveragingError, DescribedVibration, DescribingFunction,
    DitheredSystem, NoSlowVibration, SlowVibration,
};
use quell_model::Contact;
use quell_model::system::{Input, InputTarget};
use quell_model::units::Quantity;
use serde_json::Value as Json;

pub use gains::{GainCurve, NoSmallGain};
pub use limit::LimitAveragedCycles;
pub use unknown::{JudgedUpTo, NoSmallGrowth, NoStableCycle};

use crate::complaint::{Complaint, Failure};
use crate::contact_state;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::noise::few_lines;
use crate::range;
use crate::run::system::{has_equations, in_units, oscillating, velocity_in_words};
use crate::study::{SystemStudy, UnitSystem};

/// The failure of an average.
fn failed(why: impl std::fmt::Display) -> Failure {
    Failure::Failed { key: "friction".to_owned(), why: why.to_string().into() }
}

/// Rejects an amplitude that is not above 0.
fn is_amplitude(largest: f64) -> Result<(), Failure> {
    if largest > 0.0 && largest.is_finite() {
        return Ok(());
    }
    let allowed = "a velocity amplitude above 0";
    Err(Complaint::option("--describing", largest.to_string(), allowed).into())
}

/// Averaged friction of one contact under a slow sinusoid of its slip velocity.
#[derive(Clone, Debug)]
pub struct DescribedContact {
    /// Name of the contact.
    pub name: String,
    /// Mean slip velocity, that of the surface.
    pub velocity: f64,
    /// Mean normal load.
    pub normal_load: f64,
    /// Mean and equivalent gain.
    pub curve: GainCurve,
}

/// The describing functions of a system.
#[derive(Clone, Debug)]
pub struct DescribedContacts {
    /// Largest velocity amplitude.
    pub largest: f64,
    /// The contacts, in the order of the study.
    pub contacts: Vec<DescribedContact>,
    /// The slow vibration, or why harmonic balance does not hold.
    pub balance: Result<SlowBalance, NoSlowVibration>,
    /// The cycles of one mass in the limit of high dither frequency, or why they are unknown; `None` of other systems and without dither.
    pub limit: Option<Result<LimitAveragedCycles, AveragingError>>,
    warnings: Vec<String>,
}

/// The balance of slow motions over the amplitude at one contact.
#[derive(Clone, Debug)]
pub struct SlowBalance {
    /// The contact, counted from 0.
    pub contact: usize,
    /// Growth rate of slow motions at each amplitude of its curve.
    pub growth: Vec<f64>,
    /// Growth rate of small slow motions, or why it is unknown.
    pub small: Result<f64, NoSmallGrowth>,
    /// Every limit cycle up to the largest amplitude, ascending.
    pub cycles: Vec<DescribedVibration>,
}

/// The describing functions of a system for amplitudes of the slip velocity up to `largest`.
///
/// # Errors
/// A complaint about an amplitude that is not above 0; [`Failure::Failed`] without averaged sliding or if an average has no value.
pub fn run(study: &SystemStudy, largest: f64) -> Result<DescribedContacts, Failure> {
    has_equations(study, "friction --describing")?;
    is_amplitude(largest)?;
    let system = study.system();
    let prepared = DitheredSystem::new(system).map_err(failed)?;
    let average = prepared.average().map_err(failed)?;
    let (mut contacts, mut functions) = (Vec::new(), Vec::new());
    for (index, contact) in system.contacts.iter().enumerate() {
        let (velocity, normal_load) =
            (contact.surface_velocity.mean(), average.contacts[index].normal_load);
        let law = prepared.fast().law(system, (index, normal_load), None);
        let law = law.map_err(failed)?;
        let function = DescribingFunction::new(law, velocity).map_err(failed)?;
        let bare = AveragedLaw::undithered(&contact.friction);
        let without = DescribingFunction::new(bare, velocity).map_err(failed)?;
        let curve = GainCurve::new(&function, &without, largest).map_err(failed)?;
        contacts.push(DescribedContact {
            name: contact.name.clone(),
            velocity,
            normal_load,
            curve,
        });
        functions.push(function);
    }
    let balance = SlowVibration::contact_of(system);
    let balance = balance.and_then(|contact| {
        balance_of(&average, contact, &functions[contact], &contacts[contact].curve)
    });
    let warnings = warnings(study, &average, largest);
    let limit = LimitAveragedCycles::of(system, largest);
    Ok(DescribedContacts { largest, contacts, balance, limit, warnings })
}

fn balance_of(
    average: &AveragedSliding,
    contact: usize,
    function: &DescribingFunction,
    curve: &GainCurve,
) -> Result<SlowBalance, NoSlowVibration> {
    let slow = SlowVibration::new(average, contact, function);
    let rate = |gain: f64| slow.growth_rate(gain);
    let cycles = slow.cycles(curve.largest)?;
    let growth = curve.gains().into_iter().map(rate).collect::<Result<Vec<f64>, _>>()?;
    let small = curve.small.clone().map_err(NoSmallGrowth::from);
    let small = small.and_then(|gain| Ok(rate(gain)?));
    Ok(SlowBalance { contact, growth, small, cycles })
}

/// Slip beyond the range of a law, contacts with a state, and loads that open.
fn warnings(study: &SystemStudy, average: &AveragedSliding, largest: f64) -> Vec<String> {
    let system = study.system();
    let mut warnings = study.warnings().to_vec();
    let contacts = system.contacts.iter().zip(&average.contacts);
    warnings.extend(contacts.filter_map(|(contact, found): (&Contact, _)| {
        range::at_contact(contact, found.largest_slip(contact) + largest, |speed| {
            velocity_in_words(study, speed)
        })
    }));
    warnings.extend(contact_state::averaged_without_states(system, &average.contacts));
    warnings.extend(few_lines(system));
    let of_load = |input: &Input| matches!(input.target, InputTarget::NormalLoad { .. });
    if system.inputs.iter().any(of_load) {
        warnings.push(
            "the fast motion under dither of a load is that at the velocity of the surface; it changes over a slow motion of large \
             amplitude"
                .to_owned(),
        );
    }
    warnings
}

impl DescribedContacts {
    /// The smallest stable limit cycle.
    ///
    /// # Errors
    /// Why no such cycle exists up to the largest amplitude.
    pub fn stable_cycle(&self, study: &SystemStudy) -> Result<&DescribedVibration, NoStableCycle> {
        let no_balance = |why: &NoSlowVibration| NoStableCycle::NoBalance(why.clone());
        let balance = self.balance.as_ref().map_err(no_balance)?;
        let largest = JudgedUpTo { amplitude: self.largest, units: study.units() };
        balance.cycles.iter().find(|found| found.cycle.stable).ok_or_else(|| {
            if balance.growth.iter().all(|rate| *rate < 0.0) {
                NoStableCycle::AllDecay(largest)
            } else if balance.growth.iter().all(|rate| *rate > 0.0) {
                NoStableCycle::AllGrow(largest)
            } else {
                NoStableCycle::NoneStable(largest)
            }
        })
    }

    /// The result in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let units = study.units();
        let which = if study.system().is_dithered() {
            "friction averaged over the dither"
        } else {
            "friction"
        };
        let balance = match &self.balance {
            Ok(balance) => balance,
            Err(why) => {
                return format!(
                    "The describing function of {which} is known at every contact, but no slow vibration follows from it: {why}."
                );
            }
        };
        let contact = &self.contacts[balance.contact].name;
        let small = match &balance.small {
            Ok(rate) if *rate > 0.0 => "Small slow motions grow.",
            Ok(_) => "Small slow motions decay.",
            Err(_) => "The growth of small slow motions is unknown.",
        };
        let velocity = |amplitude: f64| in_units(units, Quantity::Velocity, amplitude);
        let cycles = match self.stable_cycle(study) {
            Ok(found) => {
                let before = balance.cycles.iter().find(|other| {
                    !other.cycle.stable && other.cycle.amplitude < found.cycle.amplitude
                });
                let from = before.map_or_else(String::new, |other| {
                    let velocity = velocity(other.cycle.amplitude);
                    format!(" Motions above the velocity amplitude {velocity} grow.")
                });
                let length = found.amplitude(&study.observe());
                format!(
                    "{from} A stable limit cycle {} has the velocity amplitude {} at the contact and the amplitude {} of the observed \
                     displacement.",
                    oscillating(units, found.frequency),
                    velocity(found.cycle.amplitude),
                    in_units(units, Quantity::Displacement, length)
                )
            }
            Err(why) => format!(" No limit cycle: {why}."),
        };
        format!("By the describing function of {which} at contact {contact}: {small}{cycles}")
    }

    /// Warnings: a slow motion that reverses or sticks, slip beyond the range of a law, and states of contacts.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        let reverses = self.balance.as_ref().is_ok_and(|balance| {
            let speed = self.contacts[balance.contact].velocity.abs();
            balance.cycles.iter().any(|found| found.cycle.stable && found.cycle.amplitude > speed)
        });
        if reverses {
            warnings.push(
                "the slow velocity of the limit cycle exceeds the velocity of the surface: the contact may stick in each slow period, so \
                 that the motion is no sinusoid; response gives its amplitude"
                    .to_owned(),
            );
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let empty = || Fields::in_units(study.units());
        let mut fields = empty();
        let observe = study.observe();
        let stable = self.stable_cycle(study);
        let of = |pick: &dyn Fn(&DescribedVibration) -> f64| stable.clone().map(pick);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .known("limit_cycle_velocity", Quantity::Velocity, of(&|found| found.cycle.amplitude))
            .known(
                "limit_cycle_amplitude",
                Quantity::Displacement,
                of(&|found| found.amplitude(&observe)),
            )
            .known("limit_cycle_frequency", Quantity::FrequencyRatio, of(&|found| found.frequency));
        match &self.balance {
            Ok(balance) => {
                let cycles = balance.cycles.iter().map(|found| {
                    let mut inner = empty();
                    inner
                        .number("velocity_amplitude", Quantity::Velocity, found.cycle.amplitude)
                        .number("velocity_amplitude_error", Quantity::Velocity, found.cycle.error)
                        .number("amplitude", Quantity::Displacement, found.amplitude(&observe))
                        .number("frequency", Quantity::FrequencyRatio, found.frequency)
                        .plain("stable", found.cycle.stable);
                    inner
                });
                let growth: Vec<Option<f64>> = balance.growth.iter().copied().map(Some).collect();
                fields
                    .plain("balanced_contact", self.contacts[balance.contact].name.as_str())
                    .list("limit_cycles", cycles.collect::<Vec<_>>())
                    .known_rate("small_growth_rate", balance.small.clone())
                    .rates("growth_rate", &growth, "unknown");
            }
            Err(why) => {
                for name in ["balanced_contact", "limit_cycles", "growth_rate"] {
                    fields.unknown(name, why);
                }
                fields.known_rate("small_growth_rate", Err(why));
            }
        }
        let contacts = self.contacts.iter().map(|contact| {
            let mut inner = empty();
            inner
                .plain("name", contact.name.as_str())
                .number("slip_velocity", Quantity::Velocity, contact.velocity)
                .number("normal_load", Quantity::Force, contact.normal_load)
                .known("small_gain", Quantity::PerVelocity, contact.curve.small.clone());
            contact.curve.put(&mut inner);
            inner
        });
        fields.list("contacts", contacts.collect::<Vec<_>>());
        match &self.limit {
            Some(Ok(limit)) => {
                fields.nested("limit", limit.fields(study, self.largest));
            }
            Some(Err(why)) => {
                fields.unknown("limit", why);
            }
            None => {}
        }
        fields.plain("warnings", self.warnings());
        fields.finish()
    }

    /// As a dataset, one row for each contact and amplitude.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let counts =
            self.contacts.iter().map(|contact| (contact.name.as_str(), contact.curve.points.len()));
        let rows = |of: &dyn Fn(&GainCurve) -> Vec<f64>| -> Vec<f64> {
            self.contacts.iter().flat_map(|contact| of(&contact.curve)).collect()
        };
        let growth =
            self.contacts.iter().enumerate().flat_map(|(index, contact)| match &self.balance {
                Ok(balance) if balance.contact == index => balance.growth.clone(),
                _ => vec![f64::NAN; contact.curve.points.len()],
            });
        let rate = if study.units() == UnitSystem::None { "1" } else { "1/s" };
        Dataset::of(&study.into(), "friction")
            .fact(self.sentence(study))
            .by_contact(counts)
            .array("velocity_amplitude", Quantity::Velocity, rows(&GainCurve::amplitudes))
            .array("mean_coefficient", Quantity::Ratio, rows(&GainCurve::coefficients))
            .per_velocity("gain", rows(&GainCurve::gains))
            .per_velocity("undithered_gain", rows(&GainCurve::undithered_gains))
            .with(Array::new("growth_rate", rate, growth.collect()))
    }
}
