//! The values of units in which a system is written.

use super::Quantity;

/// The values of one unit of the numbers of a system. Force and velocity are those that follow from the other three; they are given, so
/// that they are rounded as where they come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitValues {
    /// Of mass.
    pub mass: f64,
    /// Of length.
    pub length: f64,
    /// Of time.
    pub time: f64,
    /// Of force.
    pub force: f64,
    /// Of velocity.
    pub velocity: f64,
}

impl UnitValues {
    /// Of the quantity of a friction law.
    pub(crate) fn of_law(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Velocity => self.velocity,
            Quantity::PerVelocity => self.velocity.recip(),
            Quantity::PerLength => self.length.recip(),
            Quantity::Displacement => self.length,
            _ => 1.0,
        }
    }
}
