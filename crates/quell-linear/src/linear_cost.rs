//! The steady response of a belt's mass on its spring to one tangential dither, without friction: stroke, velocity, power.
//!
//! x″ + 2ζx′ + x = D g(Rτ). The mean power that the dither brings into the structure is ⟨D g x′⟩ = 2ζ⟨x′²⟩. A sine has the stroke
//! 2D/√((R² − 1)² + 4ζ²R²), nearly 2D/|R² − 1|. A burst repeats at R over its cycles: one of its harmonics may be near the natural
//! frequency. The motion is that of [`crate::driven_point`].

use quell_model::{Direction, Dither};

use crate::driven_point::{DrivenPoint, PointOutput};
use crate::periodic_response::NoPeriodicResponse;

/// Steady response of the structure without friction to one tangential dither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearCost {
    /// Peak-to-peak displacement, a length.
    pub stroke: f64,
    /// Largest velocity |x′|, a length per τ.
    pub velocity: f64,
    /// Mean power 2ζ⟨x′²⟩ that the dither brings into the structure, length² per τ (power/(kω₀)).
    pub power: f64,
}

/// Why the response has no value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoLinearCost {
    /// A normal dither does not act on the structure without friction.
    Normal,
    /// There is no periodic response.
    NoResponse(NoPeriodicResponse),
    /// Noise has no largest displacement; [`noise_cost`] has its root mean squares.
    Noise,
}

impl core::fmt::Display for NoLinearCost {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Normal => f.write_str("a normal dither does not move the mass without friction"),
            Self::NoResponse(why) => why.fmt(f),
            Self::Noise => f.write_str(
                "noise has no largest displacement and velocity, only root mean squares",
            ),
        }
    }
}

impl core::error::Error for NoLinearCost {}

/// Stroke, velocity and power of the response to a dither at a damping ratio.
///
/// # Errors
/// [`NoLinearCost`] for normal dither, and at an undamped resonance.
pub fn linear_cost(dither: &Dither, damping_ratio: f64) -> Result<LinearCost, NoLinearCost> {
    if dither.direction == Direction::Normal {
        return Err(NoLinearCost::Normal);
    }
    if !dither.waveform.is_periodic() {
        return Err(NoLinearCost::Noise);
    }
    let point = DrivenPoint::of_one_mass(&dither.waveform, dither.frequency_ratio, damping_ratio)
        .map_err(NoLinearCost::NoResponse)?;
    let outputs = point.outputs(&[PointOutput::DISPLACEMENT, PointOutput::VELOCITY]);
    let [displacement, velocity] = [&outputs[0], &outputs[1]];
    let [[least, largest], [slowest, fastest]] = [displacement.range(), velocity.range()];
    let amplitude = dither.amplitude.abs();
    Ok(LinearCost {
        stroke: amplitude * (largest - least),
        velocity: amplitude * fastest.max(-slowest),
        power: amplitude * amplitude * (2.0 * damping_ratio * velocity.mean_of_product(velocity)),
    })
}

/// Steady response of the structure without friction to tangential noise: root mean squares, sums over the lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseCost {
    /// √⟨(D g)²⟩, a length.
    pub force: f64,
    /// √⟨x²⟩, a length.
    pub displacement: f64,
    /// √⟨x′²⟩, a length per τ.
    pub velocity: f64,
    /// Mean power 2ζ⟨x′²⟩.
    pub power: f64,
}

