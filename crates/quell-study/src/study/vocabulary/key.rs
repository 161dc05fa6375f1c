//! A key of the study file: its table, its name and the values it takes.

use quell_model::friction::expression;
use quell_model::parameter::{COEFFICIENT, Parameter, SiTwin};
use quell_model::units::{Quantity, UnitSystem};

use super::course::{CourseKey, CourseTable, DISC_DRIVE, DRIVE, ENVELOPE, LOAD, LOAD_ENVELOPE};
use super::size::SizeKey;
use super::words::Choice;

/// What the key `schema` of a study is.
pub const SCHEMA_ABOUT: &str = "version of the study file [default: 1]";

/// A table of the study file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Section {
    /// Keys outside any table.
    Root,
    /// `[belt]`.
    Belt,
    /// `[belt.initial]`.
    Initial,
    /// `[belt.drive]`.
    Drive,
    /// `[belt.load]`.
    Load,
    /// `[friction]`.
    Friction,
    /// `[friction.constants]`, whose names a study chooses.
    Constants,
    /// `[disc]`.
    Disc,
    /// `[[disc.mode]]`.
    DiscMode,
    /// `[disc.load]` or `[[disc.load]]`.
    DiscLoad,
    /// `[disc.drive]`.
    DiscDrive,
    /// `[disc.load.envelope]`.
    LoadEnvelope,
    /// `[dither]` or `[[dither]]`.
    Dither,
    /// `[dither.envelope]`.
    Envelope,
    /// `[solver]`.
    Solver,
    /// `[response]`.
    Response,
    /// `[design]`.
    Design,
    /// `[design.limits]`.
    DesignLimits,
    /// `[actuator]`.
    Actuator,
    /// `[[sweep]]`.
    Sweep,
}

impl Section {
    /// Every table, in the order of a study file.
    pub const ALL: &'static [Self] = &[
        Self::Root,
        Self::Belt,
        Self::Initial,
        Self::Drive,
        Self::Load,
        Self::Friction,
        Self::Constants,
        Self::Disc,
        Self::DiscMode,
        Self::DiscLoad,
        Self::DiscDrive,
        Self::LoadEnvelope,
        Self::Dither,
        Self::Envelope,
        Self::Solver,
        Self::Response,
        Self::Design,
        Self::DesignLimits,
        Self::Actuator,
        Self::Sweep,
    ];

    /// Path of the table; empty for the root.
    pub fn path(self) -> &'static str {
        match self {
            Self::Root => "",
            Self::Belt => "belt",
            Self::Initial => "belt.initial",
            Self::Drive => "belt.drive",
            Self::Load => "belt.load",
            Self::Friction => "friction",
            Self::Constants => expression::CONSTANTS,
            Self::Disc => "disc",
            Self::DiscMode => "disc.mode",
            Self::DiscLoad => "disc.load",
            Self::DiscDrive => "disc.drive",
            Self::LoadEnvelope => "disc.load.envelope",
            Self::Dither => "dither",
            Self::Envelope => "dither.envelope",
            Self::Solver => "solver",
            Self::Response => "response",
            Self::Design => "design",
            Self::DesignLimits => "design.limits",
            Self::Actuator => "actuator",
            Self::Sweep => "sweep",
        }
    }

    /// Contents of the table, in one line.
    pub fn about(self) -> &'static str {
        match self {
            Self::Root => "a study: a belt with its friction law or a disc, and dither",
            Self::Disc => "annular disc under rotating loads",
            Self::DiscMode => "a mode of the disc, if modes are listed instead of computed",
            Self::DiscLoad => {
                "mass, damper, spring and friction at a point; several as [[disc.load]]"
            }
            Self::Belt => "mass, spring and damper on a moving belt",
            Self::Initial => "initial state of a run [default: at rest]",
            Self::Drive => "velocity of the belt over time, instead of or added to belt_velocity",
            Self::Load => "normal load over time, instead of or added to normal_load",
            Self::Friction => "the friction law",
            Self::Constants => "named numbers of a formula",
            Self::Dither => "one dither force; several as [[dither]]",
            Self::DiscDrive => {
                "speed of the disc over time, instead of or added to disc.load.speed"
            }
            Self::LoadEnvelope => "share of the normal load, and with it of friction, over time",
            Self::Envelope => "share of the amplitude over time",
            Self::Solver => "accuracy and length of the computations",
            Self::Response => {
                "measurements of a response in addition to the band of slow vibration"
            }
            Self::Design => "the least dither over a box of operating points",
            Self::DesignLimits => "limits of the dither that is designed",
            Self::Actuator => "the actuator that gives the dither",
            Self::Sweep => "one axis of a map; several in order",
        }
    }

    /// What a table over time gives.
    pub fn course(self) -> Option<CourseTable> {
        match self {
            Self::Drive => Some(DRIVE),
            Self::Load => Some(LOAD),
            Self::DiscDrive => Some(DISC_DRIVE),
            Self::LoadEnvelope => Some(LOAD_ENVELOPE),
            Self::Envelope => Some(ENVELOPE),
            _ => None,
        }
    }
}

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

