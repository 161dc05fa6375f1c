//! Any waveform of a disc's dither: exact exponents against each other and against Runge–Kutta steps, and resonances of the
//! harmonics against the exact boundaries.

use std::f64::consts::{FRAC_PI_2, TAU};

use quell_disc::dithered;
use quell_disc::plate::{ModeSet, Plate, Reference};
use quell_disc::resonance::{Order, Resonance, Tongue, Waves, clear_frequencies};
use quell_linear::linearised::Linearised;
use quell_model::disc::{DiscDither, DitherShape, Load, Mode, Patch};
use quell_model::profile::{KnotShape, Knots};
use quell_model::waveform::{Burst, FourierWave, Harmonic, Hold, SampledWave};
use quell_model::{Disc, System, Waveform};
use quell_numerics::eigen::eigenvalues;
use quell_numerics::floquet::Effort;
use quell_numerics::matrix::Matrix;
use quell_numerics::polar::modulus;

const RATIO: f64 = 2.7;

fn normal(amplitude: f64) -> DiscDither {
    DiscDither::Normal { amplitude, frequency_ratio: RATIO }
}

fn tangential(amplitude: f64) -> DiscDither {
    DiscDither::Tangential { amplitude, frequency_ratio: RATIO }
}

fn modes(damping: f64) -> Vec<Mode> {
    let plate = Plate::new(0.5, 0.3).expect("valid");
    let set = ModeSet::new(&plate, 1, 2, Reference::Critical).expect("found");
    set.at_radius(0.75, damping).expect("on the plate")
}

fn disc(loads: Vec<Load>, dither: DiscDither, waveform: &Waveform) -> Disc {
    let shape = DitherShape { waveform: waveform.clone(), envelope: None };
    Disc::dithered_by(modes(1e-4), loads, (dither, shape), 0.37).expect("valid")
}

fn load() -> Load {
    Load::new(0.1, 0.05, 0.1, 0.3)
}

fn fourier(harmonics: &[(u32, f64, f64)]) -> Waveform {
    let one = |&(order, sine, cosine): &(u32, f64, f64)| Harmonic { order, sine, cosine };
    let series = FourierWave::new(harmonics.iter().map(one).collect()).expect("valid");
    Waveform::Fourier(series.into())
}

fn samples(values: Vec<f64>, hold: Hold) -> Waveform {
    Waveform::Samples(SampledWave::new(values, hold).expect("valid").into())
}

fn burst(carrier: Waveform, on: u32, off: u32) -> Waveform {
    Burst::new(carrier, on, off).expect("valid").into_waveform()
}

fn rate(disc: &Disc) -> f64 {
    dithered::growth(disc, Effort::default()).expect("finite").rate
}

/// Every combination of loads that the tests use.
fn all_loads() -> Vec<Vec<Load>> {
    vec![
        vec![load()],
        vec![load(), load().at_angle(2.0).dithered_at(FRAC_PI_2)],
        vec![load().over(Patch::sector(0.5, 3)).dithered_at(0.4)],
    ]
}

#[test]
fn waveforms_that_say_the_same_have_the_same_exponents() {
    let held = samples(vec![1.0, -1.0], Hold::Zero);
    let one = fourier(&[(1, 1.0, 0.0)]);
    for loads in all_loads() {
        for dither in [normal(0.8), tangential(1.0)] {
            let of = |waveform: &Waveform| rate(&disc(loads.clone(), dither, waveform));
            assert!((of(&held) - of(&Waveform::Square)).abs() < 1e-12, "held");
            // Two methods: the splitting and the Taylor series of the map.
            assert!((of(&one) - of(&Waveform::Sine)).abs() < 1e-9, "fourier");
            for carrier in Waveform::NAMED {
                assert_eq!(burst(carrier.clone(), 3, 0), *carrier);
            }
        }
    }
}

