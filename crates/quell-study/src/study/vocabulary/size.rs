//! Keys that give the amplitude of a dither other than as a peak force: as a root mean square or peak to peak, as a voltage or a
//! current, or in per cent of what an actuator can give.

use quell_model::Waveform;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

/// How the size of a periodic signal is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalMeasure {
    /// As the amplitude, which multiplies the waveform: the peak of the waveforms of unit peak.
    Peak,
    /// As root mean square.
    RootMeanSquare,
    /// As the largest value less the least.
    PeakToPeak,
}

impl SignalMeasure {
    /// Its value for a waveform of unit amplitude; `None` for the peak-to-peak value of noise, which has none.
    pub fn of_unit(self, waveform: &Waveform) -> Option<f64> {
        match self {
            Self::Peak => Some(1.0),
            Self::RootMeanSquare => Some(waveform.root_mean_square()),
            Self::PeakToPeak => waveform.is_periodic().then(|| {
                let RealInterval { lower: least, upper: largest } = waveform.range();
                largest - least
            }),
        }
    }
}

/// What a size is a size of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SizedSignal {
    /// The force, in the unit of the amplitude.
    Force,
    /// The force in newtons, in a study in SI.
    Newtons,
    /// The voltage of the actuator, about its mean.
    Voltage,
    /// The current of the actuator, about its mean.
    Current,
    /// The share of the largest amplitude that the actuator can give, in per cent.
    Rated,
}

/// A key that gives an amplitude by another size than its peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeKey {
    /// Key in the table of the dither, such as `amplitude_v`.
    pub key: &'static str,
    /// Unit of its number; empty for that of the amplitude.
    pub unit: &'static str,
    /// Symbol.
    pub symbol: &'static str,
    /// Description, in one line.
    pub about: &'static str,
    /// The signal whose size it is.
    pub signal: SizedSignal,
    /// How the size is given.
    pub measure: SignalMeasure,
}

impl SizeKey {
    /// Whether an actuator makes it a force.
    pub fn needs_actuator(&self) -> bool {
        !matches!(self.signal, SizedSignal::Force | SizedSignal::Newtons)
    }

    /// The quantity that it measures; `None` for a share of what the actuator can give.
    pub fn quantity(&self) -> Option<Quantity> {
        match self.signal {
            SizedSignal::Force | SizedSignal::Newtons => Some(Quantity::Force),
            SizedSignal::Voltage => Some(Quantity::Voltage),
            SizedSignal::Current => Some(Quantity::Current),
            SizedSignal::Rated => None,
        }
    }
}

const fn size(
    key: &'static str,
    unit: &'static str,
    (symbol, about): (&'static str, &'static str),
    signal: SizedSignal,
    measure: SignalMeasure,
) -> SizeKey {
    SizeKey { key, unit, symbol, about, signal, measure }
}

/// The keys of a dither.
pub const DITHER_SIZES: &[SizeKey] = &[
    size(
        "amplitude_rms",
        "",
        ("D_{rms}", "dither force, as root mean square"),
        SizedSignal::Force,
        SignalMeasure::RootMeanSquare,
    ),
    size(
        "amplitude_peak_to_peak",
        "",
        ("D_{pp}", "dither force, peak to peak"),
        SizedSignal::Force,
        SignalMeasure::PeakToPeak,
    ),
    size(
        "amplitude_n_rms",
        "N",
        ("A_{rms}", "dither force, as root mean square"),
        SizedSignal::Newtons,
        SignalMeasure::RootMeanSquare,
    ),
    size(
        "amplitude_n_peak_to_peak",
        "N",
        ("A_{pp}", "dither force, peak to peak"),
        SizedSignal::Newtons,
        SignalMeasure::PeakToPeak,
    ),
    size(
        "amplitude_v",
        "V",
        ("U", "peak of the voltage of the actuator about its mean"),
        SizedSignal::Voltage,
        SignalMeasure::Peak,
    ),
    size(
        "amplitude_v_rms",
        "V",
        ("U_{rms}", "voltage of the actuator about its mean, as root mean square"),
        SizedSignal::Voltage,
        SignalMeasure::RootMeanSquare,
    ),
    size(
        "amplitude_v_peak_to_peak",
        "V",
        ("U_{pp}", "voltage of the actuator, peak to peak"),
        SizedSignal::Voltage,
        SignalMeasure::PeakToPeak,
    ),
    size(
        "amplitude_a",
        "A",
        ("I", "peak of the current of the actuator about its mean"),
        SizedSignal::Current,
        SignalMeasure::Peak,
    ),
    size(
        "amplitude_a_rms",
        "A",
        ("I_{rms}", "current of the actuator about its mean, as root mean square"),
        SizedSignal::Current,
        SignalMeasure::RootMeanSquare,
    ),
    size(
        "amplitude_a_peak_to_peak",
        "A",
        ("I_{pp}", "current of the actuator, peak to peak"),
        SizedSignal::Current,
        SignalMeasure::PeakToPeak,
    ),
    size(
        "amplitude_percent",
        "%",
        ("p", "per cent of the largest amplitude that the actuator can give"),
        SizedSignal::Rated,
        SignalMeasure::Peak,
    ),
];
