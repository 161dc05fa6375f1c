//! The answer of `thresholds` in sentences: where the base response is stable, and where runs from each start end quiet.

use quell_dynamics::attractor::{RunSwitch, RunSwitches};
use quell_dynamics::orbit::{
    BranchEnding, BranchThresholds, NoOrbit, OrbitVerdict, ResponseGap, Threshold, ThresholdKind,
};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use super::Thresholds;
use super::curves::kind_in_words;
use crate::run::criticality::{self, NoLyapunovCoefficient};
use crate::run::system::in_units;
use crate::study::SystemStudy;
use crate::words::{capital, quantity_at, quantity_is};

/// Half the width of an interval, relative to its value, up to which a change of a run is a single value in a sentence. Wider ones,
/// where halving was stopped, are reported with their error.
const NARROW: f64 = 1e-4;

/// One end of an interval of the parameter.
#[derive(Clone, Debug, PartialEq)]
struct Limit {
    value: f64,
    /// Its error, if it is to be shown.
    error: Option<f64>,
    /// The kind of threshold in words; `None` at an end of the range.
    kind: Option<String>,
    /// Whether it is an end of the requested range, or of the part that could be answered.
    of_range: bool,
}

/// An interval with the same answer.
#[derive(Clone, Debug, PartialEq)]
struct Interval<T> {
    from: Limit,
    to: Limit,
    answer: T,
}

impl Limit {
    fn of_range(value: f64) -> Self {
        Self { value, error: None, kind: None, of_range: true }
    }

    fn of_gap(value: f64) -> Self {
        Self { of_range: false, ..Self::of_range(value) }
    }

    fn of_switch(switch: &RunSwitch) -> Self {
        let is_close = switch.error <= NARROW * switch.value.abs();
        let error = (!is_close).then_some(switch.error);
        let kind = switch.kind.map(|kind| kind.name().to_owned());
        Self { value: switch.value, error, kind, of_range: false }
    }
}

/// Merges intervals with the same answer that meet.
fn merged<T: PartialEq>(intervals: Vec<Interval<T>>) -> Vec<Interval<T>> {
    let mut merged: Vec<Interval<T>> = Vec::new();
    for interval in intervals {
        match merged.last_mut() {
            Some(last)
                if last.answer == interval.answer && last.to.value == interval.from.value =>
            {
                last.to = interval.to;
            }
            _ => merged.push(interval),
        }
    }
    merged
}

/// The parameter in sentences, and its values with units.
struct NamedParameter<'a> {
    done: &'a Thresholds,
    study: &'a SystemStudy,
}

impl NamedParameter<'_> {
    fn name(&self) -> String {
        quantity_at(&self.done.request.parameter)
    }

    fn number(&self, limit: &Limit) -> String {
        let value = self.done.value(self.study, limit.value);
        match limit.error {
            Some(error) => format!("{value} ± {}", self.done.value(self.study, error)),
            None => value,
        }
    }

    fn value(&self, limit: &Limit) -> String {
        format!("the {}", quantity_is(&self.done.request.parameter, &self.number(limit)))
    }

    fn at(&self, value: f64) -> String {
        self.value(&Limit::of_range(value))
    }

    /// "from the load 1 (fold) to 2 (flip)", "from the load 1 on (fold)", "up to the load 2 (flip)".
    fn interval<T>(&self, interval: &Interval<T>) -> String {
        self.interval_of(interval, |limit| self.value(limit))
    }

    /// [`Self::interval`] with a first value in these words.
    fn interval_of<T>(&self, interval: &Interval<T>, value: impl Fn(&Limit) -> String) -> String {
        let Interval { from, to, .. } = interval;
        let kind = |limit: &Limit| {
            limit.kind.as_ref().map_or_else(String::new, |kind| format!(" ({kind})"))
        };
        match (from.of_range, to.of_range) {
            (true, true) => {
                format!(
                    "at every {} from {} to {}",
                    self.name(),
                    self.number(from),
                    self.number(to)
                )
            }
            (false, true) => format!("from {} on{}", value(from), kind(from)),
            (true, false) => format!("up to {}{}", value(to), kind(to)),
            (false, false) => {
                let (first, last) = (value(from), self.number(to));
                format!("from {first}{} to {last}{}", kind(from), kind(to))
            }
        }
    }

    fn intervals<'b, T: 'b>(&self, list: impl IntoIterator<Item = &'b Interval<T>>) -> String {
        // The parameter is named once.
        let each = list.into_iter().enumerate().map(|(place, interval)| match place {
            0 => self.interval(interval),
            _ => self.interval_of(interval, |limit| self.number(limit)),
        });
        listed(&each.collect::<Vec<_>>(), "and")
    }

    /// The range that all intervals cover: "load from 1 to 2".
    fn whole<T>(&self, intervals: &[Interval<T>]) -> String {
        let ends = intervals.first().zip(intervals.last());
        ends.map_or_else(String::new, |(first, last)| {
            let (from, to) = (self.number(&first.from), self.number(&last.to));
            format!("{} from {from} to {to}", self.name())
        })
    }
}

