//! A waveform of pieces: its zero-mean integral and its averages, computed from the pieces in closed form.

use std::f64::consts::PI;

use quell_numerics::interval::RealInterval;

use super::shape::Piece;

/// Breaks and pieces with the numbers that follow from them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WaveTable {
    /// Phases at which the pieces begin, from 0, ascending.
    breaks: Vec<f64>,
    pieces: Vec<Piece>,
    /// G at the breaks.
    integrals: Vec<f64>,
    range: RealInterval,
    integral_range: RealInterval,
    mean_square: f64,
    mean_square_integral: f64,
}

/// g and its integral from the start of a piece at a distance from it; the start of a harmonic piece is a multiple of 2π.
fn at(piece: Piece, distance: f64) -> (f64, f64) {
    match piece {
        Piece::Harmonic => (libm::sin(distance), versine(distance)),
        Piece::Affine { value, slope } => {
            (slope.mul_add(distance, value), distance * (0.5 * slope).mul_add(distance, value))
        }
    }
}

/// 1 − cos θ.
fn versine(phase: f64) -> f64 {
    let half = libm::sin(0.5 * phase);
    2.0 * half * half
}

impl WaveTable {
    /// The table of pieces that begin at `breaks` and end at `period`. Their mean must be zero. A harmonic piece begins at a
    /// multiple of 2π and is whole periods long.
    pub(super) fn new(breaks: Vec<f64>, pieces: Vec<Piece>, period: f64) -> Self {
        let ends = breaks.iter().skip(1).copied().chain([period]);
        let lengths: Vec<f64> = ends.zip(&breaks).map(|(end, start)| end - start).collect();
        let parts: Vec<(Piece, f64)> = pieces.iter().copied().zip(lengths).collect();
        // The integral from the first break, and its mean over the period.
        let mut integrals = Vec::with_capacity(breaks.len());
        let (mut sum, mut area) = (0.0_f64, 0.0_f64);
        for (piece, length) in parts.iter().copied() {
            integrals.push(sum);
            let of_integral = match piece {
                Piece::Harmonic => length,
                Piece::Affine { value, slope } => {
                    length * length * (slope * length / 6.0 + 0.5 * value)
                }
            };
            area += sum.mul_add(length, of_integral);
            sum += match piece {
                Piece::Harmonic => 0.0,
                piece @ Piece::Affine { .. } => at(piece, length).1,
            };
        }
        let mean = area / period;
        for value in &mut integrals {
            *value -= mean;
        }
        let mut table = Self {
            breaks,
            pieces,
            integrals,
            range: RealInterval::point(0.0),
            integral_range: RealInterval::point(0.0),
            mean_square: 0.0,
            mean_square_integral: 0.0,
        };
        let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut square, mut square_integral) = (0.0, 0.0);
        for (index, (piece, length)) in parts.into_iter().enumerate() {
            let start = table.integrals[index];
            let mut meet = |distance: f64| {
                let (value, integral) = at(piece, distance);
                (least, largest) = (least.min(value), largest.max(value));
                (low, high) = (low.min(start + integral), high.max(start + integral));
            };
            meet(0.0);
            match piece {
                Piece::Harmonic => [0.5 * PI, PI, 1.5 * PI].into_iter().for_each(&mut meet),
                Piece::Affine { value, slope } => {
                    meet(length);
                    let turn = -value / slope;
                    if turn > 0.0 && turn < length {
                        meet(turn);
                    }
                }
            }
            square += length * mean_square(piece, length);
            square_integral += length * mean_square_of_integral(piece, start, length);
        }
        table.range = RealInterval::new(least, largest);
        table.integral_range = RealInterval::new(low, high);
        table.mean_square = square / period;
        table.mean_square_integral = square_integral / period;
        table
    }

    pub(super) fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    pub(super) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// G at a phase within the period.
    pub(super) fn integral(&self, phase: f64) -> f64 {
        let index = self.breaks.partition_point(|&start| start <= phase).saturating_sub(1);
        self.integrals[index] + at(self.pieces[index], phase - self.breaks[index]).1
    }

    pub(super) fn range(&self) -> RealInterval {
        self.range
    }

    pub(super) fn integral_range(&self) -> RealInterval {
        self.integral_range
    }

    pub(super) fn root_mean_square(&self) -> f64 {
        self.mean_square.sqrt()
    }

    pub(super) fn mean_square_integral(&self) -> f64 {
        self.mean_square_integral
    }
}

/// ⟨g²⟩ over a piece.
fn mean_square(piece: Piece, length: f64) -> f64 {
    match piece {
        Piece::Harmonic => 0.5,
        Piece::Affine { value, slope } => {
            let end = slope.mul_add(length, value);
            (value * value + value * end + end * end) / 3.0
        }
    }
}

/// ⟨G²⟩ over a piece at whose start G = `start`.
fn mean_square_of_integral(piece: Piece, start: f64, length: f64) -> f64 {
    match piece {
        // G = start + 1 − cos θ over whole periods.
        Piece::Harmonic => (start + 1.0) * (start + 1.0) + 0.5,
        // A quadratic: G = a + bx + cx² on [0, 1].
        Piece::Affine { value, slope } => {
            let (a, b, c) = (start, value * length, 0.5 * slope * length * length);
            a * a + a * b + b * b / 3.0 + 2.0 * a * c / 3.0 + 0.5 * b * c + c * c / 5.0
        }
    }
}
