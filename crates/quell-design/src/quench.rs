//! The exact quench amplitude: the least amplitude of a dither from which the base response is stable.
//!
//! The base response is followed from steady sliding without this dither up to a limit, by the continuation of `thresholds` and
//! `design`. So a change below the least amplitude cannot be missed, and every further change above it is known too. The limit is
//! twice the largest of three amplitudes: that at which the fast slip is as fast as the surface (beyond it the contact reverses within every
//! cycle, and the verdict hardly changes), the last change by averaging, and the largest static friction of a contact, which a slow force
//! has to overcome. The dither of a prescribed load may at most lift it.

use std::fmt;

use quell_dynamics::orbit::{NoOrbit, ThresholdKind, sliding_state};
use quell_linear::averaging::{AveragingError, DitheredSystem};
use quell_model::profile::Wave;
use quell_model::system::{Input, InputTarget};
use quell_model::{Dither, System};
use quell_numerics::interval::RealInterval;

use crate::least_dither::{
    AmplitudeBranch, QuietAmplitudes, QuietChange, amplitude_branch, averaged_quiet,
};

/// Least number of steps of the continuation up to the limit.
const STEPS: u32 = 16;

/// The limit, relative to the larger of the two amplitudes that it is made of.
const BEYOND: f64 = 2.0;

/// Share of the load that a normal dither may take: at the whole load the contact opens.
const SHARE_OF_LOAD: f64 = 1.0 - 1e-9;

/// The verdict on the base response over the amplitude of a dither, from zero to a limit.
#[derive(Clone, Debug)]
pub struct Quench {
    /// The base response.
    pub branch: AmplitudeBranch,
    /// The amplitudes that are quiet by finite-R averaging, or why averaging has no value.
    pub averaged: Result<QuietAmplitudes, AveragingError>,
}

/// Why there is no quench amplitude.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotQuenched {
    /// Sliding is stable without this dither.
    QuietWithout,
    /// No amplitude up to the limit is quiet.
    NeverQuiet,
    /// The base response ends, or was lost, before a quiet amplitude.
    Ends,
}

/// Why the base response could not be followed.
#[derive(Clone, Debug, PartialEq)]
pub enum NoQuench {
    /// There is no dither.
    NoDither,
    /// The dither moves no contact.
    NoReach,
    /// There is no steady sliding to begin from.
    NoSteadySliding,
    /// There is no base response at zero amplitude: the dithers have no common period, say.
    NoBaseResponse,
    /// The engine stopped.
    Stalled,
    /// The limit has no value, because averaging has none.
    Averaging(AveragingError),
}

impl NotQuenched {
    /// A description.
    pub fn words(self) -> &'static str {
        match self {
            Self::QuietWithout => "steady sliding is stable without this dither",
            Self::NeverQuiet => {
                "the base response becomes stable at no amplitude up to the limit of the search"
            }
            Self::Ends => "the base response ends before it becomes stable",
        }
    }
}

impl fmt::Display for NotQuenched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words())
    }
}

impl fmt::Display for NoQuench {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDither => f.write_str("no dither acts"),
            Self::NoReach => f.write_str("the dither moves no contact that slides"),
            Self::NoSteadySliding => f.write_str("there is no steady sliding"),
            Self::NoBaseResponse => f.write_str("there is no base response"),
            Self::Stalled => f.write_str("the engine stopped"),
            Self::Averaging(why) => write!(f, "by averaging: {why}"),
        }
    }
}

impl Quench {
    /// The least amplitude from which the base response is stable.
    ///
    /// # Errors
    /// [`NotQuenched`].
    pub fn least(&self) -> Result<&QuietChange, NotQuenched> {
        match self.branch.changes.first() {
            _ if self.branch.quiet_at_first => Err(NotQuenched::QuietWithout),
            Some(first) => Ok(first),
            None if self.branch.end.is_some() => Err(NotQuenched::Ends),
            None => Err(NotQuenched::NeverQuiet),
        }
    }

    /// The amplitude at which the first quiet interval ends: the next change, or the end of the base response. `None` where it reaches
    /// the limit, and where no amplitude is quiet.
    pub fn lost(&self) -> Option<f64> {
        let loud = self.branch.changes.iter().find(|change| !change.becomes_quiet);
        let high = self.branch.quiet().intervals().first()?.upper;
        loud.map(|change| change.amplitude).or(self.branch.end.filter(|end| *end <= high))
    }

    /// The amplitude from which everything up to the limit is quiet: the quench amplitude where the quiet amplitudes are one interval.
    /// `None` where the limit itself is not quiet; 0 where every amplitude is.
    pub fn last(&self) -> Option<f64> {
        let intervals = self.branch.quiet();
        let RealInterval { lower: low, upper: high } = *intervals.intervals().last()?;
        (high == self.branch.range.upper).then_some(low)
    }

    /// The least quiet amplitude by finite-R averaging.
    ///
    /// # Errors
    /// [`NotQuenched`], or why averaging has no value.
    pub fn averaged(&self) -> Result<Result<f64, NotQuenched>, &AveragingError> {
        let quiet = self.averaged.as_ref()?;
        Ok(match quiet.intervals().first() {
            Some(RealInterval { lower: 0.0, .. }) => Err(NotQuenched::QuietWithout),
            Some(RealInterval { lower: low, .. }) => Ok(*low),
            None => Err(NotQuenched::NeverQuiet),
        })
    }
}