/// The kind of value that a key takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// A parameter by its own key.
    Number(Parameter),
    /// A parameter by another key.
    Twin(Parameter, SiTwin),
    /// Another size of a signal than its peak, which gives this parameter.
    Size(Parameter, SizeKey),
    /// A word from a list.
    Choice(Choice),
    /// Free text.
    Text,
    /// `true` or `false`.
    Flag,
    /// The version of the file.
    Schema,
    /// Words from a list, as an array.
    Choices(Choice),
    /// The reference frequency of a disc: "critical", or a frequency parameter k².
    Reference,
    /// A formula of the friction coefficient, measured coefficients, or the number of a named law.
    Coefficient,
    /// Friction as a force in SI, which determines this parameter of a named law.
    FrictionForce(Parameter, &'static str),
    /// Measured slip speeds, in SI or not.
    Speeds {
        /// In metres per second.
        si: bool,
    },
    /// The two ends of a band of frequencies, in hertz or in ω₀.
    Band {
        /// In hertz.
        hertz: bool,
    },
    /// The number of terms of a fit.
    Terms,
    /// A part of the description of a waveform.
    Wave(WaveKey),
    /// A part of a drive, a load or an envelope.
    Course(CourseKey),
    /// A named number of a formula.
    Constant,
    /// A bare number of an axis, in the unit of the parameter it names.
    AxisNumber,
    /// The number of points of an axis.
    AxisPoints,
    /// The list of values of an axis.
    AxisValues,
    /// The paths of the numbers that a design varies.
    Paths,
    /// The ranges of the numbers over which a design holds, by their paths.
    Ranges,
}

/// One key of the study file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Its table.
    pub section: Section,
    /// Its name inside the table.
    pub name: &'static str,
    /// Its kind of value.
    pub role: Role,
    /// Description, in one line.
    pub about: &'static str,
}

impl Key {
    /// Its path without index.
    pub fn path(&self) -> String {
        join(self.section.path(), self.name)
    }

    /// The parameter it gives, in SI or not.
    pub fn parameter(&self) -> Option<Parameter> {
        match self.role {
            Role::Number(parameter) | Role::Twin(parameter, _) | Role::Size(parameter, _) => {
                Some(parameter)
            }
            Role::Coefficient => Some(COEFFICIENT),
            _ => None,
        }
    }

    /// Symbol of its number in the equations, in SI or not.
    pub fn symbol(&self) -> Option<&'static str> {
        match self.role {
            Role::Twin(_, SiTwin { own: Some((symbol, _)), .. })
            | Role::Size(_, SizeKey { symbol, .. }) => Some(symbol),
            _ => self.parameter().map(|parameter| parameter.symbol),
        }
    }

    /// Whether it takes a number that can be varied.
    pub fn takes_number(&self) -> bool {
        let named = matches!(self.role, Role::Constant | Role::FrictionForce(..));
        named || self.parameter().is_some()
    }

    /// Unit of its value, in a study with these units.
    pub fn unit(&self, units: UnitSystem) -> &'static str {
        match self.role {
            Role::Number(parameter) if parameter.is_pure() => parameter.quantity.scaled_unit(),
            Role::Number(parameter) => own_unit(parameter.quantity, units),
            Role::Twin(parameter, other) if other.unit.is_empty() => {
                own_unit(parameter.quantity, units)
            }
            Role::Twin(_, other) => other.unit,
            Role::Size(parameter, size) if size.unit.is_empty() => {
                own_unit(parameter.quantity, units)
            }
            Role::Size(_, size) => size.unit,
            Role::FrictionForce(_, unit) => unit,
            Role::Speeds { si: true } => "m/s",
            Role::Speeds { si: false } => own_unit(Quantity::Velocity, units),
            Role::Band { hertz: true } => "Hz",
            Role::Band { hertz: false } => own_unit(Quantity::FrequencyRatio, units),
            _ => "1",
        }
    }

    /// Unit in words; frequencies of a disc are in ω_ref.
    pub fn unit_in_words(&self, units: UnitSystem) -> &'static str {
        let unit = self.unit(units);
        if self.is_of_a_disc() && unit == "ω₀" { "ω_ref" } else { unit }
    }

    /// The unit to which a number with a unit is converted, such as `5.7kN` for a key in newtons; `None` for dimensionless
    /// numbers and other values without a unit.
    pub fn measured_in(&self, units: UnitSystem) -> Option<&'static str> {
        match self.role {
            Role::Number(parameter) => match parameter.quantity {
                Quantity::Ratio | Quantity::DampingRatio => Some("1"),
                Quantity::Angle => Some("rad"),
                _ if parameter.is_pure() => Some("1"),
                quantity => quantity.own_unit().or_else(|| units.unit(quantity)),
            },
            Role::Twin(parameter, other) if other.unit.is_empty() => units.unit(parameter.quantity),
            Role::Size(parameter, size) if size.unit.is_empty() => units.unit(parameter.quantity),
            Role::Twin(_, SiTwin { unit, .. })
            | Role::Size(_, SizeKey { unit, .. })
            | Role::FrictionForce(_, unit) => Some(unit),
            Role::Speeds { si: true } => Some("m/s"),
            Role::Band { hertz: true } => Some("Hz"),
            Role::Constant => Some("1"),
            _ => None,
        }
    }

    fn is_of_a_disc(&self) -> bool {
        matches!(self.section, Section::Disc | Section::DiscMode | Section::DiscLoad)
    }
}

/// Unit of a bare number of a quantity.
fn own_unit(quantity: Quantity, units: UnitSystem) -> &'static str {
    units.unit(quantity).unwrap_or_else(|| quantity.scaled_unit())
}

/// `table.key`, or `key` alone at the root.
pub fn join(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
}
