//! Mean friction of a contact with a state of its own, whose slip is prescribed.
//!
//! Averaging of a law of the slip velocity is a mean over the phase of the dither. With a state the friction of one moment depends on
//! the moments before, so that the mean is that of a periodic motion: γ = V − αG(Rτ) and N = F + D_N g_N(R_Nτ) are prescribed, as
//! in the limit of high frequency, and the state of the contact follows them.
//!
//! * Bristles: ż is linear in z under a prescribed slip, so that two periods give the periodic state exactly. A method for stiff
//!   equations computes them (`bristles`), because fast slip makes them far faster than the dither.
//! * Elastic sliders: computed by the event-exact engine on a structure that the contact does not move, ẋ = D g(Rτ). A slider that slides forgets its state. From its bound in the direction of V the run is periodic after the
//!   periods that it takes to slide. At V = 0 a slider that does not slide in both directions keeps any state: no mean.
//!
//! Accuracy: that of the steps, about 10⁻¹² of μ_s, and the last change of an elastic slider from period to period. Slopes are
//! differences of fourth order, with the difference to those of twice the step as their error.

mod bristles;

use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::fmt;

use quell_linear::averaging::{Effective, SlopeSide};
use quell_linear::pure_slip::period;
use quell_model::friction::{Bristles, SlidingLaw};
use quell_model::profile::Profile;
use quell_model::system::{Contact, Input, InputTarget, StateSpace, Structure, System};
use quell_model::{Belt, Direction, Friction};
use quell_numerics::matrix::Matrix;

use bristles::Bristled;

use crate::motion::{ContactMeter, MOTION_TOLERANCE, Motion, MotionStart, MotionStopped};

/// Most periods that an elastic slider may take to its periodic motion.
const MOST_PERIODS: usize = 4000;

/// Most periods of the dither that a motion of an elastic slider may take to repeat itself: under a falling law it jumps at its release,
/// and a soft slider that slips slowly is released only once in many periods.
const MOST_MULTIPLE: usize = 1000;

/// Change of the mean friction coefficient from period to period, over μ_s, at which a motion is periodic.
const PERIODIC: f64 = 1e-11;

/// Step of the differences that give slopes, over the largest slip speed.
const STEP: f64 = 1e-3;

/// Share of its state that bristles keep over a period above which the periodic state is not known.
const KEPT: f64 = 1.0 - 1e-9;

/// Steps of bristles in a cycle of the fastest oscillation of the dither, before any is halved.
const STEPS: f64 = 16.0;

/// Most steps of bristles over a period, a second of computation. Ordinary periods take some hundreds for each of their cycles.
const MOST_STEPS: u32 = 1 << 21;

/// Why a contact with a state has no mean friction.
#[derive(Clone, Debug, PartialEq)]
pub enum NoMeanFriction {
    /// The dithers have no common period.
    NoPeriod,
    /// The motion of the state could not be computed.
    Stopped(MotionStopped),
    /// The contact cannot be simulated.
    Immobile(String),
    /// The contact keeps the state with which it began.
    History,
    /// A period of the dither has too many cycles.
    TooLong,
    /// No periodic motion was found.
    NotPeriodic {
        /// Number of periods computed.
        periods: usize,
    },
}

impl fmt::Display for NoMeanFriction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPeriod => f.write_str("the frequencies of the dithers have no common period"),
            Self::Stopped(why) => why.fmt(f),
            Self::Immobile(why) => f.write_str(why),
            Self::History => f.write_str(
                "the contact keeps the state with which it began, so that the mean depends on its history: without a mean slip it \
                 slides in one direction at most",
            ),
            Self::TooLong => f.write_str(
                "a common period of the dithers takes too many steps: it has too many of their cycles",
            ),
            Self::NotPeriodic { periods } => {
                write!(
                    f,
                    "the state of the contact repeats itself after none of up to {MOST_MULTIPLE} periods of the dither, looked for over \
                     {periods} of them"
                )
            }
        }
    }
}

