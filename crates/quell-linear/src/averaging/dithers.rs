//! The fast motion under one or several dithers: slip velocity s and normal load ν, grouped by frequency.
//!
//! Here in the limit of high frequency; at finite R the fast motion is that of the system of a belt ([`super::FastInputs`]).
//! Tangential dither D g(Rτ + φ) moves the mass with the velocity αG (α = D/R). Normal dither moves it through friction (4.23):
//! φ′ = α_N μ G − (α_N²/2) μμ′ (G² − ⟨G²⟩) + … with α_N = D_N/R_N; [`Averaging`] selects how many terms are kept. μ and μ′ are
//! evaluated at the slow slip velocity and then *frozen*.
//!
//! Dithers whose frequency ratio is a ratio of small whole numbers form one periodic group and keep their phases; groups
//! of incommensurate frequencies are averaged over independent phases. Several normal dithers of one group
//! enter through their sum H = Σ α_N G; the second term is −(1/2)μμ′(H² − ⟨H²⟩).
//!
//! Closure for dither in both directions: the level μ that drives the motion due to the normal dithers is the effective friction
//! under the tangential dithers alone. The sum and difference frequencies of the two directions are neglected. This is exact to
//! first order in α_N when α_T ≪ v.
//!
//! Noise is a Gaussian velocity, independent of the groups, whose variance is the sum over its lines: ½ Σ (αᵢ)². Its load is
//! uncorrelated with its slip, line by line. Normal noise keeps the first term alone: the second has lines at the differences of the
//! frequencies, which are not fast, and no Gaussian distribution.
//!
//! Limitations: leading order in 1/R. The differences of the dither frequencies must be fast too: a slow beat is not averaged out.

use quell_model::{Direction, Dither, Friction};

use super::error::AveragingError;
use super::fast_motion::FastMotion;
use super::mean_friction::effective;
use super::periodic_motion::{LoadTerm, LoadWave, PeriodicMotion, SlipTerm};
use super::wave::FastWave;

/// Model of the fast motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Averaging {
    /// The limit of high dither frequency R → ∞, the averaging of the dissertation: the fast velocity is αG, and normal dither moves
    /// the mass to first order, φ′ = α_N μ G: the substitution α_T → μ(v₀)α_N of (4.33)–(4.42).
    #[default]
    Limit,
    /// The same with the second term of normal dither, −(α_N²/2) μμ′ (G² − ⟨G²⟩): for a sine, the cos 2R_Nτ term of (4.22).
    LimitToSecondOrder,
    /// The response of the mass on its spring and damper at the study's frequencies, that of normal dither to second order
    /// ([`super::DitheredSystem`]).
    FiniteR,
}

impl FastMotion {
    /// Fast motion of dithers in the limit of high frequency under the law and the load of a belt, whether or not the contact would stay
    /// closed.
    pub(super) fn in_the_limit(
        (law, normal_load): (&Friction, f64),
        dithers: &[Dither],
        v: f64,
        to_second_order: bool,
    ) -> Result<Self, AveragingError> {
        let acting: Vec<&Dither> = dithers.iter().filter(|d| d.amplitude > 0.0).collect();
        let (level, slope) = friction_level(law, &acting, v)?;
        let mut groups = grouped(&acting, (level, normal_load));
        if to_second_order && level != 0.0 {
            for group in groups.iter_mut().filter(|group| !group.normal.is_empty()) {
                group.distortion = -0.5 * slope / level;
            }
        }
        Ok(Self::new(groups).with_noise(noise_variance(&acting, level).sqrt()))
    }
}

/// Variance of the fast velocity under the noise among some dithers; normal noise is driven by the friction coefficient `level`.
fn noise_variance(dithers: &[&Dither], level: f64) -> f64 {
    let own = |dither: &&Dither| {
        let level = if dither.direction == Direction::Normal { level } else { 1.0 };
        dither.amplitude_ratio() * level * unit_noise(dither)
    };
    dithers.iter().map(own).map(|own| own * own).sum()
}

/// Standard deviation of the fast velocity under a dither of noise for D/R = 1 in the limit of high frequency; 0 of another waveform.
pub(super) fn unit_noise(dither: &Dither) -> f64 {
    dither.waveform.noise().map_or(0.0, |noise| noise.mean_square(|ratio| 1.0 / ratio).sqrt())
}

