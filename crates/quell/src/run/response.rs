//! `response`: the steady response, the effect of the dither and its cost.

use std::f64::consts::TAU;

use quell_dynamics::attractor::Reached;
use quell_dynamics::orbit::cycle::{FreeEnd, free_end};
use quell_dynamics::response::{
    BAND_END, Effect, RunEnding, SettledRecord, SteadyResponse, Uncertain, respond,
    respond_with_state, samples_per_slow_period, stroke_is_measured,
};
use quell_dynamics::simulation::{Sample, Start, within};
use quell_model::units::Quantity;
use quell_model::{Belt, Dither, Waveform};
use serde_json::Value as Json;

use super::belt_start::begin;
use super::effect_words::{EffectWords, MOST_DECIBELS, level_of, percent, residual_in_words};
use super::failed;
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::{passivity, refused_of_belt};
use crate::dataset::Dataset;
use crate::effort::STEPS_OF_A_SEARCH;
use crate::fields::Fields;
use crate::range::SlipMet;
use crate::study::{BeltStudy, Solver};
use crate::words::{capital, in_words, start_in_words};

/// Largest number of samples of a record: with the undithered record and both spectra about a gigabyte. With more, a fast
/// dither could exhaust the memory; with fewer, records would have to be shorter.
const MOST_SAMPLES: f64 = 4_194_304.0;

/// A steady response with its start.
#[derive(Clone, Debug)]
pub struct MeasuredResponse {
    /// The start of both runs.
    pub start: Start,
    /// The response.
    pub response: SteadyResponse,
    /// Whether the belt moves.
    moves: bool,
    /// The slip reached by both runs.
    pub slip: SlipMet,
    /// The period of the limit cycle without dither, if the run is shorter.
    longer_cycle: Option<f64>,
}

/// Measures the steady response of a study.
///
/// # Errors
/// [`Failure::Wrong`] if a squealing start is requested but does not exist; [`Failure::Failed`] if the
/// engine stops.
pub fn run(study: &BeltStudy) -> Result<MeasuredResponse, Failure> {
    refused_of_belt(study, "response")?;
    record_fits(study)?;
    let from = begin(study)?;
    let (start, solver) = (from.0, study.solver());
    let response = if study.belt().has_contact_state() {
        let found = within(STEPS_OF_A_SEARCH, || respond_with_state(study.belt(), from, solver));
        found.map_err(failed)?
    } else {
        respond(study.belt(), start, solver).map_err(failed)?
    };
    let moves = study.belt().belt_velocity() > 0.0;
    let belt = study.belt();
    let samples = response.record.samples.iter().chain(&response.undithered_record.samples);
    let mut slip = SlipMet::of_velocities(belt, samples.map(|sample| sample.velocity));
    slip.add_start(belt, start);
    slip.add_start(&belt.undithered(), start);
    let longer_cycle = longer_cycle(belt, start, solver);
    Ok(MeasuredResponse { start, response, moves, slip, longer_cycle })
}

/// The period of the limit cycle on which the undithered run ends, if the run is settled or recorded for less: on a slow belt a stick
/// may last as long as that.
fn longer_cycle(belt: &Belt, start: Start, solver: &Solver) -> Option<f64> {
    let length = solver.settle.min(TAU * f64::from(solver.record_periods));
    let law = belt.friction();
    let most = law.static_coefficient().max(law.coefficient(0.0)) * belt.normal_load();
    // The force of the spring changes by twice the largest friction in the longest stick.
    let is_slow = belt.belt_velocity() > 0.0 && 2.0 * most / belt.belt_velocity() > length - TAU;
    if !is_slow || belt.has_contact_state() {
        return None;
    }
    match free_end(&belt.undithered(), start) {
        Ok(FreeEnd::Cycle(cycle)) => Some(cycle.period).filter(|period| *period > length),
        _ => None,
    }
}

/// Rejects a record that would not fit into memory: fast dithers are sampled several times per period.
fn record_fits(study: &BeltStudy) -> Result<(), Failure> {
    let solver = study.solver();
    let each = samples_per_slow_period(study.belt());
    let most = (MOST_SAMPLES / each).floor();
    if f64::from(solver.record_periods) <= most {
        return Ok(());
    }
    let shorter = format!(
        "at most {most}: each slow period of this dither takes {each} samples, and at most {MOST_SAMPLES} are kept"
    );
    let key = "solver.record_periods";
    Err(Complaint::new(Fault::Value, key, Origin::Whole, solver.record_periods, shorter).into())
}

