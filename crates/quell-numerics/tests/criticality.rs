//! Coefficients of normal forms: maps and flows whose coefficient is known, in coordinates that hide it.

use num_complex::Complex64;
use quell_numerics::continuation::criticality::{Criticality, NoFirstLyapunov, first_lyapunov};
use quell_numerics::continuation::threshold::BifurcationKind;
use quell_numerics::continuation::{Image, PeriodMap};
use quell_numerics::eigen::Decomposition;
use quell_numerics::matrix::Matrix;
use quell_numerics::normal_form::{CriticalPair, DerivativesAlong, hopf};

const ROWS: [[f64; 3]; 3] = [[1.0, 0.4, -0.3], [0.2, 1.3, 0.5], [-0.6, 0.1, 0.9]];

/// Entry and row of a shear, and the coefficients of its square and cube.
const SHEARS: [(usize, usize, f64, f64); 4] =
    [(0, 1, 0.7, -0.4), (2, 0, -0.5, 0.9), (1, 2, 1.1, 0.3), (0, 2, -0.8, 0.2)];

/// A map in its own coordinates: image and derivative.
type OwnMap = fn([f64; 3]) -> ([f64; 3], [[f64; 3]; 3]);

/// A map in the plane of w and a decaying number s, which feed each other by square terms, seen in sheared coordinates.
struct Planted {
    /// The image of (x, y, s) with its derivative in its own coordinates.
    own: OwnMap,
    /// Distance from the fixed point beyond which the signature differs.
    border: f64,
}

fn apply(rows: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|j| rows[i][j] * x[j]).sum())
}

/// One shear, forth (sign 1) or back (sign −1), and its derivative.
fn shear(
    (to, from, square, cube): (usize, usize, f64, f64),
    x: &mut [f64; 3],
    sign: f64,
) -> [[f64; 3]; 3] {
    let u = x[from];
    x[to] += sign * (square * u * u + cube * u * u * u);
    let mut rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    rows[to][from] = sign * (2.0 * square * u + 3.0 * cube * u * u);
    rows
}

fn inverse() -> [[f64; 3]; 3] {
    let unit = Matrix::identity(3);
    let solved = Matrix::from_fn(3, 3, |i, j| ROWS[i][j]).solve(&unit).expect("regular");
    std::array::from_fn(|i| std::array::from_fn(|j| solved[(i, j)]))
}

impl PeriodMap for Planted {
    type Signature = bool;
    type Error = ();

    fn dimension(&self) -> usize {
        3
    }

    fn scale(&self) -> f64 {
        1.0
    }

    fn image(&self, state: &[f64], _: &[f64], _: Option<&bool>) -> Result<Image<bool>, ()> {
        let mut x = [state[0], state[1], state[2]];
        let far = x.iter().any(|x| x.abs() > self.border);
        let mut derivative = Matrix::identity(3);
        let mut then = |rows: [[f64; 3]; 3]| {
            derivative = Matrix::from_fn(3, 3, |i, j| rows[i][j]).times(&derivative);
        };
        for one in SHEARS.iter().rev() {
            then(shear(*one, &mut x, -1.0));
        }
        x = apply(&inverse(), x);
        then(inverse());
        let (image, rows) = (self.own)(x);
        then(rows);
        x = apply(&ROWS, image);
        then(ROWS);
        for one in SHEARS {
            then(shear(one, &mut x, 1.0));
        }
        Ok(Image { state: x.to_vec(), derivative, distance: f64::INFINITY, signature: far })
    }
}

/// w → e^{iθ}w(1 + d|w|²), s → s/3.
fn turned(x: [f64; 3], angle: f64, d: Complex64) -> ([f64; 3], [[f64; 3]; 3]) {
    let turn = Complex64::from_polar(1.0, angle);
    let w = Complex64::new(x[0], x[1]);
    let image = turn * w * (1.0 + d * w.norm_sqr());
    let by = |change: Complex64| {
        let growth = 2.0 * (w.conj() * change).re;
        turn * (change * (1.0 + d * w.norm_sqr()) + w * d * growth)
    };
    let (a, b) = (by(Complex64::new(1.0, 0.0)), by(Complex64::new(0.0, 1.0)));
    let rows = [[a.re, b.re, 0.0], [a.im, b.im, 0.0], [0.0, 0.0, 1.0 / 3.0]];
    ([image.re, image.im, x[2] / 3.0], rows)
}

/// The square of the norm of the first two numbers of the critical vector that is (1, −i, 0)/2 in own coordinates.
fn square_of_norm() -> f64 {
    let q = [Complex64::new(0.5, 0.0), Complex64::new(0.0, -0.5)];
    (0..2).map(|i| (ROWS[i][0] * q[0] + ROWS[i][1] * q[1]).norm_sqr()).sum()
}

#[test]
fn a_planted_neimark_sacker_coefficient_is_found() {
    let maps: [(Planted, f64); 2] = [
        (Planted { own: |x| turned(x, 1.1, Complex64::new(-0.3, 0.8)), border: 2.0 }, -0.3),
        (Planted { own: |x| turned(x, 2.4, Complex64::new(0.07, -0.5)), border: 0.01 }, 0.07),
    ];
    for (map, planted) in maps {
        let kind = BifurcationKind::NeimarkSacker;
        let found = first_lyapunov(&map, &[0.0; 3], &[], kind, 2).expect("smooth");
        let expected = planted / square_of_norm();
        let off = (found.value - expected).abs();
        assert!(off <= found.error, "{found:?} {expected}");
        assert!(found.error < 1e-3 * expected.abs(), "{found:?}");
        let sign =
            if planted < 0.0 { Criticality::Supercritical } else { Criticality::Subcritical };
        assert_eq!(found.criticality(), Some(sign));
    }
}

