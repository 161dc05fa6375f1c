//! Floquet exponents: measured orders, exact solutions, validity of the error bounds.

use num_complex::Complex64;
use quell_numerics::eigen::Decomposition;
use quell_numerics::floquet::{ConstantFlow, Effort, Floquet, Phase};
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

    fn matrix(&mut self, rows: usize, columns: usize) -> Matrix {
        let mut a = Matrix::zeros(rows, columns);
        a.as_mut_slice().fill_with(|| self.next());
        a
    }
}

/// Oscillators y″ = −Ky − Cy′ + u φ sᵀy as x′ = (A₀ + UΦVᵀ)x with VᵀU = 0 (forces depend on displacements only), or
/// with forces that also depend on velocities, VᵀU ≠ 0.
fn oscillators(
    numbers: &mut Numbers,
    n: usize,
    rank: usize,
    nilpotent: bool,
) -> (Matrix, Matrix, Matrix) {
    let (k, c) = (numbers.matrix(n, n), numbers.matrix(n, n));
    let a = Matrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, _) => f64::from(u8::from(j == i + n)),
        (false, true) => {
            let diagonal = if i - n == j { 1.0 + j as f64 } else { 0.0 };
            -diagonal - 0.1 * k[(i - n, j)]
        }
        (false, false) => {
            let diagonal = if i == j { 0.02 } else { 0.0 };
            -diagonal - 0.01 * c[(i - n, j - n)]
        }
    });
    let (left, right) = (numbers.matrix(n, rank), numbers.matrix(2 * n, rank));
    let u = Matrix::from_fn(2 * n, rank, |i, l| if i < n { 0.0 } else { left[(i - n, l)] });
    let v =
        Matrix::from_fn(2 * n, rank, |i, l| if i < n || !nilpotent { right[(i, l)] } else { 0.0 });
    (a, u, v)
}

/// Φ = 0.3·(1 + ½ cos θ + ¼ sin 2θ) on the diagonal, with smaller off-diagonal entries.
fn phi(phase: Phase, to: &mut Matrix) {
    let double = 2.0 * phase.sine * phase.cosine;
    for i in 0..to.rows() {
        for j in 0..to.columns() {
            to[(i, j)] = if i == j {
                0.3 * (1.0 + 0.5 * phase.cosine + 0.25 * double)
            } else {
                0.1 * phase.sine - 0.05 * j as f64
            };
        }
    }
}

fn growth_of(multipliers: &[Complex64], period: f64) -> f64 {
    multipliers.iter().map(|z| modulus(*z)).fold(0.0, f64::max).ln() / period
}

#[test]
fn the_order_is_four_for_nilpotent_kicks_and_two_otherwise() {
    let mut numbers = Numbers(11);
    for (rank, nilpotent, order) in
        [(1, true, 4.0), (2, true, 4.0), (3, true, 4.0), (1, false, 2.0), (2, false, 2.0)]
    {
        for _ in 0..5 {
            let (a, u, v) = oscillators(&mut numbers, 4, rank, nilpotent);
            let flow = ConstantFlow::new(&a, &u, &v).expect("finite");
            assert_eq!(flow.is_nilpotent(), nilpotent);
            let period = 2.0;
            let engine = Floquet::new(flow, period);
            let at = |count| growth_of(&engine.multipliers(&phi, count).expect("finite"), period);
            let (coarse, middle, fine) = (at(16), at(32), at(64));
            let measured = ((coarse - middle) / (middle - fine)).abs().log2();
            assert!(
                (measured - order).abs() < 0.3,
                "rank {rank}, nilpotent {nilpotent}: {measured}"
            );
        }
    }
}

#[test]
fn the_error_bound_holds() {
    let mut numbers = Numbers(12);
    let effort = Effort { enough: f64::INFINITY, ..Effort::default() };
    for case in 0..120 {
        let (rank, nilpotent) = (1 + case % 3, case % 2 == 0);
        let (a, u, v) = oscillators(&mut numbers, 2 + case % 5, rank, nilpotent);
        let flow = ConstantFlow::new(&a, &u, &v).expect("finite");
        let period = 1.0 + 0.02 * case as f64;
        let exact =
            Floquet::with_steps(flow.clone(), period, 2048).growth(&phi, effort).expect("finite");
        for count in [16, 32, 64, 128] {
            let found = Floquet::with_steps(flow.clone(), period, count)
                .growth(&phi, effort)
                .expect("finite");
            let gap = (found.growth_rate - exact.growth_rate).abs();
            assert!(
                gap <= found.error + exact.error,
                "case {case}, N = {count}: {gap:e} {:e}",
                found.error
            );
        }
    }
}

