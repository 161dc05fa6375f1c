//! What a dither demands of an actuator.

use std::fmt;

use quell_numerics::periodic_polynomial::PeriodicPolynomial;

/// The size of a periodic signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalSize {
    /// Largest magnitude.
    pub peak: f64,
    /// Root mean square.
    pub root_mean_square: f64,
    /// Largest value less the least.
    pub peak_to_peak: f64,
}

impl SignalSize {
    /// Of a signal over a period, times a factor.
    pub(super) fn of(signal: &PeriodicPolynomial, factor: f64) -> Self {
        let [least, largest] = signal.range();
        let size = Self {
            peak: largest.max(-least),
            root_mean_square: signal.root_mean_square(),
            peak_to_peak: largest - least,
        };
        size.times(factor.abs())
    }

    /// The signal times a positive factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            peak: factor * self.peak,
            root_mean_square: factor * self.root_mean_square,
            peak_to_peak: factor * self.peak_to_peak,
        }
    }
}

/// A limit of an actuator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActuatorLimit {
    /// The force of a piezo stack whose voltage is not given.
    BlockedForce,
    /// The travel of a coil.
    FreeStroke,
    /// The range of the voltage of a piezo stack, the peak of others.
    MaximumVoltage,
    /// The peak of the current.
    MaximumCurrent,
    /// The root mean square of the current.
    RmsCurrent,
    /// Two samples per period of the highest harmonic.
    SampleRate,
    /// A measured largest force.
    MaximumForce,
}

impl ActuatorLimit {
    /// The key that gives it.
    pub fn name(self) -> &'static str {
        match self {
            Self::BlockedForce => "blocked_force",
            Self::FreeStroke => "free_stroke",
            Self::MaximumVoltage => "maximum_voltage",
            Self::MaximumCurrent => "maximum_current",
            Self::RmsCurrent => "rms_current",
            Self::SampleRate => "sample_rate",
            Self::MaximumForce => "maximum_force",
        }
    }
}

impl ActuatorLimit {
    /// The path of that key.
    pub fn path(self) -> &'static str {
        match self {
            Self::BlockedForce => "actuator.blocked_force",
            Self::FreeStroke => "actuator.free_stroke",
            Self::MaximumVoltage => "actuator.maximum_voltage",
            Self::MaximumCurrent => "actuator.maximum_current",
            Self::RmsCurrent => "actuator.rms_current",
            Self::SampleRate => "actuator.sample_rate",
            Self::MaximumForce => "actuator.file",
        }
    }
}

/// Why a number of what a dither demands of an actuator is unknown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnknownDemand {
    /// A key of the actuator is not given.
    NotGiven(&'static str),
    /// The largest voltage or the capacitance of a piezo stack, which its current needs, is not given.
    NoCurrent,
    /// The current jumps, which an inductance does not allow.
    CurrentJumps,
    /// The voltage jumps, which a capacitance does not allow.
    VoltageJumps,
    /// Neither the stroke nor the stiffness of a piezo stack in series with a contact is given, which its force also bends.
    NoOwnSpring,
    /// The velocity of the elongation jumps, which the mass of an actuator does not allow.
    VelocityJumps,
    /// The file of a measured actuator has no column with this name.
    NoColumn(&'static str),
    /// It was measured with a sine.
    NotSine,
    /// The frequency is outside of those at which it was measured.
    OutsideMeasured,
    /// The actuator does not have this limit.
    LimitNotGiven(ActuatorLimit),
    /// The actuator has no limit.
    NoLimit,
    /// A limit allows no dither of this frequency, however small.
    NoDither(ActuatorLimit),
    /// How far a limit is used is unknown.
    OfLimit {
        /// The limit.
        limit: ActuatorLimit,
        /// Why.
        why: Box<Self>,
    },
}

impl UnknownDemand {
    fn of_limit(self, limit: ActuatorLimit) -> Self {
        Self::OfLimit { limit, why: Box::new(self) }
    }
}

impl fmt::Display for UnknownDemand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotGiven(key) => write!(f, "{key} is not given"),
            Self::NoCurrent => f.write_str("maximum_voltage and capacitance are needed for it"),
            Self::CurrentJumps => {
                f.write_str("the current jumps, which needs an unlimited voltage")
            }
            Self::VoltageJumps => {
                f.write_str("the voltage jumps, which needs an unlimited current")
            }
            Self::NoOwnSpring => f.write_str(
                "free_stroke or stiffness of the piezo stack is needed for it: in series with a contact the stack also bends itself",
            ),
            Self::VelocityJumps => f.write_str(
                "the velocity of the elongation jumps, for which the mass of the actuator needs an unlimited force",
            ),
            Self::NoColumn(name) => write!(f, "the file has no column {name}"),
            Self::NotSine => f.write_str("a measured frequency response holds for a sine"),
            Self::OutsideMeasured => {
                f.write_str("the frequency is outside the measured frequency response")
            }
            Self::LimitNotGiven(limit) => write!(f, "the actuator has no {}", limit.name()),
            Self::NoLimit => f.write_str("the actuator has no limit"),
            Self::NoDither(limit) => {
                write!(f, "{} allows no dither of this frequency", limit.path())
            }
            Self::OfLimit { limit, why } => write!(f, "{}: {why}", limit.name()),
        }
    }
}

