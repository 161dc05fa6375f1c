//! Proof that a formula is finite, smooth and not negative over a range of slip speeds.
//!
//! Scheme: the formula and its slope are evaluated over an interval of speeds with outward rounding ([`RealInterval`]), on the
//! tree. If their bounds prove nothing, the interval is halved. A lower bound is taken from one end of the interval if the slope
//! has one sign, otherwise from the mean-value form. Every halving also evaluates the formula at the midpoint: a negative or
//! infinite value there ends the search with the speed and the value. If an interval is still open when the budget is used up
//! or the interval cannot be halved, the formula is rejected, with the speed.
//!
//! Cost: a formula of ten terms takes about a microsecond an interval; common laws need one to a hundred of them.

use std::fmt;

use quell_numerics::interval::RealInterval;

use super::tree::{Function, Tree};

/// Coefficients beyond this are treated as infinite: exponentials are bounded before they overflow.
const LARGEST: f64 = 1e100;

/// Maximum number of intervals of a proof: 20 000 take tens of milliseconds, and a law that needs more falls by more than 10³
/// within a thousandth of its range.
const MOST_INTERVALS: u32 = 20_000;

/// Number of speeds at which the size of the coefficient is sampled, as reference for its rounding.
const MEASURED: u32 = 8;

/// Rounding of the coefficient relative to its size, left by differences of equal terms.
const ROUNDING: f64 = 1e-14;

/// Why a formula is rejected; speeds in units of v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Doubt {
    what: What,
    speed: f64,
    up_to: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Negative(f64),
    NotFinite,
    Unproven,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, speed, up_to } = *self;
        let speed = digits(speed);
        write!(
            f,
            "finite, smooth and ≥ 0 at every slip speed up to the maximum velocity {}; ",
            digits(up_to)
        )?;
        match what {
            What::Negative(value) => write!(f, "at v = {speed} it is {}", digits(value))?,
            What::NotFinite => write!(f, "it is not finite and smooth at v = {speed}")?,
            What::Unproven => write!(f, "this could not be proven at v = {speed}")?,
        }
        f.write_str(" (maximum_velocity sets the intended range of the formula)")
    }
}

/// Nine digits: enough to locate a narrow dip.
fn digits(value: f64) -> String {
    crate::digits::digits(value, 9)
}

/// Proves that a formula is finite, smooth and not negative from rest to `up_to`; `at` returns its coefficient and slope at
/// a speed.
///
/// # Errors
/// Where it is negative or not finite, or where the proof failed.
pub(super) fn prove(
    formula: &Formula<'_>,
    at: impl Fn(f64) -> (f64, f64),
    up_to: f64,
) -> Result<(), Doubt> {
    let speeds = (0..=MEASURED).map(|k| up_to * f64::from(k) / f64::from(MEASURED));
    let sizes = speeds.map(|speed| at(speed).0.abs()).filter(|size| size.is_finite());
    let allowed = -ROUNDING * sizes.fold(0.0, f64::max);
    let doubt = |what, speed| Doubt { what, speed, up_to };
    let mut open = vec![(0.0, up_to)];
    let mut budget = MOST_INTERVALS;
    while let Some((from, to)) = open.pop() {
        if formula.least(from, to).is_some_and(|least| least >= allowed) {
            continue;
        }
        let middle = f64::midpoint(from, to);
        let there = formula.over(middle, middle).filter(|there| there.value.is_bounded());
        let Some(there) = there else {
            return Err(doubt(What::NotFinite, middle));
        };
        if there.value.upper < allowed {
            return Err(doubt(What::Negative(at(middle).0), middle));
        }
        if there.value.lower > LARGEST || !at(middle).1.is_finite() {
            return Err(doubt(What::NotFinite, middle));
        }
        budget -= 1;
        // The interval is a few rounding errors wide: halving it further proves nothing.
        if budget == 0 || to - from <= 8.0 * f64::EPSILON * to {
            return Err(doubt(What::Unproven, middle));
        }
        open.push((middle, to));
        open.push((from, middle));
    }
    Ok(())
}

/// A formula with the values of its constants.
pub(super) struct Formula<'f> {
    pub(super) tree: &'f Tree,
    pub(super) named: &'f [f64],
}

/// Bounds of a formula and of its slope in v.
#[derive(Clone, Copy, Debug)]
struct Bounded {
    value: RealInterval,
    slope: RealInterval,
}

