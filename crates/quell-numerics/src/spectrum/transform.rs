//! The discrete Fourier transform of real numbers, X_j = Σ x_k e^{−2πi jk/n}, with the same bits on every machine.
//!
//! Decimation in time over the factors of n, with the butterflies of Cooley and Tukey (*Math. Comp.* 19 (1965) 297); a length with a large
//! prime factor is a convolution of a power of two (Bluestein, *IEEE Trans. Audio Electroacoust.* 18 (1970) 451). Each root of unity is a sine and a
//! cosine of its own, none a product of others, so that the error grows like log n. It is plain arithmetic on one number at a time: libraries
//! take the sines of the platform and sum in the order that suits the processor.

use core::f64::consts::TAU;

use num_complex::Complex64;

/// The largest prime factor p whose butterfly is summed directly, with p products a value; the convolution takes about four log₂ n.
const LARGEST_FACTOR: usize = 31;

/// The lines 0 … n/2 of the transform of an even number n of real values.
pub(super) fn real_lines(values: &[f64]) -> Vec<Complex64> {
    // Even and odd values as the two parts of one complex record of half the length.
    let half = values.len() / 2;
    let pairs: Vec<Complex64> =
        values.chunks_exact(2).map(|pair| Complex64::new(pair[0], pair[1])).collect();
    let mixed = transform(&pairs);
    (0..=half)
        .map(|j| {
            let (line, mirror) = (mixed[j % half], mixed[(half - j) % half].conj());
            let odd = Complex64::new(0.0, -0.5) * (line - mirror);
            (line + mirror) * 0.5 + root_of_unity(j, values.len()) * odd
        })
        .collect()
}

/// e^{−2πi k/n} for k < n.
fn root_of_unity(k: usize, n: usize) -> Complex64 {
    let (sine, cosine) = libm::sincos(TAU * (k as f64 / n as f64));
    Complex64::new(cosine, -sine)
}

/// The transform of complex values.
fn transform(values: &[Complex64]) -> Vec<Complex64> {
    let n = values.len();
    if largest_factor(n) > LARGEST_FACTOR {
        return by_convolution(values);
    }
    by_factors(values, &roots_of_unity(n))
}

/// e^{−2πi k/n} for all k < n.
fn roots_of_unity(n: usize) -> Vec<Complex64> {
    (0..n).map(|k| root_of_unity(k, n)).collect()
}

/// The transform of as many values as there are roots, by butterflies.
fn by_factors(values: &[Complex64], roots: &[Complex64]) -> Vec<Complex64> {
    let mut lines = vec![Complex64::ZERO; values.len()];
    decimate(values, 0, 1, roots, &mut lines);
    lines
}

/// The smallest factor above 1 by which a part of length n is divided, four before two.
fn factor_of(n: usize) -> usize {
    if n.is_multiple_of(4) {
        return 4;
    }
    (2..=n.isqrt()).find(|p| n.is_multiple_of(*p)).unwrap_or(n)
}

fn largest_factor(mut n: usize) -> usize {
    let mut largest = 1;
    while n > 1 {
        let factor = factor_of(n);
        largest = largest.max(factor);
        n /= factor;
    }
    largest
}

/// Writes the transform of the values first, first + stride, … into `lines`; `roots` are those of the whole length, of which `lines` has
/// the part 1/stride.
fn decimate(
    values: &[Complex64],
    first: usize,
    stride: usize,
    roots: &[Complex64],
    lines: &mut [Complex64],
) {
    let n = lines.len();
    if n == 1 {
        lines[0] = values[first];
        return;
    }
    let count = factor_of(n);
    let length = n / count;
    for (part, own) in lines.chunks_exact_mut(length).enumerate() {
        decimate(values, first + part * stride, stride * count, roots, own);
    }
    let mut terms = [Complex64::ZERO; LARGEST_FACTOR];
    let terms = &mut terms[..count];
    for k in 0..length {
        for (part, term) in terms.iter_mut().enumerate() {
            *term = lines[part * length + k] * roots[part * k * stride];
        }
        match *terms {
            [a, b] => {
                lines[k] = a + b;
                lines[k + length] = a - b;
            }
            [a, b, c, d] => {
                let (even, odd) = (b + d, b - d);
                let turned = Complex64::new(odd.im, -odd.re);
                let (sum, difference) = (a + c, a - c);
                lines[k] = sum + even;
                lines[k + length] = difference + turned;
                lines[k + 2 * length] = sum - even;
                lines[k + 3 * length] = difference - turned;
            }
            _ => {
                for q in 0..count {
                    let turn = |part: usize| roots[(part * q % count) * length * stride];
                    let terms = terms.iter().enumerate();
                    lines[k + q * length] = terms.map(|(part, term)| term * turn(part)).sum();
                }
            }
        }
    }
}

/// The transform by Bluestein's convolution: jk = (j² + k² − (j − k)²)/2.
fn by_convolution(values: &[Complex64]) -> Vec<Complex64> {
    let n = values.len();
    let size = (2 * n - 1).next_power_of_two();
    // e^{−πi k²/n}; k² is reduced before it is rounded.
    let chirp: Vec<Complex64> = (0..n)
        .map(|k| {
            let square = (k as u128 * k as u128 % (2 * n) as u128) as usize;
            root_of_unity(square, 2 * n)
        })
        .collect();
    let mut turned = vec![Complex64::ZERO; size];
    let mut kernel = vec![Complex64::ZERO; size];
    for (k, (value, chirp)) in values.iter().zip(&chirp).enumerate() {
        turned[k] = value * chirp;
        kernel[k] = chirp.conj();
        kernel[(size - k) % size] = chirp.conj();
    }
    let roots = roots_of_unity(size);
    let (turned, kernel) = (by_factors(&turned, &roots), by_factors(&kernel, &roots));
    // The inverse transform is the conjugate of that of conjugates.
    let product: Vec<Complex64> = turned.iter().zip(&kernel).map(|(a, b)| (a * b).conj()).collect();
    let back = by_factors(&product, &roots);
    back.iter().zip(&chirp).map(|(line, chirp)| line.conj() / size as f64 * chirp).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sum itself, for lengths with small factors, large primes and powers of two.
    #[test]
    fn lines_are_the_sums_that_define_them() {
        for n in [8, 12, 30, 64, 98, 120, 148, 404, 1000, 1024, 2018, 4 * 1009] {
            let values: Vec<f64> = (0..n)
                .map(|k| libm::sin(0.37 * (k * k) as f64) + 0.2 * k as f64 / n as f64)
                .collect();
            let lines = real_lines(&values);
            assert_eq!(lines.len(), n / 2 + 1);
            let size: f64 = values.iter().map(|x| x.abs()).sum();
            for (j, line) in lines.iter().enumerate() {
                let exact: Complex64 =
                    (0..n).map(|k| root_of_unity(j * k % n, n) * values[k]).sum();
                let off = crate::polar::modulus(line - exact) / size;
                assert!(off < 2e-15, "{n}, line {j}: {off:e}");
            }
        }
    }
}