#[test]
fn strong_resonances_are_refused() {
    for (order, angle) in [(1, 0.002), (2, 3.1413), (3, 2.0945), (4, 1.5709)] {
        // The angle cannot be captured: one map for each.
        let own: fn([f64; 3]) -> _ = match order {
            1 => |x| turned(x, 0.002, Complex64::new(-1.0, 0.0)),
            2 => |x| turned(x, 3.1413, Complex64::new(-1.0, 0.0)),
            3 => |x| turned(x, 2.0945, Complex64::new(-1.0, 0.0)),
            _ => |x| turned(x, 1.5709, Complex64::new(-1.0, 0.0)),
        };
        let map = Planted { own, border: 2.0 };
        let why = first_lyapunov(&map, &[0.0; 3], &[], BifurcationKind::NeimarkSacker, 2);
        assert_eq!(why, Err(NoFirstLyapunov::StrongResonance { order }), "{angle}");
    }
}

#[test]
fn a_border_at_the_fixed_point_leaves_no_coefficient() {
    let map = Planted { own: |x| turned(x, 1.1, Complex64::new(-0.3, 0.8)), border: -1.0 };
    let smooth = first_lyapunov(&map, &[0.0; 3], &[], BifurcationKind::NeimarkSacker, 2);
    assert!(smooth.is_ok(), "one signature everywhere");
    let map = Planted { border: 0.0, ..map };
    let why = first_lyapunov(&map, &[0.0; 3], &[], BifurcationKind::NeimarkSacker, 2);
    assert_eq!(why, Err(NoFirstLyapunov::OtherEvents));
}

/// x → −x + ½x² + c x³ hides its coefficient in the square: the normal form has c + 1/4.
#[test]
fn a_planted_flip_coefficient_is_found() {
    let own = |x: [f64; 3]| {
        let [u, y, s] = x;
        let image = [-u + 0.5 * u * u + 0.2 * u * u * u, 0.4 * y, s / 3.0];
        let slope = -1.0 + u + 0.6 * u * u;
        (image, [[slope, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 1.0 / 3.0]])
    };
    let map = Planted { own, border: 2.0 };
    let found = first_lyapunov(&map, &[0.0; 3], &[], BifurcationKind::Flip, 1).expect("smooth");
    let expected = -(0.2 + 0.25) / (ROWS[0][0] * ROWS[0][0]);
    assert!((found.value - expected).abs() <= found.error, "{found:?} {expected}");
    assert!(found.error < 1e-3, "{found:?}");
    assert_eq!(found.criticality(), Some(Criticality::Supercritical));
    let kind = BifurcationKind::Fold;
    assert_eq!(first_lyapunov(&map, &[0.0; 3], &[], kind, 1), Err(NoFirstLyapunov::OtherKind));
}

/// ẋ = −ωy + …, ẏ = ωx + … with every square and cubic term: the formula of Guckenheimer and Holmes (1983), eq. 3.4.11.
struct Planar {
    q: Vec<Complex64>,
}

/// f_xx, f_xy, f_yy of both components, and f_xxx, f_xxy, f_xyy, f_yyy.
const SQUARES: [[f64; 3]; 2] = [[0.7, -0.4, 1.1], [0.3, 0.9, -1.3]];
const CUBES: [[f64; 4]; 2] = [[0.5, -0.2, 0.8, 0.1], [-0.6, 0.4, -0.9, 1.2]];

impl DerivativesAlong for Planar {
    fn quadratic(&self, v: &[Complex64]) -> Vec<Complex64> {
        let q = &self.q;
        SQUARES
            .iter()
            .map(|[xx, xy, yy]| {
                xx * q[0] * v[0] + xy * (q[0] * v[1] + q[1] * v[0]) + yy * q[1] * v[1]
            })
            .collect()
    }

    fn cubic(&self) -> Vec<Complex64> {
        let (x, y) = (self.q[0], self.q[1]);
        let (cx, cy) = (x.conj(), y.conj());
        CUBES
            .iter()
            .map(|[xxx, xxy, xyy, yyy]| {
                xxx * x * x * cx
                    + xxy * (x * x * cy + 2.0 * x * y * cx)
                    + xyy * (2.0 * x * y * cy + y * y * cx)
                    + yyy * y * y * cy
            })
            .collect()
    }
}

#[test]
fn the_hopf_coefficient_is_that_of_guckenheimer_and_holmes() {
    let frequency = 1.7;
    let matrix = Matrix::from_fn(2, 2, |i, j| [[0.0, -frequency], [frequency, 0.0]][i][j]);
    let decomposition = Decomposition::new(&matrix).expect("finite");
    let index = decomposition.values().iter().position(|z| z.im > 0.0).expect("a pair");
    let pair = CriticalPair::new(&decomposition.pair(index), 1).expect("simple");
    let found = hopf(&matrix, &pair, &Planar { q: pair.right.clone() }).expect("regular");
    let [[fxx, fxy, fyy], [gxx, gxy, gyy]] = SQUARES;
    let cubes = CUBES[0][0] + CUBES[0][2] + CUBES[1][1] + CUBES[1][3];
    let squares = fxy * (fxx + fyy) - gxy * (gxx + gyy) - fxx * gxx + fyy * gyy;
    // ṙ = a r³ with x = r cos: q has |q₀| = 1 and x = 2|z|, so that the coefficient of |z|³ is 4a.
    let expected = 4.0 * (cubes / 16.0 + squares / (16.0 * frequency));
    assert!((found.value - expected).abs() < 1e-14, "{found:?} {expected}");
    assert!(found.rounding < 1e-13, "{found:?}");
}
