//! A periodic motion: found near a state, or continued from steady sliding as the dither grows.

use std::fmt;

use num_complex::Complex64;
use quell_linear::steady::{NoSteadySliding, SteadySliding};
use quell_model::System;
use quell_numerics::continuation::branch::{End, Follow, follow};
use quell_numerics::continuation::shooting::{NotClosed, Shooting, fixed_point};
use quell_numerics::continuation::{multipliers, spectral_radius};
use quell_numerics::matrix::Matrix;
use quell_numerics::polar::modulus;

pub(crate) use super::family::scale_of;
use super::family::{MotionSignature, NoImage, OrbitFamily, shot, shot_within, time_of};
use super::verdict::OrbitVerdict;
use crate::motion::in_steady_sliding;
use crate::motion::{Immobile, MOTION_TOLERANCE, Motion, RecordedEvent};

/// Accuracy of an image, relative to the size of the state.
const NOISE: f64 = MOTION_TOLERANCE;

/// Tolerance of a second integration, whose multipliers are compared: their difference bounds the error of the first, which is
/// smaller by a factor of up to a thousand.
const COARSE_TOLERANCE: f64 = 1e3 * MOTION_TOLERANCE;

/// A periodic motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbit {
    /// State at t = 0.
    pub state: Vec<f64>,
    /// Period.
    pub period: f64,
    /// Largest mismatch of the state after a period.
    pub residual: f64,
    /// Estimated error of the state.
    pub state_error: f64,
    /// Multipliers, the largest modulus first; of a limit cycle the 1 of its phase included.
    pub multipliers: Vec<Complex64>,
    /// Derivative of the state after a period with respect to that at t = 0; `None` of a limit cycle, whose phase is free.
    pub monodromy: Option<Matrix>,
    /// Estimated error of the modulus of the deciding multiplier: its difference from an integration with a thousand times the
    /// tolerance, and an estimate of what the error of the state adds.
    pub multiplier_error: f64,
    /// Events over the period.
    pub events: Vec<RecordedEvent>,
    /// The sequence of events.
    pub signature: MotionSignature,
    /// Whether it is a limit cycle without dither, whose phase is free.
    pub is_free: bool,
    /// Whether independent events coincide, so that the multipliers are one-sided.
    pub is_one_sided: bool,
    judged: OrbitVerdict,
}

impl Orbit {
    /// Modulus of the multiplier that decides: the largest, without the 1 of a free phase.
    pub fn radius(&self) -> f64 {
        spectral_radius(&deciding(&self.multipliers, self.is_free))
    }

    /// The verdict of the multipliers: undecided where two integrations of different tolerance disagree about it. They need not agree
    /// about the multipliers, which nearly simultaneous events of an unstable motion make very sensitive.
    pub fn verdict(&self) -> OrbitVerdict {
        self.judged
    }
}

