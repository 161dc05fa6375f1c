//! Taylor coefficients of a formula along a slip, by one bilinear recurrence for every step.
//!
//! With X = a x + b and Y = c y + d each step's series u obeys, for k ≥ 1,
//!
//! ```text
//! uₖ = α xₖ + β yₖ + γ Σ pⱼqₖ₋ⱼ        (or  γ/k Σ j pⱼqₖ₋ⱼ),   j = 1…k−1
//! ```
//!
//! | step | α | β | γ | p, q |
//! |---|---|---|---|---|
//! | X + Y | a | c | 0 | |
//! | X Y | a Y₀ | c X₀ | a c | x, y |
//! | X/Y | a/Y₀ | −u₀c/Y₀ | −c/Y₀ | y, u |
//! | e^X | a u₀ | | a | j x, u |
//! | log X | a/X₀ | | −a/X₀ | j u, x |
//! | √X | a/(2u₀) | | −1/(2u₀) | u, u |
//! | tanh X, s = 1 − u² | a s₀; s: −2u₀ on u | | a; −1 | j x, s; u, u |
//! | sin X, cos X | a cos; −a sin | | a; −a | j x, the other |
//! | atan X, q = 1 + X² | a/q₀; q: 2aX₀ | | −1/q₀; a² | j u, q; x, x |
//!
//! so that uₖ = u′(w₀)wₖ + (a part of lower orders), as the engine wants it.

use quell_numerics::elementary;
use quell_numerics::lane::{Lane, partial_product};

use super::program::{Argument, MOST_SLOTS, Program, Step};
use crate::friction::{BranchSeries, length_of_change, longest_change};

/// What a slot's recurrence sums.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sum {
    Nothing,
    /// Σ pⱼqₖ₋ⱼ.
    Plain(usize, usize),
    /// Σ j pⱼqₖ₋ⱼ / k.
    Weighted(usize, usize),
}

/// The recurrence of a slot, without its numbers.
#[derive(Clone, Copy, Debug)]
struct Rule {
    x: usize,
    y: Option<usize>,
    sum: Sum,
    /// How many times the change of x, times the constant of this place, a step may not exceed.
    guard: Option<(f64, usize)>,
}

/// α, β, γ of a slot.
type Coefficients<V> = [V; 3];

/// Value and slope in the slip speed of each slot, and the numbers of its recurrence.
struct Start<'s, V> {
    value: &'s mut [V],
    slope: &'s mut [V],
    coefficients: &'s mut [Coefficients<V>],
}

impl<V: Lane> Start<'_, V> {
    /// Fills every slot from the slip speed in slot 0.
    #[inline(always)]
    fn fill(&mut self, program: &Program, constants: &[V]) {
        let mut slot = 1;
        for step in &program.steps {
            self.step(*step, slot, constants);
            slot += step.slots();
        }
    }

    #[inline(always)]
    fn set(&mut self, slot: usize, value: V, of: (usize, usize), coefficients: Coefficients<V>) {
        let [alpha, beta, _] = coefficients;
        self.value[slot] = value;
        self.slope[slot] = alpha.mul_add(self.slope[of.0], beta * self.slope[of.1]);
        self.coefficients[slot] = coefficients;
    }

    #[inline(always)]
    fn step(&mut self, step: Step, slot: usize, constants: &[V]) {
        let zero = V::splat(0.0);
        let one = V::splat(1.0);
        let at = |start: &Self, it: Argument| {
            let factor = constants[it.factor];
            (factor.mul_add(start.value[it.slot], constants[it.offset]), factor)
        };
        match step {
            Step::Sum(x, y) => {
                let ((first, a), (second, c)) = (at(self, x), at(self, y));
                self.set(slot, first + second, (x.slot, y.slot), [a, c, zero]);
            }
            Step::Product(x, y) => {
                let ((first, a), (second, c)) = (at(self, x), at(self, y));
                let numbers = [a * second, c * first, a * c];
                self.set(slot, first * second, (x.slot, y.slot), numbers);
            }
            Step::Quotient(x, y) => {
                let ((first, a), (second, c)) = (at(self, x), at(self, y));
                let value = first.zip(second, |x, y| x / y);
                let inverse = second.map(|y| 1.0 / y);
                let by = -(c * inverse);
                self.set(slot, value, (x.slot, y.slot), [a * inverse, value * by, by]);
            }
            Step::Exp(x) => {
                let (argument, a) = at(self, x);
                let value = elementary::exp(argument.min(V::splat(EXP_CEILING)));
                self.set(slot, value, (x.slot, 0), [a * value, zero, a]);
            }
            Step::Log(x) => {
                let (argument, a) = at(self, x);
                let by = argument.zip(a, |x, a| a / x);
                self.set(slot, argument.map(libm::log), (x.slot, 0), [by, zero, -by]);
            }
            Step::Sqrt(x) => {
                let (argument, a) = at(self, x);
                let value = argument.map(libm::sqrt);
                let by = value.map(|u| 0.5 / u);
                self.set(slot, value, (x.slot, 0), [a * by, zero, -by]);
            }
            Step::Tanh(x) => {
                let (argument, a) = at(self, x);
                let value = argument.map(libm::tanh);
                // 1 − tanh² without cancellation.
                let rest = argument.map(|x| {
                    let inverse = 1.0 / libm::cosh(x);
                    inverse * inverse
                });
                self.set(slot, value, (x.slot, 0), [a * rest, zero, a]);
                self.set(slot + 1, rest, (slot, 0), [-(value + value), zero, -one]);
            }
            Step::Sine(x) => {
                let (argument, a) = at(self, x);
                let (sine, cosine) = (argument.map(libm::sin), argument.map(libm::cos));
                self.set(slot, sine, (x.slot, 0), [a * cosine, zero, a]);
                self.set(slot + 1, cosine, (x.slot, 0), [-(a * sine), zero, -a]);
            }
            Step::Atan(x) => {
                let (argument, a) = at(self, x);
                let square = argument.mul_add(argument, one);
                let inverse = square.map(|q| 1.0 / q);
                let value = argument.map(libm::atan);
                self.set(slot, value, (x.slot, 0), [a * inverse, zero, -inverse]);
                let twice = argument + argument;
                self.set(slot + 1, square, (x.slot, 0), [a * twice, zero, a * a]);
            }
        }
    }
}

