//! The Taylor series of one contact on a step.

use quell_numerics::lane::Lane;

use super::own_state::OwnSeries;
use crate::simulation::ORDER;

/// Taylor coefficients in every lane.
pub(super) type SeriesOf<V> = [V; ORDER + 1];

/// Series of one contact on a step.
#[expect(
    clippy::struct_excessive_bools,
    reason = "independent properties of a contact, constant along a run"
)]
#[derive(Clone, Debug)]
pub(super) struct ContactSeries<V = f64> {
    /// Whether load and factor are constant and without reaction on the structure, and friction is not turned by a slope: the
    /// series of the load are then written once, when the run begins.
    pub(super) is_plain: bool,
    /// Whether the load depends on the motion or on time.
    pub(super) load_varies: bool,
    /// Whether a part of the load has no reaction on the structure.
    pub(super) is_guided: bool,
    /// Whether a factor multiplies friction.
    pub(super) has_factor: bool,
    /// dT/dγ at the start of the step, where the contact is plain and slips.
    pub(super) drag: V,
    /// γ̇ of the current order without the forces that are sought, where the contact sticks.
    pub(super) lost: V,
    /// γ.
    pub(super) slip: SeriesOf<V>,
    /// N; where the contact is open the load that it would have, which is negative.
    pub(super) load: SeriesOf<V>,
    /// N₀ + ΔN(t).
    pub(super) given: SeriesOf<V>,
    /// N times its factor: what the coefficient of friction multiplies.
    pub(super) pressed: SeriesOf<V>,
    /// T.
    pub(super) friction: SeriesOf<V>,
    /// sᵀx.
    pub(super) tilt: SeriesOf<V>,
    pub(super) scaled: SeriesOf<V>,
    pub(super) coefficient: SeriesOf<V>,
    pub(super) surface: SeriesOf<V>,
    pub(super) guided: SeriesOf<V>,
    pub(super) factor: SeriesOf<V>,
    /// The series of a contact with a state of its own.
    pub(super) own: Option<Box<OwnSeries<V>>>,
}

impl<V: Lane> ContactSeries<V> {
    pub(super) fn zero() -> Self {
        let series = [V::splat(0.0); ORDER + 1];
        Self {
            is_plain: false,
            load_varies: false,
            is_guided: false,
            has_factor: false,
            drag: V::splat(0.0),
            lost: V::splat(0.0),
            slip: series,
            load: series,
            given: series,
            pressed: series,
            friction: series,
            tilt: series,
            scaled: series,
            coefficient: series,
            surface: series,
            guided: series,
            factor: series,
            own: None,
        }
    }

    /// γ̇ of order k without the forces that are sought: (k + 1) v_{k+1} − tᵀẋ.
    #[inline(always)]
    pub(super) fn lost_slip(&self, k: usize, along: V) -> V {
        let surface = if k < ORDER { self.surface[k + 1] } else { V::splat(0.0) };
        V::splat((k + 1) as f64).mul_add(surface, -along)
    }
}
