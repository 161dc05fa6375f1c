//! The answer of `design`: sentence, warnings and JSON.

use std::fmt::Write as _;

use quell_design::least_dither::{
    DesignObjective, DesignPoint, DesignStart, Designed, FeasibleDesign, InfeasibleDesign,
    LimitedQuantity, NoDesign, ResponseSize,
};
use quell_model::Waveform;
use quell_model::parameter::design::LIMITS;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::found::{DesignedDither, LeastDitherFound};
use super::slow::OF_SLOW;
use super::study_with_design::StudyWithDesign;
use crate::contact_state::averages_are_a_start;
use crate::fields::Fields;
use crate::run::waveforms::label;
use crate::words::{counted, digits, listed, more_digits, quantity_at};

/// A limit binds if at least this share of it is used.
const BINDS: f64 = 0.9999;

/// Quiet amplitudes up to this multiple of the least one are a narrow range, of which a user is warned.
const NARROW: f64 = 1.5;

/// A ratio to a limit in words, with as many digits as show that it is not 1.
fn times_in_words(used: f64) -> String {
    let short = digits(used);
    if short == "1" { format!("{used} times") } else { format!("{short} times") }
}

/// A limited quantity in words.
pub(super) fn limit_in_words(quantity: LimitedQuantity) -> String {
    quantity_at(quantity.name())
}

/// The quantity of an objective.
pub fn quantity_of(study: &dyn StudyWithDesign, objective: DesignObjective) -> Quantity {
    match objective {
        DesignObjective::Amplitude => study.quantity_of_amplitude(),
        DesignObjective::Stroke => Quantity::Displacement,
        DesignObjective::Velocity => Quantity::Velocity,
        DesignObjective::Power => Quantity::Power,
        DesignObjective::FrictionLoss => Quantity::Ratio,
    }
}

/// The quantity of a limit.
pub(super) fn quantity_of_limit(study: &dyn StudyWithDesign, limited: LimitedQuantity) -> Quantity {
    if limited == LimitedQuantity::Amplitude {
        return study.quantity_of_amplitude();
    }
    let parameter = LIMITS.iter().find(|parameter| parameter.key() == limited.name());
    parameter.map_or(Quantity::Ratio, |parameter| parameter.quantity)
}

impl LeastDitherFound {
    /// The dither of the answer.
    pub fn dither(&self) -> &DesignedDither {
        &self.tried[self.best]
    }

    /// Its waveform.
    pub fn waveform(&self) -> &Waveform {
        &self.dither().waveform
    }

    /// The answer of that dither.
    pub fn answer(&self) -> &Designed {
        &self.dither().designed
    }

    /// The other design variables of the answer, or of the dither that reaches furthest.
    pub fn chosen(&self) -> Option<Vec<f64>> {
        match &self.answer().answer {
            Ok(found) => Some(found.critical.others.clone()),
            Err(_) => self.covered.as_ref().ok().map(|part| part.others.clone()),
        }
    }

    /// A dither of the waveform of the answer by the paths of the study.
    pub(super) fn by_path(&self, amplitude: f64, others: &[f64]) -> Json {
        self.with_waveform_by_path(self.waveform(), amplitude, others)
    }

    /// A dither by the paths of the study.
    fn with_waveform_by_path(&self, waveform: &Waveform, amplitude: f64, others: &[f64]) -> Json {
        let burst = if let Waveform::Burst(burst) = waveform { Some(burst) } else { None };
        let periods = self
            .periods
            .iter()
            .filter_map(|(path, number)| Some((path.clone(), Json::from(number.of(burst?)))));
        let all = [&self.amplitude].into_iter().chain(&self.others);
        let values = [amplitude].into_iter().chain(others.iter().copied());
        let values = all
            .zip(values)
            .map(|(number, value)| (number.path.clone(), Json::from(value * number.per_unit)));
        values.chain(periods).collect::<serde_json::Map<_, _>>().into()
    }

