//! A body that carries a load: a pad, or the caliper behind it.

/// A body that moves normal to the disc on a spring and a damper of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// Mass m* > 0 over the mass of the plate.
    pub mass: f64,
    /// Damper c* ≥ 0 to the next body, or to the ground.
    pub damping: f64,
    /// Spring k* > 0 to the next body, or to the ground.
    pub stiffness: f64,
}
