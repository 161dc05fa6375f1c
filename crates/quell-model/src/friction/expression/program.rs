//! A formula as a list of steps, each of which has a recurrence for its Taylor coefficients.
//!
//! Terms that do not depend on v become constants; adding or multiplying by constants costs
//! nothing, because every step takes its arguments as a x + b. The structure depends only on the text, never
//! on the value of a constant, so that runs with different constants can share lanes.

use super::tree::{Function, Tree};
use super::unusable::UnusableFormula;

/// Maximum number of series of a formula.
pub(super) const MOST_SLOTS: usize = 32;

/// Largest power that is computed by products; others are exp(b log a).
pub(super) const LARGEST_POWER: f64 = 8.0;

/// a x + b: a series, and the places of a and b in the list of constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Argument {
    pub(super) slot: usize,
    pub(super) factor: usize,
    pub(super) offset: usize,
}

/// What a step computes from X and Y, each a series times a constant plus a constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    /// X + Y.
    Sum(Argument, Argument),
    /// X Y.
    Product(Argument, Argument),
    /// X/Y.
    Quotient(Argument, Argument),
    /// e^X.
    Exp(Argument),
    /// log X.
    Log(Argument),
    /// √X.
    Sqrt(Argument),
    /// tanh X, and 1 − tanh²X in the next slot.
    Tanh(Argument),
    /// sin X, and cos X in the next slot.
    Sine(Argument),
    /// atan X, and 1 + X² in the next slot.
    Atan(Argument),
}

impl Step {
    /// Number of series that it computes.
    pub(super) fn slots(self) -> usize {
        match self {
            Self::Tanh(_) | Self::Sine(_) | Self::Atan(_) => 2,
            _ => 1,
        }
    }
}

/// A compiled formula: slot 0 is the slip speed, each step fills the slots after it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Program {
    /// Constants of the steps, in terms of the named ones.
    pub(super) constants: Vec<Tree>,
    pub(super) steps: Vec<Step>,
    /// The coefficient: a sum of series, each by its slot and the place of its factor…
    pub(super) output: Vec<(usize, usize)>,
    /// …and of the constant of this place.
    pub(super) offset: usize,
    /// Number of series, slot 0 included.
    pub(super) slots: usize,
}

/// A part of the formula while it is compiled.
#[derive(Clone, Debug)]
enum FormulaPart {
    Constant(Tree),
    /// Σ a x + b, the series of different slots with their factors.
    Straight(Vec<(usize, Tree)>, Tree),
}

const ONE: Tree = Tree::Number(1.0);
const ZERO: Tree = Tree::Number(0.0);

fn sum(x: Tree, y: Tree) -> Tree {
    match (x, y) {
        (x, y) if x == ZERO => y,
        (x, y) if y == ZERO => x,
        (x, y) => Tree::Sum(Box::new(x), Box::new(y)),
    }
}

fn product(x: Tree, y: Tree) -> Tree {
    match (x, y) {
        (x, y) if x == ONE => y,
        (x, y) if y == ONE => x,
        (x, y) if x == ZERO || y == ZERO => ZERO,
        (x, y) => Tree::Product(Box::new(x), Box::new(y)),
    }
}

fn negative(x: Tree) -> Tree {
    if x == ZERO { ZERO } else { Tree::Negative(Box::new(x)) }
}

impl Program {
    /// Compiles a formula for the branch of `sign`: v = ±|v|, while slot 0 is |v| on both.
    ///
    /// # Errors
    /// A function that is not smooth where it is used, a formula too long.
    pub(super) fn new(tree: &Tree, sign: f64) -> Result<Self, UnusableFormula> {
        let mut compiler =
            Compiler { constants: vec![ZERO, ONE], steps: Vec::new(), slots: 1, sign };
        let (terms, offset) = match compiler.part(tree)? {
            FormulaPart::Constant(value) => (Vec::new(), value),
            FormulaPart::Straight(terms, offset) => (terms, offset),
        };
        let output =
            terms.into_iter().map(|(slot, factor)| (slot, compiler.constant(factor))).collect();
        let offset = compiler.constant(offset);
        let Compiler { constants, steps, slots, .. } = compiler;
        if slots > MOST_SLOTS {
            return Err(UnusableFormula::TooLong { slots, most: MOST_SLOTS });
        }
        Ok(Self { constants, steps, output, offset, slots })
    }

    /// Values of the constants of the steps.
    pub(super) fn values(&self, named: &[f64]) -> Vec<f64> {
        self.constants.iter().map(|constant| constant.value(named)).collect()
    }
}

struct Compiler {
    constants: Vec<Tree>,
    steps: Vec<Step>,
    slots: usize,
    sign: f64,
}

