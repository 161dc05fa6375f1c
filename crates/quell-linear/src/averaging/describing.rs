//! Describing function of averaged friction: a slow sinusoid in addition to the dither.
//!
//! For the slip velocity v₀ + a sin φ − s(θ) with independent phases φ and θ, friction has the mean μ₀(a) = ⟨μ̄(v₀ + a sin φ)⟩ and
//! the harmonic aN₁(a) sin φ with the equivalent gain
//!
//! N₁(a) = (2/a) ⟨μ̄(v₀ + a sin φ) sin φ⟩ = (2/πa) ∫₀^{π/2} [μ̄(v₀ + a sin φ) − μ̄(v₀ − a sin φ)] sin φ dφ,
//!
//! because the average over the dither comes first: this is the dual-input describing function of the law (Gelb and Vander Velde,
//! *Multiple-Input Describing Functions and Nonlinear System Design*, 1968, chapter 6). For a → 0 it is μ̄′(v₀). Integration by
//! parts gives N₁(a) = 2⟨μ̄′(v₀ + a sin φ) cos² φ⟩ where μ̄ is continuous.
//!
//! A slow motion of velocity amplitude a keeps its energy where 2ζ + FN₁(a) = 0 (first harmonic of the averaged equation; error of
//! the order of the change per slow period). The cycle is stable where that sum increases with a. Of a system it is the growth rate of
//! the slow motion that vanishes ([`super::SlowVibration`]).
//!
//! The fast motion s is frozen at the belt velocity, as in the criterion. Under tangential dither it does not depend on the slip
//! velocity anyway.
//!
//! Accuracy: 10⁻¹⁰ of μ_s/a. Up to two groups of incommensurate frequencies, because each value is itself an integral.

use core::f64::consts::{FRAC_PI_2, PI};

use quell_model::Belt;
use quell_numerics::order::ascending;
use quell_numerics::quadrature::{QuadratureOptions, integrate};

use super::averaged_law::AveragedLaw;
use super::dithers::Averaging;
use super::effective::SlopeSide;
use super::error::{AveragingError, settled};
use super::sign_changes::sign_changes;

/// Largest number of incommensurate groups whose mean is taken at every slow phase.
const MOST_GROUPS: usize = 2;

/// Accuracy of the integrals, relative to the law.
const CLOSENESS: f64 = 1e-11;

/// Amplitudes between corners at which the balance of energy is examined for cycles.
const POINTS: u32 = 64;

/// Averaged friction under a slow sinusoid of the slip velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquivalentGain {
    /// Amplitude a of the slow slip velocity.
    pub amplitude: f64,
    /// Mean coefficient μ₀(a).
    pub coefficient: f64,
    /// Equivalent gain N₁(a), per unit velocity.
    pub gain: f64,
    /// Bound on the numerical error of `gain`.
    pub error: f64,
}

/// A slow cycle at which damping and averaged friction balance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DescribedCycle {
    /// Velocity amplitude a; that of the displacement is the same number of lengths.
    pub amplitude: f64,
    /// Bound on its numerical error.
    pub error: f64,
    /// Whether slow motions near it approach it.
    pub stable: bool,
}

/// The describing function of an averaged law at a slow slip velocity.
#[derive(Clone, Debug)]
pub struct DescribingFunction {
    law: AveragedLaw,
    velocity: f64,
    corners: Vec<f64>,
}

impl DescribingFunction {
    /// Prepares the describing function of a law at the mean v₀ of the slip velocity.
    ///
    /// # Errors
    /// [`AveragingError`] for more than two groups of incommensurate frequencies.
    pub fn new(law: AveragedLaw, velocity: f64) -> Result<Self, AveragingError> {
        let groups = law.groups();
        if groups > MOST_GROUPS {
            return Err(AveragingError::TooManyGroups { groups, largest: MOST_GROUPS });
        }
        let corners = law.corners()?;
        Ok(Self { law, velocity, corners })
    }

    /// That of a belt under its dithers, at its belt velocity.
    ///
    /// # Errors
    /// As [`DescribingFunction::new`], and where the fast motion has no value.
    pub fn of_one_mass(belt: &Belt, averaging: Averaging) -> Result<Self, AveragingError> {
        let velocity = belt.belt_velocity();
        Self::new(AveragedLaw::of_one_mass(belt, velocity, averaging)?, velocity)
    }

