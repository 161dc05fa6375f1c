//! Averaged stability: closed forms, limits, finite-R thresholds, numbers of the corrected dissertation.

use core::f64::consts::PI;

use quell_linear::averaging::{
    AveragedVerdict, Averaging, AveragingError, Becomes, CriticalVelocity, CrossingKind,
    EverywhereStable, FastWave, NeverStable, UndecidedBecause, closed_band, criterion,
    critical_amplitudes, everywhere_stable_amplitude, undithered_critical_velocity, unstable_bands,
};
use quell_model::{Belt, Direction, Dither, Friction, LawKind, Waveform};
use quell_zoo::BeltExt;
use quell_zoo::belt::{belt, decreasing_under};
use quell_zoo::dither::dither;
use quell_zoo::law::{self, build, dissertation, formula_with_level};

/// The laws with closed forms.
const CLOSED: [LawKind; 2] = [LawKind::Stribeck, LawKind::Decreasing];

fn close(value: f64, exact: f64, tolerance: f64) {
    assert!(((value - exact) / exact).abs() < tolerance, "{value} should be {exact}");
}

/// Undithered thresholds v₂ of both laws.
#[test]
fn undithered_thresholds() {
    for (kind, zeta, exact) in [
        (LawKind::Stribeck, 0.005, 0.198830057233),
        (LawKind::Stribeck, 0.05, 0.187973180517),
        (LawKind::Stribeck, 0.1, 0.175122337774),
        (LawKind::Decreasing, 0.005, 0.809135878048),
        (LawKind::Decreasing, 0.05, 0.348618859449),
        (LawKind::Decreasing, 0.1, 0.209989423337),
    ] {
        let Ok(CriticalVelocity::Above(v)) =
            undithered_critical_velocity(&dissertation(kind), zeta, 1.0)
        else {
            panic!("{kind:?} {zeta} has a threshold")
        };
        close(v, exact, 3e-12);
        let criterion = |v0: f64| {
            criterion(&belt(zeta, v0, dissertation(kind), vec![]), Averaging::Limit)
                .expect("slides")
        };
        assert_eq!(criterion(v * (1.0 - 1e-9)).verdict, AveragedVerdict::Unstable);
        assert_eq!(criterion(v * (1.0 + 1e-9)).verdict, AveragedVerdict::Stable);
        let at = criterion(v);
        assert!(at.value.abs() < 1e-14, "{at:?}");
        assert!(at.verdict != AveragedVerdict::Unstable || kind == LawKind::Decreasing, "{at:?}");
    }
    let decreasing = dissertation(LawKind::Decreasing);
    let undamped = undithered_critical_velocity(&decreasing, 0.0, 1.0);
    assert_eq!(undamped, Ok(CriticalVelocity::UnstableEverywhere));
    let damped = undithered_critical_velocity(&decreasing, 0.3, 1.0);
    assert_eq!(damped, Ok(CriticalVelocity::StableEverywhere));
}

/// Outer roots against the closed forms (3.43)–(3.60), as corrected, over belt velocities and dampings.
#[test]
fn roots_against_closed_forms() {
    let mut met = 0;
    for kind in &CLOSED {
        for waveform in Waveform::NAMED {
            for zeta in [0.005, 0.03, 0.08] {
                for k in 1..40 {
                    let v0 = 0.05 * f64::from(k);
                    let dithers = vec![dither(Direction::Tangential, waveform.clone(), 0.0, 10.0)];
                    let belt = belt(zeta, v0, dissertation(*kind), dithers);
                    let found = critical_amplitudes(&belt, Averaging::Limit);
                    for critical in found.expect("found") {
                        let alpha = critical.amplitude_ratio;
                        if critical.crossing == CrossingKind::Jump {
                            close(alpha * waveform.peak_integral(), v0, 1e-15);
                            assert_eq!(critical.becomes, Becomes::Stable);
                            continue;
                        }
                        met += 1;
                        let band = closed_band(&dissertation(*kind), zeta, 1.0, waveform, alpha);
                        let upper = band.expect("a band").upper.expect("it ends");
                        close(upper, v0, 1e-12);
                        let becomes = if *kind == LawKind::Stribeck {
                            Becomes::Stable
                        } else {
                            Becomes::Unstable
                        };
                        assert_eq!(critical.becomes, becomes);
                    }
                }
            }
        }
    }
    assert!(met > 40, "{met}");
}

