//! Eigenvalues of steady sliding followed over a parameter: merging frequencies, and the thresholds of stability.
//!
//! The eigenvalues at neighbouring values of the parameter are matched with a prediction from the last step. Where a match is not
//! certain, the step is halved: near a close approach of two eigenvalues the steps are as short as the approach requires, down
//! to a coalescence, where the two cannot be distinguished. Where two eigenvalues pass each other between two points, further
//! points are inserted at the width of the range in which their coupling acts (`approach.rs`). Thresholds are located by root finding on the largest growth rate, not
//! on the grid.

mod approach;
mod coalescence;
mod family;
mod matching;
mod thresholds;

use approach::Search;
use family::at;
pub use family::{Family, TrackedPoint};
use quell_numerics::interval::RealInterval;
use quell_numerics::order::{ascending, ascending_by};
pub use thresholds::{StabilityChange, ThresholdOfStability};

/// Shortest step over the width of the window: below it two eigenvalues count as one.
const SHORTEST: f64 = 1e-12;

/// Distance over the width of the window from a value without a matrix at which the eigenvalues are computed first: far above the
/// error of that value, so that both are on their sides of it. A threshold closer to it is missed.
const NEXT_TO_A_GAP: f64 = 1e-9;

/// Most values of the parameter at which eigenvalues are computed, for each requested point: every close approach halves a
/// step some forty times.
const MOST_VALUES_PER_POINT: usize = 64;

/// Passes over a piece in search of close approaches: the points of one pass can reveal further ones.
const MOST_PASSES: usize = 3;

/// A range of the parameter without an answer.
#[derive(Clone, Debug, PartialEq)]
pub struct UnknownRange<E> {
    /// First value without.
    pub from: f64,
    /// Last value without.
    pub to: f64,
    /// Why.
    pub why: E,
}

/// Eigenvalues over a window of a parameter.
#[derive(Clone, Debug)]
pub struct Tracked<E> {
    /// Pieces of the window, ascending; between two pieces there is no steady sliding.
    pub pieces: Vec<Vec<TrackedPoint>>,
    /// The ranges between the pieces.
    pub unknown: Vec<UnknownRange<E>>,
    /// Values at which the verdict changes or two eigenvalues coalesce, ascending.
    pub thresholds: Vec<ThresholdOfStability>,
    /// Close approaches of two eigenvalues that were not examined, because there were too many: thresholds may be missing there.
    pub unexamined: usize,
}

/// Follows the eigenvalues of a family over a window, on at least `points` values.
///
/// # Errors
/// The reason at the first value, if no value of the window has eigenvalues.
pub fn track<F: Family>(
    family: &F,
    window: RealInterval,
    points: usize,
) -> Result<Tracked<F::Error>, F::Error> {
    let RealInterval { lower: from, upper: to } = window;
    let count = points.max(2);
    let share = |k: usize| k as f64 / (count - 1) as f64;
    let mut grid: Vec<f64> = (0..count)
        .map(|k| if k + 1 == count { to } else { from + (to - from) * share(k) })
        .collect();
    let aside = NEXT_TO_A_GAP * (to - from).abs();
    let mut gaps = family.gaps();
    gaps.retain(|(gap, _)| *gap > from + aside && *gap < to - aside);
    grid.retain(|value| gaps.iter().all(|(gap, _)| (value - gap).abs() > aside));
    grid.extend(gaps.iter().flat_map(|(gap, _)| [gap - aside, gap + aside]));
    ascending(&mut grid);
    let mut gaps = gaps.into_iter().peekable();
    let mut is_gap = false;
    let mut pieces: Vec<Vec<TrackedPoint>> = Vec::new();
    let mut unknown: Vec<UnknownRange<F::Error>> = Vec::new();
    let mut piece: Vec<TrackedPoint> = Vec::new();
    for &value in &grid {
        while let Some((gap, why)) = gaps.next_if(|(gap, _)| *gap < value) {
            // Inside a range without an answer a gap is part of it.
            if !piece.is_empty() {
                unknown.push(UnknownRange { from: gap, to: gap, why });
                pieces.push(std::mem::take(&mut piece));
                is_gap = true;
            }
        }
        match at(family, value) {
            Ok(point) => piece.push(point),
            Err(why) => {
                match unknown.last_mut() {
                    Some(range) if piece.is_empty() && !is_gap => range.to = value,
                    _ => unknown.push(UnknownRange { from: value, to: value, why }),
                }
                is_gap = false;
                if !piece.is_empty() {
                    pieces.push(std::mem::take(&mut piece));
                }
            }
        }
    }
    if !piece.is_empty() {
        pieces.push(piece);
    }
    if let (true, Some(range)) = (pieces.is_empty(), unknown.first()) {
        return Err(range.why.clone());
    }
    let most = count * MOST_VALUES_PER_POINT;
    let shortest = SHORTEST * (to - from).abs();
    let mut thresholds = Vec::new();
    let mut unexamined = 0;
    for piece in &mut pieces {
        let mut search = Search::new(family, shortest, most);
        *piece = matching::followed(family, std::mem::take(piece), shortest, most);
        for _ in 0..MOST_PASSES {
            let further = search.points(piece);
            if further.is_empty() {
                break;
            }
            piece.extend(further);
            ascending_by(piece, |a| a.value);
            *piece = matching::followed(family, std::mem::take(piece), shortest, most);
        }
        unexamined += search.unexamined;
        thresholds.extend(thresholds::of_piece(family, piece)?);
    }
    ascending_by(&mut thresholds, |a| a.value);
    Ok(Tracked { pieces, unknown, thresholds, unexamined })
}
