//! The picture of a computed map: for each variable a curve over one axis, a map over two axes, or a map for each value of the
//! slower axes.
//!
//! The stability boundaries by averaging are drawn on top if the plane contains them. Curves have gaps and maps are hatched
//! where a number is unknown; the legend shows the reason.

use quell_linear::averaging::{Averaging, Becomes};
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending;

use super::caption::{VariedNumber, caption_of, with_varied};
use super::map::{self, MapAxis, MapKind, MappedQuantity};
use super::undrawable;
use crate::complaint::Failure;
use crate::disc_units::DiscUnits;
use crate::map::{FinishedMap, amplitude_and_other, boundaries_at};
use crate::plot::{
    Figure, Layer, Legend, LineStyle, Marker, Note, Panel, PlotAxis, PlotError, PlotPoint,
    PlotRole, Points, Polyline, Size, Spread,
};
use crate::run::thresholds::curves::{self, CurvesRequest};
use crate::status::Status;
use crate::study::{DiscStudy, Study};
use crate::sweep::{Grid, GridAxis, Variable, VariableArrays, VariableKind};

/// What a growth rate of one ω_ref is in the units in which a disc is answered.
fn one_growth(study: &Study) -> f64 {
    let units = study.disc().ok().and_then(|study| DiscUnits::of(&study));
    units.and_then(|units| units.one("growth", "ω_ref")).map_or(1.0, |(one, _)| one)
}

/// Whether the values of a variable are growth rates, the real parts of eigenvalues.
fn is_growth(variable: &Variable) -> bool {
    variable.symbol.starts_with("Re")
}

/// Whether a variable is drawn only if no other quantity was requested.
fn is_secondary(name: &str) -> bool {
    [
        "settled",
        "growth_error",
        "growth_verdict",
        "growth_undithered_error",
        "quench_amplitude_averaged",
        "quench_lost",
        "quench_last",
    ]
    .contains(&name)
}

/// The picture of a computed map.
///
/// # Errors
/// [`Failure::Failed`] if it cannot be drawn because there are too many panels.
pub fn sweep(done: &FinishedMap) -> Result<Figure, Failure> {
    let plan = done.plan();
    let axes = plan.grid().axes().len();
    let entries = plan.sheet().entries();
    let mut shown: Vec<&VariableArrays> =
        entries.iter().filter(|entry| !is_secondary(entry.variable.name)).collect();
    if shown.is_empty() {
        shown = entries.iter().collect();
    }
    let columns = shown.len().min(2);
    // The same curves are over every panel.
    let over = if axes == 1 { Vec::new() } else { over(done) };
    let figure = match axes {
        1 => Ok(Figure::grid(columns, shown.iter().map(|entry| panel(done, entry)))),
        2 => {
            let panels: Result<Vec<Panel>, PlotError> = shown
                .iter()
                .map(|entry| {
                    Ok(map::map_panel(&picture(done, entry, &over), true)?.legend(Legend::Above))
                })
                .collect();
            panels.map(|panels| Figure::grid(columns, panels).size(Size::Frame(400.0, 310.0)))
        }
        _ => map::map(&picture(done, shown[0], &over)),
    };
    let figure = figure.map_err(undrawable)?;
    let title = plan.grid().study().picture_title().unwrap_or_default();
    let ranges: Vec<VariedNumber> = plan.grid().axes().iter().filter_map(range).collect();
    let caption = with_varied(plan.grid().study(), caption_of, &ranges);
    Ok(figure.title(title).caption(caption))
}

/// The range of an axis.
fn range(axis: &GridAxis) -> Option<VariedNumber<'_>> {
    Some((axis.path.as_str().into(), *axis.values.first()?, *axis.values.last()?))
}

