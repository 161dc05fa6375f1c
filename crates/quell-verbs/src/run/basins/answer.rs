//! Basins in sentences, JSON and datasets.

use std::fmt::Write as _;

use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::{Basins, Portrait, Share};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::system::attractor::{VERDICTS, in_words, put_attractor, verdict_code};
use crate::run::system::of_runs::beyond_laws;
use crate::run::system::value_at;
use crate::study::SystemStudy;
use crate::words::{capital, digits, plural, quantity_at, quantity_is, unit_after};

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
    /// How many starts fall quiet, and whether the base response is stable.
    fn sentence(&self) -> String {
        let count = self.ends.len();
        let unknown = self.unknown.starts;
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
                let basins = self.basins.len();
                match (known, unknown) {
                    (1, 0) => format!("The start does not {fall}."),
                    (1, _) => format!("The only start with a known outcome does not {fall}."),
                    _ => format!(
                        "None of {starts} {falls}; they end on {basins} motion{}.",
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
        let subject = if self.is_dithered { "The base response" } else { "Steady sliding" };
        match &self.local {
            Ok(verdict) => format!("{subject} is {verdict}."),
            Err(why) => format!("{}.", capital(&why.to_string())),
        }
    }

    /// The other motions on which starts end, if some fall quiet.
    fn elsewhere(&self) -> String {
        let others = self.basins.iter().filter(|basin| !basin.attractor.quiet).count();
        match (others, self.unknown.starts) {
            (0, _) => String::new(),
            (1, 0) => "; the others end on another motion".to_owned(),
            (1, _) => "; one other motion was found".to_owned(),
            (_, 0) => format!("; the others end on {others} other motions"),
            _ => format!("; {others} other motions were found"),
        }
    }

    fn put(&self, fields: &mut Fields, study: &SystemStudy) {
        match &self.local {
            Ok(verdict) => fields.plain("local_verdict", *verdict),
            Err(why) => fields.unknown("local_verdict", why),
        };
        Share::put_quiet(fields, self.quiet);
        let attractors = self.basins.iter().map(|basin| {
            let mut inner = Fields::in_units(study.units());
            basin.share.put(&mut inner);
            inner.plain("periods_to_settle", basin.periods);
            put_attractor(&mut inner, &basin.attractor, study);
            inner
        });
        let attractors: Vec<Fields> = attractors.collect();
        fields.list("attractors", attractors).plain("unknown_starts", self.unknown.starts);
        let mut unknown = Fields::in_units(study.units());
        self.unknown.put(&mut unknown);
        fields.nested("unknown", unknown);
    }
}

impl Basins {
    /// Whether motions with the period of the dither may vibrate in the band of the vibration, at any value.
    pub fn in_band(&self) -> bool {
        self.portraits.iter().any(|portrait| portrait.in_band)
    }

    /// How many starts fall quiet, or the range of their share over the parameter, in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        match (&self.over, self.portraits.as_slice()) {
            (None, [portrait]) => portrait.sentence(),
            _ => self.over_parameter(study).join(" "),
        }
    }

    /// The plane of the starts where the state has other numbers.
    pub fn notes(&self, study: &SystemStudy) -> Vec<String> {
        let other = study.system().state_names().len() - 2;
        let [first, second] = &self.names;
        let plane = format!(
            "The starts are in the plane of {first} and {second}; the other {other} number{} of the state {} {}.",
            plural(other),
            if other == 1 { "starts" } else { "start" },
            self.start
        );
        (other > 0).then_some(plane).into_iter().collect()
    }

    /// A value of the parameter with its unit.
    fn value(&self, study: &SystemStudy, value: f64) -> String {
        let path = self.over.as_ref().map_or("", |over| over.parameter.as_str());
        value_at(study, path, value)
    }

    fn over_parameter(&self, study: &SystemStudy) -> Vec<String> {
        let Some(over) = &self.over else { return Vec::new() };
        let (from, to) = (self.value(study, over.from), self.value(study, over.to));
        let mut text = format!("Over the {} from {from} to {to}", quantity_at(&over.parameter));
        let known = || {
            let portraits = self.portraits.iter();
            portraits.filter_map(|portrait| Some((portrait.value?, portrait.quiet?.fraction)))
        };
        let least = known().min_by(|a, b| a.1.total_cmp(&b.1));
        let most = known().max_by(|a, b| a.1.total_cmp(&b.1));
        let [falls, fall] = quiescence(self.in_band());
        match least.zip(most) {
            Some(((at, low), (other, high))) => {
                let (at, other) = (self.value(study, at), self.value(study, other));
                let (low, high) = (100.0 * low, 100.0 * high);
                let _ = write!(
                    text,
                    ", the share of starts that {fall} ranges from {low:.1} % (at {at}) to {high:.1} % (at {other})."
                );
            }
            None => text.push_str(", the outcome of every start is unknown."),
        }
        let mut sentences = vec![text];
        let count = self.portraits.len();
        let open = self.portraits.iter().filter(|portrait| portrait.unknown.starts > 0).count();
        if open > 0 && least.is_some() {
            sentences.push(format!("Some outcomes are unknown at {open} of {count} values."));
        }
        let only_local = self.portraits.iter().filter(|portrait| {
            portrait.local.as_ref().is_ok_and(|verdict| *verdict == "stable") && portrait.leaves()
        });
        let only_local = only_local.count();
        if only_local > 0 {
            let subject = if self.portraits.iter().any(|portrait| portrait.is_dithered) {
                "the base response"
            } else {
                "steady sliding"
            };
            sentences.push(format!(
                "At {only_local} of {count} values {subject} is stable, but not every start {falls}."
            ));
        }
        sentences
    }

    /// The starts in words.
    pub fn starts_in_words(&self, study: &SystemStudy) -> String {
        let axes = [0, 1].map(|axis| {
            let unit = unit_after(Some(self.unit(study, axis)));
            let RealInterval { lower: from, upper: to } = self.windows[axis];
            format!("{} from {} to {}{unit}", self.names[axis], digits(from), digits(to))
        });
        format!("{}, {}", self.layout.words(), axes.join(", "))
    }

    /// The meaning of the shares and their bounds.
    pub fn meaning(&self) -> &'static str {
        self.layout.meaning()
    }

    /// The unit of an axis.
    fn unit(&self, study: &SystemStudy, axis: usize) -> &'static str {
        let names = study.system().state_names();
        let place = names.iter().position(|name| *name == self.names[axis]);
        let quantity = place.and_then(|place| study.system().state_quantity(place));
        quantity.and_then(|quantity| study.units().unit(quantity)).unwrap_or("1")
    }

    /// Warnings: those of the study, and starts of unknown outcome.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let unknown = self.portraits.iter().flat_map(|portrait| {
            let at = match (portrait.value, &self.over) {
                (Some(value), Some(over)) => {
                    format!(" at the {}", quantity_is(&over.parameter, &self.value(study, value)))
                }
                _ => String::new(),
            };
            portrait.reasons.iter().map(move |(why, count)| {
                format!("the outcome of {count} start{}{at} is unknown: {why}", plural(*count))
            })
        });
        let beyond = beyond_laws(study, |contact| {
            let speeds = self.portraits.iter().map(|portrait| portrait.largest_slip[contact]);
            speeds.fold(0.0, f64::max)
        });
        study.warnings().iter().cloned().chain(beyond).chain(unknown).collect()
    }

    /// As JSON: the fields of a single portrait, or a list of portraits.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::in_units(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain(
                "protocol",
                "each start at t = 0 is run until it is certain on which motion it ends",
            )
            .plain("error_meaning", self.meaning())
            .plain("plane", self.names.to_vec())
            .plain("start", self.start.clone())
            .plain("starts", self.starts.len())
            .plain("layout", self.layout.json());
        // Of a grid the values of each axis, of a sample those of each start.
        let columns = self.layout.axes(self.windows).unwrap_or_else(|| {
            [0, 1].map(|axis| self.starts.iter().map(|start| start[axis]).collect())
        });
        for (axis, (name, values)) in ["across", "up"].into_iter().zip(columns).enumerate() {
            let (unit, RealInterval { lower: from, upper: to }) =
                (self.unit(study, axis), self.windows[axis]);
            fields.measured(name, unit, values);
            let window = ["window_across", "window_up"][axis];
            fields.measured(window, unit, vec![from, to]);
        }
        match (&self.over, self.portraits.as_slice()) {
            (None, [portrait]) => {
                portrait.put(&mut fields, study);
                let ends: Vec<Json> = portrait.ends.iter().map(|end| Json::from(*end)).collect();
                fields.plain("ends", ends);
            }
            (over, portraits) => {
                let path = over.as_ref().map_or("", |over| over.parameter.as_str());
                fields.plain("parameter", path).plain("unit", study.unit_of(path).unwrap_or("1"));
                let portraits = portraits.iter().map(|portrait| {
                    let mut inner = Fields::in_units(study.units());
                    inner.plain("value", portrait.value);
                    portrait.put(&mut inner, study);
                    inner
                });
                fields.list("portraits", portraits);
            }
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The motion of each start; with a parameter, the shares over the parameter.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let facts = format!("{}; {}", self.starts_in_words(study), self.meaning());
        match (&self.over, self.portraits.as_slice()) {
            (None, [portrait]) => self.dataset_of(study, portrait).fact(facts),
            _ => self.dataset_of_shares(study).fact(facts),
        }
    }

    /// Over the grid, or one row per start.
    fn dataset_of(&self, study: &SystemStudy, portrait: &Portrait) -> Dataset {
        let ends = portrait.ends.iter().map(|end| end.map_or(f64::NAN, |place| place as f64));
        let is_quiet = |place: usize| u8::from(portrait.basins[place].attractor.quiet);
        let quiet: Vec<u8> = portrait.ends.iter().map(|end| end.map_or(2, is_quiet)).collect();
        let mut dataset = Dataset::of(&study.into(), "basins");
        let words = portrait.basins.iter().map(|basin| in_words(&basin.attractor, study.units()));
        for (place, words) in words.enumerate() {
            dataset = dataset.fact(format!("attractor {place}: {words}"));
        }
        let axis = |number: usize, values: Vec<f64>| {
            Array::new(self.names[number].as_str(), self.unit(study, number), values)
        };
        // The last axis runs fastest.
        let dataset = if let Some([across, up]) = self.layout.axes(self.windows) {
            dataset.with_axis(axis(1, up)).with_axis(axis(0, across))
        } else {
            let rows = (0..self.starts.len()).map(|row| row as f64).collect();
            let column = |number: usize| {
                axis(number, self.starts.iter().map(|start| start[number]).collect())
            };
            dataset.with_axis(Array::new("start", "1", rows)).with(column(0)).with(column(1))
        };
        dataset.with(Array::new("attractor", "1", ends.collect())).with(Array::of_words(
            "quiet",
            vec![(0, "no"), (1, "yes"), (2, "unknown")],
            &quiet,
        ))
    }

    fn dataset_of_shares(&self, study: &SystemStudy) -> Dataset {
        let path = self.over.as_ref().map_or("", |over| over.parameter.as_str());
        let of = |value: &dyn Fn(&Portrait) -> f64| -> Vec<f64> {
            self.portraits.iter().map(value).collect()
        };
        let quiet =
            |which: fn(Share) -> f64| of(&|portrait| portrait.quiet.map_or(f64::NAN, which));
        let verdicts: Vec<u8> =
            self.portraits.iter().map(|portrait| verdict_code(&portrait.local)).collect();
        let values = of(&|portrait| portrait.value.unwrap_or(f64::NAN));
        Dataset::of(&study.into(), "basins")
            .with_axis(Array::new(path, study.unit_of(path).unwrap_or("1"), values))
            .with(Array::of_words("local_verdict", VERDICTS.to_vec(), &verdicts))
            .with(Array::new("quiet_fraction", "1", quiet(|share| share.fraction)))
            .with(Array::new("quiet_fraction_low", "1", quiet(|share| share.low)))
            .with(Array::new("quiet_fraction_high", "1", quiet(|share| share.high)))
            .with(Array::new("unknown_fraction", "1", of(&|portrait| portrait.unknown.fraction)))
            .with(Array::new("attractors", "1", of(&|portrait| portrait.basins.len() as f64)))
    }
}
