//! What `[friction]` gives.

use std::sync::Arc;

use quell_model::Friction;

use super::measured::Measured;

/// A law as `[friction]` gives it.
pub(in crate::study) struct ReadLaw {
    /// The law.
    pub(in crate::study) law: Friction,
    /// The samples that it was fitted to.
    pub(in crate::study) measured: Option<Arc<Measured>>,
    /// The normal load F of friction in newtons where the study gives none.
    pub(in crate::study) own_load: Option<f64>,
}

impl ReadLaw {
    pub(super) fn of(law: Friction) -> Self {
        Self { law, measured: None, own_load: None }
    }
}