/// Above this the exponential is held at e^709; such a law is refused where it is made.
const EXP_CEILING: f64 = 709.0;

/// Value and slope of the output per unit of slot 0.
#[inline(always)]
fn output<V: Lane>(program: &Program, constants: &[V], value: &[V], slope: &[V]) -> (V, V) {
    let Argument { slot, factor, offset } = program.output;
    let factor = constants[factor];
    (factor.mul_add(value[slot], constants[offset]), factor * slope[slot])
}

/// Coefficient and its slope at a slip speed, in the unit of the formula.
#[inline]
pub(super) fn at_speed(program: &Program, constants: &[f64], speed: f64) -> (f64, f64) {
    let (mut value, mut slope) = ([0.0; MOST_SLOTS], [0.0; MOST_SLOTS]);
    let mut coefficients = [[0.0; 3]; MOST_SLOTS];
    (value[0], slope[0]) = (speed, 1.0);
    let mut start = Start { value: &mut value, slope: &mut slope, coefficients: &mut coefficients };
    start.fill(program, constants);
    output(program, constants, &value, &slope)
}

/// Rules of the slots, slot 0 without any.
fn rules(program: &Program) -> Vec<Rule> {
    let mut rules = vec![Rule { x: 0, y: None, sum: Sum::Nothing, guard: None }];
    for step in &program.steps {
        let slot = rules.len();
        let one = |x: Argument, sum| Rule { x: x.slot, y: None, sum, guard: None };
        let two = |x: Argument, y: Argument, sum| Rule { y: Some(y.slot), ..one(x, sum) };
        let guarded =
            |x: Argument, sum, times| Rule { guard: Some((times, x.factor)), ..one(x, sum) };
        match *step {
            Step::Sum(x, y) => rules.push(two(x, y, Sum::Nothing)),
            Step::Product(x, y) => rules.push(two(x, y, Sum::Plain(x.slot, y.slot))),
            Step::Quotient(x, y) => rules.push(two(x, y, Sum::Plain(y.slot, slot))),
            Step::Exp(x) => rules.push(guarded(x, Sum::Weighted(x.slot, slot), 1.0)),
            Step::Log(x) => rules.push(one(x, Sum::Weighted(slot, x.slot))),
            Step::Sqrt(x) => rules.push(one(x, Sum::Plain(slot, slot))),
            Step::Tanh(x) => {
                // 1 − tanh² falls as e^(−2|X|).
                rules.push(guarded(x, Sum::Weighted(x.slot, slot + 1), 2.0));
                let u = Argument { slot, ..x };
                rules.push(one(u, Sum::Plain(slot, slot)));
            }
            Step::Sine(x) => {
                rules.push(guarded(x, Sum::Weighted(x.slot, slot + 1), 1.0));
                rules.push(one(x, Sum::Weighted(x.slot, slot)));
            }
            Step::Atan(x) => {
                rules.push(one(x, Sum::Weighted(slot, slot + 1)));
                rules.push(one(x, Sum::Plain(x.slot, x.slot)));
            }
        }
    }
    rules
}

/// A formula with its constants in each lane, and the memory of its recurrence.
#[derive(Debug)]
pub struct ExpressionConstants<V> {
    program: std::sync::Arc<Program>,
    rules: Vec<Rule>,
    /// Constants of the steps.
    constants: Vec<V>,
    /// Slip speed in the unit of the formula per unit of scaled slip.
    scale: V,
    value: Vec<V>,
    slope: Vec<V>,
    lower: Vec<V>,
    coefficients: Vec<Coefficients<V>>,
    /// Slot by slot, as many orders as the last recurrence had.
    series: Vec<V>,
    /// j xⱼ of the first factor of weighted sums, likewise.
    rates: Vec<V>,
}