#[test]
fn without_dither_exponents_are_eigenvalues() {
    let mut numbers = Numbers(13);
    for case in 0..60 {
        let (a, u, v) = oscillators(&mut numbers, 2 + case % 5, 1 + case % 2, case % 3 != 0);
        let constant = |_: Phase, to: &mut Matrix| {
            to.as_mut_slice().fill(0.0);
            for i in 0..to.rows() {
                to[(i, i)] = 0.4;
            }
        };
        let flow = ConstantFlow::new(&a, &u, &v).expect("finite");
        let found = Floquet::new(flow, 1.7).growth(&constant, Effort::default()).expect("finite");
        let mut whole = a.clone();
        whole.add_scaled(0.4, &u.times(&v.transpose()));
        let wanted = Decomposition::new(&whole).expect("finite").rightmost().expect("has rows");
        let gap = (found.growth_rate - wanted.value.re).abs();
        assert!(gap <= found.error + wanted.error, "case {case}: {gap:e} {:e}", found.error);
        assert!(found.error < 1e-4);
    }
}

#[test]
fn a_scalar_system_grows_at_the_mean_rate() {
    let one = |value| Matrix::from_fn(1, 1, |_, _| value);
    let flow = ConstantFlow::new(&one(-0.2), &one(1.0), &one(1.0)).expect("finite");
    let force = |phase: Phase, to: &mut Matrix| to[(0, 0)] = 0.3 + 0.7 * phase.cosine;
    let found = Floquet::new(flow, 3.0).growth(&force, Effort::default()).expect("finite");
    assert!((found.growth_rate - 0.1).abs() < 1e-14 && found.error < 1e-12, "{found:?}");
}

#[test]
fn multiple_eigenvalues_are_handled() {
    // Two equal oscillators with cross-coupled forces: double eigenvalues with two vectors each; and a
    // defective pair (free motion, no spring).
    for spring in [1.0, 0.0] {
        let a = Matrix::from_fn(4, 4, |i, j| match (i, j) {
            (0, 2) | (1, 3) => 1.0,
            (2, 0) | (3, 1) => -spring,
            (2, 2) | (3, 3) => -0.1,
            _ => 0.0,
        });
        let u = Matrix::from_fn(4, 2, |i, l| f64::from(u8::from(i == l + 2)));
        let v = Matrix::from_fn(4, 2, |i, l| f64::from(u8::from(i == 1 - l)));
        let force = |_: Phase, to: &mut Matrix| {
            (to[(0, 0)], to[(0, 1)], to[(1, 0)], to[(1, 1)]) = (0.3, 0.0, 0.0, -0.3);
        };
        let flow = ConstantFlow::new(&a, &u, &v).expect("finite");
        let found = Floquet::new(flow, 1.3).growth(&force, Effort::default()).expect("finite");
        // y″ + 0.1y′ + (spring ∓ 0.3i) y = 0 for y = A ± iB.
        let root = (Complex64::new(0.0025 - spring, 0.3)).sqrt();
        let wanted = -0.05 + root.re.abs();
        let gap = (found.growth_rate - wanted).abs();
        assert!(gap <= found.error && found.error < 1e-9, "spring {spring}: {gap:e} {found:?}");
    }
}

/// A constant part with one eigenvector for two equal eigenvalues has no modal coordinates: the same system, split differently
/// into constant part and kicks so that modal coordinates exist, has the same exponents.
#[test]
fn a_defective_constant_part_is_handled() {
    // y″ + 2cy′ + (k + s(t))y = 0; at k = c² the constant part is defective.
    let damping = 0.15;
    let growth = |spring: f64| {
        let a = Matrix::from_fn(2, 2, |i, j| match (i, j) {
            (0, 1) => 1.0,
            (1, 0) => -spring,
            (1, 1) => -2.0 * damping,
            _ => 0.0,
        });
        let u = Matrix::from_fn(2, 1, |i, _| i as f64);
        let v = Matrix::from_fn(2, 1, |i, _| 1.0 - i as f64);
        let force = |phase: Phase, to: &mut Matrix| {
            to[(0, 0)] = spring - (1.0 + 0.8 * phase.cosine);
        };
        let flow = ConstantFlow::new(&a, &u, &v).expect("finite");
        Floquet::new(flow, 3.0).growth(&force, Effort::default()).expect("finite")
    };
    let (defective, modal) = (growth(damping * damping), growth(1.0));
    assert!(modal.growth_rate > 0.02, "in the first tongue: {modal:?}");
    let gap = (defective.growth_rate - modal.growth_rate).abs();
    assert!(gap <= defective.error + modal.error, "{gap:e} {defective:?} {modal:?}");
    assert!(defective.error < 1e-6 && modal.error < 1e-6, "{defective:?} {modal:?}");
}
