//! What a quantity of a map is: its name, what it needs of a study, and its variables.

use std::any::TypeId;

use quell_model::units::Quantity;

use super::points::{ChunkPoints, PointComputation, PointValue, Subject};
use crate::cite::Task;
use crate::needs::Needs;
use crate::status::Status;

/// The kind of the values of a variable, in the units of the study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    /// Numbers of a quantity.
    Number(Quantity),
    /// Rates of motions and their angular frequencies.
    Rate,
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
    /// Statuses besides the common ones.
    pub statuses: &'static [Status],
    /// Its values at the points of a chunk.
    pub(super) read: fn(&ChunkPoints<'_>) -> Vec<PointValue>,
}

impl Variable {
    /// Every status it can have, in the order of the codes.
    pub fn all_statuses(&self) -> Vec<Status> {
        let common = [Status::Known, Status::InvalidStudy, Status::NotFinite, Status::Missing];
        let mut all = [&common, self.statuses].concat();
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
    /// What it needs of a study.
    pub needs: Needs,
    /// The variables that it provides.
    pub variables: &'static [Variable],
    /// The task whose sources are those of its computation.
    pub(crate) task: Task,
    /// The computation that its variables read.
    pub(super) computation: fn() -> TypeId,
    /// Estimated seconds of one point of that computation.
    pub(super) seconds: fn(&Subject) -> f64,
}

impl PartialEq for MapQuantity {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl MapQuantity {
    /// A quantity whose variables read one computation.
    pub(super) const fn of<T: PointComputation>(
        name: &'static str,
        about: &'static str,
        needs: Needs,
        variables: &'static [Variable],
    ) -> Self {
        Self {
            name,
            about,
            needs,
            variables,
            task: T::TASK,
            computation: TypeId::of::<T>,
            seconds: T::seconds,
        }
    }
}

/// A variable with its name and symbol.
pub(super) const fn variable(
    (name, symbol): (&'static str, &'static str),
    about: &'static str,
    kind: VariableKind,
    statuses: &'static [Status],
    read: fn(&ChunkPoints<'_>) -> Vec<PointValue>,
) -> Variable {
    Variable { name, about, symbol, kind, statuses, read }
}

/// Words of a verdict; the first is 0, so that a verdict is 1 if sliding is stable.
pub(super) const VERDICTS: VariableKind =
    VariableKind::Word { words: &["unstable", "stable"], unknown: "undecided" };

pub(super) const RATIO: VariableKind = VariableKind::Number(Quantity::Ratio);
pub(super) const LENGTH: VariableKind = VariableKind::Number(Quantity::Displacement);
pub(super) const FORCE: VariableKind = VariableKind::Number(Quantity::Force);

/// Statuses of averages, their amplitudes included, other than known.
pub(super) const OF_AVERAGES: &[Status] = &[
    Status::BeyondRange,
    Status::WithoutState,
    Status::Opens,
    Status::SetValued,
    Status::TooManyGroups,
    Status::NotFast,
    Status::NotConverged,
    Status::NoSteadySliding,
    Status::Resonance,
    Status::FrictionFactor,
    Status::NoAverageOfWaveform,
    Status::NotOneMass,
    // Of verdicts.
    Status::WithinError,
    Status::AtCorner,
    // Of amplitudes.
    Status::NoDither,
    Status::NeverChanges,
    Status::ChangesOnce,
];
