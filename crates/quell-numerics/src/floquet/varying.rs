//! Exponents where the matrix varies analytically on each of a few pieces of the period: x′ = (A₀ + U diag(φ(t)) Vᵀ) x.
//!
//! On a piece every φ is a straight line and a sum of sines, whose Taylor coefficients are known, so that those of the map follow
//! from the recurrence
//!
//! ```text
//! (k + 1) X_{k+1} = A₀ X_k + U S_k,      S_k = Σ_j diag(φ_j) Vᵀ X_{k−j}
//! ```
//!
//! Steps are so short that the series converges to rounding; there is no other truncation and nothing to extrapolate. The error
//! is that of [`of_pieces`](super::of_pieces), with the rounding of the steps in place of that of the exponentials.

use crate::eigen::EigenError;
use crate::matrix::Matrix;

use super::Exponent;
use super::pieces::exponents_of;

/// Rounding of the steps relative to ε‖A‖.
const ROUNDING: f64 = 16.0;

/// Length of a step times the fastest rate: the terms of an exponential then vanish below rounding after about 25.
const REACH: f64 = 1.5;

/// Terms after which a step is halved. Strongly non-normal matrices need more than others.
const MOST_TERMS: usize = 60;

/// Size of a term relative to the sum below which it is rounding.
const NEGLIGIBLE: f64 = 1e-18;

/// Largest number of halvings of a step: by then it is below rounding.
const MOST_HALVINGS: u32 = 50;

/// a sin(ωt + φ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sinusoid {
    /// Amplitude a.
    pub amplitude: f64,
    /// Angular frequency ω.
    pub frequency: f64,
    /// Phase φ at the start of the piece, radians.
    pub phase: f64,
}

/// One φ on a piece: value + slope·t + Σ sinusoids, t since the start of the piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strength {
    /// Value of the straight line at the start of the piece.
    pub value: f64,
    /// Slope per unit of time.
    pub slope: f64,
    /// The sinusoids.
    pub sinusoids: Vec<Sinusoid>,
}

/// A part of the period on which every φ is analytic.
#[derive(Clone, Debug, PartialEq)]
pub struct VaryingPiece {
    /// Its duration.
    pub duration: f64,
    /// φ of each column of U.
    pub strengths: Vec<Strength>,
}

/// The constant parts of the equations: A₀ (n × n), U and V (n × r).
#[derive(Clone, Debug, PartialEq)]
pub struct VaryingFlow {
    constant: Matrix,
    u: Matrix,
    /// Vᵀ.
    v: Matrix,
}

impl Strength {
    /// Taylor coefficients in powers of (time after `since`)/`step`.
    fn series(&self, since: f64, step: f64, to: &mut [f64]) {
        to.fill(0.0);
        to[0] = self.slope.mul_add(since, self.value);
        if let Some(second) = to.get_mut(1) {
            *second = self.slope * step;
        }
        for Sinusoid { amplitude, frequency, phase } in &self.sinusoids {
            let (sine, cosine) = libm::sincos(frequency.mul_add(since, *phase));
            let cycle = [sine, cosine, -sine, -cosine];
            let mut factor = *amplitude;
            for (k, coefficient) in to.iter_mut().enumerate() {
                *coefficient += factor * cycle[k % 4];
                factor *= frequency * step / (k + 1) as f64;
            }
        }
    }

    /// Bound on |φ| over a piece, and its highest frequency.
    fn bounds(&self, duration: f64) -> (f64, f64) {
        let line = self.value.abs().max(self.slope.mul_add(duration, self.value).abs());
        let sines: f64 = self.sinusoids.iter().map(|sine| sine.amplitude.abs()).sum();
        let fastest = self.sinusoids.iter().map(|sine| sine.frequency.abs()).fold(0.0, f64::max);
        (line + sines, fastest)
    }
}

impl VaryingFlow {
    /// From A₀, U and V.
    ///
    /// # Panics
    /// If the sizes do not match.
    pub fn new(constant: Matrix, u: Matrix, v: &Matrix) -> Self {
        let n = constant.rows();
        assert!(u.rows() == n && v.rows() == n && u.columns() == v.columns(), "sizes");
        Self { constant, u, v: v.transpose() }
    }

    /// The exponents of a period that consists of these pieces, one of each conjugate pair, the fastest first. `steps` is the
    /// number of steps.
    ///
    /// # Errors
    /// [`EigenError`] if the map is not finite or its eigenvalues do not converge.
    pub fn exponents(&self, pieces: &[VaryingPiece]) -> Result<Vec<Exponent>, EigenError> {
        let period: f64 = pieces.iter().map(|piece| piece.duration).sum();
        let (map, steps) = self.map(pieces)?;
        let norm = pieces.iter().map(|piece| self.largest(piece).frobenius_norm());
        let rounding = ROUNDING * f64::EPSILON * norm.fold(0.0, f64::max);
        exponents_of(&map, period, rounding, steps)
    }

