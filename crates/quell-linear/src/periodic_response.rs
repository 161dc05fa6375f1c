//! The periodic response of a linear structure to a wave: x′ = A x + b g(ωt), for any waveform.
//!
//! Between two breaks of the waveform the response is analytic, and its Taylor series follows from the equation by recurrence. With
//! the phase θ = ωt, x_{k+1} = (A x_k/ω + b g_k/ω)/(k + 1). Intervals are so short that `DEGREE` terms are exact to rounding. The
//! start of the period solves x(Θ) = x(0), where Θ is the period: (e^{AΘ/ω} − 1) x(0) = −f with the response f to rest.
//! e^{AΘ/ω} − 1 is computed without its leading 1, which would hide slow motion under a fast wave.
//!
//! The result is exact for every damping, every order in 1/R and every waveform; a structure with an undamped eigenfrequency at a
//! multiple of the repetition frequency has none.

use std::sync::Arc;

use quell_model::Waveform;
use quell_model::waveform::Piece;
use quell_numerics::eigen::balanced;
use quell_numerics::matrix::Matrix;
use quell_numerics::periodic_polynomial::{PeriodicPolynomial, value_of};

/// Degree of the polynomials: with ‖A‖h/ω ≤ 1 the rest is 1/19!, below rounding.
const DEGREE: usize = 18;

/// Largest number of intervals of a period.
const MOST_INTERVALS: f64 = 2e5;

/// Norm of (e^{AΘ/ω} − 1)⁻¹, over that of what it inverts, beyond which an eigenfrequency is at a harmonic of the wave.
const RESONANT: f64 = 1e11;

/// Why there is no periodic response.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPeriodicResponse {
    /// A harmonic of the wave is at the frequency of an undamped motion of the structure.
    Resonance,
    /// The wave is so slow against the fastest motion of the structure that a period takes too many intervals.
    TooSlow,
    /// A number overflows.
    Overflow,
    /// The wave is noise, which does not repeat.
    Noise,
}

impl std::fmt::Display for NoPeriodicResponse {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Resonance => "a harmonic of the dither is at the frequency of an undamped motion",
            Self::TooSlow => {
                "the structure has motions so much faster than the dither that its response takes too many intervals"
            }
            Self::Noise => "noise does not repeat, so that no response does",
            Self::Overflow => "the equations of the structure overflow",
        })
    }
}

impl std::error::Error for NoPeriodicResponse {}

/// The periodic response to a wave of unit amplitude, as a function of the phase θ.
#[derive(Clone, Debug)]
pub struct ResponseToWave<'w> {
    waveform: &'w Waveform,
    /// A/ω in balanced coordinates, b/ω in them, and the factors that lead back.
    matrix: Matrix,
    source: Vec<f64>,
    scales: Vec<f64>,
    starts: Arc<[f64]>,
    /// Balanced states at the starts.
    states: Vec<Vec<f64>>,
}

impl<'w> ResponseToWave<'w> {
    /// The response of x′ = `matrix`·x + `source`·g(`frequency`·t).
    ///
    /// # Errors
    /// [`NoPeriodicResponse`].
    pub fn new(
        matrix: &Matrix,
        source: &[f64],
        waveform: &'w Waveform,
        frequency: f64,
    ) -> Result<Self, NoPeriodicResponse> {
        if !waveform.is_periodic() {
            return Err(NoPeriodicResponse::Noise);
        }
        let n = matrix.rows();
        let mut scaled = Matrix::from_fn(n, n, |i, j| matrix[(i, j)] / frequency);
        let scales = balanced(&mut scaled);
        let source = source.iter().zip(&scales).map(|(b, scale)| b / (scale * frequency)).collect();
        let norm = (0..n)
            .map(|i| scaled.row(i).iter().map(|entry| entry.abs()).sum::<f64>())
            .fold(0.0, f64::max);
        if !norm.is_finite() {
            return Err(NoPeriodicResponse::Overflow);
        }
        let fastest = norm.max(f64::from(waveform.highest_order())).max(1.0);
        if fastest * waveform.period() > MOST_INTERVALS {
            return Err(NoPeriodicResponse::TooSlow);
        }
        let starts = starts(waveform, fastest);
        let mut response =
            Self { waveform, matrix: scaled, source, scales, starts, states: Vec::new() };
        let from_rest = response.run(vec![0.0; n]);
        let begin = start_of_period(&response.matrix, (norm, waveform.period()), &from_rest)?;
        response.run(begin);
        Ok(response)
    }

