//! Test functions of bifurcations.
//!
//! With the multipliers λᵢ of the period map, a fold or a branching has Π(λᵢ − 1) = 0, a flip Π(λᵢ + 1) = 0, and a
//! Neimark–Sacker bifurcation Π(λᵢλⱼ − 1) = 0 over pairs i < j (Kuznetsov's bialternate product). All three are smooth
//! in state and parameters where the image is. The last also vanishes for two real multipliers with product 1, which
//! is not a bifurcation: a root counts only if a complex pair lies on the unit circle. At grazing, the distance from the
//! border of the signature is zero; the multipliers jump there and give no test function.

use num_complex::Complex64;

use super::{Image, multipliers};
use crate::polar::modulus;

/// Largest distance of the pair of a Neimark–Sacker bifurcation from the unit circle.
pub(super) const ON_THE_CIRCLE: f64 = 1e-5;

/// Bifurcation of a fixed point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BifurcationKind {
    /// A multiplier crosses +1 and the branch turns back.
    Fold,
    /// A multiplier crosses +1 and the branch continues: another branch crosses it.
    Branching,
    /// A multiplier crosses −1.
    Flip,
    /// A complex pair of multipliers crosses the unit circle.
    NeimarkSacker,
    /// The distance from the border of the signature is zero; beyond it the signature is different.
    Grazing,
    /// The signature changes, and the map does not define the distance from its border.
    Border,
}

/// The test functions of smooth thresholds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tests {
    pub(super) values: [f64; 3],
}

/// Kinds in the order of [`Tests::values`]; branching is distinguished from a fold by the shape of the branch.
pub(super) const SMOOTH: [BifurcationKind; 3] =
    [BifurcationKind::Fold, BifurcationKind::Flip, BifurcationKind::NeimarkSacker];

impl Tests {
    pub(super) fn of(multipliers: &[Complex64]) -> Self {
        let product = |shift: f64| multipliers.iter().map(|z| z + shift).product::<Complex64>().re;
        let mut pairs = Complex64::new(1.0, 0.0);
        for (i, a) in multipliers.iter().enumerate() {
            for b in &multipliers[i + 1..] {
                pairs *= a * b - 1.0;
            }
        }
        Self { values: [product(-1.0), product(1.0), pairs.re] }
    }
}

/// The test function of this kind of bifurcation; `None` if the multipliers cannot be computed.
pub(super) fn test<S>(kind: BifurcationKind, image: &Image<S>) -> Option<f64> {
    let index = match kind {
        BifurcationKind::Grazing | BifurcationKind::Border => return Some(image.distance),
        BifurcationKind::Fold | BifurcationKind::Branching => 0,
        BifurcationKind::Flip => 1,
        BifurcationKind::NeimarkSacker => 2,
    };
    Some(Tests::of(&multipliers(&image.derivative)?).values[index])
}

/// Whether a root of the test function of a kind is a bifurcation of this kind.
pub(super) fn confirmed(kind: BifurcationKind, multipliers: &[Complex64]) -> bool {
    kind != BifurcationKind::NeimarkSacker
        || multipliers.iter().any(|&z| z.im != 0.0 && (modulus(z) - 1.0).abs() < ON_THE_CIRCLE)
}
