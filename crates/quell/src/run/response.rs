//! `response`: the steady response, what the dither does to it, and what it costs.

use quell_belt::attractor::Reached;
use quell_belt::response::{BAND_END, Effect, Ending, Response, respond};
use quell_belt::simulation::{Sample, Start};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::range::SlipMet;
use super::{failed, in_words, start, start_in_words};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::study::Study;

/// A steady response with its start.
#[derive(Clone, Debug)]
pub struct Steady {
    /// Where both runs started.
    pub start: Start,
    /// The response.
    pub response: Response,
    /// Whether the belt moves.
    moves: bool,
    /// The slip that both runs met.
    pub slip: SlipMet,
}

/// Measures the steady response of a study.
///
/// # Errors
/// [`Failure::Wrong`] where the study starts squealing and cannot; [`Failure::Failed`] if the
/// engine stops.
pub fn run(study: &Study) -> Result<Steady, Failure> {
    let start = start(study)?;
    let response = respond(study.belt(), start, study.solver()).map_err(failed)?;
    let moves = study.belt().belt_velocity() > 0.0;
    let belt = study.belt();
    let samples = response.record.samples.iter().chain(&response.undithered_record.samples);
    let mut slip = SlipMet::of_velocities(belt, samples.map(|sample| sample.velocity));
    slip.add_start(belt, start);
    slip.add_start(&belt.undithered(), start);
    Ok(Steady { start, response, moves, slip })
}

impl Steady {
    /// What the dither does, and at what cost.
    pub fn sentence(&self, study: &Study) -> String {
        let response = &self.response;
        let from = start_in_words(study);
        if study.belt().dithers().iter().all(|dither| dither.amplitude == 0.0) {
            return match &response.efficiency {
                Ok(_) => format!("Without dither, {from}, the belt keeps vibrating."),
                Err(why) => format!("The study has no dither, and {why}."),
            };
        }
        let residual = response.efficiency.map_or_else(
            |_| String::new(),
            |ratio| {
                let level = self.level();
                let level = level.map_or_else(String::new, |level| format!(", {level:.1} dB"));
                format!("the residual vibration E below {BAND_END} ω₀ is {}{level}", percent(ratio))
            },
        );
        let amplitude = in_words(study, Quantity::Displacement, response.amplitude);
        let what = match response.effect {
            Effect::Quenches => format!("this dither quenches the vibration: {residual}"),
            Effect::Reduces => format!("this dither reduces the vibration: {residual}"),
            Effect::Increases => format!("this dither increases the vibration: {residual}"),
            Effect::Causes => format!(
                "this dither causes vibration: the belt is quiet without it, and vibrates with an amplitude of \
                 {amplitude} below {BAND_END} ω₀ with it"
            ),
            Effect::Quiet => {
                "the belt is quiet without this dither and with it: there is nothing to quench"
                    .to_owned()
            }
            Effect::Unknown(why) => format!("the effect of this dither is unknown: {why}"),
        };
        format!("Started {from}, {what}.{}", self.cost(study))
    }

    /// The cost of the dither in a sentence of its own.
    fn cost(&self, study: &Study) -> String {
        let response = &self.response;
        let loss = self.friction_loss().ok().map(|loss| {
            let change = if loss < 0.0 { "raises" } else { "lowers" };
            format!("{change} the mean friction by {}", percent(loss.abs()))
        });
        let power = response.dither_power.map(|power| {
            let verb = if power < 0.0 { "returns to its actuator" } else { "takes" };
            format!("{verb} a mean power of {}", in_words(study, Quantity::Power, power.abs()))
        });
        let stroke = response.dither_stroke.map(|stroke| {
            let stroke = in_words(study, Quantity::Displacement, stroke);
            format!("needs a stroke of {stroke} peak to peak")
        });
        let parts: Vec<String> = [loss, power, stroke].into_iter().flatten().collect();
        match parts.as_slice() {
            [] => String::new(),
            [only] => format!(" It {only}."),
            [first, second] => format!(" It {first} and {second}."),
            [first, second, rest @ ..] => {
                format!(" It {first}, {second} and {}.", rest.join(" and "))
            }
        }
    }

    /// Share of the friction of undithered steady sliding that is lost, 1 − ⟨f⟩/(μ(v₀)F); negative where there is more.
    ///
    /// # Errors
    /// Why it is undefined.
    pub fn friction_loss(&self) -> Result<f64, String> {
        let response = &self.response;
        if self.moves {
            Ok(1.0 - response.mean_friction / response.mean_friction_undithered)
        } else {
            Err("the belt does not move (v₀ = 0), so there is no steady sliding to compare with"
                .to_owned())
        }
    }

    /// 20 lg E, in dB; `None` where E is undefined or zero.
    pub fn level(&self) -> Option<f64> {
        let ratio = self.response.efficiency.ok().filter(|ratio| *ratio > 0.0)?;
        Some(20.0 * ratio.log10())
    }

