//! Runs of a system under noise.

use quell_dynamics::response::{SteadyResponse, UnditheredResponse};
use quell_linear::averaging::DitheredSystem;
use quell_linear::input_cost::noise_input_cost;
use quell_linear::linear_cost::NoiseCost;
use quell_linear::linearised::Linearised;
use quell_model::waveform::Noise;
use quell_model::{Input, System, Waveform};

use super::{NoAveragedGrowth, NoNoiseCost, NoiseResponse, NoisyContact, NoisyRun, number_of_runs};
use crate::complaint::Failure;
use crate::parallel::Parallel;
use crate::run::response::{NoResidualVibration, ResponseRequest, plan_of, refused};
use crate::run::system::has_equations;
use crate::run::system::of_runs::beyond_laws;
use crate::run::system::start::{start_in_words, start_of};
use crate::study::SystemStudy;

/// Measures runs with different seeds.
///
/// # Errors
/// A number of seeds that is not allowed; as [`crate::run::response::run`].
pub fn run(study: &SystemStudy, request: ResponseRequest) -> Result<NoiseResponse, Failure> {
    has_equations(study, "response")?;
    let system = study.system();
    let count = number_of_runs(request.seeds, system.has_noise())?;
    let (start, plan) = (start_of(study)?, plan_of(study, request)?);
    let failed = |why| refused(study, &plan, why);
    let without = UnditheredResponse::new(system, &start, &plan).map_err(failed)?;
    let seeded: Vec<System> = (0..count as u64).map(|by| system.reseeded(by)).collect();
    let found: Vec<Result<(NoisyRun, Vec<f64>), Failure>> = seeded
        .in_parallel(|system| Ok(run_of(system, &without.with_dither(system).map_err(failed)?)))
        .collect();
    let runs: Vec<(NoisyRun, Vec<f64>)> = found.into_iter().collect::<Result<_, _>>()?;
    let largest = |contact: usize| runs.iter().map(|(_, slip)| slip[contact]).fold(0.0, f64::max);
    let mut warnings = study.warnings().to_vec();
    warnings.extend(beyond_laws(study, largest));
    let undithered = without.record();
    Ok(NoiseResponse {
        start: start_in_words(study, &Vec::new()),
        settle: plan.settle,
        length: plan.length,
        band_end: without.band_end(),
        contacts: system.contacts.iter().map(|contact| contact.name.clone()).collect(),
        undithered_amplitude: undithered.lines.whole,
        undithered_friction: undithered.contacts.iter().map(|means| means.friction).collect(),
        costs: costs(system),
        averaged: averaged(system),
        warnings,
        runs: runs.into_iter().map(|(run, _)| run).collect(),
    })
}

/// A run and the largest slip velocity of its contacts.
fn run_of(system: &System, response: &SteadyResponse) -> (NoisyRun, Vec<f64>) {
    let record = &response.dithered;
    let seed = system.waves().find_map(|wave| wave.waveform.noise()).map_or(0, Noise::seed);
    let contacts = record.contacts.iter().map(|means| NoisyContact {
        stick_fraction: means.stick_fraction,
        friction: means.friction,
    });
    let run = NoisyRun {
        seed,
        residual_vibration: response.residual_vibration.map_err(NoResidualVibration),
        amplitude: record.lines.whole,
        settled: response.vibrations.dithered.is_settled(response.vibrations.undithered.whole()),
        contacts: contacts.collect(),
    };
    let slips = (0..system.contacts.len()).map(|contact: usize| record.largest_slip[contact]);
    (run, slips.collect())
}

/// Root mean squares of every dither at its driven point, without the slope of friction.
fn costs(system: &System) -> Vec<Result<NoiseCost, NoNoiseCost>> {
    let sliding = match Linearised::new(system) {
        Ok(sliding) => sliding,
        Err(why) => return vec![Err(why.into()); system.inputs.len()],
    };
    let of = |input: &Input| {
        let [wave] = input.profile.waves() else {
            return Err(NoNoiseCost::NotOneWave);
        };
        if wave.waveform != Waveform::Sine && !wave.waveform.is_sum_of_sines() {
            return Err(NoNoiseCost::NoSines(wave.waveform.name()));
        }
        Ok(noise_input_cost(system, &sliding, &input.target, wave)?)
    };
    system.inputs.iter().map(of).collect()
}

/// The largest growth rate of small slow motions, averaged over the distribution of the noise.
fn averaged(system: &System) -> Result<f64, NoAveragedGrowth> {
    let average = DitheredSystem::new(system).and_then(|prepared| prepared.average());
    Ok(average?.growth()?.rate)
}
