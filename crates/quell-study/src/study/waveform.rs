//! The waveform of a dither: its name, and the keys that describe one by harmonics, by samples, by bursts, or as noise.

use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_input::wave_file;
use quell_model::Waveform;
use quell_model::waveform::{
    BURST, Burst, FOURIER, FourierWave, Harmonic, Hold, LARGEST_SEED, NOISE, Noise, SAMPLES,
    SampledWave, WaveformError,
};
use serde_json::Value as Json;

use crate::study::reader::Reader;
use crate::study::vocabulary::{Choice, WAVE_KEYS, join};

/// Most periods of the carrier in a part of a burst: more are a carrier without pauses, or a pause, to any run.
const MOST_CYCLES: f64 = 1e6;

/// Lines of noise by default.
const LINES: f64 = 64.0;

/// Seed of noise by default.
const SEED: f64 = 1.0;

/// The keys of a periodic dither that noise does not have.
const OF_PERIODIC: [&str; 4] = ["frequency_ratio", "frequency", "frequency_hz", "phase"];

/// Whether the waveform of a dither is noise, which has a band instead of a frequency and a phase.
pub(super) fn is_noise(table: &Table) -> bool {
    matches!(table.get("waveform").map(|node| &node.value), Some(Value::Text(name)) if name == NOISE)
}

/// Reads the waveform of a dither, and of noise the middle of its band; `header` is the place of its table, `band` reads the key
/// of the band, in the unit of the frequency: `Some(None)` where it is not given.
pub(super) fn read(
    reader: &mut Reader,
    table: &Table,
    (prefix, header): (&str, Origin),
    band: impl FnOnce(&mut Reader) -> Option<Option<[f64; 2]>>,
) -> Option<(Waveform, Option<f64>)> {
    let name = reader.needed_choice(table, prefix, header, "waveform", Choice::Waveform)?;
    described(reader, table, (prefix, header), name, band)
}

/// As [`read`], a sine where no waveform is named, and periodic waveforms only.
pub(super) fn read_or_sine(
    reader: &mut Reader,
    table: &Table,
    prefix: &str,
    header: Origin,
) -> Option<Waveform> {
    let name = match table.get("waveform") {
        None => Waveform::Sine.name(),
        Some(node) => reader.choice(&join(prefix, "waveform"), node, Choice::Waveform)?,
    };
    if let Some(node) = table.get("waveform").filter(|_| name == NOISE) {
        let allowed = "periodic: the exponents of a disc, its resonances and tongues exist under periodic dither only";
        reader.wrong(&join(prefix, "waveform"), node, allowed);
        return None;
    }
    described(reader, table, (prefix, header), name, |_| None).map(|(waveform, _)| waveform)
}

/// The waveform of a name, by the keys that describe it, and of noise the middle of its band.
fn described(
    reader: &mut Reader,
    table: &Table,
    (prefix, header): (&str, Origin),
    name: &str,
    band: impl FnOnce(&mut Reader) -> Option<Option<[f64; 2]>>,
) -> Option<(Waveform, Option<f64>)> {
    let mut fits = true;
    for (key, wave) in WAVE_KEYS {
        if let Some(node) = table.get(key).filter(|_| wave.waveform() != name) {
            let allowed = format!("left out: only the waveform \"{}\" has it", wave.waveform());
            let key = join(prefix, key);
            reader.complain(Complaint::new(
                Fault::Conflict,
                key,
                node.origin,
                node.given(),
                allowed,
            ));
            fits = false;
        }
    }
    let not_of_noise = OF_PERIODIC.into_iter().filter(|_| name == NOISE);
    for (key, node) in not_of_noise.filter_map(|key| Some((key, table.get(key)?))) {
        let allowed = "left out: noise has the frequencies of its band and random phases";
        let key = join(prefix, key);
        reader.complain(Complaint::new(Fault::Conflict, key, node.origin, node.given(), allowed));
        fits = false;
    }
    if !fits {
        return None;
    }
    let place = WavePlace { table, prefix, header };
    let waveform = match name {
        FOURIER => place.fourier(reader),
        SAMPLES => place.samples(reader),
        BURST => place.burst(reader),
        NOISE => return place.noise(reader, band),
        _ => Waveform::from_name(name),
    };
    Some((waveform?, None))
}

