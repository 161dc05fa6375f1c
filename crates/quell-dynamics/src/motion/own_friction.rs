//! Friction of contacts with a state of their own, order by order.
//!
//! T of one order follows from γ and N of that order, so that the series of a step stays explicit. In a slip the number of an elastic
//! slider has no rate of its own: its series is that of T.

use quell_model::friction::{BranchSeries, FrictionSeries};
use quell_numerics::lane::partial_product;

use super::contact_equation::ContactEquation;
use super::contact_in_step::ContactInStep;
use super::contact_series::{ContactSeries, SeriesOf};
use super::own_state::{OwnState, OwnStateKind};
use super::rows::StateStorage;
use crate::simulation::ORDER;

/// Friction and state of a contact with a state of its own at order k, and its action on the structure.
#[inline(always)]
pub(super) fn friction<S: StateStorage>(
    storage: S,
    (k, own): (usize, OwnState),
    contact: &ContactEquation,
    phase: &ContactInStep,
    branch: &mut Option<FrictionSeries<'_, f64, { ORDER + 1 }>>,
    series: &mut ContactSeries,
    (state, rates): (&mut [f64], &mut [f64]),
) {
    if let Some(branch) = branch {
        let w = series.slip[k] * contact.inverse_scale;
        series.scaled[k] = w;
        series.coefficient[k] = if k == 0 {
            branch.first()
        } else {
            f64::mul_add(branch.slope(), w, branch.lower(k, &series.scaled))
        };
    }
    let Some(mut inner) = series.own.take() else { return };
    if k == 0 {
        inner.carried = state[own.place];
    }
    let (force, rate) = match own.kind {
        _ if phase.is_open => {
            state[own.place] = 0.0;
            (0.0, 0.0)
        }
        OwnStateKind::Elastic { .. } if phase.slips => {
            let product = partial_product(&series.coefficient, &series.pressed, k, 0, k);
            let force = phase.turned * product;
            state[own.place] = force;
            (force, 0.0)
        }
        OwnStateKind::Elastic { stiffness } => (state[own.place], stiffness * series.slip[k]),
        OwnStateKind::Bristles { stiffness, damping, viscous } => {
            let level = &series.coefficient;
            let rest = partial_product(level, &inner.turnover, k, 1, k);
            let inverse = 1.0 / level[0];
            inner.turnover[k] = (series.slip[k] - rest) * inverse;
            inner.deflection[k] = state[own.place];
            let slipped = partial_product(&inner.turnover, &inner.deflection, k, 0, k);
            let rate = f64::mul_add(-stiffness, slipped, series.slip[k]);
            let moving = f64::mul_add(viscous, series.slip[k], damping * rate);
            inner.share[k] = f64::mul_add(stiffness, inner.deflection[k], moving);
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