impl Formula<'_> {
    /// Bounds between two speeds ≥ 0; `None` where it is not defined throughout.
    fn over(&self, from: f64, to: f64) -> Option<Bounded> {
        // On the branch of slip v = 0 is 0⁺, where sign(v) is 1.
        let speeds = RealInterval::new(from, to.max(f64::MIN_POSITIVE));
        self.bounds(self.tree, speeds)
    }

    /// A lower bound between two speeds; `None` where it is not proven finite and smooth there.
    fn least(&self, from: f64, to: f64) -> Option<f64> {
        let whole = self.over(from, to)?;
        if !(whole.slope.is_bounded() && whole.value.lower > f64::NEG_INFINITY)
            || whole.value.upper > LARGEST
        {
            return None;
        }
        let end = |speed: f64| self.over(speed, speed).map(|there| there.value.lower);
        let other = if whole.slope.lower >= 0.0 {
            end(from)
        } else if whole.slope.upper <= 0.0 {
            end(to)
        } else {
            let middle = f64::midpoint(from, to);
            let there = self.over(middle, middle)?.value;
            let away = RealInterval::new(from, to) - RealInterval::point(middle);
            Some((there + whole.slope * away).lower)
        };
        Some(other.unwrap_or(f64::NEG_INFINITY).max(whole.value.lower))
    }

    fn bounds(&self, tree: &Tree, v: RealInterval) -> Option<Bounded> {
        let constant = |value| Bounded { value, slope: RealInterval::point(0.0) };
        let of = |tree: &Tree| self.bounds(tree, v);
        Some(match tree {
            Tree::Number(number) => constant(RealInterval::point(*number)),
            Tree::Constant(place) => constant(RealInterval::point(*self.named.get(*place)?)),
            Tree::Velocity => Bounded { value: v, slope: RealInterval::point(1.0) },
            Tree::Negative(x) => {
                let x = of(x)?;
                Bounded { value: -x.value, slope: -x.slope }
            }
            Tree::Sum(x, y) => {
                let (x, y) = (of(x)?, of(y)?);
                Bounded { value: x.value + y.value, slope: x.slope + y.slope }
            }
            Tree::Difference(x, y) => {
                let (x, y) = (of(x)?, of(y)?);
                Bounded { value: x.value - y.value, slope: x.slope - y.slope }
            }
            Tree::Product(x, y) => {
                let (x, y) = (of(x)?, of(y)?);
                Bounded { value: x.value * y.value, slope: x.slope * y.value + x.value * y.slope }
            }
            Tree::Quotient(x, y) => of(x)?.over(of(y)?)?,
            Tree::Power(x, y) if !(x.has_velocity() || y.has_velocity()) => {
                let value = tree.value(self.named);
                // The error of the platform-independent power is below this.
                constant(RealInterval::point(value) * RealInterval::new(1.0 - 1e-15, 1.0 + 1e-15))
            }
            Tree::Power(x, y) => power(of(x)?, y, of(y)?)?,
            Tree::Call(function, x) => called(*function, of(x)?)?,
        })
    }
}

impl Bounded {
    /// Quotient.
    fn over(self, y: Self) -> Option<Self> {
        let value = self.value.over(y.value)?;
        let slope = (self.slope - value * y.slope).over(y.value)?;
        Some(Self { value, slope })
    }

    /// f(X) with f′(X) over X.
    fn through(self, value: RealInterval, derivative: RealInterval) -> Self {
        Self { value, slope: derivative * self.slope }
    }
}

/// x^y as the compiled formula evaluates it: integer exponents written in the formula are products, others e^(y log x).
fn power(x: Bounded, written: &Tree, y: Bounded) -> Option<Bounded> {
    let whole = if let Tree::Number(n) = written { Some(*n) } else { None };
    match whole {
        Some(n) if n.fract() == 0.0 && n.abs() <= super::program::LARGEST_POWER => {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number up to LARGEST_POWER"
            )]
            let whole = n.abs() as u32;
            let derivative = match whole {
                0 => RealInterval::point(0.0),
                whole => RealInterval::point(f64::from(whole)) * x.value.power(whole - 1),
            };
            let raised = x.through(x.value.power(whole), derivative);
            let one = Bounded { value: RealInterval::point(1.0), slope: RealInterval::point(0.0) };
            if n < 0.0 { one.over(raised) } else { Some(raised) }
        }
        Some(0.5) => called(Function::Sqrt, x),
        _ => {
            let logarithm = called(Function::Log, x)?;
            let exponent = Bounded {
                value: y.value * logarithm.value,
                slope: y.slope * logarithm.value + y.value * logarithm.slope,
            };
            called(Function::Exp, exponent)
        }
    }
}

fn called(function: Function, x: Bounded) -> Option<Bounded> {
    let one = RealInterval::point(1.0);
    let sign = if x.value.lower >= 0.0 && x.value.upper > 0.0 {
        one
    } else if x.value.upper <= 0.0 && x.value.lower < 0.0 {
        -one
    } else if x.value.lower == 0.0 && x.value.upper == 0.0 {
        RealInterval::point(0.0)
    } else {
        RealInterval::new(-1.0, 1.0)
    };
    Some(match function {
        Function::Abs => x.through(x.value.abs(), sign),
        Function::Sign => Bounded { value: sign, slope: RealInterval::point(0.0) },
        Function::Exp => {
            let value = x.value.exp();
            x.through(value, value)
        }
        Function::Log => x.through(x.value.log()?, one.over(x.value)?),
        Function::Sqrt => {
            let value = x.value.sqrt()?;
            x.through(value, RealInterval::point(0.5).over(value)?)
        }
        Function::Sin => x.through(x.value.sin(), x.value.cos()),
        Function::Cos => x.through(x.value.cos(), -x.value.sin()),
        Function::Tanh => {
            let sech = x.value.sech();
            x.through(x.value.tanh(), sech.power(2))
        }
        Function::Sech => {
            let value = x.value.sech();
            x.through(value, -(value * x.value.tanh()))
        }
        Function::Atan => x.through(x.value.atan(), one.over(one + x.value.power(2))?),
    })
}
