//! Stability boundaries under dither by D-partition: frictions at which a Floquet exponent is imaginary, without a grid in f.
//!
//! Under one load, a motion e^{ρτ} Σ y_h e^{ihRτ} has the slope θ_h = T(ρ + ihR) [f(τ) θ]_h at the load, where T is the
//! receptance from follower force to slope of the disc with mass, damper and spring attached. With H₁ = uᵀG u and H₂ = sᵀG u from
//! the G(λ) of the free disc,
//!
//! ```text
//! T = H₂/(1 + Z H₁),  Z = mλ² + cλ + k,     θ/f = 𝒯 F θ,  F = mean on the diagonal, α/2 off the diagonal
//! ```
//!
//! At ρ = iω, every positive real eigenvalue of the tridiagonal 𝒯F over the harmonics is therefore a 1/f for which iω is an
//! exponent: a scalar Hill determinant det(1 − f𝒯F), for any number of modes. ω covers [0, R/2]; where an eigenvalue crosses the
//! real axis the crossing is bracketed and refined. H places the highest harmonic above twice the fastest wave. There T decreases
//! like λ⁻³, and the truncation error is a product of such factors.
//!
//! Every crossing is listed, including those at which an already unstable disc gains one more unstable pair. At ξ = 0 and on the
//! lines of table 5.1 an exponent is imaginary for every f; the load cannot excite that one, and it does not appear. At ω = 0 and
//! ω = R/2 eigenvalues are real or in pairs by symmetry, and real ones count as boundaries (divergence, and doubling of the
//! dither period). The eigenvalues are computed by QL on the tridiagonal matrix at every point, which finds all of them. A
//! crossing is refined by a secant in ω along its own eigenvalue, tracked by Newton's method, with bisection as a fallback.
//! Limitations: two crossings within one step of ω are missed (`POINTS_PER_WAVE`; `marginal` finds them). Near poles of T, at ξ = 0 close to a
//! coincidence, they can be that close.

use std::fmt;

use num_complex::Complex64;
use quell_numerics::eigen::Tridiagonal;
use quell_numerics::order::ascending_by;

use quell_model::{Disc, Waveform};

use crate::boundaries::NOT_PLAIN;

/// Largest H. Time grows with its square; with this one, ten modes took 17 s on a 2.1 GHz Xeon. A smaller limit would reject slow
/// dithers that can be computed in acceptable time.
pub const MOST_HARMONICS: usize = 200;

/// Points in [0, R/2] for each free wave.
const POINTS_PER_WAVE: usize = 40;

/// Most iterations per crossing: by bisection alone the interval would shrink below the last digit of ω.
const ITERATIONS: usize = 60;

/// A crossing has converged when the imaginary part of the eigenvalue is below this fraction of the eigenvalue.
const REAL: f64 = 1e-15;

/// A resonant wave is detuned by this fraction of its stiffness: far below the resolution of a map, far above rounding.
const POLE_OFFSET: f64 = 1e-14;

/// A friction at which an exponent is imaginary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionCrossing {
    /// Factor on the friction of the load.
    pub factor: f64,
    /// Frequency ω of the exponent, 0 ≤ ω ≤ R/2.
    pub frequency: f64,
}

/// Why no partition exists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPartition {
    /// The number of loads is not one.
    Loads(usize),
    /// The load is distributed, its pad moves, or a law gives its friction.
    NotPlain,
    /// The dither is not a sine.
    Waveform,
    /// There is no dither.
    Undithered,
    /// The dither is so slow compared to the waves that more than [`MOST_HARMONICS`] harmonics would be needed.
    TooManyHarmonics {
        /// The number of harmonics needed.
        harmonics: usize,
    },
    /// The eigenvalues could not be computed at any ω.
    Eigenvalues,
}

impl fmt::Display for NoPartition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Loads(count) => {
                write!(f, "a D-partition exists for one load only, but the disc has {count}")
            }
            Self::NotPlain => f.write_str(NOT_PLAIN),
            Self::Waveform => f.write_str("a D-partition exists for sinusoidal dither only"),
            Self::Undithered => f.write_str("there is no dither"),
            Self::TooManyHarmonics { harmonics } => write!(
                f,
                "the dither is too slow compared to the waves: a D-partition would need {harmonics} harmonics, more than \
                 {MOST_HARMONICS}"
            ),
            Self::Eigenvalues => f.write_str(
                "the eigenvalues could not be computed at any frequency: the numbers are too large",
            ),
        }
    }
}

