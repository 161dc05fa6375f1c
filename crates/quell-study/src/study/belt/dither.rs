//! `[dither]` or `[[dither]]`.

use quell_design::actuator::Actuator;
use quell_input::document::{Node, Table, Value};
use quell_linear::driven_point::DrivenPoint;
use quell_model::parameter::{Bounds, DITHER_FREQUENCY_RATIO, DITHER_PHASE};
use quell_model::{Direction, Dither, Waveform};

use crate::study::band;
use crate::study::course::{Course, CoursePlace};
use crate::study::dither_size::{self, GivenSize, SizedAmplitude};
use crate::study::reader::Reader;
use crate::study::vocabulary::{Choice, ENVELOPE, Section, join};
use crate::study::waveform;

/// Reads every dither; `None` if one of them is invalid.
pub(super) fn read(
    reader: &mut Reader,
    root: &Table,
) -> Option<Vec<(Dither, String, SizedAmplitude)>> {
    let Some(node) = root.get("dither") else {
        return Some(Vec::new());
    };
    let has_actuator = root.has("actuator");
    match &node.value {
        Value::Table(_) => one(reader, node, ("dither", has_actuator)).map(|dither| vec![dither]),
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
) -> Option<(Dither, String, SizedAmplitude)> {
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
) -> Option<(Dither, String, SizedAmplitude)> {
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
    Some((dither, prefix.to_owned(), amplitude))
}

/// The dithers with the amplitudes that an actuator determines, and every amplitude that is given by another size than a peak force;
/// `None` if one is wrong.
pub(super) fn sized(
    reader: &mut Reader,
    read: Vec<(Dither, String, SizedAmplitude)>,
    actuator: Option<&Actuator>,
    damping_ratio: Option<f64>,
) -> Option<(Vec<Dither>, Vec<GivenSize>)> {
    let (mut dithers, mut sizes) = (Vec::new(), Vec::new());
    let mut whole = true;
    for (place, (dither, prefix, size)) in read.into_iter().enumerate() {
        let mut dither = dither;
        match size {
            SizedAmplitude::Known(_, None) => {}
            SizedAmplitude::Known(amplitude, Some((key, value))) => {
                let path = join(&prefix, key.key);
                sizes.push(GivenSize { dither: place, path, key, value, amplitude });
            }
            SizedAmplitude::Driven(driven) => {
                let waveform = dither.waveform.clone();
                let point = point(&waveform, &dither, damping_ratio?);
                match driven.resolved(reader, actuator, point) {
                    Some(amplitude) => {
                        dither.amplitude = amplitude;
                        sizes.push(driven.into_given(place, amplitude));
                    }
                    None => whole = false,
                }
            }
        }
        dithers.push(dither);
    }
    whole.then_some((dithers, sizes))
}

/// The mass under a dither.
fn point<'w>(
    waveform: &'w Waveform,
    dither: &Dither,
    damping_ratio: f64,
) -> Result<DrivenPoint<'w>, String> {
    if dither.direction == Direction::Normal {
        let why = "a normal dither on a prescribed load has no stroke, which the demand on an actuator needs";
        return Err(why.to_owned());
    }
    DrivenPoint::of_belt(waveform, dither.frequency_ratio, damping_ratio)
        .map_err(|why| why.to_string())
}