    /// What a reader of the numbers should know.
    pub fn warnings(&self, study: &Study) -> Vec<String> {
        let time = if study.scales().is_some() { "t" } else { "τ" };
        let settle = in_words(study, Quantity::Time, study.solver().settle);
        let mut warnings = self.slip.warnings(study);
        let mut warn = |which: &str, settled: bool| {
            if !settled {
                warnings.push(format!(
                    "the {which} response has not settled after {time} = {settle}: the amplitudes of the two \
                     halves of the record differ; raise solver.settle or solver.record_periods"
                ));
            }
        };
        warn("dithered", self.response.settled);
        // Where it decays to nothing it need not settle: E is undefined and says so.
        warn("undithered", self.response.undithered_settled || self.response.efficiency.is_err());
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &Study) -> Json {
        let response = &self.response;
        let scales = study.scales();
        let mut fields = Fields::new(scales);
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        match response.effect {
            Effect::Unknown(why) => {
                fields.plain("effect", "unknown").why("effect", why.to_string())
            }
            effect => fields.plain("effect", effect.name()),
        };
        fields.plain("ends_on", response.ending.name());
        if let Some(why) = why_end_unknown(response.ending) {
            fields.why("ends_on", why);
        }
        fields.number("amplitude", Quantity::Displacement, response.amplitude);
        let peaks = response.peaks.iter().map(|peak| {
            let mut inner = Fields::new(scales);
            inner.number("frequency", Quantity::FrequencyRatio, peak.frequency).number(
                "amplitude",
                Quantity::Displacement,
                peak.amplitude,
            );
            inner
        });
        fields.list("peaks", peaks);
        let only_normal = || {
            "all dither is normal: the model has no normal motion on which it could work".to_owned()
        };
        fields
            .number("stick_fraction", Quantity::Ratio, response.stick_fraction)
            .known(
                "efficiency",
                Quantity::Ratio,
                response.efficiency.map_err(|why| why.to_string()),
            )
            .known(
                "level_db",
                Quantity::Ratio,
                self.level().ok_or_else(|| match response.efficiency {
                    Ok(_) => "E is zero".to_owned(),
                    Err(why) => why.to_string(),
                }),
            )
            .number("undithered_amplitude", Quantity::Displacement, response.undithered_amplitude)
            .plain("settled", response.settled)
            .plain("undithered_settled", response.undithered_settled)
            .number("mean_friction", Quantity::Force, response.mean_friction)
            .number("mean_friction_undithered", Quantity::Force, response.mean_friction_undithered)
            .known("friction_loss", Quantity::Ratio, self.friction_loss())
            .known("dither_power", Quantity::Power, response.dither_power.ok_or_else(only_normal))
            .known(
                "dither_stroke",
                Quantity::Displacement,
                response.dither_stroke.ok_or_else(only_normal),
            )
            .number("minimum_normal_load", Quantity::Force, response.minimum_normal_load)
            .number("settle", Quantity::Time, study.solver().settle)
            .number("record_length", Quantity::Time, response.record.length())
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The record of both runs.
    pub fn record(&self, study: &Study) -> Dataset {
        let (with, without) =
            (&self.response.record.samples, &self.response.undithered_record.samples);
        let column = |samples: &[Sample], value: fn(&Sample) -> f64| -> Vec<f64> {
            samples.iter().map(value).collect()
        };
        Dataset::new(study, "response: record")
            .fact(format!("start: {}", start_in_words(study)))
            .axis("time", Quantity::Time, column(with, |sample| sample.time))
            .array(
                "displacement",
                Quantity::Displacement,
                column(with, |sample| sample.displacement),
            )
            .array("velocity", Quantity::Velocity, column(with, |sample| sample.velocity))
            .array(
                "sticking",
                Quantity::Count,
                column(with, |sample| f64::from(u8::from(sample.sticking))),
            )
            .array(
                "undithered_displacement",
                Quantity::Displacement,
                column(without, |sample| sample.displacement),
            )
            .array(
                "undithered_velocity",
                Quantity::Velocity,
                column(without, |sample| sample.velocity),
            )
            .array(
                "undithered_sticking",
                Quantity::Count,
                column(without, |sample| f64::from(u8::from(sample.sticking))),
            )
    }

    /// The spectra of both records.
    pub fn spectrum(&self, study: &Study) -> Dataset {
        let (with, without) =
            (&self.response.record.spectrum, &self.response.undithered_record.spectrum);
        Dataset::new(study, "response: spectrum of the displacement")
            .fact("mean removed, Hann window, four times the record's length by zeros; amplitude of a pure tone")
            .axis("frequency", Quantity::FrequencyRatio, with.frequencies().collect())
            .array("amplitude", Quantity::Displacement, with.amplitudes().to_vec())
            .array("undithered_amplitude", Quantity::Displacement, without.amplitudes().to_vec())
    }
}

/// Why it is unknown where a run ends.
fn why_end_unknown(ending: Ending) -> Option<String> {
    match ending {
        Ending::Unknown(why) => Some(why.to_string()),
        Ending::Reached(Reached::Unsettled | Reached::Unknown) => {
            Some("the run had not settled when its periods were over".to_owned())
        }
        Ending::Reached(Reached::Sliding | Reached::Elsewhere) => None,
    }
}

/// A share as a percentage with three digits.
fn percent(ratio: f64) -> String {
    let value = 100.0 * ratio;
    if value >= 100.0 {
        format!("{value:.0} %")
    } else if value >= 0.1 {
        format!("{value:.2} %")
    } else {
        format!("{value:.1e} %")
    }
}
