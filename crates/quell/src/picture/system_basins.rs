//! Basins of a system in the plane of starts, and the share of quiescent motions over a parameter.

use super::basins::panel_of_shares;
use super::caption::{VariedNumber, caption_of_varied};
use super::map::{MapAxis, MapKind, MappedQuantity, map_panel};
use super::system::axis_of;
use super::undrawable;
use crate::complaint::Failure;
use crate::plot::{Figure, Legend, Panel, PlotAxis, PlotRole, Points, SharedLegend, Size};
use crate::run::system::basins::{SystemBasin, SystemBasins, SystemPortrait};
use crate::study::SystemStudy;

/// Reason in the legend for a start without colour.
const UNKNOWN: &str = "outcome unknown";

/// The picture of basins: the plane of starts, or the share over a parameter.
///
/// # Errors
/// [`Failure::Failed`] if it cannot be drawn.
pub fn basins(study: &SystemStudy, done: &SystemBasins) -> Result<Figure, Failure> {
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

/// The plane of starts.
fn plane(
    study: &SystemStudy,
    done: &SystemBasins,
    portrait: &SystemPortrait,
) -> Result<Panel, Failure> {
    let names = done.names.each_ref().map(|name| PlotAxis::new(name.as_str()));
    let outcome = |(place, basin): (usize, &SystemBasin)| {
        let share = 100.0 * basin.share.fraction;
        (
            role(&portrait.basins, place),
            format!("{}: {share:.1}\u{a0}%", basin.attractor.words(study.units())),
        )
    };
    let outcomes = portrait.basins.iter().enumerate().map(outcome);
    let Some(values) = done.layout.axes(done.windows) else {
        let panel = {
            let [across, up] = names;
            Panel::new(across, up)
        };
        return Ok(outcomes.enumerate().fold(panel, |panel, (place, (role, label))| {
            let starts = done.starts.iter().zip(&portrait.ends);
            let inside = starts.filter(|(_, end)| **end == Some(place));
            let inside = inside.map(|([across, up], _)| (*across, *up));
            panel.with(Points::new(role, inside).size(3.0).label(label))
        }));
    };
    let (columns, rows) = (values[0].len(), values[1].len());
    let places = (0..columns).flat_map(|column| (0..rows).map(move |row| row * columns + column));
    let axes = names.into_iter().zip(values).map(|(axis, values)| MapAxis { axis, values });
    let picture = MappedQuantity {
        values: places.map(|at| portrait.ends[at].map(|place| place as f64).ok_or(0)).collect(),
        axes: axes.collect(),
        quantity: PlotAxis::new("outcome"),
        kind: MapKind::Outcome(outcomes.collect()),
        reasons: vec![UNKNOWN.to_owned()],
        zero: None,
        over: Vec::new(),
    };
    map_panel(&picture, false).map_err(undrawable)
}

/// The share of starts that end in step with the dither, or at rest, over the parameter.
fn shares(study: &SystemStudy, done: &SystemBasins) -> Panel {
    let Some(over) = &done.over else { return Panel::default() };
    let (axis, ruler) = axis_of(study, &over.parameter, (over.from, over.to));
    let local = done.portraits.iter().filter_map(|portrait| {
        let unstable = portrait.local.as_ref().is_ok_and(|verdict| *verdict == "unstable");
        Some((ruler.place(portrait.value?), unstable))
    });
    let local: Vec<(f64, bool)> = local.collect();
    let shares = done
        .portraits
        .iter()
        .filter_map(|portrait| Some((ruler.place(portrait.value?), portrait.quiet)));
    panel_of_shares((axis, "starts that fall quiet"), &local, &shares.collect::<Vec<_>>())
}

/// The quiescent motion is blue, the largest other one red.
fn role(basins: &[SystemBasin], place: usize) -> PlotRole {
    let quiet_first = basins.first().is_some_and(|basin| basin.attractor.quiet);
    match (quiet_first, place) {
        (true, 0) => PlotRole::Stable,
        (true, 1) | (false, 0) => PlotRole::Unstable,
        _ => PlotRole::Series(place + 1),
    }
}
