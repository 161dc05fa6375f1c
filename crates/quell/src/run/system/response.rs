//! `response` of a system: the steady response of the observed row, the effect of the dither, and the cost of every dither.

use quell_dynamics::motion::{ContactMeans, InputCost, SeriesCost};
use quell_dynamics::response::{
    Effect, PEAK_FLOOR, ResponsePlan, ResponseRefused, SystemEnding, SystemRecord, SystemResponse,
    Uncertain, Undefined, respond_system,
};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::of_runs::{beyond_laws, failed_run, of_engine, put_means};
use super::periods::slowest_period;
use super::start::{start_in_words, start_of};
use super::{failed, frequency_in_words, has_equations, in_units};
use crate::complaint::{Complaint, Failure};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::effect_words::{EffectWords, level_of, percent, residual_in_words};
use crate::study::{SystemStudy, UnitSystem};
use crate::words::listed;

/// Periods of the slowest oscillation that are discarded before the record.
pub const SETTLE_PERIODS: f64 = 200.0;

/// Periods of the slowest oscillation in the record.
pub const RECORD_PERIODS: f64 = 60.0;

/// Times of a response; `None` for [`SETTLE_PERIODS`] and [`RECORD_PERIODS`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ResponseRequest {
    /// Time discarded before the record.
    pub settle: Option<f64>,
    /// Length of the record.
    pub record: Option<f64>,
}

/// A steady response of a system.
#[derive(Clone, Debug)]
pub struct SettledSystem {
    /// How it was measured.
    pub plan: ResponsePlan,
    /// The response.
    pub response: SystemResponse,
}

/// How the response of a study is measured.
///
/// # Errors
/// A complaint where nothing oscillates and a time is not given.
pub(crate) fn plan_of(
    study: &SystemStudy,
    request: ResponseRequest,
) -> Result<ResponsePlan, Failure> {
    let period = || slowest_period(study, "--settle");
    Ok(ResponsePlan {
        row: study.observe(),
        settle: request.settle.map_or_else(|| Ok(SETTLE_PERIODS * period()?), Ok::<_, Failure>)?,
        length: request.record.map_or_else(|| Ok(RECORD_PERIODS * period()?), Ok::<_, Failure>)?,
    })
}

/// Why a response could not be measured.
pub(crate) fn refused(study: &SystemStudy, plan: &ResponsePlan, why: ResponseRefused) -> Failure {
    let record = |allowed: String| Complaint::option("--record", plan.length, allowed).into();
    match why {
        ResponseRefused::Immobile(why) => failed("response", why),
        ResponseRefused::Stopped(stopped) => failed_run("response", study.system(), &stopped),
        ResponseRefused::TooLong { most } => record(format!(
            "at most {}, a record with all the samples that are kept (by default it is {RECORD_PERIODS} periods of the slowest motion)",
            in_units(study.units(), Quantity::Time, most)
        )),
        ResponseRefused::TooShort { least } => record(format!(
            "more than {}, so that the band of slow vibration ends below the dither",
            in_units(study.units(), Quantity::Time, least)
        )),
    }
}

/// Measures the steady response of a study.
///
/// # Errors
/// A complaint about the start or the times; [`Failure::Failed`] where the motion cannot be computed or the engine stops.
pub fn run(study: &SystemStudy, request: ResponseRequest) -> Result<SettledSystem, Failure> {
    has_equations(study, "response")?;
    let (start, plan) = (start_of(study)?, plan_of(study, request)?);
    let response = respond_system(study.system(), &start, &plan);
    let response = response.map_err(|why| refused(study, &plan, why))?;
    Ok(SettledSystem { plan, response })
}

/// Relative change of the mean friction that is rounding.
const UNCHANGED: f64 = 1e-9;

/// Why E is undefined.
pub(crate) fn undefined(why: Undefined) -> String {
    match why {
        Undefined::UnditheredUnknown => {
            "the vibration without dither still changes within the record, so there is no steady vibration to compare with: \
             settle for longer"
                .to_owned()
        }
        Undefined::UnditheredUnstable | Undefined::UnditheredDrifts => why.to_string(),
        Undefined::UnditheredSettles | Undefined::UnditheredAtRest => {
            "without dither the motion settles without vibration from this start, so there is no vibration to compare with"
                .to_owned()
        }
    }
}