    /// An operating point by the paths of the study.
    pub(super) fn point_by_path(&self, point: &[f64]) -> Json {
        let values = self.over.iter().zip(point);
        let values = values
            .map(|(number, value)| (number.path.clone(), Json::from(value * number.per_unit)));
        values.collect::<serde_json::Map<_, _>>().into()
    }

    /// An operating point in words; empty where the study has one alone.
    pub(super) fn point_in_words(&self, point: &[f64]) -> String {
        let values = self.over.iter().zip(point);
        let words: Vec<String> =
            values.map(|(number, value)| format!("the {}", number.in_words(*value))).collect();
        if words.is_empty() { String::new() } else { format!(" at {}", listed(&words)) }
    }

    /// The design variables other than the amplitude in words, each after a comma.
    pub(super) fn chosen_in_words(&self, others: &[f64]) -> String {
        let values = self.others.iter().zip(others);
        values.fold(String::new(), |mut text, (number, value)| {
            let _ = write!(text, ", {}", number.in_words(*value));
            text
        })
    }

    /// The answer in two sentences; [`LeastDitherFound::notes`] has what it costs and on what it depends.
    pub fn sentence(&self, study: &dyn StudyWithDesign) -> String {
        let waveform = label(self.waveform());
        let place = match &self.dither().place {
            Some(place) => format!(" at {place}"),
            None => String::new(),
        };
        let force = |value: f64| study.in_words(study.quantity_of_amplitude(), value);
        let chosen = |others: &[f64]| self.chosen_in_words(others);
        match &self.answer().answer {
            Ok(found) => {
                let critical = &found.critical;
                let smallest = match &critical.worst {
                    Some(_) => "",
                    None => {
                        "; this smallest allowed amplitude is quiet everywhere, and less, or no dither, may do"
                    }
                };
                let slow = self.residual_in_words();
                let size = format!("{}{}", force(critical.amplitude), chosen(&critical.others));
                let what = if self.is_quiet() == Ok(true) {
                    "that is quiet"
                } else {
                    "with which the motion stays in step"
                };
                format!(
                    "The least dither {what} in the whole range is a {waveform}{place} of amplitude {size}{slow}{smallest}."
                )
            }
            Err(none) => {
                let is_limited = matches!(none.why, NoDesign::Limit { .. });
                let covered = self.covered.as_ref().map_or(String::new(), |part| {
                    let one = format!(
                        "{waveform}{place} of amplitude {}{}",
                        force(part.amplitude),
                        chosen(&part.others)
                    );
                    self.covered_in_words(&one, is_limited)
                });
                let why = self.why(study, none);
                let is_whole = self.is_covered_whole();
                if is_whole && is_limited {
                    format!(
                        "No dither that has the least quiet amplitude of its choice keeps every limit: {why}.{covered}"
                    )
                } else if is_whole {
                    format!("The least dither is unknown: {why}.{covered}")
                } else if none.why.is_known() {
                    format!("No allowed dither is quiet in the whole range: {why}.{covered}")
                } else {
                    format!(
                        "Whether an allowed dither is quiet in the whole range is unknown: {why}.{covered}"
                    )
                }
            }
        }
    }

