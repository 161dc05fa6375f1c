//! Periodic responses, exactly: Newton shooting on the period map, Floquet multipliers through stick and slip.
//!
//! The steady response to periodic dither is a fixed point of the map over one common period (or n of them). Its stability
//! is decided by the multipliers of the map's derivative, which `variation` carries along the run with a jump at
//! every event; neither averaging nor a long simulation is needed. In pure slip det M = exp(−∮(2ζ + μ′N)dτ); with a
//! stick one multiplier is 0, because the mass leaves it at one state whatever came before.
//!
//! Shooting, branches and thresholds are the mathematics of [`quell_numerics::continuation`]; [`family`] tells it
//! what a belt does in a period, and is what a model with more masses and contacts would write anew.
//!
//! * [`threshold`]: the values of a parameter at which the response of sliding gains or loses stability;
//! * [`curve`]: curves of thresholds in two parameters;
//! * [`cycle`]: the limit cycles of an undithered belt, stable or not;
//! * [`reached`]: where a run from a given start ends, and on what orbit.

mod collocation;
pub mod curve;
pub mod cycle;
pub mod family;
pub mod reached;
pub mod threshold;
mod variation;

use std::f64::consts::TAU;
use std::fmt;

use quell_model::Belt;
use quell_numerics::continuation::branch::{End, Follow, follow};
use quell_numerics::continuation::shooting::{NotClosed, Shooting, fixed_point};

use crate::simulation::{EventKind, FinalState, Stalled, Start, simulate};
use family::{Forced, Setting, Signature};
pub use variation::Matrix;
use variation::Variation;

/// Bound on the last retained Taylor terms of a step while shooting, relative to F.
const TOLERANCE: f64 = 1e-14;

/// Frequencies whose ratio is a fraction with a denominator up to this are commensurate.
const DENOMINATORS: u32 = 64;

/// Multipliers this near to modulus 1 leave the verdict open.
const UNDECIDED: f64 = 1e-9;

/// Whether small changes of a periodic response die out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Every multiplier lies inside the unit circle.
    Stable,
    /// One lies outside.
    Unstable,
    /// The largest lies on it, within the error.
    Undecided,
}

impl Verdict {
    /// Of an orbit whose largest multiplier has this modulus.
    pub fn of(radius: f64) -> Self {
        match radius {
            radius if radius > 1.0 + UNDECIDED => Self::Unstable,
            radius if radius < 1.0 - UNDECIDED => Self::Stable,
            _ => Self::Undecided,
        }
    }

    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stable => "stable",
            Self::Unstable => "unstable",
            Self::Undecided => "undecided",
        }
    }
}

/// A periodic response.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbit {
    /// State at τ = 0, where the dither has its phase φ.
    pub start: Start,
    /// Length in τ: a whole number of common periods of the dithers.
    pub period: f64,
    /// Mismatch of x and x′ after the period, the larger one, a length.
    pub residual: f64,
    /// Derivative of the period map: rows (x, x′) at its end, columns (x, x′) at its start.
    pub monodromy: Matrix,
    /// Its eigenvalues (re, im), the larger modulus first.
    pub multipliers: [(f64, f64); 2],
    /// Events of a period in order, with the sign of v_r afterwards: the signature of the orbit.
    pub events: Vec<(EventKind, i8)>,
    /// ∮(2ζ + μ′N)dτ over slip, dimensionless: in pure slip det M = e to minus this.
    pub damping: f64,
    /// Least |v_r| inside slip, a velocity ≥ 0, and the τ of it; `None` for an orbit in stick throughout.
    pub least_slip: Option<(f64, f64)>,
    /// Share of the period spent in stick.
    pub stick_fraction: f64,
    /// Sign of v_r at its end.
    pub slip_sign: i8,
    /// Whether its phase is free: a limit cycle without dither, one multiplier of which is 1, along it.
    pub is_free: bool,
}

impl Orbit {
    /// Modulus of the multiplier that decides: the larger one; of a free orbit the one that is not 1.
    pub fn radius(&self) -> f64 {
        let off = |(re, im): (f64, f64)| libm::hypot(re - 1.0, im);
        let [larger, smaller] = self.multipliers;
        let (re, im) = if self.is_free && off(smaller) > off(larger) { smaller } else { larger };
        libm::hypot(re, im)
    }

    /// The same with a free phase.
    fn free(self) -> Self {
        Self { is_free: true, ..self }
    }

    /// What happens along its period.
    pub fn signature(&self) -> Signature {
        let stuck = self.stick_fraction * self.period;
        Signature::of(&self.events, stuck, self.slip_sign)
    }

    /// What the multipliers say.
    pub fn verdict(&self) -> Verdict {
        Verdict::of(self.radius())
    }

    /// Whether it never touches v_r = 0.
    pub fn is_pure_slip(&self) -> bool {
        self.events.is_empty() && self.stick_fraction == 0.0
    }

