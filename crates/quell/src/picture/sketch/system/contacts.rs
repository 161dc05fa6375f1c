//! Contacts below the bodies: a pad on a moving surface, with its normal load and friction, or several of them as one.

use quell_model::Contact;

use super::body::{BodyKind, SketchBody};
use super::contact_place::{PAD, ROD, SPRING, home, is_compliant, mark, state_height};
use super::drawing::SystemDrawing;
use super::grid::BodySeat;
use crate::picture::sketch::symbols::{index, indexed};
use crate::plot::{
    FrameSize, LabelSide, LineStyle, PlotPoint, PlotRange, Sketch, SketchInk, SketchPart,
    SketchShape,
};
use crate::words::counted;

use LabelSide::{Above, Below, Left, Right};

/// The most contacts that are drawn below one body; more are drawn as one with their count.
const MOST_CONTACTS: usize = 1;
/// The contacts of each body.
pub(super) fn by_body<'a>(drawing: &SystemDrawing<'a>) -> Vec<(usize, Vec<(usize, &'a Contact)>)> {
    let mut groups: Vec<(usize, Vec<(usize, &Contact)>)> = Vec::new();
    for (place, contact) in drawing.study.system().contacts.iter().enumerate() {
        let body = home(contact, &drawing.bodies).unwrap_or(0);
        match groups.iter_mut().find(|(known, _)| *known == body) {
            Some((_, group)) => group.push((place, contact)),
            None => groups.push((body, vec![(place, contact)])),
        }
    }
    groups
}

/// Where the contacts of a body are drawn: the middle of the pads, side by side.
fn places(drawing: &SystemDrawing<'_>, body: usize, count: usize) -> Vec<f64> {
    let seat = drawing.grid.seat(body);
    if count <= fit(&drawing.bodies[body], &seat) {
        let pitch = 60.0;
        let first = seat.middle() - 0.5 * pitch * (count as f64 - 1.0);
        (0..count).map(|place| first + pitch * place as f64).collect()
    } else {
        vec![seat.middle()]
    }
}

/// How many contacts fit below a body.
fn fit(body: &SketchBody, seat: &BodySeat) -> usize {
    match body.kind {
        BodyKind::Mass => MOST_CONTACTS,
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a small count"
        )]
        _ => (seat.width / 58.0).floor() as usize,
    }
}

/// Draws the contacts.
pub(super) fn draw(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let count = drawing.study.system().contacts.len();
    for (body, group) in by_body(drawing) {
        let spots = places(drawing, body, group.len());
        if spots.len() == group.len() {
            for (across, (place, contact)) in spots.into_iter().zip(group) {
                let index = index(place, count);
                sheet = one(sheet, drawing, contact, (body, across), &index);
            }
        } else {
            sheet = several(sheet, drawing, &group, (body, spots[0]));
        }
    }
    sheet
}

/// The level of the pad's upper side.
fn pad_level(drawing: &SystemDrawing<'_>, body: usize, is_soft: bool) -> f64 {
    let row = drawing.grid.seat(body).row;
    let contacts = &drawing.study.system().contacts;
    let in_row = |contact: &&Contact| {
        home(contact, &drawing.bodies).is_some_and(|body| drawing.grid.seat(body).row == row)
    };
    let is_soft = is_soft || contacts.iter().filter(in_row).any(is_compliant);
    drawing.grid.seat(body).bottom() + if is_soft { SPRING } else { ROD }
}

/// Draws one contact below a body at a horizontal position.
fn one(
    sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    contact: &Contact,
    (body, across): (usize, f64),
    index: &str,
) -> Sketch {
    let at = PlotPoint::new;
    let seat = drawing.grid.seat(body);
    let pad = pad_level(drawing, body, is_compliant(contact));
    let ink = SketchInk::Contact;
    let normal = contact.normal.as_deref().map(|row| drawing.touched(row)).unwrap_or_default();
    let is_own = normal.iter().any(|(touched, _)| *touched == body);
    let drawn_at = normal.iter().find(|(other, _)| reaches(drawing, (body, *other), pad));
    let block =
        SketchShape::Block { corner: at(across - 14.0, pad), size: FrameSize::new(28.0, PAD) };
    let mut part = SketchPart::new("contact", format!("contact {}", contact.name), block).ink(ink);
    let mut sheet = sheet;
    if is_compliant(contact) && (is_own || drawn_at.is_none()) {
        sheet = stiffness(sheet, contact, (across, seat.bottom(), pad), index);
    } else {
        let points = vec![at(across, seat.bottom()), at(across, pad)];
        part = part.and(SketchShape::Line { points, style: LineStyle::Solid });
    }
    sheet = sheet.with(part);
    let spring_at = drawn_at.filter(|_| !is_own && is_compliant(contact)).map(|(other, _)| *other);
    for (other, _) in normal.iter().filter(|(touched, _)| *touched != body) {
        sheet = if spring_at == Some(*other) {
            approach(sheet, drawing, contact, *other, at(across, pad), index)
        } else {
            lead(sheet, drawing, contact, (body, *other), at(across, pad))
        };
    }
    let mut met: Vec<usize> = normal.iter().map(|(touched, _)| *touched).collect();
    for row in [&contact.tangent, &contact.force, &contact.slope].into_iter().flatten() {
        for (other, _) in drawing.touched(row).into_iter().filter(|(touched, _)| *touched != body) {
            if !met.contains(&other) {
                met.push(other);
                sheet = lead(sheet, drawing, contact, (body, other), at(across, pad));
            }
        }
    }
    let from_left = met.iter().any(|&other| {
        let (seat, far) = (drawing.grid.seat(body), drawing.grid.seat(other));
        seat.row == far.row && far.column + 1 == seat.column
    });
    if let Some(mark) = mark(contact) {
        let within = (across - 22.0, across + 22.0);
        let of = format!(" of contact {}", contact.name);
        sheet = mark.draw(sheet, within, pad + PAD, (&of, &tangential_symbol(index)));
    }
    loads(sheet, at(across, pad + PAD + state_height(contact)), contact, (index, from_left))
}

