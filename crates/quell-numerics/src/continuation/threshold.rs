//! What is zero at a threshold.
//!
//! With multipliers λᵢ of the period map: a fold or a branching has Π(λᵢ − 1) = 0, a flip Π(λᵢ + 1) = 0, a
//! Neimark–Sacker bifurcation Π(λᵢλⱼ − 1) = 0 over pairs i < j (Kuznetsov's bialternate product). All three are smooth
//! in state and parameters where the image is. The last vanishes for two real multipliers with product 1 too, which
//! is no bifurcation: a root counts only with a complex pair on the circle. At a touch the distance from the border of the
//! signature is zero; multipliers say nothing there, for they jump.

use num_complex::Complex64;

use super::{Image, modulus, multipliers};

/// How near to the unit circle the pair of a Neimark–Sacker bifurcation must be.
const ON_THE_CIRCLE: f64 = 1e-5;

/// What happens to a fixed point at a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BifurcationKind {
    /// A multiplier passes +1 and the branch turns back.
    Fold,
    /// A multiplier passes +1 and the branch goes on: another one crosses.
    Branching,
    /// A multiplier passes −1.
    Flip,
    /// A complex pair of multipliers passes the unit circle.
    NeimarkSacker,
    /// The distance from the border of the signature is zero; what lies beyond has another signature.
    Grazing,
    /// The signature changes, and the family knows no distance from its border.
    Border,
}

/// The test functions of smooth thresholds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tests {
    pub(super) values: [f64; 3],
}

/// Kinds in the order of [`Tests::values`]; branching is told from a fold by the branch.
pub(super) const SMOOTH: [BifurcationKind; 3] =
    [BifurcationKind::Fold, BifurcationKind::Flip, BifurcationKind::NeimarkSacker];

impl Tests {
    pub(super) fn of(multipliers: &[Complex64]) -> Self {
        let product =
            |shift: f64| multipliers.iter().map(|it| it + shift).product::<Complex64>().re;
        let mut pairs = Complex64::new(1.0, 0.0);
        for (i, a) in multipliers.iter().enumerate() {
            for b in &multipliers[i + 1..] {
                pairs *= a * b - 1.0;
            }
        }
        Self { values: [product(-1.0), product(1.0), pairs.re] }
    }
}

/// What is zero at a threshold of this kind; `None` where multipliers cannot be computed.
pub(super) fn test<S>(kind: BifurcationKind, image: &Image<S>) -> Option<f64> {
    let index = match kind {
        BifurcationKind::Grazing | BifurcationKind::Border => return Some(image.distance),
        BifurcationKind::Fold | BifurcationKind::Branching => 0,
        BifurcationKind::Flip => 1,
        BifurcationKind::NeimarkSacker => 2,
    };
    Some(Tests::of(&multipliers(&image.derivative)?).values[index])
}

/// Whether a root of the test of a kind is one of its bifurcations.
pub(super) fn confirmed(kind: BifurcationKind, multipliers: &[Complex64]) -> bool {
    kind != BifurcationKind::NeimarkSacker
        || multipliers.iter().any(|&it| it.im != 0.0 && (modulus(it) - 1.0).abs() < ON_THE_CIRCLE)
}
