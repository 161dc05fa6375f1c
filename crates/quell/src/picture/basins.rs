//! Basins in the plane of starts, and the share of quiescent motions over a parameter.

use super::bifurcation::intervals;
use super::caption::{VariedNumber, caption_of_varied};
use super::map::{MapAxis, MapKind, MappedQuantity, map_panel};
use super::ruler::Ruler;
use super::system::axis_of;
use super::{undrawable, with_unstable};
use crate::complaint::Failure;
use crate::plot::{
    Figure, Layer, Legend, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, Region,
    SharedLegend, Size,
};
use crate::run::basins::{Basins, FoundBasin, Portrait, Share, quiescence};
use crate::run::system::attractor::in_words;
use crate::study::SystemStudy;
use quell_dynamics::attractor::MotionKind;
use quell_dynamics::orbit::CycleSamples;
use quell_numerics::interval::RealInterval;

/// Most states of a motion that are drawn.
const STATES: usize = 400;

/// Reason in the legend for a start without colour.
const UNKNOWN: &str = "outcome unknown";

/// The picture of basins: the plane of starts, or the share over a parameter.
///
/// # Errors
/// [`Failure::Failed`] if it cannot be drawn.
pub fn basins(study: &SystemStudy, done: &Basins) -> Result<Figure, Failure> {
    let figure = match (&done.over, done.portraits.as_slice()) {
        (None, [portrait]) => Figure::single(plane(study, done, portrait)?.legend(Legend::Above))
            .size(Size::Frame(420.0, 330.0)),
        _ => Figure::single(shares(study, done))
            .legend(SharedLegend::Above)
            .size(Size::Frame(480.0, 280.0)),
    };
    let ranges: Vec<VariedNumber> =
        done.over.iter().map(|over| (over.parameter.as_str().into(), over.from, over.to)).collect();
    let (sentence, starts) = (done.sentence(study), done.starts_in_words(study));
    Ok(figure
        .title(study.title().unwrap_or_default())
        .caption(format!("{sentence} {starts}. {}", caption_of_varied(study, &ranges))))
}

/// An axis of the plane, and its ruler.
fn axis(study: &SystemStudy, done: &Basins, number: usize) -> (PlotAxis, Ruler) {
    let RealInterval { lower: from, upper: to } = done.windows[number];
    let name = done.names[number].as_str();
    let Some(quantity) = study.system().state_quantity(done.places[number]) else {
        return (PlotAxis::new(name), Ruler::of_unit("", from.abs().max(to.abs())));
    };
    let ruler = Ruler::new(study, quantity, [from, to]);
    (ruler.axis(name, ""), ruler)
}

/// A limit cycle in the plane.
fn cycle(study: &SystemStudy, done: &Basins, state: &[f64], period: f64) -> Vec<PlotPoint> {
    let free = study.system().undithered();
    let samples = CycleSamples::over(&free, &study.observe(), state, period);
    let [first, second] = done.places;
    samples
        .states
        .chunks(state.len())
        .map(|state| PlotPoint::new(state[first], state[second]))
        .collect()
}

