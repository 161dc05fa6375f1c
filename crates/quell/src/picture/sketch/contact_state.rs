//! The state of a contact between a body and its surface: the spring of an elastic slider with its shoe, or bristles.

use quell_model::Friction;

use crate::plot::{
    FrameSize, LabelSide, LineStyle, PlotPoint, Sketch, SketchInk, SketchPart, SketchShape,
};

/// Height of an elastic slider and of bristles.
const SLIDER: f64 = 17.0;
const BRISTLES: f64 = 9.0;
/// Bristles that are drawn, their distance and their lean.
const COUNT: u8 = 6;
const PITCH: f64 = 5.0;
const LEAN: f64 = 4.0;
/// Size of the shoe of a slider.
const SHOE: FrameSize = FrameSize::new(9.0, 10.0);

/// What a contact has between its body and its surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StateMark {
    /// An elastic slider.
    Slider,
    /// Bristles.
    Bristles,
}

impl StateMark {
    /// The mark of a law and a tangential stiffness; `None` of a rigid contact.
    pub(super) fn of(friction: &Friction, tangential_stiffness: Option<f64>) -> Option<Self> {
        if tangential_stiffness.is_some() {
            return Some(Self::Slider);
        }
        friction.bristles().map(|_| Self::Bristles)
    }

    /// Its height between body and surface.
    pub(super) fn height(self) -> f64 {
        match self {
            Self::Slider => SLIDER,
            Self::Bristles => BRISTLES,
        }
    }

    /// Draws it below `top`, between two positions along the surface.
    pub(super) fn draw(
        self,
        sheet: Sketch,
        (from, to): (f64, f64),
        top: f64,
        (of, symbol): (&str, &str),
    ) -> Sketch {
        let ink = SketchInk::Contact;
        match self {
            Self::Slider => {
                let bottom = top + SLIDER;
                let level = bottom - 0.5 * SHOE.height;
                let shoe = SketchShape::Block {
                    corner: PlotPoint::new(from, bottom - SHOE.height),
                    size: SHOE,
                };
                let spring = SketchShape::Spring {
                    from: PlotPoint::new(from + SHOE.width, level),
                    to: PlotPoint::new(to, level),
                };
                let foot = vec![PlotPoint::new(to, top), PlotPoint::new(to, level)];
                let foot = SketchShape::Line { points: foot, style: LineStyle::Solid };
                sheet
                    .with(SketchPart::new("shoe", format!("shoe{of}, which slides"), shoe).ink(ink))
                    .with(
                        SketchPart::new(
                            "tangential-spring",
                            format!("tangential stiffness{of}"),
                            spring,
                        )
                        .and(foot)
                        .ink(ink)
                        .label(symbol, &[LabelSide::Right, LabelSide::Left, LabelSide::Below]),
                    )
            }
            Self::Bristles => {
                let middle = 0.5 * (from + to);
                let shape = |place: u8| {
                    let at = middle + PITCH * (f64::from(place) - 0.5 * f64::from(COUNT - 1));
                    let points = vec![
                        PlotPoint::new(at + 0.5 * LEAN, top),
                        PlotPoint::new(at - 0.5 * LEAN, top + BRISTLES),
                    ];
                    SketchShape::Line { points, style: LineStyle::Solid }
                };
                let first = SketchPart::new("bristles", format!("bristles{of}"), shape(0));
                sheet.with((1..COUNT).fold(first, |part, place| part.and(shape(place))).ink(ink))
            }
        }
    }
}
