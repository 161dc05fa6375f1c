//! Where the search of a free decay begins.
//!
//! The frequency is that of the largest line of the spectrum. Over each half period the record is fitted by a sine, a cosine and a
//! constant, whose amplitude Aₖ is that of the envelope. Viscous damping gives ln Aₖ = a − ζω tₖ (the logarithmic decrement), friction
//! Aₖ = a − (2d ω/π) tₖ. These are only starts.

use std::f64::consts::PI;

use quell_model::RecordedQuantity;
use quell_numerics::interval::RealInterval;
use quell_numerics::least_squares::least_squares;
use quell_numerics::spectrum::Spectrum;

use super::motion::{DECAY_PARAMETERS, FreeVibration, readings};

/// Amplitudes below this share of the largest are not used: noise, and rest after friction.
const VISIBLE: f64 = 0.1;

/// Least number of samples in a half period: a sine, a cosine and a constant.
const LEAST_SAMPLES: usize = 4;

/// Damping ratios of a start: those of a record in which several periods are visible.
const DAMPING: RealInterval = RealInterval::new(0.0, 0.3);

/// Periods at the beginning that give the first state.
const FIRST: f64 = 1.5;

/// Why a record has no start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoDecay {
    /// No line in the spectrum.
    Constant,
    /// Fewer than the periods that are needed.
    TooShort {
        /// Periods in the record.
        periods: usize,
    },
    /// Fewer samples than two for each half period.
    TooCoarse {
        /// Samples per period.
        samples: usize,
    },
}

impl std::fmt::Display for NoDecay {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Constant => f.write_str("the record does not vibrate"),
            Self::TooShort { periods } => {
                write!(f, "the record has about {periods} periods, and at least two are needed")
            }
            Self::TooCoarse { samples } => write!(
                f,
                "the record has about {samples} samples per period, and at least {} are needed",
                2 * LEAST_SAMPLES
            ),
        }
    }
}

/// A part of the envelope.
#[derive(Clone, Copy, Debug)]
struct EnvelopePoint {
    time: f64,
    amplitude: f64,
}

/// Starts of the search, as values of all parameters, for a motion with friction or without.
///
/// # Errors
/// A record in which no decay is visible.
pub(super) fn starts(
    times: &[f64],
    data: &[f64],
    quantity: RecordedQuantity,
) -> Result<Vec<[f64; DECAY_PARAMETERS]>, NoDecay> {
    let omega = dominant_frequency(times, data)?;
    let length = times[times.len() - 1];
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
    let count = |value: f64| value as usize;
    let periods = length * omega / (2.0 * PI);
    if periods < 2.0 {
        return Err(NoDecay::TooShort { periods: count(periods) });
    }
    let samples = times.len() as f64 / periods;
    if samples < 2.0 * LEAST_SAMPLES as f64 {
        return Err(NoDecay::TooCoarse { samples: count(samples) });
    }
    let envelope = envelope(times, data, omega);
    let (Some(first), false) = (envelope.first().copied(), envelope.len() < 2) else {
        return Ok(vec![with_state(omega, 0.01, 0.0, (times, data), quantity)]);
    };
    let logarithms = |point: &EnvelopePoint| libm::log(point.amplitude);
    let zeta = (-slope(&envelope, logarithms) / omega).clamp(DAMPING.lower, DAMPING.upper);
    // Amplitude of x.
    let scale = match quantity {
        RecordedQuantity::Displacement => 1.0,
        RecordedQuantity::Velocity => omega,
        RecordedQuantity::Acceleration => omega * omega,
    };
    let fall = -slope(&envelope, |point| point.amplitude / scale);
    let friction = (0.5 * PI * fall / omega).clamp(0.0, 0.5 * first.amplitude / scale);
    let start = |zeta, friction| with_state(omega, zeta, friction, (times, data), quantity);
    Ok(vec![start(zeta, 0.0), start(0.0, friction), start(0.5 * zeta, 0.5 * friction)])
}

