//! Shapes of mechanical drawings as strokes and fills.

use std::f64::consts::{PI, TAU};

use crate::canvas::Rectangle;
use crate::palette::{self, Colour, LineStyle, PlotRole};

/// A position in pixels of 1/96 inch from the upper left.
type Spot = (f64, f64);

/// The colour of a part. Kinds of parts differ in shape too, so that a print in grey can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SketchInk {
    /// Masses, springs and supports: nearly black.
    #[default]
    Structure,
    /// Contacts, their loads and moving surfaces: vermillion.
    Contact,
    /// Inputs: blue.
    Input,
    /// Lines that only connect or guide: grey.
    Guide,
}

impl SketchInk {
    pub(super) fn colour(self) -> Colour {
        match self {
            Self::Structure => palette::FRAME,
            Self::Contact => PlotRole::Unstable.colour(),
            Self::Input => PlotRole::Dithered.colour(),
            Self::Guide => palette::FAINT,
        }
    }
}

/// A periodic wave as a small symbol.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WaveGlyph {
    /// ∿
    Sine,
    /// ⊓⊔
    Square,
    /// △▽
    Triangle,
}

/// A shape. Positions are (x, y) in pixels of 1/96 inch, y downwards; the sketch is centred on its sheet as a whole.
#[derive(Debug, Clone, PartialEq)]
pub enum SketchShape {
    /// A box: upper left corner, width and height.
    Block {
        /// Upper left corner.
        corner: (f64, f64),
        /// Width and height.
        size: (f64, f64),
    },
    /// A coil spring as a zigzag.
    Spring {
        /// One end.
        from: (f64, f64),
        /// The other end.
        to: (f64, f64),
    },
    /// A dashpot.
    Damper {
        /// The end of the piston rod.
        from: (f64, f64),
        /// The end of the cylinder.
        to: (f64, f64),
    },
    /// A fixed support: a line with hatching on its left, seen from `from` to `to`.
    Ground {
        /// One end.
        from: (f64, f64),
        /// The other end.
        to: (f64, f64),
    },
    /// An endless belt on two rollers, whose upper side is at `top`.
    Belt {
        /// Left and right end of the upper side.
        ends: (f64, f64),
        /// Height of the upper side.
        top: f64,
        /// Radius of the rollers.
        radius: f64,
    },
    /// A moving surface: a horizontal line with hatching below it.
    Surface {
        /// Left and right end.
        ends: (f64, f64),
        /// Its height.
        top: f64,
    },
    /// A polyline.
    Line {
        /// Its points.
        points: Vec<(f64, f64)>,
        /// Its dashes.
        style: LineStyle,
    },
    /// A straight arrow with its head at `to`.
    Arrow {
        /// The tail.
        from: (f64, f64),
        /// The head.
        to: (f64, f64),
    },
    /// An arrow along a circle, from one angle to another (degrees, counter-clockwise from the right).
    Turn {
        /// Centre of the circle.
        centre: (f64, f64),
        /// Its radius.
        radius: f64,
        /// Angles of tail and head.
        angles: (f64, f64),
    },
    /// One and a half periods of a wave.
    Wave {
        /// The centre.
        at: (f64, f64),
        /// Its form.
        glyph: WaveGlyph,
    },
    /// An annular disc in plan.
    Ring {
        /// The centre.
        centre: (f64, f64),
        /// Outer and inner radius.
        radii: (f64, f64),
    },
    /// A part of an annulus between two angles (degrees, counter-clockwise from the right), filled.
    Sector {
        /// The centre.
        centre: (f64, f64),
        /// Outer and inner radius.
        radii: (f64, f64),
        /// The two angles.
        angles: (f64, f64),
    },
    /// A filled point.
    Dot {
        /// The centre.
        at: (f64, f64),
        /// The radius.
        radius: f64,
    },
    /// Nothing that is drawn: a position for a label.
    Spot {
        /// The position.
        at: (f64, f64),
    },
}

/// A closed area and its fill.
pub(super) struct FilledArea {
    pub(super) outline: Vec<Spot>,
    /// Whether it has the ink of the part; else it is a pale surface.
    pub(super) inked: bool,
}

/// What is drawn of a shape.
#[derive(Default)]
pub(super) struct ShapeStrokes {
    /// Solid lines of the usual width.
    pub(super) lines: Vec<Vec<Spot>>,
    /// Thin lines, such as hatching.
    pub(super) thin: Vec<Vec<Spot>>,
    pub(super) fills: Vec<FilledArea>,
    /// Closed lines with a hole: the outlines of a ring.
    pub(super) style: Option<LineStyle>,
}

const COIL: f64 = 5.0;
const HATCH: f64 = 5.0;

