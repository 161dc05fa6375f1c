//! A mode of the disc and a load that rotates over it.

use crate::Invalid;
use crate::parameter::disc::{
    LOAD_ANGLE, LOAD_DAMPING, LOAD_DITHER_PHASE, LOAD_FRICTION, LOAD_MASS, LOAD_STIFFNESS,
    MODE_DAMPING, MODE_DIAMETERS, MODE_RATIO, MODE_SHAPE_AT_LOAD,
};
use crate::parameter::{Parameter, indexed};

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

/// Mass, damper, spring and friction at one point of the rotating frame.
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
    /// Radius over the outer radius, where it is known.
    pub radius_ratio: Option<f64>,
    /// Shapes of all modes at this load, where it sits at another radius than the modes'
    /// [`Mode::shape_at_load`] means.
    pub shapes: Option<Vec<f64>>,
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
            radius_ratio: None,
            shapes: None,
        }
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

/// A complaint about entry `index` of `count`, its key with the index where there are several.
fn complain(parameter: &Parameter, value: f64, index: usize, count: usize) -> Option<Invalid> {
    parameter.check(value).err().map(|mut complaint| {
        let (table, key) = parameter.path.rsplit_once('.').unwrap_or(("", parameter.path));
        complaint.key = indexed(table, index, count, key);
        complaint
    })
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
        ]
        .iter()
        .filter_map(|(parameter, value)| complain(parameter, *value, index, count))
        .collect();
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