impl Thresholds {
    /// The name of the response that is followed.
    pub fn subject(&self) -> &'static str {
        match (self.request.near.is_some(), self.dithered) {
            (true, _) => "the periodic motion",
            (false, true) => "the base response",
            (false, false) => "steady sliding",
        }
    }

    /// Where the response is stable, and where runs from each start end quiet.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let parameter = NamedParameter { done: self, study };
        let first = match &self.local {
            Ok(local) => self.of_the_response(&parameter, local),
            Err(why) => self.without_response(&parameter, why),
        };
        let mut sentences = vec![first];
        // Starts with the same answer share a sentence.
        let mut answers: Vec<(Vec<String>, String)> = Vec::new();
        for ((protocol, switches), quiet_without) in self.runs.iter().zip(&self.quiet_without) {
            let answer = self.of_runs(&parameter, switches, *quiet_without);
            let start = protocol.words(study);
            match answers.iter_mut().find(|(_, said)| *said == answer) {
                Some((starts, _)) => starts.push(start),
                None => answers.push((vec![start], answer)),
            }
        }
        let ramp = self.ramp_in_words(study);
        let answers = answers
            .into_iter()
            .map(|(starts, answer)| format!("for runs {}{ramp}, {answer}", listed(&starts, "or")));
        let answers: Vec<String> = answers.collect();
        if !answers.is_empty() {
            sentences.push(format!("{}.", capital(&answers.join("; "))));
        }
        sentences.join(" ")
    }

    /// Where and why the response ends within the range.
    pub fn notes(&self, study: &SystemStudy) -> Vec<String> {
        let parameter = NamedParameter { done: self, study };
        let Ok(local) = &self.local else { return Vec::new() };
        let (intervals, end) = self.verdicts(study, local);
        let until_then = intervals.last().is_some_and(|last| last.answer == OrbitVerdict::Stable);
        self.of_the_end(&parameter, (end, local.ending), until_then).into_iter().collect()
    }

    fn without_response(&self, parameter: &NamedParameter<'_>, why: &NoOrbit) -> String {
        let first = parameter.at(self.request.window.lower);
        let again = self.again(parameter).map_or(String::new(), |again| format!("; {again}"));
        format!("At {first} {} was not found: {why}{again}.", self.subject())
    }

    fn again(&self, parameter: &NamedParameter<'_>) -> Option<String> {
        let last = parameter.at(self.request.window.upper);
        self.resumes.then(|| {
            format!(
                "at {last} a base response exists again (begin the range beyond the gap to find its thresholds)"
            )
        })
    }

    /// The intervals of the response from the first value until it turns back or ends, and the threshold there.
    fn verdicts<'l>(
        &self,
        study: &SystemStudy,
        local: &'l BranchThresholds,
    ) -> (Vec<Interval<OrbitVerdict>>, Option<&'l Threshold>) {
        let Some(first) = local.branch.first() else { return (Vec::new(), None) };
        let path = &self.request.parameter;
        let mut intervals = Vec::new();
        let mut from = Limit::of_range(self.request.window.lower);
        let mut answer = OrbitVerdict::of(first.radius, 0.0);
        let mut gaps = local.gaps.iter().peekable();
        for threshold in &local.thresholds {
            // Gaps on whose sides the response has one verdict.
            while let Some(gap) = gaps.next_if(|gap| gap.grazing < threshold.value) {
                let [low, high] = gap.ends().map(Limit::of_gap);
                intervals.push(Interval { from, to: low, answer });
                from = high;
            }
            let gap = gaps.next_if(|gap| gap.grazing == threshold.value);
            let criticality = threshold.first_lyapunov.map_err(NoLyapunovCoefficient::from);
            let kind = kind_in_words(study, threshold.kind, &threshold.contacts)
                + &criticality::clause(&criticality, ", ", "")
                + &criticality::opening_clause(&threshold.fold, ", ", &quantity_at(path));
            let [to, next] = gap.map_or([threshold.value; 2], ResponseGap::ends);
            let limit = |value| Limit { value, kind: Some(kind.clone()), ..Limit::of_gap(value) };
            intervals.push(Interval { from, to: limit(to), answer });
            let limit = limit(next);
            // No response on one side: the branch ends or turns back there.
            let (Some(_), Some(next)) = (threshold.was, threshold.becomes) else {
                return (merged(intervals), Some(threshold));
            };
            (from, answer) = (limit, next);
        }
        for gap in gaps {
            let [low, high] = gap.ends().map(Limit::of_gap);
            intervals.push(Interval { from, to: low, answer });
            from = high;
        }
        let to = super::answer::end_of(local.ending).unwrap_or(self.request.window.upper);
        intervals.push(Interval { from, to: Limit::of_range(to), answer });
        (merged(intervals), None)
    }

    fn of_the_response(&self, parameter: &NamedParameter<'_>, local: &BranchThresholds) -> String {
        let subject = self.subject();
        let (intervals, end) = self.verdicts(parameter.study, local);
        let is_stable =
            |interval: &&Interval<OrbitVerdict>| interval.answer == OrbitVerdict::Stable;
        let stable: Vec<&Interval<OrbitVerdict>> = intervals.iter().filter(is_stable).collect();
        let covered =
            end.is_none() && local.ending == BranchEnding::Covered && local.gaps.is_empty();
        let none = if covered && local.thresholds.is_empty() {
            " (no threshold in this range)"
        } else {
            ""
        };
        let statement = match (stable.as_slice(), intervals.as_slice()) {
            ([], all) => {
                let unstable = all.iter().all(|interval| interval.answer == OrbitVerdict::Unstable);
                let whole = parameter.whole(all);
                if unstable {
                    format!("{subject} is unstable at every {whole}{none}")
                } else {
                    format!("{subject} is stable at no {whole}")
                }
            }
            ([only], all) => {
                // Up to where, or from where, the response is unstable next to it, beyond a gap.
                let place = all.iter().position(|interval| interval == *only).unwrap_or(0);
                let before = place.checked_sub(1).map(|before| &all[before].to);
                let after = all.get(place + 1).map(|after| &after.from);
                let statement = format!("{subject} is stable {}", parameter.interval(only));
                // Undecided values occur only at thresholds, and are listed in the table.
                let unstable =
                    all.iter().filter(|interval| interval.answer == OrbitVerdict::Unstable).count();
                match (only.from.of_range, only.to.of_range) {
                    _ if unstable + 1 < all.len() || all.len() == 1 => format!("{statement}{none}"),
                    (false, true) => match before.filter(|limit| limit.value < only.from.value) {
                        Some(to) => {
                            format!("{statement} and unstable up to {}", parameter.number(to))
                        }
                        None => format!("{statement} and unstable below"),
                    },
                    (true, false) => match after.filter(|limit| limit.value > only.to.value) {
                        Some(from) => {
                            format!("{statement} and unstable from {} on", parameter.number(from))
                        }
                        None => format!("{statement} and unstable above"),
                    },
                    _ => format!("{statement} and unstable outside this interval"),
                }
            }
            (several, _) => {
                format!("{subject} is stable {}", parameter.intervals(several.iter().copied()))
            }
        };
        format!("{}.", capital(&statement))
    }

    /// Where and why the response ends within the range.
    fn of_the_end(
        &self,
        parameter: &NamedParameter<'_>,
        (end, ending): (Option<&Threshold>, BranchEnding),
        said_already: bool,
    ) -> Option<String> {
        let at = |value: f64| parameter.at(value);
        let beyond = self
            .again(parameter)
            .unwrap_or_else(|| "beyond, runs end on another motion".to_owned());
        Some(match (end, ending) {
            (None, BranchEnding::Covered) => return None,
            (Some(end), _) if said_already => {
                let ends = if end.kind == ThresholdKind::Fold { "turns back" } else { "ends" };
                format!("There the response {ends}; {beyond}.")
            }
            (Some(end), ending)
                if end.kind == ThresholdKind::Fold || ending == BranchEnding::Covered =>
            {
                format!(
                    "The response turns back at {} ({}); {beyond}.",
                    at(end.value),
                    end.kind.name()
                )
            }
            (Some(end), _) => {
                format!("The response ends at {} ({}); {beyond}.", at(end.value), end.kind.name())
            }
            (
                None,
                BranchEnding::TurnedBack { at: value }
                | BranchEnding::LostTurning { furthest: value, .. },
            ) => {
                format!("The response turns back at {}; {beyond}.", at(value))
            }
            (None, BranchEnding::Touch { at: value }) => {
                format!("The response ends at {}, where it grazes v_r = 0; {beyond}.", at(value))
            }
            (None, BranchEnding::Lost { at: value }) => {
                let then =
                    if self.resumes { beyond.as_str() } else { "the rest of the range is unknown" };
                format!("The response could not be followed beyond {}; {then}.", at(value))
            }
        })
    }

    fn ramp_in_words(&self, study: &SystemStudy) -> String {
        match self.request.ramp {
            0.0 => String::new(),
            ramp => {
                let time = in_units(study.units(), Quantity::Time, ramp);
                format!(" with the dither ramped up over {time}")
            }
        }
    }

    /// The intervals in which runs from a start end quiet.
    fn of_runs(
        &self,
        parameter: &NamedParameter<'_>,
        switches: &RunSwitches,
        quiet_without: bool,
    ) -> String {
        let intervals = runs(self.request.window, switches);
        let verb = match (self.dithered, self.in_band) {
            (false, _) => "the run comes to rest or to steady sliding",
            (true, true) => "the run falls into step with the dither",
            (true, false) if quiet_without => {
                "which end quiet without dither, the motion stays quiet"
            }
            (true, false) => "the dither quenches",
        };
        let quenched = intervals.iter().filter(|interval| interval.answer == Some(true));
        let quenched: Vec<&Interval<Option<bool>>> = quenched.collect();
        let answer = if quenched.is_empty() {
            format!("{verb} at no {}", parameter.whole(&intervals))
        } else {
            format!("{verb} {}", parameter.intervals(quenched))
        };
        match switches.unknown.as_slice() {
            [] => answer,
            [(value, _)] => format!("{answer}; the outcome is unknown at {}", parameter.at(*value)),
            several => {
                format!("{answer}; the outcome is unknown at {} values tried", several.len())
            }
        }
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
fn runs(
    RealInterval { lower: from, upper: to }: RealInterval,
    switches: &RunSwitches,
) -> Vec<Interval<Option<bool>>> {
    let first = (Limit::of_range(from), switches.first.is_quiet());
    let changes = switches.changes.iter();
    let changed =
        changes.clone().map(|change| (Limit::of_switch(change), change.becomes.is_quiet()));
    let ends = changes.map(Limit::of_switch).chain([Limit::of_range(to)]);
    let each = std::iter::once(first).chain(changed).zip(ends);
    merged(each.map(|((from, answer), to)| Interval { from, to, answer }).collect())
}
