//! N equal steps of a period: the times of the kicks, and the constant flow between them.
//!
//! In modal coordinates a kick at time s after the start of a chunk is a rank-r update of Z = e^{−A₀s}X
//! with e^{−A₀s}U and Vᵀe^{A₀s}: Z is constant between kicks. The length of a chunk is limited by e^{|Re λ|s} < e²; at its end
//! Z is advanced by the flow of the chunk. Powers are computed by halving, e^{λhk} = e^{λh⌊k/2⌋} e^{λh⌈k/2⌉}, so that rounding
//! errors grow with log N, not with N.

use num_complex::Complex64;

use super::flow::{ConstantFlow, Coordinates};
use crate::matrix::Matrix;

/// A phase of the period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// Time divided by the period.
    pub cycles: f64,
    /// Cosine of 2π·cycles.
    pub cosine: f64,
    /// Sine of 2π·cycles.
    pub sine: f64,
}

impl Phase {
    /// The phase after a number of cycles.
    pub fn new(cycles: f64) -> Self {
        let (sine, cosine) = libm::sincos(core::f64::consts::TAU * cycles);
        Self { cycles, cosine, sine }
    }
}

/// Largest exponent of the growth within a chunk.
const CHUNK_GROWTH: f64 = 2.0;

/// A period divided into equal steps, for a given flow.
#[derive(Clone, Debug)]
pub(super) struct Steps {
    pub(super) step: f64,
    pub(super) phases: Vec<Phase>,
    pub(super) motion: StepMotion,
}

/// The constant flow between kicks.
#[derive(Clone, Debug)]
pub(super) enum StepMotion {
    /// Tables of one chunk and its flow.
    Modal {
        /// Number of kicks in a chunk.
        chunk: usize,
        /// Rows of the tables: the size, rounded up to an even number.
        rows: usize,
        /// e^{−A₀s}U, [kick][r][row].
        u: Vec<f64>,
        /// Vᵀe^{A₀s}, [kick][r][row].
        v: Vec<f64>,
        /// e^{λs} of a whole chunk for each block: real part, imaginary part, and whether the block is a complex pair.
        flow: Vec<(f64, f64, bool)>,
    },
    /// e^{A₀h/2} and e^{A₀h}.
    Dense {
        /// Half a step.
        half: Matrix,
        /// A step.
        whole: Matrix,
    },
}

/// e^{zk} for k = 0…count, computed by halving.
fn powers(z: Complex64, count: usize) -> Vec<Complex64> {
    let mut powers = vec![Complex64::new(1.0, 0.0); count + 1];
    if count > 0 {
        powers[1] = exponential(z);
    }
    for k in 2..=count {
        powers[k] = powers[k / 2] * powers[k - k / 2];
    }
    powers
}

/// e^z, with the same bits on every machine.
pub(super) fn exponential(z: Complex64) -> Complex64 {
    let (sine, cosine) = libm::sincos(z.im);
    let size = libm::exp(z.re);
    Complex64::new(size * cosine, size * sine)
}

impl Steps {
    /// A period divided into `count` steps, a power of two.
    pub(super) fn new(flow: &ConstantFlow, period: f64, count: usize) -> Self {
        let step = period / count as f64;
        let turn = Complex64::new(0.0, core::f64::consts::TAU / count as f64);
        let half = exponential(0.5 * turn);
        let phases = powers(turn, count - 1)
            .iter()
            .enumerate()
            .map(|(k, power)| {
                let middle = power * half;
                let cycles = (k as f64 + 0.5) / count as f64;
                Phase { cycles, cosine: middle.re, sine: middle.im }
            })
            .collect();
        let motion = match &flow.coordinates {
            Coordinates::Modal(values) => modal(flow, values, step, count),
            Coordinates::Dense(a) => {
                let half = exponential_of_matrix(a, 0.5 * step);
                let whole = half.times(&half);
                StepMotion::Dense { half, whole }
            }
        };
        Self { step, phases, motion }
    }
}

fn modal(flow: &ConstantFlow, values: &[Complex64], step: f64, count: usize) -> StepMotion {
    let mut chunk = count;
    while chunk > 1 && flow.strongest * step * chunk as f64 > CHUNK_GROWTH {
        chunk /= 2;
    }
    let (n, r) = (flow.size, flow.rank);
    let rows = n.next_multiple_of(2);
    let mut u = vec![0.0; chunk * r * rows];
    let mut v = vec![0.0; chunk * r * rows];
    let mut at = 0;
    for &value in values {
        let pair = value.im != 0.0;
        let middle = exponential(0.5 * step * value);
        let back_middle = exponential(-0.5 * step * value);
        let (ahead, back) = (powers(step * value, chunk - 1), powers(-step * value, chunk - 1));
        for k in 0..chunk {
            let (ahead, back) = (ahead[k] * middle, back[k] * back_middle);
            for c in 0..r {
                let to = (k * r + c) * rows + at;
                if pair {
                    let b = back * Complex64::new(flow.u[(at, c)], flow.u[(at + 1, c)]);
                    // The row is (2 Re c, −2 Im c): conjugation gives 2c.
                    let row = ahead * Complex64::new(flow.v[(c, at)], -flow.v[(c, at + 1)]);
                    (u[to], u[to + 1]) = (b.re, b.im);
                    (v[to], v[to + 1]) = (row.re, -row.im);
                } else {
                    u[to] = back.re * flow.u[(at, c)];
                    v[to] = ahead.re * flow.v[(c, at)];
                }
            }
        }
        at += if pair { 2 } else { 1 };
    }
    let flow = values
        .iter()
        .map(|&value| {
            let end = exponential(step * chunk as f64 * value);
            (end.re, end.im, value.im != 0.0)
        })
        .collect();
    StepMotion::Modal { chunk, rows, u, v, flow }
}

/// e^{At} by the Taylor series of e^{At/2^s}, ‖At‖/2^s ≤ ½, squared s times.
pub(super) fn exponential_of_matrix(a: &Matrix, t: f64) -> Matrix {
    let n = a.rows();
    let mut size = (a.frobenius_norm() * t).abs();
    let mut squarings = 0;
    let mut scaled = t;
    while size > 0.5 {
        size *= 0.5;
        scaled *= 0.5;
        squarings += 1;
    }
    let mut power = Matrix::identity(n);
    let mut sum = power.clone();
    // ½^16/16! is far below the rounding error.
    for k in 1..=16 {
        let mut next = Matrix::zeros(n, n);
        next.add_scaled(scaled / f64::from(k), &power.times(a));
        sum.add_scaled(1.0, &next);
        power = next;
    }
    for _ in 0..squarings {
        sum = sum.times(&sum);
    }
    sum
}
