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
//! * [`cycle`]: the limit cycles of an undithered belt, stable or not, and where undithered runs end.

mod accuracy;
mod collocation;
pub mod curve;
pub mod cycle;
pub mod family;
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

/// Least error of a multiplier's modulus: that of the collocation of `variation`, 10⁻¹⁰ against differences, and some room.
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
    /// Of an orbit whose largest multiplier has this modulus with this error (at least 10⁻⁹ is presumed).
    pub fn of(radius: f64, error: f64) -> Self {
        let error = error.max(UNDECIDED);
        match radius {
            radius if radius > 1.0 + error => Self::Unstable,
            radius if radius < 1.0 - error => Self::Stable,
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
    /// Estimated error of the state, a length: twice the mismatch over |1 − λ| of the multiplier λ nearest to 1.
    pub state_error: f64,
    /// Estimated error of the modulus of the multiplier that decides: its change over the state's error. Infinite where
    /// the state is too uncertain to say.
    pub multiplier_error: f64,
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
    /// Modulus of the multiplier that decides: the larger one; of a free orbit the one across it.
    pub fn radius(&self) -> f64 {
        let slides = self.is_pure_slip();
        deciding(self.multipliers, self.is_free, slides.then_some(self.damping))
    }

    /// What happens along its period.
    pub fn signature(&self) -> Signature {
        let stuck = self.stick_fraction * self.period;
        Signature::of(&self.events, stuck, self.slip_sign)
    }

    /// What the multipliers say.
    pub fn verdict(&self) -> Verdict {
        Verdict::of(self.radius(), self.multiplier_error)
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

/// Why a run has not settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Unsettled {
    /// It still moved when its periods were over.
    Moving,
    /// It dwells in slip where areas grow: beside an unstable curve between two basins.
    Dwelling,
}

impl Unsettled {
    /// In words.
    pub fn about(self) -> &'static str {
        match self {
            Self::Moving => "it still moved when its periods were over",
            Self::Dwelling => "it dwells beside an unstable curve between two basins",
        }
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
    /// The run ends on a response that does not return to itself within this number of common periods.
    NoPeriod {
        /// The number.
        most: u32,
    },
    /// The run comes to rest on a belt that does not move.
    AtRest,
    /// The run had not settled when its periods were over.
    Unsettled(Unsettled),
    /// The undithered run converges neither to a known limit cycle nor to stable steady sliding.
    NoLimit,
    /// A parameter cannot take this value.
    Invalid {
        /// The value.
        value: f64,
    },
    /// The engine stopped.
    Stalled(Stalled),
}

impl NoOrbit {
    /// Whether this says that the base response does not exist, rather than that it was not found.
    pub fn is_absence(&self) -> bool {
        matches!(self, Self::Ends { .. } | Self::Degenerate { .. } | Self::Another { .. })
    }
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
                "the base response ends at {} of the dither's amplitude: there is none beyond; look near a state, or \
                 for what a run ends on",
                rounded(*share)
            ),
            Self::LostOnTheWay { share } => write!(
                f,
                "the base response could not be followed beyond {} of the dither's amplitude",
                rounded(*share)
            ),
            Self::NoPeriod { most } => write!(
                f,
                "the run ends on a response that does not repeat within {most} periods of the dither: \
                 it is quasi-periodic, or locked at a longer period"
            ),
            Self::AtRest => {
                f.write_str("without dither the mass comes to rest on a belt that does not move: there is no orbit")
            }
            Self::Unsettled(why) => write!(f, "the run has not settled: {}", why.about()),
            Self::NoLimit => f.write_str(
                "the run converges neither to a known limit cycle nor to stable steady sliding",
            ),
            Self::Invalid { value } => write!(f, "a parameter cannot be {value}"),
            Self::Stalled(stalled) => stalled.fmt(f),
        }
    }
}

/// A number with seven significant digits, however small.
fn rounded(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
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
    orbit_at(belt, &found.state, forced.period_of(belt)?, false)
}

/// The orbit of a state that is known to close; `is_free` of a limit cycle without dither.
fn orbit_at(belt: &Belt, state: &[f64], period: f64, is_free: bool) -> Result<Orbit, NoOrbit> {
    let start = family::start_of(state);
    let (end, variation) = shot(belt, start, period)?;
    let mismatch = [end.displacement - start.displacement, end.velocity - start.velocity];
    let residual = mismatch[0].abs().max(mismatch[1].abs());
    let errors = accuracy::accuracy(belt, start, period, residual, &variation, is_free);
    Ok(Orbit {
        start,
        period,
        residual,
        state_error: errors.state,
        multiplier_error: errors.multiplier,
        monodromy: variation.matrix,
        multipliers: multipliers_of(&variation.matrix),
        events: variation.events,
        damping: variation.damping,
        // A run stays on its side of v_r = 0: what is below is rounding at an event.
        least_slip: variation.least.map(|(least, time)| (least.max(0.0), time)),
        stick_fraction: variation.stuck / period,
        slip_sign: end.slip_sign,
        is_free,
    })
}

/// Modulus of the multiplier that decides. Of a free orbit one multiplier is 1, along it; the other is the determinant, in pure
/// slip e^−`damping`: the eigenvalues themselves are ill-conditioned where both are near 1.
fn deciding(multipliers: [(f64, f64); 2], is_free: bool, damping: Option<f64>) -> f64 {
    let off = |(re, im): (f64, f64)| libm::hypot(re - 1.0, im);
    let [larger, smaller] = multipliers;
    match damping {
        Some(damping) if is_free => libm::exp(-damping),
        _ if is_free && off(smaller) > off(larger) => libm::hypot(smaller.0, smaller.1),
        _ => libm::hypot(larger.0, larger.1),
    }
}

/// The same along a run of one period.
fn radius_of(variation: &Variation<'_>, is_free: bool) -> f64 {
    let slides = variation.events.is_empty() && variation.stuck == 0.0;
    deciding(multipliers_of(&variation.matrix), is_free, slides.then_some(variation.damping))
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
    orbit_at(belt, &last.state, period, false)
}

/// The response that sliding becomes; without dither steady sliding itself, as the fixed point of the flow over unit time.
pub(crate) fn quiet(belt: &Belt, steps: u32) -> Result<Orbit, NoOrbit> {
    if !belt.dithers().is_empty() {
        return from_sliding(belt, steps);
    }
    orbit_at(belt, &[belt.steady_sliding(), 0.0], 1.0, false)
}
