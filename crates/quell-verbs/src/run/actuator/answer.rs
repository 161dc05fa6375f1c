//! The answer of `actuator`: sentence, warnings and JSON.

use quell_design::NoAnswer;
use quell_design::actuator::{ActuatorAtFrequency, ActuatorLimit, SufficientBand};
use quell_dynamics::response::BAND_END;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::ActuatorFound;
use super::demand::{FEW_SAMPLES, demand_fields, warnings_about_actuator};
use crate::fields::Fields;
use crate::run::design::StudyWithDesign;
use crate::run::stability::FAR;
use crate::run::waveforms::label;
use crate::study::SystemStudy;
use crate::words::{digits, listed, more_digits, quantity_at};

/// Why a margin has no value where nothing needs to be quenched.
const NOTHING_TO_QUENCH: &str = "steady sliding is stable without this dither";

/// Why the margin has no value at an undamped resonance.
const UNBOUNDED_MARGIN: &str = "unbounded (undamped resonance)";

/// Why no limit binds where the largest amplitude has no value.
const UNKNOWN_AMPLITUDE: &str = "the largest amplitude is unknown there";

/// Margin above which rounding decides it: no structure with damping has a quality factor near it, and an undamped one at its natural
/// frequency, rounded, answers with about the inverse of the machine precision. A smaller bound would hide margins that are real.
const MOST_MARGIN: f64 = 1e9;

/// A limit in words.
fn limit_in_words(limit: Option<ActuatorLimit>) -> String {
    limit.map_or_else(|| "unknown".to_owned(), |limit| format!("the {}", quantity_at(limit.path())))
}

/// A range of frequencies with its unit.
fn range_in_words(
    study: &SystemStudy,
    RealInterval { lower: from, upper: to }: RealInterval,
) -> String {
    let scale = study.frequency_scale();
    format!("{} to {}{}", more_digits(scale.of(from)), more_digits(scale.of(to)), scale.unit)
}

/// Bands of frequencies, those that are narrow apart.
fn bands_in_words(study: &SystemStudy, bands: &[SufficientBand]) -> String {
    let (narrow, wide): (Vec<&SufficientBand>, Vec<&SufficientBand>) =
        bands.iter().partition(|band| band.is_narrow());
    let wide: Vec<String> = wide.into_iter().map(|band| range_in_words(study, band.ends)).collect();
    let narrow: Vec<String> = narrow
        .into_iter()
        .map(|band| {
            let width = quell_model::digits::digits(100.0 * band.width(), 2);
            format!("{} ({width} % wide)", range_in_words(study, band.ends))
        })
        .collect();
    let moves = "which a small change of a natural frequency moves away";
    match (wide.is_empty(), narrow.is_empty()) {
        (_, true) => format!("from {}", listed(&wide)),
        (false, false) => {
            format!(
                "from {}, and in narrow windows, {moves}, from {}",
                listed(&wide),
                listed(&narrow)
            )
        }
        (true, false) => format!("only in narrow windows, {moves}: from {}", listed(&narrow)),
    }
}

