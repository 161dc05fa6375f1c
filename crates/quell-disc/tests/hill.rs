//! Floquet exponents from splitting, against an independent method: the scalar Hill determinant.
//!
//! Under one load an exponent ρ makes det(1 − 𝒯F) = 0 over the harmonics h = −H…H, 𝒯 = diag T(ρ + ihR), F tridiagonal with
//! the mean of f(τ) and half of its amplitude (`quell_disc::partition`). The exponent from the splitting starts a secant
//! iteration that converges to the last digits: the distance moved is the error of the splitting.

use num_complex::Complex64;
use quell_disc::dithered;
use quell_model::Disc;
use quell_model::disc::{DiscDither, Load, Mode};
use quell_numerics::floquet::Effort;
use quell_zoo::disc::{self as zoo, ZooModes};

const HARMONICS: i32 = 24;

/// T(λ), from the sums over waves.
fn receptance(disc: &Disc, lambda: Complex64) -> Complex64 {
    let load = &disc.loads()[0];
    let (mut h1, mut h2) = (Complex64::new(0.0, 0.0), Complex64::new(0.0, 0.0));
    for mode in disc.modes() {
        let q = mode.diameters as f64;
        let waves: &[f64] = if mode.diameters == 0 { &[0.0] } else { &[q, -q] };
        for l in waves {
            let seen = lambda - Complex64::new(0.0, l * disc.speed());
            let stiffness =
                seen * seen + seen * (2.0 * mode.damping * mode.ratio) + mode.ratio * mode.ratio;
            let share = mode.shape_at_load * mode.shape_at_load / waves.len() as f64 / stiffness;
            h1 += share;
            h2 += share * Complex64::new(0.0, *l);
        }
    }
    h2 / (h1 * (lambda * lambda * load.mass + lambda * load.damping + load.stiffness) + 1.0)
}

/// det(1 − 𝒯F), by the recurrence of a tridiagonal determinant.
fn hill(disc: &Disc, friction: f64, rho: Complex64) -> Complex64 {
    let (mean, amplitude) = disc.dither().mean_and_amplitude();
    let ratio = disc.dither().frequency_ratio().expect("dithered");
    let (mut before, mut value) = (Complex64::new(0.0, 0.0), Complex64::new(1.0, 0.0));
    let mut last = Complex64::new(0.0, 0.0);
    for h in -HARMONICS..=HARMONICS {
        let t = friction * receptance(disc, rho + Complex64::new(0.0, f64::from(h) * ratio));
        let coupling = last * t * (0.25 * amplitude * amplitude);
        (before, value) = (value, (1.0 - t * mean) * value - coupling * before);
        last = t;
    }
    value
}

fn polished(disc: &Disc, friction: f64, start: Complex64) -> Complex64 {
    let (mut a, mut b) = (start, start + Complex64::new(1e-9, 1e-9));
    let (mut at_a, mut at_b) = (hill(disc, friction, a), hill(disc, friction, b));
    for _ in 0..12 {
        let slope = (at_b - at_a) / (b - a);
        if !(slope.re.is_finite() && slope.norm_sqr() > 0.0) {
            break;
        }
        (a, at_a) = (b, at_b);
        b -= at_b / slope;
        at_b = hill(disc, friction, b);
        if (b - a).norm_sqr() < 1e-32 {
            break;
        }
    }
    b
}

#[test]
fn the_hill_determinant_vanishes_at_the_exponents_of_the_splitting() {
    let mode = |diameters, ratio, shape_at_load, damping| Mode {
        diameters,
        ratio,
        shape_at_load,
        damping,
    };
    let mut checked = 0;
    for large in [false, true] {
        for damping in [0.0, 1e-3] {
            let mut modes = ZooModes::N12.modes(damping);
            if large {
                modes.push(mode(3, 2.524769, 0.930869, damping));
                modes.push(mode(5, 4.859967, 0.890682, damping));
                modes.push(mode(1, 11.793635, -2.02319, damping));
            }
            for dither in [
                DiscDither::Normal { amplitude: 0.5, frequency_ratio: 2.7 },
                DiscDither::Normal { amplitude: 1.0, frequency_ratio: 4.1 },
                DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 2.7 },
                DiscDither::Tangential { amplitude: 0.8, frequency_ratio: 0.9 },
            ] {
                for speed in [0.05, 0.2, 0.37, 0.61, 0.88] {
                    let load = Load::new(0.2, 0.15, 0.3, 1.0);
                    let disc = zoo::disc(modes.clone(), vec![load], dither, speed);
                    let prepared = dithered::prepared(&disc).expect("finite").expect("dithered");
                    for friction in [0.1, 0.6, 1.5] {
                        let found = prepared.growth(friction, Effort::default()).expect("finite");
                        let start = Complex64::new(found.rate, found.frequency);
                        let exact = polished(&disc, friction, start);
                        let gap = (exact.re - found.rate).abs();
                        let at = format!(
                            "{dither:?}, Ω = {speed}, f = {friction}, ξ = {damping}: {found:?}"
                        );
                        // Close by: otherwise the secant iteration converged to another exponent.
                        assert!((exact - start).norm_sqr().sqrt() < 1e-5, "{at} {exact}");
                        assert!(gap <= found.error && gap < 1e-9, "{at}: {gap:e}");
                        checked += 1;
                    }
                }
            }
        }
    }
    assert_eq!(checked, 240);
}
