//! A friction law under the loads of a disc.
//!
//! A load slides at the speed Ω and the law gives its friction, f* = sgn(Ω) μ(|Ω|) N*. Lengths are measured in the radius r₀ of
//! the first load, so that slip velocities are in r₀ω_ref and forces in r₀M_pω_ref²; a point at the radius r = ϱr₀ slides at ϱΩ,
//! its normal load is ϱN* where N* is in its own radius, and its slope row is s/ϱ.
//!
//! The surface of a bent plate of thickness h moves in its plane by u_θ = −(h/2r) ∂w/∂φ (Kirchhoff), so that the tangent row is
//! t = −η s with η = h/(2r): friction acts on the slope of the disc, and a rate of slope changes the slip and with it μ. For h = 0
//! there is no tangent row, and a law of constant μ is the follower force of the dissertation in every bit.

use super::drive::DISC_DRIVE;
use super::{Disc, Load};
use crate::parameter::disc::{DISC_SPEED, LOAD_FRICTION, LOAD_NORMAL};
use crate::parameter::indexed;
use crate::{Friction, Invalid, InvalidValues};

impl Disc {
    /// The same disc with a friction law in place of the given follower forces: every load has a normal load instead.
    ///
    /// # Errors
    /// A load without normal load or with a friction of its own; a speed of 0, at which sliding has no direction.
    pub fn under_law(self, law: Friction) -> Result<Self, InvalidValues> {
        let complaints = self.complaints_under_law();
        if complaints.is_empty() {
            Ok(Self { law: Some(law), ..self })
        } else {
            Err(InvalidValues::of(complaints))
        }
    }

    /// The friction law, if friction is not given as a follower force.
    pub fn law(&self) -> Option<&Friction> {
        self.law.as_ref()
    }

    /// Whether every load is the dissertation's: at a point, from the ground, with a given follower force.
    pub fn is_plain(&self) -> bool {
        self.law.is_none() && self.loads.iter().all(Load::is_plain)
    }

    fn complaints_under_law(&self) -> Vec<Invalid> {
        let count = self.loads.len();
        let mut complaints = Vec::new();
        for (index, load) in self.loads.iter().enumerate() {
            if load.normal_load.is_none() {
                let key = indexed("disc.load", index, count, LOAD_NORMAL.key());
                let allowed = "a normal load > 0, which a friction law requires";
                complaints.push(Invalid::new(key, "none", allowed));
            }
            if load.friction != 0.0 {
                let key = indexed("disc.load", index, count, LOAD_FRICTION.key());
                let allowed = "no friction force: the friction law gives it";
                complaints.push(Invalid::new(key, load.friction, allowed));
            }
        }
        if let Some(drive) = self.drive().filter(|_| count > 0) {
            let bounds = drive.bounds();
            if bounds.contains(0.0) {
                let allowed = "a speed of one sign at all times: a friction law requires sliding, and a load that stands still or turns \
                               round has no direction of sliding";
                complaints.push(Invalid::new(
                    DISC_DRIVE,
                    format!("{} to {}", bounds.lower, bounds.upper),
                    allowed,
                ));
            }
        } else if self.speed == 0.0 && count > 0 {
            let allowed = "a speed other than 0: a friction law requires sliding";
            complaints.push(Invalid::new(DISC_SPEED.path, self.speed, allowed));
        }
        complaints
    }

    /// Radius of a load over that of the first load; 1 where a radius is unknown.
    pub fn radius_over_first(&self, load: &Load) -> f64 {
        let first = self.loads.first().and_then(|first| first.radius_ratio);
        load.radius_ratio.zip(first).map_or(1.0, |(own, first)| own / first)
    }
}
