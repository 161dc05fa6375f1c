//! What the table of a law gives.

use std::sync::Arc;

use quell_model::Friction;

use super::measured::Measured;

/// A law as its table gives it.
#[derive(Clone)]
pub(in crate::study) struct ReadLaw {
    /// The law.
    pub(in crate::study) law: Friction,
    /// The samples that it was fitted to.
    pub(in crate::study) measured: Option<Arc<Measured>>,
    /// The normal load of friction that is given as a force, where the study gives none.
    pub(in crate::study) own_load: Option<f64>,
    /// Whether the coefficient was negative: the law is that of the positive one, for a surface that moves in the other direction.
    pub(in crate::study) reversed: bool,
}

impl ReadLaw {
    pub(super) fn of(law: Friction) -> Self {
        Self { law, measured: None, own_load: None, reversed: false }
    }
}
