//! Limits and identities that hold for any parameters.

use std::f64::consts::PI;

use num_complex::Complex64;
use quell_disc::boundaries::{Marginal, NoBoundary, boundaries};
use quell_disc::dithered;
use quell_disc::partition::{NoPartition, crossings};
use quell_disc::undithered::{self, eigenvalues};
use quell_linear::growth::{Growth, Verdict};
use quell_model::Disc;
use quell_model::disc::{Contribution, Contributions};
use quell_model::disc::{DiscDither, Load, Mode};
use quell_numerics::floquet::Effort;
use quell_zoo::DiscExt;
use quell_zoo::disc::{self as zoo, NORMAL, TANGENTIAL, ZooModes, free, loaded};

fn of(disc: &Disc) -> Growth {
    dithered::growth(disc, Effort::default()).expect("finite")
}

fn values(disc: &Disc) -> Vec<Complex64> {
    eigenvalues(disc).expect("finite")
}

/// |z|.
fn size(z: Complex64) -> f64 {
    z.norm_sqr().sqrt()
}

/// Speeds up to 1 at which two free waves coincide (table 5.1, and Ω = 0).
fn coincidences(set: ZooModes) -> Vec<f64> {
    let waves: Vec<(f64, f64)> = set
        .modes(0.0)
        .iter()
        .flat_map(|mode| {
            let q = mode.diameters as f64;
            [(q, mode.ratio), (-q, mode.ratio), (q, -mode.ratio), (-q, -mode.ratio)]
        })
        .collect();
    let mut speeds = vec![0.0];
    for (l, w) in &waves {
        for (other_l, other_w) in &waves {
            let speed = (w - other_w) / (other_l - l);
            if l != other_l && speed > 0.0 && speed <= 1.0 {
                speeds.push(speed);
            }
        }
    }
    speeds.sort_by(f64::total_cmp);
    speeds.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
    speeds
}

#[test]
fn marginal_lines_are_undecided() {
    let speeds = coincidences(ZooModes::N12);
    let printed = [0.0, 0.036, 0.064, 0.114, 0.192, 1.0];
    assert_eq!(speeds.len(), printed.len(), "{speeds:?}");
    for (speed, printed) in speeds.iter().zip(printed) {
        assert!((speed - printed).abs() < 6e-4, "{speed} {printed}");
        // Under small friction nothing grows, and one exponent stays on the imaginary axis.
        for friction in [0.0, 0.003, 0.01] {
            for dither in [DiscDither::None, NORMAL, TANGENTIAL] {
                let load = Load::new(0.1, 0.1, 0.1, friction);
                let found = of(&loaded(ZooModes::N12, 0.0, load, dither, *speed));
                let at = format!("Ω = {speed}, f = {friction}, {dither:?}: {found:?}");
                assert_eq!(found.verdict(), Verdict::Undecided, "{at}");
                // At Ω = 1 a wave meets its own conjugate at ω = 0: a defective double zero, known to the square root of the
                // rounding.
                assert!(found.error < if *speed > 0.99 { 1e-6 } else { 1.1e-11 }, "{at}");
            }
        }
    }
    // Off the lines the same disc has a verdict.
    let found =
        of(&loaded(ZooModes::N12, 0.0, Load::new(0.1, 0.1, 0.1, 0.01), DiscDither::None, 0.3));
    assert_eq!(found.verdict(), Verdict::Stable);
}

#[test]
fn a_free_disc_decays_with_the_damping_of_its_modes_at_any_speed() {
    let damping = 1e-3;
    for set in ZooModes::ALL {
        for speed in [0.0, 0.3, 1.0, 1.3, 5.0] {
            let modes = set.modes(damping);
            let lowest = modes.iter().map(|mode| mode.ratio).fold(f64::INFINITY, f64::min);
            let free = free(set, damping, speed);
            let found = of(&free);
            let gap = (found.rate + damping * lowest).abs();
            assert!(gap <= found.error, "{set:?}, Ω = {speed}: {gap:e} {found:?}");
            for value in values(&free) {
                let nearest = modes
                    .iter()
                    .map(|mode| (value.re + damping * mode.ratio).abs())
                    .fold(f64::INFINITY, f64::min);
                assert!(nearest < 1e-11, "{set:?}, Ω = {speed}: {value}");
            }
        }
    }
}

#[test]
fn damping_that_rotates_with_the_load_would_destabilise_a_free_disc() {
    // Why the circulatory pair is needed: Ω = 1.3, ξ = 10⁻³, no contact.
    let free = free(ZooModes::N12, 1e-3, 1.3);
    let parts = Contributions::ALL.without(Contribution::CirculatoryDamping);
    let rotating = undithered::growth_with(&free, parts).expect("finite").rate;
    assert!((rotating - 6.0e-4).abs() < 1e-5, "{rotating}");
    let resting = of(&free).rate;
    assert!((resting + 1.77e-3).abs() < 1e-5, "{resting}");
}

