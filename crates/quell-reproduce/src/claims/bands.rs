//! Statements of chapter 5 about bands of instability, by exact growth: which speeds have one, how wide it is, what removes it.

use quell::parallel::Parallel;
use quell_disc::growing::{GrowingSpeeds, growing_speeds};
use quell_disc::plate::{ModeSet, Plate, PlateMaterial, Reference};
use quell_disc::undithered;
use quell_model::Disc;
use quell_model::disc::{DiscDither, Load};
use quell_numerics::interval::RealInterval;

use super::super::disc::STRENGTH_PER_PRINTED;
use super::super::failure::failed;
use super::chapter5::{NORMAL, TANGENTIAL, UNIT, at, disc, growth, meetings};
use super::sheet::{ClaimSheet, digits, list};
use quell::complaint::Failure;

/// The speeds at which a motion grows at a printed friction (10⁻⁴).
fn growing(
    disc: &Disc,
    RealInterval { lower: from, upper: to }: RealInterval,
    printed: f64,
    steps: u32,
) -> Result<Vec<GrowingSpeeds>, Failure> {
    let disc = disc
        .with_friction_of(0, printed * UNIT)
        .map_err(|_| failed("claims", &"a friction of chapter 5 is not valid"))?;
    growing_speeds(&disc, &(from..=to), steps).map_err(|why| failed("claims", &why))
}

/// Printed frictions (10⁻⁴) over the axes of figures 5.9 to 5.15.
const FRICTIONS: [f64; 8] = [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0];