/// The multipliers without that of a free phase: the one nearest to 1.
fn deciding(multipliers: &[Complex64], is_free: bool) -> Vec<Complex64> {
    let mut others = multipliers.to_vec();
    if is_free {
        let distance = |place: &usize| modulus(multipliers[*place] - 1.0);
        let phase = (0..others.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        phase.map(|place| others.remove(place));
    }
    others
}

/// Why no periodic motion was found.
#[derive(Clone, Debug, PartialEq)]
pub enum NoOrbit {
    /// There is no dither: the response has no period of its own.
    NoDither,
    /// The motion cannot be computed.
    Immobile(Immobile),
    /// There is no steady sliding to continue from.
    NoSliding(NoSteadySliding),
    /// An iterate has no image.
    NoImage(NoImage),
    /// Newton's method did not converge.
    NotConverged {
        /// Number of steps.
        steps: u32,
        /// Least mismatch.
        residual: f64,
    },
    /// A multiplier is 1 to rounding, so that Newton's step is undefined.
    Degenerate {
        /// Number of steps.
        steps: u32,
        /// Mismatch there.
        residual: f64,
    },
    /// The derivative of the period map is not finite: the motion is too large for its numbers.
    NoMultipliers,
    /// The base response ends before the dither reaches its amplitude.
    Ends {
        /// Fraction of the amplitude up to which it exists.
        share: f64,
    },
    /// The base response could not be followed to the dither's amplitude.
    Lost {
        /// Fraction of the amplitude up to which it was followed.
        share: f64,
    },
    /// The run does not settle on a periodic motion.
    Unsettled {
        /// Number of periods after which it was given up.
        periods: u32,
        /// Its last states at whole periods, the latest last.
        last: Vec<Vec<f64>>,
        /// Whether the run no longer changes: it is on a motion that does not repeat itself. Otherwise where it ends is unknown.
        is_steady: bool,
    },
}

impl fmt::Display for NoOrbit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDither => f.write_str("without dither the response has no prescribed period"),
            Self::Immobile(why) => why.fmt(f),
            Self::NoSliding(why) => why.fmt(f),
            Self::NoImage(why) => why.fmt(f),
            Self::NotConverged { steps, residual } => {
                write!(
                    f,
                    "shooting did not converge in {steps} steps: least mismatch {residual:.1e}"
                )
            }
            Self::Degenerate { steps, residual } => write!(
                f,
                "shooting stopped after {steps} steps with a mismatch of {residual:.1e}: a multiplier is 1 there"
            ),
            Self::NoMultipliers => {
                f.write_str("the derivative of the motion over a period is not finite")
            }
            Self::Ends { share } => write!(
                f,
                "the base response ends at {:.4} % of the dither amplitude",
                100.0 * share
            ),
            Self::Lost { share } => write!(
                f,
                "the base response could not be followed beyond {:.4} % of the dither amplitude",
                100.0 * share
            ),
            Self::Unsettled { periods, is_steady: true, .. } => {
                write!(
                    f,
                    "the run ends on a motion that does not repeat itself: followed over {periods} periods of the dither, it has no period of \
                     up to 200 of them"
                )
            }
            Self::Unsettled { periods, is_steady: false, .. } => {
                write!(
                    f,
                    "the run has not settled within {periods} periods of the dither: it still changes"
                )
            }
        }
    }
}

impl std::error::Error for NoOrbit {}

impl NoOrbit {
    /// Whether the base response does not exist, as opposed to not having been found.
    pub fn is_absence(&self) -> bool {
        matches!(self, Self::Ends { .. } | Self::Degenerate { .. })
    }
}

impl From<NotClosed<NoImage>> for NoOrbit {
    fn from(why: NotClosed<NoImage>) -> Self {
        match why {
            NotClosed::TooManySteps { steps, residual, .. }
            | NotClosed::Strayed { steps, distance: residual, .. } => {
                Self::NotConverged { steps, residual }
            }
            NotClosed::Singular { steps, residual, .. } => Self::Degenerate { steps, residual },
            NotClosed::NoImage { why, .. } => Self::NoImage(why),
        }
    }
}

