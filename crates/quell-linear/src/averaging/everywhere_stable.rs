//! The amplitude that stabilises steady sliding at every belt velocity, α^L.
//!
//! Outside the corner the criterion is smallest at the tip v₀ = αG_max, so the outer region is stable for all v₀ when
//! h(α) = 2ζ + Fμ̄′(αG_max⁺; α) ≥ 0. Roots of h:
//! * Stribeck law, closed form: α^L = v_m√((1 − κ)/(G_max² + ⟨G²⟩)), κ = 4v_mζ/(3F(μ_s − μ_m)): sine v_m√(2(1 − κ)/3), triangle
//!   (v_m/π)√(240(1 − κ)/23), square (v_m/π)√(3(1 − κ)). The printed formulas (3.44) (a nested root) and (3.48) are wrong, and
//!   (4.38) is too large by a factor of two;
//! * decreasing law: e^{−c}m(α/v_m) = 2v_mζ/(F(μ_s − μ_m)), c = αG_max/v_m. The left side decreases to 0, so a root exists for
//!   any ζ > 0, but for light damping and smooth waves it is far outside any plot (sine, ζ = 0.005: 104). Without damping no root
//!   exists.
//!
//! "μ̄′ ≥ 0 inside" is true for the values of the dissertation but not in general (Stribeck: iff (μ_s − μ_m)/μ_s ≤ √6/π, √0.4, 1
//! for sine, triangle, square). The inner region is therefore searched too, and α^L is the amplitude beyond which both regions
//! are stable.
//!
//! Normal dither: v₀ is unstable for α_N up to α/μ(v₀), where α is the largest unstable tangential amplitude at v₀. α_N^L is the
//! maximum over v₀. It is at the tip, α^L/μ(α^L G_max) ((4.34)–(4.42) leave μ(v₀) open), unless μ decreases steeply beyond it.

use quell_model::friction::SlidingLaw;
use quell_model::{Direction, Friction};
use quell_numerics::roots::{Closeness, minimise, try_minimise};

use super::criterion::Criterion;
use super::edges::{CriticalVelocity, kappa, undithered_critical_velocity};
use super::error::AveragingError;
use super::sign_changes::{grown, sign_changes};
use super::single_wave;
use super::wave::FastWave;

/// The amplitude ratio beyond which steady sliding is stable at every belt velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EverywhereStable {
    /// Stable at every belt velocity even without dither.
    Always,
    /// Stable for every α ≥ `amplitude_ratio`.
    From {
        /// α^L (α_N^L for normal dither).
        amplitude_ratio: f64,
        /// Estimate of its numerical error. Where a maximum over belt velocities is searched on a grid (normal dither with a law
        /// or a wave without closed forms), a maximum between neighbouring grid points is missed, and the estimate does not
        /// include it.
        error: f64,
    },
    /// Stable for no amplitude.
    Never {
        /// The reason.
        why: NeverStable,
    },
}

/// Why no amplitude stabilises every belt velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NeverStable {
    /// There is no damping, and the law decreases at all velocities.
    NoDamping,
    /// Slow sliding below the fast velocity stays unstable at any amplitude.
    InnerRegion,
    /// No root up to 10⁶ v_m.
    OffScale,
    /// There is damping, but without dither sliding does not become stable at any belt velocity up to 365 v_m. Amplitudes were
    /// not tried.
    NoEdge,
}

