//! Claims of chapter 5: the disc. The printed f is in units of 10⁻⁴ of the consistent one; see `reproduce::disc`.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use quell_disc::boundaries::{Marginal, boundaries};
use quell_disc::dithered;
use quell_disc::partition::crossings;
use quell_disc::resonance::{Resonance, Waves};
use quell_model::Disc;
use quell_model::disc::{DiscDither, Load};
use quell_numerics::floquet::Effort;
use quell_numerics::quadrature::{QuadratureOptions, integrate};

use super::super::disc::{
    FRICTION_PER_PRINTED, PRINTED_INDUCED, PRINTED_UNDITHERED, STRENGTH_PER_PRINTED, study,
};
use super::super::failure::failed;
use super::chapter2::source;
use super::sheet::{ClaimSheet, digits, list};
use quell::complaint::Failure;

/// The unit of f in the dissertation.
pub(super) const UNIT: f64 = 1e-4 * FRICTION_PER_PRINTED;

/// A disc of the dissertation: N_r, N_θ, printed m = c = k, ξ, dither.
pub(super) fn disc(
    modes: [u32; 2],
    size: f64,
    damping: f64,
    dither: DiscDither,
) -> Result<Disc, Failure> {
    loaded_at("0.75", modes, size, damping, dither)
}

/// The same with the load at another r₀/a.
pub(super) fn loaded_at(
    radius_ratio: &str,
    modes: [u32; 2],
    size: f64,
    damping: f64,
    dither: DiscDither,
) -> Result<Disc, Failure> {
    let changes = [
        format!("disc.load.radius_ratio={radius_ratio}"),
        format!("disc.radial_modes={}", modes[0]),
        format!("disc.nodal_diameters={}", modes[1]),
        format!("disc.modal_damping={damping:?}"),
    ];
    let study = study(&source("table-5.1")?, &changes.each_ref().map(String::as_str))?;
    let strength = size * STRENGTH_PER_PRINTED;
    let load = Load::new(strength, strength, strength, 1.0);
    Disc::new(study.disc().modes().to_vec(), vec![load], dither, 0.0)
        .map_err(|_| failed("claims", &"a disc of chapter 5 is not valid"))
}

pub(super) const TANGENTIAL: DiscDither =
    DiscDither::Tangential { amplitude: 1.0, frequency_ratio: 2.7 };
pub(super) const NORMAL: DiscDither = DiscDither::Normal { amplitude: 1.0, frequency_ratio: 2.7 };

pub(super) fn at(disc: &Disc, speed: f64) -> Result<Disc, Failure> {
    disc.at_speed(speed).map_err(|_| failed("claims", &"a speed of chapter 5 is not valid"))
}

/// Growth rate at a speed and a printed friction (in 10⁻⁴).
pub(super) fn growth(disc: &Disc, speed: f64, printed: f64) -> Result<f64, Failure> {
    let disc = at(disc, speed)?
        .with_friction_of(0, printed * UNIT)
        .map_err(|_| failed("claims", &"a friction of chapter 5 is not valid"))?;
    let found = dithered::growth(&disc, Effort::default()).map_err(|why| failed("claims", &why))?;
    Ok(found.rate)
}

/// Printed friction (in 10⁻⁴) above which an undithered, undamped disc is unstable at a speed.
fn threshold(disc: &Disc, speed: f64) -> Result<f64, Failure> {
    let found = boundaries(&at(disc, speed)?)
        .map_err(|_| failed("claims", &"a boundary of chapter 5 is not known"))?;
    let positive = found.iter().filter_map(|boundary| match boundary.friction {
        Marginal::At(friction) if friction > 0.0 => Some(friction / UNIT),
        _ => None,
    });
    Ok(positive.fold(f64::INFINITY, f64::min))
}

/// Equally spaced speeds in (0, 1).
fn speeds() -> impl Iterator<Item = f64> {
    (1..400).map(|k| f64::from(k) / 400.0)
}