/// A variable of a computed map as plain data.
fn picture(done: &FinishedMap, entry: &VariableArrays, over: &[Layer]) -> MappedQuantity {
    let plan = done.plan();
    let grid = plan.grid();
    let states: Vec<Status> = (0..grid.len()).map(|point| done.status(entry, point)).collect();
    let mut unknown: Vec<Status> =
        states.iter().copied().filter(|status| !status.has_number()).collect();
    unknown.sort_unstable();
    unknown.dedup();
    let value = |point: usize| {
        done.number(entry, point)
            .ok_or_else(|| unknown.iter().position(|status| *status == states[point]).unwrap_or(0))
    };
    let variable = &entry.variable;
    let array = entry.value;
    let unit = &plan.sheet().fields()[array].unit;
    let kind = match variable.kind {
        VariableKind::Word { words, .. } => {
            let outcomes = words.iter().enumerate();
            MapKind::Outcome(
                outcomes
                    .map(|(index, &word)| (role_of(word, index, words.len()), word.to_owned()))
                    .collect(),
            )
        }
        // Growth rates in tongues are 10⁻⁹ to 10⁻², decay rates about 10⁻².
        VariableKind::Rate if is_growth(variable) && grid.study().disc().is_ok() => {
            MapKind::Growth(Spread::SignedLog(1e-5 * one_growth(grid.study())))
        }
        VariableKind::Rate if is_growth(variable) => MapKind::Growth(Spread::Linear),
        VariableKind::Number(_) if variable.name == "residual_vibration" => {
            MapKind::ResidualVibration
        }
        VariableKind::Rate | VariableKind::Number(_) => MapKind::Number(Spread::Linear),
    };
    let name = match kind {
        MapKind::ResidualVibration => "residual vibration",
        _ => short_name(variable.about),
    };
    MappedQuantity {
        axes: grid
            .axes()
            .iter()
            .map(|axis| MapAxis { axis: across(axis), values: axis.values.clone() })
            .collect(),
        quantity: labelled(PlotAxis::new(name), variable.symbol, unit),
        kind,
        values: (0..grid.len()).map(value).collect(),
        reasons: unknown.iter().map(|status| status.about().to_owned()).collect(),
        zero: None,
        over: over.iter().cloned().chain(doubtful(done, &states)).collect(),
    }
}

/// Crosses at the points whose number is known and lies outside the range of the model, with the reason in the legend.
fn doubtful(done: &FinishedMap, states: &[Status]) -> Vec<Layer> {
    let axes = done.plan().grid().axes();
    let [across, up] = axes else { return Vec::new() };
    let height = up.values.len();
    let marks = |status: Status| {
        let places = states.iter().enumerate().filter(|(_, state)| **state == status);
        let points: Vec<PlotPoint> = places
            .map(|(point, _)| {
                PlotPoint::new(across.values[point / height], up.values[point % height])
            })
            .collect();
        (!points.is_empty()).then(|| {
            let crosses = Points::new(PlotRole::Guide, points).marker(Marker::Cross).size(2.6);
            Layer::from(crosses.label(status.about()))
        })
    };
    [Status::BeyondRange, Status::Opens, Status::WithoutState]
        .into_iter()
        .filter_map(marks)
        .collect()
}

/// The exact curves of the quench amplitude, if it is mapped over a plane: over the amplitude itself the mapped values, over two other
/// numbers the thresholds of the study's own amplitude, followed as `thresholds --along` does.
fn exact_curves(done: &FinishedMap) -> Vec<Layer> {
    let grid = done.plan().grid();
    let entries = done.plan().sheet().entries();
    let (Some(entry), [first, second]) =
        (entries.iter().find(|entry| entry.variable.name == "quench_amplitude"), grid.axes())
    else {
        return Vec::new();
    };
    let (pieces, label) = if let Some((amplitude, other)) = amplitude_and_other(grid) {
        let upwards = second == amplitude;
        let height = second.values.len();
        let place = |index: usize| if upwards { index * height } else { index };
        let value = |index: usize| done.number(entry, place(index));
        let points = other.values.iter().enumerate().map(|(index, at)| {
            let value = value(index).unwrap_or(f64::NAN);
            if upwards { PlotPoint::new(*at, value) } else { PlotPoint::new(value, *at) }
        });
        (vec![points.collect::<Vec<_>>()], "exact quench amplitude")
    } else {
        let ends = |axis: &GridAxis| {
            let values = axis.values.iter().copied();
            let least = values.clone().fold(f64::INFINITY, f64::min);
            RealInterval::new(least, values.fold(f64::NEG_INFINITY, f64::max))
        };
        let request = CurvesRequest {
            parameter: second.path.clone(),
            window: ends(second),
            along: first.path.clone(),
            between: ends(first),
        };
        (threshold_curves(grid, &request), "exact threshold at the study's amplitude")
    };
    if pieces.iter().all(|piece| piece.len() < 2) {
        return Vec::new();
    }
    vec![Polyline::pieces(PlotRole::Exact, pieces).width(1.8).label(label).into()]
}