    /// Number of events of a kind in a period.
    pub fn count(&self, kind: EventKind) -> usize {
        self.events.iter().filter(|(it, _)| *it == kind).count()
    }
}

/// Why there is no periodic response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoOrbit {
    /// There is no dither: the response has no period of its own.
    NoDither,
    /// Frequencies of the dithers have no common period.
    Incommensurate,
    /// Newton's method did not come to an end.
    NotConverged {
        /// Steps taken.
        steps: u32,
        /// Mismatch at the last one.
        residual: f64,
        /// Where it was then.
        at: Start,
    },
    /// A multiplier is 1 to rounding, so that Newton's method has no step.
    Degenerate {
        /// Steps taken.
        steps: u32,
        /// Mismatch there.
        residual: f64,
        /// Where it was then.
        at: Start,
    },
    /// An orbit was found, but not the one that was meant.
    Another {
        /// Its distance from where the orbit should be.
        distance: f64,
        /// Where it is.
        at: Start,
    },
    /// The response that sliding becomes ends before the dither has its amplitude.
    Ends {
        /// Share of the amplitude up to which there is one.
        share: f64,
    },
    /// The response that sliding becomes could not be followed until the dither has its amplitude.
    LostOnTheWay {
        /// Share of the amplitude up to which it was followed.
        share: f64,
    },
    /// The run does not come back to itself within this number of common periods.
    NoPeriod {
        /// The number.
        most: u32,
    },
    /// The turns of an undithered run come to no limit cycle that is known, nor to stable steady sliding.
    NoLimit,
    /// A parameter cannot take this value.
    Invalid {
        /// The value.
        value: f64,
    },
    /// The engine stopped.
    Stalled(Stalled),
}

impl fmt::Display for NoOrbit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDither => f.write_str("without dither the response has no period given to it"),
            Self::Incommensurate => {
                f.write_str("the frequencies of the dithers have no common period")
            }
            Self::NotConverged { steps, residual, at } => write!(
                f,
                "shooting stopped after {steps} steps at x = {}, x′ = {} with a mismatch of {residual:.1e}",
                at.displacement, at.velocity
            ),
            Self::Degenerate { steps, residual, at } => write!(
                f,
                "shooting stopped after {steps} steps at x = {}, x′ = {} with a mismatch of {residual:.1e}: \
                 a multiplier is 1 there",
                at.displacement, at.velocity
            ),
            Self::Another { distance, at } => write!(
                f,
                "shooting found an orbit at x = {}, x′ = {}, but {distance:.1e} from where it should be: another one",
                at.displacement, at.velocity
            ),
            Self::Ends { share } => write!(
                f,
                "the response that sliding becomes ends when the dither has {share:.7} of its amplitude: \
                 there is none beyond; look near a state, or for what a run ends on"
            ),
            Self::LostOnTheWay { share } => write!(
                f,
                "the response that sliding becomes could not be followed beyond {share:.7} of the dither's amplitude"
            ),
            Self::NoPeriod { most } => write!(
                f,
                "the run does not come back to itself within {most} periods of the dither: \
                 it is slow, locked at a longer period, or not periodic"
            ),
            Self::NoLimit => f.write_str(
                "the turns of the run come to no limit cycle that is known, nor to stable steady sliding",
            ),
            Self::Invalid { value } => write!(f, "a parameter cannot be {value}"),
            Self::Stalled(stalled) => stalled.fmt(f),
        }
    }
}

impl std::error::Error for NoOrbit {}

impl From<NotClosed<NoOrbit>> for NoOrbit {
    fn from(why: NotClosed<NoOrbit>) -> Self {
        let start = |at: &[f64]| family::start_of(at);
        match why {
            NotClosed::TooManySteps { steps, residual, at } => {
                Self::NotConverged { steps, residual, at: start(&at) }
            }
            NotClosed::Singular { steps, residual, at } => {
                Self::Degenerate { steps, residual, at: start(&at) }
            }
            NotClosed::Strayed { distance, at, .. } => Self::Another { distance, at: start(&at) },
            NotClosed::NoImage { why, .. } => why,
        }
    }
}

/// The common period of the dithers.
///
/// # Errors
/// [`NoOrbit::NoDither`], [`NoOrbit::Incommensurate`].
pub fn common_period(belt: &Belt) -> Result<f64, NoOrbit> {
    let rates: Vec<f64> = belt.dithers().iter().map(|dither| dither.frequency_ratio).collect();
    let Some(&first) = rates.first() else { return Err(NoOrbit::NoDither) };
    for count in 1..=DENOMINATORS {
        let period = f64::from(count) * TAU / first;
        let whole = |rate: &f64| {
            let turns = rate * period / TAU;
            (turns - turns.round()).abs() <= 1e-12 * turns.max(1.0)
        };
        if rates.iter().all(whole) {
            return Ok(period);
        }
    }
    Err(NoOrbit::Incommensurate)
}

