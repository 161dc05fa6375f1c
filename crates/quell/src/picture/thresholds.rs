//! The modulus of the larger multiplier over a parameter, with its thresholds; and threshold curves in two parameters compared
//! with the stability boundaries by averaging.

use std::borrow::Cow;

use quell_dynamics::orbit::threshold::ThresholdKind;
use quell_model::units::Quantity;

use super::caption::{caption, with_varied};
use super::ruler::Ruler;
use super::sweep::short_name;
use crate::plot::{
    AxisRange, Figure, Layer, Legend, LineStyle, Marker, Note, Panel, PlotAxis, PlotRole, Points,
    Polyline, ReferenceLine, Region, Size,
};
use crate::run::curves::{AveragedBoundary, Curves, ThresholdCurve};
use crate::run::thresholds::{Thresholds, becomes};
use crate::run::varied::{key_of, name_of};
use crate::study::BeltStudy;

/// Minimum jump of the multiplier between neighbouring points that counts as grazing.
const JUMP: f64 = 0.05;

/// The axis of a parameter, and its ruler.
fn axis_of(study: &BeltStudy, path: &str, range: (f64, f64)) -> (PlotAxis, Ruler) {
    let largest = range.0.abs().max(range.1.abs());
    let address = study.address(path).ok();
    let Some((quantity, symbol)) = address.and_then(|found| found.quantity.zip(found.symbol))
    else {
        return (PlotAxis::new(path), Ruler::new(study, Quantity::Ratio, largest));
    };
    let ruler = Ruler::new(study, quantity, largest);
    let (about, symbol) = name_of(study, path).unwrap_or((path, symbol));
    let axis = ruler
        .axis(short_name(about), &symbol.replace('₀', "_0"))
        .between(ruler.place(range.0.min(range.1)), ruler.place(range.0.max(range.1)));
    (axis, ruler)
}

/// The picture of the thresholds of one parameter.
pub fn thresholds(study: &BeltStudy, done: &Thresholds) -> Figure {
    let question = &done.question;
    let (axis, ruler) = axis_of(study, &question.parameter, (question.from, question.to));
    // The multipliers jump at grazing, and the curve has a gap there.
    let mut pieces: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for pair in done.local.branch.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        if let Some(piece) = pieces.last_mut() {
            piece.push((ruler.place(a.value), a.radius));
        }
        if a.signature != b.signature && (a.radius - b.radius).abs() > JUMP {
            pieces.push(Vec::new());
        }
    }
    if let (Some(piece), Some(last)) = (pieces.last_mut(), done.local.branch.last()) {
        piece.push((ruler.place(last.value), last.radius));
    }
    let radii = || pieces.iter().flatten().map(|point| point.1);
    let (low, high) = (radii().fold(1.0, f64::min), radii().fold(1.0, f64::max));
    let room = 0.15 * (high - low).max(1e-3);
    let modulus =
        PlotAxis::new("modulus of the multiplier").symbol("|λ|").between(low - room, high + room);
    let mut panel = Panel::new(axis, modulus)
        .with(Region::across_y(PlotRole::Unstable, 1.0, f64::INFINITY).label("unstable"))
        .with(ReferenceLine::horizontal(1.0))
        .with(Polyline::pieces(PlotRole::Exact, pieces));
    for kind in ThresholdKind::ALL {
        let places: Vec<(f64, f64)> = done
            .local
            .thresholds
            .iter()
            .filter(|threshold| threshold.kind == kind)
            .map(|threshold| (ruler.place(threshold.value), 1.0))
            .collect();
        if !places.is_empty() {
            let marker = if kind == ThresholdKind::Grazing { Marker::Circle } else { Marker::Disc };
            panel = panel.with(
                Points::new(PlotRole::Exact, places).marker(marker).size(7.0).label(words(kind)),
            );
        }
    }
    for (protocol, switches) in &done.protocols {
        for switch in &switches.changes {
            let label = format!(
                "{}: {} above {}",
                protocol.name().replace('_', " "),
                becomes(switch.becomes, done.in_band),
                ruler.words(switch.value)
            );
            let rule = ReferenceLine::vertical(ruler.place(switch.value)).style(LineStyle::Dashed);
            panel = panel.with(rule.label(label));
        }
    }
    Figure::single(panel.legend(Legend::Above)).title(study.title().unwrap_or_default()).caption(
        format!(
            "{} {}.",
            done.sentence(study),
            with_varied(
                study,
                caption,
                &[range(study, &question.parameter, (question.from, question.to))]
            )
        ),
    )
}

