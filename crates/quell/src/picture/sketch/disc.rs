//! The sketch of an annular disc under its loads: the disc in plan, and a section through each kind of load.

use quell_model::disc::{DiscDither, Load};
use quell_model::parameter::Parameter;
use quell_model::parameter::disc::{
    CALIPER_DAMPING, CALIPER_MASS, CALIPER_STIFFNESS, LOAD_DAMPING, LOAD_FRICTION, LOAD_MASS,
    LOAD_NORMAL, LOAD_STATIC, LOAD_STIFFNESS, PAD_DAMPING, PAD_MASS, PAD_STIFFNESS,
};
use quell_model::profile::Profile;
use quell_numerics::interval::RealInterval;

use super::disc_load::{SECTION_WIDTH, section};
use super::symbols::{further, index, indexed, law_items, measured, number, wave_items};
use crate::plot::{
    LabelSide, LineStyle, PlotPoint, Sketch, SketchInk, SketchKey, SketchPart, SketchShape,
};
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;
use crate::words::{capital, counted};

/// Outer radius of the disc in plan.
const RADIUS: f64 = 54.0;
/// Inner radius and radius of a load over the outer one where the study does not give them.
const TYPICAL: (f64, f64) = (0.5, 0.75);
/// The loads that have a row each in the key; more are summarised.
const MOST_LOADS: usize = 8;