pub(super) fn meetings(disc: &Disc, dithered: bool) -> Result<Vec<Resonance>, Failure> {
    let waves = Waves::new(disc).map_err(|why| failed("claims", &why))?;
    let found = if dithered { waves.dithered(0.0..=1.0) } else { waves.undithered(0.0..=1.0) };
    Ok(found.into_iter().filter(|resonance| resonance.speed > 1e-9).collect())
}

/// Tables 5.1 and 5.2.
pub(super) fn tables(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let disc = disc([1, 2], 0.1, 0.0, TANGENTIAL)?;
    for (table, printed, dithered, star) in
        [("5.1", &PRINTED_UNDITHERED[..], false, ""), ("5.2", &PRINTED_INDUCED[..], true, "*")]
    {
        for (index, (resonance, printed)) in
            meetings(&disc, dithered)?.iter().zip(printed).enumerate()
        {
            let number = index + 1;
            sheet
                .number(
                    &format!("{table}-speed-{number}"),
                    &format!("Table {table}"),
                    &format!("Ω_{number}{star}: {}", resonance.label()),
                    printed,
                    &[resonance.speed],
                )
                .note("with b/a = 0.5; with the printed 0.05 no digit agrees");
        }
    }
    Ok(())
}

/// Thresholds without dither.
pub(super) fn thresholds(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    for (size, printed) in [(0.1, "2"), (0.2, "3.5"), (0.3, "5")] {
        let disc = disc([1, 2], size, 0.0, DiscDither::None)?;
        let mut highest = 0.0f64;
        for speed in speeds().skip(3) {
            highest = highest.max(threshold(&disc, speed)?);
        }
        sheet
            .number(
                &format!("5.9-all-unstable-{size}"),
                "Text of figures 5.9–5.11",
                &format!("f in 10⁻⁵ above which all speeds are unstable, m = c = k = {size}"),
                printed,
                &[10.0 * highest],
            )
            .note("with the unit of f, r₀ and ρha² fitted to such statements, see the captions");
    }
    for (name, size, printed) in [("a", 0.1, 0.1), ("b", 0.01, 0.01)] {
        let disc = disc([1, 2], size, 0.0, DiscDither::None)?;
        let mut stable = 0.0;
        for speed in speeds() {
            stable += f64::from(u8::from(threshold(&disc, speed)? > printed)) / 399.0;
        }
        sheet.statement(
            [
                &format!("5.3{name}-mostly-stable"),
                &format!("Figure 5.3({name})"),
                &format!("mostly stable for f below {printed:?}·10⁻⁴"),
            ],
            format!("{} % of the speeds", digits(100.0 * stable, 3)),
            &[stable],
            stable > 0.5,
        );
    }
    Ok(())
}

/// Normal dither.
pub(super) fn normal(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let undithered = disc([1, 2], 0.3, 0.0, DiscDither::None)?;
    let dithered = disc([1, 2], 0.3, 0.0, NORMAL)?;
    let first = |speed: f64| -> Result<f64, Failure> {
        let found = crossings(&at(&dithered, speed)?)
            .map_err(|_| failed("claims", &"a boundary of chapter 5 is not known"))?;
        Ok(found.first().map_or(f64::INFINITY, |crossing| crossing.factor / UNIT))
    };
    for (printed, from, to) in [("0.7", 0.66, 0.75), ("0.88", 0.85, 0.92)] {
        let mut best = (0.0, 0.0, 0.0);
        for k in 0..=90 {
            let speed = from + (to - from) * f64::from(k) / 90.0;
            let (without, with) = (threshold(&undithered, speed)?, first(speed)?);
            if with.is_finite() && with - without > best.1 {
                best = (speed, with - without, with);
            }
        }
        sheet
            .number(
                &format!("5.7-peak-{printed}"),
                "Text of figure 5.7",
                "speed near which normal dither stabilises the disc over a small range of friction",
                printed,
                &[best.0],
            )
            .note(format!(
                "the threshold there increases by {} to {} (10⁻⁴)",
                digits(best.1, 2),
                digits(best.2, 2)
            ));
    }
    let mut unstable = [0.0; 2];
    for k in 1..40 {
        for l in 1..40 {
            let (speed, friction) = (f64::from(k) / 40.0, f64::from(l) / 20.0);
            for (share, disc) in unstable.iter_mut().zip([&undithered, &dithered]) {
                *share += f64::from(u8::from(growth(disc, speed, friction)? > 1e-10)) / 1521.0;
            }
        }
    }
    sheet.statement(
        [
            "5.7-not-suppressed",
            "Text of figures 5.7, 5.8",
            "normal dither does not suppress the unstable region",
        ],
        format!(
            "unstable fraction {} without dither, {} with",
            digits(unstable[0], 3),
            digits(unstable[1], 3)
        ),
        &unstable,
        (unstable[0] - unstable[1]).abs() < 0.02,
    );
    Ok(())
}

