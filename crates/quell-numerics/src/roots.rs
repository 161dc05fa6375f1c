//! Scalar roots in a bracket (Chandrupatla) and minima of unimodal functions (Brent).
//!
//! Root: f(a) and f(b) have opposite signs; each step uses inverse quadratic interpolation through
//! the last three points if Chandrupatla's test shows it to be safe (f monotone and not too curved on the bracket),
//! and bisection otherwise. The bracket always contains a sign change, so the result is a root of the
//! *computed* f within the tolerance; convergence is superlinear for simple roots and never slower than about three times
//! bisection. A jump through zero is treated like a root: the result is the location of the sign change.
//! Reference: T. R. Chandrupatla, *Adv. Eng. Software* 28 (1997) 145–149.
//!
//! Minimum: golden section with parabolic steps, R. P. Brent, *Algorithms for Minimization without
//! Derivatives* (1973), ch. 5. The location of a smooth minimum is only determined to √ε.
//!
//! Both are deterministic: the same f gives the same sequence of points.

/// A root and its final bracket.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScalarRoot {
    /// The end of the last bracket with the smaller |f|.
    pub location: f64,
    /// f at the root.
    pub residual: f64,
    /// Width of the last bracket, at most twice the tolerance: the error bound (0 if f vanished exactly).
    pub width: f64,
    /// Number of evaluations of f, including both ends.
    pub evaluations: usize,
}

/// A minimum inside an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// Location of the smallest value found.
    pub location: f64,
    /// The smallest value found.
    pub value: f64,
    /// Number of evaluations of f.
    pub evaluations: usize,
}

/// Tolerance for the location of a root or a minimum: `absolute + relative·|x|`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closeness {
    /// Part of the tolerance that does not depend on x.
    pub absolute: f64,
    /// Part of the tolerance proportional to |x|; effectively at least 2ε for a root and 10⁻⁹ for a minimum, whose location
    /// is not determined more accurately.
    pub relative: f64,
}

impl Default for Closeness {
    /// The tightest tolerance that the arithmetic allows.
    fn default() -> Self {
        Self { absolute: 0.0, relative: 2.0 * f64::EPSILON }
    }
}

impl Closeness {
    fn at(&self, x: f64) -> f64 {
        self.absolute + self.relative.max(2.0 * f64::EPSILON) * x.abs() + f64::MIN_POSITIVE
    }
}

/// The reason why no root or minimum was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RootError {
    /// f has the same sign at both ends.
    NotBracketed {
        /// f at the lower end.
        at_lower: f64,
        /// f at the upper end.
        at_upper: f64,
    },
    /// An end of the interval, or f at a point, is not a number.
    NotANumber {
        /// The point.
        at: f64,
    },
    /// The search did not converge within [`MAX_STEPS`] evaluations.
    TooManySteps {
        /// Lower end of the last bracket.
        lower: f64,
        /// Upper end of the last bracket.
        upper: f64,
    },
}

impl core::fmt::Display for RootError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotBracketed { at_lower, at_upper } => {
                write!(f, "no change of sign: {at_lower:e} and {at_upper:e} at the two ends")
            }
            Self::NotANumber { at } => write!(f, "the function is not a number at {at}"),
            Self::TooManySteps { lower, upper } => {
                write!(f, "no root within {MAX_STEPS} steps; last bracket {lower} to {upper}")
            }
        }
    }
}

impl core::error::Error for RootError {}

/// Maximum number of steps of either search; bisection alone needs at most about 1080 over the whole range of `f64`
/// (and 64 once the bracket spans one power of two).
pub const MAX_STEPS: usize = 2200;

