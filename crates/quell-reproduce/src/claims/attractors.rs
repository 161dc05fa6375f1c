//! Claims about single responses from rest, figures 2.10, 2.11, 3.12, 3.13, 4.11, and from other initial conditions.

use std::sync::Arc;

use quell_dynamics::attractor::{AttractorSettings, Patience, gather, settle_many};
use quell_dynamics::simulation::Start;
use quell_model::{Direction, LawKind, Waveform};

use super::super::amplitude_columns::{AmplitudeColumn, AmplitudeColumns, AmplitudeThreshold};
use super::super::failure::failed;
use super::chapter2::{LIGHT, belt, source};
use super::sheet::{ClaimSheet, digits, list};
use quell::complaint::Failure;

/// Claims of a figure: stable and unstable amplitudes, and the amplitudes between which stability changes.
struct Printed {
    figure: &'static str,
    /// The amplitudes of the columns called stable.
    stable: &'static [f64],
    /// "Becomes unstable for D ≥": the first unstable column.
    unstable_from: f64,
    /// "Stabilised for D ≥".
    stable_from: f64,
    /// The predictions of averaging for both, as printed.
    averaged: [&'static str; 2],
}

const TANGENTIAL: [Printed; 4] = [
    Printed {
        figure: "2.10",
        stable: &[0.0, 2.5, 10.0],
        unstable_from: 3.0,
        stable_from: 10.0,
        averaged: ["4.3", "9.8"],
    },
    Printed {
        figure: "2.11",
        stable: &[0.0, 6.5, 15.0],
        unstable_from: 7.0,
        stable_from: 15.0,
        averaged: ["10", "15"],
    },
    Printed {
        figure: "3.12",
        stable: &[0.0, 3.0, 13.0],
        unstable_from: 4.0,
        stable_from: 13.0,
        averaged: ["5.4", "12.7"],
    },
    Printed {
        figure: "3.13",
        stable: &[0.0, 2.0, 6.5],
        unstable_from: 2.5,
        stable_from: 6.5,
        averaged: ["3.3", "6.3"],
    },
];

/// The claims of one of figures 2.10, 2.11, 3.12, 3.13.
pub(super) fn tangential(sheet: &mut ClaimSheet, figure: &str) -> Result<(), Failure> {
    let printed = TANGENTIAL
        .iter()
        .find(|printed| printed.figure == figure)
        .ok_or_else(|| failed("claims", &format!("nothing is printed about figure {figure}")))?;
    let columns = sheet.shared.columns(figure, &source(figure)?.study()?)?;
    columns_claim(sheet, figure, figure, &columns, printed.stable);
    borders(sheet, printed, &columns);
    let place = format!("Figure {figure}");
    for ((change, averaged), (word, claim)) in columns
        .local
        .iter()
        .zip(printed.averaged)
        .zip([("unstable", "lower"), ("stable again", "upper")])
    {
        let name = format!("{figure}-local-{claim}");
        let statement = format!(
            "the response is {word} from D_T = (printed: averaging; measured: exact Floquet threshold)"
        );
        sheet.number(&name, &place, &statement, averaged, &[change.amplitude]);
    }
    let vibrating = columns.cases.iter().filter(|case| !case.quiet);
    let frequencies: Vec<f64> = vibrating.filter_map(AmplitudeColumn::frequency).collect();
    let name = format!("{figure}-period-10");
    let statement =
        "the unstable response is close to period-10: its low frequency is at or near ω₀";
    sheet
        .number(&name, &place, statement, "1.0", &frequencies)
        .note("revolutions of the section per period, times R");
    Ok(())
}

/// The columns that settle from rest.
fn columns_claim(
    sheet: &mut ClaimSheet,
    stem: &str,
    figure: &str,
    columns: &AmplitudeColumns,
    stable: &[f64],
) {
    let of = |quiet: bool| -> Vec<f64> {
        columns.cases.iter().filter(|case| case.quiet == quiet).map(|case| case.amplitude).collect()
    };
    let (settles, vibrates) = (of(true), of(false));
    let others: Vec<f64> =
        columns.cases.iter().map(|case| case.amplitude).filter(|d| !stable.contains(d)).collect();
    let plain = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
    let statement = format!(
        "responses from rest settle at D = {} and vibrate at D = {}",
        plain(stable),
        plain(&others)
    );
    let measured = format!("settle: {}; vibrate: {}", plain(&settles), plain(&vibrates));
    let holds = settles == stable;
    sheet.statement(
        [&format!("{stem}-columns"), &format!("Figure {figure}"), &statement],
        measured,
        &settles,
        holds,
    );
}

/// "Becomes unstable for D ≥ 3": the threshold from rest lies between the last stable and the first unstable column.
fn borders(sheet: &mut ClaimSheet, printed: &Printed, columns: &AmplitudeColumns) {
    let name = printed.figure;
    for (word, claim, holds_above, first) in [
        ("unstable", "lower", false, printed.unstable_from),
        ("stable again", "upper", true, printed.stable_from),
    ] {
        let before = columns
            .cases
            .iter()
            .map(|case| case.amplitude)
            .filter(|d| *d < first)
            .fold(0.0, f64::max);
        let found: Vec<f64> = columns
            .from_rest
            .iter()
            .filter(|change| change.holds_above == holds_above)
            .map(|change| change.amplitude)
            .collect();
        let holds = found.iter().any(|amplitude| before < *amplitude && *amplitude <= first);
        let statement = format!("from rest it is {word} for D ≥ {first}, but not yet at {before}");
        let claim = sheet.statement(
            [&format!("{name}-from-rest-{claim}"), &format!("Figure {name}"), &statement],
            format!("threshold {}", list(&found)),
            &found,
            holds,
        );
        if !holds_above && let Some(AmplitudeThreshold { amplitude, .. }) = columns.local.first() {
            claim.note(format!(
                "the base response is stable up to {}: between the two amplitudes a stick-slip vibration coexists with it, and \
                 rest is in the basin of that vibration",
                digits(*amplitude, 6)
            ));
        }
    }
}

/// Figure 4.11 with the waveform of its caption: what its text says of it.
pub(super) fn square(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let columns = normal(sheet, &Waveform::Square)?;
    let stem = "4.11-square";
    columns_claim(sheet, stem, "4.11, square", &columns, &[0.0, 0.6, 0.95]);
    let (spreads, thresholds) = (spreads(&columns), amplitudes(&columns.local));
    let statement =
        "from rest it is stable at D_N = 0.6, unstable from 0.7, and nearly stable at 0.9 to 0.95";
    sheet
        .statement(
            [&format!("{stem}-pattern"), "Figure 4.11, square", statement],
            format!("size of the section {}", list(&spreads)),
            &spreads,
            is_the_pattern(&spreads),
        )
        .note(format!("the stability of the base response changes at D_N = {}", list(&thresholds)));
    Ok(())
}

/// With a sine, of which the dissertation says nothing, the pattern of the text appears.
pub(super) fn sine(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let columns = normal(sheet, &Waveform::Sine)?;
    // "Unstable for D_N ≥ 0.7", not yet at 0.6, and "stabilised approximately in the range 0.9 ≤ D_N ≤ 0.95".
    let sizes = spreads(&columns);
    let left = match sizes.as_slice() {
        [_, _, first, .., last] => Some(last / first),
        _ => None,
    };
    let found: Vec<f64> =
        amplitudes(&columns.from_rest).first().copied().into_iter().chain(left).collect();
    let holds = found.len() == 2 && 0.6 < found[0] && found[0] <= 0.7 && found[1] < 0.2;
    sheet
        .finding(
            [
                "4.11-sine-columns",
                "Figure 4.11, sine",
                "with a sine, runs from rest become unstable between the columns 0.6 and 0.7, and little of that is left at 0.95",
            ],
            format!(
                "unstable from {}; at 0.95 the section has {} of its size at 0.7",
                list(&found[..found.len().min(1)]),
                list(found.get(1..).unwrap_or_default())
            ),
            &found,
            holds,
        )
        .note("the dissertation says square; the small vibration at D_N = 0.95 disappears at 0.9654");
    let (spreads, thresholds) = (spreads(&columns), amplitudes(&columns.local));
    sheet
        .finding(
            [
                "4.11-sine-pattern",
                "Figure 4.11, sine",
                "with a sine, the sections have the pattern that the text describes: a point, closed curves, nearly a point",
            ],
            format!("size of the section {}", list(&spreads)),
            &spreads,
            is_the_pattern(&spreads),
        )
        .note(format!("the stability of the base response changes at D_N = {}", list(&thresholds)));
    several_responses(sheet, &columns);
    Ok(())
}

/// The columns of figure 4.11 with a waveform.
fn normal(sheet: &ClaimSheet, waveform: &Waveform) -> Result<Arc<AmplitudeColumns>, Failure> {
    let study = source("4.11")?.changed(&[&format!("dither.waveform={}", waveform.name())])?;
    sheet.shared.columns("4.11", &study)
}

fn spreads(columns: &AmplitudeColumns) -> Vec<f64> {
    columns.cases.iter().filter_map(spread).collect()
}

fn amplitudes(changes: &[AmplitudeThreshold]) -> Vec<f64> {
    changes.iter().map(|change| change.amplitude).collect()
}

/// Whether the sections are as the text describes: their size where it calls the response unstable, compared with that at the end.
fn is_the_pattern(spreads: &[f64]) -> bool {
    spreads.len() == 6
        && spreads[1] < 1e-6
        && spreads[2] > 0.01
        && spreads[3] > 0.01
        && spreads[5] < 0.2 * spreads[2]
}

/// "Although multiple solutions have not been encountered in this study, their existence in other parameter regions is still an open
/// question": they exist where the base response is stable and the run from rest does not end on it.
fn several_responses(sheet: &mut ClaimSheet, columns: &AmplitudeColumns) {
    let ends = |changes: &[AmplitudeThreshold]| -> Option<f64> {
        changes.iter().find(|change| !change.holds_above).map(|change| change.amplitude)
    };
    let found: Vec<f64> =
        [ends(&columns.from_rest), ends(&columns.local)].into_iter().flatten().collect();
    let holds = found.len() == 2 && found[0] < found[1];
    sheet
        .finding(
            [
                "4-open-question",
                "after Figure 4.11",
                "whether multiple solutions exist under normal dither, which the dissertation leaves open",
            ],
            format!("they exist from D_N = {}, for the values of figure 4.11 and a sine", list(&found).replace(", ", " to ")),
            &found,
            holds,
        )
        .note("the base response is stable up to the second amplitude, and runs from rest leave it from the first one on: between \
               them a quasi-periodic vibration coexists with it");
}

/// Extent along x of the section of a response, if the run converged to one.
fn spread(case: &AmplitudeColumn) -> Option<f64> {
    let displacements = case.attractor.as_ref()?.section.iter().map(|(x, _)| *x);
    let (low, high) = displacements
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    (low <= high).then_some(high - low)
}

/// "Multiple solutions have not been encountered", normal dither: 11 × 9 initial conditions, x from −1 to 1.5, x′ from −1 to 1.
pub(super) fn other_starts(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let cases = [
        (LawKind::Stribeck, LIGHT, 0.05, Waveform::Sine, 0.9, 10.0),
        (LawKind::Decreasing, LIGHT, 0.05, Waveform::Sine, 0.6, 7.0),
        (LawKind::Decreasing, LIGHT, 0.05, Waveform::Sine, 0.9, 7.0),
        (LawKind::Decreasing, 0.2, 0.075, Waveform::Square, 0.6, 5.0),
        (LawKind::Decreasing, 0.2, 0.075, Waveform::Sine, 0.8, 5.0),
    ];
    let starts: Vec<Start> = (0..99)
        .map(|k| Start {
            time: 0.0,
            displacement: -1.0 + 0.25 * f64::from(k % 11),
            velocity: -1.0 + 0.25 * f64::from(k / 11),
        })
        .collect();
    let (mut found, mut unknown) = (Vec::new(), 0);
    for (law, damping, velocity, waveform, amplitude, ratio) in cases {
        let dither = Some((Direction::Normal, waveform, amplitude, ratio));
        let belt = belt(law, damping, velocity, dither)?;
        let settings = AttractorSettings::new(&belt).map_err(|why| failed("claims", &why))?;
        let ends = settle_many(&settings, &starts, Patience::BASIN);
        let basins = gather(&settings, &ends).map_err(|why| failed("claims", &why))?;
        found.push(basins.basins.len() as f64);
        unknown += basins.unknown();
    }
    let holds = found.iter().all(|count| *count == 1.0);
    sheet
        .statement(
            [
                "4-other-starts",
                "after Figure 4.11",
                "normal dither: multiple solutions have not been encountered on a grid of initial conditions",
            ],
            format!(
                "number of responses reached from 11 × 9 initial conditions, five cases: {}; runs that did not settle: {unknown}",
                list(&found)
            ),
            &found,
            holds,
        )
        .note("x from −1 to 1.5, x′ from −1 to 1; figures 4.3(c), 4.4(b), 4.4(c), 4.11 square D_N = 0.6 and sine D_N = 0.8");
    Ok(())
}
