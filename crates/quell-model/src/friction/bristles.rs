//! The numbers of the bristles whose deflection is the state of a friction law.

/// The bristles of a law, over the normal load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bristles {
    /// Stiffness σ₀ > 0, per unit of length.
    pub stiffness: f64,
    /// Damping σ₁ ≥ 0, per unit of velocity.
    pub damping: f64,
    /// Viscous part σ₂ ≥ 0, per unit of velocity.
    pub viscous: f64,
}
