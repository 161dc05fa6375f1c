//! Pictures of maps: one quantity over one axis, over two axes, or over two axes for each value of the others.
//!
//! Two axes give a map: a residual vibration as labelled contour lines over light colours, a growth rate in pale blue (decay) and
//! darker red (growth) with the zero contour, an outcome in flat colours, and any other number in colours with contour lines at
//! round values. One axis gives a curve with gaps where the value is unknown. Points without a value are hatched, with the reason in
//! the legend. Theoretical curves are drawn on top.

use std::ops::Range;

use quell_numerics::order::ascending_by;

use super::ruler::short;
use crate::plot::{
    Colouring, Contours, Field, Figure, Fill, Heatmap, Layer, Legend, Palette, Panel, PlotAxis,
    PlotError, PlotPoint, PlotRange, PlotRole, Polyline, ReferenceLine, Region, Shading,
    SharedLegend, Sharing, Size, Spread, Tint,
};

/// Contour levels of a residual vibration by which maps are read (per cent): quenched, halved, without effect.
const RESIDUAL_LEVELS: &[f64] = &[5.0, 50.0, 95.0];
/// Contour levels between them (per cent).
const RESIDUAL_BETWEEN: &[f64] = &[20.0, 80.0];
/// Widths of these contours (pixels).
const RESIDUAL_WIDTHS: (f64, f64) = (1.3, 0.6);
/// Approximate number of round contour levels of a number.
const LEVELS: usize = 7;
/// Width of the contour of zero growth, which is wider than other contour lines (pixels).
const ZERO_WIDTH: f64 = 1.5;
/// Frame of a map of two axes (pixels).
const PLANE: Size = Size::Frame(400.0, 310.0);
/// Frame of outcomes over one axis: a strip (pixels).
const STRIP: Size = Size::Frame(440.0, 70.0);
/// Maximum number of panels in a picture.
pub const MOST_PANELS: usize = 24;

/// An axis of a map with its values.
#[derive(Debug, Clone, PartialEq)]
pub struct MapAxis {
    /// Name, symbol, unit and scale. The range follows from the values.
    pub axis: PlotAxis,
    /// The values, without repetition, in any order.
    pub values: Vec<f64>,
}

/// Kind of the numbers of a map, which determines how they are drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum MapKind {
    /// A fraction of one: contours at 5, 50 and 95 per cent, and thinner ones at 20 and 80 per cent.
    ResidualVibration,
    /// A rate whose sign determines stability: colours centred on zero with the given spread, and the zero contour.
    Growth(Spread),
    /// The index (0, 1, …) of an outcome in this list of words.
    Outcome(Vec<(PlotRole, String)>),
    /// Any other number: colours with the given spread, and contours at round values.
    Number(Spread),
}

/// A quantity over one or more axes.
#[derive(Debug, Clone, PartialEq)]
pub struct MappedQuantity {
    /// The axes, slowest first. The second to last is drawn from left to right and the last one upwards; each combination of
    /// the values of the other axes has its own panel. A single axis is drawn from left to right.
    pub axes: Vec<MapAxis>,
    /// Name, symbol and unit of the quantity (no unit for a residual vibration, which is drawn in per cent).
    pub quantity: PlotAxis,
    /// Kind of its numbers.
    pub kind: MapKind,
    /// The number at each point, last axis fastest; or the index in `reasons` of why it is missing.
    pub values: Vec<Result<f64, usize>>,
    /// Reasons for missing numbers, as shown in the legend.
    pub reasons: Vec<String>,
    /// The zero lines of a rate, if they are known more accurately than by interpolation between the points of the map.
    pub zero: Option<Vec<Vec<PlotPoint>>>,
    /// Theoretical curves and regions, drawn over each panel.
    pub over: Vec<Layer>,
}

