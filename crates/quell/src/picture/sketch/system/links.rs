//! Draws springs, dampers and other couplings between bodies, and between a body and the ground.

use super::drawing::SystemDrawing;
use super::grid::{BodySeat, SUPPORT};
use super::link::SketchLink;
use crate::plot::{LabelSide, LineStyle, PlotPoint, Sketch, SketchInk, SketchPart, SketchShape};
use crate::words::counted;

use LabelSide::{Above, Below, Left, Right};

/// The most links that are listed below the boxes.
const MOST_LISTED: usize = 12;
/// Width and height of one of them.
const LISTED_WIDTH: f64 = 144.0;
const LISTED_HEIGHT: f64 = 28.0;
/// Draws the links.
pub(super) fn draw(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let mut listed: Vec<(&SketchLink, usize)> = Vec::new();
    for link in &drawing.links {
        let Some(other) = link.to else {
            sheet = support(sheet, drawing, link);
            continue;
        };
        let (from, to) = (drawing.grid.seat(link.from), drawing.grid.seat(other));
        if from.row == to.row && from.column + 1 == to.column {
            sheet = neighbours(sheet, drawing, link, (from, to));
        } else if let Some(track) = drawing.grid.track(link) {
            sheet = tracked(sheet, drawing, link, (from, to), track);
        } else if drawing.grid.wraps(link.from, other) {
            sheet = stubs(sheet, drawing, link, (from, to));
        } else {
            listed.push((link, other));
        }
    }
    list(sheet, drawing, &listed)
}

/// The name of a link and what it connects.
fn named(drawing: &SystemDrawing<'_>, link: &SketchLink, noun: &str) -> String {
    let name = |place: usize| drawing.bodies[place].name.as_str();
    match link.to {
        Some(to) => format!("{noun} between {} and {}", name(link.from), name(to)),
        None => format!("{noun} between {} and the ground", name(link.from)),
    }
}

/// A spring and a damper above a body, on a support.
fn support(mut sheet: Sketch, drawing: &SystemDrawing<'_>, link: &SketchLink) -> Sketch {
    let at = PlotPoint::new;
    let seat = drawing.grid.seat(link.from);
    let top = seat.top - SUPPORT;
    let (left, right) = (seat.left + 12.0, seat.left + 30.0);
    if link.stiffness.is_some() {
        let shape = SketchShape::Spring { from: at(left, seat.top), to: at(left, top) };
        let part = SketchPart::new("spring", named(drawing, link, "spring"), shape);
        sheet = sheet.with(part.label(link.symbol("k"), &[Left]));
    }
    if link.damping.is_some() {
        let shape = SketchShape::Damper { from: at(right, seat.top), to: at(right, top) };
        let part = SketchPart::new("damper", named(drawing, link, "damper"), shape);
        sheet = sheet.with(part.label(link.symbol("c"), &[Right]));
    }
    let shape = SketchShape::Ground { from: at(left - 10.0, top), to: at(right + 10.0, top) };
    sheet.with(SketchPart::new("ground", "ground", shape))
}

/// A link between two boxes next to each other.
fn neighbours(
    mut sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    link: &SketchLink,
    (from, to): (BodySeat, BodySeat),
) -> Sketch {
    let line = |level: f64| [from.right(), to.left].map(|across| PlotPoint::new(across, level));
    let both = link.stiffness.is_some() || !link.couplings.is_empty();
    let (upper, lower) = (from.top + 8.0, from.top + if both { 28.0 } else { 8.0 });
    if link.stiffness.is_some() {
        let [from, to] = line(upper);
        let shape = SketchShape::Spring { from, to };
        let part = SketchPart::new("spring", named(drawing, link, "spring"), shape);
        sheet = sheet.with(part.label(link.symbol("k"), &[Above]));
    }
    if link.damping.is_some() {
        let [from, to] = line(lower);
        let shape = SketchShape::Damper { from, to };
        let part = SketchPart::new("damper", named(drawing, link, "damper"), shape);
        sheet = sheet.with(part.label(link.symbol("c"), &[Below]));
    }
    if link.couplings.is_empty() {
        return sheet;
    }
    let level = if link.stiffness.is_some() { from.top + 18.0 } else { upper };
    let part = coupling(drawing, link, line(level).to_vec());
    sheet.with(part.label(letters(link), &[Above, Below]))
}

/// A dashed line for a coupling without spring.
fn coupling(drawing: &SystemDrawing<'_>, link: &SketchLink, points: Vec<PlotPoint>) -> SketchPart {
    let shape = SketchShape::Line { points, style: LineStyle::Dashed };
    SketchPart::new("coupling", named(drawing, link, "coupling"), shape).ink(SketchInk::Guide)
}

/// Letters of the matrices of a coupling.
fn letters(link: &SketchLink) -> String {
    let letters: Vec<String> =
        link.couplings.iter().map(|(letter, ..)| format!("${letter}$")).collect();
    letters.join(", ")
}

