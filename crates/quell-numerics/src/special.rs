//! Special functions in scaled form: nothing here overflows, underflows early or cancels.
//!
//! The averaged friction laws need I₀, the error function and Dawson's integral at arguments from
//! 10⁻⁶ to several hundred. Every function below is a thin door to a published implementation
//! made of polynomials and correctly rounded operations only (`+ − × ÷ √`), or of [`libm`], never
//! of the platform's mathematics library: the same bits come out on every machine.
//!
//! Largest relative errors measured against 50-digit values over 10⁻¹⁰ ≤ |x| ≤ 10³
//! (`reference/special.csv`, made by `reference/scripts/special.py`; the tests hold these bounds):
//!
//! | function | implementation | relative error |
//! |---|---|---|
//! | [`bessel_i0_scaled`], [`bessel_i1_scaled`] | Cephes Chebyshev series (`spec_math`) | 7e-16, 1.1e-15 |
//! | [`erf`], [`erfc`] | FreeBSD rational (`libm`) | 2.2e-16 (`erfc` while it is normal) |
//! | [`erfcx`] | Faddeeva piecewise Chebyshev (`errorfunctions`) | 9e-16 (x ≥ −2; see there) |
//! | [`dawson`] | Cephes rational (`spec_math`) | 2.3e-16 |
//! | [`exp`], [`expm1`], [`ln_1p`], [`ln`] | FreeBSD (`libm`) | 2.3e-16 |

use errorfunctions::RealErrorFunctions;
use spec_math::cephes64;

/// Scaled modified Bessel function e^{−|x|} I₀(x); even, positive, 1 at x = 0, ~ 1/√(2π|x|) far out.
#[must_use]
pub fn bessel_i0_scaled(x: f64) -> f64 {
    cephes64::i0e(x)
}

/// Scaled modified Bessel function e^{−|x|} I₁(x); odd, ~ x/2 near 0.
#[must_use]
pub fn bessel_i1_scaled(x: f64) -> f64 {
    cephes64::i1e(x)
}

/// Error function erf x = (2/√π) ∫₀ˣ e^{−t²} dt.
#[must_use]
pub fn erf(x: f64) -> f64 {
    libm::erf(x)
}

/// Complementary error function erfc x = 1 − erf x, without cancellation; 0 beyond x ≈ 27.2.
#[must_use]
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// Scaled complementary error function e^{x²} erfc x; ~ 1/(x√π) for large x.
///
/// For x < 0 it is 2e^{x²} − erfcx(−x); the rounding of x² makes the relative error grow like
/// x²·10⁻¹⁶ there, and below x ≈ −26.6 the value itself is beyond the range of `f64` and comes back as +∞.
#[must_use]
pub fn erfcx(x: f64) -> f64 {
    if x >= 0.0 {
        RealErrorFunctions::erfcx(x)
    } else if x.is_nan() {
        x
    } else {
        // The crate would call the platform's exp here.
        2.0 * libm::exp(x * x) - RealErrorFunctions::erfcx(-x)
    }
}

/// Dawson's integral e^{−x²} ∫₀ˣ e^{t²} dt = (√π/2) e^{−x²} erfi x; odd, ~ 1/(2x) for large x.
#[must_use]
pub fn dawson(x: f64) -> f64 {
    cephes64::dawsn(x)
}

/// Exponential eˣ.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// eˣ − 1 without cancellation near x = 0.
#[must_use]
pub fn expm1(x: f64) -> f64 {
    libm::expm1(x)
}