#[test]
fn two_opposite_half_pads_split_into_even_and_odd_diameters() {
    let whole = Load::new(0.3, 0.2, 0.25, 0.4);
    let half = Load::new(0.15, 0.1, 0.125, 0.2);
    let pads = vec![half.clone(), half.at_angle(PI)];
    for set in [ZooModes::N12, ZooModes::N25] {
        for speed in [0.05, 0.3, 0.85] {
            let split = |odd: usize| {
                let chosen =
                    set.modes(1e-4).into_iter().filter(|m| m.diameters % 2 == odd).collect();
                zoo::disc(chosen, vec![whole.clone()], DiscDither::None, speed)
            };
            let both = zoo::disc(set.modes(1e-4), pads.clone(), DiscDither::None, speed);
            let mut parts = values(&split(0));
            parts.extend(values(&split(1)));
            let found = values(&both);
            assert_eq!(found.len(), parts.len());
            for value in found {
                let (at, gap) = parts
                    .iter()
                    .enumerate()
                    .map(|(at, part)| (at, size(part - value)))
                    .min_by(|a, b| a.1.total_cmp(&b.1))
                    .expect("as many");
                assert!(gap < 1e-12, "{set:?}, Ω = {speed}: {value} {gap:e}");
                parts.swap_remove(at);
            }
            // The same under dither: the larger of the two growth rates.
            for dither in [NORMAL, TANGENTIAL] {
                let growth = |disc: &Disc| of(&disc.with_dither(dither));
                let (both, even, odd) = (growth(&both), growth(&split(0)), growth(&split(1)));
                let gap = (both.rate - even.rate.max(odd.rate)).abs();
                let bound = both.error + even.error + odd.error;
                assert!(gap <= bound && gap < 1e-9, "{set:?}, Ω = {speed}: {gap:e} {bound:e}");
            }
        }
    }
}

#[test]
fn exact_boundaries_are_marginal_and_linear_in_the_damper() {
    for set in [ZooModes::N12, ZooModes::N25] {
        for speed in [0.05, 0.3, 0.77, 0.95] {
            let at = |damping: f64, friction: f64| {
                loaded(set, 0.0, Load::new(0.2, damping, 0.3, friction), DiscDither::None, speed)
            };
            let found = boundaries(&at(0.1, 0.0)).expect("conservative");
            let doubled = boundaries(&at(0.2, 0.0)).expect("conservative");
            let mut checked = 0;
            for (one, two) in found.iter().zip(&doubled) {
                let (Marginal::At(f), Marginal::At(g)) = (one.friction, two.friction) else {
                    continue;
                };
                assert!((g - 2.0 * f).abs() <= 1e-12 * g.abs(), "{one:?} {two:?}");
                // On the boundary one eigenvalue lies on the axis, at the predicted frequency.
                let axis = Complex64::new(0.0, one.frequency);
                let gap = values(&at(0.1, f))
                    .iter()
                    .map(|v| size(v - axis))
                    .fold(f64::INFINITY, f64::min);
                assert!(gap < 1e-10, "{set:?}, Ω = {speed}, {one:?}: {gap:e}");
                checked += 1;
            }
            assert!(checked >= 4, "{set:?}, Ω = {speed}: {found:?}");
        }
    }
    // At standstill the two waves of each pair coincide: the load cannot reach one combination of each pair.
    let rest = loaded(ZooModes::N12, 0.0, Load::new(0.1, 0.1, 0.1, 0.1), DiscDither::None, 0.0);
    let found = boundaries(&rest).expect("conservative");
    assert_eq!(found.iter().filter(|b| b.friction == Marginal::Always).count(), 2, "{found:?}");
    let damped = loaded(ZooModes::N12, 1e-4, Load::new(0.1, 0.1, 0.1, 0.1), DiscDither::None, 0.3);
    assert_eq!(boundaries(&damped), Err(NoBoundary::DampedModes));
}

