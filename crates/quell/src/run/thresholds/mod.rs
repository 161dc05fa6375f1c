//! `thresholds`: values of a parameter at which the response changes: local thresholds by Floquet multipliers, and for runs
//! from given starts the values at which dither starts or stops quenching. `answer` puts them into sentences.

use quell_dynamics::attractor::{
    AttractorSettings, Reached, SWITCH_CLOSENESS, StroboscopicSection, Switches, ramped, switches,
};
use quell_dynamics::orbit::NoOrbit;
use quell_dynamics::orbit::family::BeltAt;
pub use quell_dynamics::orbit::family::Signature;
pub use quell_dynamics::orbit::threshold::{
    BranchEnding, Local, SignatureChange, Threshold, ThresholdKind,
};
use quell_dynamics::orbit::threshold::{NoThresholds, local};
use quell_dynamics::response::BAND_END;
use quell_dynamics::simulation::{Start, within};
use quell_dynamics::start::NoSquealingStart;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::attractor::{self, unknown};
use super::criticality;
use super::protocol::Protocol;
use super::varied::{Named, ascending, key_of};
use crate::complaint::{Complaint, Complaints, Failure, Fault, Origin};
use crate::contact_state::refused_of_belt;
use crate::document::given_number;
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::fields::Fields;
use crate::quantity::bearable;
use crate::quantity::unit_of;
use crate::range::SlipMet;
use crate::study::{BeltStudy, InitialState};
use crate::words::{digits, in_words, plural};

mod answer;

/// Minimum number of continuation steps over the range.
const STEPS: u32 = 40;

/// Equal steps between the values tried for a start; two changes between neighbouring values that cancel are missed.
pub const TRIED: u32 = 40;

/// Options of `thresholds`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ThresholdsRequest {
    /// Path of the parameter; an SI key is allowed in a study in SI.
    pub parameter: String,
    /// First value, in the unit of that key.
    pub from: f64,
    /// Last value, above the first.
    pub to: f64,
    /// Protocols to run in addition to the local thresholds.
    pub protocols: Vec<Protocol>,
    /// Time τ over which the dither of a protocol is ramped up from zero, in steps of its period; 0 switches it on at once.
    pub ramp: f64,
}

/// The thresholds of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Thresholds {
    /// The request, in numbers of the equations.
    pub question: ThresholdsRequest,
    /// The parameter as it was asked for.
    pub asked: Named,
    /// Thresholds by multipliers, with the branch of responses that contains them.
    pub local: Local,
    /// Why no base response exists at the first value, if only runs are judged.
    pub no_base: Option<NoOrbit>,
    /// Whether a base response exists at the last value although the branch ends before it.
    pub resumes: bool,
    /// Thresholds by runs from each start.
    pub protocols: Vec<(Protocol, Switches)>,
    /// The slip reached by the responses at both ends and at the thresholds, and by the runs at their beginning.
    pub slip: SlipMet,
    /// Whether responses of the dither's own period may vibrate in the band of slow vibration (R ≤ 1.9), somewhere in the range.
    pub in_band: bool,
}

/// The key of a number of the equations, in SI if the study is in SI.
pub fn path_in_words(study: &BeltStudy, path: &str) -> String {
    key_of(study, path)
}

/// A value of a number of the equations, in SI if the study is in SI.
pub fn value_in_words(study: &BeltStudy, path: &str, value: f64) -> String {
    if study.scales().is_none() {
        return value.to_string();
    }
    match quantity_of(study, path) {
        // The path names ζ for any key that the study uses.
        Quantity::DampingRatio => digits(value),
        quantity => in_words(study, quantity, value),
    }
}

/// The quantity of a number of the equations.
pub fn quantity_of(study: &BeltStudy, path: &str) -> Quantity {
    study.address(path).ok().and_then(|address| address.quantity).unwrap_or(Quantity::Ratio)
}

