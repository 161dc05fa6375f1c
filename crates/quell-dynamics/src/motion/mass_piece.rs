//! One piece of slip of a system of one mass, whose series are computed where an observer asks for them.

use std::cell::{OnceCell, RefCell};

use quell_model::OneMass;
use quell_model::friction::FrictionConstants;
use quell_numerics::dispatch::{Work, with_fused_multiply_add};

use super::contact_series::ContactSeries;
use crate::simulation::{ORDER, Series};

/// Length of the state of one mass.
pub(super) const SIZE: usize = 2;

/// The states of one mass on a piece, order by order.
pub(super) type MassStates = [f64; (ORDER + 1) * SIZE];

/// A step of slip of the engine for one mass, in the units of its system on demand.
pub(super) struct MassPiece<'a> {
    pub(super) mass: &'a OneMass,
    /// Coefficients of x and v_r in the units of the engine.
    pub(super) raw: (&'a [f64], &'a [f64]),
    /// Length unit of the engine.
    pub(super) unit: f64,
    /// Powers of ω.
    pub(super) rates: &'a Series,
    /// Sign of the slip.
    pub(super) sign: f64,
    pub(super) law: &'a RefCell<FrictionConstants>,
    /// The contact, of which slip, load and surface are known.
    pub(super) contact: &'a ContactSeries,
    pub(super) states: OnceCell<MassStates>,
    pub(super) complete: OnceCell<Box<ContactSeries>>,
}

impl MassPiece<'_> {
    /// The states, order by order.
    pub(super) fn states(&self) -> &MassStates {
        self.states.get_or_init(|| with_fused_multiply_add(StatesOf(self)))
    }

    /// The contact with its law and friction along the piece.
    pub(super) fn complete(&self) -> &ContactSeries {
        self.complete.get_or_init(|| {
            let (coefficient, friction) = with_fused_multiply_add(FrictionOf(self));
            Box::new(ContactSeries { friction, coefficient, ..self.contact.clone() })
        })
    }

    /// T at slip velocities of the piece, and at the loads there.
    #[inline(always)]
    pub(super) fn frictions_at<const N: usize>(
        &self,
        slips: &[f64; N],
        loads: &[f64; N],
    ) -> [f64; N] {
        let mut law = self.law.borrow_mut();
        let one = self.unit.recip();
        let mut forces = *loads;
        for (force, slip) in forces.iter_mut().zip(slips) {
            let [coefficient] = law.along(self.sign, &[one * slip]);
            *force *= coefficient;
        }
        forces
    }
}

struct StatesOf<'p, 'a>(&'p MassPiece<'a>);

impl Work for StatesOf<'_, '_> {
    type Output = MassStates;

    #[inline(always)]
    fn run(self) -> MassStates {
        let MassPiece { mass, raw, unit, rates, contact, .. } = self.0;
        let (length, direction) = (unit * mass.displacement(), -mass.direction() / mass.tangent());
        let mut states = [0.0; (ORDER + 1) * SIZE];
        let series = raw.0.iter().zip(rates.iter()).zip(&contact.slip);
        for (state, ((x, rate), slip)) in states.as_chunks_mut::<SIZE>().0.iter_mut().zip(series) {
            *state = [length * x * rate, direction * slip];
        }
        states[0] += mass.shift() * mass.displacement();
        states[1] = -direction * (contact.surface[0] - contact.slip[0]);
        states
    }
}

struct FrictionOf<'p, 'a>(&'p MassPiece<'a>);

impl Work for FrictionOf<'_, '_> {
    type Output = (Series, Series);

    #[inline(always)]
    fn run(self) -> (Series, Series) {
        let MassPiece { law, sign, contact, .. } = self.0;
        // The law along the slip in the time of the system.
        let coefficient = law.borrow_mut().along(*sign, &contact.scaled);
        let load = &contact.load;
        if load[1..].iter().all(|term| *term == 0.0) {
            return (coefficient, coefficient.map(|term| load[0] * term));
        }
        let mut friction = [0.0; ORDER + 1];
        for (k, force) in friction.iter_mut().enumerate() {
            let terms = coefficient[..=k].iter().zip(load[..=k].iter().rev());
            *force = terms.fold(0.0, |sum, (a, b)| f64::mul_add(*a, *b, sum));
        }
        (coefficient, friction)
    }
}
