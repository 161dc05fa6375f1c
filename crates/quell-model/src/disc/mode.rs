//! A mode of the disc and a load that rotates over it.

use std::cmp::Ordering;

use super::complaint::complain;
use super::{Carrier, Patch};
use crate::Invalid;
use crate::parameter::disc::{
    CALIPER_DAMPING, CALIPER_MASS, CALIPER_STIFFNESS, LOAD_ANGLE, LOAD_DAMPING, LOAD_DITHER_PHASE,
    LOAD_FRICTION, LOAD_HALF_THICKNESS, LOAD_MASS, LOAD_NORMAL, LOAD_SLIP_RATIO, LOAD_STATIC,
    LOAD_STIFFNESS, MODE_DAMPING, MODE_DIAMETERS, MODE_RATIO, MODE_SHAPE_AT_LOAD, PAD_DAMPING,
    PAD_MASS, PAD_STIFFNESS,
};
use crate::parameter::indexed;
use crate::profile::Profile;

/// A mode R(r)·(A cos qφ + B sin qφ) of the plate at rest, φ counted from the first load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Nodal diameters q. A mode without any has one coordinate (A), every other two (A and B).
    pub diameters: usize,
    /// Frequency ratio β = ω/ω_ref > 0.
    pub ratio: f64,
    /// Shape φ(r₀) at the load's radius, unit mean square of φ cos qθ over the plate.
    pub shape_at_load: f64,
    /// Damping ratio ξ ≥ 0. The damper rests in the disc.
    pub damping: f64,
}

/// Mass, damper, spring and friction at one point of the rotating frame, or over a patch around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Angle θ in the frame of the loads, radians.
    pub angle: f64,
    /// Mass m* = m/M_p ≥ 0.
    pub mass: f64,
    /// Damper c* = c/(M_p ω_ref) ≥ 0.
    pub damping: f64,
    /// Spring k* = k/(M_p ω_ref²) ≥ 0.
    pub stiffness: f64,
    /// Follower force of friction f* = F_θ/(r₀ M_p ω_ref²); positive drags the disc in the direction of +θ.
    pub friction: f64,
    /// Phase φ of the dither of its friction, cos(Rτ + φ), radians.
    pub dither_phase: f64,
    /// Static load P* = P/(r₀M_pω_ref²) on the disc: the equations of small motions do not contain it, it deflects the disc.
    pub static_load: f64,
    /// Normal load N* = N/(r₀M_pω_ref²) > 0 under a friction law ([`Disc::under_law`](super::Disc::under_law)), which stands for
    /// [`Load::friction`].
    pub normal_load: Option<f64>,
    /// Half the thickness of the disc over the radius of the load, η = h/(2r₀) ≥ 0: under a friction law the surface of a bent disc
    /// moves in its plane by u_θ = −(h/2r) ∂w/∂φ.
    pub half_thickness: f64,
    /// Slip ratio Λ > 0 of tangential dither, the peak of its velocity over the speed of sliding, where it is given. The equations
    /// do not contain it: it determines the force that the dither needs.
    pub slip_ratio: Option<f64>,
    /// Radius over the outer radius, where it is known.
    pub radius_ratio: Option<f64>,
    /// Shapes of all modes at this load, where it sits at another radius than the modes'
    /// [`Mode::shape_at_load`] means.
    pub shapes: Option<Vec<f64>>,
    /// The area over which it is distributed; `None` for a point.
    pub patch: Option<Patch>,
    /// Share s > 0 of the normal load over time, and with it of friction: `friction` and `normal_load` are those of s = 1. `None`
    /// for a load that does not vary.
    pub share: Option<Profile>,
    /// The pad, between the spring and damper of the contact and the caliper or the ground; `None` where they are at rest.
    pub pad: Option<Carrier>,
    /// The caliper that carries the pad; `None` for a pad on the ground. Ignored without a pad.
    pub caliper: Option<Carrier>,
}

impl Load {
    /// A load at angle zero from m*, c*, k*, f*.
    pub fn new(mass: f64, damping: f64, stiffness: f64, friction: f64) -> Self {
        Self {
            angle: 0.0,
            mass,
            damping,
            stiffness,
            friction,
            dither_phase: 0.0,
            static_load: 0.0,
            normal_load: None,
            half_thickness: 0.0,
            slip_ratio: None,
            radius_ratio: None,
            shapes: None,
            patch: None,
            share: None,
            pad: None,
            caliper: None,
        }
    }

    /// The same load with a share of it over time.
    #[must_use]
    pub fn varying(self, share: Profile) -> Self {
        Self { share: Some(share), ..self }
    }

