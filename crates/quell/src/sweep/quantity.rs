//! The quantities that a map can show, each a value in the file of its kind of study (`belt.rs`, `disc.rs`, `system.rs`).
//!
//! A quantity is requested by its name; it lists the computation that it needs and the variables that it provides.
//! Quantities with the same computation share it.

use quell_linear::growth::{Growth, Verdict};
use quell_model::units;

use super::evaluate::{Computation, Results};
use super::status::Status;

/// The kind of the values of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    /// Numbers of a quantity.
    Number(units::Quantity),
    /// Rates per unit τ, in SI per second.
    Rate,
    /// Rates of a disc per unit τ = ω_ref t.
    DiscRate,
    /// Rates and angular frequencies of a system, in the units of its file.
    SystemRate,
    /// Numbers of a quantity of a system, in the units of its file.
    SystemNumber(units::Quantity),
    /// One of these words, stored as its index in the list.
    Word {
        /// The words.
        words: &'static [&'static str],
        /// The word for an unknown value.
        unknown: &'static str,
    },
}

/// One array of a map.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Its name in stores, JSON and CSV.
    pub name: &'static str,
    /// Description in one line.
    pub about: &'static str,
    /// Its symbol in the equations; empty without one.
    pub symbol: &'static str,
    /// The kind of its values.
    pub kind: VariableKind,
    /// Further statuses besides the common ones.
    pub statuses: &'static [Status],
    /// Reads its number from the results.
    pub(super) read: fn(&Results) -> Result<f64, Status>,
}

impl Variable {
    /// Its number at a point, or why it is unknown.
    pub(super) fn read(&self, results: &Results) -> Result<f64, Status> {
        let value = (self.read)(results)?;
        if value.is_finite() { Ok(value) } else { Err(Status::NotFinite) }
    }

    /// Every status it can have, in the order of the codes.
    pub fn all_statuses(&self, computation: Computation) -> Vec<Status> {
        let common = [Status::Known, Status::InvalidStudy, Status::NotFinite, Status::Missing];
        let friction = computation.meets_friction().then_some(Status::BeyondRange);
        let state = computation.is_without_state().then_some(Status::WithoutState);
        let mut all: Vec<Status> = common.into_iter().chain(friction).chain(state).collect();
        all.extend_from_slice(self.statuses);
        all.sort_unstable();
        all.dedup();
        all
    }
}

/// One quantity that a map can show.
#[derive(Clone, Copy, Debug)]
pub struct MapQuantity {
    /// Its name on the command line.
    pub name: &'static str,
    /// Description in one line.
    pub about: &'static str,
    /// The kind of study it is for, as [`crate::study::Kind::name`] gives it.
    pub kind: &'static str,
    /// The computation that it needs.
    pub computation: Computation,
    /// The variables that it provides.
    pub variables: &'static [Variable],
}

impl PartialEq for MapQuantity {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.kind == other.kind
    }
}

/// Words of a verdict; the first is 0, so that a verdict is 1 if sliding is stable.
pub(super) const VERDICTS: VariableKind =
    VariableKind::Word { words: &["unstable", "stable"], unknown: "undecided" };

/// The code of a verdict in [`VERDICTS`].
pub(super) fn decided(growth: Growth) -> Result<f64, Status> {
    match growth.verdict() {
        Verdict::Unstable => Ok(0.0),
        Verdict::Stable => Ok(1.0),
        Verdict::Undecided => Err(Status::WithinError),
    }
}

pub(super) const fn variable(
    (name, symbol): (&'static str, &'static str),
    about: &'static str,
    kind: VariableKind,
    statuses: &'static [Status],
    read: fn(&Results) -> Result<f64, Status>,
) -> Variable {
    Variable { name, about, symbol, kind, statuses, read }
}