impl SketchShape {
    /// Lines and areas of the shape.
    pub(super) fn strokes(&self) -> ShapeStrokes {
        let mut drawn = ShapeStrokes::default();
        match self {
            Self::Block { .. } => {
                let outline = corners(self.area());
                drawn.fills.push(FilledArea { outline: outline.clone(), inked: false });
                drawn.lines.push(outline);
            }
            Self::Spring { from, to } => drawn.lines.push(zigzag(*from, *to)),
            Self::Damper { from, to } => drawn.lines.extend(dashpot(*from, *to)),
            Self::Ground { from, to } => {
                drawn.lines.push(vec![*from, *to]);
                drawn.thin.extend(hatching(*from, *to));
            }
            Self::Belt { ends, top, radius } => belt(&mut drawn, *ends, *top, *radius),
            Self::Surface { ends, top } => {
                drawn.lines.push(vec![(ends.0, *top), (ends.1, *top)]);
                drawn.thin.extend(hatching((ends.1, *top), (ends.0, *top)));
            }
            Self::Line { points, style } => {
                drawn.lines.push(points.clone());
                drawn.style = Some(*style);
            }
            Self::Arrow { from, to } => arrow(&mut drawn, *from, *to),
            Self::Turn { centre, radius, angles } => turn(&mut drawn, *centre, *radius, *angles),
            Self::Wave { at, glyph } => drawn.lines.push(wave(*at, *glyph)),
            Self::Ring { centre, radii } => {
                let (outer, inner) = (circle(*centre, radii.0), circle(*centre, radii.1));
                let outline = outer.iter().chain(inner.iter().rev()).copied().collect();
                drawn.fills.push(FilledArea { outline, inked: false });
                drawn.lines.extend([outer, inner]);
            }
            Self::Sector { centre, radii, angles } => {
                let outline = sector(*centre, *radii, *angles);
                drawn.fills.push(FilledArea { outline, inked: true });
            }
            Self::Dot { at, radius } => {
                drawn.fills.push(FilledArea { outline: circle(*at, *radius), inked: true });
            }
            Self::Spot { .. } => {}
        }
        drawn
    }

    /// The rectangle around the shape.
    pub(super) fn area(&self) -> Rectangle {
        match self {
            Self::Block { corner, size } => Rectangle {
                left: corner.0,
                top: corner.1,
                right: corner.0 + size.0,
                bottom: corner.1 + size.1,
            },
            Self::Spot { at } => Rectangle { left: at.0, top: at.1, right: at.0, bottom: at.1 },
            _ => {
                let drawn = self.strokes();
                let outlines = drawn.fills.iter().map(|filled| &filled.outline);
                bounds(drawn.lines.iter().chain(&drawn.thin).chain(outlines).flatten())
            }
        }
    }

    /// The same shape at another position.
    pub(super) fn moved(&self, (dx, dy): Spot) -> Self {
        let by = |spot: &Spot| (spot.0 + dx, spot.1 + dy);
        match self.clone() {
            Self::Block { corner, size } => Self::Block { corner: by(&corner), size },
            Self::Spring { from, to } => Self::Spring { from: by(&from), to: by(&to) },
            Self::Damper { from, to } => Self::Damper { from: by(&from), to: by(&to) },
            Self::Ground { from, to } => Self::Ground { from: by(&from), to: by(&to) },
            Self::Belt { ends, top, radius } => {
                Self::Belt { ends: (ends.0 + dx, ends.1 + dx), top: top + dy, radius }
            }
            Self::Surface { ends, top } => {
                Self::Surface { ends: (ends.0 + dx, ends.1 + dx), top: top + dy }
            }
            Self::Line { points, style } => {
                Self::Line { points: points.iter().map(by).collect(), style }
            }
            Self::Arrow { from, to } => Self::Arrow { from: by(&from), to: by(&to) },
            Self::Turn { centre, radius, angles } => {
                Self::Turn { centre: by(&centre), radius, angles }
            }
            Self::Wave { at, glyph } => Self::Wave { at: by(&at), glyph },
            Self::Ring { centre, radii } => Self::Ring { centre: by(&centre), radii },
            Self::Sector { centre, radii, angles } => {
                Self::Sector { centre: by(&centre), radii, angles }
            }
            Self::Dot { at, radius } => Self::Dot { at: by(&at), radius },
            Self::Spot { at } => Self::Spot { at: by(&at) },
        }
    }

    /// Lines that a text must not cover, those through the interior of an area included.
    pub(super) fn barriers(&self) -> Vec<Vec<Spot>> {
        let drawn = self.strokes();
        let mut lines: Vec<Vec<Spot>> = drawn.lines.into_iter().chain(drawn.thin).collect();
        for filled in drawn.fills.iter().filter(|filled| filled.inked) {
            lines.push(filled.outline.clone());
        }
        if let Self::Block { .. } = self {
            let outline = corners(self.area());
            lines.extend([vec![outline[0], outline[2]], vec![outline[1], outline[3]]]);
        }
        lines
    }
}

