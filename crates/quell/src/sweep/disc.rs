//! Maps of discs: growth rates, with the work that neighbours share, and the quantities read from them.
//!
//! Points that differ only in the friction of a single load share the constant flow or the assembled equations. Every point
//! goes through the same arithmetic with or without such neighbours, so that its bits do not depend on them.

use quell_disc::dithered;
use quell_disc::equations::linearised;
use quell_linear::eigenvalues;
use quell_linear::floquet::FollowerDither;
use quell_linear::growth::Growth;
use quell_linear::linearised::Linearised;
use quell_model::Disc;
use quell_model::disc::{Contribution, Contributions};
use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::Effort;

use super::evaluate::{Computation, Results};
use super::grid::Grid;
use super::mapped::{Mapped, PointResults, PointScales};
use super::quantity::{MapQuantity, VERDICTS, Variable, VariableKind, decided, variable};
use super::status::Status;
use super::{cost, refine};
use crate::outcome::disc_units::DiscUnits;
use crate::study::{DiscSetup, DiscStudy, Sweep};

/// Maps of disc studies.
pub(super) struct DiscPoints(DiscStudy);

impl DiscPoints {
    pub(super) fn of(study: DiscStudy) -> Self {
        Self(study)
    }
}

impl Mapped for DiscPoints {
    fn quantities(&self) -> &'static [MapQuantity] {
        QUANTITIES
    }

    fn values(&self, sweep: &Sweep) -> Vec<f64> {
        refine::values(&self.0, sweep)
    }

    fn seconds(&self, wanted: &[Computation]) -> f64 {
        cost::of_disc(&self.0, wanted)
    }

    fn compute(
        &self,
        grid: &Grid,
        indices: &[usize],
        wanted: &[Computation],
    ) -> Vec<Option<PointResults>> {
        let study = &self.0;
        let discs: Vec<Option<Disc>> = indices
            .iter()
            .map(|index| Some(study.setup_at(&grid.numbers_at(*index)).ok()?.disc().clone()))
            .collect();
        let found = evaluate(&discs, study.parts(), wanted);
        // Asked once: every point has the units of the study, and an ω_ref of its own.
        let has_units = DiscUnits::of(study).is_some();
        let scales = |disc: &Disc| {
            let scales = disc.scales(0).filter(|_| has_units);
            scales.map_or(PointScales::Own, |scales| PointScales::Disc(scales.angular_frequency()))
        };
        let each = discs.iter().zip(found);
        each.map(|(disc, found)| Some((scales(disc.as_ref()?), found?))).collect()
    }
}

/// The quantities of a map of discs.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    disc("growth", "largest growth rate of the disc, its verdict and the bound on its error", Computation::DiscGrowth, &[
        variable(("growth", "Re ρ"), "largest growth rate", VariableKind::DiscRate, &[], |r| Ok(grown(r)?.rate)),
        variable(("growth_error", ""), "bound on the error of the growth rate", VariableKind::DiscRate, &[], |r| Ok(grown(r)?.error)),
        variable(("growth_verdict", ""), "whether the sign of the growth rate is certain within its error", VERDICTS, OF_DISC, |r| decided(grown(r)?)),
    ]),
    disc("frequency", "frequency of the fastest growing motion; under dither up to multiples of R", Computation::DiscGrowth, &[
        variable(("frequency", "Im ρ"), "frequency of the fastest growing motion", VariableKind::DiscRate, &[], |r| Ok(grown(r)?.frequency)),
    ]),
    disc("verdict", "verdict on the disc: stable or unstable, undecided within its error", Computation::DiscGrowth, &[
        variable(("verdict", ""), "verdict on the disc", VERDICTS, OF_DISC, |r| decided(grown(r)?)),
    ]),
    disc("growth-undithered", "the growth rate without dither", Computation::DiscGrowthUndithered, &[
        variable(("growth_undithered", "Re ρ_0"), "largest growth rate without dither", VariableKind::DiscRate, &[], |r| Ok(grown_undithered(r)?.rate)),
        variable(("growth_undithered_error", ""), "bound on the error of the growth rate without dither", VariableKind::DiscRate, &[], |r| Ok(grown_undithered(r)?.error)),
    ]),
];

/// Statuses of a disc's verdict other than known.
const OF_DISC: &[Status] = &[Status::WithinError];

const fn disc(
    name: &'static str,
    about: &'static str,
    computation: Computation,
    variables: &'static [Variable],
) -> MapQuantity {
    MapQuantity { name, about, kind: DiscSetup::NAME, computation, variables }
}

fn grown(results: &Results) -> Result<Growth, Status> {
    results.disc.unwrap_or(Err(Status::Missing))
}

fn grown_undithered(results: &Results) -> Result<Growth, Status> {
    results.disc_undithered.unwrap_or(Err(Status::Missing))
}

/// A disc of unit friction, and what was prepared for it.
struct Prepared {
    disc: Disc,
    equations: DiscEquations,
}

enum DiscEquations {
    Dithered(Box<FollowerDither>),
    Constant(Box<Linearised>),
}

/// Computes every point; `None` without a valid disc.
fn evaluate(
    points: &[Option<Disc>],
    parts: Contributions,
    wanted: &[Computation],
) -> Vec<Option<Results>> {
    let mut dithered: Option<Prepared> = None;
    let mut constant: Option<Prepared> = None;
    let mut one = |disc: &Disc| {
        let mut results = Results::default();
        for computation in wanted {
            match computation {
                Computation::DiscGrowth => {
                    results.disc = Some(growth(disc, parts, &mut dithered));
                }
                Computation::DiscGrowthUndithered => {
                    let still = disc.undithered();
                    results.disc_undithered = Some(growth(&still, parts, &mut constant));
                }
                _ => {}
            }
        }
        results
    };
    points.iter().map(|disc| disc.as_ref().map(&mut one)).collect()
}

/// Largest growth rate of one disc.
pub(crate) fn growth_alone(disc: &Disc, parts: Contributions) -> Result<Growth, Status> {
    growth(disc, parts, &mut None)
}

/// Largest growth rate of a disc. Uses `prepared` if it fits this disc except for the friction of its load.
fn growth(
    disc: &Disc,
    parts: Contributions,
    prepared: &mut Option<Prepared>,
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
            &prepared.insert(Prepared { disc: unit, equations }).equations
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
