//! Unstable belt velocities: the bands of v₀ in which averaged steady sliding is unstable, for fixed dither.
//!
//! Without dither, the Stribeck law is unstable below v_m√(1 − κ), κ = 4v_mζ/(3F(μ_s − μ_m)) (2.28), the decreasing law below
//! −v_m ln(2v_mζ/(F(μ_s − μ_m))).
//!
//! With one tangential dither, α = D/R, the lower edge is αG_max (a jump), and the upper edge is
//! * Stribeck: v_m√(1 − κ − ⟨G²⟩(α/v_m)²), ⟨G²⟩ = 1/2, π²/30, π²/12 (3.43), (3.47), (3.51); the dissertation prints π²/48 for the
//!   triangle;
//! * decreasing: αG_max − v_m ln(2v_mζ/(F(μ_s − μ_m)e^{−αG_max/v_m}m)) (3.55), (3.59). It rises with α: dither can destabilise.
//!
//! A band exists where the upper edge is above the lower one. For normal dither α = μ(v₀)α_N at the edge itself
//! (4.33)–(4.42). [`unstable_bands`] finds the bands of any belt with any dithers from the criterion itself; the closed
//! forms ([`closed_band`]) are the fast alternative and a check. For a law without closed forms the edge is searched numerically.

use std::fmt;

use quell_model::friction::{SlidingLaw, Stribeck};
use quell_model::{Belt, Friction, Waveform};
use quell_numerics::order::ascending;
use quell_numerics::special::ln;

use super::averaged_law::AveragedLaw;
use super::criterion::{AveragedVerdict, Criterion, UndecidedBecause};
use super::decreasing::scaled_mean_exponential;
use super::dithers::Averaging;
use super::error::AveragingError;
use super::fast_motion::FastMotion;
use super::periodic::Signal;
use super::sign_changes::{CrossingKind, sign_changes};
use super::single_wave;
use super::wave::FastWave;

/// Belt velocities above which undithered steady sliding is stable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CriticalVelocity {
    /// Stable at every belt velocity v₀ > 0: damping exceeds the steepest negative slope of the law.
    StableEverywhere,
    /// Stable above this belt velocity, unstable below it.
    Above(f64),
    /// Unstable at every belt velocity examined. Closed forms: all velocities, without damping. Other laws: velocities up to 365
    /// v_m, of which the fastest decides.
    UnstableEverywhere,
}

/// A band of unstable belt velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnstableBand {
    /// Lower edge, a velocity; 0 where the instability extends down to rest.
    pub lower: f64,
    /// How stability is lost at the lower edge (for increasing v₀); `None` at v₀ → 0.
    pub lower_crossing: Option<CrossingKind>,
    /// Upper edge; `None` where the instability has no upper end, or none in the range examined.
    pub upper: Option<f64>,
}

/// Why there is no band of unstable belt velocities.
#[derive(Clone, Debug, PartialEq)]
pub enum NoBand {
    /// Every belt velocity beyond the fast velocity is stable.
    Stable,
    /// An average could not be computed.
    Failed(AveragingError),
}

