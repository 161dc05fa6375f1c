//! Envelopes: an oscillation too fast to be resolved in the figure is drawn as the band between its extremes.
//!
//! Strokes closer to each other than about their own width merge, and what remains visible is an interference of the
//! oscillation with the pixels (moiré). Where a curve swings more often than that, the band between its upper and its lower
//! extremes is what the eye can take from it.

use super::geometry::PlotPoint;
use super::palette::{Colour, PlotRole};

/// Largest distance along x between an extreme and the next for which the strokes merge (pixels).
const MERGING: f64 = 2.2;
/// Least height of a swing that makes a band; a smaller one is hidden by the width of the stroke (pixels).
const LEAST_SWING: f64 = 3.0;
/// Least number of successive swings that make a band.
const LEAST_COUNT: usize = 8;

/// Opacity of a band of this colour: that of the response without dither is much paler, so that two bands differ in grey.
pub(super) fn band_opacity(colour: Colour) -> f64 {
    if colour == PlotRole::Undithered.colour() { 0.25 } else { 0.55 }
}

/// A part of a curve as it is drawn (pixels).
#[derive(Debug, Clone, PartialEq)]
pub(super) enum CurveTrace {
    /// A stroke.
    Line(Vec<PlotPoint>),
    /// The band between two curves, both from left to right.
    Band {
        /// Through the upper extremes.
        upper: Vec<PlotPoint>,
        /// Through the lower extremes.
        lower: Vec<PlotPoint>,
    },
}

/// Splits a curve into strokes and bands. A curve that reverses in x is one stroke.
pub(super) fn traces(points: &[PlotPoint]) -> Vec<CurveTrace> {
    if points.windows(2).any(|pair| pair[1].x < pair[0].x) {
        return vec![CurveTrace::Line(points.to_vec())];
    }
    let extremes = extremes(points);
    let mut traces = Vec::new();
    let mut drawn = 0;
    for (from, to) in dense_runs(points, &extremes) {
        let (first, last) = (extremes[from], extremes[to]);
        if first > drawn {
            traces.push(CurveTrace::Line(points[drawn..=first].to_vec()));
        }
        traces.push(band(points, &extremes[from..=to]));
        drawn = last;
    }
    if drawn + 1 < points.len() || traces.is_empty() {
        traces.push(CurveTrace::Line(points[drawn..].to_vec()));
    }
    traces
}

/// Indices of the points at which the curve turns from rising to falling or back, with both ends. Reversals by less than
/// [`LEAST_SWING`] are passed over.
fn extremes(points: &[PlotPoint]) -> Vec<usize> {
    let mut found = vec![0];
    // The lowest and the highest point since the last extreme.
    let (mut lowest, mut highest) = (0, 0);
    let mut rising: Option<bool> = None;
    for (index, point) in points.iter().enumerate() {
        if point.y < points[lowest].y {
            lowest = index;
        }
        if point.y > points[highest].y {
            highest = index;
        }
        let has_risen = point.y - points[lowest].y >= LEAST_SWING;
        let has_fallen = points[highest].y - point.y >= LEAST_SWING;
        let turned = match rising {
            None if has_risen || has_fallen => Some((has_risen, None)),
            Some(true) if has_fallen => Some((false, Some(highest))),
            Some(false) if has_risen => Some((true, Some(lowest))),
            _ => None,
        };
        if let Some((up, extreme)) = turned {
            found.extend(extreme.filter(|extreme| *extreme > 0));
            rising = Some(up);
            (lowest, highest) = (index, index);
        }
    }
    if points.len() > 1 && found.last() != Some(&(points.len() - 1)) {
        found.push(points.len() - 1);
    }
    found
}

/// Ranges of extremes (first and last) between which every swing merges with its neighbours.
fn dense_runs(points: &[PlotPoint], extremes: &[usize]) -> Vec<(usize, usize)> {
    let merges: Vec<bool> = extremes
        .windows(2)
        .map(|pair| {
            let (from, to) = (points[pair[0]], points[pair[1]]);
            to.x - from.x < MERGING
        })
        .collect();
    let mut runs = Vec::new();
    let mut from = 0;
    for run in merges.chunk_by(|one, other| one == other) {
        if run[0] && run.len() >= LEAST_COUNT {
            runs.push((from, from + run.len()));
        }
        from += run.len();
    }
    runs
}