/// Largest growth rate over a range of speeds and printed frictions (10⁻⁴).
fn largest(disc: &Disc, speeds: [f64; 2], frictions: &[f64]) -> Result<f64, Failure> {
    let mut most = f64::NEG_INFINITY;
    for k in 0..=120 {
        let speed = speeds[0] + (speeds[1] - speeds[0]) * f64::from(k) / 120.0;
        for &friction in frictions {
            most = most.max(growth(disc, speed, friction)?);
        }
    }
    Ok(most)
}

/// Tangential dither.
pub(super) fn tangential(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let reversed = |theta: f64| libm::cos(theta).signum() * libm::cos(theta) / PI;
    let breaks = [FRAC_PI_2, 3.0 * FRAC_PI_2];
    let fundamental = integrate(reversed, 0.0, TAU, &breaks, &QuadratureOptions::default())
        .map_err(|why| failed("claims", &why))?
        .value;
    sheet
        .finding(
            [
                "5.30-fundamental",
                "before (5.30)",
                "friction that alternates between ±F_θ is approximated by F_θ cos ωt; its fundamental is 4/π of that",
            ],
            format!("{} F_θ", digits(fundamental, 4)),
            &[fundamental],
            (fundamental - 4.0 / PI).abs() < 1e-9,
        )
        .note("an approximation that the text states; with it thresholds under tangential dither are 27 % higher, and α = 4/π corrects them");
    for damping in [1e-4, 1e-3] {
        let found = largest(
            &disc([1, 2], 0.3, damping, TANGENTIAL)?,
            [0.005, 0.25],
            &[0.5, 1.0, 1.5, 2.0],
        )?;
        sheet.statement(
            [
                &format!("5.14-vanish-{damping:?}"),
                "Text of figures 5.14, 5.15",
                &format!("with ξ = {damping:?} the original tongues are absent for f up to 2·10⁻⁴"),
            ],
            format!("largest growth rate {}", digits(found, 2)),
            &[found],
            found < 0.0,
        );
    }
    Ok(())
}

/// Relative distances from a meeting speed: the first below the meeting, the others within its tongue.
const OFFSETS: [f64; 12] =
    [-0.02, 0.001, 0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.12, 0.16, 0.2, 0.25];

/// Modal damping without dither: the remaining tongues.
pub(super) fn damping(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    for (damping, printed) in
        [(0.0, &[1, 2, 3, 4][..]), (1e-5, &[1, 2, 3, 4]), (1e-4, &[2, 3]), (1e-3, &[2])]
    {
        let disc = disc([1, 2], 0.3, damping, DiscDither::None)?;
        let (mut left, mut depths) = (Vec::new(), Vec::new());
        for (index, resonance) in meetings(&disc, false)?.iter().take(4).enumerate() {
            let mut thresholds = Vec::new();
            for offset in OFFSETS {
                thresholds.push(first_unstable(&disc, resonance.speed * (1.0 + offset))?);
            }
            // A tongue is a notch: beyond the meeting the threshold decreases by more than a step of the search.
            let lowest = thresholds[1..].iter().copied().fold(f64::INFINITY, f64::min);
            let depth = lowest / thresholds[0];
            depths.push(depth);
            if depth < 0.92 {
                left.push(index + 1);
            }
        }
        let words = |list: &[usize]| {
            list.iter().map(|index| format!("Ω_{index}")).collect::<Vec<_>>().join(", ")
        };
        sheet.statement(
            [
                &format!("5.12-left-{damping:?}"),
                "Figures 5.12–5.15, left",
                &format!(
                    "without dither and with ξ = {damping:?} the tongues of {} are present",
                    words(printed)
                ),
            ],
            format!(
                "{}; threshold divided by that before the meeting: {}",
                words(&left),
                list(&depths)
            ),
            &depths,
            left == printed,
        );
    }
    Ok(())
}

