//! Floquet exponents of small motions where an input multiplies the friction forces: f_c(t) = f_c (m + α g(ωt + φ_c)), g a cosine
//! or a square wave.
//!
//! All friction is in the kicks, ẋ = A₀x + Σ_c f_c(t) U_c V_cᵀ x, so that A₀ is the same for every friction:
//! [`FollowerDither`] prepares it once and serves a whole row of a map. A point gives the same bits either way.
//! Contacts have no tangent here, so that VᵀU = 0 and the exponents are of fourth order for any number of contacts.
//! Under a square wave friction is constant between the jumps, so that the map is an exact product of exponentials.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt;

use quell_model::profile::Wave;
use quell_model::system::InputTarget;
use quell_model::{System, Waveform};
use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::{
    ConstantFlow, ConstantPiece, Effort, Exponent, Floquet, Phase, of_pieces,
};
use quell_numerics::matrix::Matrix;

use crate::growth::Growth;
use crate::linearised::{LinearContact, Linearised};

/// Jumps closer than this fraction of the period are one.
const SAME_JUMP: f64 = 1e-14;

/// Why the exponents of a system are not those of a dithered follower force.
#[derive(Clone, Debug, PartialEq)]
pub enum NotFollowerDither {
    /// An input does not multiply the friction of a contact, or it is not one sine or square wave of the frequency given.
    Input,
    /// The waveforms of the contacts differ.
    Waveforms,
    /// The friction of a contact is not multiplied.
    Undithered {
        /// Index of the contact.
        contact: usize,
    },
    /// Friction also acts along a tangent of the contact.
    Tangent {
        /// Index of the contact.
        contact: usize,
    },
    /// The matrices could not be decomposed.
    Eigenvalues(EigenError),
}

impl fmt::Display for NotFollowerDither {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input => f.write_str(
                "Floquet exponents require inputs that multiply the friction of contacts by one sine or square wave",
            ),
            Self::Waveforms => {
                f.write_str("Floquet exponents require the same waveform at every contact")
            }
            Self::Undithered { contact } => {
                write!(f, "Floquet exponents require dither at every contact, but contact {contact} has none")
            }
            Self::Tangent { contact } => write!(
                f,
                "Floquet exponents of dithered friction require contacts without tangential motion, but contact {contact} has some"
            ),
            Self::Eigenvalues(why) => why.fmt(f),
        }
    }
}

impl std::error::Error for NotFollowerDither {}

impl From<EigenError> for NotFollowerDither {
    fn from(why: EigenError) -> Self {
        Self::Eigenvalues(why)
    }
}

/// The factor m + α g(ωt + φ) on the friction of one contact.
#[derive(Clone, Debug)]
struct Factor {
    mean: f64,
    wave: Wave,
    sine: f64,
    cosine: f64,
}

/// Small motions under dithered follower forces, prepared for any factor on all friction forces together.
#[derive(Clone, Debug)]
pub struct FollowerDither {
    engine: FollowerWave,
    friction: Vec<f64>,
    factors: Vec<Factor>,
}

#[derive(Clone, Debug)]
enum FollowerWave {
    /// A sine: kicks on a constant flow.
    Smooth(Box<Floquet>),
    /// A square wave: the linear equations, the period, and the jumps in cycles, ascending.
    Square { linear: Box<Linearised>, period: f64, jumps: Vec<f64> },
}

impl FollowerDither {
    /// Prepares a linearised system for a dither of angular `frequency`.
    ///
    /// # Errors
    /// [`NotFollowerDither`] where an input is not one wave of this frequency on the friction of a contact without tangent, and
    /// where parameters are so large that the matrix overflows.
    pub fn new(
        system: &System,
        linear: &Linearised,
        frequency: f64,
    ) -> Result<Self, NotFollowerDither> {
        let factors = factors(system, frequency)?;
        if let Some(contact) =
            linear.contacts().iter().position(|contact: &LinearContact| contact.tangent().is_some())
        {
            return Err(NotFollowerDither::Tangent { contact });
        }
        let friction = linear.contacts().iter().map(|contact| contact.steady.friction).collect();
        let waveform =
            factors.first().map_or(Waveform::Sine, |factor| factor.wave.waveform.clone());
        if factors.iter().any(|factor| factor.wave.waveform != waveform) {
            return Err(NotFollowerDither::Waveforms);
        }
        let period = TAU / frequency;
        let engine = if waveform == Waveform::Square {
            let jumps = jumps(&factors);
            FollowerWave::Square { linear: Box::new(linear.clone()), period, jumps }
        } else {
            let none = vec![0.0; factors.len()];
            let (u, v) = linear.follower_columns();
            let flow = ConstantFlow::new(&linear.state_matrix(&none), &u, &v)?;
            FollowerWave::Smooth(Box::new(Floquet::new(flow, period)))
        };
        Ok(Self { engine, friction, factors })
    }

    /// Largest growth rate with every contact's friction times `factor`.
    ///
    /// # Errors
    /// [`EigenError`] where the monodromy matrix overflows or its eigenvalues do not converge.
    pub fn growth(&self, factor: f64, effort: Effort) -> Result<Growth, EigenError> {
        self.exponent(factor, effort).map(growth_of)
    }