/// Root mean squares of the response to noise at a damping ratio: each line of amplitude A and ratio R has ⟨x²⟩ =
/// ½A²/((R² − 1)² + 4ζ²R²).
///
/// # Errors
/// [`NoLinearCost`] for normal dither, and at an undamped resonance. Of a periodic dither that is a sum of harmonics the same
/// holds; other waveforms have [`linear_cost`].
pub fn noise_cost(dither: &Dither, damping_ratio: f64) -> Result<NoiseCost, NoLinearCost> {
    if dither.direction == Direction::Normal {
        return Err(NoLinearCost::Normal);
    }
    let (mut force, mut displacement, mut velocity) = (0.0, 0.0, 0.0);
    for line in dither.by_harmonics() {
        let ratio = line.frequency_ratio;
        let stiffness = (1.0 - ratio) * (1.0 + ratio);
        let damping = 2.0 * damping_ratio * ratio;
        let square = stiffness.mul_add(stiffness, damping * damping);
        if square == 0.0 && line.amplitude != 0.0 {
            return Err(NoLinearCost::NoResponse(NoPeriodicResponse::Resonance));
        }
        let mean_square = 0.5 * line.amplitude * line.amplitude;
        force += mean_square;
        displacement += mean_square / square;
        velocity += mean_square * ratio * ratio / square;
    }
    let power = 2.0 * damping_ratio * velocity;
    let [force, displacement, velocity] = [force, displacement, velocity].map(f64::sqrt);
    Ok(NoiseCost { force, displacement, velocity, power })
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::SQRT_2;
    use quell_model::Waveform;
    use quell_model::waveform::{Burst, FourierWave, Harmonic, Noise};

    use crate::averaging::FastWave;

    fn dither(waveform: Waveform, frequency_ratio: f64) -> Dither {
        let (direction, amplitude, phase) = (Direction::Tangential, 0.7, 0.0);
        Dither { direction, waveform, amplitude, frequency_ratio, phase, envelope: None }
    }

    fn close(value: f64, exact: f64, tolerance: f64) {
        assert!((value / exact - 1.0).abs() < tolerance, "{value} should be {exact}");
    }

    #[test]
    fn a_sine_in_closed_form() {
        for (ratio, damping) in [(10.0, 0.005), (3.0, 0.0), (1.0, 0.1), (0.5, 0.3), (1e4, 0.01)] {
            let found = linear_cost(&dither(Waveform::Sine, ratio), damping).expect("a response");
            let square: f64 = ratio * ratio;
            let size = ((square - 1.0).powi(2) + 4.0 * damping * damping * square).sqrt();
            close(found.stroke, 1.4 / size, 1e-12);
            close(found.velocity, 0.7 * ratio / size, 1e-12);
            let power = damping * (0.7 * ratio / size).powi(2);
            assert!((found.power - power).abs() < 1e-12 * (1.0 + power), "{found:?} {power}");
        }
    }

    /// Without damping the velocity is the shape that finite-R averaging uses.
    #[test]
    fn velocity_of_the_undamped_oscillator() {
        for waveform in Waveform::NAMED {
            for frequency_ratio in [1.7, 10.0] {
                let found = linear_cost(&dither(waveform.clone(), frequency_ratio), 0.0);
                let shape = FastWave::Oscillator { waveform: waveform.clone(), frequency_ratio };
                let exact = 0.7 / frequency_ratio * shape.peak();
                close(found.expect("a response").velocity, exact, 1e-12);
            }
        }
    }

    /// The power is the work of the force per time: ⟨D g v⟩ of a sum of harmonics, each with its own response.
    #[test]
    fn power_of_a_sum_is_that_of_its_harmonics() {
        let harmonics = vec![
            Harmonic { order: 1, sine: 0.8, cosine: 0.1 },
            Harmonic { order: 3, sine: -0.3, cosine: 0.4 },
        ];
        let wave = FourierWave::new(harmonics.clone()).expect("a sum");
        let (ratio, damping) = (2.3, 0.02);
        let found = linear_cost(&dither(Waveform::Fourier(wave.into()), ratio), damping);
        let exact: f64 = harmonics
            .iter()
            .map(|harmonic| {
                let own = dither(Waveform::Sine, ratio * f64::from(harmonic.order));
                let share = harmonic.amplitude() * harmonic.amplitude();
                share * linear_cost(&own, damping).expect("a response").power
            })
            .sum();
        close(found.expect("a response").power, exact, 1e-12);
    }

    /// One line is a sine, and noise has no stroke.
    #[test]
    fn noise_of_one_line_is_a_sine() {
        let noise = Noise::new([8.0, 12.0], 1, 3).expect("noise");
        let dither = dither(Waveform::Noise(noise.into()), 10.0);
        assert_eq!(linear_cost(&dither, 0.05), Err(NoLinearCost::Noise));
        let found = noise_cost(&dither, 0.05).expect("a response");
        let line = &dither.by_harmonics()[0];
        let exact = linear_cost(line, 0.05).expect("a response");
        close(found.power, exact.power, 1e-9);
        close(found.displacement, exact.stroke / 8f64.sqrt(), 1e-5);
        close(found.velocity, exact.velocity / SQRT_2, 1e-5);
        close(found.force, 0.7 / SQRT_2, 1e-14);
    }

    /// A burst against the response that its pieces have in closed form: the same start after one period.
    #[test]
    fn a_burst_against_integration() {
        let waveform = Burst::new(Waveform::Sine, 2, 3).expect("a burst").into_waveform();
        let (ratio, damping) = (6.0, 0.05);
        let dither = dither(waveform, ratio);
        let found = linear_cost(&dither, damping).expect("a response");
        // Runge–Kutta of fourth order over many periods.
        let steps = 5000;
        let period = dither.waveform.period() / ratio;
        let h = period / f64::from(steps);
        let force = |time: f64| 0.7 * dither.waveform.value(ratio * time);
        let rate = |time: f64, [x, v]: [f64; 2]| [v, force(time) - 2.0 * damping * v - x];
        let mut state = [0.0, 0.0];
        let (mut least, mut largest, mut fastest, mut work) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0);
        for _ in 0..120 {
            (least, largest, fastest, work) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.0);
            for k in 0..steps {
                let time = h * f64::from(k);
                let add = |state: [f64; 2], slope: [f64; 2], by: f64| {
                    [state[0] + by * slope[0], state[1] + by * slope[1]]
                };
                let a = rate(time, state);
                let b = rate(time + 0.5 * h, add(state, a, 0.5 * h));
                let c = rate(time + 0.5 * h, add(state, b, 0.5 * h));
                let d = rate(time + h, add(state, c, h));
                work += h * force(time) * state[1];
                for i in 0..2 {
                    state[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
                }
                (least, largest) = (least.min(state[0]), largest.max(state[0]));
                fastest = fastest.max(state[1].abs());
            }
        }
        close(found.stroke, largest - least, 1e-5);
        close(found.velocity, fastest, 1e-5);
        close(found.power, work / period, 1e-5);
    }

    #[test]
    fn refused() {
        let normal = Dither { direction: Direction::Normal, ..dither(Waveform::Sine, 10.0) };
        assert_eq!(linear_cost(&normal, 0.1), Err(NoLinearCost::Normal));
        assert_eq!(
            linear_cost(&dither(Waveform::Sine, 1.0), 0.0),
            Err(NoLinearCost::NoResponse(NoPeriodicResponse::Resonance))
        );
    }
}
