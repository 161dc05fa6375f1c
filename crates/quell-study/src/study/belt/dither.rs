//! `[dither]` or `[[dither]]`.

use quell_model::parameter::{DITHER_AMPLITUDE, DITHER_FREQUENCY_RATIO, DITHER_PHASE};
use quell_model::{Direction, Dither};

use super::band;
use crate::study::course::{Course, CoursePlace, CourseUnits};
use crate::study::document::{Node, Table, Value};
use crate::study::reader::{Found, Reader};
use crate::study::vocabulary::{Choice, ENVELOPE, Section};
use crate::study::wave_file::WaveFiles;
use crate::study::waveform;

/// Reads every dither; `None` if one of them is invalid.
pub(super) fn read(
    reader: &mut Reader,
    root: &Table,
    files: &mut WaveFiles<'_>,
) -> Option<Vec<Dither>> {
    let Some(node) = root.get("dither") else {
        return Some(Vec::new());
    };
    match &node.value {
        Value::Table(_) => one(reader, node, "dither", files).map(|dither| vec![dither]),
        Value::List(list) => {
            let single = list.len() == 1;
            let dithers: Vec<Option<Dither>> = list
                .iter()
                .enumerate()
                .map(|(index, node)| {
                    let prefix = if single { "dither".into() } else { format!("dither[{index}]") };
                    one(reader, node, &prefix, files)
                })
                .collect();
            dithers.into_iter().collect()
        }
        _ => {
            reader.wrong(
                "dither",
                node,
                format!("a table [dither] or tables [[dither]]; got {}", node.kind()),
            );
            None
        }
    }
}

fn one(
    reader: &mut Reader,
    node: &Node,
    prefix: &str,
    files: &mut WaveFiles<'_>,
) -> Option<Dither> {
    let Some(table) = node.table() else {
        reader.wrong(prefix, node, format!("a table; got {}", node.kind()));
        return None;
    };
    reader.unknown_keys(table, Section::Dither, prefix, &["envelope"]);
    let direction = reader
        .needed_choice(table, prefix, node.origin, "direction", Choice::Direction)
        .and_then(Direction::from_name);
    let is_noise = waveform::is_noise(table);
    let wave = waveform::read(reader, table, (prefix, node.origin), files, |reader| {
        band::given(reader, table, prefix)
    });
    let (waveform, middle) = wave.unzip();
    let amplitude = match reader.optional(table, prefix, DITHER_AMPLITUDE, waveform.as_ref()) {
        Found::Value(value) => Some(value),
        Found::Wrong => None,
        Found::Absent => reader.number(table, prefix, node.origin, DITHER_AMPLITUDE),
    };
    let (frequency_ratio, phase) = if is_noise {
        (middle.flatten(), Some(0.0))
    } else {
        let frequency_ratio = reader.number(table, prefix, node.origin, DITHER_FREQUENCY_RATIO);
        (frequency_ratio, reader.optional(table, prefix, DITHER_PHASE, None).or(0.0))
    };
    let place = CoursePlace { what: ENVELOPE, units: CourseUnits::Belt, folder: files.folder() };
    let envelope = place.optional(reader, table, prefix, "envelope").map(Course::knots);
    Some(Dither {
        direction: direction?,
        waveform: waveform?,
        amplitude: amplitude?,
        frequency_ratio: frequency_ratio?,
        phase: phase?,
        envelope: envelope.ok()?,
    })
}