/// Natural logarithm ln x.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// ln(1 + x) without cancellation near x = 0.
#[must_use]
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// (eˣ − 1)/x with its limit 1 at x = 0.
#[must_use]
pub fn expm1_over(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { libm::expm1(x) / x }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn relative(value: f64, exact: f64) -> f64 {
        if value == exact { 0.0 } else { ((value - exact) / exact).abs() }
    }

    /// The table at the top of this file, against 50-digit values.
    #[test]
    fn stored_values() {
        let table = include_str!("../../../reference/special.csv");
        let mut rows = 0;
        for line in table.lines().filter(|line| !line.starts_with('#')) {
            let mut fields = line.split(',');
            let mut field = || fields.next().expect("three fields");
            let name = field();
            let x: f64 = field().parse().expect("a number");
            let exact: f64 = field().parse().expect("a number");
            let (value, bound) = match name {
                "i0e" => (bessel_i0_scaled(x), 8e-16),
                "i1e" => (bessel_i1_scaled(x), 1.1e-15),
                "erf" => (erf(x), 3e-16),
                "erfc" => (erfc(x), 3e-16),
                "erfcx" => (erfcx(x), 1e-15),
                "dawson" => (dawson(x), 3e-16),
                "exp" => (exp(x), 3e-16),
                "expm1" => (expm1(x), 3e-16),
                "ln_1p" => (ln_1p(x), 3e-16),
                other => panic!("unknown function {other}"),
            };
            let error = relative(value, exact);
            assert!(error <= bound, "{name}({x}) = {value:e}, should be {exact:e}: {error:e}");
            rows += 1;
        }
        assert!(rows > 700, "only {rows} rows");
    }

    /// Two independent implementations of I₀ and I₁.
    #[test]
    fn bessel_agrees_with_amos() {
        for k in 0..400 {
            let x = libm::exp(-7.0 + 0.035 * f64::from(k));
            let z = num_complex::Complex::new(x, 0.0);
            let i0 = complex_bessel::besseli_scaled(0.0, z).expect("in range").re;
            let i1 = complex_bessel::besseli_scaled(1.0, z).expect("in range").re;
            assert!(relative(bessel_i0_scaled(x), i0) < 2e-15, "I0 at {x}");
            assert!(relative(bessel_i1_scaled(x), i1) < 2e-15, "I1 at {x}");
        }
    }

    /// erf + erfc = 1; erfcx and Dawson from their differential equations y' = 2xy − 2/√π, y' = 1 − 2xy.
    #[test]
    fn identities() {
        let h = 1e-3;
        let difference = |f: &dyn Fn(f64) -> f64, x: f64| {
            (8.0 * (f(x + h) - f(x - h)) - (f(x + 2.0 * h) - f(x - 2.0 * h))) / (12.0 * h)
        };
        for k in -20..200 {
            let x = 0.05 * f64::from(k);
            assert!((erf(x) + erfc(x) - 1.0).abs() < 4e-16);
            let d = difference(&dawson, x);
            assert!((d - (1.0 - 2.0 * x * dawson(x))).abs() < 1e-11, "Dawson at {x}: {d}");
            let e = difference(&erfcx, x);
            let slope = 2.0 * x * erfcx(x) - core::f64::consts::FRAC_2_SQRT_PI;
            assert!((e - slope).abs() < 1e-9 * (1.0 + slope.abs()), "erfcx at {x}: {e} {slope}");
        }
    }

    #[test]
    fn symmetries_and_ends() {
        for x in [1e-8, 0.3, 2.0, 7.9, 8.1, 40.0] {
            assert_eq!(bessel_i0_scaled(-x), bessel_i0_scaled(x));
            assert_eq!(bessel_i1_scaled(-x), -bessel_i1_scaled(x));
            assert_eq!(dawson(-x), -dawson(x));
        }
        assert_eq!(bessel_i0_scaled(0.0), 1.0);
        assert_eq!(erfcx(0.0), 1.0);
        assert_eq!(dawson(0.0), 0.0);
        assert_eq!(expm1_over(0.0), 1.0);
        assert!(bessel_i0_scaled(1e300) > 0.0);
        assert!(erfcx(1e300) > 0.0);
        assert_eq!(erfcx(-30.0), f64::INFINITY);
    }
}