/// The picture of a map.
///
/// # Errors
/// [`PlotError::Field`] if there are no axes, an axis has repeated values or values that are not finite, there would be more than
/// [`MOST_PANELS`] panels, or the number of values does not match the axes.
pub fn map(map: &MappedQuantity) -> Result<Figure, PlotError> {
    let count: usize = map.axes.iter().map(|axis| axis.values.len()).product();
    if map.axes.is_empty() || count != map.values.len() {
        let why = format!("{} values for {count} points", map.values.len());
        return Err(PlotError::Field { why });
    }
    match map.axes.as_slice() {
        [axis] => {
            let figure = Figure::single(sweep(map, axis)?);
            let strip = matches!(map.kind, MapKind::Outcome(_));
            Ok(if strip { figure.size(STRIP) } else { figure })
        }
        [x, y] => {
            let panel = plane(map, (x, y), 0..count, true)?.legend(Legend::Above);
            Ok(Figure::single(panel).size(PLANE))
        }
        [others @ .., x, y] => panels(map, others, (x, y)),
        [] => Err(PlotError::Field { why: "a map without axes".to_owned() }),
    }
}

/// The picture of a map of two axes as one panel of a larger figure, with or without a colour bar.
///
/// # Errors
/// As [`map`], and if the number of axes is not two.
pub fn map_panel(map: &MappedQuantity, bar: bool) -> Result<Panel, PlotError> {
    let count: usize = map.axes.iter().map(|axis| axis.values.len()).product();
    match map.axes.as_slice() {
        [x, y] if count == map.values.len() => plane(map, (x, y), 0..count, bar),
        axes => {
            let why = format!("{} axes and {} values for a panel", axes.len(), map.values.len());
            Err(PlotError::Field { why })
        }
    }
}

/// One panel for each point of the slower axes.
fn panels(
    map: &MappedQuantity,
    others: &[MapAxis],
    (x, y): (&MapAxis, &MapAxis),
) -> Result<Figure, PlotError> {
    let count: usize = others.iter().map(|axis| axis.values.len()).product();
    if count > MOST_PANELS {
        return Err(PlotError::Field {
            why: format!("{count} panels; at most {MOST_PANELS} fit in a picture"),
        });
    }
    let columns = if count <= 4 { count.min(2) } else { 3 };
    let size = x.values.len() * y.values.len();
    let panels = (0..count).map(|number| {
        // All panels have the same colours, so that one colour bar at the end of each row is enough.
        let bar = number % columns == columns - 1 || number == count - 1;
        let panel = plane(map, (x, y), number * size..(number + 1) * size, bar)?;
        Ok(panel.title(heading(others, number)))
    });
    let panels: Vec<Panel> = panels.collect::<Result<_, PlotError>>()?;
    Ok(Figure::grid(columns, panels)
        .legend(SharedLegend::Below)
        .sharing_x(Sharing::Aligned)
        .sharing_y(Sharing::Aligned))
}

/// The values of the slower axes in one panel.
fn heading(others: &[MapAxis], number: usize) -> String {
    let mut rest = number;
    let mut parts: Vec<String> = Vec::new();
    for MapAxis { axis, values } in others.iter().rev() {
        let value = values[rest % values.len()];
        rest /= values.len();
        let name =
            if axis.symbol.is_empty() { axis.name.clone() } else { format!("${}$", axis.symbol) };
        let unit = if axis.unit.is_empty() { String::new() } else { format!(" {}", axis.unit) };
        parts.push(format!("{name} = {}{unit}", short(value)));
    }
    parts.reverse();
    let letter = char::from(b'a' + u8::try_from(number % 26).unwrap_or(0));
    format!("({letter}) {}", parts.join(", "))
}

/// Indices of the values in ascending order, and the sorted values.
fn rising(axis: &MapAxis) -> (Vec<usize>, Vec<f64>) {
    let mut order: Vec<usize> = (0..axis.values.len()).collect();
    ascending_by(&mut order, |one| axis.values[*one]);
    let values = order.iter().map(|place| axis.values[*place]).collect();
    (order, values)
}