    /// The map of a period, and the number of steps.
    ///
    /// # Errors
    /// [`EigenError::NotFinite`] if it is not finite.
    pub fn map(&self, pieces: &[VaryingPiece]) -> Result<(Matrix, usize), EigenError> {
        let mut map = Matrix::identity(self.constant.rows());
        let mut taken = 0;
        for piece in pieces {
            let largest = self.largest(piece);
            if !largest.is_finite() {
                return Err(EigenError::NotFinite);
            }
            let sines = piece.strengths.iter().map(|strength| strength.bounds(piece.duration).1);
            let rate = fastest(&self.constant).max(fastest(&largest)) + sines.fold(0.0, f64::max);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a count of steps, at least 1"
            )]
            let count = (rate * piece.duration / REACH).ceil().max(1.0) as usize;
            let step = piece.duration / count as f64;
            for k in 0..count {
                map = self.step(piece, step * k as f64, step, &map, 0)?;
            }
            taken += count;
        }
        if map.is_finite() { Ok((map, taken)) } else { Err(EigenError::NotFinite) }
    }

    /// A₀ + U diag(|φ|) Vᵀ, |φ| bounded over the piece.
    fn largest(&self, piece: &VaryingPiece) -> Matrix {
        let mut scaled = self.v.clone();
        for (c, strength) in piece.strengths.iter().enumerate() {
            let bound = strength.bounds(piece.duration).0;
            scaled.row_mut(c).iter_mut().for_each(|value| *value *= bound);
        }
        let mut sum = self.constant.clone();
        sum.add_scaled(1.0, &self.u.times(&scaled));
        sum
    }

    /// The map after one step from the time `since` of a piece.
    fn step(
        &self,
        piece: &VaryingPiece,
        since: f64,
        step: f64,
        map: &Matrix,
        halvings: u32,
    ) -> Result<Matrix, EigenError> {
        let (n, rank) = (map.rows(), self.v.rows());
        let mut phi = vec![vec![0.0; MOST_TERMS]; rank];
        for (strength, to) in piece.strengths.iter().zip(&mut phi) {
            strength.series(since, step, to);
        }
        let mut sum = map.clone();
        let mut term = map.clone();
        // Vᵀ X_k of all terms so far.
        let mut seen: Vec<Matrix> = Vec::with_capacity(MOST_TERMS);
        let mut small = 0;
        for k in 0..MOST_TERMS {
            seen.push(self.v.times(&term));
            let mut forced = Matrix::zeros(rank, n);
            for (c, phi) in phi.iter().enumerate() {
                let row = forced.row_mut(c);
                for (j, coefficient) in phi.iter().enumerate().take(k + 1) {
                    if *coefficient != 0.0 {
                        for (to, from) in row.iter_mut().zip(seen[k - j].row(c)) {
                            *to = coefficient.mul_add(*from, *to);
                        }
                    }
                }
            }
            let mut next = Matrix::zeros(n, n);
            let factor = step / (k + 1) as f64;
            next.add_scaled(factor, &self.constant.times(&term));
            next.add_scaled(factor, &self.u.times(&forced));
            sum.add_scaled(1.0, &next);
            small = if next.largest() <= NEGLIGIBLE * sum.largest() { small + 1 } else { 0 };
            // A term may vanish by chance: φ and the constant part each have their own.
            if small == 3 {
                return Ok(sum);
            }
            term = next;
        }
        if halvings == MOST_HALVINGS {
            return Err(EigenError::NotFinite);
        }
        let half = 0.5 * step;
        let middle = self.step(piece, since, half, map, halvings + 1)?;
        self.step(piece, since + half, half, &middle, halvings + 1)
    }
}