/// Angular frequency of the largest line of a record, resampled at equal steps; times count from the first sample.
///
/// # Errors
/// [`NoDecay::Constant`].
pub fn dominant_frequency(times: &[f64], data: &[f64]) -> Result<f64, NoDecay> {
    let length = times[times.len() - 1];
    let step = length / (times.len() - 1) as f64;
    let mut next = 1;
    let even: Vec<f64> = (0..times.len())
        .map(|k| {
            let time = k as f64 * step;
            while next + 1 < times.len() && times[next] < time {
                next += 1;
            }
            let (from, to) = (times[next - 1], times[next]);
            let share = ((time - from) / (to - from)).clamp(0.0, 1.0);
            data[next - 1] + share * (data[next] - data[next - 1])
        })
        .collect();
    let spectrum = Spectrum::of(&even, step).map_err(|_| NoDecay::Constant)?;
    let largest = spectrum.largest_line(0.0, f64::INFINITY).filter(|line| line.amplitude > 0.0);
    let line = largest.ok_or(NoDecay::Constant)?;
    // Of a short record the line is interpolated between those of the grid.
    let peaks = spectrum.peaks(0.5);
    let near = peaks.iter().min_by(|a, b| {
        let away = |frequency: f64| (frequency - line.frequency).abs();
        away(a.frequency).total_cmp(&away(b.frequency))
    });
    Ok(near.map_or(line.frequency, |peak| peak.frequency))
}

/// Amplitudes over half periods, as long as they are visible.
fn envelope(times: &[f64], data: &[f64], omega: f64) -> Vec<EnvelopePoint> {
    let half = PI / omega;
    let mut found: Vec<EnvelopePoint> = Vec::new();
    let mut from = 0;
    let mut index = 0.0;
    while from < times.len() {
        let end = (index + 1.0) * half;
        let until = from + times[from..].partition_point(|time| *time < end);
        if until - from >= LEAST_SAMPLES {
            let own = &times[from..until];
            let wave = |of: fn(f64) -> f64| own.iter().map(|t| of(omega * t)).collect();
            let columns = [wave(libm::cos), wave(libm::sin), vec![1.0; own.len()]];
            if let Some(solved) = least_squares(&columns, &data[from..until]) {
                let amplitude = libm::hypot(solved.solution[0], solved.solution[1]);
                let largest = found.iter().map(|point| point.amplitude).fold(0.0, f64::max);
                if amplitude < VISIBLE * largest || amplitude <= 0.0 {
                    break;
                }
                found.push(EnvelopePoint { time: (index + 0.5) * half, amplitude });
            }
        }
        from = until;
        index += 1.0;
    }
    found
}

/// Slope over time of a function of the envelope.
fn slope(envelope: &[EnvelopePoint], of: impl Fn(&EnvelopePoint) -> f64) -> f64 {
    let count = envelope.len() as f64;
    let time = envelope.iter().map(|point| point.time).sum::<f64>() / count;
    let mean = envelope.iter().map(&of).sum::<f64>() / count;
    let (mut above, mut below) = (0.0, 0.0);
    for point in envelope {
        above += (point.time - time) * (of(point) - mean);
        below += (point.time - time) * (point.time - time);
    }
    above / below
}

/// All parameters: x₀, ẋ₀ and the offset by linear least squares over the first periods without friction.
fn with_state(
    omega: f64,
    zeta: f64,
    friction: f64,
    (times, data): (&[f64], &[f64]),
    quantity: RecordedQuantity,
) -> [f64; DECAY_PARAMETERS] {
    let end = FIRST * 2.0 * PI / omega;
    let count = times.partition_point(|time| *time <= end).max(LEAST_SAMPLES).min(times.len());
    let mut values = [omega, zeta, 0.0, 0.0, 0.0, 0.0];
    let vibration = FreeVibration::of(&values);
    let linear = readings(&vibration, quantity, &times[..count], false).derivatives;
    let column = |k: usize| -> Vec<f64> { linear.iter().map(|row| row[k]).collect() };
    if let Some(solved) = least_squares(&[column(3), column(4), column(5)], &data[..count]) {
        values[3..].copy_from_slice(&solved.solution);
    }
    values[2] = friction;
    values
}