/// Without damping a decreasing law, built in or as a formula, is unstable at every velocity above the fast velocity,
/// although its slopes far out are zero within their error. A law without a slope has no unstable velocity.
#[test]
fn only_laws_without_any_slope_have_no_unstable_band() {
    let formula = |text: &str| formula_with_level(text, law::STATIC);
    let named = law::decreasing();
    let falling = formula("0.2857 + 0.1143*exp(-abs(v)/0.2)");
    for (law, bands) in [(named, 1), (falling, 1), (formula("0.3"), 0)] {
        let sine = dither(Direction::Tangential, Waveform::Sine, 6.0, 10.0);
        let belt = belt(0.0, 1.0, &law, vec![sine]);
        let found = unstable_bands(&belt, Averaging::Limit).expect("ok");
        assert_eq!(found.len(), bands, "{law:?} {found:?}");
        for band in found {
            assert!((band.lower - 0.6).abs() < 1e-9 && band.upper.is_none(), "{band:?}");
        }
    }
}

/// Bands found from the criterion are the closed ones, tangential; for normal dither their edges satisfy α = μ(v₀)α_N.
#[test]
fn bands() {
    let (mut tangential, mut normal) = (0, 0);
    for kind in &CLOSED {
        let law = dissertation(*kind);
        for waveform in Waveform::NAMED {
            for zeta in [0.005, 0.05, 0.1] {
                for alpha in [0.0, 0.02, 0.07, 0.15, 0.3] {
                    let dithers =
                        vec![dither(Direction::Tangential, waveform.clone(), 10.0 * alpha, 10.0)];
                    let dithered = belt(zeta, 1.0, &law, dithers);
                    let found = unstable_bands(&dithered, Averaging::Limit).expect("ok");
                    let closed = closed_band(&law, zeta, 1.0, waveform, alpha);
                    assert_eq!(found.len(), usize::from(closed.is_ok()), "{found:?} {closed:?}");
                    if let (Some(found), Ok(closed)) = (found.first(), closed) {
                        tangential += 1;
                        assert!((found.lower - closed.lower).abs() < 1e-14, "{found:?} {closed:?}");
                        close(found.upper.expect("ends"), closed.upper.expect("ends"), 1e-12);
                        assert_eq!(found.lower_crossing, closed.lower_crossing);
                    }
                    let dithers =
                        vec![dither(Direction::Normal, waveform.clone(), 2.0 * alpha, 2.0)];
                    let dithered = belt(zeta, 1.0, &law, dithers);
                    for band in unstable_bands(&dithered, Averaging::Limit).expect("ok") {
                        normal += 1;
                        let level = |v: f64| law.coefficient(v) * alpha;
                        let reach = level(band.lower) * waveform.peak_integral();
                        assert!((band.lower - reach).abs() < 1e-13, "{band:?}");
                        let upper = band.upper.expect("ends");
                        let same = closed_band(&law, zeta, 1.0, waveform, level(upper));
                        close(same.expect("a band").upper.expect("ends"), upper, 1e-12);
                    }
                }
            }
        }
    }
    assert!(tangential > 30 && normal > 50, "{tangential} {normal}");
    // The corrected (3.47): upper edge of the triangle at α = 0.15 (the print's π²/48 gives 0.18683).
    let band = closed_band(&dissertation(LawKind::Stribeck), 0.005, 1.0, &Waveform::Triangle, 0.15);
    close(band.expect("a band").upper.expect("ends"), 0.17925174576154, 1e-13);
}

fn amplitude(found: Result<EverywhereStable, AveragingError>) -> f64 {
    match found {
        Ok(EverywhereStable::From { amplitude_ratio, error }) => {
            assert!(error < 1e-11 * amplitude_ratio);
            amplitude_ratio
        }
        other => panic!("{other:?}"),
    }
}

