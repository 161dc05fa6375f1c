//! A contact as the engine needs it: the rows that it reads and the columns that it adds.

use super::own_state::OwnState;
use super::rows::{RowEntries, StateRow};

/// A contact as the engine needs it, with rows of type `R` and numbers of type `V`.
#[derive(Clone, Debug)]
pub(super) struct ContactEquation<R = RowEntries, V = f64> {
    /// Row t of the slip velocity γ = v − tᵀx.
    pub(super) tangent: R,
    /// Row r of the load: k nᵀ over displacements and d nᵀ over velocities.
    pub(super) approach: R,
    /// Row s of the tilt.
    pub(super) slope: R,
    /// Columns g and h.
    pub(super) along: R,
    pub(super) across: R,
    /// N₀.
    pub(super) normal_load: V,
    /// Velocity that scales slip for the law.
    pub(super) scale: V,
    pub(super) inverse_scale: V,
    /// μ_s and μ(0⁺).
    pub(super) static_coefficient: V,
    pub(super) sliding_coefficient: V,
    /// Its own number of the state: none in lanes.
    pub(super) own: Option<OwnState>,
}

impl<R: StateRow, V> ContactEquation<R, V> {
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
