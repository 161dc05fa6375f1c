//! The kinds of study that a design is for: their units, their numbers and their equations.

use std::f64::consts::TAU;

use quell_design::actuator::Actuator;
use quell_linear::averaging::DitheredSystem;
use quell_model::disc::DiscDither;
use quell_model::units::Quantity;
use quell_model::{RefusedNumbers, System, Waveform};
use serde_json::Value as Json;

use super::slow_response::{self, SlowResponse};
use super::unknown::NoSlowResponse;
use super::waveform::system_with_waveform;
use crate::disc_units::DiscUnits;
use crate::fields::Fields;
use crate::range::outside_of_laws;
use crate::run::system::in_units;
use crate::study::{Design, DiscStudy, SystemStudy, Uncertainty, UnitSystem};
use crate::words::digits;

/// A study with a design: its units and what it requests.
pub trait StudyWithDesign: Sync {
    /// The table `[design]`.
    fn asked(&self) -> Option<&Design>;

    /// The table `[actuator]`.
    fn actuator(&self) -> Option<&Actuator>;

    /// An empty answer in the units of the study.
    fn fields(&self) -> Fields;

    /// A quantity of the equations with its unit.
    fn in_words(&self, quantity: Quantity, value: f64) -> String;

    /// How frequencies are written.
    fn frequency_scale(&self) -> FrequencyScale;

    /// The quantity of the amplitude that is chosen.
    fn quantity_of_amplitude(&self) -> Quantity {
        Quantity::Force
    }

    /// What a growth rate of one is in the units of the study, and that unit.
    fn unit_of_growth(&self) -> (f64, &'static str) {
        (1.0, "ω_ref")
    }

    /// The document of the study after its changes.
    fn document(&self) -> Json;

    /// The number at a path, in the unit of its key; `None` where the study has none there.
    fn number_at(&self, path: &str) -> Option<f64>;

    /// The unit of the number at a path; `1` without a unit.
    fn unit_at(&self, path: &str) -> String;

    /// The equations with numbers set in order as by `--set`, and another waveform of the dither that is designed.
    ///
    /// # Errors
    /// Why the study cannot take these numbers, or has no equations of motion.
    fn system_with(
        &self,
        waveform: &Waveform,
        numbers: &[(&str, f64)],
    ) -> Result<System, RefusedNumbers>;

    /// Warnings where slip leaves the range of a friction law by averaging, with numbers set in order as by `--set` and another waveform
    /// of the dither that is designed. None where averaging has no answer.
    fn beyond_laws(&self, waveform: &Waveform, numbers: &[(&str, f64)]) -> Vec<String> {
        let Ok(system) = self.system_with(waveform, numbers) else { return Vec::new() };
        let average = DitheredSystem::new(&system).and_then(|prepared| prepared.average());
        let words = |speed| self.in_words(Quantity::Velocity, speed);
        average.map_or_else(
            |_| Vec::new(),
            |found| outside_of_laws(&system, words, Some(&found.contacts)),
        )
    }

    /// The response to a dither that repeats in the band of the vibration, on the base response, with numbers set in order as by `--set` and
    /// another waveform of the dither that is designed.
    ///
    /// # Errors
    /// Why it is unknown.
    fn slow_response(
        &self,
        waveform: &Waveform,
        numbers: &[(&str, f64)],
    ) -> Result<SlowResponse, NoSlowResponse>;

    /// The uncertain numbers.
    fn uncertain(&self) -> Option<&Uncertainty>;

    /// What a reader of the answer must know about the dither of the study.
    fn warnings_about_design(&self) -> Vec<String> {
        Vec::new()
    }
}

/// How frequencies of a study are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrequencyScale {
    /// Of one in the equations.
    pub factor: f64,
    /// The unit after a number, with a space; empty for a pure number.
    pub unit: &'static str,
    /// What the number is called.
    pub noun: &'static str,
}

impl FrequencyScale {
    /// In hertz, where a frequency of the equations has a value in hertz.
    fn new(hertz: Option<f64>, noun: &'static str) -> Self {
        match hertz {
            Some(factor) => Self { factor, unit: " Hz", noun: "frequency" },
            None => Self { factor: 1.0, unit: "", noun },
        }
    }

    /// A frequency of the equations.
    pub fn of(self, frequency: f64) -> f64 {
        self.factor * frequency
    }