/// The kinds of bifurcation that may end a loud range, in the order of their codes in maps.
pub const QUENCH_KINDS: [&str; 8] = {
    let mut names = [""; 8];
    let mut index = 0;
    while index < ThresholdKind::ALL.len() {
        names[index] = ThresholdKind::ALL[index].name();
        index += 1;
    }
    names
};

/// The place of a kind in [`QUENCH_KINDS`].
pub fn quench_kind(kind: ThresholdKind) -> usize {
    ThresholdKind::ALL.iter().position(|other| *other == kind).unwrap_or(0)
}

/// The quench amplitude of a dither of a system, whose own amplitude does not matter.
///
/// # Errors
/// [`NoQuench`].
pub fn quench(system: &System, input: usize) -> Result<Quench, NoQuench> {
    if system.inputs.get(input).is_none_or(|input| input.profile.waves().is_empty()) {
        return Err(NoQuench::NoDither);
    }
    sliding_state(system).map_err(|_| NoQuench::NoSteadySliding)?;
    let limit = amplitude_limit(system, input)?;
    let at = |amplitude: f64| Ok(system.with_amplitude(input, amplitude));
    let branch = amplitude_branch(&at, RealInterval::new(0.0, limit), STEPS);
    let branch = branch.map_err(|why| no_branch(&why))?;
    let averaged = match not_fast(system) {
        Some(frequency_ratio) => Err(AveragingError::NotFast { frequency_ratio }),
        None => averaged_quiet(system, input, RealInterval::new(0.0, limit)),
    };
    Ok(Quench { branch, averaged })
}

/// The lowest frequency of the dither of one mass over its natural frequency, where it is not above it: no average is a first guess.
fn not_fast(system: &System) -> Option<f64> {
    let mass = system.one_averaged_mass()?;
    let ratios = mass.belt().dithers().iter().map(Dither::lowest_ratio);
    Some(ratios.fold(f64::INFINITY, f64::min)).filter(|lowest| *lowest <= 1.0)
}

/// Why a system has no branch over the amplitude.
fn no_branch(why: &NoOrbit) -> NoQuench {
    match why {
        NoOrbit::NoSliding(_) => NoQuench::NoSteadySliding,
        NoOrbit::Immobile(_) => NoQuench::Stalled,
        _ => NoQuench::NoBaseResponse,
    }
}

/// The largest amplitude of a dither that is followed: beyond it the verdict hardly changes.
///
/// # Errors
/// [`NoQuench`].
pub fn amplitude_limit(system: &System, input: usize) -> Result<f64, NoQuench> {
    if let InputTarget::NormalLoad { contact, .. } = system.inputs[input].target
        && system.contacts[contact].normal.is_none()
    {
        return limit_of_load(system, (input, contact));
    }
    let no_average = |why: AveragingError| match why {
        AveragingError::NoSteadySliding(_) => NoQuench::NoSteadySliding,
        why => NoQuench::Averaging(why),
    };
    let prepared = DitheredSystem::new(system).map_err(no_average)?;
    let corners = prepared.fast().corners(system, input).map_err(no_average)?;
    let corner = *corners.first().ok_or(NoQuench::NoReach)?;
    let averaged = prepared.critical_amplitudes(input).map_err(no_average)?;
    let last = averaged.iter().map(|critical| critical.amplitude).fold(0.0, f64::max);
    Ok(BEYOND * corner.max(last).max(static_friction(system, input)))
}

/// The amplitude of a force that is as large as the largest static friction of a contact; 0 for other inputs.
fn static_friction(system: &System, input: usize) -> f64 {
    let InputTarget::Force(row) = &system.inputs[input].target else { return 0.0 };
    let largest = row.iter().fold(0.0, |most: f64, share| most.max(share.abs()));
    let friction = system.contacts.iter().map(|contact| {
        contact.friction.static_coefficient() * contact.load().bounds().upper.max(0.0)
    });
    if largest > 0.0 { friction.fold(0.0, f64::max) / largest } else { 0.0 }
}

/// The amplitude of a dither that a prescribed load bears, where it and the others lift the load.
fn limit_of_load(system: &System, (input, contact): (usize, usize)) -> Result<f64, NoQuench> {
    let lift = |waves: &[Wave]| -> f64 {
        waves.iter().map(|wave| -wave.amplitude * wave.waveform.range().lower).sum()
    };
    let own = |other: &Input| matches!(other.target, InputTarget::NormalLoad { contact: of, .. } if of == contact);
    let others =
        system.inputs.iter().enumerate().filter(|(index, other)| *index != input && own(other));
    let taken: f64 = others.map(|(_, other)| lift(other.profile.waves())).sum();
    let one = lift(system.with_amplitude(input, 1.0).inputs[input].profile.waves());
    let limit = SHARE_OF_LOAD * (system.contacts[contact].normal_load - taken) / one;
    if one > 0.0 && limit > 0.0 { Ok(limit) } else { Err(NoQuench::NoReach) }
}
