//! The linear part of a system: a mechanical structure M q̈ + C q̇ + K q = p, or first-order equations ẋ = A x + p.

use quell_numerics::matrix::Matrix;

use super::MassMatrix;
use crate::profile::Profile;

/// The linear part of a system.
#[derive(Clone, Debug, PartialEq)]
pub enum Structure {
    /// Masses, dampers and springs; the state is (q, q̇).
    Mechanical(Mechanical),
    /// First-order equations; the state is x.
    StateSpace(StateSpace),
}

impl Structure {
    /// Names of the coordinates q, or of the states x: what a row of a contact or an input has one number for.
    pub fn names(&self) -> &[String] {
        match self {
            Self::Mechanical(mechanical) => mechanical.coordinates(),
            Self::StateSpace(states) => states.names(),
        }
    }

    /// The constant forces p, one for each name.
    pub fn force(&self) -> &[f64] {
        match self {
            Self::Mechanical(mechanical) => mechanical.force(),
            Self::StateSpace(states) => states.force(),
        }
    }

    /// Length of a row: the number of names.
    pub fn size(&self) -> usize {
        self.names().len()
    }

    /// Length of the state: 2n of a mechanical structure, else the number of states.
    pub fn state_size(&self) -> usize {
        match self {
            Self::Mechanical(mechanical) => 2 * mechanical.size(),
            Self::StateSpace(states) => states.names().len(),
        }
    }

    /// The mechanical structure, if it is one.
    pub fn mechanical(&self) -> Option<&Mechanical> {
        match self {
            Self::Mechanical(mechanical) => Some(mechanical),
            Self::StateSpace(_) => None,
        }
    }

    /// The natural frequency √(k/m) of one coordinate with a spring; `None` of other structures.
    pub fn natural_frequency(&self) -> Option<f64> {
        let mechanical = self.mechanical().filter(|mechanical| mechanical.size() == 1)?;
        let ratio = mechanical.stiffness()[(0, 0)] / mechanical.mass().matrix()[(0, 0)];
        (ratio > 0.0).then(|| ratio.sqrt())
    }
}

impl From<Mechanical> for Structure {
    fn from(mechanical: Mechanical) -> Self {
        Self::Mechanical(mechanical)
    }
}

impl From<StateSpace> for Structure {
    fn from(states: StateSpace) -> Self {
        Self::StateSpace(states)
    }
}

/// First-order equations ẋ = A x + p: a structure with its controllers, actuators and filters.
///
/// Rows of contacts and inputs are over the states; a contact's friction enters through its column g
/// ([`Contact::force`](super::Contact::force)).
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    names: Vec<String>,
    matrix: Matrix,
    force: Vec<f64>,
}

impl StateSpace {
    /// From the names of the states and A, without constant forces.
    ///
    /// # Panics
    /// If A is not square of that size.
    pub fn new(names: Vec<String>, matrix: Matrix) -> Self {
        let n = names.len();
        assert_eq!((matrix.rows(), matrix.columns()), (n, n), "size of the state matrix");
        Self { names, matrix, force: vec![0.0; n] }
    }

    /// The same equations with the constant rates p, one for each state.
    ///
    /// # Panics
    /// If there are not as many rates as states.
    #[must_use]
    pub fn under(self, force: Vec<f64>) -> Self {
        assert_eq!(force.len(), self.names.len(), "one rate for each state");
        Self { force, ..self }
    }

    /// Names of the states.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// A.
    pub fn matrix(&self) -> &Matrix {
        &self.matrix
    }

    /// Constant rates p.
    pub fn force(&self) -> &[f64] {
        &self.force
    }
}

/// Masses, dampers, springs and constant forces of n coordinates.
///
/// M is symmetric and positive definite; C and K are any real matrices, gyroscopic and circulatory parts included.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanical {
    coordinates: Vec<String>,
    mass: MassMatrix,
    damping: Matrix,
    stiffness: Matrix,
    force: Vec<f64>,
    by_speed: Option<Box<SpeedDependence>>,
}

/// The parts of C and K that a speed Ω(t) multiplies, as of a structure in a rotating frame:
///
/// ```text
/// M q̈ + (C + Ω C₁) q̇ + (K + Ω K₁ + Ω² K₂ + Ω′ K₃) q = p + …
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedDependence {
    /// Ω over time.
    pub speed: Profile,
    /// C₁.
    pub damping: Matrix,
    /// K₁.
    pub stiffness: Matrix,
    /// K₂.
    pub square: Matrix,
    /// K₃.
    pub rate: Matrix,
}

impl Mechanical {
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
        let force = vec![0.0; n];
        Self { coordinates, mass, damping, stiffness, force, by_speed: None }
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

    /// The same structure with matrices that also depend on a speed over time.
    ///
    /// # Panics
    /// If the sizes do not agree.
    #[must_use]
    pub fn at_speed(self, by_speed: SpeedDependence) -> Self {
        let n = self.size();
        let SpeedDependence { damping, stiffness, square, rate, .. } = &by_speed;
        for matrix in [damping, stiffness, square, rate] {
            assert_eq!((matrix.rows(), matrix.columns()), (n, n), "sizes of a structure");
        }
        Self { by_speed: Some(Box::new(by_speed)), ..self }
    }

    /// The parts of C and K that depend on a speed over time; `None` for constant matrices.
    pub fn by_speed(&self) -> Option<&SpeedDependence> {
        self.by_speed.as_deref()
    }

    /// The structure with the constant matrices of the speed of a time, without those of its rate of change.
    #[must_use]
    pub fn steady_at(&self, time: f64) -> Self {
        let Some(by_speed) = self.by_speed() else { return self.clone() };
        let speed = by_speed.speed.value(time);
        let n = self.size();
        let damping = Matrix::from_fn(n, n, |i, j| {
            speed.mul_add(by_speed.damping[(i, j)], self.damping[(i, j)])
        });
        let stiffness = Matrix::from_fn(n, n, |i, j| {
            let by_speed = speed.mul_add(by_speed.square[(i, j)], by_speed.stiffness[(i, j)]);
            speed.mul_add(by_speed, self.stiffness[(i, j)])
        });
        Self { damping, stiffness, by_speed: None, ..self.clone() }
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

    /// C, without the parts that depend on a speed over time.
    pub fn damping(&self) -> &Matrix {
        &self.damping
    }

    /// K, without the contacts' own stiffness and the parts that depend on a speed over time.
    pub fn stiffness(&self) -> &Matrix {
        &self.stiffness
    }

    /// Constant forces p.
    pub fn force(&self) -> &[f64] {
        &self.force
    }
}