/// The quantity over two axes.
fn plane(
    map: &MappedQuantity,
    (x, y): (&MapAxis, &MapAxis),
    points: Range<usize>,
    bar: bool,
) -> Result<Panel, PlotError> {
    let values = &map.values[points];
    let ((columns, at_x), (rows, at_y)) = (rising(x), rising(y));
    let height = rows.len();
    let point = |column: usize, row: usize| values[columns[column] * height + rows[row]];
    let scale = shown_scale(map);
    let field = Field::from_fn(at_x, at_y, |column, row| {
        point(column, row).ok().map(|value| scale * value)
    })?;
    let mut grid = Heatmap::new(field.clone(), colouring(map));
    if bar && !matches!(map.kind, MapKind::Outcome(_)) {
        grid = grid.bar(shown_quantity(map));
    }
    for (number, reason) in map.reasons.iter().enumerate() {
        grid = grid.gap(reason.clone(), |column, row| point(column, row) == Err(number));
    }
    let panel = Panel::new(x.axis.clone(), y.axis.clone()).with(grid);
    let panel = match &map.kind {
        MapKind::ResidualVibration => {
            let contours = |levels: &[f64], width: f64| {
                Contours::new(field.clone(), levels.iter().copied()).unit("%").width(width)
            };
            panel
                .with(contours(RESIDUAL_LEVELS, RESIDUAL_WIDTHS.0))
                .with(contours(RESIDUAL_BETWEEN, RESIDUAL_WIDTHS.1))
        }
        MapKind::Growth(_) => {
            let label = format!("zero {}", map.quantity.name);
            match &map.zero {
                Some(lines) => {
                    let exact = Polyline::pieces(PlotRole::Boundary, lines.iter().cloned());
                    panel.with(exact.width(ZERO_WIDTH).label(label))
                }
                None => {
                    panel.with(Contours::new(field, [0.0]).plain().width(ZERO_WIDTH).label(label))
                }
            }
        }
        MapKind::Outcome(_) => panel,
        MapKind::Number(Spread::Linear) => panel.with(Contours::about(field, LEVELS)),
        MapKind::Number(_) => {
            let levels = field.extremes().map_or_else(Vec::new, round_ratios);
            panel.with(Contours::new(field, levels))
        }
    };
    Ok(panel.with_all(map.over.iter().cloned()))
}

/// Factor by which a number is multiplied for display.
fn shown_scale(map: &MappedQuantity) -> f64 {
    if map.kind == MapKind::ResidualVibration { 100.0 } else { 1.0 }
}

fn shown_quantity(map: &MappedQuantity) -> PlotAxis {
    if map.kind == MapKind::ResidualVibration {
        map.quantity.clone().unit("%")
    } else {
        map.quantity.clone()
    }
}

/// The colours, the same in all panels.
fn colouring(map: &MappedQuantity) -> Colouring {
    let known = || map.values.iter().filter_map(|value| value.ok());
    let finite = known().filter(|value| value.is_finite());
    let range = finite
        .map(|value| (value, value))
        .reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)));
    let shading = match &map.kind {
        MapKind::ResidualVibration => Shading::new(Palette::Pale).range(0.0, 100.0),
        MapKind::Growth(spread) => {
            let shading = Shading::new(Palette::Sign).spread(*spread).signs("decay", "growth");
            range.map_or(shading.clone(), |(least, most)| shading.range(least, most))
        }
        MapKind::Number(spread) => {
            let shading = Shading::new(Palette::Pale).spread(*spread);
            range.map_or(shading.clone(), |(least, most)| shading.range(least, most))
        }
        MapKind::Outcome(outcomes) => {
            let tint = |(role, word): &(PlotRole, String)| Tint::new(*role, word.clone());
            return Colouring::Outcomes(outcomes.iter().map(tint).collect());
        }
    };
    Colouring::Shaded(shading)
}