impl MeasuredResponse {
    /// The effect of the dither and its cost.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let response = &self.response;
        let from = start_in_words(study);
        if study.belt().dithers().iter().all(|dither| dither.amplitude == 0.0) {
            return match &response.residual_vibration {
                Ok(_) => format!("Without dither, started {from}, the belt keeps vibrating."),
                Err(why) => format!("The study has no dither. {}.", capital(&why.to_string())),
            };
        }
        let residual =
            residual_in_words(response.residual_vibration.ok(), &format!("{BAND_END} ω₀"));
        let amplitude = in_words(study, Quantity::Displacement, response.amplitude);
        let what = EffectWords {
            body: "the belt",
            band: &format!("{BAND_END} ω₀"),
            amplitude: &amplitude,
            residual: &residual,
        };
        let what = what.sentence(response.effect);
        let left = match (response.effect, response.ending) {
            (Effect::Quenches, RunEnding::Reached(Reached::Elsewhere)) => {
                " A slow vibration of that size remains: `thresholds`, `basins` and `bifurcation` classify this \
                 response as vibrating."
            }
            _ => "",
        };
        let (band, cost) = (self.of_the_band(study), self.cost(study));
        format!("Started {from}, {what}.{left}{band}{cost}")
    }

    /// The cost of the dither in a sentence of its own.
    fn cost(&self, study: &BeltStudy) -> String {
        let response = &self.response;
        let loss = self.friction_loss().ok().map(|loss| {
            let change = if loss < 0.0 { "raises" } else { "lowers" };
            format!(
                "{change} the mean friction by {} relative to steady sliding",
                percent(loss.abs())
            )
        });
        let power = response.dither_power.map(|power| {
            let size = in_words(study, Quantity::Power, power.abs());
            if power < 0.0 {
                format!("returns a mean power of {size} to its actuator")
            } else {
                format!("consumes a mean power of {size}")
            }
        });
        let stroke = response.dither_stroke.map(|stroke| {
            let stroke = in_words(study, Quantity::Displacement, stroke);
            let of_one_line = |dither: &Dither| {
                matches!(dither.waveform, Waveform::Sine | Waveform::Triangle | Waveform::Square)
            };
            let several = !study.belt().dithers().iter().all(of_one_line);
            let at = if several { "frequencies" } else { "frequency" };
            format!("needs a peak-to-peak stroke of {stroke} at its {at}")
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

    /// The stroke of the tangential dithers, or why it is unknown; `only_normal` says that no dither is tangential.
    pub(crate) fn dither_stroke(
        &self,
        study: &BeltStudy,
        only_normal: impl FnOnce() -> String,
    ) -> Result<f64, String> {
        self.response.dither_stroke.ok_or_else(|| {
            let measured = stroke_is_measured(study.belt(), study.solver().record_periods);
            measured.err().map_or_else(only_normal, str::to_owned)
        })
    }

    /// Whether both runs have settled, as far as E requires: a run that decays to zero need not settle.
    pub fn settled(&self) -> bool {
        let response = &self.response;
        response.settled && (response.undithered_settled || response.residual_vibration.is_err())
    }

    /// Relative loss of friction, 1 − ⟨f⟩/(μ(v₀)F), compared with undithered steady sliding; negative for a gain.
    ///
    /// # Errors
    /// Why it is undefined.
    pub fn friction_loss(&self) -> Result<f64, String> {
        let response = &self.response;
        if response.effect == Effect::Unknown(Uncertain::NoDither) {
            Err(Uncertain::NoDither.to_string())
        } else if self.moves {
            Ok(1.0 - response.mean_friction / response.steady_sliding_friction)
        } else {
            Err("the belt does not move (v₀ = 0), so there is no steady sliding to compare with"
                .to_owned())
        }
    }

    /// Fraction of the record spent in stick; an elastic slider that adheres counts as sticking.
    ///
    /// # Errors
    /// Bristles never stick.
    pub fn stick_fraction(&self, study: &BeltStudy) -> Result<f64, String> {
        match study.belt().friction().bristles() {
            Some(_) => Err("bristles slip at any load, however slowly, and never stick".to_owned()),
            None => Ok(self.response.stick_fraction),
        }
    }

    /// 20 lg E, in dB; `None` if E is undefined or zero.
    pub fn level(&self) -> Option<f64> {
        self.response.residual_vibration.ok().and_then(level_of)
    }

    /// The levels in the frequency band of the study.
    pub fn in_band(&self, study: &BeltStudy) -> Option<InBand> {
        let band = study.band()?;
        let [low, high] = band;
        let of = |record: &SettledRecord| record.spectrum.root_mean_square(low, high);
        let both = of(&self.response.record).zip(of(&self.response.undithered_record));
        // The window spreads a tone over four lines of the unpadded record.
        let resolved = 4.0 / f64::from(study.solver().record_periods);
        if high - low < resolved {
            let resolved = in_words(study, Quantity::FrequencyRatio, resolved);
            let unit = if study.scales().is_some() { "" } else { " ω₀" };
            let why = format!(
                "the band is narrower than the resolution of the record, {resolved}{unit}; raise solver.record_periods"
            );
            return Some(InBand { band, values: Err(why) });
        }
        let values = both.ok_or_else(|| {
            let last = self.response.record.spectrum.frequencies().last().unwrap_or_default();
            let last = in_words(study, Quantity::FrequencyRatio, last);
            let unit = if study.scales().is_some() { "" } else { " ω₀" };
            format!("the record has no frequencies above {last}{unit}")
        });
        Some(InBand { band, values })
    }

    /// Adds the levels in the band; null without a band.
    fn put_band(&self, study: &BeltStudy, fields: &mut Fields) {
        let band = self.in_band(study);
        let band =
            band.as_ref().ok_or_else(|| "the study does not define a frequency band".to_owned());
        let end = |place: usize| band.clone().map(|band| band.band[place]);
        fields.known("band_from", Quantity::FrequencyRatio, end(0)).known(
            "band_to",
            Quantity::FrequencyRatio,
            end(1),
        );
        let values = band.and_then(|band| band.values.clone());
        let names = [("displacement", Quantity::Displacement), ("velocity", Quantity::Velocity)];
        for (place, (name, quantity)) in names.into_iter().enumerate() {
            let both = values.clone().map(|(with, without)| (with[place], without[place]));
            let (with, without) =
                (both.clone().map(|pair| pair.0), both.clone().map(|pair| pair.1));
            let level = both.and_then(|(with, without)| level(with, without));
            fields
                .known(&format!("band_{name}_rms"), quantity, with)
                .known(&format!("band_undithered_{name}_rms"), quantity, without)
                .known(&format!("band_{name}_level_db"), Quantity::Ratio, level);
        }
    }

    /// The levels in the band in a sentence of its own.
    fn of_the_band(&self, study: &BeltStudy) -> String {
        let Some(InBand { band, values }) = self.in_band(study) else { return String::new() };
        let unit = if study.scales().is_some() { "" } else { " ω₀" };
        let [low, high] = band.map(|end| in_words(study, Quantity::FrequencyRatio, end));
        let levels = values.and_then(|(with, without)| {
            Ok([level(with[0], without[0])?, level(with[1], without[1])?])
        });
        let change = match levels {
            Ok([displacement, velocity]) => {
                let change = |level: f64| {
                    let way = if level > 0.0 { "rises" } else { "falls" };
                    format!("{way} by {}", decibels(level.abs()))
                };
                format!(
                    "the displacement level {} and the velocity level {}",
                    change(displacement),
                    change(velocity)
                )
            }
            Err(why) => format!("the level is undefined: {why}"),
        };
        format!(" From {low}{unit} to {high}{unit} {change}.")
    }

    /// Warnings about the result.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let time = if study.scales().is_some() { "t" } else { "τ" };
        let settle = in_words(study, Quantity::Time, study.solver().settle);
        let mut warnings = self.slip.warnings(study);
        warnings.extend(passivity(study));
        let mut warn = |which: &str, settled: bool| {
            if !settled {
                warnings.push(format!(
                    "the {which} response has not settled after {time} = {settle}: the amplitudes of the two halves of the record differ, or \
                     the mass is still in its first stick; raise solver.settle or solver.record_periods"
                ));
            }
        };
        warn("dithered", self.response.settled);
        // A run that decays to zero need not settle: E is then undefined, with a reason.
        warn(
            "undithered",
            self.response.undithered_settled || self.response.residual_vibration.is_err(),
        );
        warnings.extend(self.longer_cycle.map(|period| {
            let record = TAU * f64::from(study.solver().record_periods);
            let [period, record] =
                [period, record].map(|length| in_words(study, Quantity::Time, length));
            format!(
                "the vibration without dither repeats after {time} = {period}, but the run settles for {settle} and is recorded for \
                 {record}: M₀, E and the friction without dither are those of a part of it; raise solver.settle and solver.record_periods"
            )
        }));
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
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
            "all dither is normal, and a prescribed load has no motion in the normal direction; a system with a normal row and a \
             normal stiffness has power and stroke"
                .to_owned()
        };
        fields
            .known("stick_fraction", Quantity::Ratio, self.stick_fraction(study))
            .known(
                "residual_vibration",
                Quantity::Ratio,
                response.residual_vibration.map_err(|why| why.to_string()),
            )
            .known(
                "level_db",
                Quantity::Ratio,
                self.level().ok_or_else(|| match response.residual_vibration {
                    Ok(_) => "E is zero, which has no level in decibels".to_owned(),
                    Err(why) => why.to_string(),
                }),
            )
            .number("undithered_amplitude", Quantity::Displacement, response.undithered_amplitude);
        self.put_band(study, &mut fields);
        fields
            .plain("settled", response.settled)
            .plain("undithered_settled", response.undithered_settled)
            .number("mean_friction", Quantity::Force, response.mean_friction)
            .number("mean_friction_undithered", Quantity::Force, response.mean_friction_undithered)
            .number("steady_sliding_friction", Quantity::Force, response.steady_sliding_friction)
            .known("friction_loss", Quantity::Ratio, self.friction_loss())
            .known("dither_power", Quantity::Power, response.dither_power.ok_or_else(only_normal))
            .known("dither_stroke", Quantity::Displacement, self.dither_stroke(study, only_normal))
            .number("minimum_normal_load", Quantity::Force, response.minimum_normal_load)
            .number("settle", Quantity::Time, study.solver().settle)
            .number("record_length", Quantity::Time, response.record.length())
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The record of both runs.
    pub fn record(&self, study: &BeltStudy) -> Dataset {
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
    pub fn spectrum(&self, study: &BeltStudy) -> Dataset {
        let (with, without) =
            (&self.response.record.spectrum, &self.response.undithered_record.spectrum);
        Dataset::new(study, "response: spectrum of the displacement")
            .fact("mean removed, Hann window, zero-padded to four times the record length; amplitudes are those of a pure tone")
            .axis("frequency", Quantity::FrequencyRatio, with.frequencies().collect())
            .array("amplitude", Quantity::Displacement, with.amplitudes().to_vec())
            .array("undithered_amplitude", Quantity::Displacement, without.amplitudes().to_vec())
    }
}

/// Levels in a frequency band.
#[derive(Clone, Debug, PartialEq)]
pub struct InBand {
    /// Its ends, in ω₀.
    pub band: [f64; 2],
    /// Root mean square of displacement and velocity, with and without dither; or why they are undefined.
    pub values: Result<([f64; 2], [f64; 2]), String>,
}

/// A change of level in a sentence.
fn decibels(size: f64) -> String {
    if size > MOST_DECIBELS {
        format!("more than {MOST_DECIBELS} dB")
    } else {
        format!("{size:.1} dB")
    }
}

/// 20 lg of two root mean squares, in dB.
fn level(with: f64, without: f64) -> Result<f64, String> {
    if without == 0.0 {
        return Err("nothing vibrates in the band without dither".to_owned());
    }
    if with == 0.0 {
        return Err("nothing vibrates in the band with dither".to_owned());
    }
    Ok(20.0 * (with / without).log10())
}

/// Why the end of a run is unknown.
fn why_end_unknown(ending: RunEnding) -> Option<String> {
    match ending {
        RunEnding::Unknown(why) => Some(why.to_string()),
        RunEnding::Reached(Reached::Unsettled | Reached::Unknown) => {
            Some("the run had not settled within its number of periods".to_owned())
        }
        RunEnding::Reached(Reached::Base | Reached::Forced | Reached::Elsewhere) => None,
    }
}