/// Root of `f` between `a` and `b`, between which it changes sign.
///
/// # Errors
/// [`RootError`] if there is no sign change or f is not a number.
pub fn find_root(
    mut f: impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    closeness: Closeness,
) -> Result<ScalarRoot, RootError> {
    // b: newest point, a: other end of the bracket, c: the point discarded last.
    let (mut a, mut b) = (b, a);
    let mut fa = number(f(a), a)?;
    let mut fb = number(f(b), b)?;
    if fa == 0.0 || fb == 0.0 {
        let location = if fa == 0.0 { a } else { b };
        return Ok(ScalarRoot { location, residual: 0.0, width: 0.0, evaluations: 2 });
    }
    if (fa > 0.0) == (fb > 0.0) {
        return Err(RootError::NotBracketed { at_lower: fb, at_upper: fa });
    }
    let mut fraction = 0.5;
    for evaluations in 3..MAX_STEPS {
        let x = a + fraction * (b - a);
        let fx = number(f(x), x)?;
        let (c, fc);
        if (fx > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (x, fx);
        let (location, residual) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        if residual == 0.0 {
            return Ok(ScalarRoot { location, residual, width: 0.0, evaluations });
        }
        let width = (b - a).abs();
        let limit = closeness.at(location) / width;
        if limit > 0.5 {
            return Ok(ScalarRoot { location, residual, width, evaluations });
        }
        let xi = (a - b) / (c - b);
        let phi = (fa - fb) / (fc - fb);
        fraction = if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
            fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
        } else {
            0.5
        };
        fraction = fraction.clamp(limit, 1.0 - limit);
    }
    Err(RootError::TooManySteps { lower: a.min(b), upper: a.max(b) })
}

/// Minimum of a function that decreases and then increases between `a` and `b`.
///
/// For a function with several local minima it returns one of them; for a monotone function it converges to an end
/// (which it approaches within the tolerance but does not evaluate).
///
/// # Errors
/// [`RootError::NotANumber`] if an end or f is not a number, [`RootError::TooManySteps`] if it does not converge.
pub fn minimise(
    mut f: impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    closeness: Closeness,
) -> Result<Minimum, RootError> {
    /// Golden section (3 − √5)/2.
    const GOLDEN: f64 = 0.3819660112501051;
    let (mut low, mut high) = (a.min(b), a.max(b));
    let relative = closeness.relative.max(1e-9);
    let mut x = low + GOLDEN * (high - low);
    let mut fx = number(f(x), x)?;
    let (mut w, mut v, mut fw, mut fv) = (x, x, fx, fx);
    let (mut step, mut before): (f64, f64) = (0.0, 0.0);
    for evaluations in 1..MAX_STEPS {
        let middle = low.midpoint(high);
        let near = closeness.absolute + relative * x.abs() + f64::MIN_POSITIVE;
        if (x - middle).abs() <= 2.0 * near - 0.5 * (high - low) {
            return Ok(Minimum { location: x, value: fx, evaluations });
        }
        let mut golden = true;
        if before.abs() > near {
            let r = (x - w) * (fx - fv);
            let q = (x - v) * (fx - fw);
            let (mut p, mut q) = ((x - v) * q - (x - w) * r, 2.0 * (q - r));
            if q > 0.0 {
                p = -p;
            }
            q = q.abs();
            if p.abs() < (0.5 * q * before).abs() && p > q * (low - x) && p < q * (high - x) {
                before = step;
                step = p / q;
                let u = x + step;
                if u - low < 2.0 * near || high - u < 2.0 * near {
                    step = if x < middle { near } else { -near };
                }
                golden = false;
            }
        }
        if golden {
            before = if x < middle { high - x } else { low - x };
            step = GOLDEN * before;
        }
        let u = x + if step.abs() >= near { step } else { near.copysign(step) };
        let fu = number(f(u), u)?;
        if fu <= fx {
            if u < x {
                high = x;
            } else {
                low = x;
            }
            (v, fv, w, fw, x, fx) = (w, fw, x, fx, u, fu);
        } else {
            if u < x {
                low = u;
            } else {
                high = u;
            }
            if fu <= fw || w == x {
                (v, fv, w, fw) = (w, fw, u, fu);
            } else if fu <= fv || v == x || v == w {
                (v, fv) = (u, fu);
            }
        }
    }
    Err(RootError::TooManySteps { lower: low, upper: high })
}

