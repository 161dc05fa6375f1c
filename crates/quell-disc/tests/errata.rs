//! Errors in print in chapter 5: the printed form and the right one, both against exact modes, exact eigenvalues and exact
//! exponents.

use std::f64::consts::PI;

use quell_disc::dithered;
use quell_disc::equations::linearised;
use quell_disc::growing::growing_speeds;
use quell_disc::plate::{ModeSet, Plate, RadialShape, Reference};
use quell_disc::resonance::Waves;
use quell_disc::undithered;
use quell_linear::growth::Verdict;
use quell_model::Disc;
use quell_model::disc::{Contribution, Contributions};
use quell_model::disc::{DiscDither, Mode};
use quell_numerics::eigen::eigenvalues;
use quell_numerics::floquet::Effort;
use quell_numerics::matrix::Matrix;
use quell_numerics::quadrature::{QuadratureOptions, integrate};
use quell_zoo::disc::{self as zoo, TANGENTIAL, equal_load};

fn set(inner: f64, diameters: u32) -> ModeSet {
    let plate = Plate::new(inner, 0.3).expect("a plate");
    ModeSet::new(&plate, 1, diameters, Reference::Critical).expect("modes")
}

/// N = (1, 2) of b/a = 0.5 seen by a load at r₀/a = 0.75.
fn modes(damping: f64) -> Vec<Mode> {
    set(0.5, 2).at_radius(0.75, damping).expect("a radius of the plate")
}

/// m = c = k = `strength`, friction in units of it.
fn disc(strength: f64, friction: f64, damping: f64, dither: DiscDither, speed: f64) -> Disc {
    zoo::disc(modes(damping), vec![equal_load(strength, friction * strength)], dither, speed)
}

fn growth(disc: &Disc) -> f64 {
    if disc.dither() == DiscDither::None {
        undithered::growth(disc).expect("finite").rate
    } else {
        dithered::growth(disc, Effort::default()).expect("finite").rate
    }
}

fn close(value: f64, exact: f64, tolerance: f64) {
    assert!((value / exact - 1.0).abs() < tolerance, "{value} should be {exact}");
}

/// R″ + R′/r − q²R/r², by differences of eighth order.
fn laplacian(of: &dyn Fn(f64) -> f64, radius: f64, diameters: u32) -> f64 {
    let h = 0.004;
    let second = [-205.0 / 72.0, 8.0 / 5.0, -0.2, 8.0 / 315.0, -1.0 / 560.0];
    let first = [0.0, 0.8, -0.2, 4.0 / 105.0, -1.0 / 280.0];
    let (mut bend, mut slope) = (second[0] * of(radius), 0.0);
    for (k, (second, first)) in second.iter().zip(first).enumerate().skip(1) {
        let (right, left) = (of(radius + h * k as f64), of(radius - h * k as f64));
        bend += second * (right + left);
        slope += first * (right - left);
    }
    let order = f64::from(diameters);
    bend / (h * h) + slope / (h * radius) - order * order * of(radius) / (radius * radius)
}

/// (5.2): the operator applied twice gives k⁴w; the printed square of it does not.
#[test]
fn modes_solve_the_plate_equation() {
    for mode in set(0.5, 2).modes() {
        let shape: &RadialShape = &mode.shape;
        let value = |radius: f64| shape.value(radius).expect("inside");
        let once = |radius: f64| laplacian(&value, radius, mode.diameters);
        let ratios: Vec<[f64; 2]> = [0.65, 0.75, 0.85]
            .iter()
            .map(|&radius| {
                let twice = laplacian(&once, radius, mode.diameters);
                [twice / value(radius), once(radius) * once(radius) / value(radius)]
            })
            .collect();
        for [operator, square] in &ratios {
            close(*operator, mode.frequency_parameter * mode.frequency_parameter, 1e-5);
            assert!((square / operator - 1.0).abs() > 0.1, "{square} {operator}");
        }
        assert!((ratios[0][1] / ratios[2][1] - 1.0).abs() > 0.5, "the square is no eigenvalue");
    }
}

