//! The plate in the frame of the loads: gyroscopic terms, damping and elasticity of its modes.
//!
//! At a fixed place of the plate the angle in the frame of the loads is φ = θ − ∫Ω dt, so that ∂/∂t of the plate is
//! ∂/∂t − Ω ∂/∂φ of the frame, and its second derivative
//!
//! ```text
//! w″ − 2Ω w′_φ + Ω² w_φφ − Ω′ w_φ,
//! ```
//!
//! where the last term (Euler's acceleration) vanishes at constant speed. With w = φ(r)(A cos qφ + B sin qφ) it is −qΩ′B in the
//! equation of A and +qΩ′A in that of B. The damper 2ξβ of the plate acts on w′ − Ω w_φ and has no part in Ω′. The shear stress that
//! an angular acceleration of the disc itself causes in its plane is left out: it does no work in a single mode, and couples modes of
//! different radial order.

use quell_numerics::matrix::Matrix;

use super::{Contribution, Contributions, Disc};
use crate::profile::Profile;
use crate::system::SpeedDependence;

/// The factors that the terms of the plate have: those without the speed, those in Ω, in Ω² and in Ω′.
///
/// At a speed they are 1, Ω, Ω and 0. With one factor 1 and the others 0 they give the matrix that this factor multiplies.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpeedFactors {
    rest: f64,
    linear: f64,
    /// Square root of the factor of the terms in Ω².
    root: f64,
    rate: f64,
}

impl SpeedFactors {
    const NONE: Self = Self { rest: 0.0, linear: 0.0, root: 0.0, rate: 0.0 };

    /// The terms without the speed.
    pub(super) const REST: Self = Self { rest: 1.0, ..Self::NONE };

    /// All terms at a constant speed.
    pub(super) fn at(speed: f64) -> Self {
        Self { linear: speed, root: speed, ..Self::REST }
    }
}

impl Disc {
    /// C and K of the plate alone.
    pub(super) fn plate(&self, parts: Contributions, factors: SpeedFactors) -> (Matrix, Matrix) {
        let SpeedFactors { rest, linear, root, rate } = factors;
        let n = self.coordinates();
        let (mut damping, mut stiffness) = (Matrix::zeros(n, n), Matrix::zeros(n, n));
        let on = |part, value: f64| if parts.contains(part) { value } else { 0.0 };
        let mut at = 0;
        for (index, mode) in self.modes().iter().enumerate() {
            let diameters = mode.diameters as f64;
            let (rotation, spin) = (diameters * linear, diameters * root);
            let loss = 2.0 * mode.damping * mode.ratio;
            let diagonal = on(Contribution::Plate, rest * (mode.ratio * mode.ratio))
                - on(Contribution::Gyroscopic, spin * spin);
            let centrifugal = self.centrifugal(index);
            let diagonal = if centrifugal == 0.0 {
                diagonal
            } else {
                let stress = centrifugal * root * root;
                diagonal + on(Contribution::Centrifugal, stress)
            };
            let coordinates = if mode.diameters == 0 { 1 } else { 2 };
            for i in at..at + coordinates {
                stiffness[(i, i)] += diagonal;
                damping[(i, i)] += on(Contribution::DiscDamping, rest * loss);
            }
            if coordinates == 2 {
                let gyroscopic = on(Contribution::Gyroscopic, 2.0 * rotation);
                damping[(at, at + 1)] -= gyroscopic;
                damping[(at + 1, at)] += gyroscopic;
                let circulatory = on(Contribution::CirculatoryDamping, loss * rotation);
                let euler = on(Contribution::Gyroscopic, diameters * rate);
                stiffness[(at, at + 1)] -= circulatory + euler;
                stiffness[(at + 1, at)] += circulatory + euler;
            }
            at += coordinates;
        }
        (damping, stiffness)
    }

    /// The terms of the plate that a speed over time multiplies.
    pub(super) fn speed_dependence(
        &self,
        parts: Contributions,
        speed: &Profile,
    ) -> SpeedDependence {
        let (damping, stiffness) =
            self.plate(parts, SpeedFactors { linear: 1.0, ..SpeedFactors::NONE });
        let (_, square) = self.plate(parts, SpeedFactors { root: 1.0, ..SpeedFactors::NONE });
        let (_, rate) = self.plate(parts, SpeedFactors { rate: 1.0, ..SpeedFactors::NONE });
        SpeedDependence { speed: speed.clone(), damping, stiffness, square, rate }
    }
}