/// The spring and damper of a compliant contact, from `top` to `bottom`.
fn stiffness(
    sheet: Sketch,
    contact: &Contact,
    (across, top, bottom): (f64, f64, f64),
    index: &str,
) -> Sketch {
    let at = PlotPoint::new;
    let has_damper = contact.normal_damping != 0.0;
    let apart = if has_damper { 8.0 } else { 0.0 };
    let shape =
        SketchShape::Spring { from: at(across - apart, top), to: at(across - apart, bottom) };
    let name = format!("normal stiffness of contact {}", contact.name);
    let label = stiffness_symbol(index);
    let sheet = sheet.with(
        SketchPart::new("contact-spring", name, shape)
            .ink(SketchInk::Contact)
            .label(label, &[Left, Right]),
    );
    if !has_damper {
        return sheet;
    }
    let shape =
        SketchShape::Damper { from: at(across + apart, top), to: at(across + apart, bottom) };
    let name = format!("normal damping of contact {}", contact.name);
    let label = indexed("d", index);
    sheet.with(
        SketchPart::new("contact-damper", name, shape)
            .ink(SketchInk::Contact)
            .label(label, &[Right]),
    )
}

/// Symbol of the normal stiffness of a contact: $k$ alone would be that of a spring.
pub(super) fn stiffness_symbol(index: &str) -> String {
    indexed("k", &format!("n{index}"))
}

/// Symbol of the tangential stiffness of a contact.
pub(super) fn tangential_symbol(index: &str) -> String {
    indexed("k", &format!("t{index}"))
}

/// Whether a line from the pad of a contact below one body reaches another one: its neighbour, high enough for a spring.
fn reaches(drawing: &SystemDrawing<'_>, (body, other): (usize, usize), pad: f64) -> bool {
    let (seat, far) = (drawing.grid.seat(body), drawing.grid.seat(other));
    let is_next = seat.row == far.row && seat.column.abs_diff(far.column) == 1;
    is_next && pad - far.bottom() >= SPRING
}

/// A normal row that acts on a neighbour: the spring below it and a line to the pad.
fn approach(
    sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    contact: &Contact,
    other: usize,
    PlotPoint { x: across, y: pad }: PlotPoint,
    index: &str,
) -> Sketch {
    let at = PlotPoint::new;
    let far = drawing.grid.seat(other);
    let sign = (far.middle() - across).signum();
    let corner = far.middle() - sign * 0.3 * far.width;
    let level = pad + 0.5 * PAD;
    let sheet = stiffness(sheet, contact, (corner, far.bottom(), pad - 2.0), index);
    let points = vec![at(corner, pad - 2.0), at(corner, level), at(across + sign * 14.0, level)];
    let shape = SketchShape::Line { points, style: LineStyle::Solid };
    let name = format!("approach of contact {}", contact.name);
    sheet.with(SketchPart::new("guide", name, shape).ink(SketchInk::Contact))
}

/// A dashed line from a contact to another body that it acts on, or a note at that body.
fn lead(
    sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    contact: &Contact,
    (body, other): (usize, usize),
    PlotPoint { x: across, y: pad }: PlotPoint,
) -> Sketch {
    let at = PlotPoint::new;
    let (seat, far) = (drawing.grid.seat(body), drawing.grid.seat(other));
    let name = format!("contact {} acts on {}", contact.name, drawing.bodies[other].name);
    let is_next = seat.row == far.row && seat.column.abs_diff(far.column) == 1;
    if !is_next {
        let shape = SketchShape::Line {
            points: vec![
                at(far.left + 14.0, far.bottom()),
                at(far.left + 14.0, far.bottom() + 8.0),
            ],
            style: LineStyle::Dashed,
        };
        let dot = SketchShape::Dot { at: at(far.left + 14.0, far.bottom() + 8.0), radius: 2.0 };
        let part = SketchPart::new("guide", name, shape).and(dot).ink(SketchInk::Contact);
        return sheet.with(part.label(contact.name.clone(), &[Right, Left]));
    }
    let sign = (far.middle() - across).signum();
    let corner = far.middle() - sign * 0.4 * far.width;
    let level = pad + 0.5 * PAD;
    let points = vec![at(across + sign * 14.0, level), at(corner, level), at(corner, far.bottom())];
    let shape = SketchShape::Line { points, style: LineStyle::Dashed };
    sheet.with(SketchPart::new("guide", name, shape).ink(SketchInk::Contact))
}

