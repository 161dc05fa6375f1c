//! Taylor coefficients of a formula along a slip, by one bilinear recurrence per step.
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
//! so that uₖ = u′(w₀)wₖ + (a part of lower orders), as the engine requires.

use quell_numerics::elementary;
use quell_numerics::lane::{Lane, half_inner_square, partial_product};

use super::program::{Argument, MOST_SLOTS, Program, Step};
use crate::friction::BranchSeries;
use crate::friction::series::{length_of_change, longest_change};

/// The sum in the recurrence of a slot.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sum {
    Nothing,
    /// Σ pⱼqₖ₋ⱼ.
    Plain(usize, usize),
    /// Σ pⱼpₖ₋ⱼ.
    Square(usize),
    /// Σ j pⱼqₖ₋ⱼ / k.
    Weighted(usize, usize),
}

/// The recurrence of a slot, without its numbers.
#[derive(Clone, Copy, Debug)]
struct Rule {
    x: usize,
    y: Option<usize>,
    sum: Sum,
    /// Limits a step: the change of x times this factor and the constant with this index must stay bounded.
    guard: Option<(f64, usize)>,
}

/// α, β, γ of a slot.
type Coefficients<V> = [V; 3];

/// A slot at the start of a step, with the values for its recurrence.
#[derive(Clone, Copy, Debug)]
struct Slot<V> {
    value: V,
    /// Slope in the slip speed; along the slip itself once the recurrence has begun.
    slope: V,
    /// uₖ without its part in wₖ, for the last k.
    lower: V,
    coefficients: Coefficients<V>,
}

impl<V: Lane> Slot<V> {
    fn zero() -> Self {
        let zero = V::splat(0.0);
        Self { value: zero, slope: zero, lower: zero, coefficients: [zero; 3] }
    }
}

/// The slots while they are being filled.
struct SlotFiller<'s, V> {
    slots: &'s mut [Slot<V>],
}

