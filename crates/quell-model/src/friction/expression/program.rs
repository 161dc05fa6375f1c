//! A formula as a list of steps, each of which has a recurrence for its Taylor coefficients.
//!
//! What does not depend on v becomes a constant; sums with constants and products by them cost
//! nothing, for every step takes its arguments as a x + b. The structure depends on the text alone, never
//! on the value of a constant: runs that differ in those go side by side.

use super::syntax::{Function, Tree};

/// Most series that a formula may need.
pub(super) const MOST_SLOTS: usize = 32;

/// Powers that are products; others are exp(b log a).
const LARGEST_POWER: f64 = 8.0;

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
    /// Series that it makes.
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
    /// The coefficient.
    pub(super) output: Argument,
    /// Number of series, slot 0 included.
    pub(super) slots: usize,
}

/// A part of the formula while it is compiled.
#[derive(Clone, Debug)]
enum Part {
    Constant(Tree),
    /// a x + b.
    Straight {
        slot: usize,
        factor: Tree,
        offset: Tree,
    },
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
    pub(super) fn new(tree: &Tree, sign: f64) -> Result<Self, String> {
        let mut compiler =
            Compiler { constants: vec![ZERO, ONE], steps: Vec::new(), slots: 1, sign };
        let whole = compiler.part(tree)?;
        let output = match whole {
            Part::Constant(value) => {
                let offset = compiler.constant(value);
                Argument { slot: 0, factor: 0, offset }
            }
            straight @ Part::Straight { .. } => compiler.argument(straight),
        };
        let Compiler { constants, steps, slots, .. } = compiler;
        if slots > MOST_SLOTS {
            return Err(format!(
                "shorter: it needs {slots} series (one a product, a quotient or a function), at most {MOST_SLOTS} are there"
            ));
        }
        Ok(Self { constants, steps, output, slots })
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

    fn argument(&mut self, part: Part) -> Argument {
        match part {
            Part::Constant(value) => Argument { slot: 0, factor: 0, offset: self.constant(value) },
            Part::Straight { slot, factor, offset } => {
                Argument { slot, factor: self.constant(factor), offset: self.constant(offset) }
            }
        }
    }

    /// Adds a step; its first slot, or the one after it.
    fn step(&mut self, step: Step, second: bool) -> Part {
        // The same step twice is one.
        let mut slot = 1;
        for known in &self.steps {
            if *known == step {
                return Part::Straight {
                    slot: slot + usize::from(second),
                    factor: ONE,
                    offset: ZERO,
                };
            }
            slot += known.slots();
        }
        self.steps.push(step);
        self.slots += step.slots();
        Part::Straight { slot: slot + usize::from(second), factor: ONE, offset: ZERO }
    }

    fn part(&mut self, tree: &Tree) -> Result<Part, String> {
        Ok(match tree {
            Tree::Number(_) | Tree::Constant(_) => Part::Constant(tree.clone()),
            Tree::Velocity => {
                Part::Straight { slot: 0, factor: Tree::Number(self.sign), offset: ZERO }
            }
            Tree::Negative(x) => scaled(self.part(x)?, &Tree::Number(-1.0)),
            Tree::Sum(x, y) => {
                let (x, y) = (self.part(x)?, self.part(y)?);
                self.sum(x, y)
            }
            Tree::Difference(x, y) => {
                let (x, y) = (self.part(x)?, scaled(self.part(y)?, &Tree::Number(-1.0)));
                self.sum(x, y)
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

    fn sum(&mut self, x: Part, y: Part) -> Part {
        match (x, y) {
            (Part::Constant(x), Part::Constant(y)) => Part::Constant(sum(x, y)),
            (Part::Constant(c), Part::Straight { slot, factor, offset })
            | (Part::Straight { slot, factor, offset }, Part::Constant(c)) => {
                Part::Straight { slot, factor, offset: sum(offset, c) }
            }
            (
                Part::Straight { slot, factor, offset },
                Part::Straight { slot: other, factor: second, offset: shift },
            ) if slot == other => {
                Part::Straight { slot, factor: sum(factor, second), offset: sum(offset, shift) }
            }
            (x, y) => {
                let (x, y) = (self.argument(x), self.argument(y));
                self.step(Step::Sum(x, y), false)
            }
        }
    }

    fn product(&mut self, x: Part, y: Part) -> Part {
        match (x, y) {
            (Part::Constant(c), part) | (part, Part::Constant(c)) => scaled(part, &c),
            (x, y) => {
                let (x, y) = (self.argument(x), self.argument(y));
                self.step(Step::Product(x, y), false)
            }
        }
    }

    fn quotient(&mut self, x: Part, y: Part) -> Part {
        match (x, y) {
            (part, Part::Constant(c)) => scaled(part, &Tree::Quotient(Box::new(ONE), Box::new(c))),
            (x, y) => {
                let (x, y) = (self.argument(x), self.argument(y));
                self.step(Step::Quotient(x, y), false)
            }
        }
    }

    fn power(&mut self, x: Part, y: Part) -> Part {
        match (x, y) {
            (Part::Constant(x), Part::Constant(y)) => {
                Part::Constant(Tree::Power(Box::new(x), Box::new(y)))
            }
            (x, Part::Constant(Tree::Number(n)))
                if n.fract() == 0.0 && n.abs() <= LARGEST_POWER =>
            {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "a whole number up to LARGEST_POWER"
                )]
                let whole = self.whole_power(x, n.abs() as u32);
                if n < 0.0 { self.quotient(Part::Constant(ONE), whole) } else { whole }
            }
            (x, Part::Constant(Tree::Number(0.5))) => self.unary(x, Step::Sqrt, Function::Sqrt),
            (x, y) => {
                let logarithm = self.unary(x, Step::Log, Function::Log);
                let exponent = self.product(logarithm, y);
                self.unary(exponent, Step::Exp, Function::Exp)
            }
        }
    }

    fn whole_power(&mut self, x: Part, n: u32) -> Part {
        match n {
            0 => Part::Constant(ONE),
            1 => x,
            _ => {
                let half = self.whole_power(x.clone(), n / 2);
                let square = self.product(half.clone(), half);
                if n % 2 == 1 { self.product(square, x) } else { square }
            }
        }
    }

    fn unary(&mut self, x: Part, step: fn(Argument) -> Step, function: Function) -> Part {
        match x {
            Part::Constant(x) => Part::Constant(Tree::Call(function, Box::new(x))),
            x @ Part::Straight { .. } => {
                let x = self.argument(x);
                self.step(step(x), false)
            }
        }
    }

    fn call(&mut self, function: Function, x: Part) -> Result<Part, String> {
        if let Part::Constant(x) = x {
            return Ok(Part::Constant(Tree::Call(function, Box::new(x))));
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
                self.step(Step::Sine(x), true)
            }
            Function::Sech => self.sech(x)?,
        })
    }
}

impl Compiler {
    /// sech X = 2E/(1 + E²), E = e^(−|X|): no overflow far out.
    fn sech(&mut self, x: Part) -> Result<Part, String> {
        let size = directed(Function::Abs, x)?;
        let decay = self.unary(scaled(size, &Tree::Number(-1.0)), Step::Exp, Function::Exp);
        let square = self.product(decay.clone(), decay.clone());
        let below = self.sum(square, Part::Constant(ONE));
        Ok(self.quotient(scaled(decay, &Tree::Number(2.0)), below))
    }
}

/// abs and sign of a multiple of v, which has one sign on a branch.
fn directed(function: Function, x: Part) -> Result<Part, String> {
    match x {
        Part::Straight { slot: 0, factor, offset } if offset == ZERO => {
            let factor = Tree::Call(function, Box::new(factor));
            Ok(if function == Function::Abs {
                Part::Straight { slot: 0, factor, offset: ZERO }
            } else {
                Part::Constant(factor)
            })
        }
        _ => Err("smooth on each side of v = 0: abs, sign and sech take a multiple of v or a \
                  constant; of anything else they could have a kink elsewhere"
            .to_owned()),
    }
}

/// A part times a constant.
fn scaled(part: Part, by: &Tree) -> Part {
    match part {
        Part::Constant(value) if *by == Tree::Number(-1.0) => Part::Constant(negative(value)),
        Part::Constant(value) => Part::Constant(product(value, by.clone())),
        Part::Straight { slot, factor, offset } => Part::Straight {
            slot,
            factor: product(factor, by.clone()),
            offset: product(offset, by.clone()),
        },
    }
}
