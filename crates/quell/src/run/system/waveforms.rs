//! `waveforms` of a system: the least first dither of each waveform that quenches by averaging, and its cost.
//!
//! The cost is that of the sliding structure without the slope of friction ([`quell_linear::input_cost`]) at the driven point, exact
//! for every waveform: the stroke of bᵀq, the largest velocity, and the mean power ⟨u bᵀq̇⟩ of a force b u(t).

use quell_linear::averaging::{Becomes, DitheredSystem};
use quell_linear::growth::Verdict;
use quell_linear::input_cost::input_cost;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_model::System;
use quell_model::profile::{Profile, Wave};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::modes::natural;
use super::stability::FAR;
use super::{failed, has_equations, in_units};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::{averaged_without_states, averages_are_a_start, passivity_of_system};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::parallel::Parallel;
use crate::run::waveforms::{
    Candidates, ComparedWaveform, LeastDither, NoAveragedDither, WaveformComparison, WaveformCost,
    duty_cycle, exact_of_system, in_the_band, searched,
};
use crate::study::SystemStudy;
use quell_dynamics::response::dither_reaches_the_band;

/// Compares waveforms of the first dither of a system.
///
/// # Errors
/// A complaint about a study without dither; [`Failure::Failed`] without steady sliding.
pub fn run(study: &SystemStudy) -> Result<WaveformComparison, Failure> {
    has_equations(study, "waveforms")?;
    let system = study.system();
    let first = system.inputs.first().and_then(|input| input.profile.waves().first());
    let Some(first) = first else {
        let allowed =
            "given: waveforms are compared at the place and the frequency of the study's dither";
        return Err(
            Complaint::new(Fault::Missing, "dither", Origin::Whole, Json::Null, allowed).into()
        );
    };
    let sliding = Linearised::new(system).map_err(|why| failed("waveforms", why))?;
    let Candidates { waveforms, carrier } = Candidates::beside(&first.waveform);
    let motions =
        spectrum(&sliding, &sliding.friction()).map_err(|why| failed("waveforms", why))?;
    let highest = motions.motions.iter().map(natural).fold(0.0, f64::max);
    let rows = waveforms.in_parallel(|waveform| {
        let wave = Wave { waveform: waveform.clone(), amplitude: 1.0, ..first.clone() };
        let acting = |amplitude: f64| with_wave(system, &Wave { amplitude, ..wave.clone() });
        let unit = acting(1.0);
        let prepared = DitheredSystem::new(&unit).map_err(NoAveragedDither::unknown);
        let averaged =
            prepared.as_ref().map_err(Clone::clone).and_then(|known| least(known, &wave));
        let without_state = prepared.as_ref().ok().zip(averaged.as_ref().ok());
        let without_state = without_state.and_then(|(prepared, least)| {
            let average = prepared.average_with(Some((0, least.amplitude))).ok()?;
            averaged_without_states(&unit, &average.contacts).into_iter().next()
        });
        let cost = input_cost(&unit, &sliding, &unit.inputs[0].target, &wave);
        let cost = cost.map_err(|why| why.to_string());
        ComparedWaveform {
            own: *waveform == first.waveform,
            duty_cycle: duty_cycle(waveform),
            slow: wave.repetition() < FAR * highest,
            exact: prepared
                .as_ref()
                .map_err(ToString::to_string)
                .and_then(|prepared| exact(prepared, &averaged, &acting)),
            averaged: averaged.map_err(|why| why.to_string()),
            unit: WaveformCost {
                root_mean_square: waveform.root_mean_square(),
                stroke: cost.clone().map(|cost| cost.stroke),
                velocity: cost.clone().map(|cost| cost.velocity),
                power: cost.map(|cost| cost.power),
            },
            without_state,
            waveform: waveform.clone(),
        }
    });
    Ok(WaveformComparison { rows: rows.collect(), carrier })
}

/// The system with this wave as its first dither.
fn with_wave(system: &System, wave: &Wave) -> System {
    let mut changed = system.clone();
    let input = &mut changed.inputs[0];
    input.profile = Profile::constant(input.profile.mean()).with(wave.clone());
    changed
}

/// The exact least amplitude of a system.
fn exact(
    prepared: &DitheredSystem<'_>,
    averaged: &Result<LeastDither, NoAveragedDither>,
    acting: &(dyn Fn(f64) -> System + Sync),
) -> Result<f64, String> {
    if dither_reaches_the_band(&acting(1.0)) {
        return Err(in_the_band());
    }
    let closed = |amplitude: f64| {
        prepared.average_with(Some((0, amplitude))).is_ok_and(|average| {
            average.contacts.iter().all(|contact| contact.normal_load > contact.load_amplitude)
        })
    };
    let loads: f64 = acting(0.0).contacts.iter().map(|contact| contact.normal_load.abs()).sum();
    // About an averaged amplitude a contact may open for a part of the period.
    let is_allowed = |amplitude: f64| averaged.is_ok() || closed(amplitude);
    let range = searched(averaged, loads, is_allowed)?;
    let at = |values: &[f64]| -> Result<System, String> { Ok(acting(values[0])) };
    exact_of_system(&at, range)
}

/// The least first dither of a system by averaging.
fn least(prepared: &DitheredSystem<'_>, wave: &Wave) -> Result<LeastDither, NoAveragedDither> {
    let without = prepared.average_with(Some((0, 0.0))).map_err(NoAveragedDither::unknown)?;
    let growth = without.growth().map_err(NoAveragedDither::unknown)?;
    if growth.verdict() == Verdict::Stable {
        return Err(NoAveragedDither::Quiet);
    }
    let found = prepared.critical_amplitudes(0).map_err(NoAveragedDither::unknown)?;
    let place = found.iter().position(|critical| critical.becomes == Becomes::Stable);
    let place = place.ok_or(NoAveragedDither::Never)?;
    if !found[place].contacts_stay_closed {
        return Err(NoAveragedDither::Opens);
    }
    let amplitude = found[place].amplitude;
    Ok(LeastDither {
        amplitude_ratio: amplitude / wave.frequency,
        amplitude,
        until: found[place..]
            .iter()
            .find(|critical| critical.becomes == Becomes::Unstable)
            .map(|critical| critical.amplitude),
    })
}

impl WaveformComparison {
    /// The result of a system in a few sentences.
    pub fn of_system_in_words(&self, study: &SystemStudy) -> String {
        let force = |value: f64| in_units(study.units(), Quantity::Force, value);
        self.sentence(force, "steady sliding")
    }

    /// The comparison of a system as JSON.
    pub fn json_of_system(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::of_system(study.units());
        fields.plain("ok", true).plain("sentence", self.of_system_in_words(study));
        self.put_rows(
            &mut fields,
            || Fields::of_system(study.units()),
            |row, inner| {
                inner.plain("slow", row.slow);
            },
        );
        fields.plain("warnings", self.warnings_about_system(study));
        fields.finish()
    }

    /// The warnings of the study, and one about waveforms whose repetition is not fast.
    pub fn warnings_about_system(&self, study: &SystemStudy) -> Vec<String> {
        let mut warnings = study.warnings().to_vec();
        warnings.extend(passivity_of_system(study));
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

    /// The comparison of a system as a dataset: one row for each waveform.
    pub fn dataset_of_system(&self, study: &SystemStudy) -> Dataset {
        let dataset = self.named_rows(Dataset::of(&study.into(), "waveforms"));
        self.arrays().into_iter().fold(dataset, |dataset, (name, quantity, values)| {
            let unit = study.units().unit(quantity).unwrap_or("1");
            dataset.with(Array::new(&name, unit, values))
        })
    }
}