/// A link over the heads of the boxes between its ends.
fn tracked(
    sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    link: &SketchLink,
    (from, to): (BodySeat, BodySeat),
    (slot, level): (usize, f64),
) -> Sketch {
    let aside = 4.0 + 6.0 * slot as f64;
    let (left, right) = (from.right() - aside, to.right() - aside);
    let middle = 0.5 * (left + right);
    let at = PlotPoint::new;
    let legs = |inner: f64| {
        [
            vec![at(left, from.top), at(left, level), at(middle - inner, level)],
            vec![at(middle + inner, level), at(right, level), at(right, to.top)],
        ]
    };
    let line = |points: Vec<PlotPoint>| SketchShape::Line { points, style: LineStyle::Solid };
    let (class, mut label) = main_part(link);
    if class == "coupling" {
        let points = vec![at(left, from.top), at(left, level), at(right, level), at(right, to.top)];
        return sheet.with(coupling(drawing, link, points).label(label, &[Above]));
    }
    if link.stiffness.is_some() && link.damping.is_some() {
        label = format!("{label}, {}", link.symbol("c"));
    }
    let [one, other] = legs(16.0);
    let shape = element(class, at(middle - 16.0, level), at(middle + 16.0, level));
    let part = SketchPart::new(class, named(drawing, link, class), shape);
    let part = part.label(label, &[Above, Below]);
    let sheet = sheet.with(part.and(line(one)).and(line(other)));
    if link.couplings.is_empty() {
        return sheet;
    }
    let spot = SketchShape::Spot { at: PlotPoint::new(middle + 20.0, level) };
    let part =
        SketchPart::new("coupling", named(drawing, link, "coupling"), spot).ink(SketchInk::Guide);
    sheet.with(part.label(letters(link), &[Above, Below]))
}

/// The class of the part that represents a link by itself, and the letter of its symbol.
fn main_part(link: &SketchLink) -> (&'static str, String) {
    match (link.stiffness, link.damping) {
        (Some(_), _) => ("spring", link.symbol("k")),
        (None, Some(_)) => ("damper", link.symbol("c")),
        (None, None) => ("coupling", letters(link)),
    }
}

/// A spring, a damper or a dashed line between two points.
fn element(class: &str, from: PlotPoint, to: PlotPoint) -> SketchShape {
    match class {
        "spring" => SketchShape::Spring { from, to },
        "damper" => SketchShape::Damper { from, to },
        _ => SketchShape::Line { points: vec![from, to], style: LineStyle::Dashed },
    }
}

/// The two ends of a link between the end of a row and the beginning of the next, each with the name of the other body.
fn stubs(
    mut sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    link: &SketchLink,
    ends: (BodySeat, BodySeat),
) -> Sketch {
    let Some(to) = link.to else { return sheet };
    let (class, label) = main_part(link);
    let name = named(drawing, link, class);
    for (seat, sign, other) in [(ends.0, 1.0, to), (ends.1, -1.0, link.from)] {
        let level = seat.top + 18.0;
        let edge = if sign > 0.0 { seat.right() } else { seat.left };
        let [from, end] = [edge, edge + sign * 26.0].map(|across| PlotPoint::new(across, level));
        let dot = SketchShape::Dot { at: end, radius: 2.0 };
        let part = SketchPart::new(class, name.clone(), element(class, from, end)).and(dot);
        let part = part.label(label.clone(), &[Above]);
        sheet = sheet.with(part.label(drawing.bodies[other].lines[0].clone(), &[Below]));
    }
    sheet
}

/// Links that no line between their boxes could show clearly: in rows below the boxes, each with the names of its ends.
fn list(mut sheet: Sketch, drawing: &SystemDrawing<'_>, links: &[(&SketchLink, usize)]) -> Sketch {
    let room = sheet.room();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let columns = ((room / LISTED_WIDTH).floor() as usize).max(1);
    let across = columns.min(links.len()) as f64;
    let first = drawing.grid.middle() - 0.5 * LISTED_WIDTH * across;
    for (place, (link, to)) in links.iter().take(MOST_LISTED).enumerate() {
        let left = first + LISTED_WIDTH * (place % columns) as f64;
        let level = drawing.grid.bottom() + 16.0 + LISTED_HEIGHT * (place / columns) as f64;
        let [from, end] = [left + 52.0, left + 92.0].map(|across| PlotPoint::new(across, level));
        let (class, label) = main_part(link);
        let shape = element(class, from, end);
        let name = named(drawing, link, class);
        let part = SketchPart::new(class, name, shape).label(label, &[Above]);
        let part = part.label(drawing.bodies[link.from].lines[0].clone(), &[Left]);
        sheet = sheet.with(part.label(drawing.bodies[*to].lines[0].clone(), &[Right]));
    }
    if links.len() > MOST_LISTED {
        let rows = MOST_LISTED.div_ceil(columns);
        let level = drawing.grid.bottom() + 16.0 + LISTED_HEIGHT * rows as f64;
        let words = counted(links.len() - MOST_LISTED, "further link");
        let spot = SketchShape::Spot { at: PlotPoint::new(drawing.grid.middle(), level) };
        sheet = sheet.with(SketchPart::new("coupling", words.clone(), spot).label(words, &[Below]));
    }
    sheet
}