/// The rectangle around some points; empty at the origin without points.
pub(super) fn bounds<'a>(points: impl Iterator<Item = &'a Spot>) -> Rectangle {
    let mut area: Option<Rectangle> = None;
    for &(x, y) in points {
        let known = area.get_or_insert(Rectangle { left: x, top: y, right: x, bottom: y });
        known.left = known.left.min(x);
        known.top = known.top.min(y);
        known.right = known.right.max(x);
        known.bottom = known.bottom.max(y);
    }
    area.unwrap_or(Rectangle { left: 0.0, top: 0.0, right: 0.0, bottom: 0.0 })
}

/// A closed outline.
fn corners(area: Rectangle) -> Vec<Spot> {
    let Rectangle { left, top, right, bottom } = area;
    vec![(left, top), (right, top), (right, bottom), (left, bottom), (left, top)]
}

/// The point at a distance along and across the line between two points (to the right of it, y downwards).
fn along(from: Spot, to: Spot, distance: f64, across: f64) -> Spot {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
    let (ux, uy) = (dx / length, dy / length);
    (from.0 + distance * ux - across * uy, from.1 + distance * uy + across * ux)
}

fn length(from: Spot, to: Spot) -> f64 {
    (to.0 - from.0).hypot(to.1 - from.1)
}

fn zigzag(from: Spot, to: Spot) -> Vec<Spot> {
    let whole = length(from, to);
    // A long lead does not lengthen the coils.
    let coils = whole.min(34.0) * 0.7;
    let lead = 0.5 * (whole - coils);
    let turns = 4;
    let mut points = vec![from, along(from, to, lead, 0.0)];
    for number in 0..2 * turns {
        let distance = lead + coils * (f64::from(number) + 0.5) / f64::from(2 * turns);
        let side = if number % 2 == 0 { COIL } else { -COIL };
        points.push(along(from, to, distance, side));
    }
    points.extend([along(from, to, whole - lead, 0.0), to]);
    points
}

fn dashpot(from: Spot, to: Spot) -> [Vec<Spot>; 4] {
    let whole = length(from, to);
    let half = 0.5 * (whole.min(24.0) * 0.5);
    let middle = 0.5 * whole;
    let at = |distance: f64, across: f64| along(from, to, distance, across);
    let (open, back) = (middle - half, middle + half);
    [
        vec![from, at(middle, 0.0)],
        vec![at(middle, -3.5), at(middle, 3.5)],
        vec![at(open, -5.0), at(back, -5.0), at(back, 5.0), at(open, 5.0)],
        vec![at(back, 0.0), to],
    ]
}

/// Short strokes on the left of a line, seen from `from` to `to`.
fn hatching(from: Spot, to: Spot) -> Vec<Vec<Spot>> {
    let whole = length(from, to);
    let mut strokes = Vec::new();
    let mut distance = 1.0;
    while distance < whole {
        let foot = (distance - HATCH).max(-1.0);
        strokes.push(vec![along(from, to, distance, 0.0), along(from, to, foot, -HATCH)]);
        distance += HATCH;
    }
    strokes
}

fn belt(drawn: &mut ShapeStrokes, (left, right): (f64, f64), top: f64, radius: f64) {
    let middle = top + radius;
    let centres = [(left + radius, middle), (right - radius, middle)];
    for centre in centres {
        drawn.thin.push(circle(centre, radius - 2.5));
        drawn.fills.push(FilledArea { outline: circle(centre, 1.5), inked: true });
    }
    let mut outline = arc(centres[0], radius, 90.0, 270.0);
    outline.extend(arc(centres[1], radius, 270.0, 450.0));
    outline.push(outline[0]);
    drawn.lines.push(outline);
}

fn arrow(drawn: &mut ShapeStrokes, from: Spot, to: Spot) {
    let whole = length(from, to);
    drawn.lines.push(vec![from, along(from, to, (whole - 4.0).max(0.0), 0.0)]);
    let foot = whole - 7.0;
    let head = vec![to, along(from, to, foot, -3.0), along(from, to, foot, 3.0), to];
    drawn.fills.push(FilledArea { outline: head, inked: true });
}

fn turn(drawn: &mut ShapeStrokes, centre: Spot, radius: f64, (from, to): (f64, f64)) {
    let points = arc(centre, radius, from, to);
    let Some(&end) = points.last() else { return };
    // The head points along the tangent at its middle.
    let sign = if to > from { 1.0 } else { -1.0 };
    let slope = (to - sign * 90.0 / radius.max(1.0) * 2.0).to_radians();
    let (ux, uy) = (-sign * slope.sin(), -sign * slope.cos());
    let back = |distance: f64, across: f64| {
        (end.0 - distance * ux - across * uy, end.1 - distance * uy + across * ux)
    };
    let tip = back(-4.0, 0.0);
    drawn
        .fills
        .push(FilledArea { outline: vec![tip, back(3.0, 3.0), back(3.0, -3.0), tip], inked: true });
    drawn.lines.push(points);
}