/// The orbit through a state that closes after a time.
pub(crate) fn orbit_at(
    motion: &Motion<'_>,
    state: &[f64],
    period: f64,
    is_free: bool,
) -> Result<Orbit, NoOrbit> {
    let (image, met) = shot(motion, state, period, None).map_err(NoOrbit::NoImage)?;
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let mismatch: Vec<f64> = image.state.iter().zip(state).map(|(to, from)| to - from).collect();
    let residual = largest(&mismatch);
    let found = multipliers(&image.derivative).ok_or(NoOrbit::NoMultipliers)?;
    let size = largest(state).max(f64::MIN_POSITIVE);
    let noise = residual + NOISE * size;
    let others = deciding(&found, is_free);
    let distances = others.iter().map(|z| modulus(*z - 1.0));
    let slowness = distances.fold(1.0, f64::min);
    // How the multiplier varies with the state is not known: it is taken to vary by itself over the size of the state. What the
    // integration leaves is measured.
    let by_state = noise / size / slowness;
    let radius = spectral_radius(&others);
    let coarse = shot_within(motion, state, period, None, COARSE_TOLERANCE).ok();
    let coarse = coarse.and_then(|(image, _)| multipliers(&image.derivative));
    let coarse = coarse.map_or(radius, |coarse| spectral_radius(&deciding(&coarse, is_free)));
    let verdicts = [radius, coarse].map(|radius| OrbitVerdict::of(radius, by_state));
    let judged = if verdicts[0] == verdicts[1] { verdicts[0] } else { OrbitVerdict::Undecided };
    Ok(Orbit {
        state: state.to_vec(),
        period,
        residual,
        state_error: noise / slowness,
        multiplier_error: by_state + (coarse - radius).abs(),
        multipliers: found,
        monodromy: (!is_free).then_some(image.derivative),
        events: met.events,
        signature: image.signature,
        is_free,
        is_one_sided: met.is_one_sided,
        judged,
    })
}

/// The orbit of `periods` common periods near a state at t = 0.
///
/// # Errors
/// [`NoOrbit`].
pub fn near(system: &System, guess: &[f64], periods: u32) -> Result<Orbit, NoOrbit> {
    let motion = Motion::new(system).map_err(NoOrbit::Immobile)?;
    let period = period_of(&motion, periods)?;
    let at = |_: &[f64]| Ok(system.clone());
    let scale = scale_of(&motion, guess);
    let family = OrbitFamily { at: &at, periods, size: guess.len(), scale };
    let found = fixed_point(&family, guess, &[], None, &Shooting::default())?;
    orbit_at(&motion, &found.state, period, false)
}

/// The orbit with the least part of its `periods` common periods after which it repeats itself; `None` if it has no shorter period. `is_same`
/// decides whether an orbit near its state is it.
pub fn shortened(
    system: &System,
    orbit: &Orbit,
    periods: u32,
    is_same: impl Fn(&Orbit) -> bool,
) -> Option<(u32, Orbit)> {
    let mut parts = (1..periods).filter(|part| periods.is_multiple_of(*part));
    parts.find_map(|part| {
        let shorter = near(system, &orbit.state, part).ok().filter(&is_same)?;
        Some((part, shorter))
    })
}

/// The common period, of a system that has one.
pub(super) fn period_of(motion: &Motion<'_>, periods: u32) -> Result<f64, NoOrbit> {
    if !motion.system().has_waves() {
        return Err(NoOrbit::NoDither);
    }
    time_of(motion, periods.max(1)).map_err(NoOrbit::NoImage)
}

/// Shares of the dither on both sides of 1 between which a branch that changes there may be lost: the response at 1 is then sought from
/// one beyond the change. Next to a grazing the steps of a continuation become smaller than the rounding of their ends. This is a hundred
/// times the 10⁻⁶ within which responses were seen to be lost; of a smaller value they are reported as lost.
const NEXT_TO_A_CHANGE: f64 = 1e-4;

/// Share of the dither, over that of a change, from which a response at 1 is sought where the branch ends at the change: where a stick begins
/// with a static level above μ(0⁺) no response exists next to the grazing, and the branch goes on up to 2 % beyond it. This is twice that. With a
/// smaller value a response just beyond such a gap is taken for none; a larger one only costs time where none exists.
const BEYOND_A_GAP: f64 = 0.04;

