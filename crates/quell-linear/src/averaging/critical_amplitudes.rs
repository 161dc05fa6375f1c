//! Critical dither amplitudes: every α = D/R > 0 at which averaged stability changes as the amplitude of the first dither varies.
//!
//! For one dither, the amplitude at which the fast velocity reaches the belt velocity, α = v₀/G_max (v₀/(μ(v₀)G_max) for normal
//! dither), divides the axis. Below it (outer region) the criterion is smooth. At it the criterion jumps: to +∞ for a sine and a
//! triangle, by a finite step for a square. Above it (inner region) the criterion falls and may dip once more. A jump is a
//! critical amplitude too, and a root finder alone misses it. Both regions are scanned, with extra points clustered just above
//! the jump, and dips are followed to their minimum. With several dithers the other ones are held fixed, and the jump is where
//! the sum of the fast velocities reaches v₀. Under noise there is no jump: the criterion is smooth in α.
//!
//! The corresponding closed forms for one tangential dither are (3.43)–(3.60). Stribeck law: the outer root is
//! α = v_m √((1 − κ − w²)/⟨G²⟩) with κ = 4v_mζ/(3F(μ_s − μ_m)), w = v₀/v_m. Decreasing law: the root of
//! m(α/v_m) = 2v_mζe^{w}/(F(μ_s − μ_m)). Normal dither: the same with α_T → μ(v₀)α_N.

use quell_model::{Belt, Direction};
use quell_numerics::order::ascending;

use super::averaged_law::AveragedLaw;
use super::belt_averages::BeltAverages;
use super::criterion::Criterion;
use super::dithers::Averaging;
use super::error::AveragingError;
use super::fast_motion::FastMotion;
use super::periodic::Signal;
use super::periodic_motion::PeriodicMotion;
use super::sign_changes::{CrossingKind, grown, sign_changes};

/// Stability of steady sliding after a change of sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Becomes {
    /// The criterion becomes positive.
    Stable,
    /// The criterion becomes negative.
    Unstable,
}

impl Becomes {
    pub(super) fn from_sign(positive: bool) -> Self {
        if positive { Self::Stable } else { Self::Unstable }
    }
}

/// One critical amplitude of the first dither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalAmplitude {
    /// α = D/R.
    pub amplitude_ratio: f64,
    /// D = αR, the force amplitude, a length.
    pub amplitude: f64,
    /// Bound on the numerical error of `amplitude_ratio`.
    pub error: f64,
    /// Whether the criterion passes through zero or jumps.
    pub crossing: CrossingKind,
    /// Stability of steady sliding at slightly larger amplitudes.
    pub becomes: Becomes,
    /// Whether the contact would stay closed: ΣD_N ≤ F. Always true for tangential dither.
    pub contact_stays_closed: bool,
}

/// Every amplitude ratio α > 0 of the first dither at which the averaged stability of steady sliding changes. The
/// amplitude of the first dither in `belt` is ignored; the other dithers are held fixed. Empty without dither.
///
/// # Errors
/// [`AveragingError`], for instance for a belt at rest with normal dither only.
pub fn critical_amplitudes(
    belt: &Belt,
    averaging: Averaging,
) -> Result<Vec<CriticalAmplitude>, AveragingError> {
    let Some(first) = belt.dithers().first() else {
        return Ok(Vec::new());
    };
    let averages = BeltAverages::new(belt, belt.belt_velocity(), averaging)?;
    let probe = Probe { belt, frequency_ratio: first.frequency_ratio, averages };
    let largest = probe.end_of_expansion()?;
    let mut corners = probe.corners()?;
    let scale = corners
        .iter()
        .fold(belt.friction().velocity_scale().max(belt.belt_velocity()), |m, c| m.max(*c));
    let mut points = scan_points(&corners, scale, belt.belt_velocity() == 0.0);
    points.extend(probe.noise_points()?);
    ascending(&mut points);
    points.dedup();
    // Two points beyond it, so that a dip just below it is seen.
    points.truncate(points.partition_point(|point| *point <= largest) + 2);
    corners.retain(|corner| points.last().is_some_and(|last| corner <= last));
    let changes = sign_changes(|alpha| probe.criterion(alpha), &points, &corners)?;
    let others: f64 = belt.dithers()[1..]
        .iter()
        .filter(|d| d.direction == Direction::Normal)
        .map(|d| d.amplitude)
        .sum();
    Ok(changes
        .into_iter()
        .map(|change| {
            let amplitude = change.location * first.frequency_ratio;
            let most = -first.waveform.range().lower;
            let own = if first.direction == Direction::Normal { most * amplitude } else { 0.0 };
            CriticalAmplitude {
                amplitude_ratio: change.location,
                amplitude,
                error: change.error,
                crossing: change.crossing,
                becomes: Becomes::from_sign(change.becomes_positive),
                contact_stays_closed: others + own <= belt.normal_load(),
            }
        })
        .collect())
}

