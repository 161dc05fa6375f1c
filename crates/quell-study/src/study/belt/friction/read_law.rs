//! What `[friction]` gives.

use quell_model::Friction;

use super::measured::Measured;

/// A law as `[friction]` gives it.
pub(in crate::study::belt) struct ReadLaw {
    /// The law.
    pub(in crate::study::belt) law: Friction,
    /// The samples that it was fitted to.
    pub(in crate::study::belt) measured: Option<Measured>,
    /// The normal load F of friction in newtons where the study gives none.
    pub(in crate::study::belt) own_load: Option<f64>,
}

impl ReadLaw {
    pub(super) fn of(law: Friction) -> Self {
        Self { law, measured: None, own_load: None }
    }
}
