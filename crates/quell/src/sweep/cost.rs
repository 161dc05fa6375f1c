//! A rough estimate of the cost of a point of a map, which determines the size of a chunk.
//!
//! The estimate depends on the study alone: times measured on one core of a common machine, scaled
//! with the amount of work. It need not be accurate, but it must be the same on every machine.

use quell_model::Direction;

use super::evaluate::Computation;
use crate::study::{BeltStudy, DiscStudy};

/// Seconds of one dither period with events.
const PERIOD: f64 = 1e-6;

/// Seconds of one slow period without dither.
const SLOW_PERIOD: f64 = 3e-6;

/// Cost of a response including the end of its run, relative to the response alone.
const SETTLING: f64 = 2.0;

/// Cost of a response one at a time, with the means over a period of the motion on which its run ends, relative to one of many.
const ALONE: f64 = 8.0;

/// Cost of a run of a belt whose contact has a state, by the engine for systems and one at a time, relative to that of a rigid one.
const WITH_STATE: f64 = 10.0;

/// Seconds of one sample of a record that is observed but not stored.
const SAMPLE: f64 = 5e-8;

/// Seconds of one averaged criterion in closed form.
const CLOSED_FORM: f64 = 1e-6;

/// Seconds of one averaged criterion by quadrature.
const QUADRATURE: f64 = 4e-4;

/// Evaluations of the criterion in a search for critical amplitudes.
const SEARCH: f64 = 100.0;

/// Seconds in which the base response of a belt is followed over the amplitude of a dither.
const QUENCH: f64 = 1e-2;

/// Minimum seconds to set up and store a point.
const POINT: f64 = 2e-5;

/// Minimum number of chunks that a map should have: four for each of 32 threads.
const CHUNKS: f64 = 128.0;

/// Maximum seconds of a chunk: the work that an interruption may lose.
const LONGEST: f64 = 2.0;

/// Minimum seconds of a chunk: below, files cost more than points.
const SHORTEST: f64 = 0.05;

/// Number of points of a chunk that fills the SIMD lanes of the engine; fewer if they would take longer than a
/// chunk should.
const LANES_FULL: f64 = 64.0;

/// Maximum number of points of a chunk.
const MOST: f64 = 65_536.0;

/// Seconds of one point of a map of belts.
pub(super) fn of_belt(study: &BeltStudy, wanted: &[Computation]) -> f64 {
    let each = wanted.iter().map(|computation| match computation {
        Computation::Response => response(study),
        Computation::ResponseWithEffect => SETTLING * response(study),
        Computation::ResponseWithCost => ALONE * response(study),
        Computation::Criterion => criterion(study, true),
        Computation::LimitCriterion => criterion(study, false),
        Computation::CriticalAmplitudes => SEARCH * criterion(study, true),
        Computation::LimitCriticalAmplitudes => SEARCH * criterion(study, false),
        Computation::Quench => QUENCH + SEARCH * criterion(study, true),
        Computation::DiscGrowth
        | Computation::DiscGrowthUndithered
        | Computation::SystemGrowth
        | Computation::SystemGrowthUndithered
        | Computation::SystemCritical
        | Computation::SystemQuench
        | Computation::SystemOrbit
        | Computation::SystemEnd
        | Computation::SystemResponse => 0.0,
    });
    POINT + each.sum::<f64>()
}

/// Seconds of one point of a map of discs.
pub(super) fn of_disc(study: &DiscStudy, wanted: &[Computation]) -> f64 {
    POINT + wanted.len() as f64 * exponents(study)
}

/// Seconds of the exponents of a disc: 25 µs for ten states, growing slightly slower than their cube.
fn exponents(study: &DiscStudy) -> f64 {
    let states = 2.0 * study.disc().coordinates() as f64;
    2.5e-5 * (states / 10.0).powi(2).max(0.1)
}

fn response(study: &BeltStudy) -> f64 {
    let fastest = study
        .belt()
        .dithers()
        .iter()
        .filter(|dither| dither.amplitude > 0.0)
        .fold(0.0_f64, |rate, dither| rate.max(dither.frequency_ratio));
    let solver = study.solver();
    let record = f64::from(solver.record_periods);
    let periods = solver.settle / std::f64::consts::TAU + record;
    let samples = record * (16.0 * fastest).max(128.0);
    let engine = if study.belt().has_contact_state() { WITH_STATE } else { 1.0 };
    engine * periods * (fastest * PERIOD + 2.0 * SLOW_PERIOD) + 2.0 * samples * SAMPLE
}

fn criterion(study: &BeltStudy, finite_r: bool) -> f64 {
    let belt = study.belt();
    let normal = belt.dithers().iter().any(|dither| dither.direction == Direction::Normal);
    match belt.dithers().len() {
        0 => CLOSED_FORM,
        1 if !(normal && finite_r) => CLOSED_FORM,
        dithers => QUADRATURE * 30_f64.powi(i32::try_from(dithers).unwrap_or(4).min(4) - 1),
    }
}

/// Number of points of a chunk, for a map of `points` points that take `seconds` each.
pub(super) fn points_per_chunk(points: usize, seconds: f64) -> usize {
    let chunk = (points as f64 * seconds / CHUNKS).clamp(SHORTEST, LONGEST);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 1 and MOST"
    )]
    let most = (chunk / seconds).max(LANES_FULL.min(LONGEST / seconds)).clamp(1.0, MOST) as usize;
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_are_many_where_points_are_dear_and_few_where_they_are_cheap() {
        // 40 000 points of 10 ms: 200 points take two seconds.
        assert_eq!(points_per_chunk(40_000, 0.01), 200);
        // 1000 points of 10 ms: enough to fill the lanes, although that gives few chunks.
        assert_eq!(points_per_chunk(1000, 0.01), 64);
        // 1000 points of 0.1 s: two seconds.
        assert_eq!(points_per_chunk(1000, 0.1), 20);
        // Points that each take longer than a chunk should.
        assert_eq!(points_per_chunk(10, 100.0), 1);
        // 1000 points of 20 µs: one chunk.
        assert!(points_per_chunk(1000, 2e-5) >= 1000);
    }
}
