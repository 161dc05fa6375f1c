//! Pictures of a system: eigenvalues, how they move with a parameter, and the reach of dither.

use std::collections::BTreeMap;

use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending_by;

use super::frame::filled;
use super::ruler::Ruler;
use crate::plot::{
    Figure, Legend, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine,
    Region,
};
use crate::run::system::reach::Reaches;
use crate::run::system::tracked::TrackedStability;
use crate::study::{SystemStudy, UnitSystem};
use crate::words::quantity_at;

/// Largest share of the growth rates that is hidden below the axis: overdamped motions just beyond a jump decay arbitrarily fast.
const HIDDEN: f64 = 0.15;

/// Margin of the axis of growth rates where some rates are below it.
const MARGIN: f64 = 0.1;

/// The axis of an angular frequency, in hertz where the study has units, and the factor to it.
pub(super) fn frequency_axis(study: &SystemStudy, symbol: &str) -> (PlotAxis, f64) {
    match study.units() {
        UnitSystem::None => (PlotAxis::new("angular frequency").symbol(symbol), 1.0),
        _ => (PlotAxis::new("frequency").unit("Hz"), 1.0 / std::f64::consts::TAU),
    }
}

pub(super) fn growth_axis(study: &SystemStudy) -> PlotAxis {
    let axis = PlotAxis::new("growth rate").symbol("Re λ");
    match study.units() {
        UnitSystem::None => axis,
        _ => axis.unit("1/s"),
    }
}

/// The axis of the number at a path over a range, and its ruler.
pub(super) fn axis_of(
    study: &SystemStudy,
    path: &str,
    RealInterval { lower: from, upper: to }: RealInterval,
) -> (PlotAxis, Ruler) {
    let ruler = Ruler::of_path(study, path, from.abs().max(to.abs()));
    // The unit of a key such as `amplitude_n` is that of the axis.
    let axis = ruler.axis(&quantity_at(path), "");
    (axis.between(ruler.place(from), ruler.place(to)), ruler)
}

/// Lower end of the axis of growth rates, where a few rates are far below all others.
fn lowest_rate(done: &TrackedStability) -> Option<f64> {
    let mut rates: Vec<PlotPoint> = Vec::new();
    for pair in done.tracked.pieces.iter().flat_map(|piece| piece.windows(2)) {
        let width = pair[1].value - pair[0].value;
        rates.extend(pair[1].eigenvalues.iter().map(|z| PlotPoint::new(z.re, width)));
    }
    ascending_by(&mut rates, |a| a.x);
    let (lowest, highest) = rates.first().zip(rates.last())?;
    let whole: f64 = rates.iter().map(|point| point.y).sum();
    let mut below = 0.0;
    let usual = rates.iter().find(|point| {
        below += point.y;
        below >= HIDDEN * whole
    })?;
    let length = highest.x - usual.x;
    (lowest.x < usual.x - length).then_some(usual.x - MARGIN * length)
}