/// The base response: the orbit that continues steady sliding as the dither grows from zero, followed in the common factor of
/// all amplitudes in at least `steps` steps.
///
/// # Errors
/// [`NoOrbit`].
pub fn base_response(system: &System, steps: u32) -> Result<Orbit, NoOrbit> {
    let motion = Motion::new(system).map_err(NoOrbit::Immobile)?;
    let period = period_of(&motion, 1)?;
    let sliding = sliding_state(system).map_err(NoOrbit::NoSliding)?;
    let grown = |to: f64| followed(&motion, &sliding, 0.0, to, steps);
    let (why, changes_at) = match grown(1.0) {
        Ok(Ok(state)) => return orbit_at(&motion, &state, period, false),
        Ok(Err(lost)) => lost,
        Err(why) => return Err(why),
    };
    if (changes_at - 1.0).abs() < NEXT_TO_A_CHANGE {
        return match grown(1.0 + NEXT_TO_A_CHANGE) {
            Ok(Ok(state)) => near(system, &state, 1).map_err(|_| why),
            _ => Err(why),
        };
    }
    let beyond = changes_at * (1.0 + BEYOND_A_GAP);
    if changes_at < 1.0
        && beyond > 1.0
        && let Ok(Ok(farther)) = grown(beyond)
        && let Ok(Ok(state)) = followed(&motion, &farther, beyond, 1.0, steps)
    {
        return orbit_at(&motion, &state, period, false);
    }
    Err(why)
}

/// The state of the base response under a share of the dither, followed from a state under another one; or why it is lost on the way, and
/// the share at which the branch changes last.
fn followed(
    motion: &Motion<'_>,
    first: &[f64],
    from: f64,
    to: f64,
    steps: u32,
) -> Result<Result<Vec<f64>, (NoOrbit, f64)>, NoOrbit> {
    let at = |factor: &[f64]| Ok(motion.system().with_amplitudes_scaled(factor[0]));
    let scale = scale_of(motion, first);
    let family = OrbitFamily { at: &at, periods: 1, size: first.len(), scale };
    let options = Follow::window(from, to, steps).only_forwards();
    let branch = follow(&family, first, from, to > from, options)?;
    let turns = branch.special_points.iter().find(|point| point.is_turn());
    let why = match (turns, branch.end) {
        (Some(turn), _) => NoOrbit::Ends { share: turn.parameter },
        (None, End::Window { at }) if at == to => {
            let last = branch.points.last().ok_or(NoOrbit::Ends { share: 0.0 })?;
            return Ok(Ok(last.state.clone()));
        }
        (None, End::Grazing { at } | End::TurnsBack { at }) => NoOrbit::Ends { share: at },
        (None, End::Lost { at } | End::TooLong { at }) => NoOrbit::Lost { share: at },
        (None, End::Window { .. } | End::Closed) => NoOrbit::Ends { share: 0.0 },
    };
    let changes_at = branch.special_points.last().map_or(0.0, |point| point.parameter);
    Ok(Err((why, changes_at)))
}

/// Distance from steady sliding, relative to its state and the velocities of the surfaces, within which a state is on it: the distance
/// within which a state of a belt counts as its base response. It is far above the error of a run and of a start written with seven
/// digits, and far below any limit cycle that can be observed. With a smaller value a start given in digits would be taken for a
/// vibration while it slowly leaves unstable sliding; with a larger one a small vibration would be taken for sliding.
const ON_SLIDING: f64 = 1e-6;

/// Whether a state is that of steady sliding; `false` where the system has none.
pub fn is_on_sliding(system: &System, state: &[f64]) -> bool {
    let Ok(sliding) = sliding_state(system) else { return false };
    let speeds = system.contacts.iter().map(|contact| contact.surface_velocity.mean().abs());
    let size = sliding.iter().map(|value| value.abs()).chain(speeds).fold(0.0, f64::max);
    sliding.iter().zip(state).all(|(a, b)| (a - b).abs() <= ON_SLIDING * size)
}

/// Steady sliding without dither as a state.
///
/// # Errors
/// [`NoSteadySliding`].
pub fn sliding_state(system: &System) -> Result<Vec<f64>, NoSteadySliding> {
    let steady = SteadySliding::new(system)?;
    let mut state = steady.position.clone();
    state.resize(system.structure.state_size(), 0.0);
    for (contact, steady) in system.contacts.iter().zip(&steady.contacts) {
        state.extend(in_steady_sliding(contact, steady));
    }
    Ok(state)
}