/// Why an effect is unknown.
fn uncertain(why: Uncertain) -> String {
    match why {
        Uncertain::Undithered(why) => undefined(why),
        why => why.to_string(),
    }
}

impl SettledSystem {
    /// Whether a dither acts.
    pub fn has_dither(&self) -> bool {
        self.response.effect != Effect::Unknown(Uncertain::NoDither)
    }

    /// Whether the run with dither ends on an orbit, or M of the halves of its record agree.
    fn settled(&self) -> bool {
        let vibrations = &self.response.vibrations;
        vibrations.dithered.is_settled(vibrations.undithered.whole())
            && self.response.dithered.ending != SystemEnding::Drift
    }

    /// The same without dither.
    fn undithered_settled(&self) -> bool {
        self.response.vibrations.undithered.is_steady()
            && self.response.undithered.ending != SystemEnding::Drift
            || self.response.residual_vibration == Err(Undefined::UnditheredSettles)
    }

    /// The effect of the dither and its cost.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let response = &self.response;
        let (units, from) = (study.units(), start_in_words(study, &Vec::new()));
        let amplitude = in_units(units, Quantity::Displacement, response.dithered.lines.whole);
        if !self.has_dither() {
            return match response.residual_vibration {
                Ok(_) => format!(
                    "Started {from}, without dither, the system keeps vibrating with an amplitude of {amplitude}."
                ),
                Err(Undefined::UnditheredSettles) => {
                    format!("Started {from}, the motion settles without vibration.")
                }
                Err(why) => format!("Started {from}, {}.", undefined(why)),
            };
        }
        let band = frequency_in_words(units, response.band_end);
        let what = match response.effect {
            Effect::Unknown(why) => {
                format!("the effect of this dither is unknown: {}", uncertain(why))
            }
            effect => EffectWords {
                body: "the system",
                band: &band,
                amplitude: &amplitude,
                residual: &residual_in_words(response.residual_vibration.ok(), &band),
            }
            .sentence(effect),
        };
        format!("Started {from}, {what}.{}", self.cost(study))
    }

    /// The cost of every dither in a sentence of its own.
    fn cost(&self, study: &SystemStudy) -> String {
        let units = study.units();
        let losses = study.system().contacts.iter().zip(0..).filter_map(|(contact, index)| {
            let loss = self.friction_loss(index).ok()?;
            if loss.abs() < UNCHANGED {
                return Some(format!(
                    "leaves the mean friction of contact {} at that of steady sliding",
                    contact.name
                ));
            }
            let change = if loss < 0.0 { "raises" } else { "lowers" };
            let share = percent(loss.abs());
            Some(format!(
                "{change} the mean friction of contact {} by {share} relative to steady sliding",
                contact.name
            ))
        });
        let several = self.response.dithered.inputs.len() > 1;
        let inputs = self.response.dithered.inputs.iter().enumerate();
        let costs = inputs.filter_map(|(index, cost)| {
            let InputCost { power, stroke, in_series } = cost.ok()?;
            let does = if power < 0.0 { "returns" } else { "consumes" };
            let power = in_units(units, Quantity::Power, power.abs());
            let stroke = in_units(units, Quantity::Displacement, stroke);
            let of = if several { format!(" at dither[{index}]") } else { String::new() };
            Some(format!(
                "{does} a mean power of {power} while the point on which it acts moves by {stroke} peak to peak{of}{}",
                in_series.and_then(Result::ok).map_or(String::new(), |cost| format!(
                    ", and an actuator in series with the spring of the contact delivers {} with a stroke of {}",
                    in_units(units, Quantity::Power, cost.power),
                    in_units(units, Quantity::Displacement, cost.stroke)
                ))
            ))
        });
        let parts: Vec<String> = losses.chain(costs).collect();
        if parts.is_empty() { String::new() } else { format!(" It {}.", listed(&parts)) }
    }

    /// Relative loss of the mean friction of a contact against steady sliding without dither; negative for a gain.
    fn friction_loss(&self, contact: usize) -> Result<f64, String> {
        let steady = self.steady_friction(contact)?;
        Ok(1.0 - self.response.dithered.contacts[contact].friction / steady)
    }

    fn steady_friction(&self, contact: usize) -> Result<f64, String> {
        let steady = self.response.steady_friction.as_ref().map(|forces| forces[contact]);
        steady.ok_or_else(|| "the system has no steady sliding to compare with".to_owned())
    }

    /// Warnings about the result.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let response = &self.response;
        let mut warnings = study.warnings().to_vec();
        let records = [&response.dithered, &response.undithered];
        let largest = |contact| records.map(|record| record.whole.largest_slip(contact));
        warnings
            .extend(beyond_laws(study, |contact| largest(contact).into_iter().fold(0.0, f64::max)));
        warnings.extend(of_engine(study.system(), &response.dithered.end));
        let settle = in_units(study.units(), Quantity::Time, self.plan.settle);
        let runs = [
            ("dithered ", self.settled(), &response.dithered),
            ("undithered ", self.undithered_settled(), &response.undithered),
        ];
        // Without dither both are one run.
        let runs = if self.has_dither() { &runs[..] } else { &runs[1..] };
        for (which, settled, record) in runs {
            let which = if self.has_dither() { which } else { "" };
            match record.ending {
                SystemEnding::Drift => warnings.push(format!(
                    "the {which}response drifts: over the record the observed motion moves on by more than it vibrates, so that \
                     amplitudes and strokes grow with the record"
                )),
                SystemEnding::UnstableSliding => warnings.push(format!(
                    "the {which}run stays in steady sliding, which is unstable, because its start does not disturb it"
                )),
                _ if !settled => warnings.push(format!(
                    "the {which}response has not settled after t = {settle}: the amplitudes of the two halves of the record \
                     differ; raise --settle or --record"
                )),
                _ => {}
            }
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let (units, response) = (study.units(), &self.response);
        let mut fields = Fields::of_system(units);
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        match response.effect {
            Effect::Unknown(why) => fields.plain("effect", "unknown").why("effect", uncertain(why)),
            effect => fields.plain("effect", effect.name()),
        };
        let residual_vibration = response.residual_vibration.map_err(undefined);
        let level = residual_vibration.clone().and_then(|ratio| {
            level_of(ratio).ok_or_else(|| "E is zero, which has no level in decibels".to_owned())
        });
        let (with, without) = (&response.dithered, &response.undithered);
        put_record(&mut fields, "", with);
        fields.known("residual_vibration", Quantity::Ratio, residual_vibration).known(
            "level_db",
            Quantity::Ratio,
            level,
        );
        put_record(&mut fields, "undithered_", without);
        fields
            .number("band_end", Quantity::FrequencyRatio, response.band_end)
            .plain("settled", self.settled())
            .plain("settled_on", with.ending.name())
            .plain("undithered_settled", self.undithered_settled())
            .plain("undithered_settled_on", without.ending.name());
        for (name, record) in [("period", with), ("undithered_period", without)] {
            let why = "the run was not found to end on a periodic motion";
            let period = record.ending.period().ok_or_else(|| why.to_owned());
            fields.known(name, Quantity::Time, period);
        }
        let peaks = with.spectrum.peaks(PEAK_FLOOR).into_iter().map(|peak| {
            let mut inner = Fields::of_system(units);
            inner.number("frequency", Quantity::FrequencyRatio, peak.frequency).number(
                "amplitude",
                Quantity::Displacement,
                peak.amplitude,
            );
            inner
        });
        fields.list("peaks", peaks.collect::<Vec<_>>());
        fields.list("contacts", self.put_contacts(study));
        fields.list("dithers", put_inputs(units, with));
        fields
            .number("settle", Quantity::Time, self.plan.settle)
            .number("record_length", Quantity::Time, self.plan.length)
            .plain("near_tangential_releases", with.end.near_tangential_releases)
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    fn put_contacts(&self, study: &SystemStudy) -> Vec<Fields> {
        let contacts = study.system().contacts.iter().enumerate().map(|(index, contact)| {
            let mut inner = Fields::of_system(study.units());
            inner.plain("name", contact.name.clone());
            let means: ContactMeans = self.response.dithered.contacts[index];
            put_means(&mut inner, Ok(means));
            inner
                .number(
                    "mean_friction_undithered",
                    Quantity::Force,
                    self.response.undithered.contacts[index].friction,
                )
                .known("steady_sliding_friction", Quantity::Force, self.steady_friction(index))
                .known("friction_loss", Quantity::Ratio, self.friction_loss(index));
            inner
        });
        contacts.collect()
    }

    /// The record of both runs.
    pub fn record(&self, study: &SystemStudy) -> Dataset {
        let (with, without) = (&self.response.dithered, &self.response.undithered);
        let unit = |quantity| study.units().unit(quantity).unwrap_or("1");
        let times = (0..with.row.samples.len())
            .map(|number| f64::mul_add(number as f64, with.step, self.plan.settle));
        let length = unit(Quantity::Displacement);
        Dataset::of(&study.into(), "response: record of the observed displacement")
            .fact(format!("start: {}", start_in_words(study, &Vec::new())))
            .with_axis(Array::new("time", unit(Quantity::Time), times.collect()))
            .with(Array::new("observed", length, with.row.samples.clone()))
            .with(Array::new("undithered_observed", length, without.row.samples.clone()))
    }

    /// The spectra of both records.
    pub fn spectrum(&self, study: &SystemStudy) -> Dataset {
        let (with, without) =
            (&self.response.dithered.spectrum, &self.response.undithered.spectrum);
        let unit = |quantity| study.units().unit(quantity).unwrap_or("1");
        let (rate, length) = (unit(Quantity::FrequencyRatio), unit(Quantity::Displacement));
        Dataset::of(&study.into(), "response: spectrum of the observed displacement")
            .fact("mean removed, Hann window, zero-padded to four times the record length; amplitudes are those of a pure tone")
            .with_axis(Array::new("frequency", rate, with.frequencies().collect()))
            .with(Array::new("amplitude", length, with.amplitudes().to_vec()))
            .with(Array::new("undithered_amplitude", length, without.amplitudes().to_vec()))
    }
}