#[test]
fn many_samples_of_a_sine_approach_it() {
    let sampled = |count: u32| {
        let value = |k: u32| (TAU * f64::from(k) / f64::from(count)).sin();
        samples((0..count).map(value).collect(), Hold::Linear)
    };
    let of = |waveform: &Waveform| rate(&disc(vec![load()], tangential(1.0), waveform));
    let sine = of(&Waveform::Sine);
    let gaps = [100, 1000].map(|count| (of(&sampled(count)) - sine).abs());
    assert!(gaps[1] < 1e-6 && gaps[1] > 0.0, "{gaps:?}");
    // The chords lie below the arcs by a share that falls with the square of their number.
    assert!((gaps[0] / gaps[1] - 100.0).abs() < 3.0, "{gaps:?}");
}

/// x′ = A(t) x over one period by Runge–Kutta steps between the breaks of the friction.
fn by_runge_kutta(disc: &Disc, steps: u32) -> f64 {
    let system: System = disc.system();
    let linear = Linearised::new(&system).expect("flat");
    let period = TAU / disc.repetition_ratio().expect("dithered");
    let mut cuts = vec![0.0, period];
    for wave in system.waves() {
        for phase in wave.waveform.breaks() {
            let at = (phase - wave.phase) / wave.frequency;
            cuts.push(at.rem_euclid(period));
        }
    }
    cuts.sort_by(f64::total_cmp);
    let friction: Vec<f64> =
        linear.contacts().iter().map(|contact| contact.steady.friction).collect();
    let matrix = |time: f64| {
        let now: Vec<f64> = friction
            .iter()
            .zip(&system.inputs)
            .map(|(f, input)| f * input.profile.value(time))
            .collect();
        linear.state_matrix(&now)
    };
    let n = matrix(0.0).rows();
    let mut map = Matrix::identity(n);
    for part in cuts.windows(2).filter(|part| part[1] - part[0] > 1e-12) {
        let step = (part[1] - part[0]) / f64::from(steps);
        for k in 0..steps {
            let from = part[0] + step * f64::from(k);
            // Both ends within the piece, regardless of the rounding of its breaks.
            let inside = 1e-13 * period;
            let (one, middle, two) =
                (matrix(from + inside), matrix(from + 0.5 * step), matrix(from + step - inside));
            let moved = |by: f64, slope: &Matrix| {
                let mut next = map.clone();
                next.add_scaled(by, slope);
                next
            };
            let first = one.times(&map);
            let second = middle.times(&moved(0.5 * step, &first));
            let third = middle.times(&moved(0.5 * step, &second));
            let fourth = two.times(&moved(step, &third));
            let mut next = map.clone();
            for (weight, slope) in [(1.0, &first), (2.0, &second), (2.0, &third), (1.0, &fourth)] {
                next.add_scaled(weight * step / 6.0, slope);
            }
            map = next;
        }
    }
    let largest = eigenvalues(&map).expect("finite").into_iter().map(modulus).fold(0.0, f64::max);
    largest.ln() / period
}

#[test]
fn exponents_are_those_of_runge_kutta() {
    let waves = [
        Waveform::Triangle,
        fourier(&[(1, 0.6, 0.1), (2, 0.0, 0.5), (5, 0.1, 0.0)]),
        samples(vec![0.3, 1.0, -0.4, 0.9, -2.0], Hold::Linear),
        samples(vec![0.3, 1.0, -0.4, 0.9, -2.0], Hold::Zero),
        burst(Waveform::Sine, 2, 1),
        burst(Waveform::Triangle, 1, 2),
        burst(Waveform::Square, 1, 1),
    ];
    for loads in all_loads() {
        for waveform in &waves {
            for dither in [normal(0.4), tangential(0.9)] {
                let disc = disc(loads.clone(), dither, waveform);
                let found = dithered::growth(&disc, Effort::default()).expect("finite");
                let other = by_runge_kutta(&disc, 400);
                let gap = (found.rate - other).abs();
                assert!(gap < 1e-8, "{waveform:?} {dither:?}: {} {other}", found.rate);
                assert!(found.error < 1e-11, "{found:?}");
            }
        }
    }
}

