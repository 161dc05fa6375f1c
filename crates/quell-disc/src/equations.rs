//! The equations of motion of a disc, assembled from named contributions.
//!
//! In the frame of the loads, w = Σ φ(r)(A cos qφ + B sin qφ):
//!
//! ```text
//! A″ − 2qΩB′ + (β² − q²Ω²)A + 2ξβ(A′ − qΩB) = −Σ_l φ cos qθ_l [m w″ + c w′ + k w − f(τ) w_φ] at load l
//! B″ + 2qΩA′ + (β² − q²Ω²)B + 2ξβ(B′ + qΩA) = −Σ_l φ sin qθ_l [the same]                    (5.18), (5.25), (5.32)
//! ```
//!
//! with the contact row u_l (φ cos qθ_l for A, φ sin qθ_l for B), w = u_lᵀy, and the slope row
//! s_l (−qφ sin qθ_l, qφ cos qθ_l), w_φ = s_lᵀy. So M = I + Σ m u uᵀ, C and K get Σ c u uᵀ and Σ k u uᵀ − Σ f u sᵀ.
//!
//! Corrections to the print. Inside the double sum of (5.18), (5.25) and (5.32) the accelerations and velocities carry the
//! indices of the equation (A_pq″, A_pq′); they must be those of the sum (A_ij″, A_ij′), as (5.15) has them. Taken
//! literally it is another system whose verdict differs (Ω = 0.2, m = c = k = 0.3, f = 0.1: −2.1·10⁻² instead of +9.3·10⁻⁵).
//! The dissertation drops the plate's damping from (5.14) on and uses ξ in figures 5.8–5.15 without a definition;
//! here it is a damper at rest in the disc, which brings the circulatory pair 2ξβqΩ.
//!
//! State x = (y, y′). Friction enters as a kick x′ = A₀x + Σ f_l(τ) U_l V_lᵀ x with U_l = (0, M⁻¹u_l), V_l = (s_l, 0): VᵀU = 0.

use quell_model::Disc;
use quell_model::disc::{Contribution, Contributions};
use quell_numerics::matrix::Matrix;

/// Matrices of the equations of motion, and the rows of the contacts.
#[derive(Clone, Debug)]
pub struct System {
    /// M − I has rank one for each mass.
    mass: Matrix,
    damping: Matrix,
    stiffness: Matrix,
    /// Contact rows u_l, one row for each load.
    contact: Matrix,
    /// Slope rows s_l.
    slope: Matrix,
    /// M⁻¹u_l as columns.
    response: Matrix,
    /// M⁻¹C and M⁻¹K, without friction.
    over_mass: [Matrix; 2],
    /// Friction f_l of each load.
    friction: Vec<f64>,
    /// Mean of f(τ)/f and amplitude of its cosine.
    modulation: (f64, f64),
    /// Mean follower force f_l of each load.
    mean_friction: Vec<f64>,
    frequency_ratio: Option<f64>,
}

impl System {
    /// The disc as it is.
    pub fn new(disc: &Disc) -> Self {
        Self::assemble(disc, Contributions::ALL)
    }

    /// The disc with some contributions switched off.
    pub fn assemble(disc: &Disc, parts: Contributions) -> Self {
        let n = disc.coordinates();
        let (contact, slope) = rows(disc);
        let mut mass = Matrix::identity(n);
        let mut damping = Matrix::zeros(n, n);
        let mut stiffness = Matrix::zeros(n, n);
        add_plate(disc, parts, &mut damping, &mut stiffness);
        for (l, load) in disc.loads().iter().enumerate() {
            let u = contact.row(l);
            for (part, strength, matrix) in [
                (Contribution::LoadMass, load.mass, &mut mass),
                (Contribution::Damper, load.damping, &mut damping),
                (Contribution::Spring, load.stiffness, &mut stiffness),
            ] {
                if parts.contains(part) && strength != 0.0 {
                    for i in 0..n {
                        for j in 0..n {
                            matrix[(i, j)] += strength * u[i] * u[j];
                        }
                    }
                }
            }
        }
        let (mean, amplitude) = disc.dither().mean_and_amplitude();
        let mean = if parts.contains(Contribution::FollowerForce) { mean } else { 0.0 };
        let amplitude = if parts.contains(Contribution::Dither) { amplitude } else { 0.0 };
        let masses: Vec<f64> = disc
            .loads()
            .iter()
            .map(|load| if parts.contains(Contribution::LoadMass) { load.mass } else { 0.0 })
            .collect();
        let inverse = InverseMass::new(&contact, &masses);
        let response = inverse.times(&contact.transpose());
        let over_mass = [inverse.times(&damping), inverse.times(&stiffness)];
        Self {
            mass,
            damping,
            stiffness,
            contact,
            slope,
            response,
            over_mass,
            friction: disc.loads().iter().map(|load| load.friction).collect(),
            modulation: (mean, amplitude),
            mean_friction: disc.loads().iter().map(|load| mean * load.friction).collect(),
            frequency_ratio: disc.dither().frequency_ratio(),
        }
    }