impl fmt::Display for NoBand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stable => f.write_str("every belt velocity beyond the fast velocity is stable"),
            Self::Failed(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NoBand {}

/// Belt velocity above which undithered steady sliding is locally stable.
///
/// # Errors
/// [`AveragingError`] from a quadrature, for a law without closed forms.
pub fn undithered_critical_velocity(
    law: &Friction,
    damping_ratio: f64,
    normal_load: f64,
) -> Result<CriticalVelocity, AveragingError> {
    Ok(match outer_edge(law, damping_ratio, normal_load, &Waveform::Sine, 0.0)? {
        None => CriticalVelocity::UnstableEverywhere,
        Some(v) if v > 0.0 => CriticalVelocity::Above(v),
        Some(_) => CriticalVelocity::StableEverywhere,
    })
}

/// Unstable band under one tangential dither of amplitude ratio α ≥ 0 in the limit of high frequency. Instability below
/// αG_max, which is possible with steep laws, is left to [`unstable_bands`].
///
/// # Errors
/// [`NoBand::Stable`] where α stabilises every belt velocity; [`NoBand::Failed`] where a quadrature fails.
pub fn closed_band(
    law: &Friction,
    damping_ratio: f64,
    normal_load: f64,
    waveform: &Waveform,
    alpha: f64,
) -> Result<UnstableBand, NoBand> {
    let lower = alpha * waveform.peak_integral();
    let upper = outer_edge(law, damping_ratio, normal_load, waveform, alpha);
    let upper = upper.map_err(NoBand::Failed)?;
    let lower_crossing = (alpha > 0.0).then_some(CrossingKind::Jump);
    let is_there = upper.is_none_or(|upper| upper > lower);
    is_there.then_some(UnstableBand { lower, lower_crossing, upper }).ok_or(NoBand::Stable)
}

/// κ = 4v_mζ/(3F(μ_s − μ_m)): ratio of the damping to the steepest negative slope of the Stribeck law. κ ≥ 1 stabilises every
/// velocity.
pub(super) fn kappa(law: &Stribeck, damping_ratio: f64, normal_load: f64) -> f64 {
    let difference = law.static_coefficient() - law.minimum_coefficient();
    4.0 * law.velocity_scale() * damping_ratio / (3.0 * normal_load * difference)
}

/// Root of the outer criterion in v₀, continued below the corner; 0 where the criterion is positive at every velocity,
/// `None` where it is not positive at the last velocity examined.
fn outer_edge(
    law: &Friction,
    damping_ratio: f64,
    normal_load: f64,
    waveform: &Waveform,
    alpha: f64,
) -> Result<Option<f64>, AveragingError> {
    let vm = law.velocity_scale();
    let ratio = alpha / vm;
    Ok(match law {
        Friction::Stribeck(law) => {
            let difference = law.static_coefficient() - law.minimum_coefficient();
            if difference == 0.0 {
                return Ok(Some(0.0));
            }
            let square = 1.0
                - kappa(law, damping_ratio, normal_load)
                - waveform.mean_square_integral() * ratio * ratio;
            Some(vm * square.max(0.0).sqrt())
        }
        Friction::Decreasing(law) => {
            let difference = law.static_coefficient() - law.minimum_coefficient();
            if difference == 0.0 {
                return Ok(Some(0.0));
            }
            if damping_ratio == 0.0 {
                return Ok(None);
            }
            let corner = alpha * waveform.peak_integral();
            let scaled = scaled_mean_exponential(waveform, ratio)?;
            let edge =
                corner - vm * ln(2.0 * vm * damping_ratio / (normal_load * difference * scaled));
            Some(edge.max(0.0))
        }
        law => searched_edge(law, damping_ratio, normal_load, waveform, alpha)?,
    })
}

/// The same for a law without closed forms: the last velocity beyond the corner at which the criterion becomes positive, searched
/// on a grid up to 365 v_m beyond the corner.
fn searched_edge(
    law: &Friction,
    damping_ratio: f64,
    normal_load: f64,
    waveform: &Waveform,
    alpha: f64,
) -> Result<Option<f64>, AveragingError> {
    let wave = FastWave::Integral(waveform.clone());
    let corner = alpha * wave.peak();
    let value = |v: f64| -> Result<f64, AveragingError> {
        let effective = if alpha == 0.0 {
            single_wave::undithered(law, v)?
        } else {
            single_wave::effective(law, &wave, alpha, v)?
        };
        Ok(Criterion::new(damping_ratio, normal_load, effective).value)
    };
    let beyond = (0..260).map(|k| libm::exp(-20.0 + 0.1 * f64::from(k)));
    let points: Vec<f64> = beyond.map(|share| corner + law.velocity_scale() * share).collect();
    let changes = sign_changes(value, &points, &[])?;
    Ok(match changes.last() {
        Some(last) => last.becomes_positive.then_some(last.location),
        None => (value(points[0])? >= 0.0).then_some(0.0),
    })
}

/// Every band of belt velocities v₀ > 0 in which averaged steady sliding of `belt` is unstable, in ascending order. The dithers
/// of `belt` are held fixed; its belt velocity is ignored. Velocities up to 200 v_m beyond the fast velocity are examined.
///
/// # Errors
/// [`AveragingError`].
pub fn unstable_bands(
    belt: &Belt,
    averaging: Averaging,
) -> Result<Vec<UnstableBand>, AveragingError> {
    let law = belt.friction();
    let motion = |v: f64| FastMotion::of(belt, v, averaging);
    let criterion = |v: f64| -> Result<Criterion, AveragingError> {
        let effective = AveragedLaw::of_one_mass(belt, v, averaging)?.at(v)?;
        Ok(Criterion::new(belt.damping_ratio(), belt.normal_load(), effective))
    };
    let value = |v: f64| criterion(v).map(|found| found.value);
    let vm = law.velocity_scale();
    // Upper bound of the fast velocity: the coefficient that drives normal dither is largest at the static level or far out.
    let reach = motion(vm)?.largest_slip()?.max(motion(1e-9 * vm)?.largest_slip()?);
    let mut points: Vec<f64> =
        (0..60).map(|k| vm * libm::exp(-14.0 + 0.25 * f64::from(k))).collect();
    points.extend((1..=80).map(|k| 2.0 * reach * f64::from(k) / 80.0));
    points.extend((1..=60).map(|k| reach + vm * 0.05 * f64::from(k)));
    points.extend((0..30).map(|k| reach + 3.0 * vm * libm::exp(0.15 * f64::from(k))));
    points.retain(|v| *v > 0.0);
    ascending(&mut points);
    points.dedup();
    let excess = |v: f64| -> Result<f64, AveragingError> { Ok(v - motion(v)?.largest_slip()?) };
    let still = motion(vm)?;
    let corners: Vec<f64> = match still.groups() {
        // Under noise the average is smooth.
        _ if still.noise() > 0.0 => Vec::new(),
        // Tangential dither moves the mass in the same way at every velocity: every maximum of the fast velocity is a corner.
        [group] if group.normal.is_empty() && group.single_term().is_none() => {
            let extrema = Signal::new(group)?.turning_values().into_iter();
            extrema.filter(|extremum| *extremum > 0.0).collect()
        }
        _ => sign_changes(excess, &points, &[])?.into_iter().map(|c| c.location).collect(),
    };
    for corner in &corners {
        points.extend((0..24).map(|k| corner * (1.0 - libm::exp(-30.0 + 1.2 * f64::from(k)))));
    }
    points.retain(|v| *v > 0.0);
    ascending(&mut points);
    let changes = sign_changes(value, &points, &corners)?;
    let mut bands = Vec::new();
    let starts_unstable = value(points[0])? < 0.0;
    let mut open = starts_unstable.then_some((0.0, None));
    for change in changes {
        if change.becomes_positive {
            if let Some((lower, lower_crossing)) = open.take() {
                bands.push(UnstableBand { lower, lower_crossing, upper: Some(change.location) });
            }
        } else {
            open = Some((change.location, Some(change.crossing)));
        }
    }
    if let Some((lower, lower_crossing)) = open {
        bands.push(UnstableBand { lower, lower_crossing, upper: None });
    }
    // Where the criterion is zero throughout, without damping and without a slope, nothing grows. A single point would not prove
    // it: far out, the slope of an exponentially decreasing law is below rounding error too.
    let neutral = AveragedVerdict::Undecided { why: UndecidedBecause::WithinError };
    let grows = |band: &UnstableBand| -> Result<bool, AveragingError> {
        let is_inside = |v: &f64| *v > band.lower && band.upper.is_none_or(|upper| *v < upper);
        let mut inside = points.iter().copied().filter(is_inside).peekable();
        if inside.peek().is_none() {
            return Ok(true);
        }
        for v in inside {
            if criterion(v)?.verdict != neutral {
                return Ok(true);
            }
        }
        Ok(false)
    };
    let mut growing = Vec::with_capacity(bands.len());
    for band in bands {
        if grows(&band)? {
            growing.push(band);
        }
    }
    Ok(growing)
}
