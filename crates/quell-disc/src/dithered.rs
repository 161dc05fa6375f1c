//! Stability with dither: Floquet exponents (sections 5.4 and 5.5), f(τ) = f(1 + α cos Rτ) or f α cos Rτ. Each load may have
//! a phase of its own, cos(Rτ + φ_l), which the dissertation does not have: under one load it only shifts the time.
//!
//! All friction is in the kicks, x′ = A₀x + Σ_l f_l(τ) U_l V_lᵀ x, so that A₀ is the same for every friction at one speed:
//! [`DitheredDisc`] prepares it once and serves a whole row of a map. A point gives the same bits either way.
//! VᵀU = 0, so exponents are of fourth order for any loads.

use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::{ConstantFlow, Effort, Exponent, Floquet, Phase};
use quell_numerics::matrix::Matrix;

use crate::equations::System;
use crate::undithered;
use quell_linear::growth::Growth;
use quell_model::Disc;
use quell_model::disc::Contributions;

/// A disc whose friction is dithered, prepared for any factor on the friction of its loads.
#[derive(Clone, Debug)]
pub struct DitheredDisc {
    engine: Floquet,
    friction: Vec<f64>,
    /// Sine and cosine of the phase of each load's dither.
    phases: Vec<(f64, f64)>,
    modulation: (f64, f64),
}

impl DitheredDisc {
    /// Prepares a disc; `None` without dither.
    ///
    /// # Errors
    /// [`EigenError`] where parameters are so large that the matrix overflows.
    pub fn new(disc: &Disc) -> Result<Option<Self>, EigenError> {
        Self::with_contributions(disc, Contributions::ALL)
    }

    /// The same with some contributions switched off.
    ///
    /// # Errors
    /// As [`DitheredDisc::new`].
    pub fn with_contributions(
        disc: &Disc,
        parts: Contributions,
    ) -> Result<Option<Self>, EigenError> {
        let system = System::assemble(disc, parts);
        let Some(ratio) = system.frequency_ratio() else { return Ok(None) };
        let none = vec![0.0; disc.loads().len()];
        let (u, v) = system.kick();
        let flow = ConstantFlow::new(&system.state_matrix(&none), &u, &v)?;
        Ok(Some(Self {
            engine: Floquet::new(flow, core::f64::consts::TAU / ratio),
            friction: system.friction().to_vec(),
            phases: disc.loads().iter().map(|load| libm::sincos(load.dither_phase)).collect(),
            modulation: system.modulation(),
        }))
    }

    /// Largest growth rate with every load's friction times `factor`.
    ///
    /// # Errors
    /// As [`DitheredDisc::new`].
    pub fn growth(&self, factor: f64, effort: Effort) -> Result<Growth, EigenError> {
        let Exponent { growth_rate, error, frequency, .. } = self.exponent(factor, effort)?;
        Ok(Growth { rate: growth_rate, error, frequency })
    }

    /// As [`DitheredDisc::growth`], with the number of steps it took.
    ///
    /// # Errors
    /// As [`DitheredDisc::new`].
    pub fn exponent(&self, factor: f64, effort: Effort) -> Result<Exponent, EigenError> {
        self.engine.growth(&|phase, to| self.kick(factor, phase, to), effort)
    }

    /// Every motion that grows by more than its error with the friction as it is, the fastest first.
    ///
    /// # Errors
    /// As [`DitheredDisc::new`].
    pub fn growing(&self, effort: Effort) -> Result<Vec<Growth>, EigenError> {
        let found = self.engine.growing(&|phase, to| self.kick(1.0, phase, to), effort)?;
        let growth = |found: Exponent| Growth {
            rate: found.growth_rate,
            error: found.error,
            frequency: found.frequency,
        };
        Ok(found.into_iter().map(growth).collect())
    }

    /// Friction of every load at a phase of the period.
    fn kick(&self, factor: f64, phase: Phase, to: &mut Matrix) {
        let (mean, amplitude) = self.modulation;
        for (l, (friction, (sine, cosine))) in self.friction.iter().zip(&self.phases).enumerate() {
            // cos(Rτ + φ); without a phase the cosine itself, to the last bit.
            let wave = phase.cosine * cosine - phase.sine * sine;
            to[(l, l)] = factor * friction * amplitude.mul_add(wave, mean);
        }
    }
}

/// Largest growth rate of a disc, dithered or not.
///
/// # Errors
/// [`EigenError`] where parameters are so large that the matrix overflows.
pub fn growth(disc: &Disc, effort: Effort) -> Result<Growth, EigenError> {
    match DitheredDisc::new(disc)? {
        Some(dithered) => dithered.growth(1.0, effort),
        None => undithered::growth(disc),
    }
}