impl std::error::Error for NoMeanFriction {}

impl From<MotionStopped> for NoMeanFriction {
    fn from(why: MotionStopped) -> Self {
        Self::Stopped(why)
    }
}

/// The mean of T/F, and its slope, of a belt whose contact has a state, at the mean slip velocity V: in the periodic motion of the
/// state under γ = V − αG(Rτ) and the load over time.
///
/// # Errors
/// [`NoMeanFriction`] with the reason.
pub fn mean_friction(belt: &Belt, slip_velocity: f64) -> Result<Effective, NoMeanFriction> {
    let [coefficient, error] = coefficient_at(belt, slip_velocity)?;
    let step = STEP * (slip_velocity.abs() + belt.fast_velocity());
    let difference = |step: f64| -> Result<f64, NoMeanFriction> {
        let at =
            |place: f64| coefficient_at(belt, slip_velocity + place * step).map(|[mean, _]| mean);
        let (inner, outer) = (at(1.0)? - at(-1.0)?, at(2.0)? - at(-2.0)?);
        Ok((8.0 * inner - outer) / (12.0 * step))
    };
    let (slope, coarse) = match (difference(step), difference(2.0 * step)) {
        (Ok(slope), Ok(coarse)) => (slope, coarse),
        (Err(why), _) | (_, Err(why)) => return Err(why),
    };
    Ok(Effective {
        coefficient,
        coefficient_error: error,
        slope,
        slope_error: (slope - coarse).abs() + 2.0 * error / step,
        side: SlopeSide::Both,
    })
}

/// The mean of T/F and its error.
fn coefficient_at(belt: &Belt, slip_velocity: f64) -> Result<[f64; 2], NoMeanFriction> {
    let level = belt.friction().static_coefficient();
    let period = match period(&belt.system()) {
        Some(period) => period,
        // Nothing varies in time.
        None if belt.fast_velocity() == 0.0 => 1.0,
        None => return Err(NoMeanFriction::NoPeriod),
    };
    if let (Some(bristles), Friction::Lugre(law)) = (belt.friction().bristles(), belt.friction()) {
        let steady = law.level();
        let level_at = |speed: f64| steady.coefficient(speed);
        let mean = of_bristles(belt, (slip_velocity, period), bristles, &level_at)?;
        return Ok([mean, 1e-12 * level]);
    }
    let system = prescribed(belt, slip_velocity);
    let motion = Motion::new(&system).map_err(|why| NoMeanFriction::Immobile(why.to_string()))?;
    let run =
        Prescribed { motion: &motion, period, load: belt.normal_load(), fast: fast_at(belt, 0.0) };
    let bound = level * belt.normal_load_at(0.0);
    let mean = run.of_slider(bound.copysign(slip_velocity), level)?;
    if slip_velocity == 0.0 {
        let other = run.of_slider(-bound, level)?;
        if (mean - other).abs() > 1e-9 * level {
            return Err(NoMeanFriction::History);
        }
    }
    Ok([mean, 2.0 * PERIODIC * level])
}

/// The fast velocity Σ αG(Rτ + φ) of the tangential dithers.
fn fast_at(belt: &Belt, time: f64) -> f64 {
    belt.dithers_along(Direction::Tangential)
        .map(|dither| {
            let phase = dither.frequency_ratio.mul_add(time, dither.phase);
            dither.amplitude_ratio() * dither.waveform.integral(phase)
        })
        .sum()
}

