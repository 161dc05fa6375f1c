//! Basins as sentences, JSON and datasets.

use std::fmt::Write as _;

use quell_dynamics::attractor::{Attractor, BasinLabel};
use quell_dynamics::orbit::OrbitVerdict;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::super::attractor::{VERDICTS, number, put, put_section, verdict_code, words};
use super::{Basins, Portrait, Share};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::study::BeltStudy;
use crate::words::{capital, in_words, plural};

/// The verb for a start that ends without slow motion, singular and plural. Under a dither in the band of the vibration
/// itself no response is quiet.
pub fn quiescence(in_band: bool) -> [&'static str; 2] {
    if in_band {
        ["falls into step with the dither", "fall into step with the dither"]
    } else {
        ["falls quiet", "fall quiet"]
    }
}

impl Portrait {
    /// The word for a quiet attractor; `None` for one that vibrates.
    pub fn quiet_word(&self, attractor: &Attractor) -> Option<&'static str> {
        attractor.quiet.then_some(if self.in_band { "in step with the dither" } else { "quiet" })
    }

    /// How many starts fall quiet, and whether the base response is stable.
    pub fn sentence(&self) -> String {
        let count = self.gathered.labels.len();
        let unknown = self.gathered.unknown();
        let known = count - unknown;
        if known == 0 {
            let outcome = match count {
                1 => "The outcome of the start is unknown".to_owned(),
                _ => format!("The outcome of {count} starts is unknown"),
            };
            return format!("{outcome}. {}", self.local_sentence());
        }
        let starts = if unknown == 0 {
            format!("{count} starts")
        } else {
            format!("{known} starts with a known outcome")
        };
        let [falls, fall] = quiescence(self.in_band);
        let outcome = match self.quiet.filter(|share| share.starts > 0) {
            Some(share) if share.starts == known => match (known, unknown) {
                (1, 0) => format!("The start {falls}."),
                (1, _) => format!("The only start with a known outcome {falls}."),
                _ => format!("All {starts} {fall}."),
            },
            Some(share) => {
                let elsewhere = self.elsewhere();
                format!("Only {} of {count} starts {fall}{elsewhere}.", share.percent())
            }
            None => {
                let basins = self.gathered.basins.len();
                match (known, unknown) {
                    (1, 0) => format!("The start does not {fall}."),
                    (1, _) => format!("The only start with a known outcome does not {fall}."),
                    _ => format!(
                        "None of {starts} {falls}; they end on {basins} attractor{}.",
                        plural(basins)
                    ),
                }
            }
        };
        let local = self.local_sentence();
        match unknown {
            0 => format!("{outcome} {local}"),
            _ => format!(
                "{outcome} The outcome of {unknown} start{} is unknown. {local}",
                plural(unknown)
            ),
        }
    }

    /// The verdict on the base response.
    fn local_sentence(&self) -> String {
        match &self.local {
            Ok(verdict) => format!("The base response is {}.", verdict.name()),
            Err(why) => format!("{}.", capital(why)),
        }
    }

    /// The other attractors on which starts end, if some fall quiet.
    fn elsewhere(&self) -> String {
        let others = self.gathered.basins.iter().filter(|basin| !basin.attractor.quiet).count();
        match (others, self.gathered.unknown()) {
            (0, _) => String::new(),
            (1, 0) => "; the others end on another attractor".to_owned(),
            (1, _) => "; one other attractor was found".to_owned(),
            (_, 0) => format!("; the others end on {others} other attractors"),
            _ => format!("; {others} other attractors were found"),
        }
    }

    /// Index of the attractor on which each start ends; null if unknown.
    fn ends(&self) -> Json {
        let end = |label: &BasinLabel| match label {
            BasinLabel::Attractor(place) => Json::from(*place),
            BasinLabel::Unsettled(_) | BasinLabel::Stalled(_) => Json::Null,
        };
        self.gathered.labels.iter().map(end).collect()
    }
}