    /// The same load on a pad that moves.
    #[must_use]
    pub fn on_pad(self, pad: Carrier) -> Self {
        Self { pad: Some(pad), ..self }
    }

    /// The same load on a caliper that moves and carries its pad.
    #[must_use]
    pub fn on_caliper(self, caliper: Carrier) -> Self {
        Self { caliper: Some(caliper), ..self }
    }

    /// The same load, distributed over a patch.
    #[must_use]
    pub fn over(self, patch: Patch) -> Self {
        Self { patch: Some(patch), ..self }
    }

    /// Number of coordinates of its own: one for the pad, one more for the caliper.
    pub fn bodies(&self) -> usize {
        match (&self.pad, &self.caliper) {
            (None, _) => 0,
            (Some(_), None) => 1,
            (Some(_), Some(_)) => 2,
        }
    }

    /// Whether it acts at one point, from the ground: the load of the dissertation, for which closed forms exist.
    pub fn is_plain(&self) -> bool {
        self.patch.is_none() && self.pad.is_none()
    }

    /// The same load at another angle (radians).
    #[must_use]
    pub fn at_angle(self, angle: f64) -> Self {
        Self { angle, ..self }
    }

    /// The same load with another phase of its dither (radians).
    #[must_use]
    pub fn dithered_at(self, dither_phase: f64) -> Self {
        Self { dither_phase, ..self }
    }
}

impl Mode {
    pub(crate) fn complaints(&self, index: usize, count: usize) -> Vec<Invalid> {
        [
            (MODE_DIAMETERS, self.diameters as f64),
            (MODE_RATIO, self.ratio),
            (MODE_SHAPE_AT_LOAD, self.shape_at_load),
            (MODE_DAMPING, self.damping),
        ]
        .iter()
        .filter_map(|(parameter, value)| complain(parameter, *value, index, count))
        .collect()
    }
}

impl Load {
    pub(crate) fn complaints(&self, modes: usize, index: usize, count: usize) -> Vec<Invalid> {
        let mut complaints: Vec<Invalid> = [
            (LOAD_ANGLE, self.angle),
            (LOAD_MASS, self.mass),
            (LOAD_DAMPING, self.damping),
            (LOAD_STIFFNESS, self.stiffness),
            (LOAD_FRICTION, self.friction),
            (LOAD_DITHER_PHASE, self.dither_phase.to_degrees()),
            (LOAD_STATIC, self.static_load),
        ]
        .iter()
        .filter_map(|(parameter, value)| complain(parameter, *value, index, count))
        .collect();
        let of_pad = [PAD_MASS, PAD_DAMPING, PAD_STIFFNESS];
        let of_caliper = [CALIPER_MASS, CALIPER_DAMPING, CALIPER_STIFFNESS];
        for (body, names) in [(&self.pad, of_pad), (&self.caliper, of_caliper)] {
            let Some(Carrier { mass, damping, stiffness }) = *body else { continue };
            let numbers = names.iter().zip([mass, damping, stiffness]);
            complaints
                .extend(numbers.filter_map(|(name, value)| complain(name, value, index, count)));
        }
        if self.caliper.is_some() && self.pad.is_none() {
            let key = indexed("disc.load", index, count, PAD_MASS.key());
            complaints.push(Invalid::new(key, "none", "a pad: the caliper carries it"));
        }
        let own =
            [(LOAD_NORMAL, self.normal_load), (LOAD_HALF_THICKNESS, Some(self.half_thickness))];
        complaints
            .extend(own.iter().filter_map(|(name, value)| complain(name, (*value)?, index, count)));
        let slip_ratio = self.slip_ratio;
        complaints
            .extend(slip_ratio.and_then(|value| complain(&LOAD_SLIP_RATIO, value, index, count)));
        if let Some(least) = self.share.as_ref().map(|share| share.bounds().lower)
            && least.partial_cmp(&0.0) != Some(Ordering::Greater)
        {
            let key = indexed("disc.load", index, count, "envelope");
            let allowed =
                "a share above 0 at all times: a load that vanishes would open its contact";
            complaints.push(Invalid::new(key, least, allowed));
        }
        if let Some(patch) = &self.patch {
            complaints.extend(patch.complaints(modes, index, count));
        }
        if let Some(shapes) = &self.shapes {
            let key = format!("disc.load[{index}].shapes");
            if shapes.len() != modes {
                let allowed = format!("one shape for each of the {modes} modes");
                complaints.push(Invalid::new(key, shapes.len(), allowed));
            } else if let Some(shape) = shapes.iter().find(|shape| !shape.is_finite()) {
                complaints.push(Invalid::new(key, shape, "finite numbers"));
            }
        }
        complaints
    }
}