/// A unit of a period counts from the carrier: a longer pause brings the mean closer to no dither.
#[test]
fn a_burst_with_a_long_pause_approaches_no_dither() {
    let plain = disc(vec![load()], normal(0.0), &Waveform::Sine);
    let of = |off: u32| rate(&disc(vec![load()], normal(1.0), &burst(Waveform::Sine, 1, off)));
    let still = rate(&plain);
    let gaps = [1, 30].map(|off| (of(off) - still).abs());
    assert!(gaps[1] < 0.2 * gaps[0], "{gaps:?}");
}

#[test]
fn normal_dither_must_not_pull_the_contact_apart() {
    let built = |amplitude: f64, waveform: &Waveform, envelope: Option<Knots>| {
        let shape = DitherShape { waveform: waveform.clone(), envelope };
        Disc::dithered_by(modes(0.0), vec![load()], (normal(amplitude), shape), 0.1)
    };
    // g from −0.5 to 1.5: the least value alone matters.
    let peaks = samples(vec![1.5, -0.5, -0.5, -0.5], Hold::Zero);
    assert!(built(2.0, &peaks, None).is_ok());
    let refused = built(2.1, &peaks, None).expect_err("too much").to_string();
    assert!(refused.contains("dither.amplitude") && refused.contains("at most 2"), "{refused}");
    assert!(built(1.0, &Waveform::Triangle, None).is_ok());
    let half = Knots::new(vec![0.0, 9.0], vec![0.0, 0.5], KnotShape::Linear).ok();
    assert!(built(2.0, &Waveform::Sine, half.clone()).is_ok());
    assert!(built(2.1, &Waveform::Sine, half.clone()).is_err());
    // A negative share turns the wave over.
    let turned = Knots::new(vec![0.0], vec![-1.0], KnotShape::Linear).ok();
    assert!(built(1.0, &peaks, turned.clone()).is_err());
    assert!(built(0.6, &peaks, turned).is_ok());
    let shape = DitherShape { waveform: Waveform::Sine, envelope: half };
    let refused = Disc::dithered_by(modes(0.0), vec![load()], (tangential(1.0), shape), 0.1);
    assert!(refused.expect_err("no weaker dither").to_string().contains("dither.envelope"));
}

/// A load whose first-order theory has relative errors of about one percent.
fn light(friction: f64) -> Load {
    Load::new(2e-3, 1e-4, 2e-3, friction)
}

/// Half the width of a tongue and its growth, relative to the exact ones.
fn check_tongue(resonance: &Resonance, disc: &Disc) {
    let Tongue::Between { lower, upper, peak_speed, peak_growth } = resonance.tongue else {
        return;
    };
    let growth = |speed: f64| rate(&disc.at_speed(speed).expect("in bounds"));
    let found = growth(peak_speed);
    assert!((found / peak_growth - 1.0).abs() < 0.1, "{resonance:?}: {found}");
    let width = upper - lower;
    for (edge, inward) in [(lower, 1.0), (upper, -1.0)] {
        assert!(growth(edge + 0.1 * inward * width) > 0.0, "{resonance:?} {edge}");
        assert!(growth(edge - 0.1 * inward * width) <= 1e-9, "{resonance:?} {edge}");
    }
}

#[test]
fn tongues_of_the_harmonics_are_those_of_the_exponents() {
    let waves = [
        (Waveform::Square, 3),
        (Waveform::Triangle, 1),
        (fourier(&[(1, 0.2, 0.0), (2, 0.3, 0.7)]), 2),
        (samples(vec![0.0, 1.0, -0.4, 0.9, -1.5], Hold::Linear), 2),
        (burst(Waveform::Sine, 2, 1), 2),
        (burst(Waveform::Sine, 2, 1), 3),
        (burst(Waveform::Square, 1, 1), 1),
    ];
    let mut checked = 0;
    for (waveform, harmonic) in waves {
        let shape = DitherShape { waveform: waveform.clone(), envelope: None };
        // Low frequencies, so that the harmonics meet within the speeds.
        let low =
            DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 2.7 / f64::from(harmonic) };
        let cycles = f64::from(waveform.cycles());
        let DiscDither::Tangential { frequency_ratio, .. } = low else { continue };
        let dither =
            DiscDither::Tangential { amplitude: 1.0, frequency_ratio: cycles * frequency_ratio };
        let disc = Disc::dithered_by(modes(1e-5), vec![light(6e-3)], (dither, shape), 0.1);
        let disc = disc.expect("valid");
        let found = Waves::new(&disc).expect("one load").dithered(0.2..=0.6);
        let of_harmonic = found
            .iter()
            .filter(|r| r.harmonic.unsigned_abs() == harmonic && r.tongue.edges().is_some());
        let before = checked;
        for resonance in of_harmonic {
            check_tongue(resonance, &disc);
            checked += 1;
        }
        assert!(checked > before, "{waveform:?} {harmonic}: {found:?}");
    }
    assert!(checked >= 10, "{checked}");
}

