//! Basins in the plane of starts, and the share of quiescent responses over a parameter.

use quell_dynamics::attractor::{Basin, BasinLabel};
use quell_dynamics::orbit::OrbitVerdict;
use quell_model::units::Quantity;

use super::bifurcation::{axis, intervals, range};
use super::caption::{VariedNumber, caption, with_varied};
use super::map::{MapAxis, MapKind, MappedQuantity, map_panel};
use super::ruler::Ruler;
use super::{undrawable, with_unstable};
use crate::complaint::Failure;
use crate::plot::{
    Figure, Layer, Legend, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, Region,
    SharedLegend, Size,
};
use crate::run::attractor::words;
use crate::run::basins::{Basins, Portrait, Share};
use crate::study::BeltStudy;

/// Maximum number of states of a section that are drawn.
const STATES: usize = 400;

/// Reason in the legend for a start without colour.
const UNKNOWN: &str = "outcome unknown";

/// The picture of basins: the plane of starts, or the share over a parameter.
///
/// # Errors
/// [`Failure::Failed`] if it cannot be drawn.
pub fn basins(study: &BeltStudy, done: &Basins) -> Result<Figure, Failure> {
    let figure = match (&done.varied, done.portraits.as_slice()) {
        (None, [portrait]) => {
            Figure::single(plane(study, done, portrait)?).size(Size::Frame(420.0, 330.0))
        }
        _ => {
            Figure::single(shares(done)).legend(SharedLegend::Above).size(Size::Frame(480.0, 280.0))
        }
    };
    let title = study.title().unwrap_or_default();
    let ranges: Vec<VariedNumber> = done.varied.iter().map(range).collect();
    let text = format!(
        "{} {}. {}.",
        done.sentence(study),
        done.starts_in_words(study),
        with_varied(study, caption, &ranges)
    );
    Ok(figure.title(title).caption(text))
}

/// The plane of starts of one portrait.
///
/// # Errors
/// [`Failure::Failed`] if it cannot be drawn.
pub(crate) fn plane(
    study: &BeltStudy,
    done: &Basins,
    portrait: &Portrait,
) -> Result<Panel, Failure> {
    let window = done.starts.window();
    let (x, v) = (
        Ruler::of(study, Quantity::Displacement, [window.displacement.0, window.displacement.1]),
        Ruler::of(study, Quantity::Velocity, [window.velocity.0, window.velocity.1]),
    );
    let basins = &portrait.gathered.basins;
    let outcome = |place: usize| {
        let share = 100.0 * portrait.shares[place].fraction;
        let attractor = &basins[place].attractor;
        let name = portrait
            .quiet_word(attractor)
            .map_or_else(|| words(portrait.scales, attractor, portrait.period), str::to_owned);
        (role(basins, place), format!("{name}: {share:.1}\u{a0}%"))
    };
    let mut over: Vec<Layer> = Vec::new();
    for (place, basin) in basins.iter().enumerate() {
        let section = &basin.attractor.section;
        let step = section.len().div_ceil(STATES).max(1);
        let states: Vec<(f64, f64)> =
            section.iter().step_by(step).map(|(a, b)| (x.place(*a), v.place(*b))).collect();
        let single = states.len() == 1;
        let points = Points::new(PlotRole::Exact, states);
        let marker = if single { Marker::Cross } else { Marker::Disc };
        let label = if place == 0 { "stroboscopic sections of the responses" } else { "" };
        over.push(points.marker(marker).size(if single { 8.0 } else { 2.4 }).label(label).into());
    }
    let (across, up) = (x.axis("displacement", "x"), v.axis("velocity", "x′"));
    let labels = &portrait.gathered.labels;
    let Some((columns, rows)) = done.starts.axes() else {
        let mut panel = Panel::new(across, up);
        for place in 0..basins.len() {
            let (role, label) = outcome(place);
            let states = done.starts.states().iter().zip(labels);
            let inside = states.filter(|(_, label)| **label == BasinLabel::Attractor(place));
            let inside =
                inside.map(|(state, _)| (x.place(state.displacement), v.place(state.velocity)));
            panel = panel.with(Points::new(role, inside).size(3.0).label(label));
        }
        return Ok(panel.with_all(over).legend(Legend::Above));
    };
    let value = |column: usize, row: usize| match labels[row * columns.len() + column] {
        BasinLabel::Attractor(place) => Ok(place as f64),
        BasinLabel::Unsettled(_) | BasinLabel::Stalled(_) => Err(0),
    };
    let values =
        (0..columns.len()).flat_map(|column| (0..rows.len()).map(move |row| (column, row)));
    let picture = MappedQuantity {
        values: values.map(|(column, row)| value(column, row)).collect(),
        axes: vec![
            MapAxis { axis: across, values: columns.iter().map(|value| x.place(*value)).collect() },
            MapAxis { axis: up, values: rows.iter().map(|value| v.place(*value)).collect() },
        ],
        quantity: PlotAxis::new("outcome"),
        kind: MapKind::Outcome((0..basins.len()).map(outcome).collect()),
        reasons: vec![UNKNOWN.to_owned()],
        zero: None,
        over,
    };
    Ok(map_panel(&picture, false).map_err(undrawable)?.legend(Legend::Above))
}

/// The quiescent response is blue, the largest other one red.
fn role(basins: &[Basin], place: usize) -> PlotRole {
    let quiet_first = basins.first().is_some_and(|basin| basin.attractor.quiet);
    match (quiet_first, place) {
        (true, 0) => PlotRole::Stable,
        (true, 1) | (false, 0) => PlotRole::Unstable,
        _ => PlotRole::Series(place + 1),
    }
}

/// The share of starts that reach a quiescent response over the parameter.
fn shares(done: &Basins) -> Panel {
    let Some(varied) = &done.varied else { return Panel::default() };
    let (across, ruler) = axis(varied);
    let local = done.portraits.iter().filter_map(|portrait| {
        Some((ruler.place(portrait.value?), portrait.local == Ok(OrbitVerdict::Unstable)))
    });
    let local: Vec<(f64, bool)> = local.collect();
    let shares = done
        .portraits
        .iter()
        .filter_map(|portrait| Some((ruler.place(portrait.value?), portrait.quiet)));
    let label = "starts that fall quiet";
    panel_of_shares((across, label), &local, &shares.collect::<Vec<_>>())
}

/// Shares of starts over a parameter, where the response is locally unstable or not; the curve has a gap where no share is known.
pub(super) fn panel_of_shares(
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
    let points = |piece: &[(f64, Share)], which: fn(Share) -> f64| -> Vec<(f64, f64)> {
        piece.iter().map(|(value, share)| (*value, which(*share))).collect()
    };
    let fractions: Vec<Vec<(f64, f64)>> =
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