impl Compiler {
    fn constant(&mut self, value: Tree) -> usize {
        if let Some(known) = self.constants.iter().position(|known| *known == value) {
            return known;
        }
        self.constants.push(value);
        self.constants.len() - 1
    }

    fn argument(&mut self, part: FormulaPart) -> Argument {
        let (terms, offset) = match part {
            FormulaPart::Constant(value) => (Vec::new(), value),
            FormulaPart::Straight(terms, offset) => (terms, offset),
        };
        let zero = self.constant(ZERO);
        let mut terms = terms.into_iter();
        let mut whole = match terms.next() {
            None => Argument { slot: 0, factor: zero, offset: zero },
            Some((slot, factor)) => Argument { slot, factor: self.constant(factor), offset: zero },
        };
        for (slot, factor) in terms {
            let next = Argument { slot, factor: self.constant(factor), offset: zero };
            let slot = self.step(Step::Sum(whole, next));
            whole = Argument { slot, factor: self.constant(ONE), offset: zero };
        }
        Argument { offset: self.constant(offset), ..whole }
    }

    /// Adds a step; its first slot.
    fn step(&mut self, step: Step) -> usize {
        // Equal steps are shared.
        let mut slot = 1;
        for known in &self.steps {
            if *known == step {
                return slot;
            }
            slot += known.slots();
        }
        self.steps.push(step);
        self.slots += step.slots();
        slot
    }

    fn part(&mut self, tree: &Tree) -> Result<FormulaPart, UnusableFormula> {
        Ok(match tree {
            Tree::Number(_) | Tree::Constant(_) => FormulaPart::Constant(tree.clone()),
            Tree::Velocity => FormulaPart::Straight(vec![(0, Tree::Number(self.sign))], ZERO),
            Tree::Negative(x) => scaled(self.part(x)?, &Tree::Number(-1.0)),
            Tree::Sum(x, y) => {
                let (x, y) = (self.part(x)?, self.part(y)?);
                combined(x, y)
            }
            Tree::Difference(x, y) => {
                let (x, y) = (self.part(x)?, scaled(self.part(y)?, &Tree::Number(-1.0)));
                combined(x, y)
            }
            Tree::Product(x, y) => {
                let (x, y) = (self.part(x)?, self.part(y)?);
                self.product(x, y)
            }
            Tree::Quotient(x, y) => {
                let (x, y) = (self.part(x)?, self.part(y)?);
                self.quotient(x, y)
            }
            Tree::Power(x, y) => {
                let (x, y) = (self.part(x)?, self.part(y)?);
                self.power(x, y)
            }
            Tree::Call(function, x) => {
                let x = self.part(x)?;
                self.call(*function, x)?
            }
        })
    }

    fn product(&mut self, x: FormulaPart, y: FormulaPart) -> FormulaPart {
        match (x, y) {
            (FormulaPart::Constant(c), part) | (part, FormulaPart::Constant(c)) => scaled(part, &c),
            (x, y) => {
                let (x, y) = (self.argument(x), self.argument(y));
                alone(self.step(Step::Product(x, y)))
            }
        }
    }

    fn quotient(&mut self, x: FormulaPart, y: FormulaPart) -> FormulaPart {
        match (x, y) {
            (part, FormulaPart::Constant(c)) => {
                scaled(part, &Tree::Quotient(Box::new(ONE), Box::new(c)))
            }
            (x, y) => {
                let (x, y) = (self.argument(x), self.argument(y));
                alone(self.step(Step::Quotient(x, y)))
            }
        }
    }

