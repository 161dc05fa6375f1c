//! Friction laws.

use quell_model::units::Quantity;
use quell_model::{Expression, Friction, LawKind, Samples};

use crate::NamedModel;

/// Static level μ_s of the dissertation.
pub const STATIC: f64 = 0.4;

/// Minimum level μ_m of the dissertation; the printed 0.2587 is a misprint.
pub const MINIMUM: f64 = 0.2857;

/// Reference velocity v_m of the dissertation.
pub const REFERENCE_VELOCITY: f64 = 0.2;

/// A law of numbers from values in the order of its parameters.
///
/// # Panics
/// On values that the law does not accept.
pub fn build(kind: LawKind, values: &[f64]) -> Friction {
    kind.build(values).unwrap_or_else(|why| panic!("{kind:?} {values:?}: {why:?}"))
}

/// A law of the dissertation, [`LawKind::Stribeck`] (2.7) or [`LawKind::Decreasing`] (2.8), with its values.
///
/// # Panics
/// On another law.
pub fn dissertation(kind: LawKind) -> Friction {
    build(kind, &[STATIC, MINIMUM, REFERENCE_VELOCITY])
}

/// (2.7): a cubic with its minimum at v_m.
pub fn stribeck() -> Friction {
    dissertation(LawKind::Stribeck)
}

/// (2.8): an exponential decrease.
pub fn decreasing() -> Friction {
    dissertation(LawKind::Decreasing)
}

/// Coulomb friction: sliding coefficient, static level, no viscous part.
pub fn coulomb(coefficient: f64, static_coefficient: f64) -> Friction {
    build(LawKind::Coulomb, &[coefficient, static_coefficient, 0.0])
}

/// An exponential fall with an exponent and a viscous part.
pub fn stribeck_exponential() -> Friction {
    build(LawKind::StribeckExponential, &[MINIMUM, STATIC, REFERENCE_VELOCITY, 2.0, 0.05])
}

/// A formula; its static level is μ(0⁺).
///
/// # Panics
/// On a text that is not a law.
pub fn formula(text: &str) -> Friction {
    expression(text, None)
}

/// A formula with a static level of its own.
///
/// # Panics
/// As [`formula`].
pub fn formula_with_level(text: &str, static_coefficient: f64) -> Friction {
    expression(text, Some(static_coefficient))
}

fn expression(text: &str, static_coefficient: Option<f64>) -> Friction {
    let law = Expression::new(text, &[], static_coefficient, 1.0);
    Friction::Expression(law.unwrap_or_else(|why| panic!("{text}: {why:?}")))
}

/// A formula whose sliding branch starts below the static level: a release with a jump of friction.
pub fn jumping_formula() -> Friction {
    formula_with_level("0.3 + 0.06*exp(-abs(v)/0.2)", STATIC)
}

/// A law of the dissertation as a formula, with its values as the constants `mu_s`, `mu_m` and `v_m`.
///
/// # Panics
/// On another law.
pub fn dissertation_as_formula(kind: LawKind) -> Friction {
    let text = match kind {
        LawKind::Stribeck => "mu_s - 3/2*(mu_s - mu_m)*(abs(v)/v_m - (abs(v)/v_m)^3/3)",
        LawKind::Decreasing => "mu_m + (mu_s - mu_m)*exp(-abs(v)/v_m)",
        other => panic!("{other:?} is not a law of the dissertation"),
    };
    let constants = [("mu_s", STATIC), ("mu_m", MINIMUM), ("v_m", REFERENCE_VELOCITY)]
        .map(|(name, value)| (name.to_owned(), value));
    Friction::Expression(Expression::new(text, &constants, None, 1.0).expect(text))
}

/// `count` samples of a law at even slip speeds from 0 to `last`.
pub fn measured(law: &Friction, last: f64, count: u32) -> Vec<(f64, f64)> {
    (0..count)
        .map(|k| {
            let speed = last * f64::from(k) / f64::from(count - 1);
            (speed, law.coefficient(speed))
        })
        .collect()
}

/// Samples of (2.8) up to v = 1 with a static level above their fit.
///
/// # Panics
/// Never: the fit exists.
pub fn samples() -> Friction {
    let measured = measured(&decreasing(), 1.0, 61);
    Friction::Samples(Samples::new(&measured, Some(0.45), None, 1.0).expect("a fit"))
}

/// One law of every kind, and two of Coulomb's.
pub fn all() -> Vec<NamedModel<Friction>> {
    vec![
        NamedModel::new("stribeck", "(2.7)", stribeck()),
        NamedModel::new("decreasing", "(2.8)", decreasing()),
        NamedModel::new("coulomb", "chosen: μ_s = μ", coulomb(0.3, 0.3)),
        NamedModel::new(
            "coulomb with a static level",
            "chosen: a viscous part and μ_s > μ",
            build(LawKind::Coulomb, &[MINIMUM, STATIC, 0.05]),
        ),
        NamedModel::new("stribeck-exponential", "chosen: exponent 2", stribeck_exponential()),
        NamedModel::new("expression", "chosen: μ_s > μ(0⁺)", jumping_formula()),
        NamedModel::new("samples", "chosen: (2.8) sampled, μ_s > μ(0⁺)", samples()),
    ]
}

/// The law with every length and velocity multiplied by `factor`.
///
/// # Panics
/// On a factor that takes a value out of its bounds.
#[must_use]
pub fn scaled(law: &Friction, factor: f64) -> Friction {
    match law {
        Friction::Expression(law) => {
            return Friction::Expression(law.in_unit(law.velocity_unit() * factor));
        }
        Friction::Samples(law) => {
            return Friction::Samples(law.in_unit(law.curve().velocity_unit() * factor));
        }
        _ => {}
    }
    let parameters = law.kind().parameters();
    let values: Vec<f64> = parameters
        .iter()
        .zip(law.values())
        .map(|(parameter, value)| match parameter.quantity {
            Quantity::Velocity | Quantity::Displacement | Quantity::Force => value * factor,
            Quantity::PerVelocity | Quantity::PerLength => value / factor,
            _ => value,
        })
        .collect();
    build(law.kind(), &values)
}