impl<V: Lane> ExpressionConstants<V> {
    pub(super) fn new(program: std::sync::Arc<Program>, constants: Vec<V>, scale: V) -> Self {
        let zeros = vec![V::splat(0.0); program.slots];
        Self {
            rules: rules(&program),
            constants,
            scale,
            value: zeros.clone(),
            slope: zeros.clone(),
            lower: zeros,
            coefficients: vec![[V::splat(0.0); 3]; program.slots],
            series: Vec::new(),
            rates: Vec::new(),
            program,
        }
    }

    /// Starts the recurrence at scaled slip `w0` on the branch of `sign`.
    #[inline(always)]
    pub(super) fn start<const N: usize>(&mut self, sign: V, w0: V) -> ExpressionSeries<'_, V, N> {
        let length = self.value.len() * N;
        if self.series.len() != length {
            self.series = vec![V::splat(0.0); length];
            self.rates = vec![V::splat(0.0); length];
        }
        self.value[0] = sign * w0 * self.scale;
        self.slope[0] = self.scale;
        let mut start = Start {
            value: &mut self.value,
            slope: &mut self.slope,
            coefficients: &mut self.coefficients,
        };
        start.fill(&self.program, &self.constants);
        let (first, slope) = output(&self.program, &self.constants, &self.value, &self.slope);
        // Along scaled slip of this sign; slot 0 is the speed.
        for own in &mut self.slope {
            *own = *own * sign;
        }
        ExpressionSeries { law: self, sign, first: sign * first, slope, complete: 0 }
    }
}

/// Recurrence of a formula.
#[derive(Debug)]
pub struct ExpressionSeries<'c, V, const N: usize> {
    law: &'c mut ExpressionConstants<V>,
    sign: V,
    first: V,
    slope: V,
    /// Orders of every slot that are complete, order 0 apart.
    complete: usize,
}

impl<V: Lane, const N: usize> ExpressionSeries<'_, V, N> {
    /// The series of a slot.
    #[inline(always)]
    fn slot(of: &[V], slot: usize) -> &[V; N] {
        let row = of.get(slot * N..).and_then(<[V]>::first_chunk::<N>);
        // UNWRAP: `start` gives every slot a row of N.
        row.unwrap()
    }

    /// Completes order k − 1 of every slot.
    #[inline(always)]
    fn complete(&mut self, k: usize, w: &[V]) {
        let law = &mut *self.law;
        let (newest, order) = (w[k - 1], V::splat((k - 1) as f64));
        for (slot, rule) in law.rules.iter().enumerate() {
            law.series[slot * N + k - 1] = law.slope[slot].mul_add(newest, law.lower[slot]);
            // A weighted sum's first factor is an earlier slot or this one: complete by now.
            if let Sum::Weighted(p, _) = rule.sum {
                law.rates[slot * N + k - 1] = order * law.series[p * N + k - 1];
            }
        }
        self.complete = k - 1;
    }
}

impl<V: Lane, const N: usize> BranchSeries<V> for ExpressionSeries<'_, V, N> {
    #[inline(always)]
    fn first(&self) -> V {
        self.first
    }

    #[inline(always)]
    fn slope(&self) -> V {
        self.slope
    }

    #[inline(always)]
    fn lower(&mut self, k: usize, w: &[V]) -> V {
        if k > 1 {
            self.complete(k, w);
        }
        let law = &mut *self.law;
        law.lower[0] = V::splat(0.0);
        for (slot, rule) in law.rules.iter().enumerate().skip(1) {
            let [alpha, beta, gamma] = law.coefficients[slot];
            let mut lower = alpha * law.lower[rule.x];
            if let Some(y) = rule.y {
                lower = beta.mul_add(law.lower[y], lower);
            }
            if k > 1 {
                let sum = match rule.sum {
                    Sum::Nothing => None,
                    Sum::Plain(p, q) => {
                        Some((Self::slot(&law.series, p), Self::slot(&law.series, q), gamma))
                    }
                    Sum::Weighted(_, q) => {
                        let by = gamma * V::splat(1.0 / k as f64);
                        Some((Self::slot(&law.rates, slot), Self::slot(&law.series, q), by))
                    }
                };
                if let Some((p, q, by)) = sum {
                    lower = by.mul_add(partial_product(p, q, k, 1, k - 1), lower);
                }
            }
            law.lower[slot] = lower;
        }
        let Argument { slot, factor, .. } = law.program.output;
        self.sign * (law.constants[factor] * law.lower[slot])
    }

    #[inline(always)]
    fn trusted(&self, w: &[V], length: V) -> V {
        let most = longest_change(w.len() - 1);
        let mut trusted = length;
        for rule in &self.law.rules {
            if let Some((times, factor)) = rule.guard {
                let by = self.law.constants[factor] * V::splat(times);
                let mut change = [V::splat(0.0); N];
                // The orders beyond are those that the step's length keeps below the tolerance.
                let known = Self::slot(&self.law.series, rule.x);
                for k in 1..=self.complete {
                    change[k] = by * known[k];
                }
                trusted = length_of_change(&change, trusted, most);
            }
        }
        trusted
    }
}
