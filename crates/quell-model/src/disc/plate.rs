//! The plate in the frame of the loads: gyroscopic terms, damping and elasticity of its modes.

use quell_numerics::matrix::Matrix;

use super::{Contribution, Contributions, Disc};

impl Disc {
    /// C and K of the plate alone.
    pub(super) fn plate(&self, parts: Contributions) -> (Matrix, Matrix) {
        let n = self.coordinates();
        let (mut damping, mut stiffness) = (Matrix::zeros(n, n), Matrix::zeros(n, n));
        let on = |part, value: f64| if parts.contains(part) { value } else { 0.0 };
        let mut at = 0;
        for (index, mode) in self.modes().iter().enumerate() {
            let rotation = mode.diameters as f64 * self.speed();
            let loss = 2.0 * mode.damping * mode.ratio;
            let diagonal = on(Contribution::Plate, mode.ratio * mode.ratio)
                - on(Contribution::Gyroscopic, rotation * rotation);
            let centrifugal = self.centrifugal(index);
            let diagonal = if centrifugal == 0.0 {
                diagonal
            } else {
                let stress = centrifugal * self.speed() * self.speed();
                diagonal + on(Contribution::Centrifugal, stress)
            };
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
