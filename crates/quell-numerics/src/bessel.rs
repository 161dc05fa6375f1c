//! Bessel functions of integer order and positive argument, each with its next order; I and K are scaled exponentially.
//!
//! Every function returns the values of orders n and n + 1, from which the derivative follows without a further call,
//!
//! ```text
//! J' = (n/x) J − Jₙ₊₁     Y' = (n/x) Y − Yₙ₊₁     I' = (n/x) I + Iₙ₊₁     K' = (n/x) K − Kₙ₊₁
//! ```
//!
//! and the second derivative follows from Bessel's equation. I is multiplied by e^{−x} and K by e^{x}: the unscaled functions
//! leave the range of `f64` beyond x ≈ 713. The values are those of D. E. Amos's algorithms (ACM TOMS 644), as
//! implemented by the crate `complex-bessel`. Products of J and Y, and of I and K, satisfy the Wronskian identities within
//! 10⁻¹³ for n ≤ 21 and 10⁻² ≤ x ≤ 10³ (see the tests below); frequencies computed from them agree with 40-digit arithmetic
//! to 2·10⁻¹⁵ (`quell-disc`, `plate`).

use complex_bessel::{
    BesselResult, Error, Scaling, besseli_seq, besselj_seq, besselk_seq, bessely_seq,
};
use realfft::num_complex::Complex;

/// Values of the orders n and n + 1.
pub type Neighbours = [f64; 2];

type Sequence = fn(f64, Complex<f64>, usize, Scaling) -> Result<BesselResult<f64>, Error>;

/// The two values; `None` if x is not positive or a value is out of the range of `f64`.
fn neighbours(sequence: Sequence, order: u32, x: f64, scaling: Scaling) -> Option<Neighbours> {
    if !(x > 0.0 && x.is_finite()) {
        return None;
    }
    let values = sequence(f64::from(order), Complex::new(x, 0.0), 2, scaling).ok()?.values;
    let pair = [values.first()?.re, values.get(1)?.re];
    pair.iter().all(|value| value.is_finite()).then_some(pair)
}

/// Jₙ(x) and Jₙ₊₁(x); `None` if x is not positive or too large for any correct digit (x > 10⁹).
#[must_use]
pub fn bessel_j(order: u32, x: f64) -> Option<Neighbours> {
    neighbours(besselj_seq, order, x, Scaling::Unscaled)
}

/// Yₙ(x) and Yₙ₊₁(x); `None` if x is not positive, or so small that −Y is out of the range of `f64`.
#[must_use]
pub fn bessel_y(order: u32, x: f64) -> Option<Neighbours> {
    neighbours(bessely_seq, order, x, Scaling::Unscaled)
}

/// e^{−x} Iₙ(x) and e^{−x} Iₙ₊₁(x); `None` if x is not positive.
#[must_use]
pub fn bessel_i_scaled(order: u32, x: f64) -> Option<Neighbours> {
    neighbours(besseli_seq, order, x, Scaling::Exponential)
}

/// eˣ Kₙ(x) and eˣ Kₙ₊₁(x); `None` if x is not positive, or so small that K is out of the range of `f64`.
#[must_use]
pub fn bessel_k_scaled(order: u32, x: f64) -> Option<Neighbours> {
    neighbours(besselk_seq, order, x, Scaling::Exponential)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Jₙ₊₁Yₙ − JₙYₙ₊₁ = 2/(πx) and IₙKₙ₊₁ + Iₙ₊₁Kₙ = 1/x.
    #[test]
    fn wronskians() {
        for order in 0..=21 {
            for step in 0..=50 {
                let x = libm::pow(10.0, -2.0 + 0.1 * f64::from(step));
                let [j, j_next] = bessel_j(order, x).expect("in range");
                let [y, y_next] = bessel_y(order, x).expect("in range");
                let wave = (j_next * y - j * y_next) * core::f64::consts::FRAC_PI_2 * x;
                assert!((wave - 1.0).abs() < 1e-13, "J, Y: n {order}, x {x}: {:e}", wave - 1.0);
                let [i, i_next] = bessel_i_scaled(order, x).expect("in range");
                let [k, k_next] = bessel_k_scaled(order, x).expect("in range");
                let decay = (i * k_next + i_next * k) * x;
                assert!((decay - 1.0).abs() < 1e-13, "I, K: n {order}, x {x}: {:e}", decay - 1.0);
            }
        }
    }

    /// J₀(1), Y₀(1), I₀(1), K₀(1) and the next order, from published tables.
    #[test]
    fn table_values() {
        let close = |pair: Option<Neighbours>, exact: Neighbours| {
            let pair = pair.expect("in range");
            assert!(
                pair.iter().zip(exact).all(|(a, b)| (a - b).abs() < 1e-15),
                "{pair:?} {exact:?}"
            );
        };
        let e = core::f64::consts::E;
        close(bessel_j(0, 1.0), [0.7651976865579666, 0.44005058574493355]);
        close(bessel_y(0, 1.0), [0.08825696421567697, -0.7812128213002887]);
        close(bessel_i_scaled(0, 1.0), [1.2660658777520084 / e, 0.565159103992485 / e]);
        close(bessel_k_scaled(0, 1.0), [0.42102443824070834 * e, 0.6019072301972346 * e]);
        assert_eq!(bessel_y(0, 0.0), None);
        assert_eq!(bessel_j(3, f64::NAN), None);
        assert_eq!(bessel_k_scaled(40, 1e-30), None);
    }
}
