//! The answer of `thresholds` in sentences: where the base response is stable, and where runs from each start are quenched.

use quell_dynamics::attractor::{Switch, Switches};
use quell_dynamics::orbit::OrbitVerdict;
use quell_model::Dither;
use quell_model::units::Quantity;
use quell_numerics::continuation::criticality::Criticality;

use super::{BranchEnding, Threshold, ThresholdKind, Thresholds, path_in_words, quantity_of};
use crate::run::attractor::unknown;
use crate::run::criticality;
use crate::run::protocol::Protocol;
use crate::run::varied::name_of;
use crate::study::BeltStudy;
use crate::words::{capital, in_words};

/// One end of an interval of the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Limit {
    value: f64,
    /// Its error, if it is to be shown.
    error: Option<f64>,
    /// The kind of threshold; `None` at an end of the range.
    kind: Option<ThresholdKind>,
    /// Whether it is supercritical, where that is decided.
    criticality: Option<Criticality>,
    /// Whether it is an end of the requested range, or of the part that could be answered.
    of_range: bool,
}

/// An interval with the same answer.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Interval<T> {
    from: Limit,
    to: Limit,
    answer: T,
}

impl Limit {
    fn of_range(value: f64) -> Self {
        Self { value, error: None, kind: None, criticality: None, of_range: true }
    }
}

/// Merges neighbouring intervals with the same answer.
fn merged<T: PartialEq>(intervals: Vec<Interval<T>>) -> Vec<Interval<T>> {
    let mut merged: Vec<Interval<T>> = Vec::new();
    for interval in intervals {
        match merged.last_mut() {
            Some(last) if last.answer == interval.answer => last.to = interval.to,
            _ => merged.push(interval),
        }
    }
    merged
}

/// The name of the parameter in sentences, and its values with units.
struct NamedParameter<'a> {
    study: &'a BeltStudy,
    name: String,
    quantity: Quantity,
}

impl<'a> NamedParameter<'a> {
    /// The symbol if it is unambiguous, else the key.
    fn of(study: &'a BeltStudy, path: &str) -> Self {
        let belt = study.belt();
        let one_of_many = path.starts_with("dither") && belt.dithers().len() > 1;
        let symbol = name_of(study, path).map(|(_, symbol)| symbol);
        let name = symbol.filter(|symbol| !one_of_many && !symbol.is_empty());
        let name = name.map_or_else(|| path_in_words(study, path), str::to_owned);
        Self { study, name, quantity: quantity_of(study, path) }
    }

    fn number(&self, limit: Limit) -> String {
        let value = in_words(self.study, self.quantity, limit.value);
        match limit.error {
            Some(error) => {
                format!("{value} ± {}", in_words(self.study, self.quantity, error))
            }
            None => value,
        }
    }

    fn value(&self, limit: Limit) -> String {
        format!("{} = {}", self.name, self.number(limit))
    }

    /// "from D = 1 (fold) to 2 (flip)", "from D = 1 on (fold)", "up to D = 2 (flip)".
    fn interval<T>(&self, interval: &Interval<T>) -> String {
        let Interval { from, to, .. } = *interval;
        let kind = |limit: Limit| {
            let words = limit.criticality.map(criticality::words);
            let clause = words.map_or(String::new(), |words| format!(", {words}"));
            limit.kind.map_or_else(String::new, |kind| format!(" ({}{clause})", kind.name()))
        };
        match (from.of_range, to.of_range) {
            (true, true) => {
                format!("at every {} from {} to {}", self.name, self.number(from), self.number(to))
            }
            (false, true) => format!("from {} on{}", self.value(from), kind(from)),
            (true, false) => format!("up to {}{}", self.value(to), kind(to)),
            (false, false) => {
                let (first, last) = (self.value(from), self.number(to));
                format!("from {first}{} to {last}{}", kind(from), kind(to))
            }
        }
    }

    fn intervals<'b, T: 'b>(&self, list: impl IntoIterator<Item = &'b Interval<T>>) -> String {
        let each: Vec<String> = list.into_iter().map(|interval| self.interval(interval)).collect();
        listed(&each, "and")
    }

    /// The range that all intervals cover: "D from 1 to 2".
    fn whole<T>(&self, intervals: &[Interval<T>]) -> String {
        let ends = intervals.first().zip(intervals.last());
        ends.map_or_else(String::new, |(first, last)| {
            format!("{} from {} to {}", self.name, self.number(first.from), self.number(last.to))
        })
    }
}