/// Where a run of one period ends, and how changes travel along it.
fn shot(belt: &Belt, start: Start, period: f64) -> Result<(FinalState, Variation<'_>), NoOrbit> {
    let mut variation = Variation::new(belt);
    let until = start.time + period;
    let end = simulate(belt, start, until, TOLERANCE, &mut variation).map_err(NoOrbit::Stalled)?;
    Ok((end, variation))
}

/// The orbit of `periods` common periods near a state at τ = 0.
///
/// # Errors
/// [`NoOrbit`].
pub fn near(belt: &Belt, guess: Start, periods: u32) -> Result<Orbit, NoOrbit> {
    let forced = Forced { belt, setting: Setting::Given, periods: periods.max(1) };
    let longest = (belt.belt_velocity() / belt.normal_load()).max(1.0);
    let shooting = Shooting { longest_step: longest, ..Shooting::default() };
    let guess = [guess.displacement, guess.velocity];
    let found = fixed_point(&forced, &guess, &[], None, &shooting)?;
    orbit_at(belt, &found.state, forced.period_of(belt)?)
}

/// The orbit of a state that is known to close.
fn orbit_at(belt: &Belt, state: &[f64], period: f64) -> Result<Orbit, NoOrbit> {
    let start = family::start_of(state);
    let (end, variation) = shot(belt, start, period)?;
    let mismatch = [end.displacement - start.displacement, end.velocity - start.velocity];
    let residual = mismatch[0].abs().max(mismatch[1].abs());
    Ok(orbit_of(start, period, residual, &end, &variation))
}

fn orbit_of(
    start: Start,
    period: f64,
    residual: f64,
    end: &FinalState,
    variation: &Variation<'_>,
) -> Orbit {
    Orbit {
        start,
        period,
        residual,
        monodromy: variation.matrix,
        multipliers: multipliers_of(&variation.matrix),
        events: variation.events.clone(),
        damping: variation.damping,
        // A run stays on its side of v_r = 0: what is below is rounding at an event.
        least_slip: variation.least.map(|(least, time)| (least.max(0.0), time)),
        stick_fraction: variation.stuck / period,
        slip_sign: end.slip_sign,
        is_free: false,
    }
}

/// Multipliers of a period map, the larger modulus first.
pub(crate) fn multipliers_of(matrix: &Matrix) -> [(f64, f64); 2] {
    let found = quell_numerics::continuation::multipliers(&family::matrix_of(matrix));
    let both = found.filter(|found| found.len() == 2).map(|found| [found[0], found[1]]);
    // A matrix that is not finite has none; a run that ended has a finite one.
    both.map_or([(f64::INFINITY, 0.0); 2], |both| both.map(|it| (it.re, it.im)))
}

/// The orbit that sliding without dither becomes when the dither grows from nothing: followed along the share of all
/// amplitudes at once in at least `steps` steps, around folds and through touches of v_r = 0.
///
/// # Errors
/// [`NoOrbit::Ends`] where the branch ends before the amplitudes are reached, [`NoOrbit::LostOnTheWay`] where it is lost.
pub fn from_sliding(belt: &Belt, steps: u32) -> Result<Orbit, NoOrbit> {
    let forced = Forced { belt, setting: Setting::Share, periods: 1 };
    let period = forced.period_of(belt)?;
    let branch =
        follow(&forced, &[belt.steady_sliding(), 0.0], 0.0, true, Follow::window(0.0, 1.0, steps))?;
    // Where the branch turns back the response that grew from sliding is over, wherever the branch goes on to.
    let turn = branch.passages.iter().find(|it| it.below.is_none() || it.above.is_none());
    if let Some(turn) = turn {
        return Err(NoOrbit::Ends { share: turn.parameter });
    }
    match branch.end {
        End::Window { at: 1.0 } => {}
        End::Touch { at } => return Err(NoOrbit::Ends { share: at }),
        End::Lost { at } | End::TooLong { at } => {
            return Err(NoOrbit::LostOnTheWay { share: at });
        }
        End::Window { .. } | End::Closed => return Err(NoOrbit::Ends { share: 0.0 }),
    }
    let last = branch.points.last().ok_or(NoOrbit::Ends { share: 0.0 })?;
    orbit_at(belt, &last.state, period)
}

/// The response that sliding becomes; without dither steady sliding itself, as the fixed point of the flow over unit time.
pub(crate) fn quiet(belt: &Belt, steps: u32) -> Result<Orbit, NoOrbit> {
    if !belt.dithers().is_empty() {
        return from_sliding(belt, steps);
    }
    orbit_at(belt, &[belt.steady_sliding(), 0.0], 1.0)
}
