//! A linear structure: M q̈ + C q̇ + K q = p.

use quell_numerics::matrix::Matrix;

use super::MassMatrix;

/// Masses, dampers, springs and constant forces of n coordinates.
///
/// M is symmetric and positive definite; C and K are any real matrices, gyroscopic and circulatory parts included.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    coordinates: Vec<String>,
    mass: MassMatrix,
    damping: Matrix,
    stiffness: Matrix,
    force: Vec<f64>,
}

impl Structure {
    /// From the names of the coordinates, M, C and K, without constant forces.
    ///
    /// # Panics
    /// If the sizes do not agree.
    pub fn new(
        coordinates: Vec<String>,
        mass: MassMatrix,
        damping: Matrix,
        stiffness: Matrix,
    ) -> Self {
        let n = coordinates.len();
        for (rows, columns) in [
            (mass.size(), mass.size()),
            (damping.rows(), damping.columns()),
            (stiffness.rows(), stiffness.columns()),
        ] {
            assert_eq!((rows, columns), (n, n), "sizes of a structure");
        }
        Self { coordinates, mass, damping, stiffness, force: vec![0.0; n] }
    }

    /// The same structure under the constant forces p, one for each coordinate.
    ///
    /// # Panics
    /// If there are not as many forces as coordinates.
    #[must_use]
    pub fn under(self, force: Vec<f64>) -> Self {
        assert_eq!(force.len(), self.size(), "one force for each coordinate");
        Self { force, ..self }
    }

    /// Number n of coordinates; the state has 2n numbers.
    pub fn size(&self) -> usize {
        self.coordinates.len()
    }

    /// Names of the coordinates.
    pub fn coordinates(&self) -> &[String] {
        &self.coordinates
    }

    /// M.
    pub fn mass(&self) -> &MassMatrix {
        &self.mass
    }

    /// C.
    pub fn damping(&self) -> &Matrix {
        &self.damping
    }

    /// K, without the contacts' own stiffness.
    pub fn stiffness(&self) -> &Matrix {
        &self.stiffness
    }

    /// Constant forces p.
    pub fn force(&self) -> &[f64] {
        &self.force
    }
}
