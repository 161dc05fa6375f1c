//! A periodic response: its state, its multipliers and their errors.

use super::family::Signature;
use super::period_map::deciding;
use super::variation::Matrix2;
use super::verdict::OrbitVerdict;
use crate::simulation::{EventKind, Start};

/// A periodic response.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbit {
    /// State at τ = 0, where the dither has its phase φ.
    pub start: Start,
    /// Period in τ: a whole number of common periods of the dithers.
    pub period: f64,
    /// The larger mismatch of x and x′ after the period, a length.
    pub residual: f64,
    /// Estimated error of the state, a length: twice the mismatch divided by |1 − λ|, λ the multiplier nearest to 1.
    pub state_error: f64,
    /// Estimated error of the modulus of the deciding multiplier: its change over the state's error. Infinite where
    /// the state is too uncertain for an estimate.
    pub multiplier_error: f64,
    /// Derivative of the period map: rows (x, x′) at its end, columns (x, x′) at its start.
    pub monodromy: Matrix2,
    /// Eigenvalues of the monodromy matrix (re, im), the larger modulus first.
    pub multipliers: [(f64, f64); 2],
    /// Events of a period in order, with the sign of v_r afterwards: the signature of the orbit.
    pub events: Vec<(EventKind, i8)>,
    /// ∮(2ζ + μ′N)dτ over slip, dimensionless: in pure slip det M = e to minus this.
    pub damping: f64,
    /// Least |v_r| inside slip, a velocity ≥ 0, and its τ; `None` for an orbit that sticks throughout.
    pub least_slip: Option<(f64, f64)>,
    /// Fraction of the period spent in stick.
    pub stick_fraction: f64,
    /// Sign of v_r at the end of the period.
    pub slip_sign: i8,
    /// Whether its phase is free: a limit cycle without dither, with a multiplier 1 along it.
    pub is_free: bool,
}

impl Orbit {
    /// Modulus of the deciding multiplier: the larger one; for a free orbit the transverse one.
    pub fn radius(&self) -> f64 {
        let damping = self.is_pure_slip().then_some(self.damping);
        deciding(self.multipliers, self.is_free, damping)
    }

    /// The sequence of events in a period.
    pub fn signature(&self) -> Signature {
        let stuck = self.stick_fraction * self.period;
        Signature::of(&self.events, stuck, self.slip_sign)
    }

    /// The verdict of the multipliers.
    pub fn verdict(&self) -> OrbitVerdict {
        OrbitVerdict::of(self.radius(), self.multiplier_error)
    }

    /// Whether it never reaches v_r = 0.
    pub fn is_pure_slip(&self) -> bool {
        self.events.is_empty() && self.stick_fraction == 0.0
    }

    /// Number of events of a kind in a period.
    pub fn count(&self, kind: EventKind) -> usize {
        self.events.iter().filter(|(event, _)| *event == kind).count()
    }
}
