//! `[dither]` of a disc: its waveform, read as those of belts and systems are, its envelope, and its amplitude relative to friction.

use quell_input::document::{Table, Value};
use quell_model::Direction;
use quell_model::disc::{DiscDither, DitherShape};
use quell_model::parameter::DITHER_FREQUENCY_RATIO;
use quell_model::parameter::disc::DISC_DITHER_AMPLITUDE;

use crate::study::course::{Course, CoursePlace};
use crate::study::reader::Reader;
use crate::study::vocabulary::{Choice, ENVELOPE, Section};
use crate::study::waveform;

/// The keys that do not describe the waveform.
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
    reader.unknown_keys(table, Section::Dither, "dither");
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
