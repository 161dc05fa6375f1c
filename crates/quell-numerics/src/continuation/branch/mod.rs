//! A branch of fixed points in one parameter, by pseudo-arclength: around folds, through borders of signatures.
//!
//! On one smooth piece the step size is adapted to the curvature of the branch: the distance of a corrected point from the
//! predicted one is limited to a fraction of the step, and the tangent may not rotate by more than about 25°. This test
//! prevents the continuation run from jumping to another branch. Thresholds are sign changes of test functions,
//! located on the hyperplanes between two points; a pair of sign changes between two points is detected where the test
//! function has a dip between its neighbours.
//!
//! At a grazing point the branch may continue with another signature, turn back with it, or end. The continuation is
//! searched for at distances that grow from very small ones, and accepted if the state tends to the grazing state as the
//! parameter tends to the grazing value: continuity is required, not convergence alone. A grazing point that is approached from the
//! side with more events is located on the piece with fewer of them, extended over its border.

mod follow;
mod outside;
mod parameter_window;
mod points;
mod run;
mod special_points;

pub use follow::{Followed, follow};
pub use parameter_window::Follow;
pub use points::{BranchSide, ContinuationPoint, End, FixedPointBranch, SpecialPoint};