    /// Number of coordinates; the state has twice as many numbers.
    pub fn coordinates(&self) -> usize {
        self.mass.rows()
    }

    /// M.
    pub fn mass(&self) -> &Matrix {
        &self.mass
    }

    /// C.
    pub fn damping(&self) -> &Matrix {
        &self.damping
    }

    /// K without friction.
    pub fn stiffness(&self) -> &Matrix {
        &self.stiffness
    }

    /// Contact rows u_l, one for each load: the disc's displacement there is u_lᵀy.
    pub fn contact(&self) -> &Matrix {
        &self.contact
    }

    /// Slope rows s_l, one for each load: the disc's slope along φ there is s_lᵀy.
    pub fn slope(&self) -> &Matrix {
        &self.slope
    }

    /// Mean follower force of each load.
    pub fn mean_friction(&self) -> &[f64] {
        &self.mean_friction
    }

    /// Friction f_l of each load.
    pub fn friction(&self) -> &[f64] {
        &self.friction
    }

    /// Mean of f(τ)/f and amplitude of its cosine, without what is switched off.
    pub fn modulation(&self) -> (f64, f64) {
        self.modulation
    }

    /// Dither frequency ratio R, where there is dither.
    pub fn frequency_ratio(&self) -> Option<f64> {
        self.frequency_ratio
    }

    /// [[0, I], [−M⁻¹K, −M⁻¹C]], the state matrix with the load's friction f_l (one for each load) as given.
    pub fn state_matrix(&self, friction: &[f64]) -> Matrix {
        let n = self.coordinates();
        let [damping, stiffness] = &self.over_mass;
        let mut a = Matrix::zeros(2 * n, 2 * n);
        for i in 0..n {
            a[(i, n + i)] = 1.0;
            let row = a.row_mut(n + i);
            for j in 0..n {
                row[j] = -stiffness[(i, j)];
                row[n + j] = -damping[(i, j)];
            }
            for (l, &force) in friction.iter().enumerate() {
                if force != 0.0 {
                    let factor = force * self.response[(i, l)];
                    for (entry, slope) in row[..n].iter_mut().zip(self.slope.row(l)) {
                        *entry += factor * slope;
                    }
                }
            }
        }
        a
    }

    /// U (columns (0, M⁻¹u_l)) and V (columns (s_l, 0)) of the friction kick.
    pub fn kick(&self) -> (Matrix, Matrix) {
        let (n, loads) = (self.coordinates(), self.contact.rows());
        let u = Matrix::from_fn(
            2 * n,
            loads,
            |i, l| {
                if i < n { 0.0 } else { self.response[(i - n, l)] }
            },
        );
        let v = Matrix::from_fn(2 * n, loads, |i, l| if i < n { self.slope[(l, i)] } else { 0.0 });
        (u, v)
    }
}

/// Contact and slope rows of every load.
fn rows(disc: &Disc) -> (Matrix, Matrix) {
    let (n, loads) = (disc.coordinates(), disc.loads().len());
    let mut contact = Matrix::zeros(loads, n);
    let mut slope = Matrix::zeros(loads, n);
    for (l, load) in disc.loads().iter().enumerate() {
        let mut at = 0;
        for (index, mode) in disc.modes().iter().enumerate() {
            let q = mode.diameters as f64;
            let (sine, cosine) = libm::sincos(q * load.angle);
            let shape = disc.shape(index, l);
            contact[(l, at)] = shape * cosine;
            if mode.diameters > 0 {
                contact[(l, at + 1)] = shape * sine;
                slope[(l, at)] = -q * shape * sine;
                slope[(l, at + 1)] = q * shape * cosine;
                at += 1;
            }
            at += 1;
        }
    }
    (contact, slope)
}