/// (5.7): R² cos² qθ has unit mean over the plate, sin 0 has zero mean; |R e^{iqθ}|² has twice that for q ≠ 0, so that a wave
/// needs half of R², and with all of it the growth rate of every wave is doubled.
#[test]
fn normalisation_of_real_and_complex_modes() {
    let area = PI * (1.0 - 0.25);
    for mode in set(0.5, 2).modes() {
        let density =
            |radius: f64| radius * mode.shape.value(radius).expect("inside").powi(2) / area;
        let radial = integrate(density, 0.5, 1.0, &[], &QuadratureOptions::default());
        let radial = radial.expect("converges").value;
        let (cosine, sine) = if mode.diameters == 0 { (2.0 * PI, 0.0) } else { (PI, PI) };
        close(radial * cosine, 1.0, 1e-10);
        assert!((radial * sine - if mode.diameters == 0 { 0.0 } else { 1.0 }).abs() < 1e-10);
        close(radial * 2.0 * PI, if mode.diameters == 0 { 1.0 } else { 2.0 }, 1e-10);
    }
    // Only the two-diameter mode, far from any meeting: the backward wave under a weak load.
    let (strength, friction, speed) = (1e-4, 4.0, 0.6);
    let mode = modes(0.0)[2];
    let load = equal_load(strength, friction * strength);
    let disc = zoo::disc(vec![mode], vec![load], DiscDither::None, speed);
    let rate = |square: f64| {
        -square / (2.0 * mode.ratio) * strength * (mode.ratio + 2.0 * speed - 2.0 * friction)
    };
    let square = mode.shape_at_load * mode.shape_at_load;
    close(growth(&disc), rate(0.5 * square), 1e-3);
    close(growth(&disc), 0.5 * rate(square), 1e-3);
}

/// The text says b/a = 0.05: thirteen printed speeds need 0.5; r₀/a = 0.5 would then be the clamp.
#[test]
fn geometry_of_the_tables() {
    let speeds = |inner: f64| -> Vec<f64> {
        let modes = set(inner, 2).at_radius(0.75, 0.0).expect("a radius");
        let disc = zoo::disc(modes, vec![equal_load(0.1, 0.1)], TANGENTIAL, 0.3);
        let waves = Waves::new(&disc).expect("waves");
        let both = waves.undithered(0.0..=1.0).into_iter().chain(waves.dithered(0.0..=1.0));
        both.map(|resonance| resonance.speed).collect()
    };
    let printed =
        [0.036, 0.064, 0.114, 0.192, 1.0, 0.325, 0.369, 0.458, 0.536, 0.675, 0.836, 0.879, 0.964];
    let found = |inner: f64| {
        let speeds = speeds(inner);
        let there = |value: &&f64| speeds.iter().any(|speed| (speed - **value).abs() <= 5e-4);
        printed.iter().filter(there).count()
    };
    assert_eq!(found(0.5), 13);
    assert!(found(0.05) < 6, "{}", found(0.05));
    assert!(set(0.5, 2).modes()[0].shape.value(0.5).expect("the clamp").abs() < 1e-12);
}

/// Modal damping is fixed in the disc. Without the circulatory pair, the free disc would be unstable beyond Ω = β/q.
#[test]
fn damping_turns_with_the_disc() {
    let disc = zoo::disc(modes(1e-3), vec![equal_load(0.0, 0.0)], DiscDither::None, 1.3);
    let rate = |parts: Contributions| undithered::growth_with(&disc, parts).expect("finite").rate;
    close(rate(Contributions::ALL), -1.771_548e-3, 1e-5);
    close(rate(Contributions::ALL.without(Contribution::CirculatoryDamping)), 6.0e-4, 0.01);
}

/// (5.17): the reference is the lowest critical speed of the set of modes: every number changes by 1.188.
#[test]
fn reference_frequency_depends_on_the_modes() {
    close(set(0.5, 2).reference() / set(0.5, 5).reference(), 1.188_22, 1e-5);
    let critical = |diameters: u32| set(0.5, diameters).critical_mode().expect("one").diameters;
    assert_eq!((critical(2), critical(5)), (2, 3));
}

