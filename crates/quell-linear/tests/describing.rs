//! Describing functions of averaged friction: closed forms, limits, integration by parts.

use core::f64::consts::PI;

use quell_linear::averaging::{
    Averaging, AveragingError, DescribingFunction, FastMotion, FastWave, criterion, effective,
};
use quell_model::waveform::Burst;
use quell_model::{Belt, Direction, Dither, LawKind, Waveform};
use quell_numerics::interval::RealInterval;
use quell_numerics::quadrature::{QuadratureOptions, integrate};
use quell_zoo::BeltExt;
use quell_zoo::belt::{belt, undithered_belt};
use quell_zoo::dither::{normal, tangential};
use quell_zoo::law;

fn of(belt: &Belt) -> DescribingFunction {
    DescribingFunction::of_one_mass(belt, Averaging::Limit).expect("an average")
}

/// The cubic law without dither: N₁ = a₁ + 3a₃v₀² + ¾a₃a², and 4μ_s√(1 − (v₀/a)²)/(πa) for the sign where a > v₀.
#[test]
fn cubic_law_in_closed_form() {
    let (level, least, vm) = (0.4, 0.2857, 0.2);
    let (linear, cubic) = (-1.5 * (level - least) / vm, 0.5 * (level - least) / (vm * vm * vm));
    for v0 in [0.05, 0.15, 0.3] {
        let belt = undithered_belt(0.005, v0, law::stribeck());
        let found = of(&belt);
        for amplitude in [1e-3, 0.02, 0.049, 0.0501, 0.16, 0.5] {
            let sign = (1.0 - (v0 / amplitude) * (v0 / amplitude)).max(0.0).sqrt();
            let exact = linear
                + cubic * (3.0 * v0 * v0 + 0.75 * amplitude * amplitude)
                + 4.0 * level * sign / (PI * amplitude);
            let point = found.at(amplitude).expect("a gain");
            assert!((point.gain - exact).abs() < 1e-10 / amplitude, "{v0} {point:?} {exact}");
            assert!((point.gain - exact).abs() <= point.error, "{v0} {point:?} {exact}");
            let share = (v0 / amplitude).min(1.0);
            let mean = 2.0 / PI * level * share.asin()
                + v0 * (linear + cubic * (v0 * v0 + 1.5 * amplitude * amplitude));
            assert!((point.coefficient - mean).abs() < 1e-10, "{v0} {point:?} {mean}");
        }
    }
}

/// Thomsen's amplitude of pure slip, a = 2v_m √(1 − κ − w² − ⟨G²⟩(α/v_m)²), without and under dither.
#[test]
fn limit_cycle_of_the_cubic_law() {
    let (vm, v0, damping) = (0.2, 0.185, 0.005);
    for (waveform, ratio) in [
        (Waveform::Sine, 0.0),
        (Waveform::Sine, 0.03),
        (Waveform::Triangle, 0.05),
        (Waveform::Square, 0.02),
    ] {
        let square = waveform.mean_square_integral();
        let belt =
            belt(damping, v0, law::stribeck(), vec![tangential(waveform, 10.0 * ratio, 10.0)]);
        let kappa = 4.0 * vm * damping / (3.0 * (0.4 - 0.2857));
        let rest = 1.0 - kappa - (v0 / vm) * (v0 / vm) - square * (ratio / vm) * (ratio / vm);
        let exact = 2.0 * vm * rest.sqrt();
        assert!(exact + ratio < v0, "pure slip");
        let balance = |gain: f64| -> Result<f64, AveragingError> {
            Ok(belt.damping_rate(gain, belt.normal_load()))
        };
        let found = of(&belt).cycles(0.9 * v0, balance).expect("cycles");
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(
            found[0].stable && (found[0].amplitude / exact - 1.0).abs() < 1e-8,
            "{found:?} {exact}"
        );
    }
}

fn dithered() -> Vec<Belt> {
    let burst = Burst::new(Waveform::Sine, 2, 1).expect("a burst").into_waveform();
    let base = |kind| undithered_belt(0.01, 0.1, law::dissertation(kind));
    let mut belts = Vec::new();
    for kind in [LawKind::Stribeck, LawKind::Decreasing] {
        for waveform in [Waveform::Sine, Waveform::Triangle, Waveform::Square, burst.clone()] {
            for ratio in [0.04, 0.13] {
                belts.push(base(kind).with_dither(tangential(
                    waveform.clone(),
                    10.0 * ratio,
                    10.0,
                )));
            }
        }
        belts.push(base(kind).with_dither(normal(Waveform::Sine, 0.8, 5.0)));
    }
    let two = vec![tangential(Waveform::Sine, 0.5, 10.0), tangential(Waveform::Sine, 0.9, 23.7)];
    belts.push(base(LawKind::Stribeck).with_dithers(two));
    belts
}

