//! The kind of each unstable motion: which part of the loads causes it.
//!
//! Iwan and Stahl (*J. Appl. Mech.* 40, 1973, 445) name the instabilities of a disc under a load after their cause: a *stiffness*
//! instability above a critical speed is due to the spring, a *terminal* instability beyond it to the mass; friction adds its own
//! at any speed (Chan, Mottershead and Cartmell 1994), and a damper at rest in the frame of the loads destabilises the waves that
//! run slower than the loads.
//!
//! The criterion is quantitative. Mass, damper, spring and friction of all loads are reduced to zero, one of them at a time
//! with everything else as it is, and the unstable eigenvalue λ is followed. The share of the part is the growth that is lost,
//!
//! ```text
//! S_k = Re λ(1) − Re λ(0) = ∫₀¹ Re (yᵀ A_k x / yᵀ x) dε,       A(ε) with the part k at the strength ε
//! ```
//!
//! A motion that does not grow without friction is a friction instability (S = Re λ(1) or more). Any other is of the kind of the
//! largest positive share: without that part it grows least. Friction comes first because mass and spring also detune the waves that
//! friction couples, so that their share can exceed that of friction although the disc without friction is stable. The integrand at ε = 1 alone is the
//! share by left and right eigenvectors (y, x); it would be misleading, for a spring that is stiffer than the worst one reduces
//! the growth that it causes. Shares do not add up to the growth where parts interact, as spring and friction do in mode coupling.
//!
//! The eigenvalue is followed by prediction along its last step, with smaller steps where two are close. Where two eigenvalues
//! meet, at the onset of flutter, either of them leads to the same real part.

use num_complex::Complex64;
use quell_linear::growth::Growth;
use quell_model::Disc;
use quell_model::disc::{Contributions, Load};
use quell_numerics::eigen::{EigenError, eigenvalues};
use quell_numerics::polar::modulus;

use crate::equations::linearised;

/// The first step of the strength.
const FIRST_STEP: f64 = 1.0 / 16.0;

/// The smallest step: two eigenvalues that are closer than their motion in it are about to meet.
const SMALLEST_STEP: f64 = 1.0 / 256.0;

/// A step is accepted if the nearest eigenvalue is this much nearer to the prediction than the next one.
const CERTAIN: f64 = 0.25;

/// The cause of an instability.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum InstabilityKind {
    /// The mass of the loads.
    Terminal,
    /// Their dampers.
    Damping,
    /// Their springs.
    Stiffness,
    /// Their friction.
    Friction,
}

impl InstabilityKind {
    /// Every kind, in the order of [`GrowthShares::shares`].
    pub const ALL: [Self; 4] = [Self::Terminal, Self::Damping, Self::Stiffness, Self::Friction];

    /// Word in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Terminal => "terminal",
            Self::Damping => "damping",
            Self::Stiffness => "stiffness",
            Self::Friction => "friction",
        }
    }

    /// The part of a load that causes it.
    pub fn part(self) -> &'static str {
        match self {
            Self::Terminal => "mass",
            Self::Damping => "damper",
            Self::Stiffness => "spring",
            Self::Friction => "friction",
        }
    }

    /// A load whose part has this fraction of its strength.
    fn weakened(self, mut load: Load, strength: f64) -> Load {
        let part = match self {
            Self::Terminal => &mut load.mass,
            Self::Damping => &mut load.damping,
            Self::Stiffness => &mut load.stiffness,
            // A friction law has no strength of its own: the force is reduced where the equations are assembled.
            Self::Friction => return load,
        };
        *part *= strength;
        load
    }
}

/// Shares of the parts of the loads in the growth of one motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowthShares {
    /// Share of mass, damper, spring and friction, in the order of [`InstabilityKind::ALL`]: positive where the part adds to the
    /// growth.
    pub shares: [f64; 4],
    /// The growth rate itself.
    pub rate: f64,
}

impl GrowthShares {
    /// The kind: friction if nothing grows without it, else that of the largest share; `None` where no part of the loads adds to
    /// the growth.
    pub fn kind(&self) -> Option<InstabilityKind> {
        let [.., friction] = self.shares;
        if friction > 0.0 && friction >= self.rate {
            return Some(InstabilityKind::Friction);
        }
        let pairs = InstabilityKind::ALL.into_iter().zip(self.shares);
        let largest = pairs.max_by(|a, b| a.1.total_cmp(&b.1));
        largest.filter(|(_, share)| *share > 0.0).map(|(kind, _)| kind)
    }
}

/// The origin of each motion of a disc without dither, some contributions switched off.
///
/// # Errors
/// [`EigenError`] where parameters are so large that the matrix overflows.
pub fn origins(
    disc: &Disc,
    parts: Contributions,
    motions: &[Growth],
) -> Result<Vec<GrowthShares>, EigenError> {
    motions.iter().map(|motion| origin(disc, parts, motion)).collect()
}

fn origin(disc: &Disc, parts: Contributions, motion: &Growth) -> Result<GrowthShares, EigenError> {
    let start = Complex64::new(motion.rate, motion.frequency);
    let mut shares = [0.0; 4];
    for (share, kind) in shares.iter_mut().zip(InstabilityKind::ALL) {
        let absent = |load: &Load| match kind {
            InstabilityKind::Friction => load.friction == 0.0 && disc.law().is_none(),
            kind => kind.weakened(load.clone(), 0.0) == *load,
        };
        if !disc.loads().iter().all(absent) {
            *share = start.re - without(disc, parts, kind, start)?.re;
        }
    }
    Ok(GrowthShares { shares, rate: start.re })
}

/// The eigenvalue that λ becomes as a part of the loads vanishes.
fn without(
    disc: &Disc,
    parts: Contributions,
    kind: InstabilityKind,
    start: Complex64,
) -> Result<Complex64, EigenError> {
    let (mut strength, mut value) = (1.0, start);
    let mut slope = Complex64::new(0.0, 0.0);
    let mut step = FIRST_STEP;
    while strength > 0.0 {
        let next = f64::max(strength - step, 0.0);
        let guess = value + slope * (strength - next);
        let (nearest, distance, other) = nearest(disc, parts, kind, next, guess)?;
        if distance > CERTAIN * other && step > SMALLEST_STEP {
            step *= 0.5;
            continue;
        }
        slope = (nearest - value) / (strength - next);
        (strength, value) = (next, nearest);
        step = f64::min(2.0 * step, FIRST_STEP);
    }
    Ok(value)
}

/// The eigenvalue nearest to a guess, its distance, and that of the next.
fn nearest(
    disc: &Disc,
    parts: Contributions,
    kind: InstabilityKind,
    strength: f64,
    guess: Complex64,
) -> Result<(Complex64, f64, f64), EigenError> {
    let weaker = disc
        .with_each_load(|load| kind.weakened(load.clone(), strength))
        .map_err(|_| EigenError::NotFinite)?;
    let system = linearised(&weaker.undithered(), parts)?;
    let mut friction = system.mean_friction();
    if kind == InstabilityKind::Friction {
        for force in &mut friction {
            *force *= strength;
        }
    }
    let values = eigenvalues(&system.state_matrix(&friction))?;
    let mut best = (guess, f64::INFINITY, f64::INFINITY);
    for value in values {
        let distance = modulus(value - guess);
        if distance < best.1 {
            best = (value, distance, best.1);
        } else {
            best.2 = best.2.min(distance);
        }
    }
    Ok(best)
}