/// The surface, its velocity, the normal load and the friction force.
fn loads(
    sheet: Sketch,
    PlotPoint { x: across, y: level }: PlotPoint,
    contact: &Contact,
    (index, from_left): (&str, bool),
) -> Sketch {
    let at = PlotPoint::new;
    let ink = SketchInk::Contact;
    let of = |noun: &str| format!("{noun} of contact {}", contact.name);
    let surface =
        SketchShape::Surface { ends: PlotRange::new(across - 26.0, across + 26.0), top: level };
    let velocity = SketchShape::Arrow {
        from: at(across + 2.0, level + 13.0),
        to: at(across + 26.0, level + 13.0),
    };
    let load = SketchShape::Arrow {
        from: at(across - 12.0, level + 33.0),
        to: at(across - 12.0, level + 7.0),
    };
    // A line from the left would cover the arrow.
    let (tail, head) = if from_left { (15.0, 31.0) } else { (-31.0, -15.0) };
    let friction = SketchShape::Arrow {
        from: at(across + tail, level - 4.0),
        to: at(across + head, level - 4.0),
    };
    sheet
        .with(SketchPart::new("surface", of("moving surface"), surface))
        .with(
            SketchPart::new("velocity", of("velocity of the surface"), velocity)
                .ink(ink)
                .label(indexed("v", index), &[Below, Right]),
        )
        .with(
            SketchPart::new("load", of("normal load"), load)
                .ink(ink)
                .label(indexed("N", index), &[Left, Right]),
        )
        .with(
            SketchPart::new("friction", of("friction force"), friction).ink(ink).label(
                indexed("T", index),
                if from_left { &[Right, Above] } else { &[Left, Above] },
            ),
        )
}

/// Several contacts below one body as one.
fn several(
    sheet: Sketch,
    drawing: &SystemDrawing<'_>,
    group: &[(usize, &Contact)],
    (body, across): (usize, f64),
) -> Sketch {
    let seat = drawing.grid.seat(body);
    let pad = pad_level(drawing, body, false);
    let ink = SketchInk::Contact;
    let mut sheet = sheet;
    for (number, offset) in [-22.0, 0.0, 22.0].into_iter().enumerate().take(group.len().max(2)) {
        let at = across + offset;
        let block = SketchShape::Block {
            corner: PlotPoint::new(at - 8.0, pad),
            size: FrameSize::new(16.0, PAD),
        };
        let points = vec![PlotPoint::new(at, seat.bottom()), PlotPoint::new(at, pad)];
        let part = SketchPart::new(
            "contact",
            if number == 0 { names(group) } else { String::new() },
            block,
        );
        sheet =
            sheet.with(part.and(SketchShape::Line { points, style: LineStyle::Solid }).ink(ink));
    }
    let surface =
        SketchShape::Surface { ends: PlotRange::new(across - 40.0, across + 40.0), top: pad + PAD };
    let part = SketchPart::new("surface", "moving surfaces", surface);
    sheet.with(part.label(counted(group.len(), "contact"), &[Below]))
}

fn names(group: &[(usize, &Contact)]) -> String {
    let names: Vec<&str> = group.iter().map(|(_, contact)| contact.name.as_str()).collect();
    format!("contacts {}", names.join(", "))
}

/// Where the normal load and the friction of a contact are drawn: below the tail of the load's arrow, and left of the pad.
pub(super) fn spot(drawing: &SystemDrawing<'_>, contact: usize) -> Option<ContactSpot> {
    for (body, group) in by_body(drawing) {
        let Some(place) = group.iter().position(|(known, _)| *known == contact) else { continue };
        let spots = places(drawing, body, group.len());
        let across = spots.get(place).or(spots.first()).copied()?;
        let pad = pad_level(drawing, body, is_compliant(group[place].1));
        let level = pad + PAD + state_height(group[place].1);
        return Some(ContactSpot {
            load: PlotPoint::new(across - 12.0, level + 26.0),
            friction: PlotPoint::new(across - 30.0, level - 4.0),
        });
    }
    None
}

/// Positions of the forces of a contact.
pub(super) struct ContactSpot {
    pub(super) load: PlotPoint,
    pub(super) friction: PlotPoint,
}
