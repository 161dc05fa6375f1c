//! The growth rate of small motions about steady sliding where it is asked at many values, as maps and samples do: alone, of the average
//! under dither, or of a disc.
//!
//! Discs that differ only in the friction of a single load share the constant flow or the assembled equations. Every one goes through
//! the same arithmetic with or without such neighbours, so that its bits do not depend on them.

use quell_disc::dithered;
use quell_disc::equations::linearised;
use quell_linear::averaging::{DitheredContact, DitheredSystem};
use quell_linear::eigenvalues;
use quell_linear::floquet::FollowerDither;
use quell_linear::growth::{Growth, Verdict};
use quell_linear::linearised::Linearised;
use quell_linear::spectrum;
use quell_model::disc::{Contribution, Contributions};
use quell_model::{Contact, Disc, System};
use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::Effort;

use super::stability::averaged_verdict;
use crate::contact_state::averaged_without_states;
use crate::range::outside_of_laws;
use crate::status::Status;
use crate::words::digits;

/// The largest growth rate of one study.
#[derive(Clone, Debug, PartialEq)]
pub struct SlidingGrowth {
    /// Largest growth rate.
    pub growth: Growth,
    /// Largest fast slip velocity over the velocity of its surface, over all contacts.
    pub slip_ratio: f64,
    /// 2ζ + Fμ̄′ (2.26) of one mass, as `stability` has it.
    criterion: Result<f64, Status>,
    /// Whether the fast slip of a contact just reaches the velocity of its surface.
    at_corner: bool,
    /// Why it does not hold as stated: the gravest first.
    pub doubts: Vec<Status>,
}

/// 2ζ + Fμ̄′ of one mass in which friction has this slope.
fn criterion(system: &System, slope: f64) -> Result<f64, Status> {
    let mass = system.one_averaged_mass().ok_or(Status::NotOneMass)?;
    Ok(mass.belt().damping_rate(slope / mass.force(), 1.0))
}

impl SlidingGrowth {
    /// By averaging under dither; where none acts of the small motions themselves.
    ///
    /// # Errors
    /// Why it does not exist.
    pub fn averaged(system: &System) -> Result<Self, Status> {
        if !system.is_dithered() {
            return Self::undithered(system);
        }
        let average = DitheredSystem::new(system).and_then(|prepared| prepared.average());
        let average = average.map_err(Status::from)?;
        let growth = average.growth().map_err(not_finite)?;
        let contacts = system.contacts.iter().zip(&average.contacts);
        let ratios = contacts
            .map(|(contact, found)| found.slip_amplitude / contact.surface_velocity.mean().abs());
        let opens = average.contacts.iter().any(DitheredContact::opens);
        let beyond = !outside_of_laws(system, digits, Some(&average.contacts)).is_empty();
        let without_state = !averaged_without_states(system, &average.contacts).is_empty();
        let doubts = [
            (opens, Status::Opens),
            (beyond, Status::BeyondRange),
            (without_state, Status::WithoutState),
        ];
        let slope = average.contacts.first().map_or(0.0, |contact| contact.slope_by_velocity);
        Ok(Self {
            growth,
            criterion: criterion(system, slope),
            slip_ratio: ratios.fold(0.0, f64::max),
            at_corner: average.contacts.iter().any(|contact| contact.one_sided),
            doubts: doubts.into_iter().filter(|(holds, _)| *holds).map(|(_, why)| why).collect(),
        })
    }

    /// Without dither.
    ///
    /// # Errors
    /// Why it does not exist.
    pub fn undithered(system: &System) -> Result<Self, Status> {
        let linear = Linearised::new(system).map_err(|_| Status::NoSteadySliding)?;
        let friction = linear.friction();
        let growth = spectrum::growth(&linear, &friction).map_err(not_finite)?;
        let slope = friction.first().map_or(0.0, |friction| friction.by_velocity);
        let has_state = system.contacts.iter().any(Contact::has_state);
        let criterion = if has_state { Err(Status::NotOneMass) } else { criterion(system, slope) };
        let beyond = !outside_of_laws(system, digits, None).is_empty();
        let doubts = if beyond { vec![Status::BeyondRange] } else { Vec::new() };
        Ok(Self { criterion, doubts, ..Self::alone(growth) })
    }

