//! A map over one axis: one panel a variable.
//!
//! Curves are broken where a number is not known; words are drawn as the steps between them.

use crate::plot::{Axis, Figure, Line, Panel, Role};
use crate::run::map::Map;
use crate::sweep::{Entry, Kind};

/// The picture of a map over one axis.
pub fn curve(map: &Map) -> Figure {
    let plan = map.plan();
    let entries = plan.sheet().entries();
    let panels = entries.iter().map(|entry| panel(map, entry));
    let title = plan.grid().study().title().unwrap_or_default();
    let figure = if entries.len() == 1 {
        Figure::grid(1, panels)
    } else {
        Figure::grid(entries.len().min(2), panels)
    };
    figure.title(title).caption(super::caption::caption_of_run(plan.grid().study()))
}

fn panel(map: &Map, entry: &Entry) -> Panel {
    let plan = map.plan();
    let Some(swept) = plan.grid().axes().first() else {
        return Panel::new(Axis::new(""), Axis::new(""));
    };
    let mut across = labelled(Axis::new(swept.about), swept.symbol.unwrap_or(""), swept.unit);
    if swept.logarithmic {
        across = across.log();
    }
    let variable = &entry.variable;
    let array = entry.twin.unwrap_or(entry.value);
    let unit = &plan.sheet().fields()[array].unit;
    let mut up = labelled(Axis::new(variable.about), variable.symbol, unit);
    if let Kind::Word { words, .. } = variable.kind {
        up = Axis::new(format!("{} (0 {})", variable.about, words.join(", 1 ")));
        up = up.between(-0.1, 1.1).ticks([0.0, 1.0]);
    }
    let value = |point| match entry.twin {
        Some(_) => map.number_in_si(entry, point),
        None => map.number(entry, point),
    };
    let mut pieces: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for (point, place) in swept.values.iter().enumerate() {
        match (value(point), pieces.last_mut()) {
            (Some(value), Some(piece)) => piece.push((*place, value)),
            (None, Some(piece)) if !piece.is_empty() => pieces.push(Vec::new()),
            _ => {}
        }
    }
    Panel::new(across, up).with(Line::pieces(Role::Dithered, pieces))
}

/// An axis with symbol and unit; numbers of the equations carry none.
fn labelled(axis: Axis, symbol: &str, unit: &str) -> Axis {
    let axis = if symbol.is_empty() { axis } else { axis.symbol(symbol) };
    let scaled = unit.is_empty() || unit == "1" || unit.contains(['ω', '(']) || unit == "length";
    if scaled { axis } else { axis.unit(unit) }
}