/// Adds the measures of a record under names with a prefix.
fn put_record(fields: &mut Fields, prefix: &str, record: &SystemRecord) {
    let lengths = [
        ("amplitude", record.lines.whole),
        ("half_peak_to_peak", 0.5 * record.observed.range()),
        ("rms", record.observed.deviation()),
        ("mean", record.observed.mean()),
    ];
    for (name, value) in lengths {
        fields.number(&format!("{prefix}{name}"), Quantity::Displacement, value);
    }
}

/// The cost of every dither.
fn put_inputs(units: UnitSystem, record: &SystemRecord) -> Vec<Fields> {
    let inputs = record.inputs.iter().map(|cost| {
        let mut inner = Fields::of_system(units);
        let of = |pick: fn(&InputCost) -> f64| {
            cost.as_ref().map(pick).map_err(|why| why.why().to_owned())
        };
        inner.known("power", Quantity::Power, of(|cost| cost.power)).known(
            "stroke",
            Quantity::Displacement,
            of(|cost| cost.stroke),
        );
        let in_series = |pick: fn(&SeriesCost) -> f64| {
            let cost = cost.as_ref().map_err(|why| why.why().to_owned())?;
            let force = "a force on coordinates has no spring of a contact to act through";
            let series = cost.in_series.as_ref().ok_or_else(|| force.to_owned())?;
            series.as_ref().map(pick).map_err(ToString::to_string)
        };
        inner.known("actuator_power", Quantity::Power, in_series(|cost| cost.power)).known(
            "actuator_stroke",
            Quantity::Displacement,
            in_series(|cost| cost.stroke),
        );
        inner
    });
    inputs.collect()
}
