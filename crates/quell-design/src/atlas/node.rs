//! The exact values of the surfaces, by the continuation of `thresholds` and the shooting of `orbit`.

use quell_dynamics::orbit::{
    BASE_STEPS, BranchEnding, MotionSignature, Orbit, base_response, branch_thresholds, near,
};
use quell_dynamics::simulation::{Start, Variation, simulate};
use quell_model::Belt;

use super::point::AtlasPoint;

/// First amplitude relative to that at which the structure without friction is as fast as the belt, which grazes at 0.8 to 1.2.
const FIRST: f64 = 0.5;

/// Share of the way to the predicted grazing that a step takes: predictions are good to some per cent of the way.
const SHARE: f64 = 0.95;

/// The grazing is extrapolated when so near, relatively. The parabola through points at distances of 10⁻³, 10⁻⁴ and 10⁻⁵ is then good to
/// 10⁻¹².
const NEAR: f64 = 1e-5;

/// Most responses on the way to a grazing; six are usual.
const RESPONSES: usize = 60;

/// Largest amplitude of the continuation, relative to that of the structure without friction, where stepping does not arrive.
const LIMIT: f64 = 1.5;

/// Least number of steps of that continuation.
const STEPS: u32 = 16;

/// Bound on the last terms of a step, relative to the load, of the period over which a response is measured: that of its orbit.
const TOLERANCE: f64 = 1e-14;

/// The neutral damping is found when it changes by less.
const CLOSENESS: f64 = 1e-11;

/// Most iterations for the neutral damping. Each gains two digits or more.
const ITERATIONS: usize = 40;

/// Why a surface has no value at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoAtlasNode {
    /// The place makes no belt.
    NoBelt,
    /// The base response was lost before it grazes.
    NoGrazing,
    /// There is no response at this share of the grazing amplitude.
    NoResponse,
    /// The iteration for the neutral damping does not converge.
    NotConverged,
}

impl std::fmt::Display for NoAtlasNode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NoBelt => "the place is not a belt",
            Self::NoGrazing => "the grazing was not found",
            Self::NoResponse => "the response was not found",
            Self::NotConverged => "the neutral damping was not found",
        })
    }
}

impl std::error::Error for NoAtlasNode {}

/// A response in slip.
#[derive(Clone, Copy, Debug)]
struct SlippingResponse {
    amplitude: f64,
    start: Start,
    /// The least slip velocity.
    least: f64,
    /// The mean of 2ζ + μ′N.
    damping: f64,
}

/// The base response up to its grazing.
struct UpToGrazing {
    /// The amplitude at the grazing.
    amplitude: f64,
    /// Responses before it, in ascending order of the amplitude.
    before: Vec<SlippingResponse>,
}

/// The grazing amplitude of a point over its corner.
pub(super) fn grazing_factor(point: &AtlasPoint) -> Result<f64, NoAtlasNode> {
    let corner = point.corner().ok_or(NoAtlasNode::NoBelt)?;
    Ok(followed(point)?.amplitude / corner)
}

/// Responses by shooting, each nearer to the grazing, which is extrapolated; or by continuation.
fn followed(point: &AtlasPoint) -> Result<UpToGrazing, NoAtlasNode> {
    let corner = point.corner().ok_or(NoAtlasNode::NoBelt)?;
    let still = point.belt(0.0).map_err(|_| NoAtlasNode::NoBelt)?;
    let sliding = Start { displacement: still.steady_sliding(), ..Start::REST };
    let least = still.belt_velocity();
    let mut before = vec![SlippingResponse { amplitude: 0.0, start: sliding, least, damping: 0.0 }];
    let mut share = FIRST;
    for _ in 0..RESPONSES {
        let last = before[before.len() - 1];
        let grazing = predicted(&before).unwrap_or(corner);
        let way = grazing - last.amplitude;
        if way.abs() <= NEAR * grazing {
            return Ok(UpToGrazing { amplitude: grazing, before });
        }
        let amplitude = share.mul_add(way, last.amplitude);
        // Without neighbours the velocity is that of the structure without friction, which is slowest at the phase 0.
        let guess = between(&before, amplitude)
            .unwrap_or(Start { velocity: -least * amplitude / corner, ..sliding });
        if let Some(found) = slipping(point, amplitude, guess) {
            before.push(found);
            share = SHARE;
        } else if share < 1e-3 {
            break;
        } else {
            share *= 0.5;
        }
    }
    let amplitude = by_continuation(point, corner).ok_or(NoAtlasNode::NoGrazing)?;
    before.retain(|response| response.amplitude < amplitude);
    Ok(UpToGrazing { amplitude, before })
}

/// The amplitude at which the least slip velocity vanishes: on the inverse parabola, or the line, through the last responses.
fn predicted(before: &[SlippingResponse]) -> Option<f64> {
    let line = |a: &SlippingResponse, b: &SlippingResponse| {
        b.amplitude + b.least * (b.amplitude - a.amplitude) / (a.least - b.least)
    };
    let found = match before {
        [.., a, b, c] => {
            let (ab, bc) = (line(a, b), line(b, c));
            bc + c.least * (bc - ab) / (a.least - c.least)
        }
        [a, b] => line(a, b),
        _ => return None,
    };
    found.is_finite().then_some(found)
}