/// (5.18), (5.25), (5.32): with A_pq″, A_pq′ inside the double sum, as printed, the verdict flips.
#[test]
fn indices_of_the_double_sum() {
    let disc = disc(0.3, 1.0 / 3.0, 0.0, DiscDither::None, 0.2);
    let right = undithered::growth(&disc).expect("finite");
    // As printed: every row of the load's mass and damper acts on its own coordinate, with the sum of all shapes.
    let (count, load) = (disc.coordinates(), &disc.loads()[0]);
    let parts = Contributions::ALL.without(Contribution::LoadMass).without(Contribution::Damper);
    let bare = linearised(&disc, parts).expect("finite");
    let whole_mass =
        disc.system_of(Contributions::ALL).structure.mechanical().expect("masses").mass().matrix();
    let bare_mass = disc.system_of(parts).structure.mechanical().expect("masses").mass().matrix();
    let row = |matrix: &Matrix, i: usize, j: usize| matrix.row(i)[j];
    let (mut mass, mut damping) =
        (bare_mass.clone(), bare.matrices().expect("masses").damping.clone());
    for i in 0..count {
        // The diagonal of the full system shows on which rows the load acts: φ_pq² there.
        let own = row(&whole_mass, i, i) - row(&bare_mass, i, i);
        let sum: f64 =
            (0..count).map(|j| (row(&whole_mass, i, j) - row(&bare_mass, i, j)) / load.mass).sum();
        if own != 0.0 {
            mass.row_mut(i)[i] += load.mass * sum;
            damping.row_mut(i)[i] += load.damping * sum;
        }
    }
    // With the follower forces: what the state matrix of the rest has in its lower left is −M⁻¹K.
    let kept = bare.state_matrix(&bare.mean_friction());
    let lower = Matrix::from_fn(count, count, |i, j| -kept.row(count + i)[j]);
    let stiffness = bare_mass.times(&lower);
    let joined = Matrix::from_fn(count, 2 * count, |i, j| {
        if j < count { -stiffness.row(i)[j] } else { -damping.row(i)[j - count] }
    });
    let solved = mass.solve(&joined).expect("regular");
    let literal = Matrix::from_fn(2 * count, 2 * count, |i, j| match i.checked_sub(count) {
        None => f64::from(u8::from(j == i + count)),
        Some(i) => solved.row(i)[j],
    });
    let printed =
        eigenvalues(&literal).expect("finite").iter().map(|z| z.re).fold(f64::MIN, f64::max);
    assert_eq!(right.verdict(), Verdict::Unstable, "{right:?}");
    close(right.rate, 9.33e-5, 0.01);
    close(printed, -2.08e-2, 0.01);
}

/// (5.40)–(5.51): α cos Rτ is α/2 in the complex form; taken as α the tongue of Ω₁* would begin at half the friction.
#[test]
fn dither_is_halved_in_the_complex_form() {
    let strength = 0.006_25;
    let largest = |friction: f64| {
        let rates = (-40..=40).map(|k| {
            growth(&disc(strength, friction, 0.0, TANGENTIAL, 0.325 + 1e-4 * f64::from(k)))
        });
        rates.fold(f64::MIN, f64::max)
    };
    let ratios: Vec<f64> = modes(0.0).iter().map(|mode| mode.ratio).collect();
    let tip = 2.0 * (ratios[2] / 2.0 - 0.325);
    close(tip, 1.350, 1e-3);
    // Halved: from 1.3617 c on; as printed it would be from 0.68 c on.
    assert!(largest(1.30) < 0.0 && largest(1.45) > 0.0, "{} {}", largest(1.30), largest(1.45));
}

/// Text before (5.30): of a friction that alternates between ±F_θ only the fundamental is kept, as F_θ cos Rτ; it is 4/π of
/// that. The exact monodromy under the whole square wave has the threshold of α = 4/π, π/4 of the printed one.
#[test]
fn first_harmonic_of_a_reversed_friction() {
    let wave = |theta: f64| theta.cos().signum() * theta.cos() / PI;
    let first =
        integrate(wave, 0.0, 2.0 * PI, &[0.5 * PI, 1.5 * PI], &QuadratureOptions::default());
    close(first.expect("converges").value, 4.0 / PI, 1e-12);
    let largest = |friction: f64, rate: &dyn Fn(&Disc) -> f64, amplitude: f64| {
        let dither = DiscDither::Tangential { amplitude, frequency_ratio: 2.7 };
        let speeds = (0..=30).map(|k| 0.3182 + 4e-4 * f64::from(k));
        let discs = speeds.map(|speed| disc(0.1, friction / 0.1, 0.0, dither, speed));
        discs.map(|disc| rate(&disc)).fold(f64::MIN, f64::max)
    };
    let (below, above) = (0.115, 0.119);
    assert!(largest(below, &reversing, 1.0) < 0.0 && largest(above, &reversing, 1.0) > 0.0);
    assert!(largest(below, &growth, 4.0 / PI) < 0.0 && largest(above, &growth, 4.0 / PI) > 0.0);
    assert!(largest(above, &growth, 1.0) < 0.0, "as printed the tongue begins later");
    assert!(largest(0.151, &growth, 1.0) > 0.0, "at 0.149");
}

