//! A number over time, given at knots: straight or smooth between them.

use std::sync::Arc;

use quell_numerics::interval::RealInterval;

use crate::Invalid;

/// How the value passes from knot to knot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum KnotShape {
    /// Along a straight line.
    #[default]
    Linear,
    /// Along a cubic with slope zero at both knots.
    Smooth,
}

impl KnotShape {
    /// Both shapes.
    pub const ALL: &'static [Self] = &[Self::Linear, Self::Smooth];

    /// Name in a study file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Smooth => "smooth",
        }
    }

    /// The shape of a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|shape| shape.name() == name)
    }
}

/// A number over time, given at knots. Before the first knot it has the first value, after the last one the last. Two knots at one
/// time are a jump there; at that time the value is the one after it.
///
/// ```
/// use quell_model::profile::{KnotShape, Knots};
///
/// let stop = Knots::new(vec![10.0, 40.0], vec![0.3, 0.0], KnotShape::Linear)?;
/// assert_eq!(stop.value(5.0), 0.3);
/// assert_eq!(stop.value(25.0), 0.15);
/// assert_eq!(stop.value(50.0), 0.0);
/// # Ok::<(), quell_model::Invalid>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Knots {
    times: Arc<[f64]>,
    values: Arc<[f64]>,
    shape: KnotShape,
}

/// The piece between two knots, or before the first or after the last one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnotPiece {
    /// Its start; −∞ before the first knot.
    pub began: f64,
    /// Its end; ∞ after the last knot.
    pub ends: f64,
    /// Coefficients of the powers of the time since its start.
    pub coefficients: [f64; 4],
}

/// Largest number of knots.
pub const MOST_KNOTS: usize = 100_000;

impl Knots {
    /// From times in ascending order and one value for each.
    ///
    /// # Errors
    /// No knot or too many, lists of different lengths, a number that is not finite, times that go back, more than two knots at one
    /// time. The key of the error is `time` or `value`, with the place in the list.
    pub fn new(times: Vec<f64>, values: Vec<f64>, shape: KnotShape) -> Result<Self, Invalid> {
        let count = times.len();
        if count == 0 || count > MOST_KNOTS {
            let allowed = format!("a list of 1 to {MOST_KNOTS} times; got {count}");
            return Err(Invalid::new("time", count as f64, allowed));
        }
        if values.len() != count {
            let given = values.len();
            let allowed = format!("one value for each of the {count} times; got {given}");
            return Err(Invalid::new("value", given as f64, allowed));
        }
        for (place, time) in times.iter().enumerate() {
            let at = || format!("time[{place}]");
            if !time.is_finite() {
                return Err(Invalid::new(at(), *time, "a finite number"));
            }
            let Some(earlier) = place.checked_sub(1).map(|place| times[place]) else { continue };
            if *time < earlier {
                let allowed =
                    format!("at least the time before it, {earlier}: time does not go back");
                return Err(Invalid::new(at(), *time, allowed));
            }
            if place > 1 && *time == times[place - 2] {
                let allowed = "different from the two times before it: two knots at one time are a jump, a third has no meaning";
                return Err(Invalid::new(at(), *time, allowed));
            }
        }
        if let Some(place) = values.iter().position(|value| !value.is_finite()) {
            return Err(Invalid::new(format!("value[{place}]"), values[place], "a finite number"));
        }
        Ok(Self { times: times.into(), values: values.into(), shape })
    }

    /// Times of the knots, in ascending order.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Values at the knots.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Shape between the knots.
    pub fn shape(&self) -> KnotShape {
        self.shape
    }

    /// The first place where the value jumps, as its index in the list of times.
    pub fn first_jump(&self) -> Option<usize> {
        let same = |pair: usize| {
            self.times[pair] == self.times[pair + 1] && self.values[pair] != self.values[pair + 1]
        };
        (0..self.times.len() - 1).find(|pair| same(*pair)).map(|pair| pair + 1)
    }

    /// Smallest and largest value; both shapes stay between the values at their knots.
    pub fn range(&self) -> RealInterval {
        let least = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        RealInterval::new(least, most)
    }

    /// The knots with values of the opposite sign.
    #[must_use]
    pub fn reversed(&self) -> Self {
        self.scaled(-1.0)
    }