/// Curves of thresholds in the plane of a map, in the units of its axes; none where the study has none.
fn threshold_curves(grid: &Grid, request: &CurvesRequest) -> Vec<Vec<PlotPoint>> {
    let Ok(found) = curves::run(&grid.study().system(), request) else { return Vec::new() };
    let curves = found.found.curves.iter();
    curves
        .map(|curve| {
            curve.points.iter().map(|point| PlotPoint::new(point.along, point.value)).collect()
        })
        .collect()
}

/// The stability boundaries by averaging as lines, in the plane as it is drawn: the first axis to the right.
fn over(done: &FinishedMap) -> Vec<Layer> {
    let grid = done.plan().grid();
    if let Ok(study) = grid.study().disc() {
        return over_disc(grid, &study);
    }
    let Some((amplitude, other)) = amplitude_and_other(grid) else { return exact_curves(done) };
    let upwards = grid.axes().last() == Some(amplitude);
    let furthest = amplitude.values.iter().copied().fold(0.0, f64::max);
    let found = boundaries_at(grid, &to_the_frame(other));
    let line = |averaging, becomes, label: &str| {
        let points: Vec<Vec<PlotPoint>> = found
            .iter()
            .filter(|boundary| boundary.averaging == averaging && boundary.becomes == becomes)
            .map(|boundary| {
                let inside = boundary.points.iter().filter(|point| point.1 <= 1.2 * furthest);
                inside
                    .map(
                        |&(at, d)| {
                            if upwards { PlotPoint::new(at, d) } else { PlotPoint::new(d, at) }
                        },
                    )
                    .collect()
            })
            .collect();
        let (role, style) = match averaging {
            Averaging::FiniteR => (PlotRole::Averaged, LineStyle::ShortDashed),
            Averaging::Limit | Averaging::LimitToSecondOrder => {
                (PlotRole::Averaged, LineStyle::DashDotted)
            }
        };
        let any = points.iter().any(|piece: &Vec<_>| piece.len() > 1);
        any.then(|| Layer::from(Polyline::pieces(role, points).style(style).label(label)))
    };
    let averaged = [
        line(Averaging::Limit, Becomes::Stable, "quenches, by averaging"),
        line(Averaging::FiniteR, Becomes::Stable, "quenches, by finite-$R$ averaging"),
        line(Averaging::Limit, Becomes::Unstable, "destabilises, by averaging"),
        line(Averaging::FiniteR, Becomes::Unstable, "destabilises, by finite-$R$ averaging"),
    ];
    exact_curves(done).into_iter().chain(averaged.into_iter().flatten()).collect()
}

/// The values of an axis in ascending order, and the borders of the outermost cells, at which the frame of a map ends.
fn to_the_frame(axis: &GridAxis) -> Vec<f64> {
    let mut values = axis.values.clone();
    ascending(&mut values);
    if let [first, second, .., before, last] = values[..] {
        let (lower, upper) = if axis.logarithmic {
            (first * (first / second).sqrt(), last * (last / before).sqrt())
        } else {
            (first - 0.5 * (second - first), last + 0.5 * (last - before))
        };
        values.insert(0, lower);
        values.push(upper);
    }
    values
}

/// The predicted tongues, if the plane is that of speed (to the right) and friction.
fn over_disc(grid: &Grid, study: &DiscStudy) -> Vec<Layer> {
    let [speed, friction] = grid.axes() else { return Vec::new() };
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    if (last(&speed.path).as_str(), last(&friction.path).as_str()) != ("speed", "friction") {
        return Vec::new();
    }
    let least = speed.values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = speed.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    super::disc::tongues(
        study.disc(),
        RealInterval::new(least, most),
        &friction.values,
        |friction| friction,
    )
}

/// The role of one of several words: the two of a verdict have theirs, more of them differ in colour.
fn role_of(word: &str, index: usize, count: usize) -> PlotRole {
    match (word, count) {
        ("stable" | "yes", _) => PlotRole::Stable,
        (_, ..=2) => PlotRole::Unstable,
        _ => PlotRole::Series(index),
    }
}

fn across(swept: &GridAxis) -> PlotAxis {
    let axis =
        labelled(PlotAxis::new(short_name(swept.about)), swept.symbol.unwrap_or(""), swept.unit);
    if swept.logarithmic { axis.log() } else { axis }
}

