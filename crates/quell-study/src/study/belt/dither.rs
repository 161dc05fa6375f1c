//! `[dither]` or `[[dither]]`.

use quell_input::document::{Node, Table, Value};
use quell_model::parameter::{Bounds, DITHER_FREQUENCY_RATIO, DITHER_PHASE};
use quell_model::{Direction, Dither};

use crate::study::band;
use crate::study::course::{Course, CoursePlace};
use crate::study::dither_size::{self, SizedAmplitude};
use crate::study::reader::Reader;
use crate::study::vocabulary::{Choice, ENVELOPE, Section};
use crate::study::waveform;

/// Every dither, its amplitude zero while an actuator determines it, and their amplitudes with their paths.
pub(super) type BeltDithers = (Vec<Dither>, Vec<(String, SizedAmplitude)>);

/// Reads every dither; `None` if one of them is invalid.
pub(super) fn read(reader: &mut Reader, root: &Table) -> Option<BeltDithers> {
    let Some(node) = root.get("dither") else {
        return Some(BeltDithers::default());
    };
    let has_actuator = root.has("actuator");
    match &node.value {
        Value::Table(_) => {
            let (dither, size) = one(reader, node, ("dither", has_actuator))?;
            Some((vec![dither], vec![size]))
        }
        Value::List(list) => {
            let single = list.len() == 1;
            let dithers: Vec<Option<_>> = list
                .iter()
                .enumerate()
                .map(|(index, node)| {
                    let prefix = if single { "dither".into() } else { format!("dither[{index}]") };
                    one(reader, node, (&prefix, has_actuator))
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
    (prefix, has_actuator): (&str, bool),
) -> Option<(Dither, (String, SizedAmplitude))> {
    let Some(table) = node.table() else {
        reader.wrong(prefix, node, format!("a table; got {}", node.kind()));
        return None;
    };
    reader.part(table, has_actuator, |reader| whole(reader, (node, table), (prefix, has_actuator)))
}

fn whole(
    reader: &mut Reader,
    (node, table): (&Node, &Table),
    (prefix, has_actuator): (&str, bool),
) -> Option<(Dither, (String, SizedAmplitude))> {
    reader.unknown_keys(table, Section::Dither, prefix);
    let direction = reader
        .needed_choice(table, prefix, node.origin, "direction", Choice::Direction)
        .and_then(Direction::from_name);
    let is_noise = waveform::is_noise(table);
    let wave = waveform::read(reader, table, (prefix, node.origin), |reader| {
        band::given(reader, table, prefix, Bounds::POSITIVE)
    });
    let (waveform, middle) = wave.unzip();
    let wave = (waveform.as_ref(), has_actuator);
    let amplitude = dither_size::read(reader, table, (prefix, node.origin), wave);
    let (frequency_ratio, phase) = if is_noise {
        (middle.flatten(), Some(0.0))
    } else {
        let frequency_ratio = reader.number(table, prefix, node.origin, DITHER_FREQUENCY_RATIO);
        (frequency_ratio, reader.optional(table, prefix, DITHER_PHASE).or(0.0))
    };
    let envelope =
        CoursePlace(ENVELOPE).optional(reader, table, prefix, "envelope").map(Course::knots);
    let amplitude = amplitude?;
    let dither = Dither {
        direction: direction?,
        waveform: waveform?,
        amplitude: amplitude.so_far(),
        frequency_ratio: frequency_ratio?,
        phase: phase?,
        envelope: envelope.ok()?,
    };
    Some((dither, (prefix.to_owned(), amplitude)))
}
