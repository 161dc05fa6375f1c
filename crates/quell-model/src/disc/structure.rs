//! The disc as a structure with contacts: its modes in the frame of the loads.
//!
//! In the frame of the loads, w = Σ φ(r)(A cos qφ + B sin qφ):
//!
//! ```text
//! A″ − 2qΩB′ + (β² − q²Ω²)A + 2ξβ(A′ − qΩB) = −Σ_l φ cos qθ_l [m w″ + c w′ + k w − f(τ) w_φ] at load l
//! B″ + 2qΩA′ + (β² − q²Ω²)B + 2ξβ(B′ + qΩA) = −Σ_l φ sin qθ_l [the same]                    (5.18), (5.25), (5.32)
//! ```
//!
//! Load l is a contact with the normal row u_l (φ cos qθ_l for A, φ sin qθ_l for B), w = u_lᵀy, and the slope row
//! s_l (−qφ sin qθ_l, qφ cos qθ_l), w_φ = s_lᵀy: its spring and damper are those of the contact, its mass is attached to the
//! structure, and its friction force f acts along the slope.
//!
//! Corrections to the print. Inside the double sum of (5.18), (5.25) and (5.32) the accelerations and velocities carry the
//! indices of the equation (A_pq″, A_pq′); they must be those of the sum (A_ij″, A_ij′), as (5.15) has them. Taken
//! literally it is another system whose verdict differs (Ω = 0.2, m = c = k = 0.3, f = 0.1: −2.1·10⁻² instead of +9.3·10⁻⁵).
//! The dissertation drops the plate's damping from (5.14) on and uses ξ in figures 5.8–5.15 without a definition;
//! here it is a damper at rest in the disc, which brings the circulatory pair 2ξβqΩ.

use std::f64::consts::FRAC_PI_2;

use quell_numerics::matrix::Matrix;

use super::{Contribution, Contributions, Disc};
use crate::friction::{Coulomb, Friction};
use crate::parameter::Parameter;
use crate::profile::{Profile, Wave};
use crate::system::{Contact, Input, InputTarget, MassMatrix, Mechanical, System};
use crate::{InvalidValues, Parametrisation, Waveform};

impl Parametrisation for Disc {
    fn parameter(&self, path: &str) -> Option<Parameter> {
        Self::parameter(self, path)
    }

    fn get(&self, path: &str) -> Option<f64> {
        Self::get(self, path)
    }

    fn with(&self, path: &str, value: f64) -> Result<Self, InvalidValues> {
        Self::with(self, path, value)
    }

    fn si_per_unit(&self, path: &str) -> Option<f64> {
        let parameter = Self::parameter(self, path)?;
        self.scales(Self::load_of(path).unwrap_or(0))?.si_per_unit(parameter.quantity)
    }

    fn system(&self) -> System {
        self.system_of(Contributions::ALL)
    }
}

impl Disc {
    /// The system of some contributions, the others switched off.
    ///
    /// The follower force of the dissertation depends neither on the speed nor on the load: it is a Coulomb contact of unit
    /// load with μ = |f| on a surface that moves, at unit speed, in the direction of f. Its dither is a factor on the
    /// friction force.
    pub fn system_of(&self, parts: Contributions) -> System {
        let (damping, stiffness) = self.plate(parts);
        let mut mass = MassMatrix::identity(self.coordinates());
        let mut contacts = Vec::new();
        let mut inputs = Vec::new();
        for (l, load) in self.loads().iter().enumerate() {
            let on = |part, value: f64| if parts.contains(part) { value } else { 0.0 };
            let (normal, slope) = self.rows_at(l);
            mass = mass.attach(on(Contribution::LoadMass, load.mass), normal.clone());
            contacts.push(Contact {
                name: format!("load {l}"),
                tangent: None,
                force: None,
                normal: Some(normal),
                slope: Some(slope),
                normal_load: 1.0,
                normal_stiffness: on(Contribution::Spring, load.stiffness),
                normal_damping: on(Contribution::Damper, load.damping),
                surface_velocity: Profile::constant(1f64.copysign(load.friction)),
                friction: Friction::Coulomb(Coulomb::constant(load.friction.abs())),
            });
            let (mean, amplitude) = self.dither().mean_and_amplitude();
            let mut factor = Profile::constant(on(Contribution::FollowerForce, mean));
            if let Some(frequency) = self.dither().frequency_ratio() {
                // cos(Rτ + φ) is a sine that leads by a quarter of a cycle.
                factor = factor.with(Wave {
                    waveform: Waveform::Sine,
                    amplitude: on(Contribution::Dither, amplitude),
                    frequency,
                    phase: load.dither_phase + FRAC_PI_2,
                });
            }
            inputs.push(Input { target: InputTarget::Friction { contact: l }, profile: factor });
        }
        let structure = Mechanical::new(self.coordinate_names(), mass, damping, stiffness);
        System { structure: structure.into(), contacts, inputs }
    }