/// α^L of both laws, tangential and normal.
#[test]
fn everywhere_stable() {
    let [sine, triangle, square] = [Waveform::Sine, Waveform::Triangle, Waveform::Square];
    let (stribeck, decreasing) =
        (dissertation(LawKind::Stribeck), dissertation(LawKind::Decreasing));
    let (t, n) = (Direction::Tangential, Direction::Normal);
    let found = |law: &Friction, zeta: f64, waveform: Waveform, direction: Direction| {
        let wave = FastWave::Integral(waveform);
        amplitude(everywhere_stable_amplitude(law, zeta, 1.0, wave, direction))
    };
    for (zeta, waveform, exact) in [
        (0.005, sine.clone(), 0.162344061917),
        (0.1, sine.clone(), 0.142986790037),
        (0.005, triangle.clone(), 0.204443763791),
    ] {
        close(found(&stribeck, zeta, waveform, t), exact, 3e-12);
    }
    for (zeta, waveform, exact) in [
        (0.05, sine.clone(), 1.0941276920426),
        (0.05, triangle.clone(), 1.6332707873485),
        (0.05, square.clone(), 0.36260571633514),
        (0.07, sine.clone(), 0.59157534212326),
        (0.07, triangle.clone(), 0.8399929583869),
        (0.07, square.clone(), 0.2551552486811),
        (0.1, sine.clone(), 0.32506419178468),
        (0.1, triangle.clone(), 0.43625568163403),
        (0.1, square.clone(), 0.16915165909353),
        (0.005, sine.clone(), 104.013944251928),
        (0.005, triangle.clone(), 163.306125),
        (0.005, square.clone(), 3.6382819990807),
    ] {
        let tolerance = if exact == 163.306125 { 1e-8 } else { 1e-12 };
        close(found(&decreasing, zeta, waveform, t), exact, tolerance);
    }
    for (waveform, exact) in
        [(sine.clone(), 0.557124589480), (triangle, 0.700327159816), (square, 0.379493225521)]
    {
        close(found(&stribeck, 0.005, waveform, n), exact, 3e-12);
    }
    let never = |law: &Friction, zeta: f64| {
        everywhere_stable_amplitude(law, zeta, 1.0, FastWave::Integral(sine.clone()), t)
            .expect("ok")
    };
    assert_eq!(never(&decreasing, 0.0), EverywhereStable::Never { why: NeverStable::NoDamping });
    assert_eq!(never(&decreasing, 0.3), EverywhereStable::Always);
}

/// Normal dither on a Stribeck law so steep that the largest α/μ(v₀) lies beyond the tip: the search under the oscillator's
/// response agrees with the closed form for fast dither; taken at the tip alone the amplitude would be smaller.
#[test]
fn steep_laws_are_searched_beyond_the_tip() {
    let steep = build(LawKind::Stribeck, &[0.4, 0.008, 0.2]);
    let (waveform, frequency_ratio) = (Waveform::Square, 1e4);
    let limit = FastWave::Integral(waveform.clone());
    let own = FastWave::Oscillator { waveform: waveform.clone(), frequency_ratio };
    let found = |wave: FastWave, direction: Direction| match everywhere_stable_amplitude(
        &steep,
        0.001,
        1.0,
        wave.clone(),
        direction,
    ) {
        Ok(EverywhereStable::From { amplitude_ratio, .. }) => amplitude_ratio,
        other => panic!("{wave:?} {direction:?}: {other:?}"),
    };
    let tangential = found(limit.clone(), Direction::Tangential);
    let at_tip = tangential / steep.coefficient(tangential * waveform.peak_integral());
    let closed = found(limit, Direction::Normal);
    assert!(closed > 1.01 * at_tip, "{closed} {at_tip}");
    close(found(own, Direction::Normal), closed, 1e-4);
}

