//! Values of an axis, with additional values near every predicted resonance of a disc.
//!
//! Tongues are as narrow as 10⁻⁵ in Ω, far below the steps of any map, and at ξ = 0 their edges are exactly marginal. A
//! speed axis given by its ends gets additional points on both sides of each meeting of waves, at increasing distances, and one at
//! the peak of the predicted tongue. An axis given by its values is left unchanged.

use quell_disc::resonance::{Resonance, Tongue, Waves};
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending;

use quell_model::parameter::disc::DISC_SPEED;

use crate::study::{Axis, DiscStudy, Sweep};

/// Distances from a meeting of waves, in Ω.
const BESIDE: [f64; 4] = [1e-5, 1e-4, 1e-3, 4e-3];

/// Number of points across a predicted tongue.
const ACROSS: [f64; 3] = [0.25, 0.5, 0.75];

/// The values of an axis.
pub(super) fn values(study: &DiscStudy, sweep: &Sweep) -> Vec<f64> {
    let mut values: Vec<f64> = sweep.axis.values().collect();
    let range = match sweep.axis {
        Axis::Linear { from, to, .. } | Axis::Logarithmic { from, to, .. } => {
            RealInterval::new(from, to)
        }
        Axis::Values(_) => return values,
    };
    let Some(per_speed) = per_speed(study, sweep, range) else { return values };
    let speeds = beside(study, RealInterval::new(range.lower / per_speed, range.upper / per_speed));
    values.extend(speeds.into_iter().map(|speed| speed * per_speed));
    ascending(&mut values);
    values.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * per_speed.abs());
    if range.lower > range.upper {
        values.reverse();
    }
    values
}

/// The value of an axis for the speed Ω = 1; `None` if it varies no speed.
fn per_speed(
    study: &DiscStudy,
    sweep: &Sweep,
    RealInterval { lower: from, upper: to }: RealInterval,
) -> Option<f64> {
    if !sweep.target.number.ends_with(&format!(".{}", DISC_SPEED.key())) {
        return None;
    }
    let end = if to == 0.0 { from } else { to };
    let parameter = study.model().parameter(&sweep.path).ok()?;
    let speed = study.setup_at(&[(parameter, end)]).ok()?.disc().speed();
    (speed != 0.0).then_some(end / speed)
}

/// Points near the resonances strictly between two speeds.
fn beside(study: &DiscStudy, RealInterval { lower: from, upper: to }: RealInterval) -> Vec<f64> {
    let (low, high) = (from.min(to), from.max(to));
    let mut points = Vec::new();
    for resonance in resonances(study, low, high) {
        let distances = BESIDE.iter().flat_map(|distance| [-distance, *distance]);
        points.extend(distances.map(|distance| resonance.speed + distance));
        if let Tongue::Between { lower, upper, peak_speed, .. } = resonance.tongue {
            points.push(peak_speed);
            points.extend(ACROSS.iter().map(|share| lower + share * (upper - lower)));
        }
    }
    points.retain(|speed| *speed > low && *speed < high);
    points
}

/// Meetings of waves, those at higher harmonics of the dither where they have a tongue, of which a burst has hundreds; none if
/// the theory does not apply.
fn resonances(study: &DiscStudy, low: f64, high: f64) -> Vec<Resonance> {
    let Ok(waves) = Waves::new(study.disc()) else { return Vec::new() };
    let mut found = waves.undithered(low..=high);
    let is_listed = |resonance: &Resonance| {
        resonance.harmonic.unsigned_abs() <= 1 || resonance.tongue.edges().is_some()
    };
    found.extend(waves.dithered(low..=high).into_iter().filter(is_listed));
    found
}
