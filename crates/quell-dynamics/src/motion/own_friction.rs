//! Friction of contacts with a state of their own, order by order.
//!
//! T of one order follows from γ and N of that order, so that the series of a step stays explicit. In a slip the number of an elastic
//! slider has no rate of its own: its series is that of T.

use quell_model::friction::{BranchSeries, FrictionSeries};
use quell_numerics::lane::{Lane, partial_product};

use super::contact_equation::ContactEquation;
use super::contact_masks::ContactMasks;
use super::contact_series::{ContactSeries, SeriesOf};
use super::own_state::{OwnState, OwnStateKind};
use super::rows::{StateRow, StateStorage};
use crate::simulation::ORDER;

/// Friction and state of a contact with a state of its own at order k, and its action on the structure.
#[inline(always)]
pub(super) fn friction<V: Lane, S: StateStorage<V>>(
    storage: S,
    (k, own): (usize, OwnState),
    contact: &ContactEquation<S::Row, V>,
    masks: &ContactMasks<V>,
    branch: &mut Option<FrictionSeries<'_, V, { ORDER + 1 }>>,
    series: &mut ContactSeries<V>,
    (state, rates): (&mut [V], &mut [V]),
) {
    let zero = V::splat(0.0);
    if let Some(branch) = branch {
        let w = series.slip[k] * contact.inverse_scale;
        series.scaled[k] = w;
        series.coefficient[k] = if k == 0 {
            branch.first()
        } else {
            branch.slope().mul_add(w, branch.lower(k, &series.scaled))
        };
    }
    let Some(mut inner) = series.own.take() else { return };
    if k == 0 {
        inner.carried = state[own.place];
    }
    let (force, rate) = match own.kind {
        _ if masks.any_open => {
            state[own.place] = zero;
            (zero, zero)
        }
        OwnStateKind::Elastic { .. } if masks.any_slips => {
            let product = partial_product(&series.coefficient, &series.pressed, k, 0, k);
            let force = V::splat(masks.turned) * product;
            state[own.place] = force;
            (force, zero)
        }
        OwnStateKind::Elastic { stiffness } => {
            (state[own.place], V::splat(stiffness) * series.slip[k])
        }
        OwnStateKind::Bristles { stiffness, damping, viscous } => {
            let level = &series.coefficient;
            let rest = partial_product(level, &inner.turnover, k, 1, k);
            let inverse = level[0].map(|level| 1.0 / level);
            inner.turnover[k] = (series.slip[k] - rest) * inverse;
            inner.deflection[k] = state[own.place];
            let slipped = partial_product(&inner.turnover, &inner.deflection, k, 0, k);
            let rate = V::splat(-stiffness).mul_add(slipped, series.slip[k]);
            let moving = V::splat(viscous).mul_add(series.slip[k], V::splat(damping) * rate);
            inner.share[k] = V::splat(stiffness).mul_add(inner.deflection[k], moving);
            (partial_product(&inner.share, &series.pressed, k, 0, k), rate)
        }
    };
    series.own = Some(inner);
    series.friction[k] = force;
    rates[own.place] = rate;
    storage.add(&contact.along, force, rates);
    if !contact.slope.is_empty() {
        let tilted = partial_product(&series.tilt, &series.friction, k, 0, k);
        storage.add(&contact.across, tilted, rates);
    }
}

/// The own speed γ − Ṫ/k_t of an elastic slider on a step, in the direction of its slip. Without the last term of Ṫ, which is beyond
/// the order of the step.
#[inline(always)]
pub(super) fn own_speed(series: &ContactSeries, stiffness: f64, out: &mut SeriesOf<f64>) {
    let inverse = 1.0 / stiffness;
    let rates = series.friction[1..].iter().zip(&series.slip).enumerate();
    for (out, (k, (friction, slip))) in out.iter_mut().zip(rates) {
        *out = f64::mul_add(-((k + 1) as f64) * inverse, *friction, *slip);
    }
    out[ORDER] = series.slip[ORDER];
}