/// The table of a dither.
struct WavePlace<'a> {
    table: &'a Table,
    prefix: &'a str,
    header: Origin,
}

impl<'a> WavePlace<'a> {
    /// A key that the waveform needs.
    fn needed(&self, reader: &mut Reader, name: &str, allowed: &str) -> Option<&'a Node> {
        let found = self.table.get(name);
        if found.is_none() {
            let key = join(self.prefix, name);
            let complaint = Complaint::new(Fault::Missing, key, self.header, Json::Null, allowed);
            reader.complain(complaint);
        }
        found
    }

    /// Reports why numbers make no waveform.
    fn refused(&self, reader: &mut Reader, why: WaveformError) -> Option<Waveform> {
        let in_si = self.table.has("band_hz") && why.key == "band";
        let name = if in_si { "band_hz" } else { why.key };
        let key = join(self.prefix, name);
        let node = self.table.get(name);
        let (origin, given) =
            node.map_or((self.header, Json::Null), |node| (node.origin, node.given()));
        reader.complain(Complaint::new(Fault::Value, key, origin, given, why.allowed));
        None
    }

    fn fourier(&self, reader: &mut Reader) -> Option<Waveform> {
        const ALLOWED: &str = "a list of harmonics, such as [{ order = 1, sine = 1.0 }, { order = 3, sine = 0.2, cosine = 0.1 }]";
        let node = self.needed(reader, "harmonics", ALLOWED)?;
        let key = join(self.prefix, "harmonics");
        let Value::List(list) = &node.value else {
            reader.wrong(&key, node, format!("{ALLOWED}; got {}", node.kind()));
            return None;
        };
        let harmonics: Vec<Option<Harmonic>> = list
            .iter()
            .enumerate()
            .map(|(place, node)| harmonic(reader, &format!("{key}[{place}]"), node))
            .collect();
        let harmonics: Option<Vec<Harmonic>> = harmonics.into_iter().collect();
        match FourierWave::new(harmonics?) {
            Ok(series) => Some(Waveform::Fourier(series.into())),
            Err(why) => self.refused(reader, why),
        }
    }

    fn samples(&self, reader: &mut Reader) -> Option<Waveform> {
        let hold = match self.table.get("hold") {
            None => Hold::default(),
            Some(node) => {
                let key = join(self.prefix, "hold");
                Hold::from_name(reader.choice(&key, node, Choice::Hold)?)?
            }
        };
        let values = match self.table.get("file") {
            Some(node) => self.samples_of_file(reader, node)?,
            None => self.listed_samples(reader)?,
        };
        match SampledWave::new(values, hold) {
            Ok(samples) => Some(Waveform::Samples(samples.into())),
            Err(mut why) => {
                if self.table.get("file").is_some() {
                    why.key = "file";
                }
                self.refused(reader, why)
            }
        }
    }

    /// The samples in a file of their own.
    fn samples_of_file(&self, reader: &mut Reader, node: &Node) -> Option<Vec<f64>> {
        let key = join(self.prefix, "file");
        if let Some(other) = self.table.get("values") {
            let allowed = format!("the samples are already given by {key}; remove this key");
            let values = join(self.prefix, "values");
            let complaint =
                Complaint::new(Fault::Conflict, values, other.origin, Json::Null, allowed);
            reader.complain(complaint);
            return None;
        }
        let name = reader.text(&key, node)?;
        let values = wave_file::values(reader.files(), &key, &name);
        reader.in_file((&key, node), &name, values)
    }

    /// The samples in the study.
    fn listed_samples(&self, reader: &mut Reader) -> Option<Vec<f64>> {
        const ALLOWED: &str =
            "the samples of one period, a list of at least two numbers, or given by file";
        let node = self.needed(reader, "values", ALLOWED)?;
        let key = join(self.prefix, "values");
        let Value::List(list) = &node.value else {
            reader.wrong(&key, node, format!("{ALLOWED}; got {}", node.kind()));
            return None;
        };
        let mut values = Vec::with_capacity(list.len());
        for (place, node) in list.iter().enumerate() {
            let Value::Number(value) = node.value else {
                let allowed = format!("a number; got {}", node.kind());
                reader.wrong(&format!("{key}[{place}]"), node, allowed);
                return None;
            };
            values.push(value);
        }
        Some(values)
    }

    fn burst(&self, reader: &mut Reader) -> Option<Waveform> {
        let carrier =
            reader.needed_choice(self.table, self.prefix, self.header, "carrier", Choice::Carrier);
        let count = |reader: &mut Reader, name: &str| {
            let allowed =
                format!("a whole number of periods of the carrier, from 0 to {MOST_CYCLES}");
            let node = self.needed(reader, name, &allowed)?;
            self.whole(reader, name, node, (MOST_CYCLES, &allowed))
        };
        let (on, off) = (count(reader, "on"), count(reader, "off"));
        let small = |count: Option<u64>| count.and_then(|count| u32::try_from(count).ok());
        let (on, off) = (small(on), small(off));
        match Burst::new(Waveform::from_name(carrier?)?, on?, off?) {
            Ok(burst) => Some(burst.into_waveform()),
            Err(why) => self.refused(reader, why),
        }
    }
}

