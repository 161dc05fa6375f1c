//! The line of zero growth over speed and friction, exact at every point that is drawn.
//!
//! Marching squares say between which two neighbours of the grid the growth rate changes its sign; its root between them is then
//! computed with the growth rate itself. What the grid does not resolve, the narrow tips of tongues, it is given points for:
//! every interval of growth is followed down to a small friction, and its centre and edges join the speeds
//! ([`speeds_of_tongues`]).

use std::ops::RangeInclusive;

use quell::complaint::Failure;
use quell::parallel::Parallel;
use quell::plot::{PlotPoint, isolines};
use quell_disc::resonance::{Resonance, Waves};
use quell_model::Disc;
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending;
use quell_numerics::roots::{Closeness, try_find_root};

use super::growth::{DiscGrowth, Growths};

/// Ratio of the frictions at which an interval of growth is followed. The width of a tongue is proportional to friction, so that its
/// former centre is inside the next interval for any ratio above one half; below that a leaning tongue could be lost.
const FRICTION_RATIO: f64 = 0.65;
/// An interval of growth wider than this fraction of its speed is resolved by the grid.
const WIDE: f64 = 0.1;
/// Relative accuracy of a root in speed or friction. The slope of the rate at the tip of a tongue is large: with 1e-7 the rate at a
/// point there is not yet small compared with the rates next to it.
const CLOSENESS: Closeness = Closeness { absolute: 0.0, relative: 1e-11 };
/// Speeds closer than this fraction of the highest one are one: far below the narrowest tongue that is followed.
const SAME_SPEED: f64 = 1e-9;

/// The lines on which the growth rate is zero.
pub(super) fn zero_lines(
    source: &str,
    growths: &Growths,
    disc: &Disc,
) -> Result<Vec<Vec<PlotPoint>>, Failure> {
    let (speeds, frictions) = (&growths.speeds, &growths.frictions);
    let rows = frictions.len();
    let values: Vec<Option<f64>> = (0..rows)
        .flat_map(|row| (0..speeds.len()).map(move |column| column * rows + row))
        .map(|index| Some(growths.values[index].rate))
        .collect();
    let lines = isolines(speeds, frictions, &values, 0.0);
    let exact = lines.into_iter().map(|line| {
        line.points.in_parallel(|&point| refined(source, growths, disc, point)).collect()
    });
    exact.collect()
}

/// The root next to a point (speed, friction) that marching squares have interpolated on an edge of the grid.
fn refined(
    source: &str,
    growths: &Growths,
    disc: &Disc,
    point: PlotPoint,
) -> Result<PlotPoint, Failure> {
    let PlotPoint { x: speed, y: friction } = point;
    let neighbours = |values: &[f64], at: f64| {
        let above = values.partition_point(|value| *value < at).clamp(1, values.len() - 1);
        (values[above - 1], values[above])
    };
    if growths.speeds.contains(&speed) {
        let prepared = DiscGrowth::at(source, disc, speed)?;
        let (below, above) = neighbours(&growths.frictions, friction);
        let rate = |friction: f64| Ok::<f64, Failure>(prepared.growth(source, friction)?.rate);
        let found = try_find_root(rate, below, above, CLOSENESS)?;
        // Without a change of sign (a rate of exactly zero at a point of the grid) the interpolated point is that root.
        return Ok(found.map_or(point, |root| PlotPoint::new(speed, root.location)));
    }
    let (below, above) = neighbours(&growths.speeds, speed);
    let found =
        try_find_root(|speed| rate(source, disc, speed, friction), below, above, CLOSENESS)?;
    Ok(found.map_or(point, |root| PlotPoint::new(root.location, friction)))
}

/// The speeds of a grid, and the centres and edges of the tongues between the highest and the lowest friction.
pub(super) fn speeds_of_tongues(
    source: &str,
    disc: &Disc,
    speeds: Vec<f64>,
    RealInterval { lower: lowest, upper: highest }: RealInterval,
) -> Result<Vec<f64>, Failure> {
    let (Some(&first), Some(&last)) = (speeds.first(), speeds.last()) else { return Ok(speeds) };
    let mut all = speeds;
    let mut intervals = vec![RealInterval::new(first, last)];
    let mut friction = highest;
    while friction >= lowest && !intervals.is_empty() {
        all.extend(predicted(disc, friction, first..=last));
        sort(&mut all, last);
        intervals = growing(source, disc, &all, &intervals, friction)?;
        let narrow = intervals.iter().filter(|interval| interval.width() < WIDE * interval.upper);
        all.extend(narrow.flat_map(|interval| [interval.lower, interval.middle(), interval.upper]));
        friction *= FRICTION_RATIO;
    }
    sort(&mut all, last);
    Ok(all)
}