/// A sum of one harmonic is the sine, at both orders and with clear frequencies.
#[test]
fn one_harmonic_has_the_resonances_of_the_sine() {
    let one = fourier(&[(1, 1.0, 0.0)]);
    let waves = |waveform: &Waveform, order: Order| {
        let disc = disc(vec![load()], tangential(1.0), waveform);
        Waves::new(&disc).expect("one load").with_order(order)
    };
    for order in [Order::First, Order::Second] {
        let (sine, sum) = (waves(&Waveform::Sine, order), waves(&one, order));
        assert_eq!(sine.dithered(0.0..=1.0), sum.dithered(0.0..=1.0));
        assert_eq!(sine.undithered(0.0..=1.0), sum.undithered(0.0..=1.0));
        let clear = |waves: &Waves| clear_frequencies(waves, 0.2..=0.6, 2.0..=6.0);
        assert_eq!(clear(&sine), clear(&sum));
    }
    // Twice the order at half the frequency.
    let double = fourier(&[(2, 1.0, 0.0)]);
    let shape = DitherShape { waveform: double, envelope: None };
    let half = DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 0.5 * RATIO };
    let disc = Disc::dithered_by(modes(1e-4), vec![load()], (half, shape), 0.37).expect("valid");
    let found = Waves::new(&disc).expect("one load").dithered(0.0..=1.0);
    let sine = waves(&Waveform::Sine, Order::First).dithered(0.0..=1.0);
    assert_eq!(found.len(), sine.len());
    for (found, sine) in found.iter().zip(&sine) {
        assert_eq!(found.harmonic, 2 * sine.harmonic);
        assert!((found.speed - sine.speed).abs() < 1e-12);
        assert_eq!(found.tongue.edges().is_some(), sine.tongue.edges().is_some());
    }
}

/// Frequencies that are clear by the theory have no growth where it is accurate; blocked ones have.
#[test]
fn clear_frequencies_of_a_square_wave_have_no_tongue() {
    let of = |ratio: f64| {
        let dither = DiscDither::Tangential { amplitude: 1.0, frequency_ratio: ratio };
        let shape = DitherShape { waveform: Waveform::Square, envelope: None };
        Disc::dithered_by(modes(1e-5), vec![light(6e-3)], (dither, shape), 0.1).expect("valid")
    };
    let waves = Waves::new(&of(2.0)).expect("one load");
    let found = clear_frequencies(&waves, 0.3..=0.5, 0.8..=2.0).expect("answer");
    assert!(found.blocked.iter().any(|block| block.harmonic.unsigned_abs() == 3), "{found:?}");
    let largest = |ratio: f64| {
        let disc = of(ratio);
        let step = |k: u32| 0.3 + 0.2 * f64::from(k) / 400.0;
        (0..=400)
            .map(|k| rate(&disc.at_speed(step(k)).expect("in bounds")))
            .fold(f64::MIN, f64::max)
    };
    let widest = |list: &mut dyn Iterator<Item = [f64; 2]>| {
        list.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0]))).expect("one")
    };
    let [from, to] = widest(&mut found.clear.iter().copied());
    assert!(largest(0.5 * (from + to)) < 1e-9);
    let third = found.blocked.iter().filter(|block| block.harmonic.unsigned_abs() == 3);
    let [from, to] = widest(&mut third.map(|block| [block.from, block.to]));
    assert!(largest(0.5 * (from + to)) > 0.0);
}
