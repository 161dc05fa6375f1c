//! The registry of what a map can show.
//!
//! A quantity is asked for by its name; it says which kind of study it is for, which
//! computation it needs, and which variables it gives. Quantities with the same computation
//! share it.

use quell_dynamics::response::Effect;
use quell_linear::averaging::{AveragedVerdict, Criterion, UndecidedBecause};
use quell_linear::growth::Growth;
use quell_model::units;

use super::evaluate::{Computation, Results, Steady};
use super::status::Status;
use crate::complaint::{Complaint, Fault, Origin};
use crate::run::stability::growth_rate;
use crate::study::{Subject, suggest};

/// A kind of study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum System {
    /// A mass on a moving belt.
    Belt,
    /// An annular disc under rotating loads.
    Disc,
}

/// What the numbers of a variable are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Numbers of a quantity.
    Number(units::Quantity),
    /// Rates per unit τ, in SI per second.
    Rate,
    /// Rates of a disc per unit τ = ω_ref t.
    DiscRate,
    /// One of these words, stored as its place in the list.
    Word {
        /// The words.
        words: &'static [&'static str],
        /// The word where it is not known.
        unknown: &'static str,
    },
}

/// One array of a map.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Its name in stores, JSON and CSV.
    pub name: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    /// Its symbol in the equations; empty where it has none.
    pub symbol: &'static str,
    /// What its numbers are.
    pub kind: Kind,
    /// What its status can be besides the common ones.
    pub statuses: &'static [Status],
    /// Takes its number out of what was computed.
    read: fn(&Results) -> Result<f64, Status>,
}

impl Variable {
    /// Its number at a point, or why there is none.
    pub(super) fn read(&self, results: &Results) -> Result<f64, Status> {
        let value = (self.read)(results)?;
        if value.is_finite() { Ok(value) } else { Err(Status::NotFinite) }
    }

    /// Every state it can have, in the order of their codes.
    pub fn all_statuses(&self, computation: Computation) -> Vec<Status> {
        let common = [Status::Known, Status::InvalidStudy, Status::NotFinite, Status::Missing];
        let friction = computation.meets_friction().then_some(Status::BeyondRange);
        let mut all: Vec<Status> =
            common.into_iter().chain(friction).chain(self.statuses.iter().copied()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// One thing that a map can show.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    /// The kind of study it is for.
    pub system: System,
    /// What it is computed from.
    pub computation: Computation,
    /// What it gives.
    pub variables: &'static [Variable],
}

impl PartialEq for Quantity {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.system == other.system
    }
}

impl Quantity {
    /// The quantity of a name.
    ///
    /// # Errors
    /// A complaint about `option` with the nearest name.
    pub fn named(name: &str, option: &'static str) -> Result<&'static Self, Box<Complaint>> {
        Self::named_for(System::Belt, name, option)
    }

    /// The quantity of a name for a kind of study.
    ///
    /// # Errors
    /// A complaint about `option` with the nearest name.
    pub fn named_for(
        system: System,
        name: &str,
        option: &'static str,
    ) -> Result<&'static Self, Box<Complaint>> {
        let there = || QUANTITIES.iter().filter(|quantity| quantity.system == system);
        if let Some(found) = there().find(|quantity| quantity.name == name) {
            return Ok(found);
        }
        let names: Vec<&str> = there().map(|quantity| quantity.name).collect();
        let allowed = format!("one of {}", names.join(", "));
        let complaint =
            Complaint::new(Fault::Value, option, Origin::Argument(option), name, allowed);
        let nearest = suggest::word(&name.replace('_', "-"), names);
        Err(Box::new(complaint.suggesting(nearest)))
    }