/// For a → 0 the gain is the slope of the averaged law, and the balance is the criterion of averaged stability.
#[test]
fn small_amplitudes() {
    for belt in dithered() {
        let found = of(&belt);
        let criterion = criterion(&belt, Averaging::Limit).expect("a criterion");
        let small = found.small().expect("a slope").expect("no corner");
        assert_eq!(belt.damping_rate(small, belt.normal_load()), criterion.value);
        let point = found.at(1e-4).expect("a gain");
        // The gain differs from the slope by μ̄‴a²/8: below 10⁻⁴ of the slopes here.
        let scale = 1e-3 * (1.0 + small.abs());
        assert!((point.gain - small).abs() < scale, "{belt:?} {point:?} {small}");
        let mean = criterion.effective.coefficient;
        assert!((point.coefficient - mean).abs() < 1e-5, "{belt:?} {point:?} {mean}");
    }
}

/// Integration by parts: N₁ = 2⟨μ̄′(v₀ + a sin φ) cos² φ⟩, where the law is continuous.
#[test]
fn gain_from_the_slopes() {
    for belt in dithered().into_iter().take(8) {
        let [dither] = belt.dithers() else { panic!("one dither") };
        let wave = FastWave::Integral(dither.waveform.clone());
        let RealInterval { lower: low, upper: high } = dither.waveform.integral_range();
        let alpha = dither.amplitude_ratio();
        let motion = FastMotion::of(&belt, 0.1, Averaging::Limit).expect("a motion");
        let single = FastMotion::single(wave, alpha);
        for amplitude in [0.01, 0.08, 0.2, 0.4] {
            // In the pause of a burst the fast velocity is constant, and the averaged law jumps at that velocity.
            if 0.1 - amplitude < alpha * low && !dither.waveform.is_symmetric() {
                continue;
            }
            let slope = |phase: f64| {
                let v = 0.1 + amplitude * phase.sin();
                let motion = if dither.waveform.is_symmetric() { &single } else { &motion };
                effective(belt.friction(), motion, v).expect("a mean").slope
                    * phase.cos()
                    * phase.cos()
            };
            // The slope is unbounded at corners; each piece is mapped so that its ends are smooth.
            let mut cuts = vec![-0.5 * PI, 0.5 * PI];
            for corner in [alpha * low, alpha * high, -alpha * low, -alpha * high, 0.0] {
                let sine = (corner - 0.1) / amplitude;
                if sine.abs() < 1.0 {
                    cuts.push(sine.asin());
                }
            }
            cuts.sort_by(f64::total_cmp);
            let options =
                QuadratureOptions { relative: 1e-9, absolute: 1e-9, ..Default::default() };
            let mut sum = 0.0;
            for pair in cuts.windows(2).filter(|pair| pair[1] - pair[0] > 1e-12) {
                let length = pair[1] - pair[0];
                let mapped = |t: f64| {
                    slope(pair[0] + length * t * t * (3.0 - 2.0 * t)) * length * 6.0 * t * (1.0 - t)
                };
                let part = integrate(mapped, 0.0, 1.0, &[], &options);
                sum +=
                    part.map_or_else(|why| why.best().expect("a value").value, |part| part.value);
            }
            let point = of(&belt).at(amplitude).expect("a gain");
            assert!(
                (point.gain - 2.0 * sum / PI).abs() < 1e-6 * (1.0 + point.gain.abs()),
                "{belt:?} {point:?} {}",
                2.0 * sum / PI
            );
        }
    }
}

/// The average over the dither comes first or last: the mean at a slow sinusoid is the mean under a second dither whose velocity
/// is that sinusoid.
#[test]
fn order_of_the_averages() {
    let dither = tangential(Waveform::Sine, 0.6, 10.0);
    let belt = belt(0.01, 0.1, law::stribeck(), vec![dither]);
    for amplitude in [0.03, 0.07, 0.3] {
        let both = belt.with_dither(tangential(Waveform::Sine, 3.7 * amplitude * PI, 3.7 * PI));
        let motion = FastMotion::of(&both, 0.1, Averaging::Limit).expect("a motion");
        let mean = effective(both.friction(), &motion, 0.1).expect("a mean").coefficient;
        let point = of(&belt).at(amplitude).expect("a gain");
        assert!((point.coefficient - mean).abs() < 1e-9, "{point:?} {mean}");
    }
}

#[test]
fn undefined_and_refused() {
    let rest = undithered_belt(0.005, 0.0, law::stribeck());
    let found = of(&rest);
    assert!(matches!(found.small(), Err(AveragingError::SetValued { .. })));
    // Only the jump: N₁ = 4μ_s/(πa) to leading order.
    let point = found.at(1e-6).expect("a gain");
    assert!((point.gain * 1e-6 * PI / (4.0 * 0.4) - 1.0).abs() < 1e-4, "{point:?}");
    // At a corner the slope jumps.
    let corner = belt(0.005, 0.1, law::stribeck(), vec![tangential(Waveform::Sine, 1.0, 10.0)]);
    assert_eq!(of(&corner).small().expect("a mean"), None);
    let three = [10.0, 11.7, 13.9].map(|ratio: f64| Dither {
        direction: Direction::Tangential,
        waveform: Waveform::Sine,
        amplitude: 0.2,
        frequency_ratio: ratio * PI.sqrt().powf(ratio / 10.0),
        phase: 0.0,
        envelope: None,
    });
    let three = belt(0.005, 0.1, law::stribeck(), three.to_vec());
    let refused = DescribingFunction::of_one_mass(&three, Averaging::Limit);
    assert!(matches!(refused, Err(AveragingError::TooManyGroups { groups: 3, largest: 2 })));
}
