//! The study of another kind whose numbers are the parameters of a system.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use quell_model::System;

use crate::complaint::Complaints;

/// A study of another kind that is answered as a system: its numbers keep their keys.
pub trait NumberedStudy: Any + fmt::Debug + Send + Sync {
    /// The number at a path, in the unit of its key; `None` where the study has no such number.
    fn number(&self, path: &str) -> Option<f64>;

    /// The unit of its key, `1` without a unit.
    fn unit_of(&self, path: &str) -> &'static str;

    /// The key of a number of the equations in the units of the study.
    fn key_of(&self, path: &str) -> String;

    /// The system with numbers set in order as by `--set`.
    ///
    /// # Errors
    /// All complaints about the changed study.
    fn system_with(&self, numbers: &[(&str, f64)]) -> Result<System, Complaints>;
}

/// Such a study, shared by the systems made of it.
#[derive(Clone, Debug)]
pub struct SystemOrigin(Arc<dyn NumberedStudy>);

impl SystemOrigin {
    /// The origin of a system.
    pub fn of(study: impl NumberedStudy + 'static) -> Self {
        Self(Arc::new(study))
    }

    /// The study.
    pub fn study(&self) -> &dyn NumberedStudy {
        &*self.0
    }

    /// The study, if it is of this kind.
    pub fn of_kind<S: NumberedStudy>(&self) -> Option<&S> {
        (self.study() as &dyn Any).downcast_ref()
    }
}

/// Systems of one study share it.
impl PartialEq for SystemOrigin {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