    /// The leading exponent with its effort and multiplier.
    ///
    /// # Errors
    /// As [`FollowerDither::growth`].
    pub fn exponent(&self, factor: f64, effort: Effort) -> Result<Exponent, EigenError> {
        match &self.engine {
            FollowerWave::Smooth(engine) => {
                engine.growth(&|phase, to| self.kick(factor, phase, to), effort)
            }
            FollowerWave::Square { .. } => {
                let found = of_pieces(&self.pieces(factor))?;
                let mut leading = found.first().copied().ok_or(EigenError::NotConverged)?;
                // A slightly smaller exponent with a larger error may be the true leading one.
                for other in found {
                    let beyond = other.growth_rate + other.error - leading.growth_rate;
                    leading.error = leading.error.max(beyond);
                }
                Ok(leading)
            }
        }
    }

    /// Every motion that grows by more than its error, the fastest first.
    ///
    /// # Errors
    /// As [`FollowerDither::growth`].
    pub fn growing(&self, effort: Effort) -> Result<Vec<Growth>, EigenError> {
        let found = match &self.engine {
            FollowerWave::Smooth(engine) => {
                engine.growing(&|phase, to| self.kick(1.0, phase, to), effort)?
            }
            FollowerWave::Square { .. } => {
                let found = of_pieces(&self.pieces(1.0))?.into_iter();
                found.filter(|exponent| exponent.growth_rate > exponent.error).collect()
            }
        };
        Ok(found.into_iter().map(growth_of).collect())
    }

    fn kick(&self, factor: f64, phase: Phase, to: &mut Matrix) {
        for (c, (friction, dither)) in self.friction.iter().zip(&self.factors).enumerate() {
            let wave = phase.cosine * dither.cosine - phase.sine * dither.sine;
            to[(c, c)] = factor * friction * dither.wave.amplitude.mul_add(wave, dither.mean);
        }
    }

    /// The pieces of one period between the jumps of a square wave, with the friction in the middle of each.
    fn pieces(&self, factor: f64) -> Vec<ConstantPiece> {
        let FollowerWave::Square { linear, period, jumps } = &self.engine else {
            return Vec::new();
        };
        let first = jumps.first().copied().unwrap_or(0.0);
        let ends = jumps.iter().skip(1).copied().chain([first + 1.0]);
        jumps
            .iter()
            .zip(ends)
            .map(|(from, to)| {
                let middle = 0.5 * (from + to);
                let acting = |(friction, dither): (&f64, &Factor)| {
                    let cycles = middle + dither.wave.phase / TAU;
                    let wave = dither.wave.waveform.value(TAU * (cycles - cycles.floor()));
                    factor * friction * dither.wave.amplitude.mul_add(wave, dither.mean)
                };
                let friction: Vec<f64> =
                    self.friction.iter().zip(&self.factors).map(acting).collect();
                ConstantPiece {
                    duration: (to - from) * period,
                    matrix: linear.state_matrix(&friction),
                }
            })
            .collect()
    }
}

fn growth_of(found: Exponent) -> Growth {
    Growth { rate: found.growth_rate, error: found.error, frequency: found.frequency }
}

/// The jumps of square waves in one period, in cycles, ascending: those of g are at the phases 0 and π.
fn jumps(factors: &[Factor]) -> Vec<f64> {
    let of_one = |factor: &Factor| {
        [0.0, 0.5].map(|cycles| {
            let at = cycles - factor.wave.phase / TAU;
            at - at.floor()
        })
    };
    let mut jumps: Vec<f64> = factors.iter().flat_map(of_one).collect();
    jumps.sort_by(f64::total_cmp);
    jumps.dedup_by(|next, before| *next - *before <= SAME_JUMP);
    // The last may be the first again, one period later.
    if jumps.len() > 1 && jumps[0] + 1.0 - jumps[jumps.len() - 1] <= SAME_JUMP {
        jumps.pop();
    }
    jumps
}

/// The factor of each contact.
fn factors(system: &System, frequency: f64) -> Result<Vec<Factor>, NotFollowerDither> {
    let mut factors = vec![None; system.contacts.len()];
    for input in &system.inputs {
        let InputTarget::Friction { contact } = input.target else {
            return Err(NotFollowerDither::Input);
        };
        let [wave] = input.profile.waves() else { return Err(NotFollowerDither::Input) };
        let known = matches!(wave.waveform, Waveform::Sine | Waveform::Square);
        if wave.frequency != frequency || !known {
            return Err(NotFollowerDither::Input);
        }
        // A sine that leads by a quarter of a cycle is a cosine.
        let (sine, cosine) = libm::sincos(wave.phase - FRAC_PI_2);
        let mean = input.profile.mean();
        let place = factors.get_mut(contact).ok_or(NotFollowerDither::Input)?;
        *place = Some(Factor { mean, wave: wave.clone(), sine, cosine });
    }
    let numbered = factors.into_iter().enumerate();
    numbered
        .map(|(contact, factor)| factor.ok_or(NotFollowerDither::Undithered { contact }))
        .collect()
}
