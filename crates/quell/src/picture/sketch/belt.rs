//! The sketch of a mass on a moving belt.

use quell_model::parameter::{NORMAL_STIFFNESS, TANGENTIAL_STIFFNESS};
use quell_model::units::Quantity;
use quell_model::{Direction, Profile};
use quell_numerics::interval::RealInterval;

use super::actuator;
use super::contact_state::StateMark;
use super::symbols::{glyph, index, indexed, item, law_items, number, wave_items};
use crate::noise::band_in_words;
use crate::picture::ruler::words;
use crate::plot::{
    FrameSize, LabelSide, PlotPoint, PlotRange, Sketch, SketchInk, SketchKey, SketchPart,
    SketchShape,
};
use crate::study::BeltStudy;

use LabelSide::{Above, Below, Inside, Left, Right};

/// Left end of the mass.
const MASS: f64 = 76.0;
/// Width of the mass.
const WIDTH: f64 = 66.0;
/// Height of the mass for a row of forces; each further tangential dither adds another row.
const HEIGHT: f64 = 58.0;
/// Height of a row.
const ROW: f64 = 20.0;

/// The letters of the dissertation: with dimensions in SI, else those of the numbers of the equations.
struct Letters {
    load: &'static str,
    velocity: &'static str,
    force: &'static str,
    rate: &'static str,
}

/// Draws a belt.
pub(super) fn draw(sheet: Sketch, study: &BeltStudy) -> Sketch {
    let letters = match study.scales() {
        Some(_) => Letters { load: "N_0", velocity: "V_0", force: "A", rate: "f" },
        None => Letters { load: "F", velocity: "v_0", force: "D", rate: "R" },
    };
    let tangential = study.belt().dithers_along(Direction::Tangential).count();
    let height = HEIGHT + ROW * tangential.saturating_sub(1) as f64;
    let sheet = structure(sheet, study, height);
    let sheet = contact(sheet, study, &letters, height);
    let sheet = dithers(sheet, study, &letters);
    key(sheet, study, &letters)
}

fn structure(sheet: Sketch, study: &BeltStudy, height: f64) -> Sketch {
    let at = PlotPoint::new;
    let si = study.scales().is_some();
    let wall = SketchShape::Ground { from: at(0.0, height + 2.0), to: at(0.0, -2.0) };
    let mass = SketchShape::Block { corner: at(MASS, 0.0), size: FrameSize::new(WIDTH, height) };
    let spring = SketchShape::Spring { from: at(0.0, 9.0), to: at(MASS, 9.0) };
    let damper = SketchShape::Damper { from: at(0.0, 27.0), to: at(MASS, 27.0) };
    let (m, k, c) = if si { ("$m$", "$k$", "$c$") } else { ("1", "1", "$2ζ$") };
    let way = SketchShape::Arrow { from: at(MASS + 0.5 * WIDTH, -9.0), to: at(MASS + WIDTH, -9.0) };
    let foot = SketchShape::Line {
        points: vec![at(MASS + 0.5 * WIDTH, -13.0), at(MASS + 0.5 * WIDTH, -5.0)],
        style: crate::plot::LineStyle::Solid,
    };
    sheet
        .with(SketchPart::new("ground", "wall", wall))
        .with(
            SketchPart::new("spring", "spring between the wall and the mass", spring)
                .label(k, &[Above]),
        )
        .with(
            SketchPart::new("damper", "damper between the wall and the mass", damper)
                .label(c, &[Below]),
        )
        .with(SketchPart::new("mass", "mass on the belt", mass).label(m, &[Inside]))
        .with(
            SketchPart::new("coordinate", "displacement x of the mass", way)
                .and(foot)
                .label("$x$", &[Right, Above]),
        )
}

fn contact(sheet: Sketch, study: &BeltStudy, letters: &Letters, height: f64) -> Sketch {
    let at = PlotPoint::new;
    let mark = StateMark::of(study.belt().friction(), study.belt().tangential_stiffness());
    let top = height + mark.map_or(0.0, StateMark::height);
    let belt = SketchShape::Belt {
        ends: PlotRange::new(MASS - 46.0, MASS + WIDTH + 66.0),
        top,
        radius: 11.0,
    };
    let velocity = SketchShape::Arrow {
        from: at(MASS + WIDTH + 16.0, top - 6.0),
        to: at(MASS + WIDTH + 46.0, top - 6.0),
    };
    let load = SketchShape::Arrow {
        from: at(MASS + 0.25 * WIDTH, -34.0),
        to: at(MASS + 0.25 * WIDTH, -1.0),
    };
    let friction = SketchShape::Arrow {
        from: at(MASS - 24.0, height - 6.0),
        to: at(MASS - 1.0, height - 6.0),
    };
    let ink = SketchInk::Contact;
    let within = (MASS + 8.0, MASS + WIDTH - 10.0);
    let sheet = match mark {
        Some(mark) => mark.draw(sheet, within, height, (" of the contact", "$k_t$")),
        None => sheet,
    };
    sheet
        .with(SketchPart::new("surface", "moving belt", belt))
        .with(
            SketchPart::new("velocity", "belt velocity", velocity)
                .ink(ink)
                .label(format!("${}$", letters.velocity), &[Right, Above]),
        )
        .with(
            SketchPart::new("load", "normal load", load)
                .ink(ink)
                .label(format!("${}$", letters.load), &[Left]),
        )
        .with(
            SketchPart::new("friction", "friction force on the mass", friction)
                .ink(ink)
                .label("$T$", &[Left, Above]),
        )
}

