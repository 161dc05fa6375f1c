//! The key of a system: masses, links, contacts and inputs with their values.

use quell_model::system::{InputTarget, Structure};
use quell_model::units::Quantity;
use quell_model::{Contact, Input, Profile};
use quell_numerics::interval::RealInterval;

use super::body::BodyKind;
use super::contacts::{stiffness_symbol, tangential_symbol};
use super::drawing::SystemDrawing;
use super::key_rows::{KeyRow, add_rows};
use crate::picture::sketch::actuator;
use crate::picture::sketch::symbols::{
    combination, further, index, indexed, item, law_items, measured, number, pair, wave_items,
};
use crate::plot::{Sketch, SketchKey};
use crate::run::design::StudyWithDesign;
use crate::run::system::in_units;
use crate::study::UnitSystem;
use crate::words::counted;

/// The most links between coordinates, contacts or inputs with a row each.
const MOST_ROWS: usize = 12;

/// Adds the key.
pub(super) fn add(sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let sheet = bodies(sheet, drawing);
    let sheet = links(sheet, drawing);
    let sheet = contacts(sheet, drawing);
    let mut sheet = inputs(sheet, drawing);
    if let Some(given) = drawing.study.actuator() {
        let units = drawing.study.units();
        let words = |quantity: Quantity, value: f64| in_units(units, quantity, value);
        sheet = sheet.with_key(actuator::key(given, &words));
    }
    if drawing.study.units() != UnitSystem::None {
        let words = format!("Numbers without a unit: units {}", drawing.study.units().name());
        sheet = sheet.with_key(SketchKey::new(words, Vec::<String>::new()));
    }
    sheet
}

fn bodies(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let structure = &drawing.study.system().structure;
    let force = structure.force();
    match structure {
        Structure::Mechanical(mechanical) => {
            let mass = mechanical.mass().matrix();
            let mut rows = Vec::new();
            for (place, body) in drawing.bodies.iter().enumerate() {
                if body.kind != BodyKind::Mass {
                    continue;
                }
                let place_name = (place + 1).to_string();
                let mut items = vec![item(&indexed("m", &place_name), mass[(place, place)], None)];
                for link in
                    drawing.links.iter().filter(|link| link.from == place && link.to.is_none())
                {
                    items.extend(link.stiffness.map(|value| item(&link.symbol("k"), value, None)));
                    items.extend(link.damping.map(|value| item(&link.symbol("c"), value, None)));
                }
                if force[place] != 0.0 {
                    items.push(item(&indexed("p", &place_name), force[place], None));
                }
                let shown = &body.lines[0];
                let head = if *shown == body.name {
                    body.name.clone()
                } else {
                    format!("{shown} {}", body.name)
                };
                rows.push(KeyRow { head, index: place_name, items, rows: Vec::new() });
            }
            sheet = add_rows(sheet, &rows, "");
            if drawing.bodies.iter().any(|body| body.kind == BodyKind::Group)
                && drawing.study.frequency_response().is_none()
            {
                let total: f64 = (0..mechanical.size()).map(|place| mass[(place, place)]).sum();
                let names = mechanical.coordinates();
                let items = [
                    format!("{} to {}", names[0], names[names.len() - 1]),
                    format!("sum of the diagonal of $M$ = {}", number(total)),
                ];
                sheet = sheet.with_key(SketchKey::new(counted(names.len(), "coordinate"), items));
            }
        }
        Structure::StateSpace(states)
            if drawing.bodies.iter().any(|body| body.kind == BodyKind::Group) =>
        {
            let names = states.names();
            let items = [format!("{} to {}", names[0], names[names.len() - 1])];
            sheet = sheet.with_key(SketchKey::new(counted(names.len(), "state"), items));
        }
        Structure::StateSpace(_) => {}
    }
    sheet
}

fn links(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let between: Vec<_> = drawing.links.iter().filter_map(|link| Some((link, link.to?))).collect();
    let mut rows = Vec::new();
    for (link, to) in between.iter().take(MOST_ROWS) {
        let name = |place: usize| drawing.bodies[place].lines[0].clone();
        let mut items = Vec::new();
        items.extend(link.stiffness.map(|value| item(&link.symbol("k"), value, None)));
        items.extend(link.damping.map(|value| item(&link.symbol("c"), value, None)));
        for (letter, one, other) in &link.couplings {
            let (there, back) = (pair(link.from, *to), pair(*to, link.from));
            let (there, back) = (indexed(letter, &there), indexed(letter, &back));
            if one == other {
                items.push(format!("coupling {there} = {back} = {}", number(*one)));
            } else {
                items.push(format!("coupling {}", item(&there, *one, None)));
                items.push(item(&back, *other, None));
            }
        }
        let head = format!("{} – {}", name(link.from), name(*to));
        let index = pair(link.from, *to);
        rows.push(KeyRow { head, index, items, rows: Vec::new() });
    }
    sheet = add_rows(sheet, &rows, "");
    further(sheet, between.len(), MOST_ROWS, "link")
}

