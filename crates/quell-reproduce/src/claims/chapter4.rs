//! Claims of chapter 4: normal dither.

use quell::plot::PlotPoint;
use quell_dynamics::response::{SUPPRESSED, steady_effective_friction};
use quell_linear::averaging::{
    Averaging, EverywhereStable, FastWave, criterion, everywhere_stable_amplitude, unstable_bands,
};
use quell_model::{Belt, Direction, LawKind, Waveform};

use super::super::failure::failed;
use super::super::measured_friction::{self, FrictionPanel, TOLERANCE, averaged_at, interpolated};
use super::super::printed_formulas::{self, LawNumbers};
use super::super::responses::{ResponseColumn, cases};
use super::chapter2::{LIGHT, belt, critical, law, partial, residual_vibrations, source};
use super::chapter3::lost_brace;
use super::record::largest_line;
use super::sheet::{ClaimSheet, USUAL_LIMIT, digits, list, shares};
use quell::complaint::Failure;

const NUMBERS: LawNumbers = LawNumbers::DISSERTATION;

/// Figures 4.3 and 4.4.
pub(super) fn responses(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let columns = cases(&source("4.3")?)?;
    let found = residual_vibrations(&columns);
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
        .note("printed as approximate; the next line is the reading of the dissertation");
    let belt_of = |column: &ResponseColumn| column.study.belt().clone();
    let with = largest_line(&belt_of(&columns[2]))?.amplitude;
    let without = largest_line(&belt_of(&columns[2]).undithered())?.amplitude;
    let words = [
        "4.3-record",
        "Figure 4.3(c)",
        "the same by the largest lines of records of length 75π without window",
    ];
    sheet
        .number_within(0.2, words, "0.5", &[1.0 - with / without])
        .note("the undithered vibration lies between two lines of such a record, which lowers its largest line");
    let found = residual_vibrations(&cases(&source("4.4")?)?);
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

/// Figures 4.5 and 4.6, on steady responses with stick.
pub(super) fn effective_friction(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    for figure in ["4.5", "4.6"] {
        let cases = measured_friction::cases(&source(figure)?)?;
        let place = format!("Figure {figure}");
        let pairs = cases.iter().map(tops).collect::<Result<Vec<[f64; 2]>, Failure>>()?;
        slope_change(sheet, figure, &place, &pairs);
        let worst = cases
            .iter()
            .zip(&pairs)
            .map(|(case, tops)| outer_deviation(case, tops[0].max(tops[1])))
            .fold(0.0, f64::max);
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
        let low: Vec<[f64; 2]> =
            cases.iter().zip(&pairs).filter_map(|(case, tops)| low_region(case, *tops)).collect();
        let [measured, averaged] =
            [0, 1].map(|k: usize| low.iter().map(|pair| pair[k]).collect::<Vec<f64>>());
        let holds = low.len() == cases.len()
            && measured
                .iter()
                .zip(&averaged)
                .all(|(measured, averaged)| measured.signum() != averaged.signum());
        sheet
            .statement(
                [
                    &format!("{figure}-convexity"),
                    &place,
                    "at low slip velocities simulation and averaging differ in the convexity of the curve",
                ],
                format!(
                    "friction halfway to the maximum, less the mean of its ends: measured {}; averaged {}",
                    list(&measured),
                    list(&averaged)
                ),
                &measured,
                holds,
            )
            .note("positive: concave; between the first slip velocity and that of the maximum");
    }
    Ok(())
}

/// Where the slope changes sign, and for which amplitude averaging is more accurate.
fn slope_change(sheet: &mut ClaimSheet, figure: &str, place: &str, pairs: &[[f64; 2]]) {
    let [measured, averaged] =
        [0, 1].map(|k: usize| pairs.iter().map(|pair| pair[k]).collect::<Vec<f64>>());
    let relative: Vec<f64> = pairs.iter().map(|[m, a]| (a / m - 1.0).abs()).collect();
    let differences: Vec<f64> = pairs.iter().map(|[m, a]| (a - m).abs()).collect();
    let worst = relative.iter().copied().fold(0.0, f64::max);
    sheet
        .statement(
            [
                &format!("{figure}-slope-change"),
                place,
                "simulation and averaging agree on the slip velocity at which the slope of the friction changes sign",
            ],
            format!("v_r = {} and {}", list(&measured), list(&averaged)),
            &measured,
            worst <= USUAL_LIMIT,
        )
        .note(format!("largest relative difference {}; steady responses, stick included", digits(worst, 2)));
    sheet.statement(
        [
            &format!("{figure}-smaller-amplitude"),
            place,
            "the predicted change of slope is more accurate in case (a) than in case (d)",
        ],
        format!("differences of v_r: {}", list(&differences)),
        &differences,
        differences.first() < differences.last(),
    );
}

/// Largest slip velocity at which the maximum of friction is searched: the Stribeck law increases again beyond v_m.
const TOPS_BELOW: f64 = 0.75 * NUMBERS.vm;

/// Slip velocity of the largest friction below that of the law's minimum: measured and averaged.
fn tops(case: &FrictionPanel) -> Result<[f64; 2], Failure> {
    let steady = case.steady.iter().map(|&(v, mu, _)| PlotPoint::new(v, mu));
    tops_among(&case.belt, steady, case.averaged.iter().copied())
}

/// The same of a belt with normal dither.
pub(super) fn tops_of(belt: &Belt) -> Result<[f64; 2], Failure> {
    let grid: Vec<f64> = (1..=50).map(|k| 0.02 * TOPS_BELOW * f64::from(k)).collect();
    let steady = grid
        .iter()
        .filter_map(|v| {
            let found = steady_effective_friction(belt, *v, TOLERANCE).ok()?;
            Some(PlotPoint::new(*v, found.coefficient))
        })
        .collect::<Vec<_>>();
    let averaged = grid
        .iter()
        .map(|v| Ok(PlotPoint::new(*v, averaged_at("claims", belt, *v)?)))
        .collect::<Result<Vec<PlotPoint>, Failure>>()?;
    tops_among(belt, steady, averaged)
}

fn tops_among(
    belt: &Belt,
    steady: impl IntoIterator<Item = PlotPoint>,
    averaged: impl IntoIterator<Item = PlotPoint>,
) -> Result<[f64; 2], Failure> {
    let below = |point: &PlotPoint| point.x < TOPS_BELOW;
    let steady: Vec<PlotPoint> = steady.into_iter().filter(below).collect();
    let measured = top(&steady, |v| {
        steady_effective_friction(belt, v, TOLERANCE)
            .map(|found| found.coefficient)
            .map_err(|error| failed("claims", &error))
    })?;
    let curve: Vec<PlotPoint> = averaged.into_iter().filter(below).collect();
    let averaged = top(&curve, |v| averaged_at("claims", belt, v))?;
    Ok([measured, averaged])
}

/// Where a function is largest: by golden sections about the largest of some of its points.
fn top(points: &[PlotPoint], value: impl Fn(f64) -> Result<f64, Failure>) -> Result<f64, Failure> {
    let largest = (0..points.len()).max_by(|&a, &b| points[a].y.total_cmp(&points[b].y));
    let Some(largest) = largest.filter(|index| 0 < *index && index + 1 < points.len()) else {
        return Err(failed("claims", &"the friction has no maximum"));
    };
    let (mut from, mut to) = (points[largest - 1].x, points[largest + 1].x);
    let golden = 0.5 * (5.0f64.sqrt() - 1.0);
    while to - from > 1e-6 {
        let (left, right) = (to - golden * (to - from), from + golden * (to - from));
        if value(left)? > value(right)? {
            to = right;
        } else {
            from = left;
        }
    }
    Ok(0.5 * (from + to))
}

/// Largest difference between measured and averaged friction, from a tenth beyond the maximum up to v_m.
fn outer_deviation(case: &FrictionPanel, top: f64) -> f64 {
    let outer = case.steady.iter().filter(|(v, _, _)| *v > 1.1 * top && *v < NUMBERS.vm);
    outer.map(|&(v, mu, _)| (mu - interpolated(&case.averaged, v)).abs()).fold(0.0, f64::max)
}

/// Value halfway between the first point and the maximum, less the mean of the two: measured and averaged.
fn low_region(case: &FrictionPanel, tops: [f64; 2]) -> Option<[f64; 2]> {
    let measured: Vec<PlotPoint> =
        case.steady.iter().map(|&(v, mu, _)| PlotPoint::new(v, mu)).collect();
    let from = measured.first()?.x;
    let bulge = |curve: &[PlotPoint], top: f64| {
        let at = |v: f64| interpolated(curve, v);
        at(0.5 * (from + top)) - 0.5 * (at(from) + at(top))
    };
    Some([bulge(&measured, tops[0]), bulge(&case.averaged, tops[1])])
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
    let undithered = criterion(&belt.undithered(), Averaging::Limit)
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
    let found = critical(&belt, Averaging::Limit)?;
    for (which, ratio, amplitude) in [(0, "0.115", "0.575"), (1, "0.13", "0.65")] {
        let becomes = ["unstable", "stable"][which];
        let found = found.get(which).map(|change| change.amplitude_ratio);
        let statement =
            |symbol: &str| format!("averaging, square, R_N = 5: {becomes} from {symbol} =");
        let name = format!("4.41-{becomes}");
        sheet.truncated(
            [&format!("{name}-ratio"), "(4.41)", &statement("α_N")],
            ratio,
            found.as_slice(),
        );
        // "i.e. D_N = α_N R_N": R_N times the truncated α_N.
        let scale = 10f64.powi(i32::try_from(ratio.len()).unwrap_or(2) - 2);
        let product = found.map(|alpha| 5.0 * (alpha * scale).trunc() / scale);
        let exact = found.map_or_else(String::new, |alpha| digits(5.0 * alpha, 4));
        sheet
            .truncated([&name, "(4.41)", &statement("D_N")], amplitude, product.as_slice())
            .note(format!("R_N times the truncated α_N; without truncation {exact}"));
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
    /// Equation, waveform, α^L as printed for ζ.
    type Row = (&'static str, Waveform, fn(LawNumbers, f64) -> f64);
    let rows: [Row; 3] = [
        ("4.34", Waveform::Sine, printed_formulas::everywhere_344),
        ("4.36", Waveform::Triangle, printed_formulas::everywhere_348),
        ("4.38", Waveform::Square, printed_formulas::everywhere_348),
    ];
    let law = law(LawKind::Stribeck)?;
    for (equation, waveform, printed) in rows {
        let tip = everywhere(waveform.clone(), Direction::Tangential)? * waveform.peak_integral();
        let at_tip = law.coefficient(tip);
        let right = everywhere(waveform.clone(), Direction::Normal)?;
        let note = match waveform {
            Waveform::Sine => {
                lost_brace(printed_formulas::everywhere_344_read(NUMBERS, LIGHT) / at_tip / right)
            }
            Waveform::Triangle => "the same error as in (3.48)".to_owned(),
            _ => "2/π should be 1/π; it repeats (4.36)".to_owned(),
        };
        let statement = format!("α_N^L, Stribeck law, {}, ζ = 0.005, at its tip", waveform.name());
        sheet
            .formula(
                [equation, &format!("({equation})"), &statement],
                printed(NUMBERS, LIGHT) / at_tip,
                right,
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
    let bands =
        unstable_bands(&belt, Averaging::Limit).map_err(|error| failed("claims", &error))?;
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
