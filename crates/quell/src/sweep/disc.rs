//! What a map computes of a disc: growth rates, with the work that neighbours share.
//!
//! Points that differ in the friction of the one load alone share the constant flow or the assembled system. Every point is
//! computed through the same arithmetic whether it has such neighbours or not, so that its bits do not depend on them.

use quell_disc::dithered::DitheredDisc;
use quell_disc::equations::System;
use quell_disc::undithered;
use quell_linear::growth::Growth;
use quell_model::Disc;
use quell_model::disc::{Contribution, Contributions};
use quell_numerics::floquet::Effort;

use super::evaluate::{Computation, Results};
use super::status::Status;

/// A disc of unit friction, and what it was prepared for.
struct Prepared {
    disc: Disc,
    kind: Kind,
}

enum Kind {
    Dithered(Box<DitheredDisc>),
    Constant(Box<System>),
}

/// Computes at every point; `None` where there is no valid disc.
pub(super) fn evaluate(
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

/// Largest growth rate of a disc. What `prepared` holds is used where it is for this disc but for the friction of its load.
fn growth(
    disc: &Disc,
    parts: Contributions,
    prepared: &mut Option<Prepared>,
) -> Result<Growth, Status> {
    let (unit, factor) = match disc.loads() {
        [load] => {
            let unit = disc.with("disc.load.friction", 1.0).map_err(|_| Status::NotFinite)?;
            (unit, load.friction)
        }
        _ => (disc.clone(), 1.0),
    };
    let kind = match prepared {
        Some(prepared) if prepared.disc == unit => &prepared.kind,
        _ => {
            let kind = DitheredDisc::with_contributions(&unit, parts).map_err(told)?.map_or_else(
                || Kind::Constant(Box::new(System::assemble(&unit, parts))),
                |it| Kind::Dithered(Box::new(it)),
            );
            &prepared.insert(Prepared { disc: unit, kind }).kind
        }
    };
    match kind {
        Kind::Dithered(dithered) => dithered.growth(factor, Effort::default()).map_err(told),
        Kind::Constant(system) => {
            let on = parts.contains(Contribution::FollowerForce);
            let mean = system.friction().iter();
            let friction: Vec<f64> = mean.map(|f| if on { factor * f } else { 0.0 }).collect();
            undithered::growth_of(system, &friction).map_err(told)
        }
    }
}

fn told(_: quell_numerics::eigen::EigenError) -> Status {
    Status::NotFinite
}
