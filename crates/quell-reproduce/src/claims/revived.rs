//! Claims about the tongues of figures 5.9 to 5.13 that occur without dither and are revived by strong tangential dither.
//!
//! At second order in f their growth rate scales with f⁴. Without modal damping they have no threshold; with it they begin where
//! growth exceeds the damping.

use quell_model::Disc;

use super::chapter5::{TANGENTIAL, disc, growth, loaded_at, meetings};
use super::sheet::{ClaimSheet, list};
use quell::complaint::Failure;

/// Growth rate from which a stability map shows a tongue that theory gives no threshold.
const FLOOR: f64 = 1e-7;

/// Largest growth rate of the revived tongue below a meeting speed. Such tongues are narrow and close to the meeting, so the speeds
/// are clustered there, and then about the best of them.
fn revived_growth(disc: &Disc, meeting: f64, printed: f64) -> Result<f64, Failure> {
    let at = |exponent: f64| growth(disc, meeting * (1.0 - libm::pow(10.0, exponent)), printed);
    let (mut from, mut to, mut points) = (-6.0, -1.0, 200);
    let mut best = (0.0, f64::NEG_INFINITY);
    for _ in 0..3 {
        let step = (to - from) / f64::from(points);
        for k in 0..=points {
            let exponent = from + step * f64::from(k);
            let rate = at(exponent)?;
            if rate > best.1 {
                best = (exponent, rate);
            }
        }
        (from, to, points) = (best.0 - step, best.0 + step, 12);
    }
    Ok(best.1)
}

/// Printed friction (10⁻⁴) at which the revived tongue of a meeting grows at a rate; `None` beyond 2. The rate increases with the
/// friction.
fn revived_from(disc: &Disc, meeting: f64, rate: f64) -> Result<Option<f64>, Failure> {
    let (mut below, mut above) = (0.02, 2.0);
    if revived_growth(disc, meeting, above)? <= rate {
        return Ok(None);
    }
    while above - below > 1e-3 * above {
        let middle = (below * above).sqrt();
        let grows = revived_growth(disc, meeting, middle)? > rate;
        *(if grows { &mut above } else { &mut below }) = middle;
    }
    Ok(Some(above))
}

/// "Only when friction reaches a high value, f ≈ 10⁻⁴ for Ω_1 and 3·10⁻⁵ for Ω_4": figures 5.9 to 5.11.
pub(super) fn undamped(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    for (index, printed) in [(0, "1"), (3, "0.3")] {
        let mut found = Vec::new();
        let mut growths = Vec::new();
        for size in [0.1, 0.2, 0.3] {
            let disc = disc([1, 2], size, 0.0, TANGENTIAL)?;
            let meeting = meetings(&disc, false)?[index].speed;
            found.extend(revived_from(&disc, meeting, FLOOR)?);
            let half: f64 = printed.parse().unwrap_or(f64::NAN) / 2.0;
            growths.push(revived_growth(&disc, meeting, half)?);
        }
        let number = index + 1;
        sheet
            .number(
                &format!("5.12-revived-{number}"),
                "Text of figures 5.9–5.12",
                &format!("the tongue of Ω_{number} occurs only above f, approximately (10⁻⁴), m = c = k = 0.1, 0.2, 0.3"),
                printed,
                &found,
            )
            .note(format!(
                "measured: where the growth rate exceeds 10⁻⁷; this one floor gives both numbers on all three maps. There is no \
                 threshold at ξ = 0: the growth rate scales with f⁴ and is {} at half the printed f",
                list(&growths)
            ));
    }
    Ok(())
}

/// Tangential dither and light modal damping: the frictions at which the last two of the original tongues begin.
pub(super) fn damped(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let begins = |radius_ratio: &str| -> Result<Vec<Option<f64>>, Failure> {
        let disc = loaded_at(radius_ratio, [1, 2], 0.3, 1e-5, TANGENTIAL)?;
        let resonances = meetings(&disc, false)?;
        resonances.iter().take(4).map(|one| revived_from(&disc, one.speed, 0.0)).collect()
    };
    let found = begins("0.75")?;
    let values: Vec<f64> = found.iter().flatten().copied().collect();
    sheet.statement(
        [
            "5.13-left",
            "Text of figure 5.13",
            "with ξ = 10⁻⁵ only the tongues of Ω_3 and Ω_4 remain for f up to 2·10⁻⁴",
        ],
        format!("{} of the four begin below that", values.len()),
        &values,
        found[..2].iter().all(Option::is_none) && found[2..].iter().all(Option::is_some),
    );
    for (index, printed) in [(2, "1.4"), (3, "1.8")] {
        let number = index + 1;
        sheet
            .number(
                &format!("5.13-begins-{number}"),
                "Text of figure 5.13",
                &format!("f in 10⁻⁴ at which the tongue of Ω_{number} begins, ξ = 10⁻⁵"),
                printed,
                found[index].as_slice(),
            )
            .note(
                "with r₀/a = 0.75 as in all maps; the labels are interchanged, see the next lines",
            );
    }
    let found = begins("0.746")?;
    for (index, printed) in [(3, "1.4"), (2, "1.8")] {
        let number = index + 1;
        sheet.number(
            &format!("5.13-interchanged-{number}"),
            "Text of figure 5.13",
            &format!("the same with the labels interchanged: the tongue of Ω_{number} begins at f, r₀/a = 0.746"),
            printed,
            found[index].as_slice(),
        );
    }
    Ok(())
}
