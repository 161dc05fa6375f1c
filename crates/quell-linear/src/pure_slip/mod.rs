//! The dithered steady state while every contact slips, and its Floquet exponents: the exact verdict there.
//!
//! Without stick, reversal or separation the motion is smooth between the breaks of the waves, and its steady state under dithers of
//! commensurate frequencies is a periodic orbit. The orbit is found by Newton's method on the map over one period, from the
//! averaged response; its multipliers are those of the variational equation, integrated with it to full accuracy by extrapolation
//! ([`quell_numerics::extrapolation`]). Friction enters by kicks that are not nilpotent as soon as a contact has a tangent, for
//! which the splitting of [`crate::floquet`] loses its fourth order; extrapolation has order 16 for any of them.

mod equations;

use std::f64::consts::TAU;

use num_complex::Complex64;
use quell_model::System;
use quell_model::profile::Wave;
use quell_numerics::eigen::{Decomposition, EigenError};
use quell_numerics::extrapolation::{Unintegrated, integrate};
use quell_numerics::matrix::Matrix;
use quell_numerics::order::ascending;
use quell_numerics::polar::{argument, modulus};

use crate::averaging::{AveragingError, DitheredSystem, commensurate_groups};
use crate::growth::Growth;
use crate::steady::NoSteadySliding;
use equations::PureSlip;

/// Error of a step of the integration.
const TOLERANCE: f64 = 2e-15;

/// Least number of steps in a period, between which slip and load are watched.
const STEPS: f64 = 32.0;

/// Newton steps after which the orbit is given up.
const MOST_NEWTON_STEPS: usize = 30;

/// Steps of Newton's method that no longer shrink are those of rounding below this share of the state.
const STAGNANT: f64 = 1e-8;

/// Accepted change of the state over a period, relative to its size.
const CLOSED: f64 = 1e-13;

/// Why there is no exact verdict in pure slip.
#[derive(Clone, Debug, PartialEq)]
pub enum NoPureSlip {
    /// There is no steady sliding without dither, or no fast response.
    NoAverage(AveragingError),
    /// The dithers have no common period.
    NoPeriod,
    /// The slip at a contact comes to rest or reverses.
    Reverses {
        /// Name of the contact.
        contact: String,
    },
    /// A contact opens.
    Opens {
        /// Name of the contact.
        contact: String,
    },
    /// Newton's method does not converge.
    NoOrbit,
    /// The integration ended early.
    Unintegrated(Unintegrated),
    /// The multipliers cannot be computed.
    Eigenvalues(EigenError),
}