impl ActuatorFound {
    /// The result in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let kind = study.actuator().map_or("actuator", |actuator| actuator.kind().in_words());
        let waveform = label(&self.waveform);
        match (&self.coverage.sufficient[..], &self.coverage.best) {
            _ if self.is_quiet_without() => {
                "Steady sliding is stable without this dither: there is nothing to quench."
                    .to_owned()
            }
            ([], Some(best)) => format!(
                "By averaging{}, the {kind} cannot quench with a {waveform} from {}: at best, at {}, it gives {} of the least amplitude \
                 that quenches.",
                self.unsure_in_words(study),
                range_in_words(study, self.range),
                study.frequency_scale().with_noun(best.frequency),
                percent(best.margin())
            ),
            ([], None) => {
                let why = self.coverage.points.iter().find_map(|point| point.needed.as_ref().err());
                format!(
                    "With a {waveform} from {} nothing is known to be quenched: {}.",
                    range_in_words(study, self.range),
                    why.map_or("nothing is known".to_owned(), ToString::to_string)
                )
            }
            (bands, best) => {
                let best = best.as_ref().map_or(String::new(), |best| {
                    let margin = match best.margin() {
                        Ok(margin) if margin > MOST_MARGIN => UNBOUNDED_MARGIN.to_owned(),
                        Ok(margin) => {
                            format!("{} times the least amplitude", digits(margin))
                        }
                        Err(why) => why.to_string(),
                    };
                    format!(
                        " The margin is largest at {}, {margin}.",
                        study.frequency_scale().with_noun(best.frequency)
                    )
                });
                format!(
                    "By averaging{}, the {kind} can quench with a {waveform} {}.{best}",
                    self.unsure_in_words(study),
                    bands_in_words(study, bands)
                )
            }
        }
    }

    /// The largest amplitude and what limits it, in one sentence.
    fn reach_in_words(&self, study: &SystemStudy) -> String {
        let kind = study.actuator().map_or("actuator", |actuator| actuator.kind().in_words());
        let most = self.best_or_own();
        let at = study.frequency_scale().with_noun(most.frequency);
        match most.reach() {
            Ok(reach) => {
                let largest = study.in_words(Quantity::Force, reach.amplitude);
                let limit = quantity_at(reach.limit.path());
                format!("At {at} the {kind} can give {largest}, limited by the {limit}.")
            }
            Err(why) => format!("What the {kind} can give at {at} is unknown: {why}."),
        }
    }

    /// The largest amplitude, and the changes of the limit that binds.
    pub fn notes(&self, study: &SystemStudy) -> Vec<String> {
        let scale = study.frequency_scale();
        let changes = self.coverage.changes().map(|(at, [below, above])| {
            let [below, above] = [below, above].map(limit_in_words);
            format!("from {below} to {above} at {}", scale.with_unit(at))
        });
        let changes: Vec<String> = changes.collect();
        let binds = format!("What binds changes {}.", listed(&changes));
        let binds = (!changes.is_empty()).then_some(binds);
        [self.reach_in_words(study)].into_iter().chain(binds).collect()
    }

    /// The frequency at which the dither repeats as often as the vibration.
    fn slow_dither(&self) -> Option<f64> {
        Some(self.slow? * f64::from(self.waveform.cycles()))
    }

    /// Where averaging does not hold or else is unsure, after a comma; empty where it is sure. A warning says both.
    fn unsure_in_words(&self, study: &SystemStudy) -> String {
        let Some(slow) = self.slow_dither() else { return String::new() };
        let (holds_from, sure_from) = (BAND_END * slow, FAR * slow);
        let scale = study.frequency_scale();
        let unsure = self.coverage.sufficient.iter().any(|band| band.ends.lower < sure_from);
        match (self.range.lower < holds_from, unsure) {
            (false, false) => String::new(),
            (true, _) => format!(", which does not hold below {}", scale.with_noun(holds_from)),
            (false, true) => format!(", which is unsure below {}", scale.with_noun(sure_from)),
        }
    }

    /// What holds at the largest margin, or at the study's frequency.
    fn best_or_own(&self) -> &ActuatorAtFrequency {
        self.coverage.best.as_ref().unwrap_or(&self.own)
    }

    /// Warnings: few samples where the actuator suffices, an actuator that changes the structure, and a range that averaging does not
    /// describe.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let mut warnings = study.warnings().to_vec();
        let scale = study.frequency_scale();
        let known = self.coverage.points.iter().find_map(|point| point.demand.as_ref().ok());
        if let (Some(actuator), Some(demand)) = (study.actuator(), known) {
            warnings.extend(warnings_about_actuator(actuator, demand));
        }
        // Samples per period times frequency is the sample rate.
        let rate = self.coverage.points.iter().find_map(|point| {
            Some(point.frequency * point.demand.as_ref().ok()?.samples_per_period?)
        });
        let few_from = rate.map(|rate| rate / FEW_SAMPLES);
        if let Some(few_from) = few_from.filter(|few| *few < self.range.upper) {
            warnings.push(format!(
                "from {} on the controller has fewer than {} samples in a period of the dither, so that the force is a staircase: \
                 waveform \"samples\" with hold = \"zero\" describes it",
                scale.with_noun(f64::max(few_from, self.range.lower)),
                digits(FEW_SAMPLES)
            ));
        }
        warnings.extend(self.closing.iter().map(|window| {
            let force = |amplitude| study.in_words(Quantity::Force, amplitude);
            format!(
                "at {} by averaging only amplitudes from {} to {} quench: above, sliding is unstable again, and the actuator can give {}",
                scale.with_noun(window.frequency),
                force(window.amplitudes.lower),
                force(window.amplitudes.upper),
                force(window.largest)
            )
        }));
        if let Some(slow) = self.slow_dither().filter(|slow| self.range.lower < FAR * slow) {
            warnings.push(format!(
                "below {} the dither repeats at less than {} times the frequency of the vibration: averaging assumes that it is much \
                 faster, and near the vibration itself the least amplitude is that of a resonance, which excites and does not quench",
                scale.with_noun(FAR * slow),
                digits(FAR)
            ));
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = study.fields();
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        if let Some(actuator) = study.actuator() {
            fields.plain("kind", actuator.kind().name());
        }
        fields
            .plain("dither", self.dither.as_str())
            .plain("waveform", self.waveform.name())
            .plain("can_quench", !self.coverage.sufficient.is_empty())
            .plain("quiet_without", self.is_quiet_without())
            .number("from", Quantity::FrequencyRatio, self.range.lower)
            .number("to", Quantity::FrequencyRatio, self.range.upper);
        let sufficient = self.coverage.sufficient.iter();
        let sufficient: Vec<Fields> =
            sufficient.map(|band| self.band_fields(study, band)).collect();
        fields.list("sufficient", sufficient);
        if let Some(best) = &self.coverage.best {
            fields.nested("best", self.fields_at(study, best, false));
        } else {
            let why = self.coverage.points.iter().find_map(|point| point.margin().err());
            fields.unknown("best", why.map_or(NOTHING_TO_QUENCH.to_owned(), |why| why.to_string()));
        }
        let mut own = self.fields_at(study, &self.own, false);
        own.number("given", Quantity::Force, self.own_amplitude);
        let used = self.own.reach().map(|reach| self.own_amplitude / reach.amplitude);
        own.known("used", Quantity::Ratio, used);
        match &self.own.demand {
            Ok(demand) => own.nested("drive", demand_fields(study, &demand.at(self.own_amplitude))),
            Err(why) => own.unknown("drive", why),
        };
        fields.nested("own", own);
        let binding = self.coverage.binding.iter().map(|band| {
            let mut inner = study.fields();
            inner.number("from", Quantity::FrequencyRatio, band.ends.lower).number(
                "to",
                Quantity::FrequencyRatio,
                band.ends.upper,
            );
            let limit = band.limit.ok_or_else(|| self.why_unknown(band.ends));
            inner.known_plain("limit", limit.map(ActuatorLimit::path));
            inner
        });
        fields.list("binding", binding.collect::<Vec<_>>());
        let changes = self.coverage.changes().map(|(at, limits)| {
            let mut inner = study.fields();
            inner.number("frequency", Quantity::FrequencyRatio, at);
            for (name, limit) in ["below", "above"].into_iter().zip(limits) {
                inner.known_plain(name, limit.map(ActuatorLimit::path).ok_or(UNKNOWN_AMPLITUDE));
            }
            inner
        });
        fields.list("changes", changes.collect::<Vec<_>>());
        let resonances = self.coverage.resonances.iter().map(|resonance| {
            let mut inner = self.fields_at(study, &resonance.at, resonance.unbounded);
            inner.plain("helps", resonance.helps);
            inner
        });
        fields.list("resonances", resonances.collect::<Vec<_>>());
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Why the largest amplitude is unknown between two frequencies.
    fn why_unknown(&self, RealInterval { lower: from, upper: to }: RealInterval) -> String {
        let inside =
            |point: &&ActuatorAtFrequency| from <= point.frequency && point.frequency <= to;
        let why = self.coverage.points.iter().filter(inside).find_map(|point| point.reach().err());
        why.map_or(UNKNOWN_AMPLITUDE.to_owned(), |why| why.to_string())
    }

    fn band_fields(&self, study: &SystemStudy, band: &SufficientBand) -> Fields {
        let mut inner = study.fields();
        inner
            .number("from", Quantity::FrequencyRatio, band.ends.lower)
            .number("to", Quantity::FrequencyRatio, band.ends.upper)
            .plain("narrow", band.is_narrow())
            .nested("best", self.fields_at(study, &band.best, false));
        inner
    }

    /// What is known at one frequency.
    fn fields_at(&self, study: &SystemStudy, at: &ActuatorAtFrequency, unbounded: bool) -> Fields {
        let mut inner = study.fields();
        let reach = at.reach();
        inner.number("frequency", Quantity::FrequencyRatio, at.frequency).known(
            "amplitude",
            Quantity::Force,
            reach.clone().map(|reach| reach.amplitude),
        );
        inner.known_plain("limit", reach.map(|reach| reach.limit.path()));
        let unbounded =
            unbounded || at.margin().is_ok_and(|margin| margin > MOST_MARGIN && margin.is_finite());
        let bounded = if unbounded { Err(UNBOUNDED_MARGIN.to_owned()) } else { Ok(()) };
        let margin = bounded.and_then(|()| match at.margin() {
            Ok(margin) if margin.is_infinite() => Err(NOTHING_TO_QUENCH.to_owned()),
            margin => margin.map_err(|why| why.to_string()),
        });
        inner.known("needed", Quantity::Force, at.needed.clone()).known(
            "margin",
            Quantity::Ratio,
            margin,
        );
        let contacts =
            self.contacts.iter().enumerate().map(|(place, (name, speed))| {
                let mut of_contact = study.fields();
                of_contact.plain("contact", name.as_str());
                of_contact
                    .known("slip_velocity", Quantity::Velocity, at.reached_slip(place))
                    .number("surface_velocity", Quantity::Velocity, *speed);
                of_contact
            });
        inner.list("contacts", contacts.collect::<Vec<_>>());
        inner
    }
}

/// A share in per cent.
fn percent(share: Result<f64, NoAnswer>) -> String {
    share.map_or_else(|why| why.to_string(), |share| format!("{} %", digits(100.0 * share)))
}