/// Amplitudes to scan: equally spaced up to the first corner, clustered above each corner, then a geometric sequence far out.
fn scan_points(corners: &[f64], scale: f64, at_rest: bool) -> Vec<f64> {
    let mut points = Vec::new();
    let first = corners.iter().copied().fold(scale, f64::min);
    if at_rest {
        points.extend((0..80).map(|k| first * libm::exp(-0.25 * f64::from(80 - k))));
    } else {
        points.push(0.0);
        points.extend((1..=12).map(|k| first * libm::exp(-0.5 * f64::from(13 - k))));
        points.extend((1..=48).map(|k| first * f64::from(k) / 48.0));
    }
    for corner in corners {
        points.extend((0..30).map(|k| corner * (1.0 + libm::exp(-34.0 + 1.1 * f64::from(k)))));
    }
    // Ratio 1.15 over two decades beyond the largest scale, 2 over two more.
    let mut point = first;
    while point < 1e4 * scale {
        point = grown(point, if point < 1e2 * scale { 1.15 } else { 2.0 });
        points.push(point);
    }
    ascending(&mut points);
    points.dedup();
    points
}

/// The belt with another amplitude of its first dither, whether or not the contact would stay closed.
struct Probe<'a> {
    belt: &'a Belt,
    frequency_ratio: f64,
    averages: BeltAverages<'a>,
}

impl Probe<'_> {
    fn law(&self, alpha: f64) -> Result<AveragedLaw, AveragingError> {
        self.averages.law(Some(alpha * self.frequency_ratio))
    }

    fn motion(&self, alpha: f64) -> Result<FastMotion, AveragingError> {
        Ok(self.law(alpha)?.motion().clone())
    }

    /// The amplitude at which the second order of the motion under normal dither is as large as the first: beyond it the expansion
    /// (4.23) says nothing. Infinite where only the first order is kept.
    fn end_of_expansion(&self) -> Result<f64, AveragingError> {
        let unit = self.motion(1.0)?;
        let share = |group: &PeriodicMotion| {
            let peaks = group.normal.iter().map(|term| term.amplitude.abs() * term.wave.peak());
            group.distortion.abs() * peaks.sum::<f64>()
        };
        let most = unit.groups().iter().map(share).fold(0.0, f64::max);
        Ok(if self.belt.dithers()[0].direction == Direction::Normal {
            1.0 / most
        } else {
            f64::INFINITY
        })
    }

    fn criterion(&self, alpha: f64) -> Result<f64, AveragingError> {
        let belt = self.belt;
        let effective = self.law(alpha)?.at(belt.belt_velocity())?;
        Ok(Criterion::new(belt.damping_ratio(), belt.normal_load(), effective).value)
    }

    /// Amplitudes at which the Gaussian velocity is comparable to the belt velocity, where the criterion changes most.
    fn noise_points(&self) -> Result<Vec<f64>, AveragingError> {
        const POINTS: u32 = 160;
        let deviation = self.motion(1.0)?.noise();
        let velocity = self.belt.belt_velocity();
        if deviation == 0.0 || velocity == 0.0 {
            return Ok(Vec::new());
        }
        let unit = 4.0 * velocity / (deviation * f64::from(POINTS));
        Ok((1..=POINTS).map(|k| unit * f64::from(k)).collect())
    }

    /// Amplitudes at which the largest fast velocity equals the belt velocity.
    fn corners(&self) -> Result<Vec<f64>, AveragingError> {
        let v = self.belt.belt_velocity();
        if v == 0.0 {
            return Ok(Vec::new());
        }
        let unit = self.motion(1.0)?;
        // Under noise the average is smooth.
        if unit.noise() > 0.0 {
            return Ok(Vec::new());
        }
        // Exact where the fast motion is a single first-order wave.
        if let [group] = unit.groups()
            && let Some((wave, amplitude)) = group.single_term()
        {
            return Ok(vec![v / (amplitude.abs() * wave.peak())]);
        }
        // The fast motion of one dither is proportional to its amplitude: every maximum of it is a corner.
        if let ([group], [_]) = (unit.groups(), self.belt.dithers())
            && group.distortion == 0.0
        {
            let extrema = Signal::new(group)?.turning_values();
            let corners = extrema.into_iter().filter(|extremum| *extremum > 0.0);
            let mut corners: Vec<f64> = corners.map(|extremum| v / extremum).collect();
            ascending(&mut corners);
            return Ok(corners);
        }
        let scale = v.max(self.belt.friction().velocity_scale());
        let points: Vec<f64> =
            (0..160).map(|k| scale * libm::exp(-9.2 + 0.1 * f64::from(k))).collect();
        let excess = |alpha: f64| -> Result<f64, AveragingError> {
            Ok(self.motion(alpha)?.largest_slip()? - v)
        };
        let changes = sign_changes(excess, &points, &[])?;
        Ok(changes.into_iter().map(|change| change.location).collect())
    }
}
