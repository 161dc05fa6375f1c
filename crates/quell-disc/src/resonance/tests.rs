//! Comparison with the tables of the dissertation, exact eigenvalues and exponents, and limits.

use super::meetings::WaveMeeting;
use super::*;
use crate::dithered::growth;
use crate::plate::{ModeSet, Plate, Reference};
use quell_model::disc::{Disc, DiscDither};
use quell_model::disc::{Load, Mode};
use quell_numerics::floquet::Effort;

/// b/a = 0.5, r₀/a = 0.75, ν = 0.3, N = (1, 2).
fn modes(damping: f64) -> Vec<Mode> {
    let plate = Plate::new(0.5, 0.3).expect("valid");
    let set = ModeSet::new(&plate, 1, 2, Reference::Critical).expect("found");
    set.at_radius(0.75, damping).expect("on the plate")
}

/// m = c = k = ε and a friction.
fn load(size: f64, friction: f64) -> Load {
    Load::new(size, size, size, friction)
}

fn waves_of(modes: &[Mode], load: &Load, dither: DiscDither) -> Waves {
    Waves::new(&Disc::new(modes.to_vec(), vec![load.clone()], dither, 0.0).expect("valid"))
        .expect("one load")
}

fn tangential(frequency_ratio: f64) -> DiscDither {
    DiscDither::Tangential { amplitude: 1.0, frequency_ratio }
}

/// Tables 5.1 and 5.2 to every printed digit, and which meetings of the second can be unstable.
#[test]
fn tables_of_the_dissertation() {
    let waves = waves_of(&modes(0.0), &load(0.1, 0.1), tangential(2.7));
    let printed = |found: &[Resonance]| -> Vec<String> {
        found.iter().map(|resonance| format!("{:.3}", resonance.speed)).collect()
    };
    let undithered: Vec<Resonance> =
        waves.undithered(0.0..=1.0).into_iter().filter(|r| r.speed > 1e-9).collect();
    assert_eq!(printed(&undithered), ["0.036", "0.064", "0.114", "0.192", "1.000"]);
    let dithered: Vec<Resonance> =
        waves.dithered(0.0..=1.0).into_iter().filter(|r| r.speed > 1e-9).collect();
    let speeds = ["0.325", "0.369", "0.458", "0.536", "0.675", "0.836", "0.879", "0.964"];
    assert_eq!(printed(&dithered), speeds);
    let unstable: Vec<bool> = dithered.iter().map(Resonance::pair_can_be_unstable).collect();
    assert_eq!(unstable, [true, true, true, false, false, false, false, false]);
    assert_eq!(dithered[0].label(), "forward (1,2) with its own conjugate");
    assert_eq!(dithered[1].label(), "forward (1,1) with forward (1,2)");
    assert_eq!(dithered[2].label(), "forward (1,1) with its own conjugate");
    // Frictions at the tips under tangential dither, in units of c: 1.350, 1.905, 2.700.
    for (resonance, tip) in dithered.iter().zip([1.350, 1.905, 2.700]) {
        let threshold = resonance.threshold.expect("has a tip");
        assert!((threshold / 0.1 - tip).abs() < 6e-4, "{threshold}");
    }
    // Without mean friction the undithered pairs are not excited; without dither they are.
    assert!(undithered.iter().all(|resonance| !resonance.pair_can_be_unstable()));
    let plain = waves_of(&modes(0.0), &load(0.1, 0.1), DiscDither::None);
    let found = plain.undithered(0.01..=0.99);
    assert!(found.iter().all(Resonance::pair_can_be_unstable));
    assert!(found.iter().all(|resonance| resonance.threshold == Some(0.0)));
    assert!(plain.dithered(0.0..=1.0).is_empty());
}

/// Largest growth rate at a speed by the exact equations.
fn exact(modes: &[Mode], load: &Load, dither: DiscDither, speed: f64) -> f64 {
    let disc = Disc::new(modes.to_vec(), vec![load.clone()], dither, speed).expect("valid");
    growth(&disc, Effort::default()).expect("finite").rate
}

fn largest(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let steps = 40;
    let at = |i: i32| from + (to - from) * f64::from(i) / f64::from(steps);
    let best = (1..steps).max_by(|a, b| f(at(*a)).total_cmp(&f(at(*b)))).expect("steps");
    let closeness = quell_numerics::roots::Closeness { absolute: 1e-9, relative: 0.0 };
    -quell_numerics::roots::minimise(|x| -f(x), at(best - 1), at(best + 1), closeness)
        .expect("ends")
        .value
}