/// The induced speeds with a band of their own at some friction of the figure: the largest growth among the bands that are nearest to
/// each, and the friction at which it occurs.
fn induced_bands(disc: &Disc) -> Result<Vec<Option<(f64, GrowingSpeeds)>>, Failure> {
    let speeds: Vec<f64> = meetings(disc, true)?.iter().map(|meeting| meeting.speed).collect();
    let rows = FRICTIONS
        .in_parallel(|&friction| {
            Ok((friction, growing(disc, RealInterval::new(0.28, 1.0), friction, 90)?))
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let mut found: Vec<Option<(f64, GrowingSpeeds)>> = vec![None; speeds.len()];
    for (friction, band) in rows.iter().flat_map(|(f, bands)| bands.iter().map(|band| (*f, *band)))
    {
        let apart = |speed: &f64| (speed - band.peak_speed).abs();
        let nearest = (0..speeds.len())
            .min_by(|a, b| apart(&speeds[*a]).total_cmp(&apart(&speeds[*b])))
            .unwrap_or(0);
        let best = &mut found[nearest];
        if best.is_none_or(|(_, known)| band.peak_growth > known.peak_growth) {
            *best = Some((friction, band));
        }
    }
    Ok(found)
}

/// Figures 5.9 to 5.11: "additional resonances … occur at Ω₁*, Ω₂* and Ω₃*. The instability band associated with Ω₄* is also present
/// in Figure 5.9 in the case 0.1."
pub(super) fn induced(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let sizes = [0.1, 0.2, 0.3];
    let bands = sizes
        .in_parallel(|&size| induced_bands(&disc([1, 2], size, 0.0, TANGENTIAL)?))
        .collect::<Result<Vec<_>, Failure>>()?;
    let present = |bands: &[Option<(f64, GrowingSpeeds)>]| -> Vec<usize> {
        (1..=bands.len()).filter(|number| bands[number - 1].is_some()).collect()
    };
    let sets: Vec<Vec<usize>> = bands.iter().map(|bands| present(bands)).collect();
    let words = |set: &[usize]| {
        set.iter().map(|number| format!("Ω_{number}*")).collect::<Vec<_>>().join(", ")
    };
    let measured: Vec<String> =
        sizes.iter().zip(&sets).map(|(size, set)| format!("{size}: {}", words(set))).collect();
    let counts: Vec<f64> = sets.iter().map(|set| set.len() as f64).collect();
    sheet
        .statement(
            [
                "5.9-first-three",
                "Figures 5.9–5.11",
                "of the eight induced speeds Ω_1*, Ω_2*, Ω_3* have bands, and Ω_4* for m = c = k = 0.1",
            ],
            format!("exact growth for f up to 2·10⁻⁴, m = c = k = {}", measured.join("; ")),
            &counts,
            sets == [vec![1, 2, 3, 4], vec![1, 2, 3], vec![1, 2, 3]],
        )
        .note("at first order only three of the eight can have a band: a forward and a backward wave share damping, and waves without \
               nodal diameters do not couple; the fourth needs three waves and strong friction");
    for ((size, bands), present) in sizes.iter().zip(&bands).zip([true, false, false]) {
        if *size == 0.2 {
            continue;
        }
        let word = if present { "present" } else { "absent" };
        let fourth = bands[3];
        let measured = fourth.map_or_else(
            || "no growth near it for f up to 2·10⁻⁴".to_owned(),
            |(friction, band)| {
                format!(
                    "growth up to {} at Ω = {}, f = {friction}·10⁻⁴",
                    digits(band.peak_growth, 3),
                    digits(band.peak_speed, 4)
                )
            },
        );
        let values: Vec<f64> = fourth.iter().map(|(_, band)| band.peak_growth).collect();
        sheet
            .statement(
                [
                    &format!("5.9-fourth-{size}"),
                    "Text of figures 5.9–5.11",
                    &format!("the tongue of Ω_4* is {word} for m = c = k = {size}"),
                ],
                measured,
                &values,
                fourth.is_some() == present,
            )
            .note("exact exponents; no pair of waves has this tongue at first or second order");
    }
    Ok(())
}

/// Frequency parameter of the unit of speed, ω_cr = min ω_pq/q, of N = (1, `diameters`).
fn critical_parameter(plate: &Plate, diameters: u32) -> Result<f64, Failure> {
    let set = ModeSet::new(plate, 1, diameters, Reference::Critical)
        .map_err(|why| failed("claims", &why))?;
    let turning = set.modes().iter().filter(|mode| mode.diameters > 0);
    let critical = turning.map(|mode| mode.frequency_parameter / f64::from(mode.diameters));
    Ok(critical.fold(f64::INFINITY, f64::min))
}

/// Figures 5.3 to 5.5: "the same bands of instability are found, but additional unstable regions are also present".
pub(super) fn more_bands(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let plate = Plate::new(0.5, 0.3).map_err(|why| failed("claims", &why))?;
    let reference = |diameters: u32| critical_parameter(&plate, diameters);
    let unit = reference(2)?;
    let friction = 0.15;
    let sets = [([1, 2], reference(2)?), ([1, 5], reference(5)?), ([2, 5], reference(5)?)];
    let bands = sets
        .in_parallel(|&(modes, own)| -> Result<Vec<RealInterval>, Failure> {
            let disc = disc(modes, 0.1, 0.0, DiscDither::None)?;
            let scale = own / unit;
            // The same speeds in radians per second.
            let bands =
                growing(&disc, RealInterval::new(0.02 / scale, 0.8 / scale), friction, 160)?;
            Ok(bands
                .iter()
                .map(|band| RealInterval::new(band.from * scale, band.to * scale))
                .collect())
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let share = |bands: &[RealInterval]| bands.iter().map(|band| band.width()).sum::<f64>() / 0.78;
    let counts: Vec<f64> = bands.iter().map(|bands| bands.len() as f64).collect();
    let shares: Vec<f64> = bands.iter().map(|bands| share(bands)).collect();
    // A band of fewer modes is found again if speeds of it are unstable with more modes too.
    let meets = |one: &RealInterval, others: &[RealInterval]| {
        others.iter().any(|other| one.lower < other.upper && other.lower < one.upper)
    };
    let again = bands.windows(2).all(|pair| pair[0].iter().all(|band| meets(band, &pair[1])));
    sheet
        .statement(
            [
                "5.4-more-bands",
                "Figures 5.4, 5.5",
                "with more modes the same bands of instability are found, and additional ones",
            ],
            format!(
                "N = (1, 2), (1, 5), (2, 5): {} bands, {} of the speeds",
                list(&counts),
                list(&shares)
            ),
            &[counts.clone(), shares.clone()].concat(),
            again && shares.windows(2).all(|pair| pair[1] > pair[0]),
        )
        .note(format!(
            "at f = {friction}·10⁻⁴, m = c = k = 0.1, over the same speeds in rad/s: the unit of speed changes by 1.188 from N_θ = 2 \
             to 5, and with it the scale of m, c, k and f"
        ));
    Ok(())
}

/// "The only influential parameter in the subcritical range is the friction follower force amplitude."
pub(super) fn friction_alone(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let base = disc([1, 2], 0.1, 0.0, DiscDither::None)?;
    let largest = |load: &Load, range: RealInterval| -> Result<f64, Failure> {
        let loaded = Disc::new(base.modes().to_vec(), vec![load.clone()], DiscDither::None, 0.0)
            .map_err(|_| failed("claims", &"a disc of chapter 5 is not valid"))?;
        let mut most = f64::NEG_INFINITY;
        for k in 1..=200 {
            let speed = range.lower + range.width() * f64::from(k) / 201.0;
            let found =
                undithered::growth(&at(&loaded, speed)?).map_err(|why| failed("claims", &why))?;
            most = most.max(found.rate);
        }
        Ok(most)
    };
    let (mut below, mut above) = (Vec::new(), Vec::new());
    for [mass, damping, stiffness] in [
        [0.1, 0.0, 0.0],
        [0.0, 0.1, 0.0],
        [0.0, 0.0, 0.1],
        [0.1, 0.1, 0.1],
        [0.3, 0.01, 0.3],
        [0.01, 0.3, 0.1],
    ] {
        let load = Load::new(mass, damping, stiffness, 0.0);
        below.push(largest(&load, RealInterval::new(0.0, 1.0))?);
        above.push(largest(&load, RealInterval::new(1.0, 1.6))?);
    }
    let most = |values: &[f64]| values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let found = [most(&below), most(&above)];
    sheet
        .statement(
            [
                "5.3-friction-alone",
                "before Figure 5.3",
                "for 0 < Ω ≤ 1 friction alone destabilises: without it no mass, damper or spring does",
            ],
            format!(
                "largest growth rate without friction, six loads: {} below Ω = 1, {} above",
                digits(found[0], 2),
                digits(found[1], 2)
            ),
            &found,
            found[0] < 1e-12 && found[1] > 1e-3,
        )
        .note("rates below 10⁻¹² are rounding");
    Ok(())
}

/// "The importance of plate damping in stabilizing the system is also clearly evident": figures 5.7 and 5.8.
pub(super) fn plate_damping(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let shares = [0.0, 1e-3]
        .in_parallel(|&damping| -> Result<f64, Failure> {
            let disc = disc([1, 2], 0.3, damping, DiscDither::None)?;
            let mut unstable = 0.0;
            for k in 1..=20 {
                // Below the friction at which every speed is unstable, where bands can be seen.
                let bands = growing(&disc, RealInterval::new(0.02, 1.0), 0.02 * f64::from(k), 120)?;
                unstable += bands.iter().map(|band| band.to - band.from).sum::<f64>() / 0.98 / 20.0;
            }
            Ok(unstable)
        })
        .collect::<Result<Vec<f64>, Failure>>()?;
    sheet
        .statement(
            [
                "5.8-plate-damping",
                "Text of figures 5.7, 5.8",
                "the importance of plate damping in stabilising the system is clearly evident",
            ],
            format!(
                "unstable share of the speeds for f up to 0.4·10⁻⁴: {} at ξ = 0, {} at ξ = 10⁻³",
                digits(shares[0], 3),
                digits(shares[1], 3)
            ),
            &shares,
            shares[1] < 0.7 * shares[0],
        )
        .note("m = c = k = 0.3, without dither");
    Ok(())
}

/// "Neither normal nor tangential dither can suppress the system parametric resonances", after (5.56), and what (5.66) says of strong
/// friction.
pub(super) fn suppression(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    // The band of Ω_2 at a friction far below that at which waves grow on their own.
    let peak = |dither: DiscDither| -> Result<f64, Failure> {
        let disc = disc([1, 2], 0.1, 0.0, dither)?;
        let bands = growing(&disc, RealInterval::new(0.06, 0.1), 0.04, 60)?;
        Ok(bands.iter().map(|band| band.peak_growth).fold(0.0, f64::max))
    };
    let found = [peak(DiscDither::None)?, peak(NORMAL)?, peak(TANGENTIAL)?];
    let words = format!(
        "growth at Ω_2, f = 0.04·10⁻⁴: {} without dither, {} with normal, {} with tangential dither",
        digits(found[0], 3),
        digits(found[1], 3),
        digits(found[2], 2)
    );
    sheet.statement(
        [
            "5.56-normal",
            "after (5.56)",
            "normal dither cannot suppress the resonances (5.55a), (5.56a)",
        ],
        words.clone(),
        &found,
        found[1] > 0.3 * found[0],
    );
    sheet
        .statement(
            [
                "5.56-tangential",
                "after (5.56)",
                "tangential dither cannot suppress the resonances (5.55a), (5.56a)",
            ],
            words.clone(),
            &found,
            found[2] > 0.3 * found[0],
        )
        .note("its own (5.53) and (5.54) have no mean friction under tangential dither, which drives these resonances");
    sheet
        .statement(
            [
                "5.66-tangential",
                "after (5.66), chapter 6",
                "tangential dither suppresses the resonances (5.55a), (5.56a)",
            ],
            words,
            &found,
            found[2] < 1e-2 * found[0],
        )
        .note("with friction of the order √ε the text says the opposite of the line before, and is right at both orders");
    Ok(())
}

/// "These instability bands, associated with the scaled rotation speeds Ω_i, are very narrow": figures 5.9 to 5.11, revived bands.
pub(super) fn narrow(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let mut widths = Vec::new();
    for size in [0.1, 0.2, 0.3] {
        let disc = disc([1, 2], size, 0.0, TANGENTIAL)?;
        for meeting in meetings(&disc, false)?.iter().take(4) {
            let range = RealInterval::new(0.9 * meeting.speed, meeting.speed);
            let bands = growing(&disc, range, 1.5, 60)?;
            widths.push(bands.iter().map(|band| band.to - band.from).sum::<f64>());
        }
    }
    let most = widths.iter().copied().fold(0.0, f64::max);
    sheet
        .statement(
            [
                "5.9-narrow",
                "Text of figures 5.9–5.11",
                "the bands of Ω_1 to Ω_4 that return under tangential dither are very narrow",
            ],
            format!("widths in Ω at f = 1.5·10⁻⁴: {}", list(&widths)),
            &widths,
            most < 0.01,
        )
        .note("m = c = k = 0.1, 0.2, 0.3, Ω_1 to Ω_4 of each; narrow is taken as a hundredth of the axis");
    Ok(())
}

/// Chapter 6: "as R can be arbitrarily chosen, it can be used to cancel squeal arising at a particular rotor speed".
pub(super) fn chosen_speed(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let speeds = [0.07, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95];
    // Above the friction at which every speed squeals without dither.
    let friction = 0.2;
    let found = speeds
        .in_parallel(|&speed| -> Result<(f64, usize, f64), Failure> {
            let still = growth(&disc([1, 2], 0.1, 0.0, DiscDither::None)?, speed, friction)?;
            let (mut clear, mut least) = (0, f64::INFINITY);
            for k in 0..=80 {
                let frequency_ratio = 2.0 + 0.05 * f64::from(k);
                let dither = DiscDither::Tangential { amplitude: 1.0, frequency_ratio };
                let rate = growth(&disc([1, 2], 0.1, 0.0, dither)?, speed, friction)?;
                clear += usize::from(rate < 0.0);
                least = least.min(rate);
            }
            Ok((still, clear, least))
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let squeals = found.iter().filter(|(still, ..)| *still > 0.0).count();
    let counts: Vec<f64> = found.iter().map(|(_, clear, _)| *clear as f64).collect();
    sheet
        .statement(
            [
                "6-chosen-speed",
                "chapters 5, 6",
                "the frequency of tangential dither can be chosen to cancel squeal at a particular rotor speed",
            ],
            format!("of 81 ratios R from 2 to 6 at seven speeds, without growth: {}", list(&counts)),
            &counts,
            squeals == speeds.len() && counts.iter().all(|count| *count > 0.0),
        )
        .note(format!(
            "f = {friction}·10⁻⁴, m = c = k = 0.1, Ω = 0.07 to 0.95, where every speed grows without dither; `quell resonances --clear` \
             and `quell design` choose R for a range of speeds"
        ));
    Ok(())
}

/// The friction of figures 5.3 to 5.15 in newtons, for a rotor of the size that chapter 5 calls typical.
pub(super) fn newtons(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let plate = Plate::new(0.5, 0.3).map_err(|why| failed("claims", &why))?;
    let (radius, thickness) = (0.15, 0.15 * 0.15);
    let material = PlateMaterial::new(1.95e11, 7700.0, thickness, radius)
        .map_err(|why| failed("claims", &why))?;
    let reference = critical_parameter(&plate, 2)? * material.angular_frequency_unit(&plate);
    // F = f r₀ ω², with f = c/ω = 0.1 kg times the number of the threshold.
    let newtons = |number: f64| 0.1 * number * 0.75 * radius * reference * reference;
    let induced = disc([1, 2], 0.1, 0.0, TANGENTIAL)?;
    let tip = meetings(&induced, true)?
        .first()
        .and_then(|meeting| meeting.threshold)
        .map_or(f64::NAN, |threshold| threshold / (0.1 * STRENGTH_PER_PRINTED));
    let found = [newtons(1.0), newtons(tip)];
    sheet
        .finding(
            [
                "5.3-newtons",
                "axes of figures 5.3–5.15",
                "with consistent units nothing in these figures happens in a brake: their thresholds are of meganewtons",
            ],
            format!(
                "waves grow from {} MN on, the first induced band begins at {} MN",
                digits(1e-6 * found[0], 2),
                digits(1e-6 * found[1], 2)
            ),
            &found,
            found.iter().all(|force| *force > 1e6),
        )
        .note("m = 0.1 kg, c = 0.1 kg·ω_cr, k = 0.1 kg·ω_cr², a steel rotor of 150 mm with h/a = 0.15 as the chapter calls typical; a pad \
               pulls with kilonewtons");
    Ok(())
}
