//! Results that are costly to compute from the numbers of a study: they are kept where these numbers stay.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// The largest number of results that are kept: a study has few, and one that is changed again and again must not grow.
const MOST: usize = 32;

/// Results of earlier readings, each of which knows the numbers that it was computed from.
#[derive(Clone, Default)]
pub(super) struct Computed {
    results: Vec<Arc<dyn Any + Send + Sync>>,
}

impl Computed {
    /// The result of a type that was computed from the same numbers, or else a new one.
    ///
    /// # Errors
    /// Those of `compute`.
    pub(super) fn get<C: Send + Sync + 'static, E>(
        &mut self,
        same: impl Fn(&C) -> bool,
        compute: impl FnOnce() -> Result<C, E>,
    ) -> Result<Arc<C>, E> {
        match self.known(same) {
            Some(known) => Ok(known),
            None => Ok(self.keep(compute()?)),
        }
    }

    /// The result of a type that was computed from the same numbers.
    pub(super) fn known<C: Send + Sync + 'static>(
        &self,
        same: impl Fn(&C) -> bool,
    ) -> Option<Arc<C>> {
        let known = self.results.iter().find(|known| known.downcast_ref().is_some_and(&same))?;
        Arc::clone(known).downcast().ok()
    }

    /// Keeps a new result.
    pub(super) fn keep<C: Send + Sync + 'static>(&mut self, made: C) -> Arc<C> {
        let made = Arc::new(made);
        if self.results.len() == MOST {
            self.results.remove(0);
        }
        self.results.push(Arc::clone(&made) as Arc<dyn Any + Send + Sync>);
        made
    }
}

/// Equal studies may have computed different results.
impl PartialEq for Computed {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl fmt::Debug for Computed {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("Computed").field(&self.results.len()).finish()
    }
}
