//! The lines of a record in the band of slow vibration, without the tones of dithers above it.

use quell_model::System;
use quell_model::profile::Wave;
use quell_numerics::matrix::Matrix;
use quell_numerics::spectrum::Spectrum;
use quell_numerics::spectrum::low_band::LargestLines;

/// M of a record and of its halves, without the tones of dithers above the band, which the window spreads. A tone in the band is a slow
/// vibration. The lines of noise are many and close to each other: they stay, and what the window spreads of each beyond four lines is
/// small.
pub(super) fn lines_of(samples: &[f64], system: &System, step: f64, band_end: f64) -> LargestLines {
    let mut rest = samples.to_vec();
    let tones = system.waves().filter(|wave| wave.amplitude != 0.0 && wave.waveform.is_periodic());
    for frequency in tones.map(Wave::repetition).filter(|frequency| *frequency > band_end) {
        subtract_tone(&mut rest, frequency * step);
    }
    let largest = |samples: &[f64]| {
        let spectrum = spectrum_of(samples, step);
        let lines = spectrum.frequencies().zip(spectrum.amplitudes());
        let low = lines.skip(1).take_while(|(frequency, _)| *frequency <= band_end);
        low.fold(0.0_f64, |most, (_, amplitude)| most.max(*amplitude))
    };
    let (first, second) = rest.split_at(rest.len() / 2);
    LargestLines { whole: largest(&rest), halves: [largest(first), largest(second)] }
}

/// Subtracts the tone of an angular frequency per sample that fits best under the Hann window, and leaves the mean.
fn subtract_tone(samples: &mut [f64], rate: f64) {
    let count = samples.len() as f64;
    let parts = |number: usize| {
        let sine = libm::sin(std::f64::consts::PI * number as f64 / count);
        let phase = rate * number as f64;
        (sine * sine, [1.0, libm::cos(phase), libm::sin(phase)])
    };
    let mut matrix = Matrix::zeros(3, 3);
    let mut right = Matrix::zeros(3, 1);
    for (number, sample) in samples.iter().enumerate() {
        let (weight, basis) = parts(number);
        for (i, a) in basis.iter().enumerate() {
            right[(i, 0)] += weight * a * sample;
            for (j, b) in basis.iter().enumerate() {
                matrix[(i, j)] += weight * a * b;
            }
        }
    }
    let Some(fit) = matrix.solve(&right) else { return };
    for (number, sample) in samples.iter_mut().enumerate() {
        let (_, [_, cosine, sine]) = parts(number);
        *sample -= fit[(1, 0)] * cosine + fit[(2, 0)] * sine;
    }
}

pub(super) fn spectrum_of(samples: &[f64], step: f64) -> Spectrum {
    // UNWRAP: a record has at least four samples, the step is positive, and a run whose state is not finite stops before.
    Spectrum::of(samples, step).expect("a record of finite samples")
}
