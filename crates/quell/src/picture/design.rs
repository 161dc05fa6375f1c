//! The least dither: the amplitudes that are quiet over the second number that is chosen, or over the box of operating points.

use super::caption::{caption, disc_caption};
use quell_design::least_dither::{DesignObjective, DesignPoint, LimitedQuantity};

use crate::plot::{
    Figure, LineStyle, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline,
    ReferenceLine, Region, SharedLegend,
};
use crate::run::design::{LeastDitherFound, StudyWithDesign, quantity_of};
use crate::study::UnitSystem;
use crate::study::key_at;
use crate::study::vocabulary::DocumentKind;
use crate::study::{DiscStudy, SystemStudy};
use crate::words::quantity_at;

/// Required amplitudes over the other number that is chosen, or over the operating points.
pub fn design(study: &SystemStudy, done: &LeastDitherFound) -> Figure {
    let axis = |path: &str| {
        let axis = PlotAxis::new(quantity_at(path));
        match study.unit_of(path).filter(|unit| *unit != "1") {
            Some(unit) => axis.unit(unit),
            None => axis,
        }
    };
    figure(study, done, &axis).title(study.title().unwrap_or_default()).caption(format!(
        "{} {}",
        caption(study),
        done.sentence(study)
    ))
}

/// The same of a disc, with the exact thresholds over the speeds.
pub fn disc_design(study: &DiscStudy, done: &LeastDitherFound) -> Figure {
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
        .caption(format!("{} {}", disc_caption(study), done.sentence(study)))
}

/// The amplitudes at which the disc changes between quiet and loud, over the speeds, at the frequency of the answer.
fn tongues(done: &LeastDitherFound, axis: &AxisOfPath<'_>) -> Panel {
    let (number, up) = (&done.over[0], done.amplitude.per_unit);
    let mut pieces: Vec<Vec<PlotPoint>> = Vec::new();
    let mut open: Vec<Vec<PlotPoint>> = Vec::new();
    for (speed, ends) in &done.tongues {
        // Boundaries go on while their number is the same.
        if open.len() != ends.len() {
            pieces.append(&mut open);
            open = vec![Vec::new(); ends.len()];
        }
        for (piece, end) in open.iter_mut().zip(ends) {
            piece.push(PlotPoint::new(speed * number.per_unit, end * up));
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
            let at = vec![PlotPoint::new(worst * number.per_unit, found.critical.amplitude * up)];
            let decides = Points::new(PlotRole::Series(1), at).marker(Marker::Disc);
            panel = panel.with(decides.label("the speed that decides"));
        }
    }
    panel
}

/// The axis of the number at a path.
type AxisOfPath<'a> = dyn Fn(&str) -> PlotAxis + 'a;

/// The panels of a design: over the other number that is chosen, along the box, and against its limits.
fn figure(study: &dyn StudyWithDesign, done: &LeastDitherFound, axis: &AxisOfPath<'_>) -> Figure {
    let mut panels = Vec::new();
    if !done.others.is_empty() {
        panels.push(region(done, axis));
    }
    let is_scheduled = done.schedule.as_ref().is_ok_and(|schedule| !schedule.is_empty());
    if is_scheduled || done.others.is_empty() {
        panels.push(schedule(done, axis));
    }
    panels.extend(frontier(study, done, axis));
    if panels.len() == 1 {
        return Figure::grid(1, panels).legend(SharedLegend::Below);
    }
    Figure::grid(1, panels)
}

/// An axis of a number of a disc, by its key.
fn axis_of_key(path: &str, in_si: bool) -> PlotAxis {
    let Ok(address) = key_at(path, DocumentKind::Disc) else { return PlotAxis::new(path) };
    let parameter = address.key.parameter();
    let symbol = parameter.map_or("", |parameter| parameter.symbol);
    let about = parameter.map_or(path, |parameter| short_about(parameter.about));
    let unit = address.key.unit_in_words(DocumentKind::Disc, UnitSystem::None);
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
    let points = scheduled.filter_map(|row| {
        Some(PlotPoint::new(row.point.first()? * per_unit, row.amplitude.as_ref().ok()? * up))
    });
    let mut panel = Panel::new(axis(across), axis(&done.amplitude.path).from(0.0)).with(
        Polyline::new(PlotRole::Series(0), points.collect::<Vec<_>>())
            .label("exact least amplitude at each operating point"),
    );
    if let Ok(found) = &done.answer().answer {
        let line =
            ReferenceLine::horizontal(found.critical.amplitude * up).style(LineStyle::Dashed);
        panel = panel.with(line.label("exact, for all operating points"));
        if let Some(worst) = found.critical.worst.as_ref().and_then(|worst| worst.first()) {
            let at = vec![PlotPoint::new(worst * per_unit, found.critical.amplitude * up)];
            panel = panel.with(
                Points::new(PlotRole::Series(1), at)
                    .marker(Marker::Disc)
                    .label("the operating point that decides"),
            );
        }
    }
    panel
}