impl Thresholds {
    /// Where the base response is stable, and where the dither quenches runs from each start.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let parameter = NamedParameter::of(study, &self.question.parameter);
        let acts = |dither: &Dither| dither.amplitude > 0.0;
        let is_varied = self.question.parameter.starts_with("dither");
        let dithered = is_varied || study.belt().dithers().iter().any(acts);
        let mut sentences = vec![self.of_the_base_response(&parameter, dithered)];
        // Starts with the same answer share a sentence.
        let mut answers: Vec<(Vec<String>, String)> = Vec::new();
        for (protocol, switches) in &self.protocols {
            let answer = self.of_runs(&parameter, switches, dithered);
            let start = start_in_words(study, *protocol);
            match answers.iter_mut().find(|(_, said)| *said == answer) {
                Some((starts, _)) => starts.push(start),
                None => answers.push((vec![start], answer)),
            }
        }
        for (starts, answer) in answers {
            let (starts, ramp) = (listed(&starts, "or"), self.ramp_in_words(study));
            sentences.push(format!("For runs started {starts}{ramp}, {answer}."));
        }
        sentences.join(" ")
    }

    /// The intervals of the base response from the first value until it turns back or ends, and the threshold there.
    fn base_response(&self) -> (Vec<Interval<OrbitVerdict>>, Option<&Threshold>) {
        let Some(first) = self.local.branch.first() else { return (Vec::new(), None) };
        let mut intervals = Vec::new();
        let mut from = Limit::of_range(self.question.from);
        let mut answer = OrbitVerdict::of(first.radius, 0.0);
        for threshold in &self.local.thresholds {
            let Threshold { value, kind, becomes, was, .. } = *threshold;
            let found = threshold.first_lyapunov.map_err(|why| why.to_string());
            let criticality = criticality::decided(&found).ok();
            let limit =
                Limit { value, error: None, kind: Some(kind), criticality, of_range: false };
            intervals.push(Interval { from, to: limit, answer });
            // No response on one side: the branch ends or turns back there.
            let (Some(_), Some(next)) = (was, becomes) else {
                return (merged(intervals), Some(threshold));
            };
            (from, answer) = (limit, next);
        }
        let to = match self.local.ending {
            BranchEnding::Covered => self.question.to,
            BranchEnding::TurnedBack { at }
            | BranchEnding::Touch { at }
            | BranchEnding::Lost { at } => at,
            BranchEnding::LostTurning { furthest, .. } => furthest,
        };
        intervals.push(Interval { from, to: Limit::of_range(to), answer });
        (merged(intervals), None)
    }

    fn of_the_base_response(&self, parameter: &NamedParameter<'_>, dithered: bool) -> String {
        if let Some(why) = &self.no_base {
            let first = parameter.value(Limit::of_range(self.question.from));
            let last = parameter.value(Limit::of_range(self.question.to));
            let again = if self.resumes {
                format!(
                    "; at {last} a base response exists again (begin the range beyond the gap to find its thresholds)"
                )
            } else {
                String::new()
            };
            return format!("At {first} {}{again}.", unknown(why));
        }
        let subject = if dithered { "the base response" } else { "steady sliding" };
        let (intervals, end) = self.base_response();
        let is_stable =
            |interval: &&Interval<OrbitVerdict>| interval.answer == OrbitVerdict::Stable;
        let stable: Vec<&Interval<OrbitVerdict>> = intervals.iter().filter(is_stable).collect();
        let statement = match (stable.len(), intervals.as_slice()) {
            (0, all) => {
                let unstable = all.iter().all(|interval| interval.answer == OrbitVerdict::Unstable);
                let covered = end.is_none() && self.local.ending == BranchEnding::Covered;
                let none = if covered { " (no threshold in this range)" } else { "" };
                if unstable {
                    format!("{subject} is unstable at every {}{none}", parameter.whole(all))
                } else {
                    format!("{subject} is stable at no {}", parameter.whole(all))
                }
            }
            (_, [only]) if only.to.of_range => {
                let covered = self.local.ending == BranchEnding::Covered;
                let none = if covered { " (no threshold in this range)" } else { "" };
                format!("{subject} is stable {}{none}", parameter.interval(only))
            }
            (1, all) => {
                let only = stable[0];
                let interval = parameter.interval(only);
                let statement = format!("{subject} is stable {interval}");
                // Undecided values occur only at thresholds, and are listed in the table.
                let unstable =
                    all.iter().filter(|interval| interval.answer == OrbitVerdict::Unstable).count();
                match (only.from.of_range, only.to.of_range) {
                    _ if unstable + 1 < all.len() || all.len() == 1 => statement,
                    (false, true) => {
                        format!("{statement} and unstable below")
                    }
                    (true, false) => {
                        format!("{statement} and unstable above")
                    }
                    _ => format!("{statement} and unstable outside this interval"),
                }
            }
            _ => format!("{subject} is stable {}", parameter.intervals(stable)),
        };
        let stable_until_then = intervals.last().as_ref().is_some_and(is_stable);
        let ends = self.of_the_end(parameter, end, stable_until_then);
        format!("{}.{ends}", capital(&statement))
    }

    /// Where and why the base response ends within the range.
    fn of_the_end(
        &self,
        parameter: &NamedParameter<'_>,
        end: Option<&Threshold>,
        said_already: bool,
    ) -> String {
        let at = |value: f64| parameter.value(Limit::of_range(value));
        let beyond = if self.resumes {
            let last = at(self.question.to);
            format!(
                "at {last} a base response exists again (begin the range beyond the gap to find its thresholds)"
            )
        } else {
            "beyond, runs end on another response".to_owned()
        };
        match (end, self.local.ending) {
            (Some(end), _) if said_already => {
                let ends = if end.kind == ThresholdKind::Fold { "turns back" } else { "ends" };
                format!(" There it {ends}; {beyond}.")
            }
            (Some(end), _)
                if end.kind == ThresholdKind::Fold
                    || self.local.ending == BranchEnding::Covered =>
            {
                format!(" It turns back at {} ({}); {beyond}.", at(end.value), end.kind.name())
            }
            (Some(end), _) => {
                format!(" It ends at {} ({}); {beyond}.", at(end.value), end.kind.name())
            }
            (None, BranchEnding::Covered) => String::new(),
            (
                None,
                BranchEnding::TurnedBack { at: value }
                | BranchEnding::LostTurning { furthest: value, .. },
            ) => {
                format!(" It turns back at {}; {beyond}.", at(value))
            }
            (None, BranchEnding::Touch { at: value }) => {
                format!(" It ends at {}, where it grazes v_r = 0; {beyond}.", at(value))
            }
            (None, BranchEnding::Lost { at: value }) => {
                let then =
                    if self.resumes { beyond.as_str() } else { "the rest of the range is unknown" };
                format!(" It could not be continued beyond {}; {then}.", at(value))
            }
        }
    }

    fn ramp_in_words(&self, study: &BeltStudy) -> String {
        if self.question.ramp > 0.0 {
            let time = in_words(study, Quantity::Time, self.question.ramp);
            format!(" with the dither ramped up over {time}")
        } else {
            String::new()
        }
    }

    /// The intervals in which runs from a start are quenched.
    fn of_runs(
        &self,
        parameter: &NamedParameter<'_>,
        switches: &Switches,
        dithered: bool,
    ) -> String {
        let intervals = runs(self.question.from, self.question.to, switches);
        let of = |wanted: Option<bool>| -> Vec<&Interval<Option<bool>>> {
            intervals.iter().filter(|interval| interval.answer == wanted).collect()
        };
        let verb = match (dithered, self.in_band) {
            (false, _) => "the run ends in steady sliding",
            (true, true) => "the run falls into step with the dither",
            (true, false) => "the dither quenches",
        };
        let quenched = of(Some(true));
        let answer = if quenched.is_empty() {
            format!("{verb} at no {}", parameter.whole(&intervals))
        } else {
            format!("{verb} {}", parameter.intervals(quenched))
        };
        let open = of(None);
        if open.is_empty() {
            return answer;
        }
        format!("{answer}; the outcome is unknown {}", parameter.intervals(open))
    }
}

