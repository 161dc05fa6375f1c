//! A periodic function by polynomials on intervals, as the response of a linear system to a wave of pieces is known.

use std::sync::Arc;

use crate::roots::{Closeness, find_root};

/// Points of an interval between which a slope changes its sign at most once.
const SAMPLES: usize = 8;

/// Coefficients below this share of the largest value are dropped from the end of a polynomial.
const NEGLIGIBLE: f64 = 1e-19;

/// A function of period `period` that is a polynomial of x − start on each interval.
///
/// ```
/// use quell_numerics::periodic_polynomial::PeriodicPolynomial;
///
/// // A triangle of period 2: x, then 2 − x.
/// let tooth = PeriodicPolynomial::new(2.0, vec![0.0, 1.0].into(), &[vec![0.0, 1.0], vec![1.0, -1.0]]);
/// assert_eq!(tooth.value_and_slope(3.25), (0.75, -1.0));
/// assert_eq!(tooth.range(), [0.0, 1.0]);
/// assert!((tooth.mean_of_product(&tooth) - 1.0 / 3.0).abs() < 1e-15);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicPolynomial {
    period: f64,
    /// Starts of the intervals, ascending from 0; shared by functions of one origin.
    starts: Arc<[f64]>,
    /// Coefficients of all intervals, one after the other, and where those of each begin.
    coefficients: Vec<f64>,
    offsets: Vec<usize>,
    /// Where the function turns within an interval, ascending.
    turns: Vec<f64>,
    range: [f64; 2],
}

/// A part of an interval on which the function is monotone.
#[derive(Clone, Copy, Debug)]
pub struct MonotonePart<'a> {
    /// Coefficients of the interval.
    pub coefficients: &'a [f64],
    /// Where the part begins and ends, from the start of the interval.
    pub ends: [f64; 2],
}

/// The value of a polynomial, coefficients from the constant upwards.
///
/// Without fused multiply-add, which is a call of a library on a processor that may lack it.
pub fn value_of(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum: f64, c| sum * x + c)
}

/// The slope of a polynomial.
pub fn slope_of(coefficients: &[f64], x: f64) -> f64 {
    value_and_slope_of(coefficients, x).1
}

/// Both.
fn value_and_slope_of(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients
        .iter()
        .rev()
        .fold((0.0, 0.0), |(value, slope): (f64, f64), c| (value * x + c, slope * x + value))
}

impl PeriodicPolynomial {
    /// From the coefficients of every interval: `starts` ascend from 0 and are below the period.
    ///
    /// # Panics
    /// If there is no interval, or not one list of coefficients for each.
    pub fn new(period: f64, starts: Arc<[f64]>, intervals: &[Vec<f64>]) -> Self {
        assert!(!starts.is_empty() && starts.len() == intervals.len(), "one list for each start");
        let mut function = Self {
            period,
            starts,
            coefficients: Vec::new(),
            offsets: vec![0],
            turns: Vec::new(),
            range: [f64::INFINITY, f64::NEG_INFINITY],
        };
        let largest = |(place, own): (usize, &Vec<f64>)| {
            let length = function.length(place);
            own.iter().rev().fold(0.0, |sum: f64, c| sum.mul_add(length, c.abs()))
        };
        let scale = intervals.iter().enumerate().map(largest).fold(0.0, f64::max);
        for (place, own) in intervals.iter().enumerate() {
            let length = function.length(place);
            let mut reach = libm::pow(length, own.len().saturating_sub(1) as f64);
            let mut kept = own.len();
            while kept > 1 && own[kept - 1].abs() * reach <= NEGLIGIBLE * scale {
                kept -= 1;
                reach /= length;
            }
            function.coefficients.extend(&own[..kept]);
            function.offsets.push(function.coefficients.len());
        }
        function.find_turns();
        function
    }

    /// The period.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// Where one interval ends and the next begins, from 0.
    pub fn starts(&self) -> &[f64] {
        &self.starts
    }

    /// Where the function turns between these.
    pub fn turns(&self) -> &[f64] {
        &self.turns
    }

    /// Least and largest value.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// The value and the slope at any x; at the start of an interval, those after it.
    pub fn value_and_slope(&self, x: f64) -> (f64, f64) {
        let wrapped = x.rem_euclid(self.period);
        let wrapped = if wrapped == self.period { 0.0 } else { wrapped };
        let place = self.starts.partition_point(|start| *start <= wrapped) - 1;
        let (own, since) = (self.of(place), wrapped - self.starts[place]);
        value_and_slope_of(own, since)
    }

    /// Mean over a period of the product with a function on the same intervals.
    pub fn mean_of_product(&self, other: &Self) -> f64 {
        let mut sum = 0.0;
        for place in 0..self.starts.len() {
            let length = self.length(place);
            let (left, right) = (self.of(place), other.of(place));
            // ∫ Σ lᵢ xⁱ Σ rⱼ xʲ = h Σ lᵢhⁱ rⱼhʲ/(i + j + 1)
            let scaled = |own: &[f64]| -> Vec<f64> {
                let mut power = 1.0;
                let next = |c: &f64| {
                    let value = c * power;
                    power *= length;
                    value
                };
                own.iter().map(next).collect()
            };
            let (left, right) = (scaled(left), scaled(right));
            for (i, l) in left.iter().enumerate() {
                for (j, r) in right.iter().enumerate() {
                    sum += length * l * r / (i + j + 1) as f64;
                }
            }
        }
        sum / self.period
    }

