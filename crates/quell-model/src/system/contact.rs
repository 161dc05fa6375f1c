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
/// A load over time takes the place of N₀ in both: what presses the contact on balances it at every moment, so that a run follows the
/// studies whose constant load is that of the moment. An oscillation that the structure shall take is an input to the load.
///
/// A contact without a tangent slips at γ = v; one without a normal has a prescribed load, and its normal stiffness is then only that
/// through which an actuator modulates the load.
///
/// A contact has a state of its own if a tangential stiffness precedes its slip (an elastic slider), or if its law has one
/// ([`Friction::bristles`]): see [`Contact::has_state`].
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
    /// Steady normal load N₀ > 0; where it varies in time, its value at t = 0.
    pub normal_load: f64,
    /// N₀ over time, if it varies; it takes the place of `normal_load`.
    pub varying_load: Option<Profile>,
    /// Normal stiffness k ≥ 0.
    pub normal_stiffness: f64,
    /// Normal damping d ≥ 0.
    pub normal_damping: f64,
    /// Velocity v of the surface.
    pub surface_velocity: Profile,
    /// Friction law; odd in the slip velocity.
    pub friction: Friction,
    /// Tangential stiffness k_t > 0 of an elastic slider, a force over a length; `None` for a rigid contact.
    ///
    /// While |T| < max(μ_s, μ(|γ|))N the contact adheres and Ṫ = k_t γ. It slides at T = ±μ(|γ|)N, and adheres again where its own
    /// speed γ − Ṫ/k_t reaches zero. Its state is T, 0 at the start of a study and where an open contact lands: the element of Jenkins
    /// (1962) and Iwan (1966).
    pub tangential_stiffness: Option<f64>,
}

impl Contact {
    /// Whether the friction force has a state of its own, so that it is no function of the slip velocity and the load.
    pub fn has_state(&self) -> bool {
        self.tangential_stiffness.is_some() || self.friction.bristles().is_some()
    }

    /// The displacement μ_s N₀/k_t by which an elastic slider bends before it slides; `None` of a rigid contact.
    pub fn breakaway(&self) -> Option<f64> {
        let stiffness = self.tangential_stiffness?;
        Some(self.friction.static_coefficient() * self.normal_load / stiffness)
    }
}

impl Contact {
    /// N₀ over time.
    pub fn load(&self) -> Profile {
        self.varying_load.clone().unwrap_or_else(|| Profile::constant(self.normal_load))
    }

    /// The contact with the surface velocity and the load of a time.
    #[must_use]
    pub fn steady_at(&self, time: f64) -> Self {
        Self {
            normal_load: self.load().value(time),
            varying_load: None,
            surface_velocity: Profile::constant(self.surface_velocity.value(time)),
            ..self.clone()
        }
    }
}