    /// How the dither was verified, what decides, what the verified dither demands of the actuator and costs, the dither that is quiet in most samples, what a schedule saves, and on
    /// what the amplitude depends most.
    pub fn notes(&self, study: &dyn StudyWithDesign) -> Vec<String> {
        let Ok(found) = &self.answer().answer else { return Vec::new() };
        let loss = found.friction_loss.as_ref().ok().map(|(loss, point)| {
            let change = if *loss < 0.0 { "gains" } else { "loses" };
            format!(
                "The mean friction {change} at most {} %{}.",
                digits(100.0 * loss.abs()),
                self.point_in_words(point)
            )
        });
        let decides = found.critical.worst.as_ref().filter(|worst| !worst.is_empty());
        let decides = decides
            .map(|worst| format!("The least dither is decided{}.", self.point_in_words(worst)));
        let binding = self.binding(&found.critical);
        let binding: Vec<String> = binding.iter().map(|name| quantity_at(name)).collect();
        let binds = (!binding.is_empty()).then(|| format!("At the limit: {}.", listed(&binding)));
        let largest = more_digits(found.largest_multiplier());
        let notes = [
            Some(verified_in_words(study, found)),
            decides,
            binds,
            self.slow_in_words(study),
            Some(format!("The largest multiplier of the verified dither is {largest}.")),
            self.drive_in_words(study, found.drive.as_ref()),
            self.confident_in_words(study),
            loss,
            self.schedule_in_words(study),
            self.sensitivity_in_words(),
        ];
        notes.into_iter().flatten().collect()
    }

    /// Why there is no dither.
    fn why(&self, study: &dyn StudyWithDesign, none: &InfeasibleDesign) -> String {
        match &none.why {
            NoDesign::NeverQuiet { point } => {
                // The point that left no amplitude need not be one at which every amplitude is loud.
                let at = match self.point_in_words(point) {
                    at if at.is_empty() => at,
                    at => {
                        format!(" at all operating points that were examined; the search ended{at}")
                    }
                };
                format!(
                    "no amplitude from {} to {} is quiet{at}",
                    study.in_words(study.quantity_of_amplitude(), self.amplitude.range.lower),
                    study.in_words(study.quantity_of_amplitude(), self.amplitude.range.upper)
                )
            }
            NoDesign::Limit { quantity, used, point } => {
                let at = point.as_ref().map_or(String::new(), |point| self.point_in_words(point));
                let used = match quantity {
                    // A limit from below.
                    LimitedQuantity::MinimumNormalLoad => 1.0 / used,
                    _ => *used,
                };
                format!(
                    "the {} would be {} its limit{at}",
                    limit_in_words(*quantity),
                    times_in_words(used)
                )
            }
            NoDesign::Unlimited { quantity, point, why } => {
                let at = point.as_ref().map_or(String::new(), |point| self.point_in_words(point));
                format!("the {}: {why}{at}", limit_in_words(*quantity))
            }
            NoDesign::Failed { point, why } => format!("{why}{}", self.point_in_words(point)),
        }
    }

    /// What decides: the names of the limits that are used wholly, and the end of a range.
    fn binding(&self, critical: &DesignPoint) -> Vec<String> {
        let used = critical.used.iter();
        let limits = used.filter(|(_, used)| used.as_ref().is_ok_and(|used| *used >= BINDS));
        let mut binding: Vec<String> =
            limits.map(|(quantity, _)| quantity.name().to_owned()).collect();
        for (number, value) in self.others.iter().zip(&critical.others) {
            if *value == number.range.lower || *value == number.range.upper {
                binding.push(number.path.clone());
            }
        }
        if critical.worst.is_none() {
            binding.push(self.amplitude.path.clone());
        }
        binding
    }

