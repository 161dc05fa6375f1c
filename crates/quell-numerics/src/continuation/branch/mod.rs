//! A branch of fixed points in one parameter, by pseudo-arclength: around folds, through borders of signatures.
//!
//! On one smooth piece the step is adapted to the bend of the branch: a corrected point may lie no further from the
//! predicted one than a share of the step, and the tangent may not turn by more than about 25°. That is the test of
//! nearness which keeps the run from stepping onto another branch. Thresholds are sign changes of test functions,
//! located on the hyperplanes between two points; a pair of sign changes between two points is found where the test function dips
//! between its neighbours.
//!
//! At a touch the branch may go on with another signature, turn back with it, or end. What lies beyond is looked
//! for at distances that grow from very small ones, and believed where the state comes to the touch as the parameter
//! does: continuity, not convergence alone.

mod follow;
mod parameter_window;
mod points;
mod run;
mod special_points;

pub use follow::{Followed, follow};
pub use parameter_window::Follow;
pub use points::{BranchSide, ContinuationPoint, End, FixedPointBranch, SpecialPoint};