impl WavePlace<'_> {
    /// A whole number from 0 to `most`.
    fn whole(
        &self,
        reader: &mut Reader,
        name: &str,
        node: &Node,
        (most, allowed): (f64, &str),
    ) -> Option<u64> {
        match node.value {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number up to 2⁵³"
            )]
            Value::Number(value) if value.fract() == 0.0 && (0.0..=most).contains(&value) => {
                Some(value as u64)
            }
            _ => {
                reader.wrong(&join(self.prefix, name), node, allowed);
                None
            }
        }
    }

    /// Noise, with the middle of its band.
    fn noise(
        &self,
        reader: &mut Reader,
        band: impl FnOnce(&mut Reader) -> Option<Option<[f64; 2]>>,
    ) -> Option<(Waveform, Option<f64>)> {
        const ALLOWED: &str = "the lowest and the highest frequency of the noise, such as [8.0, 12.0]; or band_hz in hertz";
        let band = band(reader);
        if band == Some(None) {
            self.needed(reader, "band", ALLOWED);
        }
        let mut count = |name: &str, default: f64, most: f64| match self.table.get(name) {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "the default, a small whole number"
            )]
            None => Some(default as u64),
            Some(node) => {
                self.whole(reader, name, node, (most, &format!("a whole number from 0 to {most}")))
            }
        };
        let (lines, seed) = (count("lines", LINES, 1e6), count("seed", SEED, LARGEST_SEED as f64));
        let lines = lines.and_then(|lines| u32::try_from(lines).ok());
        let (band, lines, seed) = (band??, lines?, seed?);
        match Noise::new(band, lines, seed) {
            Ok(noise) => Some((Waveform::Noise(noise.into()), Some(Noise::middle(band)))),
            Err(why) => {
                self.refused(reader, why);
                None
            }
        }
    }
}

/// One harmonic.
fn harmonic(reader: &mut Reader, key: &str, node: &Node) -> Option<Harmonic> {
    const ALLOWED: &str = "a table of order, sine and cosine, such as { order = 3, sine = 0.2 }";
    let Some(table) = node.table() else {
        reader.wrong(key, node, format!("{ALLOWED}; got {}", node.kind()));
        return None;
    };
    for (name, inner) in table.iter() {
        if !["order", "sine", "cosine"].contains(&name) {
            let key = join(key, name);
            let complaint =
                Complaint::new(Fault::Unknown, key, inner.origin, inner.given(), ALLOWED);
            reader.complain(complaint);
            return None;
        }
    }
    let mut number = |name: &str, default: Option<f64>| {
        let inner = match table.get(name) {
            Some(inner) => inner,
            None if default.is_some() => return default,
            None => {
                reader.wrong(key, node, ALLOWED);
                return None;
            }
        };
        let Value::Number(value) = inner.value else {
            reader.wrong(&join(key, name), inner, format!("a number; got {}", inner.kind()));
            return None;
        };
        Some(value)
    };
    let order = number("order", None)?;
    let (sine, cosine) = (number("sine", Some(0.0))?, number("cosine", Some(0.0))?);
    if order.fract() != 0.0 || !(1.0..=1e6).contains(&order) {
        reader.wrong(
            &join(key, "order"),
            table.get("order").unwrap_or(node),
            "a whole number from 1",
        );
        return None;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number up to 10⁶"
    )]
    Some(Harmonic { order: order as u32, sine, cosine })
}