/// ‖A⁸‖^{1/8}, close to the largest |λ|.
fn fastest(matrix: &Matrix) -> f64 {
    let size = matrix.frobenius_norm();
    if size == 0.0 {
        return 0.0;
    }
    let mut power = Matrix::zeros(matrix.rows(), matrix.rows());
    power.add_scaled(size.recip(), matrix);
    for _ in 0..3 {
        power = power.times(&power);
    }
    size * libm::pow(power.frobenius_norm(), 0.125)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floquet::{ConstantPiece, of_pieces};

    fn oscillator() -> VaryingFlow {
        let constant = Matrix::from_fn(2, 2, |i, j| match (i, j) {
            (0, 1) => 1.0,
            (1, 0) => -1.0,
            (1, 1) => -0.02,
            _ => 0.0,
        });
        let unit = |at: usize| Matrix::from_fn(2, 1, |i, _| f64::from(u8::from(i == at)));
        VaryingFlow::new(constant, unit(1), &unit(0))
    }

    /// Classical Runge–Kutta steps of x″ + 0.02x′ + (1 − φ(t))x = 0.
    fn by_runge_kutta(phi: &dyn Fn(f64) -> f64, duration: f64, steps: u32) -> [[f64; 2]; 2] {
        let rate = |t: f64, [x, v]: [f64; 2]| [v, (phi(t) - 1.0) * x - 0.02 * v];
        let h = duration / f64::from(steps);
        [[1.0, 0.0], [0.0, 1.0]].map(|mut y| {
            for k in 0..steps {
                let t = h * f64::from(k);
                let moved = |k: [f64; 2], by: f64| [y[0] + by * k[0], y[1] + by * k[1]];
                let one = rate(t, y);
                let two = rate(t + 0.5 * h, moved(one, 0.5 * h));
                let three = rate(t + 0.5 * h, moved(two, 0.5 * h));
                let four = rate(t + h, moved(three, h));
                for i in 0..2 {
                    y[i] += h / 6.0 * (one[i] + 2.0 * (two[i] + three[i]) + four[i]);
                }
            }
            y
        })
    }

    #[test]
    fn the_map_is_that_of_runge_kutta() {
        let sine = |amplitude, frequency, phase| Sinusoid { amplitude, frequency, phase };
        let strengths = [
            Strength { value: 0.4, slope: -0.3, sinusoids: Vec::new() },
            Strength {
                value: 0.1,
                slope: 0.0,
                sinusoids: vec![sine(0.8, 2.0, 0.4), sine(0.1, 6.0, 1.0)],
            },
        ];
        for strength in strengths {
            let phi = |t: f64| {
                let waves = strength.sinusoids.iter();
                let sines = waves.map(|s| s.amplitude * (s.frequency * t + s.phase).sin());
                strength.value + strength.slope * t + sines.sum::<f64>()
            };
            let wanted = by_runge_kutta(&phi, 5.0, 20_000);
            let piece = VaryingPiece { duration: 5.0, strengths: vec![strength.clone()] };
            let (map, _) = oscillator().map(&[piece]).expect("finite");
            for (column, wanted) in wanted.iter().enumerate() {
                for (row, wanted) in wanted.iter().enumerate() {
                    assert!((map[(row, column)] - wanted).abs() < 1e-12, "{row} {column}");
                }
            }
        }
    }

    #[test]
    fn constant_pieces_are_those_of_the_exponentials() {
        let level = |value: f64| Strength { value, ..Strength::default() };
        let varying: Vec<VaryingPiece> = [(0.3, 2.0), (-0.3, 2.4)]
            .map(|(value, duration)| VaryingPiece { duration, strengths: vec![level(value)] })
            .to_vec();
        let flow = oscillator();
        let constant: Vec<ConstantPiece> = varying
            .iter()
            .map(|piece| {
                let mut matrix = flow.constant.clone();
                matrix[(1, 0)] += piece.strengths[0].value;
                ConstantPiece { duration: piece.duration, matrix }
            })
            .collect();
        let (one, other) =
            (flow.exponents(&varying).expect("finite"), of_pieces(&constant).expect("finite"));
        assert_eq!(one.len(), other.len());
        for (one, other) in one.iter().zip(&other) {
            assert!((one.growth_rate - other.growth_rate).abs() < 1e-13);
            assert!((one.frequency - other.frequency).abs() < 1e-13);
        }
    }

    /// A step that is far too long for its series is halved until it converges.
    #[test]
    fn long_steps_are_halved() {
        let flow = oscillator();
        let strength = Strength {
            sinusoids: vec![Sinusoid { amplitude: 0.5, frequency: 3.0, phase: 0.0 }],
            ..Strength::default()
        };
        let piece = VaryingPiece { duration: 40.0, strengths: vec![strength] };
        let (usual, _) = flow.map(std::slice::from_ref(&piece)).expect("finite");
        let halved = flow.step(&piece, 0.0, 40.0, &Matrix::identity(2), 0).expect("it converges");
        let mut gap = usual.clone();
        gap.add_scaled(-1.0, &halved);
        assert!(gap.largest() < 1e-12 * usual.largest(), "{}", gap.largest());
    }
}
