//! The Taylor series of one contact on a step.

use crate::simulation::{ORDER, Series};

/// Series of one contact on a step.
#[derive(Clone, Debug)]
pub(super) struct ContactSeries {
    /// Whether load and factor are constant and without reaction on the structure, and friction is not turned by a slope: the
    /// series of the load are then written once, when the run begins.
    pub(super) is_plain: bool,
    /// dT/dγ at the start of the step, where the contact is plain and slips.
    pub(super) drag: f64,
    /// γ.
    pub(super) slip: Series,
    /// N; where the contact is open the load that it would have, which is negative.
    pub(super) load: Series,
    /// N₀ + ΔN(t).
    pub(super) given: Series,
    /// N times its factor: what the coefficient of friction multiplies.
    pub(super) pressed: Series,
    /// T.
    pub(super) friction: Series,
    /// sᵀx.
    pub(super) tilt: Series,
    pub(super) scaled: Series,
    pub(super) coefficient: Series,
    pub(super) surface: Series,
    pub(super) guided: Series,
    pub(super) factor: Series,
}

impl ContactSeries {
    pub(super) const ZERO: Self = Self {
        is_plain: false,
        drag: 0.0,
        slip: [0.0; ORDER + 1],
        load: [0.0; ORDER + 1],
        given: [0.0; ORDER + 1],
        pressed: [0.0; ORDER + 1],
        friction: [0.0; ORDER + 1],
        tilt: [0.0; ORDER + 1],
        scaled: [0.0; ORDER + 1],
        coefficient: [0.0; ORDER + 1],
        surface: [0.0; ORDER + 1],
        guided: [0.0; ORDER + 1],
        factor: [0.0; ORDER + 1],
    };
}

impl ContactSeries {
    /// γ̇ of order k without the forces that are sought: (k + 1) v_{k+1} − tᵀẋ.
    #[inline(always)]
    pub(super) fn lost_slip(&self, k: usize, along: f64) -> f64 {
        let surface = if k < ORDER { self.surface[k + 1] } else { 0.0 };
        f64::mul_add((k + 1) as f64, surface, -along)
    }
}
