//! A contact as the engine needs it: the rows that it reads and the columns that it adds.

use super::own_state::OwnState;
use super::rows::RowEntries;

/// A contact as the engine needs it.
#[derive(Clone, Debug)]
pub(super) struct ContactEquation {
    /// Row t of the slip velocity γ = v − tᵀx.
    pub(super) tangent: RowEntries,
    /// Row r of the load: k nᵀ over displacements and d nᵀ over velocities.
    pub(super) approach: RowEntries,
    /// Row s of the tilt.
    pub(super) slope: RowEntries,
    /// Columns g and h.
    pub(super) along: RowEntries,
    pub(super) across: RowEntries,
    /// N₀.
    pub(super) normal_load: f64,
    /// Velocity that scales slip for the law.
    pub(super) scale: f64,
    pub(super) inverse_scale: f64,
    /// μ_s and μ(0⁺).
    pub(super) static_coefficient: f64,
    pub(super) sliding_coefficient: f64,
    /// Its own number of the state.
    pub(super) own: Option<OwnState>,
}

impl ContactEquation {
    /// Whether the load depends on the motion, so that the contact can open.
    #[inline(always)]
    pub(super) fn is_compliant(&self) -> bool {
        !self.approach.is_empty()
    }

    /// Whether the contact has a tangent, so that it can stick.
    #[inline(always)]
    pub(super) fn can_stick(&self) -> bool {
        !self.tangent.is_empty()
    }
}
