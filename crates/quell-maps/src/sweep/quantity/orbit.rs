//! The base response under dither and its multipliers.

use quell_dynamics::orbit::{BASE_STEPS, NoImage, NoOrbit, Orbit, OrbitVerdict, base_response};

use crate::needs::Needs;
use crate::status::Status;
use crate::sweep::map_quantity::{MapQuantity, RATIO, VERDICTS, variable};
use crate::sweep::points::{ChunkPoints, PointComputation, Subject};

/// The quantities.
#[rustfmt::skip]
pub(super) const QUANTITIES: &[MapQuantity] = &[
    MapQuantity::of::<BaseOrbit>("orbit-verdict", "verdict on the base response by its multipliers", Needs::MOTIONS, &[
        variable(("orbit_verdict", ""), "verdict on the base response by its multipliers", VERDICTS, OF_ORBIT, |points| points.values(BaseOrbit::verdict)),
    ]),
    MapQuantity::of::<BaseOrbit>("orbit-radius", "modulus of the deciding multiplier of the base response: stable below 1", Needs::MOTIONS, &[
        variable(("orbit_radius", "|λ|"), "modulus of the deciding multiplier", RATIO, OF_ORBIT, |points| points.values(|found: &BaseOrbit| Ok(found.0.radius()))),
    ]),
];

/// Statuses of base responses other than known.
const OF_ORBIT: &[Status] = &[
    Status::Stalled,
    Status::WithinError,
    Status::NoDither,
    Status::NoSteadySliding,
    Status::NoBaseResponse,
];

/// Seconds in which the base response of four states is followed.
const ORBIT: f64 = 3e-2;

/// The base response.
struct BaseOrbit(Orbit);

impl BaseOrbit {
    fn verdict(&self) -> Result<f64, Status> {
        match self.0.verdict() {
            OrbitVerdict::Unstable => Ok(0.0),
            OrbitVerdict::Stable => Ok(1.0),
            OrbitVerdict::Undecided => Err(Status::WithinError),
        }
    }
}

impl PointComputation for BaseOrbit {
    fn at(points: &ChunkPoints<'_>) -> Vec<Result<Self, Status>> {
        points.each(|point| {
            let system = point.system()?;
            if !system.is_dithered() {
                return Err(Status::NoDither);
            }
            let orbit = base_response(system, BASE_STEPS).map_err(|why| match why {
                NoOrbit::NoDither => Status::NoDither,
                NoOrbit::NoSliding(_) => Status::NoSteadySliding,
                NoOrbit::NoImage(NoImage::Stopped(_)) => Status::Stalled,
                _ => Status::NoBaseResponse,
            });
            orbit.map(Self)
        })
    }

    fn seconds(subject: &Subject) -> f64 {
        ORBIT * subject.work_over(4.0)
    }
}