/// What the plate alone contributes to C and K.
fn add_plate(disc: &Disc, parts: Contributions, damping: &mut Matrix, stiffness: &mut Matrix) {
    let on = |part, value: f64| if parts.contains(part) { value } else { 0.0 };
    let mut at = 0;
    for mode in disc.modes() {
        let turning = mode.diameters as f64 * disc.speed();
        let loss = 2.0 * mode.damping * mode.ratio;
        let diagonal = on(Contribution::Plate, mode.ratio * mode.ratio)
            - on(Contribution::Gyroscopic, turning * turning);
        let coordinates = if mode.diameters == 0 { 1 } else { 2 };
        for i in at..at + coordinates {
            stiffness[(i, i)] += diagonal;
            damping[(i, i)] += on(Contribution::DiscDamping, loss);
        }
        if coordinates == 2 {
            let gyroscopic = on(Contribution::Gyroscopic, 2.0 * turning);
            damping[(at, at + 1)] -= gyroscopic;
            damping[(at + 1, at)] += gyroscopic;
            let circulatory = on(Contribution::CirculatoryDamping, loss * turning);
            stiffness[(at, at + 1)] -= circulatory;
            stiffness[(at + 1, at)] += circulatory;
        }
        at += coordinates;
    }
}

/// (I + Σ m u uᵀ)⁻¹ = I − W (D⁻¹ + WᵀW)⁻¹ Wᵀ with W the contact columns of the loads that have a mass.
struct InverseMass {
    columns: Matrix,
    small: Option<Matrix>,
}

impl InverseMass {
    fn new(contact: &Matrix, masses: &[f64]) -> Self {
        let heavy: Vec<usize> = (0..masses.len()).filter(|&l| masses[l] > 0.0).collect();
        let columns =
            Matrix::from_fn(contact.columns(), heavy.len(), |i, l| contact[(heavy[l], i)]);
        let mut small = columns.transpose().times(&columns);
        for (l, &load) in heavy.iter().enumerate() {
            small[(l, l)] += 1.0 / masses[load];
        }
        // Positive definite: elimination never fails.
        let small = small.solve(&Matrix::identity(heavy.len()));
        Self { columns, small }
    }

    fn times(&self, right: &Matrix) -> Matrix {
        let mut result = right.clone();
        if let Some(small) = &self.small
            && small.rows() > 0
        {
            let along = self.columns.transpose().times(right);
            result.add_scaled(-1.0, &self.columns.times(&small.times(&along)));
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use quell_model::disc::DiscDither;
    use quell_model::disc::{Load, Mode};

    #[test]
    fn the_inverse_of_the_mass_is_one() {
        let mode = |diameters, ratio, shape_at_load| Mode {
            diameters,
            ratio,
            shape_at_load,
            damping: 1e-3,
        };
        let modes = vec![mode(0, 1.7, 0.6), mode(1, 1.8, 0.9), mode(2, 2.0, 0.93)];
        let loads = vec![
            Load::new(0.3, 0.1, 0.2, 0.1),
            Load::new(0.0, 0.1, 0.2, 0.1).at_angle(1.0),
            Load::new(2.5, 0.1, 0.2, 0.1).at_angle(2.2),
        ];
        let disc = Disc::new(modes, loads, DiscDither::None, 0.4).expect("valid");
        let system = System::new(&disc);
        for (product, wanted) in [
            (system.mass.times(&system.over_mass[0]), &system.damping),
            (system.mass.times(&system.over_mass[1]), &system.stiffness),
            (system.mass.times(&system.response), &system.contact.transpose()),
        ] {
            for (value, wanted) in product.as_slice().iter().zip(wanted.as_slice()) {
                assert!((value - wanted).abs() < 1e-14);
            }
        }
        let (u, v) = system.kick();
        assert_eq!(v.transpose().times(&u).largest(), 0.0);
    }

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
}