/// Just above α^L no belt velocity is unstable, and just below it the tip is; also for the
/// oscillator's response and for normal dither in the limit.
#[test]
fn everywhere_stable_closes_the_band() {
    for kind in &CLOSED {
        for waveform in Waveform::NAMED {
            for &direction in Direction::ALL {
                for response in [Averaging::Limit, Averaging::FiniteR] {
                    // α^L has normal dither to first order, finite-R bands to second.
                    if response == Averaging::FiniteR && direction == Direction::Normal {
                        continue;
                    }
                    let (zeta, r) = (0.08, 1.2);
                    let wave = match response {
                        Averaging::FiniteR => {
                            FastWave::Oscillator { waveform: waveform.clone(), frequency_ratio: r }
                        }
                        _ => FastWave::Integral(waveform.clone()),
                    };
                    let law = dissertation(*kind);
                    let alpha =
                        amplitude(everywhere_stable_amplitude(&law, zeta, 1.0, wave, direction));
                    let bands = |alpha: f64| {
                        let dithers = vec![dither(direction, waveform.clone(), alpha * r, r)];
                        // A heavy load keeps the contact closed; F enters the criterion with ζ.
                        let belt =
                            Belt::new(4.0 * zeta, 4.0, 1.0, law.clone(), dithers).expect("valid");
                        unstable_bands(&belt, response).expect("ok")
                    };
                    assert!(
                        bands(alpha * (1.0 + 1e-6)).is_empty(),
                        "{kind:?} {waveform:?} {direction:?} {response:?}"
                    );
                    assert_eq!(
                        bands(alpha * (1.0 - 1e-6)).len(),
                        1,
                        "{kind:?} {waveform:?} {direction:?} {response:?} {alpha}"
                    );
                }
            }
        }
    }
}

/// "μ̄′ ≥ 0 inside" fails for a Stribeck law that falls far enough: (μ_s − μ_m)/μ_s above √6/π, √0.4, never for a square.
#[test]
fn inner_region_may_be_unstable() {
    for (waveform, limit) in
        [(Waveform::Sine, 6.0_f64.sqrt() / PI), (Waveform::Triangle, 0.4_f64.sqrt())]
    {
        for (fall, dips) in [(limit - 0.01, false), (limit + 0.01, true)] {
            let law = build(LawKind::Stribeck, &[1.0, 1.0 - fall, 0.2]);
            let dithers = vec![dither(Direction::Tangential, waveform.clone(), 1.0, 10.0)];
            let belt = belt(0.0, 1e-7, &law, dithers);
            let found = critical_amplitudes(&belt, Averaging::Limit).expect("ok");
            // One jump at the corner, and two roots where the inner criterion dips below zero.
            assert_eq!(found.len(), if dips { 3 } else { 1 }, "{waveform:?} {fall} {found:?}");
            if dips {
                assert_eq!(found[1].becomes, Becomes::Unstable);
                assert_eq!(found[2].becomes, Becomes::Stable);
                let wave = FastWave::Integral(waveform.clone());
                let all = everywhere_stable_amplitude(&law, 0.0, 1.0, wave, Direction::Tangential);
                let all = amplitude(all);
                close(all, found[2].amplitude_ratio, 1e-5);
                assert!(all >= found[2].amplitude_ratio);
            }
        }
    }
    let deep = build(LawKind::Stribeck, &[1.0, 0.0, 0.2]);
    let dithers = vec![dither(Direction::Tangential, Waveform::Square, 1.0, 10.0)];
    let found = critical_amplitudes(&belt(0.0, 1e-4, deep, dithers), Averaging::Limit);
    assert_eq!(found.expect("ok").len(), 1);
}

/// Averaging with the oscillator's own velocity: decreasing law, v₀ = 1, R = 10, sine.
#[test]
fn finite_r_thresholds() {
    let belt = decreasing_under(Waveform::Sine, 1.0);
    let finite_r = Averaging::FiniteR;
    let found = critical_amplitudes(&belt, finite_r).expect("ok");
    assert_eq!(found.len(), 2);
    // Exact (Floquet): 4.322392624 and 9.900214849; plain averaging 4.366 and 10.
    close(found[0].amplitude, 4.322392, 1e-7);
    close(found[0].amplitude, 4.322392624, 2e-7);
    close(found[1].amplitude, 9.9, 1e-14);
    let plain = critical_amplitudes(&belt, Averaging::Limit).expect("ok");
    close(plain[0].amplitude, 4.36605249129233293, 1e-13);
    close(plain[1].amplitude, 10.0, 1e-15);
    // Square: exact 3.295664190 and 6.313857946.
    let belt = decreasing_under(Waveform::Square, 1.0);
    let found = critical_amplitudes(&belt, finite_r).expect("ok");
    close(found[0].amplitude, 3.295664190, 1e-6);
    close(found[1].amplitude, 6.313857946, 1e-3);
    let plain = critical_amplitudes(&belt, Averaging::Limit).expect("ok");
    assert!((plain[0].amplitude - 3.295664190).abs() > 0.02);
}

