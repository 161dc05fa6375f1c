//! The amplitude that stabilises steady sliding at every belt velocity under noise, α^L.
//!
//! The fast velocity is Gaussian with the standard deviation σ = αs, s that of the dither for α = 1; of normal noise it is αs μ(v₀).
//! The criterion 2ζ + Fμ̄′(v₀) has no corner, so that the worst belt velocity is found by a search: up to the velocity from which
//! sliding is stable without dither, and [`BEYOND`] standard deviations further, where the Gaussian tail no longer reaches the
//! falling part of the law. α^L is the last amplitude at which the least criterion changes its sign.

use quell_model::{Belt, Direction, Dither};
use quell_numerics::roots::{Closeness, try_minimise};

use super::belt_averages::BeltAverages;
use super::criterion::Criterion;
use super::dithers::Averaging;
use super::edges::{CriticalVelocity, undithered_critical_velocity};
use super::error::AveragingError;
use super::everywhere_stable::{EverywhereStable, NeverStable};
use super::gaussian;
use super::sign_changes::sign_changes;

/// Standard deviations beyond the stable velocities at which the average is examined: the tail beyond has the weight 10⁻⁹.
const BEYOND: f64 = 6.0;

/// Belt velocities of the search at one amplitude; the criterion varies over one standard deviation and over the scale of the law.
const VELOCITIES: u32 = 96;

/// Amplitudes from σ = 10⁻² to 10⁵ velocity scales of the law, in equal ratios: below, noise does not act; beyond, the search of
/// periodic waves ends too.
const AMPLITUDES: u32 = 140;
const FROM: f64 = 1e-2;
const RATIO: f64 = 0.115;

/// Relative accuracy of the velocity of the least criterion; its square is that of the criterion.
const CLOSENESS: f64 = 1e-7;

/// α^L for a belt whose only dither is noise.
///
/// # Errors
/// [`AveragingError`].
pub fn everywhere_stable_under_noise(
    belt: &Belt,
    dither: &Dither,
    averaging: Averaging,
) -> Result<EverywhereStable, AveragingError> {
    let law = belt.friction();
    let end = match undithered_critical_velocity(law, belt.damping_ratio(), belt.normal_load())? {
        CriticalVelocity::StableEverywhere => return Ok(EverywhereStable::Always),
        CriticalVelocity::UnstableEverywhere => {
            let damped = belt.damping_ratio() > 0.0;
            let why = if damped { NeverStable::NoEdge } else { NeverStable::NoDamping };
            return Ok(EverywhereStable::Never { why });
        }
        CriticalVelocity::Above(end) => end,
    };
    // In proportion to the level of friction under normal noise, at any velocity.
    let velocity = belt.friction().velocity_scale();
    let unit = BeltAverages::new(belt, velocity, averaging)?.law(Some(dither.frequency_ratio))?;
    let level = level_of(belt, dither, velocity);
    let search = WorstVelocity { belt, unit: unit.motion().noise() / level, dither, end };
    let first = FROM * law.velocity_scale() / search.unit;
    let points: Vec<f64> =
        (0..AMPLITUDES).map(|k| first * libm::exp(RATIO * f64::from(k))).collect();
    let last = points[points.len() - 1];
    if search.least(last)? < 0.0 {
        return Ok(EverywhereStable::Never { why: NeverStable::OffScale });
    }
    let changes = sign_changes(|alpha| search.least(alpha), &points, &[])?;
    Ok(changes.last().map_or(EverywhereStable::Always, |change| EverywhereStable::From {
        amplitude_ratio: change.location,
        error: change.error.max(1e-10 * change.location),
    }))
}

/// The search for the worst belt velocity.
struct WorstVelocity<'a> {
    belt: &'a Belt,
    dither: &'a Dither,
    /// Standard deviation of the velocity for α = 1, of normal noise over μ.
    unit: f64,
    /// Velocity from which sliding is stable without dither.
    end: f64,
}

impl WorstVelocity<'_> {
    fn criterion(&self, alpha: f64, v: f64) -> Result<f64, AveragingError> {
        let law = self.belt.friction();
        let level = level_of(self.belt, self.dither, v);
        let effective = gaussian::effective(law, alpha * self.unit * level, v)?;
        Ok(Criterion::new(self.belt.damping_ratio(), self.belt.normal_load(), effective).value)
    }

    /// The least criterion over the belt velocities.
    fn least(&self, alpha: f64) -> Result<f64, AveragingError> {
        let level = level_of(self.belt, self.dither, 0.0);
        let most = self.end + BEYOND * alpha * self.unit * level;
        let location = |k: u32| most * f64::from(k) / f64::from(VELOCITIES);
        let mut worst = (f64::INFINITY, 1);
        for k in 1..VELOCITIES {
            let value = self.criterion(alpha, location(k))?;
            if value < worst.0 {
                worst = (value, k);
            }
        }
        let closeness = Closeness { absolute: 0.0, relative: CLOSENESS };
        let (low, high) = (location(worst.1 - 1), location(worst.1 + 1));
        let value = |v: f64| self.criterion(alpha, v);
        let bottom = try_minimise(value, low.max(1e-3 * high), high, closeness)?;
        Ok(bottom.map_or(worst.0, |bottom| bottom.value.min(worst.0)))
    }
}

/// The friction coefficient that drives the motion due to normal dither at a slip velocity; 1 of tangential dither.
fn level_of(belt: &Belt, dither: &Dither, v: f64) -> f64 {
    match dither.direction {
        Direction::Tangential => 1.0,
        Direction::Normal => belt.friction().coefficient(v),
    }
}