/// The failure that reports why there are no thresholds.
pub(super) fn refused(
    study: &BeltStudy,
    why: NoThresholds,
    path: &str,
    option: &'static str,
) -> Failure {
    let key = path_in_words(study, path);
    let words = |value: f64| value_in_words(study, path, value);
    match why {
        NoThresholds::Invalid { value } => {
            Complaint::option(option, words(value), format!("a value that {key} can take")).into()
        }
        NoThresholds::Start(why) if why.is_absence() || is_lost(why) => Failure::Failed {
            key: "thresholds".to_owned(),
            why: format!(
                "{} at the first value: begin where a base response exists, or request runs (--from-rest, --from-squeal, …)",
                unknown(&why)
            ),
        },
        NoThresholds::Start(why) => attractor::refused(why),
        NoThresholds::Lost { at } => Failure::Failed {
            key: "thresholds".to_owned(),
            why: format!("the continuation lost the response beyond {key} = {}", words(at)),
        },
    }
}

/// The request in numbers of the equations.
///
/// # Errors
/// Every complaint about it at once.
fn understood(
    study: &BeltStudy,
    question: ThresholdsRequest,
) -> Result<(Named, ThresholdsRequest), Failure> {
    let ThresholdsRequest { from, to, ramp, .. } = question;
    let named = Named::new(study, "--parameter", &question.parameter)?;
    let ends = [("--from", from), ("--to", to)];
    let mut wrong: Vec<Complaint> =
        ends.into_iter().flat_map(|end| named.unable(study, end)).collect();
    wrong.extend(ascending(from, to).err().map(|complaint| *complaint));
    wrong.extend(named.without_effect(study, "--parameter", (from, to)).filter(|_| from < to));
    wrong.extend(can_ramp(ramp, question.protocols.is_empty()).err().into_iter().flatten());
    if !wrong.is_empty() {
        return Err(wrong.into());
    }
    slides(study, &named, from)?;
    let (from, to) = (named.of(from), named.of(to));
    let parameter = named.path.clone();
    Ok((named, ThresholdsRequest { parameter, from, to, ..question }))
}

