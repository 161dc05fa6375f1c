//! A disc whose speed varies in time.

use super::Disc;
use crate::parameter::disc::DISC_SPEED;
use crate::profile::{Knots, Profile};
use crate::{Invalid, InvalidValues};
use quell_numerics::interval::RealInterval;

/// Path of the table.
pub(super) const DISC_DRIVE: &str = "disc.drive";

impl Disc {
    /// The same disc at a speed Ω(t), in ω_ref, in place of its constant one.
    ///
    /// The loads may stand still and turn round where they have no friction. A given friction force has a direction that does not follow
    /// the speed: it may reach zero speed, but not reverse. Under a friction law every load must slide at all times.
    ///
    /// # Errors
    /// A speed that jumps, whose Ω′ would be an impulse; one out of the bounds of a constant speed; a reversal under friction.
    pub fn driven(self, drive: Profile) -> Result<Self, InvalidValues> {
        let mut complaints = Vec::new();
        if let Some(place) = drive.knots().and_then(Knots::first_jump) {
            let time = drive.knots().map_or(0.0, |knots| knots.times()[place]);
            let allowed = "later than the time before it: the speed of a disc cannot jump";
            complaints.push(Invalid::new(format!("{DISC_DRIVE}.time[{place}]"), time, allowed));
        }
        let RealInterval { lower: least, upper: most } = drive.bounds();
        let range = || format!("{least} to {most}");
        if [least, most].iter().any(|speed| DISC_SPEED.check(*speed).is_err()) {
            let allowed = format!("speeds {}", DISC_SPEED.bounds);
            complaints.push(Invalid::new(DISC_DRIVE, range(), allowed));
        }
        let follows = self.law.is_none() && self.loads.iter().any(|load| load.friction != 0.0);
        if follows && least < 0.0 && most > 0.0 {
            let allowed = "speeds of one sign: the direction of a given friction force does not follow the speed, so that the run before \
                           and the one after a reversal are two studies with friction of opposite signs";
            complaints.push(Invalid::new(DISC_DRIVE, range(), allowed));
        }
        if !complaints.is_empty() {
            return Err(InvalidValues::of(complaints));
        }
        let speed = if drive.knots().is_some() { drive.value(0.0) } else { drive.mean() };
        let driven = Self { drive: Some(drive), speed, ..self };
        match driven.law.clone() {
            Some(law) => driven.under_law(law),
            None => Ok(driven),
        }
    }

    /// The speed over time; `None` at a constant speed.
    pub fn drive(&self) -> Option<&Profile> {
        self.drive.as_ref()
    }

    /// Speed Ω at a time.
    pub fn speed_at(&self, time: f64) -> f64 {
        self.drive.as_ref().map_or(self.speed, |drive| drive.value(time))
    }
}
