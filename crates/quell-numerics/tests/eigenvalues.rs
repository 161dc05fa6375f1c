//! Eigenvalues of the own iteration against `faer` and against known eigenvalues.

use num_complex::Complex64;
use quell_numerics::eigen::{Decomposition, eigenvalues};
use quell_numerics::matrix::Matrix;
use quell_numerics::polar::modulus;

/// Random numbers in (−1, 1) with a fixed seed: SplitMix64.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn matrix(&mut self, n: usize) -> Matrix {
        let mut a = Matrix::zeros(n, n);
        a.as_mut_slice().fill_with(|| self.next());
        a
    }
}

fn by_faer(a: &Matrix) -> Vec<Complex64> {
    faer::Mat::from_fn(a.rows(), a.rows(), |i, j| a[(i, j)]).eigenvalues().expect("converges")
}

/// Largest distance when each value is paired with the nearest unpaired one.
fn distance(ours: &[Complex64], others: &[Complex64]) -> f64 {
    let mut left = others.to_vec();
    let mut largest = 0.0f64;
    for &value in ours {
        let (at, gap) = left
            .iter()
            .enumerate()
            .map(|(at, &other)| (at, modulus(value - other)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .expect("as many");
        left.swap_remove(at);
        largest = largest.max(gap);
    }
    largest
}

/// Allowed distance: a perturbation of n ε ‖A‖ times the condition number for simple eigenvalues, the square root of the
/// perturbation for double ones.
fn allowed(a: &Matrix) -> f64 {
    let decomposition = Decomposition::new(a).expect("converges");
    let worst = (0..a.rows()).map(|i| decomposition.pair(i).condition).fold(1.0, f64::max);
    let error = decomposition.backward_error();
    (2.0 * worst * error).min(10.0 * (error * decomposition.norm()).sqrt())
}

#[test]
fn random_matrices_agree_with_faer() {
    let mut numbers = Numbers(1);
    for case in 0..4000 {
        let n = 1 + case % 24;
        let a = numbers.matrix(n);
        let gap = distance(&eigenvalues(&a).expect("converges"), &by_faer(&a));
        let allowed = allowed(&a);
        assert!(gap <= allowed.max(1e-14), "case {case}, n = {n}: {gap:e} {allowed:e}");
    }
}

#[test]
fn large_matrices_agree_with_faer() {
    let mut numbers = Numbers(2);
    for n in [44, 44, 45, 60, 97] {
        let a = numbers.matrix(n);
        let gap = distance(&eigenvalues(&a).expect("converges"), &by_faer(&a));
        assert!(gap <= allowed(&a), "n = {n}: {gap:e}");
    }
}

#[test]
fn badly_scaled_matrices_keep_their_eigenvalues() {
    // D⁻¹AD with powers of two over twenty orders of magnitude in D has exactly the eigenvalues of A.
    let mut numbers = Numbers(3);
    for case in 0..300 {
        let n = 2 + case % 15;
        let a = numbers.matrix(n);
        let scales: Vec<f64> = (0..n).map(|_| (35.0 * numbers.next()).round().exp2()).collect();
        let scaled = Matrix::from_fn(n, n, |i, j| a[(i, j)] / scales[i] * scales[j]);
        let gap = distance(&eigenvalues(&scaled).expect("converges"), &by_faer(&a));
        let allowed = 4.0 * allowed(&a).max(1e-14);
        assert!(gap <= allowed, "case {case}, n = {n}: {gap:e} {allowed:e}");
    }
}

#[test]
fn defective_matrices_lose_half_the_digits_and_have_large_condition_numbers() {
    // A 2 × 2 Jordan block under a random similarity transformation.
    let mut numbers = Numbers(4);
    for case in 0..200 {
        let n = 3 + case % 6;
        let mut block = Matrix::from_fn(n, n, |i, j| if i == j { 2.0 + i as f64 } else { 0.0 });
        block[(0, 0)] = 1.0;
        block[(1, 1)] = 1.0;
        block[(0, 1)] = 1.0;
        let mut p = numbers.matrix(n);
        p.add_scaled(3.0, &Matrix::identity(n));
        let a = p.solve(&block.times(&p)).expect("regular");
        let decomposition = Decomposition::new(&a).expect("converges");
        let planted: Vec<Complex64> = (0..n).map(|i| Complex64::new(block[(i, i)], 0.0)).collect();
        let gap = distance(decomposition.values(), &planted);
        assert!(gap < 1e-5, "case {case}: {gap:e}");
        let double = (0..n)
            .filter(|&i| modulus(decomposition.values()[i] - 1.0) < 1e-3)
            .map(|i| decomposition.pair(i).condition)
            .fold(0.0, f64::max);
        assert!(double > 1e5, "case {case}: condition {double:e}");
    }
}

#[test]
fn eigenvectors_satisfy_their_equations() {
    let mut numbers = Numbers(5);
    for n in [2, 3, 5, 10, 22, 44] {
        let a = numbers.matrix(n);
        let decomposition = Decomposition::new(&a).expect("converges");
        for index in 0..n {
            let pair = decomposition.pair(index);
            let (mut right, mut left, mut product) = (0.0f64, 0.0f64, Complex64::new(0.0, 0.0));
            for i in 0..n {
                let ax: Complex64 = (0..n).map(|j| pair.right[j] * a[(i, j)]).sum();
                let ya: Complex64 = (0..n).map(|j| pair.left[j] * a[(j, i)]).sum();
                right = right.max(modulus(ax - pair.value * pair.right[i]));
                left = left.max(modulus(ya - pair.value * pair.left[i]));
                product += pair.left[i] * pair.right[i];
            }
            let bound = 1e-12 * pair.condition;
            assert!(right < bound && left < bound, "n = {n}, {index}: {right:e} {left:e}");
            assert!(modulus(product - 1.0) < 1e-12 * pair.condition);
        }
    }
}

#[test]
fn special_matrices_are_solved() {
    // Zero, identity, and a cyclic shift, whose eigenvalues have equal moduli, so that QR without
    // exceptional shifts stagnates.
    for n in [1, 2, 3, 8, 9] {
        let zero = eigenvalues(&Matrix::zeros(n, n)).expect("zero");
        assert_eq!(zero, vec![Complex64::new(0.0, 0.0); n]);
        let identity = eigenvalues(&Matrix::identity(n)).expect("identity");
        assert_eq!(identity, vec![Complex64::new(1.0, 0.0); n]);
        let cycle = Matrix::from_fn(n, n, |i, j| f64::from(u8::from((i + 1) % n == j)));
        for value in eigenvalues(&cycle).expect("cycle") {
            let power = (0..n).fold(Complex64::new(1.0, 0.0), |power, _| power * value);
            assert!(modulus(power - 1.0) < 1e-13, "n = {n}: {value}");
        }
    }
    let broken = Matrix::from_fn(3, 3, |_, _| f64::NAN);
    assert!(eigenvalues(&broken).is_err());
}