/// Rejects a time over which a dither cannot be ramped up, or that belongs to no run.
pub(in crate::run) fn can_ramp(ramp: f64, without_runs: bool) -> Result<(), Complaints> {
    let mut wrong: Vec<Complaint> = Vec::new();
    wrong.extend(bearable(ramp, given_number(ramp), "--ramp").err().map(|complaint| *complaint));
    if ramp > 0.0 && without_runs {
        let allowed = "requires --from-rest, --from-sliding, --from-squeal or --start: it ramps up the dither of those runs";
        let origin = Origin::Argument("--ramp");
        wrong.push(Complaint::new(Fault::Conflict, "--ramp", origin, ramp, allowed));
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// Rejects a first value at which the belt is at rest: no steady sliding exists to continue from.
fn slides(study: &BeltStudy, named: &Named, from: f64) -> Result<(), Box<Complaint>> {
    let belt = study.belt();
    let at_rest = |belt: &quell_model::Belt| belt.belt_velocity() == 0.0;
    if !named.belt_at(study, named.of(from)).is_some_and(|first| at_rest(&first)) {
        return Ok(());
    }
    let why = "thresholds are computed for the response continued from steady sliding, which a belt at rest does not have; \
               `orbit`, `response` and `bifurcation` start from rest";
    let allowed = format!("such that the belt moves: {why}");
    Err(Box::new(if at_rest(belt) {
        let allowed = format!("above 0: {why}");
        Complaint::new(Fault::Value, "belt.belt_velocity", Origin::Whole, 0.0, allowed)
    } else {
        Complaint::option("--from", given_number(from), allowed)
    }))
}

/// Thresholds of a study's belt.
///
/// # Errors
/// A complaint about the parameter or its range; [`Failure::Failed`] if no response exists at the beginning.
pub fn run(study: &BeltStudy, question: ThresholdsRequest) -> Result<Thresholds, Failure> {
    refused_of_belt(study, "thresholds")?;
    within(STEPS_OF_MANY_SEARCHES, || found(study, question))
}

fn found(study: &BeltStudy, question: ThresholdsRequest) -> Result<Thresholds, Failure> {
    let (asked, question) = understood(study, question)?;
    let path = question.parameter.as_str();
    let (from, to) = (question.from, question.to);
    let at = |values: &[f64]| asked.belt_at(study, values[0]);
    let (local, no_base) = match local(&at, from, to, STEPS) {
        Ok(local) => (local, None),
        // Runs have an outcome even without a base response.
        Err(NoThresholds::Start(why))
            if !question.protocols.is_empty() && (why.is_absence() || is_lost(why)) =>
        {
            (Local::nowhere(from), Some(why))
        }
        Err(why) => return Err(refused(study, why, path, "--from")),
    };
    let last = at(&[to]);
    let resumes = local.ending != BranchEnding::Covered
        && last.is_some_and(|belt| {
            AttractorSettings::new(&belt).is_ok_and(|settings| settings.base.is_ok())
        });
    let mut protocols = Vec::new();
    for &protocol in &question.protocols {
        let initial = protocol.initial();
        let start = |belt: &quell_model::Belt| -> Result<Option<Start>, NoOrbit> {
            let start = match initial.resolve(belt) {
                Ok(start) => start,
                Err(NoSquealingStart::SettlesToSliding | NoSquealingStart::BeltAtRest) => {
                    return Ok(None);
                }
                Err(NoSquealingStart::Stalled(why)) => return Err(NoOrbit::Stalled(why)),
            };
            // Without dither there is nothing to ramp up.
            match ramped(belt, start, question.ramp) {
                Err(NoOrbit::NoDither) => Ok(Some(start)),
                ramped => ramped.map(Some),
            }
        };
        let found = switches(&at, (from, to), TRIED, SWITCH_CLOSENESS, start)
            .map_err(|why| refused(study, why, path, "--from"))?;
        protocols.push((protocol, found));
    }
    let slip = slip_met(&at, &question, &local, &protocols);
    let reaches = |value: f64| {
        at(&[value])
            .and_then(|belt| StroboscopicSection::of(&belt).ok())
            .is_some_and(|section| section.reaches_the_band())
    };
    let in_band = reaches(from) || reaches(to);
    Ok(Thresholds { question, asked, local, no_base, resumes, protocols, slip, in_band })
}

/// Whether the continuation lost the base response, as opposed to its not existing.
fn is_lost(why: NoOrbit) -> bool {
    matches!(why, NoOrbit::LostOnTheWay { .. })
}

/// The slip reached by the responses at the thresholds, by steady sliding at both ends, and by the runs of protocols there and
/// at their switches.
fn slip_met(
    at: BeltAt<'_>,
    question: &ThresholdsRequest,
    local: &Local,
    protocols: &[(Protocol, Switches)],
) -> SlipMet {
    let mut slip = SlipMet::default();
    let at = |value: f64| at(&[value]);
    for threshold in &local.thresholds {
        if let Some(belt) = at(threshold.value) {
            slip.add_attractor(&belt, threshold.state);
        }
    }
    let ends = [question.from, question.to];
    for belt in ends.into_iter().filter_map(at) {
        let sliding = InitialState::Sliding.resolve(&belt);
        if let Ok(sliding) = sliding {
            slip.add_start(&belt, sliding);
        }
    }
    for (protocol, switches) in protocols {
        let values = ends.into_iter().chain(switches.changes.iter().map(|change| change.value));
        for belt in values.filter_map(at) {
            if let Ok(start) = protocol.initial().resolve(&belt) {
                slip.add_attractor(&belt, start);
            }
        }
    }
    slip
}

/// The outcome of runs beyond a switch. A dither in the band of the vibration itself cannot quench it: runs fall into step with
/// the dither or not.
pub fn becomes(reached: Reached, in_band: bool) -> &'static str {
    match (reached, in_band) {
        (Reached::Base | Reached::Forced, false) => "quenched",
        (Reached::Base | Reached::Forced, true) => "in step with the dither",
        (Reached::Elsewhere, false) => "not quenched",
        (Reached::Elsewhere, true) => "not in step with the dither",
        (Reached::Unsettled, _) => "unsettled",
        (Reached::Unknown, _) => "unknown",
    }
}

/// The verdict on one side of a threshold; "none" if this response does not exist there.
pub fn side(verdict: Option<quell_dynamics::orbit::OrbitVerdict>) -> &'static str {
    verdict.map_or("none", quell_dynamics::orbit::OrbitVerdict::name)
}