fn dithers(mut sheet: Sketch, study: &BeltStudy, letters: &Letters) -> Sketch {
    let at = PlotPoint::new;
    let dithers = study.belt().dithers();
    let (mut rows, mut columns) = (0.0, 0.0);
    for (place, dither) in dithers.iter().enumerate() {
        let number = index(place, dithers.len());
        let symbol = indexed(letters.force, &number);
        let name = format!("{} {} dither", dither.direction.name(), dither.waveform.name());
        let (shape, wave) = match dither.direction {
            Direction::Tangential => {
                let level = 12.0 + ROW * rows;
                rows += 1.0;
                let from = at(MASS + WIDTH + 1.0, level);
                let to = at(MASS + WIDTH + 27.0, level);
                (SketchShape::Arrow { from, to }, at(to.x + 13.0, level))
            }
            Direction::Normal => {
                let across = MASS + 0.25 * WIDTH + 22.0 + 46.0 * columns;
                columns += 1.0;
                // The vertical arrow is next to that of the load and ends above the mass.
                let arrow = SketchShape::Arrow {
                    from: at(across - 12.0, -40.0),
                    to: at(across - 12.0, -16.0),
                };
                (arrow, at(across, -32.0))
            }
        };
        let given = study.kind().system().actuator();
        let given = given.filter(|_| place == 0 && dither.direction == Direction::Tangential);
        if let Some(actuator) = given {
            sheet = sheet.with(actuator::drawn(at(wave.x + 13.0, wave.y), actuator));
        }
        let sides = if given.is_some() { [Above, Below] } else { [Right, Above] };
        let wave = SketchShape::Wave { at: wave, glyph: glyph(&dither.waveform) };
        let label = SketchPart::new("dither", name, wave).and(shape).ink(SketchInk::Input);
        sheet = sheet.with(label.label(symbol, &sides));
    }
    sheet
}

fn key(sheet: Sketch, study: &BeltStudy, letters: &Letters) -> Sketch {
    let belt = study.belt();
    let equal = |symbol: &str, quantity: Quantity, value: f64| {
        format!("${symbol}$ = {}", words(study, quantity, value))
    };
    let mass = match study.scales() {
        Some(scales) => {
            let damping = scales.to_units(Quantity::DampingRatio, belt.damping_ratio());
            let of = |quantity| scales.unit(quantity).unwrap_or_default().replace('·', " ");
            vec![
                format!("$m$ = {} {}", number(scales.mass()), of(Quantity::LoadMass)),
                item("$k$", scales.stiffness(), Some(&of(Quantity::LoadStiffness))),
                format!(
                    "$c$ = {} {} ($ζ$ = {})",
                    number(damping),
                    of(Quantity::LoadDamping),
                    number(belt.damping_ratio())
                ),
            ]
        }
        None => vec![
            "mass, stiffness and natural frequency 1".to_owned(),
            format!("$ζ$ = {}", number(belt.damping_ratio())),
        ],
    };
    let over_time = |letter: &str, quantity, value, profile: Option<&Profile>| match profile {
        None => equal(letter, quantity, value),
        Some(profile) => {
            let RealInterval { lower: least, upper: largest } = profile.bounds();
            format!(
                "{} to {} over time",
                equal(letter, quantity, least),
                words(study, quantity, largest)
            )
        }
    };
    let in_words = |quantity, value| words(study, quantity, value);
    let mut friction = vec![
        over_time(letters.load, Quantity::Force, belt.normal_load(), belt.load()),
        over_time(letters.velocity, Quantity::Velocity, belt.belt_velocity(), belt.drive()),
    ];
    friction.extend(law_items(belt.friction(), "$T$", in_words));
    let springs = [
        (TANGENTIAL_STIFFNESS, belt.tangential_stiffness()),
        (NORMAL_STIFFNESS, belt.normal_stiffness()),
    ];
    for (spring, value) in springs {
        friction.extend(value.map(|value| equal(spring.symbol, spring.quantity, value)));
    }
    let mut sheet =
        sheet.with_key(SketchKey::new("Mass", mass)).with_key(SketchKey::new("Contact", friction));
    let dithers = belt.dithers();
    for (place, dither) in dithers.iter().enumerate() {
        let number_of = index(place, dithers.len());
        let bare = |letter: &str| indexed(letter, &number_of).trim_matches('$').to_owned();
        let mut items = vec![
            equal(&bare(letters.force), Quantity::Force, dither.amplitude),
            match dither.waveform.noise() {
                Some(noise) => {
                    let band = band_in_words(noise, dither.frequency_ratio, in_words);
                    format!("${}$ = {band}", bare(letters.rate))
                }
                None => {
                    equal(&bare(letters.rate), Quantity::FrequencyRatio, dither.frequency_ratio)
                }
            },
        ];
        items.extend(wave_items(&dither.waveform, dither.envelope.is_some(), dither.phase));
        let head = format!("{} {} dither", dither.direction.name(), dither.waveform.name());
        sheet = sheet.with_key(SketchKey::new(crate::words::capital(&head), items));
    }
    if let Some(given) = study.kind().system().actuator() {
        sheet = sheet.with_key(actuator::key(given, &in_words));
    }
    sheet
}