/// The state at an amplitude on the line through the two responses nearest to it.
fn between(before: &[SlippingResponse], amplitude: f64) -> Option<Start> {
    let after = before.iter().position(|response| response.amplitude >= amplitude);
    let last = after.unwrap_or(before.len() - 1).max(1);
    let (low, high) = (before.get(last - 1)?, before.get(last)?);
    let part = (amplitude - low.amplitude) / (high.amplitude - low.amplitude);
    let mix = |a: f64, b: f64| part.mul_add(b - a, a);
    Some(Start {
        time: 0.0,
        displacement: mix(low.start.displacement, high.start.displacement),
        velocity: mix(low.start.velocity, high.start.velocity),
    })
}

/// The response in slip near a state, if that is where shooting ends.
fn slipping(point: &AtlasPoint, amplitude: f64, guess: Start) -> Option<SlippingResponse> {
    let belt = point.belt(amplitude).ok()?;
    let orbit = near(&belt.system(), &[guess.displacement, guess.velocity], 1).ok()?;
    measured(&belt, amplitude, &orbit)
}

/// The response of an orbit; `None` of one that does not slip throughout.
fn measured(belt: &Belt, amplitude: f64, orbit: &Orbit) -> Option<SlippingResponse> {
    let start = Start::of_state(&orbit.state);
    let mut variation = Variation::new(belt);
    simulate(belt, start, orbit.period, TOLERANCE, &mut variation).ok()?;
    let (least, _) = variation.least.filter(|_| orbit.signature.is_pure_slip())?;
    let damping = variation.damping / orbit.period;
    Some(SlippingResponse { amplitude, start, least: least.max(0.0), damping })
}

/// The amplitude at which the branch of the base response leaves slip.
fn by_continuation(point: &AtlasPoint, corner: f64) -> Option<f64> {
    let belt = point.belt(0.0).ok()?;
    let at = |values: &[f64]| Ok(belt.with_amplitude(0, values[0])?.system());
    let branch = branch_thresholds(&at, 0.0, LIMIT * corner, STEPS, None).ok()?;
    let leaves = branch.changes.iter().find(|change| {
        let pure = change.below.as_ref().is_some_and(MotionSignature::is_pure_slip);
        pure && !change.above.as_ref().is_some_and(MotionSignature::is_pure_slip)
    });
    let touch = match branch.ending {
        BranchEnding::Touch { at } => Some(at),
        _ => None,
    };
    leaves.map(|change| change.value).or(touch)
}

/// κ_n at a share of the grazing amplitude; the κ of the point is ignored.
///
/// The mean of the damping rate over a period is κ + ⟨μ′⟩/max|μ′|, in units of 2ζ_f, and ⟨μ′⟩ depends on κ only through the response,
/// by a factor near ζ_f/R. So κ ← κ − mean converges quickly, and Aitken's extrapolation where the factor is not small. A belt has
/// no negative damping: where κ_n < 0 it is that of the response without damping.
pub(super) fn neutral_damping(point: &AtlasPoint, share: f64) -> Result<f64, NoAtlasNode> {
    let mut trail: Vec<f64> = vec![start(point)];
    for _ in 0..ITERATIONS {
        let kappa = trail.last().copied().unwrap_or(0.0).max(0.0);
        let next =
            kappa - mean_damping(&AtlasPoint { relative_damping: kappa, ..point.clone() }, share)?;
        if (next - kappa).abs() < CLOSENESS || (next <= 0.0 && kappa == 0.0) {
            return Ok(next);
        }
        trail.push(next);
        if let [a, b, c] = trail[..]
            && (0.0..2.0).contains(&c)
        {
            let bend = (c - b) - (b - a);
            let jump = if bend == 0.0 { c } else { c - (c - b) * (c - b) / bend };
            let is_close = jump.is_finite() && (jump - c).abs() <= 4.0 * (c - b).abs();
            trail = vec![if is_close { jump } else { c }];
        }
    }
    Err(NoAtlasNode::NotConverged)
}

/// κ_n of steady sliding, where every iteration begins.
fn start(point: &AtlasPoint) -> f64 {
    let belt = point.belt(0.0);
    let slope =
        belt.map_or(0.0, |belt| belt.friction().slope(belt.belt_velocity()) * belt.normal_load());
    (-0.5 * slope / point.friction_damping).clamp(0.0, 1.0)
}

/// The mean of (2ζ + Fμ′)/(2ζ_f) over a period of the response at a share of the grazing amplitude.
fn mean_damping(point: &AtlasPoint, share: f64) -> Result<f64, NoAtlasNode> {
    let UpToGrazing { amplitude, before } = followed(point)?;
    let amplitude = share * amplitude;
    let shot = between(&before, amplitude).and_then(|guess| slipping(point, amplitude, guess));
    let response = if let Some(response) = shot {
        response
    } else {
        let belt = point.belt(amplitude).map_err(|_| NoAtlasNode::NoBelt)?;
        let grown = base_response(&belt.system(), BASE_STEPS).ok();
        let grown = grown.and_then(|orbit| measured(&belt, amplitude, &orbit));
        grown.ok_or(NoAtlasNode::NoResponse)?
    };
    Ok(response.damping / (2.0 * point.friction_damping))
}