/// α^L for one dither of the given shape and direction.
///
/// # Errors
/// [`AveragingError`] from a quadrature.
pub fn everywhere_stable_amplitude(
    law: &Friction,
    damping_ratio: f64,
    normal_load: f64,
    wave: FastWave,
    direction: Direction,
) -> Result<EverywhereStable, AveragingError> {
    let dithered = DitheredLaw { law, damping_ratio, normal_load, wave };
    let tangential = match undithered_critical_velocity(law, damping_ratio, normal_load)? {
        CriticalVelocity::StableEverywhere => EverywhereStable::Always,
        CriticalVelocity::UnstableEverywhere => {
            let damped = damping_ratio > 0.0;
            let why = if damped { NeverStable::NoEdge } else { NeverStable::NoDamping };
            EverywhereStable::Never { why }
        }
        CriticalVelocity::Above(_) => dithered.tangential()?,
    };
    match (direction, tangential) {
        (Direction::Normal, EverywhereStable::From { amplitude_ratio, error }) => {
            let (normal, searched) = dithered.normal(amplitude_ratio)?;
            let error = normal * (error / amplitude_ratio + searched + 4.0 * f64::EPSILON);
            Ok(EverywhereStable::From { amplitude_ratio: normal, error })
        }
        (_, tangential) => Ok(tangential),
    }
}

/// Relative tolerance of the search for the location of a maximum over belt velocities. Its square, which is the error of the
/// maximum itself, is below the accuracy required of α^L (10⁻¹¹). Each location costs 32 averages.
const SEARCHED: f64 = 1e-6;

/// A law, damping and load under dither of one shape.
struct DitheredLaw<'a> {
    law: &'a Friction,
    damping_ratio: f64,
    normal_load: f64,
    wave: FastWave,
}