/// Normal dither, decreasing law, ζ = 0.2, v₀ = 0.075: first and second order of φ′ against the limit R → ∞
/// (derived in `averaging_errata.rs`, where exact orbits are extrapolated to it).
#[test]
fn normal_dither() {
    let law = dissertation(LawKind::Decreasing);
    for (waveform, first, second, exact) in [
        (Waveform::Square, 0.115719, 0.115518, 0.115322),
        (Waveform::Sine, 0.148482, 0.148321, 0.147977),
    ] {
        let belt =
            belt(0.2, 0.075, &law, vec![dither(Direction::Normal, waveform.clone(), 0.5, 5.0)]);
        let critical = |averaging| critical_amplitudes(&belt, averaging).expect("ok");
        let one = critical(Averaging::Limit);
        assert_eq!(one.len(), 2, "{one:?}");
        assert!((one[0].amplitude_ratio - first).abs() < 6e-7, "{one:?}");
        assert_eq!((one[0].crossing, one[0].becomes), (CrossingKind::Root, Becomes::Unstable));
        let last = one[1];
        close(
            last.amplitude_ratio * law.coefficient(0.075) * waveform.peak_integral(),
            0.075,
            1e-14,
        );
        assert_eq!(last.crossing, CrossingKind::Jump);
        // D_N = 0.655 for the square, but 1.03 > F for the sine, whose jump lies at α_N = 0.206.
        assert_eq!(last.contact_stays_closed, waveform == Waveform::Square);
        let two = critical(Averaging::LimitToSecondOrder);
        assert_eq!(two.len(), 2, "{two:?}");
        assert!((two[0].amplitude_ratio - second).abs() < 6e-7, "{two:?}");
        assert!((two[0].amplitude_ratio - exact).abs() < (first - exact));
        assert_eq!((two[0].crossing, two[1].crossing), (CrossingKind::Root, CrossingKind::Jump));
    }
    // The substitution α_T → μ(v₀)α_N, on every row of a grid.
    for kind in &CLOSED {
        for v0 in [0.03, 0.12, 0.18, 0.6] {
            let law = dissertation(*kind);
            let of = |direction| {
                let belt =
                    belt(0.05, v0, &law, vec![dither(direction, Waveform::Triangle, 0.1, 3.0)]);
                critical_amplitudes(&belt, Averaging::Limit).expect("ok")
            };
            let (tangential, normal) = (of(Direction::Tangential), of(Direction::Normal));
            assert_eq!(tangential.len(), normal.len());
            for (t, n) in tangential.iter().zip(&normal) {
                close(n.amplitude_ratio * law.coefficient(v0), t.amplitude_ratio, 1e-12);
                assert_eq!((n.crossing, n.becomes), (t.crossing, t.becomes));
            }
        }
    }
}

/// Scaling all lengths by a power of two scales the critical amplitudes exactly.
#[test]
fn lengths_scale_out() {
    let scale = 2.0_f64.powi(-17);
    for kind in &CLOSED {
        for waveform in Waveform::NAMED {
            for v0 in [0.1, 0.5, 1.0] {
                let dithers = vec![dither(Direction::Tangential, waveform.clone(), 0.1, 10.0)];
                let belt = belt(0.005, v0, dissertation(*kind), dithers);
                let found = |belt: &Belt| critical_amplitudes(belt, Averaging::Limit).expect("ok");
                let (one, small) = (found(&belt), found(&belt.scaled(scale)));
                assert_eq!(one.len(), small.len());
                for (one, small) in one.iter().zip(&small) {
                    assert_eq!(one.amplitude_ratio * scale, small.amplitude_ratio);
                    assert_eq!(one.amplitude * scale, small.amplitude);
                }
            }
        }
    }
}

