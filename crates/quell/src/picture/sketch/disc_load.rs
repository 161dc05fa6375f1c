//! A section through the disc at a load: the contact, the pad and the caliper up to the support.

use quell_model::Disc;
use quell_model::disc::{DiscDither, Load};

use super::symbols::{glyph, indexed};
use crate::plot::{FrameSize, LabelSide, PlotPoint, Sketch, SketchInk, SketchPart, SketchShape};

use LabelSide::{Above, Below, Inside, Left, Right};

/// Width of a section.
pub(super) const SECTION_WIDTH: f64 = 150.0;
/// Height of the disc in section, its upper side.
const DISC: f64 = 40.0;
/// Length of a spring between two bodies.
const SPRING: f64 = 32.0;
/// Height of a body.
const BODY: f64 = 20.0;
/// Half the distance of spring and damper.
const APART: f64 = 15.0;

/// A stage of the chain: the mass at its lower end, if it has one, then spring and damper.
struct Stage {
    body: Option<(String, &'static str)>,
    spring: String,
    damper: String,
    above: &'static str,
}

/// Draws the section of a load with this index, with its left end at `left`.
pub(super) fn section(sheet: Sketch, disc: &Disc, load: &Load, index: &str, left: f64) -> Sketch {
    let middle = left + 66.0;
    let strip = SketchShape::Block {
        corner: PlotPoint::new(left + 12.0, DISC),
        size: FrameSize::new(108.0, 9.0),
    };
    let sheet = sheet.with(SketchPart::new("disc", "disc in section", strip));
    let sheet = chain(sheet, load, index, middle);
    forces(sheet, disc, load, index, middle)
}

fn chain(mut sheet: Sketch, load: &Load, index: &str, middle: f64) -> Sketch {
    let at = PlotPoint::new;
    let body = (load.mass > 0.0).then(|| (indexed("m", index), "mass of the load on the disc"));
    let above = |pad: bool, caliper: bool| match (pad, caliper) {
        (true, _) => "the pad",
        (false, true) => "the caliper",
        (false, false) => "the support",
    };
    let mut stages = vec![Stage {
        body,
        spring: indexed("k", index),
        damper: indexed("c", index),
        above: above(load.pad.is_some(), false),
    }];
    if load.pad.is_some() {
        stages.push(Stage {
            body: Some(("$m_p$".to_owned(), "pad")),
            spring: "$k_p$".to_owned(),
            damper: "$c_p$".to_owned(),
            above: above(false, load.caliper.is_some()),
        });
        if load.caliper.is_some() {
            stages.push(Stage {
                body: Some(("$m_c$".to_owned(), "caliper")),
                spring: "$k_c$".to_owned(),
                damper: "$c_c$".to_owned(),
                above: "the support",
            });
        }
    }
    let mut level = DISC;
    for stage in stages {
        if let Some((label, name)) = stage.body {
            level -= BODY;
            let shape = SketchShape::Block {
                corner: at(middle - 24.0, level),
                size: FrameSize::new(48.0, BODY),
            };
            sheet = sheet.with(SketchPart::new("mass", name, shape).label(label, &[Inside]));
        }
        let line = |across: f64| [level, level - SPRING].map(|level| at(middle + across, level));
        let ([from, to], [rod, cylinder]) = (line(-APART), line(APART));
        let (spring, damper) =
            (SketchShape::Spring { from, to }, SketchShape::Damper { from: rod, to: cylinder });
        let (of_spring, of_damper) =
            (format!("spring below {}", stage.above), format!("damper below {}", stage.above));
        sheet = sheet
            .with(SketchPart::new("spring", of_spring, spring).label(stage.spring, &[Left]))
            .with(SketchPart::new("damper", of_damper, damper).label(stage.damper, &[Right]));
        level -= SPRING;
    }
    let support =
        SketchShape::Ground { from: at(middle - 28.0, level), to: at(middle + 28.0, level) };
    sheet.with(SketchPart::new("ground", "support", support))
}

/// Friction, normal load and dither at the contact.
fn forces(sheet: Sketch, disc: &Disc, load: &Load, index: &str, middle: f64) -> Sketch {
    let at = PlotPoint::new;
    let below = DISC + 9.0;
    let friction = SketchShape::Arrow {
        from: at(middle + 4.0, below + 8.0),
        to: at(middle + 40.0, below + 8.0),
    };
    let part = SketchPart::new("friction", "friction force on the disc", friction);
    let part = part
        .ink(SketchInk::Contact)
        .label(indexed(if disc.law().is_some() { "T" } else { "f" }, index), &[Right, Below]);
    let mut sheet = sheet.with(part);
    let pressing = match (load.normal_load, load.static_load != 0.0) {
        (Some(_), _) => Some(("normal load", indexed("N", index))),
        (None, true) => Some(("static load", indexed("P", index))),
        (None, false) => None,
    };
    if let Some((name, label)) = pressing {
        let shape = SketchShape::Arrow {
            from: at(middle - 40.0, DISC - 26.0),
            to: at(middle - 40.0, DISC - 1.0),
        };
        let part = SketchPart::new("load", name, shape).ink(SketchInk::Contact);
        sheet = sheet.with(part.label(label, &[Left, Above]));
    }
    let name = match disc.dither() {
        DiscDither::None => return sheet,
        DiscDither::Normal { .. } => "normal dither of the friction force",
        DiscDither::Tangential { .. } => "tangential dither of the friction force",
    };
    let shape =
        SketchShape::Wave { at: at(middle - 16.0, below + 8.0), glyph: glyph(disc.waveform()) };
    let part = SketchPart::new("dither", name, shape).ink(SketchInk::Input);
    sheet.with(part.label("$α$, $R$", &[Left, Below]))
}
