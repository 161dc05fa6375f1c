//! `[dither]` of a disc: its waveform, read as those of belts and systems are, its envelope, and its amplitude relative to friction.

use quell_input::document::{Table, Value};
use quell_model::Direction;
use quell_model::disc::{DiscDither, DitherShape};
use quell_model::parameter::DITHER_FREQUENCY_RATIO;
use quell_model::parameter::disc::DISC_DITHER_AMPLITUDE;

use crate::study::course::{Course, CoursePlace};
use crate::study::dither_size::{self, SizedAmplitude};
use crate::study::reader::Reader;
use crate::study::vocabulary::size::DITHER_SIZES;
use crate::study::vocabulary::{Choice, ENVELOPE, Section};
use crate::study::waveform;

/// The dither of all loads, its amplitude zero while an actuator determines it.
pub(super) struct ReadDiscDither {
    pub(super) dither: DiscDither,
    pub(super) shape: DitherShape,
    /// The size that gives the amplitude, if an actuator does.
    pub(super) driven: Option<SizedAmplitude>,
}

/// Reads it; `None` if it is invalid, which has been reported.
pub(super) fn read(reader: &mut Reader, document: &Table) -> Option<ReadDiscDither> {
    let Some(node) = document.get("dither") else {
        let (dither, shape) = (DiscDither::None, DitherShape::default());
        return Some(ReadDiscDither { dither, shape, driven: None });
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
    let is_driven = DITHER_SIZES.iter().any(|size| size.needs_actuator() && table.has(size.key));
    let (amplitude, driven) = if is_driven {
        let wave = (waveform.as_ref(), document.has("actuator"));
        let size = dither_size::read(reader, table, ("dither", node.origin), wave);
        (size.as_ref().map(SizedAmplitude::so_far), size)
    } else {
        // Without one, that of the dissertation's tangential dither.
        (reader.optional(table, "dither", DISC_DITHER_AMPLITUDE).or(1.0), None)
    };
    let frequency_ratio = reader.number(table, "dither", node.origin, DITHER_FREQUENCY_RATIO);
    let envelope =
        CoursePlace(ENVELOPE).optional(reader, table, "dither", "envelope").map(Course::knots);
    let shape = DitherShape { waveform: waveform?, envelope: envelope.ok()? };
    let (amplitude, frequency_ratio) = (amplitude?, frequency_ratio?);
    let dither = match direction? {
        Direction::Normal => DiscDither::Normal { amplitude, frequency_ratio },
        Direction::Tangential => DiscDither::Tangential { amplitude, frequency_ratio },
    };
    Some(ReadDiscDither { dither, shape, driven })
}