impl std::fmt::Display for NoPureSlip {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoAverage(why) => why.fmt(f),
            Self::NoPeriod => f.write_str("the frequencies of the dithers have no common period"),
            Self::Reverses { contact } => write!(
                f,
                "contact {contact} sticks or reverses in its dithered motion, which is not pure slip"
            ),
            Self::Opens { contact } => {
                write!(f, "contact {contact} opens in its dithered motion, which is not pure slip")
            }
            Self::NoOrbit => f.write_str("no periodic motion in pure slip was found"),
            Self::Unintegrated(why) => why.fmt(f),
            Self::Eigenvalues(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoPureSlip {}

impl From<AveragingError> for NoPureSlip {
    fn from(why: AveragingError) -> Self {
        Self::NoAverage(why)
    }
}

impl From<NoSteadySliding> for NoPureSlip {
    fn from(why: NoSteadySliding) -> Self {
        Self::NoAverage(why.into())
    }
}

impl From<Unintegrated> for NoPureSlip {
    fn from(why: Unintegrated) -> Self {
        Self::Unintegrated(why)
    }
}

impl From<EigenError> for NoPureSlip {
    fn from(why: EigenError) -> Self {
        Self::Eigenvalues(why)
    }
}

/// A Floquet exponent ln(m)/T; its frequency is known up to multiples of the frequency of the orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipExponent {
    /// The exponent; its imaginary part lies between plus and minus half the frequency of the orbit.
    pub exponent: Complex64,
    /// Bound on the error of its real part.
    pub error: f64,
    /// The multiplier m.
    pub multiplier: Complex64,
}

/// The dithered steady state in pure slip.
#[derive(Clone, Debug)]
pub struct SlipOrbit {
    /// Period T.
    pub period: f64,
    /// State at t = 0.
    pub state: Vec<f64>,
    /// Distance between the state and its image after a period.
    pub residual: f64,
    /// Every exponent, the largest growth rate first.
    pub exponents: Vec<SlipExponent>,
}

impl SlipOrbit {
    /// Largest growth rate.
    pub fn growth(&self) -> Growth {
        let highest = self.exponents.iter().map(|found| found.exponent.re + found.error);
        let leading = self.exponents.first();
        let rate = leading.map_or(f64::NEG_INFINITY, |found| found.exponent.re);
        Growth {
            rate,
            error: highest.fold(rate, f64::max) - rate,
            frequency: leading.map_or(0.0, |found| found.exponent.im.abs()),
        }
    }
}

/// The common period of the inputs of a system; `None` without dither or without a common period.
///
/// Waves of amplitude 0 have none of their own, except where no other acts: a family whose amplitude passes 0 keeps its period.
pub fn period(system: &System) -> Option<f64> {
    let acting: Vec<f64> = system.acting_frequencies().collect();
    let frequencies =
        if acting.is_empty() { system.waves().map(Wave::repetition).collect() } else { acting };
    let groups = commensurate_groups(&frequencies);
    let [members] = groups.as_slice() else { return None };
    let (first, multiple) = members.first()?;
    Some(TAU * f64::from(*multiple) / frequencies[*first])
}

/// The dithered steady state of a system and its exponents.
///
/// # Errors
/// [`NoPureSlip`], with the contact that sticks, reverses or opens.
pub fn orbit(system: &System) -> Result<SlipOrbit, NoPureSlip> {
    let period = period(system).ok_or(NoPureSlip::NoPeriod)?;
    let equations = PureSlip::new(system)?;
    let mut state = DitheredSystem::with_fast_motion(system)?.fast_state()?;
    let breaks = breaks(system, period);
    let mut previous = f64::INFINITY;
    for _ in 0..MOST_NEWTON_STEPS {
        let turn = turn(system, &equations, &state, period, &breaks)?;
        let n = state.len();
        let residual: Vec<f64> =
            turn.state.iter().zip(&state).map(|(end, start)| end - start).collect();
        let size = state.iter().fold(0.0, |m: f64, y| m.max(y.abs()));
        let distance = residual.iter().fold(0.0, |m: f64, y| m.max(y.abs()));
        if distance <= CLOSED * size || size == 0.0 && distance == 0.0 {
            return closed(turn, period, state);
        }
        let jacobian =
            Matrix::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) - turn.derivative[(i, j)]);
        let right = Matrix::from_fn(n, 1, |i, _| residual[i]);
        let step = jacobian.solve(&right).ok_or(NoPureSlip::NoOrbit)?;
        if !step.is_finite() {
            return Err(NoPureSlip::NoOrbit);
        }
        let moved = step.largest();
        for (y, step) in state.iter_mut().zip(step.as_slice()) {
            *y += step;
        }
        // As close as rounding allows.
        let stagnant = moved <= STAGNANT * size && moved >= 0.5 * previous;
        previous = moved;
        if moved <= 4.0 * f64::EPSILON * size || stagnant {
            let last = self::turn(system, &equations, &state, period, &breaks)?;
            return closed(last, period, state);
        }
    }
    Err(NoPureSlip::NoOrbit)
}

/// The orbit of a state that returns to itself.
fn closed(turn: Turn, period: f64, state: Vec<f64>) -> Result<SlipOrbit, NoPureSlip> {
    if let Some(why) = turn.leaves {
        return Err(why);
    }
    let exponents = exponents(&turn, period)?;
    let changes = turn.state.iter().zip(&state).map(|(end, start)| (end - start).abs());
    let residual = changes.fold(0.0, f64::max);
    Ok(SlipOrbit { period, state, residual, exponents })
}