/// The mean of T/F of bristles: z after a period is a z + b.
fn of_bristles(
    belt: &Belt,
    (slip_velocity, period): (f64, f64),
    Bristles { stiffness, damping, viscous }: Bristles,
    level: &dyn Fn(f64) -> f64,
) -> Result<f64, NoMeanFriction> {
    let slip = |time: f64| slip_velocity - fast_at(belt, time);
    let load = |time: f64| belt.normal_load_at(time) / belt.normal_load();
    let most = belt.friction().static_coefficient();
    let reached = slip_velocity.abs() + belt.fast_velocity();
    let sizes = [most / stiffness, (damping + viscous).mul_add(reached, most)];
    let driven = Bristled { slip: &slip, load: &load, level, stiffness, damping, viscous, sizes };
    let fastest = belt.dithers().iter().fold(0.0, |rate: f64, dither| {
        let pieces = dither.waveform.breaks().len() as f64;
        rate.max(dither.resolved_ratio()).max(dither.repetition_ratio() * pieces / STEPS)
    });
    let wanted = STEPS * (period * fastest / TAU).max(1.0);
    let mut steps = 1_u32;
    while f64::from(steps) < wanted && steps < MOST_STEPS {
        steps *= 2;
    }
    let over = |deflection: f64| {
        let found = driven.over(deflection, period, steps, MOST_STEPS);
        found.ok_or(NoMeanFriction::TooLong)
    };
    let (constant, _) = over(0.0)?;
    if constant == 0.0 {
        return Ok(over(0.0)?.1);
    }
    let kept = (over(constant)?.0 - constant) / constant;
    if kept.is_nan() || kept >= KEPT {
        return Err(NoMeanFriction::History);
    }
    let periodic = constant / (1.0 - kept);
    // One more period removes what the difference has lost to rounding.
    Ok(over(over(periodic)?.0)?.1)
}

/// The contact of a belt on a velocity that the dither alone moves.
fn prescribed(belt: &Belt, slip_velocity: f64) -> System {
    let System { contacts, inputs, .. } = belt.system();
    let matrix = Matrix::from_fn(1, 1, |_, _| 0.0);
    let contacts = contacts.into_iter().map(|contact| Contact {
        tangent: Some(vec![1.0]),
        force: Some(vec![0.0]),
        surface_velocity: Profile::constant(slip_velocity),
        ..contact
    });
    let inputs = inputs.into_iter().map(|input| match input.target {
        InputTarget::Force(_) => Input { target: InputTarget::Force(vec![1.0]), ..input },
        _ => input,
    });
    System {
        structure: Structure::StateSpace(StateSpace::new(vec!["velocity".to_owned()], matrix)),
        contacts: contacts.collect(),
        inputs: inputs.collect(),
    }
}

/// Runs over one period from a state of the contact.
struct Prescribed<'a> {
    motion: &'a Motion<'a>,
    period: f64,
    load: f64,
    fast: f64,
}

impl Prescribed<'_> {
    /// The state of the contact after a period, and the mean of T/F over it.
    fn over(&self, own: f64) -> Result<(f64, f64), NoMeanFriction> {
        let start = MotionStart { time: 0.0, state: vec![self.fast, own] };
        let mut meter = ContactMeter::new(1);
        let end = self.motion.run(&start, self.period, MOTION_TOLERANCE, &mut meter)?;
        let mean = meter.means().and_then(|means| Some(means.first()?.friction / self.load));
        Ok((end.state[1], mean.unwrap_or(0.0)))
    }

    /// An elastic slider: period by period from a state at its bound, until it repeats itself after one or several periods.
    fn of_slider(&self, start: f64, level: f64) -> Result<f64, NoMeanFriction> {
        let mut recent = VecDeque::from([self.over(start)?]);
        for _ in 0..MOST_PERIODS {
            let found = self.over(recent[0].0)?;
            let repeats = |(own, mean): &(f64, f64)| {
                (found.0 - own).abs() <= PERIODIC * level * self.load
                    && (found.1 - mean).abs() <= PERIODIC * level
            };
            if let Some(before) = recent.iter().position(repeats) {
                let others: f64 = recent.iter().take(before).map(|(_, mean)| mean).sum();
                return Ok((found.1 + others) / (before + 1) as f64);
            }
            recent.push_front(found);
            recent.truncate(MOST_MULTIPLE);
        }
        Err(NoMeanFriction::NotPeriodic { periods: MOST_PERIODS })
    }
}
