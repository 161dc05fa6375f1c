//! The part of the state matrix that a speed over time multiplies, as of a disc in the frame of its loads.
//!
//! ```text
//! ẋ = (A + Ω A₁ + Ω² A₂ + Ω′ A₃) x + …
//! ```
//!
//! At order k of a step each of the three products is a Cauchy sum of the coefficients of its factor with A_j x of the orders up to k.
//! Between its breaks Ω is a cubic and a sum of sines, whose coefficients are exact, so that the series is that of the solution.

use quell_model::system::{Mechanical, SpeedDependence};
use quell_numerics::interval::RealInterval;
use quell_numerics::lane::partial_product;
use quell_numerics::matrix::Matrix;

use super::contact_series::SeriesOf;
use super::stopped::Immobile;
use crate::simulation::{Clock, Forcing, ORDER};

/// A₁, A₂ and A₃ by their entries that are not zero.
#[derive(Clone, Debug)]
pub(super) struct SpeedMatrices {
    terms: [Vec<MatrixEntry>; 3],
    /// Number of displacements: the rows of the matrices are those of the velocities after them.
    offset: usize,
    /// Largest magnitude of Ω.
    largest_speed: f64,
}

/// A number of a matrix with its place.
#[derive(Clone, Copy, Debug)]
struct MatrixEntry {
    /// Its row, without the offset.
    row: usize,
    column: usize,
    value: f64,
}

/// The factors Ω, Ω² and Ω′ on a step, and A_j x of its orders.
#[derive(Clone, Debug)]
pub(super) struct SpeedSeries {
    factors: [SeriesOf<f64>; 3],
    /// Row by row.
    images: [Vec<SeriesOf<f64>>; 3],
}

impl SpeedMatrices {
    /// Those of a structure; `None` if its matrices are constant.
    pub(super) fn of(mechanical: &Mechanical) -> Option<Result<Self, Immobile>> {
        Some(Self::solved(mechanical, mechanical.by_speed()?))
    }

    fn solved(mechanical: &Mechanical, given: &SpeedDependence) -> Result<Self, Immobile> {
        let n = mechanical.size();
        let solve = |matrix: &Matrix| mechanical.mass().solve(matrix).ok_or(Immobile::NoMass);
        let entries = |matrix: &Matrix, first: usize| -> Vec<MatrixEntry> {
            let places = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
            let all = places.map(|(i, j)| MatrixEntry {
                row: i,
                column: first + j,
                value: -matrix[(i, j)],
            });
            all.filter(|entry| entry.value != 0.0).collect()
        };
        let mut linear = entries(&solve(&given.stiffness)?, 0);
        linear.extend(entries(&solve(&given.damping)?, n));
        let square = entries(&solve(&given.square)?, 0);
        let rate = entries(&solve(&given.rate)?, 0);
        let RealInterval { lower: least, upper: most } = given.speed.bounds();
        let largest_speed = least.abs().max(most.abs());
        Ok(Self { terms: [linear, square, rate], offset: n, largest_speed })
    }

    /// Bounds of the magnitudes of the whole matrix at the largest speed, for an estimate of its fastest rate. The part of Ω′ is left
    /// out: a change within a short time is no fast motion.
    pub(super) fn largest(&self, matrix: &Matrix) -> Matrix {
        let size = matrix.rows();
        let mut closed = Matrix::from_fn(size, size, |i, j| matrix[(i, j)].abs());
        let speed = self.largest_speed;
        for (entries, factor) in self.terms.iter().zip([speed, speed * speed]) {
            for entry in entries {
                closed[(self.offset + entry.row, entry.column)] += (factor * entry.value).abs();
            }
        }
        closed
    }

    /// Adds their products with the state at a moment to its rates.
    pub(super) fn add_now(&self, speed: &Forcing, clock: Clock, state: &[f64], rates: &mut [f64]) {
        let series = speed.series(clock);
        let factors = [series[0], series[0] * series[0], series[1]];
        for (entries, factor) in self.terms.iter().zip(factors) {
            for entry in entries {
                rates[self.offset + entry.row] += factor * (entry.value * state[entry.column]);
            }
        }
    }

    /// Adds the terms of order k to the rates of the state.
    #[inline(always)]
    pub(super) fn add(&self, k: usize, series: &mut SpeedSeries, state: &[f64], rates: &mut [f64]) {
        let SpeedSeries { factors, images } = series;
        for ((entries, factor), images) in self.terms.iter().zip(factors).zip(images) {
            for image in images.iter_mut() {
                image[k] = 0.0;
            }
            for entry in entries {
                let image = &mut images[entry.row][k];
                *image = f64::mul_add(state[entry.column], entry.value, *image);
            }
            for (rate, image) in rates[self.offset..].iter_mut().zip(images) {
                *rate += partial_product(factor, image, k, 0, k);
            }
        }
    }
}

impl SpeedSeries {
    /// Zeros.
    pub(super) fn new(matrices: &SpeedMatrices) -> Self {
        let images = std::array::from_fn(|_| vec![[0.0; ORDER + 1]; matrices.offset]);
        Self { factors: [[0.0; ORDER + 1]; 3], images }
    }

    /// Writes the factors of the step that begins at a moment.
    pub(super) fn begin(&mut self, speed: &Forcing, clock: Clock) {
        let linear = speed.series(clock);
        let [own, square, rate] = &mut self.factors;
        for k in 0..=ORDER {
            square[k] = partial_product(&linear, &linear, k, 0, k);
            // The last coefficient of Ω′ would enter an order that is not kept.
            rate[k] = if k < ORDER { (k + 1) as f64 * linear[k + 1] } else { 0.0 };
        }
        *own = linear;
    }
}