    /// Root mean square over a period.
    pub fn root_mean_square(&self) -> f64 {
        self.mean_of_product(self).max(0.0).sqrt()
    }

    /// The slope as a function.
    #[must_use]
    pub fn derivative(&self) -> Self {
        let slope = |place: usize| -> Vec<f64> {
            let own = self.of(place).iter().enumerate().skip(1);
            let mut slope: Vec<f64> = own.map(|(power, c)| power as f64 * c).collect();
            if slope.is_empty() {
                slope.push(0.0);
            }
            slope
        };
        let intervals: Vec<Vec<f64>> = (0..self.starts.len()).map(slope).collect();
        Self::new(self.period, Arc::clone(&self.starts), &intervals)
    }

    /// `scale` times this function plus `factor` times another on the same intervals.
    #[must_use]
    pub fn combined(&self, scale: f64, factor: f64, other: &Self) -> Self {
        let sum = |place: usize| -> Vec<f64> {
            let (own, more) = (self.of(place), other.of(place));
            let at = |list: &[f64], power: usize| list.get(power).copied().unwrap_or(0.0);
            let powers = 0..own.len().max(more.len());
            powers.map(|power| scale * at(own, power) + factor * at(more, power)).collect()
        };
        let intervals: Vec<Vec<f64>> = (0..self.starts.len()).map(sum).collect();
        Self::new(self.period, Arc::clone(&self.starts), &intervals)
    }

    /// The largest jump between the end of an interval and the start of the next; of a continuous function a rounding error.
    pub fn largest_jump(&self) -> f64 {
        let count = self.starts.len();
        let jump = |place: usize| {
            let end = value_of(self.of(place), self.length(place));
            (self.of((place + 1) % count)[0] - end).abs()
        };
        (0..count).map(jump).fold(0.0, f64::max)
    }

    /// The parts on which the function is monotone, ascending.
    pub fn monotone_parts(&self) -> impl Iterator<Item = MonotonePart<'_>> {
        let mut turn = 0;
        (0..self.starts.len()).flat_map(move |place| {
            let start = self.starts[place];
            let mut from = 0.0;
            let mut parts = Vec::with_capacity(1);
            while let Some(at) = self.turns.get(turn).filter(|at| **at < start + self.length(place))
            {
                parts.push(MonotonePart { coefficients: self.of(place), ends: [from, at - start] });
                from = at - start;
                turn += 1;
            }
            parts.push(MonotonePart {
                coefficients: self.of(place),
                ends: [from, self.length(place)],
            });
            parts
        })
    }

    fn of(&self, place: usize) -> &[f64] {
        &self.coefficients[self.offsets[place]..self.offsets[place + 1]]
    }

    fn length(&self, place: usize) -> f64 {
        self.starts.get(place + 1).copied().unwrap_or(self.period) - self.starts[place]
    }

    fn find_turns(&mut self) {
        let mut turns = Vec::new();
        let [mut least, mut largest] = self.range;
        for place in 0..self.starts.len() {
            let (own, length) = (self.of(place), self.length(place));
            let slope = |x: f64| slope_of(own, x);
            let at = |i: usize| length * i as f64 / SAMPLES as f64;
            let mut take = |x: f64| {
                let value = value_of(own, x);
                (least, largest) = (least.min(value), largest.max(value));
            };
            take(0.0);
            take(length);
            for i in 0..SAMPLES {
                let changes = (slope(at(i)) > 0.0) != (slope(at(i + 1)) > 0.0);
                if !changes {
                    continue;
                }
                if let Ok(root) = find_root(slope, at(i), at(i + 1), Closeness::default()) {
                    take(root.location);
                    if root.location > 0.0 && root.location < length {
                        turns.push(self.starts[place] + root.location);
                    }
                }
            }
        }
        (self.turns, self.range) = (turns, [least, largest]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_sums_and_jumps() {
        let starts: Arc<[f64]> = vec![0.0, 1.0].into();
        let tooth =
            PeriodicPolynomial::new(2.0, Arc::clone(&starts), &[vec![0.0, 1.0], vec![1.0, -1.0]]);
        let slope = tooth.derivative();
        assert_eq!((slope.range(), slope.root_mean_square()), ([-1.0, 1.0], 1.0));
        assert_eq!((slope.largest_jump(), tooth.largest_jump()), (2.0, 0.0));
        let square = PeriodicPolynomial::new(2.0, starts, &[vec![1.0], vec![-1.0]]);
        assert_eq!(square.derivative().range(), [0.0, 0.0]);
        // 2 x + 3 on the first half, 2 (1 − x) − 3 on the second.
        let sum = tooth.combined(2.0, 3.0, &square);
        assert_eq!((sum.range(), sum.value_and_slope(0.5)), ([-3.0, 5.0], (4.0, 2.0)));
        assert!((tooth.root_mean_square() - (1.0_f64 / 3.0).sqrt()).abs() < 1e-15);
    }
}