/// Number of steps in the search for a threshold.
const STEPS: u32 = 75;

/// Lowest printed friction (10⁻⁴) at which an undithered disc is unstable, in steps of 5 %.
fn first_unstable(disc: &Disc, speed: f64) -> Result<f64, Failure> {
    for step in 0..STEPS {
        let friction = 0.01 * 1.05f64.powi(i32::try_from(step).unwrap_or(0));
        if growth(disc, speed, friction)? > 1e-12 {
            return Ok(friction);
        }
    }
    Ok(f64::INFINITY)
}

/// "The stability for the system without dither determined numerically using Floquet theory is in strong agreement with the
/// eigenvalue analysis": both methods at speeds and frictions of figure 5.3.
pub(super) fn floquet(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let still = DiscDither::Normal { amplitude: 0.0, frequency_ratio: 2.7 };
    let [by_floquet, by_eigenvalues] =
        [disc([1, 2], 0.3, 1e-4, still)?, disc([1, 2], 0.3, 1e-4, DiscDither::None)?];
    let (mut worst, mut scale) = (0.0f64, 0.0f64);
    for k in 1..20 {
        for friction in [0.05, 0.2, 0.5, 1.0, 2.0] {
            let speed = f64::from(k) / 20.0;
            let pair =
                [growth(&by_floquet, speed, friction)?, growth(&by_eigenvalues, speed, friction)?];
            worst = worst.max((pair[0] - pair[1]).abs());
            scale = scale.max(pair[1].abs());
        }
    }
    sheet.statement(
        [
            "5.6-floquet",
            "before Multiple Scales Method",
            "without dither Floquet theory agrees strongly with the eigenvalues",
        ],
        format!(
            "largest difference of the growth rates {} at 95 points, where they reach {}",
            digits(worst, 2),
            digits(scale, 2)
        ),
        &[worst, scale],
        worst < 1e-6 * scale,
    );
    Ok(())
}

/// (5.26), (5.29): with φ = φ₀ sin ωt and φ₀ = O(ω^n₁), −1 < n₁ < 0, the force is of the order of φ″, O(ω^n₂) with 1 < n₂ < 2.
pub(super) fn tangential_force(sheet: &mut ClaimSheet) {
    // The largest |φ″| over a cycle by second differences, whose step is a fixed fraction of the cycle.
    let peak = |n1: f64, omega: f64| {
        let angle = |time: f64| libm::pow(omega, n1) * libm::sin(omega * time);
        let step = 1e-3 / omega;
        let second = |k: i32| {
            let time = f64::from(k) * TAU / omega / 1000.0;
            (angle(time + step) - 2.0 * angle(time) + angle(time - step)) / (step * step)
        };
        (0..1000).map(|k| second(k).abs()).fold(0.0, f64::max)
    };
    let orders: Vec<f64> = [-0.9, -0.5, -0.1]
        .map(|n1| libm::log(peak(n1, 1e4) / peak(n1, 1e2)) / libm::log(1e2))
        .to_vec();
    sheet.statement(
        ["5.29-order", "(5.29)", "D_T = O(ω^n₂) with 1 < n₂ < 2 for φ₀ = O(ω^n₁) with −1 < n₁ < 0"],
        format!("n₂ at n₁ = −0.9, −0.5, −0.1: {}", list(&orders)),
        &orders,
        orders.iter().all(|order| 1.0 < *order && *order < 2.0),
    );
}
