//! Natural frequency, damping ratio and friction from a record of a free decay.
//!
//! The exact motion with viscous damping and Coulomb friction ([`motion`](self::FreeVibration)) is fitted by least squares, with exact
//! derivatives, from the starts of the envelope. The record is fitted over a growing part, each from the fit before: the phase of a long
//! record has many local minima in the frequency, that of its beginning has one.

mod motion;
mod start;

use quell_model::RecordedQuantity;
use quell_numerics::damped_least_squares::{DampedMinimum, DampedSearch, FittedFunction, fitted};
use quell_numerics::interval::RealInterval;

pub use motion::{DECAY_PARAMETERS, DecayReadings, FreeVibration, readings};
pub use start::{NoDecay, dominant_frequency};

use crate::estimates::{Estimates, Freedom};

/// What takes energy from a free vibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DecayLaw {
    /// Viscous damping: an exponential envelope.
    Viscous,
    /// Coulomb friction: a linear envelope.
    Coulomb,
    /// Both.
    ViscousCoulomb,
}

impl DecayLaw {
    /// Every law.
    pub const ALL: [Self; 3] = [Self::Viscous, Self::Coulomb, Self::ViscousCoulomb];

    /// Name in options and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Viscous => "viscous",
            Self::Coulomb => "coulomb",
            Self::ViscousCoulomb => "viscous-coulomb",
        }
    }

    /// Whether it has friction.
    pub fn has_friction(self) -> bool {
        self != Self::Viscous
    }

    fn has_damping(self) -> bool {
        self != Self::Coulomb
    }
}

/// Names of the parameters in options and JSON, in their order. The natural frequency is ω/2π.
pub const DECAY_NAMES: [&str; DECAY_PARAMETERS] = [
    "natural_frequency",
    "damping_ratio",
    "friction_displacement",
    "displacement",
    "velocity",
    "offset",
];

/// Bounds of the damping ratio: below critical, and not excited.
const DAMPING: RealInterval = RealInterval::new(0.0, 0.95);

/// Periods of the first part that is fitted, and the factor by which it grows.
const FIRST_PART: (f64, f64) = (4.0, 2.0);

/// Most steps of a search; some tens suffice.
const STEPS: usize = 100;

/// A fit of one law.
#[derive(Clone, Debug, PartialEq)]
pub struct DecayFit {
    /// The law.
    pub law: DecayLaw,
    /// The estimates, with ω in place of the natural frequency.
    pub estimates: Estimates,
    /// The fitted readings.
    pub values: Vec<f64>,
    /// Standard deviation of the curve at each sample by the delta method.
    pub deviations: Vec<f64>,
    /// Whether the search has converged.
    pub converged: bool,
}

impl DecayFit {
    /// The fitted vibration.
    pub fn vibration(&self) -> FreeVibration {
        let mut values = [0.0; DECAY_PARAMETERS];
        values.copy_from_slice(&self.estimates.values);
        FreeVibration::of(&values)
    }
}

/// Fits a law to readings at ascending times, which count from the first; `fixed` are values of parameters that are given.
///
/// # Errors
/// [`NoDecay`].
pub fn fit_decay(
    law: DecayLaw,
    (times, data): (&[f64], &[f64]),
    quantity: RecordedQuantity,
    fixed: &[Option<f64>; DECAY_PARAMETERS],
) -> Result<DecayFit, NoDecay> {
    let mut given = *fixed;
    if !law.has_damping() {
        given[1] = Some(0.0);
    }
    if !law.has_friction() {
        given[2] = Some(0.0);
    }
    let freedom: Vec<Freedom> = given
        .iter()
        .map(|one| if one.is_some() { Freedom::Fixed } else { Freedom::Free })
        .collect();
    let mut best: Option<DampedMinimum> = None;
    for mut start in start::starts(times, data, quantity)? {
        for (value, given) in start.iter_mut().zip(&given) {
            *value = given.unwrap_or(*value);
        }
        let Some(found) = over_growing_parts(law, (times, data), quantity, &given, start) else {
            continue;
        };
        if best.as_ref().is_none_or(|best| found.rss < best.rss) {
            best = Some(found);
        }
    }
    let found = best.ok_or(NoDecay::Constant)?;
    let estimates = Estimates::of(&found, data, &freedom);
    let deviations = deviations(&estimates, &found.columns);
    Ok(DecayFit { law, estimates, values: found.values, deviations, converged: found.converged })
}

fn over_growing_parts(
    law: DecayLaw,
    (times, data): (&[f64], &[f64]),
    quantity: RecordedQuantity,
    given: &[Option<f64>; DECAY_PARAMETERS],
    start: [f64; DECAY_PARAMETERS],
) -> Option<DampedMinimum> {
    let mut at = start.to_vec();
    let mut part = FIRST_PART.0;
    loop {
        let end = part * 2.0 * std::f64::consts::PI / start[0];
        let count = times.partition_point(|time| *time <= end);
        let whole = count >= times.len();
        let mut function =
            DecayFunction { quantity, times: &times[..count], with_friction: law.has_friction() };
        let found = fitted(&mut function, &data[..count], &at, &search(given, start[0]))?;
        if whole {
            return Some(found);
        }
        at = found.at;
        part *= FIRST_PART.1;
    }
}

/// The bounds. A given value is both of its bounds.
fn search(given: &[Option<f64>; DECAY_PARAMETERS], omega: f64) -> DampedSearch {
    let infinite = f64::MAX;
    let any = RealInterval::new(-infinite, infinite);
    let bounds = [
        RealInterval::new(0.5 * omega, 2.0 * omega),
        DAMPING,
        RealInterval::new(0.0, infinite),
        any,
        any,
        any,
    ];
    let bounds = bounds.iter().zip(given);
    let bounds = bounds.map(|(bounds, given)| given.map_or(*bounds, RealInterval::point));
    let (lower, upper) = bounds.map(|RealInterval { lower, upper }| (lower, upper)).unzip();
    DampedSearch { lower, upper, steps: STEPS }
}

/// The readings as a function of the parameters.
struct DecayFunction<'a> {
    quantity: RecordedQuantity,
    times: &'a [f64],
    with_friction: bool,
}

impl DecayFunction<'_> {
    fn readings(&self, at: &[f64]) -> Option<DecayReadings> {
        let values: &[f64; DECAY_PARAMETERS] = at.try_into().ok()?;
        let vibration = FreeVibration::of(values);
        Some(readings(&vibration, self.quantity, self.times, self.with_friction))
    }
}

impl FittedFunction for DecayFunction<'_> {
    fn values(&mut self, at: &[f64]) -> Option<Vec<f64>> {
        self.readings(at).map(|found| found.values)
    }

    fn columns(&mut self, at: &[f64], _: &[f64]) -> Option<Vec<Vec<f64>>> {
        let rows = self.readings(at)?.derivatives;
        let column = |k: usize| rows.iter().map(|row| row[k]).collect();
        Some((0..DECAY_PARAMETERS).map(column).collect())
    }
}

/// √(gᵀ C g) at each datum, with g its derivatives.
fn deviations(estimates: &Estimates, columns: &[Vec<f64>]) -> Vec<f64> {
    let at = |row: usize| {
        let mut variance = 0.0;
        for (entries, i) in estimates.covariance.iter().zip(&estimates.order) {
            for (entry, j) in entries.iter().zip(&estimates.order) {
                variance += entry * columns[*i][row] * columns[*j][row];
            }
        }
        variance.max(0.0).sqrt()
    };
    (0..columns.first().map_or(0, Vec::len)).map(at).collect()
}
