//! Floquet exponents of small motions where an input multiplies the friction forces: f_c(t) = f_c (m + α cos(ωt + φ_c)).
//!
//! All friction is in the kicks, ẋ = A₀x + Σ_c f_c(t) U_c V_cᵀ x, so that A₀ is the same for every friction:
//! [`FollowerDither`] prepares it once and serves a whole row of a map. A point gives the same bits either way.
//! Contacts have no tangent here, so that VᵀU = 0 and the exponents are of fourth order for any number of contacts.

use std::f64::consts::{FRAC_PI_2, TAU};

use quell_model::system::InputTarget;
use quell_model::{System, Waveform};
use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::{ConstantFlow, Effort, Exponent, Floquet, Phase};
use quell_numerics::matrix::Matrix;

use crate::growth::Growth;
use crate::linearised::{LinearContact, Linearised};

/// The factor m + α cos(ωt + φ) on the friction of one contact.
#[derive(Clone, Copy, Debug)]
struct Factor {
    mean: f64,
    amplitude: f64,
    sine: f64,
    cosine: f64,
}

/// Small motions under dithered follower forces, prepared for any factor on all friction forces together.
#[derive(Clone, Debug)]
pub struct FollowerDither {
    engine: Floquet,
    friction: Vec<f64>,
    factors: Vec<Factor>,
}

impl FollowerDither {
    /// Prepares a linearised system for a dither of angular `frequency`; `None` where an input is not one sine of this
    /// frequency on the friction of a contact without tangent.
    ///
    /// # Errors
    /// [`EigenError`] where parameters are so large that the matrix overflows.
    pub fn new(
        system: &System,
        linear: &Linearised,
        frequency: f64,
    ) -> Result<Option<Self>, EigenError> {
        let Some(factors) = factors(system, frequency) else { return Ok(None) };
        if linear.contacts().iter().any(|contact: &LinearContact| contact.tangent().is_some()) {
            return Ok(None);
        }
        let none = vec![0.0; factors.len()];
        let (u, v) = linear.follower_columns();
        let flow = ConstantFlow::new(&linear.state_matrix(&none), &u, &v)?;
        Ok(Some(Self {
            engine: Floquet::new(flow, TAU / frequency),
            friction: linear.contacts().iter().map(|contact| contact.steady.friction).collect(),
            factors,
        }))
    }

    /// Largest growth rate with every contact's friction times `factor`.
    ///
    /// # Errors
    /// [`EigenError`] where the monodromy matrix overflows or its eigenvalues do not converge.
    pub fn growth(&self, factor: f64, effort: Effort) -> Result<Growth, EigenError> {
        let Exponent { growth_rate, error, frequency, .. } = self.exponent(factor, effort)?;
        Ok(Growth { rate: growth_rate, error, frequency })
    }

    /// The leading exponent with its effort and multiplier.
    ///
    /// # Errors
    /// As [`FollowerDither::growth`].
    pub fn exponent(&self, factor: f64, effort: Effort) -> Result<Exponent, EigenError> {
        self.engine.growth(&|phase, to| self.kick(factor, phase, to), effort)
    }

    /// Every motion that grows by more than its error, the fastest first.
    ///
    /// # Errors
    /// As [`FollowerDither::growth`].
    pub fn growing(&self, effort: Effort) -> Result<Vec<Growth>, EigenError> {
        let found = self.engine.growing(&|phase, to| self.kick(1.0, phase, to), effort)?;
        let growth = |found: Exponent| Growth {
            rate: found.growth_rate,
            error: found.error,
            frequency: found.frequency,
        };
        Ok(found.into_iter().map(growth).collect())
    }

    fn kick(&self, factor: f64, phase: Phase, to: &mut Matrix) {
        for (c, (friction, dither)) in self.friction.iter().zip(&self.factors).enumerate() {
            let wave = phase.cosine * dither.cosine - phase.sine * dither.sine;
            to[(c, c)] = factor * friction * dither.amplitude.mul_add(wave, dither.mean);
        }
    }
}

/// The factor of each contact.
fn factors(system: &System, frequency: f64) -> Option<Vec<Factor>> {
    let mut factors = vec![None; system.contacts.len()];
    for input in &system.inputs {
        let InputTarget::Friction { contact } = input.target else { return None };
        let [wave] = input.profile.waves() else { return None };
        if wave.frequency != frequency || wave.waveform != Waveform::Sine {
            return None;
        }
        // A sine that leads by a quarter of a cycle is a cosine.
        let (sine, cosine) = libm::sincos(wave.phase - FRAC_PI_2);
        let (mean, amplitude) = (input.profile.mean(), wave.amplitude);
        factors[contact] = Some(Factor { mean, amplitude, sine, cosine });
    }
    factors.into_iter().collect()
}
