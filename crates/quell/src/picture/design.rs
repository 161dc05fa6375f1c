//! The least dither: the amplitudes that are quiet over the second number that is chosen, or over the box of operating points.

use super::caption::{caption, caption_of_system};
use super::system::name_of as name_of_path;
use crate::plot::{
    Figure, LineStyle, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, ReferenceLine,
    SharedLegend,
};
use crate::run::design::LeastDitherFound;
use crate::run::varied::name_of;
use crate::study::vocabulary::resolve;
use crate::study::{BeltStudy, SystemStudy};

/// Required amplitudes over the other number that is chosen, or over the operating points.
pub fn design(study: &BeltStudy, done: &LeastDitherFound) -> Figure {
    panel(done, &|path| axis(study, path))
        .title(study.title().unwrap_or_default())
        .caption(format!("{}. {}", caption(study), done.sentence(study)))
}

/// The same of a system.
pub fn design_of_system(study: &SystemStudy, done: &LeastDitherFound) -> Figure {
    let axis = |path: &str| {
        let axis = PlotAxis::new(name_of_path(path));
        match study.unit_of(path).filter(|unit| *unit != "1") {
            Some(unit) => axis.unit(unit),
            None => axis,
        }
    };
    panel(done, &axis).title(study.title().unwrap_or_default()).caption(format!(
        "{} {}",
        caption_of_system(study),
        done.sentence(study)
    ))
}

/// The axis of the number at a path.
type AxisOfPath<'a> = dyn Fn(&str) -> PlotAxis + 'a;

fn panel(done: &LeastDitherFound, axis: &AxisOfPath<'_>) -> Figure {
    let panel = if done.others.is_empty() { schedule(done, axis) } else { region(done, axis) };
    Figure::single(panel).legend(SharedLegend::Below)
}

/// An axis of a number, by its key.
fn axis(study: &BeltStudy, path: &str) -> PlotAxis {
    let (about, symbol) = name_of(study, path).unwrap_or((path, ""));
    let unit = resolve(path).map_or("", |address| address.key.unit_in_words());
    let axis = PlotAxis::new(about).symbol(symbol);
    if study.scales().is_some() && unit != "1" { axis.unit(unit) } else { axis }
}

/// The least amplitude at each operating point, and the one amplitude for all of them.
fn schedule(done: &LeastDitherFound, axis: &AxisOfPath<'_>) -> Panel {
    let across = done.over.first().map_or("", |number| number.path.as_str());
    let per_unit = done.over.first().map_or(1.0, |number| number.per_unit);
    let up = done.amplitude.per_unit;
    let points =
        done.schedule.iter().filter_map(|(point, least)| Some((point * per_unit, (*least)? * up)));
    let mut panel = Panel::new(axis(across), axis(&done.amplitude.path).from(0.0)).with(
        Polyline::new(PlotRole::Series(0), points.collect::<Vec<_>>())
            .label("by averaging, at each operating point"),
    );
    if let Ok(found) = &done.answer().answer {
        let line =
            ReferenceLine::horizontal(found.critical.amplitude * up).style(LineStyle::Dashed);
        panel = panel.with(line.label("exact, for all operating points"));
        if let Some(worst) = found.critical.worst.as_ref().and_then(|worst| worst.first()) {
            let at = vec![(worst * per_unit, found.critical.amplitude * up)];
            panel = panel.with(
                Points::new(PlotRole::Series(1), at)
                    .marker(Marker::Disc)
                    .label("the operating point that decides"),
            );
        }
    }
    panel
}

/// The required amplitude over the first other number, and the largest amplitude that keeps every limit.
fn region(done: &LeastDitherFound, axis: &AxisOfPath<'_>) -> Panel {
    let number = &done.others[0];
    let up = done.amplitude.per_unit;
    let tried = &done.answer().tried;
    let curve = |keeps: bool| -> Vec<(f64, f64)> {
        let chosen = tried.iter().filter(|point| (point.use_of_limits() <= 1.0) == keeps);
        chosen.map(|point| (point.others[0] * number.per_unit, point.amplitude * up)).collect()
    };
    let mut panel = Panel::new(axis(&number.path), axis(&done.amplitude.path).from(0.0))
        .with(
            Points::new(PlotRole::Series(0), curve(true))
                .marker(Marker::Circle)
                .label("least amplitude, every limit kept"),
        )
        .with(
            Points::new(PlotRole::Undecided, curve(false))
                .marker(Marker::Cross)
                .label("least amplitude, a limit exceeded"),
        );
    if let Ok(found) = &done.answer().answer {
        let at = vec![(found.critical.others[0] * number.per_unit, found.critical.amplitude * up)];
        panel = panel.with(
            Points::new(PlotRole::Series(1), at).marker(Marker::Disc).label("exact least dither"),
        );
    }
    panel
}
