//! The steady response as JSON and as datasets.

use quell_dynamics::motion::{ContactMeans, FedCost, SeriesCost};
use quell_dynamics::response::{Effect, PEAK_FLOOR, SettledRecord, SystemEnding};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::{MeasuredResponse, NoLevel, NoResidualVibration, uncertain};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::effect_words::level_of;
use crate::run::system::attractor::put_quietness;
use crate::run::system::of_runs::put_means;
use crate::run::system::start::start_in_words;
use crate::study::{SystemStudy, UnitSystem};

impl MeasuredResponse {
    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let (units, response) = (study.units(), &self.response);
        let mut fields = Fields::in_units(units);
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        match response.effect {
            Effect::Unknown(why) => fields.plain("effect", "unknown").why("effect", uncertain(why)),
            effect => fields.plain("effect", effect.name()),
        };
        let residual_vibration = response.residual_vibration.map_err(NoResidualVibration);
        let level = residual_vibration.map_err(NoLevel::from);
        let level = level.and_then(|ratio| level_of(ratio).ok_or(NoLevel::Zero));
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
            .plain("settled", self.response.dithered_is_settled())
            .plain("undithered_settled", self.response.undithered_is_settled());
        put_ending(&mut fields, "", &with.ending);
        put_ending(&mut fields, "undithered_", &without.ending);
        let peaks = with.spectrum.peaks(PEAK_FLOOR).into_iter().map(|peak| {
            let mut inner = Fields::in_units(units);
            inner.number("frequency", Quantity::FrequencyRatio, peak.frequency).number(
                "amplitude",
                Quantity::Displacement,
                peak.amplitude,
            );
            inner
        });
        fields.list("peaks", peaks.collect::<Vec<_>>());
        self.put_band(study, &mut fields);
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
            let mut inner = Fields::in_units(study.units());
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
        let times =
            (0..with.samples.len()).map(|number| f64::mul_add(number as f64, with.step, with.from));
        let (length, speed) = (unit(Quantity::Displacement), unit(Quantity::Velocity));
        Dataset::of(&study.into(), "response: record of the observed motion")
            .fact(format!("start: {}", start_in_words(study, &Vec::new())))
            .with_axis(Array::new("time", unit(Quantity::Time), times.collect()))
            .with(Array::new("displacement", length, with.samples.clone()))
            .with(Array::new("velocity", speed, with.rates.clone()))
            .with(Array::new("undithered_displacement", length, without.samples.clone()))
            .with(Array::new("undithered_velocity", speed, without.rates.clone()))
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

/// Adds where a run ends under names with a prefix.
fn put_ending(fields: &mut Fields, prefix: &str, ending: &SystemEnding) {
    let name = |name: &str| format!("{prefix}{name}");
    fields.plain(&name("ends_on"), ending.name());
    let unknown = || ending.why().unwrap_or_else(|| "the run ends on no known motion".to_owned());
    if let Some(why) = ending.why() {
        fields.why(&name("ends_on"), why);
    }
    let period = || "the run was not found to end on a periodic motion".to_owned();
    fields.known(&name("period"), Quantity::Time, ending.period().ok_or_else(period));
    let Some(found) = ending.motion() else {
        fields.unknown(&name("quiet"), unknown()).unknown(&name("base_response"), unknown());
        return;
    };
    put_quietness(fields, prefix, found);
}

/// Adds the measures of a record under names with a prefix.
fn put_record(fields: &mut Fields, prefix: &str, record: &SettledRecord) {
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
fn put_inputs(units: UnitSystem, record: &SettledRecord) -> Vec<Fields> {
    let inputs = record.inputs.iter().map(|cost| {
        let mut inner = Fields::in_units(units);
        let of = |pick: fn(&FedCost) -> f64| {
            cost.fed.as_ref().map(pick).map_err(|why| why.why().to_owned())
        };
        inner.known("power", Quantity::Power, of(|cost| cost.power)).known(
            "stroke",
            Quantity::Displacement,
            of(|cost| cost.stroke),
        );
        let in_series = |pick: fn(&SeriesCost) -> f64| {
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