/// The two real roots of c + bx + ax², the second of which may be infinite or not a number if coefficients vanish; `None`
/// if there are no real roots.
///
/// The first root is the one of −(b ± √(b² − 4ac))/2a that is computed without cancellation; the second one follows from the
/// product of the two.
pub fn quadratic(constant: f64, linear: f64, square: f64) -> Option<[f64; 2]> {
    let discriminant = linear * linear - 4.0 * square * constant;
    if discriminant < 0.0 {
        return None;
    }
    let large = -0.5 * (linear + libm::copysign(libm::sqrt(discriminant), linear));
    Some([large / square, constant / large])
}

/// [`find_root`] for a fallible function.
///
/// # Errors
/// The first error of `f`, which ends the search; the inner result is that of [`find_root`].
pub fn try_find_root<E>(
    mut f: impl FnMut(f64) -> Result<f64, E>,
    a: f64,
    b: f64,
    closeness: Closeness,
) -> Result<Result<ScalarRoot, RootError>, E> {
    let mut failure = None;
    let found = find_root(|x| kept(f(x), &mut failure), a, b, closeness);
    failure.map_or(Ok(found), Err)
}

/// [`minimise`] for a fallible function.
///
/// # Errors
/// The first error of `f`, which ends the search; the inner result is that of [`minimise`].
pub fn try_minimise<E>(
    mut f: impl FnMut(f64) -> Result<f64, E>,
    a: f64,
    b: f64,
    closeness: Closeness,
) -> Result<Result<Minimum, RootError>, E> {
    let mut failure = None;
    let found = minimise(|x| kept(f(x), &mut failure), a, b, closeness);
    failure.map_or(Ok(found), Err)
}

/// The value, or NaN after storing the failure, which ends the search.
fn kept<E>(value: Result<f64, E>, failure: &mut Option<E>) -> f64 {
    value.unwrap_or_else(|why| {
        *failure = Some(why);
        f64::NAN
    })
}

