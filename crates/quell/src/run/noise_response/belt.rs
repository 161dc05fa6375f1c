//! Runs of a belt under noise.

use quell_dynamics::response::{BAND_END, Compared, Observables, ResponseCase, compare_many};
use quell_linear::averaging::{Averaging, criterion};
use quell_linear::growth::of_criterion;
use quell_linear::linear_cost::{NoiseCost, noise_cost};
use quell_model::waveform::Noise;
use quell_model::{Belt, Direction, Waveform};

use super::{NoiseResponse, NoisyContact, NoisyRun, number_of_runs};
use crate::complaint::Failure;
use crate::contact_state::complaint_of_belt;
use crate::parallel::Parallel;
use crate::range;
use crate::run::{failed, start};
use crate::study::BeltStudy;
use crate::words::start_in_words;

/// Runs of one work item: as many as fit into the lanes of a processor.
const ABREAST: usize = 8;

/// Measures runs of a belt with `seeds` different seeds.
///
/// # Errors
/// A number of seeds that is not allowed; a contact with a state; as [`crate::run::response::run`].
pub fn of_belt(study: &BeltStudy, seeds: Option<usize>) -> Result<NoiseResponse, Failure> {
    let belt = study.belt();
    let is_noise = belt.dithers().iter().any(|dither| !dither.waveform.is_periodic());
    let count = number_of_runs(seeds, is_noise)?;
    if let Some(complaint) = complaint_of_belt(belt, "response") {
        return Err(complaint.into());
    }
    let start = start(study)?;
    let cases: Vec<ResponseCase> =
        (0..count as u64).map(|by| ResponseCase { belt: belt.reseeded(by), start }).collect();
    // The power of noise is that of its linear response; the stroke has no largest value.
    let observables = Observables { dither_cost: false };
    let abreast: Vec<&[ResponseCase]> = cases.chunks(ABREAST).collect();
    let compared = |cases: &&[ResponseCase]| compare_many(cases, study.solver(), observables);
    let found: Vec<Result<Compared, _>> = abreast.in_parallel(compared).flatten().collect();
    let found: Vec<Compared> = found.into_iter().collect::<Result<_, _>>().map_err(failed)?;
    let runs = found.iter().zip(&cases).map(|(run, case)| {
        let first = case.belt.dithers().iter().find_map(|dither| dither.waveform.noise());
        NoisyRun {
            seed: first.map_or(0, Noise::seed),
            residual_vibration: run.residual_vibration().map_err(|why| why.to_string()),
            amplitude: run.dithered.lines.whole,
            settled: run.settled(),
            contacts: vec![NoisyContact {
                stick_fraction: run.dithered.stick_fraction,
                friction: run.dithered.mean_friction,
            }],
        }
    });
    let runs: Vec<NoisyRun> = runs.collect();
    // Without dither all runs are one.
    let undithered = &found[0].undithered;
    let averaged = criterion(belt, Averaging::FiniteR);
    Ok(NoiseResponse {
        start: start_in_words(study),
        clock: if study.scales().is_some() { "t" } else { "τ" },
        longer: "solver.record_periods",
        settle: study.solver().settle,
        length: std::f64::consts::TAU * f64::from(study.solver().record_periods),
        band_end: BAND_END,
        contacts: vec!["belt".to_owned()],
        undithered_amplitude: undithered.lines.whole,
        undithered_friction: vec![undithered.mean_friction],
        costs: vec![cost(belt)],
        averaged: averaged.map(|found| of_criterion(found.value)).map_err(|why| why.to_string()),
        warnings: range::averaged(study),
        runs,
    })
}

/// Root mean squares under all tangential dithers, whose lines are independent.
fn cost(belt: &Belt) -> Result<NoiseCost, String> {
    let mut sum = NoiseCost { force: 0.0, displacement: 0.0, velocity: 0.0, power: 0.0 };
    let mut any = false;
    for dither in belt.dithers_along(Direction::Tangential) {
        if dither.waveform != Waveform::Sine && !dither.waveform.is_sum_of_sines() {
            let name = dither.waveform.name();
            return Err(format!("it is computed for sums of sines, and a dither is a \"{name}\""));
        }
        let own = noise_cost(dither, belt.damping_ratio()).map_err(|why| why.to_string())?;
        let add = |all: f64, own: f64| all.hypot(own);
        sum = NoiseCost {
            force: add(sum.force, own.force),
            displacement: add(sum.displacement, own.displacement),
            velocity: add(sum.velocity, own.velocity),
            power: sum.power + own.power,
        };
        any = true;
    }
    if any { Ok(sum) } else { Err("all dither is normal".to_owned()) }
}