    /// Warnings: waveforms without an answer, and minima that were searched.
    pub fn warnings(&self, study: &dyn StudyWithDesign) -> Vec<String> {
        let mut warnings = Vec::new();
        for tried in &self.tried {
            if let (Err(none), true) = (&tried.designed.answer, self.tried.len() > 1) {
                let none_known = if none.why.is_known() { "no allowed dither" } else { "unknown" };
                warnings.push(format!(
                    "{}: {none_known}: {}",
                    tried.label(),
                    self.why(study, none)
                ));
            }
        }
        if let Ok(found) = &self.answer().answer
            && let (Ok(exact), Ok(averaged)) =
                (&found.critical.objective, &found.averaged.objective)
            && (exact / averaged - 1.0).abs() > 0.1
        {
            warnings.push(format!(
                "the exact least dither differs from that of averaging by {} %: the dither is not much faster than the vibration",
                digits(100.0 * (exact / averaged - 1.0).abs())
            ));
        }
        if let Ok(found) = &self.answer().answer
            && let Ok(Some(end)) = found.loud_from
            && end < NARROW * found.critical.amplitude
        {
            warnings.push(format!(
                "it vibrates again from {} on: a larger dither is not safer",
                study.in_words(study.quantity_of_amplitude(), end)
            ));
        }
        warnings.extend(self.without_state.first().map(|because| averages_are_a_start(because)));
        warnings.extend(self.warnings_about_drive(study));
        warnings.extend(self.warnings_about_samples());
        warnings.extend(self.beyond_laws.clone());
        warnings.extend(self.warnings_about_slow_ones());
        warnings.extend(study.warnings_about_design());
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &dyn StudyWithDesign) -> Json {
        let asked = study.asked();
        let minimise = asked.map_or(DesignObjective::Amplitude, |asked| asked.minimise);
        let mut fields = study.fields();
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        self.put_whether_feasible(&mut fields, study, self.answer());
        fields.plain("waveform", self.waveform().name()).plain("minimise", minimise.name());
        match &self.dither().place {
            Some(place) => fields.plain("place", place.as_str()),
            None => fields.unknown(
                "place",
                "design.places is not given: the dither acts where the study says",
            ),
        };
        match &self.answer().answer {
            Ok(found) => self.put_feasible(&mut fields, study, found, minimise),
            Err(none) => self.put_infeasible(&mut fields, study, none),
        }
        let basins = self.answer().basins.iter().map(|basin| {
            let mut inner = study.fields();
            inner.plain("parameters", self.by_path(basin.amplitude, &basin.others));
            inner.number("objective", quantity_of(study, minimise), basin.objective);
            inner
        });
        fields.list("basins", basins.collect::<Vec<_>>());
        let rows = self.tried.iter().map(|tried| {
            let (waveform, designed) = (&tried.waveform, &tried.designed);
            let mut inner = study.fields();
            inner.plain("waveform", waveform.name());
            if let Waveform::Burst(burst) = waveform {
                inner.plain("on", burst.on()).plain("off", burst.off());
            }
            if let Some(place) = &tried.place {
                inner.plain("place", place.as_str());
            }
            self.put_whether_feasible(&mut inner, study, designed);
            if let Ok(DesignPoint { amplitude, others, .. }) =
                designed.answer.as_ref().map(|found| &found.critical)
            {
                let critical = self.with_waveform_by_path(waveform, *amplitude, others);
                inner.plain("critical", critical);
            }
            let objective = match &designed.answer {
                Ok(found) => found.critical.objective.clone().map_err(|why| why.to_string()),
                Err(none) => Err(self.why(study, none)),
            };
            inner.known("objective", quantity_of(study, minimise), objective);
            inner
        });
        fields.list("waveforms", rows.collect::<Vec<_>>());
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Adds `feasible`: null where the search failed on the way.
    fn put_whether_feasible(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        designed: &Designed,
    ) {
        match &designed.answer {
            // A dither that serves the whole box was found by another search.
            Err(none)
                if !none.why.is_known()
                    || self.is_covered_whole() && !matches!(none.why, NoDesign::Limit { .. }) =>
            {
                fields.unknown("feasible", self.why(study, none));
            }
            answer => {
                fields.plain("feasible", answer.is_ok());
            }
        }
    }

    fn put_feasible(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        found: &FeasibleDesign,
        minimise: DesignObjective,
    ) {
        let FeasibleDesign {
            critical, averaged, verified_amplitude, verified, friction_loss, ..
        } = found;
        fields
            .plain("critical", self.by_path(critical.amplitude, &critical.others))
            .plain("parameters", self.by_path(*verified_amplitude, &critical.others))
            .plain("averaged", self.by_path(averaged.amplitude, &averaged.others))
            .known("objective", quantity_of(study, minimise), critical.objective.clone())
            .plain("binding", self.binding(critical));
        self.put_slow(fields);
        self.put_drive(fields, study, found.drive.as_ref());
        match &critical.worst {
            Some(worst) => fields.plain("worst", self.point_by_path(worst)),
            None => fields.unknown("worst", "the smallest allowed amplitude is quiet everywhere"),
        };
        fields.number("margin", Quantity::Ratio, found.margin());
        let loud = || "no larger amplitude of the range is loud where it was judged".to_owned();
        let loud_from = found
            .loud_from
            .clone()
            .map_err(|why| why.to_string())
            .and_then(|end| end.ok_or_else(loud));
        fields.known("loud_from", study.quantity_of_amplitude(), loud_from);
        let start = study.asked().map_or("local", |asked| asked.start.name());
        let mut inner = study.fields();
        inner.plain("protocol", start);
        if let Some(first) = verified.first() {
            inner.number("multiplier", Quantity::Ratio, first.multiplier);
            if let Some(rate) = first.growth_rate {
                let (one, unit) = study.unit_of_growth();
                inner.measured("growth_rate", unit, one * rate);
            }
            inner.plain("point", self.point_by_path(&first.point));
        }
        inner.number("largest_multiplier", Quantity::Ratio, found.largest_multiplier());
        inner.plain("operating_points", verified.len());
        fields.nested("verified", inner);
        fields.known(
            "friction_loss",
            Quantity::Ratio,
            friction_loss.as_ref().map(|(loss, _)| *loss).map_err(Clone::clone),
        );
        let used = critical.used.iter().map(|(quantity, used)| {
            let mut inner = study.fields();
            inner.plain("limit", quantity.name()).known("used", Quantity::Ratio, used.clone());
            inner
        });
        fields.list("limits", used.collect::<Vec<_>>());
        self.put_frontier(fields, study, minimise);
        let response =
            |of: fn(&ResponseSize) -> f64| found.response.as_ref().map(of).map_err(Clone::clone);
        fields.known("response_rms", Quantity::Displacement, response(|size| size.rms)).known(
            "response_peak",
            Quantity::Displacement,
            response(|size| size.peak),
        );
        self.put_schedule(fields, study, minimise);
        self.put_confident(fields, study, minimise);
        self.put_sensitivity(fields, study);
    }

    fn put_infeasible(
        &self,
        fields: &mut Fields,
        study: &dyn StudyWithDesign,
        none: &InfeasibleDesign,
    ) {
        let why = self.why(study, none);
        let unknown = [
            "critical",
            "averaged",
            "objective",
            "loud_from",
            "drive",
            "confident",
            "response_rms",
            "response_peak",
            "schedule",
            "saved_by_schedule",
            "sensitivity",
            "sensitivity_relative",
            "threshold",
        ];
        // What the dither leaves is known where one serves a part of the box.
        let left: &[&str] = if self.covered.is_ok() { &[] } else { &OF_SLOW };
        for name in unknown.iter().chain(left) {
            fields.unknown(name, why.clone());
        }
        if self.covered.is_ok() {
            self.put_slow(fields);
        }
        if let NoDesign::NeverQuiet { point } | NoDesign::Limit { point: Some(point), .. } =
            &none.why
        {
            fields.plain("worst", self.point_by_path(point));
        }
        self.put_covered(fields, study);
    }
}

/// How a dither was verified, in one sentence.
fn verified_in_words(study: &dyn StudyWithDesign, found: &FeasibleDesign) -> String {
    let by = match study.asked().map_or(DesignStart::Local, |asked| asked.start) {
        DesignStart::Local => "small motions about exact responses",
        DesignStart::Rest => "exact responses and runs from rest",
        DesignStart::Squeal => "exact responses and runs from squeal",
    };
    let amplitude = study.in_words(study.quantity_of_amplitude(), found.verified_amplitude);
    let points = counted(found.verified.len(), "operating point");
    format!("At {amplitude} this dither is verified by {by} at {points}.")
}
