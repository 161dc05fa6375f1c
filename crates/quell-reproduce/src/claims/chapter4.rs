//! Claims of chapter 4: normal dither.

use quell_linear::averaging::{
    AveragingOptions, EverywhereStable, FastResponse, FastWave, criterion,
    everywhere_stable_amplitude, unstable_bands,
};
use quell_model::{Direction, LawKind, Waveform};

use super::super::failure::failed;
use super::super::measured_friction::{self, BIN, FrictionPanel, interpolated};
use super::super::printed_formulas::{self, LawNumbers};
use super::super::responses::cases;
use super::chapter2::{LIGHT, SUPPRESSED, belt, critical, efficiencies, law, partial, source};
use super::sheet::{ClaimSheet, digits, list, shares};
use quell::complaint::Failure;

const NUMBERS: LawNumbers = LawNumbers::DISSERTATION;

/// Figures 4.3 and 4.4.
pub(super) fn responses(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let found = efficiencies(&cases(&source("4.3")?)?);
    sheet.statement(
        [
            "4.3-never-suppressed",
            "Figure 4.3",
            "D_N = 0.3, 0.6, 0.9 do not suppress the vibration, Stribeck law, R_N = 10",
        ],
        format!("E = {}", shares(&found)),
        &found,
        found.iter().all(|e| partial(*e)),
    );
    sheet
        .number_within(
            0.2,
            [
                "4.3-cancelled",
                "Figure 4.3(c)",
                "fraction of the vibration cancelled at D_N = 0.9, approximately",
            ],
            "0.5",
            &[1.0 - found[2]],
        )
        .note("printed as approximate");
    let found = efficiencies(&cases(&source("4.4")?)?);
    let words = [
        "4.4-partial",
        "Figure 4.4(a), (b)",
        "partial control at D_N = 0.3, 0.6, decreasing law, R_N = 7",
    ];
    sheet.statement(
        words,
        format!("E = {}", shares(&found[..2])),
        &found[..2],
        found[..2].iter().all(|e| partial(*e)),
    );
    let words = ["4.4-suppressed", "Figure 4.4(c)", "full control at D_N = 0.9"];
    sheet.statement(
        words,
        format!("E = {}", shares(&found[2..])),
        &found[2..],
        found[2] < SUPPRESSED,
    );
    Ok(())
}

/// Figures 4.5 and 4.6.
pub(super) fn effective_friction(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    for figure in ["4.5", "4.6"] {
        let cases = measured_friction::cases(&source(figure)?)?;
        let place = format!("Figure {figure}");
        let pairs: Vec<(f64, f64)> = cases.iter().map(tops).collect();
        let worst = pairs
            .iter()
            .map(|(measured, averaged)| (measured - averaged).abs())
            .fold(0.0, f64::max);
        let (measured, averaged): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        sheet
            .statement(
                [
                    &format!("{figure}-slope-change"),
                    &place,
                    "simulation and averaging agree on the slip velocity at which the slope of the friction changes sign",
                ],
                format!("v_r = {} and {}", list(&measured), list(&averaged)),
                &measured,
                worst <= 2.0 * BIN,
            )
            .note(format!("largest difference {}; bins are {BIN} wide", digits(worst, 2)));
        let worst = cases.iter().map(outer_deviation).fold(0.0, f64::max);
        sheet.statement(
            [
                &format!("{figure}-falling-region"),
                &place,
                "they agree well in the region of negative slope",
            ],
            format!("largest difference of μ̄ {}", digits(worst, 2)),
            &[worst],
            worst < 0.01,
        );
    }
    Ok(())
}

/// Slip velocity of the largest friction: measured and averaged.
fn tops(case: &FrictionPanel) -> (f64, f64) {
    let top = |points: &[(f64, f64)]| {
        points.iter().copied().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(f64::NAN, |point| point.0)
    };
    // The Stribeck law increases again beyond v_m.
    let below = |v: f64| v < 0.15;
    let measured: Vec<(f64, f64)> =
        case.bins.iter().map(|&(v, mu, _)| (v, mu)).filter(|point| below(point.0)).collect();
    let averaged: Vec<(f64, f64)> =
        case.averaged.iter().copied().filter(|point| below(point.0)).collect();
    (top(&measured), top(&averaged))
}

/// Largest difference between measured and averaged friction, from one bin beyond the maximum up to v_m.
fn outer_deviation(case: &FrictionPanel) -> f64 {
    let (measured, averaged) = tops(case);
    let from = measured.max(averaged) + BIN;
    let outer = case.bins.iter().filter(|(v, _, _)| *v > from && *v < NUMBERS.vm);
    outer.map(|&(v, mu, _)| (mu - interpolated(&case.averaged, v)).abs()).fold(0.0, f64::max)
}

