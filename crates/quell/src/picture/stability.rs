//! Stability: the criterion of one mass over the amplitude of the first dither, eigenvalues of other systems.

use quell_linear::averaging::{Averaging, criterion};
use quell_model::units::Quantity;
use quell_model::{Belt, Direction};

use super::caption::caption;
use super::ruler::Ruler;
use super::system::{frequency_axis, growth_axis};
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine, Region,
};
use crate::run::stability::{OneMassStability, SlidingStability, UnderDither};
use crate::study::{SystemStudy, UnitSystem};

/// Number of points of each interval between critical amplitudes.
const POINTS: u32 = 160;

/// The criterion of one mass over the amplitude of its first dither; of another system, and without dither, its eigenvalues.
pub fn stability(study: &SystemStudy, done: &SlidingStability) -> Figure {
    match (&done.one_mass, &done.dither) {
        (Some(one), Some(dither)) => of_one_mass(study, one, dither),
        _ => eigenvalues(study, done),
    }
}

/// One curve over the amplitude, with gaps at its jumps.
fn of_one_mass(study: &SystemStudy, one: &OneMassStability, dither: &UnderDither) -> Figure {
    let belt = one.belt();
    let critical: Vec<f64> = dither
        .critical
        .iter()
        .flatten()
        .map(|critical| critical.amplitude / one.amplitude())
        .collect();
    let own = belt.dithers().first().map_or(0.0, |dither| dither.amplitude);
    let end = last_amplitude(belt, critical.iter().copied().fold(own, f64::max));
    let force = Ruler::new(study, Quantity::Force, [one.amplitude() * end]);
    let place = |amplitude: f64| force.place(one.amplitude() * amplitude);
    let value = |amplitude: f64| {
        let changed = belt.with_amplitude(0, amplitude).ok()?;
        let found = criterion(&changed, Averaging::FiniteR).ok()?;
        Some(PlotPoint::new(place(amplitude), found.value))
    };
    let pieces = between(&critical, end, value);
    let vertical = upwards(&pieces);
    let symbol = if study.units() == UnitSystem::None { "D" } else { "A" };
    let mut panel =
        Panel::new(force.axis("dither amplitude", symbol).between(0.0, place(end)), vertical)
            .with(Region::across_y(PlotRole::Unstable, f64::NEG_INFINITY, 0.0).label("unstable"))
            .with(ReferenceLine::horizontal(0.0));
    if let Ok(found) = criterion(&belt.undithered(), Averaging::FiniteR) {
        let level = [PlotPoint::new(0.0, found.value), PlotPoint::new(place(end), found.value)];
        panel = panel.with(Polyline::new(PlotRole::Undithered, level).label("without dither"));
    }
    panel = panel.with(Polyline::pieces(PlotRole::Averaged, pieces).label("averaged"));
    if let Some(PlotPoint { x: place, y: value }) = value(own) {
        let point = Points::new(PlotRole::Dithered, [PlotPoint::new(place, value)])
            .marker(Marker::Disc)
            .size(7.0);
        panel = panel.with(point.label("this study"));
    }
    Figure::single(panel)
        .title(study.title().unwrap_or_default())
        .caption(format!("{}; by finite-R averaging.", caption(study)))
}

/// Every eigenvalue in the complex plane; under dither those without it too.
fn eigenvalues(study: &SystemStudy, done: &SlidingStability) -> Figure {
    let (frequency, factor) = frequency_axis(study, "|Im λ|");
    let places = |motions: &[quell_linear::spectrum::SmallMotion]| -> Vec<PlotPoint> {
        let upper = motions.iter().filter(|motion| motion.eigenvalue.im >= 0.0);
        upper
            .map(|motion| PlotPoint::new(motion.eigenvalue.re, factor * motion.frequency()))
            .collect()
    };
    let own = places(&done.spectrum.motions);
    let mut panel = Panel::new(growth_axis(study), frequency)
        .with(Region::across_x(PlotRole::Unstable, 0.0, f64::INFINITY).label("unstable"))
        .with(ReferenceLine::vertical(0.0));
    if let Some(dither) = &done.dither {
        let before = dither.undithered.as_ref().map(|found| places(&found.motions));
        let before = before.unwrap_or_default();
        panel = panel
            .with(
                Points::new(PlotRole::Undithered, before)
                    .marker(Marker::Circle)
                    .size(7.0)
                    .label("without dither"),
            )
            .with(
                Points::new(PlotRole::Dithered, own)
                    .marker(Marker::Disc)
                    .size(6.0)
                    .label("averaged"),
            );
    } else {
        panel = panel.with(
            Points::new(PlotRole::Undithered, own)
                .marker(Marker::Disc)
                .size(6.0)
                .label("linearised"),
        );
    }
    Figure::single(panel)
        .title(study.title().unwrap_or_default())
        .caption("Eigenvalues of small motions about steady sliding.".to_owned())
}

/// Upper limit of the amplitude axis, beyond the largest relevant amplitude.
fn last_amplitude(belt: &Belt, largest: f64) -> f64 {
    let dither = belt.dithers().first();
    let end = if largest > 0.0 {
        1.5 * largest
    } else {
        let rate = dither.map_or(1.0, |dither| dither.frequency_ratio);
        2.0 * belt.friction().velocity_scale() * rate
    };
    match dither {
        Some(dither) if dither.direction == Direction::Normal => end.min(belt.normal_load()),
        _ => end,
    }
}

/// The curve in pieces, with a gap at each critical amplitude.
fn between(
    critical: &[f64],
    end: f64,
    value: impl Fn(f64) -> Option<PlotPoint>,
) -> Vec<Vec<PlotPoint>> {
    let inside = critical.iter().copied().filter(|amplitude| *amplitude < end);
    let bounds: Vec<f64> = [0.0].into_iter().chain(inside).chain([end]).collect();
    let piece = |ends: &[f64]| {
        let inside = |k: u32| {
            // Both ends are slightly inside the interval: at a jump the value belongs to one side.
            let share = (f64::from(k) / f64::from(POINTS)).clamp(1e-9, 1.0 - 1e-9);
            ends[0] + (ends[1] - ends[0]) * share
        };
        (0..=POINTS).filter_map(|k| value(inside(k))).collect()
    };
    bounds.windows(2).map(piece).collect()
}

/// The axis of the criterion, from the lowest to a multiple of the highest minimum of a piece.
fn upwards(pieces: &[Vec<PlotPoint>]) -> PlotAxis {
    let lowest = pieces.iter().flatten().map(|point| point.y).fold(0.0, f64::min);
    // Beyond a jump the criterion falls from infinity: the axis shows the levels to which it falls.
    let low_of =
        |piece: &Vec<PlotPoint>| piece.iter().map(|point| point.y).fold(f64::INFINITY, f64::min);
    let levels = pieces.iter().map(low_of).filter(|level| level.is_finite());
    let highest = 2.0 * levels.fold(0.5 * lowest.abs(), f64::max);
    let span = highest - lowest;
    let axis = PlotAxis::new("criterion").symbol("2ζ + F\\bar{μ}′");
    if span > 0.0 { axis.between(lowest - 0.08 * span, highest + 0.08 * span) } else { axis }
}
