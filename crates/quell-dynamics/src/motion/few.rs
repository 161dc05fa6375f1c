//! Lists of the contacts of a moment: events of systems with few contacts need no memory but the stack.

use smallvec::SmallVec;

/// A list that lies on the stack while it has at most four entries.
pub(super) type Few<T> = SmallVec<[T; 4]>;