#[test]
fn crossings_of_the_partition_are_marginal() {
    // On a crossing a Floquet exponent is imaginary. Where nothing else grows, the growth rate vanishes there and the verdict
    // changes across it: the splitting and the scalar Hill determinant agree on its location.
    for (dither, strength, speed) in
        [(NORMAL, 0.3, 0.7), (NORMAL, 0.1, 0.3), (TANGENTIAL, 0.1, 0.325), (TANGENTIAL, 0.1, 0.369)]
    {
        for damping in [0.0, 1e-4] {
            let load = Load::new(strength, strength, strength, 1.0);
            let disc = loaded(ZooModes::N12, damping, load, dither, speed);
            let name = format!("{dither:?}, Ω = {speed}, ξ = {damping}");
            let prepared = dithered::prepared(&disc).expect("finite").expect("dithered");
            let at = |factor| prepared.growth(factor, Effort::default()).expect("finite");
            let found = crossings(&disc).expect("one load, dithered");
            let mut leading = 0;
            for crossing in found.iter().filter(|crossing| crossing.factor < 3.0) {
                let on = at(crossing.factor);
                if on.rate.abs() < 1e-8 {
                    leading += 1;
                    let gap = (on.frequency - crossing.frequency).abs();
                    assert!(gap < 1e-5, "{name}: {crossing:?} {on:?}");
                    let (below, above) = (at(crossing.factor * 0.999), at(crossing.factor * 1.001));
                    assert_ne!(below.verdict(), above.verdict(), "{name}: {crossing:?}");
                } else {
                    assert!(on.rate > 0.0, "{name}: {crossing:?} {on:?}");
                }
            }
            assert!(leading >= 1, "{name}: {found:?}");
            for share in [0.2, 0.6, 0.95] {
                let below = at(share * found[0].factor);
                assert_ne!(below.verdict(), Verdict::Unstable, "{name}: {below:?}");
            }
        }
    }
    let plain = loaded(ZooModes::N12, 0.0, Load::new(0.1, 0.1, 0.1, 1.0), DiscDither::None, 0.3);
    assert_eq!(crossings(&plain), Err(NoPartition::Undithered));
    // A dither a hundred times slower than the waves is rejected: it would take hours.
    let slow = DiscDither::Normal { amplitude: 0.8, frequency_ratio: 0.01 };
    let slow = loaded(ZooModes::N12, 0.0, Load::new(0.1, 0.1, 0.1, 1.0), slow, 0.3);
    assert!(matches!(crossings(&slow), Err(NoPartition::TooManyHarmonics { harmonics: 200.. })));
    // A friction whose square overflows has no computable eigenvalues at any frequency, which is not "no boundary".
    let vast = loaded(ZooModes::N12, 0.0, Load::new(0.1, 0.1, 0.1, 1e200), NORMAL, 0.3);
    assert_eq!(crossings(&vast), Err(NoPartition::Eigenvalues));
}

/// Two loads under dither with phases: a common phase only shifts the time, half a period reverses the sign.
#[test]
fn a_common_phase_shifts_time_and_half_a_period_reverses_the_sign() {
    let mode = |diameters, ratio| Mode { diameters, ratio, shape_at_load: 0.9, damping: 1e-3 };
    let loads = |friction: [f64; 2], phases: [f64; 2]| -> Vec<Load> {
        let angles = [0.0, 0.8];
        (0..2)
            .map(|l| {
                let load = Load::new(0.05, 0.01, 0.1, friction[l]);
                load.at_angle(angles[l]).dithered_at(phases[l])
            })
            .collect()
    };
    let growth = |friction, phases| {
        let dither = DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 3.9 };
        let modes = vec![mode(1, 1.8), mode(2, 2.0), mode(3, 3.1)];
        let disc = zoo::disc(modes, loads(friction, phases), dither, 0.3);
        dithered::prepared(&disc)
            .expect("finite")
            .expect("dithered")
            .growth(1.0, Effort { at_least: 1e-9, ..Effort::default() })
            .expect("finite")
    };
    let close = |a: Growth, b: Growth| {
        assert!((a.rate - b.rate).abs() <= a.error + b.error, "{a:?} {b:?}");
    };
    let plain = growth([0.2, 0.15], [0.0, 0.0]);
    close(plain, growth([0.2, 0.15], [0.7, 0.7]));
    close(growth([0.2, -0.15], [0.0, 0.0]), growth([0.2, 0.15], [0.0, PI]));
    // A phase between the loads is another system.
    let apart = growth([0.2, 0.15], [0.0, 0.5 * PI]);
    assert!(
        (apart.rate - plain.rate).abs() > 10.0 * (apart.error + plain.error),
        "{apart:?} {plain:?}"
    );
}

/// Every growing motion is listed, and the fastest is the one that decides.
#[test]
fn every_growing_motion_is_listed() {
    let mode = |diameters, ratio| Mode { diameters, ratio, shape_at_load: 0.9, damping: 0.0 };
    let disc = |dither| {
        let modes = vec![mode(1, 1.8), mode(2, 2.0), mode(3, 3.1)];
        zoo::disc(modes, vec![Load::new(0.05, 0.02, 0.1, 0.3)], dither, 0.3)
    };
    let still = disc(DiscDither::None);
    let listed = undithered::growing_with(&still, Contributions::ALL).expect("finite");
    let all = eigenvalues(&still).expect("finite");
    let growing = all.iter().filter(|value| value.im >= 0.0 && value.re > 1e-12).count();
    assert!(listed.len() == growing && growing > 1, "{listed:?} {all:?}");
    assert_eq!(listed[0].rate, undithered::growth(&still).expect("finite").rate);
    assert!(listed.is_sorted_by(|a, b| a.rate >= b.rate));
}
