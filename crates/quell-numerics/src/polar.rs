//! Modulus, argument and square root of complex numbers, with the same bits on every machine.
//!
//! The methods of `num_complex` call the mathematics library of the platform.

use num_complex::Complex64;

/// |z|.
#[must_use]
pub fn modulus(z: Complex64) -> f64 {
    libm::hypot(z.re, z.im)
}

/// arg z in (−π, π].
#[must_use]
pub fn argument(z: Complex64) -> f64 {
    libm::atan2(z.im, z.re)
}

/// r e^{iθ}.
#[must_use]
pub fn from_polar(modulus: f64, argument: f64) -> Complex64 {
    let (sine, cosine) = libm::sincos(argument);
    Complex64::new(modulus * cosine, modulus * sine)
}

/// √z with Re √z ≥ 0, without cancellation.
#[must_use]
pub fn square_root(z: Complex64) -> Complex64 {
    let larger = libm::sqrt(0.5 * (modulus(z) + z.re.abs()));
    if larger == 0.0 {
        return z;
    }
    let smaller = 0.5 * z.im.abs() / larger;
    if z.re >= 0.0 {
        Complex64::new(larger, smaller.copysign(z.im))
    } else {
        Complex64::new(smaller, larger.copysign(z.im))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_and_polar_forms_give_the_number_back() {
        for (re, im) in
            [(3.0, -4.0), (-3.0, 4.0), (-1e-9, -2.0), (0.0, 1.0), (-4.0, 0.0), (2.0, 0.0)]
        {
            let z = Complex64::new(re, im);
            let root = square_root(z);
            assert!(root.re >= 0.0 && modulus(root * root - z) <= 1e-15 * modulus(z), "{z}");
            let back = from_polar(modulus(z), argument(z));
            assert!(modulus(back - z) <= 1e-15 * modulus(z), "{z} {back}");
        }
        assert_eq!(square_root(Complex64::ZERO), Complex64::ZERO);
    }
}
