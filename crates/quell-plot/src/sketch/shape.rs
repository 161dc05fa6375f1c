//! Shapes of mechanical drawings as strokes and fills.

use super::outline::{
    FilledArea, ShapeStrokes, WaveGlyph, arrow, belt, bounds, circle, corners, dashpot, hatching,
    sector, turn, wave, zigzag,
};
use crate::canvas::Rectangle;
use crate::geometry::{FrameSize, PlotPoint, PlotRange};
use crate::palette::{self, Colour, LineStyle, PlotRole};

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

/// A shape. Positions are (x, y) in pixels of 1/96 inch, y downwards; the sketch is centred on its sheet as a whole.
#[derive(Debug, Clone, PartialEq)]
pub enum SketchShape {
    /// A box: upper left corner, width and height.
    Block {
        /// Upper left corner.
        corner: PlotPoint,
        /// Width and height.
        size: FrameSize,
    },
    /// A coil spring as a zigzag.
    Spring {
        /// One end.
        from: PlotPoint,
        /// The other end.
        to: PlotPoint,
    },
    /// A dashpot.
    Damper {
        /// The end of the piston rod.
        from: PlotPoint,
        /// The end of the cylinder.
        to: PlotPoint,
    },
    /// A fixed support: a line with hatching on its left, seen from `from` to `to`.
    Ground {
        /// One end.
        from: PlotPoint,
        /// The other end.
        to: PlotPoint,
    },
    /// An endless belt on two rollers, whose upper side is at `top`.
    Belt {
        /// Left and right end of the upper side.
        ends: PlotRange,
        /// Height of the upper side.
        top: f64,
        /// Radius of the rollers.
        radius: f64,
    },
    /// A moving surface: a horizontal line with hatching below it.
    Surface {
        /// Left and right end.
        ends: PlotRange,
        /// Its height.
        top: f64,
    },
    /// A polyline.
    Line {
        /// Its points.
        points: Vec<PlotPoint>,
        /// Its dashes.
        style: LineStyle,
    },
    /// A straight arrow with its head at `to`.
    Arrow {
        /// The tail.
        from: PlotPoint,
        /// The head.
        to: PlotPoint,
    },
    /// An arrow along a circle, from one angle to another (degrees, counter-clockwise from the right).
    Turn {
        /// Centre of the circle.
        centre: PlotPoint,
        /// Its radius.
        radius: f64,
        /// Angles of tail and head.
        angles: (f64, f64),
    },
    /// One and a half periods of a wave.
    Wave {
        /// The centre.
        at: PlotPoint,
        /// Its form.
        glyph: WaveGlyph,
    },
    /// An annular disc in plan.
    Ring {
        /// The centre.
        centre: PlotPoint,
        /// Outer and inner radius.
        radii: (f64, f64),
    },
    /// A part of an annulus between two angles (degrees, counter-clockwise from the right), filled.
    Sector {
        /// The centre.
        centre: PlotPoint,
        /// Outer and inner radius.
        radii: (f64, f64),
        /// The two angles.
        angles: (f64, f64),
    },
    /// A filled point.
    Dot {
        /// The centre.
        at: PlotPoint,
        /// The radius.
        radius: f64,
    },
    /// Nothing that is drawn: a position for a label.
    Spot {
        /// The position.
        at: PlotPoint,
    },
}

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
                drawn
                    .lines
                    .push(vec![PlotPoint::new(ends.lower, *top), PlotPoint::new(ends.upper, *top)]);
                drawn.thin.extend(hatching(
                    PlotPoint::new(ends.upper, *top),
                    PlotPoint::new(ends.lower, *top),
                ));
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
                left: corner.x,
                top: corner.y,
                right: corner.x + size.width,
                bottom: corner.y + size.height,
            },
            Self::Spot { at } => Rectangle { left: at.x, top: at.y, right: at.x, bottom: at.y },
            _ => {
                let drawn = self.strokes();
                let outlines = drawn.fills.iter().map(|filled| &filled.outline);
                bounds(drawn.lines.iter().chain(&drawn.thin).chain(outlines).flatten())
            }
        }
    }

    /// The same shape at another position.
    pub(super) fn moved(&self, PlotPoint { x: dx, y: dy }: PlotPoint) -> Self {
        let by = |spot: &PlotPoint| spot.moved(dx, dy);
        match self.clone() {
            Self::Block { corner, size } => Self::Block { corner: by(&corner), size },
            Self::Spring { from, to } => Self::Spring { from: by(&from), to: by(&to) },
            Self::Damper { from, to } => Self::Damper { from: by(&from), to: by(&to) },
            Self::Ground { from, to } => Self::Ground { from: by(&from), to: by(&to) },
            Self::Belt { ends, top, radius } => Self::Belt {
                ends: PlotRange::new(ends.lower + dx, ends.upper + dx),
                top: top + dy,
                radius,
            },
            Self::Surface { ends, top } => Self::Surface {
                ends: PlotRange::new(ends.lower + dx, ends.upper + dx),
                top: top + dy,
            },
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
    pub(super) fn barriers(&self) -> Vec<Vec<PlotPoint>> {
        let drawn = self.strokes();
        let mut lines: Vec<Vec<PlotPoint>> = drawn.lines.into_iter().chain(drawn.thin).collect();
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hatching_of_a_ceiling_is_above_it_and_of_a_floor_below() {
        let ceiling = hatching(PlotPoint::new(0.0, 50.0), PlotPoint::new(40.0, 50.0));
        assert!(ceiling.iter().flatten().all(|spot| spot.y <= 50.0));
        let floor = SketchShape::Surface { ends: PlotRange::new(0.0, 40.0), top: 50.0 }.area();
        assert!((floor.top - 50.0).abs() < 1e-12 && floor.bottom > 50.0);
    }

    #[test]
    fn a_moved_shape_has_a_moved_area() {
        let shapes = [
            SketchShape::Damper { from: PlotPoint::new(0.0, 0.0), to: PlotPoint::new(30.0, 0.0) },
            SketchShape::Belt { ends: PlotRange::new(0.0, 60.0), top: 4.0, radius: 8.0 },
            SketchShape::Ring { centre: PlotPoint::new(5.0, 6.0), radii: (20.0, 10.0) },
            SketchShape::Turn {
                centre: PlotPoint::new(5.0, 6.0),
                radius: 9.0,
                angles: (10.0, 80.0),
            },
            SketchShape::Wave { at: PlotPoint::new(1.0, 2.0), glyph: WaveGlyph::Triangle },
        ];
        for shape in shapes {
            let (before, after) = (shape.area(), shape.moved(PlotPoint::new(3.0, -7.0)).area());
            assert!((after.left - before.left - 3.0).abs() < 1e-9, "{shape:?}");
            assert!((after.bottom - before.bottom + 7.0).abs() < 1e-9, "{shape:?}");
        }
    }
}
