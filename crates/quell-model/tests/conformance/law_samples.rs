//! Valid examples of every law, found from its parameters alone.

use quell_model::parameter::{COEFFICIENT, EXPONENT, Parameter};
use quell_model::units::Quantity;
use quell_model::{Expression, Friction, LawKind, Samples};

/// Slip speeds in units of the law's velocity scale: at rest, small, at the scale, far out.
pub(crate) const SCALED_SPEEDS: &[f64] = &[0.0, 1e-9, 0.03, 0.31, 0.77, 1.0, 1.42, 3.3, 9.0];

/// Examples tried, and the least and largest number of valid ones.
const TRIALS: usize = 400;
const AT_LEAST: usize = 12;
const AT_MOST: usize = 40;

/// Numbers of the kind of `parameter`: those of the dissertation, round ones, one of a real
/// brake (lengths of micrometres), and the edge of its range.
fn candidates(parameter: &Parameter) -> Vec<f64> {
    let numbers: &[f64] = match parameter.quantity {
        // Steeper falls need more terms than this suite keeps: `law_powers` holds them to formulas.
        _ if parameter.path == EXPONENT.path => &[1.0, 2.0],
        // Where nothing stays at high slip, a fall to 10⁻³⁰⁰ has too few terms to be judged.
        _ if parameter.path == COEFFICIENT.path => &[0.4, 0.2857, 0.05, 1.3],
        Quantity::PerVelocity => &[0.0, 0.05, 0.3],
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

/// Formulas of every function and operation; each is even or odd in v, smooth and nowhere negative.
const FORMULAS: &[&str] = &[
    "0.3",
    "0.3 + 0.1*exp(-abs(v)/0.2)",
    "sign(v)*(0.3 + 0.1*exp(-abs(v)/v_m))",
    "0.2857 + 0.1143*sech(v/0.3)^2 + 0.001*v^2",
    "0.4 - 0.17145*(abs(v)/v_m - (abs(v)/v_m)^3/3)",
    "0.2 + 0.2/(1 + (v/v_m)^2)",
    "0.1 + sqrt(0.04 + v^2)*0.01 + 0.3*exp(-(v/0.4)^2)",
    "tanh(3*v)*(0.1 + 0.2*exp(-3*abs(v)))",
    "0.3 + 0.05*sin(2*abs(v)) + 0.02*cos(3*v)*exp(-abs(v))",
    "0.5 - 0.2*atan(abs(v)/v_m)",
    "0.2 + 0.03*log(1 + 4*abs(v)) + 0.1*exp(-abs(v)/0.05)",
    "0.1*(2 + abs(v))^1.5 + pi/20*(1 + abs(v))^-2",
    "0.25*(1 + abs(v)/3)^0.5 + v_m",
    "6e-3 + 0.3*exp(-abs(v)/6e-6)",
];

/// Samples of curves that fall, that fall and rise, and that begin away from rest.
fn measured(kind: u32) -> Vec<(f64, f64)> {
    (0..40)
        .map(|k| {
            let u = f64::from(k) * 0.02 + if kind == 2 { 0.013 } else { 0.0 };
            let ripple = 1e-3 * (f64::from(k * k) * 1.7).sin();
            (
                u,
                match kind {
                    0 => 0.2857 + 0.1143 * (-u / 0.2).exp(),
                    1 => 0.35 - 0.3 * u + 0.5 * u * u,
                    _ => 0.2 + 0.15 * (-u / 0.06).exp() + 0.05 * u + ripple,
                },
            )
        })
        .collect()
}

/// Laws that carry data.
fn carrying(kind: LawKind) -> Vec<Friction> {
    let constants = [("v_m".to_owned(), 0.2)];
    let mut found = Vec::new();
    match kind {
        LawKind::Expression => {
            for (index, formula) in FORMULAS.iter().enumerate() {
                // The static level by itself and apart; v in lengths and in metres per second.
                let level = if index % 3 == 1 { Some(1.5) } else { None };
                let unit = if index % 2 == 1 { 1.0 / 37.0 } else { 1.0 };
                let law = Expression::new(formula, &constants, level, unit);
                found.push(Friction::Expression(law.expect(formula)));
            }
        }
        LawKind::Samples => {
            for shape in 0..3 {
                for (level, terms, unit) in
                    [(None, None, 1.0), (Some(0.6), Some(3), 6e-6), (Some(0.34), Some(2), 0.25)]
                {
                    let law = Samples::new(&measured(shape), level, terms, unit);
                    found.push(Friction::Samples(law.expect("a fit")));
                }
            }
        }
        _ => {}
    }
    found
}

/// Every example of every law.
pub(crate) fn all_samples() -> impl Iterator<Item = Friction> {
    let of = |&kind: &LawKind| {
        if LawKind::NUMERIC.contains(&kind) { samples(kind) } else { carrying(kind) }
    };
    let found: Vec<Vec<Friction>> = LawKind::ALL.iter().map(of).collect();
    assert!(found.iter().all(|laws| !laws.is_empty()), "a law without examples");
    found.into_iter().flatten()
}