fn contacts(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let contacts = &drawing.study.system().contacts;
    let mut rows = Vec::new();
    for (place, contact) in contacts.iter().enumerate().take(MOST_ROWS) {
        rows.push(contact_row(drawing, contact, index(place, contacts.len())));
    }
    sheet = add_rows(sheet, &rows, "Contact ");
    further(sheet, contacts.len(), MOST_ROWS, "contact")
}

fn contact_row(drawing: &SystemDrawing<'_>, contact: &Contact, index: String) -> KeyRow {
    let units = drawing.study.units();
    let names = drawing.study.system().structure.names();
    let modal = drawing.bodies.iter().any(|body| body.kind == BodyKind::Modes);
    let with = |letter: &str, quantity: Quantity, value: f64| {
        item(&indexed(letter, &index), value, units.unit(quantity))
    };
    let over_time = |letter: &str, quantity: Quantity, profile: &Profile| {
        let RealInterval { lower: least, upper: largest } = profile.bounds();
        if least == largest {
            return with(letter, quantity, least);
        }
        format!("{} to {} over time", with(letter, quantity, least), number(largest))
    };
    let mut items = vec![
        over_time("N", Quantity::Force, &contact.load()),
        over_time("v", Quantity::Velocity, &contact.surface_velocity),
    ];
    if contact.normal_stiffness != 0.0 {
        let unit = units.unit(Quantity::LoadStiffness);
        items.push(item(&stiffness_symbol(&index), contact.normal_stiffness, unit));
    }
    if contact.normal_damping != 0.0 {
        items.push(with("d", Quantity::LoadDamping, contact.normal_damping));
    }
    if let Some(stiffness) = contact.tangential_stiffness {
        let unit = units.unit(Quantity::Stiffness);
        items.push(item(&tangential_symbol(&index), stiffness, unit));
    }
    let written = |quantity, value| measured(value, units.unit(quantity));
    items.extend(law_items(&contact.friction, &indexed("T", &index), written));
    let named = [
        ("slip", &contact.tangent),
        ("friction acts on", &contact.force),
        ("approach", &contact.normal),
        ("slope", &contact.slope),
    ];
    let rows = named.into_iter().filter_map(|(word, row)| {
        row.as_ref().filter(|_| !modal).map(|row| (word, combination(row, names)))
    });
    KeyRow { head: contact.name.clone(), rows: rows.collect(), index, items }
}

fn inputs(mut sheet: Sketch, drawing: &SystemDrawing<'_>) -> Sketch {
    let inputs = &drawing.study.system().inputs;
    for (place, input) in inputs.iter().enumerate().take(MOST_ROWS) {
        let symbol = indexed("u", &index(place, inputs.len()));
        let (head, items) = input_row(drawing, input, &symbol);
        sheet = sheet.with_key(SketchKey::new(head, items));
    }
    further(sheet, inputs.len(), MOST_ROWS, "dither")
}

fn input_row(drawing: &SystemDrawing<'_>, input: &Input, symbol: &str) -> (String, Vec<String>) {
    let system = drawing.study.system();
    let units = drawing.study.units();
    let modal = drawing.bodies.iter().any(|body| body.kind == BodyKind::Modes);
    let name =
        |contact: usize| system.contacts.get(contact).map_or("", |contact| contact.name.as_str());
    let (place, force_unit) = match &input.target {
        InputTarget::Force(_) if modal => {
            ("force on the modes".to_owned(), units.unit(Quantity::Force))
        }
        InputTarget::Force(row) => {
            let names = system.structure.names();
            (format!("force on {}", combination(row, names)), units.unit(Quantity::Force))
        }
        InputTarget::NormalLoad { contact, reaction } => {
            let taken = if *reaction { "" } else { " without reaction" };
            (format!("normal load of {}{taken}", name(*contact)), units.unit(Quantity::Force))
        }
        InputTarget::Friction { contact } => (format!("friction of {}", name(*contact)), None),
    };
    let mut items = Vec::new();
    if input.profile.mean() != 0.0 {
        items.push(format!("mean {}", number(input.profile.mean())));
    }
    for wave in input.profile.waves() {
        items.push(item(&format!("{} {symbol}", wave.waveform.name()), wave.amplitude, force_unit));
        let noise = wave.waveform.noise();
        let ends = noise.map_or([wave.frequency; 2], |noise| noise.band(wave.frequency));
        let scale = drawing.study.frequency_scale();
        let [low, high] = ends.map(|end| number(scale.of(end)));
        let range = if noise.is_some() { format!("{low} to {high}") } else { low };
        let symbol = if scale.unit.is_empty() { "$ω$ = " } else { "" };
        items.push(format!("{symbol}{range}{}", scale.unit));
        items.extend(wave_items(&wave.waveform, wave.envelope.is_some(), wave.phase));
    }
    (crate::words::capital(&format!("dither, {place}")), items)
}