    /// That of a growth rate alone, in these units.
    fn alone(growth: Growth) -> Self {
        let criterion = Err(Status::NotOneMass);
        Self { growth, criterion, slip_ratio: 0.0, at_corner: false, doubts: Vec::new() }
    }

    /// The criterion; at a corner, where it jumps, it has no value.
    ///
    /// # Errors
    /// Why it does not exist.
    pub fn criterion(&self) -> Result<f64, Status> {
        if self.at_corner { Err(Status::AtCorner) } else { self.criterion }
    }

    /// That of a disc, of which a rate of the equations is `rate` in the units of the study.
    pub fn in_units(found: Growth, rate: f64) -> Self {
        let Growth { rate: growth, error, frequency } = found;
        Self::alone(Growth {
            rate: rate * growth,
            error: rate * error,
            frequency: rate * frequency,
        })
    }

    /// Whether small motions grow.
    ///
    /// # Errors
    /// Why that is undecided.
    pub fn is_unstable(&self) -> Result<bool, Status> {
        match averaged_verdict(self.growth, self.at_corner) {
            Verdict::Unstable => Ok(true),
            Verdict::Stable => Ok(false),
            Verdict::Undecided if self.at_corner => Err(Status::AtCorner),
            Verdict::Undecided if !self.growth.error.is_finite() => Err(Status::NotFinite),
            Verdict::Undecided => Err(Status::WithinError),
        }
    }
}

/// A disc of unit friction, and what was prepared for it.
pub struct PreparedDisc {
    disc: Disc,
    equations: DiscEquations,
}

enum DiscEquations {
    Dithered(Box<FollowerDither>),
    Constant(Box<Linearised>),
}

/// Largest growth rate of one disc.
///
/// # Errors
/// Why it does not exist.
pub fn growth_of(disc: &Disc, parts: Contributions) -> Result<Growth, Status> {
    disc_growth(disc, parts, &mut None)
}

/// Largest growth rate of a disc. Uses `prepared` if it fits this disc except for the friction of its load.
///
/// # Errors
/// Why it does not exist.
pub fn disc_growth(
    disc: &Disc,
    parts: Contributions,
    prepared: &mut Option<PreparedDisc>,
) -> Result<Growth, Status> {
    let (unit, factor) = match disc.loads() {
        [load] if disc.law().is_none() => {
            let unit = disc.with_friction_of(0, 1.0).map_err(|_| Status::NotFinite)?;
            (unit, load.friction)
        }
        _ => (disc.clone(), 1.0),
    };
    let equations = match prepared {
        Some(prepared) if prepared.disc == unit => &prepared.equations,
        _ => {
            let equations =
                match dithered::prepared_with(&unit, parts).map_err(|_| Status::NotFinite)? {
                    Some(dithered) => DiscEquations::Dithered(Box::new(dithered)),
                    None => DiscEquations::Constant(Box::new(
                        linearised(&unit, parts).map_err(not_finite)?,
                    )),
                };
            &prepared.insert(PreparedDisc { disc: unit, equations }).equations
        }
    };
    match equations {
        DiscEquations::Dithered(dithered) => {
            dithered.growth(factor, Effort::default()).map_err(not_finite)
        }
        DiscEquations::Constant(linear) => {
            let on = parts.contains(Contribution::FollowerForce);
            let mean = linear.contacts().iter();
            let friction: Vec<f64> = mean
                .map(|contact| if on { factor * contact.steady.friction } else { 0.0 })
                .collect();
            eigenvalues::growth(linear, &friction).map_err(not_finite)
        }
    }
}

fn not_finite(_: EigenError) -> Status {
    Status::NotFinite
}
