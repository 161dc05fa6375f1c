//! Floquet exponents of small motions where an input multiplies the friction forces: f_c(t) = f_c (m + α g(ωt + φ_c)), g any
//! waveform, the same at every contact.
//!
//! All friction is in the kicks, ẋ = A₀x + Σ_c f_c(t) U_c V_cᵀ x, so that A₀ is the same for every friction:
//! [`FollowerDither`] prepares it once and serves a whole row of a map. A point gives the same bits either way.
//! Contacts have no tangent here, so that VᵀU = 0 and the exponents are of fourth order for any number of contacts.
//!
//! | waveform | map of a period |
//! |---|---|
//! | sine | splitting with kicks, extrapolated ([`Floquet`]) |
//! | constant between jumps: square, held samples, their bursts | exact product of exponentials ([`of_pieces`]) |
//! | any other | Taylor series of the map between kinks and jumps ([`VaryingFlow`]) |
//!
//! The period of a burst is that of its carrier times its cycles. Kinks and jumps of every contact, each at its own phase, are
//! ends of pieces, so that no step passes one.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt;

use quell_model::profile::Wave;
use quell_model::system::InputTarget;
use quell_model::waveform::Piece;
use quell_model::{System, Waveform};
use quell_numerics::eigen::EigenError;
use quell_numerics::floquet::{
    ConstantFlow, ConstantPiece, Effort, Exponent, Floquet, Phase, Sinusoid, Strength, VaryingFlow,
    VaryingPiece, of_pieces,
};
use quell_numerics::matrix::Matrix;
use quell_numerics::order::ascending;

use crate::growth::Growth;
use crate::linearised::{LinearContact, Linearised};

/// Breaks closer than this fraction of the period are one.
const SAME_BREAK: f64 = 1e-14;

/// Why the exponents of a system are not those of a dithered follower force.
#[derive(Clone, Debug, PartialEq)]
pub enum NotFollowerDither {
    /// An input does not multiply the friction of a contact, or it is not one wave of the frequency given and of constant
    /// amplitude.
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
                "Floquet exponents require inputs that multiply the friction of contacts by one wave",
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
    /// Constant between jumps: the linear equations, and where the pieces begin.
    Constant { linear: Box<Linearised>, pieces: Pieces },
    /// Analytic between breaks.
    Varying { flow: Box<VaryingFlow>, pieces: Pieces },
}

/// The pieces of a period.
#[derive(Clone, Debug)]
struct Pieces {
    period: f64,
    /// Where they begin, as fractions of the period, ascending; at least one.
    begin: Vec<f64>,
}

impl Pieces {
    /// Begin and end of each piece, as fractions of the period.
    fn ends(&self) -> impl Iterator<Item = (f64, f64)> {
        let first = self.begin.first().copied().unwrap_or(0.0);
        let ends = self.begin.iter().skip(1).copied().chain([first + 1.0]);
        self.begin.iter().copied().zip(ends)
    }
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
        let period = TAU / frequency * f64::from(waveform.cycles());
        let none = vec![0.0; factors.len()];
        let engine = if waveform == Waveform::Sine {
            let (u, v) = linear.follower_columns();
            let flow = ConstantFlow::new(&linear.state_matrix(&none), &u, &v)?;
            FollowerWave::Smooth(Box::new(Floquet::new(flow, period)))
        } else {
            let pieces = Pieces { period, begin: breaks(&factors) };
            if waveform.is_piecewise_constant() {
                FollowerWave::Constant { linear: Box::new(linear.clone()), pieces }
            } else {
                let (u, v) = linear.follower_columns();
                let flow = VaryingFlow::new(linear.state_matrix(&none), u, &v);
                FollowerWave::Varying { flow: Box::new(flow), pieces }
            }
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
            FollowerWave::Constant { .. } | FollowerWave::Varying { .. } => {
                let found = self.of_period(factor)?;
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
            FollowerWave::Constant { .. } | FollowerWave::Varying { .. } => {
                let found = self.of_period(1.0)?.into_iter();
                found.filter(|exponent| exponent.growth_rate > exponent.error).collect()
            }
        };
        Ok(found.into_iter().map(growth_of).collect())
    }

    /// All exponents with every contact's friction times `factor`, one of each conjugate pair, the fastest first.
    ///
    /// # Errors
    /// As [`FollowerDither::growth`].
    pub fn exponents(&self, factor: f64, effort: Effort) -> Result<Vec<Exponent>, EigenError> {
        match &self.engine {
            FollowerWave::Smooth(engine) => {
                engine.exponents(&|phase, to| self.kick(factor, phase, to), effort)
            }
            FollowerWave::Constant { .. } | FollowerWave::Varying { .. } => self.of_period(factor),
        }
    }

    /// The period after which the dither repeats itself.
    pub fn period(&self) -> f64 {
        match &self.engine {
            FollowerWave::Smooth(engine) => engine.period(),
            FollowerWave::Constant { pieces, .. } | FollowerWave::Varying { pieces, .. } => {
                pieces.period
            }
        }
    }

