//! The deflection of a disc under static loads, and how near its speed is to a critical speed.
//!
//! A load P that is constant in the frame of the loads deflects the disc by y with A (y, 0) + (0, M⁻¹p) = 0, p = Σ P_l u_l over
//! the rows u of the loads, A the state matrix of small motions with springs and mean friction. A free mode of q diameters
//! answers with P φ²/(β² + κΩ² − q²Ω²): its forward wave stands still under the loads at the critical speed Ω_c = β/√(q² − κ), and
//! only the damping of the disc bounds it there. Its deflection is that at rest times 1/(1 − (Ω/Ω_c)²).
//!
//! Loads are in r₀M_pω_ref² and deflections in r₀, each of its own load.

use quell_linear::linearised::Linearised;
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_numerics::eigen::EigenError;
use quell_numerics::matrix::Matrix;
use quell_numerics::order::ascending_by;

/// Amplification of a mode from which its critical speed is near: Ω is within 5 % of Ω_c.
pub const NEAR: f64 = 10.0;

/// A critical speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalSpeed {
    /// Index of the mode.
    pub mode: usize,
    /// Ω_c in ω_ref.
    pub speed: f64,
    /// Deflection of the free mode at the speed of the disc over that at rest, 1/|1 − (Ω/Ω_c)²|; infinite at Ω_c.
    pub amplification: f64,
}

impl CriticalSpeed {
    /// Whether the disc rotates near it.
    pub fn is_near(&self) -> bool {
        self.amplification >= NEAR
    }
}

/// The critical speeds of a disc, ascending.
pub fn critical_speeds(disc: &Disc) -> Vec<CriticalSpeed> {
    let of_mode = |mode| {
        let speed = disc.critical_speed(mode)?;
        let ratio = disc.speed().abs() / speed;
        let amplification = ((1.0 - ratio) * (1.0 + ratio)).abs().recip();
        Some(CriticalSpeed { mode, speed, amplification })
    };
    let mut found: Vec<CriticalSpeed> = (0..disc.modes().len()).filter_map(of_mode).collect();
    ascending_by(&mut found, |a| a.speed);
    found
}

/// Deflection at every load under the static loads of all; `None` where the disc has no unique equilibrium.
///
/// # Errors
/// [`EigenError::NotFinite`] where parameters are so large that the mass matrix cannot be inverted.
pub fn deflections(disc: &Disc, parts: Contributions) -> Result<Option<Vec<f64>>, EigenError> {
    let system = disc.undithered().system_of(parts);
    let linear = Linearised::new(&system).map_err(|_| EigenError::NotFinite)?;
    let structure = system.structure.mechanical().ok_or(EigenError::NotFinite)?;
    let n = linear.coordinates();
    let mut force = Matrix::zeros(n, 1);
    let rows: Vec<Vec<f64>> = (0..disc.loads().len()).map(|load| disc.surface_row(load)).collect();
    for (load, row) in disc.loads().iter().zip(&rows) {
        // Forces in the units of the first load.
        let strength = load.static_load * disc.radius_over_first(load);
        for (i, entry) in row.iter().enumerate() {
            force[(i, 0)] += strength * entry;
        }
    }
    let force = structure.mass().solve(&force).ok_or(EigenError::NotFinite)?;
    let right = Matrix::from_fn(2 * n, 1, |i, _| if i < n { 0.0 } else { -force[(i - n, 0)] });
    let matrix = linear.state_matrix(&linear.mean_friction());
    let Some(found) = matrix.solve(&right).filter(Matrix::is_finite) else { return Ok(None) };
    let at = |(row, load)| {
        let row: &Vec<f64> = row;
        let deflection: f64 = row.iter().zip(found.as_slice()).map(|(u, y)| u * y).sum();
        deflection / disc.radius_over_first(load)
    };
    Ok(Some(rows.iter().zip(disc.loads()).map(at).collect()))
}
