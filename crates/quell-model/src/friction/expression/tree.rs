//! A formula as a tree, and the functions in it.

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Abs,
    Sign,
    Exp,
    Log,
    Sqrt,
    Sin,
    Cos,
    Tanh,
    Sech,
    Atan,
}

impl Function {
    /// Names in a formula.
    pub(super) const NAMES: &'static [(&'static str, Self)] = &[
        ("abs", Self::Abs),
        ("sign", Self::Sign),
        ("exp", Self::Exp),
        ("log", Self::Log),
        ("ln", Self::Log),
        ("sqrt", Self::Sqrt),
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("tanh", Self::Tanh),
        ("sech", Self::Sech),
        ("atan", Self::Atan),
    ];

    pub(super) fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|(known, _)| *known == name).map(|(_, function)| *function)
    }

    /// Its value at a number.
    pub(super) fn value(self, x: f64) -> f64 {
        match self {
            Self::Abs => x.abs(),
            Self::Sign if x == 0.0 => 0.0,
            Self::Sign => 1f64.copysign(x),
            Self::Exp => libm::exp(x),
            Self::Log => libm::log(x),
            Self::Sqrt => libm::sqrt(x),
            Self::Sin => libm::sin(x),
            Self::Cos => libm::cos(x),
            Self::Tanh => libm::tanh(x),
            Self::Sech => 1.0 / libm::cosh(x),
            Self::Atan => libm::atan(x),
        }
    }
}

/// A formula as a tree.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Tree {
    Number(f64),
    /// The slip velocity.
    Velocity,
    /// A named constant, by its place in the list of names.
    Constant(usize),
    Negative(Box<Tree>),
    Sum(Box<Tree>, Box<Tree>),
    Difference(Box<Tree>, Box<Tree>),
    Product(Box<Tree>, Box<Tree>),
    Quotient(Box<Tree>, Box<Tree>),
    Power(Box<Tree>, Box<Tree>),
    Call(Function, Box<Tree>),
}

impl Tree {
    /// Whether the slip velocity is in it.
    pub(super) fn has_velocity(&self) -> bool {
        match self {
            Self::Velocity => true,
            Self::Number(_) | Self::Constant(_) => false,
            Self::Negative(x) | Self::Call(_, x) => x.has_velocity(),
            Self::Sum(x, y)
            | Self::Difference(x, y)
            | Self::Product(x, y)
            | Self::Quotient(x, y)
            | Self::Power(x, y) => x.has_velocity() || y.has_velocity(),
        }
    }

    /// Adds the places of the named constants that occur in it, each once.
    pub(super) fn constants(&self, found: &mut Vec<usize>) {
        match self {
            Self::Constant(index) => {
                if !found.contains(index) {
                    found.push(*index);
                }
            }
            Self::Number(_) | Self::Velocity => {}
            Self::Negative(x) | Self::Call(_, x) => x.constants(found),
            Self::Sum(x, y)
            | Self::Difference(x, y)
            | Self::Product(x, y)
            | Self::Quotient(x, y)
            | Self::Power(x, y) => {
                x.constants(found);
                y.constants(found);
            }
        }
    }

    /// Its value where it has no slip velocity in it.
    pub(super) fn value(&self, constants: &[f64]) -> f64 {
        let of = |tree: &Self| tree.value(constants);
        match self {
            Self::Number(number) => *number,
            Self::Velocity => f64::NAN,
            Self::Constant(index) => constants.get(*index).copied().unwrap_or(f64::NAN),
            Self::Negative(x) => -of(x),
            Self::Sum(x, y) => of(x) + of(y),
            Self::Difference(x, y) => of(x) - of(y),
            Self::Product(x, y) => of(x) * of(y),
            Self::Quotient(x, y) => of(x) / of(y),
            Self::Power(x, y) => libm::pow(of(x), of(y)),
            Self::Call(function, x) => function.value(of(x)),
        }
    }
}