    /// The knots with values multiplied by a factor.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self { values: self.values.iter().map(|value| factor * value).collect(), ..self.clone() }
    }

    /// The knots in another unit of time, of which one unit of their own is `factor` > 0.
    #[must_use]
    pub fn in_time_unit(&self, factor: f64) -> Self {
        Self { times: self.times.iter().map(|time| factor * time).collect(), ..self.clone() }
    }

    /// Whether all values are equal.
    pub fn is_constant(&self) -> bool {
        let range = self.range();
        range.lower == range.upper
    }

    /// Number of pieces, those before the first and after the last knot included.
    pub fn pieces(&self) -> usize {
        self.times.len() + 1
    }

    /// Number of the piece that contains a time: knots at that time are passed.
    pub fn piece_at(&self, time: f64) -> usize {
        self.times.partition_point(|knot| *knot <= time)
    }

    /// A piece by its number: 0 is before the first knot.
    pub fn piece(&self, number: usize) -> KnotPiece {
        let last = self.times.len() - 1;
        let still = |value: f64| [value, 0.0, 0.0, 0.0];
        if number == 0 {
            let coefficients = still(self.values[0]);
            return KnotPiece { began: f64::NEG_INFINITY, ends: self.times[0], coefficients };
        }
        if number > last {
            let coefficients = still(self.values[last]);
            return KnotPiece { began: self.times[last], ends: f64::INFINITY, coefficients };
        }
        let (began, ends) = (self.times[number - 1], self.times[number]);
        let (from, to) = (self.values[number - 1], self.values[number]);
        let (length, rise) = (ends - began, to - from);
        let coefficients = if length == 0.0 {
            still(to)
        } else {
            match self.shape {
                KnotShape::Linear => [from, rise / length, 0.0, 0.0],
                KnotShape::Smooth => {
                    let second = 3.0 * rise / (length * length);
                    [from, 0.0, second, -2.0 * rise / (length * length * length)]
                }
            }
        };
        KnotPiece { began, ends, coefficients }
    }

    /// The value at a time.
    pub fn value(&self, time: f64) -> f64 {
        let piece = self.piece(self.piece_at(time));
        let since = if piece.began.is_finite() { time - piece.began } else { 0.0 };
        piece.value(since)
    }
}

impl KnotPiece {
    /// The value at a time after its start.
    pub fn value(&self, since: f64) -> f64 {
        let [a, b, c, d] = self.coefficients;
        d.mul_add(since, c).mul_add(since, b).mul_add(since, a)
    }

    /// Coefficients of the powers of the time after `since`.
    pub fn shifted(&self, since: f64) -> [f64; 4] {
        let [_, b, c, d] = self.coefficients;
        let slope = (3.0 * d).mul_add(since, 2.0 * c).mul_add(since, b);
        [self.value(since), slope, (3.0 * d).mul_add(since, c), d]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knots(shape: KnotShape) -> Knots {
        let times = vec![-1.0, 2.0, 2.0, 5.0];
        Knots::new(times, vec![1.0, 3.0, -2.0, 0.5], shape).expect("valid")
    }

    #[test]
    fn values_at_the_knots_between_them_and_beyond() {
        for shape in KnotShape::ALL {
            let knots = knots(*shape);
            for (time, value) in [
                (-7.0, 1.0),
                (-1.0, 1.0),
                (0.5, 2.0),
                (2.0, -2.0),
                (3.5, -0.75),
                (5.0, 0.5),
                (9.0, 0.5),
            ] {
                assert!((knots.value(time) - value).abs() < 1e-15, "{shape:?} {time}");
            }
            assert_eq!(knots.first_jump(), Some(2));
            assert_eq!(knots.range(), RealInterval::new(-2.0, 3.0));
        }
        assert!(knots(KnotShape::Smooth).piece(1).shifted(3.0)[1].abs() < 1e-15);
    }

    #[test]
    fn a_shifted_piece_is_the_same_polynomial() {
        let piece = knots(KnotShape::Smooth).piece(3);
        let shifted = KnotPiece { coefficients: piece.shifted(0.7), ..piece };
        for since in [0.0, 0.3, 1.9] {
            assert!((shifted.value(since) - piece.value(0.7 + since)).abs() < 1e-15);
        }
    }

    #[test]
    fn errors_name_their_place() {
        let key = |times: &[f64], values: &[f64]| {
            Knots::new(times.to_vec(), values.to_vec(), KnotShape::Linear).expect_err("wrong").key
        };
        assert_eq!(key(&[], &[]), "time");
        assert_eq!(key(&[0.0, 1.0], &[1.0]), "value");
        assert_eq!(key(&[0.0, 2.0, 1.0], &[1.0; 3]), "time[2]");
        assert_eq!(key(&[0.0, 0.0, 0.0], &[1.0, 2.0, 3.0]), "time[2]");
        assert_eq!(key(&[0.0, f64::NAN], &[1.0, 2.0]), "time[1]");
        assert_eq!(key(&[0.0, 1.0], &[1.0, f64::INFINITY]), "value[1]");
    }
}