/// One period from a state.
struct Turn {
    state: Vec<f64>,
    derivative: Matrix,
    /// Bound on the error of the derivative, relative to its entries.
    error: f64,
    /// Where the motion is not pure slip.
    leaves: Option<NoPureSlip>,
}

fn turn(
    system: &System,
    equations: &PureSlip<'_>,
    start: &[f64],
    period: f64,
    breaks: &[f64],
) -> Result<Turn, NoPureSlip> {
    let n = equations.size();
    let mut whole = start.to_vec();
    whole.extend_from_slice(Matrix::identity(n).as_slice());
    let mut matrix = Matrix::zeros(n, n);
    let mut f = |time: f64, whole: &[f64], slope: &mut [f64]| {
        let (y, variation) = whole.split_at(n);
        let (rate, turned) = slope.split_at_mut(n);
        equations.slope(time, y, rate, Some(&mut matrix));
        for i in 0..n {
            let row = &mut turned[i * n..(i + 1) * n];
            row.fill(0.0);
            for (k, &factor) in matrix.row(i).iter().enumerate() {
                if factor != 0.0 {
                    for (sum, &term) in row.iter_mut().zip(&variation[k * n..(k + 1) * n]) {
                        *sum += factor * term;
                    }
                }
            }
        }
    };
    let mut leaves = None;
    let mut watch = |time: f64, whole: &[f64]| {
        for (index, contact) in system.contacts.iter().enumerate() {
            let instant = equations.instant(index, time, &whole[..n]);
            let name = || contact.name.clone();
            if contact.tangent.is_some() && instant.slip <= 0.0 {
                leaves.get_or_insert_with(|| NoPureSlip::Reverses { contact: name() });
            }
            if instant.normal_load <= 0.0 {
                leaves.get_or_insert_with(|| NoPureSlip::Opens { contact: name() });
            }
        }
    };
    watch(0.0, &whole);
    let mut error = 0.0;
    for pair in breaks.windows(2) {
        let tolerances = (TOLERANCE, period / STEPS);
        // A wave has its value after a break at the break itself: stay inside.
        let (from, to) = (pair[0], pair[1]);
        let inside = |time: f64| time.clamp(from + 1e-14 * period, to - 1e-14 * period);
        let mut g = |time: f64, y: &[f64], slope: &mut [f64]| f(inside(time), y, slope);
        error += integrate(&mut g, (from, to), &mut whole, tolerances, &mut watch)?;
    }
    let variation = &whole[n..];
    let derivative = Matrix::from_fn(n, n, |i, j| variation[i * n + j]);
    Ok(Turn { state: whole[..n].to_vec(), derivative, error, leaves })
}

/// Times in [0, T] at which a wave has a kink or a jump, both ends included.
fn breaks(system: &System, period: f64) -> Vec<f64> {
    let mut breaks = vec![0.0, period];
    for wave in system.waves() {
        for phase in wave.waveform.breaks() {
            let cycle = wave.waveform.period() / wave.frequency;
            let mut time = ((phase - wave.phase) / wave.frequency).rem_euclid(cycle);
            while time < period {
                breaks.push(time);
                time += cycle;
            }
        }
    }
    ascending(&mut breaks);
    breaks.dedup_by(|a, b| (*a - *b).abs() <= 1e-12 * period);
    breaks
}

fn exponents(turn: &Turn, period: f64) -> Result<Vec<SlipExponent>, EigenError> {
    let decomposition = Decomposition::new(&turn.derivative)?;
    let norm = decomposition.norm();
    let mut found: Vec<SlipExponent> = (0..decomposition.values().len())
        .map(|index| {
            let pair = decomposition.pair(index);
            let multiplier = pair.value;
            let size = modulus(multiplier);
            let rounding = decomposition.error_of(&pair) + pair.condition * turn.error * norm;
            let exponent = Complex64::new(libm::log(size), argument(multiplier)) / period;
            SlipExponent { exponent, error: rounding / (size * period), multiplier }
        })
        .collect();
    found.sort_by(|a, b| {
        b.exponent.re.total_cmp(&a.exponent.re).then(b.exponent.im.total_cmp(&a.exponent.im))
    });
    Ok(found)
}
