//! Contacts with a state of their own, one number each, which follows the states of the structure.
//!
//! * An elastic slider has the state T. It adheres, Ṫ = k_t γ, while |T| < max(μ_s, μ(|γ|))N; it slides at T = sμ(|γ|)N, s = ±1, and
//!   adheres again where its own speed γ − Ṫ/k_t reaches zero: γ alone does not end a slip under a load that varies. The level μ(|γ|)
//!   counts where the law rises above its static level (a viscous part), because the force of a spring does not jump up. An adhering
//!   slider is a spring; only a rigid contact is held by a force that is sought. Jenkins (1962), Iwan (1966).
//! * Bristles have the state z: ż = γ − σ₀|γ|z/g(γ), T = N(σ₀z + σ₁ż + σ₂γ). They never stick; each sign change of γ is an event,
//!   because |γ| has a kink there. Canudas de Wit et al. (1995).
//!
//! An open contact has neither T nor z: it lands with both at zero.
//!
//! In both, T of one order follows from γ and N of that order, so that the series of a step stays explicit. In a slip the number of an
//! elastic slider has no rate of its own: its series is that of T.

use quell_linear::steady::SteadyContact;
use quell_model::friction::FrictionConstants;
use quell_model::{Contact, Friction};

use super::phase::{ContactNow, ContactPhase, ElasticNow, OwnNow};
use crate::simulation::ORDER;

/// The state of a contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct OwnState {
    /// Its place in the state.
    pub(super) place: usize,
    pub(super) kind: OwnStateKind,
}

/// What the state of a contact is.
#[derive(Clone, Copy, Debug)]
pub(super) enum OwnStateKind {
    /// T of an elastic slider.
    Elastic {
        /// k_t.
        stiffness: f64,
    },
    /// z of bristles.
    Bristles {
        /// σ₀, σ₁ and σ₂.
        stiffness: f64,
        damping: f64,
        viscous: f64,
    },
}

impl OwnState {
    /// That of a contact; `None` of a rigid one with a law of γ alone.
    pub(super) fn of(contact: &Contact, place: usize) -> Option<Self> {
        // Bristles are elastic themselves: a spring in series with them is left to the structure.
        let kind = if let Some(bristles) = contact.friction.bristles() {
            OwnStateKind::Bristles {
                stiffness: bristles.stiffness,
                damping: bristles.damping,
                viscous: bristles.viscous,
            }
        } else {
            OwnStateKind::Elastic { stiffness: contact.tangential_stiffness? }
        };
        Some(Self { place, kind })
    }

    /// A contact with this state that does this.
    pub(super) fn now(self, phase: ContactPhase) -> ContactNow {
        let own = match self.kind {
            OwnStateKind::Elastic { .. } => {
                OwnNow::Elastic(ElasticNow { branch: phase.slip_sign(), ..ElasticNow::default() })
            }
            OwnStateKind::Bristles { .. } => OwnNow::Bristles,
        };
        ContactNow { own, ..ContactNow::of(phase) }
    }

    /// Whether the state is the deflection of bristles.
    pub(super) fn is_bristle(self) -> bool {
        matches!(self.kind, OwnStateKind::Bristles { .. })
    }
}

/// The state of a contact in steady sliding; `None` of a contact without one.
pub(crate) fn in_steady_sliding(contact: &Contact, steady: &SteadyContact) -> Option<f64> {
    let own = OwnState::of(contact, 0)?;
    Some(match own.kind {
        OwnStateKind::Elastic { .. } => steady.friction * steady.factor,
        OwnStateKind::Bristles { stiffness, viscous, .. } => {
            let slip = contact.surface_velocity.mean();
            (steady.friction / steady.normal_load - viscous * slip) / stiffness
        }
    })
}

/// The law in the engine: that of a contact's slip, or the level of its bristles.
pub(super) fn law_of(friction: &Friction) -> FrictionConstants {
    match friction {
        Friction::Lugre(law) => FrictionConstants::of(&Friction::StribeckExponential(law.level())),
        law => FrictionConstants::of(law),
    }
}

/// Series of a contact with a state of its own.
#[derive(Clone, Debug)]
pub(super) struct OwnSeries {
    /// T of an elastic slider where the step begins, from before its slip began or its load jumped.
    pub(super) carried: f64,
    /// z.
    pub(super) deflection: [f64; ORDER + 1],
    /// γ over the signed level: |γ|/g.
    pub(super) turnover: [f64; ORDER + 1],
    /// T/N.
    pub(super) share: [f64; ORDER + 1],
}

impl OwnSeries {
    pub(super) fn zero() -> Self {
        let zeros = [0.0; ORDER + 1];
        Self { carried: 0.0, deflection: zeros, turnover: zeros, share: zeros }
    }
}
