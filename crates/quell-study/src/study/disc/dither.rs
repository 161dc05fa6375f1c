//! `[dither]` of a disc: its waveform, read as those of belts and systems are, its envelope, and its amplitude relative to friction.

use quell_model::Direction;
use quell_model::disc::{DiscDither, DitherShape};
use quell_model::parameter::DITHER_FREQUENCY_RATIO;
use quell_model::parameter::disc::DISC_DITHER_AMPLITUDE;

use crate::complaint::{Complaint, Fault};
use crate::study::course::{Course, CoursePlace};
use crate::study::document::{Table, Value};
use crate::study::reader::Reader;
use crate::study::suggest;
use crate::study::vocabulary::{Choice, ENVELOPE, WAVE_KEYS, join};
use crate::study::waveform;

/// The keys that do not describe the waveform.
const KEYS: [&str; 4] = ["direction", "waveform", "amplitude", "envelope"];

/// Reads the dither of all loads; `None` if it is invalid, which has been reported.
pub(super) fn read(reader: &mut Reader, document: &Table) -> Option<(DiscDither, DitherShape)> {
    let Some(node) = document.get("dither") else {
        return Some((DiscDither::None, DitherShape::default()));
    };
    let node = match &node.value {
        Value::List(list) if list.len() == 1 => &list[0],
        _ => node,
    };
    let table = reader.table("dither", node)?;
    unknown_keys(reader, table);
    let direction = reader
        .needed_choice(table, "dither", node.origin, "direction", Choice::Direction)
        .and_then(Direction::from_name);
    let waveform = waveform::read_or_sine(reader, table, "dither", node.origin);
    // Without one, that of the dissertation's tangential dither.
    let amplitude = reader.optional(table, "dither", DISC_DITHER_AMPLITUDE).or(1.0);
    let frequency_ratio = reader.number(table, "dither", node.origin, DITHER_FREQUENCY_RATIO);
    let envelope =
        CoursePlace(ENVELOPE).optional(reader, table, "dither", "envelope").map(Course::knots);
    let shape = DitherShape { waveform: waveform?, envelope: envelope.ok()? };
    let (amplitude, frequency_ratio) = (amplitude?, frequency_ratio?);
    let dither = match direction? {
        Direction::Normal => DiscDither::Normal { amplitude, frequency_ratio },
        Direction::Tangential => DiscDither::Tangential { amplitude, frequency_ratio },
    };
    Some((dither, shape))
}

fn unknown_keys(reader: &mut Reader, table: &Table) {
    let wave = WAVE_KEYS.iter().map(|(name, _)| *name);
    let keys: Vec<&str> =
        KEYS.into_iter().chain(DITHER_FREQUENCY_RATIO.keys()).chain(wave).collect();
    for (name, node) in table.iter().filter(|(name, _)| !keys.contains(name)) {
        let nearest = suggest::word(name, keys.iter().copied()).map(|word| join("dither", &word));
        let complaint = Complaint::new(
            Fault::Unknown,
            join("dither", name),
            node.origin,
            node.given(),
            keys.join(", "),
        );
        reader.complain(complaint.suggesting(nearest));
    }
}