/// Undithered tongues, m = c = k = ε, f = 0.4ε, ξ = 0: the errors of the largest growth rate and the far edge decrease with ε.
#[test]
fn undithered_tongues_converge() {
    let modes = modes(0.0);
    for index in 0..4 {
        let mut errors = Vec::new();
        for size in [0.1, 0.025, 0.00625] {
            let load = load(size, 0.4 * size);
            let waves = waves_of(&modes, &load, DiscDither::None);
            let resonance = waves.undithered(0.01..=0.99)[index];
            let Tongue::Between { lower, upper, peak_growth, .. } = resonance.tongue else {
                panic!("{resonance:?}");
            };
            assert!(
                (lower - resonance.speed).abs() < 1e-12,
                "K < 0: the tongue is above its meeting"
            );
            let width = upper - lower;
            let growth = |speed: f64| exact(&modes, &load, DiscDither::None, speed);
            let exact = largest(growth, lower, upper);
            let (mut inside, mut outside) = (lower + 0.4 * width, lower + 1.6 * width);
            for _ in 0..60 {
                let middle = 0.5 * (inside + outside);
                if growth(middle) > 0.0 { inside = middle } else { outside = middle }
            }
            let growth_error = peak_growth / exact - 1.0;
            let width_error = width / (inside - lower) - 1.0;
            println!("Ω_{} ε = {size}: {growth_error:+.4}, {width_error:+.4}", index + 1);
            errors.push([growth_error.abs(), width_error.abs()]);
        }
        for pair in errors.windows(2) {
            // Proportional to ε would be a factor of 4; the next order in ε modifies it.
            for (coarse, fine) in pair[0].iter().zip(&pair[1]) {
                assert!((2.3..7.0).contains(&(coarse / fine)), "{index}: {errors:?}");
            }
        }
    }
}

/// Tongues induced by tangential dither at 1.5 times the friction of their tip.
#[test]
fn dithered_tongues_converge() {
    let modes = modes(0.0);
    for index in 0..3 {
        let mut errors = Vec::new();
        for size in [0.025, 0.00625] {
            let still = waves_of(&modes, &load(size, 0.0), tangential(2.7));
            let tip = still.dithered(0.01..=0.99)[index].threshold.expect("a tip");
            let load = load(size, 1.5 * tip);
            let waves = still.with_friction(1.5 * tip);
            let resonance = waves.dithered(0.01..=0.99)[index];
            let Tongue::Between { lower, upper, peak_growth, .. } = resonance.tongue else {
                panic!("{resonance:?}");
            };
            let width = upper - lower;
            let growth = |speed: f64| exact(&modes, &load, tangential(2.7), speed);
            let exact = largest(growth, lower - 0.3 * width, upper + 0.3 * width);
            errors.push(peak_growth / exact - 1.0);
        }
        println!("Ω_{}*: {errors:?}", index + 1);
        let ratio = errors[0] / errors[1];
        assert!((3.0..6.0).contains(&ratio) && errors[1].abs() < 0.025, "{errors:?}");
    }
}

/// Second order: tongues revived under tangential dither, f = √ε·0.5. The error of the growth rate decreases with ε.
#[test]
fn revived_tongues_converge() {
    let modes = modes(0.0);
    for index in 0..4 {
        let mut errors = Vec::new();
        for size in [0.02, 0.005] {
            let load = load(size, 0.5 * f64::sqrt(size));
            let waves = waves_of(&modes, &load, tangential(2.7)).with_order(Order::Second);
            let resonance = waves.undithered(0.01..=0.99)[index];
            let Tongue::Between { lower, upper, peak_growth, .. } = resonance.tongue else {
                panic!("{resonance:?}");
            };
            let width = upper - lower;
            let growth = |speed: f64| exact(&modes, &load, tangential(2.7), speed);
            let exact = largest(growth, lower - 0.3 * width, upper + 0.3 * width);
            println!(
                "revived Ω_{}: ε {size}, at {:.5}, {lower:.6} to {upper:.6}, growth {peak_growth:.3e}, exact {exact:.3e}",
                index + 1,
                resonance.speed
            );
            errors.push((peak_growth / exact - 1.0).abs());
        }
        assert!(errors[1] < 0.15 && errors[1] < 0.6 * errors[0], "{index}: {errors:?}");
    }
}