impl std::error::Error for NoPartition {}

/// The tridiagonal operator 𝒯F of a disc.
struct Operator<'a> {
    disc: &'a Disc,
    mean: f64,
    half_amplitude: f64,
    ratio: f64,
    harmonics: usize,
}

impl Operator<'_> {
    /// f T(iw), where f is the friction of the load.
    fn receptance(&self, w: f64) -> Complex64 {
        let speed = self.disc.speed();
        let load = &self.disc.loads()[0];
        let lambda = Complex64::new(0.0, w);
        let (mut h1, mut h2) = (Complex64::new(0.0, 0.0), Complex64::new(0.0, 0.0));
        for (index, mode) in self.disc.modes().iter().enumerate() {
            let q = mode.diameters as f64;
            let square = self.disc.shape(index, 0) * self.disc.shape(index, 0);
            let loss = 2.0 * mode.damping * mode.ratio;
            let ratio = self.disc.ratio_at_speed(index);
            // The wave e^{ilφ}: its oscillator is fixed to the disc, where λ is λ − ilΩ.
            let wave = |l: f64| {
                let shifted = lambda - Complex64::new(0.0, l * speed);
                let stiffness = shifted * shifted + shifted * loss + ratio * ratio;
                // At a pole H₁ and H₂ are infinite but their quotient is not: evaluate close to the pole.
                let offset = Complex64::new(POLE_OFFSET * mode.ratio * mode.ratio, 0.0);
                if stiffness.norm_sqr() > 0.0 { stiffness.inv() } else { offset.inv() }
            };
            if mode.diameters == 0 {
                h1 += wave(0.0) * square;
            } else {
                let (ahead, back) = (wave(q), wave(-q));
                h1 += (ahead + back) * (0.5 * square);
                h2 += (ahead - back) * Complex64::new(0.0, 0.5 * q * square);
            }
        }
        let z = lambda * lambda * load.mass + lambda * load.damping + load.stiffness;
        h2 / (z * h1 + 1.0) * load.friction
    }

    /// 𝒯F at ρ = iω, whose eigenvalues are 1/factor. The harmonics are −H…H at ω = 0 and −H−1…H elsewhere: at either end of the
    /// range the set is symmetric, so that eigenvalues that are real by symmetry are real to the last digits.
    fn matrix(&self, omega: f64) -> Tridiagonal {
        let below = if omega == 0.0 { self.harmonics } else { self.harmonics + 1 };
        let receptances: Vec<Complex64> = (0..=self.harmonics + below)
            .map(|row| self.receptance((row as f64 - below as f64).mul_add(self.ratio, omega)))
            .collect();
        let square = self.half_amplitude * self.half_amplitude;
        Tridiagonal {
            diagonal: receptances.iter().map(|receptance| receptance * self.mean).collect(),
            across: receptances.windows(2).map(|pair| pair[0] * pair[1] * square).collect(),
        }
    }

    /// Eigenvalues 1/factor at ρ = iω; `None` where they cannot be computed, as at a pole. No crossing is detected there.
    fn inverse_factors(&self, omega: f64) -> Option<Vec<Complex64>> {
        self.matrix(omega).eigenvalues().ok()
    }

    /// The eigenvalue at ρ = iω within `gap` of `guess`: by Newton's method, or else the nearest of all eigenvalues.
    fn followed(&self, omega: f64, guess: Complex64, gap: f64) -> Option<Complex64> {
        let matrix = self.matrix(omega);
        matrix
            .refine(guess, gap)
            .or_else(|| nearest(&matrix.eigenvalues().unwrap_or_default(), guess))
    }

    /// Refines the crossing of one eigenvalue through the real axis; `None` where the eigenvalue jumps (two
    /// were mistaken for one, or a pole is in between).
    fn refine_crossing(
        &self,
        mut low: f64,
        mut value: Complex64,
        mut high: f64,
        mut beyond: Complex64,
    ) -> Option<FrictionCrossing> {
        for iteration in 0..ITERATIONS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            // Every third iteration bisects, because a secant may converge slowly.
            let share = if iteration % 3 == 2 { 0.5 } else { value.im / (value.im - beyond.im) };
            let secant = share.mul_add(high - low, low);
            let omega = if secant > low && secant < high { secant } else { middle };
            let gap = (value - beyond).norm_sqr().sqrt();
            let guess = value + (beyond - value) * ((omega - low) / (high - low));
            let next = self.followed(omega, guess, gap)?;
            if (value.im < 0.0) == (next.im < 0.0) {
                (low, value) = (omega, next);
            } else {
                (high, beyond) = (omega, next);
            }
            if next.im.abs() <= REAL * next.re && gap <= 1e-3 * next.re {
                return Some(FrictionCrossing { factor: next.re.recip(), frequency: omega });
            }
        }
        let jump = (value - beyond).norm_sqr().sqrt();
        let crossed = value.re > 0.0 && jump <= 1e-8 * value.re;
        crossed.then(|| FrictionCrossing { factor: value.re.recip(), frequency: low })
    }
}

