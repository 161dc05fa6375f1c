//! Means over a period of the steady response, and what the dither costs.

use quell_dynamics::motion::FedCost;
use quell_model::system::InputTarget;
use quell_model::units::Quantity;

use super::response::{self, measured};
use crate::cite::Task;
use crate::needs::Needs;
use crate::run::system::of_runs::beyond_laws;
use crate::status::Status;
use crate::sweep::map_quantity::{FORCE, LENGTH, MapQuantity, VariableKind, variable};
use crate::sweep::points::{ChunkPoints, Point, PointComputation, Subject};

/// The quantities.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<Means>("mean-friction", "mean friction force of the steady response, of all contacts", Needs::MOTIONS, &[
        variable(("mean_friction", "⟨f⟩"), "mean friction force", FORCE, OF_MEANS, |points| points.values(|found: &Means| Ok(found.friction))),
    ]),
    MapQuantity::of::<Means>("dither-power", "mean power supplied by tangential dither", Needs::MOTIONS, &[
        variable(("dither_power", "P"), "mean power of the dither", VariableKind::Number(Quantity::Power), OF_MEANS, |points| points.values(|found: &Means| Ok(found.dither?.0))),
    ]),
    MapQuantity::of::<Means>("dither-stroke", "largest peak-to-peak displacement of a point on which tangential dither acts", Needs::MOTIONS, &[
        variable(("dither_stroke", ""), "stroke of tangential dither", LENGTH, OF_MEANS, |points| points.values(|found: &Means| Ok(found.dither?.1))),
    ]),
    MapQuantity::of::<Means>("minimum-normal-load", "smallest normal load of a contact in the steady response", Needs::MOTIONS, &[
        variable(("minimum_normal_load", "N_{min}"), "smallest normal load", FORCE, OF_MEANS, |points| points.values(|found: &Means| Ok(found.least_load))),
    ]),
];

/// Statuses of means other than known.
const OF_MEANS: &[Status] = &[
    Status::BeyondRange,
    Status::Stalled,
    Status::NoSquealingStart,
    Status::NoDither,
    Status::OnlyNormalDither,
    Status::RecordLength,
];

/// Means of a steady response.
struct Means {
    /// Friction force, summed over the contacts.
    friction: f64,
    /// Power of tangential dither, and the largest stroke.
    dither: Result<(f64, f64), Status>,
    /// Smallest normal load.
    least_load: f64,
    beyond_range: bool,
}

impl Means {
    fn of(point: &Point<'_>) -> Result<Self, Status> {
        let (study, found) = (point.study()?, measured(point)?);
        let record = &found.dithered;
        let inputs = record.inputs.iter().zip(&study.system().inputs);
        let tangential = inputs.filter(|(_, input)| matches!(input.target, InputTarget::Force(_)));
        let costs: Vec<&FedCost> =
            tangential.filter_map(|(cost, _)| cost.fed.as_ref().ok()).collect();
        let strokes = costs.iter().map(|cost| cost.stroke);
        let stroke = strokes.max_by(f64::total_cmp);
        let power = costs.iter().map(|cost| cost.power).sum();
        let without = if found.has_dither() { Status::OnlyNormalDither } else { Status::NoDither };
        let loads = record.contacts.iter().map(|contact| contact.least_load);
        Ok(Self {
            friction: record.contacts.iter().map(|contact| contact.friction).sum(),
            dither: stroke.map(|stroke| (power, stroke)).ok_or(without),
            least_load: loads.fold(f64::INFINITY, f64::min),
            beyond_range: !beyond_laws(study, |contact| found.largest_slip(contact)).is_empty(),
        })
    }
}

impl PointComputation for Means {
    const TASK: Task = Task::Response;

    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        points.each(Self::of)
    }

    fn seconds(subject: &Subject) -> f64 {
        response::seconds_alone(subject)
    }

    fn qualification(&self, _: f64) -> Status {
        Status::of_range(self.beyond_range)
    }
}
