//! A friction contact: rows over the coordinates, a load, a surface that moves, and a law.

use crate::friction::Friction;
use crate::profile::Profile;

/// A contact between the structure and a moving surface.
///
/// With its rows t (tangent), n (normal) and s (slope), all over the coordinates q:
///
/// * slip velocity γ = v(t) − tᵀq̇, v the velocity of the surface; friction T pulls along +t while γ > 0;
/// * normal load N = N₀ + k nᵀq + d nᵀq̇, nᵀq the approach; q is measured from the loaded rest without friction;
/// * the force on the structure is t T + n (T sᵀq − (N − N₀)).
///
/// A contact without a tangent slips at γ = v; one without a normal has a prescribed load.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Name, unique in the system.
    pub name: String,
    /// Tangent row t.
    pub tangent: Option<Vec<f64>>,
    /// Column g of first-order equations, ẋ = … + g T, which stands for M⁻¹t; `None` for a mechanical structure.
    pub force: Option<Vec<f64>>,
    /// Normal row n.
    pub normal: Option<Vec<f64>>,
    /// Slope row s: a surface tilted by sᵀq turns friction by that angle.
    pub slope: Option<Vec<f64>>,
    /// Steady normal load N₀ > 0.
    pub normal_load: f64,
    /// Normal stiffness k ≥ 0.
    pub normal_stiffness: f64,
    /// Normal damping d ≥ 0.
    pub normal_damping: f64,
    /// Velocity v of the surface.
    pub surface_velocity: Profile,
    /// Friction law; odd in the slip velocity.
    pub friction: Friction,
}