/// Draws a disc.
pub(super) fn draw(sheet: Sketch, study: &DiscStudy) -> Sketch {
    let mut sheet = plan(sheet, study);
    // One section for each kind of load.
    let loads = study.disc().loads();
    let mut kinds: Vec<(usize, &Load)> = Vec::new();
    for (place, load) in loads.iter().enumerate() {
        let same = |known: &Load| {
            (known.pad.is_some(), known.caliper.is_some(), known.mass == 0.0)
                == (load.pad.is_some(), load.caliper.is_some(), load.mass == 0.0)
        };
        if !kinds.iter().any(|(_, known)| same(known)) {
            kinds.push((place, load));
        }
    }
    let room = sheet.room() - 2.0 * (RADIUS + 14.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let fit = ((room / SECTION_WIDTH).floor() as usize).max(1);
    for (column, (place, load)) in kinds.iter().take(fit).enumerate() {
        let left = RADIUS + 26.0 + SECTION_WIDTH * column as f64;
        sheet = section(sheet, study.disc(), load, &index(*place, loads.len()), left);
    }
    key(sheet, study)
}

/// The disc seen from above, with its loads at their angles.
fn plan(sheet: Sketch, study: &DiscStudy) -> Sketch {
    let disc = study.disc();
    let inner = match study.source() {
        ModeSource::Plate(plate) => plate.plate.inner_radius_ratio(),
        _ => TYPICAL.0,
    };
    let centre = PlotPoint::new(0.0, 0.0);
    let ring = SketchShape::Ring { centre, radii: (RADIUS, RADIUS * inner) };
    let mut sheet = sheet.with(SketchPart::new("disc", "annular disc", ring));
    let count = disc.loads().len();
    for (place, (load, radius)) in disc.loads().iter().zip(study.radii()).enumerate() {
        let at = RADIUS * radius.unwrap_or(0.5 * (1.0 + inner).max(TYPICAL.1));
        let degrees = load.angle.to_degrees();
        let point = |radius: f64| {
            PlotPoint::new(
                centre.x + radius * libm::cos(load.angle),
                centre.y - radius * libm::sin(load.angle),
            )
        };
        let name = format!("load {} at {}°", place + 1, number(degrees));
        let spoke = SketchShape::Line {
            points: vec![point(RADIUS * inner), point(RADIUS + 4.0)],
            style: LineStyle::DashDotted,
        };
        let mark = match &load.patch {
            Some(patch) => {
                let half = 0.5 * patch.extent.to_degrees();
                let depth =
                    if patch.radii.is_empty() { 3.0 } else { 0.5 * RADIUS * (1.0 - inner) - 4.0 };
                let radii = (at + depth, at - depth);
                SketchShape::Sector { centre, radii, angles: (degrees - half, degrees + half) }
            }
            None => SketchShape::Dot { at: point(at), radius: 3.5 },
        };
        let end = SketchShape::Spot { at: point(RADIUS + 3.0) };
        sheet = sheet.with(SketchPart::new("guide", "", spoke).ink(SketchInk::Guide));
        sheet = sheet.with(SketchPart::new("contact", name, mark).ink(SketchInk::Contact));
        if count > 1 && count <= 12 {
            let (x, y) = (libm::cos(load.angle), libm::sin(load.angle));
            let side = match (x.abs() >= y.abs(), x > 0.0, y > 0.0) {
                (true, true, _) => LabelSide::Right,
                (true, false, _) => LabelSide::Left,
                (false, _, true) => LabelSide::Above,
                (false, _, false) => LabelSide::Below,
            };
            let part = SketchPart::new("number", "", end).ink(SketchInk::Contact);
            sheet = sheet.with(part.label((place + 1).to_string(), &[side]));
        }
    }
    let radius = (RADIUS * inner - 6.0).max(7.0);
    let angles = if disc.speed() < 0.0 { (130.0, 50.0) } else { (50.0, 130.0) };
    let turning = SketchShape::Turn { centre, radius, angles };
    let name = if disc.is_stiffened() { "rotation of the disc" } else { "rotation of the loads" };
    let part = SketchPart::new("velocity", name, turning).ink(SketchInk::Contact);
    sheet.with(part.label("$Ω$", &[LabelSide::Below]))
}

fn key(sheet: Sketch, study: &DiscStudy) -> Sketch {
    let disc = study.disc();
    let modes = disc.modes().len();
    let mut plate = vec![counted(modes, "mode")];
    match study.source() {
        ModeSource::Plate(source) => {
            plate.push(format!("$b$/$a$ = {}", number(source.plate.inner_radius_ratio())));
            plate.push(format!("$ν$ = {}", number(source.plate.poisson_ratio())));
        }
        _ => plate.push("radii of the plate not given".to_owned()),
    }
    let lowest = disc.modes().iter().map(|mode| mode.ratio).fold(f64::INFINITY, f64::min);
    plate.push(format!("lowest $β$ = {}", number(lowest)));
    if let Some(hertz) = study.reference_hz() {
        plate.push(format!("unit of frequency {}", measured(hertz, Some("Hz"))));
    }
    let moving = if disc.is_stiffened() { "disc rotates, loads at rest" } else { "loads rotate" };
    let speed = match disc.drive().map(Profile::bounds) {
        None => format!("$Ω$ = {}", number(disc.speed())),
        Some(RealInterval { lower: least, upper: largest }) => {
            format!("$Ω$ from {} to {} over time", number(least), number(largest))
        }
    };
    let speed = vec![speed, moving.to_owned()];
    let mut sheet =
        sheet.with_key(SketchKey::new("Disc", plate)).with_key(SketchKey::new("Speed", speed));
    let loads = disc.loads();
    for (place, load) in loads.iter().enumerate().take(MOST_LOADS) {
        let head = match loads.len() {
            1 => "Load".to_owned(),
            _ => format!("Load {}", place + 1),
        };
        sheet = sheet.with_key(SketchKey::new(head, load_items(study, place, load)));
    }
    sheet = further(sheet, loads.len(), MOST_LOADS, "load");
    if let Some(law) = disc.law() {
        let items = law_items(law, "$T$", |_, value| number(value));
        sheet = sheet.with_key(SketchKey::new("Friction", items));
    }
    if let DiscDither::Normal { amplitude, frequency_ratio }
    | DiscDither::Tangential { amplitude, frequency_ratio } = disc.dither()
    {
        let direction = match disc.dither() {
            DiscDither::Normal { .. } => "normal",
            _ => "tangential",
        };
        let head = capital(&format!("{direction} {} dither", disc.waveform().name()));
        let mut items = vec![
            format!("$α$ = {}", number(amplitude)),
            format!("$R$ = {}", number(frequency_ratio)),
        ];
        items.extend(wave_items(disc.waveform(), disc.envelope().is_some(), 0.0));
        sheet = sheet.with_key(SketchKey::new(head, items));
    }
    let without = study.without();
    if !without.is_empty() {
        sheet = sheet.with_key(SketchKey::new("Left out", without));
    }
    sheet
}

/// The values of a load, in SI where its scales are known.
fn load_items(study: &DiscStudy, place: usize, load: &Load) -> Vec<String> {
    let count = study.disc().loads().len();
    let numbered = index(place, count);
    let scales = study.scales(place);
    let written = |parameter: Parameter, value: f64| {
        let quantity = parameter.quantity;
        let si = scales.and_then(|scales| scales.si_per_unit(quantity)).zip(quantity.si_unit());
        match si {
            Some((per_unit, (unit, _))) => measured(value * per_unit, Some(unit)),
            None => number(value),
        }
    };
    let item = |letter: &str, parameter: Parameter, value: f64| {
        format!("{} = {}", indexed(letter, &numbered), written(parameter, value))
    };
    let mut items = vec![
        item("m", LOAD_MASS, load.mass),
        item("c", LOAD_DAMPING, load.damping),
        item("k", LOAD_STIFFNESS, load.stiffness),
    ];
    match load.normal_load {
        Some(normal) => items.push(item("N", LOAD_NORMAL, normal)),
        None => items.push(item("f", LOAD_FRICTION, load.friction)),
    }
    if let Some(RealInterval { lower: least, upper: largest }) =
        load.share.as_ref().map(Profile::bounds)
    {
        items.push(format!("times {} to {} over time", number(least), number(largest)));
    }
    if load.static_load != 0.0 {
        items.push(item("P", LOAD_STATIC, load.static_load));
    }
    let pad = [("m_p", PAD_MASS), ("c_p", PAD_DAMPING), ("k_p", PAD_STIFFNESS)];
    let caliper = [("m_c", CALIPER_MASS), ("c_c", CALIPER_DAMPING), ("k_c", CALIPER_STIFFNESS)];
    for (body, letters) in [(load.pad, pad), (load.caliper, caliper)] {
        let Some(body) = body else { continue };
        let values = [body.mass, body.damping, body.stiffness];
        for ((letter, parameter), value) in letters.into_iter().zip(values) {
            // The letter has an index of its own; the heading says which load it is.
            items.push(format!("${letter}$ = {}", written(parameter, value)));
        }
    }
    if let Some(Some(radius)) = study.radii().get(place) {
        items.push(format!("$r$/$a$ = {}", number(*radius)));
    }
    if load.angle != 0.0 {
        items.push(format!("at {}°", number(load.angle.to_degrees())));
    }
    if let Some(patch) = &load.patch {
        items.push(format!("extent {}°", number(patch.extent.to_degrees())));
    }
    if load.dither_phase != 0.0 {
        items.push(format!("$φ$ = {}°", number(load.dither_phase.to_degrees())));
    }
    items
}