    /// Names of the coordinates: A and B of each mode, counted from 0.
    fn coordinate_names(&self) -> Vec<String> {
        let modes = self.modes().iter().enumerate();
        modes
            .flat_map(|(index, mode)| {
                let second = (mode.diameters > 0).then(|| format!("B{index}"));
                [Some(format!("A{index}")), second].into_iter().flatten()
            })
            .collect()
    }

    /// Normal and slope row of a load.
    fn rows_at(&self, l: usize) -> (Vec<f64>, Vec<f64>) {
        let (mut normal, mut slope) = (Vec::new(), Vec::new());
        let angle = self.loads()[l].angle;
        for (index, mode) in self.modes().iter().enumerate() {
            let q = mode.diameters as f64;
            let (sine, cosine) = libm::sincos(q * angle);
            let shape = self.shape(index, l);
            normal.push(shape * cosine);
            if mode.diameters > 0 {
                normal.push(shape * sine);
                slope.push(-q * shape * sine);
                slope.push(q * shape * cosine);
            } else {
                slope.push(0.0);
            }
        }
        (normal, slope)
    }

    /// C and K of the plate alone.
    fn plate(&self, parts: Contributions) -> (Matrix, Matrix) {
        let n = self.coordinates();
        let (mut damping, mut stiffness) = (Matrix::zeros(n, n), Matrix::zeros(n, n));
        let on = |part, value: f64| if parts.contains(part) { value } else { 0.0 };
        let mut at = 0;
        for mode in self.modes() {
            let rotation = mode.diameters as f64 * self.speed();
            let loss = 2.0 * mode.damping * mode.ratio;
            let diagonal = on(Contribution::Plate, mode.ratio * mode.ratio)
                - on(Contribution::Gyroscopic, rotation * rotation);
            let coordinates = if mode.diameters == 0 { 1 } else { 2 };
            for i in at..at + coordinates {
                stiffness[(i, i)] += diagonal;
                damping[(i, i)] += on(Contribution::DiscDamping, loss);
            }
            if coordinates == 2 {
                let gyroscopic = on(Contribution::Gyroscopic, 2.0 * rotation);
                damping[(at, at + 1)] -= gyroscopic;
                damping[(at + 1, at)] += gyroscopic;
                let circulatory = on(Contribution::CirculatoryDamping, loss * rotation);
                stiffness[(at, at + 1)] -= circulatory;
                stiffness[(at + 1, at)] += circulatory;
            }
            at += coordinates;
        }
        (damping, stiffness)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{DiscDither, Load, Mode};
    use super::*;

    #[test]
    fn contributions_can_be_switched_one_by_one() {
        let mut set = Contributions::ALL;
        for &part in Contribution::ALL {
            assert!(set.contains(part));
            set = set.without(part);
            assert!(!set.contains(part));
            assert_eq!(Contribution::from_name(part.name()), Some(part));
        }
        assert_eq!(
            Contribution::ALL.iter().fold(set, |set, &part| set.with(part)),
            Contributions::ALL
        );
    }

    #[test]
    fn the_factor_of_the_friction_force_is_the_dither() {
        let mode = Mode { diameters: 2, ratio: 2.0, shape_at_load: 0.93, damping: 0.0 };
        let load = Load::new(0.1, 0.2, 0.3, -0.4).dithered_at(0.7);
        let dither = DiscDither::Normal { amplitude: 0.5, frequency_ratio: 2.7 };
        let system = Disc::new(vec![mode], vec![load], dither, 0.3).expect("valid").system();
        let factor = &system.inputs[0].profile;
        for time in [0.0f64, 0.4, 1.9] {
            let wanted = 0.5f64.mul_add((2.7 * time + 0.7).cos(), 1.0);
            assert!((factor.value(time) - wanted).abs() < 1e-14);
        }
        let contact = &system.contacts[0];
        let speed = contact.surface_velocity.mean();
        assert_eq!(speed.signum() * contact.friction.coefficient(speed.abs()), -0.4);
    }
}
