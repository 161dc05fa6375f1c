//! StudyParts of a study that were read before.
//!
//! A run assembles a study at hundreds of values of one number. Only the table that gives this number is read again, and what depends on
//! it: the other parts are those of the study.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use quell_input::document::Table;

use super::{NumbersByName, Reader, StudyUnits};

/// What the tables of a valid study gave.
#[derive(Clone, Default)]
pub(in crate::study) struct StudyParts {
    kept: Arc<Vec<Arc<dyn Any + Send + Sync>>>,
    /// Whether they stand for tables that did not change, as opposed to being gathered.
    stand_in: bool,
}

impl StudyParts {
    /// The same parts, to be taken where their tables did not change.
    pub(in crate::study) fn to_reuse(&self) -> Self {
        Self { stand_in: true, ..self.clone() }
    }
}

/// What a table gave, and all that it was read by.
struct StudyPart<E, T> {
    table: Table,
    units: StudyUnits,
    named: NumbersByName,
    environment: E,
    read: T,
}

impl Reader {
    /// Reads a table, whose meaning depends on nothing but the units, the named numbers and its environment; or takes what the study gave,
    /// where none of these changed.
    pub(in crate::study) fn part<E, T>(
        &mut self,
        table: &Table,
        environment: E,
        read: impl FnOnce(&mut Self) -> Option<T>,
    ) -> Option<T>
    where
        E: PartialEq + Send + Sync + 'static,
        T: Clone + Send + Sync + 'static,
    {
        let same = |part: &&StudyPart<E, T>| {
            part.table.is_same(table)
                && part.units == self.units
                && part.named == self.named
                && part.environment == environment
        };
        if self.parts.stand_in {
            let mut known = self.parts.kept.iter().filter_map(|part| part.downcast_ref());
            if let Some(part) = known.find(same) {
                return Some(part.read.clone());
            }
            return read(self);
        }
        let before = self.complaints_so_far();
        let read = read(self)?;
        if self.complaints_so_far() == before {
            let part = StudyPart {
                table: table.clone(),
                units: self.units,
                named: self.named.clone(),
                environment,
                read: read.clone(),
            };
            Arc::make_mut(&mut self.parts.kept).push(Arc::new(part));
        }
        Some(read)
    }
}

/// Studies are equal by what they say, not by how they were read.
impl PartialEq for StudyParts {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for StudyParts {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("StudyParts").field(&self.kept.len()).finish()
    }
}
