//! Periodic responses, exactly: Newton shooting on the period map, Floquet multipliers through stick and slip.
//!
//! The steady response to periodic dither is a fixed point of the map over one common period (or n of them). Its stability
//! is decided by the multipliers of the map's derivative, which `variation` carries along the run with a jump at
//! every event; neither averaging nor a long simulation is needed. In pure slip det M = exp(−∮(2ζ + μ′N)dτ); with a
//! stick one multiplier is 0, because the mass leaves it at one state whatever came before.
//!
//! [`threshold`] follows an orbit along a parameter to the values at which its stability changes.

pub mod reached;
pub mod threshold;
mod variation;

use std::f64::consts::TAU;
use std::fmt;

use quell_model::Belt;

use crate::simulation::{EventKind, FinalState, Stalled, Start, simulate};
pub use variation::Matrix;
use variation::Variation;

/// Bound on the last retained Taylor terms of a step while shooting, relative to F.
const TOLERANCE: f64 = 1e-14;

/// Newton steps of one shooting.
const MOST_STEPS: u32 = 40;

/// Mismatch of an orbit after its period, relative to F, at which shooting ends.
const CLOSED: f64 = 1e-12;

/// A mismatch that rounding of a long period may leave.
const NEARLY_CLOSED: f64 = 1e-9;

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
    /// Mismatch of x and x′ after the period, the larger one.
    pub residual: f64,
    /// Derivative of the period map.
    pub monodromy: Matrix,
    /// Its eigenvalues (re, im), the larger modulus first.
    pub multipliers: [(f64, f64); 2],
    /// Events of a period in order, with the sign of v_r afterwards: the signature of the orbit.
    pub events: Vec<(EventKind, i8)>,
    /// ∮(2ζ + μ′N)dτ over slip.
    pub damping: f64,
    /// Least |v_r| inside slip and when; `None` for an orbit in stick throughout.
    pub least_slip: Option<(f64, f64)>,
    /// Share of the period spent in stick.
    pub stick_fraction: f64,
}

impl Orbit {
    /// Modulus of the larger multiplier.
    pub fn radius(&self) -> f64 {
        let (re, im) = self.multipliers[0];
        libm::hypot(re, im)
    }

    /// What the multipliers say.
    pub fn verdict(&self) -> Verdict {
        match self.radius() {
            radius if radius > 1.0 + UNDECIDED => Verdict::Unstable,
            radius if radius < 1.0 - UNDECIDED => Verdict::Stable,
            _ => Verdict::Undecided,
        }
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
            Self::Stalled(stalled) => stalled.fmt(f),
        }
    }
}

impl std::error::Error for NoOrbit {}

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
    let period = f64::from(periods.max(1)) * common_period(belt)?;
    let scale = belt.normal_load();
    let mut start = Start { time: 0.0, ..guess };
    let mut best: Option<(f64, Start)> = None;
    for steps in 0..MOST_STEPS {
        let (end, variation) = shot(belt, start, period)?;
        let mismatch = [end.displacement - start.displacement, end.velocity - start.velocity];
        let residual = mismatch[0].abs().max(mismatch[1].abs());
        let improves = best.is_none_or(|(least, _)| residual < 0.5 * least);
        if residual <= CLOSED * scale || (residual <= NEARLY_CLOSED * scale && !improves) {
            return Ok(orbit_of(start, period, residual, &variation));
        }
        if best.is_none_or(|(least, _)| residual < least) {
            best = Some((residual, start));
        }
        let [[a, b], [c, d]] = variation.matrix;
        let determinant = (a - 1.0) * (d - 1.0) - b * c;
        let step = [
            -((d - 1.0) * mismatch[0] - b * mismatch[1]) / determinant,
            -((a - 1.0) * mismatch[1] - c * mismatch[0]) / determinant,
        ];
        // Far from the orbit the first order may send the state anywhere: no step is longer than the system is wide.
        let longest = scale.max(belt.belt_velocity());
        let length = step[0].abs().max(step[1].abs());
        if !length.is_finite() {
            return Err(NoOrbit::NotConverged { steps, residual, at: start });
        }
        let share = (longest / length).min(1.0);
        start.displacement += share * step[0];
        start.velocity += share * step[1];
    }
    let (residual, at) = best.unwrap_or((f64::INFINITY, start));
    Err(NoOrbit::NotConverged { steps: MOST_STEPS, residual, at })
}

fn orbit_of(start: Start, period: f64, residual: f64, variation: &Variation<'_>) -> Orbit {
    Orbit {
        start,
        period,
        residual,
        monodromy: variation.matrix,
        multipliers: eigenvalues(&variation.matrix),
        events: variation.events.clone(),
        damping: variation.damping,
        least_slip: variation.least,
        stick_fraction: variation.stuck / period,
    }
}

/// Eigenvalues of a 2 × 2 matrix, the larger modulus first.
fn eigenvalues([[a, b], [c, d]]: &Matrix) -> [(f64, f64); 2] {
    let half = 0.5 * (a + d);
    let determinant = a * d - b * c;
    let discriminant = 0.25 * (a - d) * (a - d) + b * c;
    if discriminant < 0.0 {
        let im = libm::sqrt(-discriminant);
        return [(half, im), (half, -im)];
    }
    let large = half + libm::copysign(libm::sqrt(discriminant), half);
    // The smaller one by the product, which does not cancel.
    let small = if large == 0.0 { 0.0 } else { determinant / large };
    [(large, 0.0), (small, 0.0)]
}

/// The orbit that sliding without dither becomes when the dither grows from nothing: followed in
/// `steps` of all amplitudes at once, halved where shooting does not converge.
///
/// # Errors
/// [`NoOrbit`] of the last amplitude that failed.
pub fn from_sliding(belt: &Belt, steps: u32) -> Result<Orbit, NoOrbit> {
    let scaled = |share: f64| {
        (0..belt.dithers().len()).try_fold(belt.clone(), |scaled, index| {
            let amplitude = share * belt.dithers()[index].amplitude;
            scaled.with(&belt.dither_path(index, "amplitude"), amplitude).ok()
        })
    };
    let mut share = 0.0;
    let mut step = 1.0 / f64::from(steps.max(1));
    let mut known: Vec<(f64, Start)> =
        vec![(0.0, Start { time: 0.0, displacement: belt.steady_sliding(), velocity: 0.0 })];
    loop {
        let next = if share + step > 1.0 - 1e-9 { 1.0 } else { share + step };
        let belt = scaled(next).ok_or(NoOrbit::NoDither)?;
        match near(&belt, predicted(&known, next), 1) {
            Ok(orbit) if next >= 1.0 => return Ok(orbit),
            Ok(orbit) => {
                known.push((next, orbit.start));
                share = next;
            }
            Err(why) if step < 1e-6 => return Err(why),
            Err(_) => step *= 0.5,
        }
    }
}

/// The state at `value` on the line through the last two known ones.
fn predicted(known: &[(f64, Start)], value: f64) -> Start {
    match known {
        [.., (a, from), (b, to)] if a != b => {
            let share = (value - b) / (b - a);
            Start {
                time: 0.0,
                displacement: share.mul_add(to.displacement - from.displacement, to.displacement),
                velocity: share.mul_add(to.velocity - from.velocity, to.velocity),
            }
        }
        [.., (_, last)] => *last,
        [] => Start::REST,
    }
}
