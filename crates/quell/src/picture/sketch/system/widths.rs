//! Widths that bodies and their grid share.

/// Room between two boxes, for springs, forces and ends of links.
pub(super) const GAP: f64 = 39.0;

/// Width of the box of a state.
pub(super) fn state_width(room: f64) -> f64 {
    (room - 2.0 * GAP - 6.0).min(300.0)
}
