//! Where the law of a contact is read from.

/// The table of a law: where it is, and what the laws of a study have in common.
#[derive(Clone, Copy)]
pub(in crate::study) struct LawPlace<'a> {
    /// Path of the table, such as `contact.friction`.
    pub(in crate::study) path: &'a str,
    /// The normal load in the numbers of the equations, where it is given and right; friction that is given as forces needs none.
    pub(in crate::study) normal_load: Option<f64>,
    /// Whether a coefficient may be negative, of a surface that moves in the other direction.
    pub(in crate::study) may_be_reversed: bool,
}
