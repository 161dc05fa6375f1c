//! Pictures of a system: eigenvalues, how they move with a parameter, and the reach of dither.

use std::collections::BTreeMap;

use crate::plot::{
    Figure, Legend, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, ReferenceLine, Region,
};
use crate::run::system::reach::Reaches;
use crate::run::system::stability::SystemStability;
use crate::run::system::tracked::TrackedStability;
use crate::study::{SystemStudy, SystemUnits};

/// The axis of an angular frequency, in hertz where the study has units, and the factor to it.
fn frequency_axis(study: &SystemStudy) -> (PlotAxis, f64) {
    match study.units() {
        SystemUnits::None => (PlotAxis::new("angular frequency").symbol("|Im λ|"), 1.0),
        _ => (PlotAxis::new("frequency").unit("Hz"), 1.0 / std::f64::consts::TAU),
    }
}

fn growth_axis(study: &SystemStudy) -> PlotAxis {
    let axis = PlotAxis::new("growth rate").symbol("Re λ");
    match study.units() {
        SystemUnits::None => axis,
        _ => axis.unit("1/s"),
    }
}

/// Every eigenvalue in the complex plane; under dither those without it too.
pub fn stability(study: &SystemStudy, done: &SystemStability) -> Figure {
    let (frequency, factor) = frequency_axis(study);
    let places = |motions: &[quell_linear::spectrum::SmallMotion]| -> Vec<(f64, f64)> {
        let upper = motions.iter().filter(|motion| motion.eigenvalue.im >= 0.0);
        upper.map(|motion| (motion.eigenvalue.re, factor * motion.frequency())).collect()
    };
    let own = places(&done.spectrum.motions);
    let mut panel = Panel::new(growth_axis(study), frequency)
        .with(Region::across_x(PlotRole::Unstable, 0.0, f64::INFINITY).label("unstable"))
        .with(ReferenceLine::vertical(0.0));
    if let Some(dither) = &done.dither {
        let before = places(&dither.undithered.motions);
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

/// Frequency and growth rate of every motion over the parameter, with the thresholds.
pub fn tracked(study: &SystemStudy, done: &TrackedStability) -> Figure {
    let (frequency, factor) = frequency_axis(study);
    let (from, to) = done.request.window;
    let across = || PlotAxis::new(done.request.parameter.clone()).between(from, to);
    let branches = |pick: &dyn Fn(&num_complex::Complex64) -> Option<f64>| -> Vec<Vec<(f64, f64)>> {
        let mut lines: BTreeMap<(usize, usize), Vec<(f64, f64)>> = BTreeMap::new();
        for (index, piece) in done.tracked.pieces.iter().enumerate() {
            for point in piece {
                for (branch, value) in point.eigenvalues.iter().enumerate() {
                    if let Some(height) = pick(value) {
                        lines.entry((index, branch)).or_default().push((point.value, height));
                    }
                }
            }
        }
        lines.into_values().collect()
    };
    let upper = |z: &num_complex::Complex64| z.im >= 0.0;
    let frequencies = branches(&|z| upper(z).then_some(factor * z.im));
    let rates = branches(&|z| upper(z).then_some(z.re));
    let marks: Vec<(f64, f64)> = done
        .tracked
        .thresholds
        .iter()
        .map(|found| (found.value, factor * found.eigenvalue.im.abs()))
        .collect();
    let zero: Vec<(f64, f64)> =
        done.tracked.thresholds.iter().map(|found| (found.value, found.eigenvalue.re)).collect();
    let role = if done.averaged { PlotRole::Averaged } else { PlotRole::Undithered };
    let mark = |points: Vec<(f64, f64)>| {
        Points::new(PlotRole::Exact, points).marker(Marker::Disc).size(7.0).label("threshold")
    };
    let above = Panel::new(across(), frequency.from(0.0))
        .with(Polyline::pieces(role, frequencies))
        .with(mark(marks))
        .title("(a) frequency")
        .legend(Legend::None);
    let below = Panel::new(across(), growth_axis(study))
        .with(Region::across_y(PlotRole::Unstable, 0.0, f64::INFINITY).label("unstable"))
        .with(ReferenceLine::horizontal(0.0))
        .with(Polyline::pieces(role, rates))
        .with(mark(zero))
        .title("(b) growth rate");
    let mut panels = vec![above, below];
    if let Some((along, (first, last))) = &done.request.along {
        let mut panel = Panel::new(PlotAxis::new(along.clone()).between(*first, *last), across());
        for curve in &done.curves {
            let points: Vec<(f64, f64)> =
                curve.points.iter().map(|(at, found)| (*at, found.value)).collect();
            let label = curve.points.first().map_or("", |(_, found)| found.change.name());
            panel = panel.with(Polyline::new(PlotRole::Exact, points).label(label));
        }
        panels.push(panel.title("(c) thresholds"));
    }
    Figure::grid(2, panels).title(study.title().unwrap_or_default()).caption(format!(
        "Eigenvalues followed over {}; {}.",
        done.request.parameter,
        done.protocol()
    ))
}

/// Slip amplitude per unit of dither over its frequency.
pub fn reach(study: &SystemStudy, done: &Reaches) -> Figure {
    let (frequency, factor) = frequency_axis(study);
    let mut panel =
        Panel::new(frequency.log(), PlotAxis::new("slip amplitude per unit of dither").log());
    for pair in &done.pairs {
        let contact = &study.system().contacts[pair.contact].name;
        let points: Vec<(f64, f64)> = done
            .frequencies
            .iter()
            .map(|w| factor * w)
            .zip(pair.slip.iter().copied())
            .filter(|(_, slip)| slip.is_finite() && *slip > 0.0)
            .collect();
        if points.is_empty() {
            continue;
        }
        panel = panel.with(
            Polyline::new(PlotRole::Series(pair.dither + pair.contact), points)
                .label(format!("dither {} at {contact}", pair.dither)),
        );
    }
    Figure::single(panel)
        .title(study.title().unwrap_or_default())
        .caption("Linear response of the sliding structure, friction carried along.".to_owned())
}