impl Thresholds {
    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let question = &self.question;
        let quantity = quantity_of(study, &question.parameter);
        let object = || Fields::new(study.scales());
        let asked = &self.asked;
        let local = self.local.thresholds.iter().map(|threshold| {
            let mut inner = object();
            asked.put(&mut inner, "value", threshold.value);
            asked.put(&mut inner, "error", threshold.error);
            inner
                .plain("kind", threshold.kind.name())
                .plain("was", side(threshold.was))
                .plain("becomes", side(threshold.becomes))
                .number("displacement", Quantity::Displacement, threshold.state.displacement)
                .number("velocity", Quantity::Velocity, threshold.state.velocity);
            let length = unit_of(Quantity::Displacement, study.scales());
            let found = threshold.first_lyapunov.map_err(|why| why.to_string());
            criticality::put(&mut inner, &length, &found);
            let unit = unit_of(quantity, study.scales());
            criticality::put_fold(&mut inner, [&unit, &length], &threshold.fold);
            inner
        });
        let words = |signature: Option<&Signature>| {
            signature.map_or_else(|| "none".to_owned(), Signature::words)
        };
        let changes = self.local.changes.iter().map(|change| {
            let mut inner = object();
            asked.put(&mut inner, "value", change.value);
            inner
                .plain("below", words(change.below.as_ref()))
                .plain("above", words(change.above.as_ref()));
            inner
        });
        let mut fields = object();
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("parameter", asked.key());
        asked.put(&mut fields, "from", question.from);
        asked.put(&mut fields, "to", question.to);
        fields
            .plain("covered", self.local.ending == BranchEnding::Covered)
            .plain("resumes", self.resumes)
            .list("local", local)
            .list("signature_changes", changes);
        if question.ramp > 0.0 {
            fields.number("ramp", Quantity::Time, question.ramp);
        }
        let mut first = object();
        for (protocol, switches) in &self.protocols {
            first.plain(protocol.name(), becomes(switches.first, self.in_band));
            let switches = switches.changes.iter().map(|switch| {
                let mut inner = object();
                asked.put(&mut inner, "value", switch.value);
                asked.put(&mut inner, "error", switch.error);
                inner.plain("becomes", becomes(switch.becomes, self.in_band));
                inner
            });
            fields.list(protocol.name(), switches);
        }
        if !self.protocols.is_empty() {
            fields.nested("at_from", first).plain("values_tried", TRIED + 1);
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Warnings, among them values at which the outcome of runs is unknown.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let path = self.asked.key();
        let warning = |(protocol, switches): &(Protocol, Switches)| {
            let (value, why) = switches.unknown.first()?;
            let value = self.asked.words(study, *value);
            let runs = protocol.name().replace('_', " ");
            let count = switches.unknown.len();
            let others = if count > 1 {
                format!("; it is also unknown at {} more value{}", count - 1, plural(count - 1))
            } else {
                String::new()
            };
            Some(format!(
                "the outcome of the run {runs} at {path} = {value} is unknown: {why}{others}"
            ))
        };
        let in_band = (self.in_band && !self.protocols.is_empty()).then(|| {
            format!(
                "the dither acts at or below {BAND_END} ω₀, in the band of the vibration itself: a run in step with it \
                 still vibrates; `response` gives the remaining amplitude"
            )
        });
        self.slip
            .warnings(study)
            .into_iter()
            .chain(in_band)
            .chain(self.protocols.iter().filter_map(warning))
            .collect()
    }
}
