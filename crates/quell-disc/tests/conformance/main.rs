//! One conformance suite for every disc of `quell_zoo`: identities of spectra, and eigenvalues against Floquet exponents.
//!
//! No numbers are asserted: a new model is one line in the zoo, and is tested here without a change.

use num_complex::Complex64;
use quell_disc::dithered;
use quell_disc::equations::linearised;
use quell_disc::undithered::{self, eigenvalues};
use quell_linear::growth::{Growth, Verdict};
use quell_model::Disc;
use quell_model::disc::{Contributions, DiscDither};
use quell_numerics::floquet::Effort;
use quell_numerics::matrix::Matrix;
use quell_zoo::{DiscExt, all_discs};

fn growth(disc: &Disc) -> Growth {
    dithered::growth(disc, Effort::default()).expect("finite")
}

fn assert_equal(name: &str, one: Growth, other: Growth) {
    let gap = (one.rate - other.rate).abs();
    assert!(gap <= one.error + other.error && gap < 1e-9, "{name}: {one:?} {other:?}");
}

fn trace(matrix: &Matrix) -> f64 {
    (0..matrix.rows()).map(|i| matrix.row(i)[i]).sum()
}

/// Eigenvalues come in conjugate pairs, are as many as the numbers of the state, and add up to the trace of the state matrix,
/// which is that of −M⁻¹C: no friction enters it.
#[test]
fn eigenvalues_are_conjugate_and_add_up_to_the_trace() {
    for named in all_discs() {
        let disc = named.model.undithered();
        let values = eigenvalues(&disc).expect("finite");
        let system = linearised(&disc, Contributions::ALL).expect("finite");
        assert_eq!(values.len(), 2 * disc.coordinates(), "{}", named.name);
        let size = values.iter().map(Complex64::norm_sqr).sum::<f64>().sqrt();
        for value in &values {
            let distance = |other: &Complex64| (other.conj() - value).norm_sqr().sqrt();
            let nearest = values.iter().map(distance).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12 * size, "{}: {value} {nearest:e}", named.name);
        }
        let sum: Complex64 = values.iter().sum();
        let free = vec![0.0; disc.loads().len()];
        for friction in [system.mean_friction(), free] {
            let trace = trace(&system.state_matrix(&friction));
            let gap = (sum - trace).norm_sqr().sqrt();
            assert!(gap < 1e-12 * size, "{}: {sum} {trace}", named.name);
        }
    }
}

/// The growth rate is the largest real part of the eigenvalues, and what grows is listed once for each pair.
#[test]
fn the_growth_rate_is_the_largest_real_part() {
    let mut growing = 0;
    for named in all_discs() {
        let disc = named.model.undithered();
        let found = undithered::growth(&disc).expect("finite");
        let values = eigenvalues(&disc).expect("finite");
        let largest = values.iter().map(|value| value.re).fold(f64::MIN, f64::max);
        assert!((found.rate - largest).abs() <= found.error, "{}: {found:?}", named.name);
        let listed = undithered::growing_with(&disc, Contributions::ALL).expect("finite");
        let expected = values.iter().filter(|value| value.im >= 0.0 && value.re > found.error);
        assert_eq!(listed.len(), expected.count(), "{}: {listed:?} {values:?}", named.name);
        assert_eq!(listed.is_empty(), found.verdict() != Verdict::Unstable, "{}", named.name);
        growing += listed.len();
    }
    assert!(growing >= 15, "{growing}");
}

/// Without amplitude, normal dither leaves the mean friction: its Floquet exponents are the eigenvalues. Tangential dither
/// takes the mean: they are the eigenvalues without friction.
#[test]
fn exponents_under_dither_of_amplitude_zero_are_eigenvalues() {
    for named in all_discs().into_iter().filter(|named| named.model.dither() == DiscDither::None) {
        let disc = &named.model;
        for frequency_ratio in [2.7, 40.0] {
            let normal = DiscDither::Normal { amplitude: 0.0, frequency_ratio };
            let tangential = DiscDither::Tangential { amplitude: 0.0, frequency_ratio };
            let frictionless = disc.with_friction_times(0.0).expect("valid");
            for (dither, plain) in [(normal, disc), (tangential, &frictionless)] {
                let silent = disc.with_dither(dither);
                let expected = undithered::growth(plain).expect("finite");
                assert_equal(&named.name, growth(&silent), expected);
                let prepared = dithered::prepared(&silent).expect("finite").expect("dithered");
                let found = prepared.growing(Effort::default()).expect("finite");
                let listed = undithered::growing_with(plain, Contributions::ALL).expect("finite");
                assert_eq!(found.len(), listed.len(), "{}: {found:?} {listed:?}", named.name);
                for (one, other) in found.iter().zip(&listed) {
                    assert_equal(&named.name, *one, *other);
                }
            }
        }
    }
}

/// Growth changes with the square of a faint dither.
#[test]
fn faint_dither_is_nearly_none() {
    let faint = DiscDither::Normal { amplitude: 1e-7, frequency_ratio: 2.7 };
    for named in all_discs() {
        let disc = named.model.undithered();
        let (found, plain) = (growth(&disc.with_dither(faint)), growth(&disc));
        let gap = (found.rate - plain.rate).abs();
        let bound = found.error + plain.error + 1e-12;
        assert!(gap <= bound && gap < 1e-9, "{}: {found:?} {plain:?}", named.name);
    }
}

/// With all friction off nothing feeds a disc: it never grows, under any dither, and decays where its modes are damped.
#[test]
fn without_friction_nothing_grows() {
    let mut damped = 0;
    for named in all_discs() {
        let disc = named.model.with_friction_times(0.0).expect("valid");
        let found = growth(&disc);
        assert!(found.rate <= found.error, "{}: {found:?}", named.name);
        if disc.modes().iter().all(|mode| mode.damping > 0.0) {
            assert_eq!(found.verdict(), Verdict::Stable, "{}: {found:?}", named.name);
            damped += 1;
        }
    }
    assert!(damped >= 15, "{damped}");
}

/// A row of a map shares what does not depend on friction, and gives the bits of its points.
#[test]
fn a_row_of_a_map_gives_the_bits_of_its_points() {
    for named in all_discs() {
        let Some(prepared) = dithered::prepared(&named.model).expect("finite") else { continue };
        for factor in [0.01, 0.2, 1.5] {
            let alone = growth(&named.model.with_friction_times(factor).expect("valid"));
            let shared = prepared.growth(factor, Effort::default()).expect("finite");
            assert_eq!(alone.rate.to_bits(), shared.rate.to_bits(), "{}", named.name);
        }
    }
}

/// Turning all loads by one angle turns the frame, and shifting all phases shifts the time: neither changes the growth.
#[test]
fn turning_all_loads_and_shifting_all_phases_changes_nothing() {
    for named in all_discs() {
        let moved = named.model.loads().iter().map(|load| {
            let (angle, phase) = (load.angle + 0.7, load.dither_phase + 0.9);
            load.clone().at_angle(angle).dithered_at(phase)
        });
        let moved = named.model.with_loads(moved.collect());
        assert_equal(&named.name, growth(&named.model), growth(&moved));
    }
}

/// A load that neither presses nor weighs is no load.
#[test]
fn a_load_of_zeros_is_no_load() {
    for named in all_discs() {
        let mut loads = named.model.loads().to_vec();
        loads.push(quell_zoo::disc::equal_load(0.0, 0.0).at_angle(2.0));
        assert_equal(&named.name, growth(&named.model), growth(&named.model.with_loads(loads)));
    }
}