    fn kick(&self, factor: f64, phase: Phase, to: &mut Matrix) {
        for (c, (friction, dither)) in self.friction.iter().zip(&self.factors).enumerate() {
            let wave = phase.cosine * dither.cosine - phase.sine * dither.sine;
            to[(c, c)] = factor * friction * dither.wave.amplitude.mul_add(wave, dither.mean);
        }
    }

    /// All exponents of the map of a period made of pieces.
    fn of_period(&self, factor: f64) -> Result<Vec<Exponent>, EigenError> {
        match &self.engine {
            FollowerWave::Smooth(_) => Err(EigenError::NotConverged),
            FollowerWave::Constant { linear, pieces } => {
                let piece = |(from, to): (f64, f64)| {
                    let acting = |(friction, dither): (&f64, &Factor)| {
                        let wave = dither.wave.waveform.value(dither.phase_at(0.5 * (from + to)));
                        factor * friction * dither.wave.amplitude.mul_add(wave, dither.mean)
                    };
                    let friction: Vec<f64> =
                        self.friction.iter().zip(&self.factors).map(acting).collect();
                    let matrix = linear.state_matrix(&friction);
                    ConstantPiece { duration: (to - from) * pieces.period, matrix }
                };
                of_pieces(&pieces.ends().map(piece).collect::<Vec<_>>())
            }
            FollowerWave::Varying { flow, pieces } => {
                let piece = |(from, to): (f64, f64)| {
                    let duration = (to - from) * pieces.period;
                    let contacts = self.friction.iter().zip(&self.factors);
                    let strength = |(friction, dither): (&f64, &Factor)| {
                        dither.strength(factor * friction, (from, to), duration)
                    };
                    VaryingPiece { duration, strengths: contacts.map(strength).collect() }
                };
                flow.exponents(&pieces.ends().map(piece).collect::<Vec<_>>())
            }
        }
    }
}

impl Factor {
    /// The phase of the wave at a fraction of the period, within one period.
    fn phase_at(&self, fraction: f64) -> f64 {
        let cycles = f64::from(self.wave.waveform.cycles());
        let turns = fraction + self.wave.phase / TAU / cycles;
        TAU * cycles * (turns - turns.floor())
    }

    /// `friction` times the factor over a piece between two breaks, given as fractions of the period.
    fn strength(&self, friction: f64, (from, to): (f64, f64), duration: f64) -> Strength {
        let Wave { waveform, amplitude, frequency, .. } = &self.wave;
        let (start, middle) = (self.phase_at(from), self.phase_at(0.5 * (from + to)));
        let sinusoid = |order: f64, size: f64, phase: f64| Sinusoid {
            amplitude: friction * amplitude * size,
            frequency: order * frequency,
            phase: order.mul_add(start, phase),
        };
        let (line, sinusoids) = match (waveform.harmonics(), waveform.piece_after(middle)) {
            (Some(harmonics), _) => {
                let sines = harmonics.iter().map(|harmonic| {
                    let order = f64::from(harmonic.order);
                    sinusoid(order, harmonic.amplitude(), harmonic.phase())
                });
                ((0.0, 0.0), sines.collect())
            }
            (None, Some(Piece::Affine { slope, .. })) => {
                let rate = slope * frequency;
                ((waveform.value(middle) - 0.5 * duration * rate, rate), Vec::new())
            }
            (None, _) => ((0.0, 0.0), vec![sinusoid(1.0, 1.0, 0.0)]),
        };
        Strength {
            value: friction * amplitude.mul_add(line.0, self.mean),
            slope: friction * amplitude * line.1,
            sinusoids,
        }
    }
}

fn growth_of(found: Exponent) -> Growth {
    Growth { rate: found.growth_rate, error: found.error, frequency: found.frequency }
}

/// The breaks of all contacts in one period, as fractions of it, ascending, or the start of the period if no contact has a break.
fn breaks(factors: &[Factor]) -> Vec<f64> {
    let of_one = |factor: &Factor| {
        let cycles = f64::from(factor.wave.waveform.cycles());
        let lead = factor.wave.phase / TAU / cycles;
        let breaks = factor.wave.waveform.breaks().to_vec().into_iter();
        breaks.map(move |phase| {
            let at = phase / TAU / cycles - lead;
            at - at.floor()
        })
    };
    let mut breaks: Vec<f64> = factors.iter().flat_map(of_one).collect();
    ascending(&mut breaks);
    breaks.dedup_by(|next, before| *next - *before <= SAME_BREAK);
    // The last may be the first again, one period later.
    if breaks.len() > 1 && breaks[0] + 1.0 - breaks[breaks.len() - 1] <= SAME_BREAK {
        breaks.pop();
    }
    if breaks.is_empty() { vec![0.0] } else { breaks }
}

/// The factor of each contact.
fn factors(system: &System, frequency: f64) -> Result<Vec<Factor>, NotFollowerDither> {
    let mut factors = vec![None; system.contacts.len()];
    for input in &system.inputs {
        let InputTarget::Friction { contact } = input.target else {
            return Err(NotFollowerDither::Input);
        };
        let [wave] = input.profile.waves() else { return Err(NotFollowerDither::Input) };
        if wave.frequency != frequency || !input.profile.is_steady() {
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
