//! The least dither: the amplitudes that are quiet over the second number that is chosen, or over the box of operating points.

use super::caption::{caption, caption_of_disc, caption_of_system};
use super::system::name_of as name_of_path;
use crate::plot::{
    Figure, LineStyle, Marker, Panel, PlotAxis, PlotRole, Points, Polyline, ReferenceLine,
    SharedLegend,
};
use crate::run::design::LeastDitherFound;
use crate::run::varied::name_of;
use crate::study::vocabulary::resolve;
use crate::study::{BeltStudy, DiscStudy, SystemStudy};

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

/// The same of a disc, with the exact thresholds over the speeds.
pub fn design_of_disc(study: &DiscStudy, done: &LeastDitherFound) -> Figure {
    let axis = |path: &str| axis_of_key(path, study.is_si());
    let mut panels = Vec::new();
    if !done.others.is_empty() {
        panels.push(region(done, &axis));
    }
    if !done.tongues.is_empty() {
        panels.push(tongues(done, &axis));
    } else if done.others.is_empty() {
        panels.push(schedule(done, &axis));
    }
    Figure::grid(1, panels)
        .legend(SharedLegend::Below)
        .title(study.title().unwrap_or_default())
        .caption(format!("{} {}", caption_of_disc(study), done.sentence(study)))
}

/// The amplitudes at which the disc changes between quiet and loud, over the speeds, at the frequency of the answer.
fn tongues(done: &LeastDitherFound, axis: &AxisOfPath<'_>) -> Panel {
    let (number, up) = (&done.over[0], done.amplitude.per_unit);
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut open: Vec<Vec<(f64, f64)>> = Vec::new();
    for (speed, ends) in &done.tongues {
        // Boundaries go on while their number is the same.
        if open.len() != ends.len() {
            pieces.append(&mut open);
            open = vec![Vec::new(); ends.len()];
        }
        for (piece, end) in open.iter_mut().zip(ends) {
            piece.push((speed * number.per_unit, end * up));
        }
    }
    pieces.append(&mut open);
    pieces.retain(|piece| piece.len() > 1);
    let mut panel = Panel::new(axis(&number.path), axis(&done.amplitude.path).from(0.0))
        .with(Polyline::pieces(PlotRole::Boundary, pieces).label("exact threshold at each speed"));
    if let Ok(found) = &done.answer().answer {
        let line =
            ReferenceLine::horizontal(found.critical.amplitude * up).style(LineStyle::Dashed);
        panel = panel.with(line.label("exact least dither, for all speeds"));
        if let Some(worst) = found.critical.worst.as_ref().and_then(|worst| worst.first()) {
            let at = vec![(worst * number.per_unit, found.critical.amplitude * up)];
            let decides = Points::new(PlotRole::Series(1), at).marker(Marker::Disc);
            panel = panel.with(decides.label("the speed that decides"));
        }
    }
    panel
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

/// An axis of a number of a disc, by its key.
fn axis_of_key(path: &str, in_si: bool) -> PlotAxis {
    let Ok(address) = resolve(path) else { return PlotAxis::new(path) };
    let parameter = address.key.parameter();
    let symbol = parameter.map_or("", |parameter| parameter.symbol);
    let about = parameter.map_or(path, |parameter| short_about(parameter.about));
    let unit = address.key.unit_in_words();
    let axis = PlotAxis::new(about).symbol(symbol);
    if in_si && unit != "1" { axis.unit(unit) } else { axis }
}

/// What a parameter is, without its explanation.
fn short_about(about: &'static str) -> &'static str {
    about.split([';', ':', ',']).next().unwrap_or(about)
}

/// The least amplitude at each operating point, and the one amplitude for all of them.
fn schedule(done: &LeastDitherFound, axis: &AxisOfPath<'_>) -> Panel {
    let across = done.over.first().map_or("", |number| number.path.as_str());
    let per_unit = done.over.first().map_or(1.0, |number| number.per_unit);
    let up = done.amplitude.per_unit;
    let scheduled = done.schedule.iter().flatten();
    let points = scheduled
        .filter_map(|row| Some((row.point.first()? * per_unit, row.amplitude.as_ref().ok()? * up)));
    let mut panel = Panel::new(axis(across), axis(&done.amplitude.path).from(0.0)).with(
        Polyline::new(PlotRole::Series(0), points.collect::<Vec<_>>())
            .label("exact least amplitude at each operating point"),
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