fn number(y: f64, at: f64) -> Result<f64, RootError> {
    if y.is_nan() || at.is_nan() { Err(RootError::NotANumber { at }) } else { Ok(y) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(f: impl FnMut(f64) -> f64, a: f64, b: f64) -> ScalarRoot {
        find_root(f, a, b, Closeness::default()).expect("a root")
    }

    /// Known roots: simple, triple, a jump, at an end, in both orientations.
    #[test]
    fn known_roots_are_found() {
        for k in 1..200 {
            let r = 0.013 * f64::from(k);
            for flip in [1.0, -1.0] {
                let smooth = root(|x| flip * (libm::exp(x) - libm::exp(r)), 0.0, 3.0);
                assert!((smooth.location - r).abs() < 4e-15 * r.max(1.0), "{r} {smooth:?}");
                assert!(smooth.evaluations < 25, "{smooth:?}");
                let cubic = root(|x| flip * (x - r) * (x - r) * (x - r), 4.0, -1.0);
                assert!((cubic.location - r).abs() < 1e-14 * r.max(1.0), "{r} {cubic:?}");
                let jump = root(|x| if x < r { -flip } else { flip * 1e9 }, 0.0, 3.0);
                assert!((jump.location - r).abs() < 2e-15 * r.max(1.0), "{r} {jump:?}");
            }
        }
        assert_eq!(root(|x| x, 0.0, 1.0).location, 0.0);
        assert_eq!(root(|x| x - 1.0, 0.0, 1.0).location, 1.0);
    }

    #[test]
    fn roots_of_quadratics_are_free_of_cancellation() {
        // (x − 1)(x − 10⁻¹²) and its mirror image.
        for side in [1.0, -1.0] {
            let roots = quadratic(1e-12, -side * (1.0 + 1e-12), 1.0).expect("real ones");
            assert!((roots[0] * side - 1.0).abs() < 1e-15);
            assert!((roots[1] * side / 1e-12 - 1.0).abs() < 1e-15);
        }
        assert_eq!(quadratic(1.0, 0.0, 1.0), None);
    }

    #[test]
    fn searches_for_difficult_roots_converge() {
        let flat = root(|x| libm::atan(1e8 * (x - 0.7)) + 1e-9 * x, -1e6, 1e9);
        assert!((flat.location - 0.7).abs() < 1e-7, "{flat:?}");
        let tiny = root(|x| x - 1e-200, 0.0, 1.0);
        assert!((tiny.location - 1e-200).abs() < 1e-214, "{tiny:?}");
        let steep = root(|x| libm::exp(-1.0 / (x * x)) - 1e-40, 1e-3, 10.0);
        let exact = 1.0 / (40.0 * core::f64::consts::LN_10).sqrt();
        assert!((steep.location - exact).abs() < 1e-15, "{steep:?} {exact}");
    }

    #[test]
    fn tolerances_are_met_and_invalid_brackets_rejected() {
        let coarse = Closeness { absolute: 1e-3, relative: 0.0 };
        let r = find_root(|x| x * x - 2.0, 0.0, 2.0, coarse).expect("a root");
        assert!(
            (r.location - core::f64::consts::SQRT_2).abs() <= r.width && r.width <= 2e-3 * 1.01
        );
        assert!(matches!(
            find_root(|x| x * x + 1.0, -1.0, 1.0, coarse),
            Err(RootError::NotBracketed { .. })
        ));
        assert!(matches!(
            find_root(|x| (x - 0.5).sqrt(), 0.0, 1.0, coarse),
            Err(RootError::NotANumber { .. })
        ));
    }

    /// A failure during the search is returned and f is not called again; without failures the result is the plain one.
    #[test]
    fn failures_of_the_function_are_returned() {
        let c = Closeness { absolute: 1e-6, relative: 0.0 };
        for last in 1..4 {
            let mut asked = 0;
            let mut failing = |x: f64| {
                asked += 1;
                if asked < last { Ok(x * x - 0.3) } else { Err(asked) }
            };
            assert_eq!(try_find_root(&mut failing, 0.0, 1.0, c), Err(last));
            asked = 0;
            let mut failing = |x: f64| {
                asked += 1;
                if asked < last { Ok(x * x - 0.3) } else { Err(asked) }
            };
            assert_eq!(try_minimise(&mut failing, -1.0, 1.0, c), Err(last));
        }
        let f = |x: f64| x * x - 0.3;
        let sure = |x: f64| Ok::<f64, ()>(f(x));
        assert_eq!(try_find_root(sure, 0.0, 1.0, c), Ok(find_root(f, 0.0, 1.0, c)));
        assert_eq!(try_find_root(sure, 1.0, 2.0, c), Ok(find_root(f, 1.0, 2.0, c)));
        assert_eq!(try_minimise(sure, -1.0, 1.0, c), Ok(minimise(f, -1.0, 1.0, c)));
    }

    #[test]
    fn known_minima_are_found() {
        for k in 1..50 {
            let m = 0.037 * f64::from(k);
            let c = Closeness { absolute: 1e-10, relative: 0.0 };
            let smooth = minimise(|x| (x - m) * (x - m) + 3.0, -1.0, 2.5, c).expect("ends");
            assert!((smooth.location - m).abs() < 1e-7 && smooth.value - 3.0 < 1e-14, "{smooth:?}");
            let kink = minimise(|x| (x - m).abs(), -1.0, 2.5, c).expect("ends");
            assert!((kink.location - m).abs() < 1e-8, "{kink:?}");
        }
        let end = minimise(|x| x, 1.0, 2.0, Closeness::default()).expect("ends");
        assert!(end.location - 1.0 < 1e-8);
    }
}