impl DitheredLaw<'_> {
    fn criterion(&self, alpha: f64, v: f64) -> Result<f64, AveragingError> {
        let effective = single_wave::effective(self.law, &self.wave, alpha, v)?;
        Ok(Criterion::new(self.damping_ratio, self.normal_load, effective).value)
    }

    /// h(α): outer criterion at the tip.
    fn tip(&self, alpha: f64) -> Result<f64, AveragingError> {
        let (shape, gain) = self.wave.clone().canonical();
        // The corner in the same arithmetic as in the averages, so that it is hit exactly.
        self.criterion(alpha, (alpha * gain) * shape.peak())
    }

    /// Smallest criterion over the inner region.
    fn worst_inside(&self, alpha: f64) -> Result<f64, AveragingError> {
        const SAMPLES: usize = 24;
        let corner = alpha * self.wave.peak();
        let location = |k: usize| corner * (k as f64 / SAMPLES as f64);
        let mut worst = (self.criterion(alpha, 0.0)?, 0);
        for k in 1..SAMPLES {
            let value = self.criterion(alpha, location(k))?;
            if value < worst.0 {
                worst = (value, k);
            }
        }
        if worst.1 == 0 {
            return Ok(worst.0);
        }
        let value = |v: f64| self.criterion(alpha, v);
        let closeness = Closeness { absolute: 0.0, relative: 1e-8 };
        let bottom = try_minimise(value, location(worst.1 - 1), location(worst.1 + 1), closeness)?;
        Ok(bottom.map_or(worst.0, |bottom| bottom.value.min(worst.0)))
    }

    fn tangential(&self) -> Result<EverywhereStable, AveragingError> {
        let vm = self.law.velocity_scale();
        let Some((outer, error)) = self.outer()? else {
            return Ok(EverywhereStable::Never { why: NeverStable::OffScale });
        };
        // The inner region at larger amplitudes.
        let scale = outer.max(vm);
        let mut points = vec![outer];
        while points[points.len() - 1] < 1e3 * scale {
            points.push(grown(points[points.len() - 1], 1.3));
        }
        let last = points[points.len() - 1];
        if self.worst_inside(last)? < 0.0 {
            return Ok(EverywhereStable::Never { why: NeverStable::InnerRegion });
        }
        let changes = sign_changes(|alpha| self.worst_inside(alpha), &points, &[])?;
        Ok(changes.last().map_or(
            EverywhereStable::From { amplitude_ratio: outer, error },
            |change| EverywhereStable::From {
                amplitude_ratio: change.location,
                error: change.error.max(1e-12 * change.location),
            },
        ))
    }

    /// Largest root of h and its error.
    fn outer(&self) -> Result<Option<(f64, f64)>, AveragingError> {
        let vm = self.law.velocity_scale();
        if let (Friction::Stribeck(law), FastWave::Integral(waveform)) = (self.law, &self.wave) {
            let kappa = kappa(law, self.damping_ratio, self.normal_load);
            let peak = self.wave.peak();
            let alpha =
                vm * ((1.0 - kappa) / (peak * peak + waveform.mean_square_integral())).sqrt();
            return Ok(Some((alpha, 4.0 * f64::EPSILON * alpha)));
        }
        let points: Vec<f64> =
            (0..320).map(|k| vm * libm::exp(-18.0 + 0.1 * f64::from(k))).collect();
        let changes = sign_changes(|alpha| self.tip(alpha), &points, &[])?;
        Ok(changes.last().filter(|c| c.becomes_positive).map(|c| (c.location, c.error)))
    }

    /// Largest α/μ(v₀) between the tip and the velocity above which sliding is stable without dither, for a law or a
    /// wave without closed forms: searched on a grid of velocities and refined at the best one.
    fn searched_normal(&self, tip: f64, end: f64) -> Result<f64, AveragingError> {
        const VELOCITIES: usize = 24;
        const AMPLITUDES: u32 = 32;
        let peak = self.wave.peak();
        // −α/μ(v₀), where α is the largest unstable amplitude whose corner is below v₀.
        let ratio = |v: f64| -> Result<f64, AveragingError> {
            let location = |k: u32| v / peak * (1.0 - 1e-12) * f64::from(k) / f64::from(AMPLITUDES);
            let points: Vec<f64> = (1..=AMPLITUDES).map(location).collect();
            let changes = sign_changes(|alpha| self.criterion(alpha, v), &points, &[])?;
            Ok(-changes.last().map_or(0.0, |last| last.location) / self.law.coefficient(v))
        };
        let location = |k: usize| tip + (end - tip) * k as f64 / VELOCITIES as f64;
        let mut best = (0.0, 1);
        for k in 1..VELOCITIES {
            let value = ratio(location(k))?;
            if value < best.0 {
                best = (value, k);
            }
        }
        let closeness = Closeness { absolute: 0.0, relative: SEARCHED };
        let bottom = try_minimise(ratio, location(best.1 - 1), location(best.1 + 1), closeness)?;
        Ok(-bottom.map_or(best.0, |bottom| bottom.value.min(best.0)))
    }

    /// Largest unstable α_N from the largest unstable α at each belt velocity, and its relative error in addition to that of α.
    fn normal(&self, tangential: f64) -> Result<(f64, f64), AveragingError> {
        let tip = tangential * self.wave.peak();
        let at_tip = tangential / self.law.coefficient(tip);
        let CriticalVelocity::Above(end) =
            undithered_critical_velocity(self.law, self.damping_ratio, self.normal_load)?
        else {
            return Ok((at_tip, 0.0));
        };
        // The error of the value at a maximum is the square of the error of its location.
        let searched = || Ok((self.searched_normal(tip, end)?.max(at_tip), SEARCHED * SEARCHED));
        let law = match self.law {
            // Its coefficient decreases more slowly than its largest unstable α.
            Friction::Decreasing(_) => return Ok((at_tip, 0.0)),
            Friction::Stribeck(law) => law,
            _ => return searched(),
        };
        // Stribeck law beyond the tip: the outer root α(v₀) decreases, but α/μ could still rise where μ decreases steeply.
        let (wave, gain) = self.wave.clone().canonical();
        let FastWave::Integral(waveform) = wave else { return searched() };
        let mean_square = gain * gain * waveform.mean_square_integral();
        let ratio = |v: f64| {
            let square = (end - v) * (end + v) / mean_square;
            -square.max(0.0).sqrt() / law.coefficient(v)
        };
        let closeness = Closeness { absolute: 0.0, relative: 1e-9 };
        let found = minimise(ratio, tip, end, closeness);
        let error = closeness.relative * closeness.relative;
        Ok((found.map_or(at_tip, |best| at_tip.max(-best.value)), error))
    }
}
