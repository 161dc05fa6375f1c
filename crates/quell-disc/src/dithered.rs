//! Stability with dither: Floquet exponents (sections 5.4 and 5.5), f(τ) = f(1 + α cos Rτ) or f α cos Rτ.
//!
//! All friction is in the kicks, x′ = A₀x + Σ_l f_l(τ) U_l V_lᵀ x, so that A₀ is the same for every friction at one speed:
//! [`DitheredDisc`] prepares it once and serves a whole row of a map. A point gives the same bits either way.
//! VᵀU = 0, so exponents are of fourth order for any loads.

use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::{ConstantFlow, Effort, Exponent, Floquet, Phase};
use quell_numerics::matrix::Matrix;

use crate::disc::Disc;
use crate::growth::Growth;
use crate::system::{Contributions, System};
use crate::undithered;

/// A disc whose friction is dithered, prepared for any factor on the friction of its loads.
#[derive(Clone, Debug)]
pub struct DitheredDisc {
    engine: Floquet,
    friction: Vec<f64>,
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
        let phi = |phase: Phase, to: &mut Matrix| {
            let (mean, amplitude) = self.modulation;
            let modulation = amplitude.mul_add(phase.cosine, mean);
            for (l, friction) in self.friction.iter().enumerate() {
                to[(l, l)] = factor * friction * modulation;
            }
        };
        self.engine.growth(&phi, effort)
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
