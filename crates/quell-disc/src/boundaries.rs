//! Exact stability boundaries f(Ω) of an undithered disc without modal damping.
//!
//! At ξ = 0 and under one load, the equations with ρ = iω are (K_c + iωG − ω²M_c) y = −u (c iω w − f w_φ), w = uᵀy, w_φ = sᵀy,
//! with the conservative system K_c, G, M_c of plate, mass and spring on the left. A motion on the boundary that the force can
//! excite (w ≠ 0) requires a force in quadrature. For real ω the left side is real, so the bracket vanishes:
//!
//! ```text
//! f = c · iω w / w_φ        for each mode y of the conservative loaded disc
//! ```
//!
//! exactly, linearly in c, and without a grid. The force cannot excite a mode with w = 0: iω remains an eigenvalue for every f.
//! Modes at the speeds of table 5.1 and at Ω = 0 are of this kind and form vertical lines in the map.

use std::fmt;

use quell_numerics::eigen::{Decomposition, EigenError};
use quell_numerics::order::ascending_by;

use crate::equations::linearised;
use quell_model::Disc;
use quell_model::disc::{Contribution, Contributions};

/// Below this fraction of |y||u| a displacement counts as zero.
const NEGLIGIBLE: f64 = 1e-10;

/// Reason of a closed form that holds for the load of the dissertation only.
pub(crate) const NOT_PLAIN: &str = "closed forms exist only for a load at one point of the disc, without a pad of its own and with a given friction force";

/// Friction at which a mode of the conservative loaded disc is marginal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Marginal {
    /// At this friction f alone.
    At(f64),
    /// At every friction: the force does not excite the mode.
    Always,
    /// At no friction: the mode has no slope at the load (no nodal diameters).
    Never,
}

/// A mode of the conservative loaded disc and the friction at which it is marginal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModeBoundary {
    /// Frequency ω in the frame of the loads.
    pub frequency: f64,
    /// The friction.
    pub friction: Marginal,
}

/// Why there is no exact boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoBoundary {
    /// The number of loads is not one: the bracket need not vanish.
    Loads(usize),
    /// The load is distributed, its pad moves, or a law gives its friction.
    NotPlain,
    /// The modes are damped.
    DampedModes,
    /// The conservative system itself is unstable (Ω beyond β/q).
    Unstable,
    /// The eigenvalues could not be computed.
    Eigenvalues(EigenError),
}

impl fmt::Display for NoBoundary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Loads(count) => {
                write!(f, "exact boundaries exist for one load only, but the disc has {count}")
            }
            Self::NotPlain => f.write_str(NOT_PLAIN),
            Self::DampedModes => {
                f.write_str("exact boundaries exist only for a disc without modal damping")
            }
            Self::Unstable => {
                f.write_str("at this speed the disc is unstable even without damper and friction")
            }
            Self::Eigenvalues(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoBoundary {}

/// Boundaries at the speed of the disc, sorted by frequency. The friction and dither of the disc are ignored.
///
/// # Errors
/// [`NoBoundary`] where the condition above does not apply.
pub fn boundaries(disc: &Disc) -> Result<Vec<ModeBoundary>, NoBoundary> {
    if disc.loads().len() != 1 {
        return Err(NoBoundary::Loads(disc.loads().len()));
    }
    if !disc.is_plain() {
        return Err(NoBoundary::NotPlain);
    }
    if disc.modes().iter().any(|mode| mode.damping != 0.0) {
        return Err(NoBoundary::DampedModes);
    }
    let parts = Contributions::ALL.without(Contribution::Damper);
    let system = linearised(&disc.undithered(), parts).map_err(NoBoundary::Eigenvalues)?;
    let decomposition =
        Decomposition::new(&system.state_matrix(&[0.0])).map_err(NoBoundary::Eigenvalues)?;
    let n = system.coordinates();
    let load = &system.contacts()[0];
    let (contact, slope) =
        (load.normal().unwrap_or_default(), load.slope_row().unwrap_or_default());
    let size = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (contact_size, slope_size) = (size(contact), size(slope));
    let mut found = Vec::new();
    for (index, value) in decomposition.values().iter().enumerate() {
        if value.re.abs() > 1e-6 * decomposition.norm() {
            return Err(NoBoundary::Unstable);
        }
        if value.im <= 0.0 {
            continue;
        }
        let pair = decomposition.pair(index);
        let y = &pair.right[..n];
        let along =
            |row: &[f64]| y.iter().zip(row).map(|(y, r)| y * r).sum::<num_complex::Complex64>();
        let (w, w_phi) = (along(contact), along(slope));
        let length = y.iter().map(num_complex::Complex64::norm_sqr).sum::<f64>().sqrt();
        let excited = w.norm_sqr().sqrt() > NEGLIGIBLE * length * contact_size;
        let has_slope = w_phi.norm_sqr().sqrt() > NEGLIGIBLE * length * slope_size;
        let friction = match (excited, has_slope) {
            (false, _) => Marginal::Always,
            (true, false) => Marginal::Never,
            (true, true) => {
                let ratio = w / w_phi;
                Marginal::At(-disc.loads()[0].damping * value.im * ratio.im)
            }
        };
        found.push(ModeBoundary { frequency: value.im, friction });
    }
    ascending_by(&mut found, |a| a.frequency);
    Ok(found)
}