    /// The state at a phase.
    pub fn state(&self, phase: f64) -> Vec<f64> {
        let wrapped = phase.rem_euclid(self.waveform.period());
        let place = self.starts.partition_point(|start| *start <= wrapped).max(1) - 1;
        let series = self.series(place);
        let since = wrapped - self.starts[place];
        (0..self.scales.len())
            .map(|i| {
                let own: Vec<f64> = series.iter().map(|x| x[i]).collect();
                self.scales[i] * value_of(&own, since)
            })
            .collect()
    }

    /// What rows over the state, with the wave itself times a factor, do over a period of the phase: `row`·x + `direct`·g.
    pub fn outputs(&self, rows: &[(&[f64], f64)]) -> Vec<PeriodicPolynomial> {
        let balanced_rows: Vec<Vec<f64>> = rows
            .iter()
            .map(|(row, _)| row.iter().zip(&self.scales).map(|(r, scale)| r * scale).collect())
            .collect();
        let mut outputs = vec![Vec::with_capacity(self.starts.len()); rows.len()];
        for place in 0..self.starts.len() {
            let series = self.series(place);
            let wave = self.wave(place);
            for ((output, row), (_, direct)) in outputs.iter_mut().zip(&balanced_rows).zip(rows) {
                let term = |(x, g): (&Vec<f64>, &f64)| {
                    row.iter().zip(x).map(|(r, x)| r * x).sum::<f64>() + direct * g
                };
                output.push(series.iter().zip(&wave).map(term).collect::<Vec<f64>>());
            }
        }
        let of = |own: &Vec<Vec<f64>>| {
            PeriodicPolynomial::new(self.waveform.period(), self.starts.clone(), own)
        };
        outputs.iter().map(of).collect()
    }

    /// Runs through a period and keeps the states at the starts; returns the state at its end.
    fn run(&mut self, begin: Vec<f64>) -> Vec<f64> {
        self.states.clear();
        self.states.push(begin);
        for place in 0..self.starts.len() {
            let (series, length) = (self.series(place), self.length(place));
            let at_end =
                |i: usize| series.iter().rev().fold(0.0, |sum: f64, x| sum.mul_add(length, x[i]));
            self.states.push((0..self.source.len()).map(at_end).collect());
        }
        self.states.pop().unwrap_or_default()
    }

    /// Taylor coefficients of the balanced state on an interval.
    fn series(&self, place: usize) -> Vec<Vec<f64>> {
        let wave = self.wave(place);
        let mut series = vec![self.states[place].clone()];
        for k in 0..DEGREE {
            let last = &series[k];
            let next = (0..last.len()).map(|i| {
                let own = self.matrix.row(i).iter().zip(last).map(|(a, x)| a * x).sum::<f64>();
                self.source[i].mul_add(wave[k], own) / (k + 1) as f64
            });
            series.push(next.collect());
        }
        series
    }