/// The least amplitude over the other number that is chosen, the largest one within each limit, and what both leave.
fn region(done: &LeastDitherFound, axis: &AxisOfPath<'_>) -> Panel {
    let number = &done.others[0];
    let mut panel = Panel::new(axis(&number.path), axis(&done.amplitude.path).from(0.0));
    panel =
        if done.others.len() == 1 { with_curves(panel, done) } else { with_choices(panel, done) };
    if let Ok(found) = &done.answer().answer {
        let up = done.amplitude.per_unit;
        let at = vec![PlotPoint::new(
            found.critical.others[0] * number.per_unit,
            found.critical.amplitude * up,
        )];
        panel = panel.with(
            Points::new(PlotRole::Exact, at)
                .marker(Marker::Disc)
                .size(4.0)
                .label("exact least dither"),
        );
    }
    panel
}

/// Every choice that was tried, of several numbers.
fn with_choices(panel: Panel, done: &LeastDitherFound) -> Panel {
    let (number, up) = (&done.others[0], done.amplitude.per_unit);
    let tried = &done.answer().tried;
    let points = |keeps: bool| -> Vec<PlotPoint> {
        let chosen = tried.iter().filter(|point| (point.use_of_limits() <= 1.0) == keeps);
        chosen
            .map(|point| PlotPoint::new(point.others[0] * number.per_unit, point.amplitude * up))
            .collect()
    };
    panel
        .with(
            Points::new(PlotRole::Series(0), points(true))
                .marker(Marker::Circle)
                .label("least amplitude, every limit kept"),
        )
        .with(
            Points::new(PlotRole::Undecided, points(false))
                .marker(Marker::Cross)
                .label("least amplitude, a limit exceeded"),
        )
}

/// A quantity with a limit, or the rating of an actuator, in words.
fn noun_of(quantity: LimitedQuantity) -> String {
    let name = quantity.name();
    name.rsplit_once('.').map_or(name, |(_, rating)| rating).replace('_', " ")
}

/// Largest amplitude that is drawn over the largest least one: limits far above it say nothing.
const HEADROOM: f64 = 1.6;

/// The least amplitude by averaging, the lines of the limits, and the amplitudes between them.
fn with_curves(mut panel: Panel, done: &LeastDitherFound) -> Panel {
    let (number, up) = (&done.others[0], done.amplitude.per_unit);
    let tried = &done.answer().tried;
    let least: Vec<PlotPoint> = tried
        .iter()
        .map(|point| PlotPoint::new(point.others[0] * number.per_unit, point.amplitude * up))
        .collect();
    let top = HEADROOM * least.iter().map(|point| point.y).fold(0.0, f64::max);
    let quantities: Vec<LimitedQuantity> = tried
        .first()
        .map_or(Vec::new(), |point| point.used.iter().map(|(limit, _)| *limit).collect());
    let lines: Vec<Vec<Option<f64>>> = (0..quantities.len())
        .map(|place| tried.iter().map(|point| largest_within(point, place)).collect())
        .collect();
    // How friction loss and the least load depend on the amplitude is not known from the least one.
    let unknown = |quantity: &LimitedQuantity| {
        matches!(quantity, LimitedQuantity::FrictionLoss | LimitedQuantity::MinimumNormalLoad)
    };
    if !quantities.iter().any(unknown) {
        panel = panel.with_all(allowed(&least, &lines, (top, up)));
    }
    panel = panel.with(
        Polyline::new(PlotRole::Averaged, least.iter().copied())
            .label("least amplitude, by averaging"),
    );
    for (place, line) in lines.iter().enumerate() {
        let x = least.iter().map(|point| point.x);
        let drawn = x.zip(line).filter_map(|(x, most)| Some(PlotPoint::new(x, (*most)? * up)));
        let pieces = pieces_below(drawn, top);
        if !pieces.is_empty() {
            let label = format!("limit of {}", noun_of(quantities[place]));
            panel = panel.with(Polyline::pieces(PlotRole::Series(place), pieces).label(label));
        }
    }
    panel
}