impl std::error::Error for UnknownDemand {}

/// How far a limit is used.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitUse {
    /// The limit.
    pub limit: ActuatorLimit,
    /// The share of the rated value: at most 1 where the limit is kept; or why it is unknown.
    pub used: Result<f64, UnknownDemand>,
}

/// What an actuator must give for a dither.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorDemand {
    /// The force that the actuator itself must make, that on its own mass and spring included.
    pub force: SignalSize,
    /// Displacement of the driven point.
    pub displacement: SignalSize,
    /// Voltage about its mean in volts, or why it is unknown.
    pub voltage: Result<SignalSize, UnknownDemand>,
    /// Current about its mean in amperes, or why it is unknown.
    pub current: Result<SignalSize, UnknownDemand>,
    /// Ratio of its own spring or mass to those of the structure at the driven point, which is judged without them; in series with a
    /// contact the share by which it softens it.
    pub change_of_structure: f64,
    /// Whether it is in series with a contact.
    pub in_series: bool,
    /// Samples of the controller in a period of the dither.
    pub samples_per_period: Option<f64>,
    /// How far each limit is used.
    pub limits: Vec<LimitUse>,
}

/// The largest amplitude that an actuator can give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActuatorReach {
    /// The amplitude; 0 where the sample rate allows no dither of this frequency.
    pub amplitude: f64,
    /// The limit that binds.
    pub limit: ActuatorLimit,
}

impl ActuatorDemand {
    /// The share of a limit that is used.
    ///
    /// # Errors
    /// Why it is unknown.
    pub fn used(&self, limit: ActuatorLimit) -> Result<f64, UnknownDemand> {
        let known = self.limits.iter().find(|known| known.limit == limit);
        known.map_or_else(|| Err(UnknownDemand::LimitNotGiven(limit)), |known| known.used.clone())
    }

    /// The demand of the same dither with an amplitude instead of 1.
    #[must_use]
    pub fn at(&self, amplitude: f64) -> Self {
        let factor = amplitude.abs();
        let sized =
            |size: &Result<SignalSize, UnknownDemand>| size.clone().map(|size| size.times(factor));
        let limits = self.limits.iter().map(|known| LimitUse {
            limit: known.limit,
            used: known.used.clone().map(|used| match known.limit {
                // The frequency decides, not the amplitude.
                ActuatorLimit::SampleRate => used,
                _ => factor * used,
            }),
        });
        Self {
            force: self.force.times(factor),
            displacement: self.displacement.times(factor),
            voltage: sized(&self.voltage),
            current: sized(&self.current),
            change_of_structure: self.change_of_structure,
            in_series: self.in_series,
            samples_per_period: self.samples_per_period,
            limits: limits.collect(),
        }
    }

    /// The limit that is used most, with its share.
    ///
    /// # Errors
    /// Why the use of a limit is unknown.
    pub fn tightest(&self) -> Result<(ActuatorLimit, f64), UnknownDemand> {
        let mut most: Option<(ActuatorLimit, f64)> = None;
        for LimitUse { limit, used } in &self.limits {
            let used = used.clone().map_err(|why| why.of_limit(*limit))?;
            if most.is_none_or(|(_, known)| used > known) {
                most = Some((*limit, used));
            }
        }
        most.ok_or(UnknownDemand::NoLimit)
    }

    /// The largest amplitude that keeps a limit, where this is the demand of unit amplitude; of a sample rate 0 or infinity, as the
    /// frequency decides.
    ///
    /// # Errors
    /// Why the use of the limit is unknown.
    pub fn allowed(&self, limit: ActuatorLimit) -> Result<f64, UnknownDemand> {
        let used = self.used(limit).map_err(|why| why.of_limit(limit))?;
        Ok(match limit {
            ActuatorLimit::SampleRate if used > 1.0 => 0.0,
            ActuatorLimit::SampleRate => f64::INFINITY,
            _ => used.recip(),
        })
    }

    /// The largest amplitude, where this is the demand of unit amplitude.
    ///
    /// # Errors
    /// Why the use of a limit is unknown.
    pub fn reach(&self) -> Result<ActuatorReach, UnknownDemand> {
        let mut least: Option<ActuatorReach> = None;
        for LimitUse { limit, .. } in &self.limits {
            let amplitude = self.allowed(*limit)?;
            let allows_any = *limit == ActuatorLimit::SampleRate && amplitude > 0.0;
            if !allows_any && least.is_none_or(|known| amplitude < known.amplitude) {
                least = Some(ActuatorReach { amplitude, limit: *limit });
            }
        }
        least.ok_or(UnknownDemand::NoLimit)
    }
}

/// The use of a limit by a size, if the actuator has the limit.
pub(super) fn share(
    limit: ActuatorLimit,
    rated: Option<f64>,
    size: &Result<SignalSize, UnknownDemand>,
    of: fn(SignalSize) -> f64,
) -> Option<LimitUse> {
    let rated = rated?;
    Some(LimitUse { limit, used: size.clone().map(|size| of(size) / rated) })
}