    fn power(&mut self, x: FormulaPart, y: FormulaPart) -> FormulaPart {
        match (x, y) {
            (FormulaPart::Constant(x), FormulaPart::Constant(y)) => {
                FormulaPart::Constant(Tree::Power(Box::new(x), Box::new(y)))
            }
            (x, FormulaPart::Constant(Tree::Number(n)))
                if n.fract() == 0.0 && n.abs() <= LARGEST_POWER =>
            {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a whole number up to LARGEST_POWER"
                )]
                let whole = self.whole_power(x, n.abs() as u32);
                if n < 0.0 { self.quotient(FormulaPart::Constant(ONE), whole) } else { whole }
            }
            (x, FormulaPart::Constant(Tree::Number(0.5))) => {
                self.unary(x, Step::Sqrt, Function::Sqrt)
            }
            (x, y) => {
                let logarithm = self.unary(x, Step::Log, Function::Log);
                let exponent = self.product(logarithm, y);
                self.unary(exponent, Step::Exp, Function::Exp)
            }
        }
    }

    fn whole_power(&mut self, x: FormulaPart, n: u32) -> FormulaPart {
        match n {
            0 => FormulaPart::Constant(ONE),
            1 => x,
            _ => {
                let half = self.whole_power(x.clone(), n / 2);
                let square = self.product(half.clone(), half);
                if n % 2 == 1 { self.product(square, x) } else { square }
            }
        }
    }

    fn unary(
        &mut self,
        x: FormulaPart,
        step: fn(Argument) -> Step,
        function: Function,
    ) -> FormulaPart {
        match x {
            FormulaPart::Constant(x) => FormulaPart::Constant(Tree::Call(function, Box::new(x))),
            x @ FormulaPart::Straight(..) => {
                let x = self.argument(x);
                alone(self.step(step(x)))
            }
        }
    }

    fn call(&mut self, function: Function, x: FormulaPart) -> Result<FormulaPart, UnusableFormula> {
        if let FormulaPart::Constant(x) = x {
            return Ok(FormulaPart::Constant(Tree::Call(function, Box::new(x))));
        }
        Ok(match function {
            Function::Abs | Function::Sign => return directed(function, x),
            Function::Exp => self.unary(x, Step::Exp, function),
            Function::Log => self.unary(x, Step::Log, function),
            Function::Sqrt => self.unary(x, Step::Sqrt, function),
            Function::Tanh => self.unary(x, Step::Tanh, function),
            Function::Sin => self.unary(x, Step::Sine, function),
            Function::Atan => self.unary(x, Step::Atan, function),
            Function::Cos => {
                let x = self.argument(x);
                alone(self.step(Step::Sine(x)) + 1)
            }
            Function::Sech => self.sech(x)?,
        })
    }
}

impl Compiler {
    /// sech X = 2E/(1 + E²), E = e^(−|X|), which does not overflow for large |X|.
    fn sech(&mut self, x: FormulaPart) -> Result<FormulaPart, UnusableFormula> {
        let size = directed(Function::Abs, x)?;
        let decay = self.unary(scaled(size, &Tree::Number(-1.0)), Step::Exp, Function::Exp);
        let square = self.product(decay.clone(), decay.clone());
        let below = combined(square, FormulaPart::Constant(ONE));
        Ok(self.quotient(scaled(decay, &Tree::Number(2.0)), below))
    }
}

/// abs and sign of a multiple of v, whose sign is constant on a branch.
fn directed(function: Function, x: FormulaPart) -> Result<FormulaPart, UnusableFormula> {
    match x {
        FormulaPart::Straight(terms, offset)
            if offset == ZERO && terms.len() == 1 && terms[0].0 == 0 =>
        {
            let factor = Tree::Call(function, Box::new(terms[0].1.clone()));
            Ok(if function == Function::Abs {
                FormulaPart::Straight(vec![(0, factor)], ZERO)
            } else {
                FormulaPart::Constant(factor)
            })
        }
        _ => Err(UnusableFormula::Kink),
    }
}

/// A part times a constant.
fn scaled(part: FormulaPart, by: &Tree) -> FormulaPart {
    match part {
        FormulaPart::Constant(value) if *by == Tree::Number(-1.0) => {
            FormulaPart::Constant(negative(value))
        }
        FormulaPart::Constant(value) => FormulaPart::Constant(product(value, by.clone())),
        FormulaPart::Straight(terms, offset) => {
            let terms = terms.into_iter().map(|(slot, factor)| (slot, product(factor, by.clone())));
            FormulaPart::Straight(terms.collect(), product(offset, by.clone()))
        }
    }
}

/// A single series.
fn alone(slot: usize) -> FormulaPart {
    FormulaPart::Straight(vec![(slot, ONE)], ZERO)
}

/// The sum of two parts, which needs no step until it is an argument.
fn combined(x: FormulaPart, y: FormulaPart) -> FormulaPart {
    let (mut terms, offset) = match x {
        FormulaPart::Constant(x) => (Vec::new(), x),
        FormulaPart::Straight(terms, offset) => (terms, offset),
    };
    let (others, shift) = match y {
        FormulaPart::Constant(y) => (Vec::new(), y),
        FormulaPart::Straight(terms, offset) => (terms, offset),
    };
    for (slot, factor) in others {
        match terms.iter_mut().find(|(known, _)| *known == slot) {
            Some((_, known)) => *known = sum(known.clone(), factor),
            None => terms.push((slot, factor)),
        }
    }
    let offset = sum(offset, shift);
    if terms.is_empty() {
        FormulaPart::Constant(offset)
    } else {
        FormulaPart::Straight(terms, offset)
    }
}
