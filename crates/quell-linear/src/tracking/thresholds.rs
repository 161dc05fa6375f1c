//! Values of a parameter at which the verdict changes or two motions coalesce.

use num_complex::Complex64;

use super::coalescence::{self, Coalescence};
use super::family::{Family, TrackedPoint, at};
use crate::averaging::{CrossingKind, SignChange, sign_changes};
use crate::growth::{Verdict, verdicts_around};

/// Distance over the window within which a change of the verdict that is undecided on one side is that of a coalescence: growth
/// beyond one is hidden by its error, which rises like a square root, over some 10⁻⁸ of the window. Two changes within this
/// distance would be taken for one.
const TOGETHER: f64 = 1e-6;

/// A frequency below this share of the largest eigenvalue counts as zero: a simple real eigenvalue has none at all, and rounding
/// splits a double one by the square root of 10⁻¹⁶.
const NO_FREQUENCY: f64 = 1e-9;

/// What happens at a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StabilityChange {
    /// A motion of this frequency begins or ceases to grow.
    Hopf,
    /// A motion without frequency begins or ceases to grow.
    Divergence,
    /// Two frequencies merge, or part.
    Coalescence,
    /// The growth rate jumps.
    Jump,
}

impl StabilityChange {
    /// Every kind of change.
    pub const ALL: [Self; 4] = [Self::Hopf, Self::Divergence, Self::Coalescence, Self::Jump];

    /// Name in output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hopf => "hopf",
            Self::Divergence => "divergence",
            Self::Coalescence => "coalescence",
            Self::Jump => "jump",
        }
    }
}

/// A threshold of the stability of steady sliding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThresholdOfStability {
    /// Value of the parameter.
    pub value: f64,
    /// Bound on its error.
    pub error: f64,
    /// What happens.
    pub change: StabilityChange,
    /// The eigenvalue there.
    pub eigenvalue: Complex64,
    /// The verdict just below and just beyond it; the same where only frequencies merge.
    pub verdicts: [Verdict; 2],
}

/// The thresholds of a piece; `Err` only where the family fails inside it.
pub(super) fn of_piece<F: Family>(
    family: &F,
    piece: &[TrackedPoint],
) -> Result<Vec<ThresholdOfStability>, F::Error> {
    let values: Vec<f64> = piece.iter().map(|point| point.value).collect();
    let ascending = values.windows(2).all(|pair| pair[0] < pair[1]);
    if piece.len() < 2 || !ascending {
        return Ok(Vec::new());
    }
    let decided = |point: &TrackedPoint| match point.growth.verdict() {
        Verdict::Undecided => 0.0,
        _ => point.growth.rate,
    };
    // Where an eigenvalue is zero, the equations of steady sliding are singular, and the family fails at the root itself. Values
    // next to it decide whether it is one.
    let rate = |value| Ok(at(family, value).as_ref().map_or(0.0, decided));
    let changes = sign_changes(rate, &values, &[])?;
    let locations: Vec<f64> = changes.iter().map(|change| change.location).collect();
    let sides = Sides { family, values: &values, locations: &locations };
    let mut merged = coalescence::of_piece(family, piece);
    let mut found = Vec::new();
    for change in changes {
        let verdicts = sides.of(change.location)?;
        if verdicts[0] == verdicts[1] {
            continue;
        }
        let together = |merged: &Coalescence| {
            (merged.value - change.location).abs()
                <= TOGETHER * (values[values.len() - 1] - values[0])
        };
        let undecided = verdicts.contains(&Verdict::Undecided);
        if let (true, Some(index)) = (undecided, merged.iter().position(together)) {
            let Coalescence { value, error, eigenvalue } = merged.remove(index);
            let change = StabilityChange::Coalescence;
            found.push(ThresholdOfStability { value, error, change, eigenvalue, verdicts });
            continue;
        }
        found.push(described(family, change, verdicts));
    }
    for Coalescence { value, error, eigenvalue } in merged {
        let verdicts = sides.of(value)?;
        let change = StabilityChange::Coalescence;
        found.push(ThresholdOfStability { value, error, change, eigenvalue, verdicts });
    }
    Ok(found)
}

/// A change of the verdict with its kind and eigenvalue.
fn described<F: Family>(
    family: &F,
    change: SignChange,
    verdicts: [Verdict; 2],
) -> ThresholdOfStability {
    let SignChange { location: value, error, crossing, .. } = change;
    let (eigenvalue, size) = match at(family, value) {
        Ok(point) => {
            let size = |m: f64, z: &Complex64| m.max(z.re.abs() + z.im.abs());
            let eigenvalue = Complex64::new(point.growth.rate, point.growth.frequency);
            (eigenvalue, point.eigenvalues.iter().fold(0.0, size))
        }
        Err(_) => (Complex64::new(0.0, 0.0), 0.0),
    };
    let change = match crossing {
        CrossingKind::Jump => StabilityChange::Jump,
        CrossingKind::Root if eigenvalue.im <= NO_FREQUENCY * size => StabilityChange::Divergence,
        CrossingKind::Root => StabilityChange::Hopf,
    };
    ThresholdOfStability { value, error, change, eigenvalue, verdicts }
}

/// The verdicts on the sides of values of a piece.
struct Sides<'a, F> {
    family: &'a F,
    values: &'a [f64],
    /// Where the verdict changes.
    locations: &'a [f64],
}

impl<F: Family> Sides<'_, F> {
    /// The verdicts below and beyond a value, as close to it as they are decided, and before any other change.
    fn of(&self, value: f64) -> Result<[Verdict; 2], F::Error> {
        let (first, last) = (self.values[0], self.values[self.values.len() - 1]);
        let others = self.locations.iter().map(|other| (other - value).abs());
        let gap = others.filter(|gap| *gap > 0.0).fold(f64::INFINITY, f64::min);
        verdicts_around(|distance| {
            let aside = (distance * (last - first)).clamp(-0.5 * gap, 0.5 * gap);
            let there = (value + aside).clamp(first, last);
            Ok(at(self.family, there)?.growth.verdict())
        })
    }
}