/// Centres and edges of the tongues that theory predicts.
fn predicted(disc: &Disc, friction: f64, speeds: RangeInclusive<f64>) -> Vec<f64> {
    let Ok(waves) = Waves::new(disc) else { return Vec::new() };
    let waves = waves.with_friction(friction);
    let tongues =
        waves.undithered(speeds.clone()).into_iter().chain(waves.dithered(speeds.clone()));
    let of_tongue = |resonance: Resonance| {
        let edges = resonance.tongue.edges().into_iter().flatten();
        std::iter::once(resonance.speed).chain(edges).collect::<Vec<_>>()
    };
    tongues.flat_map(of_tongue).filter(|speed| speeds.contains(speed)).collect()
}

/// The intervals of speeds with growth at a friction, among these speeds and near the intervals at a higher friction.
fn growing(
    source: &str,
    disc: &Disc,
    speeds: &[f64],
    before: &[RealInterval],
    friction: f64,
) -> Result<Vec<RealInterval>, Failure> {
    // Tongues lean: at a lower friction one may reach beyond the interval at the higher one.
    let is_near = |speed: f64| {
        before.iter().any(|interval| {
            let margin = 0.5 * interval.width();
            speed >= interval.lower - margin && speed <= interval.upper + margin
        })
    };
    let rates: Result<Vec<Option<f64>>, Failure> = speeds
        .in_parallel(|&speed| {
            is_near(speed).then(|| rate(source, disc, speed, friction)).transpose()
        })
        .collect();
    let rates = rates?;
    let grows = |index: usize| rates[index].is_some_and(|rate| rate > 0.0);
    let mut intervals = Vec::new();
    let mut from = 0;
    let indices: Vec<usize> = (0..speeds.len()).collect();
    for run in indices.chunk_by(|one, other| grows(*one) == grows(*other)) {
        let (begin, end) = (from, from + run.len() - 1);
        from += run.len();
        if !grows(begin) {
            continue;
        }
        let edge = |inside: usize, outside: Option<usize>| -> Result<f64, Failure> {
            let Some(outside) =
                outside.filter(|index| rates.get(*index).is_some_and(Option::is_some))
            else {
                return Ok(speeds[inside]);
            };
            let at = |speed: f64| rate(source, disc, speed, friction);
            let found = try_find_root(at, speeds[inside], speeds[outside], CLOSENESS)?;
            Ok(found.map_or(speeds[inside], |root| root.location))
        };
        let lower = edge(begin, begin.checked_sub(1))?;
        intervals.push(RealInterval::new(lower, edge(end, Some(end + 1))?));
    }
    Ok(intervals)
}

fn rate(source: &str, disc: &Disc, speed: f64, friction: f64) -> Result<f64, Failure> {
    Ok(DiscGrowth::at(source, disc, speed)?.growth(source, friction)?.rate)
}

/// Sorts speeds and removes repetitions.
fn sort(speeds: &mut Vec<f64>, last: f64) {
    ascending(speeds);
    speeds.dedup_by(|one, other| (*one - *other).abs() < SAME_SPEED * last);
}

#[cfg(test)]
mod tests {
    use super::super::super::figures::FIGURES;
    use super::super::study;
    use super::*;

    #[test]
    fn every_point_of_the_line_has_zero_growth() {
        let entry = FIGURES.iter().find(|entry| entry.name == "5.9").expect("figure 5.9");
        let study = study(&entry.source(), &[]).expect("its study");
        let disc = study.disc();
        let unit = super::super::FRICTION_PER_PRINTED * 1e-4;
        let frictions: Vec<f64> = [0.002, 0.02, 0.1, 0.3, 0.8, 1.4].map(|f| f * unit).to_vec();
        let ends = RealInterval::new(frictions[0], frictions[5]);
        let grid = (1..40).map(|k| 0.025 * f64::from(k)).collect();
        let speeds = speeds_of_tongues("5.9", disc, grid, ends).expect("speeds");
        let growths =
            super::super::growth::growths("5.9", disc, speeds, frictions).expect("growth");
        let lines = zero_lines("5.9", &growths, disc).expect("lines");
        assert!(!lines.is_empty());
        // Without modal damping the tongues begin at zero friction.
        let lowest = lines.iter().flatten().map(|point| point.y).fold(f64::INFINITY, f64::min);
        assert!(lowest < 0.03 * unit, "{}", lowest / unit);
        for &PlotPoint { x: speed, y: friction } in lines.iter().flatten() {
            let growth = |speed: f64| {
                let prepared = DiscGrowth::at("5.9", disc, speed).expect("a speed");
                prepared.growth("5.9", friction).expect("growth")
            };
            let (found, below, above) =
                (growth(speed), growth(0.999 * speed), growth(1.001 * speed));
            let neighbours = below.rate.abs().max(above.rate.abs());
            assert!(
                found.rate.abs() <= 1e-4 * neighbours + found.error,
                "{speed} {friction}: {found:?}, next to it {neighbours}"
            );
        }
    }
}