/// Growth rate under friction that is +f for a quarter period, −f for a half, +f for a quarter.
fn reversing(disc: &Disc) -> f64 {
    let system = linearised(disc, Contributions::ALL).expect("finite");
    let period = 2.0 * PI / disc.dither().frequency_ratio().expect("dither");
    let (mean, swing) = disc.dither().mean_and_amplitude();
    assert_eq!(mean, 0.0);
    let friction = |sign: f64| -> Vec<f64> {
        disc.loads().iter().map(|load| sign * swing * load.friction).collect()
    };
    let forward = exponential(&system.state_matrix(&friction(1.0)), 0.25 * period);
    let back = exponential(&system.state_matrix(&friction(-1.0)), 0.5 * period);
    let monodromy = forward.times(&back).times(&forward);
    let multipliers = eigenvalues(&monodromy).expect("finite");
    multipliers.iter().map(|z| z.norm()).fold(0.0, f64::max).ln() / period
}

/// e^{At} by its series and squaring.
fn exponential(a: &Matrix, time: f64) -> Matrix {
    const SQUARINGS: i32 = 12;
    let step = time * f64::powi(0.5, SQUARINGS);
    let (mut sum, mut term) = (Matrix::identity(a.rows()), Matrix::identity(a.rows()));
    for k in 1..16 {
        let mut next = Matrix::zeros(a.rows(), a.rows());
        next.add_scaled(step / f64::from(k), &term.times(a));
        term = next;
        sum.add_scaled(1.0, &term);
    }
    for _ in 0..SQUARINGS {
        sum = sum.times(&sum);
    }
    sum
}

/// Captions of chapter 5 give m, c/ω_cr, k/ω_cr², F_θ/(r₀ω_cr²) as pure numbers; each is a mass. The same numbers on a plate of
/// twice the mass are half the load, and the growth is another.
#[test]
fn loads_are_ratios_to_the_mass_of_the_plate() {
    let rate = |strength: f64| growth(&disc(strength, 1.5, 0.0, DiscDither::None, 0.12));
    let (one, half) = (rate(0.1), rate(0.05));
    assert!(one > 0.0 && (half / one - 1.0).abs() > 0.1, "{one} {half}");
}

/// "The tongues of Ω₁ and Ω₄ begin at f = 10⁻⁴ and 3·10⁻⁵": without modal damping they exist for every f, with growth ~ f⁴.
#[test]
fn revived_tongues_have_no_threshold() {
    let largest = |friction: f64| {
        let rates = (0..=120).map(|k| {
            let speed = 0.1922 * (1.0 - 4e-4 * f64::from(k));
            growth(&disc(0.3, friction / 0.3, 0.0, TANGENTIAL, speed))
        });
        rates.fold(f64::MIN, f64::max)
    };
    // 3·10⁻⁵ is f = 0.3.
    let (small, large) = (largest(0.1), largest(0.2));
    assert!(small > 0.0, "{small}");
    assert!((12.0..20.0).contains(&(large / small)), "f⁴: {}", large / small);
}

/// Table 5.1 leaves Ω = 0 out, where the cosine and sine of one mode meet: an exponent stays imaginary under any load.
#[test]
fn standstill_is_a_meeting() {
    let slow = |speed: f64, friction: f64| disc(0.1, friction, 0.0, DiscDither::None, speed);
    let waves = Waves::new(&slow(0.0, 0.4)).expect("waves");
    assert!(waves.undithered(0.0..=1.0).iter().any(|resonance| resonance.speed == 0.0));
    for friction in [0.1, 0.4, 0.8] {
        let found = undithered::growth(&slow(0.0, friction)).expect("finite");
        assert_eq!(found.verdict(), Verdict::Undecided, "{found:?}");
    }
    assert!(growth(&slow(1e-4, 0.1)) > 0.0, "the tongue reaches f = 0 as Ω → 0");
    assert!(growth(&slow(0.3, 0.1)) < 0.0);
}