/// The eigenvalue nearest to a given number.
fn nearest(values: &[Complex64], to: Complex64) -> Option<Complex64> {
    values.iter().copied().min_by(|a, b| (a - to).norm_sqr().total_cmp(&(b - to).norm_sqr()))
}

/// Adds the crossings of eigenvalues that are real by symmetry, at the ends of the range of ω.
fn push_real(values: &[Complex64], frequency: f64, found: &mut Vec<FrictionCrossing>) {
    let largest = values.iter().map(|value| value.norm_sqr().sqrt()).fold(0.0, f64::max);
    for value in values {
        // Tiny eigenvalues are unbounded frictions, and their sign is rounding noise.
        if value.re > 1e-9 * largest && value.im.abs() <= 1e-10 * value.re {
            found.push(FrictionCrossing { factor: value.re.recip(), frequency });
        }
    }
}

/// Every positive factor on the friction of the load at which an exponent is imaginary, in ascending order.
///
/// # Errors
/// [`NoPartition`] for a number of loads other than one, without dither, for dither that is too slow, and where the eigenvalues
/// cannot be computed at any frequency.
pub fn crossings(disc: &Disc) -> Result<Vec<FrictionCrossing>, NoPartition> {
    if disc.loads().len() != 1 {
        return Err(NoPartition::Loads(disc.loads().len()));
    }
    if !disc.is_plain() {
        return Err(NoPartition::NotPlain);
    }
    let Some(ratio) = disc.dither().frequency_ratio() else { return Err(NoPartition::Undithered) };
    if *disc.waveform() != Waveform::Sine {
        return Err(NoPartition::Waveform);
    }
    let (mean, amplitude) = disc.dither().mean_and_amplitude();
    let fastest = disc
        .modes()
        .iter()
        .enumerate()
        .map(|(index, mode)| {
            (mode.diameters as f64).mul_add(disc.speed().abs(), disc.ratio_at_speed(index))
        })
        .fold(0.0, f64::max);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let harmonics = ((2.0 * fastest / ratio).ceil() as usize).saturating_add(6);
    if harmonics > MOST_HARMONICS {
        return Err(NoPartition::TooManyHarmonics { harmonics });
    }
    let operator = Operator { disc, mean, half_amplitude: 0.5 * amplitude, ratio, harmonics };
    let waves: usize =
        disc.modes().iter().map(|mode| if mode.diameters == 0 { 2 } else { 4 }).sum();
    let points = POINTS_PER_WAVE * waves;
    let at = |k: usize| 0.5 * ratio * (k as f64 / points as f64);
    let mut found = Vec::new();
    let mut any = false;
    let mut eigenvalues_at = |k: usize| {
        let values = operator.inverse_factors(at(k));
        any |= values.is_some();
        values.unwrap_or_default()
    };
    let mut before = eigenvalues_at(0);
    push_real(&before, at(0), &mut found);
    for k in 0..points {
        let after = eigenvalues_at(k + 1);
        for &value in &before {
            let Some(next) = nearest(&after, value) else { continue };
            if (value.im < 0.0) != (next.im < 0.0) && value.re.max(next.re) > 0.0 {
                found.extend(operator.refine_crossing(at(k), value, at(k + 1), next));
            }
        }
        before = after;
    }
    if !any {
        return Err(NoPartition::Eigenvalues);
    }
    push_real(&before, at(points), &mut found);
    ascending_by(&mut found, |a| a.factor);
    found.dedup_by(|a, b| {
        (a.factor - b.factor).abs() <= 1e-9 * b.factor
            && (a.frequency - b.frequency).abs() <= 1e-9 * ratio
    });
    Ok(found)
}
