//! Free decays with planted numbers: exact records are recovered, and noisy ones within their standard errors.

use std::f64::consts::TAU;

use quell_design::decay::{
    DECAY_PARAMETERS, DecayFit, DecayLaw, FreeVibration, NoDecay, fit_decay, readings,
};
use quell_model::RecordedQuantity;
use quell_numerics::random::SplitMix;

const NONE: [Option<f64>; DECAY_PARAMETERS] = [None; DECAY_PARAMETERS];

fn times(count: usize, step: f64) -> Vec<f64> {
    (0..count).map(|k| step * k as f64).collect()
}

fn record(
    planted: &[f64; DECAY_PARAMETERS],
    quantity: RecordedQuantity,
    times: &[f64],
) -> Vec<f64> {
    readings(&FreeVibration::of(planted), quantity, times, planted[2] > 0.0).values
}

fn fitted(law: DecayLaw, times: &[f64], data: &[f64], quantity: RecordedQuantity) -> DecayFit {
    fit_decay(law, (times, data), quantity, &NONE).expect("a decay")
}

/// Every law and quantity, also in units in which ω is 10⁴ and lengths are 10⁻⁶, and from a start in the middle of a swing.
#[test]
fn exact_records_are_recovered() {
    let laws = [
        (DecayLaw::Viscous, [2.1, 0.013, 0.0, 0.4, 1.3, 0.02]),
        (DecayLaw::Coulomb, [2.1, 0.0, 0.02, 1.0, -0.3, -0.05]),
        (DecayLaw::ViscousCoulomb, [2.1, 0.02, 0.01, -0.9, 0.7, 0.1]),
    ];
    let quantities = [
        RecordedQuantity::Displacement,
        RecordedQuantity::Velocity,
        RecordedQuantity::Acceleration,
    ];
    for (law, planted) in laws {
        for quantity in quantities {
            for (rate, length) in [(1.0, 1.0), (1e4, 1e-6)] {
                let mut planted = planted;
                planted[0] *= rate;
                planted[4] *= rate;
                planted[2..].iter_mut().for_each(|value| *value *= length);
                if quantity != RecordedQuantity::Displacement {
                    planted[5] = 0.0;
                }
                let times = times(900, 0.05 / rate);
                let data = record(&planted, quantity, &times);
                let found = fitted(law, &times, &data, quantity);
                for (place, (value, truth)) in
                    found.estimates.values.iter().zip(planted).enumerate()
                {
                    let scale = match place {
                        0 => rate,
                        1 => 1.0,
                        4 => length * rate,
                        5 => data.iter().fold(0.0, |m: f64, y| m.max(y.abs())),
                        _ => length,
                    };
                    let off = (value - truth) / scale;
                    assert!(off.abs() < 1e-8, "{law:?} {quantity:?} {rate} {place}: {off}");
                }
                assert!(found.converged);
            }
        }
    }
}

/// z = (estimate − truth)/(standard error) has the mean square 1: over 120 records of 5 or 6 parameters each, within 4 standard deviations of
/// the mean of that many squares, and 68 % of |z| are below 1.
#[test]
fn standard_errors_have_their_coverage_over_seeds() {
    const RECORDS: usize = 120;
    let planted = [1.0, 0.008, 0.006, 1.0, 0.2, 0.01];
    let times = times(1200, 0.08);
    let exact = record(&planted, RecordedQuantity::Displacement, &times);
    let mut squares = [0.0; DECAY_PARAMETERS];
    let mut inside = 0;
    for seed in 0..RECORDS {
        let mut random = SplitMix::new(seed as u64 + 7);
        let data: Vec<f64> = exact.iter().map(|y| y + 0.02 * random.normal()).collect();
        let found = fitted(DecayLaw::ViscousCoulomb, &times, &data, RecordedQuantity::Displacement);
        for place in 0..DECAY_PARAMETERS {
            let error = found.estimates.errors[place].expect("determined");
            let z = (found.estimates.values[place] - planted[place]) / error;
            squares[place] += z * z / RECORDS as f64;
            inside += usize::from(z.abs() < 1.0);
        }
        assert!((found.estimates.residual() / 0.02 - 1.0).abs() < 0.1);
    }
    // The variance of a mean of n squares is 2/n.
    let spread = 4.0 * (2.0 / RECORDS as f64).sqrt();
    for (place, square) in squares.iter().enumerate() {
        assert!((square - 1.0).abs() < spread, "parameter {place}: {square}");
    }
    // Errors of a record are correlated: n is taken as the number of records.
    let share = inside as f64 / (RECORDS * DECAY_PARAMETERS) as f64;
    assert!((share - 0.683).abs() < 4.0 * (0.683 * 0.317 / RECORDS as f64).sqrt(), "{share}");
}