    /// With its unit.
    pub(crate) fn with_unit(self, frequency: f64) -> String {
        format!("{}{}", digits(self.of(frequency)), self.unit)
    }

    /// With its unit, or with a noun where it has none.
    pub(crate) fn with_noun(self, frequency: f64) -> String {
        if self.unit.is_empty() {
            format!("the {} {}", self.noun, self.with_unit(frequency))
        } else {
            self.with_unit(frequency)
        }
    }
}

impl StudyWithDesign for SystemStudy {
    fn slow_response(
        &self,
        waveform: &Waveform,
        numbers: &[(&str, f64)],
    ) -> Result<SlowResponse, NoSlowResponse> {
        slow_response::found(self, &self.system_with(waveform, numbers)?)
    }

    fn uncertain(&self) -> Option<&Uncertainty> {
        self.uncertainty()
    }

    fn actuator(&self) -> Option<&Actuator> {
        self.actuator()
    }

    fn asked(&self) -> Option<&Design> {
        self.design()
    }

    fn fields(&self) -> Fields {
        Fields::in_units(self.units())
    }

    fn in_words(&self, quantity: Quantity, value: f64) -> String {
        in_units(self.units(), quantity, value)
    }

    fn frequency_scale(&self) -> FrequencyScale {
        let hertz = (self.units() != UnitSystem::None).then_some(1.0 / TAU);
        FrequencyScale::new(hertz, "angular frequency")
    }

    fn document(&self) -> Json {
        Self::document(self)
    }

    fn number_at(&self, path: &str) -> Option<f64> {
        self.number(path)
    }

    fn unit_at(&self, path: &str) -> String {
        self.unit_of(path).unwrap_or("1").to_owned()
    }

    fn system_with(
        &self,
        waveform: &Waveform,
        numbers: &[(&str, f64)],
    ) -> Result<System, RefusedNumbers> {
        let amplitude = self
            .asked()
            .and_then(|asked| asked.vary.iter().find_map(|range| self.dither_of(&range.path)));
        let model = self.model();
        let numbers = model.numbers(numbers).map_err(RefusedNumbers::by_study)?;
        let system = model.at(&numbers).map_err(RefusedNumbers::by_study)?;
        Ok(system_with_waveform(system, amplitude.unwrap_or(0), waveform))
    }
}

impl StudyWithDesign for DiscStudy {
    fn slow_response(
        &self,
        _: &Waveform,
        _: &[(&str, f64)],
    ) -> Result<SlowResponse, NoSlowResponse> {
        Err(NoSlowResponse::OfDisc)
    }

    fn uncertain(&self) -> Option<&Uncertainty> {
        self.uncertainty()
    }

    fn actuator(&self) -> Option<&Actuator> {
        self.actuator()
    }

    fn asked(&self) -> Option<&Design> {
        self.design()
    }

    /// The amplitude is relative to the friction, and has no SI value.
    fn fields(&self) -> Fields {
        Fields::new()
    }

    fn in_words(&self, _: Quantity, value: f64) -> String {
        digits(value)
    }

    fn frequency_scale(&self) -> FrequencyScale {
        FrequencyScale::new(None, "frequency ratio")
    }

    fn unit_of_growth(&self) -> (f64, &'static str) {
        let own = "ω_ref";
        DiscUnits::of(self).and_then(|units| units.one("growth", own)).unwrap_or((1.0, own))
    }

    fn quantity_of_amplitude(&self) -> Quantity {
        Quantity::Ratio
    }

    fn warnings_about_design(&self) -> Vec<String> {
        match self.disc().dither() {
            DiscDither::None | DiscDither::Normal { .. } => Vec::new(),
            DiscDither::Tangential { .. } => vec![
                "tangential dither removes the mean friction at every amplitude: dither.amplitude is that of the force that remains, \
                 not of an actuator, and its least value is the quietest; disc.load.slip_ratio gives the force that an actuator needs"
                    .to_owned(),
            ],
        }
    }

    fn document(&self) -> Json {
        Self::document(self)
    }

    fn number_at(&self, _: &str) -> Option<f64> {
        None
    }

    fn unit_at(&self, _: &str) -> String {
        "1".to_owned()
    }

    fn system_with(&self, _: &Waveform, _: &[(&str, f64)]) -> Result<System, RefusedNumbers> {
        let why = "derivatives are computed of belts and systems, whose thresholds are those of periodic motions";
        Err(RefusedNumbers::by_study(why))
    }
}