/// Frequency and growth rate of every motion over the parameter, with the thresholds.
pub fn tracked(study: &SystemStudy, done: &TrackedStability) -> Figure {
    let (frequency, factor) = frequency_axis(study, "|Im λ|");
    let RealInterval { lower: from, upper: to } = done.request.window;
    let (axis, ruler) = axis_of(study, &done.request.parameter, RealInterval::new(from, to));
    let across = || axis.clone();
    let branches = |pick: &dyn Fn(&num_complex::Complex64) -> Option<f64>| -> Vec<Vec<PlotPoint>> {
        let mut lines: BTreeMap<(usize, usize), Vec<PlotPoint>> = BTreeMap::new();
        for (index, piece) in done.tracked.pieces.iter().enumerate() {
            for point in piece {
                for (branch, value) in point.eigenvalues.iter().enumerate() {
                    if let Some(height) = pick(value) {
                        lines
                            .entry((index, branch))
                            .or_default()
                            .push(PlotPoint::new(ruler.place(point.value), height));
                    }
                }
            }
        }
        lines.into_values().collect()
    };
    let upper = |z: &num_complex::Complex64| z.im >= 0.0;
    let lowest = lowest_rate(done);
    let frequencies = branches(&|z| upper(z).then_some(factor * z.im));
    let rates = branches(&|z| upper(z).then_some(z.re));
    let role = if done.averaged { PlotRole::Averaged } else { PlotRole::Undithered };
    let marked = |panel: Panel, height: &dyn Fn(num_complex::Complex64) -> f64| -> Panel {
        let kinds =
            [("threshold", Marker::Disc, true), ("frequencies merge", Marker::Circle, false)];
        kinds.into_iter().fold(panel, |panel, (label, marker, changes)| {
            let found = done.tracked.thresholds.iter();
            let of_kind = found.filter(|at| (at.verdicts[0] != at.verdicts[1]) == changes);
            let points: Vec<PlotPoint> = of_kind
                .map(|at| PlotPoint::new(ruler.place(at.value), height(at.eigenvalue)))
                .collect();
            if points.is_empty() {
                return panel;
            }
            panel.with(Points::new(PlotRole::Exact, points).marker(marker).size(7.0).label(label))
        })
    };
    let all = frequencies.iter().flatten().map(|point| point.y);
    let (least, greatest) =
        all.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), height| (a.min(height), b.max(height)));
    // Frequencies that are close to each other in comparison to their size are easier to distinguish without the origin.
    let frequency = if least > 0.5 * greatest { frequency } else { frequency.from(0.0) };
    let above = Panel::new(across(), frequency).with(Polyline::pieces(role, frequencies));
    let above = marked(above, &|z| factor * z.im.abs()).title("(a) frequency").legend(Legend::None);
    let growth = match lowest {
        Some(lowest) => growth_axis(study).from(lowest),
        None => growth_axis(study),
    };
    let below = Panel::new(across(), growth)
        .with(Region::across_y(PlotRole::Unstable, 0.0, f64::INFINITY).label("unstable"))
        .with(ReferenceLine::horizontal(0.0))
        .with(Polyline::pieces(role, rates));
    let below = marked(below, &|z| z.re).title("(b) growth rate");
    let mut panels = vec![above, below];
    if let Some((along, RealInterval { lower: first, upper: last })) = &done.request.along {
        let (second, second_ruler) = axis_of(study, along, RealInterval::new(*first, *last));
        let mut panel = Panel::new(second, across());
        for (kind, changes) in [(PlotRole::Boundary, true), (PlotRole::Guide, false)] {
            let of_kind = done.curves.iter().filter(|curve| {
                let verdicts = curve.points.first().map(|(_, found)| found.verdicts);
                verdicts.is_some_and(|[before, beyond]| (before != beyond) == changes)
            });
            let lines: Vec<Vec<PlotPoint>> = of_kind
                .map(|curve| {
                    let points = curve.points.iter();
                    let placed = points.map(|(at, found)| {
                        PlotPoint::new(second_ruler.place(*at), ruler.place(found.value))
                    });
                    placed.collect()
                })
                .collect();
            if !lines.is_empty() {
                let label = if changes { "threshold" } else { "frequencies merge" };
                panel = panel.with(Polyline::pieces(kind, lines).label(label));
            }
        }
        panels.push(filled(panel).title("(c) thresholds"));
    }
    Figure::grid(2, panels).title(study.title().unwrap_or_default()).caption(format!(
        "Eigenvalues of small motions about steady sliding over {}, {}.{}",
        done.request.parameter,
        done.protocol(),
        if lowest.is_some() { " Lower growth rates exist." } else { "" }
    ))
}

/// Slip amplitude per unit of dither over its frequency.
pub fn reach(study: &SystemStudy, done: &Reaches) -> Figure {
    let (frequency, factor) = frequency_axis(study, "ω");
    let slip = match study.units() {
        UnitSystem::None => PlotAxis::new("slip amplitude per unit of dither"),
        UnitSystem::Si => PlotAxis::new("slip amplitude per force").unit("m/s/N"),
        UnitSystem::MmTonneSecond => PlotAxis::new("slip amplitude per force").unit("mm/s/N"),
    };
    let mut panel = Panel::new(frequency.log(), slip.log());
    for pair in &done.pairs {
        let contact = &study.system().contacts[pair.contact].name;
        let frequencies = done.frequencies.iter().map(|w| factor * w);
        let points: Vec<PlotPoint> = PlotPoint::zip(frequencies, pair.slip.iter().copied())
            .filter(|point| point.y.is_finite() && point.y > 0.0)
            .collect();
        if points.is_empty() {
            continue;
        }
        panel = panel.with(
            Polyline::new(PlotRole::Series(pair.dither + pair.contact), points)
                .label(format!("contact {contact}, dither[{}]", pair.dither)),
        );
    }
    Figure::single(panel).title(study.title().unwrap_or_default()).caption(
        "Slip amplitude at each contact in the linear response to the dither about steady sliding."
            .to_owned(),
    )
}