/// Coulomb's law (μ_s = μ_m) never destabilises a damped belt; at rest without dither there is no slope.
#[test]
fn limits() {
    for kind in &CLOSED {
        let coulomb = build(*kind, &[0.4, 0.4, 0.2]);
        for waveform in Waveform::NAMED {
            for v0 in [0.01, 0.3, 2.0] {
                let dithers = vec![dither(Direction::Tangential, waveform.clone(), 1.0, 10.0)];
                let belt = belt(0.01, v0, &coulomb, dithers);
                let options = Averaging::Limit;
                assert_eq!(criterion(&belt, options).expect("ok").verdict, AveragedVerdict::Stable);
                assert!(critical_amplitudes(&belt, options).expect("ok").is_empty());
                assert!(unstable_bands(&belt, options).expect("ok").is_empty());
            }
        }
        let rest = criterion(&belt(0.01, 0.0, &coulomb, vec![]), Averaging::Limit);
        assert_eq!(rest, Err(AveragingError::SetValued { static_coefficient: 0.4 }));
        // Without damping and slope the criterion is zero, and undecided.
        let neutral = criterion(&belt(0.0, 1.0, &coulomb, vec![]), Averaging::Limit);
        assert_eq!(
            neutral.expect("slides").verdict,
            AveragedVerdict::Undecided { why: UndecidedBecause::WithinError }
        );
    }
    // At rest with tangential dither there is no outer region; the default laws are stable for any amplitude.
    for kind in &CLOSED {
        let dithers = vec![dither(Direction::Tangential, Waveform::Sine, 1.0, 10.0)];
        let belt = belt(0.005, 0.0, dissertation(*kind), dithers);
        assert_eq!(
            criterion(&belt, Averaging::Limit).expect("dithered").verdict,
            AveragedVerdict::Stable
        );
        assert!(critical_amplitudes(&belt, Averaging::Limit).expect("ok").is_empty());
    }
}

/// Exactly at the corner: undecided where the sides disagree, stable where both are.
#[test]
fn verdict_at_the_corner() {
    let verdict = |kind: LawKind, v0: f64| {
        let dithers = vec![dither(Direction::Tangential, Waveform::Sine, 10.0 * v0, 10.0)];
        criterion(&belt(0.005, v0, dissertation(kind), dithers), Averaging::Limit).expect("ok")
    };
    let disagree = verdict(LawKind::Decreasing, 0.5);
    assert_eq!(disagree.verdict, AveragedVerdict::Undecided { why: UndecidedBecause::AtCorner });
    close(disagree.value, -0.14433154, 1e-7);
    assert_eq!(verdict(LawKind::Stribeck, 0.25).verdict, AveragedVerdict::Stable);
}

/// Two dithers: a second one of fixed amplitude shifts the critical amplitude of the first; equal frequencies add exactly.
#[test]
fn several_dithers() {
    let first = dither(Direction::Tangential, Waveform::Sine, 1.0, 10.0);
    let options = Averaging::Limit;
    // The same wave twice: criticals of the first are lower by the second's α.
    let second = Dither { amplitude: 0.3, ..first.clone() };
    let law = dissertation(LawKind::Decreasing);
    let alone =
        critical_amplitudes(&belt(0.05, 0.5, &law, vec![first.clone()]), options).expect("ok");
    let both =
        critical_amplitudes(&belt(0.05, 0.5, &law, vec![first.clone(), second.clone()]), options)
            .expect("ok");
    assert_eq!(alone.len(), 2);
    assert_eq!(both.len(), 2, "{both:?}");
    for (alone, both) in alone.iter().zip(&both) {
        assert!(
            (alone.amplitude_ratio - 0.03 - both.amplitude_ratio).abs() < 1e-11,
            "{alone:?} {both:?}"
        );
        assert_eq!((alone.crossing, alone.becomes), (both.crossing, both.becomes));
    }
    // Incommensurate, outer region: I₀(α₁/v_m) I₀(α₂/v_m) at the lower critical amplitude.
    let other = Dither { frequency_ratio: 10.0 * 2.0_f64.sqrt(), ..second };
    let both = critical_amplitudes(&belt(0.05, 0.5, &law, vec![first, other.clone()]), options)
        .expect("ok");
    let i0 = |a: f64| quell_numerics::special::bessel_i0_scaled(a) * a.exp();
    let m = |alpha: f64| i0(alpha / 0.2);
    close(
        m(both[0].amplitude_ratio) * m(other.amplitude_ratio()),
        m(alone[0].amplitude_ratio),
        1e-9,
    );
}
