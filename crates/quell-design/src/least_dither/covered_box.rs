//! A part of a box that one dither serves: what a covered range says, and the choice of its longest run of points.

use super::LimitedQuantity;
use crate::NoAnswer;
use quell_numerics::interval::RealInterval;

/// The part of a box that one dither serves.
#[derive(Clone, Debug, PartialEq)]
pub struct CoveredBox {
    /// Both ends of the coordinate of the box, which were judged as all points between them.
    pub ends: RealInterval,
    /// The amplitude.
    pub amplitude: f64,
    /// Values of the other design variables.
    pub others: Vec<f64>,
    /// Number of points of this part that were judged, each of which the dither serves.
    pub points: usize,
    /// The largest distance of two neighbouring ones.
    pub largest_gap: f64,
    /// What is known beyond each end.
    pub beyond: [BeyondCovered; 2],
}

/// What is known of a dither next to an end of the part of a box that it serves.
#[derive(Clone, Debug, PartialEq)]
pub enum BeyondCovered {
    /// The box ends there.
    BoxEnds,
    /// It is not quiet.
    Loud,
    /// It exceeds a limit.
    Exceeds(LimitedQuantity),
    /// It is unknown whether it is quiet and keeps the limits.
    Unknown(NoAnswer),
}

impl CoveredBox {
    /// Whether it is the whole box.
    pub fn is_whole(&self) -> bool {
        self.beyond.iter().all(|beyond| *beyond == BeyondCovered::BoxEnds)
    }

    pub(super) fn length(&self) -> f64 {
        self.ends.width()
    }
}

/// A dither that may serve a part of the box.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tried {
    pub(super) amplitude: f64,
    pub(super) others: Vec<f64>,
}

/// The run of ascending points that pass and reach furthest: its first and last place.
pub(super) fn longest_run(
    points: &[f64],
    passes: impl Fn(usize) -> bool,
) -> Option<(usize, usize)> {
    let mut longest: Option<(usize, usize)> = None;
    let mut since = None;
    for place in 0..=points.len() {
        if place < points.len() && passes(place) {
            since = since.or(Some(place));
        } else if let Some(first) = since.take() {
            let last = place - 1;
            let reach = |(first, last): (usize, usize)| points[last] - points[first];
            if longest.is_none_or(|known| reach((first, last)) > reach(known)) {
                longest = Some((first, last));
            }
        }
    }
    longest
}

#[cfg(test)]
mod tests {
    use super::longest_run;

    #[test]
    fn the_longest_run_is_found() {
        let points = [0.0, 1.0, 2.0, 2.5, 3.0];
        let passing =
            |list: &'static [bool]| longest_run(&points[..list.len()], |place| list[place]);
        assert_eq!(passing(&[true, true, false, true, true]), Some((0, 1)));
        assert_eq!(passing(&[false, true, true, true, false]), Some((1, 3)));
        assert_eq!(passing(&[true, true]), Some((0, 1)));
        assert_eq!(passing(&[false]), None);
    }
}