impl Basins {
    /// The meaning of the shares and their bounds.
    pub fn meaning(&self) -> &'static str {
        self.starts.layout().meaning()
    }

    /// The window and its starts as text.
    pub fn starts_in_words(&self, study: &BeltStudy) -> String {
        let window = self.starts.window();
        let x = |value| in_words(study, Quantity::Displacement, value);
        let v = |value| in_words(study, Quantity::Velocity, value);
        let layout = self.starts.layout().words();
        let (from, to) = (window.displacement, window.velocity);
        format!(
            "{layout}, x from {} to {}, x′ from {} to {}",
            x(from.0),
            x(from.1),
            v(to.0),
            v(to.1)
        )
    }

    /// Whether responses of the dither's own period may vibrate in the band of slow vibration, at any value.
    pub fn in_band(&self) -> bool {
        self.portraits.iter().any(|portrait| portrait.in_band)
    }

    /// The result in a few sentences.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        match (&self.varied, self.portraits.as_slice()) {
            (None, [portrait]) => portrait.sentence(),
            (Some(varied), portraits) => {
                let path = &varied.path;
                let [falls, fall] = quiescence(self.in_band());
                let value = |portrait: &Portrait| {
                    portrait
                        .value
                        .map_or_else(String::new, |value| number(study, varied.unit, value))
                };
                let ends: Vec<String> =
                    portraits.first().into_iter().chain(portraits.last()).map(value).collect();
                let mut text = format!("Over {path} from {}", ends.join(" to "));
                let known = || {
                    portraits
                        .iter()
                        .filter_map(|portrait| Some((portrait, 100.0 * portrait.quiet?.fraction)))
                };
                let least = known().min_by(|a, b| a.1.total_cmp(&b.1));
                let most = known().max_by(|a, b| a.1.total_cmp(&b.1));
                if let (Some((least, low)), Some((most, high))) = (least, most) {
                    let _ = write!(
                        text,
                        ", the share of starts that {fall} ranges from {low:.1} % (at {}) to {high:.1} % (at {})",
                        value(least),
                        value(most)
                    );
                } else {
                    text.push_str(", the outcome of every start is unknown");
                }
                let only_local = portraits
                    .iter()
                    .filter(|portrait| {
                        portrait.local == Ok(OrbitVerdict::Stable) && portrait.leaves()
                    })
                    .count();
                let open = portraits.iter().filter(|portrait| portrait.unknown.starts > 0).count();
                if open > 0 && least.is_some() {
                    let _ = write!(
                        text,
                        ". Some outcomes are unknown at {open} of {} values",
                        portraits.len()
                    );
                }
                if only_local > 0 {
                    let _ = write!(
                        text,
                        ". At {only_local} of {} values the base response is stable, but not every start {falls}",
                        portraits.len()
                    );
                }
                text + "."
            }
            (None, _) => String::new(),
        }
    }

    /// Warnings about the result.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let mut warnings = self.slip.warnings(study);
        for portrait in &self.portraits {
            let at = match (portrait.value, &self.varied) {
                (Some(value), Some(varied)) => format!(" at {} = {value}", varied.path),
                _ => String::new(),
            };
            let mut reasons: Vec<(&str, usize)> = Vec::new();
            for label in &portrait.gathered.labels {
                let why = match label {
                    BasinLabel::Attractor(_) => continue,
                    BasinLabel::Unsettled(why) => why.about(),
                    BasinLabel::Stalled(stalled) => stalled.why,
                };
                match reasons.iter_mut().find(|reason| reason.0 == why) {
                    Some(reason) => reason.1 += 1,
                    None => reasons.push((why, 1)),
                }
            }
            warnings.extend(reasons.into_iter().map(|(why, count)| {
                format!("the outcome of {count} start{}{at} is unknown: {why}", plural(count))
            }));
        }
        warnings
    }

    /// As JSON: the fields of a single portrait, or a list of portraits.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let scales = study.scales();
        let mut fields = Fields::new(scales);
        let window = self.starts.window();
        let pair = |pair: (f64, f64)| [pair.0, pair.1];
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "each start at τ = 0 is run until a growth rate determines on which attractor it ends")
            .plain("error_meaning", self.meaning())
            .numbers("window_displacement", Quantity::Displacement, &pair(window.displacement))
            .numbers("window_velocity", Quantity::Velocity, &pair(window.velocity))
            .plain("starts", self.starts.states().len());
        fields.plain("layout", self.starts.layout().json());
        if let Some(varied) = &self.varied {
            fields.plain("parameter", varied.path.as_str()).plain("unit", varied.unit);
            let portraits = self.portraits.iter().map(|portrait| {
                let mut inner = Fields::new(scales);
                inner.plain("value", portrait.value);
                put_portrait(&mut inner, portrait, false);
                inner
            });
            fields.list("portraits", portraits);
        } else if let [portrait] = self.portraits.as_slice() {
            put_portrait(&mut fields, portrait, true);
            fields.plain("ends", portrait.ends());
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The attractor of each start; with a parameter, the shares versus the parameter.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let facts = format!("{}; {}", self.starts_in_words(study), self.meaning());
        match (&self.varied, self.portraits.as_slice()) {
            (None, [portrait]) => self.map(study, portrait).fact(facts),
            (varied, portraits) => {
                let of = |value: &dyn Fn(&Portrait) -> f64| {
                    portraits.iter().map(value).collect::<Vec<f64>>()
                };
                let quiet = |which: fn(Share) -> f64| {
                    of(&|portrait| portrait.quiet.map_or(f64::NAN, which))
                };
                let verdicts: Vec<u8> =
                    portraits.iter().map(|portrait| verdict_code(&portrait.local)).collect();
                let (name, unit) = varied
                    .as_ref()
                    .map_or((String::new(), ""), |varied| (varied.name(), varied.unit));
                Dataset::new(study, "basins")
                    .fact(facts)
                    .with_axis(Array::new(
                        name,
                        unit,
                        of(&|portrait| portrait.value.unwrap_or(f64::NAN)),
                    ))
                    .with(Array::of_words("local_verdict", VERDICTS.to_vec(), &verdicts))
                    .array("quiet_fraction", Quantity::Ratio, quiet(|share| share.fraction))
                    .array("quiet_fraction_low", Quantity::Ratio, quiet(|share| share.low))
                    .array("quiet_fraction_high", Quantity::Ratio, quiet(|share| share.high))
                    .array(
                        "unknown_fraction",
                        Quantity::Ratio,
                        of(&|portrait| portrait.unknown.fraction),
                    )
                    .array(
                        "attractors",
                        Quantity::Count,
                        of(&|portrait| portrait.gathered.basins.len() as f64),
                    )
            }
        }
    }

    /// The attractor of each start: over the grid, or one row per start.
    fn map(&self, study: &BeltStudy, portrait: &Portrait) -> Dataset {
        let labels = &portrait.gathered.labels;
        let place = |label: &BasinLabel| match label {
            BasinLabel::Attractor(place) => *place as f64,
            BasinLabel::Unsettled(_) | BasinLabel::Stalled(_) => f64::NAN,
        };
        let quiet = |label: &BasinLabel| match label {
            BasinLabel::Attractor(place) => {
                u8::from(portrait.gathered.basins[*place].attractor.quiet)
            }
            BasinLabel::Unsettled(_) | BasinLabel::Stalled(_) => 2,
        };
        let ends: Vec<f64> = labels.iter().map(place).collect();
        let quiet: Vec<u8> = labels.iter().map(quiet).collect();
        let mut dataset = Dataset::new(study, "basins");
        for (place, basin) in portrait.gathered.basins.iter().enumerate() {
            dataset = dataset.fact(format!(
                "attractor {place}: {}",
                words(portrait.scales, &basin.attractor, portrait.period)
            ));
        }
        let words = vec![(0, "no"), (1, "yes"), (2, "unknown")];
        let dataset = if let Some((x, v)) = self.starts.axes() {
            // The last axis runs fastest.
            dataset.axis("velocity", Quantity::Velocity, v).axis(
                "displacement",
                Quantity::Displacement,
                x,
            )
        } else {
            let states = self.starts.states();
            let rows = (0..states.len()).map(|row| row as f64).collect();
            dataset
                .with_axis(Array::new("start", "1", rows))
                .array(
                    "displacement",
                    Quantity::Displacement,
                    states.iter().map(|start| start.displacement).collect(),
                )
                .array(
                    "velocity",
                    Quantity::Velocity,
                    states.iter().map(|start| start.velocity).collect(),
                )
        };
        dataset
            .with(Array::new("attractor", "1", ends))
            .with(Array::of_words("quiet", words, &quiet))
    }
}

fn put_portrait(fields: &mut Fields, portrait: &Portrait, section: bool) {
    match &portrait.local {
        Ok(verdict) => fields.plain("local_verdict", verdict.name()),
        Err(why) => fields.unknown("local_verdict", why.as_str()),
    };
    Share::put_quiet(fields, portrait.quiet);
    let scales = portrait.scales;
    let attractors = portrait.gathered.basins.iter().zip(&portrait.shares).map(|(basin, share)| {
        let mut inner = Fields::new(scales);
        inner.plain("words", words(portrait.scales, &basin.attractor, portrait.period));
        share.put(&mut inner);
        put(&mut inner, &basin.attractor, portrait.period);
        if section {
            put_section(&mut inner, &basin.attractor);
        }
        inner
    });
    let attractors: Vec<Fields> = attractors.collect();
    fields.list("attractors", attractors);
    let mut unknown = Fields::new(scales);
    portrait.unknown.put(&mut unknown);
    fields.nested("unknown", unknown);
}
