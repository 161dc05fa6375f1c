//! The modulus of the deciding multiplier of a periodic motion over a parameter, with its thresholds; and threshold curves in two
//! parameters compared with the stability boundaries by averaging.

use super::caption::caption_of_varied;
use super::frame::filled;
use super::system::axis_of;
use crate::plot::{
    AxisRange, Figure, Legend, LineStyle, Marker, Note, Panel, PlotAxis, PlotPoint, PlotRole,
    Points, Polyline, ReferenceLine, Region, Size,
};
use crate::run::thresholds::Thresholds;
use crate::run::thresholds::curves::{AveragedBoundary, Curves};
use crate::study::SystemStudy;
use quell_dynamics::orbit::{ThresholdCurve, ThresholdKind};
use quell_numerics::interval::RealInterval;

/// Minimum jump of the multiplier between neighbouring points with different events that counts as grazing.
const JUMP: f64 = 0.05;

/// The picture of the thresholds of one parameter.
pub fn thresholds(study: &SystemStudy, done: &Thresholds) -> Figure {
    let RealInterval { lower: from, upper: to } = done.request.window;
    let (across, ruler) = axis_of(study, &done.request.parameter, RealInterval::new(from, to));
    let branch = done.local.as_ref().map_or(&[][..], |local| &local.branch);
    // The multipliers jump at grazing, and the curve has a gap there.
    let mut pieces: Vec<Vec<PlotPoint>> = vec![Vec::new()];
    for (place, point) in branch.iter().enumerate() {
        let jumps =
            place.checked_sub(1).and_then(|before| branch.get(before)).is_some_and(|before| {
                before.signature != point.signature && (before.radius - point.radius).abs() > JUMP
            });
        if jumps {
            pieces.push(Vec::new());
        }
        if let Some(piece) = pieces.last_mut() {
            piece.push(PlotPoint::new(ruler.place(point.value), point.radius));
        }
    }
    let radii = || pieces.iter().flatten().map(|point| point.y);
    let (low, high) = (radii().fold(1.0, f64::min), radii().fold(1.0, f64::max));
    let room = 0.15 * (high - low).max(1e-3);
    let modulus =
        PlotAxis::new("modulus of the multiplier").symbol("|λ|").between(low - room, high + room);
    let mut panel = Panel::new(across, modulus)
        .with(Region::across_y(PlotRole::Unstable, 1.0, f64::INFINITY).label("unstable"))
        .with(ReferenceLine::horizontal(1.0))
        .with(Polyline::pieces(PlotRole::Exact, pieces));
    for kind in ThresholdKind::ALL {
        let found = done.local.iter().flat_map(|local| &local.thresholds);
        let places: Vec<PlotPoint> = found
            .filter(|threshold| threshold.kind == kind)
            .map(|threshold| PlotPoint::new(ruler.place(threshold.value), 1.0))
            .collect();
        if !places.is_empty() {
            let marker = if kind == ThresholdKind::Grazing { Marker::Circle } else { Marker::Disc };
            let points = Points::new(PlotRole::Exact, places).marker(marker).size(7.0);
            panel = panel.with(points.label(words(kind)));
        }
    }
    for (protocol, switches) in &done.runs {
        for change in &switches.changes {
            let label = format!(
                "run {}: {} above {}",
                protocol.words(study),
                done.words(&change.becomes),
                ruler.words(change.value)
            );
            let rule = ReferenceLine::vertical(ruler.place(change.value)).style(LineStyle::Dashed);
            panel = panel.with(rule.label(label));
        }
    }
    Figure::single(panel.legend(Legend::Above)).title(study.title().unwrap_or_default()).caption(
        format!(
            "{} {}",
            done.sentence(study),
            caption_of_varied(study, &[(done.request.parameter.as_str().into(), from, to)])
        ),
    )
}

/// The picture of threshold curves.
pub fn curves(study: &SystemStudy, done: &Curves) -> Figure {
    let request = &done.request;
    let (x, across) = axis_of(study, &request.along, request.between);
    let (y, up) = axis_of(study, &request.parameter, request.window);
    let place = |(along, value): (f64, f64)| PlotPoint::new(across.place(along), up.place(value));
    let panel = with_curves(Panel::new(x, y), &done.averaged, &done.found.curves, place);
    Figure::single(panel.legend(Legend::Above))
        .size(Size::Frame(380.0, 300.0))
        .title(study.title().unwrap_or_default())
        .caption(format!(
            "{} {}",
            done.sentence(study),
            caption_of_varied(
                study,
                &[
                    (request.along.as_str().into(), request.between.lower, request.between.upper),
                    (request.parameter.as_str().into(), request.window.lower, request.window.upper),
                ]
            )
        ))
}

/// Name of a kind in the legend.
fn words(kind: ThresholdKind) -> &'static str {
    match kind {
        ThresholdKind::NeimarkSacker => "Neimark–Sacker",
        ThresholdKind::Hopf => "Hopf",
        ThresholdKind::Flip => "flip",
        ThresholdKind::Fold => "fold",
        ThresholdKind::Branching => "branching",
        ThresholdKind::Grazing => "grazing",
        ThresholdKind::Signature => "change of events",
        ThresholdKind::Separation => "separation",
    }
}

/// A panel with the boundaries of averaging and the curves of each kind.
fn with_curves(
    mut panel: Panel,
    averaged: &[AveragedBoundary],
    curves: &[ThresholdCurve],
    place: impl Fn((f64, f64)) -> PlotPoint,
) -> Panel {
    for boundary in averaged {
        let (label, style) = if boundary.limit {
            ("averaged, R → ∞", LineStyle::Solid)
        } else {
            ("averaged at finite R", LineStyle::Dashed)
        };
        // Wide enough to be seen under an exact curve that coincides with it.
        let width = 2.6;
        let pieces = boundary.pieces.iter().map(|piece| piece.iter().copied().map(&place));
        let pieces: Vec<Vec<PlotPoint>> = pieces.map(Iterator::collect).collect();
        if !pieces.is_empty() {
            panel = panel.with(
                Polyline::pieces(PlotRole::Averaged, pieces).style(style).width(width).label(label),
            );
        }
    }
    for (number, kind) in ThresholdKind::ALL.into_iter().enumerate() {
        let pieces: Vec<Vec<PlotPoint>> = curves
            .iter()
            .filter(|curve| curve.kind == kind)
            .map(|curve| {
                curve.points.iter().map(|point| place((point.along, point.value))).collect()
            })
            .collect();
        if !pieces.is_empty() {
            // Each kind has the same colour in every picture.
            let role = if kind == ThresholdKind::NeimarkSacker {
                PlotRole::Exact
            } else {
                PlotRole::Series(number - 1)
            };
            panel =
                panel.with(Polyline::pieces(role, pieces).label(format!("exact: {}", words(kind))));
        }
    }
    if panel.layers.is_empty() {
        let middle = |axis: &PlotAxis| match axis.range {
            AxisRange::Between(from, to) => 0.5 * (from + to),
            _ => 0.5,
        };
        let place = (middle(&panel.x), middle(&panel.y));
        panel = panel.with(Note::new(place.0, place.1, "no threshold in this window"));
        return panel;
    }
    filled(panel)
}