/// Figures 4.7, 4.8, and the predictions for figure 4.11.
pub(super) fn stability_maps(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let everywhere = |direction| everywhere(Waveform::Sine, direction);
    let (normal, tangential) = (everywhere(Direction::Normal)?, everywhere(Direction::Tangential)?);
    sheet.statement(
        [
            "4.7-larger",
            "Figures 4.7, 3.5",
            "normal dither needs a much larger amplitude than tangential dither, Stribeck law",
        ],
        format!("α_N^L = {}, α_T^L = {}", digits(normal, 4), digits(tangential, 4)),
        &[normal, tangential],
        normal > 2.0 * tangential,
    );
    let belt = belt(
        LawKind::Decreasing,
        0.2,
        0.075,
        Some((Direction::Normal, Waveform::Square, 0.5, 5.0)),
    )?;
    let undithered = criterion(&belt.undithered(), AveragingOptions::default())
        .map_err(|error| failed("claims", &error))?
        .value;
    sheet
        .statement(
            [
                "4.11-undithered",
                "Figure 4.11(a)",
                "decreasing law, ζ = 0.2, v₀ = 0.075: undithered sliding is stable",
            ],
            format!("2ζ + Fμ′ = {}", digits(undithered, 3)),
            &[undithered],
            undithered > 0.0,
        )
        .note("by a small margin: it would be unstable with ζ = 0.19 or μ_m = 0.2587");
    let found = critical(&belt, FastResponse::Limit)?;
    let rows = [(0, "0.115", true), (0, "0.575", false), (1, "0.13", true), (1, "0.65", false)];
    for (which, printed, is_ratio) in rows {
        let (symbol, suffix) = if is_ratio { ("α_N", "-ratio") } else { ("D_N", "") };
        let value = found
            .get(which)
            .map(|change| if is_ratio { change.amplitude_ratio } else { change.amplitude });
        let becomes = ["unstable", "stable"][which];
        let statement = format!("averaging, square, R_N = 5: {becomes} from {symbol} =");
        sheet.number(
            &format!("4.41-{becomes}{suffix}"),
            "(4.41)",
            &statement,
            printed,
            value.as_slice(),
        );
    }
    Ok(())
}

/// α^L, Stribeck law, ζ = 0.005.
fn everywhere(waveform: Waveform, direction: Direction) -> Result<f64, Failure> {
    let wave = FastWave::Integral(waveform);
    let found = everywhere_stable_amplitude(&law(LawKind::Stribeck)?, LIGHT, 1.0, wave, direction)
        .map_err(|error| failed("claims", &error))?;
    match found {
        EverywhereStable::From { amplitude_ratio, .. } => Ok(amplitude_ratio),
        other => Err(failed("claims", &format!("no α^L: {other:?}"))),
    }
}

/// (4.34)–(4.38), with μ(v₀) at the tip v₀ = α^L G_max, which the dissertation leaves open.
pub(super) fn formulas(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    /// Equation, waveform, α^L as printed for ζ, the error.
    type Row = (&'static str, Waveform, fn(LawNumbers, f64) -> f64, &'static str);
    let rows: [Row; 3] = [
        ("4.34", Waveform::Sine, printed_formulas::everywhere_344, "the nested root of (3.44)"),
        (
            "4.36",
            Waveform::Triangle,
            printed_formulas::everywhere_348,
            "the same error as in (3.48)",
        ),
        (
            "4.38",
            Waveform::Square,
            printed_formulas::everywhere_348,
            "2/π should be 1/π; it repeats (4.36)",
        ),
    ];
    let law = law(LawKind::Stribeck)?;
    for (equation, waveform, printed, note) in rows {
        let tip = everywhere(waveform, Direction::Tangential)? * waveform.peak_integral();
        let statement = format!("α_N^L, Stribeck law, {}, ζ = 0.005, at its tip", waveform.name());
        sheet
            .formula(
                [equation, &format!("({equation})"), &statement],
                printed(NUMBERS, LIGHT) / law.coefficient(tip),
                everywhere(waveform, Direction::Normal)?,
            )
            .note(note);
    }
    // R = 1 keeps the contact closed at α_N = 0.5; in the limit of high frequency only α_N matters.
    let alpha = 0.5;
    let belt = belt(
        LawKind::Stribeck,
        LIGHT,
        0.1,
        Some((Direction::Normal, Waveform::Triangle, alpha, 1.0)),
    )?;
    let bands = unstable_bands(&belt, AveragingOptions::default())
        .map_err(|error| failed("claims", &error))?;
    let right = bands.last().and_then(|band| band.upper).unwrap_or(f64::NAN);
    // The printed equation is implicit in v₀: v₀ = edge(μ(v₀)α_N), a contraction.
    let printed = (0..200).fold(right, |v, _| {
        printed_formulas::upper_edge_347(NUMBERS, LIGHT, law.coefficient(v) * alpha)
    });
    sheet
        .formula(
            ["4.35", "(4.35)", "upper edge, Stribeck law, triangle, ζ = 0.005, α_N = 0.5"],
            printed,
            right,
        )
        .note("π²/48 should be π²/30, as in (3.47)");
    Ok(())
}