fn panel(map: &FinishedMap, entry: &VariableArrays) -> Panel {
    let plan = map.plan();
    let Some(swept) = plan.grid().axes().first() else {
        return Panel::new(PlotAxis::new(""), PlotAxis::new(""));
    };
    let across = across(swept);
    let variable = &entry.variable;
    let array = entry.value;
    let unit = &plan.sheet().fields()[array].unit;
    let mut up = labelled(PlotAxis::new(short_name(variable.about)), variable.symbol, unit);
    if let VariableKind::Word { words, .. } = variable.kind {
        let numbered = words.iter().enumerate().map(|(code, word)| format!("{code} {word}"));
        let numbered = numbered.collect::<Vec<_>>().join(", ");
        up = PlotAxis::new(format!("{} ({numbered})", variable.about));
        let last = (words.len() - 1) as f64;
        up = up
            .between(-0.1, last + 0.1)
            .ticks((0..words.len()).map(|code| code as f64).collect::<Vec<f64>>());
    }
    let mut pieces: Vec<Vec<PlotPoint>> = vec![Vec::new()];
    for (point, place) in swept.values.iter().enumerate() {
        match (map.number(entry, point), pieces.last_mut()) {
            (Some(value), Some(piece)) => piece.push(PlotPoint::new(*place, value)),
            (None, Some(piece)) if !piece.is_empty() => pieces.push(Vec::new()),
            _ => {}
        }
    }
    let whole = Panel::new(across, up);
    if pieces.iter().all(Vec::is_empty) {
        return whole.with_all(nothing(map, entry, swept));
    }
    if matches!(variable.kind, VariableKind::Word { .. }) {
        return whole.with(Points::new(PlotRole::Dithered, pieces.concat()).size(4.0));
    }
    whole.with(Polyline::pieces(PlotRole::Dithered, pieces))
}

/// Why no point has a number, in the middle of the frame.
fn nothing(map: &FinishedMap, entry: &VariableArrays, swept: &GridAxis) -> Vec<Layer> {
    let mut reasons: Vec<&str> =
        (0..swept.values.len()).map(|point| map.status(entry, point).about()).collect();
    reasons.sort_unstable();
    reasons.dedup();
    let ends =
        swept.values.iter().copied().fold((f64::INFINITY, f64::NEG_INFINITY), |ends, value| {
            (f64::min(ends.0, value), f64::max(ends.1, value))
        });
    let spread = [PlotPoint::new(ends.0, 0.0), PlotPoint::new(ends.1, 1.0)];
    vec![
        Polyline::new(PlotRole::Guide, spread).width(0.0).into(),
        Note::new(0.5 * (ends.0 + ends.1), 0.5, format!("no value: {}", reasons.join("; "))).into(),
    ]
}

/// The name of a number without the formula or the explanation that follows it, as the label of an axis.
pub(super) fn short_name(about: &str) -> &str {
    let end = about.find([':', ',', ';', '(']).unwrap_or(about.len());
    let name = &about[..end];
    let formula = match name.find(" = ") {
        // The symbol before the equals sign belongs to the formula.
        Some(sign) => name[..sign].rfind(' ').unwrap_or(sign),
        None => name.find('/').and_then(|slash| name[..slash].rfind(' ')).unwrap_or(name.len()),
    };
    name[..formula].trim_end()
}

/// An axis with symbol and unit; dimensionless numbers of the equations have no unit.
pub(super) fn labelled(axis: PlotAxis, symbol: &str, unit: &str) -> PlotAxis {
    let axis = if symbol.is_empty() { axis } else { axis.symbol(symbol) };
    match unit_or_none(unit) {
        "" => axis,
        unit => axis.unit(unit),
    }
}

/// The unit; empty for the dimensionless numbers of the equations.
pub(super) fn unit_or_none(unit: &str) -> &str {
    let scaled = unit == "1" || unit.contains(['ω', '(']) || unit == "length";
    if scaled { "" } else { unit }
}

#[cfg(test)]
mod tests {
    use super::short_name;

    #[test]
    fn labels_have_no_formulae() {
        for (about, name) in [
            ("belt velocity V₀/ω₀", "belt velocity"),
            ("damping ratio c/(2mω₀)", "damping ratio"),
            ("residual vibration E = M₁/M₀", "residual vibration"),
            ("dither frequency over natural frequency", "dither frequency over natural frequency"),
            (
                "slip velocity that scales the law: of the minimum",
                "slip velocity that scales the law",
            ),
        ] {
            assert_eq!(short_name(about), name);
        }
    }
}