/// The largest amplitude within a limit, of a quantity that is a power of the amplitude.
fn largest_within(point: &DesignPoint, place: usize) -> Option<f64> {
    let (quantity, used) = &point.used[place];
    let used = used.as_ref().ok().filter(|used| **used > 0.0)?;
    match quantity {
        LimitedQuantity::Power => Some(point.amplitude / used.sqrt()),
        LimitedQuantity::Amplitude
        | LimitedQuantity::Stroke
        | LimitedQuantity::Velocity
        | LimitedQuantity::ResponseRms
        | LimitedQuantity::ResponsePeak
        | LimitedQuantity::Actuator(_) => Some(point.amplitude / used),
        // The frequency decides, not the amplitude.
        LimitedQuantity::Band => (*used > 1.0).then_some(0.0),
        LimitedQuantity::FrictionLoss | LimitedQuantity::MinimumNormalLoad => None,
    }
}

/// The pieces of a curve up to a height.
fn pieces_below(curve: impl Iterator<Item = PlotPoint>, top: f64) -> Vec<Vec<PlotPoint>> {
    let mut pieces: Vec<Vec<PlotPoint>> = vec![Vec::new()];
    for point in curve {
        if point.y <= top {
            pieces.last_mut().into_iter().for_each(|piece| piece.push(point));
        } else if pieces.last().is_some_and(|piece| !piece.is_empty()) {
            pieces.push(Vec::new());
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

/// The amplitudes from the least one to the tightest limit, where it leaves any.
fn allowed(least: &[PlotPoint], lines: &[Vec<Option<f64>>], (top, up): (f64, f64)) -> Vec<Region> {
    let most = |place: usize| {
        lines.iter().filter_map(|line| line[place]).fold(top, |most, own| most.min(own * up))
    };
    let mut regions: Vec<Vec<(f64, f64, f64)>> = vec![Vec::new()];
    for (place, PlotPoint { x, y: amplitude }) in least.iter().enumerate() {
        if *amplitude <= most(place) {
            regions.last_mut().into_iter().for_each(|own| own.push((*x, *amplitude, most(place))));
        } else if regions.last().is_some_and(|own| !own.is_empty()) {
            regions.push(Vec::new());
        }
    }
    regions.retain(|own| own.len() > 1);
    let shade = |(number, own): (usize, &Vec<(f64, f64, f64)>)| {
        let lower = own.iter().map(|(x, low, _)| PlotPoint::new(*x, *low));
        let upper = own.iter().map(|(x, _, high)| PlotPoint::new(*x, *high));
        let region = Region::between(PlotRole::Stable, lower, upper);
        if number == 0 { region.label("quiet within every limit") } else { region }
    };
    regions.iter().enumerate().map(shade).collect()
}

/// The least objective against each limit, relative to that of the study; `None` where the choices of the design trade nothing.
fn frontier(
    study: &dyn StudyWithDesign,
    done: &LeastDitherFound,
    axis: &AxisOfPath<'_>,
) -> Option<Panel> {
    let points = done.frontier(study);
    let minimise = study.asked()?.minimise;
    let noun = PlotAxis::new(format!("least {}", minimise.name().replace('-', " ")));
    let (vertical, up) = match minimise {
        DesignObjective::Amplitude => (axis(&done.amplitude.path), done.amplitude.per_unit),
        _ => match study.fields().unit_of_study(quantity_of(study, minimise)) {
            Some(unit) => (noun.unit(unit), 1.0),
            None => (noun, 1.0),
        },
    };
    let mut panel =
        Panel::new(PlotAxis::new("limit relative to that of the study"), vertical.from(0.0));
    let mut drawn = 0;
    for own in points.chunk_by(|a, b| a.quantity == b.quantity) {
        let curve =
            own.iter().filter_map(|point| Some(PlotPoint::new(point.share, point.objective? * up)));
        let curve: Vec<PlotPoint> = curve.collect();
        let varies = curve.iter().any(|point| point.y != curve[0].y);
        if curve.len() > 1 && varies {
            let label = format!("limit of {}, by averaging", noun_of(own[0].quantity));
            panel = panel.with(Polyline::new(PlotRole::Series(drawn), curve).label(label));
            drawn += 1;
        }
    }
    let found = done.answer().answer.as_ref().ok()?;
    let objective = found.critical.objective.clone().ok()?;
    let at = Points::new(PlotRole::Exact, vec![PlotPoint::new(1.0, objective * up)])
        .marker(Marker::Disc);
    (drawn > 0).then(|| panel.with(at.size(4.0).label("exact least dither")))
}