/// Table 5.2 lists meetings of waves. At first order waves that travel head-on share their damping, and l = 0 does not couple: five of
/// the eight have no tongue. With f/c = 4 that is so exactly; with f/c = 17, in figure 5.9, the fourth grows too, and it takes all three
/// modes: no pair of them grows there.
#[test]
fn at_first_order_three_of_eight_grow_and_exactly_the_fourth_too() {
    let strength = 0.05;
    let waves = Waves::new(&disc(strength, 4.0, 0.0, TANGENTIAL, 0.3)).expect("waves");
    let found = waves.dithered(0.0..=1.0);
    let can: Vec<bool> =
        found.iter().map(quell_disc::resonance::Resonance::pair_can_be_unstable).collect();
    assert_eq!(can, [true, true, true, false, false, false, false, false]);
    for (resonance, can) in found.iter().zip(can) {
        let rates = (-60..=60).map(|k| {
            let speed = resonance.speed + 5e-4 * f64::from(k);
            growth(&disc(strength, 4.0, 0.0, TANGENTIAL, speed))
        });
        let largest = rates.fold(f64::MIN, f64::max);
        assert_eq!(largest > 0.0, can, "Ω = {}: {largest}", resonance.speed);
    }
    // Figure 5.9: printed m = c = k = 0.1 and f = 1.7·10⁻⁴, in the units of the plate's mass.
    let printed = 0.1 / (0.75 * PI);
    let of = |modes: Vec<Mode>| {
        zoo::disc(modes, vec![equal_load(printed, 17.0 * printed)], TANGENTIAL, 0.553)
    };
    let all = of(modes(0.0));
    close(growth(&all), 3.676e-4, 1e-3);
    for left_out in 0..3 {
        let mut pair = modes(0.0);
        pair.remove(left_out);
        assert!(growth(&of(pair)) < 0.0, "without mode {left_out}");
    }
    let growing = growing_speeds(&all, &(0.5..=0.6), 60).expect("finite");
    let fourth = growing.iter().find(|speeds| (speeds.from..speeds.to).contains(&0.553));
    let fourth = fourth.expect("the fourth");
    assert!(fourth.from > 0.54 && fourth.to < 0.57 && fourth.peak_growth > 3.6e-4, "{fourth:?}");
}

/// "Neither dither suppresses the undithered instabilities": tangential dither removes the mean friction that drives them.
#[test]
fn tangential_dither_takes_the_first_tongues_away() {
    let tongue = |dither: DiscDither| {
        let rates =
            (0..=80).map(|k| growth(&disc(0.1, 0.4, 0.0, dither, 0.06 + 5e-4 * f64::from(k))));
        rates.fold(f64::MIN, f64::max)
    };
    let (without, with) = (tongue(DiscDither::None), tongue(TANGENTIAL));
    close(without, 6.165e-4, 0.02);
    assert!(with < 1e-3 * without, "{with} {without}");
    let normal = tongue(DiscDither::Normal { amplitude: 1.0, frequency_ratio: 2.7 });
    assert!(normal > 0.5 * without, "normal dither does not remove them: {normal}");
}

/// Axes of the figures: away from meetings a disc is stable for f < c(1 + Ω) and unstable at every speed beyond 2c,
/// for any r₀ and any modes. Printed thresholds are 10⁻⁴ of that.
#[test]
fn unit_of_the_friction_axis() {
    for speed in [0.25, 0.5, 0.75] {
        let limit = 1.0 + speed;
        assert!(growth(&disc(0.01, 0.95 * limit, 0.0, DiscDither::None, speed)) < 0.0);
        assert!(growth(&disc(0.01, 1.05 * limit, 0.0, DiscDither::None, speed)) > 0.0);
        // "Unstable at every speed above 2·10⁻⁵" for c = 0.1: the printed number itself has no effect.
        assert!(growth(&disc(0.1, 2e-5 / 0.1, 0.0, DiscDither::None, speed)) < 0.0);
        assert!(growth(&disc(0.1, 1e4 * 2.2e-5 / 0.1, 0.0, DiscDither::None, speed)) > 0.0);
    }
}
