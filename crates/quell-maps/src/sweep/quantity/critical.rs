//! Amplitudes of the first dither at which averaged stability changes.

use quell_linear::averaging::{Becomes, CriticalInput, DitheredSystem};
use quell_model::{Contact, System};

use super::growth;
use crate::contact_state::averaged_without_states;
use crate::needs::Needs;
use crate::status::Status;
use crate::sweep::map_quantity::{FORCE, MapQuantity, OF_AVERAGES, variable};
use crate::sweep::points::{ChunkPoints, PointComputation, Subject};

/// The quantities.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<Criticals>("critical-amplitude", "smallest amplitude of the first dither that makes sliding stable, by averaging", Needs::CONTACTS, &[
        variable(("critical_amplitude", "A*"), "smallest amplitude that makes sliding stable", FORCE, OF_AVERAGES, |points| points.values(|found: &Criticals| found.first(Becomes::Stable))),
    ]),
    MapQuantity::of::<Criticals>("destabilising-amplitude", "smallest amplitude of the first dither that makes sliding unstable, by averaging", Needs::CONTACTS, &[
        variable(("destabilising_amplitude", "A°"), "smallest amplitude that makes sliding unstable", FORCE, OF_AVERAGES, |points| points.values(|found: &Criticals| found.first(Becomes::Unstable))),
    ]),
];

/// How often a search computes a growth rate.
pub(super) const SEARCH: f64 = 300.0;

/// Every critical amplitude of the first dither, in order, and what qualifies it.
struct Criticals(Vec<(CriticalInput, Status)>);

impl Criticals {
    fn of(system: &System) -> Result<Self, Status> {
        if system.inputs.is_empty() {
            return Err(Status::NoDither);
        }
        let prepared = DitheredSystem::new(system).map_err(Status::from)?;
        let found = prepared.critical_amplitudes(0).map_err(Status::from)?;
        let has_state = system.contacts.iter().any(Contact::has_state);
        let differs = |amplitude: f64| {
            let average = prepared.average_with(Some((0, amplitude)));
            average.is_ok_and(|at| !averaged_without_states(system, &at.contacts).is_empty())
        };
        let qualified = |critical: CriticalInput| {
            let without_state = has_state && differs(critical.amplitude);
            let status = if !critical.contacts_stay_closed {
                Status::Opens
            } else if !critical.within_laws {
                Status::BeyondRange
            } else if without_state {
                Status::WithoutState
            } else {
                Status::Known
            };
            (critical, status)
        };
        Ok(Self(found.into_iter().map(qualified).collect()))
    }

    fn first(&self, becomes: Becomes) -> Result<f64, Status> {
        let first = self.0.iter().find(|(critical, _)| critical.becomes == becomes);
        first.map(|(critical, _)| critical.amplitude).ok_or(Status::NeverChanges)
    }
}

impl PointComputation for Criticals {
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        points.each(|point| Self::of(point.system()?))
    }

    fn seconds(subject: &Subject) -> f64 {
        SEARCH * growth::seconds(subject)
    }

    fn qualification(&self, value: f64) -> Status {
        let mut found = self.0.iter().filter(|(critical, _)| critical.amplitude == value);
        found.next().map_or(Status::Known, |(_, status)| *status)
    }
}