/// Laws that do not contain the planted one are far worse by their criterion; with both, the shape of the envelope distinguishes friction from
/// damping. A law with one number more than the planted one may be better by chance: by more than 4 once in 70 records.
#[test]
fn the_criterion_finds_the_planted_law() {
    let times = times(1200, 0.08);
    let laws = [
        (DecayLaw::Viscous, [1.0, 0.02, 0.0, 1.0, 0.0, 0.0], vec![DecayLaw::Coulomb]),
        (DecayLaw::Coulomb, [1.0, 0.0, 0.01, 1.0, 0.0, 0.0], vec![DecayLaw::Viscous]),
        (
            DecayLaw::ViscousCoulomb,
            [1.0, 0.015, 0.008, 1.0, 0.0, 0.0],
            vec![DecayLaw::Viscous, DecayLaw::Coulomb],
        ),
    ];
    for (law, planted, wrong) in laws {
        let exact = record(&planted, RecordedQuantity::Displacement, &times);
        let mut random = SplitMix::new(3);
        let data: Vec<f64> = exact.iter().map(|y| y + 0.01 * random.normal()).collect();
        let criterion = |law| {
            let found = fitted(law, &times, &data, RecordedQuantity::Displacement);
            found.estimates.aic().expect("noise")
        };
        let own = criterion(law);
        assert!(wrong.into_iter().all(|other| criterion(other) > own + 20.0), "{law:?}");
        assert!(criterion(DecayLaw::ViscousCoulomb) > own - 4.0, "{law:?}");
    }
}

/// A record of hundreds of periods: the phase is followed, not lost in a neighbouring minimum of the frequency.
#[test]
fn a_long_record_keeps_its_phase() {
    let planted = [TAU * 50.0, 0.0008, 0.0, 1e-3, 0.0, 0.0];
    let times = times(20_000, 5e-4);
    let mut random = SplitMix::new(5);
    let exact = record(&planted, RecordedQuantity::Displacement, &times);
    let data: Vec<f64> = exact.iter().map(|y| y + 1e-4 * random.normal()).collect();
    let found = fitted(DecayLaw::Viscous, &times, &data, RecordedQuantity::Displacement);
    let error = found.estimates.errors[0].expect("determined");
    assert!(((found.estimates.values[0] - planted[0]) / error).abs() < 4.0);
    assert!(error / planted[0] < 1e-5);
}

/// A decay by friction that ends at rest: the rest is part of the motion.
#[test]
fn rest_at_the_end_is_part_of_the_record() {
    let planted = [1.0, 0.0, 0.06, 1.0, 0.0, 0.02];
    let times = times(800, 0.08);
    let mut random = SplitMix::new(11);
    let exact = record(&planted, RecordedQuantity::Displacement, &times);
    assert_eq!(exact[799], exact[600]);
    let data: Vec<f64> = exact.iter().map(|y| y + 0.01 * random.normal()).collect();
    let found = fitted(DecayLaw::Coulomb, &times, &data, RecordedQuantity::Displacement);
    for place in [0, 2, 3, 4, 5] {
        let error = found.estimates.errors[place].expect("determined");
        let z = (found.estimates.values[place] - planted[place]) / error;
        assert!(z.abs() < 4.0, "{place}: {z}");
    }
}

#[test]
fn records_without_a_decay_are_refused_with_the_reason() {
    let times = times(100, 0.1);
    let constant = vec![0.3; 100];
    let refused = |data: &[f64]| {
        fit_decay(DecayLaw::Viscous, (&times, data), RecordedQuantity::Displacement, &NONE)
    };
    assert_eq!(refused(&constant).expect_err("constant"), NoDecay::Constant);
    let short: Vec<f64> = times.iter().map(|t| libm::cos(0.7 * t)).collect();
    assert!(matches!(refused(&short), Err(NoDecay::TooShort { .. })));
    let coarse: Vec<f64> = times.iter().map(|t| libm::cos(20.0 * t)).collect();
    assert!(matches!(refused(&coarse), Err(NoDecay::TooCoarse { .. })));
}

/// A fixed parameter stays as given, and is not part of the covariance.
#[test]
fn a_fixed_parameter_has_no_error() {
    let planted = [1.0, 0.02, 0.0, 1.0, 0.0, 0.0];
    let times = times(600, 0.08);
    let data = record(&planted, RecordedQuantity::Displacement, &times);
    let mut fixed = NONE;
    fixed[1] = Some(0.03);
    let found =
        fit_decay(DecayLaw::Viscous, (&times, &data), RecordedQuantity::Displacement, &fixed)
            .expect("a decay");
    assert_eq!(found.estimates.values[1], 0.03);
    assert!(found.estimates.errors[1].is_err() && !found.estimates.order.contains(&1));
    assert!(found.estimates.rss > 1e-3);
}