    /// Whether it is for a study of this kind.
    pub(super) fn fits(&self, study: &Subject) -> Result<(), Box<Complaint>> {
        let system = System::of(study);
        if self.system == system {
            return Ok(());
        }
        Self::named_for(system, self.name, "--quantity").map(|_| ())
    }
}

impl System {
    /// The kind of a study.
    pub fn of(study: &Subject) -> Self {
        match study {
            Subject::Belt(_) => Self::Belt,
            Subject::Disc(_) => Self::Disc,
        }
    }
}

/// What a response can be instead of known.
const OF_RESPONSE: &[Status] = &[Status::Stalled, Status::NoSquealingStart];

/// The same for E.
const OF_EFFICIENCY: &[Status] = &[
    Status::Stalled,
    Status::NoSquealingStart,
    Status::UnditheredSettles,
    Status::UnditheredAtRest,
    Status::UnditheredUnknown,
];

/// The same for power and stroke.
const OF_COST: &[Status] = &[Status::Stalled, Status::NoSquealingStart, Status::OnlyNormalDither];

/// What averaging can be instead of known.
const OF_AVERAGING: &[Status] =
    &[Status::SetValued, Status::TooManyGroups, Status::NotFast, Status::NotConverged];

/// The same for the sharper averaging.
const OF_SHARPER: &[Status] = &[
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
];

/// The same for verdicts.
const OF_VERDICT: &[Status] = &[
    Status::WithinError,
    Status::AtCorner,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
];

/// The same for critical amplitudes.
const OF_CRITICAL: &[Status] = &[
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoDither,
    Status::NeverChanges,
    Status::ChangesOnce,
];

/// Words of a verdict; the first is 0, so that a verdict is 1 where sliding is stable.
const VERDICTS: Kind = Kind::Word { words: &["unstable", "stable"], unknown: "undecided" };

/// Words of an effect; the first is 0, what is wanted of a dither.
const EFFECTS: Kind = Kind::Word { words: &Effect::NAMES, unknown: "unknown" };

/// What an effect can be instead of known.
const OF_EFFECT: &[Status] = &[
    Status::Stalled,
    Status::NoSquealingStart,
    Status::UnditheredUnknown,
    Status::StillChanging,
    Status::NoDither,
];

/// Words of a flag.
const SETTLED: Kind = Kind::Word { words: &["no", "yes"], unknown: "unknown" };

const RATIO: Kind = Kind::Number(units::Quantity::Ratio);
const LENGTH: Kind = Kind::Number(units::Quantity::Displacement);
const FORCE: Kind = Kind::Number(units::Quantity::Force);
const VELOCITY: Kind = Kind::Number(units::Quantity::Velocity);

const fn belt(
    name: &'static str,
    about: &'static str,
    computation: Computation,
    variables: &'static [Variable],
) -> Quantity {
    Quantity { name, about, system: System::Belt, computation, variables }
}

const fn variable(
    (name, symbol): (&'static str, &'static str),
    about: &'static str,
    kind: Kind,
    statuses: &'static [Status],
    read: fn(&Results) -> Result<f64, Status>,
) -> Variable {
    Variable { name, about, symbol, kind, statuses, read }
}

/// Whether a response has settled: it comes with every number of one.
pub(super) const SETTLED_NAME: &str = "settled";

/// Everything that a map can show.
#[rustfmt::skip]
pub const QUANTITIES: &[Quantity] = &[
    belt("effect", "what the dither does to the vibration: quenches, reduces, increases, causes, or quiet without and with it", Computation::ResponseWithEffect, &[
        variable(("effect", ""), "effect of the dither", EFFECTS, OF_EFFECT, effect),
    ]),
    belt("efficiency", "residual vibration E = M₁/M₀ (2.27), the share left by the dither, 0 where it is quenched", Computation::Response, &[
        variable(("efficiency", "E"), "residual vibration E = M₁/M₀", RATIO, OF_EFFICIENCY, |r| steady(r)?.efficiency.map_err(Status::from)),
    ]),
    belt("amplitude", "largest spectral amplitude M of the displacement below 1.9 ω₀", Computation::Response, &[
        variable(("amplitude", "M"), "spectral amplitude of the slow vibration", LENGTH, OF_RESPONSE, |r| Ok(steady(r)?.amplitude)),
    ]),
    belt("undithered-amplitude", "the same of the run without dither, M₀", Computation::Response, &[
        variable(("undithered_amplitude", "M_0"), "spectral amplitude without dither", LENGTH, OF_RESPONSE, |r| Ok(steady(r)?.undithered_amplitude)),
    ]),
    belt("stick-fraction", "share of the time that is spent in stick", Computation::Response, &[
        variable(("stick_fraction", ""), "share of the time in stick", RATIO, OF_RESPONSE, |r| Ok(steady(r)?.stick_fraction)),
    ]),
    belt(SETTLED_NAME, "whether the amplitudes of the two halves of the record agree", Computation::Response, &[
        variable(("settled", ""), "whether the response has settled", SETTLED, OF_RESPONSE, |r| Ok(f64::from(u8::from(steady(r)?.settled)))),
    ]),
    belt("mean-friction", "mean friction force, over k", Computation::Response, &[
        variable(("mean_friction", "⟨f⟩"), "mean friction force", FORCE, OF_RESPONSE, |r| Ok(steady(r)?.mean_friction)),
    ]),
    belt("dither-power", "mean power that tangential dither feeds in", Computation::ResponseWithCost, &[
        variable(("dither_power", "P"), "mean power of the dither", Kind::Number(units::Quantity::Power), OF_COST, |r| steady(r)?.dither_power.ok_or(Status::OnlyNormalDither)),
    ]),
    belt("dither-stroke", "peak-to-peak displacement that the actuator must follow", Computation::ResponseWithCost, &[
        variable(("dither_stroke", ""), "stroke of the dither's actuator", LENGTH, OF_COST, |r| steady(r)?.dither_stroke.ok_or(Status::OnlyNormalDither)),
    ]),
    belt("minimum-normal-load", "smallest normal load, over k", Computation::Response, &[
        variable(("minimum_normal_load", "N_{min}"), "smallest normal load", FORCE, OF_RESPONSE, |r| Ok(steady(r)?.minimum_normal_load)),
    ]),
    belt("verdict", "averaged verdict on steady sliding (2.26): stable or unstable", Computation::Criterion, &[
        variable(("verdict", ""), "averaged verdict on steady sliding", VERDICTS, OF_VERDICT, |r| verdict(limit(r)?)),
    ]),
    belt("criterion", "criterion of averaged stability 2ζ + Fμ̄′ (2.26): unstable where negative", Computation::Criterion, &[
        variable(("criterion", "2ζ + F\\bar{μ}′"), "criterion of averaged stability", RATIO, OF_AVERAGING, |r| Ok(limit(r)?.value)),
    ]),
    belt("growth", "growth rate of small slow motions by averaging, per unit τ", Computation::Criterion, &[
        variable(("growth", "Re ρ"), "averaged growth rate of small slow motions", Kind::Rate, OF_AVERAGING, |r| Ok(growth_rate(limit(r)?.value))),
    ]),
    belt("verdict-sharper", "the verdict with the oscillator's own response to the dither", Computation::CriterionSharper, &[
        variable(("verdict_sharper", ""), "sharper averaged verdict on steady sliding", VERDICTS, OF_VERDICT, |r| verdict(sharper(r)?)),
    ]),
    belt("criterion-sharper", "the criterion with the oscillator's own response to the dither", Computation::CriterionSharper, &[
        variable(("criterion_sharper", "2ζ + F\\bar{μ}′"), "sharper criterion of averaged stability", RATIO, OF_SHARPER, |r| Ok(sharper(r)?.value)),
    ]),
    belt("growth-sharper", "the growth rate with the oscillator's own response to the dither", Computation::CriterionSharper, &[
        variable(("growth_sharper", "Re ρ"), "sharper averaged growth rate", Kind::Rate, OF_SHARPER, |r| Ok(growth_rate(sharper(r)?.value))),
    ]),
    belt("critical-amplitude", "smallest and largest amplitude ratio α = D/R of the first dither at which averaged stability changes", Computation::CriticalAmplitudes, &[
        variable(("critical_amplitude", "α_c"), "smallest critical amplitude ratio of the first dither", VELOCITY, OF_CRITICAL, |r| critical(r, false)),
        variable(("critical_amplitude_upper", "α_c"), "largest critical amplitude ratio of the first dither, where there are several", VELOCITY, OF_CRITICAL, |r| critical(r, true)),
    ]),
    disc("growth", "largest growth rate of the disc, its verdict and the bound on its error", Computation::DiscGrowth, &[
        variable(("growth", "Re ρ"), "largest growth rate", Kind::DiscRate, &[], |r| Ok(grown(r)?.rate)),
        variable(("growth_error", ""), "bound on the error of the growth rate", Kind::DiscRate, &[], |r| Ok(grown(r)?.error)),
        variable(("growth_verdict", ""), "whether the growth rate has a sign within its error", VERDICTS, OF_DISC, |r| decided(grown(r)?)),
    ]),
    disc("frequency", "frequency of the fastest growing motion; under dither up to multiples of R", Computation::DiscGrowth, &[
        variable(("frequency", "Im ρ"), "frequency of the fastest growing motion", Kind::DiscRate, &[], |r| Ok(grown(r)?.frequency)),
    ]),
    disc("verdict", "verdict on the disc: stable or unstable, undecided within its error", Computation::DiscGrowth, &[
        variable(("verdict", ""), "verdict on the disc", VERDICTS, OF_DISC, |r| decided(grown(r)?)),
    ]),
    disc("growth-undithered", "the growth rate without dither", Computation::DiscGrowthUndithered, &[
        variable(("growth_undithered", "Re ρ_0"), "largest growth rate without dither", Kind::DiscRate, &[], |r| Ok(grown_undithered(r)?.rate)),
        variable(("growth_undithered_error", ""), "bound on the error of that", Kind::DiscRate, &[], |r| Ok(grown_undithered(r)?.error)),
    ]),
];

/// What a disc's verdict can be instead of known.
const OF_DISC: &[Status] = &[Status::WithinError];

const fn disc(
    name: &'static str,
    about: &'static str,
    computation: Computation,
    variables: &'static [Variable],
) -> Quantity {
    Quantity { name, about, system: System::Disc, computation, variables }
}

fn steady(results: &Results) -> Result<Steady, Status> {
    results.steady.unwrap_or(Err(Status::Missing))
}

#[expect(clippy::cast_precision_loss, reason = "one of five words")]
fn effect(results: &Results) -> Result<f64, Status> {
    Ok(results.effect.unwrap_or(Err(Status::Missing))?.place()? as f64)
}

fn grown(results: &Results) -> Result<Growth, Status> {
    results.disc.unwrap_or(Err(Status::Missing))
}

fn grown_undithered(results: &Results) -> Result<Growth, Status> {
    results.disc_undithered.unwrap_or(Err(Status::Missing))
}

fn decided(growth: Growth) -> Result<f64, Status> {
    match growth.verdict() {
        quell_linear::growth::Verdict::Unstable => Ok(0.0),
        quell_linear::growth::Verdict::Stable => Ok(1.0),
        quell_linear::growth::Verdict::Undecided => Err(Status::WithinError),
    }
}

fn limit(results: &Results) -> Result<&Criterion, Status> {
    results.criterion.as_ref().map_or(Err(Status::Missing), |found| found.as_ref().map_err(|s| *s))
}

fn sharper(results: &Results) -> Result<&Criterion, Status> {
    let found = results.criterion_sharper.as_ref();
    found.map_or(Err(Status::Missing), |found| found.as_ref().map_err(|status| *status))
}

fn verdict(criterion: &Criterion) -> Result<f64, Status> {
    match criterion.verdict {
        AveragedVerdict::Unstable => Ok(0.0),
        AveragedVerdict::Stable => Ok(1.0),
        AveragedVerdict::Undecided { why: UndecidedBecause::WithinError } => {
            Err(Status::WithinError)
        }
        AveragedVerdict::Undecided { why: UndecidedBecause::AtCorner } => Err(Status::AtCorner),
    }
}

fn critical(results: &Results, upper: bool) -> Result<f64, Status> {
    let found = results.critical_amplitudes.as_ref().ok_or(Status::Missing)?;
    match (found.as_ref().map_err(|status| *status)?.as_slice(), upper) {
        ([], _) => Err(Status::NeverChanges),
        ([first, ..], false) => Ok(first.amplitude_ratio),
        ([_], true) => Err(Status::ChangesOnce),
        ([.., last], true) => Ok(last.amplitude_ratio),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_variables_follow_them() {
        for system in [System::Belt, System::Disc] {
            let there = QUANTITIES.iter().filter(|quantity| quantity.system == system);
            let mut names: Vec<&str> = there.map(|quantity| quantity.name).collect();
            let count = names.len();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), count);
        }
        for quantity in QUANTITIES {
            let first = quantity.variables.first().expect("a variable");
            assert_eq!(first.name, quantity.name.replace('-', "_"));
            let found = Quantity::named_for(quantity.system, quantity.name, "--quantity");
            assert_eq!(found, Ok(quantity));
        }
        let told = Quantity::named("stick_fraction", "--quantity").expect_err("an underscore");
        assert_eq!(told.suggestion.as_deref(), Some("stick-fraction"));
    }
}
