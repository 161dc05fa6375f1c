//! The keys of waveforms that are more than a name.

/// A part of the description of a waveform that is more than a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaveKey {
    /// The harmonics of a sum.
    Harmonics,
    /// The samples of a period.
    Values,
    /// A file of the samples.
    File,
    /// What is between two samples.
    Hold,
    /// The waveform of the carrier of bursts.
    Carrier,
    /// Periods of the carrier in a burst.
    On,
    /// Periods of the carrier in a pause.
    Off,
    /// The ends of the band of noise.
    Band,
    /// The same in hertz.
    BandHz,
    /// The number of lines of noise.
    Lines,
    /// The seed of noise.
    Seed,
}

impl WaveKey {
    /// The waveform that it describes.
    pub fn waveform(self) -> &'static str {
        match self {
            Self::Harmonics => quell_model::waveform::FOURIER,
            Self::Values | Self::File | Self::Hold => quell_model::waveform::SAMPLES,
            Self::Carrier | Self::On | Self::Off => quell_model::waveform::BURST,
            Self::Band | Self::BandHz | Self::Lines | Self::Seed => quell_model::waveform::NOISE,
        }
    }

    /// What it is, in one line.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Harmonics => "waveform \"fourier\": order, sine and cosine of every harmonic",
            Self::Values => {
                "waveform \"samples\": one period at equal distances; its mean is taken out"
            }
            Self::File => {
                "waveform \"samples\": a file of them, one number per line or a CSV column value, relative to the study file"
            }
            Self::Hold => {
                "waveform \"samples\": straight lines between them, or each held [default: linear]"
            }
            Self::Carrier => "waveform \"burst\": waveform of the carrier",
            Self::On => "waveform \"burst\": periods of the carrier in a burst",
            Self::Off => "waveform \"burst\": periods of the carrier in a pause",
            Self::Band | Self::BandHz => {
                "waveform \"noise\": lowest and highest frequency, instead of the frequency of a periodic dither"
            }
            Self::Lines => {
                "waveform \"noise\": number of equal lines at irregular frequencies [default: 64]"
            }
            Self::Seed => "waveform \"noise\": seed of their frequencies and phases [default: 1]",
        }
    }
}

/// The keys of waveforms that are more than a name.
pub const WAVE_KEYS: [(&str, WaveKey); 11] = [
    ("harmonics", WaveKey::Harmonics),
    ("values", WaveKey::Values),
    ("file", WaveKey::File),
    ("hold", WaveKey::Hold),
    ("carrier", WaveKey::Carrier),
    ("on", WaveKey::On),
    ("off", WaveKey::Off),
    ("band", WaveKey::Band),
    ("lines", WaveKey::Lines),
    ("seed", WaveKey::Seed),
    ("band_hz", WaveKey::BandHz),
];