    /// Mean and equivalent gain at an amplitude a > 0 of the slow slip velocity.
    ///
    /// # Errors
    /// [`AveragingError`]: a mean over the dither, or a quadrature over the slow phase, that has no value.
    pub fn at(&self, amplitude: f64) -> Result<EquivalentGain, AveragingError> {
        let v0 = self.velocity;
        let sines = self.corners.iter().map(|corner| ((corner - v0) / amplitude).abs());
        let cuts: Vec<f64> = sines.filter(|sine| *sine < 1.0).map(libm::asin).collect();
        let mut failure = None;
        let mut inner = 0.0_f64;
        let mut of = |phase: f64, odd: bool| {
            let moved = amplitude * libm::sin(phase);
            match (self.law.at_or_middle(v0 + moved), self.law.at_or_middle(v0 - moved)) {
                (Ok(above), Ok(below)) => {
                    inner = inner.max(above.coefficient_error + below.coefficient_error);
                    if odd {
                        (above.coefficient - below.coefficient) * libm::sin(phase)
                    } else {
                        above.coefficient + below.coefficient
                    }
                }
                (Err(why), _) | (_, Err(why)) => {
                    failure.get_or_insert(why);
                    0.0
                }
            }
        };
        let scale = self.law.law().static_coefficient();
        let options = QuadratureOptions {
            relative: CLOSENESS,
            absolute: CLOSENESS * scale,
            ..QuadratureOptions::default()
        };
        let mean = integrate(|phase| of(phase, false), 0.0, FRAC_PI_2, &cuts, &options);
        let first = integrate(|phase| of(phase, true), 0.0, FRAC_PI_2, &cuts, &options);
        if let Some(why) = failure {
            return Err(why);
        }
        let (mean, first) = (settled(mean)?, settled(first)?);
        let factor = 2.0 / (PI * amplitude);
        Ok(EquivalentGain {
            amplitude,
            coefficient: mean.value / PI,
            gain: factor * first.value,
            error: factor * (first.error + inner + 1e-15 * scale),
        })
    }

    /// N₁ for a → 0, the slope of averaged friction at the belt velocity; `None` where the slope jumps there.
    ///
    /// # Errors
    /// [`AveragingError`], in particular [`AveragingError::SetValued`] for a belt at rest without dither.
    pub fn small(&self) -> Result<Option<f64>, AveragingError> {
        let v0 = self.velocity;
        let found = self.law.at(v0)?;
        Ok((found.side == SlopeSide::Both).then_some(found.slope))
    }

    /// Amplitudes at which a corner of averaged friction enters the slow motion.
    pub fn corner_amplitudes(&self) -> Vec<f64> {
        let v0 = self.velocity;
        let mut found: Vec<f64> = self.corners.iter().map(|corner| (corner - v0).abs()).collect();
        found.retain(|amplitude| *amplitude > 0.0);
        ascending(&mut found);
        found.dedup();
        found
    }

    /// Every cycle up to a velocity amplitude, in ascending order. `balance` is positive where a slow motion with this equivalent
    /// gain loses energy.
    ///
    /// # Errors
    /// As [`DescribingFunction::at`], and the first error of `balance`.
    pub fn cycles<E: From<AveragingError>>(
        &self,
        largest: f64,
        mut balance: impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<Vec<DescribedCycle>, E> {
        let corners = self.corner_amplitudes();
        let mut ends: Vec<f64> = corners.iter().copied().filter(|end| *end < largest).collect();
        ends.push(largest);
        // Geometric up to the first corner, then equal steps, closer after each corner.
        let least = 1e-3 * ends[0];
        let mut points: Vec<f64> = (0..12)
            .map(|k| least * libm::exp(libm::log(1e3 / f64::from(POINTS)) * f64::from(k) / 12.0))
            .collect();
        let mut from = 0.0;
        for end in ends {
            points.extend(
                (1..=POINTS).map(|k| from + (end - from) * f64::from(k) / f64::from(POINTS)),
            );
            points.extend((1..8).map(|k| end * (1.0 + libm::exp(-2.0 - f64::from(k)))));
            from = end;
        }
        points.retain(|point| *point > 0.0 && *point <= largest);
        ascending(&mut points);
        points.dedup();
        let balance = |amplitude: f64| -> Result<f64, E> { balance(self.at(amplitude)?.gain) };
        let changes = sign_changes(balance, &points, &[])?;
        Ok(changes
            .into_iter()
            .map(|change| DescribedCycle {
                amplitude: change.location,
                error: change.error,
                stable: change.becomes_positive,
            })
            .collect())
    }
}