/// The band between the upper and the lower ones of these extremes, which alternate; the first and the last belong to both sides.
fn band(points: &[PlotPoint], extremes: &[usize]) -> CurveTrace {
    let found: Vec<PlotPoint> = extremes.iter().map(|&index| points[index]).collect();
    let side = |is_outer: fn(f64, f64) -> bool| -> Vec<PlotPoint> {
        let on_side = |&index: &usize| match index {
            0 => true,
            _ => index + 1 == found.len() || is_outer(found[index].y, found[index - 1].y),
        };
        (0..found.len()).filter(on_side).map(|index| found[index]).collect()
    };
    // Pixels grow downwards.
    CurveTrace::Band { upper: side(|one, last| one < last), lower: side(|one, last| one > last) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In grey, a band of the response with dither is darker than one without by more than a fifth of the range.
    #[test]
    fn bands_with_and_without_dither_differ_in_grey() {
        let grey = |role: PlotRole| {
            let (red, green, blue) = role.colour();
            let light = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
            255.0 - band_opacity(role.colour()) * (255.0 - light)
        };
        let [with, without] = [PlotRole::Dithered, PlotRole::Undithered].map(grey);
        assert!(without - with > 55.0, "{with} {without}");
    }

    fn wave(length: f64, height: f64) -> Vec<PlotPoint> {
        (0..4000)
            .map(|step| {
                let x = 0.1 * f64::from(step);
                PlotPoint::new(x, 100.0 - height * (std::f64::consts::TAU * x / length).sin())
            })
            .collect()
    }

    #[test]
    fn a_slow_oscillation_is_a_stroke() {
        let points = wave(9.0, 50.0);
        assert_eq!(traces(&points), [CurveTrace::Line(points.clone())]);
    }

    #[test]
    fn a_fast_oscillation_is_the_band_between_its_extremes() {
        let points = wave(2.0, 50.0);
        let bands: Vec<_> = traces(&points)
            .into_iter()
            .filter_map(|trace| match trace {
                CurveTrace::Band { upper, lower } => Some((upper, lower)),
                CurveTrace::Line(_) => None,
            })
            .collect();
        let [(upper, lower)] = bands.as_slice() else { panic!("{} bands", bands.len()) };
        let inner = |side: &[PlotPoint], level: f64| {
            side[2..side.len() - 2].iter().all(|point| (point.y - level).abs() < 1.0)
        };
        assert!(inner(upper, 50.0) && inner(lower, 150.0), "{upper:?} {lower:?}");
        assert!(upper[0].x < 2.0 && upper[upper.len() - 1].x > 398.0);
    }

    #[test]
    fn a_fast_ripple_on_a_slow_motion_follows_it() {
        let points: Vec<PlotPoint> = (0..4000)
            .map(|step| {
                let x = 0.1 * f64::from(step);
                PlotPoint::new(x, 100.0 + 60.0 * (0.02 * x).sin() + 10.0 * (4.0 * x).sin())
            })
            .collect();
        for trace in traces(&points) {
            if let CurveTrace::Band { upper, lower } = trace {
                let off = |side: &[PlotPoint], offset: f64| {
                    // The first and the last swing are not complete.
                    side[2..side.len() - 2]
                        .iter()
                        .map(|PlotPoint { x, y }| {
                            (y - 100.0 - 60.0 * (0.02 * x).sin() - offset).abs()
                        })
                        .fold(0.0, f64::max)
                };
                assert!(off(&upper, -10.0) < 3.0 && off(&lower, 10.0) < 3.0);
                return;
            }
        }
        panic!("no band");
    }

    #[test]
    fn the_ends_of_strokes_and_bands_meet() {
        let mut points = wave(30.0, 40.0);
        let shift = 400.0;
        points.extend(
            wave(2.0, 40.0).into_iter().map(|PlotPoint { x, y }| PlotPoint::new(x + shift, y)),
        );
        points.extend(
            wave(30.0, 40.0)
                .into_iter()
                .map(|PlotPoint { x, y }| PlotPoint::new(x + 2.0 * shift, y)),
        );
        let found = traces(&points);
        assert_eq!(found.len(), 3);
        let ends = |trace: &CurveTrace| match trace {
            CurveTrace::Line(points) => (points[0].x, points[points.len() - 1].x),
            CurveTrace::Band { upper, .. } => (upper[0].x, upper[upper.len() - 1].x),
        };
        for pair in found.windows(2) {
            assert_eq!(ends(&pair[0]).1, ends(&pair[1]).0);
        }
    }

    #[test]
    fn a_loop_is_a_stroke() {
        let points: Vec<PlotPoint> = (0..900)
            .map(|step| 0.5 * f64::from(step))
            .map(|angle: f64| PlotPoint::new(50.0 * angle.cos(), 50.0 * angle.sin()))
            .collect();
        assert_eq!(traces(&points).len(), 1);
    }
}
