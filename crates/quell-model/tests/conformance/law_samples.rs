//! Valid examples of every law, found from its parameters alone.

use quell_model::parameter::Parameter;
use quell_model::units::Quantity;
use quell_model::{Friction, LawKind};

/// Slip speeds in units of the law's velocity scale: at rest, small, at the scale, far out.
pub(crate) const SCALED_SPEEDS: &[f64] = &[0.0, 1e-9, 0.03, 0.31, 0.77, 1.0, 1.42, 3.3, 9.0];

/// Examples tried, and the number that must turn out valid.
const TRIALS: usize = 400;
const AT_LEAST: usize = 12;
const AT_MOST: usize = 40;

/// Numbers of the kind of `parameter`: those of the dissertation, round ones, one of a real
/// brake (lengths of micrometres), and the edge of its range.
fn candidates(parameter: &Parameter) -> Vec<f64> {
    let numbers: &[f64] = match parameter.quantity {
        Quantity::Ratio => &[0.4, 0.2857, 0.05, 1.3, 0.0],
        Quantity::Velocity | Quantity::Force | Quantity::Displacement => &[0.2, 0.3, 7.0, 6e-6],
        _ => &[1.0, 0.5, 2.0],
    };
    numbers.iter().copied().filter(|&value| parameter.bounds.contains(value)).collect()
}

/// Valid laws of a kind, spread over combinations of its parameters.
pub(crate) fn samples(kind: LawKind) -> Vec<Friction> {
    let choices: Vec<Vec<f64>> = kind.parameters().iter().map(candidates).collect();
    let mut found: Vec<Friction> = Vec::new();
    let mut state = 1_u64;
    for _ in 0..TRIALS {
        let values: Vec<f64> = choices
            .iter()
            .map(|choice| {
                // Linear congruence of Knuth's MMIX; the high bits choose.
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                choice[(state >> 33) as usize % choice.len()]
            })
            .collect();
        if let Ok(law) = kind.build(&values)
            && !found.contains(&law)
            && found.len() < AT_MOST
        {
            found.push(law);
        }
    }
    assert!(found.len() >= AT_LEAST, "{}: only {} examples are valid", kind.name(), found.len());
    found
}

/// Every example of every law.
pub(crate) fn all_samples() -> impl Iterator<Item = Friction> {
    LawKind::ALL.iter().copied().flat_map(samples)
}
