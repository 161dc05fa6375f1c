//! The comparison of waveforms as JSON, warnings and a dataset.

use quell_model::Waveform;
use quell_model::units::{Quantity, UnitSystem};
use serde_json::Value as Json;

use super::{COLUMNS, ComparedWaveform, LeastDither, NoLeastDither, WaveformComparison};
use crate::contact_state::averages_are_a_start;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::reasons::reasons;
use crate::run::stability::FAR;
use crate::study::SystemStudy;

reasons! {
    /// Why a range of quiet amplitudes has no end.
    enum NoUpperEnd {
        /// No amplitude is quiet.
        NoLeast(NoLeastDither),
        ;
        /// All larger ones are, by averaging.
        ByAveraging => "no larger amplitude makes it unstable again by averaging",
        /// All larger ones are that were searched.
        UpToLimit => "no larger amplitude makes it unstable again up to the limit of the search",
    }
}

/// The amplitude at which a range of quiet amplitudes ends, or why it has no value.
fn until(
    found: &Result<LeastDither, NoLeastDither>,
    without: NoUpperEnd,
) -> Result<f64, NoUpperEnd> {
    found.clone()?.until.ok_or(without)
}

impl WaveformComparison {
    /// The comparison as JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::in_units(study.units());
        fields.plain("ok", true).plain("sentence", self.sentence(study));
        self.put_rows(&mut fields, study.units());
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The warnings of the study, and one about waveforms whose repetition is not fast.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let mut warnings = study.warnings().to_vec();
        let because = self.rows.iter().find_map(|row| row.without_state.as_deref());
        warnings.extend(because.map(averages_are_a_start));
        let slow: Vec<String> =
            self.rows.iter().filter(|row| row.slow).map(ComparedWaveform::label).collect();
        if !slow.is_empty() {
            warnings.push(format!(
                "{} repeat{} at less than {FAR} times the highest eigenfrequency of the sliding structure: averaging assumes that a \
                 dither is much faster than every motion, and the least amplitude by averaging there is that of a resonance; only exact \
                 amplitudes rank {}",
                slow.join(", "),
                if slow.len() == 1 { "s" } else { "" },
                if slow.len() == 1 { "it" } else { "them" }
            ));
        }
        warnings
    }

    /// The comparison as a dataset: one row for each waveform.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let dataset = self.named_rows(Dataset::of(&study.into(), "waveforms"));
        self.arrays().into_iter().fold(dataset, |dataset, (name, quantity, values)| {
            let unit = study.units().unit(quantity).unwrap_or("1");
            dataset.with(Array::new(&name, unit, values))
        })
    }

    /// Puts the rows and the best of each column.
    fn put_rows(&self, fields: &mut Fields, units: UnitSystem) {
        let empty = || Fields::in_units(units);
        let rows = self.rows.iter().map(|row| {
            let mut inner = empty();
            inner
                .plain("waveform", row.waveform.name())
                .plain("label", row.label())
                .plain("own", row.own)
                .plain("slow", row.slow)
                .number("duty_cycle", Quantity::Ratio, row.duty_cycle);
            if let Waveform::Burst(burst) = &row.waveform {
                inner.plain("on", burst.on()).plain("off", burst.off());
            }
            for column in &COLUMNS {
                inner.known(column.name, column.quantity, row.averaged_value(column));
            }
            inner.known("until", Quantity::Force, until(&row.averaged, NoUpperEnd::ByAveraging));
            for column in &COLUMNS {
                let name = format!("exact_{}", column.name);
                inner.known(&name, column.quantity, row.exact_value(column));
            }
            let exact_until = until(&row.exact, NoUpperEnd::UpToLimit);
            inner.known("exact_until", Quantity::Force, exact_until);
            inner
        });
        fields.plain("carrier", self.carrier).plain("ranked_by", self.ranked_by().name());
        fields.list("waveforms", rows.collect::<Vec<_>>());
        let mut best = empty();
        for column in &COLUMNS {
            let row = self.best(column).map(ComparedWaveform::label);
            best.known_plain(column.name, row.ok_or("no waveform that is ranked has a value"));
        }
        fields.nested("best", best);
    }

    /// Names of the waveforms along the axis of a dataset.
    fn named_rows(&self, dataset: Dataset) -> Dataset {
        let numbers = (0..self.rows.len()).map(|number| number as f64).collect();
        let names: Vec<(u8, &'static str)> =
            (0_u8..).zip(Waveform::NAMES.iter().copied()).collect();
        let code = |row: &ComparedWaveform| {
            names.iter().find(|(_, name)| *name == row.waveform.name()).map_or(0, |(code, _)| *code)
        };
        let codes: Vec<u8> = self.rows.iter().map(code).collect();
        let dataset = dataset.with_axis(Array::new("number", "1", numbers));
        dataset.with(Array::of_words("waveform", names, &codes))
    }

    /// The arrays of a dataset: duty cycle, the quantities by averaging, and the exact amplitude.
    fn arrays(&self) -> Vec<(String, Quantity, Vec<f64>)> {
        let each = |of: &dyn Fn(&ComparedWaveform) -> Option<f64>| -> Vec<f64> {
            self.rows.iter().map(|row| of(row).unwrap_or(f64::NAN)).collect()
        };
        let duty = ("duty_cycle".to_owned(), Quantity::Ratio, each(&|row| Some(row.duty_cycle)));
        let averaged = COLUMNS.iter().map(|column| {
            (column.name.to_owned(), column.quantity, each(&|row| row.averaged_value(column).ok()))
        });
        let exact = ("exact_amplitude".to_owned(), Quantity::Force, {
            each(&|row| Some(row.exact.as_ref().ok()?.amplitude))
        });
        [duty].into_iter().chain(averaged).chain([exact]).collect()
    }
}
