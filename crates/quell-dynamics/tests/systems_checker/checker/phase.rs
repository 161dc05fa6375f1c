//! Motion with fixed modes on a fine grid of time, until the first guard vanishes.

use super::Unchecked;
use super::decision::TOO_CLOSE;
use super::equations::{Drive, Equations, Instant, Mode};
use super::extrapolation::Extrapolation;
use super::guards::Guard;

/// Longest step of the grid.
const LONGEST: f64 = 0.01;

/// The first and the last steps of a phase are shorter by this factor, doubled from one step to the next.
const SHORTENED: f64 = 64.0;

/// Number of intervals into which a step with a change of sign is divided to find the first root.
const DIVISIONS: u32 = 8;

/// Events closer than this are too close to be compared.
pub(super) const APART: f64 = 1e-7;

/// Roots closer than this are one moment.
const TOGETHER: f64 = 1e-11;

/// Guards that cross zero more slowly than this leave the time of the event uncertain.
const SLOWEST: f64 = 1e-4;

/// Larger entries of the state end a run.
const LARGEST: f64 = 1e6;

/// A time, the state, and the values of the guards.
#[derive(Clone, Debug)]
pub(super) struct Point {
    /// Time.
    pub(super) time: f64,
    /// State.
    pub(super) state: Vec<f64>,
    /// Values of the guards, in their order.
    values: Vec<f64>,
}

/// How a phase ends.
#[derive(Debug)]
pub(super) struct Ended {
    /// Where.
    pub(super) point: Point,
    /// The guards that vanish there; none at the end of the interval.
    pub(super) triggers: Vec<Guard>,
}

/// Motion with fixed modes.
#[derive(Debug)]
pub(super) struct Phase<'a> {
    equations: &'a Equations<'a>,
    drive: &'a Drive,
    modes: &'a [Mode],
    guards: Vec<Guard>,
    method: Extrapolation,
    instant: Instant,
}

/// A zero of a guard.
#[derive(Debug)]
struct Root {
    guard: usize,
    time: f64,
    /// A point before it from which it was found.
    base: Point,
}

impl<'a> Phase<'a> {
    /// Motion with these modes between two breaks.
    pub(super) fn new(equations: &'a Equations<'a>, drive: &'a Drive, modes: &'a [Mode]) -> Self {
        Self {
            equations,
            drive,
            modes,
            guards: Guard::all(equations, modes),
            method: Extrapolation::new(equations.size()),
            instant: equations.instant(),
        }
    }

    /// Runs to the first event, or to the time `end`.
    ///
    /// The guards of `fresh` contacts may start at zero; they leave it.
    ///
    /// # Errors
    /// If guards are so close to zero, or events so close together, that a comparison would be meaningless.
    pub(super) fn run(
        &mut self,
        start: (f64, &[f64]),
        fresh: &[bool],
        end: f64,
    ) -> Result<Ended, Unchecked> {
        let mut current = self.point(start.0, start.1.to_vec());
        for (guard, value) in self.guards.iter().zip(&current.values) {
            if *value < TOO_CLOSE && !fresh[guard.contact] {
                return ambiguous(format!("{guard:?} starts at {value:e} at {}", current.time));
            }
        }
        let mut before: Option<Point> = None;
        let mut step = LONGEST / SHORTENED;
        while current.time < end {
            let next = self.to(&current, stop(current.time, step, end));
            self.check(&next)?;
            let mut roots = Vec::new();
            if let Some(before) = &before {
                self.dips([before, &current, &next], &mut roots)?;
            }
            for guard in 0..self.guards.len() {
                if next.values[guard] <= 0.0 {
                    roots.push(self.first_root(&current, next.time, guard, before.is_none())?);
                }
            }
            if !roots.is_empty() {
                return self.event(before, &current, roots);
            }
            before = Some(std::mem::replace(&mut current, next));
            step = (2.0 * step).min(LONGEST);
        }
        if let Some(value) = current.values.iter().find(|value| **value < TOO_CLOSE) {
            return ambiguous(format!("a guard ends at {value:e} at {end}"));
        }
        Ok(Ended { point: current, triggers: Vec::new() })
    }

    /// The earliest of some roots, with all guards that vanish there.
    fn event(
        &mut self,
        before: Option<Point>,
        current: &Point,
        mut roots: Vec<Root>,
    ) -> Result<Ended, Unchecked> {
        let first =
            |roots: &[Root]| roots.iter().map(|root| root.time).fold(f64::INFINITY, f64::min);
        let time = first(&roots);
        if time > current.time {
            // What the grid would have shown after this step: dips between the current point and the event.
            let mut points: Vec<Point> = before.into_iter().collect();
            points.push(current.clone());
            for part in 1..DIVISIONS {
                let fraction = f64::from(part) / f64::from(DIVISIONS);
                points.push(self.to(current, current.time + fraction * (time - current.time)));
            }
            for triple in points.windows(3) {
                self.dips([&triple[0], &triple[1], &triple[2]], &mut roots)?;
            }
        }
        let time = first(&roots);
        let mut triggers = Vec::new();
        let mut base = None;
        for root in roots {
            if root.time - time <= TOGETHER {
                triggers.push(self.guards[root.guard]);
                base = Some(root.base);
            } else if root.time - time <= APART {
                return ambiguous(format!("two events at {time}"));
            }
        }
        let base = base.expect("the earliest root");
        Ok(Ended { point: self.to(&base, time), triggers })
    }