impl<V: Lane> SlotFiller<'_, V> {
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
        let slope = alpha.mul_add(self.slots[of.0].slope, beta * self.slots[of.1].slope);
        let lower = V::splat(0.0);
        self.slots[slot] = Slot { value, slope, lower, coefficients };
    }

    #[inline(always)]
    fn step(&mut self, step: Step, slot: usize, constants: &[V]) {
        let zero = V::splat(0.0);
        let one = V::splat(1.0);
        let at = |start: &Self, argument: Argument| {
            let factor = constants[argument.factor];
            (factor.mul_add(start.slots[argument.slot].value, constants[argument.offset]), factor)
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

/// Above this the exponential is held at e^709; such a law is rejected when it is built.
const EXP_CEILING: f64 = 709.0;

/// Value and slope of the output per unit of slot 0.
#[inline(always)]
fn output<V: Lane>(program: &Program, constants: &[V], slots: &[Slot<V>]) -> (V, V) {
    let (mut value, mut slope) = (constants[program.offset], V::splat(0.0));
    for &(slot, factor) in &program.output {
        let (factor, slot) = (constants[factor], slots[slot]);
        value = factor.mul_add(slot.value, value);
        slope = factor.mul_add(slot.slope, slope);
    }
    (value, slope)
}

/// Coefficient and its slope at a slip speed, in the unit of the formula.
#[inline]
pub(super) fn at_speed(program: &Program, constants: &[f64], speed: f64) -> (f64, f64) {
    let mut slots = [Slot::zero(); MOST_SLOTS];
    (slots[0].value, slots[0].slope) = (speed, 1.0);
    SlotFiller { slots: &mut slots }.fill(program, constants);
    output(program, constants, &slots)
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
            Step::Product(x, y) if x.slot == y.slot => {
                rules.push(two(x, y, Sum::Square(x.slot)));
            }
            Step::Product(x, y) => rules.push(two(x, y, Sum::Plain(x.slot, y.slot))),
            Step::Quotient(x, y) => rules.push(two(x, y, Sum::Plain(y.slot, slot))),
            Step::Exp(x) => rules.push(guarded(x, Sum::Weighted(x.slot, slot), 1.0)),
            Step::Log(x) => rules.push(one(x, Sum::Weighted(slot, x.slot))),
            Step::Sqrt(x) => rules.push(one(x, Sum::Square(slot))),
            Step::Tanh(x) => {
                // 1 − tanh² falls as e^(−2|X|).
                rules.push(guarded(x, Sum::Weighted(x.slot, slot + 1), 2.0));
                let u = Argument { slot, ..x };
                rules.push(one(u, Sum::Square(slot)));
            }
            Step::Sine(x) => {
                rules.push(guarded(x, Sum::Weighted(x.slot, slot + 1), 1.0));
                rules.push(one(x, Sum::Weighted(x.slot, slot)));
            }
            Step::Atan(x) => {
                rules.push(one(x, Sum::Weighted(slot, slot + 1)));
                rules.push(one(x, Sum::Square(x.slot)));
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
    slots: Vec<Slot<V>>,
    /// Slot by slot, as many orders as the last recurrence had.
    series: Vec<V>,
    /// j pⱼ of the first factor of weighted sums, likewise.
    rates: Vec<V>,
}

impl<V: Lane> ExpressionConstants<V> {
    pub(super) fn new(program: std::sync::Arc<Program>, constants: Vec<V>, scale: V) -> Self {
        Self {
            rules: rules(&program),
            constants,
            scale,
            slots: vec![Slot::zero(); program.slots],
            series: Vec::new(),
            rates: Vec::new(),
            program,
        }
    }

    /// Starts the recurrence at scaled slip `w0` on the branch of `sign`.
    #[inline(always)]
    pub(super) fn start<const N: usize>(&mut self, sign: V, w0: V) -> ExpressionSeries<'_, V, N> {
        let length = self.slots.len() * N;
        if self.series.len() != length {
            self.series = vec![V::splat(0.0); length];
            self.rates = vec![V::splat(0.0); length];
        }
        self.slots[0].value = sign * w0 * self.scale;
        self.slots[0].slope = self.scale;
        SlotFiller { slots: &mut self.slots }.fill(&self.program, &self.constants);
        let (first, slope) = output(&self.program, &self.constants, &self.slots);
        // Along scaled slip of this sign; slot 0 is the speed.
        for slot in &mut self.slots {
            slot.slope = slot.slope * sign;
        }
        ExpressionSeries { law: self, sign, first: sign * first, slope }
    }
}

/// Recurrence of a formula.
#[derive(Debug)]
pub struct ExpressionSeries<'c, V, const N: usize> {
    law: &'c mut ExpressionConstants<V>,
    sign: V,
    first: V,
    slope: V,
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
        let ExpressionConstants { program, rules, constants, slots, series, rates, .. } =
            &mut *self.law;
        let (series, _) = series.as_chunks_mut::<N>();
        let (rates, _) = rates.as_chunks_mut::<N>();
        let rules = &rules[..];
        let slots = &mut slots[..rules.len()];
        if k > 1 {
            // Completes order k − 1 of every slot.
            let (newest, order) = (w[k - 1], V::splat((k - 1) as f64));
            for at in 0..rules.len() {
                series[at][k - 1] = slots[at].slope.mul_add(newest, slots[at].lower);
                // A weighted sum's first factor is an earlier slot or this one: complete by now.
                if let Sum::Weighted(p, _) = rules[at].sum {
                    rates[at][k - 1] = order * series[p][k - 1];
                }
            }
        }
        for at in 1..rules.len() {
            let rule = &rules[at];
            let [alpha, beta, gamma] = slots[at].coefficients;
            let mut lower = alpha * slots[rule.x].lower;
            if let Some(y) = rule.y {
                lower = beta.mul_add(slots[y].lower, lower);
            }
            if k > 1 {
                lower = match rule.sum {
                    Sum::Nothing => lower,
                    Sum::Plain(p, q) => {
                        let sum = partial_product(&series[p], &series[q], k, 1, k - 1);
                        gamma.mul_add(sum, lower)
                    }
                    Sum::Square(p) => {
                        let half = half_inner_square(&series[p], k);
                        gamma.mul_add(half + half, lower)
                    }
                    Sum::Weighted(_, q) => {
                        let sum = partial_product(&rates[at], &series[q], k, 1, k - 1);
                        (gamma * V::splat(1.0 / k as f64)).mul_add(sum, lower)
                    }
                };
            }
            slots[at].lower = lower;
        }
        let mut whole = V::splat(0.0);
        for &(slot, factor) in &program.output {
            whole = constants[factor].mul_add(slots[slot].lower, whole);
        }
        self.sign * whole
    }

    #[inline(always)]
    fn trusted(&self, w: &[V], length: V) -> V {
        let most = longest_change(w.len() - 1);
        let (series, _) = self.law.series.as_chunks::<N>();
        let mut trusted = length;
        for rule in &self.law.rules {
            if let Some((times, factor)) = rule.guard {
                // The last orders are those that the step's length keeps below the tolerance.
                let known = &series[rule.x][..N.saturating_sub(2)];
                let by = (self.law.constants[factor] * V::splat(times)).abs();
                trusted = length_of_change(known, by, trusted, most);
            }
        }
        trusted
    }
}