/// The range of a number of the equations, by the key and in the unit of the study.
fn range<'a>(study: &BeltStudy, path: &'a str, (from, to): (f64, f64)) -> (Cow<'a, str>, f64, f64) {
    let quantity = study.address(path).ok().and_then(|address| address.quantity);
    let unit =
        study.scales().zip(quantity).map_or(1.0, |(scales, quantity)| scales.per_unit(quantity));
    (Cow::Owned(key_of(study, path)), unit * from, unit * to)
}

/// Name of a kind in the legend.
pub(super) fn words(kind: ThresholdKind) -> &'static str {
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

/// The picture of threshold curves.
pub fn curves(study: &BeltStudy, done: &Curves) -> Figure {
    let question = &done.question;
    let (x, across) = axis_of(study, &question.along, question.between);
    let (y, up) = axis_of(study, &question.parameter, question.window);
    let place = |(along, value): (f64, f64)| (across.place(along), up.place(value));
    let panel = with_curves(Panel::new(x, y), &done.averaged, &done.curves, place);
    Figure::single(panel.legend(Legend::Above))
        .size(Size::Frame(380.0, 300.0))
        .title(study.title().unwrap_or_default())
        .caption(format!(
            "{} {}.",
            done.sentence(study),
            with_varied(
                study,
                caption,
                &[
                    range(study, &question.along, question.between),
                    range(study, &question.parameter, question.window),
                ]
            )
        ))
}

/// A panel with the boundaries of averaging and the curves of each kind.
pub(super) fn with_curves<S>(
    mut panel: Panel,
    averaged: &[AveragedBoundary],
    curves: &[ThresholdCurve<S>],
    place: impl Fn((f64, f64)) -> (f64, f64),
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
        let pieces: Vec<Vec<(f64, f64)>> = pieces.map(Iterator::collect).collect();
        if !pieces.is_empty() {
            panel = panel.with(
                Polyline::pieces(PlotRole::Averaged, pieces).style(style).width(width).label(label),
            );
        }
    }
    for (number, kind) in ThresholdKind::ALL.into_iter().enumerate() {
        let pieces: Vec<Vec<(f64, f64)>> = curves
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

/// Space around the curves, as a share of their extent.
const SPACE: f64 = 0.06;

/// The panel with axes that its curves fill: the window that was searched may be much larger.
pub(super) fn filled(mut panel: Panel) -> Panel {
    let window = |axis: &PlotAxis| match axis.range {
        AxisRange::Between(from, to) => Some((from.min(to), from.max(to))),
        _ => None,
    };
    let (Some(x), Some(y)) = (window(&panel.x), window(&panel.y)) else { return panel };
    let inside = |range: (f64, f64), value: f64| (range.0..=range.1).contains(&value);
    let points: Vec<(f64, f64)> = panel
        .layers
        .iter()
        .filter_map(|layer| if let Layer::Polyline(line) = layer { Some(line) } else { None })
        .flat_map(|line| line.pieces.iter().flatten().copied())
        .filter(|point| inside(x, point.0) && inside(y, point.1))
        .collect();
    let fit = |window: (f64, f64), of: fn(&(f64, f64)) -> f64| {
        let low = points.iter().map(of).fold(f64::INFINITY, f64::min);
        let high = points.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        // A level line keeps a tenth of the window around it.
        let space = if high > low { SPACE * (high - low) } else { 0.1 * (window.1 - window.0) };
        ((low - space).max(window.0), (high + space).min(window.1))
    };
    if points.is_empty() {
        return panel;
    }
    let ((left, right), (bottom, top)) = (fit(x, |point| point.0), fit(y, |point| point.1));
    panel.x = panel.x.between(left, right);
    panel.y = panel.y.between(bottom, top);
    panel
}