/// Groups of dithers of commensurate frequencies; the motion due to normal dithers is driven by the friction coefficient `level`
/// under the load.
fn grouped(dithers: &[&Dither], (level, normal_load): (f64, f64)) -> Vec<PeriodicMotion> {
    let periodic = dithers.iter().filter(|dither| dither.waveform.is_periodic());
    let dithers: Vec<Dither> = periodic.flat_map(|dither| dither.by_harmonics()).collect();
    let frequencies: Vec<f64> = dithers.iter().map(Dither::repetition_ratio).collect();
    let groups = commensurate_groups(&frequencies).into_iter().map(|members| {
        let mut group = PeriodicMotion { load_is_slope: true, ..PeriodicMotion::default() };
        for (index, multiple) in members {
            let dither = &dithers[index];
            let harmonic = multiple * dither.waveform.cycles();
            let wave = FastWave::Integral(dither.waveform.clone());
            let (alpha, phase) = (dither.amplitude_ratio(), dither.phase);
            match dither.direction {
                Direction::Tangential => {
                    group.tangential.push(SlipTerm { wave, amplitude: alpha, harmonic, phase });
                }
                Direction::Normal => {
                    let amplitude = alpha * level;
                    group.normal.push(SlipTerm { wave, amplitude, harmonic, phase });
                    group.load.push(LoadTerm {
                        wave: LoadWave::Waveform(dither.waveform.clone()),
                        amplitude: dither.amplitude / normal_load,
                        harmonic,
                        phase,
                    });
                }
            }
        }
        group
    });
    groups.collect()
}

/// Friction coefficient and slope that drive the motion due to the normal dithers at slow slip velocity v.
fn friction_level(
    law: &Friction,
    dithers: &[&Dither],
    v: f64,
) -> Result<(f64, f64), AveragingError> {
    if dithers.iter().all(|d| d.direction == Direction::Tangential) {
        return Ok((0.0, 0.0));
    }
    let tangential: Vec<&Dither> =
        dithers.iter().copied().filter(|d| d.direction == Direction::Tangential).collect();
    if tangential.is_empty() {
        if v == 0.0 {
            return Ok((0.0, 0.0));
        }
        return Ok((law.coefficient(v.abs()).copysign(v), law.slope(v.abs())));
    }
    // There is no normal dither among them, so level and load have no effect.
    let groups = grouped(&tangential, (0.0, 1.0));
    let noise = noise_variance(&tangential, 0.0).sqrt();
    let mean = effective(law, &FastMotion::new(groups).with_noise(noise), v)?;
    Ok((mean.coefficient, mean.slope))
}

/// Largest multiple of a group's base frequency that still counts as commensurate.
pub const MAX_HARMONIC: u32 = 64;

/// Groups of frequencies in small whole-number ratios: the index of each member with its multiple of the group's base.
pub(crate) fn commensurate_groups(frequencies: &[f64]) -> Vec<Vec<(usize, u32)>> {
    let mut groups: Vec<Vec<(usize, u32)>> = Vec::new();
    'members: for (index, frequency) in frequencies.iter().enumerate() {
        for group in &mut groups {
            let (first, multiple) = group[0];
            let ratio = frequency / frequencies[first] * f64::from(multiple);
            let Some((p, q)) = small_ratio(ratio) else {
                continue;
            };
            // In units of base/q the harmonics of all members are multiplied by q.
            if group.iter().all(|(_, m)| m * q <= MAX_HARMONIC) && p <= MAX_HARMONIC {
                for member in group.iter_mut() {
                    member.1 *= q;
                }
                group.push((index, p));
                continue 'members;
            }
        }
        groups.push(vec![(index, 1)]);
    }
    groups
}

/// p/q = ratio within 10⁻¹² with p, q ≤ [`MAX_HARMONIC`], in lowest terms.
fn small_ratio(ratio: f64) -> Option<(u32, u32)> {
    (1..=MAX_HARMONIC).find_map(|q| {
        let p = (ratio * f64::from(q)).round();
        let near = (ratio * f64::from(q) - p).abs() <= 1e-12 * p;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "p is a whole number between 1 and MAX_HARMONIC"
        )]
        (near && p >= 1.0 && p <= f64::from(MAX_HARMONIC)).then_some((p as u32, q))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_by_frequency() {
        let ratios = [10.0, 15.0, 10.0 * core::f64::consts::SQRT_2, 5.0, 20.0, 7.5];
        let groups = commensurate_groups(&ratios);
        let found: Vec<Vec<(f64, u32)>> = groups
            .iter()
            .map(|g| g.iter().map(|(index, m)| (ratios[*index], *m)).collect())
            .collect();
        // Base 2.5.
        let first = vec![(10.0, 4), (15.0, 6), (5.0, 2), (20.0, 8), (7.5, 3)];
        assert_eq!(found, vec![first, vec![(ratios[2], 1)]]);
        assert_eq!(small_ratio(1.0 + 1e-9), None);
        assert_eq!(small_ratio(64.5), None);
    }
}