/// The plane of starts, with the states of each motion at whole periods of the dither.
fn plane(study: &SystemStudy, done: &Basins, portrait: &Portrait) -> Result<Panel, Failure> {
    let [(across, x), (up, y)] = [0, 1].map(|number| axis(study, done, number));
    let outcome = |(place, basin): (usize, &FoundBasin)| {
        let share = 100.0 * basin.share.fraction;
        let words = in_words(&basin.attractor, study.units());
        (role(&portrait.basins, place), format!("{words}: {share:.1}\u{a0}%"))
    };
    let outcomes = portrait.basins.iter().enumerate().map(outcome);
    let inside = |state: &[f64; 2]| {
        state
            .iter()
            .zip(done.windows)
            .all(|(value, RealInterval { lower: from, upper: to })| (from..=to).contains(value))
    };
    let mut over: Vec<Layer> = Vec::new();
    for basin in &portrait.basins {
        let label = match (over.is_empty(), portrait.is_dithered) {
            (false, _) => "",
            (true, true) => "states of the motions at whole periods",
            (true, false) => "the motions",
        };
        if let MotionKind::Cycle { period, .. } = basin.attractor.kind {
            let line = cycle(study, done, &basin.attractor.state, period);
            let line = line
                .into_iter()
                .map(|PlotPoint { x: a, y: b }| PlotPoint::new(x.place(a), y.place(b)));
            over.push(Polyline::new(PlotRole::Exact, line).width(1.2).label(label).into());
            continue;
        }
        let states = &basin.attractor.states;
        let step = states.len().div_ceil(STATES).max(1);
        let states = states.iter().step_by(step).map(|state| done.places.map(|place| state[place]));
        let states: Vec<PlotPoint> =
            states.filter(inside).map(|[a, b]| PlotPoint::new(x.place(a), y.place(b))).collect();
        if states.is_empty() {
            continue;
        }
        let single = states.len() == 1;
        let points = Points::new(PlotRole::Exact, states);
        let marker = if single { Marker::Cross } else { Marker::Disc };
        over.push(points.marker(marker).size(if single { 8.0 } else { 2.4 }).label(label).into());
    }
    let Some(values) = done.layout.axes(done.windows) else {
        let panel =
            outcomes.enumerate().fold(Panel::new(across, up), |panel, (place, (role, label))| {
                let starts = done.starts.iter().zip(&portrait.ends);
                let mine = starts.filter(|(_, end)| **end == Some(place));
                let mine = mine.map(|([a, b], _)| PlotPoint::new(x.place(*a), y.place(*b)));
                panel.with(Points::new(role, mine).size(3.0).label(label))
            });
        return Ok(panel.with_all(over));
    };
    let (columns, rows) = (values[0].len(), values[1].len());
    let places = (0..columns).flat_map(|column| (0..rows).map(move |row| row * columns + column));
    let [first, second] = values;
    let axes = vec![
        MapAxis { axis: across, values: first.iter().map(|value| x.place(*value)).collect() },
        MapAxis { axis: up, values: second.iter().map(|value| y.place(*value)).collect() },
    ];
    let picture = MappedQuantity {
        values: places.map(|at| portrait.ends[at].map(|place| place as f64).ok_or(0)).collect(),
        axes,
        quantity: PlotAxis::new("outcome"),
        kind: MapKind::Outcome(outcomes.collect()),
        reasons: vec![UNKNOWN.to_owned()],
        zero: None,
        over,
    };
    map_panel(&picture, false).map_err(undrawable)
}

/// The share of starts that end in step with the dither, or at rest, over the parameter.
fn shares(study: &SystemStudy, done: &Basins) -> Panel {
    let Some(over) = &done.over else { return Panel::default() };
    let (axis, ruler) = axis_of(study, &over.parameter, RealInterval::new(over.from, over.to));
    let local = done.portraits.iter().filter_map(|portrait| {
        let unstable = portrait.local.as_ref().is_ok_and(|verdict| *verdict == "unstable");
        Some((ruler.place(portrait.value?), unstable))
    });
    let local: Vec<(f64, bool)> = local.collect();
    let shares = done
        .portraits
        .iter()
        .filter_map(|portrait| Some((ruler.place(portrait.value?), portrait.quiet)));
    let [_, fall] = quiescence(done.in_band());
    panel_of_shares((axis, &format!("starts that {fall}")), &local, &shares.collect::<Vec<_>>())
}

/// The quiescent motion is blue, the largest other one red.
fn role(basins: &[FoundBasin], place: usize) -> PlotRole {
    let quiet_first = basins.first().is_some_and(|basin| basin.attractor.quiet);
    match (quiet_first, place) {
        (true, 0) => PlotRole::Stable,
        (true, 1) | (false, 0) => PlotRole::Unstable,
        _ => PlotRole::Series(place + 1),
    }
}

/// Shares of starts over a parameter, where the response is locally unstable or not; the curve has a gap where no share is known.
fn panel_of_shares(
    (across, label): (PlotAxis, &str),
    unstable: &[(f64, bool)],
    shares: &[(f64, Option<Share>)],
) -> Panel {
    let up = PlotAxis::new(format!("share of {label}")).between(0.0, 1.0);
    let pieces: Vec<Vec<(f64, Share)>> = shares
        .split(|(_, share)| share.is_none())
        .map(|piece| piece.iter().filter_map(|(value, share)| Some((*value, (*share)?))).collect())
        .filter(|piece: &Vec<_>| !piece.is_empty())
        .collect();
    let points = |piece: &[(f64, Share)], which: fn(Share) -> f64| -> Vec<PlotPoint> {
        piece.iter().map(|(value, share)| PlotPoint::new(*value, which(*share))).collect()
    };
    let fractions: Vec<Vec<PlotPoint>> =
        pieces.iter().map(|piece| points(piece, |share| share.fraction)).collect();
    let mut panel = with_unstable(Panel::new(across, up), intervals(unstable));
    for (number, piece) in pieces.iter().enumerate() {
        let (low, high) = (points(piece, |share| share.low), points(piece, |share| share.high));
        let label = if number == 0 { "bounds" } else { "" };
        panel = panel.with(Region::between(PlotRole::Dithered, low, high).label(label));
    }
    let dots = fractions.concat();
    panel
        .with(Polyline::pieces(PlotRole::Dithered, fractions).label(label))
        .with(Points::new(PlotRole::Dithered, dots).size(3.5))
}
