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
        let of_type = |known: &Arc<dyn Any + Send + Sync>| Arc::clone(known).downcast::<C>().ok();
        let known = self.results.iter().filter_map(of_type).find(|known| same(known));
        if let Some(known) = known {
            return Ok(known);
        }
        let made = Arc::new(compute()?);
        if self.results.len() == MOST {
            self.results.remove(0);
        }
        self.results.push(Arc::clone(&made) as Arc<dyn Any + Send + Sync>);
        Ok(made)
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
