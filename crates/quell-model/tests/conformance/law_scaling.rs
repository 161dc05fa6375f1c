//! Lengths scale out: a law whose velocities are multiplied by a power of two gives the same
//! bits at slips multiplied alike.

use quell_model::Friction;
use quell_model::units::Quantity;

use crate::law_samples::{SCALED_SPEEDS, all_samples};

/// The law with every length and velocity multiplied by `factor`.
fn scaled(law: &Friction, factor: f64) -> Friction {
    match law {
        Friction::Expression(law) => {
            return Friction::Expression(law.in_unit(law.velocity_unit() * factor));
        }
        Friction::Samples(law) => {
            return Friction::Samples(law.in_unit(law.curve().velocity_unit() * factor));
        }
        _ => {}
    }
    let kind = law.kind();
    let values: Vec<f64> = kind
        .parameters()
        .iter()
        .zip(law.values())
        .map(|(parameter, value)| match parameter.quantity {
            Quantity::Velocity | Quantity::Displacement | Quantity::Force => value * factor,
            Quantity::PerVelocity | Quantity::PerLength => value / factor,
            _ => value,
        })
        .collect();
    match kind.build(&values).expect("valid at any scale of length") {
        // It counts slip in a length of the belt.
        Friction::Coulomb(law) => Friction::Coulomb(law.counted_in(factor)),
        law => law,
    }
}

#[test]
fn powers_of_two_change_no_bit() {
    for law in all_samples() {
        for exponent in [-31, -3, 1, 12] {
            let factor = 2f64.powi(exponent);
            let other = scaled(&law, factor);
            assert_eq!(other.velocity_scale(), law.velocity_scale() * factor);
            assert_eq!(other.static_coefficient(), law.static_coefficient());
            for &speed in SCALED_SPEEDS {
                let speed = speed * law.velocity_scale();
                let (value, moved) = (law.coefficient(speed), other.coefficient(speed * factor));
                assert_eq!(value.to_bits(), moved.to_bits(), "{law:?} at {speed}");
                let (slope, moved) = (law.slope(speed), other.slope(speed * factor) * factor);
                assert_eq!(slope.to_bits(), moved.to_bits(), "{law:?} at {speed}: slope");
            }
        }
    }
}