/// Larger growth rate of the wave pair of a resonance at a speed near it, from the slow 2 × 2 system.
fn pair_growth(waves: &Waves, resonance: &Resonance, speed: f64) -> f64 {
    let meeting = WaveMeeting {
        waves: resonance.waves,
        conjugate: resonance.sum,
        h: resonance.harmonic,
        speed: resonance.speed,
    };
    let [first, second] = meeting.signed();
    waves.pair(&meeting).growth((first.l - second.l) * (speed - resonance.speed))
}

/// The slow system is marginal at the edges, its largest growth is at the peak, and the tongue begins at the threshold.
#[test]
fn tongue_agrees_with_its_own_pair() {
    let (modes, size) = (modes(1e-4), 0.05);
    let cases = [
        (DiscDither::None, 0.03, Order::First),
        (DiscDither::Normal { amplitude: 0.8, frequency_ratio: 2.7 }, 0.03, Order::First),
        (tangential(2.7), 0.2, Order::First),
        (tangential(2.7), 0.2, Order::Second),
    ];
    let mut tongues = 0;
    for (dither, friction, order) in cases {
        let waves = waves_of(&modes, &load(size, friction), dither).with_order(order);
        let found = waves.undithered(0.01..=0.99).into_iter().chain(waves.dithered(0.01..=0.99));
        for resonance in found {
            let growth = |speed: f64| pair_growth(&waves, &resonance, speed);
            match resonance.tongue {
                Tongue::Between { lower, upper, peak_speed, peak_growth } => {
                    tongues += 1;
                    assert!(growth(lower).abs() < 1e-12 && growth(upper).abs() < 1e-12);
                    assert!((growth(peak_speed) - peak_growth).abs() < 1e-15 && peak_growth > 0.0);
                    for i in 0..=100 {
                        let speed = lower + (upper - lower) * f64::from(i) / 100.0;
                        assert!(growth(speed) <= peak_growth + 1e-15);
                    }
                    let threshold = resonance.threshold.expect("it has a tongue");
                    assert!(threshold <= friction, "{resonance:?}");
                    let tongue_at = |f: f64| {
                        let waves = waves.with_friction(f);
                        let list = if resonance.harmonic == 0 {
                            waves.undithered(0.01..=0.99)
                        } else {
                            waves.dithered(0.01..=0.99)
                        };
                        let same = |r: &&Resonance| {
                            r.waves == resonance.waves
                                && r.sum == resonance.sum
                                && r.harmonic == resonance.harmonic
                        };
                        list.iter().find(same).expect("the same meeting").tongue
                    };
                    assert_eq!(tongue_at(0.999 * threshold), Tongue::Absent, "{resonance:?}");
                    assert_ne!(tongue_at(1.001 * threshold), Tongue::Absent, "{resonance:?}");
                }
                Tongue::Absent => assert!(growth(resonance.speed) < 1e-12),
                Tongue::WaveUnstable { .. } => {}
            }
        }
    }
    assert!(tongues >= 8, "{tongues}");
}

/// A backward wave by itself becomes unstable at f = c(β/l + Ω) + 2ξβ²/(l g²); a forward wave never does.
#[test]
fn single_waves() {
    let (waves, speed) = (waves_of(&modes(1e-3), &load(0.1, 0.0), DiscDither::None), 0.4);
    let mut backward = 0;
    for wave in waves.waves() {
        let growth = |friction: f64| waves.with_friction(friction).growth_rate(wave, speed);
        if wave.direction == WaveDirection::Backward {
            backward += 1;
            let (mode, l) = (&waves.modes[wave.mode], wave.signed_diameters());
            let own = 2.0 * mode.damping * mode.ratio * mode.ratio;
            let limit = waves.load.damping * (mode.ratio / l + speed)
                + own / (l * waves.coupling_squared(wave.mode));
            assert!(growth(limit).abs() < 1e-16 && growth(1.01 * limit) > 0.0);
        } else {
            assert!(growth(10.0) < 0.0);
        }
    }
    assert_eq!(backward, 2);
}

