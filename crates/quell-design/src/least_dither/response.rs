//! The size of the response that is observed, of the exact base response or estimated from the structure without friction's slope, and
//! the friction that is lost on it.

use quell_dynamics::motion::{ContactMeter, MOTION_TOLERANCE, Motion, MotionStart, RowMeter};
use quell_linear::harmonic;
use quell_linear::linearised::Linearised;
use quell_model::System;
use quell_model::waveform::WaveSine;

use crate::NoAnswer;

/// The size of a displacement over a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseSize {
    /// Root mean square about its mean.
    pub rms: f64,
    /// Half of its range from the least to the largest value.
    pub peak: f64,
}

impl ResponseSize {
    /// The larger of each.
    #[must_use]
    pub fn or_larger(self, other: Self) -> Self {
        Self { rms: self.rms.max(other.rms), peak: self.peak.max(other.peak) }
    }
}

/// The response along a row over the coordinates on a periodic motion, given by its state at t = 0 and its period.
pub(super) fn response_on(
    system: &System,
    (state, period): (&[f64], f64),
    row: &[f64],
) -> Result<ResponseSize, NoAnswer> {
    let motion = Motion::new(system)?;
    let mut meter = RowMeter::new(row, 0.0, period, 0);
    let start = MotionStart { time: 0.0, state: state.to_vec() };
    motion.run(&start, period, MOTION_TOLERANCE, &mut meter)?;
    Ok(ResponseSize { rms: meter.deviation(), peak: 0.5 * meter.range() })
}

/// The largest share of the friction of steady sliding that a contact loses on a periodic motion, given by its state at t = 0 and its
/// period.
pub(super) fn loss_on(system: &System, (state, period): (&[f64], f64)) -> Result<f64, NoAnswer> {
    let motion = Motion::new(system)?;
    let mut meter = ContactMeter::new(system.contacts.len());
    let start = MotionStart { time: 0.0, state: state.to_vec() };
    motion.run(&start, period, MOTION_TOLERANCE, &mut meter)?;
    let means = meter.means().ok_or(NoAnswer::NoPeriod)?;
    let linear = Linearised::new(&system.undithered())?;
    largest_loss(&linear, means.iter().map(|means| means.friction))
}

/// The largest share of the friction of steady sliding that a contact loses, from the mean friction of every contact.
pub(super) fn largest_loss(
    linear: &Linearised,
    mean_friction: impl Iterator<Item = f64>,
) -> Result<f64, NoAnswer> {
    let steady = linear.friction();
    let known = steady.iter().zip(mean_friction).filter(|(steady, _)| steady.force != 0.0);
    known
        .map(|(steady, mean)| 1.0 - mean / steady.force)
        .max_by(f64::total_cmp)
        .ok_or(NoAnswer::NoFriction)
}

/// An estimate of the response along a row to an input, from the sliding structure without the slope of friction: exact for a sine and
/// for sums of sines, apart from the peak of a sum, for which all lines peak together. Of other waveforms it is that of a sine.
pub(super) fn linear_response(
    system: &System,
    input: usize,
    row: &[f64],
) -> Result<ResponseSize, NoAnswer> {
    let acting = system.inputs.get(input).ok_or(NoAnswer::DoesNotAct)?;
    let wave = acting.profile.waves().first().ok_or(NoAnswer::DoesNotAct)?;
    let sliding = Linearised::new(system)?;
    let one = || vec![WaveSine { multiple: 1.0, amplitude: 1.0, phase: 0.0 }];
    let (mut mean_square, mut peak) = (0.0, 0.0);
    for line in wave.waveform.sines().unwrap_or_else(one) {
        let frequency = line.multiple * wave.frequency;
        let found = harmonic::response(system, &sliding, &acting.target, frequency)
            .ok_or(NoAnswer::UndampedHarmonic)?;
        let along = row.iter().zip(&found.displacement);
        let (re, im) = along.fold((0.0, 0.0), |(re, im), (r, q)| (re + r * q.re, im + r * q.im));
        let amplitude = (line.amplitude * wave.amplitude).abs() * libm::hypot(re, im);
        mean_square += 0.5 * amplitude * amplitude;
        peak += amplitude;
    }
    Ok(ResponseSize { rms: f64::sqrt(mean_square), peak })
}