/// Points along a circle between two angles (degrees, counter-clockwise).
pub(super) fn arc(centre: Spot, radius: f64, from: f64, to: f64) -> Vec<Spot> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let steps = ((to - from).abs() / 5.0).ceil().clamp(1.0, 360.0) as usize;
    let point = |step: usize| {
        let angle = (from + (to - from) * step as f64 / steps as f64).to_radians();
        (centre.0 + radius * angle.cos(), centre.1 - radius * angle.sin())
    };
    (0..=steps).map(point).collect()
}

fn circle(centre: Spot, radius: f64) -> Vec<Spot> {
    arc(centre, radius, 0.0, 360.0)
}

fn sector(centre: Spot, radii: (f64, f64), angles: (f64, f64)) -> Vec<Spot> {
    let mut outline = arc(centre, radii.0, angles.0, angles.1);
    outline.extend(arc(centre, radii.1, angles.1, angles.0));
    outline.push(outline[0]);
    outline
}

fn wave(at: Spot, glyph: WaveGlyph) -> Vec<Spot> {
    let (width, height) = (16.0, 4.0);
    // Phase in turns, and the value there.
    let samples: Vec<(f64, f64)> = match glyph {
        WaveGlyph::Sine => (0..=36)
            .map(|step| f64::from(step) / 24.0)
            .map(|phase| (phase, (TAU * phase).sin()))
            .collect(),
        WaveGlyph::Square => vec![
            (0.0, 0.0),
            (0.0, 1.0),
            (0.5, 1.0),
            (0.5, -1.0),
            (1.0, -1.0),
            (1.0, 1.0),
            (1.5, 1.0),
            (1.5, 0.0),
        ],
        WaveGlyph::Triangle => {
            (0..=6).map(|step| f64::from(step) / 4.0).map(|p| (p, triangle(p))).collect()
        }
    };
    let place =
        |(phase, value): (f64, f64)| (at.0 + width * (phase / 1.5 - 0.5), at.1 - height * value);
    samples.into_iter().map(place).collect()
}

/// A triangle wave of period 1 that rises through 0 at 0.
fn triangle(phase: f64) -> f64 {
    (TAU * phase).sin().asin() * 2.0 / PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spring_ends_at_its_ends_and_has_its_coils_between_them() {
        let points = zigzag((10.0, 20.0), (10.0, 80.0));
        assert_eq!((points[0], points[points.len() - 1]), ((10.0, 20.0), (10.0, 80.0)));
        let area = bounds(points.iter());
        assert!((area.left - 5.0).abs() < 1e-12 && (area.right - 15.0).abs() < 1e-12);
    }

    #[test]
    fn hatching_of_a_ceiling_is_above_it_and_of_a_floor_below() {
        let ceiling = hatching((0.0, 50.0), (40.0, 50.0));
        assert!(ceiling.iter().flatten().all(|spot| spot.1 <= 50.0));
        let floor = SketchShape::Surface { ends: (0.0, 40.0), top: 50.0 }.area();
        assert!((floor.top - 50.0).abs() < 1e-12 && floor.bottom > 50.0);
    }

    #[test]
    fn angles_are_counted_counter_clockwise_from_the_right() {
        let points = arc((0.0, 0.0), 2.0, 0.0, 90.0);
        let end = points[points.len() - 1];
        assert!(end.0.abs() < 1e-12 && (end.1 + 2.0).abs() < 1e-12);
    }

    #[test]
    fn a_moved_shape_has_a_moved_area() {
        let shapes = [
            SketchShape::Damper { from: (0.0, 0.0), to: (30.0, 0.0) },
            SketchShape::Belt { ends: (0.0, 60.0), top: 4.0, radius: 8.0 },
            SketchShape::Ring { centre: (5.0, 6.0), radii: (20.0, 10.0) },
            SketchShape::Turn { centre: (5.0, 6.0), radius: 9.0, angles: (10.0, 80.0) },
            SketchShape::Wave { at: (1.0, 2.0), glyph: WaveGlyph::Triangle },
        ];
        for shape in shapes {
            let (before, after) = (shape.area(), shape.moved((3.0, -7.0)).area());
            assert!((after.left - before.left - 3.0).abs() < 1e-9, "{shape:?}");
            assert!((after.bottom - before.bottom + 7.0).abs() < 1e-9, "{shape:?}");
        }
    }
}