/// Powers of ten within a range; in a small range also 2 and 5 times these powers.
fn round_ratios(PlotRange { lower: least, upper: most }: PlotRange) -> Vec<f64> {
    let (least, most) = (least.max(1e-12 * most), most);
    if most <= least {
        return Vec::new();
    }
    let leading: &[f64] = if most / least < 300.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let (mut levels, first) = (Vec::new(), libm::log10(least).floor());
    let mut decade = libm::pow(10.0, first);
    while decade < most {
        levels.extend(leading.iter().map(|digit| digit * decade));
        decade *= 10.0;
    }
    levels.retain(|level| *level > least && *level < most);
    levels
}

/// The quantity over one axis.
fn sweep(map: &MappedQuantity, x: &MapAxis) -> Result<Panel, PlotError> {
    let (order, at) = rising(x);
    // The constructor of the field rejects invalid axes.
    Field::from_fn(at.clone(), vec![0.0], |_, _| None)?;
    let values: Vec<Result<f64, usize>> = order.iter().map(|place| map.values[*place]).collect();
    let borders = borders(&at, &x.axis);
    let runs = |same: &dyn Fn(Result<f64, usize>) -> Option<usize>| -> Vec<(usize, f64, f64)> {
        let kinds: Vec<Option<usize>> = values.iter().map(|value| same(*value)).collect();
        let mut runs = Vec::new();
        let mut from = 0;
        for run in kinds.chunk_by(|one, other| one == other) {
            if let Some(kind) = run[0] {
                runs.push((kind, borders[from], borders[from + run.len()]));
            }
            from += run.len();
        }
        runs
    };
    let mut panel;
    if let MapKind::Outcome(outcomes) = &map.kind {
        let blank = PlotAxis { ticks: Some(Vec::new()), ..map.quantity.clone() };
        panel = Panel::new(x.axis.clone(), blank.between(0.0, 1.0)).legend(Legend::Above);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates; an unknown index has no word"
        )]
        let place = |value: Result<f64, usize>| value.ok().map(|value| value.round() as usize);
        for (number, from, to) in runs(&place) {
            if let Some((role, word)) = outcomes.get(number) {
                let region = Region::across_x(*role, from, to).fill(Fill::Outcome(number));
                panel = panel.with(region.label(word.clone()));
            }
        }
    } else {
        panel = Panel::new(x.axis.clone(), shown_quantity(map));
        if matches!(map.kind, MapKind::Growth(_)) {
            panel = panel.with(ReferenceLine::horizontal(0.0));
        }
        if matches!(map.kind, MapKind::Number(Spread::Log)) {
            panel.y = panel.y.clone().log();
        }
        let scale = shown_scale(map);
        let number = |value: &Result<f64, usize>| value.map_or(f64::NAN, |value| scale * value);
        // A point that is not finite leaves a gap in the curve.
        let points = PlotPoint::zip(at.iter().copied(), values.iter().map(number));
        panel = panel.with(Polyline::new(PlotRole::Exact, points));
    }
    for (number, from, to) in runs(&|value: Result<f64, usize>| value.err()) {
        let reason = map.reasons.get(number).map_or("no value", String::as_str);
        let gap = Region::across_x(PlotRole::Undecided, from, to).fill(Fill::Hatched);
        panel = panel.with(gap.label(reason));
    }
    let (Some(first), Some(last)) = (at.first(), at.last()) else { return Ok(panel) };
    panel.x = panel.x.clone().between(*first, *last);
    Ok(panel.with_all(map.over.iter().cloned()))
}

/// Cell borders halfway between neighbours along the axis; the outermost ones are the first and the last value.
fn borders(values: &[f64], axis: &PlotAxis) -> Vec<f64> {
    let halfway = |pair: &[f64]| match axis.scale {
        crate::plot::Scale::Log if pair[0] > 0.0 => (pair[0] * pair[1]).sqrt(),
        _ => 0.5 * (pair[0] + pair[1]),
    };
    let ends = (values.first().copied(), values.last().copied());
    ends.0.into_iter().chain(values.windows(2).map(halfway)).chain(ends.1).collect()
}