    /// Finds the roots of guards that are positive at three consecutive points and negative between them.
    fn dips(&mut self, points: [&Point; 3], roots: &mut Vec<Root>) -> Result<(), Unchecked> {
        for guard in 0..self.guards.len() {
            let [left, middle, right] = points.map(|point| point.values[guard]);
            let lowest = middle < left && middle <= right && middle > 0.0;
            // A smooth guard whose values differ less than they are away from zero does not reach it.
            if !lowest || middle > 4.0 * (left.max(right) - middle) {
                continue;
            }
            let low = self.minimum(points[0], points[2].time, guard);
            if low.values[guard].abs() < TOO_CLOSE {
                return ambiguous(format!("{:?} grazes zero at {}", self.guards[guard], low.time));
            }
            if low.values[guard] < 0.0 {
                roots.push(self.first_root(points[0], low.time, guard, false)?);
            }
        }
        Ok(())
    }

    /// The minimum of a guard between a point and a time, by the golden section.
    fn minimum(&mut self, base: &Point, to: f64, guard: usize) -> Point {
        let section = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut from, mut to) = (base.time, to);
        let mut left = self.to(base, to - section * (to - from));
        let mut right = self.to(base, from + section * (to - from));
        while to - from > 1e-9 {
            if left.values[guard] < right.values[guard] {
                to = right.time;
                right = left;
                left = self.to(base, to - section * (to - from));
            } else {
                from = left.time;
                left = right;
                right = self.to(base, from + section * (to - from));
            }
        }
        left
    }

    /// The first zero of a guard between a point where it is positive, or starts from zero, and a time where it is not.
    fn first_root(
        &mut self,
        base: &Point,
        end: f64,
        guard: usize,
        first: bool,
    ) -> Result<Root, Unchecked> {
        let mut from = base.time;
        let mut above = base.values[guard];
        if first {
            from += APART;
            above = self.to(base, from).values[guard];
        }
        if above <= 0.0 {
            return ambiguous(format!("{:?} vanishes again at {from}", self.guards[guard]));
        }
        let width = (end - from) / f64::from(DIVISIONS);
        for part in 1..=DIVISIONS {
            let to = if part == DIVISIONS { end } else { from + width };
            let below = self.to(base, to).values[guard];
            if below <= 0.0 {
                let time = self.root(base, guard, (from, above), (to, below));
                self.check_slope(base, guard, time)?;
                return Ok(Root { guard, time, base: base.clone() });
            }
            (from, above) = (to, below);
        }
        unreachable!("the guard is not positive at the end")
    }

    /// The zero of a guard in a bracket, by secants, and by bisection where a secant leaves the bracket.
    fn root(&mut self, base: &Point, guard: usize, above: (f64, f64), below: (f64, f64)) -> f64 {
        let (mut above, mut below) = (above, below);
        let (mut older, mut newer) = (above, below);
        for _ in 0..100 {
            let secant = newer.0 - newer.1 * (newer.0 - older.0) / (newer.1 - older.1);
            let inside = secant > above.0 && secant < below.0;
            let time = if inside { secant } else { 0.5 * (above.0 + below.0) };
            let resolution = 2.0 * f64::EPSILON * time.max(1.0);
            if (time - newer.0).abs() <= resolution || below.0 - above.0 <= resolution {
                return time;
            }
            let value = self.to(base, time).values[guard];
            (older, newer) = (newer, (time, value));
            if value > 0.0 {
                above = newer;
            } else {
                below = newer;
            }
        }
        0.5 * (above.0 + below.0)
    }

    /// Refuses a zero that a guard crosses so slowly that its time is uncertain.
    fn check_slope(&mut self, base: &Point, guard: usize, time: f64) -> Result<(), Unchecked> {
        let half = (0.5 * (time - base.time)).min(1e-6);
        let after = self.to(base, time + half).values[guard];
        let slope = (after - self.to(base, time - half).values[guard]) / (2.0 * half);
        if slope > -SLOWEST {
            return ambiguous(format!("{:?} crosses zero slowly at {time}", self.guards[guard]));
        }
        Ok(())
    }

    /// Refuses states out of bounds and prescribed loads that are not positive.
    fn check(&self, point: &Point) -> Result<(), Unchecked> {
        let fail = |why: &str| Err(Unchecked::Failed(format!("{why} at {}", point.time)));
        let bounded = |value: &f64| value.is_finite() && value.abs() < LARGEST;
        if !point.state.iter().all(bounded) || point.values.iter().any(|value| value.is_nan()) {
            return fail("the state grows without bound");
        }
        for (c, contact) in self.equations.system.contacts.iter().enumerate() {
            if contact.normal.is_none() && self.instant.load[c] <= 0.0 {
                return fail("a prescribed load is not positive");
            }
        }
        Ok(())
    }

    /// The point at a time after another one.
    fn to(&mut self, from: &Point, time: f64) -> Point {
        let mut state = from.state.clone();
        let Self { equations, drive, modes, method, instant, .. } = self;
        let mut rate = |time: f64, state: &[f64], rate: &mut [f64]| {
            equations.evaluate(drive, time, state, modes, instant);
            rate.copy_from_slice(&instant.rate);
        };
        method.advance(&mut rate, from.time, time, &mut state);
        self.point(time, state)
    }

    /// The point of a state.
    fn point(&mut self, time: f64, state: Vec<f64>) -> Point {
        self.equations.evaluate(self.drive, time, &state, self.modes, &mut self.instant);
        let value = |guard: &Guard| guard.value(self.equations, &self.instant);
        let values = self.guards.iter().map(value).collect();
        Point { time, state, values }
    }
}

/// The end of a step of the grid: steps shorten again before the end of the interval.
fn stop(time: f64, step: f64, end: f64) -> f64 {
    let left = end - time;
    if left <= LONGEST / SHORTENED { end } else { time + step.min(0.5 * left) }
}

/// The result of a comparison that would be meaningless.
fn ambiguous<T>(why: String) -> Result<T, Unchecked> {
    Err(Unchecked::Ambiguous(why))
}