    /// Taylor coefficients of g on an interval.
    fn wave(&self, place: usize) -> [f64; DEGREE + 1] {
        let start = self.starts[place];
        let mut wave = [0.0; DEGREE + 1];
        if let Some(harmonics) = self.waveform.harmonics() {
            for harmonic in harmonics {
                let order = f64::from(harmonic.order);
                let phase = order.mul_add(start, harmonic.phase());
                add_sine(&mut wave, harmonic.amplitude(), order, phase);
            }
            return wave;
        }
        // The middle of the interval is in its piece, however its start is rounded.
        let middle = 0.5f64.mul_add(self.length(place), start);
        let (begin, piece) = self.waveform.piece_at(middle);
        match piece {
            Piece::Harmonic => add_sine(&mut wave, 1.0, 1.0, start),
            Piece::Affine { value, slope } => {
                // The piece may begin before the period.
                let since = (start - begin).rem_euclid(self.waveform.period());
                wave[0] = slope.mul_add(since, value);
                wave[1] = slope;
            }
        }
        wave
    }

    fn length(&self, place: usize) -> f64 {
        self.starts.get(place + 1).copied().unwrap_or_else(|| self.waveform.period())
            - self.starts[place]
    }
}

/// Adds the series of amplitude·sin(phase + order·x).
fn add_sine(series: &mut [f64], amplitude: f64, order: f64, phase: f64) {
    let (sine, cosine) = (libm::sin(phase), libm::cos(phase));
    let derivatives = [sine, cosine, -sine, -cosine];
    let mut factor = amplitude;
    for (k, coefficient) in series.iter_mut().enumerate() {
        *coefficient += factor * derivatives[k % 4];
        factor *= order / (k + 1) as f64;
    }
}

/// Starts of the intervals: the breaks of the waveform, and points between them less than 1/`fastest` apart.
fn starts(waveform: &Waveform, fastest: f64) -> Arc<[f64]> {
    let period = waveform.period();
    let mut edges = vec![0.0];
    edges.extend(waveform.breaks().iter().copied().filter(|at| *at > 0.0));
    edges.push(period);
    let mut starts = Vec::new();
    for pair in edges.windows(2) {
        let parts = ((pair[1] - pair[0]) * fastest).ceil().max(1.0);
        let step = (pair[1] - pair[0]) / parts;
        let mut part = 0.0;
        while part < parts {
            starts.push(step.mul_add(part, pair[0]));
            part += 1.0;
        }
    }
    starts.into()
}

/// x with (e^{BΘ} − 1) x = −f.
fn start_of_period(
    matrix: &Matrix,
    (norm, period): (f64, f64),
    from_rest: &[f64],
) -> Result<Vec<f64>, NoPeriodicResponse> {
    let n = matrix.rows();
    let mut halvings = 0;
    let mut step = period;
    while norm * step > 0.5 {
        step *= 0.5;
        halvings += 1;
    }
    // E = e^{Bh} − 1 by its series, then E ← 2E + E².
    let mut grown = Matrix::zeros(n, n);
    let mut term = Matrix::identity(n);
    for k in 1..=DEGREE {
        term = matrix.times(&term);
        for entry in term.as_mut_slice() {
            *entry *= step / k as f64;
        }
        grown.add_scaled(1.0, &term);
    }
    for _ in 0..halvings {
        let square = grown.times(&grown);
        grown.add_scaled(1.0, &grown.clone());
        grown.add_scaled(1.0, &square);
    }
    if !grown.is_finite() {
        return Err(NoPeriodicResponse::Overflow);
    }
    let right =
        Matrix::from_fn(
            n,
            n + 1,
            |i, j| if j < n { f64::from(u8::from(i == j)) } else { -from_rest[i] },
        );
    let solved = grown.solve(&right).ok_or(NoPeriodicResponse::Resonance)?;
    let inverse = Matrix::from_fn(n, n, |i, j| solved[(i, j)]);
    // e^{BΘ} − 1 has rounding errors of this size, times ε: all of it may be rounding.
    let size = grown.frobenius_norm().max((norm * period).min(1.0));
    let condition = inverse.frobenius_norm() * size;
    if condition.is_nan() || condition >= RESONANT {
        return Err(NoPeriodicResponse::Resonance);
    }
    Ok((0..n).map(|i| solved[(i, n)]).collect())
}