/// A start as text that follows "started".
fn start_in_words(study: &BeltStudy, protocol: Protocol) -> String {
    match protocol {
        Protocol::Rest => "from rest".to_owned(),
        Protocol::Sliding => "from steady sliding".to_owned(),
        Protocol::Squeal => "in full squeal".to_owned(),
        Protocol::From(displacement, velocity) => format!(
            "at x = {}, x′ = {}",
            in_words(study, Quantity::Displacement, displacement),
            in_words(study, Quantity::Velocity, velocity)
        ),
    }
}

/// "a", "a and b", "a, b and c".
fn listed(each: &[String], and: &str) -> String {
    match each.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, before)) => format!("{} {and} {last}", before.join(", ")),
        None => String::new(),
    }
}

/// The intervals in which runs have the same outcome.
fn runs(from: f64, to: f64, switches: &Switches) -> Vec<Interval<Option<bool>>> {
    let limit = |switch: &Switch| Limit {
        value: switch.value,
        error: (!switch.is_close()).then_some(switch.error),
        kind: None,
        criticality: None,
        of_range: false,
    };
    let begins = std::iter::once((Limit::of_range(from), switches.first))
        .chain(switches.changes.iter().map(|switch| (limit(switch), switch.becomes)));
    let ends = switches.changes.iter().map(limit).chain(std::iter::once(Limit::of_range(to)));
    let each = begins.zip(ends).map(|((from, reached), to)| {
        let answer = reached.is_quiet();
        Interval { from, to, answer }
    });
    merged(each.collect())
}
