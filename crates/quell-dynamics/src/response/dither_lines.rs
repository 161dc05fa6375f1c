//! The lines in which the displacement under a dither is measured, and the stroke that they make together.

use std::f64::consts::TAU;

use quell_model::{Belt, Direction, Dither, Waveform};
use quell_numerics::order::{ascending, ascending_by};

/// Lines whose displacement, that of a free mass, is smaller than this share of the largest are left out: the share of the ninth
/// harmonic under a square.
const LEAST_SHARE: f64 = 1.0 / 729.0;

/// Highest harmonic of the highest frequency that a dither has: the highest that the samples of a record resolve
/// ([`super::samples_per_slow_period`]).
const HIGHEST_HARMONIC: f64 = 7.0;

/// Pieces of a waveform times lines that are looked at: more would take seconds.
const MOST_WORK: f64 = 4e7;

/// Points at which the periodic displacement is evaluated, per period of its highest line: a peak between two of them is at most
/// (π/64)²/2 = 0.12 % higher.
const POINTS: f64 = 64.0;

/// Why the stroke is unknown under noise.
const NOISE: &str =
    "noise has no period: the longer its record, the larger its peak-to-peak displacement";

/// Why the stroke is unknown under a waveform of very many pieces.
const TOO_FINE: &str = "the waveform has too many pieces and too high frequencies for its lines to be separated from other vibration";

/// Why the stroke is unknown in a short record.
const TOO_SHORT: &str = "the record has fewer than four periods of the dither, too few to separate its lines: raise solver.record_periods";

/// Fewest periods of a waveform in a record whose lines a Hann window separates: the width of its main lobe.
const FEWEST_PERIODS: f64 = 4.0;

/// Lines of the dithers of one period, in ascending order.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LineGroup {
    /// The frequency of which all lines are multiples.
    pub(super) repetition: f64,
    /// Their frequencies.
    pub(super) frequencies: Vec<f64>,
}

/// The lines of the tangential dithers of a belt, those with the same period together, for a record of this many slow periods 2π.
///
/// # Errors
/// Why they are unknown.
pub(super) fn groups(belt: &Belt, record_periods: u32) -> Result<Vec<LineGroup>, &'static str> {
    let mut groups: Vec<LineGroup> = Vec::new();
    for dither in belt.dithers_along(Direction::Tangential).filter(|dither| dither.amplitude > 0.0)
    {
        let repetition = dither.repetition_ratio();
        let frequencies = lines(dither)?;
        if frequencies.len() > 1 && f64::from(record_periods) * repetition < FEWEST_PERIODS {
            return Err(TOO_SHORT);
        }
        match groups.iter_mut().find(|group| group.repetition == repetition) {
            Some(group) => group.frequencies.extend(frequencies),
            None => groups.push(LineGroup { repetition, frequencies }),
        }
    }
    for group in &mut groups {
        ascending(&mut group.frequencies);
        group.frequencies.dedup();
    }
    ascending_by(&mut groups, |a| a.repetition);
    Ok(groups)
}

/// Whether a record of so many slow periods gives the stroke of the tangential dithers of a belt.
///
/// # Errors
/// Why it does not.
pub fn stroke_is_measured(belt: &Belt, record_periods: u32) -> Result<(), &'static str> {
    groups(belt, record_periods).map(|_| ())
}

/// Frequencies of the lines of a dither: its own of the waveforms of the dissertation, of others all that move a mass noticeably.
///
/// # Errors
/// Why they are unknown.
fn lines(dither: &Dither) -> Result<Vec<f64>, &'static str> {
    let waveform = &dither.waveform;
    match waveform {
        Waveform::Sine | Waveform::Triangle | Waveform::Square => {
            return Ok(vec![dither.frequency_ratio]);
        }
        Waveform::Noise(_) => return Err(NOISE),
        Waveform::Fourier(_) | Waveform::Samples(_) | Waveform::Burst(_) => {}
    }
    let repetition = dither.repetition_ratio();
    let highest = (HIGHEST_HARMONIC * dither.resolved_ratio() / repetition).ceil();
    if highest * waveform.pieces().len().max(1) as f64 > MOST_WORK {
        return Err(TOO_FINE);
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let highest = highest as u32;
    let displacements: Vec<f64> = (1..=highest)
        .map(|order| {
            let [cosine, sine] = waveform.fourier_coefficient(order);
            libm::hypot(cosine, sine) / f64::from(order).powi(2)
        })
        .collect();
    let least = LEAST_SHARE * displacements.iter().copied().fold(0.0, f64::max);
    let orders = (1..=highest).zip(displacements);
    Ok(orders
        .filter(|(_, size)| *size >= least && *size > 0.0)
        .map(|(order, _)| repetition * f64::from(order))
        .collect())
}

/// Peak-to-peak value over one period of Σ a cos ωt + b sin ωt, given [ω, a, b] of each line.
pub(super) fn peak_to_peak(repetition: f64, lines: &[[f64; 3]]) -> f64 {
    if let [[_, cosine, sine]] = lines {
        return 2.0 * libm::hypot(*cosine, *sine);
    }
    let Some([highest, ..]) = lines.last() else { return 0.0 };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let points = (POINTS * highest / repetition).ceil() as u32;
    let value = |point: u32| {
        let time = TAU / repetition * f64::from(point) / f64::from(points);
        let terms = lines.iter().map(|[rate, cosine, sine]| {
            let (s, c) = libm::sincos(rate * time);
            cosine * c + sine * s
        });
        terms.sum::<f64>()
    };
    let range =
        (0..points).map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| {
            (least.min(value), most.max(value))
        });
    range.1 - range.0
}