/// Normal dither with so much friction that a backward wave grows by itself: its meetings inside the range reach in, those
/// outside do not.
#[test]
fn unstable_wave_reaches_into_the_range() {
    // Backward waves meet backward ones at a sum of frequencies: 2·2 + 4Ω = 6.
    let dither = DiscDither::Normal { amplitude: 0.5, frequency_ratio: 6.0 };
    let waves = waves_of(&modes(1e-3), &load(0.1, 3.0), dither);
    let found = within(&waves, 0.2..=0.9);
    let alone = |nearby: &&Nearby| {
        nearby.resonance.harmonic != 0
            && matches!(nearby.resonance.tongue, Tongue::WaveUnstable { .. })
    };
    assert!(found.iter().filter(alone).count() > 0, "{found:?}");
    for nearby in found.iter().filter(alone) {
        assert_eq!(nearby.reaches_in, (0.2..=0.9).contains(&nearby.resonance.speed), "{nearby:?}");
    }
}

/// Clear frequencies have no tongue in the range and blocked ones do; a tongue enters the range at the edges of the intervals.
#[test]
fn clear_intervals() {
    let waves = waves_of(&modes(0.0), &load(0.1, 0.3), tangential(2.7));
    let speeds = 0.2..=0.6;
    let found = clear_frequencies(&waves, speeds.clone(), 2.0..=6.0).expect("answer");
    assert!(found.original_suppressed);
    assert!(!found.clear.is_empty() && !found.blocked.is_empty(), "{found:?}");
    // A single frequency is clear if it is in a clear interval.
    for frequency in [2.3, 2.7, 3.4, 4.1, 5.2, 5.9] {
        let one = clear_frequencies(&waves, speeds.clone(), frequency..=frequency).expect("answer");
        let inside = found.clear.iter().any(|[from, to]| (*from..=*to).contains(&frequency));
        let expected = if inside { vec![[frequency; 2]] } else { Vec::new() };
        assert_eq!(one.clear, expected);
    }
    let grows = |frequency: f64| {
        // The slow system over the range, with damping at the speed itself.
        (0..=4000).any(|i| {
            let speed = 0.2 + 0.4 * f64::from(i) / 4000.0;
            waves.families(1).iter().any(|family| {
                let pair = waves.pair(&Waves::meeting_of(family, speed));
                let [one, two] = family.signed();
                let apart =
                    waves.signed_frequency(&one, speed) - waves.signed_frequency(&two, speed);
                pair.growth(apart - f64::from(family.h) * frequency) > 0.0
            })
        })
    };
    for [from, to] in &found.clear {
        for part in [0.001, 0.5, 0.999] {
            assert!(!grows(from + part * (to - from)), "{from} {to}");
        }
        if *from > 2.0 {
            assert!(grows(from - 1e-3));
        }
        if *to < 6.0 {
            assert!(grows(to + 1e-3));
        }
    }
    let blocked = waves.with_dither_frequency(2.7).expect("positive");
    assert!(
        within(&blocked, speeds.clone()).iter().any(|n| n.reaches_in && n.resonance.harmonic != 0)
    );
    let middle = found.clear.iter().map(|[a, b]| 0.5 * (a + b)).next_back().expect("one");
    let free = waves.with_dither_frequency(middle).expect("positive");
    assert!(
        within(&free, speeds.clone()).iter().all(|n| !n.reaches_in || n.resonance.harmonic == 0)
    );
    let plain = waves_of(&modes(0.0), &load(0.1, 0.3), DiscDither::None);
    assert_eq!(clear_frequencies(&plain, speeds.clone(), 2.0..=6.0), Err(ClearanceError::NoDither));
    let empty = 1.0..=0.0;
    assert_eq!(clear_frequencies(&waves, empty, 2.0..=6.0), Err(ClearanceError::Range));
}

#[test]
fn inapplicable_discs_are_rejected() {
    let refused = |loads: Vec<Load>| {
        let disc = Disc::new(modes(0.0), loads, DiscDither::None, 0.0).expect("valid");
        Waves::new(&disc).expect_err("refused")
    };
    assert_eq!(refused(vec![load(0.1, 0.1), load(0.1, 0.1)]), WaveError::Loads(2));
    assert_eq!(refused(Vec::new()), WaveError::Loads(0));
    assert_eq!(refused(vec![load(0.1, -0.1)]), WaveError::NegativeFriction { friction: -0.1 });
    let waves = waves_of(&modes(0.0), &load(0.1, 0.1), tangential(2.7));
    assert_eq!(
        waves.with_dither_frequency(0.0),
        Err(WaveError::Frequency { frequency_ratio: 0.0 })
    );
}
